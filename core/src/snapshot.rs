//! Snapshots: a copy of all that a trajectory's bits depend on, so that a restored scene goes on bit for bit.
//!
//! That is q, q̇, masses, pins, springs with their constants, and which are broken: the network. The solver's vectors
//! and the islands are derived from it. (The forces and options belong to the integrator, which is `Clone`.)

use crate::error::EditError;
use crate::memory::{Fixed, List, Memory};
use crate::network::{Network, network};
use crate::real::Real;
use crate::scene::{Growable, MassSpring};

/// A copy of a scene's network, in memory of its own. Per particle 7 numbers and a word, per spring 2 and 2.
pub struct Snapshot<M: Memory> {
    network: Network<M>,
}

impl<T: Real, L: crate::Law, const N: usize, const S: usize> Snapshot<Fixed<T, N, S, L>> {
    /// An empty snapshot, all zeros, for a `static`.
    #[allow(clippy::new_without_default)] // A `default()` would build a large value on the stack.
    pub const fn new() -> Self {
        Self { network: network!(heapless::Vec::new(), heapless::Vec::new()) }
    }
}

impl<M: Growable> Snapshot<M> {
    /// An empty snapshot.
    pub fn empty() -> Self {
        Self { network: network!(M::particles(), M::springs()) }
    }
}

impl<M: Memory> MassSpring<M> {
    /// Copies the scene into a snapshot; refused, without change, if it does not fit.
    ///
    /// # Errors
    /// [`EditError::Snapshot`].
    pub fn save<N: Memory<Real = M::Real, Law = M::Law>>(
        &self,
        snapshot: &mut Snapshot<N>,
    ) -> Result<(), EditError> {
        let saved = snapshot.network.copy_from(&self.network);
        if saved { Ok(()) } else { Err(EditError::Snapshot(self.network.mass.len())) }
    }

    /// Makes the scene what it was when the snapshot was taken; refused, without change, if it does not fit. Particles
    /// and springs added since are gone.
    ///
    /// # Errors
    /// [`EditError::Snapshot`].
    pub fn restore<N: Memory<Real = M::Real, Law = M::Law>>(
        &mut self,
        snapshot: &Snapshot<N>,
    ) -> Result<(), EditError> {
        let from = &snapshot.network;
        if !self.network.copy_from(from) {
            return Err(EditError::Snapshot(from.mass.len()));
        }
        self.islands.current = false;
        let (n, s) = (from.mass.len(), from.ends.len());
        let work = &mut self.work;
        let zero = M::Real::ZERO;
        fit(&mut self.islands.particle, n, 0);
        fit(&mut self.islands.list, n, [0; 5]);
        fit(&mut self.islands.own, n, 0);
        fit(&mut self.islands.other, s, 0);
        fit(&mut self.islands.spring, s, 0);
        for vector in [&mut work.x, &mut work.r, &mut work.b, &mut work.p, &mut work.y] {
            fit(vector, n, [zero; 3]);
        }
        fit(&mut work.inertia, n, zero);
        fit(&mut work.mu, n, zero);
        fit(&mut work.block, n, [zero; 6]);
        fit(&mut work.hessian, s, [zero; 4]);
        Ok(())
    }
}

/// Makes a scratch list `n` long; there is room, since the network's own lists fitted.
fn fit<X: Copy>(list: &mut impl List<X>, n: usize, x: X) {
    list.clear();
    for _ in 0..n {
        list.push(x);
    }
}
