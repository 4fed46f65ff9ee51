//! Growable memory for a scene: the kernel's lists on `Vec`.

use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use hooke::{Growable, Law, List, Memory, Mixed, Real};

/// A scene on the heap that grows as particles and springs are added.
#[derive(Debug, Clone, Copy)]
pub struct Heap<T, L = Mixed>(PhantomData<(T, L)>);

/// A `Vec` as the kernel's list: never full.
#[derive(Debug, Clone)]
pub struct Grown<X>(Vec<X>);

impl<X> Deref for Grown<X> {
    type Target = [X];
    fn deref(&self) -> &[X] {
        &self.0
    }
}

impl<X> DerefMut for Grown<X> {
    fn deref_mut(&mut self) -> &mut [X] {
        &mut self.0
    }
}

impl<X: Copy> List<X> for Grown<X> {
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

impl<T: Real, L: Law> Memory for Heap<T, L> {
    type Real = T;
    type Law = L;
    type Particles<X: Copy + 'static> = Grown<X>;
    type Springs<X: Copy + 'static> = Grown<X>;
}

impl<T: Real, L: Law> Growable for Heap<T, L> {
    fn particles<X: Copy + 'static>() -> Grown<X> {
        Grown(Vec::new())
    }
    fn springs<X: Copy + 'static>() -> Grown<X> {
        Grown(Vec::new())
    }
}
