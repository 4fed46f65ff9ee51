//! PCG in lanes with the workspace that it says it needs.

use hooke::{Portable, Real, WideJacobi};

use crate::build;
use crate::data::SceneData;

/// A solver for these data; where no layout fits it is the plain one.
pub fn wide<T: Real>(data: &SceneData) -> WideJacobi<Vec<T>, Vec<u32>> {
    let (numbers, words) = WideJacobi::needs_of(&mut build::scene::<T>(data), true);
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], Portable)
}
