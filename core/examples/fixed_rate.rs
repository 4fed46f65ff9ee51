//! A control loop at a fixed rate: each step may take so many iterations and no more, and says how exact that was.
//!
//! `cargo run -p hooke --example fixed_rate`, here; `tests/firmware/examples.sh`, on a Cortex-M4F.

use hooke::{EditError, LinearlyImplicitEuler, Scene, StepError};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 25;
type Rope = Scene<f32, PARTICLES, { PARTICLES - 1 }>;

// In .bss: the scene never crosses the stack, however large it is.
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());

/// Ticks of the loop in a second.
const RATE: u16 = 100;
/// What a tick can afford. An iteration costs the same instructions each time, so that this bounds the time of a step.
const BUDGET: u32 = 12;
/// How large the energy of a step's error should be at most, J. Beyond it the loop goes on, and knows.
const GOOD_ENOUGH: f32 = 1e-6;

pub(crate) fn main() {
    let Some(rope) = ROPE.try_take() else { return };
    if let Err(refused) = hang(rope) {
        return println!("not built: {refused}");
    }
    if let Err(failed) = run(rope) {
        println!("stopped: {failed}");
    }
}

/// A rope of 1 m, level at first, held at one end.
fn hang(rope: &mut Rope) -> Result<(), EditError> {
    let mut above = rope.particle([0.0, 0.0, 0.0], 0.005)?; // m, kg
    rope.pin(above)?;
    for i in 1..PARTICLES {
        let below = rope.particle([i as f32 / 24.0, 0.0, 0.0], 0.005)?;
        rope.spring(above, below, 500.0)?; // N/m; rest length: as placed
        above = below;
    }
    Ok(())
}

fn run(rope: &mut Rope) -> Result<(), StepError> {
    let mut euler =
        LinearlyImplicitEuler::new(1.0 / f32::from(RATE)).gravity([0.0, -9.81, 0.0]).max_iterations(BUDGET);
    let (mut cut_short, mut not_good_enough) = (0, 0);
    for tick in 1..=3 * RATE {
        // Here a device waits for its timer.
        let report = rope.step(&mut euler)?;
        cut_short += report.capped;
        not_good_enough += u32::from(report.upper > GOOD_ENOUGH);
        if tick % 50 == 0 {
            println!(
                "tick {tick}: tip at {:+.3?} m; {} iterations{}, the error's energy is between {:.0e} and {:.0e} J",
                rope.positions()[PARTICLES - 1],
                report.iterations,
                if report.capped > 0 { " (the budget)" } else { "" },
                report.lower,
                report.upper,
            );
        }
    }
    println!(
        "of {} ticks, {cut_short} used up the budget and {not_good_enough} missed {GOOD_ENOUGH:.0e} J",
        3 * RATE
    );
    Ok(())
}
