//! Growable memory for the kernel, on `Vec`: written here so that these tests do not lean on the harness's own.

use core::marker::PhantomData;
use core::ops::{Deref, DerefMut};

use hooke::{Growable, Hookean, Law, List, MassSpring, Memory, Real};

/// A scene that grows.
pub type VecScene<T, L = Hookean> = MassSpring<VecMemory<T, L>>;

/// Lists that grow.
#[derive(Debug)]
pub struct VecMemory<T, L = Hookean>(PhantomData<(T, L)>);

/// One list.
#[derive(Debug, Clone, Default)]
pub struct VecList<X>(Vec<X>);

impl<X> Deref for VecList<X> {
    type Target = [X];
    fn deref(&self) -> &[X] {
        &self.0
    }
}

impl<X> DerefMut for VecList<X> {
    fn deref_mut(&mut self) -> &mut [X] {
        &mut self.0
    }
}

impl<X: Copy> List<X> for VecList<X> {
    fn push(&mut self, x: X) -> bool {
        self.0.push(x);
        true
    }
    fn clear(&mut self) {
        self.0.clear();
    }
    fn room(&self) -> usize {
        usize::MAX
    }
}

impl<T: Real, L: Law> Memory for VecMemory<T, L> {
    type Real = T;
    type Law = L;
    type Particles<X: Copy + 'static> = VecList<X>;
    type Springs<X: Copy + 'static> = VecList<X>;
}

impl<T: Real, L: Law> Growable for VecMemory<T, L> {
    fn particles<X: Copy + 'static>() -> VecList<X> {
        VecList(Vec::new())
    }
    fn springs<X: Copy + 'static>() -> VecList<X> {
        VecList(Vec::new())
    }
}
