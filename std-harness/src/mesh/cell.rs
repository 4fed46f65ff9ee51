//! The cells a mesh is made of, and which of their corners are joined.
//!
//! Corner order is that of VTK (VTK User's Guide, "VTK file formats", linear cell types); Gmsh and MEDIT agree with it
//! on every kind held here. A spring network needs the *sides* of a cell only: no diagonal is ever invented.

/// One element of a mesh; indices are 0-based, in the file's own order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// A line element.
    Line([usize; 2]),
    /// A triangle.
    Triangle([usize; 3]),
    /// A quadrilateral, corners in order around it.
    Quad([usize; 4]),
    /// A tetrahedron.
    Tetrahedron([usize; 4]),
    /// A pyramid: the base around, then the apex.
    Pyramid([usize; 5]),
    /// A wedge (prism): one triangle, then the one opposite.
    Wedge([usize; 6]),
    /// A hexahedron: bottom face around, then the top face around (VTK order).
    Hexahedron([usize; 8]),
}

/// The kinds in the order reports list them.
pub const KINDS: [&str; 7] =
    ["lines", "triangles", "quadrilaterals", "tetrahedra", "pyramids", "wedges", "hexahedra"];

impl Cell {
    /// The corners, in the file's order.
    pub fn corners(&self) -> &[usize] {
        match self {
            Cell::Line(c) => c,
            Cell::Triangle(c) => c,
            Cell::Quad(c) | Cell::Tetrahedron(c) => c,
            Cell::Pyramid(c) => c,
            Cell::Wedge(c) => c,
            Cell::Hexahedron(c) => c,
        }
    }

    /// What a message calls it.
    pub fn name(&self) -> &'static str {
        match self {
            Cell::Line(_) => "line",
            Cell::Triangle(_) => "triangle",
            Cell::Quad(_) => "quadrilateral",
            Cell::Tetrahedron(_) => "tetrahedron",
            Cell::Pyramid(_) => "pyramid",
            Cell::Wedge(_) => "wedge",
            Cell::Hexahedron(_) => "hexahedron",
        }
    }

    /// Its place in [`KINDS`].
    pub fn kind(&self) -> usize {
        match self {
            Cell::Line(_) => 0,
            Cell::Triangle(_) => 1,
            Cell::Quad(_) => 2,
            Cell::Tetrahedron(_) => 3,
            Cell::Pyramid(_) => 4,
            Cell::Wedge(_) => 5,
            Cell::Hexahedron(_) => 6,
        }
    }

    /// Its sides: the pairs of corners that an edge joins (1, 3, 4, 6, 8, 9 or 12 of them).
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let sides: &[[usize; 2]] = match self {
            Cell::Line(_) => &[[0, 1]],
            Cell::Triangle(_) => &[[0, 1], [1, 2], [2, 0]],
            Cell::Quad(_) => &[[0, 1], [1, 2], [2, 3], [3, 0]],
            Cell::Tetrahedron(_) => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
            Cell::Pyramid(_) => &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
            Cell::Wedge(_) => &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
            Cell::Hexahedron(_) => &[
                [0, 1],
                [1, 2],
                [2, 3],
                [3, 0],
                [4, 5],
                [5, 6],
                [6, 7],
                [7, 4],
                [0, 4],
                [1, 5],
                [2, 6],
                [3, 7],
            ],
        };
        let corners = self.corners();
        sides.iter().map(move |&[a, b]| [corners[a], corners[b]])
    }

    /// A split into tetrahedra, for volumes; nothing for cells without one.
    pub(super) fn tetrahedra(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let split: &[[usize; 4]] = match self {
            Cell::Line(_) | Cell::Triangle(_) | Cell::Quad(_) => &[],
            Cell::Tetrahedron(_) => &[[0, 1, 2, 3]],
            Cell::Pyramid(_) => &[[0, 1, 2, 4], [0, 2, 3, 4]],
            Cell::Wedge(_) => &[[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]],
            // All six around the diagonal 0–6, so that opposite faces are cut alike.
            Cell::Hexahedron(_) => {
                &[[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
            }
        };
        let corners = self.corners();
        split.iter().map(move |t| t.map(|i| corners[i]))
    }
}

/// The first corner that stands twice in a cell.
pub(super) fn repeated_corner<T: PartialEq + Copy>(corners: &[T]) -> Option<T> {
    corners.iter().enumerate().find(|(i, c)| corners[..*i].contains(c)).map(|(_, c)| *c)
}

/// A polygon as cells: triangles and quadrilaterals as they are, more corners as their boundary edges.
///
/// A fan of triangles would put in diagonals that the file does not have, and which ones would depend on the corner it
/// starts from; the boundary alone is what the file says. Such a polygon has no area and no bending pairs, and a note
/// says so. Returns how many polygons (0 or 1) were so reduced.
pub(super) fn polygon(corners: &[usize], mut push: impl FnMut(Cell)) -> usize {
    match *corners {
        [a, b, c] => push(Cell::Triangle([a, b, c])),
        [a, b, c, d] => push(Cell::Quad([a, b, c, d])),
        _ => {
            for (i, &a) in corners.iter().enumerate() {
                push(Cell::Line([a, corners[(i + 1) % corners.len()]]));
            }
            return 1;
        }
    }
    0
}

/// The note for polygons reduced to their boundary.
pub(super) fn polygon_note(count: usize) -> Option<String> {
    (count > 0).then(|| {
        format!(
            "{count} polygons with more than 4 corners: kept as their boundary edges, without area or bending"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_the_sides_of_its_solid_once_each() {
        let cells = [
            (Cell::Line([0, 1]), 1),
            (Cell::Triangle([0, 1, 2]), 3),
            (Cell::Quad([0, 1, 2, 3]), 4),
            (Cell::Tetrahedron([0, 1, 2, 3]), 6),
            (Cell::Pyramid([0, 1, 2, 3, 4]), 8),
            (Cell::Wedge([0, 1, 2, 3, 4, 5]), 9),
            (Cell::Hexahedron([0, 1, 2, 3, 4, 5, 6, 7]), 12),
        ];
        for (place, (cell, count)) in cells.into_iter().enumerate() {
            let mut sides: Vec<_> = cell.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
            sides.sort();
            sides.dedup();
            assert_eq!(sides.len(), count, "{cell:?}");
            assert_eq!(cell.kind(), place);
            assert!(KINDS[place].starts_with(&cell.name()[..4]), "{cell:?}");
        }
    }

    #[test]
    fn a_pentagon_becomes_its_five_sides() {
        let mut cells = Vec::new();
        assert_eq!(polygon(&[4, 3, 2, 1, 0], |c| cells.push(c)), 1);
        assert_eq!(cells, [[4, 3], [3, 2], [2, 1], [1, 0], [0, 4]].map(Cell::Line));
    }

    #[test]
    fn the_first_repeated_corner_is_found() {
        assert_eq!(repeated_corner(&[5, 7, 5, 7]), Some(5));
        assert_eq!(repeated_corner(&[5, 7, 6]), None);
    }
}
