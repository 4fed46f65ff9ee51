//! Block LDLᵀ of a chain in eight pieces side by side: lane l owns a piece of L rows, all lanes eliminate theirs in step,
//! and what is left are the eight last rows of the pieces.
//!
//! With couplings −C between rows k and k + 1, C = αI + wwᵀ, and −F between row k and the last row of the piece before
//! (the *spike*; F₀ is the coupling itself):
//!
//! S = M̃ + H + R,  R₊ = H − C S⁻¹C,  F₊ = C S⁻¹F,  and the last row of the piece before loses FᵀS⁻¹F.
//!
//! H is what the spring to the next row adds to both diagonals: C, or where the next is a pin only that. What is no row has
//! S = I, C = 0. The last rows are a chain of eight with full couplings, eliminated one after the other. To solve: y = S⁻¹u,
//! u₊ = b₊ + C y inwards, Fᵀy to the last row before; the eight; x = y + S⁻¹(C x₊ + F x₀) outwards. Pivots and spikes are
//! two sweeps: in one there are more numbers at hand than registers.
//!
//! The number of pieces is a part of the definition: eight on every machine, L = places/8. So bits are the same for every
//! [`crate::Dispatch`]; they are not those of [`crate::solver::chain`], which has other pieces.
//!
//! Cost per row: 290 flops to factor with the way inwards, 50 for the way outwards; two divisions for eight rows, which wait
//! for each other along a piece only. Memory: 22 numbers per place.
//!
//! Sources: Wang 1981 (partition method); Meurant 1992 (block tridiagonal matrices).

use crate::hessian::Hessian;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, all, choose, earlier, later, where_positive};
use crate::wide::piece_rows::{Block, COUPLING, Rows, SPIKE, VECTOR, columns, flat, put, spring, take};

#[inline(always)]
pub(crate) fn minus<T: Real>(a: Sym3<Eight<T>>, b: Sym3<Eight<T>>) -> Sym3<Eight<T>> {
    let ([a0, a1, a2, a3, a4, a5], [b0, b1, b2, b3, b4, b5]) = (a.0, b.0);
    Sym3([a0 - b0, a1 - b1, a2 - b2, a3 - b3, a4 - b4, a5 - b5])
}

/// w wᵀ + αI
#[inline(always)]
fn dense<T: Real>(h: &Hessian<Eight<T>>) -> Sym3<Eight<T>> {
    let [x, y, z] = h.w;
    Sym3([x * x + h.alpha, y * y + h.alpha, z * z + h.alpha, x * y, x * z, y * z])
}

/// S⁻¹ as in [`crate::solver::pivot`], and C S⁻¹ C; `sound` becomes 0 where a pivot is not positive.
///
/// S = [x cᵀ; c B], C's rows cₓ and Y, N = Y − (c/x) cₓᵀ (2×3): C S⁻¹ C = cₓcₓᵀ/x + Nᵀ Σ⁻¹ N, and all but the last product
/// with 1/det Σ is done while that division runs.
#[inline(always)]
fn eliminate<T: Real>(s: Sym3<Eight<T>>, c: Sym3<Eight<T>>, sound: &mut Eight<T>) -> [Sym3<Eight<T>>; 2] {
    let [xx, yy, zz, xy, xz, yz] = c.0;
    let (c_x, c_y, c_z) = ([xx, xy, xz], [xy, yy, yz], [xz, yz, zz]);
    let ([xx, yy, zz, xy, xz, yz], one) = (s.0, all(T::ONE));
    let first = one / xx;
    let (l_y, l_z) = (xy * first, xz * first);
    let (s_yy, s_zz, s_yz) = (yy - l_y * xy, zz - l_z * xz, yz - l_y * xz);
    let determinant = s_yy * s_zz - s_yz * s_yz;
    let second = one / determinant;
    let (n_y, n_z) = (vec3::add_scaled(c_y, -l_y, c_x), vec3::add_scaled(c_z, -l_z, c_x));
    let a_y = vec3::sub(vec3::scale(s_zz, n_y), vec3::scale(s_yz, n_z));
    let a_z = vec3::sub(vec3::scale(s_yy, n_z), vec3::scale(s_yz, n_y));
    let f = vec3::scale(first, c_x);
    let left = [
        f[0] * c_x[0] + second * (n_y[0] * a_y[0] + n_z[0] * a_z[0]),
        f[1] * c_x[1] + second * (n_y[1] * a_y[1] + n_z[1] * a_z[1]),
        f[2] * c_x[2] + second * (n_y[2] * a_y[2] + n_z[2] * a_z[2]),
        f[0] * c_x[1] + second * (n_y[0] * a_y[1] + n_z[0] * a_z[1]),
        f[0] * c_x[2] + second * (n_y[0] * a_y[2] + n_z[0] * a_z[2]),
        f[1] * c_x[2] + second * (n_y[1] * a_y[2] + n_z[1] * a_z[2]),
    ];
    let (i_yy, i_zz, i_yz) = (s_zz * second, s_yy * second, -(s_yz * second));
    let (m_y, m_z) = (i_yy * l_y + i_yz * l_z, i_yz * l_y + i_zz * l_z);
    let i_xx = first + (l_y * m_y + l_z * m_z);
    *sound = determinant.zip(
        xx.positive_then(s_yy.positive_then(*sound)),
        #[inline(always)]
        |d, sound| if d >= T::MIN_POSITIVE { sound } else { T::ZERO },
    );
    [Sym3([i_xx, i_yy, i_zz, -m_y, -m_z, i_yz]), Sym3(left)]
}

/// S of rows, I where there is none.
#[inline(always)]
fn diagonal<T: Real>(m: Eight<T>, h: &Sym3<Eight<T>>, before: &Sym3<Eight<T>>) -> Sym3<Eight<T>> {
    let ([xx, yy, zz, xy, xz, yz], [rxx, ryy, rzz, rxy, rxz, ryz]) = (h.0, before.0);
    let (one, zero) = (all(T::ONE), all(T::ZERO));
    let across = [xy + rxy, xz + rxz, yz + ryz];
    let [xy, xz, yz] = across;
    let (xy, xz, yz) = (choose(m, xy, zero), choose(m, xz, zero), choose(m, yz, zero));
    let along = [(m + xx) + rxx, (m + yy) + ryy, (m + zz) + rzz];
    let [xx, yy, zz] = along;
    Sym3([choose(m, xx, one), choose(m, yy, one), choose(m, zz, one), xy, xz, yz])
}

/// C v
#[inline(always)]
fn coupled<T: Real>(c: &Hessian<Eight<T>>, v: Vec3<Eight<T>>) -> Vec3<Eight<T>> {
    vec3::add_scaled(vec3::scale(c.alpha, v), vec3::dot(c.w, v), c.w)
}

/// What lies before the first rows: what the lane before adds to the diagonal, and the first spikes. Shifts are kept away
/// from the loops: a compiler that sees them takes its lanes apart there.
pub(crate) struct Before<T> {
    spike: Block<Eight<T>>,
}

/// What all rows but the last take from the last rows before: ΣFᵀS⁻¹F, and ΣFᵀy. Not `sound` where a pivot was not positive.
pub(crate) struct Taken<T> {
    pub(crate) sound: Eight<T>,
    pub(crate) block: [Eight<T>; 6],
    pub(crate) vector: Vec3<Eight<T>>,
}

#[inline(never)]
pub(crate) fn before<T: Real>(rows: &mut [Rows<T>], points: bool) -> Option<Before<T>> {
    let [first_mass] = take(rows.first()?, 0);
    let last = rows.last_mut()?;
    let [last_mass] = take(last, 0);
    let h = spring(last);
    let c = masked(earlier(first_mass).positive_then(last_mass), &h);
    let Sym3([xx, yy, zz, xy, xz, yz]) = Sym3(dense(&c).0.map(later));
    let spike = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut block = Sym3(dense(&h).0.map(later));
    let first = rows.first_mut()?;
    if points {
        block = plus(block, Sym3(take(first, SPIKE)));
    }
    put(first, SPIKE, block.0);
    Some(Before { spike })
}

/// Factors A, which comes as the masses of the rows in the first place of `rows`, α and w of their springs to the next in
/// the coupling's, and with `points` what else is on the diagonal in the spike's. On the way y becomes what [`inwards`] makes
/// of it. `None` if a pivot is not positive.
#[inline(always)]
pub(crate) fn factor<T: Real>(rows: &mut [Rows<T>], before: &Before<T>, points: bool) -> Option<Taken<T>> {
    let (last, interior) = rows.split_last_mut()?;
    let sound = eliminate_interior(interior, last, points)?;
    let [last_mass] = take(last, 0);
    let s = diagonal(last_mass, &dense(&spring(last)), &Sym3(take(last, SPIKE)));
    put(last, 0, s.0);
    let (spike, taken) = spikes(interior, before.spike, sound);
    put(last, SPIKE, flat(spike));
    Some(taken)
}

#[inline(always)]
fn masked<T: Real>(mark: Eight<T>, h: &Hessian<Eight<T>>) -> Hessian<Eight<T>> {
    Hessian { alpha: mark.positive_then(h.alpha), w: where_positive(mark, h.w) }
}

#[inline(always)]
fn plus<T: Real>(a: Sym3<Eight<T>>, b: Sym3<Eight<T>>) -> Sym3<Eight<T>> {
    let ([a0, a1, a2, a3, a4, a5], [b0, b1, b2, b3, b4, b5]) = (a.0, b.0);
    Sym3([a0 + b0, a1 + b1, a2 + b2, a3 + b3, a4 + b4, a5 + b5])
}

/// All but the last rows. Answers their R and C y.
#[inline(always)]
fn eliminate_interior<T: Real>(
    interior: &mut [Rows<T>],
    last: &mut Rows<T>,
    points: bool,
) -> Option<Eight<T>> {
    let [mut m] = take(interior.first()?, 0);
    let mut sound = all(T::ONE);
    let mut rest = interior;
    while let Some((rows, later)) = rest.split_first_mut() {
        let after = later.first_mut().unwrap_or(&mut *last);
        let [next] = take(after, 0);
        let spring = spring(rows);
        let block = dense(&spring);
        let s = diagonal(m, &block, &Sym3(take(rows, SPIKE)));
        let joined = next.positive_then(m);
        let [a, b, c, d, e, f] = block.0;
        let ([a, b, c], [d, e, f]) = (where_positive(joined, [a, b, c]), where_positive(joined, [d, e, f]));
        let c = Sym3([a, b, c, d, e, f]);
        let [inverse, left] = eliminate(s, c, &mut sound);
        let mut left = minus(block, left);
        if points {
            left = plus(left, Sym3(take(after, SPIKE)));
        }
        put(after, SPIKE, left.0);
        put(rows, 0, inverse.0);
        let spring = masked(joined, &spring);
        put(rows, COUPLING, [spring.alpha, spring.w[0], spring.w[1], spring.w[2]]);
        let y = inverse.mul(take(rows, VECTOR));
        put(rows, VECTOR, y);
        put(after, VECTOR, vec3::add(take(after, VECTOR), coupled(&spring, y)));
        (m, rest) = (next, later);
    }
    Some(sound)
}

/// The spikes of all but the last rows. Answers those of the last.
#[inline(always)]
fn spikes<T: Real>(
    interior: &mut [Rows<T>],
    spike: Block<Eight<T>>,
    sound: Eight<T>,
) -> (Block<Eight<T>>, Taken<T>) {
    let [mut f0, mut f1, mut f2] = spike;
    let [mut xx, mut yy, mut zz, mut xy, mut xz, mut yz] = [all(T::ZERO); 6];
    let [mut t0, mut t1, mut t2] = [all(T::ZERO); 3];
    for rows in interior {
        let y = take(rows, VECTOR);
        (t0, t1, t2) = (t0 + vec3::dot(f0, y), t1 + vec3::dot(f1, y), t2 + vec3::dot(f2, y));
        put(rows, SPIKE, flat([f0, f1, f2]));
        let (inverse, c) = (Sym3(take(rows, 0)), spring(rows));
        let y = inverse.mul(f0);
        (xx, xy, xz) = (xx + vec3::dot(f0, y), xy + vec3::dot(f1, y), xz + vec3::dot(f2, y));
        f0 = coupled(&c, y);
        let y = inverse.mul(f1);
        (yy, yz) = (yy + vec3::dot(f1, y), yz + vec3::dot(f2, y));
        f1 = coupled(&c, y);
        let y = inverse.mul(f2);
        zz = zz + vec3::dot(f2, y);
        f2 = coupled(&c, y);
    }
    ([f0, f1, f2], Taken { sound, block: [xx, yy, zz, xy, xz, yz], vector: [t0, t1, t2] })
}

/// y ← S⁻¹u in all but the last rows, u in these.
#[inline(always)]
pub(crate) fn inwards<T: Real>(rows: &mut [Rows<T>]) -> Vec3<Eight<T>> {
    let zero = [all(T::ZERO); 3];
    let (mut carried, mut taken) = (zero, zero);
    let Some((last, interior)) = rows.split_last_mut() else { return zero };
    for rows in interior {
        let u = vec3::add(take(rows, VECTOR), carried);
        let y = Sym3(take(rows, 0)).mul(u);
        put(rows, VECTOR, y);
        carried = coupled(&spring(rows), y);
        let [f0, f1, f2] = columns(take(rows, SPIKE));
        let [t0, t1, t2] = taken;
        taken = [t0 + vec3::dot(f0, y), t1 + vec3::dot(f1, y), t2 + vec3::dot(f2, y)];
    }
    put(last, VECTOR, vec3::add(take(last, VECTOR), carried));
    taken
}

/// y ← x, after [`inwards`] and [`crate::wide::last_rows::Last::solve`].
#[inline(always)]
pub(crate) fn outwards<T: Real>(rows: &mut [Rows<T>]) {
    let Some((last, interior)) = rows.split_last_mut() else { return };
    let mut x = take(last, VECTOR);
    let [b0, b1, b2] = x.map(later);
    for rows in interior.iter_mut().rev() {
        let [f0, f1, f2] = columns(take(rows, SPIKE));
        let spiked = vec3::add_scaled(vec3::add_scaled(vec3::scale(b0, f0), b1, f1), b2, f2);
        let carried = coupled(&spring(rows), x);
        let moved = Sym3(take(rows, 0)).mul(vec3::add(spiked, carried));
        x = vec3::add(take(rows, VECTOR), moved);
        put(rows, VECTOR, x);
    }
}
