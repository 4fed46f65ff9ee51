//! What every loaded mesh satisfies: at least one point, finite coordinates, every corner an existing point, no corner
//! twice in one cell. Readers of line-oriented formats hand in the lines, so that the error names one.

use std::path::Path;

use super::cell::repeated_corner;
use super::{Cell, Mesh};
use crate::error::InputError;

/// A mesh under construction whose reader knows the line of each point and cell and numbers them from 1.
#[derive(Default)]
pub(super) struct Draft {
    pub(super) mesh: Mesh,
    pub(super) point_lines: Vec<usize>,
    pub(super) cell_lines: Vec<usize>,
}

impl Draft {
    pub(super) fn point(&mut self, line: usize, point: [f64; 3]) {
        self.mesh.points.push(point);
        self.point_lines.push(line);
    }

    pub(super) fn cell(&mut self, line: usize, cell: Cell) {
        self.mesh.cells.push(cell);
        self.cell_lines.push(line);
    }

    pub(super) fn finish(self, file: &Path) -> Result<Mesh, InputError> {
        check(&self.mesh, file, 1, &self.point_lines, &self.cell_lines)?;
        Ok(self.mesh)
    }
}

impl Mesh {
    /// Checks the mesh; an error names the file, the point or cell (0-based) and the value.
    pub fn validate(&self, file: &Path) -> Result<(), InputError> {
        check(self, file, 0, &[], &[])
    }
}

fn check(
    mesh: &Mesh,
    file: &Path,
    base: usize,
    point_lines: &[usize],
    cell_lines: &[usize],
) -> Result<(), InputError> {
    let error = |line: Option<&usize>, message: String| match line {
        Some(&line) => InputError::at(file, line, message),
        None => InputError::in_file(file, message),
    };
    let count = mesh.points.len();
    if count == 0 {
        return Err(error(None, "the file holds no points".into()));
    }
    for (id, point) in mesh.points.iter().enumerate() {
        if let Some((axis, x)) = ["x", "y", "z"].iter().zip(point).find(|(_, x)| !x.is_finite()) {
            let message = format!("point {}: {axis} is {x}, coordinates must be finite", id + base);
            return Err(error(point_lines.get(id), message));
        }
    }
    for (id, cell) in mesh.cells.iter().enumerate() {
        let who = format!("cell {} ({})", id + base, cell.name());
        if let Some(&corner) = cell.corners().iter().find(|&&c| c >= count) {
            // Saturating: a corner near usize::MAX must be reported, not overflow.
            let (corner, last) = (corner.saturating_add(base), count - 1 + base);
            let message =
                format!("{who}: vertex {corner} does not exist, the file has vertices {base} to {last}");
            return Err(error(cell_lines.get(id), message));
        }
        if let Some(corner) = repeated_corner(cell.corners()) {
            let message = format!("{who}: vertex {} stands twice in it", corner + base);
            return Err(error(cell_lines.get(id), message));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(points: &[[f64; 3]], cell: Cell) -> String {
        let mesh = Mesh { points: points.to_vec(), cells: vec![cell], notes: vec![] };
        mesh.validate(Path::new("m.x")).unwrap_err().to_string()
    }

    #[test]
    fn the_message_names_the_file_the_cell_and_the_vertex() {
        let p = [[0.0; 3], [1.0; 3]];
        assert_eq!(
            message(&p, Cell::Line([0, 2])),
            "m.x: cell 0 (line): vertex 2 does not exist, the file has vertices 0 to 1"
        );
        assert_eq!(message(&p, Cell::Line([1, 1])), "m.x: cell 0 (line): vertex 1 stands twice in it");
        let e = message(&[[0.0; 3], [0.0, f64::NAN, 0.0]], Cell::Line([0, 1]));
        assert_eq!(e, "m.x: point 1: y is NaN, coordinates must be finite");
        assert_eq!(message(&[], Cell::Line([0, 1])), "m.x: the file holds no points");
    }

    #[test]
    fn a_draft_names_the_line_and_counts_from_one() {
        let mut draft = Draft::default();
        draft.point(3, [0.0; 3]);
        draft.cell(9, Cell::Line([0, usize::MAX]));
        let e = draft.finish(Path::new("m.x")).unwrap_err().to_string();
        assert!(e.starts_with("m.x:9: cell 1 (line): vertex ") && e.ends_with("vertices 1 to 1"), "{e}");
    }
}
