//! Assembly of one island's step: Σ E_jᵀ f_j, the compressed Hessians, the certificate, and the right side.
//!
//! The step solves for the change of velocity Δ from zero. With q̇ on free rows and the pins' velocity over the step on
//! the others, A q̇⁺ = Mq̇ + h f on the free rows becomes
//!
//! A Δ = b,  b = h f − θh D q̇ − Σ_j E_jᵀ H_j (Δq̇)_j,
//!
//! H_j scaled and clamped as in A ("K̃ on both sides": the equation that is solved is the lecture's with K̃ for K). One
//! root for l and one for w per spring. Where all nodes are certified there is no second look at the springs' lengths.
//!
//! Source: the mass-spring lecture (assembly, linearly-implicit integration); DESIGN §2.4 and §4.

use crate::certificate::{certify, charge, fails};
use crate::force::{Force, Rows};
use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::network::State;
use crate::parts::{IslandParts, Work};
use crate::real::Real;
use crate::selection::{self, Ends};
use crate::spring::{Spring, Stretched};
use crate::system::System;
use crate::vec3;

/// What assembling found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Assembled {
    /// Springs clamped or replaced.
    pub(crate) clamped: u32,
    /// No projection pass was needed.
    pub(crate) certified: bool,
    /// Nothing holds this island: no pin, no point spring.
    pub(crate) free: bool,
}

/// A spring of an island at the present state: its ends as particles, in the order of its slots.
struct Edge<T> {
    spring: Spring<T>,
    stretched: Stretched<T>,
    damping: T,
    slack: bool,
}

impl<T: Real> Edge<T> {
    #[inline(always)]
    fn new<F: Force<T>, L: Law>(state: &State<'_, T>, forces: &F, j: usize, a: usize, b: usize) -> Self {
        let spring = state.spring(j);
        let stretched = Stretched::new(selection::difference(a, b, state.position));
        let damping = if F::DAMPS { forces.damping(j) } else { T::ZERO };
        let marked = state.ends.get(j).is_some_and(|pair| Ends::unpack(*pair).cable);
        Self {
            spring,
            stretched,
            damping,
            slack: L::slackens(marked) && stretched.length < spring.rest_length,
        }
    }

    #[inline(always)]
    fn hessian(&self, scaling: Scaling<T>) -> Hessian<T> {
        if self.slack {
            return Hessian { alpha: T::ZERO, w: [T::ZERO; 3] };
        }
        Hessian::new(self.spring, self.stretched, self.damping, scaling)
    }

    /// Is H a replacement because the length is 0 and the rest length is not?
    #[inline(always)]
    fn replaced(&self) -> bool {
        !self.slack && self.stretched.length == T::ZERO && self.spring.rest_length > T::ZERO
    }
}

/// The particle in a slot.
#[inline(always)]
fn particle(of: &[u32], slot: usize) -> usize {
    of.get(slot).map_or(usize::MAX, |i| *i as usize)
}

/// Assembles A, μ and b of an island for a method with matrix M + θhD − sK and right side h f + … as above.
pub(crate) fn assemble<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    particles: &[u32],
    forces: &mut F,
    h: T,
    scaling: Scaling<T>,
) -> Assembled {
    let IslandParts { rows, pairs, anchors, spring, pin_velocity, free, work, .. } = island;
    let state = rows.state;
    let Work { b, inertia, mu, hessian, .. } = work;

    for (((b, m), mu), i) in b.iter_mut().zip(inertia.iter_mut()).zip(mu.iter_mut()).zip(rows.particles()) {
        let mass = state.mass.get(i).copied().unwrap_or(T::ONE);
        *b = [T::ZERO; 3];
        *m = if F::DRAGS { mass + scaling.damping * forces.drag(i, mass) } else { mass };
        *mu = T::ZERO;
    }
    forces.add(rows, b);

    // Forces and Hessians, spring by spring; μ collects the compressed ones.
    let ends = |e: usize, [a, b]: [u32; 2]| {
        let a_particle = particle(rows.particle, a as usize);
        let b_particle = if e < pairs.len() {
            particle(rows.particle, b as usize)
        } else {
            particle(particles, b as usize)
        };
        (a_particle, b_particle)
    };
    let edges = || pairs.iter().chain(anchors.iter()).copied().zip(spring.iter()).enumerate();
    let mut clamped = 0;
    for ((e, (slots, j)), place) in edges().zip(hessian.iter_mut()) {
        let (a, other) = ends(e, slots);
        let edge = Edge::new::<F, L>(&state, forces, *j as usize, a, other);
        let h = edge.hessian(scaling);
        clamped += u32::from(edge.replaced());
        *place = h.pack();
        let pull = if edge.slack { T::ZERO } else { -edge.spring.tension(edge.stretched.length) };
        let f = vec3::scale(pull, edge.stretched.direction);
        let [row, other_row] = slots.map(|slot| slot as usize);
        if e < pairs.len() {
            selection::scatter(row, other_row, f, b);
            charge(mu, row, T::TWO, &h);
            charge(mu, other_row, T::TWO, &h);
        } else {
            if let Some(b) = b.get_mut(row) {
                *b = vec3::add(*b, f);
            }
            charge(mu, row, T::ONE, &h);
        }
    }
    let mut points = 0;
    if F::ANCHORS {
        clamped += forces.linearize(rows, scaling);
        forces.hessians(rows, &mut |row, h| {
            charge(mu, row, T::ONE, &h);
            points += 1;
        });
    }

    // Projection, only where the certificate fails.
    let certified = certify(inertia, mu);
    if !certified {
        for ((e, (slots, j)), place) in edges().zip(hessian.iter_mut()) {
            let [row, other_row] = slots.map(|slot| slot as usize);
            let met = fails(mu, row) || (e < pairs.len() && fails(mu, other_row));
            // Not `>= 0`: a NaN is to be replaced as well.
            if met && !(place[0] >= T::ZERO) {
                let (a, other) = ends(e, slots);
                let edge = Edge::new::<F, L>(&state, forces, *j as usize, a, other);
                *place = Hessian::clamped(edge.spring, edge.stretched, edge.damping, scaling).pack();
                clamped += 1;
            }
        }
        if F::ANCHORS {
            clamped += forces.clamp(rows, scaling, |row| fails(mu, row));
        }
        for mu in mu.iter_mut() {
            *mu = T::ZERO;
        }
        for ((e, slots), h) in pairs.iter().chain(anchors.iter()).enumerate().zip(hessian.iter()) {
            let h = Hessian::unpack(*h);
            let [row, other_row] = slots.map(|slot| slot as usize);
            if e < pairs.len() {
                charge(mu, row, T::TWO, &h);
                charge(mu, other_row, T::TWO, &h);
            } else {
                charge(mu, row, T::ONE, &h);
            }
        }
        if F::ANCHORS {
            forces.hessians(rows, &mut |row, h| charge(mu, row, T::ONE, &h));
        }
        certify(inertia, mu);
    }

    // b = h f − θh D q̇ − Σ E_jᵀ H_j (Δq̇)_j
    for (b, i) in b.iter_mut().zip(rows.particles()) {
        *b = vec3::scale(h, *b);
        if F::DRAGS
            && let (Some(m), Some(v)) = (state.mass.get(i), state.velocity.get(i))
        {
            *b = vec3::add_scaled(*b, -(scaling.damping * forces.drag(i, *m)), *v);
        }
    }
    let velocity = |i: usize| state.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
    for ((e, slots), h) in pairs.iter().chain(anchors.iter()).enumerate().zip(hessian.iter()) {
        let h = Hessian::unpack(*h);
        let [row, other_row] = slots.map(|slot| slot as usize);
        let v = velocity(particle(rows.particle, row));
        if e < pairs.len() {
            let product = h.mul(vec3::sub(v, velocity(particle(rows.particle, other_row))));
            selection::scatter(other_row, row, product, b);
        } else {
            let pin = other_row.checked_sub(*free).and_then(|slot| pin_velocity.get(slot));
            let product = h.mul(vec3::sub(v, pin.copied().unwrap_or([T::ZERO; 3])));
            if let Some(b) = b.get_mut(row) {
                *b = vec3::sub(*b, product);
            }
        }
    }
    if F::ANCHORS {
        forces.hessians(rows, &mut |row, h| {
            let v = velocity(particle(rows.particle, row));
            if let Some(b) = b.get_mut(row) {
                *b = vec3::sub(*b, h.mul(v));
            }
        });
    }
    Assembled { clamped, certified, free: anchors.is_empty() && points == 0 }
}

/// The operator over what `assemble` left in an island's lists.
pub(crate) fn system<'a, T: Real, F: Force<T>>(
    rows: Rows<'a, T>,
    pairs: &'a [[u32; 2]],
    anchors: &'a [[u32; 2]],
    inertia: &'a [T],
    hessian: &'a [[T; 4]],
    forces: &'a F,
) -> System<'a, T, F> {
    let (pair_hessians, anchor_hessians) = hessian.split_at_checked(pairs.len()).unwrap_or((hessian, &[]));
    System { inertia, pairs, pair_hessians, anchors, anchor_hessians, forces, rows }
}
