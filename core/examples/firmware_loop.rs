//! A firmware engineer's first hour, on the host: a hanging rope in static memory, stepped at a fixed rate with a hard
//! budget, its top moved by a "sensor", and the force that a hand holding it would feel.
//!
//! `cargo run -p hooke --example firmware_loop`

use hooke::{LinearlyImplicitEuler, Motion, Scene};
use static_cell::ConstStaticCell;

const LINKS: usize = 24;
const DT: f32 = 1.0 / 100.0;

// In .bss: the scene never crosses the stack, however large it is.
static ROPE: ConstStaticCell<Scene<f32, { LINKS + 1 }, LINKS>> = ConstStaticCell::new(Scene::new());

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rope = ROPE.take();
    let mut above = rope.particle([0.0, 0.0, 0.0], 0.005)?;
    rope.pin(above)?;
    for link in 1..=LINKS {
        let below = rope.particle([0.0, -0.04 * link as f32, 0.0], 0.005)?;
        rope.spring(above, below, 500.0)?;
        above = below;
    }

    // "At most 12 iterations a step, and tell me the bound you reached": the time of a step is bounded.
    let mut euler = LinearlyImplicitEuler::new(DT).gravity([0.0, -9.81, 0.0]).max_iterations(12);
    for tick in 1..=300 {
        let (position, velocity) = sensor(tick);
        let report = rope.step_moving(&mut euler, &[Motion { particle: 0, position, velocity }])?;
        if tick % 60 == 0 {
            let feel = rope.reaction(0, &euler.forces).unwrap_or_default();
            let tip = rope.positions()[LINKS];
            println!(
                "t = {:.2} s  tip ({:+.3}, {:+.3}) m  hand holds ({:+.3}, {:+.3}) N (its own bead too), top link {:.3} N  \
                 {:2} iterations{}, error at most {:.1e} J",
                tick as f32 * DT,
                tip[0],
                tip[1],
                feel[0],
                feel[1],
                rope.springs().tension_of(0),
                report.iterations,
                if report.capped > 0 { " (the budget)" } else { "" },
                report.upper,
            );
        }
    }
    Ok(())
}

/// Where the top of the rope is held, and how fast it moves: here a hand that sways and comes to rest after 2 s.
fn sensor(tick: u32) -> ([f32; 3], [f32; 3]) {
    let t = tick as f32 * DT;
    let omega = core::f32::consts::TAU;
    if t >= 2.0 {
        return ([0.0; 3], [0.0; 3]);
    }
    ([0.1 * (omega * t).sin(), 0.0, 0.0], [0.1 * omega * (omega * t).cos(), 0.0, 0.0])
}
