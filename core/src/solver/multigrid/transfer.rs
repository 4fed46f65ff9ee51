//! From a level to the next and back: P is 1 where a row belongs to an aggregate.

use super::planes::Planes;
use super::tile::WIDTH;
use super::words::NONE;

/// d = P x_c in n rows from i on.
#[inline(always)]
pub(super) fn gather(aggregate: &[u32], coarse: &Planes<'_>, d: &mut Planes<'_>, [i, n]: [usize; 2]) {
    let [x_c, y_c, z_c] = &coarse.0;
    let places = x_c.len();
    let (Some(y_c), Some(z_c)) = (y_c.get(..places), z_c.get(..places)) else { return };
    let [dx, dy, dz] = d.0.each_mut().map(|plane| plane.get_mut(i + WIDTH..).unwrap_or_default());
    let rows = aggregate.get(i..).unwrap_or_default().iter().take(n);
    for (((aggregate, a), b), c) in rows.zip(dx).zip(dy).zip(dz) {
        let place = *aggregate as usize + WIDTH;
        if let (Some(x), Some(y), Some(z)) = (x_c.get(place), y_c.get(place), z_c.get(place)) {
            (*a, *b, *c) = (*x, *y, *z);
        }
    }
}

/// Adds Pᵀr of n rows from i on. Rows that follow one another are often of one aggregate: its sum then waits in registers
/// instead of going through memory.
#[inline(always)]
pub(super) fn scatter(aggregate: &[u32], r: &Planes<'_>, coarse: &mut Planes<'_>, [i, n]: [usize; 2]) {
    let [from_x, from_y, from_z] = r.0.each_ref().map(|plane| plane.get(i + WIDTH..).unwrap_or_default());
    let rows = aggregate.get(i..).unwrap_or_default().iter().take(n);
    let (mut last, mut sum) = (NONE, [0.0; 3]);
    for (((aggregate, a), b), c) in rows.zip(from_x).zip(from_y).zip(from_z) {
        if *aggregate != last {
            coarse.put(last as usize, sum);
            sum = coarse.at(*aggregate as usize);
            last = *aggregate;
        }
        let [x, y, z] = sum;
        sum = [x + a, y + b, z + c];
    }
    coarse.put(last as usize, sum);
}
