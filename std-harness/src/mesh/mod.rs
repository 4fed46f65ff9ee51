//! A mesh as a file holds it, before any physics: points and the cells that join them.

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
    /// A hexahedron: bottom face around, then the top face around (VTK order).
    Hexahedron([usize; 8]),
}

/// Points and cells as loaded: every point of the file, in the file's order, used or not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Point coordinates, in the file's unit (read as metres).
    pub points: Vec<[f64; 3]>,
    /// Cells, in the file's order.
    pub cells: Vec<Cell>,
    /// What a user should know about how the file was read (ignored parts, split polygons …), a line each.
    pub notes: Vec<String>,
}
