//! `--instructions`: how many instructions a run's steps take, counted by valgrind.
//!
//! Instructions are not time, but they are the same whoever else is at work on the machine. The program calls itself under
//! callgrind, with the same options and the one run that is to be made; what is counted is [`super::measure::walk`], the steps
//! alone. Valgrind knows no registers wider than 256 bits, so lanes are counted as a machine without AVX-512 makes them.

use std::process::Command;

use super::curve::{Curve, Setting, Steps};
use super::study::Study;
use crate::error::InputError;
use crate::run::integrator::{INTEGRATORS, Integrator};

/// A run that takes more is not counted, s: under valgrind it would take some fifty times as long.
pub const MOST: f64 = 2.0;

/// Is there something to count with?
pub fn ready() -> Result<(), InputError> {
    let found = Command::new("valgrind").arg("--version").output().is_ok_and(|out| out.status.success());
    match found {
        true => Ok(()),
        false => Err(InputError::new(
            "--instructions: needs valgrind, which is not installed; install it (apt-get install valgrind)",
        )),
    }
}

/// The run that `--count-run` names.
pub fn named(name: &str) -> Option<(Curve, Setting)> {
    let mut parts = name.split('/');
    let (method, steps, value) = (parts.next()?, parts.next()?, parts.next()?);
    let method: Integrator = INTEGRATORS.iter().find(|(name, _)| *name == method)?.1;
    let (steps, setting) = match steps {
        "fixed" => (Steps::Fixed, Setting::Steps(value.parse().ok()?)),
        "cut" => (Steps::Cut, Setting::Steps(value.parse().ok()?)),
        "chosen" => (Steps::Chosen, Setting::Accuracy(value.parse().ok()?)),
        _ => return None,
    };
    Some((Curve { method, steps }, setting))
}

fn name(curve: Curve, setting: Setting) -> String {
    let steps = match curve.steps {
        Steps::Fixed => "fixed",
        Steps::Cut => "cut",
        Steps::Chosen => "chosen",
    };
    let value = match setting {
        Setting::Steps(steps) => steps.to_string(),
        Setting::Accuracy(joules) => joules.to_string(),
    };
    format!("{}/{steps}/{value}", curve.method.name())
}

/// Counts a run's steps; `Err` says why there is no count.
pub fn count(study: &Study, curve: Curve, setting: Setting) -> Result<u64, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let out = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*work_precision*measure*walk*")
        .arg(program)
        .args(&study.options)
        .arg(format!("--count-run={}", name(curve, setting)))
        .output()
        .map_err(|error| format!("valgrind: {error}"))?;
    let said = String::from_utf8_lossy(&out.stderr);
    let counted = said.lines().filter_map(|line| line.split_once("Collected :")).next_back();
    match counted.and_then(|(_, n)| n.trim().parse().ok()) {
        Some(n) if out.status.success() && n > 0 => Ok(n),
        Some(0) => Err("valgrind counted nothing: the program's symbols are stripped".into()),
        _ => Err(format!("valgrind: {}", said.lines().last().unwrap_or("no answer"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_found_by_its_name() {
        let curve = |method, steps| Curve { method, steps };
        for (curve, setting) in [
            (curve(Integrator::Ros2, Steps::Fixed), Setting::Steps(12)),
            (curve(Integrator::Verlet, Steps::Cut), Setting::Steps(1)),
            (curve(Integrator::Auto, Steps::Chosen), Setting::Accuracy(1.5e-7)),
        ] {
            assert_eq!(named(&name(curve, setting)), Some((curve, setting)));
        }
        assert_eq!(named("ros2/fixed"), None);
        assert_eq!(named("nobody/fixed/1"), None);
    }
}
