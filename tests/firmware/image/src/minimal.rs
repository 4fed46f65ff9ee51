//! The rope that the smallest programs simulate: 40 particles. `minimal` is this and nothing else; each `with_…` adds
//! one feature, so that the difference of their sizes is its price.

use hooke::force::Gravity;
use hooke::{EditError, Hookean, Law, LinearlyImplicitEuler, Real, Scene};

/// How many particles it has.
pub const PARTICLES: usize = 40;
/// How many springs.
pub const SPRINGS: usize = PARTICLES - 1;
/// Its scene.
pub type Rope<T = f32, L = Hookean> = Scene<T, PARTICLES, SPRINGS, L>;

/// Lays it out level, and pins its first particle.
#[inline(always)]
pub fn build<T: Real, L: Law>(rope: &mut Rope<T, L>) -> Result<(), EditError> {
    line(rope, PARTICLES)?;
    rope.pin(0)
}

/// So many of its particles, joined by springs; answers the last.
#[inline(always)]
pub fn line<T: Real, L: Law>(rope: &mut Rope<T, L>, n: usize) -> Result<usize, EditError> {
    let (mass, stiffness) = (T::ONE / T::from_count(100), T::from_count(1000));
    let mut above = rope.particle([T::ZERO; 3], mass)?;
    for i in 1..n {
        let below = rope.particle([T::from_count(i) / T::from_count(10), T::ZERO, T::ZERO], mass)?;
        rope.spring(above, below, stiffness)?;
        above = below;
    }
    Ok(above)
}

/// Sixty steps a second, gravity.
#[inline(always)]
pub fn euler<T: Real>() -> LinearlyImplicitEuler<T, ((), Gravity<T>)> {
    LinearlyImplicitEuler::new(T::ONE / T::from_count(60)).gravity([T::ZERO, T::from_f64(-9.81), T::ZERO])
}

/// Ends the program: with 0 if all went well.
pub fn end(well: bool) -> ! {
    crate::console::exit(if well { 0 } else { 1 })
}
