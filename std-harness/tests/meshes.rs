//! Meshes in every format: the same mesh read back, and broken files refused in one line that names file and value.

#[path = "data/write.rs"]
mod write;

use std::path::{Path, PathBuf};

use hooke_harness::mesh::{Cell, Mesh, info, load};

/// Writes a file of its own folder, so that tests run side by side.
fn file(test: &str, name: &str, bytes: &[u8]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meshes").join(test);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn corners() -> Vec<[f64; 3]> {
    [[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0], [0, 0, 4], [2, 0, 4], [2, 3, 4], [0, 3, 4]]
        .map(|p: [i32; 3]| p.map(|x| f64::from(x) * 0.5))
        .to_vec()
}

/// A box's surface in triangles that name the points for the first time in order, so that STL gives them the same ids.
fn surface() -> Mesh {
    let triangles = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 4, 5],
        [0, 5, 1],
        [1, 5, 6],
        [1, 6, 2],
        [2, 6, 7],
        [2, 7, 3],
        [3, 7, 4],
        [3, 4, 0],
        [4, 5, 6],
        [4, 6, 7],
    ];
    Mesh { points: corners(), cells: triangles.map(Cell::Triangle).to_vec(), notes: vec![] }
}

/// Faces and lines, and a last point that nothing uses.
fn flat() -> Mesh {
    let mut mesh = surface();
    mesh.points.push([9.0, 0.1, 1e-3]);
    mesh.cells =
        vec![Cell::Triangle([3, 1, 0]), Cell::Quad([4, 5, 6, 7]), Cell::Line([0, 6]), Cell::Line([7, 2])];
    mesh
}

/// One of each kind.
fn solid() -> Mesh {
    let mut mesh = flat();
    mesh.cells.extend([
        Cell::Tetrahedron([0, 1, 3, 4]),
        Cell::Pyramid([0, 1, 2, 3, 8]),
        Cell::Wedge([0, 1, 3, 4, 5, 7]),
        Cell::Hexahedron([0, 1, 2, 3, 4, 5, 6, 7]),
    ]);
    mesh
}

type Files = Vec<(&'static str, Vec<u8>)>;

fn solid_formats(m: &Mesh) -> Files {
    vec![
        ("a.mesh", write::medit(m).into()),
        ("a.msh", write::gmsh(m).into()),
        ("legacy.msh", write::gmsh_legacy(m).into()),
        ("little.msh", write::gmsh_binary(m, false)),
        ("big.msh", write::gmsh_binary(m, true)),
        ("a.vtk", write::vtk(m).into()),
        ("binary.vtk", write::vtk_binary(m)),
        ("a.vtu", write::vtu(m).into()),
    ]
}

fn flat_formats(m: &Mesh) -> Files {
    vec![
        ("a.obj", write::obj(m).into()),
        ("a.ply", write::ply(m).into()),
        ("little.ply", write::ply_binary(m, false)),
        ("big.ply", write::ply_binary(m, true)),
        ("a.vtp", write::vtp(m).into()),
    ]
}

fn stl_formats(m: &Mesh) -> Files {
    vec![("a.STL", write::stl(m).into()), ("binary.stl", write::stl_binary(m))]
}

fn sorted(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut cells: Vec<_> =
        mesh.cells.iter().map(|c| [vec![c.kind()], c.corners().to_vec()].concat()).collect();
    cells.sort();
    cells
}

#[test]
fn every_format_gives_back_the_points_and_cells_it_can_hold() {
    let (solid, flat, surface) = (solid(), flat(), surface());
    let sets =
        [(&solid, solid_formats(&solid)), (&flat, flat_formats(&flat)), (&surface, stl_formats(&surface))];
    for (mesh, files) in sets {
        for (name, bytes) in files {
            let read = load(&file("good", name, &bytes)).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(read.points, mesh.points, "{name}");
            // MEDIT and VTK group cells by kind; within a file the cells are the same.
            assert_eq!(sorted(&read), sorted(mesh), "{name}");
        }
    }
}

#[test]
fn the_same_box_has_the_same_edges_in_every_format() {
    let m = surface();
    let files = [solid_formats(&m), flat_formats(&m), stl_formats(&m)].concat();
    assert_eq!(files.len(), 15);
    for (name, bytes) in files {
        let read = load(&file("same", name, &bytes)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(read.edges(), m.edges(), "{name}");
        assert_eq!((read.edges().len(), read.area(), read.components()), (18, 13.0, 1), "{name}");
        assert!(read.isolated().is_empty() && read.repeated().is_empty(), "{name}");
    }
}

#[test]
fn cutting_a_file_anywhere_never_panics_and_only_a_cut_at_a_statement_can_pass() {
    let (solid, flat, surface) = (solid(), flat(), surface());
    let sets = [solid_formats(&solid), flat_formats(&flat), stl_formats(&surface)].concat();
    for (name, bytes) in sets {
        let whole = load(&file("cut", name, &bytes)).unwrap();
        for cut in (0..bytes.len().saturating_sub(20)).step_by(7) {
            let path = file("cut", name, &bytes[..cut]);
            match load(&path) {
                Err(e) => {
                    let text = e.to_string();
                    assert!(text.starts_with(&format!("{}:", path.display())), "{name} at {cut}: {text}");
                    assert_eq!(text.lines().count(), 1);
                }
                // OBJ has no counts and MEDIT's End is optional: what is there must be a prefix.
                Ok(part) => {
                    assert!(
                        name.ends_with(".obj") || name.ends_with(".mesh"),
                        "{name} cut at {cut} of {} passes",
                        bytes.len()
                    );
                    assert!(part.cells.len() <= whole.cells.len());
                }
            }
        }
    }
}

#[test]
fn changing_any_byte_never_panics() {
    let (solid, flat, surface) = (solid(), flat(), surface());
    let sets = [solid_formats(&solid), flat_formats(&flat), stl_formats(&surface)].concat();
    let mut refused = 0;
    for (name, bytes) in sets {
        for at in (0..bytes.len()).step_by(5) {
            for byte in [0xff, b'9', b'-'] {
                let mut broken = bytes.clone();
                broken[at] = byte;
                if let Err(e) = load(&file("flip", name, &broken)) {
                    assert!(e.file.is_some() && !e.message.is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 1000, "only {refused} refused");
}

/// Asserts that a file is refused with a message that names it and holds all of `parts`.
fn refused(name: &str, bytes: impl AsRef<[u8]>, parts: &[&str]) {
    let test = format!("broken{:?}", std::thread::current().id()).replace(['(', ')'], "");
    let path = file(&test, name, bytes.as_ref());
    let text = match load(&path) {
        Err(e) => e.to_string(),
        Ok(mesh) => panic!("{name} with {parts:?} passes: {mesh:?}"),
    };
    assert!(text.starts_with(&format!("{}:", path.display())), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    parts.iter().for_each(|p| assert!(text.contains(p), "no '{p}' in: {text}"));
}

#[test]
fn missing_empty_and_unknown_files_are_refused() {
    for extension in ["obj", "mesh", "msh", "ply", "vtk", "vtu", "vtp", "stl"] {
        let e = load(Path::new(&format!("not/there.{extension}"))).unwrap_err().to_string();
        assert!(e.starts_with(&format!("not/there.{extension}: cannot read: No such file")), "{e}");
        refused(&format!("a.{extension}"), "", &["empty"]);
        refused(&format!("a.{extension}"), " \n\n", &["empty"]);
        let garbage: Vec<u8> = (0..5000_u32).map(|i| (i * i * 7 + i / 3) as u8 | 0x80).collect();
        refused(&format!("a.{extension}"), garbage, &[]);
    }
    refused("a.meshb", "x", &[".meshb", "did you mean .mesh?", ".vtu"]);
}

/// Replaces the first `from` of a good text, which must be there.
fn swap(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no {from:?} in {text}");
    text.replacen(from, to, 1)
}

#[test]
fn broken_medit_files_are_refused_with_their_line() {
    let good = write::medit(&surface());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.mesh", swap(&good, from, to), parts);
    bad("1 0 0 0", "1 nan 0 0", &[".mesh:8:", "'nan'", "y of vertex 2 of 8"]);
    bad("1 0 0 0", "inf 0 0 0", &[".mesh:8:", "'inf'"]);
    bad("1 0 0 0", "1 1e999 0 0", &[".mesh:8:", "'1e999'"]);
    bad("1 0 0 0", "1 zero 0 0", &[".mesh:8:", "'zero'"]);
    bad("1 2 3 7", "0 2 3 7", &[".mesh:18:", "vertex 0", "from 1"]);
    bad("1 2 3 7", "9 2 3 7", &[".mesh:18:", "vertex 9", "1 to 8", "triangle"]);
    bad("1 2 3 7", "-1 2 3 7", &[".mesh:18:", "'-1'"]);
    bad("1 2 3 7", "1 2 2 7", &[".mesh:18:", "vertex 2", "twice"]);
    bad("1 2 3 7", "1 2 18446744073709551615 7", &[".mesh:18:", "18446744073709551615"]);
    bad("Triangles\n12", "Triangles\n13", &["'Corners'", "entry 13 of 13"]);
    bad("Triangles\n12", "Triangles\n11", &["is no MEDIT keyword"]);
    bad("Vertices\n8", "Vertices\n99999999999", &["'Triangles'", "vertex 9 of 99999999999"]);
    bad("Vertices\n8", "Vertices\n99999999999999999999", &["'99999999999999999999'"]);
    bad("Triangles", "Triangels", &["'Triangels'", "did you mean Triangles?"]);
    bad("Dimension\n3", "Dimension\n4", &[".mesh:3:", "Dimension 4"]);
    bad("MeshVersionFormatted 2", "MeshVersionFormatted 9", &[".mesh:1:", "version 9"]);
    refused("a.mesh", "MeshVersionFormatted 1\nDimension 3\nEnd\n", &["no points"]);
}

#[test]
fn a_plane_medit_mesh_lies_at_z_0() {
    let text = "MeshVersionFormatted 1 Dimension 2 # plane\nVertices 3  1 2 0  3 4 0  5 6.5 0\nTriangles 1 1 2 3 0 End";
    let mesh = load(&file("plane", "a.mesh", text.as_bytes())).unwrap();
    assert_eq!(mesh.points, [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0], [5.0, 6.5, 0.0]]);
    assert_eq!((mesh.cells, mesh.notes), (vec![Cell::Triangle([0, 1, 2])], vec![]));
}

#[test]
fn broken_obj_files_are_refused_with_their_line() {
    let good = write::obj(&flat());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.obj", swap(&good, from, to), parts);
    bad("v 1 0 0", "v 1 NaN 0", &[".obj:5:", "y", "'NaN'"]);
    bad("v 1 0 0", "v 1 -inf 0", &[".obj:5:", "'-inf'"]);
    bad("v 1 0 0", "v 1 x 0", &[".obj:5:", "'x'"]);
    bad("v 1 0 0", "v 1 0", &[".obj:5:", "without z"]);
    bad("f 4/", "f 0/", &[".obj:17:", "'0/1/1'", "from 1"]);
    bad("f 4/", "f 10/", &[".obj:17:", "vertex 10", "1 to 9"]);
    bad("f 4/", "f -10/", &[".obj:17:", "'-10/1/1'", "9 vertices"]);
    bad("f 4/", "f 2/", &[".obj:17:", "vertex 2", "twice"]);
    bad("f 4/1/1 2/1/1 1/1/1", "f 4 2", &[".obj:17:", "3 corners", "has 2"]);
    bad("l 1 7", "l 1", &[".obj:19:", "has 1"]);
    bad("l 1 7", "l 7 7", &[".obj:19:", "vertex 7", "twice"]);
    bad("l 1 7", "lines 1 7", &[".obj:19:", "'lines'"]);
    refused("a.obj", "# nothing\n", &["no points"]);
    refused(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 0\nf 1 2 3 4 1\n",
        &[".obj:6:", "vertex 1", "twice"],
    );
}

#[test]
fn obj_polygons_keep_their_boundary_and_relative_and_continued_lines_are_read() {
    let text = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf -5 -4 -3 \\\n -2 -1\nl 1 3 5\np 1\n";
    let mesh = load(&file("polygon", "a.obj", text.as_bytes())).unwrap();
    assert_eq!(mesh.edges(), [[0, 1], [0, 2], [0, 4], [1, 2], [2, 3], [2, 4], [3, 4]]);
    assert_eq!(mesh.area(), 0.0);
    assert_eq!(mesh.notes.len(), 2);
    assert!(mesh.notes[0].starts_with("1 polygons") && mesh.notes[1].contains("'p'"), "{:?}", mesh.notes);
}

#[test]
fn broken_gmsh_files_are_refused_with_their_line() {
    let good = write::gmsh(&surface());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.msh", swap(&good, from, to), parts);
    bad("\n1 0 0\n", "\n1 nan 0\n", &[".msh:12:", "'nan'"]);
    bad("\n1 0 0\n", "\n1 inf 0\n", &[".msh:12:", "'inf'"]);
    bad("\n1 0 0\n", "\n1 o 0\n", &[".msh:12:", "'o'"]);
    bad("3 1 2 1\n1 1 2 3", "3 1 2 1\n1 0 2 3", &[".msh:23:", "element 1", "node 0"]);
    bad("3 1 2 1\n1 1 2 3", "3 1 2 1\n1 9 2 3", &[".msh:23:", "element 1", "node 9"]);
    bad("3 1 2 1\n1 1 2 3", "3 1 2 1\n1 1 2 2", &[".msh:23:", "node 2", "twice"]);
    bad("3 1 2 1\n1 1 2 3", "3 1 9 1\n1 1 2 3 4 5 6", &["element 1", "type 9", "order 1"]);
    bad("3 1 2 1\n1 1 2 3", "3 1 99 1\n1 1 2 3", &["type 99"]);
    bad("1 2 3 4 5 6 7 8\n", "1 2 3 4 5 6 7 7\n", &["node tag 7", "twice"]);
    bad("1 8 1 8\n", "1 9 1 8\n", &["announces 9 nodes", "hold 8"]);
    bad("12 12 1 12\n", "12 13 1 12\n", &["announces 13 elements", "hold 12"]);
    bad("12 12 1 12\n", "11 12 1 12\n", &["hold 11"]);
    bad("3 1 0 8\n", "3 1 0 99999999999\n", &["'1.5' is not a whole number"]);
    bad("12 12 1 12\n", "99999999999 12 1 12\n", &["'$EndElements'"]);
    bad("4.1 0 8", "4.0 0 8", &[".msh:2:", "4.0", "msh41"]);
    bad("4.1 0 8", "4.1 2 8", &[".msh:2:", "file type 2"]);
    bad("$Entities", "Entities", &["'Entities'", "section"]);
    refused("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", &["no $Elements"]);
    let binary = write::gmsh_binary(&surface(), false);
    let place = binary.windows(6).position(|w| w == b"$Nodes").unwrap() + 7;
    let mut huge = binary.clone();
    huge[place + 44..place + 52].fill(0x7f);
    refused("a.msh", huge, &["before byte", "cut short"]);
    let mut nan = binary;
    nan[place + 52 + 64..place + 52 + 72].fill(0xff);
    refused("a.msh", nan, &["before byte", "x is NaN"]);
}

#[test]
fn gmsh_tags_may_be_sparse_and_out_of_order() {
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 3 1 3\n0 1 0 1\n3\n30 0 0\n1 1 1 2\n1\n2\n10 0 0 0.5\n20 0 0 0.5\n\
        $EndNodes\n$Elements\n1 2 1 2\n1 1 1 2\n1 1 2\n2 2 3\n$EndElements\n";
    let mesh = load(&file("tags", "a.msh", text.as_bytes())).unwrap();
    assert_eq!(mesh.points, [[30.0, 0.0, 0.0], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0]]);
    assert_eq!(mesh.cells, [Cell::Line([1, 2]), Cell::Line([2, 0])]);
    assert_eq!(mesh.notes.len(), 1);
}

#[test]
fn broken_ply_files_are_refused_with_their_line_or_element() {
    let good = write::ply(&flat());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.ply", swap(&good, from, to), parts);
    bad("\n1 0 0\n", "\n1 nan 0\n", &[".ply:15:", "nan"]);
    bad("\n1 0 0\n", "\n1 inf 0\n", &[".ply:15:", "inf"]);
    bad("\n1 0 0\n", "\n1 1e999 0\n", &["point 1", "inf"]);
    bad("\n1 0 0\n", "\n1 o 0\n", &[".ply:15:", "1 o 0"]);
    bad("3 3 1 0", "3 9 1 0", &["cell 0", "vertex 9", "0 to 8"]);
    bad("3 3 1 0", "3 -1 1 0", &["face 0", "vertex -1"]);
    bad("3 3 1 0", "3 1 1 0", &["face 0", "vertex 1", "twice"]);
    bad("3 3 1 0", "2 3 1", &["face 0", "has 2"]);
    bad("3 3 1 0", "99999999999 3 1 0", &[".ply:23:", "99999999999"]);
    bad("vertex 9", "vertex 8", &[".ply:"]);
    bad("vertex 9", "vertex 10", &[".ply:"]);
    bad("edge 2", "edge 1", &["bytes follow"]);
    bad("edge 2", "edge 3", &[".ply:", "expected 3, got 2"]);
    bad("vertex 9", "vertex 99999999999", &["99999999999", "'vertex'", "cannot hold"]);
    bad("element vertex 9", "element void 99999999999\nelement vertex 9", &["99999999999", "'void'"]);
    bad("property double z", "property double w", &["vertex 0", "'z'"]);
    bad("end_header", "end_haeder", &[".ply:"]);
    let mut nan = write::ply_binary(&flat(), false);
    let start = nan.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    nan[start + 24..start + 32].fill(0xff);
    refused("a.ply", nan, &["point 1", "x is NaN"]);
}

#[test]
fn broken_vtk_files_are_refused_with_their_element() {
    let good = write::vtk(&surface());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.vtk", swap(&good, from, to), parts);
    bad("\n1 0 0\n", "\n1 nan 0\n", &[".vtk:7:", "'nan'"]);
    bad("\n1 0 0\n", "\n1 inf 0\n", &[".vtk:7:", "'inf'"]);
    bad("\n1 0 0\n", "\n1 o 0\n", &[".vtk:7:", "'o'"]);
    bad("\n1 0 0\n", "\n1 1e999 0\n", &[".vtk:7:", "'1e999'"]);
    bad("3 0 1 2", "3 8 1 2", &["cell 0", "vertex 8", "0 to 7"]);
    bad("3 0 1 2", "3 -1 1 2", &["legacy"]);
    bad("3 0 1 2", "3 1 1 2", &["cell 0", "vertex 1", "twice"]);
    bad("3 0 1 2", "4 0 1 2", &["cell "]);
    bad("POINTS 8", "POINTS 7", &[".vtk:13:", "'0'", "too small"]);
    bad("POINTS 8", "POINTS 99999999999", &[".vtk:5:", "'99999999999'"]);
    bad("POINTS 8", "POINTS 1400000000", &["announces 4200000000 numbers"]);
    bad("CELLS 12", "CELLS 13", &["13 cells", "12"]);
    bad("CELL_TYPES 12\n", "CELL_TYPES 11\n", &["'5'", "too small"]);
    bad("\n5\n", "\n22\n", &["cell 0", "type 22", "order 1"]);
    bad("UNSTRUCTURED_GRID", "UNSTRUCTURED_GRIT", &["legacy"]);
    refused(
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 1 1 1\nPOINTS 1 float\n0 0 0\n",
        &["structured grid"],
    );
    let text = write::vtu(&surface());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.vtu", swap(&text, from, to), parts);
    bad("0 0 0 1 0 0", "0 0 0 nan 0 0", &["point 1", "NaN"]);
    bad("0 0 0 1 0 0", "0 0 0 inf 0 0", &["point 1", "inf"]);
    bad("0 0 0 1 0 0", "0 0 0 one 0 0", &["XML"]);
    bad("0 1 2 0 2 3", "0 8 2 0 2 3", &["cell 0", "vertex 8"]);
    bad("0 1 2 0 2 3", "0 2 2 0 2 3", &["cell 0", "vertex 2", "twice"]);
    bad("3 6 9", "3 5 9", &["cell 1"]);
    bad("NumberOfPoints=\"8\"", "NumberOfPoints=\"9\"", &["XML"]);
    bad("NumberOfCells=\"12\"", "NumberOfCells=\"13\"", &["XML"]);
    bad("NumberOfPoints=\"8\"", "NumberOfPoints=\"99999999999\"", &["XML"]);
    bad("</VTKFile>", "", &["XML"]);
    let text = write::vtp(&flat());
    refused("a.vtp", swap(&text, "3 1 0 4 5", "9 1 0 4 5"), &["vertex 9", "0 to 8"]);
    refused("a.vtp", swap(&text, "NumberOfPolys=\"2\"", "NumberOfPolys=\"3\""), &["XML"]);
}

#[test]
fn broken_stl_files_are_refused_with_their_facet() {
    let good = write::stl(&surface());
    let bad = |from: &str, to: &str, parts: &[&str]| refused("a.stl", swap(&good, from, to), parts);
    bad("vertex 1 0 0", "vertex 1 nan 0", &["facet 0", "NaN"]);
    bad("vertex 1 0 0", "vertex 1 inf 0", &["facet 0", "inf"]);
    bad("vertex 1 0 0", "vertex 1 o 0", &["facet 0"]);
    bad("vertex 1 0 0", "vertex 0 0 0", &["facet 0", "(0, 0, 0)", "twice"]);
    bad("endloop\n", "", &["facet 0", "endloop"]);
    bad("endsolid", "", &["facet 12"]);
    refused("a.stl", "solid\nendsolid\n", &["no points"]);
    let binary = write::stl_binary(&surface());
    let mut more = binary.clone();
    more[80] = 13;
    refused("a.stl", &more[..], &["facet"]);
    more[..5].fill(b' ');
    refused("a.stl", &more[..], &["announces 13 facets", "for 12"]);
    more[80..84].fill(0xff);
    refused("a.stl", &more[..], &["announces 4294967295 facets"]);
    let mut nan = binary;
    nan[84 + 50 + 12..84 + 50 + 16].fill(0xff);
    refused("a.stl", nan, &["facet 1", "NaN"]);
}

#[test]
fn info_prints_and_serializes_what_a_mesh_holds() {
    let mut mesh = solid();
    mesh.points[8] = mesh.points[6];
    let path = file("info", "a.mesh", write::medit(&mesh).as_bytes());
    let info = info(&path).unwrap();
    assert_eq!((info.points, info.edges, info.components), (9, mesh.edges().len(), 1));
    assert_eq!((info.repeated.clone(), info.isolated.len()), (vec![[6, 8]], 0));
    let text = info.to_string();
    for line in [
        "format        MEDIT",
        "points        9",
        "cells         2 lines, 1 triangles, 1 quadrilaterals, 1 tetrahedra, 1 pyramids, 1 wedges, 1 hexahedra",
        "repeated      1 (6–8)",
        "z             0 … 2",
        "volume        6",
        "note          line ",
    ] {
        assert!(text.lines().any(|l| l.starts_with(line)), "no '{line}' in\n{text}");
    }
    let json: serde_json::Value = serde_json::to_value(&info).unwrap();
    assert_eq!(json["points"], 9);
    assert_eq!(json["repeated"], serde_json::json!([[6, 8]]));
    assert_eq!(json["cells"][6], serde_json::json!({"kind": "hexahedra", "count": 1}));
    assert_eq!(json["bounds"][1], serde_json::json!([1.0, 1.5, 2.0]));
}

#[test]
fn independent_readers_agree_on_obj_and_gmsh() {
    let mesh = flat();
    let path = file("others", "a.obj", write::obj(&mesh).as_bytes());
    let options = tobj::LoadOptions { single_index: false, triangulate: false, ..Default::default() };
    let (models, _) = tobj::load_obj(&path, &options).unwrap();
    let theirs: Vec<[f64; 3]> = models
        .iter()
        .flat_map(|m| m.mesh.indices.iter().map(|&i| [0, 1, 2].map(|k| m.mesh.positions[3 * i as usize + k])))
        .collect();
    let ours = load(&path).unwrap();
    let ours: Vec<[f64; 3]> =
        ours.cells.iter().flat_map(|c| c.corners().iter().map(|&i| ours.points[i])).collect();
    assert_eq!(ours, theirs);

    for bytes in [write::gmsh(&solid()).into_bytes(), write::gmsh_binary(&solid(), true)] {
        let theirs = mshio::parse_msh_bytes(&bytes).unwrap().data;
        let ours = load(&file("others", "a.msh", &bytes)).unwrap();
        let nodes: Vec<_> = theirs.nodes.unwrap().node_blocks.into_iter().flat_map(|b| b.nodes).collect();
        assert_eq!(ours.points, nodes.iter().map(|n| [n.x, n.y, n.z]).collect::<Vec<_>>());
        let cells: Vec<_> =
            theirs.elements.unwrap().element_blocks.into_iter().flat_map(|b| b.elements).collect();
        let tags = |c: &Cell| c.corners().iter().map(|&i| i as u64 + 1).collect::<Vec<_>>();
        assert_eq!(
            ours.cells.iter().map(tags).collect::<Vec<_>>(),
            cells.into_iter().map(|e| e.nodes).collect::<Vec<_>>()
        );
    }
}

#[test]
fn vtk_offsets_of_version_5_and_legacy_polydata_are_read() {
    let text = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n\
        CELLS 3 6\nOFFSETS vtktypeint64\n0 2 6\nCONNECTIVITY vtktypeint64\n3 0 0 1 2 3\nCELL_TYPES 2\n3\n10\n";
    let mesh = load(&file("vtk5", "a.vtk", text.as_bytes())).unwrap();
    assert_eq!(mesh.cells, [Cell::Line([3, 0]), Cell::Tetrahedron([0, 1, 2, 3])]);
    let text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n\
        LINES 1 4\n3 0 1 2\nPOLYGONS 1 4\n3 1 2 3\n";
    let mesh = load(&file("vtk5", "a.vtk", text.as_bytes())).unwrap();
    assert_eq!(mesh.cells, [Cell::Line([0, 1]), Cell::Line([1, 2]), Cell::Triangle([1, 2, 3])]);
    refused("a.vtk", swap(text, "3 1 2 3", "3 1 2 3 3 0 1 2"), &[".vtk:10:", "announces 4 numbers", "are 8"]);
    refused("a.vtk", swap(text, "3 1 2 3\n", "3 1 2 3\n3 0 1 2\n"), &[".vtk:11:", "'3'", "too small"]);
    refused(
        "a.vtk",
        swap(text, "POLYGONS", "POLIGONS"),
        &[".vtk:9:", "'POLIGONS'", "did you mean POLYGONS?"],
    );
    let mut binary = b"# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n".to_vec();
    [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.extend(b"\nPOLYGONS 1 4\n");
    [3_i32, 2, 1, 0].iter().for_each(|i| binary.extend(i.to_be_bytes()));
    let mesh = load(&file("vtk5", "a.vtk", &binary)).unwrap();
    assert_eq!((mesh.points[1], mesh.cells), ([1.0, 0.0, 0.0], vec![Cell::Triangle([2, 1, 0])]));
    refused("a.vtk", &binary[..binary.len() - 3], &["POLYGONS announces 4 numbers, 3 are left"]);
}

#[test]
fn what_the_vtk_crate_writes_is_read_back_bit_for_bit() {
    use vtkio::model::{ByteOrder, DataSet, PolyDataPiece, Version, VertexNumbers, Vtk};
    let mut mesh = flat();
    mesh.points[8] = [1.0 / 3.0, -1e-300, f64::MAX];
    mesh.cells = vec![Cell::Line([0, 6]), Cell::Triangle([3, 1, 8])];
    let piece = PolyDataPiece {
        points: mesh.points.concat().into(),
        lines: Some(VertexNumbers::XML { connectivity: vec![0, 6], offsets: vec![2] }),
        polys: Some(VertexNumbers::XML { connectivity: vec![3, 1, 8], offsets: vec![3] }),
        ..Default::default()
    };
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(piece),
        file_path: None,
    };
    let path = file("crate", "a.vtp", b"");
    vtk.export(&path).unwrap();
    let read = load(&path).unwrap();
    assert_eq!((read.points, read.cells), (mesh.points, mesh.cells));
}

/// A mesh of the user's, where there is one.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/meshes").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped: {name} is not in ../shared/meshes");
    None
}

#[test]
fn the_bunny_has_its_points_and_edges() {
    if let Some(path) = shared("coarse_bunny.mesh") {
        let bunny = info(&path).unwrap();
        assert_eq!((bunny.points, bunny.edges, bunny.components), (699, 3_521, 1));
    }
    if let Some(path) = shared("coarse_bunny.obj") {
        let bunny = load(&path).unwrap();
        assert_eq!((bunny.points.len(), bunny.cells.len(), bunny.edges().len()), (502, 1_000, 1_500));
        assert!(bunny.cells.iter().all(|c| matches!(c, Cell::Triangle(_))));
    }
}
