//! A state that an iteration tries, beside the scene's own: for methods that solve nonlinear equations for q̇⁺.

use crate::force::Rows;
use crate::network::State;
use crate::parts::IslandParts;
use crate::pins::Motion;
use crate::real::Real;
use crate::solver::Stop;
use crate::vec3::{self, Vec3};

/// A method's memory: positions and velocities in the scene's numbering.
pub(crate) struct Trial<'a, T> {
    pub(crate) position: &'a mut [Vec3<T>],
    pub(crate) velocity: &'a mut [Vec3<T>],
}

impl<'a, T: Real> Trial<'a, T> {
    /// How many vectors a scene of so many particles needs.
    pub(crate) const fn needs(particles: usize) -> usize {
        particles.saturating_mul(2)
    }

    /// `None` if the memory is too small.
    pub(crate) fn cut(memory: &'a mut [Vec3<T>], particles: usize) -> Option<Self> {
        let (position, rest) = memory.split_at_mut_checked(particles)?;
        Some(Self { position, velocity: rest.get_mut(..particles)? })
    }

    /// All where it is, moving pins at `part` of their way with the velocity p = (b⁺ − b)/h.
    pub(crate) fn begin(&mut self, state: &State<'_, T>, motion: &[Motion<T>], h: T, part: T) {
        for (i, (to, from)) in self.position.iter_mut().zip(state.position).enumerate() {
            *to = vec3::add([T::ZERO; 3], *from);
            if let (Some(v), Some(rate)) = (self.velocity.get_mut(i), state.velocity.get(i)) {
                *v = if state.is_pinned(i) { [T::ZERO; 3] } else { vec3::add([T::ZERO; 3], *rate) };
            }
        }
        for m in motion {
            if let (Some(q), Some(v), Some(b)) = (
                self.position.get_mut(m.particle),
                self.velocity.get_mut(m.particle),
                state.position.get(m.particle),
            ) {
                let way = vec3::sub(m.position, *b);
                (*q, *v) = (vec3::add_scaled(*b, part, way), vec3::map(way, |d| d / h));
            }
        }
    }

    /// The scene as it is here.
    pub(crate) fn state<'s>(&'s self, state: &State<'s, T>) -> State<'s, T> {
        State { position: self.position, velocity: self.velocity, ..*state }
    }

    /// Writes (q, q̇) of an island's rows as `of` makes them from the row and the scene's own.
    pub(crate) fn place(&mut self, rows: &Rows<'_, T>, of: impl Fn(usize, [Vec3<T>; 2]) -> [Vec3<T>; 2]) {
        for (row, i) in rows.particles().enumerate() {
            let (Some(q), Some(v)) = (rows.state.position.get(i), rows.state.velocity.get(i)) else {
                continue;
            };
            if let (Some(to), Some(to_v)) = (self.position.get_mut(i), self.velocity.get_mut(i)) {
                [*to, *to_v] = of(row, [*q, *v]);
            }
        }
    }
}

/// ½ Σ|bᵢ|²/μᵢ: how far from solved.
pub(crate) fn unsolved<T: Real>(island: &IslandParts<'_, T>) -> T {
    let rows = island.vectors.b.iter().zip(island.vectors.mu.iter());
    T::HALF * rows.fold(T::ZERO, |sum, (b, mu)| sum + vec3::dot(vec3::scale(T::ONE / *mu, *b), *b))
}

/// For the linear systems of an iteration that will go on: no more than a thousandth is worth solving for.
pub(crate) fn loose<T: Real>(stop: &Stop<T>) -> Stop<T> {
    let least = T::from_f64(1e-3);
    Stop { relative: if stop.relative < least { least } else { stop.relative }, absolute: T::ZERO, ..*stop }
}

/// ½ Σ|δᵢ|²/μᵢ of what rounding alone can leave in b: some u of masses times velocities, and of what springs make of positions
/// that are rounded, h k|x|. `r` is scratch.
#[inline(never)]
pub(crate) fn rounding<T: Real>(island: &mut IslandParts<'_, T>, before: &State<'_, T>, h: T) -> T {
    let IslandParts { matrix, vectors, particle, spring, .. } = island;
    let here = matrix.rows.state;
    let size =
        |list: &[Vec3<T>], i: usize| list.get(i).map_or(T::ZERO, |x| x[0].abs() + x[1].abs() + x[2].abs());
    for (r, i) in vectors.r.iter_mut().zip(matrix.rows.particles()) {
        let m = here.mass.get(i).copied().unwrap_or(T::ZERO);
        r[0] = m * (size(before.velocity, i) + size(here.velocity, i));
    }
    let place = |slot: usize| particle.get(slot).map_or(usize::MAX, |i| *i as usize);
    let mut edges = matrix.other.iter().zip(spring.iter());
    for (row, own) in matrix.own.iter().enumerate() {
        for (other, j) in edges.by_ref().take(*own as usize) {
            let (other, spring) = (*other as usize, here.spring(*j as usize));
            let reach =
                size(here.position, place(row)) + size(here.position, place(other)) + spring.rest_length;
            for end in [row, other] {
                if let Some(r) = vectors.r.get_mut(end) {
                    r[0] += h * spring.stiffness * reach;
                }
            }
        }
    }
    let unit = T::TWO * T::TWO * T::UNIT_ROUNDOFF;
    let rows = vectors.r.iter().zip(vectors.mu.iter());
    T::HALF * rows.fold(T::ZERO, |sum, (r, mu)| sum + unit * r[0] * (unit * r[0]) / *mu)
}
