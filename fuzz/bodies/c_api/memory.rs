//! Memory and pointers as a C program might pass them.

use std::ptr;

use crate::bytes::Bytes;
use crate::status::Failure;
use crate::status::hooke_status::*;

/// What the kernel answers to the same call.
pub type Answer = Result<(), Failure>;

/// A piece of memory as C hands it out: as long as promised (up to whole words) and no longer, and aligned for a scene. Known
/// by its address alone, as C knows it.
pub struct Memory {
    at: *mut u64,
    words: usize,
    bytes: usize,
}

impl Memory {
    /// Filled with rubbish.
    pub fn new(bytes: usize) -> Self {
        let words = bytes.div_ceil(8);
        let piece: Box<[u64]> = vec![0xa5a5_a5a5_a5a5_a5a5; words].into();
        Self { at: Box::into_raw(piece).cast(), words, bytes }
    }

    /// Another piece with the same content.
    pub fn copy(&self) -> Self {
        let copy = Self::new(self.bytes);
        // SAFETY: two pieces of so many words.
        unsafe { ptr::copy_nonoverlapping(self.at, copy.at, self.words) };
        copy
    }

    /// Changes a byte, if there is one.
    pub fn damage(&self, place: usize, by: u8) {
        if place < self.bytes {
            // SAFETY: within the piece.
            unsafe { *self.at().add(place) ^= by };
        }
    }

    /// Where it begins.
    pub fn at(&self) -> *mut u8 {
        self.at.cast()
    }

    /// Its bytes.
    pub fn content(&self) -> Vec<u8> {
        // SAFETY: so many bytes are in the piece.
        unsafe { std::slice::from_raw_parts(self.at.cast::<u8>(), self.bytes) }.to_vec()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: it was made by `Box::into_raw` of so many words.
        drop(unsafe { Box::from_raw(ptr::slice_from_raw_parts_mut(self.at, self.words)) });
    }
}

/// What a pointer argument is.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// To what it should point to.
    Good,
    /// Null.
    Null,
    /// Misaligned.
    Off,
    /// To the scene itself.
    Inside,
}

impl Kind {
    /// Mostly good ones.
    pub fn read(bytes: &mut Bytes<'_>) -> Self {
        match bytes.byte() {
            253 => Self::Null,
            254 => Self::Off,
            255 => Self::Inside,
            _ => Self::Good,
        }
    }

    /// The pointer that this makes of a good one.
    pub fn of<X, H>(self, good: *mut X, scene: *mut H) -> *mut X {
        match self {
            Self::Good => good,
            Self::Null => ptr::null_mut(),
            Self::Off => good.cast::<u8>().wrapping_add(1).cast(),
            Self::Inside => scene.cast(),
        }
    }

    /// What the interface says of it.
    pub fn answer(self) -> Answer {
        match self {
            Self::Good => Ok(()),
            Self::Null => Err(HOOKE_NULL.into()),
            Self::Off => Err(HOOKE_MISALIGNED.into()),
            Self::Inside => Err(HOOKE_OVERLAP.into()),
        }
    }

    /// The same of an answer that need not be wanted.
    pub fn answer_if_any(self) -> Answer {
        if self == Self::Null { Ok(()) } else { self.answer() }
    }
}
