//! κ(A) = λ_max/λ_min of the stored matrix.
//!
//! Up to 1e10 both come from nalgebra's eigenvalues in `f64`, which are off by about n·u·λ_max. Beyond that λ_min is 1/λ_max
//! of A⁻¹, inverted in 62 digits: there `f64` would see rounding only.

use nalgebra::DMatrix;

use crate::precise::{Big, Factor, big, small};

/// Above this `f64` is not asked.
const TRUSTED: f64 = 1e10;

/// Condition number of a matrix with this factor.
pub fn condition(matrix: &[Vec<Big>], factor: &Factor) -> f64 {
    let n = matrix.len();
    let largest = (0..n).map(|i| matrix[i][i].clone()).fold(big(0.0), |a, b| if a < b { b } else { a });
    // Scaled, since squares of faint entries would underflow.
    let scaled = DMatrix::from_fn(n, n, |i, j| small(&(&matrix[i][j] / &largest)));
    let values = scaled.symmetric_eigenvalues();
    let (least, most) = (values.min(), values.max());
    if least * TRUSTED > most {
        return most / least;
    }
    let mut columns = Vec::new();
    for j in 0..n {
        let mut unit = vec![big(0.0); n];
        unit[j] = largest.clone();
        columns.push(factor.solve(&unit));
    }
    let inverse = DMatrix::from_fn(n, n, |i, j| small(&columns[j][i]));
    most * inverse.symmetric_eigenvalues().max()
}
