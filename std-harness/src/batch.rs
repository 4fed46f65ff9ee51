//! Many scenes side by side: independent, each with its own integrator, on as many threads as are given.
//!
//! A scene is stepped by one thread from beginning to end, exactly as it would be alone. So its bits do not depend on how
//! many threads there are, nor on what the other scenes do; one that fails ends alone. Threads take scenes one by one as
//! they get free: many short steps in one scene do not make the others wait.
//!
//! Cost: starting the threads, some 30 µs each, once a call, and a lock per scene; so give it many steps at a time rather
//! than one. Memory: nothing beyond the scenes and an answer each.
//!
//! Islands of one scene (ropes without a common free particle) may as well be scenes of their own: the kernel promises
//! them the same bits. Inside an island threads do not pay; `benches/README.md` says why.

use std::sync::Mutex;
use std::thread;

use hooke::{Integrator, MassSpring, Memory, Report, StepError};

/// A scene and what steps it.
pub struct Member<M: Memory, I> {
    /// The scene.
    pub scene: MassSpring<M>,
    /// Its own integrator, with its own solver, forces and step.
    pub integrator: I,
}

/// A step that failed. The scene is as it was after the last step that did not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Failed {
    /// Which step of this call, counted from 1.
    pub step: u64,
    /// Why.
    pub error: StepError,
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "step {}: {}", self.step, self.error)
    }
}

impl std::error::Error for Failed {}

/// Advances every scene by `steps` steps on up to `threads` threads (0 is taken for 1; more than scenes are of no use).
/// Answers in the order of the scenes: the report of the last step (`None` without steps), or which step failed.
///
/// ```
/// use hooke::LinearlyImplicitEuler;
/// use hooke_harness::batch::{self, Member};
/// use hooke_harness::scene::catalog;
///
/// let mut ropes = Vec::new();
/// for k in 0..8 {
///     let mut model = catalog::named("chain:20").ok_or("no such scene")??;
///     model.mass[19] *= 1.0 + k as f64; // a heavier end each
///     let integrator = LinearlyImplicitEuler::new(model.dt).gravity(model.gravity);
///     ropes.push(Member { scene: model.build::<f64>()?, integrator });
/// }
/// for (k, answer) in batch::step(&mut ropes, 60, 2).into_iter().enumerate() {
///     match answer {
///         Ok(report) => println!("rope {k}: {:?} J off at most", report.map(|report| report.upper)),
///         Err(failed) => println!("rope {k}: {failed}"),
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn step<M, I>(
    members: &mut [Member<M, I>],
    steps: u64,
    threads: usize,
) -> Vec<Result<Option<Report<M::Real>>, Failed>>
where
    M: Memory,
    M::Real: Send,
    I: Integrator<M::Real> + Send,
    MassSpring<M>: Send,
{
    each(members, threads, |_, Member { scene, integrator }| {
        let mut last = None;
        for step in 1..=steps {
            last = Some(scene.step(integrator).map_err(|error| Failed { step, error })?);
        }
        Ok(last)
    })
}

/// Does `work` on every item, with its index, on up to `threads` threads, and answers in the order of the items: for scenes
/// of different kinds, pins that move, or whatever else each is to do.
///
/// # Panics
/// If `work` does.
pub fn each<X: Send, R: Send>(
    items: &mut [X],
    threads: usize,
    work: impl Fn(usize, &mut X) -> R + Sync,
) -> Vec<R> {
    let threads = threads.clamp(1, items.len().max(1));
    if threads == 1 {
        return items.iter_mut().enumerate().map(|(k, item)| work(k, item)).collect();
    }
    let queue = Mutex::new(items.iter_mut().enumerate());
    let take = || queue.lock().ok()?.next();
    let worker =
        || -> Vec<(usize, R)> { std::iter::from_fn(take).map(|(k, item)| (k, work(k, item))).collect() };
    let mut answers: Vec<(usize, R)> = thread::scope(|scope| {
        // This thread is one of them.
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(worker)).collect();
        let mut answers = worker();
        for other in others {
            answers.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        answers
    });
    answers.sort_unstable_by_key(|(k, _)| *k);
    answers.into_iter().map(|(_, answer)| answer).collect()
}
