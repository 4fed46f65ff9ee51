//! The eight last rows of the pieces of a chain: a chain of eight with full couplings, whose rows are eliminated one after the other,
//! each in a lane of its own. See [`crate::wide::pieces`].

use crate::real::Real;
use crate::solver::pivot;
use crate::sym3::Sym3;
use crate::vec3::{self, Vec3};
use crate::wide::eight::{Eight, WIDTH, earlier, lane};
use crate::wide::piece_rows::{Block, Rows, SPIKE, VECTOR, columns, put, take};
use crate::wide::pieces::{Taken, minus};

/// The eight last rows of the pieces, factored: S⁻¹, and the coupling to the last row before.
pub(crate) struct Last<T> {
    pivots: [Sym3<T>; WIDTH],
    towards: [Block<T>; WIDTH],
}

/// The last rows' u gains what the rows after them hand over.
#[inline(never)]
pub(crate) fn hand_over<T: Real>(rows: &mut [Rows<T>], taken: &Vec3<Eight<T>>) {
    if let Some(last) = rows.last_mut() {
        let u = vec3::add(take(last, VECTOR), taken.map(earlier));
        put(last, VECTOR, u);
    }
}

/// Factors the chain of the last rows: one row after the other.
#[inline(never)]
pub(crate) fn join<T: Real>(rows: &mut [Rows<T>], taken: &Taken<T>) -> Option<Last<T>> {
    if taken.sound.any(|sound| !(sound > T::ZERO)) {
        return None;
    }
    hand_over(rows, &taken.vector);
    let last = rows.last()?;
    // Lane l's last row also loses what lane l + 1 takes.
    let s = minus(Sym3(take(last, 0)), Sym3(taken.block.map(earlier))).0;
    let spike = columns(take(last, SPIKE));
    let nothing = Sym3([T::ZERO; 6]);
    let mut out = Last { pivots: [nothing; WIDTH], towards: [[[T::ZERO; 3]; 3]; WIDTH] };
    let mut before = nothing;
    for (l, (pivot, towards)) in out.pivots.iter_mut().zip(&mut out.towards).enumerate() {
        let of = |x: Eight<T>| lane(x, l);
        // E: rows of this, columns of the one before.
        let e = spike.map(|column| column.map(of));
        let rows = [0, 1, 2].map(|i| e.map(|column| column.get(i).copied().unwrap_or(T::ZERO)));
        let solved = rows.map(|row| before.mul(row));
        let [xx, yy, zz, xy, xz, yz] = s.map(of);
        let [r0, r1, r2] = rows;
        let [s0, s1, s2] = solved;
        let s = Sym3([
            xx - vec3::dot(r0, s0),
            yy - vec3::dot(r1, s1),
            zz - vec3::dot(r2, s2),
            xy - vec3::dot(r0, s1),
            xz - vec3::dot(r0, s2),
            yz - vec3::dot(r1, s2),
        ]);
        before = pivot::inverse(s)?;
        (*pivot, *towards) = (before, e);
    }
    Some(out)
}

impl<T: Real> Last<T> {
    /// The last rows' x from their u.
    #[inline(never)]
    pub(crate) fn solve(&self, rows: &mut [Rows<T>]) {
        let Some(last) = rows.last_mut() else { return };
        let u: Vec3<Eight<T>> = take(last, VECTOR);
        let mut x = [[T::ZERO; 3]; WIDTH];
        let mut before = [T::ZERO; 3];
        for (l, ((x, pivot), [e0, e1, e2])) in x.iter_mut().zip(&self.pivots).zip(&self.towards).enumerate() {
            let [a, b, c] = before;
            let from = vec3::add_scaled(vec3::add_scaled(vec3::scale(a, *e0), b, *e1), c, *e2);
            before = pivot.mul(vec3::add(u.map(|u| lane(u, l)), from));
            *x = before;
        }
        let mut carried = [T::ZERO; 3];
        for ((x, pivot), e) in x.iter_mut().zip(&self.pivots).zip(&self.towards).rev() {
            *x = vec3::add(*x, pivot.mul(carried));
            carried = e.map(|column| vec3::dot(column, *x));
        }
        for (l, x) in x.iter().enumerate() {
            for (lanes, x) in last.iter_mut().skip(VECTOR).zip(x) {
                if let Some(place) = lanes.get_mut(l) {
                    *place = *x;
                }
            }
        }
    }
}
