//! What a haptic device does: it moves the handle to where the user's hand is, and plays back the force that the handle
//! exerts on the hand, with the tension of a link as a second thing to feel.
//!
//! `cargo run -p hooke --example haptic`, here; `tests/firmware/examples.sh`, on a Cortex-M4F.

use hooke::{Drag, EditError, LinearlyImplicitEuler, Motion, Scene, StepError};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 12;
type Band = Scene<f32, PARTICLES, { PARTICLES - 1 }>;
static BAND: ConstStaticCell<Band> = ConstStaticCell::new(Scene::new()); // .bss

/// A haptic loop runs at about 1 kHz, or what is stiff feels soft.
const DT: f32 = 1.0 / 1000.0;
const HANDLE: usize = 0;
const WALL: usize = PARTICLES - 1;
const LINK_AT_THE_WALL: usize = PARTICLES - 2;

pub(crate) fn main() {
    let Some(band) = BAND.try_take() else { return };
    if let Err(refused) = hold(band) {
        return println!("not built: {refused}");
    }
    if let Err(failed) = run(band) {
        println!("stopped: {failed}");
    }
}

/// An elastic band of 0.44 m between the handle and a wall.
fn hold(band: &mut Band) -> Result<(), EditError> {
    let mut left = band.particle([0.0, 0.0, 0.0], 0.002)?; // m, kg
    for i in 1..PARTICLES {
        let right = band.particle([0.04 * i as f32, 0.0, 0.0], 0.002)?;
        band.spring(left, right, 80.0)?; // N/m; rest length: as placed
        left = right;
    }
    band.pin(HANDLE)?;
    band.pin(WALL)
}

fn run(band: &mut Band) -> Result<(), StepError> {
    let mut euler =
        LinearlyImplicitEuler::new(DT).gravity([0.0, -9.81, 0.0]).with(Drag(2.0)).max_iterations(8);
    for tick in 1..=1000_u16 {
        let hand = hand(f32::from(tick) * DT);
        let report = band.step_moving(&mut euler, &[hand])?;

        // What holds the handle against springs, weight and drag is what the hand must do; the device pushes back with
        // its opposite. It costs a look at every spring, and nothing where it is not asked for.
        let felt = band.reaction(HANDLE, &euler.forces).map(|holds| holds.map(|f| -f));
        let (Some(felt), true) = (felt, tick % 200 == 0) else { continue };
        println!(
            "{:.1} s: hand at {:+.3} m feels ({:+.3}, {:+.3}) N; the link at the wall pulls with {:.3} N; {} iterations, \
             the error's energy is at most {:.0e} J",
            f32::from(tick) * DT,
            hand.position[0],
            felt[0],
            felt[1],
            band.springs().tension_of(LINK_AT_THE_WALL),
            report.iterations,
            report.upper,
        );
    }
    Ok(())
}

/// Where the hand is t seconds after it took hold, and how fast it moves: 0.1 m away from the wall in a second, softly.
fn hand(t: f32) -> Motion<f32> {
    let (way, rate) = (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t));
    Motion { particle: HANDLE, position: [-0.1 * way, 0.0, 0.0], velocity: [-0.1 * rate, 0.0, 0.0] }
}
