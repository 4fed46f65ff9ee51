//! What is joined with what: free bodies, lone particles, pins everywhere, long chains, cliques, hubs.

use super::super::case::{Case, Fact, Size};
use super::{cloth, line, named, scaled, weightless};
use crate::scene::Model;

/// The cases.
pub const CASES: &[Case] = &[
    Case::with("free-at-rest", "a free block at rest, no force: no bit may change", Fact::AtRest, |_| {
        let mut model = at_rest("lattice:3x3x3");
        // Lengths that are exactly the rest lengths in both precisions.
        model.position.iter_mut().flatten().for_each(|x| *x = (*x * 10.0).round());
        keep_axes(&mut model);
        model
    }),
    Case::with("held-at-rest", "a weightless cloth at rest: no bit may change", Fact::AtRest, |_| {
        let mut model = at_rest("cloth:6");
        model.position.iter_mut().flatten().for_each(|x| *x = (*x * 5.0).round());
        keep_axes(&mut model);
        model
    }),
    Case::new("free-spinning", "a free block, 2 rad/s", |_| named("lattice:3x3x3")),
    Case::new("free-falling", "a free block, spinning and falling", |_| {
        let mut model = named("lattice:3x3x3");
        model.gravity = [0.0, -9.81, 0.0];
        model
    }),
    Case::new("free-pair", "two particles that orbit each other", |_| named("pair")),
    Case::new("free-compressed", "a free block pressed to a half", |_| scaled(named("lattice:3x3x3"), 0.5)),
    Case::new("free-heavy-and-light", "a free block, one particle 1e12 times as heavy", |_| {
        let mut model = named("lattice:3x3x3");
        model.mass[13] = 1e10;
        model
    }),
    Case::new("lone-particles", "five particles without springs", |_| {
        let mut model = Model::at_rest("lone", (0..5).map(|i| [f64::from(i), 0.0, 0.0]).collect(), 0.1);
        model.velocity[3] = [1.0, 2.0, 3.0];
        model
    }),
    Case::new("two-bodies", "two free blocks, a pendulum and a lone particle: four islands", |_| {
        two_bodies()
    }),
    Case::new("pinned-but-one", "a cloth with all but one particle pinned", |_| {
        let mut model = cloth();
        model.pinned.fill(true);
        model.pinned[14] = false;
        model
    }),
    Case::with("all-pinned", "a cloth with all particles pinned", Fact::AtRest, |_| {
        let mut model = cloth();
        model.pinned.fill(true);
        model
    }),
    Case::new("chain-long", "a chain of 1e5 particles (1e3 if quick)", |size| {
        named(size.pick("chain:1000", "chain:100000"))
    }),
    Case::new("clique", "every particle joined with every other, 40 of them (12 if quick)", |size| {
        clique(size.pick(12, 40), 1.0)
    }),
    Case::new("clique-compressed", "the same, pressed to a tenth", |size| clique(size.pick(12, 40), 0.1)),
    Case::new("hub", "one particle joined with 400 others (60 if quick)", hub),
    Case::new("parallel", "30 springs of different length between two particles", |_| {
        let mut model = line(&[0.0, 1.0], 0.1, 1.0);
        for i in 0..30 {
            model.join(0, 1, 100.0);
            model.springs[i].rest_length = 0.1 * i as f64;
        }
        model
    }),
];

/// A scene of the catalogue, without gravity and velocity.
fn at_rest(name: &str) -> Model {
    let mut model = weightless(named(name));
    model.velocity.fill([0.0; 3]);
    model
}

/// Keeps the springs along axes, at rest as placed.
fn keep_axes(model: &mut Model) {
    let springs = std::mem::take(&mut model.springs);
    for spring in springs {
        let [a, b] = spring.ends;
        let differs = (0..3).filter(|c| model.position[a][*c] != model.position[b][*c]);
        if differs.count() == 1 {
            model.join(a, b, spring.stiffness);
        }
    }
}

fn two_bodies() -> Model {
    let mut model = named("lattice:2x2x2");
    let body = model.clone();
    for (k, by) in [(8, [1.0, 0.0, 0.0]), (16, [0.0, 3.0, 0.0])] {
        let moved = body.position.iter().map(|x| std::array::from_fn(|c| x[c] + by[c]));
        model.position.extend(moved);
        model.velocity.extend(body.velocity.iter().map(|v| [-v[0], v[1], 0.1]));
        model.mass.extend(&body.mass);
        model.pinned.extend([false; 8]);
        let joined = body.springs.iter().map(|spring| {
            let mut spring = *spring;
            spring.ends = spring.ends.map(|i| i + k);
            spring
        });
        model.springs.extend(joined);
    }
    // Of the third one is pinned, one is alone.
    model.pinned[16] = true;
    model.springs.retain(|spring| !spring.ends.contains(&23));
    model.gravity = [0.0, -9.81, 0.0];
    model
}

fn clique(n: usize, size: f64) -> Model {
    // On a spiral, so that no four are in a plane by chance.
    let place = |i: usize| {
        let t = i as f64;
        [0.05 * t * (0.9 * t).cos(), 0.05 * t * (0.9 * t).sin(), 0.03 * t]
    };
    let mut model = Model::at_rest("clique", (0..n).map(place).collect(), 0.01);
    for a in 0..n {
        for b in a + 1..n {
            model.join(a, b, 1e4);
        }
    }
    model.pinned[0] = true;
    scaled(model, size)
}

fn hub(size: Size) -> Model {
    let n = size.pick(60, 400);
    let place = |i: usize| {
        let t = i as f64;
        if i == 0 { [0.0; 3] } else { [(2.4 * t).cos(), 0.01 * t, (2.4 * t).sin()] }
    };
    let mut model = Model::at_rest("hub", (0..=n).map(place).collect(), 0.01);
    for i in 1..=n {
        model.join(0, i, 1e4);
        model.pinned[i] = i % 2 == 0;
    }
    model
}
