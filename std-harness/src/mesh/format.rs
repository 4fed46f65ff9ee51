//! Which format a file is in: its extension decides, in any case; contents are never guessed.

use std::path::Path;

use crate::error::InputError;

/// A mesh file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ (`.obj`).
    Obj,
    /// MEDIT ASCII (`.mesh`).
    Medit,
    /// Gmsh MSH (`.msh`).
    Gmsh,
    /// Stanford PLY (`.ply`).
    Ply,
    /// Stereolithography (`.stl`).
    Stl,
    /// VTK legacy (`.vtk`).
    VtkLegacy,
    /// VTK XML, unstructured (`.vtu`) or polygonal (`.vtp`).
    VtkXml,
}

const KNOWN: [(&str, Format); 8] = [
    ("mesh", Format::Medit),
    ("msh", Format::Gmsh),
    ("obj", Format::Obj),
    ("ply", Format::Ply),
    ("stl", Format::Stl),
    ("vtk", Format::VtkLegacy),
    ("vtp", Format::VtkXml),
    ("vtu", Format::VtkXml),
];

impl Format {
    /// The format of a file by its extension, or an error that lists the known ones.
    pub fn of(path: &Path) -> Result<Self, InputError> {
        let list = KNOWN.map(|(e, _)| format!(".{e}")).join(" ");
        let Some(extension) = path.extension().map(|e| e.to_string_lossy().to_lowercase()) else {
            return Err(InputError::in_file(
                path,
                format!("a mesh file needs an extension; known are {list}"),
            ));
        };
        if let Some((_, format)) = KNOWN.iter().find(|(e, _)| *e == extension) {
            return Ok(*format);
        }
        let near = nearest(&extension, &KNOWN.map(|(e, _)| e)).map(|e| format!(", did you mean .{e}?"));
        Err(InputError::in_file(
            path,
            format!("unknown mesh format .{extension}; known are {list}{}", near.unwrap_or_default()),
        ))
    }

    /// What reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Format::Obj => "Wavefront OBJ",
            Format::Medit => "MEDIT",
            Format::Gmsh => "Gmsh MSH",
            Format::Ply => "Stanford PLY",
            Format::Stl => "STL",
            Format::VtkLegacy => "VTK legacy",
            Format::VtkXml => "VTK XML",
        }
    }
}

/// The known word closest to a mistyped one, if any is close enough to be worth saying.
pub(super) fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    known
        .iter()
        .map(|k| (strsim::osa_distance(&word.to_lowercase(), &k.to_lowercase()), *k))
        .filter(|(distance, k)| *distance <= k.len() / 2)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_decides_in_any_case() {
        assert_eq!(Format::of(Path::new("a/b.MeSH")), Ok(Format::Medit));
        assert_eq!(Format::of(Path::new("b.x.VTP")), Ok(Format::VtkXml));
    }

    #[test]
    fn an_unknown_extension_lists_the_known_ones_and_the_nearest() {
        let e = Format::of(Path::new("a.mehs")).unwrap_err().to_string();
        assert!(e.starts_with("a.mehs: unknown mesh format .mehs; known are .mesh .msh .obj .ply"), "{e}");
        assert!(e.ends_with("did you mean .mesh?"), "{e}");
        let e = Format::of(Path::new("a.blend")).unwrap_err().to_string();
        assert!(!e.contains("did you mean"), "{e}");
        let e = Format::of(Path::new("bunny")).unwrap_err().to_string();
        assert!(e.contains("needs an extension") && e.contains(".vtu"), "{e}");
    }
}
