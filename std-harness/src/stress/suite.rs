//! What is tried, decided and checked before anything is.

use std::path::PathBuf;

use super::arguments::{Arguments, Precisions};
use super::case::{Case, Size};
use super::cases;
use super::method::Method;
use super::progress::Progress;
use super::trial::{Prepared, Trial};
use crate::cli::Precision;
use crate::error::InputError;
use crate::output::safe;
use crate::run::plan::{known, resolved};
use crate::run::solver::METHODS as SOLVERS;

/// The solvers that are tried unless others are named.
const DEFAULT: [&str; 2] = ["jacobi", "auto"];

/// The suite, decided.
pub struct Suite {
    /// The cases.
    pub cases: Vec<Case>,
    /// The methods.
    pub methods: Vec<Method>,
    /// The precisions.
    pub precisions: Vec<Precision>,
    /// The solvers, by name.
    pub solvers: Vec<String>,
    /// How large it is.
    pub size: Size,
    /// The tables as Markdown.
    pub out: Option<PathBuf>,
    /// All trials as JSON.
    pub json: Option<PathBuf>,
    /// No progress, nothing printed.
    pub quiet: bool,
}

impl Suite {
    /// Decides it from its options.
    pub fn new(args: &Arguments) -> Result<Self, InputError> {
        let precisions = match args.precision {
            Precisions::F64 => vec![Precision::F64],
            Precisions::F32 => vec![Precision::F32],
            Precisions::Both => vec![Precision::F64, Precision::F32],
        };
        let suite = Self {
            cases: named(&args.cases)?,
            methods: Method::of(&args.integrators)?,
            precisions,
            solvers: solvers(&args.solvers)?,
            size: if args.quick { Size::Quick } else { Size::Full },
            out: args.out.clone(),
            json: args.json.clone(),
            quiet: args.quiet,
        };
        if let (Some(out), Some(json)) = (&suite.out, &suite.json)
            && resolved(out) == resolved(json)
        {
            return Err(InputError::in_file(out, "cannot write here: --out and --json name the same file"));
        }
        suite.out.iter().chain(&suite.json).try_for_each(|file| safe::prepare_file(file))?;
        Ok(suite)
    }

    /// Makes all trials.
    pub fn trials(&self) -> Vec<Trial> {
        let progress = Progress::new(self);
        let mut trials = Vec::new();
        for case in &self.cases {
            let prepared = Prepared::new(*case, self.size);
            for method in self.methods.iter().filter(|method| goes(**method, &prepared)) {
                for precision in &self.precisions {
                    // Nothing to solve: once is enough.
                    let solvers = if method.solves() { &self.solvers[..] } else { &self.solvers[..1] };
                    for solver in solvers {
                        progress.says(&format!("{}, {}, {solver}", case.name, method.name));
                        trials.push(prepared.tried(*method, *precision, solver));
                    }
                }
            }
            progress.counts();
        }
        progress.ends();
        trials
    }

    /// The command that does the same.
    pub fn command(&self, args: &Arguments) -> String {
        let mut words = vec!["cargo run --release -- stress".to_string()];
        words.extend(args.cases.iter().cloned());
        if !args.integrators.is_empty() {
            words.push(format!("--integrator {}", args.integrators.join(",")));
        }
        if !args.solvers.is_empty() && args.solvers != DEFAULT {
            words.push(format!("--solver {}", args.solvers.join(",")));
        }
        match args.precision {
            Precisions::F64 => words.push("--precision f64".into()),
            Precisions::F32 => words.push("--precision f32".into()),
            Precisions::Both => {}
        }
        if args.quick {
            words.push("--quick".into());
        }
        if let Some(out) = &self.out {
            words.push(format!("--out {}", out.display()));
        }
        words.join(" ")
    }
}

/// A step by itself has no end that a motion could be given over: where steps are chosen pins rest.
fn goes(method: Method, prepared: &Prepared) -> bool {
    !method.chosen || prepared.model.moving.is_empty()
}

fn named(names: &[String]) -> Result<Vec<Case>, InputError> {
    let all = cases::all();
    let known_names: Vec<&str> = all.iter().map(|case| case.name).collect();
    let mut wanted = vec![names.is_empty(); all.len()];
    for name in names {
        match known_names.iter().position(|known| known == name) {
            Some(exact) => wanted[exact] = true,
            None if known_names.iter().any(|known| known.starts_with(name.as_str())) => {
                for (wanted, known) in wanted.iter_mut().zip(&known_names) {
                    *wanted |= known.starts_with(name.as_str());
                }
            }
            None => _ = known("case", name, &known_names)?,
        }
    }
    Ok(all.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(case, _)| case).collect())
}

fn solvers(names: &[String]) -> Result<Vec<String>, InputError> {
    let all: Vec<&str> = SOLVERS.iter().map(|(name, _)| *name).chain(["auto", "all"]).collect();
    let mut wanted = Vec::new();
    if names.is_empty() {
        return Ok(DEFAULT.map(Into::into).into());
    }
    for name in names {
        known("solver", name, &all)?;
        if name == "all" {
            return Ok(all.into_iter().filter(|name| *name != "all").map(Into::into).collect());
        }
        if !wanted.contains(name) {
            wanted.push(name.clone());
        }
    }
    Ok(wanted)
}
