//! The least that a firmware needs: a rope of 40 particles in `f32`, stepped, nothing printed. Its size is the price of
//! the kernel in flash.
#![no_std]
#![no_main]

use firmware_image::minimal::{Rope, build, end, euler};
use hooke::Scene;
use static_cell::ConstStaticCell;

static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // `take` would panic the second time; then the price would include the printing of panics.
    let Some(rope) = ROPE.try_take() else { end(false) };
    let mut euler = euler();
    end(build(rope).is_ok() && (0..60).all(|_| rope.step(&mut euler).is_ok()))
}
