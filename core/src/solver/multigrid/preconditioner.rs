//! PCG around the cycle: the iterations of [`crate::solver::pcg`] with z = B r. The cycle sees r divided by its largest
//! component, since f32 would lose a small one, and A divided by σ.

use super::LevelPart;
use super::cycle::Hierarchy;
use super::dense::Dense;
use super::level::Level;
use super::record::{Shape, skip_record};
use super::sizes::{DENSE, LEVELS, UNKNOWNS};
use super::tile::WIDTH;
use super::words::take;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::Real;
use crate::solver::around;
use crate::solver::pcg::Iteration;
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::neighbours::Way;
use crate::wide::solve::Sweep;
use crate::wide::work::Iterates;
use crate::wide::{self, Dispatch};

/// The hierarchy with this step's numbers.
pub(super) struct Preconditioner<'a, T, D> {
    /// 1/σ
    scale: T,
    hierarchy: Hierarchy<'a>,
    dispatch: D,
}

impl<'a, T: Real, D: Dispatch> Preconditioner<'a, T, D> {
    /// Without levels. It is large, so it is built where it lies.
    #[inline(always)]
    #[expect(clippy::large_stack_frames)] // Three parts of one another are counted three times.
    pub(super) fn empty(dispatch: D) -> Self {
        let dense = Dense::new(&mut [], 0);
        let levels = [const { None }; LEVELS];
        Self { scale: T::ZERO, hierarchy: Hierarchy { levels, count: 0, dense }, dispatch }
    }

    /// All levels with the system's numbers; `None` if there is too little room.
    #[inline(never)]
    pub(super) fn build<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        shape: &Shape,
        mut kept: &'a mut [u32],
        mut pool: &'a mut [f32],
    ) -> Option<()> {
        let place_of = skip_record(&mut kept, system.matrix.other.len())?;
        self.scale = T::ONE / system.largest();
        let Hierarchy { levels, count, dense } = &mut self.hierarchy;
        *count = shape.levels;
        let coarsest = shape.size.get(shape.levels.checked_sub(1)?)?.rows;
        *dense = Dense::new(take(&mut pool, UNKNOWNS * UNKNOWNS)?, coarsest);
        let mut finer: Option<&mut Level<'_>> = None;
        let (scale, dispatch) = (self.scale, self.dispatch);
        for (level, size) in levels.iter_mut().zip(&shape.size).take(shape.levels) {
            *level = Level::carve(&mut kept, &mut pool, *size, finer.is_none());
            let level = level.as_mut()?;
            match finer {
                None => level.fill(system, place_of, scale),
                Some(fine) => level.coarsen(fine),
            }
            level.invert_diagonal(dispatch);
            finer = Some(level);
        }
        if let Some(coarsest) = finer.filter(|level| level.pattern.size.rows <= DENSE) {
            dense.clear();
            coarsest.each_block(|a, b, block| dense.add(a, b, block));
            dense.factor(dispatch);
        }
        Some(())
    }

    /// z = B r, `most` the largest component of r; answers rᵀz.
    #[inline(never)]
    pub(super) fn apply(&mut self, r: &[Vec3<T>], most: T, z: &mut [Vec3<T>]) -> T {
        if !self.cycle(r.iter().copied(), most) {
            z.fill([T::ZERO; 3]);
            return T::ZERO;
        }
        let mut product = Lanes::new();
        for (i, ((z, r), solved)) in z.iter_mut().zip(r).zip(self.solved(most)).enumerate() {
            *z = solved;
            product.add(i, vec3::dot(*r, *z));
        }
        product.sum()
    }

    /// A cycle for r, whose largest component is `most`; answers whether there is one: not if r is 0 or not finite.
    #[inline(always)]
    fn cycle(&mut self, r: impl Iterator<Item = Vec3<T>>, most: T) -> bool {
        let (down, up) = (T::ONE / most, most * self.scale);
        let Some(Some(finest)) = self.hierarchy.levels.first_mut() else { return false };
        if !(most > T::ZERO && down.is_finite() && up.is_finite()) {
            return false;
        }
        let [x, y, z] = &mut finest.r.0;
        let [x, y, z] = [rows_mut(x), rows_mut(y), rows_mut(z)];
        for (((x, y), z), [a, b, c]) in x.iter_mut().zip(y).zip(z).zip(r) {
            *x = (down * a).to_f64() as f32;
            *y = (down * b).to_f64() as f32;
            *z = (down * c).to_f64() as f32;
        }
        self.hierarchy.cycle(self.dispatch);
        true
    }

    /// What it found.
    #[inline(always)]
    fn solved(&self, most: T) -> impl Iterator<Item = Vec3<T>> {
        let up = most * self.scale;
        let finest = self.hierarchy.levels.first().and_then(|level| level.as_ref());
        let [x, y, z] = finest.map_or([&[][..]; 3], |level| {
            let [x, y, z] = &level.x.0;
            [rows_of(x), rows_of(y), rows_of(z)]
        });
        x.iter().zip(y).zip(z).map(move |((x, y), z)| {
            let of = |x: f32| up * T::from_f64(f64::from(x));
            [of(*x), of(*y), of(*z)]
        })
    }
}

/// A plane from its first row on.
#[inline(always)]
fn rows_of(plane: &[f32]) -> &[f32] {
    plane.get(WIDTH..).unwrap_or_default()
}

#[inline(always)]
fn rows_mut(plane: &mut [f32]) -> &mut [f32] {
    plane.get_mut(WIDTH..).unwrap_or_default()
}

impl<T: Real, D: Dispatch> wide::solve::Preconditioner<T> for Preconditioner<'_, T, D> {
    #[inline(always)]
    fn sweep(&mut self, to: Sweep<'_, '_, T>) -> (T, T) {
        let (beta, most) = wide::sweep::update(to.layout, to.work, to.weight, to.step);
        if !(T::HALF * beta > to.target) {
            return (beta, T::ZERO);
        }
        self.in_lanes(to.way, to.work, to.rows, most);
        (beta, wide::sweep::dot(to.layout, to.work))
    }

    #[inline(always)]
    fn apply(&mut self, to: Sweep<'_, '_, T>) {
        // Where nothing was iterated, y still holds what assembly left: a product with z must find zeros where there is no row.
        for at in to.layout.tiles() {
            to.work.y.store(at, [wide::eight::all(T::ZERO); 3]);
        }
        let most = wide::sweep::update(to.layout, to.work, to.weight, T::ZERO).1;
        self.in_lanes(to.way, to.work, to.rows, most);
    }
}

impl<T: Real, D: Dispatch> Preconditioner<'_, T, D> {
    /// y = B r in planes of places, at those of the rows.
    #[inline(never)]
    fn in_lanes(&mut self, way: Way<'_>, work: &mut Iterates<'_, T>, rows: &[u32], most: T) {
        let Iterates { r, y, .. } = work;
        let (down, up) = (T::ONE / most, most * self.scale);
        let solves = most > T::ZERO && down.is_finite() && up.is_finite();
        if solves && let Some(Some(finest)) = self.hierarchy.levels.first_mut() {
            each_stretch(way, rows, |row, place, n| {
                for (to, from) in finest.r.0.iter_mut().zip(&r.0) {
                    for (to, from) in part_mut(to, row + WIDTH, n).iter_mut().zip(part(from, place, n)) {
                        *to = (down * *from).to_f64() as f32;
                    }
                }
            });
            self.hierarchy.cycle(self.dispatch);
        }
        let finest = self.hierarchy.levels.first().and_then(|level| level.as_ref()).filter(|_| solves);
        each_stretch(way, rows, |row, place, n| {
            for (c, to) in y.0.iter_mut().enumerate() {
                let to = part_mut(to, place, n);
                let Some(from) = finest.and_then(|level| level.x.0.get(c)) else {
                    to.fill(T::ZERO);
                    continue;
                };
                for (to, from) in to.iter_mut().zip(part(from, row + WIDTH, n)) {
                    *to = up * T::from_f64(f64::from(*from));
                }
            }
        });
    }
}

/// Rows whose places follow one another: visits the first row, its place, and how many there are.
#[inline(always)]
fn each_stretch(way: Way<'_>, rows: &[u32], mut visit: impl FnMut(usize, usize, usize)) {
    let list = match &way {
        Way::Runs(_) => rows,
        Way::Slots(slots) => slots.places,
    };
    let (mut row, mut rest) = (0, list);
    while let Some(first) = rest.first() {
        let together = rest.iter().zip(rest.iter().skip(1)).take_while(|(a, b)| b.wrapping_sub(**a) == 1);
        let n = together.count() + 1;
        visit(row, way.place(row, *first), n);
        row += n;
        rest = rest.get(n..).unwrap_or_default();
    }
}

#[inline(always)]
fn part<X>(plane: &[X], from: usize, n: usize) -> &[X] {
    plane.get(from..from.saturating_add(n)).unwrap_or_default()
}

#[inline(always)]
fn part_mut<X>(plane: &mut [X], from: usize, n: usize) -> &mut [X] {
    plane.get_mut(from..from.saturating_add(n)).unwrap_or_default()
}

impl<T: Real, D> Preconditioner<'_, T, D> {
    /// 1/σ
    pub(super) fn scale(&self) -> T {
        self.scale
    }

    pub(super) fn inspect(&self, visit: &mut impl FnMut(usize, LevelPart)) {
        for (l, level) in self.hierarchy.levels.iter().flatten().enumerate() {
            level.each_block(|row, column, block| {
                visit(l, LevelPart::Block(row, column, Sym3(block).dense()))
            });
            if l + 1 < self.hierarchy.count {
                for (row, aggregate) in level.pattern.aggregate.iter().enumerate() {
                    visit(l, LevelPart::Aggregate(row, *aggregate as usize));
                }
            }
        }
    }
}

impl<T: Real, D: Dispatch> Iteration<T> for Preconditioner<'_, T, D> {
    #[inline(never)]
    fn iterate<F: Force<T>>(
        &mut self,
        system: &System<'_, T, F>,
        v: &mut Vectors<'_, T>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        around::iterate(system, v, target, max_iterations, iterations, |r, most, z| self.apply(r, most, z))
    }

    fn precondition<F: Force<T>>(&mut self, _: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        self.apply(v.r, around::largest(v.r), v.y);
    }
}
