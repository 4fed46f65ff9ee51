//! What a user would otherwise solve with: sparse direct solvers and Eigen's conjugate gradients, each at its best (all
//! that depends on the pattern only is done once). To add one, write its file and a line in [`PEERS`].

mod cpp;
pub(crate) mod faer;
mod nalgebra;
mod sprs;

use std::time::Duration;

use crate::pattern::{Part, Pattern};

/// One numeric factorisation and solve, or one iterative solve.
pub(crate) struct Solved {
    pub(crate) time: Duration,
    pub(crate) iterations: u32,
}

/// A solver that knows the pattern.
pub(crate) trait Peer {
    /// Solves A x = b for the entries `values` of A; times itself.
    fn solve(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> Result<Solved, String>;

    /// Bytes of its factor and inputs after a solve, where they are not on this process's heap.
    fn bytes_elsewhere(&self) -> Option<usize> {
        None
    }
}

/// How a peer is made from the pattern (and the tolerance, if it iterates), or why it is skipped.
type Make = fn(&Pattern, f64) -> Result<Box<dyn Peer>, String>;

/// A peer by name.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) part: Part,
    /// Does it stop at a tolerance?
    pub(crate) iterates: bool,
    pub(crate) make: Make,
}

const fn direct(name: &'static str, part: Part, make: Make) -> Entry {
    Entry { name, part, iterates: false, make }
}

/// All peers.
pub(crate) const PEERS: [Entry; 6] = [
    direct("faer LLT", Part::Lower, faer::make),
    direct("nalgebra-sparse", Part::Full, nalgebra::make),
    direct("sprs-ldl", Part::Full, sprs::make),
    direct("CHOLMOD supernodal", Part::Lower, cpp::cholmod),
    direct("Eigen LDLT", Part::Lower, cpp::eigen_ldlt),
    Entry { name: "Eigen CG diagonal", part: Part::Full, iterates: true, make: cpp::eigen_cg },
];

/// More multiplications than this in one factorisation take minutes: skipped.
const MOST_WORK: f64 = 5e10;

/// Refuses a factor whose columns have these lengths if it is too much work.
pub(crate) fn affordable(lengths: impl Iterator<Item = usize>) -> Result<(), String> {
    let work: f64 = lengths.map(|n| (n * n) as f64).sum();
    if work <= MOST_WORK {
        Ok(())
    } else {
        Err(format!("its ordering makes a factorisation of {work:.0e} multiplications"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn every_peer_solves_a_small_system_to_1e_10() {
        for entry in PEERS {
            for name in ["cloth:4", "lattice:3x3x2"] {
                let mut scenario = testing::moving(name);
                let pattern = Pattern::new(&mut scenario, entry.part);
                let full = Pattern::new(&mut scenario, Part::Full);
                let n = scenario.unknowns();
                let (mut values, mut entries) = (vec![0.0; pattern.entries()], vec![0.0; full.entries()]);
                let (mut b, mut x) = (vec![0.0; n], vec![0.0; n]);
                full.fill(&mut scenario, &mut entries, &mut b);
                pattern.fill(&mut scenario, &mut values, &mut b);
                let mut peer = match (entry.make)(&pattern, 1e-13) {
                    Ok(peer) => peer,
                    Err(why) => {
                        println!("{}: skipped: {why}", entry.name);
                        continue;
                    }
                };
                // Twice: the second solve reuses what the first left behind.
                for _ in 0..2 {
                    x.fill(0.0);
                    peer.solve(&values, &b, &mut x).unwrap();
                    let mut r = b.clone();
                    for (j, column) in full.column.windows(2).enumerate() {
                        for k in column[0]..column[1] {
                            r[full.row[k]] -= entries[k] * x[j];
                        }
                    }
                    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                    assert!(
                        norm(&r) <= 1e-10 * norm(&b),
                        "{} on {name}: {:e}",
                        entry.name,
                        norm(&r) / norm(&b)
                    );
                }
            }
        }
    }
}
