//! Gmsh MSH 4.1, ASCII and binary, and 2.2, ASCII: sections `$Name … $EndName`, of which Nodes and Elements are read.
//! Source: Gmsh Reference Manual, "MSH file format" and "MSH file format version 2 (Legacy)".
//!
//! Points are in the order of the file; elements name nodes by tag, which need be neither dense nor sorted. The reader
//! is our own because the `mshio` crate drops the tags of nodes that are dense but out of order (so that elements
//! would join the wrong nodes), reads 4.1 only and has no line numbers. Elements of higher order are refused: their
//! extra nodes would be particles that no edge holds.

use std::collections::HashMap;
use std::path::Path;

use super::Mesh;
use super::cell::{Cell, repeated_corner};
use super::gmsh_input::Input;
use crate::error::InputError;

struct Reader<'a> {
    input: Input<'a>,
    legacy: bool,
    /// Node tag → point id.
    ids: HashMap<usize, usize>,
    mesh: Mesh,
    elements: bool,
}

/// Reads an MSH file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let text = String::from_utf8_lossy(bytes);
    let (input, legacy) = Input::open(file, bytes, &text)?;
    let mut r = Reader { input, legacy, ids: HashMap::new(), mesh: Mesh::default(), elements: false };
    let mut in_order = true;
    while let Some(section) = r.input.section()? {
        match section.as_str() {
            "Nodes" if !r.mesh.points.is_empty() => return Err(r.input.fail("a second $Nodes section")),
            "Nodes" => {
                r.nodes()?;
                in_order = r.ids.iter().all(|(&tag, &id)| tag == id + 1);
            }
            "Elements" if r.elements => return Err(r.input.fail("a second $Elements section")),
            "Elements" => {
                r.elements = true;
                r.elements()?;
            }
            _ => {
                r.input.skip(&section)?;
                continue;
            }
        }
        r.input.end(&section)?;
    }
    if !r.elements {
        return Err(r
            .input
            .fail("no $Elements section: the file is cut short or was saved without elements"));
    }
    if !in_order {
        r.mesh
            .notes
            .push("node tags are not 1, 2, 3 …: ids follow the order of the nodes in the file".into());
    }
    Ok(r.mesh)
}

impl Reader<'_> {
    fn nodes(&mut self) -> Result<(), InputError> {
        let blocks = if self.legacy { 1 } else { self.input.size("the number of node blocks")? };
        let count = self.input.size("the number of nodes")?;
        if self.legacy {
            for _ in 0..count {
                let tag = self.input.size("a node tag")?;
                let point = self.coordinates()?;
                self.node(tag, point)?;
            }
            return Ok(());
        }
        self.input.size("the lowest node tag")?;
        self.input.size("the highest node tag")?;
        for _ in 0..blocks {
            let dimension = self.input.int("the dimension of a node block")?;
            self.input.int("the entity of a node block")?;
            let parametric = self.input.int("whether a node block is parametric")? != 0;
            let size = self.input.size("the number of nodes in a block")?;
            let mut tags = Vec::new();
            for _ in 0..size {
                tags.push(self.input.size("a node tag")?);
            }
            for tag in tags {
                let point = self.coordinates()?;
                for _ in 0..if parametric { dimension } else { 0 } {
                    self.input.real("a parametric coordinate")?;
                }
                self.node(tag, point)?;
            }
        }
        let found = self.mesh.points.len();
        if found == count {
            return Ok(());
        }
        Err(self.input.fail(format!("$Nodes announces {count} nodes, its blocks hold {found}")))
    }

    fn coordinates(&mut self) -> Result<[f64; 3], InputError> {
        Ok([self.input.real("x")?, self.input.real("y")?, self.input.real("z")?])
    }

    fn node(&mut self, tag: usize, point: [f64; 3]) -> Result<(), InputError> {
        if self.ids.insert(tag, self.mesh.points.len()).is_some() {
            return Err(self.input.fail(format!("node tag {tag} stands twice")));
        }
        self.mesh.points.push(point);
        Ok(())
    }

    fn elements(&mut self) -> Result<(), InputError> {
        let blocks = if self.legacy { 1 } else { self.input.size("the number of element blocks")? };
        let count = self.input.size("the number of elements")?;
        if self.legacy {
            for _ in 0..count {
                let tag = self.input.size("an element tag")?;
                let kind = self.input.int("an element type")?;
                for _ in 0..self.input.size("the number of element tags")? {
                    self.input.int("an element tag")?;
                }
                self.element(tag, kind)?;
            }
            return Ok(());
        }
        self.input.size("the lowest element tag")?;
        self.input.size("the highest element tag")?;
        let mut found = 0_usize;
        for _ in 0..blocks {
            self.input.int("the dimension of an element block")?;
            self.input.int("the entity of an element block")?;
            let kind = self.input.int("an element type")?;
            for _ in 0..self.input.size("the number of elements in a block")? {
                let tag = self.input.size("an element tag")?;
                self.element(tag, kind)?;
                found += 1;
            }
        }
        if found == count {
            return Ok(());
        }
        Err(self.input.fail(format!("$Elements announces {count} elements, its blocks hold {found}")))
    }

    /// Reads the nodes of an element and keeps it as a cell.
    fn element(&mut self, tag: usize, kind: i64) -> Result<(), InputError> {
        let corners = match kind {
            15 => 1,
            1 => 2,
            2 => 3,
            3 | 4 => 4,
            5 => 8,
            6 => 6,
            7 => 5,
            8..=14 | 16..=31 | 36.. => {
                let message =
                    format!("element {tag}: type {kind} is of higher order; save the mesh with order 1");
                return Err(self.input.fail(message));
            }
            _ => return Err(self.input.fail(format!("element {tag}: type {kind} is not known"))),
        };
        let mut tags = [0; 8];
        let mut c = [0; 8];
        for i in 0..corners {
            tags[i] = self.input.size("a node of an element")?;
            c[i] = match self.ids.get(&tags[i]) {
                Some(&id) => id,
                None => {
                    return Err(self.input.fail(format!("element {tag}: node {} does not exist", tags[i])));
                }
            };
        }
        if let Some(twice) = repeated_corner(&tags[..corners]) {
            return Err(self.input.fail(format!("element {tag}: node {twice} stands twice in it")));
        }
        let [p, q, r, s, t, u, v, w] = c;
        self.mesh.cells.push(match kind {
            1 => Cell::Line([p, q]),
            2 => Cell::Triangle([p, q, r]),
            3 => Cell::Quad([p, q, r, s]),
            4 => Cell::Tetrahedron([p, q, r, s]),
            5 => Cell::Hexahedron([p, q, r, s, t, u, v, w]),
            6 => Cell::Wedge([p, q, r, s, t, u]),
            7 => Cell::Pyramid([p, q, r, s, t]),
            // A point element: it has no edge, and its node is a particle anyway.
            _ => return Ok(()),
        });
        Ok(())
    }
}
