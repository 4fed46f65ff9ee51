//! PCG in lanes with the workspace that it says it needs.

use hooke::{Portable, Real, SingleJacobi, Wide, WideJacobi};

use crate::build;
use crate::data::SceneData;

/// A solver for these data; where no layout fits it is the plain one.
pub fn wide<T: Real>(data: &SceneData) -> WideJacobi<Vec<T>, Vec<u32>> {
    let (numbers, words) = WideJacobi::needs_of(&mut build::scene::<T>(data), true);
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], Portable)
}

/// The same with its iterations in `f32`.
pub type OwnSingle<T> = Wide<Vec<T>, Vec<u32>, Portable, SingleJacobi<Vec<f32>>>;

/// Such a solver. What lies in the workspace before does not matter.
pub fn single<T: Real>(data: &SceneData) -> OwnSingle<T> {
    let numbers = SingleJacobi::needs_of(&mut build::scene::<T>(data));
    wide(data).around(SingleJacobi::new(vec![f32::NAN; numbers]))
}
