//! Any sequence of calls to a scene: none panics, a refused call changes nothing, positions and velocities stay finite, pins
//! are where they are told to be, a step's bounds are in order, and a restored scene goes on bit for bit. Islands asleep have
//! the bits and the report of those that are assembled at rest, whatever was called since they fell asleep.

use hooke::{
    Fixed, MassSpring, Memory, Mixed, Real, Report, Rest, Scene, Sleeping, Snapshot, Spring, StepError,
};

use crate::bytes::Bytes;
use crate::kernel_step::{REST, Step};

/// Capacities that a sequence of bytes reaches.
const PARTICLES: usize = 12;
const SPRINGS: usize = 24;
/// Indices that are tried: some of particles and springs that do not exist.
const INDICES: usize = 14;
/// The most calls.
const CALLS: usize = 96;

/// Plays the bytes as calls, in the precision that the first one says.
pub fn kernel(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    if bytes.byte() & 1 == 0 { play::<f32>(bytes) } else { play::<f64>(bytes) }
}

/// All that a scene shows of itself, as bits.
pub fn visible<M: Memory>(scene: &MassSpring<M>) -> Vec<u64> {
    let state = scene.state();
    let bits = |x: M::Real| x.to_f64().to_bits();
    let vectors = state.position.iter().chain(state.velocity).flatten().copied();
    let springs = (0..state.springs()).flat_map(|j| {
        let Spring { stiffness, rest_length } = state.spring(j);
        let (a, b) = state.ends(j).unwrap_or((usize::MAX, usize::MAX));
        [bits(stiffness), bits(rest_length), a as u64, b as u64]
    });
    let pinned = (0..state.mass.len()).map(|i| u64::from(state.is_pinned(i)));
    vectors.chain(state.mass.iter().copied()).map(bits).chain(springs).chain(pinned).collect()
}

/// What was saved, and a step that was made from there.
struct Saved {
    bits: Vec<u64>,
    next: Option<(Step, String, Vec<u64>)>,
}

fn play<T: Real>(mut bytes: Bytes<'_>) {
    let mut scene = Box::new(Scene::<T, PARTICLES, SPRINGS, Mixed>::new());
    let mut snapshot = Box::new(Snapshot::<Fixed<T, PARTICLES, SPRINGS, Mixed>>::new());
    let mut saved: Option<Saved> = None;
    let mut last: Option<Step> = None;
    let mut nights = Nights::<T>::new();
    for _ in 0..CALLS {
        if bytes.is_empty() {
            return;
        }
        let before = visible(&scene);
        let accepted = match bytes.below(32) {
            14 => {
                assert!(scene.save(&mut snapshot).is_ok(), "there is room for as much as in the scene");
                saved = Some(Saved { bits: before.clone(), next: None });
                true
            }
            15 | 16 => {
                if let Some(saved) = &saved {
                    resumes(&mut scene, &snapshot, saved);
                }
                true
            }
            17 => {
                measure(&mut scene);
                visible(&scene) == before
            }
            call @ 0..14 => edit(call, &mut scene, &mut bytes),
            call => {
                let again = last.take().filter(|_| call == 31);
                let step = again.unwrap_or_else(|| Step::read(&mut bytes, INDICES));
                last = Some(step.clone());
                let after_save = saved.as_ref().is_some_and(|s| s.next.is_none() && s.bits == before);
                let report =
                    if step.rests() { nights.make(&step, &mut scene) } else { step.make(&mut *scene) };
                let now = visible(&scene);
                step.judge(&scene, &report, &before, &now);
                let outcome = format!("{report:?}");
                if let (true, Some(saved)) = (after_save, &mut saved) {
                    saved.next = Some((step, outcome, now));
                }
                report.is_ok()
            }
        };
        if !accepted {
            assert_eq!(visible(&scene), before, "a refused call changes nothing");
        }
        let state = [scene.positions(), scene.velocities()];
        assert!(state.iter().all(|list| list.as_flattened().iter().all(|x| x.is_finite())), "finite");
    }
}

/// A memory of what is asleep, from the first step to the last, and a twin of the scene that is never asleep.
struct Nights<T: Real> {
    sleeping: Sleeping<T, Vec<T>, Vec<u32>>,
    twin: Box<Scene<T, PARTICLES, SPRINGS, Mixed>>,
    copy: Box<Snapshot<Fixed<T, PARTICLES, SPRINGS, Mixed>>>,
}

impl<T: Real> Nights<T> {
    fn new() -> Self {
        let (numbers, words) = Sleeping::needs(PARTICLES, SPRINGS);
        // What is in the memory must not matter.
        let (numbers, words) = (vec![T::from_f64(f64::NAN); numbers], vec![u32::MAX; words]);
        let sleeping = Sleeping::new(T::from_f64(REST), numbers, words);
        Self { sleeping, twin: Box::new(Scene::new()), copy: Box::new(Snapshot::new()) }
    }

    /// A step that brings islands to rest, with the memory; the twin's, without it, ends the same.
    fn make(
        &mut self,
        step: &Step,
        scene: &mut Scene<T, PARTICLES, SPRINGS, Mixed>,
    ) -> Result<Report<T>, StepError> {
        assert!(scene.save(&mut self.copy).is_ok() && self.twin.restore(&self.copy).is_ok(), "a copy fits");
        let awake = step.make_with(&mut *self.twin, Rest(T::from_f64(REST)));
        let made = step.make_with(scene, &mut self.sleeping);
        let made = made.map(|report| Report { asleep: 0, ..report });
        assert_eq!(format!("{made:?}"), format!("{awake:?}"), "a scene asleep reports what one at rest does");
        assert_eq!(visible(scene), visible(&self.twin), "and has its bits");
        made
    }
}

/// One change of the scene; was it accepted?
fn edit<M: Memory<Law = Mixed>>(call: usize, scene: &mut MassSpring<M>, bytes: &mut Bytes<'_>) -> bool {
    let real = M::Real::from_f64;
    let (i, j) = (bytes.below(INDICES), bytes.below(2 * INDICES));
    let particles = scene.positions().len();
    let pinned = scene.is_pinned(i);
    let broken = scene.state().ends(j).is_none();
    let done = match call {
        0 | 1 => {
            scene.particle(bytes.vector().map(real), real(bytes.number())).map(|k| assert_eq!(k, particles))
        }
        2 | 3 => scene.spring(i, j % INDICES, real(bytes.number())).map(|_| ()),
        4 | 5 => {
            let spring = Spring { stiffness: real(bytes.number()), rest_length: real(bytes.number()) };
            let b = j % INDICES;
            let added = if call == 4 { scene.cable(i, b, spring) } else { scene.spring_with(i, b, spring) };
            added.map(|k| assert_eq!(scene.state().spring(k), spring))
        }
        6 => scene.pin(i).map(|()| assert!(scene.is_pinned(i))),
        7 => scene.release(i).map(|()| assert!(pinned && !scene.is_pinned(i))),
        8 => scene.break_spring(j).map(|()| assert!(!broken && scene.state().ends(j).is_none())),
        9 => scene.set_stiffness(j, real(bytes.number())).map(|()| assert!(!broken)),
        10 => scene.set_rest_length(j, real(bytes.number())).map(|()| assert!(!broken)),
        11 => scene.set_mass(i, real(bytes.number())),
        12 => {
            let x = bytes.vector().map(real);
            scene.set_position(i, x).map(|()| assert_eq!(scene.positions()[i], x))
        }
        _ => {
            let v = bytes.vector().map(real);
            let done = if bytes.byte() & 1 == 0 { scene.set_velocity(i, v) } else { scene.impulse(i, v) };
            done.map(|()| assert!(!pinned))
        }
    };
    done.is_ok()
}

/// A restored scene is what was saved, and its next step is that of the scene which went on, in its bits and in its report;
/// whether it has a history or is new.
fn resumes<T: Real>(
    scene: &mut Scene<T, PARTICLES, SPRINGS, Mixed>,
    snapshot: &Snapshot<Fixed<T, PARTICLES, SPRINGS, Mixed>>,
    saved: &Saved,
) {
    let mut new = Box::new(Scene::<T, PARTICLES, SPRINGS, Mixed>::new());
    for scene in [scene, &mut new] {
        assert!(scene.restore(snapshot).is_ok(), "what was saved fits");
        assert_eq!(visible(scene), saved.bits, "a restored scene is what was saved");
        if let Some((step, outcome, after)) = &saved.next {
            assert_eq!(format!("{:?}", step.make(scene)), *outcome, "its step says the same");
            assert_eq!(visible(scene), *after, "and ends in the same bits");
        }
    }
}

/// Everything that can be asked of a scene; it must answer.
fn measure<M: Memory>(scene: &mut MassSpring<M>) {
    let free = scene.free_particles();
    assert!(scene.islands() <= free && free <= scene.positions().len());
    let springs = scene.springs();
    _ = (springs.kinetic_energy(), springs.potential_energy(), springs.lagrangian());
    let state = scene.state();
    _ = (state.linear_momentum(), state.angular_momentum(), state.centre_of_mass());
    for j in 0..2 * INDICES {
        _ = (springs.tension_of(j), springs.potential_energy_of(j), springs.hessian_of(j));
        _ = (springs.length_of(j), springs.strain_of(j), springs.stretch_factor_of(j));
    }
    for i in 0..INDICES {
        let force = scene.reaction(i, &hooke::Gravity([M::Real::ONE; 3]));
        assert_eq!(force.is_some(), i < scene.positions().len());
    }
}
