//! sprs-ldl: up-looking LDLᵀ with a reverse Cuthill-McKee ordering. The symbolic part and the factor are kept, `update`
//! each time.

use cpu_time::ThreadTime;
use sprs::{CsMatView, FillInReduction, SymmetryCheck};
use sprs_ldl::{Ldl, LdlNumeric};

use super::{Peer, Solved, affordable};
use crate::pattern::Pattern;

struct Sprs {
    column: Vec<usize>,
    row: Vec<usize>,
    ldl: LdlNumeric<f64, usize>,
}

pub(crate) fn make(pattern: &Pattern, _: f64) -> Result<Box<dyn Peer>, String> {
    let (column, row) = (pattern.column.clone(), pattern.row.clone());
    let n = column.len() - 1;
    // Unit entries on the diagonal stand for the values, which are not known yet.
    let mut values = vec![0.0; row.len()];
    for j in 0..n {
        let k = column[j] + row[column[j]..column[j + 1]].partition_point(|r| *r < j);
        values[k] = 1.0;
    }
    let shape = CsMatView::new_csc((n, n), &column, &row, &values);
    let builder = Ldl::new()
        .check_symmetry(SymmetryCheck::DontCheckSymmetry)
        .fill_in_reduction(FillInReduction::ReverseCuthillMcKee);
    let symbolic = builder.symbolic(shape);
    // The average length of a column stands for all of them: the profile of this ordering is even.
    affordable(std::iter::repeat_n(symbolic.nnz() / n.max(1), n))?;
    let ldl = symbolic.factor(shape).map_err(|error| error.to_string())?;
    Ok(Box::new(Sprs { column, row, ldl }))
}

impl Peer for Sprs {
    fn solve(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> Result<Solved, String> {
        let began = ThreadTime::now();
        let n = b.len();
        let a = CsMatView::new_csc((n, n), &self.column, &self.row, values);
        self.ldl.update(a).map_err(|error| error.to_string())?;
        x.copy_from_slice(&self.ldl.solve(b));
        Ok(Solved { time: began.elapsed(), iterations: 0 })
    }
}
