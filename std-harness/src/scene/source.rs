//! Where a scene comes from: a name of the catalogue, a mesh file, or a scene `.toml`. A name wins over a file of that
//! name; `./name` is the file.

use std::path::{Path, PathBuf};

use super::{Model, catalog, from_mesh, toml};
use crate::error::InputError;
use crate::mesh;

/// A scene, and the outputs that its file asks for.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scene.
    pub model: Model,
    /// What a scene file wants written; the command line wins.
    pub outputs: Outputs,
    /// The files it was read from: no output may take their place.
    pub files: Vec<PathBuf>,
}

/// Outputs that a scene file asks for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outputs {
    /// Folder for frames, plot and picture.
    pub dir: Option<PathBuf>,
    /// Frames a second.
    pub fps: Option<f64>,
    /// Final state as CSV.
    pub final_csv: Option<PathBuf>,
    /// Outcome as JSON.
    pub json: Option<PathBuf>,
}

impl From<Model> for Loaded {
    fn from(model: Model) -> Self {
        Self { model, outputs: Outputs::default(), files: Vec::new() }
    }
}

/// Loads the scene that a command line names.
pub fn load(scene: &str) -> Result<Loaded, InputError> {
    if let Some(model) = catalog::named(scene) {
        return model.map(Loaded::from);
    }
    let path = Path::new(scene);
    let looks_like_a_file = path.extension().is_some() || scene.contains(['/', '\\']) || path.exists();
    if !looks_like_a_file {
        return Err(catalog::unknown(scene));
    }
    if path.extension().is_some_and(|x| x.eq_ignore_ascii_case("toml")) {
        return toml::load(scene, path);
    }
    let model = from_mesh::model(scene, &mesh::load(path)?);
    Ok(Loaded { model, outputs: Outputs::default(), files: vec![path.to_path_buf()] })
}
