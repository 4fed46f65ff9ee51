//! The curves of a diagram and their points: a method, how its steps are made, how many or how exact.

use crate::error::InputError;
use crate::run::integrator::{INTEGRATORS, Integrator};
use crate::run::plan::known;

/// How the steps of a curve are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steps {
    /// Equal ones.
    Fixed,
    /// The scene's own, cut by Verlet into substeps of at most 0.9 of its limit, which share forces.
    Cut,
    /// Chosen by the method's estimate of its error.
    Chosen,
}

/// A curve of the diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curve {
    /// The method.
    pub method: Integrator,
    /// How its steps are made.
    pub steps: Steps,
}

impl Curve {
    /// What table and legend call it.
    pub fn name(self) -> String {
        let of = match self.steps {
            Steps::Fixed => "",
            Steps::Cut => ", substeps",
            Steps::Chosen => ", chosen steps",
        };
        format!("{}{of}", self.method.name())
    }
}

/// One run: a point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// So many equal steps.
    Steps(u64),
    /// Chosen steps, each wrong by so many joules.
    Accuracy(f64),
}

/// The curves of these methods, all if none is named.
pub fn curves(names: &[String], accuracies: &[f64]) -> Result<Vec<Curve>, InputError> {
    let all = INTEGRATORS.map(|(name, _)| name);
    let mut wanted = vec![names.is_empty(); all.len()];
    for name in names {
        wanted[known("--method", name, &all)?] = true;
    }
    let methods =
        INTEGRATORS.iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|((_, method), _)| *method);
    let methods: Vec<Integrator> = methods.collect();
    let curve = |steps| move |method| Curve { method, steps };
    let fixed = methods.iter().copied().filter(|method| *method != Integrator::Auto);
    let chosen = methods.iter().copied().filter(|method| method.is_embedded() && !accuracies.is_empty());
    let fixed: Vec<Curve> = fixed.map(curve(Steps::Fixed)).collect();
    let chosen: Vec<Curve> = chosen.map(curve(Steps::Chosen)).collect();
    let refuse = |message: &str| Err(InputError::new(message));
    if fixed.is_empty() && chosen.is_empty() {
        return refuse("--method auto: it chooses among methods by their errors; say which with --accuracy");
    }
    if chosen.is_empty() && !accuracies.is_empty() {
        let names = names.join(",");
        let able = "add one of ros2, ros3, verlet, auto";
        return refuse(&format!("--accuracy: --method {names} has no estimate of its error; {able}"));
    }
    let cut = fixed.iter().filter(|c| c.method == Integrator::Verlet).map(|c| curve(Steps::Cut)(c.method));
    let cut: Vec<Curve> = cut.collect();
    Ok([fixed, cut, chosen].concat())
}
