//! Every method of time integration by name, so that one statement can be made of all of them.

use hooke::{
    Force, LinearlyImplicitEuler, MassSpring, Memory, Motion, Real, Report, Rosenbrock2, Rosenbrock3,
    StepError,
};

use crate::build::{self, Forces};
use crate::data::SceneData;
use crate::vec_memory::VecScene;

/// A method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Linearly-implicit Euler
    Euler,
    /// The linearly-implicit midpoint rule
    Midpoint,
    /// `ros2`
    Ros2,
    /// `ros3`
    Ros3,
    /// Backward Euler, solved for
    Newton,
    /// Energy-momentum
    EnergyMomentum,
    /// Velocity Verlet
    Verlet,
    /// Symplectic Euler
    SymplecticEuler,
}

use Method::*;

/// All of them.
pub const ALL: [Method; 8] = [Euler, Midpoint, Ros2, Ros3, Newton, EnergyMomentum, Verlet, SymplecticEuler];
/// Those that have no limit.
pub const IMPLICIT: [Method; 6] = [Euler, Midpoint, Ros2, Ros3, Newton, EnergyMomentum];

/// How a step is made.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// h, s
    pub dt: f64,
    /// R
    pub tolerance: f64,
    /// J
    pub absolute: f64,
    /// Of one solve
    pub max_iterations: u32,
    /// Of Verlet
    pub substeps: u32,
    /// How many vectors fewer than it needs the method gets
    pub short_of: usize,
}

/// A step of `dt`, its solves relatively exact to `tolerance`.
pub fn options(dt: f64, tolerance: f64) -> Options {
    Options { dt, tolerance, absolute: 0.0, max_iterations: 10_000, substeps: 1, short_of: 0 }
}

impl Method {
    /// How many vectors it needs.
    pub fn needs(self, particles: usize) -> usize {
        match self {
            Ros2 => Rosenbrock2::<f64, ()>::needs(particles),
            Ros3 => Rosenbrock3::<f64, ()>::needs(particles),
            Newton => hooke::Newton::<f64, ()>::needs(particles),
            EnergyMomentum => hooke::EnergyMomentum::<f64, ()>::needs(particles),
            _ => 0,
        }
    }

    /// One step.
    pub fn step<M: Memory, F: Force<M::Real>>(
        self,
        scene: &mut MassSpring<M>,
        options: Options,
        forces: F,
        motion: &[Motion<M::Real>],
    ) -> Result<Report<M::Real>, StepError> {
        let real = M::Real::from_f64;
        let dt = real(options.dt);
        // What is in the memory must not matter.
        let needs = self.needs(scene.positions().len()) - options.short_of;
        let mut memory = vec![[real(f64::NAN); 3]; needs];
        macro_rules! make {
            ($method:expr) => {{
                let mut method = $method
                    .with(forces)
                    .tolerance(real(options.tolerance))
                    .absolute(real(options.absolute))
                    .max_iterations(options.max_iterations);
                scene.step_moving(&mut method, motion)
            }};
        }
        let memory = memory.as_mut_slice();
        match self {
            Euler => make!(LinearlyImplicitEuler::new(dt)),
            Midpoint => make!(hooke::Midpoint::new(dt)),
            Ros2 => make!(Rosenbrock2::new(dt, memory)),
            Ros3 => make!(Rosenbrock3::new(dt, memory)),
            Newton => make!(hooke::Newton::new(dt, memory)),
            EnergyMomentum => make!(hooke::EnergyMomentum::new(dt, memory)),
            Verlet => make!(hooke::Verlet::new(dt).substeps_at_most(options.substeps)),
            SymplecticEuler => make!(hooke::SymplecticEuler::new(dt)),
        }
    }

    /// The data's scene after so many steps under all its forces.
    pub fn run<T: Real>(self, data: &SceneData, options: Options, steps: usize) -> VecScene<T> {
        let mut scene = build::scene::<T>(data);
        let mut forces = Forces::<T>::new(data);
        for step in 0..steps {
            let made = self.step(&mut scene, options, forces.all(), &[]);
            assert!(made.is_ok(), "{self:?}, step {step}: {made:?}");
        }
        scene
    }
}
