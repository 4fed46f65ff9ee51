//! A spring's quantities against 62 digits, and blocks of a few springs.

use hooke::{Hessian, Real, Scaling, Spring, Stretched, Sym3};
use nalgebra::Matrix3;

use super::COUNT;
use super::inputs::{Input, Kind};
use crate::precise::{Big, Factor, big, root, small};

/// The largest error of each quantity, in its unit; 0 where it was not measured.
pub type Errors = [f64; COUNT];

/// |computed − exact| / unit, raised into its place.
fn meet<T: Real>(errors: &mut Errors, place: usize, computed: T, exact: &Big, unit: &Big) {
    let u = big(T::UNIT_ROUNDOFF.to_f64());
    let miss = big(computed.to_f64()) - exact;
    if miss == big(0.0) {
        return;
    }
    let error = small(&(miss / (unit * u))).abs();
    errors[place] = if error <= errors[place] { errors[place] } else { error };
}

fn magnitude(x: &Big) -> Big {
    if *x < big(0.0) { -x.clone() } else { x.clone() }
}

/// Measures on some springs.
pub fn errors<T: Real>(kind: Kind, inputs: &[Input<T>]) -> Errors {
    let mut errors = [0.0; COUNT];
    for input in inputs {
        one(kind, input, &mut errors);
    }
    if kind != Kind::Edge {
        for some in inputs.chunks(6) {
            block(some, &mut errors);
        }
    }
    errors
}

fn one<T: Real>(kind: Kind, input: &Input<T>, errors: &mut Errors) {
    let exact = |x: T| big(x.to_f64());
    let delta = input.delta.map(exact);
    let squared = delta.iter().fold(big(0.0), |sum, x| sum + x * x);
    let stretched = Stretched::new(input.delta);
    if stretched.length == T::ZERO {
        return;
    }
    let l = root(&squared);
    if kind == Kind::Edge {
        return meet(errors, 2, stretched.length, &l, &l);
    }
    let [a, b, c] = input.delta;
    meet(errors, 0, (a * a + b * b) + c * c, &squared, &squared);
    meet(errors, 1, stretched.length, &l, &l);

    let spring = Spring { stiffness: input.k, rest_length: input.l0 };
    let (k, l0) = (exact(input.k), exact(input.l0));
    let strain = &l - &l0;
    let size = magnitude(&strain);
    let energy = big(0.5) * &k * &strain * &strain;
    let u = big(T::UNIT_ROUNDOFF.to_f64());
    let unit = &energy + &k * &size * &l + u * &k * &l * &l;
    meet(errors, 3, spring.potential_energy(stretched.length), &energy, &unit);
    let tension = &k * &strain;
    let pull = &k * (&l + &size);
    meet(errors, 4, spring.tension(stretched.length), &tension, &pull);

    let stored = exact(stretched.length);
    let at_stored = &k * (&stored - &l0) / &stored;
    let computed = spring.tension(stretched.length) / stretched.length;
    meet(errors, 5, computed, &at_stored, &magnitude(&at_stored));

    let gradient = spring.gradient(input.delta, [T::ZERO; 3])[0];
    let scaling = Scaling { stiffness: input.stiffness, damping: input.damping };
    let hessian = Hessian::new(spring, stretched, input.c, scaling);
    let clamped = Hessian::clamped(spring, stretched, input.c, scaling);
    let (s, damped) = (exact(input.stiffness), exact(input.damping) * exact(input.c));
    let alpha = &s * &k * &strain / &l;
    meet(errors, 7, hessian.alpha, &alpha, &(&s * &k * (big(1.0) + &size / &l)));
    let w = root(&(&s * &k * &l0 / &l + &damped));
    let w_clamped = root(&(&s * &k + &damped));
    for d in 0..3 {
        let along = &delta[d] / &l;
        let unit = magnitude(&along);
        meet(errors, 6, gradient[d], &(&tension * &along), &(&pull * &unit));
        meet(errors, 8, hessian.w[d], &(&w * &along), &(&w * &unit));
        meet(errors, 9, clamped.w[d], &(&w_clamped * &along), &(&w_clamped * &unit));
    }
}

/// The diagonal block of a particle that these springs meet at, and its inverse.
fn block<T: Real>(inputs: &[Input<T>], errors: &mut Errors) {
    let exact = |x: T| big(x.to_f64());
    let hessians = inputs.iter().map(|input| {
        let spring = Spring { stiffness: input.k, rest_length: input.l0 };
        let stretched = Stretched::new(input.delta);
        let scaling = Scaling { stiffness: input.stiffness, damping: input.damping };
        let hessian = Hessian::new(spring, stretched, input.c, scaling);
        // As the certificate would have it.
        if hessian.alpha < T::ZERO { Hessian::clamped(spring, stretched, input.c, scaling) } else { hessian }
    });
    let hessians: Vec<Hessian<T>> = hessians.collect();
    let most = hessians.iter().map(|h| h.dense()[0][0].to_f64()).fold(0.0, f64::max);
    let m = T::from_f64(most * 2f64.powi(-(hessians.len() as i32)) + T::MIN_POSITIVE.to_f64());
    let mut computed = Sym3::scalar(m);
    let (mut sum, mut size) = ([[0.0; 3].map(big), [0.0; 3].map(big), [0.0; 3].map(big)], Vec::new());
    size.resize(9, big(0.0));
    for i in 0..3 {
        sum[i][i] = exact(m);
        size[4 * i] = exact(m);
    }
    for h in &hessians {
        computed = computed.plus_scalar(h.alpha).plus_outer(h.w);
        let (alpha, w) = (exact(h.alpha), h.w.map(exact));
        for i in 0..3 {
            for j in 0..3 {
                let outer = &w[i] * &w[j];
                size[3 * i + j] += magnitude(&outer);
                sum[i][j] += outer;
            }
            size[4 * i] += magnitude(&alpha);
            sum[i][i] += &alpha;
        }
    }
    let roundings = big(2.0 * hessians.len() as f64 + 1.0);
    let dense = computed.dense();
    for i in 0..3 {
        for j in 0..3 {
            meet(errors, 10, dense[i][j], &sum[i][j], &(&roundings * &size[3 * i + j]));
        }
    }
    inverse(&computed, errors);
}

fn inverse<T: Real>(block: &Sym3<T>, errors: &mut Errors) {
    let dense = block.dense();
    let exact: Vec<Vec<Big>> =
        dense.iter().map(|row| row.iter().map(|x| big(x.to_f64())).collect()).collect();
    let (Some(inverse), Some(factor)) = (block.inverse(), Factor::new(&exact)) else { return };
    let columns = [0, 1, 2].map(|j| factor.solve(&[0, 1, 2].map(|i| big(if i == j { 1.0 } else { 0.0 }))));
    // Scaled, so that no norm overflows.
    let scale = &exact[0][0];
    let norm = |of: &dyn Fn(usize, usize) -> f64| Matrix3::from_fn(of).symmetric_eigenvalues().amax();
    let of_block = norm(&|i, j| small(&(&exact[i][j] / scale)));
    let of_inverse = norm(&|i, j| small(&(&columns[j][i] * scale)));
    if of_block * of_inverse * T::UNIT_ROUNDOFF.to_f64() > 1e-2 {
        // No digit is left to speak of; the preconditioner takes the largest entry there.
        return;
    }
    let unit = big(of_block * of_inverse * of_inverse) / scale;
    let found = inverse.dense();
    for i in 0..3 {
        for j in 0..3 {
            meet(errors, 11, found[i][j], &columns[j][i], &unit);
        }
    }
}
