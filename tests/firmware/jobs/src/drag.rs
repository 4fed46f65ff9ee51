//! Drag: every particle is slowed by the air.

use hooke::{Drag, Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, real};
use crate::trace::Trace;

crate::job::both_precisions!("drag", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity()).with(Drag(real(0.7)));
    for _ in 0..48 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
