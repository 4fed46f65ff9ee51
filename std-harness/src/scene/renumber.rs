//! Another numbering of the particles, chosen for locality: reverse Cuthill–McKee, undone on everything that leaves a run.
//!
//! Particles that a spring joins get numbers close to each other: every island is walked level by level from one of its
//! ends (a pseudo-peripheral particle), neighbours of few springs first, and the walk is reversed. Pinned particles, which
//! are no unknowns, come last. Springs are sorted as the kernel's rows read them: by their lower end, then by the other.
//! Another numbering is another ordered scene, with other last bits; so it is the harness's choice, and recorded.
//!
//! It pays where a mesh's points come in no order and do not fit the cache; compare both with
//! `cargo run --release -p hooke-benches --bin compare -- --choose FILE -- --renumber rcm`. A grid's own numbering, whose
//! springs have few distances, is better kept: [`crate::run::plan::Plan`] keeps it.
//!
//! Cost: O(particles + springs·log) once. (The ordering of `sprs` looks for every island's start from particle 0 on, which
//! is quadratic in a scene of many ropes.)
//!
//! Source: George & Liu, *Computer Solution of Large Sparse Positive Definite Systems*, §4.3.

use super::graph::{Graph, NOWHERE};
use super::{Model, Moving};

/// A numbering beside the user's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Numbering {
    /// The user's particle under each new number.
    particle: Vec<usize>,
    /// The new number of each of the user's particles.
    number: Vec<usize>,
    /// The user's spring in each new place.
    spring: Vec<usize>,
    /// The new place of each of the user's springs.
    place: Vec<usize>,
}

fn inverse(order: &[usize]) -> Vec<usize> {
    let mut inverse = vec![0; order.len()];
    for (new, old) in order.iter().enumerate() {
        inverse[*old] = new;
    }
    inverse
}

impl Numbering {
    /// Reverse Cuthill–McKee.
    pub fn reverse_cuthill_mckee(model: &Model) -> Self {
        let graph = Graph::new(model);
        let mut particle: Vec<usize> = Vec::with_capacity(model.pinned.len());
        let mut level = vec![NOWHERE; model.pinned.len()];
        for first in 0..model.pinned.len() {
            if model.pinned[first] || level[first] != NOWHERE {
                continue;
            }
            let start = graph.end_of_the_island_of(first, &mut level);
            let from = particle.len();
            graph.walk(&[start], &mut level, &mut particle);
            particle[from..].reverse();
        }
        particle.extend((0..model.pinned.len()).filter(|i| model.pinned[*i]));
        Self::new(model, particle)
    }

    /// That order of the particles, each named once, and springs sorted by it.
    pub fn new(model: &Model, particle: Vec<usize>) -> Self {
        let number = inverse(&particle);
        let mut spring: Vec<usize> = (0..model.springs.len()).collect();
        spring.sort_by_key(|j| {
            let [a, b] = model.springs[*j].ends.map(|end| number[end]);
            (a.min(b), a.max(b))
        });
        let place = inverse(&spring);
        Self { particle, number, spring, place }
    }

    /// The model in this numbering.
    pub fn model(&self, model: &Model) -> Model {
        let mut new = model.clone();
        new.position = self.particle.iter().map(|i| model.position[*i]).collect();
        new.velocity = self.particle.iter().map(|i| model.velocity[*i]).collect();
        new.mass = self.particle.iter().map(|i| model.mass[*i]).collect();
        new.pinned = self.particle.iter().map(|i| model.pinned[*i]).collect();
        new.springs = self.spring.iter().map(|j| model.springs[*j]).collect();
        for spring in &mut new.springs {
            spring.ends = spring.ends.map(|end| self.number[end]);
        }
        let numbers = |moving: &Moving| moving.particles.iter().map(|i| self.number[*i]).collect();
        for (new, moving) in new.moving.iter_mut().zip(&model.moving) {
            new.particles = numbers(moving);
        }
        new
    }

    /// A list by new number, put back into the user's order.
    pub fn restored<X: Copy>(&self, list: &[X]) -> Vec<X> {
        self.number.iter().map(|new| list[*new]).collect()
    }

    /// What the user calls this particle. (A number that is none stays as it is.)
    pub fn users_particle(&self, new: usize) -> usize {
        self.particle.get(new).copied().unwrap_or(new)
    }

    /// What the user calls this spring.
    pub fn users_spring(&self, new: usize) -> usize {
        self.spring.get(new).copied().unwrap_or(new)
    }

    /// Where this spring of the user's is.
    pub fn place_of_spring(&self, old: usize) -> usize {
        self.place[old]
    }
}

/// How far springs between free particles reach in the numbering of the unknowns: on average, and at most.
pub fn reach(model: &Model) -> (f64, usize) {
    let mut rows = 0..;
    let row: Vec<usize> =
        model.pinned.iter().map(|pinned| if *pinned { 0 } else { rows.next().unwrap_or(0) }).collect();
    let inner = model.springs.iter().filter(|s| s.ends.iter().all(|end| !model.pinned[*end]));
    let reaches: Vec<usize> = inner.map(|s| row[s.ends[0]].abs_diff(row[s.ends[1]])).collect();
    let mean = reaches.iter().sum::<usize>() as f64 / reaches.len().max(1) as f64;
    (mean, reaches.into_iter().max().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    /// The same scene under other numbers.
    fn shuffled(model: &Model) -> Model {
        let n = model.position.len();
        // Any unit of ℤ/n will do.
        let factor =
            (n / 2..n).find(|f| (2..=*f).all(|d| !f.is_multiple_of(d) || !n.is_multiple_of(d))).unwrap();
        Numbering::new(model, (0..n).map(|i| i * factor % n).collect()).model(model)
    }

    fn named(name: &str) -> Model {
        catalog::named(name).unwrap().unwrap()
    }

    #[test]
    fn a_shuffled_rope_is_a_rope_again() {
        let rope = shuffled(&named("chain:50"));
        assert!(reach(&rope).1 > 10);
        let numbering = Numbering::reverse_cuthill_mckee(&rope);
        assert_eq!(reach(&numbering.model(&rope)), (1.0, 1));
    }

    #[test]
    fn a_shuffled_cloth_reaches_about_as_far_as_its_side_is_long() {
        let cloth = shuffled(&named("cloth:12"));
        let ordered = Numbering::reverse_cuthill_mckee(&cloth).model(&cloth);
        assert!(reach(&cloth).1 > 100 && reach(&ordered).1 <= 2 * 12 + 2, "{:?}", reach(&ordered));
    }

    #[test]
    fn every_particle_and_spring_keeps_its_properties_and_finds_its_way_back() {
        let mut model = shuffled(&named("curtain"));
        for (i, mass) in model.mass.iter_mut().enumerate() {
            *mass = 1.0 + i as f64;
        }
        for (j, spring) in model.springs.iter_mut().enumerate() {
            spring.damping = j as f64;
        }
        let numbering = Numbering::reverse_cuthill_mckee(&model);
        let new = numbering.model(&model);
        assert_eq!(numbering.restored(&new.mass), model.mass);
        assert_eq!(numbering.restored(&new.position), model.position);
        assert_eq!(numbering.restored(&new.pinned), model.pinned);
        for (j, spring) in model.springs.iter().enumerate() {
            let place = numbering.place_of_spring(j);
            assert_eq!((numbering.users_spring(place), new.springs[place].damping), (j, j as f64));
            assert_eq!(new.springs[place].ends.map(|end| numbering.users_particle(end)), spring.ends);
        }
        let sorted = |s: &crate::scene::ModelSpring| (s.ends[0].min(s.ends[1]), s.ends[0].max(s.ends[1]));
        assert!(new.springs.is_sorted_by_key(sorted));
        let pins = new.pinned.iter().filter(|pinned| **pinned).count();
        assert!(new.pinned[new.pinned.len() - pins..].iter().all(|pinned| *pinned));
    }

    #[test]
    fn particles_alone_and_islands_apart_are_all_there() {
        let mut model = Model::at_rest("apart", vec![[0.0; 3]; 7], 1.0);
        model.join(6, 2, 1.0);
        model.join(2, 4, 1.0);
        model.join(1, 5, 1.0);
        model.pinned[4] = true;
        let numbering = Numbering::reverse_cuthill_mckee(&model);
        let mut all = numbering.particle.clone();
        all.sort_unstable();
        assert_eq!(all, (0..7).collect::<Vec<_>>());
        assert_eq!(numbering.particle[6], 4);
    }
}
