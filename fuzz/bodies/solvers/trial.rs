//! A trial: steps with one solver that keeps what it knows, and changes of the scene between them.

use hooke::{Drag, LinearlyImplicitEuler, Real, Report, Rosenbrock2, Solver, SpringDamping, StepError};

use super::network::Network;
use super::reference::Reference;
use super::{Heaped, Size};
use crate::bytes::Bytes;
use crate::kernel::visible;

/// Steps and changes of one trial.
pub const ACTIONS: usize = 5;
/// So often may an island ask for a larger workspace: for its pattern, its factor, and once more.
const ANSWERS: usize = 3;

/// Options of a trial's steps.
pub struct Options {
    dt: f64,
    drag: f64,
    damping: f64,
    tolerance: f64,
    iterations: u32,
    /// By the other method, of which nothing but the report tells the exactness
    other: bool,
    /// Is a large system to be judged too, at the first step?
    large: bool,
}

/// A step of another method.
pub type Other<T, S> = fn(&mut Heaped<T>, &mut S, &Options) -> Result<Report<T>, StepError>;

/// All forces and options that bytes choose, for any method.
macro_rules! method {
    ($method:expr, $options:expr) => {
        $method
            .gravity([0.0, -9.81, 0.0].map(T::from_f64))
            .with(Drag(T::from_f64($options.drag)))
            .with(SpringDamping(T::from_f64($options.damping)))
            .tolerance(T::from_f64($options.tolerance))
            .max_iterations($options.iterations)
    };
}

/// The step of a method that solves twice with one matrix.
pub fn two_stages<T: Real, S: Solver<T>>(
    scene: &mut Heaped<T>,
    solver: &mut S,
    options: &Options,
) -> Result<Report<T>, StepError> {
    // What is in the memory must not matter.
    let memory = vec![[T::from_f64(f64::NAN); 3]; Rosenbrock2::<T, ()>::needs(scene.positions().len())];
    scene.step(&mut method!(Rosenbrock2::new(T::from_f64(options.dt), memory), options).solver(solver))
}

/// Tries one solver, made by `make` in a workspace that `needs` tells the size of, or in a smaller one. `lanes`: does it add
/// up b in an order of its own? `other` is tried in place of linearly-implicit Euler where the bytes say so: not with all
/// solvers, since each pair is compiled anew.
pub fn trial<T: Real, S: Solver<T>>(
    network: &Network,
    mut bytes: Bytes<'_>,
    lanes: bool,
    needs: impl Fn(&mut Heaped<T>) -> Size,
    make: impl Fn(Size) -> S,
    other: Option<Other<T, S>>,
) {
    let mut scene = network.build::<T>();
    let flags = bytes.byte();
    let mut number = |bit: u8, other: f64| if flags & bit == 0 { other } else { bytes.size() };
    let mut options = Options {
        dt: number(1, 1.0) / 64.0,
        drag: number(2, 0.0),
        damping: number(4, 0.0),
        tolerance: number(8, 1.0) * 1e-3,
        iterations: if flags & 16 == 0 { 1000 } else { 3 },
        other: flags & 64 != 0,
        large: flags & 128 != 0,
    };
    // A workspace for the scene before anything changes, less than that, or nothing.
    let mut size = needs(&mut scene);
    if flags & 32 != 0 {
        size = (size.0 / 2, size.1 / 2);
    }
    let other = other.filter(|_| options.other);
    let mut solver = make(size);
    for action in 0..ACTIONS {
        let mut answers = 0;
        options.large &= action == 0;
        while let Err(StepError::Workspace { numbers, words }) =
            step(&mut scene, &mut solver, &options, lanes, other)
        {
            let short = numbers > size.0 || words > size.1;
            assert!(short, "{numbers} numbers and {words} words are asked for where {size:?} are");
            size = (size.0.max(numbers), size.1.max(words));
            solver = make(size);
            answers += 1;
            assert!(answers <= ANSWERS * scene.islands(), "{size:?} were asked for and are not enough");
        }
        if bytes.is_empty() {
            return;
        }
        change(&mut scene, &mut bytes);
    }
}

/// One step and what must hold of it.
fn step<T: Real, S: Solver<T>>(
    scene: &mut Heaped<T>,
    solver: &mut S,
    options: &Options,
    lanes: bool,
    other: Option<Other<T, S>>,
) -> Result<(), StepError> {
    let real = T::from_f64;
    let before = visible(scene);
    let mut euler = method!(LinearlyImplicitEuler::new(real(options.dt)), options);
    let reference = if other.is_some() { None } else { Reference::of(scene, &mut euler, options.large) };
    assert_eq!(visible(scene), before, "a look changes nothing");
    let report = match other {
        Some(step) => step(scene, solver, options),
        None => scene.step(&mut euler.solver(solver)),
    };
    let now = visible(scene);
    let r = match report {
        Ok(report) => report,
        Err(error) => {
            assert_eq!(now, before, "a refused step changes nothing");
            let valid = |x: f64| x >= 0.0 && real(x).is_finite();
            let caused = match error {
                StepError::TimeStep | StepError::NotFinite(_) => true,
                StepError::Workspace { .. } => return Err(error),
                StepError::Tolerance => !valid(options.tolerance),
                StepError::Field => !valid(options.drag),
                StepError::Damping(_) => !valid(options.damping),
                _ => false,
            };
            assert!(caused, "an error without a cause: {error:?}");
            return Ok(());
        }
    };
    let zero = T::ZERO;
    assert!(zero <= r.lower && r.lower <= r.upper && r.upper.is_finite(), "bounds in order: {r:?}");
    assert_eq!(r.islands as usize, scene.islands(), "all islands are counted");
    assert!(r.certified <= r.islands && r.clamped as usize <= scene.state().springs(), "counts: {r:?}");
    let state = [scene.positions(), scene.velocities()];
    assert!(state.iter().all(|list| list.as_flattened().iter().all(|x| x.is_finite())), "finite");
    if let Some(reference) = reference {
        reference.judge(scene, &r, lanes);
    }
    Ok(())
}

/// A change that solvers must notice.
fn change<T: Real>(scene: &mut Heaped<T>, bytes: &mut Bytes<'_>) {
    let (what, i) = (bytes.byte(), bytes.below(100));
    let number = T::from_f64(bytes.number());
    // Whatever is refused is no change.
    _ = match what % 8 {
        0 => scene.break_spring(i),
        1 => scene.pin(i),
        2 => scene.release(i),
        3 => scene.set_stiffness(i, number),
        4 => scene.set_rest_length(i, number),
        5 => scene.set_mass(i, number),
        6 => scene.spring(i, bytes.below(100), number).map(|_| ()),
        _ => Ok(()),
    };
}
