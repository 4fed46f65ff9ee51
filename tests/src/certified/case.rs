//! Random systems: what a step's matrix A = M + hD + h²(−K) can be made of.
//!
//! Condition numbers come from three places: masses apart by up to 1e9, stiffness apart by up to 1e12, and steps long
//! enough that h²k/m is up to 1e16. *Faint* systems are all of these with every mass and constant scaled down to where
//! energies are below the smallest normal number.

use crate::data::{MotionData, SceneData, distance};
use crate::generate::{self, Ingredients};
use crate::random::Random;

/// Where a system comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Lengths, masses and stiffness of things on a table, h up to 0.1 s
    Mild,
    /// Masses apart by up to 1e9, stiffness by up to 1e12
    Unequal,
    /// The same, h chosen for an h²k/m anywhere in 1 … 1e16
    LongStep,
    /// Compressed springs, h chosen so that h²|α|/m is about 1: where the certificate decides
    Borderline,
    /// Sixty-six particles in a row: what is solved in eight pieces in lanes
    Chain,
    /// Any of the first three, scaled down
    Faint,
}

/// All of them.
pub const FAMILIES: [Family; 6] =
    [Family::Mild, Family::Unequal, Family::LongStep, Family::Borderline, Family::Chain, Family::Faint];

/// One random network, its step, and how its pins move.
#[derive(Debug, Clone)]
pub struct Case {
    /// Where it comes from
    pub family: Family,
    /// Is it to be a scene in `f32`?
    pub single: bool,
    /// The network, at rest: so that v⁺ = Δ holds the solution itself and not a rounded sum
    pub data: SceneData,
    /// The step, s
    pub h: f64,
    /// Pins that move
    pub motion: Vec<MotionData>,
}

/// When a solve stops.
#[derive(Debug, Clone, Copy)]
pub struct Cut {
    /// R
    pub relative: f64,
    /// At most so many iterations
    pub iterations: u32,
}

/// More than this no solve here needs.
pub const MANY: u32 = 500;

impl Cut {
    /// Cut at 1, 3, 10, or as long as it takes; R anything from 0 to 1.
    pub fn new(random: &mut Random) -> Self {
        let iterations = [1, 3, 10, MANY, MANY][random.below(5)];
        let relative = match random.below(20) {
            0 | 1 => 0.0,
            2 => 1.0,
            _ => random.decade(1e-12, 1e-1),
        };
        Self { relative, iterations }
    }
}

impl Case {
    /// The next one of a stream.
    pub fn new(random: &mut Random) -> Self {
        let family = match random.below(20) {
            _ if random.chance(1e-3) => Family::Chain,
            0..4 => Family::Mild,
            4..8 => Family::Unequal,
            8..14 => Family::LongStep,
            14..18 => Family::Borderline,
            _ => Family::Faint,
        };
        let single = random.chance(0.5);
        let (data, h) = match family {
            Family::Faint => {
                let of = [Family::Mild, Family::Unequal, Family::LongStep][random.below(3)];
                let (mut data, h) = network(random, of);
                // Masses stay normal numbers: they are at least 1e-3 kg in mild systems, 1e-6 kg in the others.
                let least = match (single, of) {
                    (true, Family::Mild) => 1e-33,
                    (true, _) => 1e-30,
                    (false, Family::Mild) => 1e-303,
                    (false, _) => 1e-300,
                };
                fade(&mut data, random.decade(least, 1.0));
                (data, h)
            }
            of => network(random, of),
        };
        let motion = motion(random, &data);
        Self { family, single, data, h, motion }
    }
}

fn network(random: &mut Random, family: Family) -> (SceneData, f64) {
    // Mostly small; one in a hundred has up to 72 unknowns, which CG does not finish in a few iterations.
    let n = match family {
        Family::Chain => 66,
        _ if random.chance(0.01) => 24,
        _ => 2 + random.below(5),
    };
    let mut chance = |p| random.chance(p);
    let with = Ingredients {
        pins: chance(0.5),
        compressed: chance(0.5) || family == Family::Borderline,
        damped: chance(0.4),
        points: chance(0.3),
        gravity: chance(0.7),
        moving: false,
    };
    let mut data = generate::network(random, n, with);
    if family == Family::Chain {
        string(&mut data);
    }
    if family != Family::Mild && family != Family::Borderline {
        spread(&mut data, random);
    }
    let h = match family {
        Family::LongStep | Family::Chain => {
            (random.decade(1.0, 1e16) * mean(&data.mass) / stiffest(&data)).sqrt()
        }
        Family::Borderline => (random.decade(0.02, 20.0) / most_compressed(&data)).sqrt(),
        _ => random.decade(1e-4, 0.1),
    };
    (data, if h.is_finite() { h } else { 0.01 })
}

/// The same with springs from each particle to the next only.
fn string(data: &mut SceneData) {
    data.springs.truncate(data.len() - 1);
    for (i, s) in data.springs.iter_mut().enumerate() {
        (s.a, s.b) = (i, i + 1);
    }
    let ends = [0, data.len() - 1];
    (0..data.len()).filter(|i| !ends.contains(i)).for_each(|i| data.pinned[i] = false);
}

/// Masses over up to nine decades, stiffness over up to twelve.
fn spread(data: &mut SceneData, random: &mut Random) {
    let (masses, constants) = (random.decade(1.0, 1e9), random.decade(1.0, 1e12));
    for m in &mut data.mass {
        *m = 1e-6 * random.decade(1.0, masses.max(1.0 + 1e-9));
    }
    let mut k = || 1e-4 * random.decade(1.0, constants.max(1.0 + 1e-9));
    data.springs.iter_mut().for_each(|s| s.k = k());
    data.points.iter_mut().for_each(|p| p.k = k());
}

/// Everything that a mass or a stiffness enters × `by`: the same motion.
fn fade(data: &mut SceneData, by: f64) {
    data.mass.iter_mut().for_each(|m| *m *= by);
    for s in &mut data.springs {
        (s.k, s.c) = (s.k * by, s.c * by);
    }
    data.points.iter_mut().for_each(|p| p.k *= by);
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn stiffest(data: &SceneData) -> f64 {
    let all = data.springs.iter().map(|s| s.k).chain(data.points.iter().map(|p| p.k));
    all.fold(1e-300, f64::max)
}

/// The largest |α|/m of a compressed spring, 1/s².
fn most_compressed(data: &SceneData) -> f64 {
    let one = |s: &crate::data::SpringData| {
        let l = distance(data.position[s.a], data.position[s.b]);
        s.k * (s.l0 / l - 1.0) / data.mass[s.a].min(data.mass[s.b])
    };
    data.springs.iter().map(one).fold(0.0, f64::max)
}

fn motion(random: &mut Random, data: &SceneData) -> Vec<MotionData> {
    let mut motion = Vec::new();
    for particle in 0..data.len() {
        if data.pinned[particle] && random.chance(0.3) {
            let mut position = data.position[particle];
            position.iter_mut().zip(random.vector(0.1)).for_each(|(x, d)| *x += d);
            motion.push(MotionData { particle, position, velocity: [0.0; 3] });
        }
    }
    motion
}
