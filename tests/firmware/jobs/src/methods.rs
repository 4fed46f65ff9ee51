//! A rope by each method of time integration besides the default: damped, and with a pin that moves where the method takes it.

use hooke::{
    Adaptive, EnergyMomentum, Hookean, Integrator, MassSpring, Memory, Midpoint, Motion, Newton, Real,
    Rosenbrock2, Rosenbrock3, Scene, SpringDamping, SymplecticEuler, Vec3, Verlet,
};
use static_cell::ConstStaticCell;

use crate::job::Job;
use crate::outcome::{Outcome, expect};
use crate::scenes::{gravity, hang, real, vector};
use crate::trace::Trace;

const PARTICLES: usize = 8;
type Rope<T> = Scene<T, PARTICLES, { PARTICLES - 1 }, Hookean>;

/// As many vectors as the method that needs most.
const VECTORS: usize = Rosenbrock3::<f64, ()>::needs(PARTICLES);

/// A two-hundredth of a second: below the limits of explicit methods, which are 2/√(4·1000/0.01) = 3.1 ms, in two substeps.
fn dt<T: Real>() -> T {
    T::ONE / T::from_count(200)
}

/// How hard the springs resist, N·s/m.
fn damping<T: Real>() -> SpringDamping<T> {
    SpringDamping(real(0.05))
}

/// Steps over which the pin is drawn aside and up, ever faster.
fn drawn<M: Memory>(
    scene: &mut MassSpring<M>,
    trace: &mut Trace<'_>,
    mut method: impl Integrator<M::Real>,
    dt: f64,
) -> Outcome {
    hang(scene, PARTICLES)?;
    for tick in 1..=8 {
        let t = f64::from(tick) * dt;
        let motion = Motion {
            particle: 0,
            position: vector(4.0 * t * t, t * t, 0.0),
            velocity: vector(8.0 * t, 2.0 * t, 0.0),
        };
        let report = scene.step_moving(&mut method, &[motion])?;
        trace.step(scene, &report)?;
    }
    Ok(())
}

/// Steps whose length is chosen.
fn chosen<M: Memory>(
    scene: &mut MassSpring<M>,
    trace: &mut Trace<'_>,
    memory: &mut [Vec3<M::Real>],
) -> Outcome {
    hang(scene, PARTICLES)?;
    let method = Rosenbrock3::new(dt(), memory).gravity(gravity()).with(damping::<M::Real>());
    let mut method = Adaptive::new(method, real(0.05), real(1e-5));
    let mut rejections = 0;
    for _ in 0..6 {
        let report = scene.step(&mut method)?;
        rejections += method.made().rejections;
        trace.step(scene, &report)?;
    }
    expect(rejections > 0, "no step was rejected")
}

macro_rules! job {
    ($job:ident, $t:ident, $name:literal, $run:expr) => {
        #[doc = concat!("The method ", $name, " in `", stringify!($t), "`.")]
        pub const $job: Job = {
            static SCENE: ConstStaticCell<Rope<$t>> = ConstStaticCell::new(Scene::new());
            Job {
                name: $name,
                precision: stringify!($t),
                start: |trace| {
                    let run: fn(&mut Rope<$t>, &mut Trace<'_>) -> Outcome = $run;
                    run(SCENE.take(), trace)
                },
            }
        };
    };
}

/// A static list of vectors.
macro_rules! memory {
    ($t:ty) => {{
        static LIST: ConstStaticCell<[Vec3<$t>; VECTORS]> = ConstStaticCell::new([[0.0; 3]; VECTORS]);
        LIST.take().as_mut_slice()
    }};
}

/// The job of a method that `$make` makes from a step (and memory).
macro_rules! both {
    ($f32:ident, $f64:ident, $name:literal, $make:expr, $dt:expr) => {
        job!($f32, f32, $name, |scene, trace| {
            drawn(scene, trace, $make.gravity(gravity()).with(damping::<f32>()), $dt)
        });
        job!($f64, f64, $name, |scene, trace| {
            drawn(scene, trace, $make.gravity(gravity()).with(damping::<f64>()), $dt)
        });
    };
    (memory $f32:ident, $f64:ident, $name:literal, $make:expr) => {
        job!($f32, f32, $name, |scene, trace| {
            drawn(
                scene,
                trace,
                $make(dt(), memory!(f32)).gravity(gravity()).with(damping::<f32>()),
                1.0 / 200.0,
            )
        });
        job!($f64, f64, $name, |scene, trace| {
            drawn(
                scene,
                trace,
                $make(dt(), memory!(f64)).gravity(gravity()).with(damping::<f64>()),
                1.0 / 200.0,
            )
        });
    };
}

both!(MIDPOINT_F32, MIDPOINT_F64, "midpoint", Midpoint::new(dt()), 1.0 / 200.0);
both!(memory ROS2_F32, ROS2_F64, "ros2", Rosenbrock2::new);
both!(memory ROS3_F32, ROS3_F64, "ros3", Rosenbrock3::new);
both!(memory NEWTON_F32, NEWTON_F64, "newton", Newton::new);
both!(memory ENERGY_MOMENTUM_F32, ENERGY_MOMENTUM_F64, "energy-momentum", EnergyMomentum::new);
both!(VERLET_F32, VERLET_F64, "verlet", Verlet::new(dt()).substeps_at_most(4), 1.0 / 200.0);
both!(SYMPLECTIC_F32, SYMPLECTIC_F64, "symplectic-euler", SymplecticEuler::new(real(0.001)), 0.001);
job!(ADAPTIVE_F32, f32, "adaptive", |scene, trace| chosen(scene, trace, memory!(f32)));
job!(ADAPTIVE_F64, f64, "adaptive", |scene, trace| chosen(scene, trace, memory!(f64)));
