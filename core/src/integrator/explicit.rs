//! The way of explicit methods through a step: a state beside the scene's own, and forces at it.

use crate::error::StepError;
use crate::force::{Force, Rows};
use crate::islands::{Island, Islands};
use crate::memory::{Memory, part};
use crate::network::{Network, State};
use crate::parts::Parts;
use crate::pins::Course;
use crate::real::{Real, larger};
use crate::report::Report;
use crate::selection::MARK;
use crate::vec3::{self, Vec3};

use super::stage;

/// Visits the springs of all islands: (row, other end, spring), both ends as slots.
#[inline(always)]
pub(crate) fn each_spring<M: Memory>(islands: &Islands<M>, mut visit: impl FnMut(usize, usize, usize)) {
    for words in islands.islands() {
        let island = Island::unpack(*words);
        let own = part(&islands.own, island.slots());
        let mut springs =
            part(&islands.other, island.springs()).iter().zip(part(&islands.spring, island.springs()));
        for (row, own) in own.iter().enumerate() {
            for (other, j) in springs.by_ref().take(*own as usize) {
                visit(island.first + row, island.first + *other as usize, *j as usize);
            }
        }
    }
}

/// f of all springs added to b, by slot: their elastic part, at the state's positions.
#[inline(never)]
fn elastic<M: Memory<Real = T>, T: Real>(islands: &Islands<M>, state: &State<'_, T>, b: &mut [Vec3<T>]) {
    walk(islands, b, |j, [near, far]| stage::force::<T, (), M::Law>(state, &(), j, [near, far]));
}

/// The springs' damping added to b: −c(u·Δq̇)u.
#[inline(never)]
fn damping<M: Memory<Real = T>, T: Real, F: Force<T>>(
    islands: &Islands<M>,
    state: &State<'_, T>,
    forces: &F,
    b: &mut [Vec3<T>],
) {
    walk(islands, b, |j, ends| stage::damped::<T, F, M::Law>(state, forces, j, ends));
}

/// Adds what `force` says of each spring to its two ends.
#[inline(always)]
fn walk<M: Memory<Real = T>, T: Real>(
    islands: &Islands<M>,
    b: &mut [Vec3<T>],
    force: impl Fn(usize, [usize; 2]) -> Vec3<T>,
) {
    let place = |slot: usize| islands.particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let free = islands.free;
    each_spring(islands, |row, other, j| {
        let f = force(j, [place(row), place(other)]);
        if let Some(b) = b.get_mut(row) {
            *b = vec3::add(*b, f);
        }
        if other < free
            && let Some(b) = b.get_mut(other)
        {
            *b = vec3::sub(*b, f);
        }
    });
}

/// A scene on its way through an explicit step: q and q̇ beside the scene's own, in its numbering, and forces by slot.
pub(crate) struct Explicit<'a, M: Memory> {
    network: &'a mut Network<M>,
    islands: &'a Islands<M>,
    position: &'a mut [Vec3<M::Real>],
    velocity: &'a mut [Vec3<M::Real>],
    force: &'a mut [Vec3<M::Real>],
    /// Scratch, by slot
    start: &'a mut [Vec3<M::Real>],
    /// The forces where the step began, by slot
    before: &'a mut [Vec3<M::Real>],
}

impl<'a, M: Memory<Real = T>, T: Real> Explicit<'a, M> {
    /// Where the scene is.
    pub(crate) fn new(parts: Parts<'a, M>) -> Self {
        let this = Self::resume(parts);
        let pairs =
            [(&mut *this.position, &*this.network.position), (&mut *this.velocity, &this.network.velocity)];
        for (to, from) in pairs {
            for (to, from) in to.iter_mut().zip(from) {
                *to = vec3::add([T::ZERO; 3], *from);
            }
        }
        for (i, slot) in this.network.slot.iter().enumerate() {
            if slot & MARK != 0
                && let Some(v) = this.velocity.get_mut(i)
            {
                *v = [T::ZERO; 3];
            }
        }
        this
    }

    /// Where a step left off that was not taken yet.
    pub(crate) fn resume(parts: Parts<'a, M>) -> Self {
        let Parts { network, islands, work } = parts;
        Self {
            network,
            islands,
            position: &mut work.r,
            velocity: &mut work.p,
            force: &mut work.b,
            start: &mut work.y,
            before: &mut work.x,
        }
    }

    /// Moving pins where and as fast as they are after the part `s` of a step of `dt`.
    pub(crate) fn pins(&mut self, course: Course<'_, T>, s: T, dt: T) {
        for m in course.motion {
            let (Some(b), Some(rate)) =
                (self.network.position.get(m.particle), self.network.velocity.get(m.particle))
            else {
                continue;
            };
            let [q, v] = course.at(m, s, dt, *b, *rate);
            if let (Some(to), Some(to_v)) =
                (self.position.get_mut(m.particle), self.velocity.get_mut(m.particle))
            {
                (*to, *to_v) = (q, v);
            }
        }
    }

    /// f into the forces: the springs' own and what the others add; with `damped` also drag and the springs' damping.
    pub(crate) fn forces<F: Force<T>>(&mut self, forces: &F, damped: bool) {
        let Self { network, islands, position, velocity, force, .. } = self;
        let state = State { position, velocity, ..network.state() };
        force.fill([T::ZERO; 3]);
        let rows = islands.all_rows(&state);
        forces.add(&rows, force);
        elastic(islands, &state, force);
        if damped {
            resist(islands, &rows, forces, force);
        }
    }

    /// Drag and the springs' damping alone into the forces.
    fn damp<F: Force<T>>(&mut self, forces: &F) {
        let Self { network, islands, position, velocity, force, .. } = self;
        let state = State { position, velocity, ..network.state() };
        force.fill([T::ZERO; 3]);
        resist(islands, &islands.all_rows(&state), forces, force);
    }

    /// Remembers the forces.
    pub(crate) fn keep_forces(&mut self) {
        for (kept, f) in self.before.iter_mut().zip(self.force.iter()).take(self.islands.free) {
            *kept = vec3::add([T::ZERO; 3], *f);
        }
    }

    /// ½ Σ mᵢ|h(aᵢ − a)/6|², a the acceleration that is remembered, and the farthest of these, as |·|².
    pub(crate) fn change(&self, h: T) -> (T, T) {
        let share = h / T::from_count(6);
        let (mut energy, mut most) = (T::ZERO, T::ZERO);
        let forces = self.force.iter().zip(self.before.iter()).zip(self.islands.particle.iter());
        for ((f, before), i) in forces.take(self.islands.free) {
            let m = self.network.mass.get(*i as usize).copied().unwrap_or(T::ONE);
            let change = vec3::scale(share / m, vec3::sub(*f, *before));
            let square = vec3::dot(change, change);
            energy += T::HALF * m * square;
            most = larger(most, square);
        }
        (energy, most)
    }

    /// q̇ += t·M⁻¹f
    pub(crate) fn kick(&mut self, t: T) {
        for (i, f) in self.islands.particle.iter().zip(self.force.iter()).take(self.islands.free) {
            let i = *i as usize;
            if let (Some(v), Some(m)) = (self.velocity.get_mut(i), self.network.mass.get(i)) {
                *v = vec3::add_scaled(*v, t / *m, *f);
            }
        }
    }

    /// q += t·q̇
    pub(crate) fn drift(&mut self, t: T) {
        for i in self.islands.particle.iter().take(self.islands.free) {
            let i = *i as usize;
            if let (Some(q), Some(v)) = (self.position.get_mut(i), self.velocity.get(i)) {
                *q = vec3::add_scaled(*q, t, *v);
            }
        }
    }

    /// q̇ over the time t of damping alone, to second order: q̇ ← q̇ + tE(q̇ + ½tEq̇), E = −M⁻¹D. Answers ½‖½t²E²q̇‖²_M, its
    /// difference to first order.
    pub(crate) fn fade<F: Force<T>>(&mut self, forces: &F, t: T) -> T {
        for (start, i) in self.start.iter_mut().zip(self.islands.particle.iter()).take(self.islands.free) {
            *start = self.velocity.get(*i as usize).copied().unwrap_or([T::ZERO; 3]);
        }
        self.damp(forces);
        self.kick(T::HALF * t);
        self.damp(forces);
        for (start, i) in self.start.iter_mut().zip(self.islands.particle.iter()).take(self.islands.free) {
            if let Some(v) = self.velocity.get_mut(*i as usize) {
                // What half a kick has made of it: half of the first order's.
                let half = vec3::sub(*v, *start);
                *v = vec3::add([T::ZERO; 3], *start);
                *start = half;
            }
        }
        self.kick(t);
        let mut energy = T::ZERO;
        for ((half, f), i) in
            self.start.iter().zip(self.force.iter()).zip(self.islands.particle.iter()).take(self.islands.free)
        {
            let m = self.network.mass.get(*i as usize).copied().unwrap_or(T::ONE);
            let change = vec3::add_scaled(vec3::scale(t / m, *f), -T::TWO, *half);
            energy += T::HALF * m * vec3::dot(change, change);
        }
        energy
    }

    /// Takes the state, pins where a step of `dt` leaves them: what is not finite is refused, and then the scene is as it was.
    pub(crate) fn commit(self, course: Course<'_, T>, dt: T) -> Result<(), StepError> {
        let Self { network, islands, position, velocity, .. } = self;
        for m in course.motion {
            let i = m.particle;
            if let (Some(b), Some(rate), Some(q), Some(v)) =
                (network.position.get(i), network.velocity.get(i), position.get_mut(i), velocity.get_mut(i))
            {
                [*q, *v] = course.end(m, dt, *b, *rate);
                if !(vec3::is_finite(*q) && vec3::is_finite(*v)) {
                    return Err(StepError::Motion(i));
                }
            }
        }
        for i in islands.particle.iter().take(islands.free) {
            let i = *i as usize;
            let finite = |list: &[Vec3<T>]| list.get(i).is_some_and(|x| vec3::is_finite(*x));
            if !finite(position) || !finite(velocity) {
                return Err(StepError::NotFinite(i));
            }
        }
        for (slot, i) in islands.particle.iter().enumerate() {
            let i = *i as usize;
            let (Some(q), Some(v)) = (network.position.get_mut(i), network.velocity.get_mut(i)) else {
                continue;
            };
            if slot < islands.free {
                if let (Some(next), Some(rate)) = (position.get(i), velocity.get(i)) {
                    (*q, *v) = (*next, *rate);
                }
            } else {
                *v = [T::ZERO; 3];
            }
        }
        for i in course.motion.iter().map(|m| m.particle) {
            if let (Some(q), Some(v), Some(end), Some(rate)) =
                (network.position.get_mut(i), network.velocity.get_mut(i), position.get(i), velocity.get(i))
            {
                (*q, *v) = (*end, *rate);
            }
        }
        Ok(())
    }

    /// A report of islands that needed no solve.
    pub(crate) fn report(&self) -> Report<T> {
        let mut report = Report::new(self.network.ends.len() - self.islands.edges);
        report.islands = self.islands.count as u32;
        report.certified = report.islands;
        report
    }
}

/// Drag and the springs' damping added to f.
fn resist<M: Memory<Real = T>, T: Real, F: Force<T>>(
    islands: &Islands<M>,
    rows: &Rows<'_, T>,
    forces: &F,
    f: &mut [Vec3<T>],
) {
    if F::DRAGS {
        for (f, i) in f.iter_mut().zip(rows.particles()) {
            if let (Some(m), Some(v)) = (rows.state.mass.get(i), rows.state.velocity.get(i)) {
                *f = vec3::add_scaled(*f, -forces.drag(i, *m), *v);
            }
        }
    }
    if F::DAMPS {
        damping(islands, rows.state, forces, f);
    }
}
