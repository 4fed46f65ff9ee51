//! One call: attach to the buffer, do it, note what went wrong, let go.

use hooke::{EditError, Motion, Real};

use crate::buffer::{self, Header, Open};
use crate::report::{Energies, Report};
use crate::status::hooke_status::{self, *};
use crate::status::{Failure, NO_INDEX};

/// What a C program holds a scene by: a pointer to one of these, in truth to a [`Header`].
pub(crate) trait Handle {
    /// The scene's precision.
    type Real: Real;
}

/// Does something with the scene that a handle stands for.
///
/// # Safety
/// What `hooke.h` asks of a handle: see [`Open::new`].
pub(crate) unsafe fn call<H: Handle>(
    handle: *mut H,
    action: impl FnOnce(&mut Open<'_, H::Real>) -> Result<(), Failure>,
) -> hooke_status {
    // SAFETY: as promised.
    let mut open = match unsafe { Open::new(handle.cast::<Header<H::Real>>()) } {
        Ok(open) => open,
        Err(status) => return status,
    };
    let status = match action(&mut open) {
        Ok(()) => HOOKE_OK,
        Err(Failure { status, index }) => {
            open.header.last_index = index;
            status
        }
    };
    open.close();
    status
}

/// Makes a scene in a buffer.
///
/// # Safety
/// As for [`buffer::init`]; `handle` is null, or misaligned, or writable.
pub(crate) unsafe fn init<H: Handle>(
    buffer: *mut u8,
    bytes: usize,
    particles: usize,
    springs: usize,
    handle: *mut *mut H,
) -> hooke_status {
    if handle.is_null() {
        return HOOKE_NULL;
    }
    if !handle.is_aligned() {
        return HOOKE_MISALIGNED;
    }
    // The handle is written last, so that it may not lie where the scene is.
    let (begin, place) = (buffer.addr(), handle.addr());
    if place < begin.saturating_add(bytes) && begin < place.saturating_add(size_of::<*mut H>()) {
        return HOOKE_OVERLAP;
    }
    // SAFETY: as promised.
    if let Err(failure) = unsafe { buffer::init::<H::Real>(buffer, bytes, particles, springs) } {
        return failure.status;
    }
    // SAFETY: not null, aligned, writable as promised, apart from the scene.
    unsafe { handle.write(buffer.cast()) };
    HOOKE_OK
}

/// The index that the last failed call concerned.
///
/// # Safety
/// As for [`call`].
pub(crate) unsafe fn last_index<H: Handle>(handle: *mut H) -> usize {
    // SAFETY: as promised.
    unsafe { Open::new(handle.cast::<Header<H::Real>>()) }.map_or(NO_INDEX, |open| open.header.last_index)
}

impl<T: Real> Open<'_, T> {
    pub(crate) fn step(&mut self, motions: &[Motion<T>]) -> Result<Report<T>, Failure> {
        let mut euler = self.options().integrator()?;
        Ok(self.scene.step_moving(&mut euler, motions)?.into())
    }

    pub(crate) fn reaction(&mut self, particle: usize) -> Result<[T; 3], Failure> {
        let euler = self.options().integrator()?;
        let reaction = self.scene.reaction(particle, &euler.forces);
        Ok(reaction.ok_or(EditError::NoParticle(particle))?)
    }

    pub(crate) fn energies(&mut self) -> Result<Energies<T>, Failure> {
        let gravity = hooke::Gravity(self.options().gravity);
        let springs = self.scene.springs();
        Ok(Energies {
            kinetic: springs.kinetic_energy(),
            springs: springs.potential_energy(),
            gravity: hooke::Force::potential_energy(&gravity, self.scene.state()),
        })
    }

    pub(crate) fn tension(&mut self, spring: usize) -> Result<T, Failure> {
        if spring >= self.scene.state().springs() {
            return Err(EditError::NoSpring(spring).into());
        }
        Ok(self.scene.springs().tension_of(spring))
    }
}

/// A vector of the scene.
pub(crate) fn vector<X: Copy>(list: &[X], particle: usize) -> Result<X, Failure> {
    Ok(*list.get(particle).ok_or(EditError::NoParticle(particle))?)
}
