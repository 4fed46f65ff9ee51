//! VTK cell types as cells: linear ones only.
//! Source: VTK User's Guide, "VTK file formats", figures of the linear and non-linear cell types.
//!
//! Pixels and voxels run along the axes, so their corners are put in order around. Strips are cut into the triangles
//! they stand for, polylines into lines. Higher-order cells are refused: their extra nodes would be particles that no
//! edge holds.

use vtkio::model::CellType;

use super::Mesh;
use super::cell::{Cell, polygon, repeated_corner};

/// Cells collected from the pieces of one file.
#[derive(Default)]
pub(super) struct Cells {
    pub(super) mesh: Mesh,
    /// The id of the current piece's first point.
    pub(super) first: usize,
    /// Polygons reduced to their boundary.
    pub(super) polygons: usize,
    /// Vertex cells, which have no edge.
    pub(super) vertices: usize,
    seen: usize,
}

impl Cells {
    /// Adds one cell of the file; indices count from the piece's first point.
    pub(super) fn push(&mut self, kind: CellType, list: &[usize]) -> Result<(), String> {
        let id = self.seen;
        self.seen += 1;
        let c: Vec<usize> = list.iter().map(|&i| i.saturating_add(self.first)).collect();
        if let Some(out) = list.iter().find(|&&i| i >= self.mesh.points.len() - self.first) {
            let last = (self.mesh.points.len() - self.first).checked_sub(1);
            let have = last.map_or("no vertices".into(), |l| format!("vertices 0 to {l}"));
            return Err(format!("cell {id}: vertex {out} does not exist, the piece has {have}"));
        }
        // A polyline may close on itself and a strip may turn on a corner; their parts are checked after.
        let whole = !matches!(kind, CellType::PolyLine | CellType::TriangleStrip | CellType::PolyVertex);
        if let Some(twice) = repeated_corner(list).filter(|_| whole) {
            return Err(format!("cell {id}: vertex {twice} stands twice in it"));
        }
        let cells = &mut self.mesh.cells;
        match (kind, &c[..]) {
            (CellType::Vertex | CellType::PolyVertex, _) => self.vertices += 1,
            (CellType::Line, &[a, b]) => cells.push(Cell::Line([a, b])),
            (CellType::PolyLine, [_, _, ..]) => cells.extend(c.windows(2).map(|w| Cell::Line([w[0], w[1]]))),
            (CellType::Triangle, &[p, q, r]) => cells.push(Cell::Triangle([p, q, r])),
            (CellType::TriangleStrip, [_, _, _, ..]) => {
                // Every second triangle of a strip runs the other way round.
                cells.extend(c.windows(3).enumerate().map(|(i, w)| {
                    Cell::Triangle(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
                }));
            }
            (CellType::Polygon, [_, _, _, ..]) => self.polygons += polygon(&c, |cell| cells.push(cell)),
            (CellType::Quad, &[p, q, r, s]) | (CellType::Pixel, &[p, q, s, r]) => {
                cells.push(Cell::Quad([p, q, r, s]));
            }
            (CellType::Tetra, &[p, q, r, s]) => cells.push(Cell::Tetrahedron([p, q, r, s])),
            (CellType::Pyramid, &[p, q, r, s, t]) => cells.push(Cell::Pyramid([p, q, r, s, t])),
            (CellType::Wedge, &[p, q, r, s, t, u]) => cells.push(Cell::Wedge([p, q, r, s, t, u])),
            (CellType::Hexahedron, &[p, q, r, s, t, u, v, w])
            | (CellType::Voxel, &[p, q, s, r, t, u, w, v]) => {
                cells.push(Cell::Hexahedron([p, q, r, s, t, u, v, w]));
            }
            _ if (kind as u8) < 15 => {
                return Err(format!("cell {id}: {} corners do not make a {kind:?}", list.len()));
            }
            _ => {
                let number = kind as u8;
                let advice = "only linear cells (types 1 to 14) are read; save the mesh with order 1";
                return Err(format!("cell {id}: type {number} ({kind:?}): {advice}"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(points: usize, kind: CellType, list: &[usize]) -> Result<Vec<Cell>, String> {
        let mut cells = Cells::default();
        cells.mesh.points = vec![[0.0; 3]; points];
        cells.push(kind, list)?;
        Ok(cells.mesh.cells)
    }

    #[test]
    fn pixels_and_voxels_are_put_in_order_around() {
        assert_eq!(cells(4, CellType::Pixel, &[0, 1, 2, 3]), Ok(vec![Cell::Quad([0, 1, 3, 2])]));
        assert_eq!(
            cells(8, CellType::Voxel, &[0, 1, 2, 3, 4, 5, 6, 7]),
            Ok(vec![Cell::Hexahedron([0, 1, 3, 2, 4, 5, 7, 6])])
        );
    }

    #[test]
    fn strips_and_polylines_are_cut_into_their_parts() {
        let strip = [[0, 1, 2], [2, 1, 3], [2, 3, 4]].map(Cell::Triangle);
        assert_eq!(cells(5, CellType::TriangleStrip, &[0, 1, 2, 3, 4]), Ok(strip.to_vec()));
        let closed = [[0, 1], [1, 2], [2, 0]].map(Cell::Line);
        assert_eq!(cells(3, CellType::PolyLine, &[0, 1, 2, 0]), Ok(closed.to_vec()));
    }

    #[test]
    fn a_wrong_number_of_corners_and_higher_orders_are_refused() {
        assert_eq!(
            cells(4, CellType::Tetra, &[0, 1, 2]),
            Err("cell 0: 3 corners do not make a Tetra".into())
        );
        let e = cells(6, CellType::QuadraticTriangle, &[0, 1, 2, 3, 4, 5]).unwrap_err();
        assert!(e.contains("type 22 (QuadraticTriangle)") && e.contains("order 1"), "{e}");
        let e = cells(3, CellType::Triangle, &[0, 1, 3]).unwrap_err();
        assert_eq!(e, "cell 0: vertex 3 does not exist, the piece has vertices 0 to 2");
        assert!(cells(3, CellType::Triangle, &[0, 1, 1]).unwrap_err().contains("vertex 1 stands twice"));
    }
}
