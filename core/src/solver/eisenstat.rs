//! Eisenstat's trick: PCG with M = (P + L) P⁻¹ (P + Lᵀ) in two sweeps over the springs and no product.
//!
//! A = L + D + Lᵀ with D the 3×3 diagonal blocks and L below them: −H for each spring between two rows. P is any block
//! diagonal with positive blocks. Then M = (P + L) P⁻¹ (P + L)ᵀ is symmetric and positive, however P was come by.
//!
//! With E = D − P, y = (P + Lᵀ) p and z = (P + L)⁻¹ (E − P) p + (P + L)⁻¹ y,
//!
//! A p = (P + L)(p + z),
//!
//! so in place of r its image g = P (P + L)⁻¹ r is kept, rᵀM⁻¹r = gᵀP⁻¹g, and an iteration is
//!
//! - rows descending, each gathers from its own springs: y = g + (ratio) y, h = Σ H p_b, p = P⁻¹(y + h);
//! - rows ascending, each scatters to them: z = P⁻¹(E p − h + l), l_b += H z; x += a p, g −= a (y + E p + l).
//!
//! l has arrived in full when its row is reached, since a row owns the springs to later rows. Off the path that rows wait
//! for each other on, the sweeps also find pᵀAp as [`System`] does, a sum of non-negative terms, and r = g + L P⁻¹g, which
//! the stopping rule asks for.
//!
//! Cost of an iteration: 47 flops per spring and 9 more for the form, 130 per particle; each spring is read twice. A row
//! waits for the one before it, so it takes as long as these waits on a host. Memory: 9 numbers per particle.
//!
//! Source: Eisenstat 1981, *Efficient implementation of a class of preconditioned conjugate gradient methods*.

use crate::bound::square;
use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::Real;
use crate::solver::pcg::Iteration;
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// h, l and L P⁻¹g of a row.
pub(crate) type Sums<T> = [Vec3<T>; 3];

/// E = D − P, by which the diagonal exceeds the pivots.
pub(crate) trait Excess<T> {
    /// E p of a row; P p is known.
    fn times(&self, row: usize, p: Vec3<T>, pivot_times_p: Vec3<T>) -> Vec3<T>;
}

/// The iteration with given pivots.
pub(crate) struct Eisenstat<'a, T, E> {
    /// P⁻¹
    pub(crate) inverse: &'a [[T; 6]],
    pub(crate) excess: E,
    pub(crate) sums: &'a mut [Sums<T>],
}

/// The first n of a list, which goes on behind them.
#[inline(always)]
fn first<'l, X>(list: &mut &'l [X], n: u32) -> &'l [X] {
    let (first, rest) = list.split_at_checked(n as usize).unwrap_or_default();
    *list = rest;
    first
}

/// The last n of a list, which ends before them.
#[inline(always)]
fn last<'l, X>(list: &mut &'l [X], n: u32) -> &'l [X] {
    let (rest, last) = list.split_at_checked(list.len().saturating_sub(n as usize)).unwrap_or_default();
    *list = rest;
    last
}

impl<T: Real, E: Excess<T>> Eisenstat<'_, T, E> {
    /// r ← g = P (P + L)⁻¹ r; answers gᵀP⁻¹g.
    #[inline(never)]
    fn eliminate<F: Force<T>>(&mut self, system: &System<'_, T, F>, r: &mut [Vec3<T>]) -> T {
        let matrix = system.matrix;
        let (mut others, mut hessians) = (matrix.other, &*matrix.hessian);
        for [_, l, _] in self.sums.iter_mut() {
            *l = [T::ZERO; 3];
        }
        let mut form = Lanes::new();
        for (row, ((own, r), inverse)) in matrix.own.iter().zip(r.iter_mut()).zip(self.inverse).enumerate() {
            let Some([_, l, _]) = self.sums.get(row) else { break };
            *r = vec3::add(*r, *l);
            let z = Sym3(*inverse).mul(*r);
            form.add(row, vec3::dot(*r, z));
            for (other, h) in first(&mut others, *own).iter().zip(first(&mut hessians, *own)) {
                if let Some([_, l, _]) = self.sums.get_mut(*other as usize) {
                    *l = vec3::add(*l, Hessian::unpack(*h).mul(z));
                }
            }
        }
        form.sum()
    }

    /// z = (P + Lᵀ)⁻¹ z.
    #[inline(never)]
    fn substitute<F: Force<T>>(&mut self, system: &System<'_, T, F>, z: &mut [Vec3<T>]) {
        let matrix = system.matrix;
        let (mut others, mut hessians) = (matrix.other, &*matrix.hessian);
        for (row, (own, inverse)) in matrix.own.iter().zip(self.inverse).enumerate().rev() {
            let Some(mut sum) = z.get(row).copied() else { continue };
            let springs = last(&mut others, *own).iter().zip(last(&mut hessians, *own));
            for (other, h) in springs.rev() {
                if let Some(z) = z.get(*other as usize) {
                    sum = vec3::add(sum, Hessian::unpack(*h).mul(*z));
                }
            }
            if let Some(z) = z.get_mut(row) {
                *z = Sym3(*inverse).mul(sum);
            }
        }
    }

    /// y = g + ratio y, p = (P + Lᵀ)⁻¹ y; answers pᵀAp.
    #[inline(never)]
    fn backward<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        ratio: T,
        g: &[Vec3<T>],
        y: &mut [Vec3<T>],
        p: &mut [Vec3<T>],
    ) -> T {
        let matrix = system.matrix;
        let (mut others, mut hessians) = (matrix.other, &*matrix.hessian);
        let mut form = Lanes::new();
        let rows = matrix.own.iter().zip(matrix.inertia.iter()).zip(self.inverse.iter().zip(self.sums.iter_mut()));
        for (row, (((own, m), (inverse, [h_sum, l, rest])), (g, y))) in rows.zip(g.iter().zip(y.iter_mut())).enumerate().rev() {
            let springs = last(&mut others, *own).iter().zip(last(&mut hessians, *own));
            let mut sum = [T::ZERO; 3];
            for (other, h) in springs.clone().rev() {
                if let Some(p) = p.get(*other as usize) {
                    sum = vec3::add(sum, Hessian::unpack(*h).mul(*p));
                }
            }
            *y = vec3::add_scaled(*g, ratio, *y);
            let own_p = Sym3(*inverse).mul(vec3::add(*y, sum));
            (*h_sum, *l, *rest) = (sum, [T::ZERO; 3], [T::ZERO; 3]);
            let mut energy = *m * vec3::dot(own_p, own_p);
            for (other, h) in springs {
                let delta = p.get(*other as usize).map_or(own_p, |p| vec3::sub(own_p, *p));
                energy += Hessian::unpack(*h).mul_and_form(delta).1;
            }
            form.add(row, energy);
            if let Some(p) = p.get_mut(row) {
                *p = own_p;
            }
        }
        system.each_point(|row, h| {
            if let Some(p) = p.get(row) {
                form.add(row, h.mul_and_form(*p).1);
            }
        });
        form.sum()
    }

    /// x += a p, g −= a P (P + L)⁻¹ A p; answers Σ|rᵢ|²/μᵢ and gᵀP⁻¹g.
    #[inline(never)]
    fn forward<F: Force<T>>(&mut self, system: &System<'_, T, F>, a: T, v: &mut Vectors<'_, T>) -> (T, T) {
        let matrix = system.matrix;
        let (mut others, mut hessians) = (matrix.other, &*matrix.hessian);
        let (mut beta, mut form) = (Lanes::new(), Lanes::new());
        let vectors = v.x.iter_mut().zip(v.r.iter_mut()).zip(v.p.iter().zip(v.y.iter()));
        let rows = matrix.own.iter().zip(self.inverse).zip(v.mu.iter());
        for (row, (((own, inverse), weight), ((x, g), (p, y)))) in rows.zip(vectors).enumerate() {
            let Some([h_sum, l, rest]) = self.sums.get(row).copied() else { break };
            let excess = self.excess.times(row, *p, vec3::add(*y, h_sum));
            let image = vec3::add(excess, l);
            let z = Sym3(*inverse).mul(vec3::sub(image, h_sum));
            *x = vec3::add_scaled(*x, a, *p);
            *g = vec3::add_scaled(*g, -a, vec3::add(*y, image));
            let g_over = Sym3(*inverse).mul(*g);
            form.add(row, vec3::dot(*g, g_over));
            beta.add(row, square(vec3::sub(*g, rest), *weight));
            for (other, h) in first(&mut others, *own).iter().zip(first(&mut hessians, *own)) {
                if let Some([_, l, rest]) = self.sums.get_mut(*other as usize) {
                    let h = Hessian::unpack(*h);
                    *l = vec3::add(*l, h.mul(z));
                    *rest = vec3::add(*rest, h.mul(g_over));
                }
            }
        }
        (beta.sum(), form.sum())
    }
}

impl<T: Real, E: Excess<T>> Iteration<T> for Eisenstat<'_, T, E> {
    #[inline(never)]
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        for y in v.y.iter_mut() {
            *y = [T::ZERO; 3];
        }
        let (mut rz, mut ratio) = (self.eliminate(system, v.r), T::ZERO);
        while *iterations < max_iterations {
            let curvature = self.backward(system, ratio, v.r, v.y, v.p);
            if !(curvature > T::ZERO) {
                return true;
            }
            let (beta, next) = self.forward(system, rz / curvature, v);
            *iterations += 1;
            if !(T::HALF * beta > target) {
                return false;
            }
            ratio = if rz > T::ZERO { next / rz } else { T::ZERO };
            rz = next;
        }
        false
    }

    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        for (y, r) in v.y.iter_mut().zip(v.r.iter()) {
            *y = vec3::add([T::ZERO; 3], *r);
        }
        self.eliminate(system, v.y);
        self.substitute(system, v.y);
    }
}
