//! Where a scene comes from: a name of the catalogue, a mesh file, or a scene `.toml`. A name wins over a file of that
//! name; `./name` is the file.

use std::path::Path;

use super::{Model, catalog, from_mesh};
use crate::error::InputError;
use crate::{mesh, nearest};

/// Loads the scene that a command line names.
pub fn load(scene: &str) -> Result<Model, InputError> {
    if let Some(model) = catalog::named(scene) {
        return model;
    }
    let path = Path::new(scene);
    let looks_like_a_file = path.extension().is_some() || scene.contains(['/', '\\']) || path.exists();
    if !looks_like_a_file {
        let name = scene.split(':').next().unwrap_or(scene);
        let names: Vec<&str> = catalog::NAMES.iter().map(|known| known.0).collect();
        let forms: Vec<&str> = catalog::NAMES.iter().map(|known| known.1).collect();
        let near = nearest::suggestion(name, &names);
        return Err(InputError::new(format!(
            "unknown scene '{scene}'{near}; it is neither a file nor one of {}",
            forms.join(", ")
        )));
    }
    Ok(from_mesh::model(scene, &mesh::load(path)?))
}
