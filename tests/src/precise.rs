//! The same physics in 208 bits (62 digits): V, L, their derivatives by differences, and exact solves of small systems.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

use crate::data::SceneData;

/// A number of 208 bits.
pub type Big = FBig<HalfEven, 2>;

/// Bits of every number here.
pub const BITS: usize = 208;

/// The exact value of an `f64` (finite).
pub fn big(x: f64) -> Big {
    with_bits(x, BITS)
}

/// The same as a number of at least 53 bits, which what is made of it has too.
pub fn with_bits(x: f64, bits: usize) -> Big {
    let exact = FBig::<HalfEven, 2>::try_from(x).expect("a finite number");
    exact.with_precision(bits).value()
}

/// Rounded to `f64`.
pub fn small(x: &Big) -> f64 {
    x.to_f64().value()
}

/// 2^−p
pub fn two_to_minus(p: i32) -> Big {
    big(2f64.powi(-p))
}

/// Positions or velocities of the data.
pub fn bigs(of: &[[f64; 3]]) -> Vec<[Big; 3]> {
    of.iter().map(|x| x.map(big)).collect()
}

fn squared(x: &[Big; 3]) -> Big {
    x.iter().map(|x| x * x).fold(big(0.0), |sum, x| sum + x)
}

fn minus(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// √x
pub fn root(x: &Big) -> Big {
    if *x == big(0.0) { big(0.0) } else { x.sqrt() }
}

/// V = Σ ½k(l − l₀)² of the springs at q.
pub fn potential(data: &SceneData, q: &[[Big; 3]]) -> Big {
    let half = big(0.5);
    data.springs.iter().fold(big(0.0), |sum, s| {
        let strain = root(&squared(&minus(&q[s.a], &q[s.b]))) - big(s.l0);
        sum + &half * big(s.k) * &strain * &strain
    })
}

/// T = Σ ½m|q̇|².
pub fn kinetic(data: &SceneData, velocity: &[[Big; 3]]) -> Big {
    let half = big(0.5);
    let each = data.mass.iter().zip(velocity);
    each.fold(big(0.0), |sum, (m, v)| sum + &half * big(*m) * squared(v))
}

/// L = T − V.
pub fn lagrangian(data: &SceneData, q: &[[Big; 3]], velocity: &[[Big; 3]]) -> Big {
    kinetic(data, velocity) - potential(data, q)
}

/// ∂V/∂q = Σ E_jᵀ k(1 − l₀/l)(Δx, −Δx).
pub fn gradient(data: &SceneData, q: &[[Big; 3]]) -> Vec<[Big; 3]> {
    let mut sum = vec![[0.0; 3].map(big); data.len()];
    for s in &data.springs {
        let delta = minus(&q[s.a], &q[s.b]);
        let length = root(&squared(&delta));
        let factor = big(s.k) * (big(1.0) - big(s.l0) / length);
        for d in 0..3 {
            let g = &factor * &delta[d];
            sum[s.a][d] += &g;
            sum[s.b][d] -= &g;
        }
    }
    sum
}

/// ∂f/∂x by a central difference of step 2^−40, per component: its own error is of the order 2^−80.
pub fn derivative(of: impl Fn(&[[Big; 3]]) -> Big, at: &[[Big; 3]]) -> Vec<[f64; 3]> {
    let step = two_to_minus(40);
    let mut moved = at.to_vec();
    let mut derivative = vec![[0.0; 3]; at.len()];
    for i in 0..at.len() {
        for d in 0..3 {
            moved[i][d] = &at[i][d] + &step;
            let after = of(&moved);
            moved[i][d] = &at[i][d] - &step;
            let before = of(&moved);
            moved[i][d] = at[i][d].clone();
            derivative[i][d] = small(&((after - before) / (&step + &step)));
        }
    }
    derivative
}

/// A symmetric positive definite matrix's factor L Δ Lᵀ; `None` if a pivot is not positive.
#[derive(Debug, Clone)]
pub struct Factor {
    lower: Vec<Vec<Big>>,
    pivot: Vec<Big>,
}

impl Factor {
    /// Of the lower triangle of a matrix, by rows.
    pub fn new(matrix: &[Vec<Big>]) -> Option<Self> {
        let n = matrix.len();
        let (mut lower, mut pivot): (Vec<Vec<Big>>, Vec<Big>) = (Vec::new(), Vec::new());
        for i in 0..n {
            // row[j] = lᵢⱼδⱼ first, then divided.
            let mut row: Vec<Big> = Vec::with_capacity(i);
            for j in 0..i {
                let mut sum = matrix[i][j].clone();
                for k in 0..j {
                    // Chains are mostly zeros.
                    if !row[k].repr().significand().is_zero() && !lower[j][k].repr().significand().is_zero() {
                        sum -= &row[k] * &lower[j][k];
                    }
                }
                row.push(sum);
            }
            let mut last = matrix[i][i].clone();
            for j in 0..i {
                let l = &row[j] / &pivot[j];
                last -= &row[j] * &l;
                row[j] = l;
            }
            if last <= big(0.0) {
                return None;
            }
            lower.push(row);
            pivot.push(last);
        }
        Some(Self { lower, pivot })
    }

    /// rᵀA⁻¹r = Σ yᵢ²/δᵢ with L y = r.
    pub fn inverse_form(&self, r: &[Big]) -> Big {
        let mut y: Vec<Big> = Vec::with_capacity(r.len());
        let mut form = big(0.0);
        for i in 0..r.len() {
            let mut sum = r[i].clone();
            for (l, y) in self.lower[i].iter().zip(&y) {
                sum -= l * y;
            }
            form += &sum * &sum / &self.pivot[i];
            y.push(sum);
        }
        form
    }

    /// A⁻¹ r
    pub fn solve(&self, r: &[Big]) -> Vec<Big> {
        let n = r.len();
        let mut x = r.to_vec();
        for i in 0..n {
            for j in 0..i {
                let known = &self.lower[i][j] * &x[j];
                x[i] -= known;
            }
        }
        for i in 0..n {
            x[i] = &x[i] / &self.pivot[i];
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                let known = &self.lower[j][i] * &x[j];
                x[i] -= known;
            }
        }
        x
    }
}
