//! A chain solved directly in lanes: the factors of [`pieces`], refined and certified by the rules of
//! [`crate::solver::direct`] on planes; where they break down block-Jacobi PCG in lanes answers.

use crate::force::Force;
use crate::real::{Real, larger};
use crate::report::{Ending, Solve};
use crate::solver::Stop;
use crate::solver::pcg::{Iterates as _, drive};
use crate::vec3::{self, Vec3};
use crate::wide::bound;
use crate::wide::dispatch::Dispatch;
use crate::wide::eight::{all, load};
use crate::wide::gather::Matrix;
use crate::wide::jacobi::Diagonal;
use crate::wide::last_rows::{self, Last};
use crate::wide::piece_rows::{self, Rows};
use crate::wide::pieces;
use crate::wide::runs::Runs;
use crate::wide::solve::{Lanes, Widened, each_point};

/// Solves a chain; the answer goes to `x`.
pub(crate) fn solve<T: Real, F: Force<T>, D: Dispatch>(
    widened: Widened<'_, '_, T, F, D>,
    rows: &mut [Rows<T>],
    x: &mut [Vec3<T>],
    stop: &Stop<T>,
) -> Solve<T> {
    let free = widened.free;
    let mut lanes = widened.preconditioned(Diagonal);
    let solve = refine(&mut lanes, rows, stop, free);
    lanes.hand_out(x);
    solve
}

/// See [`crate::solver::direct::solve`].
#[inline(never)]
fn refine<T: Real, F: Force<T>, D: Dispatch>(
    lanes: &mut Lanes<'_, '_, T, F, D, Diagonal>,
    rows: &mut [Rows<T>],
    stop: &Stop<T>,
    free: bool,
) -> Solve<T> {
    if lanes.start() {
        let none = T::ZERO;
        return Solve { iterations: 0, upper: none, lower: none, ending: Ending::Untouched, fallback: false };
    }
    let mut from = lanes.beta();
    // No goal is relative to what has overflowed.
    let relative = if from.is_finite() { stop.relative * stop.relative * from } else { T::ZERO };
    let goal = larger(relative, stop.absolute);
    if free {
        from = lanes.check(true);
    }
    let untouched = from <= goal && from.is_finite();
    let mut ending = if untouched { Some(Ending::Untouched) } else { None };
    let joint = if untouched { None } else { factor(lanes, rows) };
    let mut sound = untouched || joint.is_some();
    let mut iterations = 0;
    while let (Some(joint), None) = (&joint, ending) {
        if iterations >= stop.max_iterations {
            ending = Some(Ending::Capped);
            break;
        }
        add_correction(lanes, rows, joint, iterations == 0);
        iterations += 1;
        let reached = lanes.check(free);
        if reached <= goal {
            ending = Some(Ending::Converged);
        } else if reached <= lanes.rounding() {
            ending = Some(Ending::Floor);
        } else if !(reached < T::HALF * from) {
            sound = reached <= lanes.attainable(iterations);
            ending = Some(Ending::Floor);
        }
        from = reached;
    }
    let Some(ending) = ending.filter(|_| sound) else {
        // Twice inverted, μ is off by two roundings: the bounds' cover has room for more.
        for mu in lanes.of.front.mu.iter_mut() {
            *mu = if *mu > T::ZERO { T::ONE / *mu } else { T::ZERO };
        }
        lanes.of.invert_diagonal();
        let left = Stop { max_iterations: stop.max_iterations.saturating_sub(iterations), ..*stop };
        let solve = drive(lanes, &left, free);
        return Solve { iterations: solve.iterations.saturating_add(iterations), fallback: true, ..solve };
    };
    let (upper, lower) = (lanes.upper(), lower(lanes));
    Solve { iterations, upper, lower, ending, fallback: false }
}

/// A's factors into the rows, and there what [`pieces::inwards`] makes of r; `None` if a pivot is not positive.
fn factor<T: Real, F: Force<T>, D: Dispatch>(
    lanes: &Lanes<'_, '_, T, F, D, Diagonal>,
    rows: &mut [Rows<T>],
) -> Option<Last<T>> {
    let Widened { layout, way, front, work, system, dispatch, .. } = &lanes.of;
    let (n, pad) = (layout.plane(), layout.pad);
    let [alpha, x, y, z] = [0, 1, 2, 3].map(|k| front.hessians.get(k * n..).unwrap_or_default());
    dispatch.run(
        #[inline(always)]
        || {
            piece_rows::spread([&*front.inertia], pad, rows, piece_rows::BLOCK);
            piece_rows::spread([alpha, x, y, z], pad, rows, piece_rows::COUPLING);
            piece_rows::spread(work.r.0.each_ref().map(|r| &**r), pad, rows, piece_rows::VECTOR);
        },
    );
    if system.points {
        piece_rows::clear(rows);
        each_point(system, way, |at, h| piece_rows::add_to_diagonal(rows, at.saturating_sub(pad), &h));
    }
    let before = pieces::before(rows, system.points)?;
    let taken = dispatch.run(
        #[inline(always)]
        || pieces::factor(rows, &before, system.points),
    )?;
    last_rows::join(rows, &taken)
}

/// x += A⁻¹ r
fn add_correction<T: Real, F: Force<T>, D: Dispatch>(
    lanes: &mut Lanes<'_, '_, T, F, D, Diagonal>,
    rows: &mut [Rows<T>],
    joint: &Last<T>,
    on_its_way: bool,
) {
    let Widened { layout, work, dispatch, .. } = &mut lanes.of;
    if !on_its_way {
        let taken = dispatch.run(
            #[inline(always)]
            || {
                piece_rows::spread(work.r.0.each_ref().map(|r| &**r), layout.pad, rows, piece_rows::VECTOR);
                pieces::inwards(rows)
            },
        );
        last_rows::hand_over(rows, &taken);
    }
    joint.solve(rows);
    dispatch.run(
        #[inline(always)]
        || {
            pieces::outwards(rows);
            piece_rows::put_back(rows, &mut work.y, layout.pad);
            for at in layout.tiles() {
                let x = vec3::add(work.x.load(at), work.y.load(at));
                work.x.store(at, x);
            }
        },
    );
}

/// ½ Σ (|rᵢ| − δᵢ)²₊/νᵢ, rounded down: see [`crate::solver::direct`]. What points add to ν goes into a plane of y.
fn lower<T: Real, F: Force<T>, D: Dispatch>(lanes: &mut Lanes<'_, '_, T, F, D, Diagonal>) -> T {
    let Widened { layout, way, front, work, system, dispatch, .. } = &mut lanes.of;
    let matrix = Matrix { layout, way: *way, hessians: front.hessians, inertia: front.inertia };
    let [added, ..] = &mut work.y.0;
    let mut points = 0_usize;
    if system.points {
        added.fill(T::ZERO);
    }
    each_point(system, way, |at, h| {
        points += 1;
        if let Some(nu) = added.get_mut(at) {
            *nu += larger(h.alpha, T::ZERO) + vec3::dot(h.w, h.w);
        }
    });
    let sum = dispatch.run(
        #[inline(always)]
        || {
            let (mut sum, neighbours) = (all(T::ZERO), Runs::new(layout, &[]));
            for at in layout.tiles() {
                let mut nu = bound::row_sum(neighbours, matrix, at);
                if points > 0 {
                    nu = nu + load(added, at);
                }
                let weight = load(matrix.inertia, at).positive_then(all(T::ONE) / nu);
                let beyond = bound::beyond(work.r.load(at), work.p.load(at));
                sum = sum + vec3::dot(vec3::scale(weight, beyond), beyond);
            }
            sum
        },
    );
    let sum = crate::lanes::Lanes::of(sum.0).sum();
    // The roundings of ν (of a row with all springs, at worst) and of the sum, twice over.
    let n = T::from_count(layout.springs + points + 3 * layout.places + 32);
    // Underflow rounds to nearest, up as well as down.
    let bound = T::HALF * sum * (T::ONE - T::TWO * n * T::UNIT_ROUNDOFF) - n * T::MIN_POSITIVE;
    if bound > T::ZERO { bound } else { T::ZERO }
}
