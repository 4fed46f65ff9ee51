//! Errors: one small enum per kind of call, each naming the particle or spring that failed. After any of them the
//! scene is as it was before the call.

use core::fmt;

/// Why an edit of a scene was refused. The number is the index of the particle or spring concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum EditError {
    /// There is no room for another particle; the number is the capacity.
    ParticlesFull(usize),
    /// There is no room for another spring; the number is the capacity.
    SpringsFull(usize),
    /// No such particle.
    NoParticle(usize),
    /// No such spring.
    NoSpring(usize),
    /// A position, velocity or impulse of this particle is infinite or NaN.
    NotFinite(usize),
    /// The mass of this particle is not a positive finite number.
    Mass(usize),
    /// The stiffness of this spring is negative, infinite or NaN.
    Stiffness(usize),
    /// The rest length of this spring is negative, infinite or NaN.
    RestLength(usize),
    /// Both ends of this spring are the same particle.
    SameEnds(usize),
    /// This particle is pinned: it has no velocity of its own.
    Pinned(usize),
    /// This particle is not pinned.
    NotPinned(usize),
    /// This spring is broken.
    Broken(usize),
    /// A snapshot does not fit: it holds more than this scene can; the number is how many particles it holds.
    Snapshot(usize),
}

/// Why a step was refused or failed. The state is as before the call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StepError {
    /// dt is not a positive finite number whose square is one too.
    TimeStep,
    /// The relative or absolute tolerance is negative, infinite or NaN.
    Tolerance,
    /// Gravity or drag has a value that is infinite, NaN or (drag) negative.
    Field,
    /// A force on this particle has a value that is infinite, NaN or (a stiffness, a rest length) negative.
    Force(usize),
    /// The damping of this spring is negative, infinite or NaN.
    Damping(usize),
    /// A force names a particle that does not exist.
    NoParticle(usize),
    /// A motion is given to a particle that is not pinned, or does not exist.
    NotPinned(usize),
    /// A motion's position or velocity is infinite or NaN, or too far away to reach in one step.
    Motion(usize),
    /// The matrix is not certified at this particle even after clamping: a force of the caller's own has a negative drag
    /// or Hessian, or one that is NaN.
    NotCertified(usize),
    /// The step would give this particle, or one of the island that begins with it, an infinite or NaN position or
    /// velocity, or no finite error bound.
    NotFinite(usize),
    /// dt is beyond the limit of an explicit method, which this particle sets.
    StepLimit(usize),
    /// The equations of the step were not solved: Newton's iterations found no way on, or there were too few of them. The
    /// particle begins the island.
    NotConverged(usize),
    /// No step short enough for the accuracy that is asked for could be accepted.
    Accuracy,
    /// A workspace is too small: it needs so many numbers and words, or more where other islands are
    /// larger still.
    Workspace {
        /// How many numbers.
        numbers: usize,
        /// How many words.
        words: usize,
    },
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ParticlesFull(n) => write!(f, "no room for another particle: the capacity is {n}"),
            Self::SpringsFull(n) => write!(f, "no room for another spring: the capacity is {n}"),
            Self::NoParticle(i) => write!(f, "there is no particle {i}"),
            Self::NoSpring(j) => write!(f, "there is no spring {j}"),
            Self::NotFinite(i) => write!(f, "particle {i}: the value is infinite or NaN"),
            Self::Mass(i) => write!(f, "particle {i}: the mass is not positive and finite"),
            Self::Stiffness(j) => write!(f, "spring {j}: the stiffness is negative, infinite or NaN"),
            Self::RestLength(j) => write!(f, "spring {j}: the rest length is negative, infinite or NaN"),
            Self::SameEnds(j) => write!(f, "spring {j}: both ends are the same particle"),
            Self::Pinned(i) => write!(f, "particle {i} is pinned"),
            Self::NotPinned(i) => write!(f, "particle {i} is not pinned"),
            Self::Broken(j) => write!(f, "spring {j} is broken"),
            Self::Snapshot(n) => write!(f, "the snapshot of {n} particles does not fit"),
        }
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TimeStep => write!(f, "dt is not a positive finite number"),
            Self::Tolerance => write!(f, "a tolerance is negative, infinite or NaN"),
            Self::Field => write!(f, "gravity or drag has an infinite, NaN or negative value"),
            Self::Force(i) => write!(f, "a force on particle {i} has an infinite, NaN or negative value"),
            Self::Damping(j) => write!(f, "spring {j}: the damping is negative, infinite or NaN"),
            Self::NotCertified(i) => {
                write!(f, "the matrix at particle {i} is not positive: a force there is not dissipative")
            }
            Self::NoParticle(i) => write!(f, "a force acts on particle {i}, which does not exist"),
            Self::NotPinned(i) => write!(f, "a motion is given to particle {i}, which is not pinned"),
            Self::Motion(i) => {
                write!(f, "the motion of pinned particle {i} is infinite, NaN or too far for one step")
            }
            Self::NotFinite(i) => {
                write!(f, "particle {i}, or its island, would leave the range of the numbers")
            }
            Self::StepLimit(i) => {
                write!(f, "dt is beyond the limit of an explicit method, which particle {i} sets")
            }
            Self::NotConverged(i) => {
                write!(
                    f,
                    "Newton's iterations did not converge on the island of particle {i}: take a shorter step"
                )
            }
            Self::Accuracy => {
                write!(
                    f,
                    "no step is short enough for this accuracy: ask for less, or for a higher precision"
                )
            }
            Self::Workspace { numbers, words } => {
                write!(f, "the workspace is too small: give it {numbers} numbers and {words} words")
            }
        }
    }
}

impl core::error::Error for EditError {}
impl core::error::Error for StepError {}
