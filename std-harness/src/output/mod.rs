//! What a run leaves behind: files for people and for other programs, made from plain data.
//!
//! Nothing here simulates or computes mechanics. Every function takes slices of numbers and a path; the caller
//! says when. A file appears under its name only once it is complete ([`safe`]), so what lies in an output
//! folder can be trusted even after a run was cut short.

use std::io;

mod camera;
mod canvas;
mod colour;
mod pen;
pub mod picture;
pub mod plot;
pub mod safe;
mod stroke_font;
pub mod table;
pub mod vtk;

/// One moment of the motion. Particles are in id order; a broken spring is absent from the three spring lists.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// Positions in m, one per particle.
    pub positions: &'a [[f64; 3]],
    /// Velocities in m/s, one per particle.
    pub velocities: &'a [[f64; 3]],
    /// Whether a particle is pinned, one per particle.
    pub fixed: &'a [bool],
    /// The two particles of each spring.
    pub springs: &'a [[usize; 2]],
    /// (l − l₀)/l₀ of each spring, dimensionless: positive where it is stretched.
    pub strain: &'a [f64],
    /// k (l − l₀) of each spring in N: positive where it pulls.
    pub tension: &'a [f64],
}

impl Frame<'_> {
    /// Refuses lists that contradict each other: a file made from them would open and show something else.
    ///
    /// # Errors
    /// `InvalidInput`, naming the list or the spring.
    pub fn check(&self) -> io::Result<()> {
        let refuse = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        let (particles, springs) = (self.positions.len(), self.springs.len());
        for (name, found, expected) in [
            ("velocities", self.velocities.len(), particles),
            ("fixed", self.fixed.len(), particles),
            ("strain", self.strain.len(), springs),
            ("tension", self.tension.len(), springs),
        ] {
            if found != expected {
                return refuse(format!("frame: {found} entries in `{name}`, expected {expected}"));
            }
        }
        match self.springs.iter().position(|ends| ends.iter().any(|&end| end >= particles)) {
            Some(j) => {
                refuse(format!("frame: spring {j} joins {:?} of {particles} particles", self.springs[j]))
            }
            None => Ok(()),
        }
    }
}

/// The energies at one time, all but the first in J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// Time in s.
    pub time: f64,
    /// T = ½ q̇ᵀMq̇.
    pub kinetic: f64,
    /// V = Σ ½ k (l − l₀)².
    pub springs: f64,
    /// Potential of gravity, −Σ m gᵀx.
    pub gravity: f64,
    /// The sum that a perfect integrator would keep, where nothing damps.
    pub total: f64,
}
