//! Numbers that a scene file may hold, each refused where it is read: so the error carries the line.

use serde::Deserialize;

/// A finite number above 0.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Positive(pub f64);

/// A finite number, 0 or above.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct NotNegative(pub f64);

/// Three finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(super) struct Triple(pub [f64; 3]);

/// A time and a displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Waypoint(pub f64, pub [f64; 3]);

impl TryFrom<f64> for Positive {
    type Error = String;
    fn try_from(x: f64) -> Result<Self, String> {
        if x.is_finite() && x > 0.0 {
            Ok(Self(x))
        } else {
            Err(format!("{x} is not a positive finite number"))
        }
    }
}

impl TryFrom<f64> for NotNegative {
    type Error = String;
    fn try_from(x: f64) -> Result<Self, String> {
        if x.is_finite() && x >= 0.0 { Ok(Self(x)) } else { Err(format!("{x} is negative, infinite or NaN")) }
    }
}

/// Exactly `N` finite numbers. serde's own arrays would let surplus elements pass in silence.
fn exactly<const N: usize>(list: &[f64], form: &str) -> Result<[f64; N], String> {
    if let Some(x) = list.iter().find(|x| !x.is_finite()) {
        return Err(format!("{x} is not a finite number"));
    }
    list.try_into().map_err(|_| format!("{} numbers where {form} is expected", list.len()))
}

impl TryFrom<Vec<f64>> for Triple {
    type Error = String;
    fn try_from(list: Vec<f64>) -> Result<Self, String> {
        exactly(&list, "[x, y, z]").map(Self)
    }
}

impl TryFrom<&[f64]> for Waypoint {
    type Error = String;
    fn try_from(list: &[f64]) -> Result<Self, String> {
        exactly(list, "[t, x, y, z]").map(|[t, x, y, z]| Self(t, [x, y, z]))
    }
}
