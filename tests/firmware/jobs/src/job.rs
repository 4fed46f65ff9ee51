//! A job: a name, a precision and what runs it.

use core::fmt::Write;

use crate::outcome::Outcome;
use crate::trace::Trace;

/// One simulation in one precision. It may be run once, since its scene is a `static` that it takes.
#[derive(Debug, Clone, Copy)]
pub struct Job {
    /// The feature it is about.
    pub name: &'static str,
    /// `f32` or `f64`.
    pub precision: &'static str,
    pub(crate) start: fn(&mut Trace<'_>) -> Outcome,
}

impl Job {
    /// Runs it and writes its trace.
    pub fn run(&self, out: &mut dyn Write) -> Outcome {
        write!(out, "job {} {}", self.name, self.precision)?;
        let mut trace = Trace::new(out);
        (self.start)(&mut trace)?;
        trace.end()
    }
}

/// Makes the job `$job` in precision `$t` of a file whose `run` takes a scene for `$n` particles and `$s` springs. The
/// scene is a `static`, all zeros until it is built: it lies in .bss and never crosses the stack.
macro_rules! one_precision {
    ($job:ident, $t:ident, $name:literal, $n:expr, $s:expr, $law:ty) => {
        #[doc = concat!("This job in `", stringify!($t), "`.")]
        pub const $job: $crate::Job = {
            type Place = static_cell::ConstStaticCell<hooke::Scene<$t, { $n }, { $s }, $law>>;
            static SCENE: Place = Place::new(hooke::Scene::new());
            $crate::Job { name: $name, precision: stringify!($t), start: |trace| run(SCENE.take(), trace) }
        };
    };
}

/// The same for both precisions: `F32` and `F64`.
macro_rules! both_precisions {
    ($name:literal, $n:expr, $s:expr, $law:ty) => {
        $crate::job::one_precision!(F32, f32, $name, $n, $s, $law);
        $crate::job::one_precision!(F64, f64, $name, $n, $s, $law);
    };
}

pub(crate) use {both_precisions, one_precision};
