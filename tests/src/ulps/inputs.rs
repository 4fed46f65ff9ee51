//! Springs to measure on: random ones; neighbouring floats and cancellation; huge, tiny and subnormal ones; those of scenes.

use hooke::Real;

use crate::build;
use crate::generate;
use crate::random::Random;

/// Kinds of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Components within a few decades of one another
    Random,
    /// Length and rest length a few floats apart; components a few floats apart, or of opposite size
    Neighbours,
    /// Up to a quarter of the exponents' range up or down
    HugeOrTiny,
    /// |Δx|² near the smallest normal number, components subnormal or 0
    Edge,
    /// Springs of a cloth, a blob and a lattice in motion
    Scenes,
}

/// All of them.
pub const KINDS: [Kind; 5] = [Kind::Random, Kind::Neighbours, Kind::HugeOrTiny, Kind::Edge, Kind::Scenes];

/// One spring as it enters a step.
#[derive(Debug, Clone, Copy)]
pub struct Input<T> {
    /// Δx
    pub delta: [T; 3],
    /// k
    pub k: T,
    /// l₀
    pub l0: T,
    /// s
    pub stiffness: T,
    /// θh
    pub damping: T,
    /// c
    pub c: T,
}

fn double(x: f64, random: &mut Random) -> f64 {
    if random.chance(0.5) { -x } else { x }
}

/// The float n places away.
fn neighbour<T: Real>(x: T, n: i64) -> T {
    let places = |x: f64| x * (1.0 + n as f64 * 2.0 * T::UNIT_ROUNDOFF.to_f64());
    T::from_f64(places(x.to_f64()))
}

/// So many springs of a kind.
pub fn inputs<T: Real>(kind: Kind, count: usize, seed: u64) -> Vec<Input<T>> {
    let mut random = Random::new(seed);
    if kind == Kind::Scenes {
        return scenes(count, &mut random);
    }
    (0..count).map(|_| one(kind, &mut random)).collect()
}

fn one<T: Real>(kind: Kind, random: &mut Random) -> Input<T> {
    let real = T::from_f64;
    let least = T::MIN_POSITIVE.to_f64();
    let mut delta = [0; 3].map(|_| {
        let x = random.decade(1e-3, 10.0);
        real(double(x, random))
    });
    let mut k = real(random.decade(1e-3, 1e6));
    let near = |random: &mut Random| random.below(9) as i64 - 4;
    match kind {
        Kind::Neighbours => {
            // Components that are floats next to one another, whose squares all round the same way, or that differ by 2^p.
            match random.below(3) {
                0 => delta = [0; 3].map(|_| neighbour(delta[0], near(random))),
                1 => delta[1] = real(delta[0].to_f64() * 2f64.powi(random.below(30) as i32 - 15)),
                _ => delta[random.below(3)] = T::ZERO,
            }
        }
        Kind::HugeOrTiny => {
            let by = least.powf(random.between(-0.22, 0.22));
            delta = delta.map(|x| real(x.to_f64() * by));
            k = real(random.decade(1e-3, 1e6) * least.powf(random.between(-0.2, 0.2)));
        }
        Kind::Edge => {
            let by = least.sqrt() * random.between(0.3, 3.0);
            delta = [0; 3].map(|_| {
                let x = by * [1.0, 1e-3, 1e-12, 0.0][random.below(4)] * random.between(0.3, 1.0);
                real(double(x, random))
            });
        }
        Kind::Random | Kind::Scenes => {}
    }
    let length = delta.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt();
    let l0 = match random.below(4) {
        0 => neighbour(real(length), near(random)),
        1 if kind != Kind::Neighbours => T::ZERO,
        _ if kind == Kind::Neighbours => neighbour(real(length), near(random) * near(random)),
        _ => real(length * random.decade(0.01, 10.0)),
    };
    let h = random.decade(1e-4, 1.0);
    let c = if random.chance(0.5) { 0.0 } else { k.to_f64() * random.decade(1e-3, 1.0) };
    Input { delta, k, l0, stiffness: real(h * h), damping: real(h), c: real(c) }
}

/// Springs of scenes some steps after rest.
fn scenes<T: Real>(count: usize, random: &mut Random) -> Vec<Input<T>> {
    let mut all = Vec::new();
    for mut data in [generate::cloth(16), generate::blob(5, 7), generate::lattice(5, 5, 5)] {
        data.springs.iter_mut().for_each(|s| s.c = random.decade(1e-3, 1.0));
        let mut scene = build::scene::<T>(&data);
        let mut forces = build::Forces::<T>::new(&data);
        let h = T::from_f64(1.0 / 60.0);
        let mut euler = forces.euler(h);
        for _ in 0..8 {
            scene.step(&mut euler).expect("a step of a reference scene");
            let x = scene.positions();
            for s in &data.springs {
                let delta = [0, 1, 2].map(|d| x[s.a][d] - x[s.b][d]);
                let real = T::from_f64;
                let (k, l0, c) = (real(s.k), real(s.l0), real(s.c));
                all.push(Input { delta, k, l0, stiffness: h * h, damping: h, c });
            }
        }
    }
    (0..count).map(|_| all[random.below(all.len())]).collect()
}
