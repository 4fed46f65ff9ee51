//! A scene in borrowed buffers beside the same scene in fixed storage: the same bits after every step.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory, Scene, SceneIn};
use static_cell::ConstStaticCell;

use crate::digest::Digest;
use crate::job::Job;
use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

const PARTICLES: usize = 12;
const SPRINGS: usize = PARTICLES - 1;
const NEEDS: (usize, usize) = SceneIn::<f32>::needs(PARTICLES, SPRINGS);

macro_rules! job {
    ($job:ident, $t:ident) => {
        #[doc = concat!("This job in `", stringify!($t), "`.")]
        pub const $job: Job = {
            type Place = Scene<$t, PARTICLES, SPRINGS, Hookean>;
            static FIXED: ConstStaticCell<Place> = ConstStaticCell::new(Scene::new());
            static NUMBERS: ConstStaticCell<[$t; NEEDS.0]> = ConstStaticCell::new([0.0; NEEDS.0]);
            static WORDS: ConstStaticCell<[u32; NEEDS.1]> = ConstStaticCell::new([0; NEEDS.1]);
            Job {
                name: "slices",
                precision: stringify!($t),
                start: |trace| run(FIXED.take(), NUMBERS.take(), WORDS.take(), trace),
            }
        };
    };
}
job!(F32, f32);
job!(F64, f64);

fn run<M: Memory>(
    fixed: &mut MassSpring<M>,
    numbers: &mut [M::Real],
    words: &mut [u32],
    trace: &mut Trace<'_>,
) -> Outcome {
    let too_small = crate::Failure::Missing("room in the buffers");
    let mut borrowed = SceneIn::<M::Real>::in_buffers(numbers, words, PARTICLES, SPRINGS).ok_or(too_small)?;
    hang(fixed, PARTICLES)?;
    hang(&mut borrowed, PARTICLES)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity::<M::Real>());
    for _ in 0..48 {
        fixed.step(&mut euler)?;
        let report = borrowed.step(&mut euler)?;
        trace.step(&borrowed, &report)?;
        expect(digest(fixed) == digest(&borrowed), "the same bits in both kinds of memory")?;
    }
    Ok(())
}

fn digest<M: Memory>(scene: &MassSpring<M>) -> Digest {
    let mut digest = Digest::new();
    digest.scene(scene);
    digest
}
