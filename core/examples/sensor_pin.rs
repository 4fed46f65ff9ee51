//! A pin that follows a sensor. Once the sensor delivers NaN: the step is refused, the scene is as it was, and the loop
//! goes on with the last good reading.
//!
//! `cargo run -p hooke --example sensor_pin`, here; `tests/firmware/examples.sh`, on a Cortex-M4F.

use hooke::{EditError, LinearlyImplicitEuler, Motion, Scene, StepError};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 16;
type Rope = Scene<f32, PARTICLES, { PARTICLES - 1 }>;
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new()); // .bss

const DT: f32 = 1.0 / 100.0;
/// The particle that the sensor moves.
const HAND: usize = 0;

pub(crate) fn main() {
    let Some(rope) = ROPE.try_take() else { return };
    if let Err(refused) = hang(rope) {
        return println!("not built: {refused}");
    }
    if let Err(failed) = run(rope) {
        println!("stopped: {failed}");
    }
}

/// A rope of 0.6 m that hangs from the hand.
fn hang(rope: &mut Rope) -> Result<(), EditError> {
    let mut above = rope.particle([0.0, 0.0, 0.0], 0.005)?; // m, kg
    rope.pin(above)?;
    for i in 1..PARTICLES {
        let below = rope.particle([0.0, -0.04 * i as f32, 0.0], 0.005)?;
        rope.spring(above, below, 500.0)?; // N/m; rest length: as placed
        above = below;
    }
    Ok(())
}

fn run(rope: &mut Rope) -> Result<(), StepError> {
    let mut euler = LinearlyImplicitEuler::new(DT).gravity([0.0, -9.81, 0.0]);
    let mut held = Motion { particle: HAND, position: [0.0; 3], velocity: [0.0; 3] };
    for tick in 1..=200 {
        // A motion is given over the step: where the pin is at its end, and how fast it then moves.
        let position = sensor(tick);
        let velocity = [0, 1, 2].map(|d| (position[d] - held.position[d]) / DT);
        let motion = Motion { particle: HAND, position, velocity };
        match rope.step_moving(&mut euler, &[motion]) {
            Ok(_) => held = motion,
            Err(StepError::Motion(pin)) => {
                println!(
                    "tick {tick}: {position:?} refused for pin {pin}, which is held at {:?} m",
                    held.position
                );
                // That step has changed nothing, so it is taken again with the pin where it was last seen, at rest.
                held.velocity = [0.0; 3];
                rope.step_moving(&mut euler, &[held])?;
            }
            Err(other) => return Err(other),
        }
        if tick % 40 == 0 {
            let (hand, tip) = (rope.positions()[HAND], rope.positions()[PARTICLES - 1]);
            println!("tick {tick}: hand at {:+.3} m, tip at ({:+.3}, {:+.3}) m", hand[0], tip[0], tip[1]);
        }
    }
    Ok(())
}

/// Where the hand is, m: 0.1 m to and fro in a second, on parabolas. A wire comes loose for one reading.
fn sensor(tick: u16) -> [f32; 3] {
    if tick == 77 {
        return [f32::NAN; 3];
    }
    let (half, t) = (tick / 50, f32::from(tick % 50) / 50.0);
    let swing = 0.4 * t * (1.0 - t);
    [if half % 2 == 0 { swing } else { -swing }, 0.0, 0.0]
}
