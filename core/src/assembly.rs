//! Assembly of one island's step: Σ E_jᵀ f_j, the compressed Hessians, the certificate, and the right side.
//!
//! The step solves for the change of velocity Δ from zero. With q̇ on free rows and the pins' velocity over the step on
//! the others, A q̇⁺ = Mq̇ + h f on the free rows becomes
//!
//! A Δ = b,  b = h f − θh D q̇ − Σ_j E_jᵀ H_j (Δq̇)_j,
//!
//! H_j scaled and clamped as in A ("K̃ on both sides": the equation that is solved is the lecture's with K̃ for K). What
//! other methods take from H instead is their [`Side`]. One root for l and one for w per spring, one pass over the springs;
//! where a node is not certified the springs that meet it are looked at again, and b takes the change of their H. A spring that
//! alone takes a node's certificate away, c|α| ≥ m̃, is in b as it will be, clamped: |α| grows like 1/l, and b would lose all else.
//!
//! Source: the mass-spring lecture (assembly, linearly-implicit integration); Baraff & Witkin 1998, §3.

use crate::certificate::{certify, charge, fails};
use crate::error::StepError;
use crate::force::{Force, Rows};
use crate::hessian::{Hessian, Scaling};
use crate::law::Law;
use crate::memory::Memory;
use crate::parts::IslandParts;
use crate::real::Real;
use crate::scene::WorkLists;
use crate::selection::Ends;
use crate::spring::{Spring, Stretched};
use crate::vec3::{self, Vec3};

/// What of the Hessians goes to the right side of a method's system, b = h f − hD q̇ − this.
pub(crate) trait Side<T: Real> {
    /// Does b hold the H that A has, clamped with it, or the true one?
    const CLAMPED: bool;
    /// Is [`Side::turning`] anything but 0?
    const TURNS: bool = false;
    /// Of one spring, from H and Δq̇.
    fn of(&self, hessian: &Hessian<T>, speed: Vec3<T>) -> Vec3<T>;
    /// What the damping force −c(u·Δq̇)u of a spring changes by because the spring turns, times −θh².
    #[inline(always)]
    fn turning(&self, damping: T, stretched: Stretched<T>, speed: Vec3<T>) -> Vec3<T> {
        let _ = (damping, stretched, speed);
        [T::ZERO; 3]
    }
}

/// H Δq̇ with A's H: the lecture's method, and a stage of a Rosenbrock method.
pub(crate) struct Same;

impl<T: Real> Side<T> for Same {
    const CLAMPED: bool = true;
    #[inline(always)]
    fn of(&self, hessian: &Hessian<T>, speed: Vec3<T>) -> Vec3<T> {
        hessian.mul(speed)
    }
}

/// Nothing: b is the force alone, for a method whose unknown is no change along H.
pub(crate) struct Nothing;

impl<T: Real> Side<T> for Nothing {
    const CLAMPED: bool = false;
    #[inline(always)]
    fn of(&self, _: &Hessian<T>, _: Vec3<T>) -> Vec3<T> {
        [T::ZERO; 3]
    }
}

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

/// M + θhD, and b and y without springs, for all islands at once: b = h f − hD q̇ with the forces that are not the
/// springs'. Each force is asked once a step, however many islands there are. Rows that a point spring holds are marked
/// in y.
#[inline(never)] // As the passes below: frames of their own keep the stack shallow.
pub(crate) fn prepare<M: Memory<Real = T>, T: Real, F: Force<T>>(
    rows: &Rows<'_, T>,
    work: &mut WorkLists<M>,
    forces: &F,
    h: T,
    scaling: Scaling<T>,
) {
    prepare_rows(rows, [&mut work.b, &mut work.y], [&mut work.inertia, &mut work.mu], forces, h, scaling);
}

/// The same for one island.
#[inline(never)]
pub(crate) fn prepare_island<T: Real, F: Force<T>>(
    island: &mut IslandParts<'_, T>,
    forces: &F,
    h: T,
    scaling: Scaling<T>,
) {
    let IslandParts { matrix, vectors, .. } = island;
    prepare_rows(&matrix.rows, [vectors.b, vectors.y], [matrix.inertia, vectors.mu], forces, h, scaling);
}

#[inline(always)]
fn prepare_rows<T: Real, F: Force<T>>(
    rows: &Rows<'_, T>,
    [b, y]: [&mut [Vec3<T>]; 2],
    [inertia, mu]: [&mut [T]; 2],
    forces: &F,
    h: T,
    scaling: Scaling<T>,
) {
    let mass = |i: usize| rows.state.mass.get(i).copied().unwrap_or(T::ONE);
    let lists = b.iter_mut().zip(inertia.iter_mut()).zip(mu.iter_mut()).zip(y.iter_mut());
    for ((((b, inertia), mu), y), i) in lists.zip(rows.particles()) {
        *inertia = if F::DRAGS { mass(i) + scaling.damping * forces.drag(i, mass(i)) } else { mass(i) };
        *b = [T::ZERO; 3];
        *y = [T::ZERO; 3];
        *mu = T::ZERO;
    }
    forces.add(rows, b);
    for (b, i) in b.iter_mut().zip(rows.particles()) {
        *b = vec3::scale(h, *b);
        if F::DRAGS {
            let v = rows.state.velocity.get(i).copied().unwrap_or([T::ZERO; 3]);
            *b = vec3::add_scaled(*b, -(h * forces.drag(i, mass(i))), v);
        }
    }
    if F::ANCHORS {
        forces.hessians(rows, &mut |row, _| {
            if let Some(mark) = y.get_mut(row) {
                *mark = [T::ONE; 3];
            }
        });
    }
}

/// Assembles A, μ and b of an island for a method with matrix M + θhD − sK, after [`prepare`].
#[inline(never)]
pub(crate) fn assemble<T: Real, F: Force<T>, L: Law, S: Side<T>>(
    island: &mut IslandParts<'_, T>,
    forces: &mut F,
    h: T,
    scaling: Scaling<T>,
    side: &S,
) -> Result<Assembled, StepError> {
    let points = F::ANCHORS && island.vectors.y.iter().any(|mark| mark[0] != T::ZERO);
    let mut replaced = linearize::<T, F, L, S>(island, forces, h, scaling, side);
    if F::ANCHORS && points {
        replaced += forces.linearize(&island.matrix.rows, scaling);
        if !S::CLAMPED {
            subtract_points(island, forces, side);
        }
        charge_points(island, forces);
    }
    let certified = certify(island.matrix.inertia, island.vectors.mu);
    let clamped = if certified { 0 } else { project(island, forces, scaling, points, side)? };
    if F::ANCHORS && points && S::CLAMPED {
        subtract_points(island, forces, side);
    }
    let free = island.anchors == 0 && !points;
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
    fn new<F: Force<T>, L: Law>(rows: &Rows<'_, T>, forces: &F, j: usize, delta: Vec3<T>) -> Self {
        let spring = rows.state.spring(j);
        let stretched = Stretched::new(delta);
        let damping = if F::DAMPS { forces.damping(j) } else { T::ZERO };
        let marked = rows.state.ends.get(j).is_some_and(|pair| Ends::unpack(*pair).cable);
        let slack = L::slackens(marked) && stretched.length < spring.rest_length;
        Self { spring, stretched, damping, slack }
    }

    #[inline(always)]
    fn hessian(&self, scaling: Scaling<T>) -> Hessian<T> {
        if self.slack {
            return Hessian { alpha: T::ZERO, w: [T::ZERO; 3] };
        }
        Hessian::new(self.spring, self.stretched, self.damping, scaling)
    }

    #[inline(always)]
    fn clamped(&self, scaling: Scaling<T>) -> Hessian<T> {
        Hessian::clamped(self.spring, self.stretched, self.damping, scaling)
    }

    /// The force on the end that x_A of its Δx belongs to.
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

/// The springs: their Hessians, what compressed ones charge μ with, and h f − H Δq̇ into b. Answers how many Hessians are
/// replacements.
#[inline(never)]
fn linearize<T: Real, F: Force<T>, L: Law, S: Side<T>>(
    island: &mut IslandParts<'_, T>,
    forces: &F,
    h: T,
    scaling: Scaling<T>,
    side: &S,
) -> u32 {
    let mut replaced = 0;
    let (own, other, spring) = (island.matrix.own, island.matrix.other, island.spring);
    let mut edges = other.iter().zip(spring).enumerate();
    for (row, own) in own.iter().enumerate() {
        let near = island.end(row);
        // The row's own sum stays in registers; b takes it at the end, after what rows above have left there.
        let mut b = island.vectors.b.get(row).copied().unwrap_or([T::ZERO; 3]);
        for (edge, (other, j)) in edges.by_ref().take(*own as usize) {
            let other = *other as usize;
            let far = island.end(other);
            let delta = vec3::sub(near.position, far.position);
            let loaded = Loaded::new::<F, L>(&island.matrix.rows, forces, *j as usize, delta);
            let hessian = loaded.hessian(scaling);
            replaced += u32::from(loaded.replaced());
            let speed = vec3::sub(near.velocity, far.velocity);
            let surely = S::CLAMPED && surely_clamped(&hessian, row, other, island.matrix.inertia);
            let in_b = if surely { loaded.clamped(scaling) } else { hessian };
            let mut sum = vec3::sub(vec3::scale(h, loaded.force()), side.of(&in_b, speed));
            if S::TURNS && F::DAMPS && !loaded.slack {
                sum = vec3::add(sum, side.turning(loaded.damping, loaded.stretched, speed));
            }
            if let Some(place) = island.matrix.hessian.get_mut(edge) {
                *place = hessian.pack();
            }
            b = vec3::add(b, sum);
            if let Some(other) = island.vectors.b.get_mut(other) {
                *other = vec3::sub(*other, sum);
            }
            charge_ends(row, other, &hessian, island.vectors.mu);
        }
        if let Some(row) = island.vectors.b.get_mut(row) {
            *row = b;
        }
    }
    replaced
}

/// Does this spring alone take an end's certificate away? Then [`project`] will clamp it: its charge alone is no less than m̃.
#[inline(always)]
fn surely_clamped<T: Real>(h: &Hessian<T>, row: usize, other: usize, inertia: &[T]) -> bool {
    if !(h.alpha < T::ZERO) {
        return false;
    }
    let far = inertia.get(other);
    let charge = if far.is_some() { -T::TWO * h.alpha } else { -h.alpha };
    let takes = |m: Option<&T>| m.is_some_and(|m| charge >= *m);
    takes(inertia.get(row)) || takes(far)
}

/// b −= Σ H q̇ over point springs, as the side takes it.
#[inline(never)]
fn subtract_points<T: Real, F: Force<T>>(island: &mut IslandParts<'_, T>, forces: &F, side: &impl Side<T>) {
    let rows = island.matrix.rows;
    forces.hessians(&rows, &mut |row, hessian| {
        let v = island.end(row).velocity;
        if let Some(b) = island.vectors.b.get_mut(row) {
            *b = vec3::sub(*b, side.of(&hessian, v));
        }
    });
}

fn charge_points<T: Real, F: Force<T>>(island: &mut IslandParts<'_, T>, forces: &F) {
    let rows = island.matrix.rows;
    forces.hessians(&rows, &mut |row, hessian| charge(island.vectors.mu, row, T::ONE, &hessian));
}

/// Clamps the compressed springs that meet a node without certificate, and computes μ anew. Answers how many. What
/// fails then is no spring's doing: a force of the caller's own with a negative drag or Hessian.
#[cold]
#[inline(never)]
fn project<T: Real, F: Force<T>, S: Side<T>>(
    island: &mut IslandParts<'_, T>,
    forces: &mut F,
    scaling: Scaling<T>,
    points: bool,
    side: &S,
) -> Result<u32, StepError> {
    let mut clamped = 0;
    each_spring(island, |island, row, other, edge| {
        let mu = &island.vectors.mu;
        let met = fails(mu, row) || (other < mu.len() && fails(mu, other));
        let (Some(place), Some(j)) = (island.matrix.hessian.get(edge), island.spring.get(edge)) else {
            return;
        };
        let old = Hessian::unpack(*place);
        if !met || old.alpha >= T::ZERO {
            return;
        }
        let (near, far) = (island.end(row), island.end(other));
        let delta = vec3::sub(near.position, far.position);
        let damping = if F::DAMPS { forces.damping(*j as usize) } else { T::ZERO };
        let spring = island.matrix.rows.state.spring(*j as usize);
        let new = Hessian::clamped(spring, Stretched::new(delta), damping, scaling);
        if S::CLAMPED && !surely_clamped(&old, row, other, island.matrix.inertia) {
            let speed = vec3::sub(near.velocity, far.velocity);
            let change = vec3::sub(side.of(&old, speed), side.of(&new, speed));
            scatter(row, other, change, island.vectors.b);
        }
        if let Some(place) = island.matrix.hessian.get_mut(edge) {
            *place = new.pack();
        }
        clamped += 1;
    });
    if F::ANCHORS && points {
        let mu = &island.vectors.mu;
        clamped += forces.clamp(&island.matrix.rows, scaling, |row| fails(mu, row));
    }
    island.vectors.mu.fill(T::ZERO);
    each_spring(island, |island, row, other, edge| {
        if let Some(hessian) = island.matrix.hessian.get(edge) {
            charge_ends(row, other, &Hessian::unpack(*hessian), island.vectors.mu);
        }
    });
    if F::ANCHORS && points {
        charge_points(island, forces);
    }
    if certify(island.matrix.inertia, island.vectors.mu) {
        return Ok(clamped);
    }
    let failing = island.matrix.rows.particles().enumerate().find(|(row, _)| fails(island.vectors.mu, *row));
    Err(StepError::NotCertified(failing.map_or(0, |(_, i)| i)))
}

/// Visits the springs in their order: (row, other end, place in the lists).
#[inline(always)]
fn each_spring<T: Real>(
    island: &mut IslandParts<'_, T>,
    mut visit: impl FnMut(&mut IslandParts<'_, T>, usize, usize, usize),
) {
    let (own, others) = (island.matrix.own, island.matrix.other);
    let mut others = others.iter().enumerate();
    for (row, own) in own.iter().enumerate() {
        for (edge, other) in others.by_ref().take(*own as usize) {
            visit(island, row, *other as usize, edge);
        }
    }
}

/// E_jᵀ on the free rows: f at the row, −f at the other end if it is free.
#[inline(always)]
fn scatter<T: Real>(row: usize, other: usize, f: Vec3<T>, b: &mut [Vec3<T>]) {
    if let Some(row) = b.get_mut(row) {
        *row = vec3::add(*row, f);
    }
    if let Some(other) = b.get_mut(other) {
        *other = vec3::sub(*other, f);
    }
}

/// c_e = 2 at both ends of a spring between free particles, 1 where the other end is pinned.
#[inline(always)]
fn charge_ends<T: Real>(row: usize, other: usize, h: &Hessian<T>, mu: &mut [T]) {
    if !(h.alpha >= T::ZERO) {
        let both = other < mu.len();
        let c = if both { T::TWO } else { T::ONE };
        charge(mu, row, c, h);
        charge(mu, other, c, h);
    }
}
