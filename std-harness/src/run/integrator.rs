//! The kernel's integrators by name, with the memory that each needs.

use hooke::{
    Adaptive, EnergyMomentum, Force, LinearlyImplicitEuler, Made, MassSpring, Memory, Midpoint, Motion,
    Newton, Probed, Real, Report, Rosenbrock2, Rosenbrock3, Sleeping, StepError, SymplecticEuler, Verlet,
};

use super::choice::{Auto, COMPETITORS};
use super::counted::Counted;
use super::simulation::Forces;
use super::solver::AnySolver;
use crate::heap::Heap;

/// How a scene is moved on in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Linearly-implicit Euler, the lecture's.
    Euler,
    /// The linearly-implicit midpoint rule.
    Midpoint,
    /// A Rosenbrock method of order 2.
    Ros2,
    /// A Rosenbrock method of order 3.
    Ros3,
    /// Backward Euler, solved by Newton's method.
    Newton,
    /// The energy-momentum method.
    EnergyMomentum,
    /// Velocity Verlet.
    Verlet,
    /// Symplectic Euler.
    SymplecticEuler,
    /// Whichever costs least ([`super::choice`]).
    Auto,
}

/// What `--integrator` calls them.
pub const INTEGRATORS: [(&str, Integrator); 9] = [
    ("euler", Integrator::Euler),
    ("midpoint", Integrator::Midpoint),
    ("ros2", Integrator::Ros2),
    ("ros3", Integrator::Ros3),
    ("newton", Integrator::Newton),
    ("energy-momentum", Integrator::EnergyMomentum),
    ("verlet", Integrator::Verlet),
    ("symplectic-euler", Integrator::SymplecticEuler),
    ("auto", Integrator::Auto),
];

impl Integrator {
    /// What `--integrator` calls it.
    pub fn name(self) -> &'static str {
        INTEGRATORS.iter().find(|(_, integrator)| *integrator == self).map_or("", |(name, _)| name)
    }

    /// In words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Euler => "linearly-implicit Euler",
            Self::Midpoint => "linearly-implicit midpoint",
            Self::Ros2 => "Rosenbrock 2",
            Self::Ros3 => "Rosenbrock 3",
            Self::Newton => "backward Euler by Newton",
            Self::EnergyMomentum => "energy-momentum",
            Self::Verlet => "velocity Verlet",
            Self::SymplecticEuler => "symplectic Euler",
            Self::Auto => "auto",
        }
    }

    /// Does it know how wrong a step is, so that `--accuracy` can choose its length?
    pub fn is_embedded(self) -> bool {
        matches!(self, Self::Ros2 | Self::Ros3 | Self::Verlet | Self::Auto)
    }

    /// Has it a limit beyond which no step is stable?
    pub fn is_explicit(self) -> bool {
        matches!(self, Self::Verlet | Self::SymplecticEuler)
    }
}

/// Memory of a method: vectors on the heap.
type Vectors<T> = Vec<[T; 3]>;
/// What an island's sleep is decided by, if at all.
type MaybeSleeping<T> = Option<Sleeping<T, Vec<T>, Vec<u32>>>;
/// Any solver, counted.
pub type AnyCounted<T> = Counted<AnySolver<T>>;
type Ros2<T> = Rosenbrock2<T, Vectors<T>, Forces<T>, AnyCounted<T>>;
type Ros3<T> = Rosenbrock3<T, Vectors<T>, Forces<T>, AnyCounted<T>>;

/// Any of the integrators, decided when the program runs, with the scene's forces and a solver.
// One of them per simulation: that they differ in size does not matter.
#[allow(clippy::large_enum_variant)]
pub enum AnyIntegrator<T: Real> {
    /// [`Integrator::Euler`]
    Euler(LinearlyImplicitEuler<T, Forces<T>, AnyCounted<T>, MaybeSleeping<T>>),
    /// [`Integrator::Midpoint`]
    Midpoint(Midpoint<T, Forces<T>, AnyCounted<T>>),
    /// [`Integrator::Ros2`]
    Ros2(Ros2<T>),
    /// [`Integrator::Ros3`]
    Ros3(Ros3<T>),
    /// [`Integrator::Newton`]
    Newton(Newton<T, Vectors<T>, Forces<T>, AnyCounted<T>>),
    /// [`Integrator::EnergyMomentum`]
    EnergyMomentum(EnergyMomentum<T, Vectors<T>, Forces<T>, AnyCounted<T>>),
    /// [`Integrator::Verlet`]
    Verlet(Verlet<T, Forces<T>>),
    /// [`Integrator::SymplecticEuler`]
    SymplecticEuler(SymplecticEuler<T, Forces<T>>),
    /// [`Integrator::Ros2`] with its steps chosen
    AdaptiveRos2(Adaptive<Ros2<T>, T>),
    /// [`Integrator::Ros3`] with its steps chosen
    AdaptiveRos3(Adaptive<Ros3<T>, T>),
    /// [`Integrator::Verlet`] with its steps chosen
    AdaptiveVerlet(Adaptive<Verlet<T, Forces<T>>, T>),
    /// [`Integrator::Auto`]
    Auto(Box<Auto<T>>),
}

/// What an integrator is to be made with.
pub struct Options<T> {
    /// The step, or the first one, s
    pub dt: T,
    /// Of a solve; the kernel's if none
    pub tolerance: Option<T>,
    /// Of a solve, J
    pub absolute: T,
    /// The kernel's if none
    pub max_iterations: Option<u32>,
    /// Error per step, J: the steps are chosen
    pub accuracy: Option<T>,
    /// How many particles the scene has
    pub particles: usize,
    /// At most so many substeps of Verlet
    pub substeps: u32,
}

/// The same expression for whatever integrator it is, and another for several.
macro_rules! whichever {
    ($self:expr, $method:ident => $do:expr, $auto:ident => $of_auto:expr) => {
        match $self {
            AnyIntegrator::Auto($auto) => $of_auto,
            AnyIntegrator::Euler($method) => $do,
            AnyIntegrator::Midpoint($method) => $do,
            AnyIntegrator::Ros2($method) => $do,
            AnyIntegrator::Ros3($method) => $do,
            AnyIntegrator::Newton($method) => $do,
            AnyIntegrator::EnergyMomentum($method) => $do,
            AnyIntegrator::Verlet($method) => $do,
            AnyIntegrator::SymplecticEuler($method) => $do,
            AnyIntegrator::AdaptiveRos2(Adaptive { method: $method, .. }) => $do,
            AnyIntegrator::AdaptiveRos3(Adaptive { method: $method, .. }) => $do,
            AnyIntegrator::AdaptiveVerlet(Adaptive { method: $method, .. }) => $do,
        }
    };
}

impl<T: Real> AnyIntegrator<T> {
    /// The integrator with its memory; what of it sleeps is for [`Integrator::Euler`] alone.
    pub fn new(
        name: Integrator,
        options: &Options<T>,
        forces: Forces<T>,
        solver: AnyCounted<T>,
        sleeping: MaybeSleeping<T>,
    ) -> Self {
        let Options { dt, accuracy, particles, .. } = *options;
        let memory = |vectors: usize| vec![[T::ZERO; 3]; vectors];
        let with = |forces: Forces<T>| forces;
        macro_rules! made {
            ($method:expr) => {{
                let ((((), gravity), drag), damping) = with(forces);
                let mut method = $method.with(gravity).with(drag).with(damping).absolute(options.absolute);
                if let Some(tolerance) = options.tolerance {
                    method = method.tolerance(tolerance);
                }
                if let Some(n) = options.max_iterations {
                    method = method.max_iterations(n);
                }
                method
            }};
        }
        match (name, accuracy) {
            (Integrator::Euler, _) => {
                Self::Euler(made!(LinearlyImplicitEuler::new(dt)).solver(solver).sleeping(sleeping))
            }
            (Integrator::Midpoint, _) => Self::Midpoint(made!(Midpoint::new(dt)).solver(solver)),
            (Integrator::Ros2, accuracy) => {
                let memory = memory(Rosenbrock2::<T, ()>::needs(particles));
                let method = made!(Rosenbrock2::new(dt, memory)).solver(solver);
                match accuracy {
                    Some(joules) => Self::AdaptiveRos2(Adaptive::new(method, dt, joules)),
                    None => Self::Ros2(method),
                }
            }
            (Integrator::Ros3, accuracy) => {
                let memory = memory(Rosenbrock3::<T, ()>::needs(particles));
                let method = made!(Rosenbrock3::new(dt, memory)).solver(solver);
                match accuracy {
                    Some(joules) => Self::AdaptiveRos3(Adaptive::new(method, dt, joules)),
                    None => Self::Ros3(method),
                }
            }
            (Integrator::Newton, _) => {
                let memory = memory(Newton::<T, ()>::needs(particles));
                Self::Newton(made!(Newton::new(dt, memory)).solver(solver))
            }
            (Integrator::EnergyMomentum, _) => {
                let memory = memory(EnergyMomentum::<T, ()>::needs(particles));
                Self::EnergyMomentum(made!(EnergyMomentum::new(dt, memory)).solver(solver))
            }
            (Integrator::Verlet, accuracy) => {
                let method = made!(Verlet::new(dt)).substeps_at_most(options.substeps);
                match accuracy {
                    Some(joules) => Self::AdaptiveVerlet(Adaptive::new(method, dt, joules)),
                    None => Self::Verlet(method),
                }
            }
            (Integrator::SymplecticEuler, _) => Self::SymplecticEuler(made!(SymplecticEuler::new(dt))),
            // Several, made one by one: see `Simulation::new`.
            (Integrator::Auto, _) => {
                Self::Euler(made!(LinearlyImplicitEuler::new(dt)).solver(solver).sleeping(sleeping))
            }
        }
    }

    /// How many vectors it has besides the scene's.
    pub fn vectors(name: Integrator, particles: usize) -> usize {
        match name {
            Integrator::Ros2 => Rosenbrock2::<T, ()>::needs(particles),
            Integrator::Ros3 => Rosenbrock3::<T, ()>::needs(particles),
            Integrator::Newton => Newton::<T, ()>::needs(particles),
            Integrator::EnergyMomentum => EnergyMomentum::<T, ()>::needs(particles),
            Integrator::Auto => COMPETITORS.into_iter().map(|name| Self::vectors(name, particles)).sum(),
            _ => 0,
        }
    }

    /// The forces besides the springs'.
    pub fn forces(&self) -> &Forces<T> {
        whichever!(self, method => &method.forces, auto => auto.method().forces())
    }

    /// One step.
    pub fn step(
        &mut self,
        scene: &mut MassSpring<Heap<T>>,
        motion: &[Motion<T>],
    ) -> Result<Report<T>, StepError> {
        match self {
            Self::AdaptiveRos2(method) => scene.step_moving(method, motion),
            Self::AdaptiveRos3(method) => scene.step_moving(method, motion),
            Self::AdaptiveVerlet(method) => scene.step_moving(method, motion),
            other => {
                whichever!(other, method => scene.step_moving(method, motion), auto => auto.step(scene, motion))
            }
        }
    }

    /// Another step, s.
    pub fn set_dt(&mut self, dt: T) {
        whichever!(self, method => method.set_dt(dt), _auto => {});
    }

    /// With chosen steps: the next one takes at most so many seconds.
    pub fn end_after(&mut self, seconds: T) {
        match self {
            Self::AdaptiveRos2(method) => method.end_after(seconds),
            Self::AdaptiveRos3(method) => method.end_after(seconds),
            Self::AdaptiveVerlet(method) => method.end_after(seconds),
            Self::Auto(auto) => auto.end_after(seconds),
            _ => {}
        }
    }

    /// With chosen steps: the last one, and the least error that was reached when none could be accepted.
    pub fn made(&self) -> Option<(Made<T>, T)> {
        match self {
            Self::AdaptiveRos2(method) => Some((method.made(), method.attained())),
            Self::AdaptiveRos3(method) => Some((method.made(), method.attained())),
            Self::AdaptiveVerlet(method) => Some((method.made(), method.attained())),
            Self::Auto(auto) => auto.method().made(),
            _ => None,
        }
    }

    /// Does it see how fast pins move when a step begins?
    pub fn interpolates(&self) -> bool {
        matches!(self, Self::Ros2(_) | Self::Ros3(_) | Self::Verlet(_))
    }

    /// With chosen steps: how long the next one is to be, s.
    pub fn next(&self) -> Option<T> {
        match self {
            Self::AdaptiveRos2(method) => Some(method.dt()),
            Self::AdaptiveRos3(method) => Some(method.dt()),
            Self::AdaptiveVerlet(method) => Some(method.dt()),
            Self::Auto(auto) => auto.next(),
            _ => None,
        }
    }

    /// With chosen steps: an attempt that is not taken ([`Adaptive::probe`]).
    pub fn probe(
        &mut self,
        scene: &mut MassSpring<Heap<T>>,
        motion: &[Motion<T>],
    ) -> Option<Result<Probed<T>, StepError>> {
        macro_rules! probed {
            ($method:expr) => {
                Some($method.probe(scene, motion))
            };
        }
        match self {
            Self::AdaptiveRos2(method) => probed!(method),
            Self::AdaptiveRos3(method) => probed!(method),
            Self::AdaptiveVerlet(method) => probed!(method),
            _ => None,
        }
    }

    /// What was picked and why, if that was left to the program while it runs.
    pub fn told(&self) -> Option<String> {
        match self {
            Self::Auto(auto) => Some(auto.told()),
            _ => None,
        }
    }

    /// The largest step that an explicit method is stable with, s; `None` for the others.
    pub fn limit<M: Memory<Real = T>>(&mut self, scene: &mut MassSpring<M>) -> Option<T> {
        match self {
            Self::Verlet(method) => Some(method.limit(scene)),
            Self::SymplecticEuler(method) => Some(method.limit(scene)),
            _ => None,
        }
    }

    /// Refuses forces that are not valid.
    pub fn check(&self, particles: usize, springs: usize) -> Result<(), StepError> {
        self.forces().check(particles, springs)
    }
}
