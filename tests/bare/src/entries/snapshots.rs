//! Keeping a scene and going back to it; empty scenes and snapshots.

use hooke::{EditError, Scene, Snapshot};

use crate::shared::*;

crate::entry_point::entry_points! {
    Scene::new() -> S<T> { Scene::new() }
    Snapshot::new() -> Kept<T> { Snapshot::new() }
    MassSpring::save(s: &S<T>, kept: &mut Kept<T>) -> Result<(), EditError> { s.save(kept) }
    MassSpring::restore(s: &mut S<T>, kept: &Kept<T>) -> Result<(), EditError> { s.restore(kept) }
    MassSpring::restore[in_buffers](s: &mut Borrowed<'_, T>, kept: &Kept<T>) -> Result<(), EditError> {
        s.restore(kept)
    }
}
