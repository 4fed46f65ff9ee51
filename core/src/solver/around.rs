//! PCG around a preconditioner in `f32`: it is told the largest component of r, since `f32` would lose a small r.

use crate::bound::square;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::{Real, larger};
use crate::system::System;
use crate::vec3::{self, Vec3};

/// Iterates from x and r as [`crate::solver::pcg::Iterates::iterate`] says; `apply` finds z = B r and answers rᵀz.
#[inline(always)]
pub(crate) fn iterate<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    v: &mut Vectors<'_, T>,
    target: T,
    max_iterations: u32,
    iterations: &mut u32,
    mut apply: impl FnMut(&[Vec3<T>], T, &mut [Vec3<T>]) -> T,
) -> bool {
    for (p, y) in v.p.iter_mut().zip(v.y.iter_mut()) {
        (*p, *y) = ([T::ZERO; 3], [T::ZERO; 3]);
    }
    // The first update has no step to make.
    let (mut step, mut rz) = (T::ZERO, T::ZERO);
    loop {
        let (beta, most) = update(step, v);
        if !(T::HALF * beta > target) || *iterations >= max_iterations {
            return false;
        }
        let next = apply(v.r, most, v.y);
        if !(next > T::ZERO) {
            return true;
        }
        let ratio = if rz > T::ZERO { next / rz } else { T::ZERO };
        for (p, y) in v.p.iter_mut().zip(v.y.iter_mut()) {
            *p = vec3::add_scaled(*y, ratio, *p);
            *y = [T::ZERO; 3];
        }
        let curvature = system.add_product(v.p, v.y);
        if !(curvature > T::ZERO) {
            return true;
        }
        step = next / curvature;
        rz = next;
        *iterations += 1;
    }
}

/// The largest component.
pub(crate) fn largest<T: Real>(r: &[Vec3<T>]) -> T {
    r.iter().fold(T::ZERO, larger_of)
}

#[inline(always)]
fn larger_of<T: Real>(most: T, r: &Vec3<T>) -> T {
    larger(larger(larger(most, r[0].abs()), r[1].abs()), r[2].abs())
}

/// x += a p, r −= a y; answers Σ|rᵢ|²/μᵢ and the largest component of r.
#[inline(never)]
fn update<T: Real>(a: T, v: &mut Vectors<'_, T>) -> (T, T) {
    let (mut beta, mut most) = (Lanes::new(), T::ZERO);
    let vectors = v.x.iter_mut().zip(v.r.iter_mut()).zip(v.p.iter().zip(v.y.iter()));
    for (i, (((x, r), (p, y)), weight)) in vectors.zip(v.mu.iter()).enumerate() {
        *x = vec3::add_scaled(*x, a, *p);
        *r = vec3::add_scaled(*r, -a, *y);
        beta.add(i, square(*r, *weight));
        most = larger_of(most, r);
    }
    (beta.sum(), most)
}
