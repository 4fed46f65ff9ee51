//! A mesh as a file holds it, before any physics: points and the cells that join them.
//!
//! Particle ids are the file's points in the file's order (0-based), used or not; nothing is merged, dropped or
//! reordered. The one exception is STL, which has no indices at all: there, exactly equal corners are one point.

mod cell;
mod edges;
mod format;
mod gmsh;
mod gmsh_input;
mod guard;
mod info;
mod measures;
mod medit;
mod obj;
mod oddities;
mod ply;
mod stl;
mod text;
mod validate;
mod vtk;
mod vtk_cells;
mod vtk_legacy;

use std::path::Path;

pub use cell::{Cell, KINDS};
pub use format::Format;
pub use info::{Info, KindCount, info};
pub use measures::Lengths;

use crate::error::InputError;

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

/// Reads and validates a mesh; its extension says which format it is in.
pub fn load(path: &Path) -> Result<Mesh, InputError> {
    let format = Format::of(path)?;
    let bytes = std::fs::read(path).map_err(|e| InputError::in_file(path, format!("cannot read: {e}")))?;
    parse(path, &bytes, format)
}

/// The mesh that these bytes of a file are in this format, validated; errors name the file.
pub fn parse(path: &Path, bytes: &[u8], format: Format) -> Result<Mesh, InputError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(InputError::in_file(path, "the file is empty"));
    }
    let mesh = match format {
        Format::Obj => obj::read(path, bytes),
        Format::Medit => medit::read(path, bytes),
        Format::Gmsh => gmsh::read(path, bytes),
        Format::Ply => ply::read(path, bytes),
        Format::VtkLegacy | Format::VtkXml => vtk::read(path, bytes, format),
        Format::Stl => stl::read(path, bytes),
    }?;
    mesh.validate(path)?;
    Ok(mesh)
}
