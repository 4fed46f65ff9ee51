//! Instructions and stack of a step, in `f32`: a rope of 40 particles and an 8×8 cloth.
#![no_std]
#![no_main]

use core::fmt::Write;

use firmware_image::console::{Console, exit};
use firmware_image::{count, stack};
use firmware_jobs::{Outcome, gravity, hang, hang_cloth};
use hooke::{Fixed, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Scene, Snapshot};
use static_cell::ConstStaticCell;

const STEPS: u64 = 15;
const CLOTH: usize = 210;
type Kept<const N: usize, const S: usize> = Snapshot<Fixed<f32, N, S, Hookean>>;
static ROPE: ConstStaticCell<Scene<f32, 40, 39>> = ConstStaticCell::new(Scene::new());
static ROPE_KEPT: ConstStaticCell<Kept<40, 39>> = ConstStaticCell::new(Snapshot::new());
static SHEET: ConstStaticCell<Scene<f32, 64, CLOTH>> = ConstStaticCell::new(Scene::new());
static SHEET_KEPT: ConstStaticCell<Kept<64, CLOTH>> = ConstStaticCell::new(Snapshot::new());

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    let mut console = Console::new();
    let (rope, sheet) = (ROPE.take(), SHEET.take());
    let built = hang(rope, 40).and_then(|()| hang_cloth(sheet, 8));
    let pinned = sheet.pin(0).and_then(|()| sheet.pin(7));
    let measured = built
        .and_then(|()| Ok(pinned?))
        .and_then(|()| measure("rope40", rope, ROPE_KEPT.take(), &mut console))
        .and_then(|()| measure("cloth8x8", sheet, SHEET_KEPT.take(), &mut console));
    exit(if measured.is_ok() { 0 } else { 1 })
}

/// Prints the mean over some steps, what an iteration and what the rest of a step cost, and the stack; 0 where it cannot
/// be counted.
fn measure<M: Memory<Real = f32>>(
    name: &str,
    scene: &mut MassSpring<M>,
    kept: &mut Snapshot<M>,
    console: &mut Console,
) -> Outcome {
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(gravity());
    let (mut sum, mut iterations, mut counted) = (0, 0, true);
    for _ in 0..STEPS {
        let (instructions, report) = count::instructions(|| scene.step(&mut euler));
        sum += instructions;
        counted &= instructions > 0;
        iterations += u64::from(report?.iterations);
    }
    // The same step cut at 10 and at 20 iterations: the difference is ten iterations.
    scene.save(kept)?;
    let mut cut = [0; 2];
    for (cut, n) in cut.iter_mut().zip([10, 20]) {
        scene.restore(kept)?;
        // The islands are renewed now, so that the step alone is counted.
        scene.islands();
        let mut short = euler.tolerance(0.0).max_iterations(n);
        let (instructions, report) = count::instructions(|| scene.step(&mut short));
        *cut = instructions;
        report?;
    }
    let [ten, twenty] = cut;
    let each = twenty.saturating_sub(ten) / 10;
    let mut failed = None;
    let deep = stack::used(|| failed = scene.step(&mut euler).err());
    if let Some(why) = failed {
        return Err(why.into());
    }
    let rest = ten.saturating_sub(10 * each);
    let (step, iterations) = (if counted { sum / STEPS } else { 0 }, iterations / STEPS);
    writeln!(console, "{name} step {step} iterations {iterations} each {each} rest {rest} stack {deep}")?;
    Ok(())
}
