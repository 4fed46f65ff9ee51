//! The caller's other pointers: checked before anything is done with them.

use core::ptr;

use hooke::Real;

use crate::buffer::Open;
use crate::status::Failure;
use crate::status::hooke_status::*;

/// Where an answer is to be written: checked before the call does anything, written after it has succeeded.
pub(crate) struct Place<R>(*mut R);

impl<R> Place<R> {
    /// # Safety
    /// The memory is still what was promised to [`Open::place`], and nothing refers to it.
    pub(crate) unsafe fn put(self, answer: R) {
        if !self.0.is_null() {
            // SAFETY: aligned and apart from the scene, as checked by `place`; writable as promised there.
            unsafe { self.0.write(answer) }
        }
    }
}

impl<'a, T: Real> Open<'a, T> {
    /// Is `p` a pointer to `count` values outside the scene's buffer?
    fn check<X>(&self, p: *const X, count: usize) -> Result<(), Failure> {
        if p.is_null() {
            return Err(HOOKE_NULL.into());
        }
        if !p.is_aligned() {
            return Err(HOOKE_MISALIGNED.into());
        }
        let bytes = count.checked_mul(size_of::<X>()).filter(|n| *n <= isize::MAX as usize);
        let bytes = bytes.ok_or(HOOKE_TOO_LARGE)?;
        let (begin, ours) = (p.addr(), ptr::from_ref(&*self.header).addr());
        let apart = begin.saturating_add(bytes) <= ours || begin >= ours.saturating_add(self.header.bytes());
        if apart { Ok(()) } else { Err(HOOKE_OVERLAP.into()) }
    }

    /// A value of the caller.
    ///
    /// # Safety
    /// `p` is null, or misaligned, or points to an `X`. Any bytes must be an `X`.
    pub(crate) unsafe fn read<X: Copy>(&self, p: *const X) -> Result<X, Failure> {
        self.check(p, 1)?;
        // SAFETY: not null, aligned, and readable as promised.
        Ok(unsafe { p.read() })
    }

    /// A list of the caller; an empty one may be null.
    ///
    /// # Safety
    /// As for [`Open::read`], for `count` values that stay as they are during `'b`.
    pub(crate) unsafe fn list<'b, X>(&self, p: *const X, count: usize) -> Result<&'b [X], Failure> {
        if count == 0 {
            return Ok(&[]);
        }
        self.check(p, count)?;
        // SAFETY: not null, aligned, not longer than an isize, readable as promised, and apart from the scene.
        Ok(unsafe { core::slice::from_raw_parts(p, count) })
    }

    /// Where to put an answer.
    pub(crate) fn place<R>(&self, p: *mut R) -> Result<Place<R>, Failure> {
        self.check(p, 1)?;
        Ok(Place(p))
    }

    /// As [`Open::place`]; null where the answer is not wanted.
    pub(crate) fn place_if_any<R>(&self, p: *mut R) -> Result<Place<R>, Failure> {
        if p.is_null() { Ok(Place(p)) } else { self.place(p) }
    }

    /// Copies vectors to an array of the caller with room for `room` of them.
    ///
    /// # Safety
    /// `to` is null, or misaligned, or writable for `room` vectors.
    pub(crate) unsafe fn copy<X: Copy>(&self, from: &[X], to: *mut X, room: usize) -> Result<(), Failure> {
        self.check(to, from.len())?;
        if room < from.len() {
            return Err(Failure { status: HOOKE_TOO_SMALL, index: from.len() });
        }
        // SAFETY: not null, aligned, writable for at least so many as promised, and apart from the scene.
        unsafe { ptr::copy_nonoverlapping(from.as_ptr(), to, from.len()) };
        Ok(())
    }
}
