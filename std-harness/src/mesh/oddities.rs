//! What is legal in a mesh but rarely meant: points that nothing holds, points on top of each other, edges of length 0.
//! All are kept as they are and reported; ids stay those of the file.

use std::collections::HashMap;

use super::{Cell, Mesh};

/// Coordinates as a key: exactly equal numbers have equal keys (−0 + 0 is +0).
pub(super) fn key(point: [f64; 3]) -> [u64; 3] {
    point.map(|x| (x + 0.0).to_bits())
}

impl Mesh {
    /// Points in no cell: particles without a spring.
    pub fn isolated(&self) -> Vec<usize> {
        let mut used = vec![false; self.points.len()];
        self.cells.iter().flat_map(Cell::corners).for_each(|&c| used[c] = true);
        (0..used.len()).filter(|&i| !used[i]).collect()
    }

    /// Points with exactly the coordinates of an earlier one, as (the first such, this one), sorted.
    pub fn repeated(&self) -> Vec<[usize; 2]> {
        let mut first = HashMap::new();
        let mut pairs = Vec::new();
        for (id, point) in self.points.iter().enumerate() {
            let earlier = *first.entry(key(*point)).or_insert(id);
            if earlier != id {
                pairs.push([earlier, id]);
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// Edges whose ends have exactly the same coordinates: springs of rest length 0.
    pub fn zero_length(&self) -> Vec<[usize; 2]> {
        let mut edges = self.edges();
        edges.retain(|&[a, b]| key(self.points[a]) == key(self.points[b]));
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_points_are_kept_apart_and_reported() {
        let points = vec![[1.0, 0.0, 0.0], [2.0; 3], [1.0, -0.0, 0.0], [2.0; 3], [1.0, 0.0, 0.0]];
        let mesh = Mesh { points, cells: vec![Cell::Triangle([0, 1, 2]), Cell::Line([1, 4])], notes: vec![] };
        assert_eq!(mesh.repeated(), [[0, 2], [0, 4], [1, 3]]);
        assert_eq!(mesh.zero_length(), [[0, 2]]);
        assert_eq!(mesh.edges().len(), 4);
        assert_eq!(mesh.isolated(), [3]);
    }
}
