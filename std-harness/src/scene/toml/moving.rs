//! `[[moving]]`: pins and their path. A path starts where its pins are: a jump at t = 0 would be a blow.

use super::Source;
use super::pins::particle;
use super::schema::{MovingEntry, SceneFile};
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
        (None, None, Some(through)) => {
            for pair in through.get_ref().windows(2) {
                let [before, now] = [pair[0].get_ref().0, pair[1].get_ref().0];
                if !(now > before) {
                    let message = format!("through: time {now} does not come after {before}");
                    return Err(source.error(&pair[1].span(), message));
                }
            }
            let points = through.get_ref().iter().map(|w| (w.get_ref().0, w.get_ref().1)).collect();
            let path = Path::Through { points };
            match (through.get_ref().is_empty(), path.at(0.0).0) {
                (true, _) => {
                    Err(source.error(&through.span(), "through: a path needs at least one [t, x, y, z]"))
                }
                (_, [0.0, 0.0, 0.0]) => Ok(path),
                (_, start) => Err(source.error(
                    &through.span(),
                    format!("through: the displacement at t = 0 is {start:?}; a path starts at [0, 0, 0]"),
                )),
            }
        }
        _ => Err(source.error(at, "[[moving]] needs exactly one of linear, oscillate, through")),
    }
}
