//! One island's step in lanes: load, assemble, certify, and where the certificate fails clamp and certify again.

use crate::assembly::Assembled;
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::parts::IslandParts;
use crate::real::Real;
use crate::vec3;
use crate::wide::assembly::{certify, charge, clamp, fails, gather, linearize};
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::load as load_lanes;
use crate::wide::layout::Layout;
use crate::wide::load::{load, load_slots};
use crate::wide::neighbours::{Neighbours, Way, either};
use crate::wide::slots::NUMBERS;
use crate::wide::work::{Front, Workshop};

/// What an island is assembled from.
pub(crate) struct Givens<'g, 'a, T, F, D> {
    pub(crate) island: &'g IslandParts<'a, T>,
    pub(crate) forces: &'g mut F,
    pub(crate) h: T,
    pub(crate) scaling: Scaling<T>,
    pub(crate) layout: &'g Layout,
    pub(crate) words: &'g [u32],
    pub(crate) way: Way<'g>,
    pub(crate) dispatch: D,
}

impl<T: Real, F: Force<T>, D: Dispatch> Givens<'_, '_, T, F, D> {
    /// A, b and μ into the front; `None` if the layout is not the island's any more.
    pub(crate) fn assemble<L: Law>(
        &mut self,
        front: &mut Front<'_, T>,
        workshop: &mut Workshop<'_, T>,
    ) -> Result<Option<Assembled>, StepError> {
        let fits = match &self.way {
            Way::Runs(_) => {
                load::<T, F, L>(self.island, self.forces, self.layout, self.words, front, workshop)
            }
            Way::Slots(slots) => {
                load_slots::<T, F, L>(self.island, self.forces, self.layout, slots, front, workshop)
            }
        };
        if !fits {
            return Ok(None);
        }
        let points = F::ANCHORS && self.island.vectors.y.iter().any(|mark| mark[0] != T::ZERO);
        self.clear_margins(workshop.pulls);
        let mut replaced = self.linearize::<L>(front, workshop);
        if points {
            replaced += self.forces.linearize(&self.island.matrix.rows, self.scaling);
            self.charge_points(front);
        }
        let certified = self.certify(front);
        let clamped = if certified { 0 } else { self.project::<L>(front, workshop, points)? };
        if points {
            self.subtract_points(front, workshop);
        }
        let free = self.island.anchors == 0 && !points;
        Ok(Some(Assembled {
            clamped: replaced + clamped,
            certified: certified && replaced == 0,
            points,
            free,
        }))
    }

    /// Nobody above the first rows pulls at them, nor does a spring that is not there.
    fn clear_margins(&self, pulls: &mut [T]) {
        if let Some(nothing) = pulls.get_mut(..NUMBERS) {
            nothing.fill(T::ZERO);
        }
        for plane in 0..3 * self.layout.runs {
            let first = plane * self.layout.pulls();
            if let Some(margin) = pulls.get_mut(first..first + self.layout.pad) {
                margin.fill(T::ZERO);
            }
        }
    }

    fn linearize<L: Law>(&self, front: &mut Front<'_, T>, workshop: &mut Workshop<'_, T>) -> u32 {
        either!(self.way, neighbours => self.linearize_in::<L, _>(neighbours, front, workshop))
    }

    #[inline(always)]
    fn linearize_in<L: Law, N: Neighbours>(
        &self,
        neighbours: N,
        front: &mut Front<'_, T>,
        workshop: &mut Workshop<'_, T>,
    ) -> u32 {
        let (layout, h, scaling) = (self.layout, self.h, self.scaling);
        self.dispatch.run(
            #[inline(always)]
            || {
                let (mut replaced, mut first) = (0, layout.pad);
                while first < layout.pad + layout.places {
                    let (neighbours, stop) = neighbours.stretch(first);
                    let rows = [first, stop];
                    replaced += if F::DAMPS {
                        linearize::<T, L, N, true>(neighbours, rows, front, workshop, h, scaling)
                    } else {
                        linearize::<T, L, N, false>(neighbours, rows, front, workshop, h, scaling)
                    };
                    gather(neighbours, rows, front, workshop.pulls);
                    charge(neighbours, rows, front);
                    neighbours.keep(workshop.pulls);
                    first = stop;
                }
                replaced
            },
        )
    }

    fn certify(&self, front: &mut Front<'_, T>) -> bool {
        self.dispatch.run(
            #[inline(always)]
            || certify(self.layout, front),
        )
    }

    /// See [`crate::assembly`].
    #[inline(never)]
    fn project<L: Law>(
        &mut self,
        front: &mut Front<'_, T>,
        workshop: &mut Workshop<'_, T>,
        points: bool,
    ) -> Result<u32, StepError> {
        let (layout, scaling) = (self.layout, self.scaling);
        let mut clamped = 0;
        if points {
            let rows = self.island.matrix.rows;
            let fails = |row: usize| {
                let at = rows.particle.get(row).map(|particle| self.way.place(row, *particle));
                !at.and_then(|at| front.mu.get(at)).is_some_and(|mu| *mu > T::ZERO)
            };
            clamped += self.forces.clamp(&rows, scaling, fails);
        }
        self.clear_margins(workshop.pulls);
        clamped += either!(self.way, neighbours => self.clamp_in::<L, _>(neighbours, front, workshop));
        if points {
            self.charge_points(front);
        }
        if self.certify(front) {
            return Ok(clamped);
        }
        let failing = layout.tiles().find_map(|at| {
            let lanes = fails(load_lanes(front.inertia, at), load_lanes(front.mu, at));
            let lane = lanes.0.iter().position(|fails| *fails > T::ZERO)?;
            self.way.particle(at + lane, self.island.matrix.rows.particle)
        });
        Err(StepError::NotCertified(failing.unwrap_or(0)))
    }

    #[inline(always)]
    fn clamp_in<L: Law, N: Neighbours>(
        &self,
        neighbours: N,
        front: &mut Front<'_, T>,
        workshop: &mut Workshop<'_, T>,
    ) -> u32 {
        let (layout, scaling) = (self.layout, self.scaling);
        self.dispatch.run(
            #[inline(always)]
            || {
                let (mut clamped, mut first) = (0, layout.pad);
                while first < layout.pad + layout.places {
                    let (neighbours, stop) = neighbours.stretch(first);
                    let rows = [first, stop];
                    clamped += if F::DAMPS {
                        clamp::<T, L, N, true>(neighbours, rows, front, workshop, scaling)
                    } else {
                        clamp::<T, L, N, false>(neighbours, rows, front, workshop, scaling)
                    };
                    gather(neighbours, rows, front, workshop.pulls);
                    // Nobody asks for these rows' μ as it was any more: springs are at the rows above.
                    charge(neighbours, rows, front);
                    neighbours.keep(workshop.pulls);
                    first = stop;
                }
                clamped
            },
        )
    }

    /// b −= Σ H q̇ over point springs.
    fn subtract_points(&self, front: &mut Front<'_, T>, workshop: &Workshop<'_, T>) {
        self.each_point(|at, hessian| {
            let pull = hessian.mul(workshop.velocity.row(at));
            front.b.put(at, vec3::sub(front.b.row(at), pull));
        });
    }

    fn charge_points(&self, front: &mut Front<'_, T>) {
        self.each_point(|at, hessian| crate::certificate::charge(front.mu, at, T::ONE, &hessian));
    }

    fn each_point(&self, mut visit: impl FnMut(usize, Hessian<T>)) {
        let rows = self.island.matrix.rows;
        self.forces.hessians(&rows, &mut |row, hessian| {
            if let Some(particle) = rows.particle.get(row) {
                visit(self.way.place(row, *particle), hessian);
            }
        });
    }
}
