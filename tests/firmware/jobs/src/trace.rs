//! The trace of a job, as text: its name, 32 bits of the running digest after every step (so that a difference can be
//! traced to its first step), and the totals. The golden file holds the same text.

use core::fmt::Write;

use hooke::{MassSpring, Memory, Report};

use crate::digest::Digest;
use crate::outcome::{Failure, Outcome};

/// Digests on one line of the trace.
const PER_LINE: u32 = 12;

/// Writes one job's trace.
pub struct Trace<'a> {
    out: &'a mut dyn Write,
    digest: Digest,
    steps: u32,
    iterations: u32,
    clamped: u32,
}

impl<'a> Trace<'a> {
    pub(crate) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, digest: Digest::new(), steps: 0, iterations: 0, clamped: 0 }
    }

    /// Takes note of a step: the scene after it, and its report.
    pub fn step<M: Memory>(&mut self, scene: &MassSpring<M>, report: &Report<M::Real>) -> Outcome {
        self.digest.scene(scene);
        self.iterations += report.iterations;
        self.clamped += report.clamped;
        let before = if self.steps.is_multiple_of(PER_LINE) { "\n " } else { " " };
        self.steps += 1;
        write!(self.out, "{before}{:08x}", self.digest.value() >> 32).map_err(Failure::from)
    }

    /// Takes note of a number that is no position or velocity, such as a tension; it counts from the next step on.
    pub fn number<T: hooke::Real>(&mut self, x: T) {
        self.digest.number(x);
    }

    pub(crate) fn end(self) -> Outcome {
        let Self { out, digest, steps, iterations, clamped } = self;
        let digest = digest.value();
        writeln!(out, "\nend {steps} steps {iterations} iterations {clamped} clamped {digest:016x}")?;
        Ok(())
    }
}
