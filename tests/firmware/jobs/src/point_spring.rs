//! A spring to a point in space, which follows a path as a mouse or a hand would, and is compressed on the way.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, PointSpring};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, real, vector};
use crate::trace::Trace;

crate::job::both_precisions!("point-spring", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let hand = PointSpring::new(11, vector(1.1, 0.0, 0.0), real(80.0)).rest_length(real(0.2));
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity()).with(hand);
    for tick in 0..48 {
        euler.forces.1.target = vector(1.1 - 0.02 * tick as f64, 0.01 * tick as f64, 0.0);
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
