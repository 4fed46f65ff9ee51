//! The hierarchy as a preconditioner. A cycle sees r divided by its largest component, since f32 would lose a small one, and A
//! divided by σ.

use super::LevelPart;
use super::cycle::Hierarchy;
use super::dense::Dense;
use super::inner::{Inner, Outer, Refined, Rows};
use super::level::Level;
use super::outer::{InLists, InVectors};
use super::record::{Shape, skip_record};
use super::sizes::{DENSE, LEVELS, UNKNOWNS};
use super::springs::Springs;
use super::words::take;
use crate::force::Force;
use crate::lanes::Lanes;
use crate::parts::Vectors;
use crate::real::Real;
use crate::solver::pcg::Iteration;
use crate::solver::refinement::{Refinement, refine};
use crate::sym3::Sym3;
use crate::system::System;
use crate::vec3::{self, Vec3};
use crate::wide::solve::Widened;
use crate::wide::{self, Dispatch};

/// The hierarchy with this step's numbers.
pub(super) struct Preconditioner<'a, T, D> {
    /// 1/σ
    scale: T,
    hierarchy: Hierarchy<'a>,
    inner: Inner<'a>,
    dispatch: D,
}

impl<'a, T: Real, D: Dispatch> Preconditioner<'a, T, D> {
    /// Without levels. It is large, so it is built where it lies.
    #[inline(always)]
    #[expect(clippy::large_stack_frames)] // Three parts of one another are counted three times.
    pub(super) fn empty(dispatch: D) -> Self {
        let dense = Dense::new(&mut [], 0);
        let levels = [const { None }; LEVELS];
        let hierarchy = Hierarchy { levels, count: 0, dense };
        Self { scale: T::ZERO, hierarchy, inner: Inner::none(), dispatch }
    }

    /// All levels with the springs' numbers; `None` if there is too little room.
    #[inline(never)]
    pub(super) fn build<F: Force<T>>(
        &mut self,
        springs: &impl Springs<T, F>,
        shape: &Shape,
        mut kept: &'a mut [u32],
        mut pool: &'a mut [f32],
    ) -> Option<()> {
        let place_of = skip_record(&mut kept, springs.system().matrix.other.len())?;
        self.scale = T::ONE / springs.largest();
        let Hierarchy { levels, count, dense } = &mut self.hierarchy;
        *count = shape.levels;
        let coarsest = shape.size.get(shape.levels.checked_sub(1)?)?.rows;
        *dense = Dense::new(take(&mut pool, UNKNOWNS * UNKNOWNS)?, coarsest);
        let [finest, ..] = shape.size;
        self.inner = Inner::carve(&mut pool, finest.rows)?;
        let mut finer: Option<&mut Level<'_>> = None;
        let (scale, dispatch) = (self.scale, self.dispatch);
        for (level, size) in levels.iter_mut().zip(&shape.size).take(shape.levels) {
            *level = Level::carve(&mut kept, &mut pool, *size, finer.is_none());
            let level = level.as_mut()?;
            match finer {
                None => level.fill(springs, place_of, scale),
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

    /// y = B r
    #[inline(always)]
    fn cycle(&mut self, rows: &mut impl Rows<T>, rough: bool) {
        let most = rows.most();
        let (down, up) = (T::ONE / most, most * self.scale);
        let Some(Some(finest)) = self.hierarchy.levels.first_mut() else { return };
        if !(most > T::ZERO && down.is_finite() && up.is_finite()) {
            finest.x.clear();
            return rows.put(T::ONE, &finest.x);
        }
        rows.residual(down, &mut finest.r);
        if rough {
            self.hierarchy.rough_cycle(self.dispatch);
        } else {
            self.hierarchy.cycle(self.dispatch);
        }
        if let Some(Some(finest)) = self.hierarchy.levels.first() {
            rows.put(up, &finest.x);
        }
    }

    /// z = B r; answers rᵀz.
    #[inline(never)]
    pub(super) fn apply(&mut self, r: &[Vec3<T>], z: &mut [Vec3<T>]) -> T {
        self.cycle(&mut InLists { r, y: z }, false);
        let mut product = Lanes::new();
        for (i, (r, z)) in r.iter().zip(z).enumerate() {
            product.add(i, vec3::dot(*r, *z));
        }
        product.sum()
    }

    #[inline(always)]
    fn iterate(
        &mut self,
        outer: &mut impl Outer<T>,
        (target, max_iterations): (T, u32),
        iterations: &mut u32,
    ) -> bool {
        let Self { scale, hierarchy, inner, dispatch, .. } = self;
        let (scale, dispatch) = (*scale, *dispatch);
        let mut refined = Refined { hierarchy, inner, outer, scale, dispatch };
        refine(&mut refined, target, max_iterations, iterations) == Refinement::Broken
    }
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
        self.iterate(&mut InVectors { system, v }, (target, max_iterations), iterations)
    }

    fn precondition<F: Force<T>>(&mut self, _: &System<'_, T, F>, v: &mut Vectors<'_, T>) {
        self.cycle(&mut InLists { r: v.r, y: v.y }, true);
    }
}

impl<T: Real, D: Dispatch> wide::solve::Preconditioner<T> for Preconditioner<'_, T, D> {
    #[inline(never)]
    fn iterate<F: Force<T>, E: Dispatch>(
        &mut self,
        of: &mut Widened<'_, '_, T, F, E>,
        target: T,
        max_iterations: u32,
        iterations: &mut u32,
    ) -> bool {
        self.iterate(of, (target, max_iterations), iterations)
    }

    #[inline(never)]
    fn apply<F: Force<T>, E: Dispatch>(&mut self, of: &mut Widened<'_, '_, T, F, E>) {
        self.cycle(of, true);
    }
}
