//! Sizes of a mesh: bounds, edge lengths, area of its faces, volume of its solids, and each point's share of them.
//!
//! Area: |(b − a) × (c − a)|/2 a triangle; a quadrilateral is the two triangles on its diagonal 0–2. Volume:
//! |(b − a) · ((c − a) × (d − a))|/6 a tetrahedron; the other solids are split into tetrahedra, absolute volumes
//! summed, so that an inside-out cell counts like any other. Shares are lumped: a cell's size in equal parts on its
//! corners. These set masses and reports; the kernel does its own arithmetic.

use serde::Serialize;

use super::{Cell, Mesh};

/// Shortest, median and longest edge, in the file's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lengths {
    /// The shortest.
    pub min: f64,
    /// The median: the mean of the two middle ones where their number is even.
    pub median: f64,
    /// The longest.
    pub max: f64,
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Mesh {
    /// The box around all points: lowest and highest corner; `None` without points.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let first = *self.points.first()?;
        let [mut low, mut high] = [first; 2];
        for point in &self.points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        Some([low, high])
    }

    /// The lengths of the unique edges; `None` without edges.
    pub fn lengths(&self) -> Option<Lengths> {
        let difference = |[a, b]: [usize; 2]| minus(self.points[b], self.points[a]);
        let mut lengths: Vec<f64> =
            self.edges().into_iter().map(difference).map(|d| dot(d, d).sqrt()).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        let (min, max) = (*lengths.first()?, *lengths.last()?);
        let n = lengths.len();
        Some(Lengths { min, median: 0.5 * (lengths[(n - 1) / 2] + lengths[n / 2]), max })
    }

    /// The area of all triangles and quadrilaterals.
    pub fn area(&self) -> f64 {
        self.cells.iter().map(|c| self.cell_area(c)).sum()
    }

    /// The volume of all tetrahedra, pyramids, wedges and hexahedra.
    pub fn volume(&self) -> f64 {
        self.cells.iter().map(|c| self.cell_volume(c)).sum()
    }

    /// Each point's share of [`area`](Self::area).
    pub fn area_share(&self) -> Vec<f64> {
        self.share(|c| self.cell_area(c))
    }

    /// Each point's share of [`volume`](Self::volume).
    pub fn volume_share(&self) -> Vec<f64> {
        self.share(|c| self.cell_volume(c))
    }

    fn share(&self, size: impl Fn(&Cell) -> f64) -> Vec<f64> {
        let mut share = vec![0.0; self.points.len()];
        for cell in &self.cells {
            let part = size(cell) / cell.corners().len() as f64;
            cell.corners().iter().for_each(|&c| share[c] += part);
        }
        share
    }

    fn cell_area(&self, cell: &Cell) -> f64 {
        match *cell {
            Cell::Triangle(t) => self.triangle_area(t),
            Cell::Quad([a, b, c, d]) => self.triangle_area([a, b, c]) + self.triangle_area([a, c, d]),
            _ => 0.0,
        }
    }

    fn triangle_area(&self, corners: [usize; 3]) -> f64 {
        let [a, b, c] = corners.map(|i| self.points[i]);
        let normal = cross(minus(b, a), minus(c, a));
        0.5 * dot(normal, normal).sqrt()
    }

    fn cell_volume(&self, cell: &Cell) -> f64 {
        cell.tetrahedra()
            .map(|t| {
                let [a, b, c, d] = t.map(|i| self.points[i]);
                dot(minus(b, a), cross(minus(c, a), minus(d, a))).abs() / 6.0
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of a box 2 × 3 × 4 in the order of a hexahedron.
    fn corners() -> Vec<[f64; 3]> {
        [[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0], [0, 0, 4], [2, 0, 4], [2, 3, 4], [0, 3, 4]]
            .map(|p: [i32; 3]| p.map(f64::from))
            .to_vec()
    }

    fn with(cells: &[Cell]) -> Mesh {
        Mesh { points: corners(), cells: cells.to_vec(), notes: vec![] }
    }

    #[test]
    fn volumes_of_the_parts_of_a_box() {
        assert_eq!(with(&[Cell::Hexahedron([0, 1, 2, 3, 4, 5, 6, 7])]).volume(), 24.0);
        assert_eq!(with(&[Cell::Hexahedron([3, 2, 1, 0, 7, 6, 5, 4])]).volume(), 24.0);
        assert_eq!(with(&[Cell::Wedge([0, 1, 2, 4, 5, 6])]).volume(), 12.0);
        assert_eq!(with(&[Cell::Pyramid([0, 1, 2, 3, 6])]).volume(), 8.0);
        assert_eq!(with(&[Cell::Tetrahedron([0, 1, 2, 5]), Cell::Tetrahedron([1, 0, 2, 5])]).volume(), 8.0);
        assert_eq!(with(&[Cell::Quad([0, 1, 2, 3])]).volume(), 0.0);
    }

    #[test]
    fn areas_and_their_shares() {
        let mesh = with(&[Cell::Quad([0, 1, 2, 3]), Cell::Triangle([1, 2, 5]), Cell::Line([0, 7])]);
        assert_eq!(mesh.area(), 12.0);
        assert_eq!(mesh.area_share(), [1.5, 3.5, 3.5, 1.5, 0.0, 2.0, 0.0, 0.0]);
        let mesh = with(&[Cell::Tetrahedron([0, 1, 2, 5])]);
        assert_eq!(mesh.volume_share(), [1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn lengths_and_bounds() {
        let mesh = with(&[Cell::Hexahedron([0, 1, 2, 3, 4, 5, 6, 7])]);
        assert_eq!(mesh.lengths(), Some(Lengths { min: 2.0, median: 3.0, max: 4.0 }));
        assert_eq!(mesh.bounds(), Some([[0.0; 3], [2.0, 3.0, 4.0]]));
        let two = with(&[Cell::Line([0, 1]), Cell::Line([0, 3])]);
        assert_eq!(two.lengths().map(|l| l.median), Some(2.5));
        assert_eq!((with(&[]).lengths(), Mesh::default().bounds()), (None, None));
    }
}
