//! The weights of `--solver auto`, fitted to times: least squares of relative errors, no weight below 0.

use hooke_harness::run::auto::Case;
use hooke_harness::run::solver::Method;

use crate::median::median;

/// One solver on one case.
pub(crate) struct Sample {
    pub(crate) case: Case,
    pub(crate) method: Method,
    /// Time of a step.
    pub(crate) ms: f64,
    /// Of all islands.
    pub(crate) iterations: f64,
}

/// x ≥ 0 that makes Σ (aᵢᵀx/yᵢ − 1)² least, by coordinate descent: few unknowns, well apart.
fn fit<const N: usize>(points: &[([f64; N], f64)]) -> [f64; N] {
    let mut x = [0.0; N];
    for _ in 0..5_000 {
        for k in 0..N {
            let (mut top, mut bottom) = (0.0, 0.0);
            for (a, y) in points {
                let others: f64 = (0..N).filter(|j| *j != k).map(|j| a[j] * x[j]).sum();
                let weight = a[k] / y;
                top += weight * (1.0 - others / y);
                bottom += weight * weight;
            }
            x[k] = if bottom > 0.0 { (top / bottom).max(0.0) } else { 0.0 };
        }
    }
    x
}

/// The terms of a sample that [`fit`] weighs, if it is one of this method's.
type Terms<const N: usize> = fn(&Sample) -> Option<[f64; N]>;

fn fitted<'s, const N: usize>(
    samples: impl IntoIterator<Item = &'s Sample>,
    method: Method,
    terms: Terms<N>,
) -> [f64; N] {
    let own = samples.into_iter().filter(|sample| sample.method == method);
    let points: Vec<_> = own.filter_map(|s| Some((terms(s)?, 1e6 * s.ms))).collect();
    fit(&points)
}

/// Σ over islands.
fn size(sample: &Sample) -> f64 {
    sample.case.islands.iter().map(Case::size).sum()
}

/// Setup, and iterations as they were; with several islands the iterations are shared out as their sizes are.
fn iterative(sample: &Sample) -> Option<[f64; 2]> {
    Some([size(sample), size(sample) * sample.iterations / sample.case.islands.len() as f64])
}

fn is_chain(sample: &Sample) -> bool {
    sample.case.islands.iter().all(|island| island.half_bandwidth <= 1)
}

fn rows(sample: &Sample) -> f64 {
    sample.case.islands.iter().map(|island| island.rows as f64).sum()
}

/// Median over the samples of what a method's iterations are per halving and unit of difficulty.
fn per_halving<'s>(
    samples: impl IntoIterator<Item = &'s Sample>,
    method: Method,
    difficulty: fn(f64) -> f64,
) -> f64 {
    let own = samples.into_iter().filter(|s| s.method == method && s.case.halvings < 30.0);
    median(own.map(|s| {
        let all: f64 = s.case.islands.iter().map(|island| difficulty(Case::difficulty(island))).sum();
        s.iterations / (all * s.case.halvings)
    }))
}

/// The table as it stands in the source.
pub(crate) fn text(samples: &[Sample]) -> String {
    let [chain] = fitted(samples, Method::Banded, |s| is_chain(s).then(|| [rows(s)]));
    let band = fitted(samples, Method::Banded, |s| {
        let work = |island: &hooke_harness::run::structure::Island| {
            island.rows as f64 * (island.half_bandwidth as f64).powi(2)
        };
        (!is_chain(s)).then(|| [rows(s), s.case.islands.iter().map(work).sum()])
    });
    let sparse = |method| {
        fitted(samples, method, |s| {
            let fill = s.case.fill?;
            Some([size(s), fill.blocks, fill.products])
        })
    };
    let [ldl, ldl32] = [Method::Ldl, Method::Ldl32].map(sparse);
    let list = |values: &[f64]| values.iter().map(|x| format!("{x:.2}")).collect::<Vec<_>>().join(", ");
    let mut text = String::from("\npub const WEIGHTS: Weights = Weights {\n");
    type Line = (&'static str, Method, fn(f64) -> f64, fn(&Sample) -> bool);
    let solvers: [Line; 8] = [
        ("jacobi", Method::Jacobi, |d| d, |_| true),
        ("wide", Method::Wide, |d| d, |s| s.case.lanes),
        ("slots", Method::Wide, |d| d, |s| !s.case.lanes),
        ("wide32", Method::Wide32, |d| d, |s| s.case.lanes),
        ("slots32", Method::Wide32, |d| d, |s| !s.case.lanes),
        ("multigrid", Method::Multigrid, f64::sqrt, |s| s.case.lanes),
        ("loose", Method::Multigrid, f64::sqrt, |s| !s.case.lanes && !s.case.solid()),
        ("solid", Method::Multigrid, f64::sqrt, |s| !s.case.lanes && s.case.solid()),
    ];
    for (name, method, difficulty, which) in solvers {
        let own = || samples.iter().filter(|s| which(s));
        let iterations = per_halving(own(), method, difficulty);
        let [setup, iteration] = fitted(own(), method, iterative);
        text += &format!(
            "    {name}: Iterative {{ iterations: {iterations:.3}, setup: {setup:.2}, iteration: {iteration:.2} }},\n"
        );
    }
    text + &format!(
        "    chain: {chain:.1},\n    band: [{}],\n    ldl: [{}],\n    ldl32: [{}],\n}};\n",
        list(&band),
        list(&ldl),
        list(&ldl32)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn made_times_give_back_the_weights_they_were_made_with() {
        let points: Vec<_> = [[1.0, 10.0], [5.0, 1.0], [7.0, 300.0], [90.0, 2.0]]
            .map(|a: [f64; 2]| (a, 3.0 * a[0] + 0.5 * a[1]))
            .into();
        let [a, b] = fit(&points);
        assert!((a - 3.0).abs() < 1e-6 && (b - 0.5).abs() < 1e-6, "{a} {b}");
    }

    #[test]
    fn no_weight_is_negative() {
        let points = [([1.0, 1.0], 1.0), ([1.0, 2.0], 0.5)];
        assert!(fit(&points).iter().all(|x| *x >= 0.0));
    }
}
