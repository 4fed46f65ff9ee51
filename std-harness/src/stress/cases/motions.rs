//! What moves fast: spin, flight, collisions, pins that jump; and what damps hard.

use super::super::case::Case;
use super::{cloth, every, named, weightless};
use crate::scene::{Model, Moving, Path};

/// The cases.
pub const CASES: &[Case] = &[
    Case::new("spin-1e3", "a pair that turns at 1e3 rad/s", |_| spinning(1e3)),
    Case::new("spin-1e6", "a pair that turns at 1e6 rad/s", |_| spinning(1e6)),
    Case::new("spin-block", "a free block that turns at 1e4 rad/s", |_| {
        let mut model = named("lattice:3x3x3");
        model.velocity.iter_mut().flatten().for_each(|v| *v *= 5e3);
        model
    }),
    Case::new("flight-1e8", "one particle of a cloth at 1e8 m/s", |_| flying(1e8)),
    Case::new("flight-1e18", "one particle of a cloth at 1e18 m/s", |_| flying(1e18)),
    Case::new("flight-1e30", "one particle of a cloth at 1e30 m/s: energy is beyond f32", |_| flying(1e30)),
    Case::new("head-on", "two particles that fly through each other: the spring's length passes 0", |_| {
        let mut model = named("pair");
        // After a step of 1/64 s they are in one place, exactly, if no force acts.
        model.velocity = vec![[-32.0, 0.0, 0.0], [32.0, 0.0, 0.0]];
        model.springs[0].stiffness = 1e-3;
        every(model, 1.0 / 64.0)
    }),
    Case::new("head-on-stiff", "the same with 1e6 N/m", |_| {
        let mut model = named("pair");
        model.velocity = vec![[-32.0, 0.0, 0.0], [32.0, 0.0, 0.0]];
        model.springs[0].stiffness = 1e6;
        every(model, 1.0 / 64.0)
    }),
    Case::new("pin-jumps-1", "a pin of a cloth that jumps 1 m in a step and back", |_| jumping(1.0)),
    Case::new("pin-jumps-1e6", "the same, 1e6 m", |_| jumping(1e6)),
    Case::new("pin-jumps-1e30", "the same, 1e30 m", |_| jumping(1e30)),
    Case::new("pin-jumps-1e300", "the same, 1e300 m (no number in f32: refused)", |_| jumping(1e300)),
    Case::new("pin-shakes", "a pin that swings 0.1 m at 1e5 Hz", |_| {
        let path = Path::Oscillate { amplitude: [0.1, 0.05, 0.0], frequency: 1e5 };
        moving(cloth(), path)
    }),
    Case::new("pin-flees", "a pin that leaves at 1e5 m/s", |_| {
        moving(cloth(), Path::Linear { velocity: [1e5, 0.0, 0.0] })
    }),
    Case::new("damping-1e6", "1e6 N·s/m along every spring", |_| damped(1e6, 0.0)),
    Case::new("damping-1e12", "1e12 N·s/m along every spring", |_| damped(1e12, 0.0)),
    Case::new("drag-1e9", "drag of 1e9 /s", |_| damped(0.0, 1e9)),
    Case::new("syrup-long", "a damped cloth, steps of 10 s", |_| every(named("syrup:6"), 10.0)),
    Case::new("curtain", "the scene that hooke run draws, at four times its step", |_| {
        every(named("curtain"), 1.0 / 30.0)
    }),
];

fn spinning(rate: f64) -> Model {
    let mut model = named("pair");
    model.velocity = vec![[0.0, 0.5 * rate, 0.0], [0.0, -0.5 * rate, 0.0]];
    every(model, 1.0 / 60.0)
}

fn flying(speed: f64) -> Model {
    let mut model = weightless(cloth());
    model.velocity[21] = [0.0, speed, 0.0];
    model
}

fn moving(mut model: Model, path: Path) -> Model {
    model.moving = vec![Moving { particles: vec![0], path }];
    model
}

/// To and fro at every second step.
fn jumping(by: f64) -> Model {
    let model = cloth();
    let points =
        (0..60).map(|step| (f64::from(step) * model.dt, [0.0, if step % 2 == 1 { by } else { 0.0 }, 0.0]));
    let path = Path::Through { points: points.collect() };
    moving(model, path)
}

fn damped(along: f64, drag: f64) -> Model {
    let mut model = cloth();
    model.springs.iter_mut().for_each(|spring| spring.damping = along);
    model.drag = drag;
    for (i, v) in model.velocity.iter_mut().enumerate() {
        *v = [0.3 * (i % 5) as f64, 1.0, -0.2 * (i % 3) as f64];
    }
    model
}
