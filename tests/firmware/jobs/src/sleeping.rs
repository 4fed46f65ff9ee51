//! Two ropes in the air come to rest and are skipped; one is pushed, wakes, and comes to rest again.

use hooke::{Drag, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Real, Sleeping};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang, line, real, vector};
use crate::trace::Trace;

const PARTICLES: usize = 6;
const SPRINGS: usize = 5;
const NEEDS: (usize, usize) = Sleeping::needs(PARTICLES, SPRINGS);

crate::job::both_precisions!("sleeping", PARTICLES, SPRINGS, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 3)?;
    let second = line(scene, 3, -0.5)?;
    scene.spring(0, second, real(500.0))?;
    let joules = real(1e-4);
    let sleeping = Sleeping::new(joules, [M::Real::ZERO; NEEDS.0], [0; NEEDS.1]);
    let mut euler = LinearlyImplicitEuler::new(dt())
        .gravity(gravity())
        .with(Drag(real(6.0)))
        .absolute(joules)
        .sleeping(sleeping);
    for push in [false, true] {
        if push {
            scene.impulse(2, vector(0.0, 0.0, 0.01))?;
        }
        let mut seen = [false; 2];
        for step in 0..72 {
            let report = scene.step(&mut euler)?;
            trace.step(scene, &report)?;
            expect(!push || step > 0 || report.asleep == 1, "one that wakes, and one that does not")?;
            seen = [seen[0] || report.asleep == 1, report.asleep == 2];
        }
        expect(seen == [true; 2], "islands asleep, first one and then both")?;
    }
    Ok(())
}
