//! When a spring carries force at all: always (Hooke), or only in tension (a cable).
//!
//! The law is part of the scene's type. Under [`Hookean`], the default, nothing is stored and nothing branches. Under
//! [`Mixed`] each spring is one or the other by a mark in the spare bit of its index pair. A slack cable has V = 0,
//! f = 0, H = 0; at l = l₀ it is taut, with f = 0.

/// Which springs of a scene go slack when shorter than their rest length.
pub trait Law: 'static {
    /// Does a spring carry nothing when compressed? `marked` tells whether the spring was added as a cable.
    fn slackens(marked: bool) -> bool;
}

/// Every spring pushes and pulls: V = ½k(l − l₀)² on both sides of l₀.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Hookean;

/// Every spring only pulls: V = ½k(l − l₀)² for l ≥ l₀, else 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cables;

/// Springs added by `cable` only pull, the others push and pull.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Mixed;

impl Law for Hookean {
    #[inline(always)]
    fn slackens(_: bool) -> bool {
        false
    }
}

impl Law for Cables {
    #[inline(always)]
    fn slackens(_: bool) -> bool {
        true
    }
}

impl Law for Mixed {
    #[inline(always)]
    fn slackens(marked: bool) -> bool {
        marked
    }
}
