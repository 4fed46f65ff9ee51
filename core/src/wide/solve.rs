//! A certified solve in lanes: what [`crate::solver::pcg::drive`] asks for, on planes.

use crate::bound::gain_by_form;
use crate::force::Force;
use crate::hessian::Hessian;
use crate::lanes::Lanes as Sums;
use crate::real::{Real, larger};
use crate::report::Solve;
use crate::solver::{Stop, pcg};
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::{Planes, all, load, store, where_positive};
use crate::wide::gather::Matrix;
use crate::wide::jacobi::same;
use crate::wide::layout::Layout;
use crate::wide::neighbours::Way;
use crate::wide::work::{Front, Iterates};
use crate::wide::{bound, jacobi, product, sweep};

/// One island in lanes, assembled; opaque.
pub struct Widened<'s, 'a, T, F, D> {
    pub(crate) layout: &'s Layout,
    pub(crate) way: Way<'s>,
    pub(crate) front: Front<'a, T>,
    pub(crate) work: Iterates<'a, T>,
    pub(crate) system: System<'s, T, F>,
    pub(crate) dispatch: D,
    /// Nothing holds this island
    pub(crate) free: bool,
}

impl<T: Real, F: Force<T>, D: Dispatch> Widened<'_, '_, T, F, D> {
    /// D⁻¹ into the work.
    pub(crate) fn invert_diagonal(&mut self) {
        let Self { layout, way, front, work, system, dispatch, .. } = self;
        let Front { inertia, hessians, .. } = &*front;
        let matrix = Matrix { layout, way: *way, hessians, inertia };
        jacobi::invert(matrix, &mut work.inverse, system, &same, *dispatch);
    }

    /// The largest 1/μ.
    #[inline(always)]
    pub(crate) fn heaviest(&mut self) -> T {
        let mut most = all(T::ZERO);
        for at in self.layout.tiles() {
            most = sweep::larger_lanes(most, load(self.front.mu, at));
        }
        most.0.iter().fold(T::ZERO, |most, x| larger(most, *x))
    }

    /// r −= A y; p is spoilt.
    #[inline(always)]
    pub(crate) fn renew(&mut self) {
        let Self { layout, way, front, work, system, dispatch, .. } = self;
        dispatch.run(
            #[inline(always)]
            || {
                let Iterates { r, p, y, .. } = &mut *work;
                let (hessians, inertia) = (&*front.hessians, &*front.inertia);
                product::over_runs(Matrix { layout, way: *way, hessians, inertia }, y, p);
                each_point(
                    system,
                    way,
                    #[inline(always)]
                    |at, h| p.put(at, vec3::add(p.row(at), h.mul(y.row(at)))),
                );
                for at in layout.tiles() {
                    let left = vec3::sub(r.load(at), p.load(at));
                    r.store(at, left);
                }
            },
        );
    }

    /// Solves it; the answer goes to `x`.
    pub(crate) fn solve(
        self,
        preconditioner: impl Preconditioner<T>,
        x: &mut [Vec3<T>],
        stop: &Stop<T>,
    ) -> Solve<T> {
        let free = self.free;
        let mut lanes = self.preconditioned(preconditioner);
        let solve = pcg::drive(&mut lanes, stop, free);
        lanes.hand_out(x);
        solve
    }
}

impl<'s, 'a, T: Real, F: Force<T>, D: Dispatch> Widened<'s, 'a, T, F, D> {
    /// With what preconditions it.
    pub(crate) fn preconditioned<P: Preconditioner<T>>(self, preconditioner: P) -> Lanes<'s, 'a, T, F, D, P> {
        Lanes { of: self, preconditioner }
    }
}

impl<T: Real, F: Force<T>, D: Dispatch, P> Lanes<'_, '_, T, F, D, P> {
    /// The answer to `x`, row by row.
    pub(crate) fn hand_out(&self, x: &mut [Vec3<T>]) {
        for (row, (x, particle)) in x.iter_mut().zip(self.of.system.matrix.rows.particle).enumerate() {
            *x = self.of.work.x.row(self.of.way.place(row, *particle));
        }
    }
}

/// The same with what preconditions it.
pub(crate) struct Lanes<'s, 'a, T, F, D, P> {
    pub(crate) of: Widened<'s, 'a, T, F, D>,
    preconditioner: P,
}

/// z = B r ≈ A⁻¹ r in lanes, and the iterations with it.
pub(crate) trait Preconditioner<T: Real> {
    /// See [`pcg::Iterates::iterate`].
    fn iterate<F: Force<T>, D: Dispatch>(
        &mut self,
        of: &mut Widened<'_, '_, T, F, D>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool;
    /// y = z, B r or near it: for the lower bound, which takes any z.
    fn apply<F: Force<T>, D: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, D>);
    /// See [`pcg::Iterates::fall_back`].
    #[inline(always)]
    fn fall_back<F: Force<T>, D: Dispatch>(&mut self, _: &mut Widened<'_, '_, T, F, D>) -> bool {
        false
    }
}

/// The point springs: place and H of each.
#[inline(always)]
pub(crate) fn each_point<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    way: &Way<'_>,
    mut visit: impl FnMut(usize, Hessian<T>),
) {
    system.each_point(
        #[inline(always)]
        |row, h| {
            if let Some(particle) = system.matrix.rows.particle.get(row) {
                visit(way.place(row, *particle), h);
            }
        },
    );
}

/// r = b − A x with δ; answers Σ|rᵢ|²/μᵢ.
#[inline(always)]
fn residual<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    matrix: Matrix<'_, T>,
    weight: &[T],
    [b, x]: [&Planes<'_, T>; 2],
    [r, error]: [&mut Planes<'_, T>; 2],
) -> T {
    bound::product(matrix, x, r, error);
    each_point(
        system,
        &matrix.way,
        #[inline(always)]
        |at, h| {
            let (d, y) = (x.row(at), r.row(at));
            let (y, rounding) = (vec3::add(y, h.mul(d)), crate::bound::term_error(&h, d));
            r.put(at, y);
            let g = vec3::add(vec3::add(error.row(at), vec3::map(y, T::abs)), rounding);
            error.put(at, g);
        },
    );
    bound::finish(matrix.layout, b, weight, r, error)
}

impl<T: Real, F: Force<T>, D: Dispatch, P: Preconditioner<T>> pcg::Iterates<T> for Lanes<'_, '_, T, F, D, P> {
    fn start(&mut self) -> bool {
        let Widened { layout, front, work, dispatch, .. } = &mut self.of;
        dispatch.run(
            #[inline(always)]
            || {
                let mut something = all(T::ZERO);
                for at in layout.tiles() {
                    let m = load(front.inertia, at);
                    let weight = m.positive_then(all(T::ONE) / load(front.mu, at));
                    store(front.mu, at, weight);
                    let (b, zero) = (front.b.load(at), [all(T::ZERO); 3]);
                    work.r.store(at, b);
                    for planes in [&mut work.x, &mut work.p] {
                        planes.store(at, zero);
                    }
                    for b in b {
                        something = something.zip(
                            b,
                            #[inline(always)]
                            |sum, b| if b == T::ZERO { sum } else { T::ONE },
                        );
                    }
                }
                !something.any(
                    #[inline(always)]
                    |b| b != T::ZERO,
                )
            },
        )
    }

    fn beta(&mut self) -> T {
        let Widened { layout, front, work, dispatch, .. } = &mut self.of;
        dispatch.run(
            #[inline(always)]
            || bound::weighted(layout, &work.r, front.mu),
        )
    }

    fn check(&mut self, free: bool) -> T {
        let Widened { layout, way, front, work, system, dispatch, .. } = &mut self.of;
        let Front { b, inertia, mu, hessians, .. } = front;
        dispatch.run(
            #[inline(always)]
            || {
                if free {
                    keep_momentum(layout, inertia, b, &mut work.x);
                }
                let Iterates { x, r, p, .. } = work;
                T::HALF
                    * residual(system, Matrix { layout, way: *way, hessians, inertia }, mu, [b, x], [r, p])
            },
        )
    }

    fn rounding(&mut self) -> T {
        bound::weighted(self.of.layout, &self.of.work.p, self.of.front.mu)
    }

    #[cold]
    fn attainable(&mut self, updates: u32) -> T {
        let Widened { layout, way, front, work, system, .. } = &mut self.of;
        let Iterates { x, p, y, .. } = work;
        let (hessians, inertia) = (&*front.hessians, &*front.inertia);
        bound::attainable(Matrix { layout, way: *way, hessians, inertia }, x, y);
        each_point(system, way, |at, h| {
            let most = h.alpha.abs() + vec3::dot(h.w, h.w);
            y.put(at, vec3::add_scaled(y.row(at), most, vec3::map(x.row(at), T::abs)));
        });
        let unit = all(T::from_count(updates as usize) * T::UNIT_ROUNDOFF);
        for at in layout.tiles() {
            let size = vec3::add_scaled(p.load(at), unit, y.load(at));
            y.store(at, size);
        }
        let beta = bound::weighted(layout, y, front.mu);
        y.clear_margins(layout.pad, layout.behind);
        beta
    }

    fn iterate(&mut self, target: T, max_iterations: u32, iterations: &mut u32) -> bool {
        self.preconditioner.iterate(&mut self.of, target, max_iterations, iterations)
    }

    fn fall_back(&mut self) -> bool {
        self.preconditioner.fall_back(&mut self.of)
    }

    fn upper(&mut self) -> T {
        let Widened { layout, front, work, dispatch, .. } = &mut self.of;
        dispatch.run(
            #[inline(always)]
            || bound::upper(layout, &work.r, &work.p, front.mu),
        )
    }

    fn lower(&mut self) -> T {
        self.preconditioner.apply(&mut self.of);
        let Widened { layout, way, front, work, system, dispatch, .. } = &mut self.of;
        let (hessians, inertia) = (&*front.hessians, &*front.inertia);
        let Iterates { r, p, y, .. } = work;
        let (of_r, [mut form, mut size]) = dispatch.run(
            #[inline(always)]
            || {
                let matrix = Matrix { layout, way: *way, hessians, inertia };
                (bound::products(layout, r, p, y), bound::form(matrix, y))
            },
        );
        let mut points = 0;
        each_point(system, way, |at, h| {
            points += 1;
            let [energy, most] = bound::form_of_point(&h, y.row(at));
            form.add(at, energy);
            size.add(at, most);
        });
        let terms = layout.places + layout.springs + points;
        gain_by_form(layout.places, of_r, terms, [form.sum(), size.sum()])
    }
}

/// x += c with c = Σ(b − m̃x)/Σm̃: see [`crate::solver::pcg`].
#[inline(always)]
fn keep_momentum<T: Real>(layout: &Layout, inertia: &[T], b: &Planes<'_, T>, x: &mut Planes<'_, T>) {
    let mut missing = [Sums::new(), Sums::new(), Sums::new()];
    let mut mass = Sums::new();
    for at in layout.tiles() {
        let m = load(inertia, at);
        let left = vec3::add_scaled(b.load(at), -m, x.load(at));
        for (sum, left) in missing.iter_mut().zip(left) {
            sum.add_lane(left.0);
        }
        mass.add_lane(m.0);
    }
    let mass = mass.sum();
    if mass > T::ZERO {
        let [a, b, c] = missing;
        let (a, b, c) = (a.sum(), b.sum(), c.sum());
        let c: Vec3<T> = vec3::scale(T::ONE / mass, [a, b, c]);
        for at in layout.tiles() {
            let m = load(inertia, at);
            let [a, b, c] = c;
            let moved = vec3::add(x.load(at), where_positive(m, [all(a), all(b), all(c)]));
            x.store(at, moved);
        }
    }
}
