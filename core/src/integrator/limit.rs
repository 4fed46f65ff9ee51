//! How long a step of an explicit method may be: a bound on how stiff a scene is.
//!
//! No eigenvalue of M⁻¹(−K) exceeds λ = max_i (1/mᵢ) Σ_{e∋i} c_e kₑ, with c_e = 1 where the other end is pinned or a point,
//! else 2: H ⪯ kI for every spring, however long it is. So the limits need no state and hold for all of a run, until k, m or
//! a pin changes. They are those of the frozen matrix, as in every linear theory: no guarantee for a nonlinear scene, but
//! where they are broken a scene leaves. Likewise the rates of damping: d = max_i (dᵢ + Σ c_e cₑ)/mᵢ.
//!
//! Source: Gershgorin's circles on M⁻¹K; Belytschko, Liu & Moran, *Nonlinear Finite Elements*, §6.2 (critical time steps).

use super::explicit::each_spring;
use crate::force::Force;
use crate::hessian::Scaling;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::real::Real;
use crate::vec3;

/// How fast a scene's parts can answer: what limits the step of explicit methods.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stiffest<T> {
    /// λ, 1/s²: no ω² is larger
    pub square: T,
    /// d, 1/s: no damping is faster
    pub damping: T,
    /// The particle where h²λ + 2hd is largest for the step that was asked about
    pub particle: usize,
}

/// λ and d of a scene, which needs its islands renewed; `forces` get a scaling of their own. O(particles + springs).
pub(crate) fn stiffest<M: Memory<Real = T>, T: Real, F: Force<T>>(
    parts: &mut Parts<'_, M>,
    forces: &mut F,
    h: T,
) -> Stiffest<T> {
    let Parts { network, islands, work } = parts;
    let state = network.state();
    // k in μ, damping in the inertia, both scratch between steps.
    for (mu, d) in work.mu.iter_mut().zip(work.inertia.iter_mut()) {
        (*mu, *d) = (T::ZERO, T::ZERO);
    }
    let free = islands.free;
    each_spring(islands, |row, other, j| {
        let (k, c) = (state.spring(j).stiffness, if F::DAMPS { forces.damping(j) } else { T::ZERO });
        let both = if other < free { T::TWO } else { T::ONE };
        for end in [row, other] {
            if let (Some(mu), Some(d)) = (work.mu.get_mut(end), work.inertia.get_mut(end)) {
                *mu += both * k;
                *d += both * c;
            }
        }
    });
    let rows = islands.all_rows(&state);
    if F::ANCHORS {
        forces.linearize(&rows, Scaling::unit());
        forces.hessians(&rows, &mut |row, h| {
            if let Some(mu) = work.mu.get_mut(row) {
                // The largest eigenvalue, which is k however long a spring is; −∂f of a force that repels counts by its size.
                let along = h.alpha + vec3::dot(h.w, h.w);
                *mu += if along > T::ZERO { along } else { -along };
            }
        });
    }
    let mut most = Stiffest { square: T::ZERO, damping: T::ZERO, particle: 0 };
    let mut worst = T::ZERO;
    for ((i, k), c) in rows.particles().zip(work.mu.iter()).zip(work.inertia.iter()) {
        let m = state.mass.get(i).copied().unwrap_or(T::ONE);
        let drag = if F::DRAGS { forces.drag(i, m) } else { T::ZERO };
        let (square, damping) = (*k / m, (*c + drag) / m);
        let own = h * (h * square + T::TWO * damping);
        if !(own <= worst) {
            (worst, most.particle) = (own, i);
        }
        if !(square <= most.square) {
            most.square = square;
        }
        if !(damping <= most.damping) {
            most.damping = damping;
        }
    }
    most
}
