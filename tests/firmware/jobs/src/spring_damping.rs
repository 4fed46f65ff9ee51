//! Damping along the springs, of each spring its own.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, Real, SpringDamping};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, real};
use crate::trace::Trace;

crate::job::both_precisions!("spring-damping", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut damping = [M::Real::ZERO; 11];
    for (j, c) in damping.iter_mut().enumerate() {
        *c = real(0.25 * (j % 4) as f64);
    }
    let damping = SpringDamping(damping.as_slice());
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity()).with(damping);
    for _ in 0..48 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
