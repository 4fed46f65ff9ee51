//! The minimal program, and islands that sleep.
#![no_std]
#![no_main]

use firmware_image::minimal::{PARTICLES, Rope, SPRINGS, build, end, euler};
use hooke::{Scene, Sleeping};
use static_cell::ConstStaticCell;

const NEEDS: (usize, usize) = Sleeping::needs(PARTICLES, SPRINGS);
static ROPE: ConstStaticCell<Rope> = ConstStaticCell::new(Scene::new());
static NUMBERS: ConstStaticCell<[f32; NEEDS.0]> = ConstStaticCell::new([0.0; NEEDS.0]);
static WORDS: ConstStaticCell<[u32; NEEDS.1]> = ConstStaticCell::new([0; NEEDS.1]);

/// Called by the startup code.
// SAFETY: the only `main` of this program.
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // `take` would panic the second time; then the price would include the printing of panics.
    let Some(rope) = ROPE.try_take() else { end(false) };
    let (Some(numbers), Some(words)) = (NUMBERS.try_take(), WORDS.try_take()) else { end(false) };
    let sleeping = Sleeping::new(1e-6, numbers.as_mut_slice(), words.as_mut_slice());
    let mut euler = euler().sleeping(sleeping);
    end(build(rope).is_ok() && (0..60).all(|_| rope.step(&mut euler).is_ok()))
}
