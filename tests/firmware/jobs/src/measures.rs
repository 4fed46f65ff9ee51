//! What a program reads from a scene: tensions, the reaction at a pin, energies, momenta and the error bounds. Their
//! bits count too.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

const PARTICLES: usize = 12;

crate::job::both_precisions!("measures", PARTICLES, PARTICLES - 1, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, PARTICLES)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for _ in 0..48 {
        let report = scene.step(&mut euler)?;
        expect(report.lower <= report.upper, "bounds in order")?;
        let springs = scene.springs();
        for j in 0..PARTICLES - 1 {
            trace.number(springs.tension_of(j));
        }
        for x in scene.reaction(0, &euler.forces).unwrap_or_default() {
            trace.number(x);
        }
        let state = scene.state();
        for x in [state.linear_momentum(), state.angular_momentum(), state.centre_of_mass()].as_flattened() {
            trace.number(*x);
        }
        for x in [springs.kinetic_energy(), springs.potential_energy(), report.upper, report.lower] {
            trace.number(x);
        }
        trace.step(scene, &report)?;
    }
    Ok(())
}
