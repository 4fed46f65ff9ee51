//! Every way a call can end, as a number.

use core::ffi::{CStr, c_char};

use hooke::{EditError, StepError};

/// How a call ended. Whatever is not HOOKE_OK has changed nothing in the scene but hooke_*_last_index, which names the
/// particle or spring concerned.
#[repr(i32)] // One size for every compiler: bare-metal C compilers differ over the size of an enum.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum hooke_status {
    /// Done.
    HOOKE_OK = 0,
    /// A pointer is null.
    HOOKE_NULL = 1,
    /// A pointer is not aligned for what it points to; for buffers see hooke_*_alignment.
    HOOKE_MISALIGNED = 2,
    /// The buffer or array is too small.
    HOOKE_TOO_SMALL = 3,
    /// More particles, springs or motions than fit into memory.
    HOOKE_TOO_LARGE = 4,
    /// The handle is no scene: not initialised, of the other precision, or overwritten.
    HOOKE_NOT_A_SCENE = 5,
    /// An argument points into the scene's own buffer.
    HOOKE_OVERLAP = 6,
    /// hooke_*_set_options has not been called yet.
    HOOKE_NO_OPTIONS = 7,
    /// There is no room for another particle; the index is the capacity.
    HOOKE_PARTICLES_FULL = 8,
    /// There is no room for another spring; the index is the capacity.
    HOOKE_SPRINGS_FULL = 9,
    /// No such particle.
    HOOKE_NO_PARTICLE = 10,
    /// No such spring.
    HOOKE_NO_SPRING = 11,
    /// A position, velocity or impulse of this particle is, or would become in this step, infinite or NaN.
    HOOKE_NOT_FINITE = 12,
    /// The mass of this particle is not a positive finite number.
    HOOKE_MASS = 13,
    /// The stiffness of this spring is negative, infinite or NaN.
    HOOKE_STIFFNESS = 14,
    /// The rest length of this spring is negative, infinite or NaN.
    HOOKE_REST_LENGTH = 15,
    /// Both ends of this spring are the same particle.
    HOOKE_SAME_ENDS = 16,
    /// This particle is pinned: it has no velocity of its own.
    HOOKE_PINNED = 17,
    /// This particle is not pinned.
    HOOKE_NOT_PINNED = 18,
    /// This spring is broken.
    HOOKE_BROKEN = 19,
    /// dt is not a positive finite number whose square is one too.
    HOOKE_TIME_STEP = 20,
    /// A tolerance is negative, infinite or NaN.
    HOOKE_TOLERANCE = 21,
    /// Gravity is infinite or NaN, or drag or damping is that or negative.
    HOOKE_FORCE = 22,
    /// The motion of this pin is infinite or NaN, or too far to reach in one step.
    HOOKE_MOTION = 23,
    /// dt is beyond the limit of an explicit method, which this particle sets.
    HOOKE_STEP_LIMIT = 24,
    /// The equations of the step were not solved; this particle begins the island.
    HOOKE_NOT_CONVERGED = 25,
    /// No step is short enough for the accuracy that is asked for.
    HOOKE_ACCURACY = 26,
}

use hooke_status::*;

/// Where no particle or spring is concerned.
pub(crate) const NO_INDEX: usize = usize::MAX;

/// A status other than `HOOKE_OK`, and the particle or spring concerned.
pub(crate) struct Failure {
    pub(crate) status: hooke_status,
    pub(crate) index: usize,
}

impl From<hooke_status> for Failure {
    fn from(status: hooke_status) -> Self {
        Self { status, index: NO_INDEX }
    }
}

impl From<EditError> for Failure {
    fn from(error: EditError) -> Self {
        let (status, index) = match error {
            EditError::ParticlesFull(n) | EditError::Snapshot(n) => (HOOKE_PARTICLES_FULL, n),
            EditError::SpringsFull(n) => (HOOKE_SPRINGS_FULL, n),
            EditError::NoParticle(i) => (HOOKE_NO_PARTICLE, i),
            EditError::NoSpring(j) => (HOOKE_NO_SPRING, j),
            EditError::NotFinite(i) => (HOOKE_NOT_FINITE, i),
            EditError::Mass(i) => (HOOKE_MASS, i),
            EditError::Stiffness(j) => (HOOKE_STIFFNESS, j),
            EditError::RestLength(j) => (HOOKE_REST_LENGTH, j),
            EditError::SameEnds(j) => (HOOKE_SAME_ENDS, j),
            EditError::Pinned(i) => (HOOKE_PINNED, i),
            EditError::NotPinned(i) => (HOOKE_NOT_PINNED, i),
            EditError::Broken(j) => (HOOKE_BROKEN, j),
        };
        Self { status, index }
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        let (status, index) = match error {
            StepError::TimeStep => (HOOKE_TIME_STEP, NO_INDEX),
            StepError::Tolerance => (HOOKE_TOLERANCE, NO_INDEX),
            // The options' gravity, drag and damping act on all.
            StepError::Field | StepError::Damping(_) => (HOOKE_FORCE, NO_INDEX),
            StepError::Force(i) | StepError::NotCertified(i) => (HOOKE_FORCE, i),
            StepError::NoParticle(i) => (HOOKE_NO_PARTICLE, i),
            StepError::NotPinned(i) => (HOOKE_NOT_PINNED, i),
            StepError::Motion(i) => (HOOKE_MOTION, i),
            StepError::NotFinite(i) => (HOOKE_NOT_FINITE, i),
            StepError::StepLimit(i) => (HOOKE_STEP_LIMIT, i),
            StepError::NotConverged(i) => (HOOKE_NOT_CONVERGED, i),
            StepError::Accuracy => (HOOKE_ACCURACY, NO_INDEX),
            StepError::Workspace { .. } => (HOOKE_TOO_SMALL, NO_INDEX),
        };
        Self { status, index }
    }
}

/// A status in words, a constant string. A number that is no status gives "unknown status".
#[unsafe(no_mangle)]
pub extern "C" fn hooke_message(status: i32) -> *const c_char {
    // In the order of the enum. A number and not the enum is taken: C can pass any.
    const MESSAGES: [&CStr; 27] = [
        c"done",
        c"a pointer is null",
        c"a pointer is misaligned",
        c"the buffer or array is too small",
        c"more than fits into memory",
        c"the handle is no scene of this precision",
        c"an argument points into the scene's buffer",
        c"the options have not been set",
        c"no room for another particle",
        c"no room for another spring",
        c"no such particle",
        c"no such spring",
        c"a value is, or would become, infinite or NaN",
        c"the mass is not positive and finite",
        c"the stiffness is negative, infinite or NaN",
        c"the rest length is negative, infinite or NaN",
        c"both ends are the same particle",
        c"the particle is pinned",
        c"the particle is not pinned",
        c"the spring is broken",
        c"dt is not a positive finite number",
        c"a tolerance is negative, infinite or NaN",
        c"gravity, drag or damping is infinite, NaN or negative",
        c"the motion of a pin is infinite or NaN",
        c"dt is beyond the limit of an explicit method",
        c"the equations of the step did not converge",
        c"no step is short enough for this accuracy",
    ];
    const { assert!(MESSAGES.len() == HOOKE_ACCURACY as usize + 1) };
    usize::try_from(status).ok().and_then(|n| MESSAGES.get(n)).unwrap_or(&c"unknown status").as_ptr()
}
