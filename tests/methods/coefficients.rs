//! The coefficients of Rosenbrock methods, made anew from each method's own α, γᵢⱼ, b and b̂; and the conditions of its order.

// The published digits, all of them.
#![allow(clippy::excessive_precision)]

use hooke::{Combination, Ros2, Ros34Pw2, Tableau};
use hooke_tests::allowed;
use nalgebra::{DMatrix, RowDVector};

/// A Rosenbrock method as it is published.
pub struct Published {
    pub gamma: f64,
    /// Below the diagonal
    pub alpha: Vec<Vec<f64>>,
    /// Below the diagonal
    pub gammas: Vec<Vec<f64>>,
    /// b
    pub b: Vec<f64>,
    /// b̂
    pub lower: Vec<f64>,
}

impl Published {
    /// α + Γ with γ on the diagonal
    pub fn beta(&self) -> Vec<Vec<f64>> {
        let row = |(a, g): (&Vec<f64>, &Vec<f64>)| {
            let mut row: Vec<f64> = a.iter().zip(g).map(|(a, g)| a + g).collect();
            row.push(self.gamma);
            row
        };
        self.alpha.iter().zip(&self.gammas).map(row).collect()
    }

    fn matrices(&self) -> [DMatrix<f64>; 2] {
        let n = self.b.len();
        let at = |rows: &[Vec<f64>], r: usize, c: usize| rows[r].get(c).map_or(0.0, |x| *x);
        let alpha = DMatrix::from_fn(n, n, |r, c| at(&self.alpha, r, c));
        let gamma = DMatrix::from_fn(n, n, |r, c| if r == c { self.gamma } else { at(&self.gammas, r, c) });
        [alpha, gamma]
    }
}

/// Rang & Angermann 2005, table 4
pub fn ros34pw2() -> Published {
    Published {
        gamma: 4.3586652150845900e-01,
        alpha: vec![
            vec![],
            vec![8.7173304301691801e-01],
            vec![8.4457060015369423e-01, -1.1299064236484185e-01],
            vec![0.0, 0.0, 1.0],
        ],
        gammas: vec![
            vec![],
            vec![-8.7173304301691801e-01],
            vec![-9.0338057013044082e-01, 5.4180672388095326e-02],
            vec![2.4212380706095346e-01, -1.2232505839045147e+00, 5.4526025533510214e-01],
        ],
        b: vec![
            2.4212380706095346e-01,
            -1.2232505839045147e+00,
            1.5452602553351020e+00,
            4.3586652150845900e-01,
        ],
        lower: vec![
            3.7810903145819369e-01,
            -9.6042292212423178e-02,
            5.0000000000000000e-01,
            2.1793326075422950e-01,
        ],
    }
}

/// Verwer et al. 1999: Wk₁ = F(y), Wk₂ = F(y + hk₁) − 2k₁ with k₂ + 2k₁ as second stage is α₂₁ = 1, γ₂₁ = −2γ, b = (½, ½).
pub fn ros2() -> Published {
    let gamma = 1.0 - 0.5f64.sqrt();
    Published {
        gamma,
        alpha: vec![vec![], vec![1.0]],
        gammas: vec![vec![], vec![-2.0 * gamma]],
        b: vec![0.5, 0.5],
        lower: vec![1.0, 0.0],
    }
}

fn near(what: &str, found: f64, expected: f64) {
    let off = (found - expected).abs();
    assert!(off <= allowed::COEFFICIENT * allowed::U64, "{what}: {found} is not {expected}: {off:e}");
}

fn combination(what: &str, found: &Combination, own: f64, stages: impl Iterator<Item = f64>) {
    near(what, found.own, own);
    list(what, found.stages, stages);
}

fn list(what: &str, found: &[f64], expected: impl Iterator<Item = f64>) {
    let expected: Vec<f64> = expected.collect();
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        near(what, *found, expected);
    }
}

/// The kernel's form of a method: stages in u = γh Γk, of which only the velocities' part is stored.
fn derived<K: Tableau>(of: &Published, trapezoidal: bool) {
    let n = of.b.len();
    let [alpha, gamma] = of.matrices();
    let inverse = gamma.solve_lower_triangular(&DMatrix::identity(n, n)).expect("γ is not 0");
    let a = &alpha * &inverse;
    let c = DMatrix::identity(n, n) - of.gamma * &inverse;
    let m = RowDVector::from_row_slice(&of.b) * &inverse;
    let lower = RowDVector::from_row_slice(&of.lower) * &inverse;
    // The positions' part of uᵢ is γh(gᵢq̇ + ΣQᵢⱼu̇ⱼ).
    let (mut g, mut q) = (vec![0.0; n], DMatrix::<f64>::zeros(n, n));
    for i in 0..n {
        g[i] = 1.0 + (0..i).map(|k| c[(i, k)] * g[k]).sum::<f64>();
        q[(i, i)] = 1.0;
        for j in 0..i {
            q[(i, j)] = a[(i, j)] + (j..i).map(|k| c[(i, k)] * q[(k, j)]).sum::<f64>();
        }
    }
    near("γ", K::GAMMA, of.gamma);
    assert_eq!(K::STAGES.len(), n);
    for (i, stage) in K::STAGES.iter().enumerate() {
        near("time", stage.time, alpha.row(i).sum());
        near("turn", stage.turn, gamma.row(i).sum() / of.gamma);
        let own = (0..i).map(|j| a[(i, j)] * g[j]).sum();
        let stages = (0..i).map(|k| (k..i).map(|j| a[(i, j)] * q[(j, k)]).sum());
        combination("position", &stage.position, own, stages);
        list("velocity", stage.velocity, (0..i).map(|j| a[(i, j)]));
        list("mass", stage.mass, (0..i).map(|j| c[(i, j)]));
        combination("rate", &stage.rate, g[i], (0..i).map(|j| q[(i, j)]));
    }
    let sums = |m: &RowDVector<f64>| -> (f64, Vec<f64>) {
        let own = (0..n).map(|i| m[i] * g[i]).sum();
        (own, (0..n).map(|j| (j..n).map(|i| m[i] * q[(i, j)]).sum()).collect())
    };
    let (own, stages) = sums(&m);
    let step = (own, stages.clone());
    combination("y⁺, positions", &K::POSITION, own, stages.into_iter());
    list("y⁺, velocities", K::VELOCITY, m.iter().copied());
    let error = &m - &lower;
    // q⁺ − q − ½h(q̇ + q̇⁺) in units of γh, or the difference to the lower answer.
    let (own, stages) = if trapezoidal {
        let half = 0.5 / of.gamma;
        (step.0 - 2.0 * half, step.1.iter().zip(m.iter()).map(|(q, m)| q - half * m).collect())
    } else {
        sums(&error)
    };
    combination("δ, positions", &K::ERROR.0, own, stages.into_iter());
    list("δ, velocities", K::ERROR.1, error.iter().copied());
}

#[test]
fn the_coefficients_of_ros3_are_those_of_the_published_method() {
    derived::<Ros34Pw2>(&ros34pw2(), false);
}

#[test]
fn the_coefficients_of_ros2_are_those_of_the_published_method() {
    derived::<Ros2>(&ros2(), true);
}

/// Σ bᵢ of the products of what `of` gives for stage i.
fn weighed(b: &[f64], of: impl Fn(usize) -> f64) -> f64 {
    b.iter().enumerate().map(|(i, b)| b * of(i)).sum()
}

/// The conditions of a W-method of order 2: with any matrix in place of J.
fn second_order(method: &Published, b: &[f64]) {
    let [alpha, gamma] = method.matrices();
    near("Σb", weighed(b, |_| 1.0), 1.0);
    near("Σbα", weighed(b, |i| alpha.row(i).sum()), 0.5);
    near("Σbγ", weighed(b, |i| gamma.row(i).sum()), 0.0);
}

#[test]
fn ros2_meets_the_conditions_of_a_w_method_of_order_2_and_its_lower_answer_those_of_order_1() {
    let method = ros2();
    second_order(&method, &method.b);
    near("Σb̂", method.lower.iter().sum(), 1.0);
}

#[test]
fn ros3_meets_the_conditions_of_a_w_method_of_order_3_and_its_lower_answer_those_of_order_2() {
    let method = ros34pw2();
    let [alpha, gamma] = method.matrices();
    let n = method.b.len();
    let row = |m: &DMatrix<f64>, i: usize| m.row(i).sum();
    let nested = |outer: &DMatrix<f64>, inner: &DMatrix<f64>| {
        weighed(&method.b, |i| (0..n).map(|j| outer[(i, j)] * row(inner, j)).sum())
    };
    second_order(&method, &method.b);
    near("Σbα²", weighed(&method.b, |i| row(&alpha, i).powi(2)), 1.0 / 3.0);
    near("Σbαα", nested(&alpha, &alpha), 1.0 / 6.0);
    near("Σbαγ", nested(&alpha, &gamma), 0.0);
    near("Σbγα", nested(&gamma, &alpha), 0.0);
    near("Σbγγ", nested(&gamma, &gamma), 0.0);
    // With the true J the lower answer has order 2.
    let beta = |i: usize| row(&alpha, i) + row(&gamma, i);
    near("Σb̂", method.lower.iter().sum(), 1.0);
    near("Σb̂β", weighed(&method.lower, beta), 0.5);
    println!("Σb̂α = {}: order 2 with any matrix too", weighed(&method.lower, |i| row(&alpha, i)));
    // Stiffly accurate: the last stage is the answer.
    for (last, b) in method.beta()[n - 1].iter().zip(&method.b) {
        near("βₙⱼ − bⱼ", last - b, 0.0);
    }
}
