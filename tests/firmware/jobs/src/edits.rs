//! Changing k, l₀, m, a position and a velocity while running.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::Outcome;
use crate::scenes::{dt, gravity, hang, real, vector};
use crate::trace::Trace;

crate::job::both_precisions!("edits", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for tick in 0..60 {
        match tick {
            10 => scene.set_stiffness(4, real(150.0))?,
            20 => scene.set_rest_length(2, real(0.15))?,
            30 => scene.set_mass(11, real(0.05))?,
            40 => scene.impulse(8, vector(0.0, 0.02, 0.01))?,
            45 => scene.set_velocity(9, vector(0.0, 0.0, 0.5))?,
            50 => scene.set_position(0, vector(0.0, 0.05, 0.0))?,
            _ => {}
        }
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
    }
    Ok(())
}
