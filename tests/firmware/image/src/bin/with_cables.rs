//! The minimal program under the law of springs and cables: its last spring is a cable.
#![no_std]
#![no_main]

use firmware_image::minimal::{PARTICLES, Rope, end, euler, line};
use hooke::{EditError, Mixed, Scene, Spring};
use static_cell::ConstStaticCell;

static ROPE: ConstStaticCell<Rope<f32, Mixed>> = ConstStaticCell::new(Scene::new());

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // `take` would panic the second time; then the price would include the printing of panics.
    let Some(rope) = ROPE.try_take() else { end(false) };
    let mut euler = euler();
    end(build(rope).is_ok() && (0..60).all(|_| rope.step(&mut euler).is_ok()))
}

#[inline(always)]
fn build(rope: &mut Rope<f32, Mixed>) -> Result<(), EditError> {
    let above = line(rope, PARTICLES - 1)?;
    let below = rope.particle([3.9, 0.0, 0.0], 0.01)?;
    rope.cable(above, below, Spring { stiffness: 1000.0, rest_length: 0.1 })?;
    rope.pin(0)
}
