//! The command line of `compare`, and the scene that each of its names stands for.

use std::path::PathBuf;

use clap::Parser;
use clap::error::ErrorKind;
use hooke_harness::cli::{self, Command};
use hooke_harness::error::InputError;
use hooke_harness::run::plan::Plan;

use crate::scenario::WINDOW;

/// Time Hooke's steps beside sparse direct solvers and Eigen's conjugate gradients, on the same states and the same
/// matrix, with one thread; judge every answer by the kernel's certified bound and by its distance from the exact one.
#[derive(Debug, Parser)]
#[command(name = "compare", max_term_width = 110, after_help = NOTES)]
pub(crate) struct Args {
    /// Scenes as `hooke run` takes them: names or mesh files [default: cloth:32 cloth:64 chain:1000]
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<String>,
    /// All lines as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Time steps, s, with commas between them [default: the scene's own; with --growth 1/60]
    #[arg(long, value_name = "S", value_delimiter = ',', allow_negative_numbers = true)]
    pub(crate) dt: Vec<f64>,
    /// Relative tolerances of the iterative solvers [default: 1e-3 1e-6 1e-10; with --growth 1e-3]
    #[arg(long, value_name = "R", num_args = 1.., value_delimiter = ',', allow_negative_numbers = true)]
    pub(crate) tolerance: Vec<f64>,
    /// Hooke's methods, as `hooke run --solver` names them [default: all; with --growth jacobi,multigrid]
    #[arg(long, value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    pub(crate) method: Vec<String>,
    /// States of the trajectory to solve at, t = 0.25 to 0.5 s [default: 6; with --growth 3]
    #[arg(long, value_name = "N")]
    pub(crate) states: Option<usize>,
    /// States between these times instead, s
    #[arg(long, value_name = "FROM,TO", num_args = 1, value_delimiter = ',', conflicts_with_all = ["growth", "choose"])]
    between: Vec<f64>,
    /// cloth:32 to 256, chain:1000 and lattice:16x16x16 at dt 1/60 and 1/1000, the SCENEs and their FLAGS beside them
    #[arg(long, conflicts_with = "growth")]
    pub(crate) all: bool,
    /// How time and memory of Hooke's methods grow: cloth:32 to 512, lattices up to 10⁶ springs (or the SCENEs given)
    #[arg(long)]
    pub(crate) growth: bool,
    /// What `hooke run --solver auto` should choose: every solver on a grid of scenes, steps and tolerances, who wins, and
    /// the weights that fit (or on the SCENEs, the --dt, the --tolerance given)
    #[arg(long, conflicts_with_all = ["growth", "all"])]
    pub(crate) choose: bool,
    /// The plot of --growth [default: out/growth.svg]
    #[arg(long, value_name = "FILE", requires = "growth")]
    pub(crate) svg: Option<PathBuf>,
    /// Overrides of the scenes, as `hooke run` takes them: --stiffness --mass --gravity --velocity --pin --dt --renumber
    #[arg(last = true, value_name = "FLAGS", allow_hyphen_values = true)]
    pub(crate) flags: Vec<String>,
}

const NOTES: &str = "\
Columns: ms: median over the states (of medians over repeats), and the worst state; the thread's own time. A peer pays for the kernel's assembly \
of the step, filling its matrix, numeric factorisation and solve; Hooke for its whole step. bound J: the kernel's certified \
bound on the energy of the answer's error; error: ‖Δq̇ − exact‖/‖exact‖; MB: everything the method holds. Whoever takes \
over 5 s for a first solve is not asked for a second: 'once'.
ratio: fastest peer that is about as exact / own time, above 1 is faster. A direct peer always counts; Eigen CG, at the \
same R, if its median error is at most 3 times the line's own: solvers are compared at equal error, not at equal residual.

Peers in C++ are compiled on first use (c++, or $CXX) where Debian's libeigen3-dev and libsuitesparse-dev are installed; \
install libopenblas0-serial too, or CHOLMOD works with the slow reference BLAS.

  compare cloth:64 --dt 0.001
  compare --all bunny.mesh -- --stiffness 1e5 --mass 1 --gravity 0,-9.8,0 --pin min-y:3 --dt 0.005 --velocity 50,0,0";

/// What `--all` measures, ...
const ALL: [&str; 6] = ["cloth:32", "cloth:64", "cloth:128", "cloth:256", "chain:1000", "lattice:16x16x16"];
/// ... at these time steps, s.
const STEPS: [f64; 2] = [1.0 / 60.0, 1.0 / 1000.0];

/// The options of `hooke run` that change a scene.
const OVERRIDES: [&str; 7] =
    ["--stiffness", "--mass", "--gravity", "--velocity", "--pin", "--dt", "--renumber"];

impl Args {
    /// Parses a command line, the program's name first. `Err(Ok(text))` is help to print, `Err(Err(e))` bad input.
    pub(crate) fn parse_from(
        arguments: impl IntoIterator<Item = String>,
    ) -> Result<Self, Result<String, InputError>> {
        let args = Self::try_parse_from(arguments).map_err(|error| match error.kind() {
            ErrorKind::DisplayHelp => Ok(error.render().to_string()),
            _ => {
                let text = error.to_string();
                let first = text.split("\n\n").next().unwrap_or_default().trim_start_matches("error: ");
                Err(InputError::new(format!("{first} (try compare --help)")))
            }
        })?;
        args.check().map_err(Err)?;
        Ok(args)
    }

    fn check(&self) -> Result<(), InputError> {
        if let Some(r) = self.tolerance.iter().find(|r| !(**r > 0.0 && **r < 1.0)) {
            return Err(InputError::new(format!("--tolerance {r:?}: not between 0 and 1")));
        }
        match self.between.as_slice() {
            [] => {}
            [from, to] if 0.0 <= *from && from <= to && to.is_finite() => {}
            _ => return Err(InputError::new("--between is FROM,TO, seconds from 0 on, FROM before TO")),
        }
        let names = self.flags.iter().filter(|flag| flag.starts_with("--"));
        let names = names.map(|flag| flag.split('=').next().unwrap_or(flag));
        for name in names {
            if !OVERRIDES.contains(&name) {
                let near = hooke_harness::nearest::suggestion(name, &OVERRIDES);
                let known = OVERRIDES.join(" ");
                return Err(InputError::new(format!("after --: '{name}' is none of {known}{near}")));
            }
        }
        Ok(())
    }

    /// The times that states are taken between.
    pub(crate) fn between(&self) -> [f64; 2] {
        self.between.as_slice().try_into().unwrap_or(WINDOW)
    }

    /// All that is to be measured: the SCENEs or else the `usual` ones, at each `--dt`; with `--all` those of the list first,
    /// to which the FLAGS do not apply. Whatever is wrong with any of them is said before the first is measured.
    pub(crate) fn plans(&self, usual: &[&str]) -> Result<Vec<Plan>, InputError> {
        let mut plans = Vec::new();
        let listed: &[&str] = if self.all { &ALL } else { &[] };
        for scene in listed {
            let steps: &[f64] = if self.dt.is_empty() { &STEPS } else { &self.dt };
            for dt in steps {
                plans.push(plan(scene, &[], Some(*dt))?);
            }
        }
        let usual: &[&str] = if self.all || !self.scenes.is_empty() { &[] } else { usual };
        for scene in self.scenes.iter().map(String::as_str).chain(usual.iter().copied()) {
            if self.dt.is_empty() {
                plans.push(plan(scene, &self.flags, None)?);
            }
            for dt in &self.dt {
                plans.push(plan(scene, &self.flags, Some(*dt))?);
            }
        }
        Ok(plans)
    }
}

/// The scene of that name as `hooke run` would take it, overrides applied.
pub(crate) fn plan(scene: &str, flags: &[String], dt: Option<f64>) -> Result<Plan, InputError> {
    let mut arguments: Vec<String> = ["hooke", "run", scene].map(String::from).into();
    arguments.extend(flags.iter().cloned());
    if let Some(dt) = dt {
        arguments.push(format!("--dt={dt:?}"));
    }
    let hint = |error: InputError| InputError {
        message: error.message.replace("hooke --help", "compare --help"),
        ..error
    };
    let args = match cli::parse(arguments) {
        Ok(Command::Run(args)) => args,
        Err(Err(error)) => return Err(hint(error)),
        _ => return Err(InputError::new(format!("'{scene}' is no scene (try compare --help)"))),
    };
    let plan = Plan::new(&args).map_err(hint)?;
    if plan.model.moving.is_empty() {
        Ok(plan)
    } else {
        Err(InputError::new(format!("{scene}: pins that move are not compared")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Args, String> {
        let arguments = ["compare"].into_iter().chain(line.split(' ').filter(|word| !word.is_empty()));
        Args::parse_from(arguments.map(String::from)).map_err(|error| match error {
            Ok(help) => help,
            Err(error) => error.to_string(),
        })
    }

    #[test]
    fn flags_of_a_mesh_reach_the_scene() {
        let args = parse("cloth:4 --dt 0.01 -- --mass 2 --stiffness 7 --pin none --velocity 50,0,0").unwrap();
        let plan = &args.plans(&[]).unwrap()[0];
        assert_eq!((plan.dt, plan.model.mass[3], plan.model.springs[2].stiffness), (0.01, 2.0, 7.0));
        assert!(!plan.model.pinned[0] && plan.model.velocity[0] == [50.0, 0.0, 0.0]);
    }

    #[test]
    fn tolerances_are_listed_with_spaces_or_commas() {
        assert_eq!(parse("cloth:4 --tolerance 1e-3 1e-6").unwrap().tolerance, [1e-3, 1e-6]);
        assert_eq!(parse("--tolerance 1e-3,1e-6 --states 9").unwrap().tolerance, [1e-3, 1e-6]);
    }

    #[test]
    fn a_list_of_time_steps_and_the_scenes_of_all_are_measured_one_by_one() {
        let plans = |line: &str| {
            let plans = parse(line).unwrap().plans(&["cloth:3"]).unwrap();
            plans.into_iter().map(|plan| (plan.model.name, plan.dt)).collect::<Vec<_>>()
        };
        assert_eq!(plans("--dt 0.01,0.001"), [("cloth:3".into(), 0.01), ("cloth:3".into(), 0.001)]);
        assert_eq!(plans("cloth:4 --dt 0.01"), [("cloth:4".into(), 0.01)]);
        let all = plans("--all pair -- --dt 0.02");
        assert_eq!((all.len(), &all[12]), (13, &("pair".into(), 0.02)));
        assert_eq!(all[1], ("cloth:32".into(), 0.001), "flags are for one's own scenes");
    }

    #[test]
    fn bad_input_is_one_line_that_names_it() {
        for (line, named) in [
            ("--foo", "'--foo'"),
            ("--tolerance 0", "--tolerance 0.0"),
            ("--tolerance NaN", "NaN"),
            ("--states x", "'x'"),
            ("--between 0.3", "FROM,TO"),
            ("--between 0.3,0.2", "FROM,TO"),
            ("--between NaN,1", "FROM,TO"),
            ("cloth:4 -- --steps 3", "'--steps'"),
            ("cloth:4 -- --stifness 3", "did you mean '--stiffness'?"),
        ] {
            let error = parse(line).map(|_| ()).unwrap_err();
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
        for (scene, named) in
            [("cloht:4", "did you mean 'cloth:4'?"), ("no.mesh", "no.mesh"), ("cloth:x", "'x'")]
        {
            let error = parse("-- --dt 0.01").unwrap().plans(&[scene]).unwrap_err().to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{scene}: {error}");
        }
        assert!(parse("-- --mass -1").unwrap().plans(&["cloth:4"]).unwrap_err().message.contains("--mass"));
    }
}
