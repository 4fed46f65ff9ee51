//! `[[moving]]`: pins and their path. A path starts where its pins are: a jump at t = 0 would be a blow.

use ::toml::Spanned;

use super::Source;
use super::pins::particle;
use super::schema::{MovingEntry, SceneFile};
use super::value::Waypoint;
use crate::error::InputError;
use crate::scene::{Model, Moving, Path};

/// Adds the moving pins that the file asks for. Needs the pins to be set.
pub(super) fn set(model: &mut Model, scene: &SceneFile, source: &Source<'_>) -> Result<(), InputError> {
    let mut has_path = vec![false; model.pinned.len()];
    for entry in &scene.moving {
        let mut particles = Vec::new();
        for id in &entry.get_ref().particles {
            let (at, i) = (id.span(), *id.get_ref());
            let taken = particle(&mut has_path, i).map_err(|m| source.error(&at, m))?;
            if !model.pinned[i] {
                return Err(source.error(&at, format!("particle {i} is not pinned: only a pin can be moved")));
            }
            if std::mem::replace(taken, true) {
                return Err(source.error(&at, format!("particle {i} is given a second path")));
            }
            particles.push(i);
        }
        if particles.is_empty() {
            return Err(source.error(&entry.span(), "[[moving]] names no particles"));
        }
        model.moving.push(Moving { particles, path: path(entry.get_ref(), &entry.span(), source)? });
    }
    Ok(())
}

fn path(entry: &MovingEntry, at: &std::ops::Range<usize>, source: &Source<'_>) -> Result<Path, InputError> {
    match (&entry.linear, &entry.oscillate, &entry.through) {
        (Some(linear), None, None) => Ok(Path::Linear { velocity: linear.velocity.0 }),
        (None, Some(o), None) => Ok(Path::Oscillate { amplitude: o.amplitude.0, frequency: o.frequency.0 }),
        (None, None, Some(list)) => through(list, source),
        _ => Err(source.error(at, "[[moving]] needs exactly one of linear, oscillate, through")),
    }
}

fn through(list: &Spanned<Vec<Spanned<Vec<f64>>>>, source: &Source<'_>) -> Result<Path, InputError> {
    let mut points: Vec<(f64, [f64; 3])> = Vec::new();
    for entry in list.get_ref() {
        let refuse = |message| source.error(&entry.span(), message);
        let Waypoint(t, d) = entry.get_ref().as_slice().try_into().map_err(refuse)?;
        match points.last() {
            Some((before, _)) if !(t > *before) => {
                return Err(refuse(format!("through: time {t} does not come after {before}")));
            }
            _ => points.push((t, d)),
        }
    }
    if points.is_empty() {
        return Err(source.error(&list.span(), "through: a path needs at least one [t, x, y, z]"));
    }
    let path = Path::Through { points };
    match path.at(0.0).0 {
        [0.0, 0.0, 0.0] => Ok(path),
        start => {
            let message =
                format!("through: the displacement at t = 0 is {start:?}; a path starts at [0, 0, 0]");
            Err(source.error(&list.span(), message))
        }
    }
}
