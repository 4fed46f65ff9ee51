//! Snapshot and restore: the same steps taken again give the same bits.

use hooke::{Fixed, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Snapshot};
use static_cell::ConstStaticCell;

use crate::digest::Digest;
use crate::job::Job;
use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

const PARTICLES: usize = 12;
const SPRINGS: usize = PARTICLES - 1;

macro_rules! job {
    ($job:ident, $t:ident) => {
        #[doc = concat!("This job in `", stringify!($t), "`.")]
        pub const $job: Job = {
            type Kept = Fixed<$t, PARTICLES, SPRINGS, Hookean>;
            static SCENE: ConstStaticCell<MassSpring<Kept>> = ConstStaticCell::new(MassSpring::new());
            static SNAPSHOT: ConstStaticCell<Snapshot<Kept>> = ConstStaticCell::new(Snapshot::new());
            Job {
                name: "snapshot",
                precision: stringify!($t),
                start: |trace| run(SCENE.take(), SNAPSHOT.take(), trace),
            }
        };
    };
}
job!(F32, f32);
job!(F64, f64);

fn run<M: Memory>(scene: &mut MassSpring<M>, snapshot: &mut Snapshot<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, PARTICLES)?;
    steps(scene, 16, trace)?;
    scene.save(snapshot)?;
    let first = steps(scene, 16, trace)?;
    scene.break_spring(3)?;
    scene.pin(9)?;
    steps(scene, 4, trace)?;
    scene.restore(snapshot)?;
    let again = steps(scene, 16, trace)?;
    expect(first == again, "the same bits after a restore")
}

/// Takes `n` steps; answers the digest of what they did.
fn steps<M: Memory>(
    scene: &mut MassSpring<M>,
    n: usize,
    trace: &mut Trace<'_>,
) -> Result<Digest, crate::outcome::Failure> {
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    let mut digest = Digest::new();
    for _ in 0..n {
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
        digest.scene(scene);
    }
    Ok(digest)
}
