//! Sixteen f32 side by side: what the loops over a level work on. Written so that a compiler finds the vector registers; each
//! lane is its own sum, so how wide they are does not touch the bits.

/// How many there are in a tile.
pub(super) const WIDTH: usize = 16;

/// A number of each row.
pub(super) type Tile = [f32; WIDTH];
/// A vector of each row.
pub(super) type Tile3 = [Tile; 3];
/// A symmetric 3×3 matrix of each row: xx yy zz xy xz yz.
pub(super) type Tile6 = [Tile; 6];

#[inline(always)]
fn zip<const N: usize>(mut a: [f32; N], b: [f32; N], f: impl Fn(f32, f32) -> f32) -> [f32; N] {
    for (a, b) in a.iter_mut().zip(b) {
        *a = f(*a, b);
    }
    a
}

#[inline(always)]
pub(super) fn add<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    zip(a, b, |a, b| a + b)
}

#[inline(always)]
pub(super) fn sub<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    zip(a, b, |a, b| a - b)
}

#[inline(always)]
pub(super) fn mul<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    zip(a, b, |a, b| a * b)
}

/// a − b where b comes as three.
#[inline(always)]
pub(super) fn sub3(a: Tile3, b: Tile3) -> Tile3 {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    [sub(ax, bx), sub(ay, by), sub(az, bz)]
}

#[inline(always)]
pub(super) fn add3(a: Tile3, b: Tile3) -> Tile3 {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    [add(ax, bx), add(ay, by), add(az, bz)]
}

/// s·v
#[inline(always)]
pub(super) fn scale(s: Tile, [x, y, z]: Tile3) -> Tile3 {
    [mul(s, x), mul(s, y), mul(s, z)]
}

/// (a·x + b·y) + c·z
#[inline(always)]
pub(super) fn dot([a, b, c]: Tile3, [x, y, z]: Tile3) -> Tile {
    add(add(mul(a, x), mul(b, y)), mul(c, z))
}

/// Symmetric matrices times vectors.
#[inline(always)]
pub(super) fn symmetric([xx, yy, zz, xy, xz, yz]: Tile6, v: Tile3) -> Tile3 {
    [dot([xx, xy, xz], v), dot([xy, yy, yz], v), dot([xz, yz, zz], v)]
}
