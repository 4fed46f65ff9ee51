//! Islands asleep: neither assembled nor solved while nothing about them changes.
//!
//! A step is a function of what goes into it. At q̇ = 0 that is, of an island: M̃ and h f (asked of the forces in every step),
//! Δx, k, l₀ and c of its springs, its pattern, dt and the absolute tolerance. All of it is remembered, number by number, in
//! every step that begins at q̇ = 0. If the step answered Δ = 0 ([`super::Rest`]), the island is *asleep*: while all is as
//! remembered, compared number by number, the step would answer the same bits again, its report included, and is not made.
//! Anything else wakes it: an edit, a force, a pin that moves, a restored snapshot, another scene.
//!
//! Where pins or springs were added, released or broken anywhere, the whole scene is awake for that step. An island that a
//! point spring holds is never asleep: what it does is not the island's own to remember.
//!
//! Cost per step: of an island asleep 7 comparisons per spring and 4 per particle, no root, no product; of one that moves,
//! up to its first moving particle; of all, one word per particle and spring for the pattern.
//! Memory: 6 numbers per particle and spring, 2 words per particle and 1 per spring.

use super::pattern::{self, remember};
use super::{Found, Rest, steps};
use crate::error::StepError;
use crate::force::Force;
use crate::islands::Islands;
use crate::memory::{Memory, part_mut};
use crate::network::State;
use crate::parts::{IslandParts, Parts, Vectors};
use crate::real::Real;
use crate::report::{Ending, IslandReport, Solve};
use crate::system::System;
use crate::vec3;

/// The rule of [`Rest`] with a memory of the caller's: arrays, borrowed slices, vectors.
///
/// ```
/// use hooke::{LinearlyImplicitEuler, Scene, Sleeping};
/// const NEEDS: (usize, usize) = Sleeping::needs(2, 1);
/// let mut scene = Box::new(Scene::<f32, 2, 1>::new());
/// let (a, b) = (scene.particle([0.0; 3], 1.0)?, scene.particle([1.0, 0.0, 0.0], 1.0)?);
/// scene.spring(a, b, 100.0)?;
/// let sleeping = Sleeping::new(1e-9, [0.0; NEEDS.0], [0; NEEDS.1]);
/// let mut euler = LinearlyImplicitEuler::new(0.01).sleeping(sleeping);
/// assert_eq!(scene.step(&mut euler)?.asleep, 0); // at rest, and remembered
/// assert_eq!(scene.step(&mut euler)?.asleep, 1); // not assembled, not solved
/// scene.impulse(a, [0.1, 0.0, 0.0])?;
/// assert_eq!(scene.step(&mut euler)?.asleep, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Sleeping<T, N, W> {
    rule: Rest<T>,
    numbers: N,
    words: W,
    /// What the memory belongs to: dt and absolute tolerance; particles and unknowns of the pattern
    method: [T; 2],
    sizes: [usize; 2],
    /// Where the next island's springs are, islands being asked for in their order
    next: usize,
}

/// Notes about an island, at its first row: it began the last step at rest and is remembered; it is asleep, was
/// certified, and in the other bits how many of its springs were clamped.
const REMEMBERED: u32 = 1 << 29;
const CERTIFIED: u32 = 1 << 30;
const ASLEEP: u32 = 1 << 31;

impl Sleeping<(), (), ()> {
    /// How many numbers and words a scene of so many particles and springs needs.
    pub const fn needs(particles: usize, springs: usize) -> (usize, usize) {
        let numbers = particles.saturating_add(springs).saturating_mul(6);
        (numbers, particles.saturating_mul(2).saturating_add(springs))
    }
}

impl<T: Real, N, W> Sleeping<T, N, W> {
    /// Brings to rest what [`Rest`] of so many joules does, in this memory; [`Sleeping::needs`] says how large it is to be. If
    /// it is too small, a step fails with [`StepError::Workspace`], which says so too.
    pub const fn new(joules: T, numbers: N, words: W) -> Self {
        Self { rule: Rest(joules), numbers, words, method: [T::ZERO; 2], sizes: [0; 2], next: 0 }
    }
}

impl<T: Real, N: AsMut<[T]>, W: AsMut<[u32]>> Sleeping<T, N, W> {
    /// What is remembered of each row (M̃, h f, both bounds of its island's solve) and of each spring (Δx, k, l₀, c), in the
    /// order of the islands: while the pattern is the same, no island's lie in another's place.
    fn records(&mut self) -> (&mut [[T; 6]], &mut [[T; 6]]) {
        let records = self.numbers.as_mut().as_chunks_mut().0;
        records.split_at_mut_checked(self.sizes[0]).unwrap_or_default()
    }

    fn note(&mut self, first_row: usize) -> Option<&mut u32> {
        self.words.as_mut().get_mut(first_row)
    }

    /// Remembers the pattern of the whole scene; answers whether it is the one that was.
    #[inline(never)]
    fn is_pattern<M: Memory<Real = T>>(&mut self, islands: &Islands<M>, state: &State<'_, T>) -> bool {
        let particles = state.mass.len();
        let same = remember(Some(&mut self.sizes), [particles, islands.free]);
        let words = self.words.as_mut().get_mut(particles..).unwrap_or_default();
        words
            .split_at_mut_checked(particles)
            .is_some_and(|words| pattern::is_as_before(words, islands, state))
            && same
    }

    /// Remembers the numbers that an island's step from q̇ = 0 depends on; answers whether they are those that were, and
    /// `None` if it does not begin at q̇ = 0.
    #[inline(never)]
    fn is_as_before<F: Force<T>>(&mut self, island: &IslandParts<'_, T>, forces: &F) -> Option<bool> {
        let matrix = &island.matrix;
        let state = matrix.rows.state();
        let first_spring = self.next;
        self.next += island.spring.len();
        if F::ANCHORS && island.vectors.y.iter().any(|mark| mark[0] != T::ZERO) {
            return None;
        }
        let rest = |v: Option<&vec3::Vec3<T>>| v == Some(&[T::ZERO; 3]);
        if !matrix.rows.particles().all(|i| rest(state.velocity.get(i))) {
            return None;
        }
        let (rows, springs) = self.records();
        let (rows, springs) = (rows.get_mut(matrix.rows.first..)?, springs.get_mut(first_spring..)?);
        let mut same = true;
        for (place, (m, b)) in rows.iter_mut().zip(matrix.inertia.iter().zip(island.vectors.b.iter())) {
            let [.., upper, lower] = *place;
            same &= remember(Some(place), [*m, b[0], b[1], b[2], upper, lower]);
        }
        let mut edges = matrix.other.iter().zip(island.spring).zip(springs);
        for (row, own) in matrix.own.iter().enumerate() {
            let near = island.end(row);
            for ((other, j), place) in edges.by_ref().take(*own as usize) {
                let (far, j) = (island.end(*other as usize), *j as usize);
                if !rest(Some(&far.velocity)) {
                    return None;
                }
                let [x, y, z] = vec3::sub(near.position, far.position);
                let (spring, c) = (state.spring(j), if F::DAMPS { forces.damping(j) } else { T::ZERO });
                same &= remember(Some(place), [x, y, z, spring.stiffness, spring.rest_length, c]);
            }
        }
        Some(same)
    }
}

impl<T: Real, N: AsMut<[T]>, W: AsMut<[u32]>> steps::Sleeps<T> for Sleeping<T, N, W> {
    fn begin<M: Memory<Real = T>>(
        &mut self,
        parts: &Parts<'_, M>,
        dt: T,
        absolute: T,
    ) -> Result<(), StepError> {
        self.rule.begin(parts, dt, absolute)?;
        let state = parts.network.state();
        let (numbers, words) = Sleeping::needs(state.mass.len(), state.springs());
        if self.numbers.as_mut().len() < numbers || self.words.as_mut().len() < words {
            return Err(StepError::Workspace { numbers, words });
        }
        let method = remember(Some(&mut self.method), [dt, absolute]);
        if !(self.is_pattern(parts.islands, &state) && method) {
            part_mut(self.words.as_mut(), 0..state.mass.len()).fill(0);
        }
        self.next = 0;
        Ok(())
    }

    fn asleep<F: Force<T>>(
        &mut self,
        island: &mut IslandParts<'_, T>,
        forces: &F,
    ) -> Option<IslandReport<T>> {
        let same = self.is_as_before(island, forces);
        let first = island.matrix.rows.first;
        let note = self.note(first)?;
        let asleep = *note & ASLEEP != 0 && same == Some(true);
        if !asleep {
            *note = if same.is_some() { REMEMBERED } else { 0 };
            return None;
        }
        let (certified, clamped) = (*note & CERTIFIED != 0, *note & (REMEMBERED - 1));
        let [.., upper, lower] = *self.records().0.get(first)?;
        island.vectors.x.fill([T::ZERO; 3]);
        let solve = Solve { iterations: 0, upper, lower, ending: Ending::Untouched, fallback: false };
        let first_particle = island.matrix.rows.particles().next()?;
        let particles = island.matrix.rows.particle.len();
        Some(IslandReport { first_particle, particles, clamped, certified, asleep: true, solve })
    }

    fn is_slow(&self, island: &IslandParts<'_, T>) -> bool {
        self.rule.is_slow(island)
    }

    fn rest<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        vectors: &mut Vectors<'_, T>,
        absolute: T,
        found: Found,
    ) -> Option<Solve<T>> {
        let solve = self.rule.rest(system, vectors, absolute, found)?;
        let first = system.matrix.rows.first;
        // A step without a finite bound is about to fail, and is to fail again.
        let kept = found.clamped < REMEMBERED && solve.upper.is_finite();
        if let Some(note) = self.note(first).filter(|note| kept && **note == REMEMBERED) {
            *note = ASLEEP | if found.certified { CERTIFIED } else { 0 } | found.clamped;
            if let Some([.., upper, lower]) = self.records().0.get_mut(first) {
                (*upper, *lower) = (solve.upper, solve.lower);
            }
        }
        Some(solve)
    }
}
