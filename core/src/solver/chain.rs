//! Block LDLᵀ of a chain (half bandwidth 1), from both ends at once: two recurrences that do not wait for each other, so
//! that a processor overlaps their divisions.
//!
//! With couplings −Cᵢ between rows i and i + 1 (Cᵢ = ΣH, symmetric) and m the middle row:
//!
//! S₀ = A₀₀, Sᵢ₊₁ = A − CᵢSᵢ⁻¹Cᵢ upwards to m; S_{n−1} = A, Sⱼ₋₁ = A − Cⱼ₋₁Sⱼ⁻¹Cⱼ₋₁ downwards to m, which takes from both.
//! Kept per row: S⁻¹, and G = S⁻¹C towards the middle. To solve: u ← u + Gᵀu inwards, then x = S⁻¹u + G x outwards.
//!
//! Cost: about 200 flops per row to factor, 50 to solve. Memory: 9 numbers per row, and the pivots.
//! Source: twisted factorisation, e.g. Meurant 1992.

use crate::force::Force;
use crate::real::Real;
use crate::solver::pivot::inverse;
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};

/// G by columns: symmetric C's columns, solved with.
pub(crate) type Towards<T> = [T; 9];

/// Which row both recurrences meet in.
fn middle(rows: usize) -> usize {
    rows / 2
}

/// Factors A in place: `pivots` become S⁻¹, `towards` G. `false` if a pivot is not positive.
#[inline(never)]
pub(crate) fn factor<T: Real, F: Force<T>>(
    system: &System<'_, T, F>,
    pivots: &mut [[T; 6]],
    towards: &mut [Towards<T>],
) -> bool {
    let (rows, middle) = (pivots.len(), middle(pivots.len()));
    system.diagonal(pivots);
    for g in towards.iter_mut() {
        *g = [T::ZERO; 9];
    }
    system.each_spring(|row, other, h| {
        // A coupling belongs to its end that is farther from the middle.
        let place = if row < middle { row } else { other };
        if let Some(g) = towards.get_mut(place).filter(|_| other < rows) {
            let [xx, yy, zz, xy, xz, yz, ..] = *g;
            let c = Sym3([xx, yy, zz, xy, xz, yz]).plus_scalar(h.alpha).plus_outer(h.w);
            let [xx, yy, zz, xy, xz, yz] = c.0;
            *g = [xx, yy, zz, xy, xz, yz, T::ZERO, T::ZERO, T::ZERO];
        }
    });
    let (Some((up, rest)), Some((up_g, rest_g))) =
        (pivots.split_at_mut_checked(middle), towards.split_at_mut_checked(middle))
    else {
        return false;
    };
    let Some((last, down)) = rest.split_first_mut() else { return true };
    let down_g = rest_g.get_mut(1..).unwrap_or_default();
    let nothing = Sym3([T::ZERO; 6]);
    let (mut from_below, mut from_above, mut sound) = (nothing, nothing, true);
    let mut up = up.iter_mut().zip(up_g);
    // With an even number of rows there is one more on the way up.
    if rows % 2 == 0
        && let Some((pivot, g)) = up.next()
    {
        from_below = eliminate(pivot, g, from_below, &mut sound);
    }
    for ((pivot, g), (pivot_down, g_down)) in up.zip(down.iter_mut().zip(down_g).rev()) {
        from_below = eliminate(pivot, g, from_below, &mut sound);
        from_above = eliminate(pivot_down, g_down, from_above, &mut sound);
    }
    let s = minus(minus(Sym3(*last), from_below), from_above);
    let middle = inverse(s);
    *last = middle.unwrap_or(nothing).0;
    sound && middle.is_some()
}

fn minus<T: Real>(a: Sym3<T>, b: Sym3<T>) -> Sym3<T> {
    let ([a0, a1, a2, a3, a4, a5], [b0, b1, b2, b3, b4, b5]) = (a.0, b.0);
    Sym3([a0 - b0, a1 - b1, a2 - b2, a3 - b3, a4 - b4, a5 - b5])
}

/// One row: S = A − what its neighbour leaves, S⁻¹ and G = S⁻¹C in place. Answers C S⁻¹ C, what it leaves to the next.
///
/// S = [x cᵀ; c B] as in [`super::pivot`], C's rows cₓ and Y, N = Y − (c/x) cₓᵀ (2×3): C S⁻¹ C = cₓcₓᵀ/x + Nᵀ Σ⁻¹ N, and all
/// but the last product with 1/det Σ is done while that division runs.
#[inline(always)]
fn eliminate<T: Real>(pivot: &mut [T; 6], g: &mut Towards<T>, before: Sym3<T>, sound: &mut bool) -> Sym3<T> {
    let [xx, yy, zz, xy, xz, yz, ..] = *g;
    let (c_x, c_y, c_z) = ([xx, xy, xz], [xy, yy, yz], [xz, yz, zz]);
    let [xx, yy, zz, xy, xz, yz] = minus(Sym3(*pivot), before).0;
    let first = T::ONE / xx;
    let (l_y, l_z) = (xy * first, xz * first);
    let (s_yy, s_zz, s_yz) = (yy - l_y * xy, zz - l_z * xz, yz - l_y * xz);
    let determinant = s_yy * s_zz - s_yz * s_yz;
    let second = T::ONE / determinant;
    *sound &= (xx > T::ZERO) & (s_yy > T::ZERO) & (determinant >= T::MIN_POSITIVE);

    let (n_y, n_z) = (vec3::add_scaled(c_y, -l_y, c_x), vec3::add_scaled(c_z, -l_z, c_x));
    let a_y = vec3::sub(vec3::scale(s_zz, n_y), vec3::scale(s_yz, n_z));
    let a_z = vec3::sub(vec3::scale(s_yy, n_z), vec3::scale(s_yz, n_y));
    let f = vec3::scale(first, c_x);
    let left = |i: usize, j: usize| {
        let at = |v: Vec3<T>, i: usize| v.get(i).copied().unwrap_or(T::ZERO);
        at(f, i) * at(c_x, j) + second * (at(n_y, i) * at(a_y, j) + at(n_z, i) * at(a_z, j))
    };
    let left = [left(0, 0), left(1, 1), left(2, 2), left(0, 1), left(0, 2), left(1, 2)];

    let (g_y, g_z) = (vec3::scale(second, a_y), vec3::scale(second, a_z));
    let g_x = vec3::add_scaled(vec3::add_scaled(f, -l_y, g_y), -l_z, g_z);
    *g = [g_x[0], g_y[0], g_z[0], g_x[1], g_y[1], g_z[1], g_x[2], g_y[2], g_z[2]];
    let (i_yy, i_zz, i_yz) = (s_zz * second, s_yy * second, -(s_yz * second));
    let (m_y, m_z) = (i_yy * l_y + i_yz * l_z, i_yz * l_y + i_zz * l_z);
    *pivot = [first + (l_y * m_y + l_z * m_z), i_yy, i_zz, -m_y, -m_z, i_yz];
    Sym3(left)
}

/// x ← A⁻¹ x
#[inline(never)]
pub(crate) fn solve<T: Real>(pivots: &[[T; 6]], towards: &[Towards<T>], x: &mut [Vec3<T>]) {
    let (rows, middle) = (x.len(), middle(x.len()));
    let (Some((up, rest)), Some((up_s, rest_s)), Some((up_g, rest_g))) =
        (x.split_at_mut_checked(middle), pivots.split_at_checked(middle), towards.split_at_checked(middle))
    else {
        return;
    };
    let (Some((last, down)), Some((last_s, down_s))) = (rest.split_first_mut(), rest_s.split_first()) else {
        return;
    };
    let down_g = rest_g.get(1..).unwrap_or_default();
    let (mut from_below, mut from_above) = ([T::ZERO; 3], [T::ZERO; 3]);
    {
        let mut up = up.iter_mut().zip(up_s.iter().zip(up_g));
        if rows % 2 == 0
            && let Some(row) = up.next()
        {
            from_below = inwards(row, from_below);
        }
        for (row, row_down) in up.zip(down.iter_mut().zip(down_s.iter().zip(down_g)).rev()) {
            from_below = inwards(row, from_below);
            from_above = inwards(row_down, from_above);
        }
    }
    *last = Sym3(*last_s).mul(vec3::add(vec3::add(*last, from_below), from_above));
    let (mut x_up, mut x_down) = (*last, *last);
    let mut up = up.iter_mut().zip(up_g).rev();
    for ((x, g), (x_below, g_below)) in up.by_ref().take(down.len()).zip(down.iter_mut().zip(down_g)) {
        x_up = outwards(x, g, x_up);
        x_down = outwards(x_below, g_below, x_down);
    }
    for (x, g) in up {
        x_up = outwards(x, g, x_up);
    }
}

/// u ← u + what the neighbour leaves, and x ← S⁻¹u in its place; answers Gᵀu for the next.
#[inline(always)]
fn inwards<T: Real>((x, (pivot, g)): (&mut Vec3<T>, (&[T; 6], &Towards<T>)), before: Vec3<T>) -> Vec3<T> {
    let u = vec3::add(*x, before);
    *x = Sym3(*pivot).mul(u);
    let [a, b, c, d, e, f, g, h, i] = *g;
    [vec3::dot([a, b, c], u), vec3::dot([d, e, f], u), vec3::dot([g, h, i], u)]
}

/// x ← x + G x₊
#[inline(always)]
fn outwards<T: Real>(x: &mut Vec3<T>, g: &Towards<T>, next: Vec3<T>) -> Vec3<T> {
    let [a, b, c, d, e, f, g, h, i] = *g;
    let columns = vec3::add_scaled(vec3::scale(next[0], [a, b, c]), next[1], [d, e, f]);
    *x = vec3::add(*x, vec3::add_scaled(columns, next[2], [g, h, i]));
    *x
}
