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
//! Source: the mass-spring lecture (assembly, linearly-implicit integration); Baraff & Witkin 1998, §3.

use crate::certificate::{certify, charge, fails};
use crate::error::StepError;
use crate::force::Force;
use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::network::State;
use crate::parts::{Edge, IslandParts, Other, Parts};
use crate::real::Real;
use crate::selection::{self, Ends};
use crate::spring::{Spring, Stretched};
use crate::vec3::{self, Vec3};

/// What assembling found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Assembled {
    /// Springs clamped or replaced.
    pub(crate) clamped: u32,
    /// Every node certified, and nothing replaced.
    pub(crate) certified: bool,
    /// Some point spring holds this island.
    pub(crate) points: bool,
    /// Nothing holds this island: no pin, no point spring.
    pub(crate) free: bool,
}

/// M + θhD and the forces that are not the springs', for all islands at once: each force is asked once a step, however
/// many islands there are. Rows that a point spring holds are marked in y.
pub(crate) fn prepare<T: Real, F: Force<T>, L>(parts: &mut Parts<'_, T, L>, forces: &F, scaling: Scaling<T>) {
    let (rows, work) = parts.all_rows();
    let lists = work.b.iter_mut().zip(work.inertia.iter_mut()).zip(work.mu.iter_mut()).zip(work.y.iter_mut());
    for ((((b, inertia), mu), y), i) in lists.zip(rows.particles()) {
        let mass = rows.state.mass.get(i).copied().unwrap_or(T::ONE);
        *inertia = if F::DRAGS { mass + scaling.damping * forces.drag(i, mass) } else { mass };
        *b = [T::ZERO; 3];
        *y = [T::ZERO; 3];
        *mu = T::ZERO;
    }
    forces.add(&rows, work.b);
    if F::ANCHORS {
        forces.hessians(&rows, &mut |row, _| {
            if let Some(mark) = work.y.get_mut(row) {
                *mark = [T::ONE; 3];
            }
        });
    }
}

/// Assembles A, μ and b of an island for a method with matrix M + θhD − sK, after [`prepare`].
#[inline(never)] // As the passes below: frames of their own keep the stack shallow.
pub(crate) fn assemble<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    forces: &mut F,
    h: T,
    scaling: Scaling<T>,
) -> Result<Assembled, StepError> {
    let points = F::ANCHORS && island.work.y.iter().any(|mark| mark[0] != T::ZERO);
    let replaced = linearize::<T, F, L>(island, forces, scaling, points);
    let certified = certify(island.work.inertia, island.work.mu);
    let clamped = if certified { 0 } else { project::<T, F, L>(island, forces, scaling, points)? };
    right_side(island, forces, h, scaling, points);
    let free = island.anchors.is_empty() && !points;
    Ok(Assembled { clamped: replaced + clamped, certified: certified && replaced == 0, points, free })
}

/// A spring of an island at the present state.
struct Loaded<T> {
    spring: Spring<T>,
    stretched: Stretched<T>,
    damping: T,
    slack: bool,
}

impl<T: Real> Loaded<T> {
    #[inline(always)]
    fn new<F: Force<T>, L: Law>(state: &State<'_, T>, forces: &F, edge: &Edge) -> Self {
        let spring = state.spring(edge.spring);
        let stretched = Stretched::new(selection::difference(edge.a, edge.b, state.position));
        let damping = if F::DAMPS { forces.damping(edge.spring) } else { T::ZERO };
        let marked = state.ends.get(edge.spring).is_some_and(|pair| Ends::unpack(*pair).cable);
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

    /// The force on end A.
    #[inline(always)]
    fn force(&self) -> Vec3<T> {
        let pull = if self.slack { T::ZERO } else { -self.spring.tension(self.stretched.length) };
        vec3::scale(pull, self.stretched.direction)
    }

    /// Is H a replacement because the length is 0 and the rest length is not?
    #[inline(always)]
    fn replaced(&self) -> bool {
        !self.slack && self.stretched.length == T::ZERO && self.spring.rest_length > T::ZERO
    }
}

/// The springs' forces into b, Hessians, and what compressed springs charge μ with. Answers how many Hessians are
/// replacements.
#[inline(never)]
fn linearize<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    forces: &mut F,
    scaling: Scaling<T>,
    points: bool,
) -> u32 {
    let edges = island.edges();
    let IslandParts { rows, work, .. } = island;
    let mut replaced = 0;
    for (edge, place) in edges.zip(work.hessian.iter_mut()) {
        let loaded = Loaded::new::<F, L>(&rows.state, forces, &edge);
        let h = loaded.hessian(scaling);
        *place = h.pack();
        replaced += u32::from(loaded.replaced());
        scatter(&edge, loaded.force(), work.b);
        charge_ends(&edge, &h, work.mu);
    }
    if F::ANCHORS && points {
        replaced += forces.linearize(rows, scaling);
        forces.hessians(rows, &mut |row, h| charge(work.mu, row, T::ONE, &h));
    }
    replaced
}

/// Clamps the compressed springs that meet a node without certificate, and computes μ anew. Answers how many. What
/// fails then is no spring's doing: a force of the caller's own with a negative drag or Hessian.
#[cold]
#[inline(never)]
fn project<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    forces: &mut F,
    scaling: Scaling<T>,
    points: bool,
) -> Result<u32, StepError> {
    let edges = island.edges();
    let IslandParts { rows, work, .. } = island;
    let mut clamped = 0;
    for (edge, place) in edges.clone().zip(work.hessian.iter_mut()) {
        let met = fails(work.mu, edge.row) || matches!(edge.other, Other::Row(row) if fails(work.mu, row));
        if met && !(place[0] >= T::ZERO) {
            let loaded = Loaded::new::<F, L>(&rows.state, forces, &edge);
            *place = Hessian::clamped(loaded.spring, loaded.stretched, loaded.damping, scaling).pack();
            clamped += 1;
        }
    }
    if F::ANCHORS && points {
        clamped += forces.clamp(rows, scaling, |row| fails(work.mu, row));
    }
    for mu in work.mu.iter_mut() {
        *mu = T::ZERO;
    }
    for (edge, h) in edges.zip(work.hessian.iter()) {
        charge_ends(&edge, &Hessian::unpack(*h), work.mu);
    }
    if F::ANCHORS && points {
        forces.hessians(rows, &mut |row, h| charge(work.mu, row, T::ONE, &h));
    }
    if certify(work.inertia, work.mu) {
        return Ok(clamped);
    }
    let failing = rows.particles().enumerate().find(|(row, _)| fails(work.mu, *row));
    Err(StepError::NotCertified(failing.map_or(0, |(_, i)| i)))
}

/// b = h f − θh D q̇ − Σ E_jᵀ H_j (Δq̇)_j, f being in b.
#[inline(never)]
fn right_side<T: Real, F: Force<T>>(
    island: &mut IslandParts<'_, T>,
    forces: &F,
    h: T,
    scaling: Scaling<T>,
    points: bool,
) {
    let edges = island.edges();
    let IslandParts { rows, work, pin_velocity, free, .. } = island;
    let velocity = |i: usize| rows.state.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
    for (b, i) in work.b.iter_mut().zip(rows.particles()) {
        *b = vec3::scale(h, *b);
        if F::DRAGS {
            let mass = rows.state.mass.get(i).copied().unwrap_or(T::ONE);
            *b = vec3::add_scaled(*b, -(scaling.damping * forces.drag(i, mass)), velocity(i));
        }
    }
    for (edge, hessian) in edges.zip(work.hessian.iter()) {
        let other = match edge.other {
            Other::Row(_) => velocity(edge.b),
            Other::Pin(slot) => {
                let pin = slot.checked_sub(*free).and_then(|pin| pin_velocity.get(pin));
                pin.copied().unwrap_or([T::ZERO; 3])
            }
        };
        let product = Hessian::unpack(*hessian).mul(vec3::sub(velocity(edge.a), other));
        scatter(&edge, vec3::scale(-T::ONE, product), work.b);
    }
    if F::ANCHORS && points {
        forces.hessians(rows, &mut |row, hessian| {
            let v = rows.particle.get(row).map_or([T::ZERO; 3], |i| velocity(*i as usize));
            if let Some(b) = work.b.get_mut(row) {
                *b = vec3::sub(*b, hessian.mul(v));
            }
        });
    }
}

/// E_jᵀ on the free rows: f at the first end, −f at the other if it is free.
#[inline(always)]
fn scatter<T: Real>(edge: &Edge, f: Vec3<T>, b: &mut [Vec3<T>]) {
    if let Some(row) = b.get_mut(edge.row) {
        *row = vec3::add(*row, f);
    }
    if let Other::Row(other) = edge.other
        && let Some(row) = b.get_mut(other)
    {
        *row = vec3::sub(*row, f);
    }
}

/// c_e = 2 at both ends of a spring between free particles, 1 where the other end is pinned.
#[inline(always)]
fn charge_ends<T: Real>(edge: &Edge, h: &Hessian<T>, mu: &mut [T]) {
    match edge.other {
        Other::Row(other) => {
            charge(mu, edge.row, T::TWO, h);
            charge(mu, other, T::TWO, h);
        }
        Other::Pin(_) => charge(mu, edge.row, T::ONE, h),
    }
}
