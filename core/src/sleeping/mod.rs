//! Sleeping: islands that have come to rest are brought to a stop, and skipped until something about them changes.
//!
//! Off unless it is named: a method made by [`crate::LinearlyImplicitEuler::new`] is [`Awake`]. Two questions, two types:
//!
//! - [`Rest`], the rule by which q̇ becomes 0. It changes the trajectory.
//! - [`Sleeping`], the same rule with a memory. An island whose q̇ = 0 and whose step cannot but return the same bits is not
//!   assembled and not solved; the memory only tells whether anything about it has changed. Its bits are those of [`Rest`].
//!
//! `Option` of one is decided when the program runs; `&mut` of one outlives the method that uses it.

mod asleep;
mod pattern;
mod rest;

pub use asleep::Sleeping;
pub use rest::Rest;

use crate::error::StepError;
use crate::force::Force;
use crate::memory::Memory;
use crate::parts::{IslandParts, Parts, Vectors};
use crate::real::Real;
use crate::report::{IslandReport, Solve};
use crate::system::System;

/// What a method does about islands at rest: [`Awake`], [`Rest`] or [`Sleeping`] (sealed).
pub trait Sleep<T: Real>: steps::Sleeps<T> {}
impl<T: Real, S: steps::Sleeps<T>> Sleep<T> for S {}

/// Nothing is done about them: every island is assembled and solved in every step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Awake;

/// What an island's assembly found, for its report.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    /// Springs clamped or replaced
    pub(crate) clamped: u32,
    /// Certified without
    pub(crate) certified: bool,
}

pub(crate) mod steps {
    use super::*;

    /// Where a step asks. Every method has a default that does nothing.
    pub trait Sleeps<T: Real> {
        /// A step of so many seconds begins, with this absolute tolerance.
        #[inline(always)]
        fn begin<M: Memory<Real = T>>(
            &mut self,
            _: &Parts<'_, M>,
            _dt: T,
            _absolute: T,
        ) -> Result<(), StepError> {
            Ok(())
        }

        /// The report of an island that is asleep, with Δ = 0 in x. Asked after [`crate::assembly::prepare`].
        #[inline(always)]
        fn asleep<F: Force<T>>(&mut self, _: &mut IslandParts<'_, T>, _: &F) -> Option<IslandReport<T>> {
            None
        }

        /// Is an island slow enough to come to rest? Only then is [`Sleeps::rest`] asked.
        #[inline(always)]
        fn is_slow(&self, _: &IslandParts<'_, T>) -> bool {
            false
        }

        /// The step of an assembled island that comes to rest, Δ = −q̇. Otherwise its solver is to be asked; b and μ are
        /// then as they were.
        #[inline(always)]
        fn rest<F: Force<T>>(
            &mut self,
            _: &System<'_, T, F>,
            _: &mut Vectors<'_, T>,
            _absolute: T,
            _: Found,
        ) -> Option<Solve<T>> {
            None
        }
    }
}

impl<T: Real> steps::Sleeps<T> for Awake {}

/// One that outlives the method which uses it.
impl<T: Real, S: steps::Sleeps<T>> steps::Sleeps<T> for &mut S {
    #[inline]
    fn begin<M: Memory<Real = T>>(
        &mut self,
        parts: &Parts<'_, M>,
        dt: T,
        absolute: T,
    ) -> Result<(), StepError> {
        (**self).begin(parts, dt, absolute)
    }
    #[inline]
    fn asleep<F: Force<T>>(
        &mut self,
        island: &mut IslandParts<'_, T>,
        forces: &F,
    ) -> Option<IslandReport<T>> {
        (**self).asleep(island, forces)
    }
    #[inline]
    fn is_slow(&self, island: &IslandParts<'_, T>) -> bool {
        (**self).is_slow(island)
    }
    #[inline]
    fn rest<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        vectors: &mut Vectors<'_, T>,
        absolute: T,
        found: Found,
    ) -> Option<Solve<T>> {
        (**self).rest(system, vectors, absolute, found)
    }
}

/// Decided when the program runs: `None` is [`Awake`].
impl<T: Real, S: steps::Sleeps<T>> steps::Sleeps<T> for Option<S> {
    #[inline]
    fn begin<M: Memory<Real = T>>(
        &mut self,
        parts: &Parts<'_, M>,
        dt: T,
        absolute: T,
    ) -> Result<(), StepError> {
        self.as_mut().map_or(Ok(()), |sleep| sleep.begin(parts, dt, absolute))
    }
    #[inline]
    fn asleep<F: Force<T>>(
        &mut self,
        island: &mut IslandParts<'_, T>,
        forces: &F,
    ) -> Option<IslandReport<T>> {
        self.as_mut()?.asleep(island, forces)
    }
    #[inline]
    fn is_slow(&self, island: &IslandParts<'_, T>) -> bool {
        self.as_ref().is_some_and(|sleep| sleep.is_slow(island))
    }
    #[inline]
    fn rest<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        vectors: &mut Vectors<'_, T>,
        absolute: T,
        found: Found,
    ) -> Option<Solve<T>> {
        self.as_mut()?.rest(system, vectors, absolute, found)
    }
}
