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
    /// Displacement at time t, m, and its rate, m/s.
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
                if t <= first.0 {
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
}
