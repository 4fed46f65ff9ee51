//! An 8×8 cloth that swings down from two corners.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::Outcome;
use crate::scenes::{self, cloth_springs, dt, gravity};
use crate::trace::Trace;

const SIDE: usize = 8;

crate::job::both_precisions!("cloth", SIDE * SIDE, cloth_springs(SIDE), Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    scenes::cloth(scene, SIDE)?;
    scene.pin(0)?;
    scene.pin(SIDE - 1)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for _ in 0..24 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
