//! The methods that are tried: every integrator with equal steps, and those that can with steps of their own choice.

use hooke::StepError;

use crate::error::InputError;
use crate::run::integrator::Integrator;
use crate::run::plan::known;

/// A method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Method {
    /// What `--integrator` of stress calls it.
    pub name: &'static str,
    /// The integrator.
    pub integrator: Integrator,
    /// Are its steps chosen by its error?
    pub chosen: bool,
    /// The most linear systems of a step and island, as the kernel's own limits allow.
    pub most_solves: u64,
}

const fn equal(name: &'static str, integrator: Integrator, most_solves: u64) -> Method {
    Method { name, integrator, chosen: false, most_solves }
}

const fn chosen(name: &'static str, integrator: Integrator, most_solves: u64) -> Method {
    Method { name, integrator, chosen: true, most_solves }
}

/// No more rejections of one step than these (`Adaptive`).
pub const REJECTIONS: u32 = 24;
/// Attempts of a step that is chosen: the rejected ones and the last.
const ATTEMPTS: u64 = REJECTIONS as u64 + 1;

/// All of them. Solves: one a stage; 200 iterations of `newton`, 50 of `energy-momentum`; `auto` also tries out ros2 and ros3
/// four times each, and goes over to the next where one fails.
pub const METHODS: [Method; 12] = [
    equal("euler", Integrator::Euler, 1),
    equal("midpoint", Integrator::Midpoint, 1),
    equal("ros2", Integrator::Ros2, 2),
    equal("ros3", Integrator::Ros3, 4),
    equal("newton", Integrator::Newton, 200),
    equal("energy-momentum", Integrator::EnergyMomentum, 50),
    equal("verlet", Integrator::Verlet, 0),
    equal("symplectic-euler", Integrator::SymplecticEuler, 0),
    chosen("ros2-accuracy", Integrator::Ros2, 2 * ATTEMPTS),
    chosen("ros3-accuracy", Integrator::Ros3, 4 * ATTEMPTS),
    chosen("verlet-accuracy", Integrator::Verlet, 0),
    chosen("auto-accuracy", Integrator::Auto, 6 * (ATTEMPTS + 4)),
];

impl Method {
    /// Those of these names; all if there is none.
    pub fn of(names: &[String]) -> Result<Vec<Self>, InputError> {
        let all = METHODS.map(|method| method.name);
        let mut wanted = vec![names.is_empty(); all.len()];
        for name in names {
            wanted[known("--integrator", name, &all)?] = true;
        }
        Ok(METHODS.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(method, _)| method).collect())
    }

    /// Does it solve linear systems?
    pub fn solves(self) -> bool {
        self.most_solves > 0
    }

    /// Is this an error that it may end with, in a scene with or without moving pins? Leaving the range of numbers may happen
    /// to all; the others are a method's own.
    pub fn may_end_with(self, error: StepError, moving: bool) -> bool {
        match error {
            StepError::NotFinite(_) => true,
            StepError::NotConverged(_) => {
                matches!(self.integrator, Integrator::Newton | Integrator::EnergyMomentum)
            }
            StepError::Accuracy => self.chosen,
            StepError::Motion(_) => moving,
            _ => false,
        }
    }
}
