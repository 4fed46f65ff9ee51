//! One spring by the textbook, and the rule of where to clamp, for the oracles in `f64`.
//!
//! ∂²V/∂Δx² = k[(1 − l₀/l)(I − uuᵀ) + uuᵀ]; clamped: k uuᵀ; at l = 0: kI. Nothing here is compressed to four numbers.

use nalgebra::{Matrix3, Vector3};

use crate::data::SceneData;

/// A spring at a length: what the textbook says of it.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// u = Δx/l, or 0
    pub u: Vector3<f64>,
    /// l
    pub l: f64,
    /// k
    pub k: f64,
    /// l₀
    pub l0: f64,
}

impl Stretch {
    /// Of Δx = x_A − x_B.
    pub fn new(delta: Vector3<f64>, k: f64, l0: f64) -> Self {
        let l = delta.norm();
        let u = if l > 0.0 { delta / l } else { Vector3::zeros() };
        Self { u, l, k, l0 }
    }

    /// ∂V/∂x_A = k(l − l₀)u
    pub fn gradient(&self) -> Vector3<f64> {
        self.k * (self.l - self.l0) * self.u
    }

    /// k(1 − l₀/l): the eigenvalue across the spring; k at l = 0.
    pub fn across(&self) -> f64 {
        if self.l > 0.0 { self.k * (1.0 - self.l0 / self.l) } else { self.k }
    }

    /// ∂²V/∂Δx²
    pub fn hessian(&self) -> Matrix3<f64> {
        let uu = self.u * self.u.transpose();
        self.k * ((1.0 - self.l0 / self.l) * (Matrix3::identity() - uu) + uu)
    }

    /// What goes into the step's matrix for ∂²V/∂Δx²: the same, or its replacement.
    pub fn used(&self, clamp: bool) -> Matrix3<f64> {
        if self.l == 0.0 {
            Matrix3::identity() * self.k
        } else if clamp {
            self.k * self.u * self.u.transpose()
        } else {
            self.hessian()
        }
    }
}

/// Which springs, and which point springs, the step must clamp; and which are replaced because l = 0 < l₀.
#[derive(Debug, Clone, Default)]
pub struct Clamping {
    /// Per spring
    pub springs: Vec<bool>,
    /// Per point spring
    pub points: Vec<bool>,
    /// How many were clamped or replaced
    pub count: usize,
}

/// Δx of a spring of the scene.
pub fn stretch_of(data: &SceneData, j: usize) -> Stretch {
    let s = &data.springs[j];
    let x = |i: usize| Vector3::from(data.position[i]);
    Stretch::new(x(s.a) - x(s.b), s.k, s.l0)
}

/// Δx of a point spring of the scene.
pub fn stretch_of_point(data: &SceneData, j: usize) -> Stretch {
    let p = &data.points[j];
    Stretch::new(Vector3::from(data.position[p.particle]) - Vector3::from(p.target), p.k, p.l0)
}

/// The rule: μᵢ = mᵢ + h·drag − h² Σ c_e max(0, −αₑ), c_e = 2, or 1 where the other end is pinned or a point; at free
/// nodes with μᵢ ≤ 0 clamp the compressed springs that meet there. One pass.
pub fn clamping(data: &SceneData, h: f64) -> Clamping {
    let mut mu: Vec<f64> = data.mass.iter().map(|m| m + h * data.drag * m).collect();
    let stretches: Vec<Stretch> = (0..data.springs.len()).map(|j| stretch_of(data, j)).collect();
    let points: Vec<Stretch> = (0..data.points.len()).map(|j| stretch_of_point(data, j)).collect();
    for (s, stretch) in data.springs.iter().zip(&stretches) {
        let weight = if data.pinned[s.a] || data.pinned[s.b] { 1.0 } else { 2.0 };
        for end in [s.a, s.b] {
            mu[end] -= h * h * weight * f64::max(0.0, -stretch.across());
        }
    }
    for (p, stretch) in data.points.iter().zip(&points) {
        mu[p.particle] -= h * h * f64::max(0.0, -stretch.across());
    }
    let fails = |i: usize| !data.pinned[i] && mu[i] <= 0.0;
    let mut count = 0;
    let springs = data
        .springs
        .iter()
        .zip(&stretches)
        .map(|(s, stretch)| {
            let clamp = (fails(s.a) || fails(s.b)) && stretch.across() < 0.0;
            count += usize::from(clamp || (data.acts(s) && stretch.l == 0.0 && s.l0 > 0.0));
            clamp
        })
        .collect();
    let points = data
        .points
        .iter()
        .zip(&points)
        .map(|(p, stretch)| {
            let clamp = fails(p.particle) && stretch.across() < 0.0;
            count += usize::from(clamp || (!data.pinned[p.particle] && stretch.l == 0.0 && p.l0 > 0.0));
            clamp
        })
        .collect();
    Clamping { springs, points, count }
}
