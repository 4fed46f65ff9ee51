//! What a step and a measurement answer, laid out for C.

use hooke::Real;

/// What a step says of itself: sums over the islands, the parts of a scene that are solved apart.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Report<T> {
    /// The energy of the solve's error, J, is at most this.
    pub upper: T,
    /// It is at least this.
    pub lower: T,
    /// Iterations of all islands together.
    pub iterations: u32,
    /// Springs whose Hessian was clamped or replaced.
    pub clamped: u32,
    /// Number of islands.
    pub islands: u32,
    /// Islands that met the tolerance at 0 iterations.
    pub untouched: u32,
    /// Islands certified without a projection pass.
    pub certified: u32,
    /// Islands that ended at the floor of their own rounding: no better answer can be recognised.
    pub at_floor: u32,
    /// Islands that used up max_iterations.
    pub capped: u32,
    /// Islands that stalled above the floor.
    pub stalled: u32,
    /// Springs that no island needed: broken, or with both ends pinned.
    pub springs_skipped: u32,
}

impl<T> From<hooke::Report<T>> for Report<T> {
    fn from(r: hooke::Report<T>) -> Self {
        Self {
            upper: r.upper,
            lower: r.lower,
            iterations: r.iterations,
            clamped: r.clamped,
            islands: r.islands,
            untouched: r.untouched,
            certified: r.certified,
            at_floor: r.at_floor,
            capped: r.capped,
            stalled: r.stalled,
            springs_skipped: r.springs_skipped,
        }
    }
}

/// Energies, J.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Energies<T: Real> {
    /// Kinetic energy.
    pub kinetic: T,
    /// Potential energy of the springs.
    pub springs: T,
    /// Potential energy in gravity; 0 at the origin.
    pub gravity: T,
}
