//! Stanford PLY, ASCII and binary: elements with named properties, described by a header.
//! Source: G. Turk, "The PLY Polygon File Format" (1994). Parsed by the `ply-rs-bw` crate.
//!
//! Read are `vertex` (x, y, z), `face` (list `vertex_indices` or `vertex_index`) and `edge` (`vertex1`, `vertex2`);
//! indices count from 0. Other elements are ignored with a note. Before the payload is read, the header's counts are
//! held against the file's length: the crate would trust them. Polygons: see `cell::polygon`.

use std::path::Path;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, ElementDef, Encoding, Header, Property, PropertyType, ScalarType};

use super::Mesh;
use super::cell::{Cell, polygon, polygon_note, repeated_corner};
use super::guard::guarded;
use crate::error::InputError;

/// Reads a PLY file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    guarded(file, || parse(file, bytes))?
}

fn parse(file: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let fail = |message: String| InputError::in_file(file, message);
    // Where a file is cut short, the crate names the line after its last.
    let last = bytes.split(|b| *b == b'\n').count();
    let line = |e: &ParseError| e.line().map(|line| line.min(last));
    let broken = |e: ParseError| InputError { file: Some(file.into()), line: line(&e), message: reason(&e) };
    let parser = Parser::<DefaultElement>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(broken)?;
    let rest = reader.get_ref().len() as u128;
    for element in header.elements.values() {
        let least = least_size(element, header.encoding) * element.count as u128;
        // The last line of an ASCII file may lack its end.
        if element.count > 0 && (element.properties.is_empty() || least > rest + 1) {
            let (count, name) = (element.count, &element.name);
            let message = format!("the header announces {count} of '{name}', which {rest} bytes cannot hold");
            return Err(fail(format!("{message}: it is cut short or its count is wrong")));
        }
    }
    let payload = parser.read_payload(&mut reader, &header).map_err(|e| match header.encoding {
        Encoding::Ascii => broken(e),
        // The crate counts an element as a line, but what is binary has none.
        _ => InputError { line: None, ..broken(e) },
    })?;
    let left = reader.get_ref().iter().filter(|b| !b.is_ascii_whitespace()).count();
    if left > 0 {
        return Err(fail(format!("{left} bytes follow the last element: the header's counts are too small")));
    }
    let mut mesh = Mesh::default();
    let mut polygons = 0;
    for (name, elements) in &payload {
        for (i, element) in elements.iter().enumerate() {
            let fail = |why: String| fail(format!("{name} {i}: {why}"));
            match name.as_str() {
                "vertex" => {
                    let [x, y, z] = ["x", "y", "z"].map(|axis| coordinate(element, axis));
                    mesh.points.push([x.map_err(fail)?, y.map_err(fail)?, z.map_err(fail)?]);
                }
                "face" => {
                    let corners = indices(element).map_err(fail)?;
                    if corners.len() < 3 {
                        return Err(fail(format!(
                            "a face needs at least 3 corners, this has {}",
                            corners.len()
                        )));
                    }
                    if let Some(c) = repeated_corner(&corners) {
                        return Err(fail(format!("vertex {c} stands twice in it")));
                    }
                    polygons += polygon(&corners, |c| mesh.cells.push(c));
                }
                "edge" => {
                    let [a, b] = ["vertex1", "vertex2"].map(|end| {
                        let values = element.get(end).and_then(whole).unwrap_or_default();
                        index(values.first().copied().ok_or(format!("no integer property '{end}'"))?)
                    });
                    mesh.cells.push(Cell::Line([a.map_err(fail)?, b.map_err(fail)?]));
                }
                _ => {}
            }
        }
    }
    mesh.notes.extend(polygon_note(polygons));
    mesh.notes.extend(ignored(&header));
    Ok(mesh)
}

/// What the crate says of a broken file, in one sentence: its own nests the line's text and the grammar it tried.
fn reason(e: &ParseError) -> String {
    let text = e.to_string();
    let text = e.line().and_then(|line| text.strip_prefix(&format!("Line {line}: "))).unwrap_or(&text);
    let Some((_, line)) = text.split_once("String: '") else { return text.into() };
    let line = line.split('\'').next().unwrap_or("").trim();
    match text.rsplit_once("Error: ").map(|(_, cause)| cause) {
        Some(cause) if cause.starts_with("error at") => {
            format!("'{line}' is no line of plain decimal numbers (nan and inf are not allowed)")
        }
        Some(cause) if !cause.starts_with("ParseError") => format!("'{line}': {cause}"),
        _ => format!("'{line}' is no line of a PLY header"),
    }
}

/// The fewest bytes one element can take.
fn least_size(element: &ElementDef, encoding: Encoding) -> u128 {
    let size = |scalar: &ScalarType| match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let property = |p: &PropertyType| match p {
        // A digit and what separates it from the next.
        _ if encoding == Encoding::Ascii => 2,
        PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => size(scalar),
    };
    element.properties.values().map(|p| property(&p.data_type)).sum()
}

fn ignored(header: &Header) -> Vec<String> {
    header
        .elements
        .values()
        .filter(|e| !["vertex", "face", "edge"].contains(&e.name.as_str()))
        .map(|e| format!("{} elements '{}' ignored", e.count, e.name))
        .collect()
}

fn coordinate(element: &DefaultElement, axis: &str) -> Result<f64, String> {
    match element.get(axis) {
        Some(Property::Float(x)) => Ok(f64::from(*x)),
        Some(Property::Double(x)) => Ok(*x),
        // Integer coordinates are allowed and exact.
        Some(other) => match whole(other).as_deref() {
            Some(&[x]) => Ok(x as f64),
            _ => Err(format!("property '{axis}' is not a number")),
        },
        None => Err(format!("no property '{axis}'")),
    }
}

fn indices(element: &DefaultElement) -> Result<Vec<usize>, String> {
    let list = element.get("vertex_indices").or_else(|| element.get("vertex_index"));
    let list = list.ok_or("no property 'vertex_indices' or 'vertex_index'")?;
    let values = whole(list).ok_or("its vertex indices are not integers")?;
    values.into_iter().map(index).collect()
}

fn index(value: i64) -> Result<usize, String> {
    usize::try_from(value).map_err(|_| format!("vertex {value}; PLY numbers vertices from 0"))
}

/// Any integer property, scalar or list.
fn whole(property: &Property) -> Option<Vec<i64>> {
    fn all<T: Copy + Into<i64>>(values: &[T]) -> Option<Vec<i64>> {
        Some(values.iter().map(|&v| v.into()).collect())
    }
    match property {
        Property::Char(v) => all(&[*v]),
        Property::UChar(v) => all(&[*v]),
        Property::Short(v) => all(&[*v]),
        Property::UShort(v) => all(&[*v]),
        Property::Int(v) => all(&[*v]),
        Property::UInt(v) => all(&[*v]),
        Property::ListChar(v) => all(v),
        Property::ListUChar(v) => all(v),
        Property::ListShort(v) => all(v),
        Property::ListUShort(v) => all(v),
        Property::ListInt(v) => all(v),
        Property::ListUInt(v) => all(v),
        Property::Float(_) | Property::Double(_) | Property::ListFloat(_) | Property::ListDouble(_) => None,
    }
}
