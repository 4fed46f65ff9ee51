//! Eight f32 side by side: what the loops over a level work on. Written so that a compiler finds the vector registers; each
//! lane is its own sum, so how wide they are does not touch the bits.

/// How many there are in a tile.
pub(super) const WIDTH: usize = 8;

/// Eight numbers.
pub(super) type Tile = [f32; WIDTH];
/// Eight vectors.
pub(super) type Tile3 = [Tile; 3];
/// Eight symmetric 3×3 matrices: xx yy zz xy xz yz.
pub(super) type Tile6 = [Tile; 6];

#[inline(always)]
fn zip(mut a: Tile, b: Tile, f: impl Fn(f32, f32) -> f32) -> Tile {
    for (a, b) in a.iter_mut().zip(b) {
        *a = f(*a, b);
    }
    a
}

#[inline(always)]
pub(super) fn add(a: Tile, b: Tile) -> Tile {
    zip(a, b, |a, b| a + b)
}

#[inline(always)]
pub(super) fn sub(a: Tile, b: Tile) -> Tile {
    zip(a, b, |a, b| a - b)
}

#[inline(always)]
pub(super) fn mul(a: Tile, b: Tile) -> Tile {
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

/// Eight symmetric matrices times eight vectors.
#[inline(always)]
pub(super) fn symmetric([xx, yy, zz, xy, xz, yz]: Tile6, v: Tile3) -> Tile3 {
    [dot([xx, xy, xz], v), dot([xy, yy, yz], v), dot([xz, yz, zz], v)]
}
