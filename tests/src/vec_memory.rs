//! Growable scenes of plain springs, on the harness's own memory.

use hooke::{Hookean, MassSpring};
use hooke_harness::heap::Heap;

/// Lists that grow.
pub type VecMemory<T, L = Hookean> = Heap<T, L>;

/// A scene that grows.
pub type VecScene<T, L = Hookean> = MassSpring<VecMemory<T, L>>;
