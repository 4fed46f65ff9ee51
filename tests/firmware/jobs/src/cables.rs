//! Cables, which only pull, beside springs: thrown up, some of them go slack.

use hooke::{LinearlyImplicitEuler, MassSpring, Memory, Mixed, Spring};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, real, vector};
use crate::trace::Trace;

const PARTICLES: usize = 12;

crate::job::both_precisions!("cables", PARTICLES, PARTICLES - 1, Mixed);

fn run<M: Memory<Law = Mixed>>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    for i in 0..PARTICLES {
        scene.particle(vector(0.0, -0.1 * i as f64, 0.01 * (i % 2) as f64), real(0.01))?;
        if i > 0 {
            let spring = Spring { stiffness: real(1000.0), rest_length: real(0.1) };
            _ = if i % 3 == 0 {
                scene.spring_with(i - 1, i, spring)?
            } else {
                scene.cable(i - 1, i, spring)?
            };
        }
    }
    scene.pin(0)?;
    scene.impulse(PARTICLES - 1, vector(0.01, 0.06, 0.0))?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    let mut slack = false;
    for _ in 0..60 {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
        let springs = scene.springs();
        slack |= (0..PARTICLES - 1).any(|j| springs.strain_of(j).is_some_and(|s| s < real(-0.001)));
    }
    expect(slack, "a slack cable")
}
