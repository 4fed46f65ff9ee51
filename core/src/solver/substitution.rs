//! x ← A⁻¹ x with a sparse factor: supernode by supernode, each on a dense copy of its rows.
//!
//! Forwards: x_k is what is left, and the rows below lose W_k S_k⁻¹ x_k. Backwards: x_k ← S_k⁻¹ (x_k − W_kᵀ x). Sums over
//! rows run in eight lanes as all sums do ([`crate::lanes`]).
//!
//! Cost: 36 flops per block of the factor, which is read twice; that is most of it.

use crate::lanes::Lanes;
use crate::real::Real;
use crate::solver::panel::{below, first, three};
use crate::solver::supernodes::{Node, Supernodes};
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};

type Parts<'s, T> = (&'s mut [Vec3<T>], &'s mut [Vec3<T>], &'s [T], &'s [[T; 6]]);

impl<T: Real> Supernodes<'_, T> {
    /// `vector` ← A⁻¹ `vector`, in elimination order.
    #[inline(always)]
    pub(crate) fn substitute(&mut self) {
        let supers = self.head.len();
        for s in 0..supers {
            let node = Node::new(&self.lists, s);
            let Some((vector, rows, columns, pivots)) = self.begin(&node) else { return };
            for (k, (column, pivot)) in columns.chunks_exact(node.length()).zip(pivots).enumerate() {
                let (Some(w), Some((x, rest))) =
                    (three(column), rows.get_mut(k..).and_then(<[_]>::split_first_mut))
                else {
                    return;
                };
                take(rest.as_flattened_mut(), below(w, k + 1), Sym3(*pivot).mul(*x));
            }
            for (row, position) in rows.iter().zip(node.rows) {
                if let Some(to) = vector.get_mut(*position as usize) {
                    *to = *row;
                }
            }
        }
        for s in (0..supers).rev() {
            let node = Node::new(&self.lists, s);
            let Some((vector, rows, columns, pivots)) = self.begin(&node) else { return };
            let mut k = pivots.len();
            while let Some(last) = k.checked_sub(1) {
                let column = |k: usize| {
                    columns
                        .get(k.saturating_mul(node.length())..)
                        .and_then(|c| three(c.get(..node.length())?))
                };
                let (Some(w), Some(pivot), Some((front, rest))) =
                    (column(last), pivots.get(last), rows.split_at_mut_checked(k))
                else {
                    return;
                };
                let w = below(w, k);
                let rest = rest.as_flattened();
                // Two block columns read the rows once, if there are two.
                let Some((before, pivot_before)) =
                    last.checked_sub(1).and_then(|b| Some((column(b)?, pivots.get(b)?)))
                else {
                    if let Some(x) = front.last_mut() {
                        let [sum] = along(rest, [w]);
                        *x = Sym3(*pivot).mul(vec3::sub(*x, sum));
                    }
                    break;
                };
                let [sum, sum_before] = along(rest, [w, below(before, k)]);
                if let [.., y, x] = front {
                    *x = Sym3(*pivot).mul(vec3::sub(*x, sum));
                    let [a, b, c] = first(below(before, last));
                    let own = [
                        vec3::dot([a[0], b[0], c[0]], *x),
                        vec3::dot([a[1], b[1], c[1]], *x),
                        vec3::dot([a[2], b[2], c[2]], *x),
                    ];
                    *y = Sym3(*pivot_before).mul(vec3::sub(vec3::sub(*y, sum_before), own));
                }
                k = last.saturating_sub(1);
            }
            let own = vector.get_mut(node.first..node.end).unwrap_or_default();
            for (to, row) in own.iter_mut().zip(rows.iter()) {
                *to = *row;
            }
        }
    }

    /// The vector, a supernode's rows of it side by side, its columns and its pivots.
    #[inline(always)]
    fn begin(&mut self, node: &Node<'_>) -> Option<Parts<'_, T>> {
        let rows = self.update.as_chunks_mut().0.get_mut(..node.rows.len())?;
        for (row, position) in rows.iter_mut().zip(node.rows) {
            *row = self.vector.get(*position as usize).copied().unwrap_or([T::ZERO; 3]);
        }
        let columns = self.panels.get(node.from..node.to).unwrap_or_default();
        let pivots = self.pivots.get(node.first..node.end).unwrap_or_default();
        Some((&mut *self.vector, rows, columns, pivots))
    }
}

/// x −= W v
#[inline(always)]
fn take<T: Real>(x: &mut [T], [a, b, c]: [&[T]; 3], v: Vec3<T>) {
    for (((x, a), b), c) in x.iter_mut().zip(a).zip(b).zip(c) {
        *x -= (*a * v[0] + *b * v[1]) + *c * v[2];
    }
}

/// Wᵀ x for B block columns.
#[inline(always)]
fn along<T: Real, const B: usize>(x: &[T], columns: [[&[T]; 3]; B]) -> [Vec3<T>; B] {
    let (eights, rest) = x.as_chunks::<8>();
    let mut sums = [[Lanes::new(); 3]; B];
    for (k, x) in eights.iter().enumerate() {
        for (sums, columns) in sums.iter_mut().zip(&columns) {
            for (sum, w) in sums.iter_mut().zip(columns) {
                sum.add_lane(products(w.as_chunks().0.get(k).unwrap_or(T::ZEROS), x));
            }
        }
    }
    let done = 8 * eights.len();
    for (i, x) in rest.iter().enumerate() {
        for (sums, columns) in sums.iter_mut().zip(&columns) {
            for (sum, w) in sums.iter_mut().zip(columns) {
                sum.add(i, w.get(done + i).copied().unwrap_or(T::ZERO) * *x);
            }
        }
    }
    sums.map(|sums| sums.map(Lanes::sum))
}

#[inline(always)]
fn products<T: Real>(a: &[T; 8], x: &[T; 8]) -> [T; 8] {
    let mut products = *a;
    for (a, x) in products.iter_mut().zip(x) {
        *a = *a * *x;
    }
    products
}
