//! All cases, in the order of the table.

mod bodies;
mod lengths;
mod motions;
mod scales;

use super::case::Case;
use crate::scene::{Model, catalog};

/// All of them.
pub fn all() -> Vec<Case> {
    [lengths::CASES, scales::CASES, bodies::CASES, motions::CASES].concat()
}

/// A scene of the catalogue.
fn named(name: &str) -> Model {
    match catalog::named(name) {
        Some(Ok(model)) => model,
        // Each is tried by the tests.
        _ => unreachable!("{name} is a scene of the catalogue"),
    }
}

/// A cloth of 6×6, hanging on two corners.
fn cloth() -> Model {
    named("cloth:6")
}

/// The same with all positions shrunk or stretched, rest lengths as they were.
fn scaled(mut model: Model, factor: f64) -> Model {
    model.position.iter_mut().flatten().for_each(|x| *x *= factor);
    model
}

/// The same with another step.
fn every(mut model: Model, dt: f64) -> Model {
    model.dt = dt;
    model
}

/// The same with every spring this stiff.
fn stiff(mut model: Model, k: f64) -> Model {
    model.springs.iter_mut().for_each(|spring| spring.stiffness = k);
    model
}

/// The same with every particle this heavy.
fn heavy(mut model: Model, mass: f64) -> Model {
    model.mass.fill(mass);
    model
}

/// The same without gravity.
fn weightless(mut model: Model) -> Model {
    model.gravity = [0.0; 3];
    model
}

/// Particles on a line, springs between neighbours at rest as placed, the first pinned.
fn line(at: &[f64], mass: f64, k: f64) -> Model {
    let mut model = Model::at_rest("line", at.iter().map(|x| [*x, 0.0, 0.0]).collect(), mass);
    for i in 1..at.len() {
        model.join(i - 1, i, k);
    }
    model.pinned[0] = true;
    model
}

/// The same with all rest lengths this long.
fn resting_at(mut model: Model, rest_length: f64) -> Model {
    model.springs.iter_mut().for_each(|spring| spring.rest_length = rest_length);
    model
}
