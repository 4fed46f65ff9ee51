//! A pin that a sensor moves: to and fro along a parabola, then at rest.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, Motion};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, vector};
use crate::trace::Trace;

crate::job::both_precisions!("moving-pin", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for tick in 1..=40 {
        // x = t(40 − t)/2000 m at tick t, and its derivative in m/s (60 ticks a second).
        let t = f64::from(tick);
        let motion = Motion {
            particle: 0,
            position: vector(t * (40.0 - t) / 2000.0, 0.0, 0.0),
            velocity: vector((40.0 - 2.0 * t) / 2000.0 * 60.0, 0.0, 0.0),
        };
        let report = scene.step_moving(&mut euler, &[motion])?;
        trace.step(scene, &report)?;
    }
    for _ in 0..20 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
