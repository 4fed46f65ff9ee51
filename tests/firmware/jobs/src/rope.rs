//! A hanging rope of 30 particles: the job that also runs in the 16 KiB of a micro:bit.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

/// Particles of the rope.
pub const PARTICLES: usize = 30;

crate::job::both_precisions!("rope", PARTICLES, PARTICLES - 1, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, PARTICLES)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for _ in 0..60 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
