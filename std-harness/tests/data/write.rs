//! Writes a mesh in every format that is read, by hand from the formats' definitions: the tests' own good files.

use std::fmt::Write;

use hooke_harness::mesh::{Cell, Mesh};

fn join<T: ToString>(items: &[T]) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(" ")
}

fn plus_one(cell: &Cell) -> Vec<usize> {
    cell.corners().iter().map(|c| c + 1).collect()
}

fn faces(mesh: &Mesh) -> impl Iterator<Item = &Cell> {
    mesh.cells.iter().filter(|c| matches!(c, Cell::Triangle(_) | Cell::Quad(_)))
}

fn lines(mesh: &Mesh) -> impl Iterator<Item = &Cell> {
    mesh.cells.iter().filter(|c| matches!(c, Cell::Line(_)))
}

pub fn medit(mesh: &Mesh) -> String {
    let mut s = format!("MeshVersionFormatted 2\nDimension\n3\n\nVertices\n{}\n", mesh.points.len());
    mesh.points.iter().for_each(|p| writeln!(s, "{} 0", join(p)).unwrap());
    let names = ["Edges", "Triangles", "Quadrilaterals", "Tetrahedra", "Pyramids", "Prisms", "Hexahedra"];
    for (kind, name) in names.into_iter().enumerate() {
        let cells: Vec<_> = mesh.cells.iter().filter(|c| c.kind() == kind).collect();
        if !cells.is_empty() {
            writeln!(s, "\n{name}\n{}", cells.len()).unwrap();
            cells.iter().for_each(|c| writeln!(s, "{} 7", join(&plus_one(c))).unwrap());
        }
    }
    s + "\nCorners\n2\n1\n2\n\nEnd\n"
}

pub fn obj(mesh: &Mesh) -> String {
    let mut s = String::from("# by hand\nmtllib missing.mtl\no thing\n");
    mesh.points.iter().for_each(|p| writeln!(s, "v {}", join(p)).unwrap());
    s += "vt 0 0\nvn 0 0 1\nusemtl none\ns off\n";
    faces(mesh).for_each(|c| {
        let corners: Vec<_> = plus_one(c).iter().map(|i| format!("{i}/1/1")).collect();
        writeln!(s, "f {}", join(&corners)).unwrap();
    });
    lines(mesh).for_each(|c| writeln!(s, "l {}", join(&plus_one(c))).unwrap());
    s
}

const GMSH: [i32; 7] = [1, 2, 3, 4, 7, 6, 5];

pub fn gmsh(mesh: &Mesh) -> String {
    let n = mesh.points.len();
    let mut s = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 0\n$EndEntities\n$Nodes\n1 {n} 1 {n}\n"
    );
    writeln!(s, "3 1 0 {n}\n{}", join(&(1..=n).collect::<Vec<_>>())).unwrap();
    mesh.points.iter().for_each(|p| writeln!(s, "{}", join(p)).unwrap());
    let m = mesh.cells.len();
    writeln!(s, "$EndNodes\n$Elements\n{m} {m} 1 {m}").unwrap();
    for (i, c) in mesh.cells.iter().enumerate() {
        writeln!(s, "3 1 {} 1\n{} {}", GMSH[c.kind()], i + 1, join(&plus_one(c))).unwrap();
    }
    s + "$EndElements\n"
}

pub fn gmsh_legacy(mesh: &Mesh) -> String {
    let mut s = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.points.len());
    mesh.points.iter().enumerate().for_each(|(i, p)| writeln!(s, "{} {}", i + 1, join(p)).unwrap());
    writeln!(s, "$EndNodes\n$Elements\n{}", mesh.cells.len()).unwrap();
    for (i, c) in mesh.cells.iter().enumerate() {
        writeln!(s, "{} {} 2 0 1 {}", i + 1, GMSH[c.kind()], join(&plus_one(c))).unwrap();
    }
    s + "$EndElements\n"
}

pub fn gmsh_binary(mesh: &Mesh, big: bool) -> Vec<u8> {
    let mut b = b"$MeshFormat\n4.1 1 8\n".to_vec();
    let put = |b: &mut Vec<u8>, le: &[u8]| if big { b.extend(le.iter().rev()) } else { b.extend(le) };
    let int = |b: &mut Vec<u8>, i: i32| put(b, &i.to_le_bytes());
    let size = |b: &mut Vec<u8>, i: usize| put(b, &(i as u64).to_le_bytes());
    int(&mut b, 1);
    b.extend(b"\n$EndMeshFormat\n$Nodes\n");
    let n = mesh.points.len();
    [1, n, 1, n].into_iter().for_each(|i| size(&mut b, i));
    [3, 1, 0].into_iter().for_each(|i| int(&mut b, i));
    size(&mut b, n);
    (1..=n).for_each(|i| size(&mut b, i));
    mesh.points.iter().flatten().for_each(|x| put(&mut b, &x.to_le_bytes()));
    b.extend(b"\n$EndNodes\n$Elements\n");
    let m = mesh.cells.len();
    [m, m, 1, m].into_iter().for_each(|i| size(&mut b, i));
    for (i, c) in mesh.cells.iter().enumerate() {
        [3, 1, GMSH[c.kind()]].into_iter().for_each(|i| int(&mut b, i));
        size(&mut b, 1);
        size(&mut b, i + 1);
        plus_one(c).into_iter().for_each(|i| size(&mut b, i));
    }
    b.extend(b"\n$EndElements\n");
    b
}

fn ply_header(mesh: &Mesh, encoding: &str) -> String {
    format!(
        "ply\nformat {encoding} 1.0\ncomment by hand\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list uchar int vertex_indices\nelement edge {}\n\
         property int vertex1\nproperty int vertex2\nend_header\n",
        mesh.points.len(),
        faces(mesh).count(),
        lines(mesh).count()
    )
}

pub fn ply(mesh: &Mesh) -> String {
    let mut s = ply_header(mesh, "ascii");
    mesh.points.iter().for_each(|p| writeln!(s, "{}", join(p)).unwrap());
    faces(mesh).for_each(|c| writeln!(s, "{} {}", c.corners().len(), join(c.corners())).unwrap());
    lines(mesh).for_each(|c| writeln!(s, "{}", join(c.corners())).unwrap());
    s
}

pub fn ply_binary(mesh: &Mesh, big: bool) -> Vec<u8> {
    let mut b = ply_header(mesh, if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    let put = |b: &mut Vec<u8>, le: &[u8]| if big { b.extend(le.iter().rev()) } else { b.extend(le) };
    mesh.points.iter().flatten().for_each(|x| put(&mut b, &x.to_le_bytes()));
    for c in faces(mesh) {
        b.push(c.corners().len() as u8);
        c.corners().iter().for_each(|&i| put(&mut b, &(i as i32).to_le_bytes()));
    }
    lines(mesh).flat_map(Cell::corners).for_each(|&i| put(&mut b, &(i as i32).to_le_bytes()));
    b
}

const VTK: [u8; 7] = [3, 5, 9, 10, 14, 13, 12];

pub fn vtk(mesh: &Mesh) -> String {
    let mut s = format!(
        "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
        mesh.points.len()
    );
    mesh.points.iter().for_each(|p| writeln!(s, "{}", join(p)).unwrap());
    let (n, size) = (mesh.cells.len(), mesh.cells.iter().map(|c| 1 + c.corners().len()).sum::<usize>());
    writeln!(s, "\nCELLS {n} {size}").unwrap();
    mesh.cells.iter().for_each(|c| writeln!(s, "{} {}", c.corners().len(), join(c.corners())).unwrap());
    writeln!(s, "\nCELL_TYPES {n}").unwrap();
    mesh.cells.iter().for_each(|c| writeln!(s, "{}", VTK[c.kind()]).unwrap());
    s
}

pub fn vtk_binary(mesh: &Mesh) -> Vec<u8> {
    let mut b = format!(
        "# vtk DataFile Version 3.0\nby hand\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
        mesh.points.len()
    )
    .into_bytes();
    mesh.points.iter().flatten().for_each(|x| b.extend(x.to_be_bytes()));
    let (n, size) = (mesh.cells.len(), mesh.cells.iter().map(|c| 1 + c.corners().len()).sum::<usize>());
    b.extend(format!("\nCELLS {n} {size}\n").bytes());
    for c in &mesh.cells {
        b.extend((c.corners().len() as i32).to_be_bytes());
        c.corners().iter().for_each(|&i| b.extend((i as i32).to_be_bytes()));
    }
    b.extend(format!("\nCELL_TYPES {n}\n").bytes());
    mesh.cells.iter().for_each(|c| b.extend(i32::from(VTK[c.kind()]).to_be_bytes()));
    b.push(b'\n');
    b
}

fn array(kind: &str, name: &str, extra: &str, values: String) -> String {
    format!("<DataArray type=\"{kind}\" Name=\"{name}\"{extra} format=\"ascii\">\n{values}\n</DataArray>\n")
}

fn xml(kind: &str, piece: String, body: String) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\">\n<{kind}>\n\
         <Piece {piece}>\n{body}</Piece>\n</{kind}>\n</VTKFile>\n"
    )
}

fn topology(cells: &[&Cell]) -> String {
    let corners: Vec<usize> = cells.iter().flat_map(|c| c.corners()).copied().collect();
    let ends: Vec<usize> = cells
        .iter()
        .scan(0, |end, c| {
            *end += c.corners().len();
            Some(*end)
        })
        .collect();
    array("Int64", "connectivity", "", join(&corners)) + &array("Int64", "offsets", "", join(&ends))
}

fn xml_points(mesh: &Mesh) -> String {
    let values: Vec<f64> = mesh.points.iter().flatten().copied().collect();
    format!("<Points>\n{}</Points>\n", array("Float64", "Points", " NumberOfComponents=\"3\"", join(&values)))
}

pub fn vtu(mesh: &Mesh) -> String {
    let cells: Vec<&Cell> = mesh.cells.iter().collect();
    let types: Vec<u8> = cells.iter().map(|c| VTK[c.kind()]).collect();
    let piece = format!("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", mesh.points.len(), cells.len());
    let topology = topology(&cells) + &array("UInt8", "types", "", join(&types));
    xml("UnstructuredGrid", piece, format!("{}<Cells>\n{topology}</Cells>\n", xml_points(mesh)))
}

pub fn vtp(mesh: &Mesh) -> String {
    let (f, l): (Vec<_>, Vec<_>) = (faces(mesh).collect(), lines(mesh).collect());
    let piece = format!(
        "NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\"",
        mesh.points.len(),
        l.len(),
        f.len()
    );
    let body =
        format!("{}<Lines>\n{}</Lines>\n<Polys>\n{}</Polys>\n", xml_points(mesh), topology(&l), topology(&f));
    xml("PolyData", piece, body)
}

pub fn stl(mesh: &Mesh) -> String {
    let mut s = String::from("solid\n");
    for c in faces(mesh) {
        s += "facet normal 0 0 0\nouter loop\n";
        c.corners().iter().for_each(|&i| writeln!(s, "vertex {}", join(&mesh.points[i])).unwrap());
        s += "endloop\nendfacet\n";
    }
    s + "endsolid\n"
}

pub fn stl_binary(mesh: &Mesh) -> Vec<u8> {
    // A header that begins like an ASCII file's, as many exporters write.
    let mut b = format!("{:<80}", "solid by hand").into_bytes();
    b.extend((faces(mesh).count() as u32).to_le_bytes());
    for c in faces(mesh) {
        b.extend([0; 12]);
        c.corners().iter().flat_map(|&i| mesh.points[i]).for_each(|x| b.extend((x as f32).to_le_bytes()));
        b.extend([0; 2]);
    }
    b
}
