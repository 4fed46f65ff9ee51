//! What a haptic device does: it moves the handle to where the user's hand is, and plays back the force that the handle
//! exerts on the hand, with the tension in the link beside it.
//!
//! `cargo run -p hooke --example haptic`

use hooke::{Drag, EditError, LinearlyImplicitEuler, Motion, Scene};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 12;
type Rope = Scene<f32, PARTICLES, { PARTICLES - 1 }>;
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());

/// A haptic loop runs at about 1 kHz, or a stiff thing feels soft.
const DT: f32 = 1.0 / 1000.0;
const HANDLE: usize = 0;
const WALL: usize = PARTICLES - 1;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rope = ROPE.take(); // on a device `try_take`, whose failure is yours to handle
    stretch(rope)?;
    let mut euler =
        LinearlyImplicitEuler::new(DT).gravity([0.0, -9.81, 0.0]).with(Drag(2.0)).max_iterations(8);

    for tick in 1..=1000_u16 {
        let motion = hand(f32::from(tick) * DT);
        let report = rope.step_moving(&mut euler, &[motion])?;

        // The force that holds the handle against springs, weight and drag: what the hand must do. The device pushes
        // back with its opposite. O(springs), and only where it is asked for.
        let Some(holds) = rope.reaction(HANDLE, &euler.forces) else { continue };
        let felt = holds.map(|f| -f);
        if tick % 200 == 0 {
            println!(
                "t = {:.1} s: hand at ({:+.3}, {:+.3}) m feels ({:+.3}, {:+.3}) N; tension at the hand {:.3} N, at the wall \
                 {:.3} N; error at most {:.0e} J",
                f32::from(tick) * DT,
                motion.position[0],
                motion.position[1],
                felt[0],
                felt[1],
                rope.springs().tension_of(0),
                rope.springs().tension_of(PARTICLES - 2),
                report.upper,
            );
        }
    }
    Ok(())
}

/// Where the hand is t seconds after it took hold, and how fast it moves: 0.1 m away from the wall in a second, softly.
fn hand(t: f32) -> Motion<f32> {
    let soft = t * t * (3.0 - 2.0 * t);
    let rate = 6.0 * t * (1.0 - t);
    Motion { particle: HANDLE, position: [-0.1 * soft, 0.0, 0.0], velocity: [-0.1 * rate, 0.0, 0.0] }
}

/// An elastic band of 0.44 m between the handle and a wall.
fn stretch(rope: &mut Rope) -> Result<(), EditError> {
    let mut left = rope.particle([0.0, 0.0, 0.0], 0.002)?; // m, kg
    for i in 1..PARTICLES {
        let right = rope.particle([0.04 * i as f32, 0.0, 0.0], 0.002)?;
        rope.spring(left, right, 80.0)?; // N/m; rest length: as placed
        left = right;
    }
    rope.pin(HANDLE)?;
    rope.pin(WALL)
}
