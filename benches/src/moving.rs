//! Scenes in motion, for the benchmarks of parts: a state at rest is too easy, so each is run for a quarter of a second first.

use hooke::{Gravity, LinearlyImplicitEuler, MassSpring};
use hooke_harness::heap::Heap;
use hooke_harness::scene::catalog;

/// A scene on the heap.
pub type HostScene = MassSpring<Heap<f64>>;
/// The lecture's method with gravity.
pub type Euler = LinearlyImplicitEuler<f64, ((), Gravity<f64>)>;

/// A scene of the catalogue after a quarter of a second, and its integrator.
///
/// # Panics
/// If the name is not one of the catalogue's: a benchmark's own mistake.
pub fn moving(name: &str) -> (HostScene, Euler) {
    let model = catalog::named(name).expect("a name of the catalogue").expect("a valid size");
    let mut scene = model.build::<f64>().expect("a valid scene");
    let mut euler = LinearlyImplicitEuler::new(model.dt).gravity(model.gravity);
    for _ in 0..(0.25 / model.dt).round() as usize {
        scene.step(&mut euler).expect("a step");
    }
    (scene, euler)
}
