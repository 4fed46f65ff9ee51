//! How good an answer Δq̇ is, whoever gave it: the kernel's certified bound ½ Σ|rᵢ|²/μᵢ on the energy of its error, with
//! r = b − A Δq̇ computed anew, and its distance from the exact solution.
//!
//! The exact solution is faer's, improved by two steps of iterative refinement in f64.

use hooke::{Force, Operator, Vec3};

use crate::pattern::{Part, Pattern};
use crate::peers::Peer;
use crate::peers::faer::Faer;
use crate::scenario::Scenario;

/// What an answer is worth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quality {
    /// ½‖e‖²_A is at most this, J (but for the rounding of r itself).
    pub(crate) bound: f64,
    /// ‖Δq̇ − exact‖/‖exact‖
    pub(crate) error: f64,
}

/// A solver of the reference, and its answer at the present state.
pub(crate) struct Judge {
    pattern: Pattern,
    faer: Faer,
    exact: Vec<f64>,
}

/// Shows r = b − A x and μ of each block row at the scene's present state.
fn residual<F: Force<f64> + Clone>(
    scenario: &mut Scenario<F>,
    x: &[f64],
    mut visit: impl FnMut(usize, Vec3<f64>, f64),
) {
    let x = x.as_chunks::<3>().0;
    let mut y = vec![[0.0; 3]; x.len()];
    let shown = scenario.systems(|system, b, mu, first| {
        let rows = first..first + b.len();
        let y = &mut y[rows.clone()];
        system.apply(&x[rows.clone()], y);
        for (((row, b), y), mu) in rows.zip(b).zip(y).zip(mu) {
            visit(row, [0, 1, 2].map(|c| b[c] - y[c]), *mu);
        }
    });
    shown.expect("a step that was made before");
}

fn norm(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

impl Judge {
    pub(crate) fn new<F: Force<f64> + Clone>(scenario: &mut Scenario<F>) -> Result<Self, String> {
        let pattern = Pattern::new(scenario, Part::Lower);
        let faer = Faer::new(&pattern)?;
        Ok(Self { pattern, faer, exact: Vec::new() })
    }

    /// Solves for the scene's present state.
    pub(crate) fn learn<F: Force<f64> + Clone>(&mut self, scenario: &mut Scenario<F>) -> Result<(), String> {
        let n = scenario.unknowns();
        let (mut values, mut b) = (vec![0.0; self.pattern.entries()], vec![0.0; n]);
        self.pattern.fill(scenario, &mut values, &mut b);
        let (mut x, mut change) = (vec![0.0; n], vec![0.0; n]);
        self.faer.solve(&values, &b, &mut x)?;
        for _ in 0..2 {
            residual(scenario, &x, |row, r, _| b[3 * row..][..3].copy_from_slice(&r));
            self.faer.solve(&values, &b, &mut change)?;
            x.iter_mut().zip(&change).for_each(|(x, d)| *x += d);
        }
        self.exact = x;
        if norm(self.exact.iter().copied()) > 0.0 { Ok(()) } else { Err("nothing changes: Δq̇ = 0".into()) }
    }

    /// Judges an answer at the state that was learnt.
    pub(crate) fn judge<F: Force<f64> + Clone>(&self, scenario: &mut Scenario<F>, x: &[f64]) -> Quality {
        let mut bound = 0.0;
        residual(scenario, x, |_, r, mu| bound += 0.5 * r.iter().map(|r| r * r).sum::<f64>() / mu);
        let error = norm(x.iter().zip(&self.exact).map(|(x, e)| x - e)) / norm(self.exact.iter().copied());
        Quality { bound, error }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn the_reference_has_no_error_and_a_wrong_answer_has() {
        let mut scenario = testing::moving("cloth:6");
        let mut judge = Judge::new(&mut scenario).unwrap();
        judge.learn(&mut scenario).unwrap();
        let exact = judge.exact.clone();
        let itself = judge.judge(&mut scenario, &exact);
        assert!(itself.error == 0.0 && itself.bound < 1e-20, "{itself:?}");
        let doubled: Vec<f64> = exact.iter().map(|x| 2.0 * x).collect();
        let wrong = judge.judge(&mut scenario, &doubled);
        assert!(wrong.error == 1.0 && wrong.bound > 1e-6, "{wrong:?}");
    }

    #[test]
    fn a_nan_is_never_a_small_error() {
        let mut scenario = testing::moving("cloth:4");
        let mut judge = Judge::new(&mut scenario).unwrap();
        judge.learn(&mut scenario).unwrap();
        let mut x = judge.exact.clone();
        x[5] = f64::NAN;
        let quality = judge.judge(&mut scenario, &x);
        assert!(quality.error.is_nan() && quality.bound.is_nan());
    }
}
