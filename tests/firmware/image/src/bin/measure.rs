//! RAM, instructions and stack in `f32`: a rope of 40 particles and an 8×8 cloth. A line each: kind, what, number.
#![no_std]
#![no_main]

use core::fmt::Write;

use firmware_image::console::{Console, exit};
use firmware_image::{count, stack};
use firmware_jobs::{Outcome, gravity, hang, hang_cloth};
use hooke::{
    Fixed, Gravity, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Operator, Scene, Snapshot, Vec3,
};
use static_cell::ConstStaticCell;

const STEPS: u64 = 15;
const CLOTH: usize = 210;
type Kept<const N: usize, const S: usize> = Snapshot<Fixed<f32, N, S, Hookean>>;
type Euler = LinearlyImplicitEuler<f32, ((), Gravity<f32>)>;
static ROPE: ConstStaticCell<Scene<f32, 40, 39>> = ConstStaticCell::new(Scene::new());
static ROPE_KEPT: ConstStaticCell<Kept<40, 39>> = ConstStaticCell::new(Snapshot::new());
static SHEET: ConstStaticCell<Scene<f32, 64, CLOTH>> = ConstStaticCell::new(Scene::new());
static SHEET_KEPT: ConstStaticCell<Kept<64, CLOTH>> = ConstStaticCell::new(Snapshot::new());
static Y: ConstStaticCell<[Vec3<f32>; 64]> = ConstStaticCell::new([[0.0; 3]; 64]);

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    exit(if measure(&mut Console::new()).is_ok() { 0 } else { 1 })
}

fn measure(console: &mut Console) -> Outcome {
    ram(console)?;
    let (rope, sheet, y) = (ROPE.take(), SHEET.take(), Y.take());
    hang(rope, 40)?;
    hang_cloth(sheet, 8)?;
    sheet.pin(0)?;
    sheet.pin(7)?;
    step("rope40", rope, ROPE_KEPT.take(), y, console)?;
    step("cloth8x8", sheet, SHEET_KEPT.take(), y, console)?;
    // Two scenes of different springs per particle, nothing pinned: two equations for two unknowns.
    rope.release(0)?;
    sheet.release(0)?;
    sheet.release(7)?;
    let (rope, sheet) = (passes(rope, y)?, passes(sheet, y)?);
    for (name, rope, sheet) in [("assembly", rope.0, sheet.0), ("product", rope.1, sheet.1)] {
        let determinant = 40 * CLOTH as i64 - 64 * 39;
        let spring = 10 * (40 * sheet - 64 * rope) / determinant;
        let particle = 10 * (CLOTH as i64 * rope - 39 * sheet) / determinant;
        for (of, tenths) in [("spring", spring), ("particle", particle)] {
            writeln!(console, "instructions {name}-per-{of} {}.{}", tenths / 10, tenths % 10)?;
        }
    }
    Ok(())
}

/// Bytes that one more particle and one more spring add to a scene.
fn ram(console: &mut Console) -> Outcome {
    macro_rules! added {
        ($t:ident) => {{
            let of = size_of::<Scene<$t, 40, 40>>();
            let particle = (size_of::<Scene<$t, 42, 40>>() - of) / 2;
            let spring = (size_of::<Scene<$t, 40, 42>>() - of) / 2;
            let of = stringify!($t);
            writeln!(console, "RAM particle-{of} {particle}\nRAM spring-{of} {spring}")?;
        }};
    }
    added!(f32);
    added!(f64);
    Ok(())
}

fn euler() -> Euler {
    LinearlyImplicitEuler::new(1.0 / 60.0).gravity(gravity())
}

/// Instructions of assembly, and of one product.
#[inline(never)]
fn passes<M: Memory<Real = f32>>(
    scene: &mut MassSpring<M>,
    y: &mut [Vec3<f32>; 64],
) -> Result<(i64, i64), firmware_jobs::Failure> {
    scene.islands(); // renewed now, so that the passes alone are counted
    let mut euler = euler();
    let (assembly, seen) = count::instructions(|| euler.inspect(scene.parts(), &[], |_, _, _| ()));
    seen?;
    let mut product = 0;
    euler.inspect(scene.parts(), &[], |system, b, _| {
        let y = y.get_mut(..b.len()).unwrap_or_default();
        product = count::instructions(|| system.apply(b, y)).0;
    })?;
    Ok((assembly as i64, product as i64))
}

/// The mean over some steps, its parts, and the stack that a step paints.
fn step<M: Memory<Real = f32>>(
    name: &str,
    scene: &mut MassSpring<M>,
    kept: &mut Snapshot<M>,
    y: &mut [Vec3<f32>; 64],
    console: &mut Console,
) -> Outcome {
    let mut euler = euler();
    let (mut sum, mut iterations) = (0, 0);
    for _ in 0..STEPS {
        let (instructions, report) = count::instructions(|| scene.step(&mut euler));
        sum += instructions;
        iterations += u64::from(report?.iterations);
    }
    // The same step cut at 10 and at 20 iterations: the difference is ten iterations.
    scene.save(kept)?;
    let mut cut = [0; 2];
    for (cut, n) in cut.iter_mut().zip([10, 20]) {
        scene.restore(kept)?;
        scene.islands(); // renewed now, so that the step alone is counted
        let mut short = euler.tolerance(0.0).max_iterations(n);
        let (instructions, report) = count::instructions(|| scene.step(&mut short));
        *cut = instructions;
        report?;
    }
    let [ten, twenty] = cut;
    let each = twenty.saturating_sub(ten) / 10;
    let (assembly, product) = passes(scene, y)?;
    let vectors = (each as i64).saturating_sub(product);
    let mut failed = None;
    let deep = stack::used(|| failed = scene.step(&mut euler).err());
    if let Some(why) = failed {
        return Err(why.into());
    }
    let ends = (ten.saturating_sub(10 * each) as i64).saturating_sub(assembly);
    let rows = scene.free_particles();
    let free_ends = |j| {
        let state = scene.state();
        let (a, b) = state.ends(j)?;
        Some(usize::from(!state.is_pinned(a)) + usize::from(!state.is_pinned(b)))
    };
    let springs = |n| (0..scene.state().springs()).filter(|j| free_ends(*j) == Some(n)).count();
    writeln!(console, "count {name}-iterations {}\ncount {name}-particles {rows}", iterations / STEPS)?;
    writeln!(console, "count {name}-pairs {}\ncount {name}-anchors {}", springs(2), springs(1))?;
    writeln!(console, "instructions {name}-step {}", sum / STEPS)?;
    writeln!(console, "instructions {name}-assembly {assembly}\ninstructions {name}-product {product}")?;
    writeln!(console, "instructions {name}-vectors {vectors}\ninstructions {name}-ends {ends}")?;
    let tenths = 10 * vectors / rows as i64;
    writeln!(console, "instructions {name}-vectors-per-particle {}.{}", tenths / 10, tenths % 10)?;
    writeln!(console, "painted {name} {deep}")?;
    Ok(())
}
