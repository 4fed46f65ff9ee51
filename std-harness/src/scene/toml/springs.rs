//! `[stiffness]`, `[bending]`, `damping`, `cables` and the `[[spring]]` entries.
//!
//! An axial stiffness EA becomes k = EA/l₀ at the end, with the rest length that the spring then has.

use std::collections::HashMap;
use std::ops::Range;

use super::Source;
use super::schema::{SceneFile, SpringEntry};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::{Model, from_mesh};

/// What a spring's k comes from, if not from the source: EA (N) and the place that says so.
type Axial = Option<(f64, Range<usize>)>;

/// Sets the springs that the file asks for.
pub(super) fn set(
    model: &mut Model,
    mesh: Option<&Mesh>,
    scene: &SceneFile,
    source: &Source<'_>,
) -> Result<(), InputError> {
    let (stiffness, axial) = everywhere(scene, source)?;
    if let Some(k) = stiffness {
        model.springs.iter_mut().for_each(|spring| spring.stiffness = k);
    }
    let mut axials = vec![axial.clone(); model.springs.len()];
    bend(model, mesh, scene, source)?;
    axials.resize(model.springs.len(), None);
    for spring in &mut model.springs {
        spring.damping = scene.damping.map_or(spring.damping, |c| c.0);
        spring.cable = scene.cables.unwrap_or(spring.cable);
    }

    let mut index: HashMap<[usize; 2], usize> =
        model.springs.iter().enumerate().map(|(j, s)| (pair(s.ends), j)).collect();
    let mut lines: HashMap<[usize; 2], usize> = HashMap::new();
    for entry in &scene.spring {
        let at = entry.span();
        let entry = entry.get_ref();
        let ends = ends(model, entry).map_err(|m| source.error(&at, m))?;
        if let Some(first) = lines.insert(ends, source.line(&at)) {
            let message = format!("{}: stands twice, first on line {first}", named(ends));
            return Err(source.error(&at, message));
        }
        let j = *index.entry(ends).or_insert_with(|| {
            model.join(entry.a, entry.b, stiffness.unwrap_or(from_mesh::STIFFNESS));
            axials.push(axial.clone());
            let j = model.springs.len() - 1;
            model.springs[j].damping = scene.damping.map_or(0.0, |c| c.0);
            model.springs[j].cable = scene.cables.unwrap_or(false);
            j
        });
        let spring = &mut model.springs[j];
        spring.rest_length = entry.rest_length.map_or(spring.rest_length, |l| l.0);
        spring.damping = entry.damping.map_or(spring.damping, |c| c.0);
        spring.cable = entry.cable.unwrap_or(spring.cable);
        match (entry.stiffness, entry.ea) {
            (None, None) => {}
            (Some(k), None) => (spring.stiffness, axials[j]) = (k.0, None),
            (None, Some(ea)) => axials[j] = Some((ea.0, at)),
            (Some(_), Some(_)) => {
                return Err(source.error(&at, format!("{}: say stiffness or ea, not both", named(ends))));
            }
        }
    }
    resolve(model, &axials, source)
}

/// The stiffness and the EA that `[stiffness]` gives to all.
fn everywhere(scene: &SceneFile, source: &Source<'_>) -> Result<(Option<f64>, Axial), InputError> {
    let Some(table) = &scene.stiffness else { return Ok((None, None)) };
    match (table.get_ref().each, table.get_ref().ea) {
        (Some(k), None) => Ok((Some(k.0), None)),
        (None, Some(ea)) => Ok((None, Some((ea.0, table.span())))),
        _ => Err(source.error(&table.span(), "[stiffness] needs exactly one of each, ea")),
    }
}

fn bend(
    model: &mut Model,
    mesh: Option<&Mesh>,
    scene: &SceneFile,
    source: &Source<'_>,
) -> Result<(), InputError> {
    let Some(bending) = &scene.bending else { return Ok(()) };
    let pairs = mesh.map(Mesh::bending_pairs).unwrap_or_default();
    if pairs.is_empty() {
        let message = "[bending] needs a mesh in which two faces share an edge; here it would add nothing";
        return Err(source.error(&bending.span(), message));
    }
    for [a, b] in pairs {
        model.join(a, b, bending.get_ref().stiffness.0);
    }
    Ok(())
}

fn resolve(model: &mut Model, axials: &[Axial], source: &Source<'_>) -> Result<(), InputError> {
    for (spring, axial) in model.springs.iter_mut().zip(axials) {
        let (name, rest) = (named(spring.ends), spring.rest_length);
        if !rest.is_finite() {
            let message = format!("{name}: its ends are too far apart, the distance is {rest} m");
            return Err(InputError::in_file(source.file, message));
        }
        let Some((ea, at)) = axial else { continue };
        spring.stiffness = ea / rest;
        if !spring.stiffness.is_finite() {
            let message =
                format!("{name}: ea = {ea} N over a rest length of {rest} m is no stiffness; say stiffness");
            return Err(source.error(at, message));
        }
    }
    Ok(())
}

/// The pair of an entry, checked.
fn ends(model: &Model, entry: &SpringEntry) -> Result<[usize; 2], String> {
    let last = model.position.len().saturating_sub(1);
    for id in [entry.a, entry.b] {
        if id > last {
            return Err(format!("spring: there is no particle {id}; ids run from 0 to {last}"));
        }
    }
    if entry.a == entry.b {
        return Err(format!("spring from particle {} to itself", entry.a));
    }
    Ok(pair([entry.a, entry.b]))
}

fn pair([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

fn named([a, b]: [usize; 2]) -> String {
    format!("spring {a}–{b}")
}
