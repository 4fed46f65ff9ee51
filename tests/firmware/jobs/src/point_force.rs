//! A force on one particle, which changes between steps.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, PointForce};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, vector};
use crate::trace::Trace;

crate::job::both_precisions!("point-force", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let thruster = PointForce { particle: 7, force: vector(0.0, 0.0, 0.0) };
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity()).with(thruster);
    for tick in 0..48 {
        euler.forces.1.force = if tick % 16 < 8 { vector(0.0, 1.5, 0.5) } else { vector(0.3, 0.0, -0.5) };
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
