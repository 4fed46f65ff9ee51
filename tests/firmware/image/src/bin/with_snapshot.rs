//! The minimal program, and a snapshot that it goes back to.
#![no_std]
#![no_main]

use firmware_image::minimal::{PARTICLES, Rope, SPRINGS, build, end, euler};
use hooke::{Fixed, Scene, Snapshot};
use static_cell::ConstStaticCell;

static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());
static KEPT: ConstStaticCell<Snapshot<Fixed<f32, PARTICLES, SPRINGS>>> =
    ConstStaticCell::new(Snapshot::new());

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // `take` would panic the second time; then the price would include the printing of panics.
    let Some(rope) = ROPE.try_take() else { end(false) };
    let Some(kept) = KEPT.try_take() else { end(false) };
    let mut euler = euler();
    end(build(rope).is_ok()
        && (0..60)
            .all(|_| rope.save(kept).is_ok() && rope.step(&mut euler).is_ok() && rope.restore(kept).is_ok()))
}
