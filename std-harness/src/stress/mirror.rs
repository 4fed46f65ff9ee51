//! What a state is worth, in f64: the scene of a trial once more, with exactly its numbers, so that energy and momentum are
//! judged without the rounding of the precision that is tried.

use hooke::{MassSpring, Real};

use crate::error::InputError;
use crate::heap::Heap;
use crate::scene::Model;

/// Positions and velocities in f64, exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// m
    pub position: Vec<[f64; 3]>,
    /// m/s
    pub velocity: Vec<[f64; 3]>,
}

impl Snapshot {
    /// Of a scene in any precision.
    pub fn of<T: Real>(scene: &MassSpring<Heap<T>>) -> Self {
        let exact = |list: &[[T; 3]]| list.iter().map(|x| x.map(T::to_f64)).collect();
        Self { position: exact(scene.positions()), velocity: exact(scene.velocities()) }
    }

    /// The first particle that has a number that is none, or infinite.
    pub fn not_finite(&self) -> Option<usize> {
        let finite = |x: &[f64; 3]| x.iter().all(|x| x.is_finite());
        (0..self.position.len()).find(|i| !finite(&self.position[*i]) || !finite(&self.velocity[*i]))
    }

    /// The first particle that has other bits.
    pub fn differs(&self, other: &Self) -> Option<usize> {
        let bits = |x: &[f64; 3]| x.map(f64::to_bits);
        (0..self.position.len()).find(|i| {
            bits(&self.position[*i]) != bits(&other.position[*i])
                || bits(&self.velocity[*i]) != bits(&other.velocity[*i])
        })
    }
}

/// The scene in f64.
pub struct Mirror {
    scene: MassSpring<Heap<f64>>,
}

impl Mirror {
    /// Of a model whose numbers are those of precision `T` (see [`rounded`]).
    pub fn new(model: &Model) -> Result<Self, InputError> {
        Ok(Self { scene: model.build()? })
    }

    /// V of the springs, and ½‖v‖²_M with these velocities, moving pins' included, J.
    pub fn energies(&mut self, state: &Snapshot, velocity: impl Fn(usize) -> [f64; 3]) -> (f64, f64) {
        let mut kinetic = 0.0;
        for i in 0..state.position.len() {
            // A state that is not finite has no energy: the judge has said so before.
            _ = self.scene.set_position(i, state.position[i]);
            kinetic += 0.5 * self.scene.state().mass[i] * velocity(i).iter().map(|v| v * v).sum::<f64>();
        }
        (self.scene.springs().potential_energy(), kinetic)
    }

    /// |tension| of spring j where the scene was last put, N, and its length, m.
    pub fn tension(&self, j: usize) -> (f64, f64) {
        let springs = self.scene.springs();
        (springs.tension_of(j).abs(), springs.length_of(j).unwrap_or(0.0))
    }
}

/// The model with all numbers rounded to precision `T`: what a scene in `T` is made of.
pub fn rounded<T: Real>(model: &Model) -> Model {
    let mut model = model.clone();
    let to = |x: &mut f64| *x = T::from_f64(*x).to_f64();
    model.position.iter_mut().chain(&mut model.velocity).flatten().for_each(to);
    model.mass.iter_mut().for_each(to);
    model.gravity.iter_mut().for_each(to);
    for spring in &mut model.springs {
        to(&mut spring.stiffness);
        to(&mut spring.rest_length);
        to(&mut spring.damping);
    }
    model
}

/// Why precision `T` has no such scene: a mass that it rounds to 0, or a number beyond its range.
pub fn unrepresentable<T: Real>(model: &Model) -> Option<&'static str> {
    let model = rounded::<T>(model);
    let mut vectors = model.position.iter().chain(&model.velocity).flatten();
    let mut springs = model.springs.iter();
    if vectors.any(|x| !x.is_finite()) {
        return Some("a coordinate is beyond its range");
    }
    if model.mass.iter().any(|m| !(*m > 0.0 && m.is_finite())) {
        return Some("a mass is beyond its range");
    }
    if springs.any(|s| !(s.stiffness + s.rest_length + s.damping).is_finite()) {
        return Some("a spring is beyond its range");
    }
    None
}
