//! The later stages of a Rosenbrock method: where the particles are in them, and their right sides.

use super::rosenbrock::Stage;
use crate::force::{Force, Rows};
use crate::hessian::Hessian;
use crate::law::Law;
use crate::network::State;
use crate::parts::IslandParts;
use crate::pins::Course;
use crate::real::Real;
use crate::selection::Ends;
use crate::spring::Stretched;
use crate::vec3::{self, Vec3};

/// A method's memory: positions and velocities of a stage in the scene's numbering, and what stages have found, by slot.
pub(crate) struct Stages<'a, T> {
    particles: usize,
    position: &'a mut [Vec3<T>],
    velocity: &'a mut [Vec3<T>],
    found: &'a mut [Vec3<T>],
}

impl<'a, T: Real> Stages<'a, T> {
    /// `None` if the memory is too small.
    pub(crate) fn cut(memory: &'a mut [Vec3<T>], particles: usize, stages: usize) -> Option<Self> {
        let (position, rest) = memory.split_at_mut_checked(particles)?;
        let (velocity, found) = rest.split_at_mut_checked(particles)?;
        let found = found.get_mut(..particles * (stages - 1))?;
        Some(Self { particles, position, velocity, found })
    }

    /// Everything where it is; pins rest unless a motion moves them, however fast they were.
    pub(crate) fn begin(&mut self, state: &State<'_, T>) {
        for (to, from) in self.position.iter_mut().zip(state.position) {
            *to = vec3::add([T::ZERO; 3], *from);
        }
        for (i, (to, from)) in self.velocity.iter_mut().zip(state.velocity).enumerate() {
            *to = if state.is_pinned(i) { [T::ZERO; 3] } else { vec3::add([T::ZERO; 3], *from) };
        }
    }

    /// Keeps u̇ of a stage.
    pub(crate) fn keep(&mut self, stage: usize, island: &IslandParts<'_, T>) {
        let to = self.found.get_mut(stage * self.particles + island.matrix.rows.first..).unwrap_or_default();
        for (to, x) in to.iter_mut().zip(island.vectors.x.iter()) {
            *to = vec3::add([T::ZERO; 3], *x);
        }
    }

    /// start + Σ of[j]·u̇ⱼ over the stages that are kept.
    #[inline]
    pub(crate) fn sum(&self, of: &[f64], start: Vec3<T>, slot: usize) -> Vec3<T> {
        let mut sum = start;
        let found = self.found.get(slot..).unwrap_or_default().iter().step_by(self.particles.max(1));
        for (share, found) in of.iter().zip(found) {
            sum = vec3::add_scaled(sum, T::from_f64(*share), *found);
        }
        sum
    }

    /// Yᵢ of an island's rows.
    pub(crate) fn place(&mut self, stage: &Stage, island: &IslandParts<'_, T>, h: T) {
        let Rows { first, state, .. } = island.matrix.rows;
        for (row, i) in island.matrix.rows.particles().enumerate() {
            let (Some(q), Some(v)) = (state.position.get(i), state.velocity.get(i)) else { continue };
            let own = vec3::scale(T::from_f64(stage.position.own), *v);
            let rate = self.sum(stage.position.stages, own, first + row);
            let velocity = self.sum(stage.velocity, *v, first + row);
            if let (Some(to), Some(to_v)) = (self.position.get_mut(i), self.velocity.get_mut(i)) {
                (*to, *to_v) = (vec3::add_scaled(*q, h, rate), velocity);
            }
        }
    }

    /// b and ḃ of moving pins at the stage's time, or without one at the end of the step; answers the first that is not finite.
    pub(crate) fn place_pins(
        &mut self,
        stage: Option<&Stage>,
        course: Course<'_, T>,
        state: &State<'_, T>,
        dt: T,
    ) -> Option<usize> {
        let mut infinite = None;
        for m in course.motion {
            let (Some(b), Some(rate)) = (state.position.get(m.particle), state.velocity.get(m.particle))
            else {
                continue;
            };
            let [q, v] = match stage {
                Some(stage) => course.at(m, T::from_f64(stage.time), dt, *b, *rate),
                None => course.end(m, dt, *b, *rate),
            };
            if infinite.is_none() && !(vec3::is_finite(q) && vec3::is_finite(v)) {
                infinite = Some(m.particle);
            }
            if let (Some(to), Some(to_v)) =
                (self.position.get_mut(m.particle), self.velocity.get_mut(m.particle))
            {
                (*to, *to_v) = (q, v);
            }
        }
        infinite
    }

    /// b and ḃ of a pin where they were placed last.
    pub(crate) fn placed(&self, i: usize) -> [Vec3<T>; 2] {
        let at = |list: &[Vec3<T>]| list.get(i).copied().unwrap_or([T::ZERO; 3]);
        [at(self.position), at(self.velocity)]
    }

    /// The scene at this stage.
    fn state<'s>(&'s self, state: &State<'s, T>) -> State<'s, T> {
        State { position: self.position, velocity: self.velocity, ..*state }
    }
}

/// b = h′f(Yᵢ) + MΣ γcᵢⱼu̇ⱼ + h′²K̃wᵢ of an island; y is left with w. A is the one that was assembled.
#[inline(never)]
pub(crate) fn right_side<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    stages: &Stages<'_, T>,
    stage: &Stage,
    forces: &F,
    h: T,
    points: bool,
) {
    let Rows { first, particle, state: before } = island.matrix.rows;
    let state = stages.state(before);
    let rows = Rows { first, particle, state: &state };
    let vectors = &mut island.vectors;
    for b in vectors.b.iter_mut() {
        *b = [T::ZERO; 3];
    }
    forces.add(&rows, vectors.b);
    for (row, (b, y)) in vectors.b.iter_mut().zip(vectors.y.iter_mut()).enumerate() {
        let Some(i) = particle.get(row).map(|i| *i as usize) else { continue };
        let (Some(m), Some(v), Some(at_start)) =
            (state.mass.get(i), state.velocity.get(i), before.velocity.get(i))
        else {
            continue;
        };
        *b = vec3::scale(h, *b);
        if F::DRAGS {
            *b = vec3::add_scaled(*b, -(h * forces.drag(i, *m)), *v);
        }
        *b = vec3::add_scaled(*b, *m, stages.sum(stage.mass, [T::ZERO; 3], first + row));
        let own = vec3::scale(T::from_f64(stage.rate.own), *at_start);
        *y = stages.sum(stage.rate.stages, own, first + row);
    }
    springs::<T, F, L>(island, &state, stage, forces, h);
    if F::ANCHORS && points {
        let IslandParts { matrix, vectors, .. } = island;
        forces.hessians(&matrix.rows, &mut |row, hessian| {
            if let (Some(b), Some(w)) = (vectors.b.get_mut(row), vectors.y.get(row)) {
                *b = vec3::sub(*b, hessian.mul(*w));
            }
        });
    }
}

/// The springs' part of it.
#[inline(never)]
fn springs<T: Real, F: Force<T>, L: Law>(
    island: &mut IslandParts<'_, T>,
    state: &State<'_, T>,
    stage: &Stage,
    forces: &F,
    h: T,
) {
    let turn = T::from_f64(stage.turn);
    let IslandParts { matrix, vectors, particle, spring, pin_velocity, first_pin, .. } = island;
    let place = |slot: usize| particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let mut edges = matrix.other.iter().zip(spring.iter()).zip(matrix.hessian.iter());
    for (row, own) in matrix.own.iter().enumerate() {
        let near = place(row);
        let mut sum = vectors.b.get(row).copied().unwrap_or([T::ZERO; 3]);
        let w = vectors.y.get(row).copied().unwrap_or([T::ZERO; 3]);
        for ((other, j), h0) in edges.by_ref().take(*own as usize) {
            let (other, j) = (*other as usize, *j as usize);
            let far = place(other);
            let far_w = match other.checked_sub(*first_pin) {
                Some(pin) => pin_velocity.get(pin).map_or([T::ZERO; 3], |v| vec3::scale(turn, *v)),
                None => vectors.y.get(other).copied().unwrap_or([T::ZERO; 3]),
            };
            let force = force::<T, F, L>(state, forces, j, [near, far]);
            let damping = if F::DAMPS { h * forces.damping(j) } else { T::ZERO };
            let product = elastic(Hessian::unpack(*h0), damping, vec3::sub(w, far_w));
            let total = vec3::sub(vec3::scale(h, force), product);
            sum = vec3::add(sum, total);
            if let Some(b) = vectors.b.get_mut(other) {
                *b = vec3::sub(*b, total);
            }
        }
        if let Some(b) = vectors.b.get_mut(row) {
            *b = sum;
        }
    }
}

/// The force on the first end of a spring, its damping included.
#[inline(always)]
pub(crate) fn force<T: Real, F: Force<T>, L: Law>(
    state: &State<'_, T>,
    forces: &F,
    j: usize,
    [near, far]: [usize; 2],
) -> Vec3<T> {
    let at = |list: &[Vec3<T>], i: usize| list.get(i).copied().unwrap_or([T::ZERO; 3]);
    let (spring, delta) = (state.spring(j), vec3::sub(at(state.position, near), at(state.position, far)));
    let stretched = Stretched::new(delta);
    if is_slack::<T, L>(state, j, stretched.length) {
        return [T::ZERO; 3];
    }
    let mut pull = -spring.tension(stretched.length);
    if F::DAMPS {
        let speed = vec3::sub(at(state.velocity, near), at(state.velocity, far));
        pull -= forces.damping(j) * vec3::dot(stretched.direction, speed);
    }
    vec3::scale(pull, stretched.direction)
}

/// Does a spring of this length carry nothing?
#[inline(always)]
pub(crate) fn is_slack<T: Real, L: Law>(state: &State<'_, T>, j: usize, length: T) -> bool {
    let marked = state.ends.get(j).is_some_and(|pair| Ends::unpack(*pair).cable);
    L::slackens(marked) && length < state.spring(j).rest_length
}

/// −c(u·Δq̇)u of one spring, on its first end.
#[inline(always)]
pub(crate) fn damped<T: Real, F: Force<T>, L: Law>(
    state: &State<'_, T>,
    forces: &F,
    j: usize,
    [near, far]: [usize; 2],
) -> Vec3<T> {
    let c = forces.damping(j);
    if !(c > T::ZERO) {
        return [T::ZERO; 3];
    }
    let at = |list: &[Vec3<T>], i: usize| list.get(i).copied().unwrap_or([T::ZERO; 3]);
    let stretched = Stretched::new(vec3::sub(at(state.position, near), at(state.position, far)));
    if is_slack::<T, L>(state, j, stretched.length) {
        return [T::ZERO; 3];
    }
    let speed = vec3::sub(at(state.velocity, near), at(state.velocity, far));
    vec3::scale(-(c * vec3::dot(stretched.direction, speed)), stretched.direction)
}

/// H d without the part θhc uuᵀ that the damping has in it: w is along u.
#[inline(always)]
fn elastic<T: Real>(hessian: Hessian<T>, damping: T, d: Vec3<T>) -> Vec3<T> {
    let product = hessian.mul(d);
    let square = vec3::dot(hessian.w, hessian.w);
    if damping > T::ZERO && square > T::ZERO {
        let along = damping * vec3::dot(hessian.w, d) / square;
        return vec3::add_scaled(product, -along, hessian.w);
    }
    product
}
