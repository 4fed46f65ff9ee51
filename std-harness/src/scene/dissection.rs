//! Elimination orders for a sparse factorisation: nested dissection by the particles' coordinates.
//!
//! The free particles are halved across their longest extent; those of the first half that have a spring into the second
//! are the separator, eliminated after both halves, which are cut in turn. On a cloth or a lattice the separators are
//! straight lines and planes, as good as they get; on a shape that is far from flat or convex an approximate minimum degree
//! order may be better, so [`crate::run::solver`] takes the one with the smaller factor.
//!
//! Cost: O(n log² n) once, n particles.
//!
//! Source: George 1973 (nested dissection); Gilbert, Miller & Teng 1998 (geometric separators).

use std::cmp::Ordering;

use super::Model;
use super::graph::Graph;

/// Parts that are not cut any more.
const SMALL: usize = 16;

/// The free particles, first to be eliminated first.
pub fn nested_dissection(model: &Model) -> Vec<u32> {
    let free: Vec<usize> = (0..model.pinned.len()).filter(|i| !model.pinned[*i]).collect();
    let mut cut = Cut {
        position: &model.position,
        graph: &Graph::new(model),
        side: vec![Side::Outside; model.pinned.len()],
        order: Vec::with_capacity(free.len()),
    };
    // Last in, first out: a part's separator waits below its halves.
    let mut parts = vec![Part::Whole(free)];
    while let Some(part) = parts.pop() {
        match part {
            Part::Whole(particles) if particles.len() > SMALL => parts.extend(cut.halve(particles)),
            Part::Whole(particles) | Part::Separator(particles) => {
                cut.order.extend(particles.into_iter().map(|i| i as u32));
            }
        }
    }
    cut.order
}

enum Part {
    Whole(Vec<usize>),
    Separator(Vec<usize>),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Outside,
    First,
    Second,
}

struct Cut<'m> {
    position: &'m [[f64; 3]],
    graph: &'m Graph,
    side: Vec<Side>,
    order: Vec<u32>,
}

impl Cut<'_> {
    /// By one axis after the other, then by number.
    fn compare(&self, axes: [usize; 3], a: usize, b: usize) -> Ordering {
        let (p, q) = (self.position[a], self.position[b]);
        axes.iter().map(|c| p[*c].total_cmp(&q[*c])).fold(Ordering::Equal, Ordering::then).then(a.cmp(&b))
    }

    /// Separator, and both halves without it.
    fn halve(&mut self, mut particles: Vec<usize>) -> [Part; 3] {
        let mut axes = [0, 1, 2];
        let extent = |c: usize| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in &particles {
                low = low.min(self.position[*i][c]);
                high = high.max(self.position[*i][c]);
            }
            high - low
        };
        let extents = axes.map(extent);
        axes.sort_by(|a, b| extents[*b].total_cmp(&extents[*a]));
        particles.sort_unstable_by(|a, b| self.compare(axes, *a, *b));
        let at = |k: usize| self.position[particles[k]][axes[0]];
        // Rather between two layers than through one.
        let middle = particles.len() / 2;
        let layer = (middle..particles.len()).find(|k| at(*k) > at(middle)).unwrap_or(middle);
        let second = particles.split_off(layer);
        let mut mark = |list: &[usize], side| list.iter().for_each(|i| self.side[*i] = side);
        mark(&particles, Side::First);
        mark(&second, Side::Second);
        let meets = |i: &usize| self.graph.neighbours(*i).iter().any(|j| self.side[*j] == Side::Second);
        let (mut separator, first): (Vec<_>, Vec<_>) = particles.iter().copied().partition(meets);
        let mut mark = |list: &[usize]| list.iter().for_each(|i| self.side[*i] = Side::Outside);
        mark(&particles);
        mark(&second);
        // Along the separator.
        axes.rotate_left(1);
        separator.sort_unstable_by(|a, b| self.compare(axes, *a, *b));
        [Part::Separator(separator), Part::Whole(second), Part::Whole(first)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Model {
        let place = |i: usize| [(i % n) as f64, 0.0, (i / n) as f64];
        let mut model = Model::at_rest("grid", (0..n * n).map(place).collect(), 0.1);
        for i in 0..n * n {
            if i % n + 1 < n {
                model.join(i, i + 1, 1.0);
            }
            if i + n < n * n {
                model.join(i, i + n, 1.0);
            }
        }
        model
    }

    #[test]
    fn every_free_particle_is_named_once_and_a_pinned_one_never() {
        let mut model = grid(13);
        model.pinned[5] = true;
        let mut order = nested_dissection(&model);
        assert_eq!(order.len(), 168);
        order.sort_unstable();
        order.dedup();
        assert!(order.len() == 168 && !order.contains(&5));
    }

    #[test]
    fn the_last_particles_are_a_line_across_the_grid() {
        let order = nested_dissection(&grid(9));
        let columns: Vec<u32> = order[72..].iter().map(|i| i % 9).collect();
        let rows: Vec<u32> = order[72..].iter().map(|i| i / 9).collect();
        let same = |list: &[u32]| list.iter().all(|i| *i == list[0]);
        assert!(same(&columns) || same(&rows), "{order:?}");
    }

    #[test]
    fn particles_in_one_place_are_no_endless_loop() {
        let mut model = Model::at_rest("point", vec![[0.0; 3]; 100], 0.1);
        (1..100).for_each(|i| model.join(0, i, 1.0));
        assert_eq!(nested_dissection(&model).len(), 100);
    }
}
