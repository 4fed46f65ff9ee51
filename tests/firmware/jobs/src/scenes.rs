//! The scenes that several jobs share.

use hooke::{MassSpring, Memory, Real, Vec3};

use crate::outcome::Outcome;

/// The step of all jobs but those that say otherwise, s.
pub fn dt<T: Real>() -> T {
    T::ONE / T::from_count(60)
}

/// A number of the caller's precision.
pub fn real<T: Real>(x: f64) -> T {
    T::from_f64(x)
}

/// A vector of the caller's precision.
pub fn vector<T: Real>(x: f64, y: f64, z: f64) -> Vec3<T> {
    [x, y, z].map(T::from_f64)
}

/// g, m/s²
pub fn gravity<T: Real>() -> Vec3<T> {
    vector(0.0, -9.81, 0.0)
}

/// A rope of `n` particles of 10 g, 0.1 m and 1000 N/m apart, laid out level; its first particle is pinned.
pub fn hang<M: Memory>(scene: &mut MassSpring<M>, n: usize) -> Outcome {
    line(scene, n, 0.0)?;
    scene.pin(0)?;
    Ok(())
}

/// The same rope at height `y`, not pinned; answers its first particle.
pub fn line<M: Memory>(
    scene: &mut MassSpring<M>,
    n: usize,
    y: f64,
) -> Result<usize, crate::outcome::Failure> {
    let first = scene.positions().len();
    for i in 0..n {
        // Not quite straight, so that no coordinate is idle.
        let sway = 0.01 * (i % 3) as f64;
        let particle = scene.particle(vector(0.1 * i as f64, y, sway), real(0.01))?;
        if i > 0 {
            scene.spring(particle - 1, particle, real(1000.0))?;
        }
    }
    Ok(first)
}

/// A level cloth of n×n particles 1/(n−1) m apart, 0.3 kg in all: structural springs of 1000 N/m, both diagonals of
/// 500 N/m. Nothing is pinned.
pub fn cloth<M: Memory>(scene: &mut MassSpring<M>, n: usize) -> Outcome {
    let mass = M::Real::from_f64(0.3) / M::Real::from_count(n * n);
    let at = |i: usize| M::Real::from_count(i) / M::Real::from_count(n - 1);
    for i in 0..n {
        for j in 0..n {
            scene.particle([at(j), M::Real::ZERO, at(i)], mass)?;
        }
    }
    for i in 0..n {
        for j in 0..n {
            let id = i * n + j;
            if j + 1 < n {
                scene.spring(id, id + 1, real(1000.0))?;
            }
            if i + 1 < n {
                scene.spring(id, id + n, real(1000.0))?;
            }
            if i + 1 < n && j + 1 < n {
                scene.spring(id, id + n + 1, real(500.0))?;
                scene.spring(id + 1, id + n, real(500.0))?;
            }
        }
    }
    Ok(())
}

/// Springs of an n×n cloth.
pub const fn cloth_springs(n: usize) -> usize {
    2 * n * (n - 1) + 2 * (n - 1) * (n - 1)
}
