//! What decides how hard a scene's systems are to solve, read off the scene and the step before anything moves: per island
//! its size, its bandwidth, its depth and its stiffness.

use crate::scene::Model;
use crate::scene::graph::{Graph, NOWHERE};

/// One island: what is solved at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Island {
    /// Its free particles.
    pub rows: usize,
    /// Its springs, those to pins included.
    pub springs: usize,
    /// The farthest that a spring reaches, in rows.
    pub half_bandwidth: usize,
    /// How many springs it takes at most to get to a pin; in an island without pins, from one end to the other.
    pub depth: usize,
    /// σ = max_i Σ_e (h² kₑ + h cₑ) / mᵢ(1 + hd): how much stiffer than heavy the stiffest particle is.
    pub stiffness: f64,
}

/// A scene's islands, by their first particles.
pub fn islands(model: &Model, dt: f64) -> Vec<Island> {
    let graph = Graph::new(model);
    let (anchored, stiffness) = particles(model, dt);
    let n = model.pinned.len();
    let (mut level, mut order) = (vec![NOWHERE; n], Vec::new());
    let (mut islands, mut of, mut row) = (Vec::new(), vec![NOWHERE; n], vec![0; n]);
    for first in 0..n {
        if model.pinned[first] || of[first] != NOWHERE {
            continue;
        }
        order.clear();
        graph.walk(&[first], &mut level, &mut order);
        order.iter().for_each(|i| level[*i] = NOWHERE);
        order.sort_unstable();
        for (place, i) in order.iter().enumerate() {
            (of[*i], row[*i]) = (islands.len(), place);
        }
        let mut starts: Vec<usize> = order.iter().copied().filter(|i| anchored[*i]).collect();
        let held = !starts.is_empty();
        if !held {
            starts.push(graph.end_of_the_island_of(first, &mut level));
        }
        let stiffest =
            order.iter().map(|i| stiffness[*i]).fold(0.0, |most: f64, s| if s > most { s } else { most });
        let rows = order.len();
        order.clear();
        let depth = graph.walk(&starts, &mut level, &mut order) + usize::from(held);
        islands.push(Island { rows, springs: 0, half_bandwidth: 0, depth, stiffness: stiffest });
    }
    for spring in &model.springs {
        let [a, b] = spring.ends;
        let Some(island) = islands.get_mut(if model.pinned[a] { of[b] } else { of[a] }) else { continue };
        island.springs += 1;
        if !model.pinned[a] && !model.pinned[b] {
            island.half_bandwidth = island.half_bandwidth.max(row[a].abs_diff(row[b]));
        }
    }
    islands
}

/// Which particles a spring joins with a pin, and each particle's own σ.
fn particles(model: &Model, dt: f64) -> (Vec<bool>, Vec<f64>) {
    let n = model.pinned.len();
    let (mut anchored, mut stiffness) = (vec![false; n], vec![0.0; n]);
    for spring in &model.springs {
        let [a, b] = spring.ends;
        for (end, other) in [(a, b), (b, a)] {
            anchored[end] |= model.pinned[other];
            stiffness[end] += dt * dt * spring.stiffness + dt * spring.damping;
        }
    }
    for (stiffness, mass) in stiffness.iter_mut().zip(&model.mass) {
        *stiffness /= mass * (1.0 + dt * model.drag);
    }
    (anchored, stiffness)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn of(name: &str, dt: f64) -> Vec<Island> {
        islands(&catalog::named(name).unwrap().unwrap(), dt)
    }

    #[test]
    fn a_chain_is_one_island_of_bandwidth_1_as_deep_as_it_is_long() {
        let [island] = of("chain:10", 0.5)[..] else { panic!() };
        assert_eq!((island.rows, island.springs, island.half_bandwidth, island.depth), (9, 9, 1, 9));
        // Two springs of 1e4 N/m on 0.01 kg.
        assert!((island.stiffness - 0.25 * 2e4 / 0.01).abs() < 1e-6);
    }

    #[test]
    fn a_cloth_is_as_wide_and_as_deep_as_its_side() {
        let [island] = of("cloth:8", 1.0 / 60.0)[..] else { panic!() };
        assert_eq!((island.rows, island.springs), (62, 2 * 8 * 7 + 2 * 7 * 7));
        assert_eq!((island.half_bandwidth, island.depth), (9, 7));
    }

    #[test]
    fn islands_are_counted_apart_and_springs_between_pins_belong_to_none() {
        let mut model = Model::at_rest("two", vec![[0.0; 3]; 6], 2.0);
        for (a, b) in [(0, 1), (1, 2), (1, 4), (4, 5), (1, 3)] {
            model.join(a, b, 3.0);
        }
        (model.pinned[1], model.pinned[3]) = (true, true);
        let found = islands(&model, 1.0);
        assert_eq!(
            found.iter().map(|i| (i.rows, i.springs, i.depth)).collect::<Vec<_>>(),
            [(1, 1, 1), (1, 1, 1), (2, 2, 2)]
        );
        assert_eq!(found[2].stiffness, 3.0);
    }

    #[test]
    fn a_free_block_is_as_deep_as_from_corner_to_corner() {
        assert_eq!(of("lattice:4x3x5", 0.01).iter().map(|i| i.depth).collect::<Vec<_>>(), [4]);
    }
}
