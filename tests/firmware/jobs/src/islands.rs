//! Several islands: two ropes on one pin, a loose rope thrown up, and one that rests where no force acts on it.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, PointForce};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, hang, line, real, vector};
use crate::trace::Trace;

crate::job::both_precisions!("islands", 24, 21, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 8)?;
    let below = line(scene, 8, -0.1)?;
    scene.spring(0, below, real(500.0))?;
    let thrown = line(scene, 5, -0.5)?;
    line(scene, 3, -0.9)?;
    scene.set_velocity(thrown + 2, vector(0.0, 3.0, 0.0))?;
    let load = |particle| PointForce { particle, force: vector(0.0, -0.4, 0.1) };
    let mut euler = LinearlyImplicitEuler::new(dt()).with(load(7)).with(load(15));
    for _ in 0..48 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
        expect(report.islands == 4, "four islands")?;
        expect(report.untouched >= 1, "an island at rest that needs no iteration")?;
    }
    Ok(())
}
