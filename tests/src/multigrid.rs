//! Multigrid with the workspace that it says it needs.

use hooke::{Multigrid, Portable};

use crate::data::SceneData;

/// Multigrid in its own memory.
pub type OwnMultigrid = Multigrid<Vec<f32>, Vec<u32>>;

/// A solver for these data. What lies in the workspace before does not matter.
pub fn multigrid(data: &SceneData) -> OwnMultigrid {
    let (numbers, words) = Multigrid::needs(data.len(), data.springs.len());
    Multigrid::new(vec![f32::NAN; numbers], vec![7; words], Portable)
}
