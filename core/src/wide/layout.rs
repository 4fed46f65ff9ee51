//! Offset runs: a cloth's springs join particles i and i + d for a few distances d. Stored per distance as arrays over i,
//! zero where there is no spring, a product needs no index and no scatter.
//!
//! A particle's place is its number counted from the lowest that the island's springs touch, so pins keep their places
//! among the rows instead of shifting what comes after them; what is no row is masked by a mass of 0. A spring's place is
//! that of its lower end. Which place and run each spring has is kept in a word, found once and compared again at each
//! step: a layout that no longer fits is found anew.

use crate::parts::IslandParts;
use crate::real::Real;
use crate::wide::eight::WIDTH;
use crate::wide::slots::{self, Counts};

/// At most so many distances.
pub(crate) const MOST_RUNS: usize = 16;
/// At least so many rows at a time.
const STRETCH: usize = 1024;
/// A spring's word: its run in the upper bits, its place in the lower.
const PLACE_BITS: u32 = 27;
const PLACE: u32 = (1 << PLACE_BITS) - 1;

/// Some rows' eights.
#[inline(always)]
pub(crate) fn eights([first, stop]: [usize; 2]) -> impl Iterator<Item = usize> {
    (0..stop.saturating_sub(first) / WIDTH).map(move |k| first + k * WIDTH)
}

/// Where an island's rows and springs lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// The distances, ascending; the first `runs` are in use
    distance: [u32; MOST_RUNS],
    pub(crate) runs: usize,
    /// The particle at place 0
    pub(crate) base: usize,
    /// Number of places, rounded up to whole tiles
    pub(crate) places: usize,
    /// Zeros before them: the farthest distance, rounded up; none in slots
    pub(crate) pad: usize,
    /// Zeros behind them: as many; in slots one per spring to a pin, rounded up
    pub(crate) behind: usize,
    /// In slots instead of runs: how many
    pub(crate) slots: Option<Counts>,
    /// How many springs it was found from
    pub(crate) springs: usize,
}

/// A spring in the numbering: particle of its lower end, distance to the other, and whether its row is the upper one (the
/// lower then is a pin).
pub(crate) struct Pair {
    pub(crate) low: u32,
    pub(crate) distance: u32,
    pub(crate) turned: bool,
}

impl Pair {
    #[inline(always)]
    pub(crate) fn new(row: u32, other: u32) -> Self {
        if row < other {
            Self { low: row, distance: other - row, turned: false }
        } else {
            Self { low: other, distance: row - other, turned: true }
        }
    }
}

impl Layout {
    /// Of nothing.
    pub(crate) const fn none() -> Self {
        Self {
            distance: [0; MOST_RUNS],
            runs: 0,
            base: 0,
            places: 0,
            pad: 0,
            behind: 0,
            slots: None,
            springs: 0,
        }
    }

    /// Numbers in a plane.
    #[inline(always)]
    pub(crate) fn plane(&self) -> usize {
        self.pad + self.places + self.behind
    }

    /// The distances in use.
    #[inline(always)]
    pub(crate) fn distances(&self) -> &[u32] {
        self.distance.get(..self.runs).unwrap_or_default()
    }

    /// Where the tiles begin.
    #[inline(always)]
    pub(crate) fn tiles(&self) -> impl Iterator<Item = usize> + use<> {
        eights([self.pad, self.pad + self.places])
    }

    /// Rows whose springs are computed before they gather, in runs: the numbers of so many stay in the cache meanwhile.
    #[inline(always)]
    pub(crate) fn stretch(&self) -> usize {
        core::cmp::min(core::cmp::max(self.pad, STRETCH), self.places)
    }

    /// Numbers in a plane of pulls: a stretch's, and before them those of the rows above that reach it.
    #[inline(always)]
    pub(crate) fn pulls(&self) -> usize {
        self.pad + self.stretch()
    }

    /// Where a particle lies in a plane, in runs.
    #[inline(always)]
    pub(crate) fn place(&self, particle: u32) -> usize {
        (particle as usize).wrapping_sub(self.base).wrapping_add(self.pad)
    }

    /// How many words it has.
    pub(crate) fn words(&self) -> usize {
        self.slots.as_ref().map_or(self.springs, Counts::words)
    }

    /// The layout that an island has, with its counts: in runs, or else in slots. The blocks are scratch.
    pub(crate) fn of<T: Real>(island: &mut IslandParts<'_, T>) -> Option<Self> {
        Self::shape(island).or_else(|| slots::arrange(island))
    }

    /// Where the first of a spring's numbers lies among the Hessians' planes.
    #[inline(always)]
    pub(crate) fn at(&self, word: u32) -> usize {
        4 * (word >> PLACE_BITS) as usize * self.plane() + self.pad + (word & PLACE) as usize
    }

    /// The run and the place that a spring's word stands for, if they are those of this pair.
    #[inline(always)]
    pub(crate) fn run_of(&self, word: u32, pair: &Pair) -> Option<usize> {
        let run = (word >> PLACE_BITS) as usize;
        let same = self.distance.get(run) == Some(&pair.distance)
            && (word & PLACE) as usize == (pair.low as usize).wrapping_sub(self.base);
        same.then_some(run)
    }

    /// Finds in `words` where each spring lies. `None` if two springs lie at one place.
    #[inline(never)]
    pub(crate) fn find<T: Real>(self, island: &mut IslandParts<'_, T>, words: &mut [u32]) -> Option<Self> {
        if let Some(counts) = &self.slots {
            return slots::fill(island, counts, words).map(|()| self);
        }
        let layout = self;
        // Two springs of the same distance cannot lie at the same place.
        let mut twice = false;
        let mut words = words.iter_mut();
        let mut others = island.matrix.other.iter();
        for (row, own) in island.matrix.own.iter().enumerate() {
            let mut seen = [0_u32; 2];
            for other in others.by_ref().take(*own as usize) {
                let pair = island.pair(row, *other as usize)?;
                let run = layout.distances().iter().position(|d| *d == pair.distance)? as u32;
                let [straight, turned] = &mut seen;
                let seen = if pair.turned { turned } else { straight };
                twice |= *seen & (1 << run) != 0;
                *seen |= 1 << run;
                let place = pair.low.wrapping_sub(layout.base as u32);
                *words.next()? = run << PLACE_BITS | place;
            }
        }
        (!twice).then_some(layout)
    }

    /// The distances and the places of runs; no memory is needed to see whether there are not too many. `None` if there
    /// are, or the runs would be mostly zeros.
    pub(crate) fn shape<T: Real>(island: &IslandParts<'_, T>) -> Option<Self> {
        let mut layout = Self::none();
        let rows = island.matrix.own.len();
        let (mut lowest, mut highest) =
            (*island.particle.first()?, *island.particle.get(rows.checked_sub(1)?)?);
        let mut others = island.matrix.other.iter();
        for (row, own) in island.matrix.own.iter().enumerate() {
            for other in others.by_ref().take(*own as usize) {
                let pair = island.pair(row, *other as usize)?;
                layout.meet(pair.distance)?;
                lowest = core::cmp::min(lowest, pair.low);
                highest = core::cmp::max(highest, pair.low + pair.distance);
            }
        }
        let farthest = layout.distances().last().copied().unwrap_or(0) as usize;
        layout.base = lowest as usize;
        layout.places = ((highest - lowest) as usize + 1).next_multiple_of(WIDTH);
        layout.pad = farthest.next_multiple_of(WIDTH);
        layout.behind = layout.pad;
        layout.springs = island.matrix.other.len();
        let springs = island.matrix.other.len();
        let worth_it = layout.runs * layout.places <= 2 * springs + 64
            && layout.places <= 2 * rows + 64
            && layout.places <= PLACE as usize;
        worth_it.then_some(layout)
    }

    /// Adds a distance, in order.
    fn meet(&mut self, d: u32) -> Option<()> {
        let at = self.distances().iter().position(|have| *have >= d).unwrap_or(self.runs);
        if self.distances().get(at) == Some(&d) {
            return Some(());
        }
        if self.runs == MOST_RUNS {
            return None;
        }
        let mut carried = d;
        for place in self.distance.iter_mut().take(self.runs + 1).skip(at) {
            core::mem::swap(place, &mut carried);
        }
        self.runs += 1;
        Some(())
    }
}

impl<T> IslandParts<'_, T> {
    /// A spring's ends in the caller's numbering.
    #[inline(always)]
    pub(crate) fn pair(&self, row: usize, other: usize) -> Option<Pair> {
        Some(Pair::new(*self.particle.get(row)?, *self.particle.get(other)?))
    }
}
