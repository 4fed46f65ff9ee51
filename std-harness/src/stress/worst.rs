//! The worst figures of a trial, or of several.

/// The most that was seen.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Worst {
    /// Linear systems of a step.
    pub solves: u64,
    /// Iterations of a step: products with the matrix, or solves with a factor.
    pub iterations: u64,
    /// Rejections of a step.
    pub rejections: u32,
    /// The upper bound of a step's solves, J.
    #[serde(rename = "upper_J")]
    pub upper: f64,
    /// Energy in motion and springs, J.
    #[serde(rename = "energy_J")]
    pub energy: f64,
    /// Change of momentum, in what rounding may make of it.
    pub momentum: f64,
    /// Rise of newton's potential, in what rounding may make of it; 0 if it never rose.
    pub potential: f64,
    /// Distance from the same motion at the origin, in u times the distance from the origin.
    pub loss: f64,
}

impl Worst {
    /// The worse of both, figure by figure.
    pub fn with(self, other: Self) -> Self {
        Self {
            solves: self.solves.max(other.solves),
            iterations: self.iterations.max(other.iterations),
            rejections: self.rejections.max(other.rejections),
            upper: self.upper.max(other.upper),
            energy: self.energy.max(other.energy),
            momentum: self.momentum.max(other.momentum),
            potential: self.potential.max(other.potential),
            loss: self.loss.max(other.loss),
        }
    }
}
