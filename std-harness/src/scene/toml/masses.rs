//! `[mass]` and the particles' own masses.
//!
//! A point with no share of the volume (or area) would have mass 0: it is refused by name rather than given some
//! mass that nobody asked for.

use super::Source;
use super::schema::SceneFile;
use super::value::Positive;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::Model;

/// Sets the masses that the file asks for.
pub(super) fn set(
    model: &mut Model,
    mesh: Option<&Mesh>,
    scene: &SceneFile,
    source: &Source<'_>,
) -> Result<(), InputError> {
    let n = model.mass.len();
    let mut shared = None;
    if let Some(table) = &scene.mass {
        let refuse = |message: String| Err(source.error(&table.span(), message));
        let needs_mesh = |key: &str| format!("[mass] {key} needs a mesh; say each, values or total");
        let mass = table.get_ref();
        match (mass.each, &mass.values, mass.total, mass.density, mass.area_density) {
            (Some(each), None, None, None, None) => model.mass.fill(each.0),
            (None, Some(values), None, None, None) if values.len() != n => {
                return refuse(format!("[mass] values: {} masses for {n} particles", values.len()));
            }
            (None, Some(values), None, None, None) => {
                for (mass, value) in model.mass.iter_mut().zip(values) {
                    let positive = Positive::try_from(*value.get_ref());
                    *mass = positive.map_err(|m| source.error(&value.span(), m))?.0;
                }
                shared = Some("values");
            }
            (None, None, Some(total), None, None) => {
                model.mass.fill(total.0 / n as f64);
                shared = Some("total");
            }
            (None, None, None, Some(density), None) => match mesh.map(Mesh::volume_share) {
                None => return refuse(needs_mesh("density")),
                Some(share) => model.mass = share.iter().map(|v| density.0 * v).collect(),
            },
            (None, None, None, None, Some(density)) => match mesh.map(Mesh::area_share) {
                None => return refuse(needs_mesh("area_density")),
                Some(share) => model.mass = share.iter().map(|a| density.0 * a).collect(),
            },
            _ => {
                return refuse(
                    "[mass] needs exactly one of each, values, total, density, area_density".into(),
                );
            }
        }
        if let Some((i, m)) = model.mass.iter().enumerate().find(|(_, m)| !(m.is_finite() && **m > 0.0)) {
            let why = match (mass.density, mass.area_density) {
                (Some(_), _) => "it has no share of any solid cell's volume; say each, values or total",
                (_, Some(_)) => "it has no share of any face's area; say each, values or total",
                _ => "a mass is positive and finite",
            };
            return refuse(format!("[mass] gives particle {i} {m} kg: {why}"));
        }
    }
    for (i, particle) in scene.particle.iter().enumerate() {
        let Some(own) = particle.get_ref().mass else { continue };
        if let Some(key) = shared {
            let message = format!("particle {i} has mass {} kg, and [mass] {key} gives it another", own.0);
            return Err(source.error(&particle.span(), message));
        }
        model.mass[i] = own.0;
    }
    Ok(())
}
