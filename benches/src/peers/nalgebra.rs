//! nalgebra-sparse's Cholesky: left-looking, in the scene's own numbering (it has no reordering). The symbolic part and
//! the factor are kept, `refactor` each time.

use cpu_time::ThreadTime;
use nalgebra_sparse::factorization::{CscCholesky, CscSymbolicCholesky};
use nalgebra_sparse::na::DVector;
use nalgebra_sparse::pattern::SparsityPattern;

use super::{Peer, Solved, affordable};
use crate::pattern::Pattern;

struct Nalgebra {
    /// None before the first solve.
    cholesky: Option<CscCholesky<f64>>,
    symbolic: CscSymbolicCholesky,
    x: DVector<f64>,
}

pub(crate) fn make(pattern: &Pattern, _: f64) -> Result<Box<dyn Peer>, String> {
    let n = pattern.column.len() - 1;
    // The symbolic factorisation itself stores the whole factor: judge by the profile before.
    affordable((0..n).map(|j| pattern.row[pattern.column[j + 1] - 1] + 1 - j))?;
    let shape =
        SparsityPattern::try_from_offsets_and_indices(n, n, pattern.column.clone(), pattern.row.clone());
    let symbolic = CscSymbolicCholesky::factor(shape.map_err(|error| error.to_string())?);
    Ok(Box::new(Nalgebra { cholesky: None, symbolic, x: DVector::zeros(n) }))
}

impl Peer for Nalgebra {
    fn solve(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> Result<Solved, String> {
        let cholesky = match &mut self.cholesky {
            Some(cholesky) => cholesky,
            None => {
                let first = CscCholesky::factor_numerical(self.symbolic.clone(), values);
                self.cholesky.insert(first.map_err(|error| error.to_string())?)
            }
        };
        let began = ThreadTime::now();
        cholesky.refactor(values).map_err(|error| error.to_string())?;
        self.x.as_mut_slice().copy_from_slice(b);
        cholesky.solve_mut(&mut self.x);
        x.copy_from_slice(self.x.as_slice());
        Ok(Solved { time: began.elapsed(), iterations: 0 })
    }
}
