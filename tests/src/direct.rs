//! Direct solvers with room enough for any scene of the tests.

use hooke::{BandedLdl, Real, Single, SparseLdl};

use crate::data::SceneData;
use crate::random::Random;

/// A banded solver for these data, however they are tied.
pub fn banded<T: Real>(data: &SceneData) -> BandedLdl<Vec<T>> {
    BandedLdl::new(vec![T::ONE; BandedLdl::needs(data.len(), data.len())])
}

/// A sparse solver in its own memory.
pub type Sparse<T> = SparseLdl<Vec<u32>, Vec<T>, Vec<u32>>;

/// A sparse solver for these data that eliminates in this order.
pub fn sparse_in<T: Real>(data: &SceneData, order: Vec<u32>) -> Sparse<T> {
    let (numbers, words) = room(data);
    SparseLdl::new(order, vec![T::ONE; numbers], vec![7; words])
}

/// Numbers and words that are enough in any order: a panel of all rows at worst; a record per island, and what the
/// analysis of the last one works in.
fn room(data: &SceneData) -> (usize, usize) {
    let (n, s) = (data.len(), data.springs.len());
    (9 * n * n + 45 * n, n * n + 40 * n + 8 * s + 16)
}

/// The same in an order that has nothing to do with the springs.
pub fn sparse<T: Real>(data: &SceneData) -> Sparse<T> {
    sparse_in(data, any_order(data))
}

fn any_order(data: &SceneData) -> Vec<u32> {
    let mut random = Random::new(data.len() as u64);
    random.permutation(data.len()).into_iter().map(|i| i as u32).collect()
}

/// The same with its factor in `f32`, whatever the scene's precision.
pub fn single(data: &SceneData) -> SparseLdl<Vec<u32>, Single<Vec<f32>>, Vec<u32>> {
    let (numbers, words) = room(data);
    SparseLdl::new(any_order(data), Single(vec![1.0; numbers]), vec![7; words])
}
