//! Error control: steps as long as an accuracy allows.
//!
//! A step of an [`Embedded`] method is taken if the energy E of its estimated error is at most J; if not, it is made anew,
//! shorter. The next step follows a PI controller, with J/E to powers that are made of square roots only:
//!
//! h⁺ = 0.9 h (J/E)^α (J/E₋)^−β, α = 3/16, β = 1/8 where E ~ h⁴, α = 1/8, β = 1/16 where E ~ h⁶,
//!
//! E₋ of the step before, the factor between ⅕ and 5. A step that the caller's end cuts short leaves the length as it was. Solves
//! are exact to J/4096: what they leave undone is small beside what the step does. So the bits are a function of the scene,
//! the options and the ends that are asked for.
//!
//! J is an error per step, not of a run. A method of order 2 gets up to ten times closer with J a hundred times smaller.
//! Where the method has no stable step, where J is below what rounding makes of a step, ½u²Σm(|q̇|² + |q|²/h²), where a shorter
//! step has no smaller error, or after 24 rejections, [`StepError::Accuracy`], and [`Adaptive::attained`] tells the least E that
//! is to be had.
//!
//! Source: Gustafsson 1991, *Control theoretic techniques for stepsize selection in explicit Runge–Kutta methods*; Söderlind
//! 2003, *Digital filters in adaptive time-stepping*.

use super::Integrator;
use super::embedded::{Embedded, LocalError};
use crate::error::StepError;
use crate::memory::Memory;
use crate::parts::Parts;
use crate::pins::{Course, Motion};
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::scene::MassSpring;
use crate::vec3;

/// No more rejections of one step than these.
const REJECTIONS: u32 = 24;

/// A method with its steps' lengths chosen. A call of [`crate::MassSpring::step`] makes one step; [`Adaptive::made`] tells how
/// long it was.
///
/// A motion is given over the time of [`Adaptive::end_after`], however many steps that takes: give it again, with the time that is
/// left, until it is over. Each step leaves the pin on the cubic of both ends, so all methods keep their order. Without an end a
/// motion is refused. How far the cubic is from the way that the caller has in mind is not judged; where that way has a corner,
/// let a motion end there and [`crate::MassSpring::set_pin_velocity`] begin the next.
///
/// ```
/// use hooke::{Adaptive, Rosenbrock2, Scene};
/// let mut scene = Scene::<f64, 2, 1>::new();
/// let (a, b) = (scene.particle([0.0; 3], 1.0)?, scene.particle([1.5, 0.0, 0.0], 1.0)?);
/// let spring = scene.spring(a, b, 100.0)?;
/// scene.set_rest_length(spring, 1.0)?;
/// scene.pin(a)?;
/// let memory = [[0.0; 3]; Rosenbrock2::<f64, ()>::needs(2)];
/// let mut method = Adaptive::new(Rosenbrock2::new(0.01, memory), 0.01, 1e-8);
/// let mut time = 0.0;
/// while time < 0.5 {
///     method.end_after(0.5 - time); // The next step ends there or before.
///     scene.step(&mut method)?;
///     time += method.made().dt;
/// }
/// let [x, ..] = scene.positions()[b];
/// assert!((x - (1.0 + 0.5 * (10.0f64 * 0.5).cos())).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Adaptive<I, T> {
    /// The method, with its forces and its solver.
    pub method: I,
    accuracy: T,
    /// The next step, unless the end is nearer
    dt: T,
    end: T,
    /// J/E of the step before
    before: T,
    made: Made<T>,
    attained: T,
}

/// A step that was made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Made<T> {
    /// How long it is, s.
    pub dt: T,
    /// Its estimated error.
    pub error: LocalError<T>,
    /// How many longer ones were rejected.
    pub rejections: u32,
}

/// What an attempt that was not taken has shown ([`Adaptive::probe`]).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Probed<T> {
    /// What such a step costs.
    pub report: Report<T>,
    /// The step that the next one begins with, s, also what [`Adaptive::dt`] answers.
    pub dt: T,
    /// The energy of the error that a step of this length is foretold to have, J: about what was asked for where the error
    /// decides on the length, less where the method has no longer step that is stable.
    pub energy: T,
    /// Was the length that was tried right within a factor of 2?
    pub settled: bool,
}

impl<I, T: Real> Adaptive<I, T> {
    /// A method that begins with a step of `dt` seconds and takes steps whose error is at most so many joules.
    pub const fn new(method: I, dt: T, accuracy: T) -> Self {
        let none = LocalError { energy: T::ZERO, distance: T::ZERO };
        let made = Made { dt: T::ZERO, error: none, rejections: 0 };
        Self { method, accuracy, dt, end: T::ZERO, before: T::ONE, made, attained: T::ZERO }
    }

    /// The next step takes at most so many seconds; 0, as at first, for no end.
    pub fn end_after(&mut self, seconds: T) {
        self.end = seconds;
    }

    /// Another accuracy, J, from the next step on.
    pub fn set_accuracy(&mut self, joules: T) {
        self.accuracy = joules;
    }

    /// The step that the next one begins with, s, if no end is nearer.
    pub fn dt(&self) -> T {
        self.dt
    }

    /// The last step that was made.
    pub fn made(&self) -> Made<T> {
        self.made
    }

    /// After [`StepError::Accuracy`]: the least energy of an error that is to be had, J.
    pub fn attained(&self) -> T {
        self.attained
    }
}

/// x^(1/2ⁿ)
fn root<T: Real>(mut x: T, n: u32) -> T {
    for _ in 0..n {
        x = x.sqrt();
    }
    x
}

/// Σ mᵢ|q̇ᵢ|² and Σ mᵢ|qᵢ|² over free particles.
fn sizes<M: Memory<Real = T>, T: Real>(parts: &Parts<'_, M>) -> (T, T) {
    let state = parts.network.state();
    let (mut moving, mut placed) = (T::ZERO, T::ZERO);
    for i in parts.islands.all_rows(&state).particles() {
        if let (Some(m), Some(q), Some(v)) = (state.mass.get(i), state.position.get(i), state.velocity.get(i))
        {
            moving += *m * vec3::dot(*v, *v);
            placed += *m * vec3::dot(*q, *q);
        }
    }
    (moving, placed)
}

/// x, but from `least` to `most`; a NaN becomes `least`.
fn within<T: Real>(x: T, least: T, most: T) -> T {
    if !(x >= least) {
        least
    } else if x > most {
        most
    } else {
        x
    }
}

impl<I: Embedded<T>, T: Real> Adaptive<I, T> {
    /// J/E, within a range that keeps its roots finite.
    fn ratio(&self, error: LocalError<T>) -> T {
        let most = T::from_f64(1e8);
        within(self.accuracy / error.energy, T::ONE / most, most)
    }

    /// How much longer the next step may be.
    fn factor(&self, ratio: T) -> T {
        let (integral, proportional) = if I::LOWER_ORDER <= 1 {
            (root(ratio, 3) * root(ratio, 4), root(self.before, 3))
        } else {
            (root(ratio, 3), root(self.before, 4))
        };
        within(T::from_f64(0.9) * integral / proportional, T::from_f64(0.2), T::from_f64(5.0))
    }

    /// How much shorter a step must be to be accepted.
    fn shortened(ratio: T) -> T {
        let root = if I::LOWER_ORDER <= 1 { root(ratio, 2) } else { root(ratio, 3) * root(ratio, 4) };
        within(T::from_f64(0.9) * root, T::from_f64(0.1), T::HALF)
    }
}

impl<I: Embedded<T>, T: Real> Adaptive<I, T> {
    /// One attempt at a step where the scene is, which is not taken: the next begins with the length that its error asks for
    /// ([`Probed::dt`]), at most twenty times more or less. A few of them find how long a step may be, for choosing between methods.
    /// Not always: where the error is no power of the step, as at rest, they may go on for ever between two lengths; so bound their
    /// number.
    ///
    /// # Errors
    /// [`StepError`]; the scene has not changed. After [`StepError::NotFinite`] the next attempt is twenty times shorter.
    pub fn probe<M: Memory<Real = T>>(
        &mut self,
        scene: &mut MassSpring<M>,
        motion: &[Motion<T>],
    ) -> Result<Probed<T>, StepError> {
        let course = self.course(motion)?;
        let mut parts = scene.parts();
        let longest = self.method.longest(&mut parts);
        if !(longest > T::ZERO) {
            return Err(StepError::Accuracy);
        }
        if longest < self.dt {
            self.dt = longest;
        }
        // Beyond its end a motion is not known.
        let ends = !motion.is_empty() && course.over < self.dt;
        if ends {
            self.dt = course.over;
        }
        let absolute = self.accuracy / T::from_count(4096);
        let attempt = self.method.attempt(&mut parts, self.dt, course, absolute, &mut |_| {});
        if let Err(StepError::NotFinite(_)) = attempt {
            self.dt = self.dt * T::from_f64(0.05);
        }
        let (report, error) = attempt?;
        let ratio = self.ratio(error);
        let root = if I::LOWER_ORDER <= 1 { root(ratio, 2) } else { root(ratio, 3) * root(ratio, 4) };
        let factor = within(T::from_f64(0.9) * root, T::from_f64(0.05), T::from_f64(20.0));
        self.before = T::ONE;
        let tried = self.dt;
        let next = tried * factor;
        if (next * next).is_finite() {
            self.dt = next;
        }
        let cut = longest < self.dt;
        if cut {
            self.dt = longest;
        }
        let longer = self.dt / tried;
        let square = longer * longer;
        let power = if I::LOWER_ORDER <= 1 { square * square } else { square * square * square };
        Ok(Probed {
            report,
            dt: self.dt,
            energy: error.energy * power,
            settled: (factor > T::HALF && factor < T::TWO) || ((cut || ends) && factor > T::ONE),
        })
    }

    /// Motions over the time until the end, which they must have.
    fn course<'m>(&self, motion: &'m [Motion<T>]) -> Result<Course<'m, T>, StepError> {
        match motion.first() {
            Some(m) if !(self.end > T::ZERO && self.end.is_finite()) => Err(StepError::Motion(m.particle)),
            _ => Ok(Course { motion, over: self.end }),
        }
    }
}

impl<I: Embedded<T>, T: Real> Integrator<T> for Adaptive<I, T> {
    fn advance<M: Memory<Real = T>>(
        &mut self,
        mut parts: Parts<'_, M>,
        motion: &[Motion<T>],
        watch: &mut impl FnMut(&IslandReport<T>),
    ) -> Result<Report<T>, StepError> {
        let course = self.course(motion)?;
        if !(self.accuracy > T::ZERO && self.accuracy.is_finite()) {
            return Err(StepError::Tolerance);
        }
        if !(self.dt > T::ZERO && self.dt.is_finite()) {
            return Err(StepError::TimeStep);
        }
        let longest = self.method.longest(&mut parts);
        if !(longest > T::ZERO) {
            return Err(StepError::Accuracy);
        }
        if longest < self.dt {
            self.dt = longest;
        }
        let cut = self.end > T::ZERO && self.end < self.dt;
        let mut dt = if cut { self.end } else { self.dt };
        let mut rejections = 0;
        self.attained = T::ZERO;
        let (moving, placed) = sizes(&parts);
        let tiny = T::from_count(4096);
        loop {
            // What rounding alone is as an error: u of every position and velocity. It is no number where dt² is 0.
            let unit = T::HALF * T::UNIT_ROUNDOFF * T::UNIT_ROUNDOFF;
            let rounding = unit * (moving + placed / (dt * dt));
            if !(rounding <= self.accuracy) {
                self.attained = rounding;
                return Err(StepError::Accuracy);
            }
            let error = match self.method.attempt(&mut parts, dt, course, self.accuracy / tiny, watch) {
                Ok((report, error)) if error.energy <= self.accuracy => {
                    self.method.accept(parts, course)?;
                    let ratio = self.ratio(error);
                    let next = dt * self.factor(ratio);
                    // Where nothing has an error steps grow, but not beyond what has a square.
                    if (next * next).is_finite() && !(cut && rejections == 0 && next < self.dt) {
                        self.dt = next;
                    }
                    self.before = ratio;
                    self.made = Made { dt, error, rejections };
                    return Ok(report);
                }
                Ok((_, error)) => Some(error),
                // What is out of range at this step need not be at a shorter one.
                Err(StepError::NotFinite(_)) => None,
                Err(error) => return Err(error),
            };
            dt = dt * error.map_or(T::from_f64(0.1), |error| Self::shortened(self.ratio(error)));
            rejections += 1;
            let energy = error.map_or(T::ZERO, |error| error.energy);
            // Half the step or less without half the error: no step helps.
            let stuck = rejections > 6 && self.attained > T::ZERO && energy > T::HALF * self.attained;
            if energy > T::ZERO && !(self.attained > T::ZERO && self.attained < energy) {
                self.attained = energy;
            }
            if stuck || rejections >= REJECTIONS {
                return Err(StepError::Accuracy);
            }
        }
    }
}
