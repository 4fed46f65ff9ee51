//! The vector work of a PCG iteration in tiles: x += a p, r −= a y, z = D⁻¹r, and p = z + ρ p.

use crate::bound::square;
use crate::lanes::Lanes;
use crate::real::Real;
use crate::sym3::Sym3;
use crate::vec3;
use crate::wide::layout::Layout;
use crate::wide::tile::{TILE, Tile, add_terms, row, tile};
use crate::wide::work::{Work, tiles};

/// x += a p, r −= a y, and then y = z = D⁻¹r. Answers Σ|rᵢ|²/μᵢ and rᵀz.
///
/// A tile's answers are gathered apart and then written: where they might overwrite what is still to be read, no rows
/// could be taken together.
#[inline(always)]
#[expect(clippy::indexing_slicing)] // As in `row`.
pub(crate) fn sweep<T: Real>(layout: &Layout, work: &mut Work<'_, T>, a: T) -> (T, T) {
    let (mut betas, mut products) = (Lanes::new(), Lanes::new());
    let Work { x, r, p, y, weight, inverse, .. } = work;
    for at in tiles(layout) {
        let weight = tile(weight, at);
        let [xx, yy, zz, xy, xz, yz] = &*inverse;
        let [xx, yy, zz] = [tile(xx, at), tile(yy, at), tile(zz, at)];
        let [xy, xz, yz] = [tile(xy, at), tile(xz, at), tile(yz, at)];
        let zeros = [[T::ZERO; TILE]; 3];
        let (mut to_x, mut to_r, mut to_z) = (zeros, zeros, zeros);
        let (mut beta, mut rz) = ([T::ZERO; TILE], [T::ZERO; TILE]);
        {
            let (x, r, p, y) = (x.tiles(at), r.tiles(at), p.tiles(at), y.tiles(at));
            for i in 0..TILE {
                put(&mut to_x, i, vec3::add_scaled(row(x, i), a, row(p, i)));
                let residual = vec3::add_scaled(row(r, i), -a, row(y, i));
                let z = Sym3([xx[i], yy[i], zz[i], xy[i], xz[i], yz[i]]).mul(residual);
                put(&mut to_r, i, residual);
                put(&mut to_z, i, z);
                beta[i] = square(residual, weight[i]);
                rz[i] = vec3::dot(residual, z);
            }
        }
        x.put_tiles(at, to_x);
        r.put_tiles(at, to_r);
        y.put_tiles(at, to_z);
        add_terms(&mut betas, &beta);
        add_terms(&mut products, &rz);
    }
    (betas.sum(), products.sum())
}

/// p = z + ρ p, z being in y.
#[inline(always)]
pub(crate) fn direction<T: Real>(layout: &Layout, work: &mut Work<'_, T>, ratio: T) {
    let Work { p, y, .. } = work;
    for at in tiles(layout) {
        let mut turned = [[T::ZERO; TILE]; 3];
        {
            let (z, p) = (y.tiles(at), p.tiles(at));
            for i in 0..TILE {
                put(&mut turned, i, vec3::add_scaled(row(z, i), ratio, row(p, i)));
            }
        }
        p.put_tiles(at, turned);
    }
}

#[inline(always)]
#[expect(clippy::indexing_slicing)] // As in `row`.
fn put<T: Real>([x, y, z]: &mut [Tile<T>; 3], i: usize, value: vec3::Vec3<T>) {
    [x[i], y[i], z[i]] = value;
}
