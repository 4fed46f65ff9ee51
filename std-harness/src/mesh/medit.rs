//! MEDIT `.mesh`, ASCII: keywords, each followed by a count and that many entries of indices (from 1) and a reference.
//! Source: P. Frey, "MEDIT: An interactive mesh visualization software", INRIA RT-0253 (2001), appendix.
//!
//! Read are Vertices, Edges, Triangles, Quadrilaterals, Tetrahedra, Pyramids, Prisms and Hexahedra; references are
//! ignored, other sections of the format are skipped with a note. Dimension 2 is read with z = 0.

use std::path::Path;

use super::Mesh;
use super::cell::Cell;
use super::format::nearest;
use super::text::Words;
use super::validate::Draft;
use crate::error::InputError;

const CELLS: [(&str, usize); 8] = [
    ("Edges", 2),
    ("Triangles", 3),
    ("Quadrilaterals", 4),
    ("Tetrahedra", 4),
    ("Pyramids", 5),
    ("Prisms", 6),
    ("Pentahedra", 6),
    ("Hexahedra", 8),
];

/// Sections that say nothing about points and cells.
const SKIPPED: [&str; 22] = [
    "Corners",
    "RequiredVertices",
    "Ridges",
    "RequiredEdges",
    "RequiredTriangles",
    "RequiredQuadrilaterals",
    "RequiredTetrahedra",
    "Normals",
    "NormalAtVertices",
    "NormalAtTriangleVertices",
    "NormalAtQuadrilateralVertices",
    "Tangents",
    "TangentAtVertices",
    "TangentAtEdges",
    "SubDomainFromMesh",
    "SubDomainFromGeom",
    "AngleOfCornerBound",
    "BoundingBox",
    "ParallelVertices",
    "ParallelEdges",
    "Iterations",
    "Time",
];

/// Reads a MEDIT file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let text = String::from_utf8_lossy(bytes);
    let mut words = Words::new(file, &text);
    if words.next() != Some("MeshVersionFormatted") {
        return Err(words.error("not a MEDIT ASCII mesh: it does not start with MeshVersionFormatted"));
    }
    let version = words.count("the version")?;
    if !(1..=4).contains(&version) {
        return Err(words.error(format!("MEDIT version {version}; known are 1 to 4")));
    }
    let mut draft = Draft::default();
    let (mut dimension, mut vertices, mut ended) = (None, false, false);
    while let Some(keyword) = words.next() {
        if keyword == "End" {
            ended = true;
            break;
        } else if keyword == "Dimension" {
            dimension = Some(match words.count("the dimension")? {
                d @ (2 | 3) => d,
                d => return Err(words.error(format!("Dimension {d}; it must be 2 or 3"))),
            });
        } else if keyword == "Vertices" {
            let Some(dimension) = dimension else {
                return Err(
                    words.error("Vertices before Dimension: how many coordinates a vertex has is not known")
                );
            };
            if std::mem::replace(&mut vertices, true) {
                return Err(words.error("a second Vertices section"));
            }
            read_vertices(&mut words, dimension, &mut draft)?;
        } else if let Some(&(section, corners)) = CELLS.iter().find(|(k, _)| *k == keyword) {
            read_cells(&mut words, section, corners, &mut draft)?;
        } else if SKIPPED.contains(&keyword) {
            let line = words.line;
            while words.peek().is_some_and(|w| !w.starts_with(|c: char| c.is_ascii_alphabetic())) {
                words.next();
            }
            draft.mesh.notes.push(format!("line {line}: section {keyword} ignored"));
        } else {
            let known: Vec<&str> =
                CELLS.iter().map(|c| c.0).chain(SKIPPED).chain(["Vertices", "Dimension", "End"]).collect();
            let near = nearest(keyword, &known).map(|k| format!(", did you mean {k}?")).unwrap_or_default();
            return Err(words.error(format!("'{keyword}' is no MEDIT keyword{near}")));
        }
    }
    if !ended {
        draft
            .mesh
            .notes
            .push("no End at the end of the file: sections after the last one may be missing".into());
    }
    draft.finish(file)
}

fn read_vertices(words: &mut Words<'_>, dimension: usize, draft: &mut Draft) -> Result<(), InputError> {
    let count = words.count("the number of vertices")?;
    for i in 1..=count {
        let mut point = [0.0; 3];
        for (x, axis) in point.iter_mut().zip(["x", "y", "z"]).take(dimension) {
            *x = words.real(&format!("{axis} of vertex {i} of {count}"))?;
        }
        draft.point(words.line, point);
        words.integer(&format!("the reference of vertex {i} of {count}"))?;
    }
    Ok(())
}

fn read_cells(
    words: &mut Words<'_>,
    section: &str,
    corners: usize,
    draft: &mut Draft,
) -> Result<(), InputError> {
    let count = words.count(&format!("the number of {section}"))?;
    for i in 1..=count {
        let mut c = [0; 8];
        let mut line = words.line;
        for (at, corner) in c.iter_mut().enumerate().take(corners) {
            let index = words.count(&format!("vertex {} of entry {i} of {count} of {section}", at + 1))?;
            if at == 0 {
                line = words.line;
            }
            *corner = index.checked_sub(1).ok_or_else(|| {
                words.error(format!("entry {i} of {section}: vertex 0; MEDIT numbers vertices from 1"))
            })?;
        }
        words.integer(&format!("the reference of entry {i} of {count} of {section}"))?;
        let [p, q, r, s, t, u, v, w] = c;
        draft.cell(
            line,
            match section {
                "Edges" => Cell::Line([p, q]),
                "Triangles" => Cell::Triangle([p, q, r]),
                "Quadrilaterals" => Cell::Quad([p, q, r, s]),
                "Tetrahedra" => Cell::Tetrahedron([p, q, r, s]),
                "Pyramids" => Cell::Pyramid([p, q, r, s, t]),
                "Hexahedra" => Cell::Hexahedron([p, q, r, s, t, u, v, w]),
                _ => Cell::Wedge([p, q, r, s, t, u]),
            },
        );
    }
    Ok(())
}
