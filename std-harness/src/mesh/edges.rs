//! The graph of a mesh: its unique edges (= springs), the pairs a bending spring would join, its pieces.
//!
//! Edges come as (lower, higher), sorted lexicographically, so that their order (and with it every bit of a run)
//! depends on which edges a mesh has, not on the order of its cells.

use std::collections::BTreeMap;

use super::{Cell, Mesh};

/// A pair of points, the lower one first.
fn pair(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

impl Mesh {
    /// The unique edges of all cells, each (lower, higher), sorted.
    pub fn edges(&self) -> Vec<[usize; 2]> {
        let mut edges: Vec<_> = self.cells.iter().flat_map(Cell::edges).map(|[a, b]| pair(a, b)).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The pairs across each edge that exactly two triangles or quadrilaterals share, unique, sorted, none an edge.
    ///
    /// At each end of the shared edge, the two sides that leave it (one in each face) continue each other; their far
    /// ends are a pair. Two triangles give their opposite vertices; two quadrilaterals give two pairs, which on a grid
    /// are the points two apart in a row.
    pub fn bending_pairs(&self) -> Vec<[usize; 2]> {
        // Edge → for each face on it, the neighbours of its lower and of its higher end in that face.
        let mut sides: BTreeMap<[usize; 2], Vec<[usize; 2]>> = BTreeMap::new();
        for cell in &self.cells {
            let (Cell::Triangle(_) | Cell::Quad(_)) = cell else { continue };
            let c = cell.corners();
            let n = c.len();
            for i in 0..n {
                let (a, b) = (c[i], c[(i + 1) % n]);
                let (before, after) = (c[(i + n - 1) % n], c[(i + 2) % n]);
                let ends = if a < b { [before, after] } else { [after, before] };
                sides.entry(pair(a, b)).or_default().push(ends);
            }
        }
        let edges = self.edges();
        let mut pairs: Vec<_> = sides
            .values()
            .filter_map(|faces| match faces[..] {
                [[a, b], [c, d]] => Some([pair(a, c), pair(b, d)]),
                _ => None,
            })
            .flatten()
            .filter(|p| p[0] != p[1] && edges.binary_search(p).is_err())
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// How many connected pieces the edges make; points in no cell are not counted.
    pub fn components(&self) -> usize {
        let mut root: Vec<usize> = (0..self.points.len()).collect();
        let mut pieces = self.points.len() - self.isolated().len();
        for [a, b] in self.edges() {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            if a != b {
                root[a] = b;
                pieces -= 1;
            }
        }
        pieces
    }
}

/// The root of a point's tree, halving the path on the way.
fn find(root: &mut [usize], mut i: usize) -> usize {
    while root[i] != i {
        root[i] = root[root[i]];
        i = root[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(points: usize, cells: &[Cell]) -> Mesh {
        Mesh { points: vec![[0.0; 3]; points], cells: cells.to_vec(), notes: vec![] }
    }

    #[test]
    fn edges_do_not_depend_on_the_order_of_cells_or_corners() {
        let a = mesh(4, &[Cell::Triangle([0, 1, 2]), Cell::Triangle([2, 1, 3])]);
        let b = mesh(4, &[Cell::Triangle([3, 2, 1]), Cell::Triangle([1, 0, 2])]);
        assert_eq!(a.edges(), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
        assert_eq!(a.edges(), b.edges());
    }

    #[test]
    fn two_triangles_bend_across_their_common_edge() {
        let m = mesh(4, &[Cell::Triangle([0, 1, 2]), Cell::Triangle([2, 1, 3])]);
        assert_eq!(m.bending_pairs(), [[0, 3]]);
        let flipped = mesh(4, &[Cell::Triangle([0, 1, 2]), Cell::Triangle([1, 2, 3])]);
        assert_eq!(flipped.bending_pairs(), [[0, 3]]);
    }

    #[test]
    fn two_quadrilaterals_bend_along_their_rows() {
        // 0 1 2 over 3 4 5
        let m = mesh(6, &[Cell::Quad([0, 1, 4, 3]), Cell::Quad([1, 2, 5, 4])]);
        assert_eq!(m.bending_pairs(), [[0, 2], [3, 5]]);
    }

    #[test]
    fn a_triangle_and_a_quadrilateral_join_the_apex_with_both_far_corners() {
        let m = mesh(5, &[Cell::Quad([0, 1, 2, 3]), Cell::Triangle([2, 1, 4])]);
        assert_eq!(m.bending_pairs(), [[0, 4], [3, 4]]);
    }

    #[test]
    fn no_bending_where_an_edge_is_there_already_or_three_faces_meet() {
        let tetrahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]].map(Cell::Triangle);
        assert!(mesh(4, &tetrahedron).bending_pairs().is_empty());
        let fan = [[0, 1, 2], [0, 1, 3], [0, 1, 4]].map(Cell::Triangle);
        assert!(mesh(5, &fan).bending_pairs().is_empty());
        let twice = [[0, 1, 2], [0, 1, 2]].map(Cell::Triangle);
        assert!(mesh(3, &twice).bending_pairs().is_empty());
    }

    #[test]
    fn pieces_are_counted_without_isolated_points() {
        let m = mesh(7, &[Cell::Line([0, 1]), Cell::Line([5, 2]), Cell::Line([2, 4]), Cell::Line([4, 5])]);
        assert_eq!(m.components(), 2);
        assert_eq!(m.isolated(), [3, 6]);
    }
}
