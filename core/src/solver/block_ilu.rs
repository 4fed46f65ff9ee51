//! Block D-ILU (prototype)
use crate::error::StepError;
use crate::force::Force;
use crate::real::Real;
use crate::report::Solve;
use crate::solver::eisenstat::{Eisenstat, Excess};
use crate::solver::{Problem, Solver, Stop, pcg};
use crate::sym3::Sym3;
use crate::system::System;
use crate::hessian::Hessian;
use crate::vec3;

/// S
#[derive(Debug, Clone, Copy)]
pub struct BlockIlu<B> {
    workspace: B,
}

impl BlockIlu<()> {
    /// How many numbers an island of so many free particles needs. Islands share the workspace: the largest need counts.
    pub const fn needs(particles: usize) -> usize {
        particles.saturating_mul(15)
    }
}

impl<B> BlockIlu<B> {
    /// new
    pub const fn new(workspace: B) -> Self {
        Self { workspace }
    }
}

struct Blocks<'a, T>(&'a [[T; 6]]);

impl<T: Real> Excess<T> for Blocks<'_, T> {
    #[inline(always)]
    fn times(&self, row: usize, p: vec3::Vec3<T>, _: vec3::Vec3<T>) -> vec3::Vec3<T> {
        self.0.get(row).map_or([T::ZERO; 3], |e| Sym3(*e).mul(p))
    }
}

fn add<T: Real>(a: &mut [T; 6], b: &[T; 6]) {
    for (a, b) in a.iter_mut().zip(b) { *a += *b; }
}

fn pivots<T: Real, F: Force<T>>(system: &System<'_, T, F>, block: &mut [[T; 6]], excess: &mut [[T; 6]], pair: &mut [[T; 9]]) -> u32 {
    system.diagonal(block);
    for (e, p) in excess.iter_mut().zip(pair.iter_mut()) { *e = [T::ZERO; 6]; *p = [T::ZERO; 9]; }
    let matrix = system.matrix;
    let (mut others, mut hessians) = (matrix.other, &*matrix.hessian);
    let mut replaced = 0;
    for (row, own) in matrix.own.iter().enumerate() {
        let (Some(block), Some(e)) = (block.get_mut(row), excess.get_mut(row)) else { break };
        let mut s = *block;
        for (s, e) in s.iter_mut().zip(e.iter()) { *s = *s - *e; }
        let inverse = match Sym3(s).inverse() {
            Some(i) => i,
            None => { replaced += 1; *e = [T::ZERO; 6]; Sym3(*block).inverse().unwrap_or_default() }
        };
        *block = inverse.0;
        let (o, r) = others.split_at_checked(*own as usize).unwrap_or_default();
        others = r;
        let (hs, r) = hessians.split_at_checked(*own as usize).unwrap_or_default();
        hessians = r;
        for (other, h) in o.iter().zip(hs) {
            if let Some(p) = pair.get_mut(*other as usize) {
                let h = Hessian::unpack(*h);
                let b = Sym3::scalar(h.alpha).plus_outer(h.w).0;
                for (p, b) in p.iter_mut().zip(b) { *p += b; }
            }
        }
        for other in o {
            if let (Some(p), Some(e)) = (pair.get_mut(*other as usize), excess.get_mut(*other as usize)) {
                let [xx, yy, zz, xy, xz, yz, ..] = *p;
                let h = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                let w = h.map(|c| inverse.mul(c));
                let d = |a: usize, b: usize| vec3::dot(h[a], w[b]);
                add(e, &[d(0, 0), d(1, 1), d(2, 2), d(0, 1), d(0, 2), d(1, 2)]);
                *p = [T::ZERO; 9];
            }
        }
    }
    replaced
}

impl<T: Real, B: AsMut<[T]>> Solver<T> for BlockIlu<B> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        let numbers = BlockIlu::needs(problem.system.particles());
        let Some(workspace) = self.workspace.as_mut().get_mut(..numbers) else {
            return Err(StepError::Workspace { numbers, words: 0 });
        };
        let Problem { system, vectors, block, free } = problem;
        let (sums, excess) = workspace.split_at_mut_checked(9 * system.particles()).unwrap_or_default();
        let excess = excess.as_chunks_mut().0;
        pivots(&system, block, excess, sums.as_chunks_mut().0);
        let sums = sums.as_chunks_mut().0.as_chunks_mut().0;
        let mut by = Eisenstat { inverse: block, excess: Blocks(excess), sums };
        Ok(pcg::solve_by(&system, &mut by, vectors, stop, free))
    }
}
