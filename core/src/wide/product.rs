//! y = A x and xᵀA x in lanes ([`crate::wide::gather`]).
//!
//! Cost: 40 flops per spring and 9 for the form, 12 per row; 4 numbers per spring read twice (the second time from the cache).
//! Computing each spring once was slower: by a third if the terms wait in planes, by a sixth if they are subtracted below at
//! once.

use crate::hessian::Hessian;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, Planes, all, where_positive};
use crate::wide::gather::{Gather, Matrix, gather};

/// Where A x and xᵀA x go.
struct Product<'y, 'a, T> {
    y: &'y mut Planes<'a, T>,
    forms: Eight<T>,
}

impl<T: Real> Gather<T> for Product<'_, '_, T> {
    type Rows = (Vec3<Eight<T>>, Eight<T>);

    #[inline(always)]
    fn new() -> Self::Rows {
        ([all(T::ZERO); 3], all(T::ZERO))
    }
    #[inline(always)]
    fn above((sum, form): Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows {
        (vec3::add(sum, h.mul(apart)), form)
    }
    #[inline(always)]
    fn inertia((sum, _): Self::Rows, m: Eight<T>, here: Vec3<Eight<T>>) -> Self::Rows {
        (vec3::add_scaled(sum, m, here), m * vec3::dot(here, here))
    }
    #[inline(always)]
    fn own((sum, form): Self::Rows, h: Hessian<Eight<T>>, apart: Vec3<Eight<T>>) -> Self::Rows {
        let (product, more) = h.mul_and_form(apart);
        (vec3::add(sum, product), form + more)
    }
    #[inline(always)]
    fn put_down(&mut self, at: usize, (sum, _): Self::Rows) {
        self.y.store(at, sum);
    }
    #[inline(always)]
    fn take_up(&self, at: usize) -> Self::Rows {
        (self.y.load(at), all(T::ZERO))
    }
    #[inline(always)]
    fn finish(&mut self, at: usize, m: Eight<T>, (sum, form): Self::Rows) {
        self.y.store(at, where_positive(m, sum));
        self.forms = self.forms + form;
    }
}

/// y = A x over the runs; answers the partial sums of xᵀA x.
#[inline(always)]
pub(crate) fn over_runs<T: Real>(
    matrix: Matrix<'_, T>,
    x: &Planes<'_, T>,
    y: &mut Planes<'_, T>,
) -> Lanes<T> {
    let mut product = Product { y, forms: all(T::ZERO) };
    gather(matrix, x, &mut product);
    Lanes::of(product.forms.0)
}
