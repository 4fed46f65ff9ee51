//! What a step says of itself: how hard it worked, how exact it is, and what it did not have to do.

/// How the solve of one island ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Ending {
    /// The start already met the tolerance, or the island came to rest ([`crate::Rest`]): 0 iterations.
    Untouched,
    /// The tolerance is met.
    Converged,
    /// The residual is as small as its own rounding: no better answer can be recognised. A success.
    Floor,
    /// The maximal number of iterations was used up; the bounds tell how far it got.
    Capped,
    /// No progress above the floor (a breakdown in rounded arithmetic); the bounds tell how far it got.
    Stalled,
}

/// The solve of one island.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Solve<T> {
    /// PCG iterations, or solves with a direct solver's factors.
    pub iterations: u32,
    /// ½‖e‖²_A is at most this, J.
    pub upper: T,
    /// ½‖e‖²_A is at least this, J.
    pub lower: T,
    /// How it ended.
    pub ending: Ending,
    /// Did factors break down, or iterations in f32 stall ([`crate::SingleJacobi`], [`crate::Multigrid`]), so that block-Jacobi PCG
    /// had to answer, or blocks of the diagonal stood in for pivots ([`crate::BlockIlu`])?
    pub fallback: bool,
}

/// One island of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IslandReport<T> {
    /// Its first particle.
    pub first_particle: usize,
    /// Its number of (free) particles.
    pub particles: usize,
    /// Springs whose Hessian was clamped or replaced.
    pub clamped: u32,
    /// Did every node hold its certificate without clamping?
    pub certified: bool,
    /// Is it asleep ([`crate::Sleeping`])? Then nothing of it was assembled or solved; all else is as when it last was.
    pub asleep: bool,
    /// The solve.
    pub solve: Solve<T>,
}

/// A whole step. Sums over islands, unless said otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report<T> {
    /// Iterations of all islands together.
    pub iterations: u32,
    /// The error's energy ½‖e‖²_A is at most this, J.
    pub upper: T,
    /// The error's energy is at least this, J.
    pub lower: T,
    /// Springs whose Hessian was clamped or replaced.
    pub clamped: u32,
    /// Number of islands.
    pub islands: u32,
    /// Islands whose start already met the tolerance: 0 iterations.
    pub untouched: u32,
    /// Of these, islands asleep: neither assembled nor solved.
    pub asleep: u32,
    /// Islands certified without a projection pass.
    pub certified: u32,
    /// Islands that ended at the floor of their own rounding.
    pub at_floor: u32,
    /// Islands that used up their iterations.
    pub capped: u32,
    /// Islands that stalled above the floor.
    pub stalled: u32,
    /// Islands where factors broke down or f32 stalled: see [`Solve::fallback`].
    pub fallbacks: u32,
    /// Springs that no island needed: broken, or with both ends pinned.
    pub springs_skipped: u32,
}

impl<T: crate::Real> Report<T> {
    pub(crate) fn new(springs_skipped: usize) -> Self {
        Self {
            iterations: 0,
            upper: T::ZERO,
            lower: T::ZERO,
            clamped: 0,
            islands: 0,
            untouched: 0,
            asleep: 0,
            certified: 0,
            at_floor: 0,
            capped: 0,
            stalled: 0,
            fallbacks: 0,
            springs_skipped: springs_skipped as u32,
        }
    }

    /// The upper bound of all with one more island, rounded up.
    #[inline(always)]
    fn upper_with(&self, upper: T) -> T {
        (self.upper + upper) * (T::ONE + T::TWO * T::TWO * T::UNIT_ROUNDOFF)
    }

    /// Is the bound of all with one more island a number?
    #[inline(always)]
    pub(crate) fn has_room_for(&self, upper: T) -> bool {
        self.upper_with(upper).is_finite()
    }

    pub(crate) fn add(&mut self, island: &IslandReport<T>) {
        let ended = |ending| u32::from(island.solve.ending == ending);
        self.iterations = self.iterations.saturating_add(island.solve.iterations);
        // Sums of bounds are bounds: rounded up and down.
        let slack = T::TWO * T::TWO * T::UNIT_ROUNDOFF;
        self.upper = self.upper_with(island.solve.upper);
        self.lower = (self.lower + island.solve.lower) * (T::ONE - slack);
        self.clamped += island.clamped;
        self.islands += 1;
        self.untouched += ended(Ending::Untouched);
        self.asleep += u32::from(island.asleep);
        self.certified += u32::from(island.certified);
        self.at_floor += ended(Ending::Floor);
        self.capped += ended(Ending::Capped);
        self.stalled += ended(Ending::Stalled);
        self.fallbacks += u32::from(island.solve.fallback);
    }

    /// One more island of the step, shown to `watch`.
    pub(crate) fn island(
        &mut self,
        island: &crate::parts::IslandParts<'_, T>,
        clamped: u32,
        certified: bool,
        solve: Solve<T>,
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<(), crate::StepError> {
        let rows = island.matrix.rows.particle;
        let first_particle = rows.first().map_or(0, |i| *i as usize);
        if !self.has_room_for(solve.upper) {
            return Err(crate::StepError::NotFinite(first_particle));
        }
        let particles = rows.len();
        let island = IslandReport { first_particle, particles, clamped, certified, asleep: false, solve };
        self.add(&island);
        watch(&island);
        Ok(())
    }

    /// Did no island need a projection pass?
    pub fn is_certified(&self) -> bool {
        self.certified == self.islands
    }
}
