//! The exponent of a power law: y ≈ c nᵖ, p by least squares over (ln n, ln y).

/// p, or `None` with fewer than two different n or a value that has no logarithm.
pub(crate) fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, y)| (n.ln(), y.ln())).collect();
    let mean = |value: fn(&(f64, f64)) -> f64| logs.iter().map(value).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let slope = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    if spread > 1e-12 && slope.is_finite() { Some(slope) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn made_data_gives_back_the_exponent_it_was_made_with() {
        for p in [0.5, 1.0, 1.5, 2.0] {
            let points: Vec<_> = [10.0, 37.0, 400.0, 9e4].map(|n: f64| (n, 3.0 * n.powf(p))).into();
            assert!((exponent(&points).unwrap() - p).abs() < 1e-12);
        }
        // Errors of +10 % and −10 % at the same n cancel nearly: ln 1.1 + ln 0.9 = −0.01.
        let noisy = [(1.0, 1.1), (1.0, 0.9), (100.0, 110.0), (100.0, 90.0)];
        assert!((exponent(&noisy).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn where_there_is_no_law_there_is_no_exponent() {
        assert_eq!(exponent(&[]), None);
        assert_eq!(exponent(&[(5.0, 1.0), (5.0, 2.0)]), None);
        assert_eq!(exponent(&[(5.0, 0.0), (6.0, 2.0)]), None);
        assert_eq!(exponent(&[(5.0, f64::NAN), (6.0, 2.0)]), None);
    }
}
