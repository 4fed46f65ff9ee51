//! A compressed cloth at a long step: some Hessians are indefinite and must be clamped.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, Real};

use crate::outcome::{Outcome, expect};
use crate::scenes::{self, cloth_springs, dt, gravity, real};
use crate::trace::Trace;

const SIDE: usize = 5;

crate::job::both_precisions!("clamping", SIDE * SIDE, cloth_springs(SIDE), Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    scenes::cloth(scene, SIDE)?;
    for i in 0..SIDE * SIDE {
        let Some([x, _, z]) = scene.positions().get(i).copied() else { continue };
        let bulge = real::<M::Real>(0.01) * M::Real::from_count(i % 4);
        scene.set_position(i, [x * real(0.7), bulge, z * real(0.7)])?;
    }
    scene.pin(0)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    let mut clamped = 0;
    for _ in 0..48 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
        clamped += report.clamped;
    }
    expect(clamped > 0, "a clamped spring")
}
