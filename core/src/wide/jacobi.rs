//! Block Jacobi in lanes: D⁻¹, and the iterations of [`crate::solver::pcg`] with it. The matrix and the vectors may be in another
//! precision than the scene, whose point springs are brought down to it.

use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3;
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::all;
use crate::wide::gather::Matrix;
use crate::wide::neighbours::either;
use crate::wide::solve::{Preconditioner, Widened, each_point};
use crate::wide::work::Iterates;
use crate::wide::{diagonal, product, sweep};

/// D⁻¹ of a matrix; `down` makes a point spring's H one of its numbers.
pub(crate) fn invert<T: Real, U: Real, F: Force<T>>(
    matrix: Matrix<'_, U>,
    inverse: &mut [&mut [U]; 6],
    system: &System<'_, T, F>,
    down: &impl Fn(Hessian<T>) -> Hessian<U>,
    dispatch: impl Dispatch,
) {
    let Matrix { layout, way, hessians, inertia } = matrix;
    dispatch.run(
        #[inline(always)]
        || either!(way, neighbours => diagonal::blocks(neighbours, layout, hessians, inertia, inverse)),
    );
    each_point(system, &way, |at, h| {
        let h = down(h);
        let added = Sym3::scalar(h.alpha).plus_outer(h.w).0;
        for (plane, added) in inverse.iter_mut().zip(added) {
            if let Some(entry) = plane.get_mut(at) {
                *entry += added;
            }
        }
    });
    dispatch.run(
        #[inline(always)]
        || diagonal::invert(layout, inertia, inverse),
    );
}

/// Where iterations are: Σ|rᵢ|²/μᵢ, rᵀz, and rᵀz of the iteration before, if p goes on from it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress<U> {
    pub(crate) beta: U,
    pub(crate) next: U,
    pub(crate) rz: U,
}

/// When iterations end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Until<U> {
    /// ½ Σ|rᵢ|²/μᵢ
    pub(crate) target: U,
    pub(crate) max_iterations: u32,
    /// At most so many without halving the least Σ|rᵢ|²/μᵢ so far
    pub(crate) patience: u32,
}

/// Iterates from x, r, p and y = z; answers whether it broke down (rᵀz or pᵀAp ≤ 0 or NaN) or patience came to its end.
#[inline(always)]
pub(crate) fn iterate<T: Real, U: Real, F: Force<T>>(
    matrix: Matrix<'_, U>,
    (work, weight): (&mut Iterates<'_, U>, &[U]),
    (system, down): (&System<'_, T, F>, &impl Fn(Hessian<T>) -> Hessian<U>),
    progress: &mut Progress<U>,
    until: Until<U>,
    iterations: &mut u32,
) -> bool {
    let Progress { beta, next, rz } = progress;
    let (mut best, mut since) = (*beta, 0);
    while U::HALF * *beta > until.target && *iterations < until.max_iterations {
        if !(*next > U::ZERO) || since >= until.patience {
            return true;
        }
        sweep::direction(matrix.layout, work, if *rz > U::ZERO { *next / *rz } else { U::ZERO });
        let Iterates { p, y, .. } = &mut *work;
        let mut form = product::over_runs(matrix, p, y);
        each_point(
            system,
            &matrix.way,
            #[inline(always)]
            |at, h| {
                let (product, energy) = down(h).mul_and_form(p.row(at));
                y.put(at, vec3::add(y.row(at), product));
                form.add(at, energy);
            },
        );
        let curvature = form.sum();
        if !(curvature > U::ZERO) {
            return true;
        }
        *rz = *next;
        *iterations += 1;
        (*beta, *next) = sweep::sweep(matrix.layout, work, weight, *next / curvature);
        (best, since) = if *beta < U::HALF * best { (*beta, 0) } else { (best, since + 1) };
    }
    false
}

/// A point spring's H as it is.
#[inline(always)]
pub(crate) fn same<T: Real>(h: Hessian<T>) -> Hessian<T> {
    h
}

/// D⁻¹, which lies in the work.
pub(crate) struct Diagonal;

impl<T: Real> Preconditioner<T> for Diagonal {
    #[inline(always)]
    fn iterate<F: Force<T>, D: Dispatch>(
        &mut self,
        of: &mut Widened<'_, '_, T, F, D>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        let Widened { layout, way, front, work, system, dispatch, .. } = of;
        dispatch.run(
            #[inline(always)]
            || {
                for at in layout.tiles() {
                    for planes in [&mut work.p, &mut work.y] {
                        planes.store(at, [all(T::ZERO); 3]);
                    }
                }
                let (hessians, inertia, weight) = (&*front.hessians, &*front.inertia, &*front.mu);
                let matrix = Matrix { layout, way: *way, hessians, inertia };
                // No step to make yet: this finds z.
                let (beta, next) = sweep::sweep(layout, work, weight, T::ZERO);
                let mut progress = Progress { beta, next, rz: T::ZERO };
                let until = Until { target, max_iterations, patience: u32::MAX };
                iterate(matrix, (work, weight), (system, &same), &mut progress, until, iterations)
            },
        )
    }

    #[inline(always)]
    fn apply<F: Force<T>, D: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, D>) {
        let Widened { layout, work, dispatch, .. } = of;
        dispatch.run(
            #[inline(always)]
            || sweep::precondition(layout, work),
        );
    }
}

/// A way to iterate, and block Jacobi in the scene's precision where that gets no nearer.
pub(crate) struct OrDiagonal<'p, P> {
    first: &'p mut P,
    /// So D⁻¹ lies in the work
    spent: bool,
}

impl<'p, P> OrDiagonal<'p, P> {
    #[inline(always)]
    pub(crate) const fn new(first: &'p mut P) -> Self {
        Self { first, spent: false }
    }
}

impl<T: Real, P: Preconditioner<T>> Preconditioner<T> for OrDiagonal<'_, P> {
    #[inline(always)]
    fn iterate<F: Force<T>, D: Dispatch>(
        &mut self,
        of: &mut Widened<'_, '_, T, F, D>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        if self.spent {
            Diagonal.iterate(of, target, max_iterations, iterations)
        } else {
            self.first.iterate(of, target, max_iterations, iterations)
        }
    }

    #[inline(always)]
    fn apply<F: Force<T>, D: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, D>) {
        if self.spent {
            Diagonal.apply(of);
        } else {
            self.first.apply(of);
        }
    }

    #[cold]
    fn fall_back<F: Force<T>, D: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, D>) -> bool {
        if self.spent {
            return false;
        }
        of.invert_diagonal();
        self.spent = true;
        true
    }
}
