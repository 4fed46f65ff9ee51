//! Eisenstat's trick: PCG with M = (P + L) P⁻¹ (P + Lᵀ) in two sweeps over the springs and no product.
//!
//! A = L + D + Lᵀ, D the 3×3 diagonal blocks and L what is below them ([`super::triangle`]). P is any block diagonal with
//! positive blocks: M = (P + L) P⁻¹ (P + L)ᵀ is then symmetric and positive, however P was come by. With E = D − P,
//!
//! A p = (P + L)(p + z),  (P + L) z = y + (E − P) p,  y = (P + Lᵀ) p,
//!
//! so where r ← r − a A p, its image g = P (P + L)⁻¹ r follows without A: g ← g − a P (p + z), and rᵀM⁻¹r = gᵀP⁻¹g. With
//! h = −Lᵀp and l = E p − L z an iteration is
//!
//! - rows descending: h = Σ H p_b over the row's own springs; y ← g + (ratio) y, p = P⁻¹(y + h), l = E p;
//! - rows ascending: z = P⁻¹(l − h), l_b += H z over the row's own springs; x += a p, g −= a (y + l).
//!
//! A row owns the springs to later rows, so that l has arrived in full when its row is reached.
//!
//! pᵀAp = pᵀ(y + E p − h) comes with the first sweep. It cancels where p is smooth; when √u of pᵀPp is all that is left of
//! it, it is summed anew as [`System::form`], a sum of non-negative terms. The stopping rule asks for the true r = g + L
//! P⁻¹g. That costs another sweep, so it is looked at where rᵀM⁻¹r promises that it is small enough, and every 8th time.
//!
//! Cost of an iteration: 34 flops per spring, as a product, and 99 per particle. Each spring is read twice. Memory: 6
//! numbers per particle.
//!
//! Source: Eisenstat 1981, *Efficient implementation of a class of preconditioned conjugate gradient methods*.

use crate::bound::{square, weighted};
use crate::force::Force;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::Real;
use crate::solver::pcg::Iteration;
use crate::solver::triangle::Springs;
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// h and l of a row.
pub(crate) type Sums<T> = [Vec3<T>; 2];

/// The true residual is looked at after so many iterations at the latest.
const LOOK: u32 = 8;

/// E = D − P, by which A's diagonal exceeds the pivots.
pub(crate) trait Excess<T> {
    /// E p of a row, of which P p is known.
    fn times(&self, row: usize, p: Vec3<T>, pivot_times_p: Vec3<T>) -> Vec3<T>;
}

/// The iteration with given pivots.
pub(crate) struct Eisenstat<'a, T, E> {
    /// P⁻¹
    pub(crate) inverse: &'a [[T; 6]],
    /// E
    pub(crate) excess: E,
    pub(crate) sums: &'a mut [Sums<T>],
}

/// l += H z
#[inline(always)]
fn add_to_l<T: Real>([_, l]: &mut Sums<T>, product: Vec3<T>) {
    *l = vec3::add(*l, product);
}

impl<T: Real, E: Excess<T>> Eisenstat<'_, T, E> {
    /// z = M⁻¹ r; answers rᵀz.
    pub(crate) fn apply<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        r: &[Vec3<T>],
        z: &mut [Vec3<T>],
    ) -> T {
        for (z, r) in z.iter_mut().zip(r) {
            // r itself; but the sum is not taken for a copy, for which a library routine would be linked.
            *z = vec3::add([T::ZERO; 3], *r);
        }
        let rz = self.eliminate(system, z);
        self.substitute(system, z);
        rz
    }

    /// r ← g = P (P + L)⁻¹ r; answers gᵀP⁻¹g.
    #[inline(never)] // As all sweeps: one copy, with a frame of its own.
    fn eliminate<F: Force<T>>(&mut self, system: &System<'_, T, F>, r: &mut [Vec3<T>]) -> T {
        self.sums.fill([[T::ZERO; 3]; 2]);
        let mut springs = Springs::of(system.matrix);
        let mut form = Lanes::new();
        let rows = system.matrix.own.iter().zip(self.inverse).zip(r);
        for (row, ((own, inverse), r)) in rows.enumerate() {
            let Some([_, l]) = self.sums.get(row) else { break };
            *r = vec3::add(*r, *l);
            let z = Sym3(*inverse).mul(*r);
            springs.first(*own).scatter(z, self.sums, add_to_l);
            form.add(row, vec3::dot(*r, z));
        }
        form.sum()
    }

    /// z ← (P + Lᵀ)⁻¹ z.
    #[inline(never)]
    fn substitute<F: Force<T>>(&self, system: &System<'_, T, F>, z: &mut [Vec3<T>]) {
        let mut springs = Springs::of(system.matrix);
        for (row, (own, inverse)) in system.matrix.own.iter().zip(self.inverse).enumerate().rev() {
            let h = springs.last(*own).gather(z);
            if let Some(z) = z.get_mut(row) {
                *z = Sym3(*inverse).mul(vec3::add(*z, h));
            }
        }
    }

    /// y ← g + ratio y, p = (P + Lᵀ)⁻¹ y, h, and of l what the row itself has; answers pᵀAp and pᵀPp.
    #[inline(never)]
    fn descend<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        ratio: T,
        v: &mut Vectors<'_, T>,
    ) -> [T; 2] {
        let mut springs = Springs::of(system.matrix);
        let (mut form, mut size) = (Lanes::new(), Lanes::new());
        let rows = system.matrix.own.iter().zip(self.inverse).zip(self.sums.iter_mut());
        for (row, (((own, inverse), sums), (g, y))) in
            rows.zip(v.r.iter().zip(v.y.iter_mut())).enumerate().rev()
        {
            let h = springs.last(*own).gather(v.p);
            *y = vec3::add_scaled(*g, ratio, *y);
            let image = vec3::add(*y, h);
            let p = Sym3(*inverse).mul(image);
            let l = self.excess.times(row, p, image);
            form.add(row, vec3::dot(p, vec3::add(*y, vec3::sub(l, h))));
            size.add(row, vec3::dot(p, image));
            *sums = [h, l];
            if let Some(place) = v.p.get_mut(row) {
                *place = p;
            }
        }
        [form.sum(), size.sum()]
    }

    /// x += a p, g −= a P (P + L)⁻¹ A p; answers gᵀP⁻¹g.
    #[inline(never)]
    fn ascend<F: Force<T>>(&mut self, system: &System<'_, T, F>, a: T, v: &mut Vectors<'_, T>) -> T {
        let mut springs = Springs::of(system.matrix);
        let mut form = Lanes::new();
        let vectors = v.x.iter_mut().zip(v.r.iter_mut()).zip(v.p.iter().zip(v.y.iter()));
        let rows = system.matrix.own.iter().zip(self.inverse).zip(vectors);
        for (row, ((own, inverse), ((x, g), (p, y)))) in rows.enumerate() {
            let Some([h, l]) = self.sums.get(row).copied() else { break };
            // What later rows wait for comes first.
            let z = Sym3(*inverse).mul(vec3::sub(l, h));
            springs.first(*own).scatter(z, self.sums, add_to_l);
            *x = vec3::add_scaled(*x, a, *p);
            *g = vec3::add_scaled(*g, -a, vec3::add(*y, l));
            form.add(row, vec3::dot(*g, Sym3(*inverse).mul(*g)));
        }
        form.sum()
    }

    /// ½ Σ|rᵢ|²/μᵢ of r = g + L P⁻¹ g.
    #[inline(never)]
    fn look<F: Force<T>>(&mut self, system: &System<'_, T, F>, g: &[Vec3<T>], weight: &[T]) -> T {
        self.sums.fill([[T::ZERO; 3]; 2]);
        let mut springs = Springs::of(system.matrix);
        let mut beta = Lanes::new();
        let rows = system.matrix.own.iter().zip(self.inverse).zip(g.iter().zip(weight));
        for (row, ((own, inverse), (g, weight))) in rows.enumerate() {
            let Some([_, l]) = self.sums.get(row) else { break };
            beta.add(row, square(vec3::sub(*g, *l), *weight));
            springs.first(*own).scatter(Sym3(*inverse).mul(*g), self.sums, add_to_l);
        }
        T::HALF * beta.sum()
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
        v.y.fill([T::ZERO; 3]);
        let beta = weighted(v.r, v.mu);
        let (mut rz, mut ratio) = (self.eliminate(system, v.r), T::ZERO);
        // β is taken for this many times rᵀM⁻¹r until it is looked at.
        let (mut scale, mut unseen) = (beta / rz, 0);
        let root = T::UNIT_ROUNDOFF.sqrt();
        while *iterations < max_iterations {
            let [form, size] = self.descend(system, ratio, v);
            let curvature = if form > root * size { form } else { system.form(v.p) };
            if !(curvature > T::ZERO) {
                return true;
            }
            let next = self.ascend(system, rz / curvature, v);
            (*iterations, unseen) = (*iterations + 1, unseen + 1);
            if unseen == LOOK || !(scale * next > T::TWO * target) {
                let beta = self.look(system, v.r, v.mu);
                if !(beta > target) {
                    return false;
                }
                (scale, unseen) = (beta / next, 0);
            }
            ratio = if rz > T::ZERO { next / rz } else { T::ZERO };
            rz = next;
        }
        false
    }

    fn precondition<F: Force<T>>(&mut self, system: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        self.apply(system, v.r, v.y);
    }
}
