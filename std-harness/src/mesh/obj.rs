//! Wavefront OBJ: one statement a line, vertices numbered from 1 in order (negative: back from the last one so far).
//! Source: "Object Files (.obj)", Wavefront Advanced Visualizer Manual, appendix B1.
//!
//! Read are `v` (x y z, weights and colours ignored), `f` and `l`; texture and normal indices are ignored, and so are
//! materials: no `.mtl` is opened. `\` at a line's end continues it. The reader is our own because the `tobj` crate
//! renumbers vertices by first use and drops those that no face uses, and has no line numbers; ids here are the file's.
//! Polygons with more than 4 corners are kept as their boundary (see `cell::polygon`).

use std::collections::BTreeSet;
use std::path::Path;

use super::Mesh;
use super::cell::{Cell, polygon, polygon_note, repeated_corner};
use super::format::nearest;
use super::text::real;
use super::validate::Draft;
use crate::error::InputError;

/// Statements that bear neither on points nor on edges and are skipped without a word.
const SILENT: [&str; 9] = ["vt", "vn", "o", "g", "s", "mtllib", "usemtl", "mg", "usemap"];
/// Statements that hold geometry which is not read: skipped with a note.
const NOTED: [&str; 24] = [
    "vp",
    "p",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "maplib",
    "shadow_obj",
    "trace_obj",
    "call",
];

/// Reads an OBJ file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let text = String::from_utf8_lossy(bytes);
    let mut draft = Draft::default();
    let (mut polygons, mut skipped) = (0, BTreeSet::new());
    let mut lines = text.lines().enumerate();
    while let Some((index, first)) = lines.next() {
        let line = index + 1;
        let fail = |message: String| InputError::at(file, line, message);
        let mut statement = first.trim_end().to_string();
        while statement.ends_with('\\') {
            statement.pop();
            statement.push(' ');
            let Some((_, more)) = lines.next() else { break };
            statement.push_str(more.trim_end());
        }
        let mut words = statement.split('#').next().unwrap_or("").split_whitespace();
        let Some(keyword) = words.next() else { continue };
        match keyword {
            "v" => {
                let mut point = [0.0; 3];
                for (x, axis) in point.iter_mut().zip(["x", "y", "z"]) {
                    let word = words.next().ok_or_else(|| fail(format!("vertex without {axis}")))?;
                    *x = real(word).map_err(|why| fail(format!("{axis} of vertex: {why}")))?;
                }
                draft.point(line, point);
            }
            "f" | "l" => {
                let corners = words
                    .map(|w| corner(w, draft.mesh.points.len()).map_err(&fail))
                    .collect::<Result<Vec<usize>, _>>()?;
                let (least, what) = if keyword == "f" { (3, "face") } else { (2, "line") };
                if corners.len() < least {
                    return Err(fail(format!(
                        "a {what} needs at least {least} corners, this has {}",
                        corners.len()
                    )));
                }
                if keyword == "l" {
                    corners.windows(2).for_each(|w| draft.cell(line, Cell::Line([w[0], w[1]])));
                } else if let Some(c) = repeated_corner(&corners) {
                    return Err(fail(format!("vertex {} stands twice in this face", c + 1)));
                } else {
                    polygons += polygon(&corners, |c| draft.cell(line, c));
                }
            }
            _ if SILENT.contains(&keyword) => {}
            _ if NOTED.contains(&keyword) => {
                skipped.insert(keyword.to_string());
            }
            _ => {
                let known: Vec<&str> = ["v", "f", "l"].into_iter().chain(SILENT).chain(NOTED).collect();
                let near =
                    nearest(keyword, &known).map(|k| format!(", did you mean '{k}'?")).unwrap_or_default();
                return Err(fail(format!("'{keyword}' is no OBJ statement{near}")));
            }
        }
    }
    draft.mesh.notes.extend(polygon_note(polygons));
    draft.mesh.notes.extend(skipped.into_iter().map(|k| format!("statements '{k}' ignored")));
    draft.finish(file)
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, 0-based.
fn corner(word: &str, so_far: usize) -> Result<usize, String> {
    let index = word.split('/').next().unwrap_or("");
    let number: i64 = index.parse().map_err(|_| format!("corner '{word}' is not a vertex number"))?;
    match (usize::try_from(number), usize::try_from(number.unsigned_abs())) {
        (Ok(0), _) => Err(format!("corner '{word}': OBJ numbers vertices from 1")),
        (Ok(n), _) => Ok(n - 1),
        (Err(_), Ok(back)) if back <= so_far => Ok(so_far - back),
        _ => Err(format!("corner '{word}' reaches back past the first of the {so_far} vertices so far")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_count_from_one_or_back_from_the_last() {
        assert_eq!(corner("3/1/2", 5), Ok(2));
        assert_eq!(corner("-1//4", 5), Ok(4));
        assert_eq!(corner("-5", 5), Ok(0));
        assert!(corner("-6", 5).unwrap_err().contains("'-6'"));
        assert!(corner("0", 5).unwrap_err().contains("from 1"));
        assert!(corner("a/1", 5).unwrap_err().contains("'a/1'"));
        assert!(corner("-9223372036854775808", 5).is_err());
    }
}
