//! M = (P + L) P⁻¹ (P + Lᵀ) and its pivots from their definitions, densely; and the solvers that it is the preconditioner of.

use hooke::{BlockIlu, Force, Real, Ssor, System};
use nalgebra::{DMatrix, DVector, Matrix3};

use crate::data::SceneData;

/// Block SSOR for these data. What lies in the workspace before does not matter.
pub fn ssor<T: Real>(data: &SceneData) -> Ssor<Vec<T>> {
    Ssor::new(vec![T::from_f64(f64::NAN); Ssor::needs(data.len())])
}

/// Block D-ILU for these data. What lies in the workspace before does not matter.
pub fn ilu<T: Real>(data: &SceneData) -> BlockIlu<Vec<T>> {
    BlockIlu::new(vec![T::from_f64(f64::NAN); BlockIlu::needs(data.len())])
}

/// A system's matrix.
pub fn matrix<T: Real, F: Force<T>>(system: &System<'_, T, F>) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(3 * system.particles(), 3 * system.particles());
    system.blocks(|a, b, block| {
        (0..9).for_each(|k| matrix[(3 * a + k / 3, 3 * b + k % 3)] += block[k / 3][k % 3].to_f64());
    });
    matrix
}

fn block(matrix: &DMatrix<f64>, a: usize, b: usize) -> Matrix3<f64> {
    matrix.fixed_view::<3, 3>(3 * a, 3 * b).into()
}

/// The blocks of A's diagonal.
pub fn diagonal(matrix: &DMatrix<f64>) -> Vec<Matrix3<f64>> {
    (0..matrix.nrows() / 3).map(|i| block(matrix, i, i)).collect()
}

/// Pᵢ = Aᵢᵢ − Σ_{j<i} Aᵢⱼ Pⱼ⁻¹ Aⱼᵢ
pub fn pivots(matrix: &DMatrix<f64>) -> Vec<Matrix3<f64>> {
    let mut pivots: Vec<Matrix3<f64>> = Vec::new();
    for i in 0..matrix.nrows() / 3 {
        let mut pivot = block(matrix, i, i);
        for (j, earlier) in pivots.iter().enumerate() {
            let a = block(matrix, i, j);
            pivot -= a * earlier.try_inverse().expect("a regular pivot") * a.transpose();
        }
        pivots.push(pivot);
    }
    pivots
}

/// M with these pivots, and |P + L||P⁻¹||P + Lᵀ|, which rounding is measured by.
pub fn preconditioner(matrix: &DMatrix<f64>, pivots: &[Matrix3<f64>]) -> [DMatrix<f64>; 2] {
    let n = matrix.nrows();
    let mut lower = matrix.map_with_location(|row, column, x| if row / 3 > column / 3 { x } else { 0.0 });
    let mut inverse = DMatrix::zeros(n, n);
    for (i, pivot) in pivots.iter().enumerate() {
        lower.fixed_view_mut::<3, 3>(3 * i, 3 * i).copy_from(pivot);
        let inverted = pivot.try_inverse().expect("a regular pivot");
        inverse.fixed_view_mut::<3, 3>(3 * i, 3 * i).copy_from(&inverted);
    }
    let size = lower.abs() * inverse.abs() * lower.transpose().abs();
    [&lower * inverse * lower.transpose(), size]
}

/// The largest |M z − r| of a row, relative to (size |z|) of that row.
pub fn miss<T: Real>([m, size]: &[DMatrix<f64>; 2], z: &[[T; 3]], r: &[[T; 3]]) -> f64 {
    let [z, r] = [z, r].map(|x| DVector::from_iterator(3 * x.len(), x.iter().flatten().map(|x| x.to_f64())));
    let miss = (m * &z - r).abs().component_div(&(size * z.abs()));
    assert!(miss.iter().all(|x| !x.is_nan()));
    miss.max()
}
