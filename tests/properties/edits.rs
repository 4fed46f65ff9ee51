//! Random edits and steps in any order, with any values: nothing panics, nothing that is stored ever stops being finite.

use hooke::{
    Drag, Fixed, LinearlyImplicitEuler, Mixed, Motion, PointForce, PointSpring, Real, Scene, Snapshot,
    Spring, SpringDamping,
};
use proptest::prelude::*;

use crate::config;

/// One thing a caller may do; indices and values may be wrong.
#[derive(Debug, Clone)]
enum Edit {
    Particle([f64; 3], f64),
    Spring(usize, usize, f64),
    SpringWith(usize, usize, f64, f64),
    Cable(usize, usize, f64, f64),
    Pin(usize),
    Release(usize),
    Break(usize),
    Stiffness(usize, f64),
    RestLength(usize, f64),
    Mass(usize, f64),
    Position(usize, [f64; 3]),
    Velocity(usize, [f64; 3]),
    Impulse(usize, [f64; 3]),
    Save,
    Restore,
    Step { h: f64, tolerance: f64, cut: u32, drag: f64, damping: f64, particle: usize, vector: [f64; 3] },
    Move(usize, [f64; 3], [f64; 3]),
}

/// Mostly sensible, sometimes extreme, sometimes no number at all.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => -2.0..2.0f64,
        4 => 0.0..1e4f64,
        2 => Just(0.0),
        2 => (-330.0..308.0f64).prop_map(|p| 10f64.powf(p)),
        1 => prop::num::f64::ANY,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::MAX), Just(-1.0), Just(f64::MIN_POSITIVE)],
    ]
}

fn positive() -> impl Strategy<Value = f64> {
    prop_oneof![8 => 1e-3..1e3f64, 1 => value()]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![6 => prop::array::uniform3(-2.0..2.0f64), 1 => prop::array::uniform3(value())]
}

fn edit() -> impl Strategy<Value = Edit> {
    let i = || 0..8usize;
    prop_oneof![
        4 => (vector(), positive()).prop_map(|(x, m)| Edit::Particle(x, m)),
        2 => (i(), i(), positive()).prop_map(|(a, b, k)| Edit::Spring(a, b, k)),
        2 => (i(), i(), positive(), positive()).prop_map(|(a, b, k, l)| Edit::SpringWith(a, b, k, l)),
        2 => (i(), i(), positive(), positive()).prop_map(|(a, b, k, l)| Edit::Cable(a, b, k, l)),
        1 => i().prop_map(Edit::Pin),
        1 => i().prop_map(Edit::Release),
        1 => i().prop_map(Edit::Break),
        1 => (i(), positive()).prop_map(|(j, k)| Edit::Stiffness(j, k)),
        1 => (i(), positive()).prop_map(|(j, l)| Edit::RestLength(j, l)),
        1 => (i(), positive()).prop_map(|(i, m)| Edit::Mass(i, m)),
        1 => (i(), vector()).prop_map(|(i, x)| Edit::Position(i, x)),
        2 => (i(), vector()).prop_map(|(i, v)| Edit::Velocity(i, v)),
        1 => (i(), vector()).prop_map(|(i, p)| Edit::Impulse(i, p)),
        1 => Just(Edit::Save),
        1 => Just(Edit::Restore),
        6 => (1e-4..0.1f64, positive(), 0..20u32, positive(), positive(), i(), vector()).prop_map(
            |(h, tolerance, cut, drag, damping, particle, vector)| Edit::Step {
                h, tolerance, cut, drag, damping, particle, vector
            }
        ),
        1 => (i(), vector(), vector()).prop_map(|(i, x, v)| Edit::Move(i, x, v)),
    ]
}

type Room<T> = Scene<T, 7, 9, Mixed>;

fn three<T: Real>(x: [f64; 3]) -> [T; 3] {
    x.map(T::from_f64)
}

/// Did the call succeed?
fn apply<T: Real>(scene: &mut Room<T>, saved: &mut Snapshot<Fixed<T, 7, 9, Mixed>>, edit: &Edit) -> bool {
    let real = T::from_f64;
    let spring = |k, l| Spring { stiffness: real(k), rest_length: real(l) };
    match *edit {
        Edit::Particle(x, m) => scene.particle(three(x), real(m)).is_ok(),
        Edit::Spring(a, b, k) => scene.spring(a, b, real(k)).is_ok(),
        Edit::SpringWith(a, b, k, l) => scene.spring_with(a, b, spring(k, l)).is_ok(),
        Edit::Cable(a, b, k, l) => scene.cable(a, b, spring(k, l)).is_ok(),
        Edit::Pin(i) => scene.pin(i).is_ok(),
        Edit::Release(i) => scene.release(i).is_ok(),
        Edit::Break(j) => scene.break_spring(j).is_ok(),
        Edit::Stiffness(j, k) => scene.set_stiffness(j, real(k)).is_ok(),
        Edit::RestLength(j, l) => scene.set_rest_length(j, real(l)).is_ok(),
        Edit::Mass(i, m) => scene.set_mass(i, real(m)).is_ok(),
        Edit::Position(i, x) => scene.set_position(i, three(x)).is_ok(),
        Edit::Velocity(i, v) => scene.set_velocity(i, three(v)).is_ok(),
        Edit::Impulse(i, p) => scene.impulse(i, three(p)).is_ok(),
        Edit::Save => scene.save(saved).is_ok(),
        Edit::Restore => scene.restore(saved).is_ok(),
        Edit::Step { h, tolerance, cut, drag, damping, particle, vector } => {
            let mut euler = LinearlyImplicitEuler::new(real(h))
                .tolerance(real(tolerance))
                .max_iterations(cut)
                .gravity([T::ZERO, real(-9.81), T::ZERO])
                .with(Drag(real(drag)))
                .with(SpringDamping(real(damping)))
                .with(PointForce { particle, force: three(vector) })
                .with(PointSpring::new(particle, three(vector), real(damping)));
            scene.step(&mut euler).is_ok()
        }
        Edit::Move(i, x, v) => {
            let motion = Motion { particle: i, position: three(x), velocity: three(v) };
            scene.step_moving(&mut LinearlyImplicitEuler::new(real(0.01)), &[motion]).is_ok()
        }
    }
}

/// All that is stored, as bits; and whether all of it is finite.
fn stored<T: Real>(scene: &Room<T>) -> (Vec<u64>, bool) {
    let state = scene.state();
    let mut numbers: Vec<f64> = Vec::new();
    numbers.extend(state.position.iter().chain(state.velocity).flatten().map(|x| x.to_f64()));
    numbers.extend(state.mass.iter().map(|x| x.to_f64()));
    for j in 0..state.springs() {
        let spring = state.spring(j);
        numbers.extend([spring.stiffness.to_f64(), spring.rest_length.to_f64()]);
    }
    let finite = numbers.iter().all(|x| x.is_finite());
    let mut bits: Vec<u64> = numbers.into_iter().map(f64::to_bits).collect();
    bits.extend((0..state.mass.len()).map(|i| u64::from(state.is_pinned(i))));
    bits.extend((0..state.springs()).map(|j| u64::from(state.ends(j).is_some())));
    (bits, finite)
}

fn survives<T: Real>(edits: &[Edit]) -> Result<(), TestCaseError> {
    let mut scene = Room::<T>::new();
    let mut saved = Snapshot::<Fixed<T, 7, 9, Mixed>>::new();
    for edit in edits {
        let (before, _) = stored(&scene);
        let done = apply(&mut scene, &mut saved, edit);
        let (after, finite) = stored(&scene);
        prop_assert!(finite, "after {edit:?}");
        prop_assert!(done || before == after, "a refused {edit:?} left a trace");
        for i in 0..9 {
            let _ = (scene.reaction(i, &()), scene.springs().tension_of(i), scene.springs().hessian_of(i));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(4, 384))]

    #[test]
    fn no_sequence_of_edits_and_steps_panics_or_leaves_a_number_that_is_not_finite(
        edits in prop::collection::vec(edit(), 1..60)
    ) {
        survives::<f64>(&edits)?;
        survives::<f32>(&edits)?;
    }
}
