//! The ends of the ranges of dt, k, m, coordinates and the numbers themselves.

use super::super::case::{Case, Fact};
use super::{cloth, every, heavy, line, named, resting_at, scaled, stiff, weightless};
use crate::scene::Model;

/// Far away.
const FAR: f64 = 1e8;

/// The cases.
pub const CASES: &[Case] = &[
    Case::new("dt-1e-9", "a cloth, steps of 1e-9 s", |_| every(cloth(), 1e-9)),
    Case::new("dt-1e-6", "steps of 1e-6 s", |_| every(cloth(), 1e-6)),
    Case::new("dt-1e-3", "steps of 1e-3 s", |_| every(cloth(), 1e-3)),
    Case::new("dt-1", "steps of 1 s", |_| every(cloth(), 1.0)),
    Case::new("dt-1e3", "steps of 1e3 s", |_| every(cloth(), 1e3)),
    Case::new("dt-1e3-free", "the same, a free spinning block", |_| every(named("lattice:3x3x3"), 1e3)),
    Case::new("k-0", "a cloth whose springs have no stiffness", |_| stiff(cloth(), 0.0)),
    Case::new("k-1e-6", "1e-6 N/m", |_| stiff(cloth(), 1e-6)),
    Case::new("k-1e6", "1e6 N/m", |_| stiff(cloth(), 1e6)),
    Case::new("k-1e12", "1e12 N/m", |_| stiff(cloth(), 1e12)),
    Case::new("k-1e-6-to-1e12", "1e-6 and 1e12 N/m in turn", |_| {
        let mut model = cloth();
        for (j, spring) in model.springs.iter_mut().enumerate() {
            spring.stiffness = if j % 2 == 0 { 1e-6 } else { 1e12 };
        }
        model
    }),
    Case::new("m-1e-9", "masses of 1e-9 kg", |_| heavy(cloth(), 1e-9)),
    Case::new("m-1e9", "masses of 1e9 kg", |_| heavy(cloth(), 1e9)),
    Case::new("m-1e-9-to-1e9", "a chain of masses from 1e-9 to 1e9 kg, the heaviest last", |_| masses(false)),
    Case::new("m-1e9-to-1e-9", "the same the other way round", |_| masses(true)),
    Case::new("stiff-light-long", "1e12 N/m, 1e-9 kg, steps of 1e3 s", |_| {
        every(heavy(stiff(cloth(), 1e12), 1e-9), 1e3)
    }),
    Case::new("stiff-light-long-free", "the same, a free spinning block", |_| {
        every(heavy(stiff(named("lattice:3x3x3"), 1e12), 1e-9), 1e3)
    }),
    Case::new("soft-heavy-short", "1e-6 N/m, 1e9 kg, steps of 1e-9 s", |_| {
        every(heavy(stiff(cloth(), 1e-6), 1e9), 1e-9)
    }),
    Case::new("gravity-1e9", "gravity of 1e9 m/s²", |_| {
        let mut model = cloth();
        model.gravity = [0.0, -1e9, 0.0];
        model
    }),
    Case::with("offset-1e8", "a cloth 1e8 m from the origin", Fact::Offset(FAR), |_| cloth()),
    Case::with("offset-1e8-free", "a free spinning block 1e8 m from the origin", Fact::Offset(FAR), |_| {
        named("lattice:3x3x3")
    }),
    Case::with("offset-1e4", "a cloth 1e4 m from the origin", Fact::Offset(1e4), |_| cloth()),
    Case::new("subnormal-lengths", "a cloth of 1e-310 m (0 in f32)", |_| small(1e-310)),
    Case::new("subnormal-lengths-f32", "a cloth of 1e-40 m (subnormal in f32)", |_| small(1e-40)),
    Case::new("lengths-1e-160", "a cloth of 1e-160 m: squares of lengths underflow", |_| small(1e-160)),
    Case::new("subnormal-masses", "masses of 1e-310 kg (no mass in f32: refused)", |_| {
        heavy(cloth(), 1e-310)
    }),
    Case::new("subnormal-masses-f32", "masses of 1e-40 kg (subnormal in f32)", |_| heavy(cloth(), 1e-40)),
    Case::new("subnormal-stiffness", "1e-310 and 1e-40 N/m in turn", |_| {
        let mut model = cloth();
        for (j, spring) in model.springs.iter_mut().enumerate() {
            spring.stiffness = if j % 2 == 0 { 1e-310 } else { 1e-40 };
        }
        model
    }),
    Case::new("subnormal-velocities", "velocities of 1e-310 and 1e-40 m/s, no gravity", |_| {
        let mut model = weightless(cloth());
        for (i, v) in model.velocity.iter_mut().enumerate() {
            *v = if i % 2 == 0 { [1e-310, 0.0, 1e-40] } else { [0.0, -1e-40, 0.0] };
        }
        model
    }),
    Case::new("lengths-1e18", "a cloth of 1e18 m: squares are near the end of f32", |_| large(1e18)),
    Case::new("lengths-1e25", "a cloth of 1e25 m: squares are beyond f32", |_| large(1e25)),
    Case::new("lengths-1e160", "a cloth of 1e160 m: squares are beyond f64 (refused in f32)", |_| {
        large(1e160)
    }),
];

/// A cloth so large, at rest lengths that fit, slightly stretched.
fn large(size: f64) -> Model {
    let mut model = scaled(cloth(), size);
    for spring in &mut model.springs {
        spring.rest_length *= 0.99 * size;
    }
    model
}

/// A cloth so small, at rest lengths that fit, not weighed down.
fn small(size: f64) -> Model {
    weightless(large(size))
}

/// Masses a thousand times as heavy from one to the next.
fn masses(reversed: bool) -> Model {
    let mut model = resting_at(line(&[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7], 1.0, 1e3), 0.1);
    for (i, mass) in model.mass.iter_mut().enumerate() {
        let power = if reversed { 7 - i } else { i };
        *mass = [1e-9, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9][power];
    }
    model
}
