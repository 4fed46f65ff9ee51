//! A scene in borrowed buffers, and the lists that scenes are made of.

use hooke::{EditError, List, SliceList};

use crate::shared::*;

crate::entry_point::entry_points! {
    SceneIn::needs(n: usize, m: usize) -> (usize, usize) { Borrowed::<T>::needs(n, m) }
    SceneIn::in_buffers<'a>(reals: &'a mut [T], words: &'a mut [u32], n: usize, m: usize) -> Option<Borrowed<'a, T>> {
        Borrowed::in_buffers(reals, words, n, m)
    }
    SceneIn::counts(s: &Borrowed<'_, T>) -> [u32; 6] { s.counts() }
    SceneIn::attach<'a>(
        reals: &'a mut [T], words: &'a mut [u32], n: usize, m: usize, counts: [u32; 6],
    ) -> Option<Borrowed<'a, T>> {
        Borrowed::attach(reals, words, n, m, counts)
    }
    MassSpring::particle[in_buffers](s: &mut Borrowed<'_, T>, x: V<T>, m: T) -> Result<usize, EditError> {
        s.particle(x, m)
    }
    MassSpring::spring[in_buffers](s: &mut Borrowed<'_, T>, a: usize, b: usize, k: T) -> Result<usize, EditError> {
        s.spring(a, b, k)
    }

    SliceList::new(buffer: &mut [T]) -> SliceList<'_, T> { SliceList::new(buffer) }
    List::push(list: &mut SliceList<'_, T>, x: T) -> bool { list.push(x) }
    List::clear(list: &mut SliceList<'_, T>) { list.clear() }
    List::room(list: &SliceList<'_, T>) -> usize { list.room() }
    SliceList::deref_mut<'a>(list: &'a mut SliceList<'_, T>) -> &'a mut [T] { list }
}
