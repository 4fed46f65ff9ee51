//! Any bytes as a mesh file of any format: an error or a valid mesh, never a panic and never a bad index.

use std::fs;

use hooke_harness::mesh;

const EXTENSIONS: [&str; 7] = ["obj", "mesh", "msh", "ply", "vtk", "vtu", "stl"];

/// Reads the bytes behind the first as the format that the first one chooses.
pub fn mesh(data: &[u8]) {
    let Some((format, content)) = data.split_first() else { return };
    let extension = EXTENSIONS[usize::from(*format) % EXTENSIONS.len()];
    let file = std::env::temp_dir().join(format!("hooke-fuzz-{}.{extension}", std::process::id()));
    if fs::write(&file, content).is_err() {
        return;
    }
    let loaded = mesh::load(&file);
    _ = fs::remove_file(&file);
    match loaded {
        Ok(mesh) => {
            let n = mesh.points.len();
            assert!(mesh.edges().iter().all(|[a, b]| a < b && *b < n), "edges are in range");
            assert!(mesh.points.as_flattened().iter().all(|x| x.is_finite()), "coordinates are finite");
        }
        Err(error) => {
            let text = error.to_string();
            assert!(
                !text.contains('\n') && text.contains("hooke-fuzz-"),
                "one line that names the file: {text}"
            );
        }
    }
}
