//! Any bytes as a mesh file of one format: an error of one line that names the file, or a valid mesh, never a panic and never a
//! bad index. What is asked of a mesh that was read is all that the harness asks of one.

use std::path::Path;

use hooke_harness::mesh::{self, Format, Info, Mesh};
use hooke_harness::scene::from_mesh;

/// Wavefront OBJ.
pub fn obj(data: &[u8]) {
    loads(Format::Obj, "fuzz.obj", data);
}

/// MEDIT.
pub fn medit(data: &[u8]) {
    loads(Format::Medit, "fuzz.mesh", data);
}

/// Gmsh MSH, 4.1 and 2.2, ASCII and binary.
pub fn gmsh(data: &[u8]) {
    loads(Format::Gmsh, "fuzz.msh", data);
}

/// Stanford PLY, ASCII and binary.
pub fn ply(data: &[u8]) {
    loads(Format::Ply, "fuzz.ply", data);
}

/// STL, ASCII and binary.
pub fn stl(data: &[u8]) {
    loads(Format::Stl, "fuzz.stl", data);
}

/// VTK legacy, ASCII and binary.
pub fn vtk(data: &[u8]) {
    loads(Format::VtkLegacy, "fuzz.vtk", data);
}

/// VTK XML: unstructured grids and polygonal data.
pub fn vtk_xml(data: &[u8]) {
    loads(Format::VtkXml, "fuzz.vtu", data);
}

fn loads(format: Format, file: &str, data: &[u8]) {
    let file = Path::new(file);
    match mesh::parse(file, data, format) {
        Ok(mesh) => is_valid(&mesh, file, format),
        Err(error) => {
            let text = error.to_string();
            assert!(!text.contains('\n'), "one line: {text}");
            assert_eq!(error.file.as_deref(), Some(file), "it names the file: {text}");
            let lines = 1 + data.iter().filter(|b| **b == b'\n').count();
            assert!(error.line.is_none_or(|line| (1..=lines).contains(&line)), "it names a line: {text}");
        }
    }
}

fn is_valid(mesh: &Mesh, file: &Path, format: Format) {
    let n = mesh.points.len();
    let edges = mesh.edges();
    assert!(edges.iter().all(|[a, b]| a < b && *b < n), "edges are in range");
    assert!(edges.is_sorted() && edges.windows(2).all(|two| two[0] != two[1]), "each edge stands once");
    assert!(mesh.points.as_flattened().iter().all(|x| x.is_finite()), "coordinates are finite");
    assert!(mesh.bending_pairs().iter().flatten().all(|i| *i < n), "bending pairs are in range");
    assert!(mesh.notes.iter().all(|note| !note.contains('\n')), "a note is one line");
    // What follows must answer, whatever it is: lengths of coordinates like 1e308 are infinite.
    _ = (Info::of(mesh, file, format), mesh.area_share(), mesh.volume_share());
    let model = from_mesh::model("fuzz", mesh);
    assert_eq!((model.position.len(), model.springs.len()), (n, edges.len()), "points are particles");
    match model.build::<f32>() {
        Ok(scene) => assert_eq!((scene.positions().len(), scene.state().springs()), (n, edges.len())),
        Err(error) => assert!(!error.to_string().contains('\n'), "one line: {error}"),
    }
}
