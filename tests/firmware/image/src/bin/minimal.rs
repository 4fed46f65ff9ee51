//! The least that a firmware needs: a rope of 40 particles in `f32`, stepped, nothing printed. Its size is the price of
//! the kernel in flash.
#![no_std]
#![no_main]

use hooke::{EditError, LinearlyImplicitEuler, Scene};
use static_cell::ConstStaticCell;

const PARTICLES: usize = 40;
type Rope = Scene<f32, PARTICLES, { PARTICLES - 1 }>;
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // `take` would panic the second time; then the price would include the printing of panics.
    let Some(rope) = ROPE.try_take() else { firmware_image::console::exit(2) };
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity([0.0, -9.81, 0.0]);
    let ran = build(rope).is_ok() && (0..60).all(|_| rope.step(&mut euler).is_ok());
    firmware_image::console::exit(if ran { 0 } else { 1 })
}

fn build(rope: &mut Rope) -> Result<(), EditError> {
    let mut above = rope.particle([0.0, 0.0, 0.0], 0.010)?;
    rope.pin(above)?;
    for i in 1..PARTICLES {
        let below = rope.particle([0.1 * i as f32, 0.0, 0.0], 0.010)?;
        rope.spring(above, below, 1_000.0)?;
        above = below;
    }
    Ok(())
}
