//! Rows of A x and b − A x against 62 digits, on systems of the certificate's own generator.

use hooke::{Operator, Real};

use super::COUNT;
use super::quantities::Errors;
use crate::build::{self, Forces};
use crate::certified::case::{Case, Family};
use crate::certified::stored::Stored;
use crate::precise::{BITS, big, small};
use crate::random::Random;

/// Measures on so many networks.
pub fn errors<T: Real>(count: usize, seed: u64) -> Errors {
    let mut random = Random::new(seed);
    let mut errors = [0.0; COUNT];
    for _ in 0..count {
        let case = Case::new(&mut random);
        // What underflows has an absolute error too, and is the certificate's business.
        if case.family != Family::Faint && case.family != Family::Chain {
            one::<T>(&case, &mut random, &mut errors);
        }
    }
    errors
}

fn one<T: Real>(case: &Case, random: &mut Random, errors: &mut Errors) {
    let mut scene = build::scene::<T>(&case.data);
    let mut forces = Forces::<T>::new(&case.data);
    let motion = build::motions::<T>(&case.motion);
    let mut euler = forces.euler(T::from_f64(case.h));
    let u = T::UNIT_ROUNDOFF.to_f64();
    let done = euler.inspect(scene.parts(), &motion, |system, b, mu| {
        let stored = Stored::new(case, system, b, mu);
        let base = random.vector(1.0);
        // Nearly the same everywhere, so that springs see differences that cancel, or not.
        let apart = [1.0, 1e-3, 1e-6][random.below(3)];
        let mut near = || {
            let by = random.vector(apart);
            [0, 1, 2].map(|d| T::from_f64(base[d] + by[d]))
        };
        let x: Vec<[T; 3]> = b.iter().map(|_| near()).collect();
        let mut y = vec![[T::ZERO; 3]; x.len()];
        system.apply(&x, &mut y);
        let flat: Vec<f64> = x.iter().flatten().map(|x| x.to_f64()).collect();
        let left = stored.residual(&stored.matrix(BITS), &flat, BITS);
        let (size, springs) = sizes(&stored, &x);
        for (k, exact) in left.iter().enumerate() {
            let (row, d) = (k / 3, k % 3);
            let right = b[row][d].to_f64();
            let product = big(right) - exact;
            let miss = small(&(big(y[row][d].to_f64()) - product)).abs();
            raise(&mut errors[12], miss / (u * (springs[row] + 9.0) * size[k]));
            let computed = (b[row][d] - y[row][d]).to_f64();
            let miss = small(&(big(computed) - exact)).abs();
            raise(&mut errors[13], miss / (u * (springs[row] + 10.0) * (size[k] + right.abs())));
        }
    });
    done.expect("a step's system");
}

fn raise(most: &mut f64, error: f64) {
    if !(error <= *most) {
        *most = error;
    }
}

/// Per component |m̃x| + Σ|α||d| + |w|(|w|·|d|), and the springs per row.
fn sizes<T: Real>(stored: &Stored<T>, x: &[[T; 3]]) -> (Vec<f64>, Vec<f64>) {
    let at = |row: usize| x[row].map(Real::to_f64);
    let mut springs = vec![0.0; x.len()];
    let mut size: Vec<f64> =
        (0..3 * x.len()).map(|k| (stored.inertia[k / 3].to_f64() * at(k / 3)[k % 3]).abs()).collect();
    for tie in &stored.ties {
        let other = tie.other.map_or([0.0; 3], at);
        let apart = [0, 1, 2].map(|d| (at(tie.row)[d] - other[d]).abs());
        let w = tie.used.w.map(|w| w.to_f64().abs());
        let along: f64 = (0..3).map(|d| w[d] * apart[d]).sum();
        for row in [Some(tie.row), tie.other].into_iter().flatten() {
            springs[row] += 1.0;
            for k in 0..3 {
                size[3 * row + k] += tie.used.alpha.to_f64().abs() * apart[k] + w[k] * along;
            }
        }
    }
    (size, springs)
}
