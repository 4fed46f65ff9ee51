//! Direct solvers with room enough for any scene of the tests.

use hooke::{BandedLdl, Real, SparseLdl};

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
    let (n, s) = (data.len(), data.springs.len());
    // A panel of all rows at worst; a record per island, and what the analysis of the last one works in.
    SparseLdl::new(order, vec![T::ONE; 9 * n * n + 12 * n], vec![7; n * n + 40 * n + 8 * s + 16])
}

/// The same in an order that has nothing to do with the springs.
pub fn sparse<T: Real>(data: &SceneData) -> Sparse<T> {
    let mut random = Random::new(data.len() as u64);
    sparse_in(data, random.permutation(data.len()).into_iter().map(|i| i as u32).collect())
}
