//! Springs of no length, of next to none, far too short and far too long.

use super::super::case::Case;
use super::{cloth, line, named, resting_at, scaled, stiff};
use crate::scene::Model;

/// The cases.
pub const CASES: &[Case] = &[
    Case::new("zero-length", "three springs of a cloth have no length, but a rest length", |_| {
        let mut model = cloth();
        for (i, j) in [(14, 15), (20, 21), (21, 27)] {
            model.position[i] = model.position[j];
        }
        model
    }),
    Case::new(
        "near-zero-lengths",
        "lengths 1e-300, 1e-160, 1e-40, 1e-20 and 1e-8 m, rest lengths 1 m",
        |_| resting_at(line(&[0.0, 1e-300, 1e-160, 1e-40, 1e-20, 1e-8], 0.01, 1e3), 1.0),
    ),
    Case::new("coincident", "all 16 particles of a net in one place, springs with rest lengths", |_| {
        scaled(named("net:4"), 0.0)
    }),
    Case::new("coincident-moving", "the same, each with another velocity", |_| {
        let mut model = scaled(named("net:4"), 0.0);
        for (i, v) in model.velocity.iter_mut().enumerate() {
            *v = [0.1 * i as f64, 1.0 - 0.2 * i as f64, 0.3];
        }
        model
    }),
    Case::new("rest-length-0", "a cloth whose springs rest at length 0: a linear system", |_| {
        resting_at(cloth(), 0.0)
    }),
    Case::new("point-of-rest-length-0", "the same, all particles in one place", |_| {
        scaled(resting_at(cloth(), 0.0), 0.0)
    }),
    Case::new("compressed-10", "a cloth pressed to a tenth of its size, in its plane", |_| {
        scaled(cloth(), 0.1)
    }),
    Case::new("compressed-1000", "a stiff net pressed to a thousandth", |_| scaled(named("net:6"), 1e-3)),
    Case::new(
        "compressed-crumpled",
        "a net pressed to a tenth, each particle a little off its place",
        |_| {
            let mut model = scaled(named("net:6"), 0.1);
            for (i, x) in model.position.iter_mut().enumerate() {
                // No two alike, the same on every machine.
                *x = std::array::from_fn(|c| x[c] + 0.003 * ((i * (3 + 4 * c) + c) % 11) as f64);
            }
            model
        },
    ),
    Case::new("compressed-line", "a straight chain pressed to half its length: a saddle", |_| {
        let at: Vec<f64> = (0..12).map(|i| 0.05 * f64::from(i)).collect();
        let mut model = resting_at(line(&at, 0.01, 1e4), 0.1);
        model.pinned[11] = true;
        model.gravity = [0.0; 3];
        model
    }),
    Case::new("stretched-1e6", "a cloth stretched 1e6 times", |_| scaled(cloth(), 1e6)),
    Case::new("stretched-1e6-stiff", "the same with 1e9 N/m", |_| stiff(scaled(cloth(), 1e6), 1e9)),
    Case::new("one-stretched-1e6", "one particle of a cloth pulled 1e6 times a spring's length away", |_| {
        let mut model = cloth();
        model.position[21] = [0.6, 2e5, 0.6];
        model
    }),
    Case::new("next-to-a-kilometre", "springs of 1e-6 m beside springs of 1e3 m", |_| {
        line(&[0.0, 1e-6, 1e3, 1e3 + 1e-6, 2e3, 2e3 + 1e-6], 0.01, 1e3)
    }),
    Case::new("cables-folded", "cables in one place and others stretched, under gravity", |_| cables()),
];

/// A cloth of cables, half of it folded onto itself.
fn cables() -> Model {
    let mut model = cloth();
    model.springs.iter_mut().for_each(|spring| spring.cable = true);
    for i in 0..model.position.len() {
        if model.position[i][2] > 0.5 {
            model.position[i] = [0.3, -0.2, 0.3];
        }
    }
    model
}
