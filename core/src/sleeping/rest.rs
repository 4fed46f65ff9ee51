//! The rule that brings q̇ to 0.
//!
//! An island comes to rest, q̇⁺ = 0 and q⁺ = q, in a step where
//!
//! ½ q̇ᵀMq̇ ≤ J  and  ½ b₀ᵀdiag(μ)⁻¹b₀ ≤ the absolute tolerance,  b₀ = h f(q) + what moving pins pull,
//!
//! b₀ the right side that the step would have at q̇ = 0. So it is slow, and at rest nothing would move it: a pendulum at its
//! highest point is slow too, but falls. The rule looks at the present state alone, so that a restored snapshot goes on bit
//! for bit. What it does is Δ = −q̇ in place of a solve; b = b₀ + (M − A)q̇, so that the residual of that, r = b − AΔ, is
//! b₀ + Mq̇. The report bounds how far this is from the equation's answer, as it does for every solve.
//!
//! It takes away at most J per island, and keeps no momentum. An island that no force holds where it is stays there if what
//! it would gain in a step, ½ m g²h² for a falling one, is below the absolute tolerance: that says what counts as nothing.
//! Give it a J not below that tolerance: what solves leave undone can keep an island above a much smaller one for good.
//! With J = 0 it stops nothing that moves; with an absolute tolerance of 0, the default, nothing but what is in perfect
//! balance.
//!
//! Cost: one sum over the particles; where an island is slow, one product with its rounding; where it comes to rest, another.

use super::{Found, steps};
use crate::bound;
use crate::error::StepError;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::memory::Memory;
use crate::parts::{IslandParts, Parts, Vectors};
use crate::real::Real;
use crate::report::{Ending, Solve};
use crate::system::System;
use crate::vec3;

/// The rule alone, without a memory: every island is assembled, those at rest are not solved. The number is J, joules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest<T>(pub T);

impl<T: Real> steps::Sleeps<T> for Rest<T> {
    #[inline]
    fn begin<M: Memory<Real = T>>(&mut self, _: &Parts<'_, M>, _: T, _: T) -> Result<(), StepError> {
        if self.0.is_finite() && self.0 >= T::ZERO { Ok(()) } else { Err(StepError::Tolerance) }
    }

    #[inline(never)]
    fn is_slow(&self, island: &IslandParts<'_, T>) -> bool {
        let rows = island.matrix.rows;
        let energy = rows.particles().fold(T::ZERO, |sum, i| {
            let (m, v) = (rows.state.mass.get(i), rows.state.velocity.get(i));
            let v = v.copied().unwrap_or([T::ZERO; 3]);
            sum + T::HALF * m.copied().unwrap_or(T::ZERO) * vec3::dot(v, v)
        });
        energy <= self.0
    }

    #[inline(never)]
    fn rest<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        absolute: T,
        _: Found,
    ) -> Option<Solve<T>> {
        let rows = system.matrix.rows;
        let particle = |row: usize| rows.particle.get(row).map_or(usize::MAX, |i| *i as usize);
        let mass = |row| rows.state.mass.get(particle(row)).copied().unwrap_or(T::ZERO);
        let velocity = |row| rows.state.velocity.get(particle(row)).copied().unwrap_or([T::ZERO; 3]);
        for (row, x) in v.x.iter_mut().enumerate() {
            *x = vec3::scale(-T::ONE, velocity(row));
        }
        bound::residual(system, v.b, v.x, v.r, v.p);
        let mut beta = Lanes::new();
        for (row, (r, mu)) in v.r.iter().zip(v.mu.iter()).enumerate() {
            let at_rest = vec3::add_scaled(*r, -mass(row), velocity(row));
            beta.add(row, bound::square(at_rest, T::ONE / *mu));
        }
        if !(T::HALF * beta.sum() <= absolute) {
            return None;
        }
        for ((mu, z), r) in v.mu.iter_mut().zip(v.y.iter_mut()).zip(v.r.iter()) {
            *mu = T::ONE / *mu;
            *z = vec3::scale(*mu, *r);
        }
        let upper = bound::upper(v.r, v.p, v.mu);
        let lower = bound::lower(system, v.r, v.y, v.b, v.p);
        Some(Solve { iterations: 0, upper, lower, ending: Ending::Untouched, fallback: false })
    }
}
