//! The graph of the springs between free particles, and walks through it level by level.

use super::Model;

/// The level of a particle that has not been met yet.
pub const NOWHERE: usize = usize::MAX;

/// Who is joined with whom, among free particles.
pub struct Graph {
    /// Where each particle's neighbours begin; one more at the end.
    from: Vec<usize>,
    neighbours: Vec<usize>,
}

impl Graph {
    /// The graph of a model's springs whose two ends are free.
    pub fn new(model: &Model) -> Self {
        let mut from = vec![0; model.pinned.len() + 1];
        let inner =
            || model.springs.iter().map(|s| s.ends).filter(|ends| ends.iter().all(|end| !model.pinned[*end]));
        inner().flatten().for_each(|end| from[end + 1] += 1);
        for i in 1..from.len() {
            from[i] += from[i - 1];
        }
        let (mut next, mut neighbours) = (from.clone(), vec![0; from[from.len() - 1]]);
        for [a, b] in inner() {
            for (end, other) in [(a, b), (b, a)] {
                neighbours[next[end]] = other;
                next[end] += 1;
            }
        }
        let mut graph = Self { from, neighbours };
        // Few springs first, as Cuthill and McKee want it; then by number, so that the order of springs does not matter.
        let degree: Vec<usize> = (0..model.pinned.len()).map(|i| graph.degree(i)).collect();
        for i in 0..model.pinned.len() {
            graph.neighbours[graph.from[i]..graph.from[i + 1]].sort_unstable_by_key(|j| (degree[*j], *j));
        }
        graph
    }

    /// Number of springs of a particle.
    pub fn degree(&self, i: usize) -> usize {
        self.from[i + 1] - self.from[i]
    }

    /// Who is joined with a particle.
    pub fn neighbours(&self, i: usize) -> &[usize] {
        &self.neighbours[self.from[i]..self.from[i + 1]]
    }

    /// Appends all that can be reached from `starts`, level by level, to `order`, and notes the levels. Answers the last.
    pub fn walk(&self, starts: &[usize], level: &mut [usize], order: &mut Vec<usize>) -> usize {
        let mut next = order.len();
        for start in starts {
            level[*start] = 0;
            order.push(*start);
        }
        let mut depth = 0;
        while let Some(&i) = order.get(next) {
            next += 1;
            depth = level[i];
            for &j in &self.neighbours[self.from[i]..self.from[i + 1]] {
                if level[j] == NOWHERE {
                    level[j] = depth + 1;
                    order.push(j);
                }
            }
        }
        depth
    }

    /// A particle as far from the others of its island as is easily found: from any, to one of few springs on the last
    /// level, as long as that makes more levels. Leaves the island unmarked.
    pub fn end_of_the_island_of(&self, first: usize, level: &mut [usize]) -> usize {
        let (mut start, mut deepest, mut island) = (first, None, Vec::new());
        let mut candidate = first;
        loop {
            island.clear();
            let depth = self.walk(&[candidate], level, &mut island);
            let last = island.iter().copied().filter(|i| level[*i] == depth);
            let farthest = last.min_by_key(|i| (self.degree(*i), *i));
            island.iter().for_each(|i| level[*i] = NOWHERE);
            if deepest.is_some_and(|deepest| depth <= deepest) {
                return start;
            }
            (start, deepest) = (candidate, Some(depth));
            candidate = farthest.unwrap_or(candidate);
        }
    }
}
