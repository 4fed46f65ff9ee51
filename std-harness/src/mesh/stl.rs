//! STL, ASCII and binary: triangles as three corners each, without indices.
//! Source: 3D Systems, "StereoLithography Interface Specification" (1989). Parsed by the `stl_io` crate.
//!
//! The one format in which points are merged: corners with exactly equal coordinates are one point (−0 equals 0), in
//! order of first appearance, since the format has no other way to say that triangles touch. Near-equal ones stay
//! apart. Whether a file is binary is told by its length (84 + 50 a triangle), not by its first word, which binary
//! exporters also set to `solid`. Coordinates are 32-bit, also those of an ASCII file.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use super::Mesh;
use super::cell::{Cell, repeated_corner};
use super::guard::guarded;
use super::oddities::key;
use crate::error::InputError;

const HEADER: usize = 80;
const FACET: usize = 50;

/// Reads an STL file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let announced = bytes
        .get(HEADER..HEADER + 4)
        .and_then(|b| <[u8; 4]>::try_from(b).ok())
        .map(|b| u32::from_le_bytes(b) as usize);
    // In 64 bits: 2³² facets of 50 bytes would not fit a 32-bit length.
    let length = |count: usize| (HEADER + 4) as u64 + FACET as u64 * count as u64;
    let ascii = bytes.starts_with(b"solid") && announced.is_none_or(|n| length(n) != bytes.len() as u64);
    let prepared = if ascii {
        // The crate wants a blank after `solid` even where no name follows.
        let end = bytes.iter().position(|b| *b == b'\n').unwrap_or(bytes.len());
        [b"solid ", &bytes[end..]].concat()
    } else {
        let Some(count) = announced else {
            return Err(InputError::in_file(
                file,
                format!("{} bytes are too few for an STL file", bytes.len()),
            ));
        };
        if length(count) != bytes.len() as u64 {
            let fit = (bytes.len() - HEADER - 4) / FACET;
            return Err(InputError::in_file(
                file,
                format!(
                    "the header announces {count} facets, the file has bytes for {fit}; or it is no STL file"
                ),
            ));
        }
        [&[0; HEADER], &bytes[HEADER..]].concat()
    };
    let facets = guarded(file, || -> std::io::Result<Vec<stl_io::Triangle>> {
        stl_io::create_stl_reader(&mut Cursor::new(prepared))?
            .enumerate()
            .map(|(i, f)| f.map_err(|e| std::io::Error::other(format!("facet {i}: {e}"))))
            .collect()
    })?
    .map_err(|e| InputError::in_file(file, format!("broken STL: {e}")))?;
    merge(file, &facets)
}

fn merge(file: &Path, facets: &[stl_io::Triangle]) -> Result<Mesh, InputError> {
    let mut mesh = Mesh::default();
    let mut ids = HashMap::new();
    for (i, facet) in facets.iter().enumerate() {
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(facet.vertices) {
            let point = vertex.0.map(f64::from);
            if let Some(x) = point.iter().find(|x| !x.is_finite()) {
                return Err(InputError::in_file(
                    file,
                    format!("facet {i}: coordinate {x}, it must be finite"),
                ));
            }
            *corner = *ids.entry(key(point)).or_insert(mesh.points.len());
            if *corner == mesh.points.len() {
                mesh.points.push(point);
            }
        }
        if let Some(twice) = repeated_corner(&corners) {
            let [x, y, z] = mesh.points[twice];
            return Err(InputError::in_file(
                file,
                format!("facet {i}: corner ({x}, {y}, {z}) stands twice in it"),
            ));
        }
        mesh.cells.push(Cell::Triangle(corners));
    }
    let (all, left) = (3 * facets.len(), mesh.points.len());
    mesh.notes.push(format!("{all} corners with exactly equal ones merged: {left} points"));
    Ok(mesh)
}
