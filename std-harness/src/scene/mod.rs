//! A scene as the command line, a mesh or a TOML file describes it: plain numbers, checked when the kernel takes them.

pub mod catalog;
pub mod dissection;
pub mod from_mesh;
pub mod graph;
pub mod motion;
pub mod pins;
pub mod renumber;
pub mod source;
pub mod start;
pub mod toml;

pub use motion::{Moving, Path};
pub use pins::PinRule;

use hooke::{EditError, MassSpring, Real, Spring};

use crate::error::InputError;
use crate::heap::Heap;

/// One spring of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelSpring {
    /// The two particles.
    pub ends: [usize; 2],
    /// k, N/m
    pub stiffness: f64,
    /// l₀, m
    pub rest_length: f64,
    /// c along the spring, N·s/m
    pub damping: f64,
    /// Does it only pull?
    pub cable: bool,
}

/// All that a run needs to know of a scene, in f64 and SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// What the scene is called in summaries and files.
    pub name: String,
    /// Positions, m; the index is the particle's id everywhere.
    pub position: Vec<[f64; 3]>,
    /// Initial velocities, m/s (those of pinned particles are not used).
    pub velocity: Vec<[f64; 3]>,
    /// Masses, kg.
    pub mass: Vec<f64>,
    /// Springs, in the order that defines the kernel's sums.
    pub springs: Vec<ModelSpring>,
    /// Which particles are pinned.
    pub pinned: Vec<bool>,
    /// Pins that move.
    pub moving: Vec<Moving>,
    /// Gravity, m/s².
    pub gravity: [f64; 3],
    /// Drag rate d, 1/s: the force is −d mᵢ q̇ᵢ.
    pub drag: f64,
    /// Default time step, s.
    pub dt: f64,
    /// Default duration, s.
    pub seconds: f64,
    /// What a user should know about how the scene came to be, a line each.
    pub notes: Vec<String>,
}

impl Model {
    /// Particles at rest, nothing pinned, no springs, the defaults of a mesh.
    pub fn at_rest(name: impl Into<String>, position: Vec<[f64; 3]>, mass: f64) -> Self {
        let n = position.len();
        Self {
            name: name.into(),
            position,
            velocity: vec![[0.0; 3]; n],
            mass: vec![mass; n],
            springs: Vec::new(),
            pinned: vec![false; n],
            moving: Vec::new(),
            gravity: [0.0, -9.81, 0.0],
            drag: 0.0,
            dt: 1.0 / 60.0,
            seconds: 1.0,
            notes: Vec::new(),
        }
    }

    /// Adds a spring whose rest length is the distance of its ends as placed.
    pub fn join(&mut self, a: usize, b: usize, stiffness: f64) {
        let [p, q] = [self.position[a], self.position[b]];
        let d: [f64; 3] = std::array::from_fn(|c| p[c] - q[c]);
        let rest_length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        self.springs.push(ModelSpring { ends: [a, b], stiffness, rest_length, damping: 0.0, cable: false });
    }

    /// Is anything damped along springs?
    pub fn is_damped(&self) -> bool {
        self.springs.iter().any(|s| s.damping != 0.0)
    }

    /// Nothing pinned, no gravity, no drag: momentum must stay.
    pub fn is_free_of_force(&self) -> bool {
        self.gravity == [0.0; 3] && self.drag == 0.0 && !self.pinned.contains(&true)
    }

    /// The kernel's scene in precision `T`. Errors name the particle or spring and its value.
    pub fn build<T: Real>(&self) -> Result<MassSpring<Heap<T>>, InputError> {
        let mut scene = MassSpring::<Heap<T>>::empty();
        let real = T::from_f64;
        let refuse =
            |e: EditError, value: String| InputError::new(format!("{}: {e} (it is {value})", self.name));
        for (x, m) in self.position.iter().zip(&self.mass) {
            scene.particle(x.map(real), real(*m)).map_err(|e| {
                let value =
                    if matches!(e, EditError::Mass(_)) { format!("{m:?} kg") } else { format!("{x:?}") };
                refuse(e, value)
            })?;
        }
        for s in &self.springs {
            let spring = Spring { stiffness: real(s.stiffness), rest_length: real(s.rest_length) };
            let [a, b] = s.ends;
            let added = if s.cable { scene.cable(a, b, spring) } else { scene.spring_with(a, b, spring) };
            added.map_err(|e| {
                let value = match e {
                    EditError::Stiffness(_) => format!("{:?} N/m", s.stiffness),
                    EditError::RestLength(_) => format!("{:?} m", s.rest_length),
                    _ => format!("from {a} to {b}"),
                };
                refuse(e, value)
            })?;
        }
        for (i, v) in self.velocity.iter().enumerate() {
            if self.pinned[i] {
                scene.pin(i).map_err(|e| refuse(e, String::new()))?;
            } else {
                scene.set_velocity(i, v.map(real)).map_err(|e| refuse(e, format!("{v:?}")))?;
            }
        }
        Ok(scene)
    }
}
