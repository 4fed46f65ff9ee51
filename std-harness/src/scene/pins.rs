//! Pin rules: which particles are held, said in one word: `none`, `min-y:D`, `vertices:0,31`.

use std::str::FromStr;

use crate::error::InputError;

/// Which particles are pinned.
#[derive(Debug, Clone, PartialEq)]
pub enum PinRule {
    /// Nothing.
    None,
    /// Everything within D metres of the lowest y.
    MinY(f64),
    /// These ids.
    Vertices(Vec<usize>),
}

impl FromStr for PinRule {
    type Err = InputError;

    fn from_str(rule: &str) -> Result<Self, InputError> {
        let (name, value) = rule.split_once(':').unwrap_or((rule, ""));
        match (name, value) {
            ("none", "") => Ok(Self::None),
            ("min-y", value) => match value.parse::<f64>() {
                Ok(d) if d.is_finite() && d >= 0.0 => Ok(Self::MinY(d)),
                _ => Err(InputError::new(format!(
                    "pin rule '{rule}': '{value}' is not a distance in metres, as in min-y:3"
                ))),
            },
            ("vertices", value) => value
                .split(',')
                .map(|id| {
                    id.trim().parse().map_err(|_| {
                        InputError::new(format!(
                            "pin rule '{rule}': '{id}' is not a vertex id, as in vertices:0,31"
                        ))
                    })
                })
                .collect::<Result<_, _>>()
                .map(Self::Vertices),
            _ => Err(InputError::new(format!(
                "unknown pin rule '{rule}'{}; the rules are none, min-y:D and vertices:0,31",
                crate::nearest::suggestion(name, &["none", "min-y", "vertices"])
            ))),
        }
    }
}

impl PinRule {
    /// Which of these particles the rule pins. A rule that pins nothing or everything is refused: only `none` asks for
    /// nothing, and a scene without unknowns has nothing to simulate.
    pub fn apply(&self, position: &[[f64; 3]]) -> Result<Vec<bool>, InputError> {
        let mut pinned = vec![false; position.len()];
        match self {
            Self::None => return Ok(pinned),
            Self::MinY(d) => {
                let lowest = position.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min);
                for (pin, x) in pinned.iter_mut().zip(position) {
                    *pin = x[1] <= lowest + d;
                }
            }
            Self::Vertices(ids) => {
                for id in ids {
                    *pinned.get_mut(*id).ok_or_else(|| {
                        let last = position.len().saturating_sub(1);
                        InputError::new(format!("there is no vertex {id} to pin; ids run from 0 to {last}"))
                    })? = true;
                }
            }
        }
        let count = pinned.iter().filter(|p| **p).count();
        if count == 0 {
            return Err(InputError::new("this pins nothing; say 'none' if that is meant"));
        }
        if count == pinned.len() {
            return Err(InputError::new(format!(
                "this pins all {count} particles and nothing is left to move, so lower the distance or name fewer vertices"
            )));
        }
        Ok(pinned)
    }
}
