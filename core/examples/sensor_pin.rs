//! A pin that follows a sensor. Once the sensor delivers NaN: the step is refused, the scene is as it was, and the loop
//! goes on with the last good reading.
//!
//! `cargo run -p hooke --example sensor_pin`

use hooke::{EditError, LinearlyImplicitEuler, Motion, Scene, StepError};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 16;
type Rope = Scene<f32, PARTICLES, { PARTICLES - 1 }>;
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());

const DT: f32 = 1.0 / 100.0;
/// The particle that the sensor moves.
const HAND: usize = 0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rope = ROPE.take(); // on a device `try_take`, whose failure is yours to handle
    hang(rope)?;
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
                    "tick {tick}: reading {position:?} of pin {pin} refused; held at {:?} m",
                    held.position
                );
                // Nothing has happened in that step, so it is taken again: the pin rests where it was last seen.
                held.velocity = [0.0; 3];
                rope.step_moving(&mut euler, &[held])?;
            }
            Err(other) => return Err(other.into()),
        }
        if tick % 40 == 0 {
            let (hand, tip) = (rope.positions()[HAND], rope.positions()[PARTICLES - 1]);
            println!("tick {tick}: hand at {:+.3} m, tip at ({:+.3}, {:+.3}) m", hand[0], tip[0], tip[1]);
        }
    }
    Ok(())
}

/// Where the hand is, m: it sways by 0.1 m once a second. A wire comes loose for one reading.
fn sensor(tick: u16) -> [f32; 3] {
    if tick == 77 {
        return [f32::NAN; 3];
    }
    [0.1 * (core::f32::consts::TAU * DT * f32::from(tick)).sin(), 0.0, 0.0]
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
