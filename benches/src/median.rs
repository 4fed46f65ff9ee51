//! Medians and worst values. A NaN counts as the worst: it must not be lost in a sum-up.

/// The values in order, NaN last.
fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.into_iter().map(|x| if x.is_nan() { f64::NAN } else { x }).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The middle value, or the mean of the middle two; NaN of nothing.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let values = sorted(values);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// The largest value, NaN if there is one.
pub(crate) fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    sorted(values).last().copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_the_worst_whatever_its_sign() {
        assert!(worst([1.0, -f64::NAN, 2.0]).is_nan());
        assert_eq!(worst([1.0, 3.0, 2.0]), 3.0);
        assert_eq!(median([3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median([4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median([f64::NAN, 1.0, f64::NAN]).is_nan());
    }
}
