//! faer's sparse Cholesky, A = LLᵀ with an AMD ordering; supernodal or not as faer chooses. Symbolic factorisation, factor
//! and scratch are kept.

use cpu_time::ThreadTime;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::prelude::*;
use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Par, Side, Spec};

use super::{Peer, Solved};
use crate::pattern::Pattern;

pub(crate) struct Faer {
    column: Vec<usize>,
    row: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    scratch: MemBuffer,
}

pub(crate) fn make(pattern: &Pattern, _: f64) -> Result<Box<dyn Peer>, String> {
    Ok(Box::new(Faer::new(pattern)?))
}

impl Faer {
    /// From the lower triangle.
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, String> {
        let (column, row) = (pattern.column.clone(), pattern.row.clone());
        let n = column.len() - 1;
        let shape = SymbolicSparseColMatRef::new_checked(n, n, &column, None, &row);
        let order = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(shape, Side::Lower, order, Default::default());
        let symbolic = symbolic.map_err(|error| format!("{error:?}"))?;
        let factoring = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let solving = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let scratch = MemBuffer::new(factoring.or(solving));
        let factor = vec![0.0; symbolic.len_val()];
        Ok(Self { column, row, symbolic, factor, scratch })
    }
}

impl Peer for Faer {
    fn solve(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> Result<Solved, String> {
        let Self { column, row, symbolic, factor, scratch } = self;
        let began = ThreadTime::now();
        // The checks of `new_checked` were made on the same arrays before; they cost little beside a factorisation.
        let shape = SymbolicSparseColMatRef::new_checked(b.len(), b.len(), column, None, row);
        let a = SparseColMatRef::new(shape, values);
        let stack = MemStack::new(scratch);
        let regularization = LltRegularization::default();
        let llt = symbolic
            .factorize_numeric_llt(factor, a, Side::Lower, regularization, Par::Seq, stack, Spec::default())
            .map_err(|error| format!("{error:?}"))?;
        x.copy_from_slice(b);
        let columns = MatMut::from_column_major_slice_mut(x, b.len(), 1);
        llt.solve_in_place_with_conj(Conj::No, columns, Par::Seq, stack);
        Ok(Solved { time: began.elapsed(), iterations: 0 })
    }
}
