//! A matrix in lanes brought down to f32, and block-Jacobi PCG with it ([`crate::SingleJacobi`]).

use crate::force::Force;
use crate::hessian::Hessian;
use crate::real::{Real, to};
use crate::solver::refinement::{Group, Refinement, Refines, refine};
use crate::sym3::Sym3;
use crate::vec3;
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::{Eight, Planes, WIDTH, all, load};
use crate::wide::gather::Matrix;
use crate::wide::jacobi::{self, Progress, Until};
use crate::wide::layout::Layout;
use crate::wide::slots::NUMBERS;
use crate::wide::solve::{Preconditioner, Widened};
use crate::wide::sweep;
use crate::wide::work::{Front, Iterates, hessians_of};

/// Numbers of a layout.
pub(crate) fn needs(layout: &Layout) -> usize {
    // m̃, 1/μ; x, r, p, y; D⁻¹
    (1 + 1 + 12 + 6) * layout.plane() + hessians_of(layout)
}

/// A/σ in f32, σ its largest mass or stiffness of a spring, and what the iterations work in.
pub(crate) struct InSingle<'a, T> {
    inertia: &'a mut [f32],
    weight: &'a mut [f32],
    hessians: &'a mut [f32],
    work: Iterates<'a, f32>,
    progress: Progress<f32>,
    /// 1/σ and 1/√σ
    scale: [T; 2],
}

/// A point spring's H divided by σ.
#[inline(always)]
fn lowered<T: Real>([scale, root]: [T; 2]) -> impl Fn(Hessian<T>) -> Hessian<f32> {
    #[inline(always)]
    move |h| Hessian { alpha: to(h.alpha * scale), w: h.w.map(|w| to(w * root)) }
}

impl<'a, T: Real> InSingle<'a, T> {
    pub(crate) fn cut<F: Force<T>, D: Dispatch>(
        numbers: &'a mut [f32],
        of: &Widened<'_, '_, T, F, D>,
    ) -> Option<Self> {
        let Widened { layout, way, front, system, dispatch, .. } = of;
        let plane = layout.plane();
        let (inertia, rest) = numbers.split_at_mut_checked(plane)?;
        let (weight, rest) = rest.split_at_mut_checked(plane)?;
        let (hessians, behind) = rest.split_at_mut_checked(hessians_of(layout))?;
        let mut work = Iterates::cut(behind, layout)?;
        let scale = T::ONE / of.largest();
        let scale = [scale, scale.sqrt()];
        dispatch.run(
            #[inline(always)]
            || lower(layout, front, scale, inertia, hessians),
        );
        let matrix = Matrix { layout, way: *way, hessians, inertia };
        jacobi::invert(matrix, &mut work.inverse, system, &lowered(scale), *dispatch);
        let progress = Progress { beta: 0.0, next: 0.0, rz: 0.0 };
        Some(Self { inertia, weight, hessians, work, progress, scale })
    }
}

/// m̃/σ, α/σ and w/√σ in f32.
#[inline(always)]
fn lower<T: Real>(
    layout: &Layout,
    front: &Front<'_, T>,
    [scale, root]: [T; 2],
    inertia: &mut [f32],
    hessians: &mut [f32],
) {
    scaled(front.inertia, scale, inertia);
    // α and the components of w lie a plane apart in runs, eight numbers in slots.
    let by = |k: usize| if k.is_multiple_of(NUMBERS_OF_ONE) { scale } else { root };
    if layout.slots.is_some() {
        let parts = front.hessians.as_chunks::<WIDTH>().0.iter().zip(hessians.as_chunks_mut::<WIDTH>().0);
        for (k, (from, into)) in parts.enumerate() {
            scaled(from, by(k), into);
        }
        return;
    }
    let plane = layout.plane();
    for k in 0..NUMBERS_OF_ONE * layout.runs {
        let from = front.hessians.get(k * plane..).unwrap_or_default();
        let into = hessians.get_mut(k * plane..).unwrap_or_default();
        scaled(from.get(..plane).unwrap_or_default(), by(k), into);
    }
}

/// α and w
const NUMBERS_OF_ONE: usize = NUMBERS / WIDTH;

#[inline(always)]
fn scaled<T: Real>(from: &[T], by: T, into: &mut [f32]) {
    for (into, from) in into.iter_mut().zip(from) {
        *into = to(*from * by);
    }
}

/// Iterations that may pass until Σ|rᵢ|²/μᵢ is halved: f32 that has lost its way comes down slowly or not at all. Where it is still
/// on it, a cloth of N×N waits for 0.9 N of them at most (measured, N = 32 to 256, dt 1/60 and 1/1000), about as long as a change
/// takes from one end to the other.
fn patience(places: usize) -> u32 {
    32 + 2 * places.isqrt() as u32
}

/// What iterates, and the scene's vectors.
struct Refined<'r, 'a, 'w, 's, T, F, D> {
    single: &'r mut InSingle<'a, T>,
    of: &'r mut Widened<'s, 'w, T, F, D>,
}

impl<T: Real, F: Force<T>, D: Dispatch> Refines<T> for Refined<'_, '_, '_, '_, T, F, D> {
    #[inline(always)]
    fn scale(&self) -> T {
        let [scale, _] = self.single.scale;
        scale
    }
    #[inline(always)]
    fn most(&mut self) -> T {
        sweep::most(self.of.layout, &self.of.work.r)
    }
    #[inline(always)]
    fn heaviest(&mut self) -> T {
        self.of.heaviest()
    }
    #[inline(always)]
    fn begin(&mut self, lighter: T) {
        scaled(self.of.front.mu, lighter, self.single.weight);
        clear(self.of.layout, &mut self.single.work.p);
        self.single.progress.rz = 0.0;
    }
    #[inline(always)]
    fn residual(&mut self, down: T) -> f32 {
        let InSingle { work, weight, progress, .. } = &mut *self.single;
        for (to, from) in work.r.0.iter_mut().zip(&self.of.work.r.0) {
            scaled(from, down, to);
        }
        clear(self.of.layout, &mut work.x);
        clear(self.of.layout, &mut work.y);
        // No step to make yet: this finds z.
        (progress.beta, progress.next) = sweep::sweep(self.of.layout, work, weight, 0.0);
        progress.beta
    }
    #[inline(always)]
    fn iterate(&mut self, group: Group, rz: &mut f32, iterations: &mut u32) -> (f32, bool) {
        let Widened { layout, way, system, .. } = &*self.of;
        let InSingle { inertia, weight, hessians, work, progress, scale, .. } = &mut *self.single;
        let matrix = Matrix { layout, way: *way, hessians, inertia };
        progress.rz = *rz;
        let Group { goal, max_iterations, .. } = group;
        let until = Until { target: 0.5 * goal, max_iterations, patience: patience(layout.places) };
        let points = (system, &lowered(*scale));
        let broken = jacobi::iterate(matrix, (work, weight), points, progress, until, iterations);
        *rz = progress.rz;
        (progress.beta, broken)
    }
    #[inline(always)]
    fn hand_out(&mut self, up: T) {
        let (layout, to) = (self.of.layout, &mut self.of.work);
        for at in layout.tiles() {
            let change = self.single.work.x.load(at).map(
                #[inline(always)]
                |c| raised(c, up),
            );
            let moved = vec3::add(to.x.load(at), change);
            to.y.store(at, change);
            to.x.store(at, moved);
        }
    }
    #[inline(always)]
    fn renew(&mut self) {
        self.of.renew();
    }
    #[inline(always)]
    fn forget(&mut self) {
        clear(self.of.layout, &mut self.single.work.p);
    }
}

#[inline(always)]
fn clear(layout: &Layout, planes: &mut Planes<'_, f32>) {
    for at in layout.tiles() {
        planes.store(at, [all(0.0); 3]);
    }
}

/// x · up in the scene's precision.
#[inline(always)]
fn raised<T: Real>(x: Eight<f32>, up: T) -> Eight<T> {
    let mut out = all(T::ZERO);
    for (out, x) in out.0.iter_mut().zip(x.0) {
        *out = up * to(x);
    }
    out
}

impl<T: Real> Preconditioner<T> for InSingle<'_, T> {
    #[inline(never)]
    fn iterate<F: Force<T>, D: Dispatch>(
        &mut self,
        of: &mut Widened<'_, '_, T, F, D>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        let dispatch = of.dispatch;
        dispatch.run(
            #[inline(always)]
            || {
                let mut refined = Refined { single: self, of };
                refine(&mut refined, target, max_iterations, iterations) == Refinement::Broken
            },
        )
    }

    /// With D⁻¹ of f32, which is near enough for any z.
    #[inline(never)]
    fn apply<F: Force<T>, D: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, D>) {
        let Widened { layout, work, dispatch, .. } = of;
        let [scale, _] = self.scale;
        dispatch.run(
            #[inline(always)]
            || {
                for at in layout.tiles() {
                    let inverse = self.work.inverse.each_ref().map(
                        #[inline(always)]
                        |plane| raised(load(plane, at), scale),
                    );
                    let z = Sym3(inverse).mul(work.r.load(at));
                    work.y.store(at, z);
                }
            },
        );
    }
}
