//! VTK: legacy `.vtk` (ASCII, binary) and XML `.vtu`, `.vtp` (inline or appended data, uncompressed).
//! Source: VTK User's Guide, "VTK file formats" (docs.vtk.org). Parsed by the `vtkio` crate.
//!
//! Read are unstructured grids and polygonal data; structured grids are refused, fields and attributes ignored. The
//! pieces of an XML file follow one another, their points too: points that two pieces repeat stay apart.

use std::path::Path;

use vtkio::IOBuffer;
use vtkio::model::{CellType, DataSet, Piece, PolyDataPiece, UnstructuredGridPiece, VertexNumbers, Vtk};

use super::cell::polygon_note;
use super::guard::guarded;
use super::vtk_cells::Cells;
use super::{Format, Mesh, vtk_legacy};
use crate::error::InputError;

/// Reads a VTK file.
pub(super) fn read(file: &Path, bytes: &[u8], format: Format) -> Result<Mesh, InputError> {
    let fail = |message: String| InputError::in_file(file, message);
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(0);
    let (mark, what) = if format == Format::VtkXml { ("<", "XML") } else { ("# vtk DataFile", "legacy") };
    if !bytes[start..].starts_with(mark.as_bytes()) {
        return Err(fail(format!("not a VTK {what} file: it does not start with '{mark}'")));
    }
    if format == Format::VtkLegacy {
        vtk_legacy::check(file, bytes)?;
    }
    let data = guarded(file, || match format {
        Format::VtkXml => Vtk::parse_xml(bytes),
        // Legacy binary files are big-endian by definition.
        _ => Vtk::parse_legacy_be(bytes),
    })?
    .map_err(|e| fail(format!("broken or truncated VTK {what} file: {e}")))?
    .data;
    let mut cells = Cells::default();
    guarded(file, || match data {
        DataSet::UnstructuredGrid { pieces, .. } => pieces.into_iter().try_for_each(|p| grid(p, &mut cells)),
        DataSet::PolyData { pieces, .. } => pieces.into_iter().try_for_each(|p| surface(p, &mut cells)),
        DataSet::ImageData { .. } => Err(kind("image data")),
        DataSet::StructuredGrid { .. } => Err(kind("a structured grid")),
        DataSet::RectilinearGrid { .. } => Err(kind("a rectilinear grid")),
        DataSet::Field { .. } => Err(kind("a field")),
    })?
    .map_err(fail)?;
    let mut mesh = cells.mesh;
    mesh.notes.extend(polygon_note(cells.polygons));
    if cells.vertices > 0 {
        mesh.notes.push(format!("{} vertex cells ignored: they have no edge", cells.vertices));
    }
    Ok(mesh)
}

fn kind(what: &str) -> String {
    format!("the file holds {what}; save it as an unstructured grid or polygonal data")
}

fn inline<P>(piece: Piece<P>) -> Result<P, String> {
    match piece {
        Piece::Inline(data) => Ok(*data),
        _ => Err("a piece is in another file; save the mesh in one".into()),
    }
}

fn points(buffer: &IOBuffer, cells: &mut Cells) -> Result<(), String> {
    cells.first = cells.mesh.points.len();
    let numbers: Vec<f64> = buffer.cast_into().ok_or("the points are not numbers")?;
    let (points, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(format!("{} coordinates do not make whole points", numbers.len()));
    }
    cells.mesh.points.extend_from_slice(points);
    Ok(())
}

fn grid(piece: Piece<UnstructuredGridPiece>, cells: &mut Cells) -> Result<(), String> {
    let piece = inline(piece)?;
    points(&piece.points, cells)?;
    let lists = split(piece.cells.cell_verts)?;
    if lists.len() != piece.cells.types.len() {
        return Err(format!("{} cells but {} cell types", lists.len(), piece.cells.types.len()));
    }
    lists.iter().zip(piece.cells.types).try_for_each(|(list, kind)| cells.push(kind, list))
}

fn surface(piece: Piece<PolyDataPiece>, cells: &mut Cells) -> Result<(), String> {
    let piece = inline(piece)?;
    points(&piece.points, cells)?;
    let kinds = [
        (piece.verts, CellType::PolyVertex),
        (piece.lines, CellType::PolyLine),
        (piece.polys, CellType::Polygon),
        (piece.strips, CellType::TriangleStrip),
    ];
    for (numbers, kind) in kinds {
        split(numbers.unwrap_or_default())?.iter().try_for_each(|list| cells.push(kind, list))?;
    }
    Ok(())
}

/// The corners of each cell, whichever of its two ways the file lists them in.
fn split(numbers: VertexNumbers) -> Result<Vec<Vec<usize>>, String> {
    let mut lists = Vec::new();
    let index = |i: u64| usize::try_from(i).map_err(|_| format!("vertex {i} is too large"));
    match numbers {
        VertexNumbers::Legacy { num_cells, vertices } => {
            let mut rest = &vertices[..];
            while let Some((&n, tail)) = rest.split_first() {
                let id = lists.len();
                let Some((corners, tail)) = tail.split_at_checked(n as usize) else {
                    return Err(format!(
                        "cell {id}: {n} vertices announced, {} are left in the list",
                        tail.len()
                    ));
                };
                lists.push(corners.iter().map(|&c| index(c.into())).collect::<Result<_, _>>()?);
                rest = tail;
            }
            if lists.len() != num_cells as usize {
                return Err(format!("{num_cells} cells announced, their list holds {}", lists.len()));
            }
        }
        VertexNumbers::XML { connectivity, offsets } => {
            // Legacy files of version 5 begin the offsets with 0, XML files do not.
            let ends = if offsets.first() == Some(&0) { &offsets[1..] } else { &offsets[..] };
            let mut start = 0;
            for &end in ends {
                let id = lists.len();
                let end = index(end)?;
                let Some(corners) = connectivity.get(start..end) else {
                    let length = connectivity.len();
                    return Err(format!(
                        "cell {id}: its vertices {start}..{end} are not in the list of {length}"
                    ));
                };
                lists.push(corners.iter().map(|&c| index(c)).collect::<Result<_, _>>()?);
                start = end;
            }
            if start != connectivity.len() {
                return Err(format!("the cells use {start} of the {} vertices listed", connectivity.len()));
            }
        }
    }
    Ok(lists)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_of_listing_corners_give_the_same() {
        let want = vec![vec![0, 1], vec![2, 3, 4]];
        let legacy = |n, v: &[u32]| split(VertexNumbers::Legacy { num_cells: n, vertices: v.to_vec() });
        let xml =
            |o: &[u64]| split(VertexNumbers::XML { connectivity: vec![0, 1, 2, 3, 4], offsets: o.to_vec() });
        assert_eq!(legacy(2, &[2, 0, 1, 3, 2, 3, 4]), Ok(want.clone()));
        assert_eq!(xml(&[2, 5]), Ok(want.clone()));
        assert_eq!(xml(&[0, 2, 5]), Ok(want));
        assert!(legacy(3, &[2, 0, 1, 3, 2, 3, 4]).unwrap_err().contains("3 cells announced"));
        assert!(
            legacy(2, &[2, 0, 1, 4, 2, 3, 4]).unwrap_err().starts_with("cell 1: 4 vertices announced, 3")
        );
        assert!(xml(&[2, 6]).unwrap_err().starts_with("cell 1: its vertices 2..6"));
        assert!(xml(&[3, 2, 5]).unwrap_err().starts_with("cell 1: its vertices 3..2"));
        assert!(xml(&[2, 4]).unwrap_err().contains("use 4 of the 5"));
    }
}
