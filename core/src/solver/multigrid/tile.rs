//! Eight f32 side by side: what the loops over a level work on. Written so that a compiler finds the vector registers; each
//! lane is its own sum, so how wide they are does not touch the bits.

/// How many there are in a tile.
pub(super) const WIDTH: usize = 8;

/// Eight numbers.
pub(super) type Tile = [f32; WIDTH];

/// Three of them: eight vectors.
pub(super) type Tile3 = [Tile; 3];

#[inline(always)]
pub(super) fn zip(mut a: Tile, b: Tile, f: impl Fn(f32, f32) -> f32) -> Tile {
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

/// (a·x + b·y) + c·z
#[inline(always)]
fn dot([a, b, c]: [Tile; 3], [x, y, z]: Tile3) -> Tile {
    add(add(mul(a, x), mul(b, y)), mul(c, z))
}

/// Eight symmetric 3×3 matrices (xx, yy, zz, xy, xz, yz) times eight vectors.
#[inline(always)]
pub(super) fn symmetric([xx, yy, zz, xy, xz, yz]: [Tile; 6], v: Tile3) -> Tile3 {
    [dot([xx, xy, xz], v), dot([xy, yy, yz], v), dot([xz, yz, zz], v)]
}

/// Eight numbers of a plane from the i-th on; zeros past its end.
#[inline(always)]
pub(super) fn load(plane: &[f32], i: usize) -> Tile {
    plane.get(i..).and_then(|rest| rest.first_chunk()).copied().unwrap_or([0.0; WIDTH])
}

#[inline(always)]
pub(super) fn store(plane: &mut [f32], i: usize, tile: Tile) {
    if let Some(place) = plane.get_mut(i..).and_then(|rest| rest.first_chunk_mut()) {
        *place = tile;
    }
}

/// Three planes side by side: x, y, z of every row.
pub(super) struct Planes<'a>(pub(super) [&'a mut [f32]; 3]);

impl Planes<'_> {
    /// One row.
    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> [f32; 3] {
        let [x, y, z] = &self.0;
        let of = |plane: &[f32]| plane.get(i).copied().unwrap_or(0.0);
        [of(x), of(y), of(z)]
    }

    /// Adds to one row.
    #[inline(always)]
    pub(super) fn add(&mut self, i: usize, v: [f32; 3]) {
        for (plane, v) in self.0.iter_mut().zip(v) {
            if let Some(place) = plane.get_mut(i) {
                *place += v;
            }
        }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, v: [f32; 3]) {
        for (plane, v) in self.0.iter_mut().zip(v) {
            if let Some(place) = plane.get_mut(i) {
                *place = v;
            }
        }
    }

    pub(super) fn clear(&mut self) {
        for plane in &mut self.0 {
            plane.fill(0.0);
        }
    }
}
