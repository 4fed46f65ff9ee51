//! `pin`, `pins` and the particles' own `pinned`: together they are the pins; without them the source's own stay.

use super::Source;
use super::schema::SceneFile;
use crate::error::InputError;
use crate::scene::{Model, PinRule};

/// Sets the pins that the file asks for.
pub(super) fn set(model: &mut Model, scene: &SceneFile, source: &Source<'_>) -> Result<(), InputError> {
    if scene.pin.is_some() || scene.pins.is_some() {
        model.pinned.fill(false);
    }
    if let Some(rule) = &scene.pin {
        let at_line = |e: InputError| source.error(&rule.span(), e.message);
        let parsed: PinRule = rule.get_ref().parse().map_err(at_line)?;
        model.pinned = parsed.apply(&model.position).map_err(at_line)?;
    }
    for id in scene.pins.iter().flatten() {
        *particle(&mut model.pinned, *id.get_ref()).map_err(|m| source.error(&id.span(), m))? = true;
    }
    for (pinned, entry) in model.pinned.iter_mut().zip(&scene.particle) {
        *pinned |= entry.get_ref().pinned;
    }
    if model.pinned.iter().all(|p| *p) {
        let count = model.pinned.len();
        let message = format!("all {count} particles are pinned; nothing is left to move");
        return Err(InputError::in_file(source.file, message));
    }
    Ok(())
}

/// The entry of a particle, or a message that says which ids there are.
pub(super) fn particle<X>(list: &mut [X], id: usize) -> Result<&mut X, String> {
    let last = list.len().saturating_sub(1);
    list.get_mut(id).ok_or_else(|| format!("there is no particle {id}; ids run from 0 to {last}"))
}
