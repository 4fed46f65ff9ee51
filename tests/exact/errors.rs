//! Every error, with the index it names; and the state as it was, bit for bit.

use hooke::{
    Drag, EditError, Gravity, LinearlyImplicitEuler, MassSpring, Memory, Motion, PointForce, PointSpring,
    Real, Report, Scene, SceneIn, Snapshot, Spring, SpringDamping, StepError,
};
use hooke_tests::build;
use hooke_tests::vec_memory::VecScene;

const SPRING: Spring<f64> = Spring { stiffness: 10.0, rest_length: 1.0 };

/// Three particles, the first pinned, two springs, the second broken; in motion.
fn scene() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    for x in 0..3 {
        scene.particle([f64::from(x), 0.0, 0.0], 1.0).unwrap();
    }
    scene.spring(0, 1, 10.0).unwrap();
    scene.spring(1, 2, 10.0).unwrap();
    scene.pin(0).unwrap();
    scene.break_spring(1).unwrap();
    scene.set_velocity(1, [0.1, 0.2, 0.3]).unwrap();
    scene
}

type Seen = (Vec<[u64; 6]>, Vec<u64>, Vec<(u64, u64)>, Vec<Option<(usize, usize)>>, Vec<bool>);

/// All that an edit can change.
fn seen<M: Memory>(scene: &MassSpring<M>) -> Seen {
    let state = scene.state();
    let constants = |j| {
        let Spring { stiffness, rest_length } = state.spring(j);
        (stiffness.to_f64().to_bits(), rest_length.to_f64().to_bits())
    };
    (
        build::bits(scene),
        state.mass.iter().map(|m| m.to_f64().to_bits()).collect(),
        (0..state.springs()).map(constants).collect(),
        (0..state.springs()).map(|j| state.ends(j)).collect(),
        (0..state.mass.len()).map(|i| state.is_pinned(i)).collect(),
    )
}

/// The edit is refused with this error, and nothing has changed, nor does what follows.
fn refused<X: core::fmt::Debug>(
    edit: impl Fn(&mut VecScene<f64>) -> Result<X, EditError>,
    expected: EditError,
) {
    let (mut tried, mut untouched) = (scene(), scene());
    let error = edit(&mut tried).expect_err("the edit is to be refused");
    assert_eq!(error, expected);
    assert!(!error.to_string().is_empty());
    assert_eq!(seen(&tried), seen(&untouched));
    let mut euler = LinearlyImplicitEuler::new(0.01).gravity([0.0, -9.81, 0.0]);
    assert_eq!(tried.step(&mut euler), untouched.step(&mut euler));
    assert_eq!(seen(&tried), seen(&untouched));
}

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn particles_that_do_not_exist_are_named() {
    refused(|s| s.spring(0, 3, 1.0), EditError::NoParticle(3));
    refused(|s| s.spring(7, 1, 1.0), EditError::NoParticle(7));
    refused(|s| s.spring_with(0, 9, SPRING), EditError::NoParticle(9));
    refused(|s| s.pin(3), EditError::NoParticle(3));
    refused(|s| s.release(4), EditError::NoParticle(4));
    refused(|s| s.set_mass(5, 1.0), EditError::NoParticle(5));
    refused(|s| s.set_position(6, [0.0; 3]), EditError::NoParticle(6));
    refused(|s| s.set_velocity(7, [0.0; 3]), EditError::NoParticle(7));
    refused(|s| s.impulse(usize::MAX, [0.0; 3]), EditError::NoParticle(usize::MAX));
}

#[test]
fn springs_that_do_not_exist_or_are_broken_are_named() {
    refused(|s| s.break_spring(2), EditError::NoSpring(2));
    refused(|s| s.set_stiffness(3, 1.0), EditError::NoSpring(3));
    refused(|s| s.set_rest_length(4, 1.0), EditError::NoSpring(4));
    refused(|s| s.break_spring(1), EditError::Broken(1));
    refused(|s| s.set_stiffness(1, 1.0), EditError::Broken(1));
    refused(|s| s.set_rest_length(1, 1.0), EditError::Broken(1));
}

#[test]
fn a_spring_from_a_particle_to_itself_is_refused() {
    refused(|s| s.spring(1, 1, 1.0), EditError::SameEnds(2));
    refused(|s| s.spring_with(2, 2, SPRING), EditError::SameEnds(2));
}

#[test]
fn values_that_are_not_finite_are_refused_in_every_component() {
    for bad in BAD {
        for d in 0..3 {
            let mut x = [1.0; 3];
            x[d] = bad;
            refused(|s| s.particle(x, 1.0), EditError::NotFinite(3));
            refused(|s| s.set_position(2, x), EditError::NotFinite(2));
            refused(|s| s.set_velocity(1, x), EditError::NotFinite(1));
            refused(|s| s.impulse(1, x), EditError::NotFinite(1));
        }
    }
    refused(
        |s| {
            s.impulse(2, [f64::MAX, 0.0, 0.0])?;
            s.set_velocity(2, [0.0; 3])?;
            s.set_mass(2, 1.0)?;
            s.impulse(2, [f64::INFINITY, 0.0, 0.0])
        },
        EditError::NotFinite(2),
    );
}

#[test]
fn masses_stiffnesses_and_rest_lengths_out_of_range_are_refused() {
    for bad in BAD.into_iter().chain([-1.0]) {
        refused(|s| s.particle([0.0; 3], bad), EditError::Mass(3));
        refused(|s| s.set_mass(1, bad), EditError::Mass(1));
        refused(|s| s.spring(0, 2, bad), EditError::Stiffness(2));
        refused(|s| s.set_stiffness(0, bad), EditError::Stiffness(0));
        refused(|s| s.set_rest_length(0, bad), EditError::RestLength(0));
        refused(|s| s.spring_with(0, 2, Spring { rest_length: bad, ..SPRING }), EditError::RestLength(2));
    }
    refused(|s| s.set_mass(2, 0.0), EditError::Mass(2));
    assert_eq!(scene().set_stiffness(0, 0.0), Ok(()), "k = 0 and l₀ = 0 are allowed");
    assert_eq!(scene().set_rest_length(0, 0.0), Ok(()));
}

#[test]
fn pins_have_no_velocity_of_their_own_and_only_pins_are_released() {
    refused(|s| s.set_velocity(0, [1.0; 3]), EditError::Pinned(0));
    refused(|s| s.impulse(0, [1.0; 3]), EditError::Pinned(0));
    refused(|s| s.release(2), EditError::NotPinned(2));
}

/// Fills a scene for 4 particles and 3 springs to the brim, and tries one more of each, at each stage; the same is built
/// where there is room to spare, without a refused call. After each stage, and 20 steps later, they are alike bit for bit.
fn overfill<M: Memory>(full: &mut MassSpring<M>) {
    let real = M::Real::from_f64;
    let at = |x: f64| [real(x), M::Real::ZERO, real(0.1)];
    let mut roomy = VecScene::<M::Real>::empty();
    for i in 0..4 {
        assert_eq!(full.particle(at(i as f64), real(1.0)), Ok(i));
        roomy.particle(at(i as f64), real(1.0)).unwrap();
    }
    assert_eq!(full.particle(at(4.0), real(1.0)), Err(EditError::ParticlesFull(4)));
    assert_eq!(seen(full), seen(&roomy));
    for j in 0..3 {
        assert_eq!(full.spring(j, j + 1, real(10.0)), Ok(j));
        roomy.spring(j, j + 1, real(10.0)).unwrap();
    }
    let spring = Spring { stiffness: real(10.0), rest_length: real(1.0) };
    assert_eq!(full.spring(0, 3, real(10.0)), Err(EditError::SpringsFull(3)));
    assert_eq!(full.spring_with(3, 0, spring), Err(EditError::SpringsFull(3)));
    assert_eq!(full.particle(at(5.0), real(1.0)), Err(EditError::ParticlesFull(4)));
    assert_eq!(seen(full), seen(&roomy));
    full.pin(0).unwrap();
    roomy.pin(0).unwrap();
    let mut euler = LinearlyImplicitEuler::new(real(0.01)).gravity([0.0, -9.81, 0.0].map(real));
    for _ in 0..20 {
        assert_eq!(full.step(&mut euler), roomy.step(&mut euler));
        assert_eq!(full.spring(0, 2, real(10.0)), Err(EditError::SpringsFull(3)), "while it runs, too");
        assert_eq!(seen(full), seen(&roomy));
    }
}

#[test]
fn beyond_the_capacity_is_an_error_at_that_call_and_everything_before_it_is_intact() {
    overfill(&mut Scene::<f32, 4, 3>::new());
    overfill(&mut Scene::<f64, 4, 3>::new());
    let (reals, words) = SceneIn::<f64>::needs(4, 3);
    let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    overfill(&mut SceneIn::<f64>::in_buffers(&mut reals, &mut words, 4, 3).unwrap());
}

#[test]
fn a_snapshot_that_does_not_fit_is_refused_without_change() {
    let small = {
        let mut small = Scene::<f64, 2, 1>::new();
        small.particle([0.0; 3], 1.0).unwrap();
        small
    };
    let big = scene();
    let mut too_small = Snapshot::<hooke::Fixed<f64, 2, 1>>::new();
    small.save(&mut too_small).unwrap();
    assert_eq!(big.save(&mut too_small), Err(EditError::Snapshot(3)));
    let mut again = Scene::<f64, 4, 4>::new();
    again.restore(&too_small).unwrap();
    assert_eq!(build::bits(&again), build::bits(&small), "the refused save left the snapshot alone");
    let mut saved = Snapshot::<hooke::Fixed<f64, 8, 8>>::new();
    big.save(&mut saved).unwrap();
    let mut small = small;
    let before = build::bits(&small);
    assert_eq!(small.restore(&saved), Err(EditError::Snapshot(3)));
    assert_eq!(build::bits(&small), before);
    // Enough particles, too few springs.
    let mut few_springs = Scene::<f64, 8, 1>::new();
    assert_eq!(few_springs.restore(&saved), Err(EditError::Snapshot(3)));
}

/// The step is refused with this error and nothing has changed.
macro_rules! fails {
    ($euler:expr, $motion:expr, $expected:expr) => {{
        let (mut tried, untouched) = (scene(), scene());
        let error = tried.step_moving(&mut $euler, $motion).expect_err("the step is to fail");
        assert_eq!(error, $expected);
        assert!(!error.to_string().is_empty());
        assert_eq!(seen(&tried), seen(&untouched));
    }};
}

#[test]
fn a_time_step_that_is_none_is_refused() {
    for dt in BAD.into_iter().chain([0.0, -0.01, 1e-200, 1e200]) {
        fails!(LinearlyImplicitEuler::new(dt), &[], StepError::TimeStep);
    }
}

#[test]
fn a_tolerance_that_is_none_is_refused() {
    for bad in BAD.into_iter().chain([-1.0]) {
        fails!(LinearlyImplicitEuler::new(0.01).tolerance(bad), &[], StepError::Tolerance);
        fails!(LinearlyImplicitEuler::new(0.01).absolute(bad), &[], StepError::Tolerance);
    }
}

#[test]
fn forces_with_bad_values_are_refused_and_named() {
    let euler = || LinearlyImplicitEuler::new(0.01);
    for bad in BAD {
        fails!(euler().with(Gravity([0.0, bad, 0.0])), &[], StepError::Field);
        fails!(euler().with(PointForce { particle: 2, force: [0.0, 0.0, bad] }), &[], StepError::Force(2));
        fails!(euler().with(PointSpring::new(1, [bad, 0.0, 0.0], 1.0)), &[], StepError::Force(1));
    }
    for bad in BAD.into_iter().chain([-1.0]) {
        fails!(euler().with(Drag(bad)), &[], StepError::Field);
        fails!(euler().with(SpringDamping(bad)), &[], StepError::Damping(0));
        fails!(euler().with(SpringDamping([0.0, bad].as_slice())), &[], StepError::Damping(1));
        fails!(euler().with(PointSpring::new(2, [0.0; 3], bad)), &[], StepError::Force(2));
        fails!(euler().with(PointSpring::new(2, [0.0; 3], 1.0).rest_length(bad)), &[], StepError::Force(2));
    }
    // Also behind others, and in a slice.
    let mut many =
        [PointForce { particle: 0, force: [0.0; 3] }, PointForce { particle: 1, force: [f64::NAN; 3] }];
    fails!(euler().gravity([0.0; 3]).with(many.as_mut_slice()), &[], StepError::Force(1));
}

#[test]
fn forces_on_particles_that_do_not_exist_are_refused_and_named() {
    let euler = || LinearlyImplicitEuler::new(0.01);
    fails!(euler().with(PointForce { particle: 3, force: [0.0; 3] }), &[], StepError::NoParticle(3));
    fails!(euler().with(PointSpring::new(9, [0.0; 3], 1.0)), &[], StepError::NoParticle(9));
}

#[test]
fn motions_of_particles_that_are_not_pinned_or_bad_are_refused_and_named() {
    let motion = |particle, position| Motion { particle, position, velocity: [0.0; 3] };
    fails!(LinearlyImplicitEuler::new(0.01), &[motion(2, [0.0; 3])], StepError::NotPinned(2));
    fails!(LinearlyImplicitEuler::new(0.01), &[motion(5, [0.0; 3])], StepError::NotPinned(5));
    for bad in BAD.into_iter().chain([f64::MAX]) {
        fails!(LinearlyImplicitEuler::new(0.01), &[motion(0, [0.0, bad, 0.0])], StepError::Motion(0));
    }
    let fast = Motion { particle: 0, position: [0.0; 3], velocity: [f64::NAN, 0.0, 0.0] };
    fails!(LinearlyImplicitEuler::new(0.01), &[fast], StepError::Motion(0));
}

/// 60 steps of a rope whose top a sensor moves; where `loose`, every reading is preceded by bad ones.
fn follow<T: Real>(loose: bool) -> Vec<(Seen, Report<T>)> {
    let real = T::from_f64;
    let mut scene = VecScene::<T>::empty();
    for i in 0..8 {
        scene.particle([T::ZERO, real(-0.1 * f64::from(i)), T::ZERO], real(0.01)).unwrap();
    }
    for i in 0..7 {
        scene.spring(i, i + 1, real(1_000.0)).unwrap();
    }
    scene.pin(0).unwrap();
    let mut euler = LinearlyImplicitEuler::new(real(0.01)).gravity([0.0, -9.81, 0.0].map(real));
    let mut answers = Vec::new();
    for tick in 1..=60 {
        let t = 0.01 * f64::from(tick);
        let good = Motion {
            particle: 0,
            position: [t * t, 0.1 * t, 0.0].map(real),
            velocity: [2.0 * t, 0.1, 0.0].map(real),
        };
        for (bad, d) in BAD.into_iter().flat_map(|bad| (0..3).map(move |d| (bad, d))).filter(|_| loose) {
            let before = seen(&scene);
            let (mut place, mut speed) = (good, good);
            place.position[d] = real(bad);
            speed.velocity[d] = real(bad);
            for motion in [place, speed] {
                assert_eq!(scene.step_moving(&mut euler, &[motion]), Err(StepError::Motion(0)));
                // A good motion beside it does not help.
                assert_eq!(scene.step_moving(&mut euler, &[good, motion]), Err(StepError::Motion(0)));
                assert_eq!(seen(&scene), before);
            }
        }
        let report = scene.step_moving(&mut euler, &[good]).unwrap();
        answers.push((seen(&scene), report));
    }
    answers
}

#[test]
fn a_sensor_that_delivers_nan_is_refused_and_the_next_good_steps_have_the_bits_they_would_have_had() {
    assert_eq!(follow::<f32>(true), follow::<f32>(false));
    assert_eq!(follow::<f64>(true), follow::<f64>(false));
}

#[test]
fn a_step_that_leaves_the_range_of_the_numbers_fails_names_the_particle_and_changes_nothing() {
    let build = || {
        let mut scene = VecScene::<f32>::empty();
        scene.particle([0.0; 3], 1.0).unwrap();
        scene.particle([0.0, 1.0, 0.0], 1.0).unwrap();
        scene.set_velocity(1, [3e38, 0.0, 0.0]).unwrap();
        scene
    };
    let mut scene = build();
    // 3e38 m/s for 2 s: beyond the largest f32.
    assert_eq!(scene.step(&mut LinearlyImplicitEuler::new(2.0)), Err(StepError::NotFinite(1)));
    assert_eq!(build::bits(&scene), build::bits(&build()));
}

/// A force of the caller's own that breaks its duty: it pushes away with a negative Hessian, or speeds up.
struct Unstable {
    alpha: f64,
    drag: f64,
}

impl hooke::Force<f64> for Unstable {
    const DRAGS: bool = true;
    const ANCHORS: bool = true;

    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn drag(&self, particle: usize, _: f64) -> f64 {
        if particle == 1 { self.drag } else { 0.0 }
    }
    fn hessians(
        &self,
        rows: &hooke::force::Rows<'_, f64>,
        visit: &mut impl FnMut(usize, hooke::Hessian<f64>),
    ) {
        if let Some(row) = rows.row(1) {
            visit(row, hooke::Hessian { alpha: self.alpha, w: [0.0; 3] });
        }
    }
}

#[test]
fn a_force_that_would_make_the_matrix_indefinite_is_an_error_and_no_false_bound() {
    for (alpha, drag) in [(-5.0, 0.0), (f64::NAN, 0.0), (0.0, -100.0), (0.0, f64::NAN)] {
        let mut scene = hooke::Scene::<f64, 2, 1>::new();
        let a = scene.particle([0.0; 3], 1.0).unwrap();
        let b = scene.particle([1.0, 0.0, 0.0], 1.0).unwrap();
        scene.spring(a, b, 10.0).unwrap();
        scene.set_velocity(a, [0.0, 1.0, 0.0]).unwrap();
        let mut euler = LinearlyImplicitEuler::new(0.1).with(Unstable { alpha, drag });
        assert_eq!(scene.step(&mut euler), Err(StepError::NotCertified(1)), "α = {alpha}, drag {drag}");
        assert_eq!(scene.velocities(), [[0.0, 1.0, 0.0], [0.0; 3]]);
    }
}
