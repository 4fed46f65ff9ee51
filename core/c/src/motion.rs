//! A pin's motion over one step: the kernel's own type under a name for C.

use core::mem::offset_of;

/// Where a pinned particle is, and how fast it moves, at the end of a step.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Motion<T> {
    /// Which particle; it must be pinned.
    pub particle: usize,
    /// Where it is then, m.
    pub position: [T; 3],
    /// How fast it moves then, m/s.
    pub velocity: [T; 3],
}

/// Both are laid out alike, so that a list from C is used where it lies.
macro_rules! alike {
    ($t:ty) => {
        const _: () = {
            type Ours = Motion<$t>;
            type Theirs = hooke::Motion<$t>;
            assert!(size_of::<Ours>() == size_of::<Theirs>() && align_of::<Ours>() == align_of::<Theirs>());
            assert!(offset_of!(Ours, particle) == offset_of!(Theirs, particle));
            assert!(offset_of!(Ours, position) == offset_of!(Theirs, position));
            assert!(offset_of!(Ours, velocity) == offset_of!(Theirs, velocity));
        };
    };
}
alike!(f32);
alike!(f64);
