//! Pins that move: a path for the displacement of some pinned particles, as a function of time.

use std::f64::consts::TAU;

/// How a pin moves, as a displacement from where it was at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// d = v t: constant velocity, m/s.
    Linear {
        /// m/s
        velocity: [f64; 3],
    },
    /// d = a sin(2πft): amplitude in m, frequency in Hz.
    Oscillate {
        /// m
        amplitude: [f64; 3],
        /// Hz
        frequency: f64,
    },
    /// Through these displacements (s, m), linear between them, at rest before and after. Times increase.
    Through {
        /// (t, d)
        points: Vec<(f64, [f64; 3])>,
    },
}

/// Some pins and their path.
#[derive(Debug, Clone, PartialEq)]
pub struct Moving {
    /// Ids of pinned particles.
    pub particles: Vec<usize>,
    /// Their common path.
    pub path: Path,
}

impl Path {
    /// Displacement at time t, m, and its rate, m/s; at a corner that with which it goes on.
    pub fn at(&self, t: f64) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Linear { velocity } => (velocity.map(|v| v * t), *velocity),
            Self::Oscillate { amplitude, frequency } => {
                let phase = TAU * frequency * t;
                (amplitude.map(|a| a * phase.sin()), amplitude.map(|a| a * TAU * frequency * phase.cos()))
            }
            Self::Through { points } => {
                let (Some(first), Some(last)) = (points.first(), points.last()) else {
                    return ([0.0; 3], [0.0; 3]);
                };
                if t < first.0 {
                    return (first.1, [0.0; 3]);
                }
                for pair in points.windows(2) {
                    let [(t0, d0), (t1, d1)] = [pair[0], pair[1]];
                    if t < t1 {
                        let rate: [f64; 3] = std::array::from_fn(|c| (d1[c] - d0[c]) / (t1 - t0));
                        return (std::array::from_fn(|c| d0[c] + rate[c] * (t - t0)), rate);
                    }
                }
                (last.1, [0.0; 3])
            }
        }
    }

    /// The rate with which time t is reached, m/s: at a corner another than that with which it goes on.
    pub fn arrives(&self, t: f64) -> [f64; 3] {
        let Self::Through { points } = self else { return self.at(t).1 };
        let mut pairs = points.windows(2);
        match pairs.find(|pair| pair[0].0 < t && t <= pair[1].0) {
            Some(pair) => self.at(pair[0].0).1,
            None => [0.0; 3],
        }
    }

    /// The first corner after time t, s; infinite if there is none.
    pub fn corner_after(&self, t: f64) -> f64 {
        match self {
            Self::Through { points } => points.iter().map(|point| point.0).find(|corner| *corner > t),
            _ => None,
        }
        .unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_is_reached_with_one_rate_and_left_with_the_next() {
        let points = vec![(0.0, [0.0; 3]), (1.0, [2.0, 0.0, 0.0]), (3.0, [2.0, 8.0, 0.0])];
        let path = Path::Through { points };
        let rates = [0.0, 0.5, 1.0, 2.0, 3.0, 4.0].map(|t| (path.arrives(t), path.at(t).1));
        let [rest, first, second] = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let expected =
            [(rest, first), (first, first), (first, second), (second, second), (second, rest), (rest, rest)];
        assert_eq!(rates, expected);
        assert_eq!(
            [-1.0, 0.0, 0.5, 1.0, 3.0].map(|t| path.corner_after(t)),
            [0.0, 1.0, 1.0, 3.0, f64::INFINITY]
        );
        let smooth = Path::Linear { velocity: first };
        assert_eq!((smooth.arrives(0.0), smooth.corner_after(0.0)), (first, f64::INFINITY));
    }
}
