//! The command line: options to plain values. What they mean is decided in [`crate::run::plan`].

use std::path::PathBuf;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};

use crate::error::InputError;
use crate::nearest;
use crate::run::rest::RestArgs;
use crate::scene::PinRule;
use crate::work_precision::arguments::Arguments;

/// Simulate mass-spring systems, with an error bound on every linear solve.
///
/// `hooke` alone is `hooke run`: the curtain, with frames for ParaView, an energy plot and a picture in out/.
#[derive(Debug, Parser)]
#[command(name = "hooke", version, max_term_width = 110, after_help = scenes())]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// What `hooke` can do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a scene: a name, a mesh file or a scene .toml (default: curtain)
    #[command(after_help = scenes())]
    Run(Box<RunArgs>),
    /// Find where a scene comes to rest under its forces
    Rest(Box<RestArgs>),
    /// Compare methods on a scene: error against time, with a reference that certifies itself
    #[command(after_help = scenes())]
    WorkPrecision(Box<Arguments>),
    /// Try every method on scenes that are hard on it, and judge what must hold of all of them
    Stress(Box<crate::stress::arguments::Arguments>),
    /// Say what is in a mesh file
    Info(InfoArgs),
}

/// Options of `hooke info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A mesh: .obj .mesh .msh .ply .vtk .vtu .vtp .stl
    pub mesh: PathBuf,
    /// As JSON instead of text
    #[arg(long)]
    pub json: bool,
}

/// Options of `hooke run`.
#[derive(Debug, Clone, Default, Args)]
pub struct RunArgs {
    /// A scene's name, a mesh file or a scene .toml; a name wins over a file of that name, ./name is the file
    pub scene: Option<String>,

    /// Time step, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = "Time")]
    pub dt: Option<f64>,
    /// Number of steps
    #[arg(long, value_name = "N", conflicts_with = "seconds", help_heading = "Time")]
    pub steps: Option<u64>,
    /// Duration, s
    #[arg(long, value_name = "T", allow_negative_numbers = true, help_heading = "Time")]
    pub seconds: Option<f64>,

    /// Choose the steps: each may be wrong by so many joules, kinetic and elastic; --dt is then the first to be tried. For
    /// ros2, ros3, verlet and auto; needs --seconds
    #[arg(long, value_name = "J", allow_negative_numbers = true, help_heading = "Time")]
    pub accuracy: Option<f64>,
    /// Let a step of verlet beyond its limit be made of up to so many substeps [default: 1]
    #[arg(long, value_name = "N", help_heading = "Time")]
    pub substeps: Option<u32>,

    /// Time integration: euler (the lecture's, linearly implicit: robust, damps), midpoint (order 2, no damping, small steps
    /// only), ros2 or ros3 (Rosenbrock methods of order 2 and 3, with an estimate of their error), newton (backward Euler to
    /// the end: any step), energy-momentum (keeps both), verlet or symplectic-euler (explicit, refused beyond their limit), auto (the one of least work; with --accuracy they compete while it runs)
    #[arg(long, value_name = "NAME", default_value = "euler", help_heading = "Method")]
    pub integrator: String,
    /// Linear solver: jacobi (block-Jacobi PCG), ssor or ilu (fewer iterations, one row after another: meshes), wide (the same in vector registers: cloths, nets, lattices, meshes), wide32 (that with its iterations in f32, checked in f64: faster where multigrid is not needed), multigrid (PCG whose iterations hardly grow with the net), banded (LDLᵀ in the order of the particles: chains, ropes, thin nets), ldl
    /// (sparse LDLᵀ), ldl32 (the same with its factor in f32, half the memory, and PCG around it) or auto (the one of least work for this scene, step and tolerance; says which and why)
    #[arg(long, value_name = "NAME", default_value = "jacobi", help_heading = "Method")]
    pub solver: String,
    /// Relative tolerance of a solve: stop at β ≤ R²β₀ [default: 1e-6 in f64, 1e-4 in f32]
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Method")]
    pub tolerance: Option<f64>,
    /// Absolute tolerance of a solve: stop at β ≤ J joules [default: 0, or the J of --sleep]
    #[arg(long, value_name = "J", allow_negative_numbers = true, help_heading = "Method")]
    pub absolute: Option<f64>,
    /// At most so many iterations per island and step [default: 10000]
    #[arg(long, value_name = "N", help_heading = "Method")]
    pub max_iterations: Option<u32>,
    /// Another numbering of the particles inside the run: rcm puts those that springs join close together (reverse
    /// Cuthill–McKee), for meshes numbered at random; every output keeps your ids, last digits may differ
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Renumber::None, help_heading = "Method")]
    pub renumber: Renumber,
    /// Let islands sleep: one that has at most J joules of kinetic energy, and would gain no more than --absolute from rest,
    /// is stopped (this changes the trajectory) and skipped until something changes [default: off]
    #[arg(long, value_name = "J", allow_negative_numbers = true, help_heading = "Method")]
    pub sleep: Option<f64>,
    /// Precision of the simulation
    #[arg(long, value_enum, default_value_t = Precision::F64, help_heading = "Method")]
    pub precision: Precision,

    /// What of the scene is to be otherwise.
    #[command(flatten)]
    pub overrides: Overrides,

    /// Folder for ParaView frames, energy plot and picture [default: out, unless --final or --json is given]
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: Option<PathBuf>,
    /// Frames a second [default: 60]
    #[arg(long, value_name = "F", allow_negative_numbers = true, help_heading = "Output")]
    pub fps: Option<f64>,
    /// Final positions and velocities as CSV
    #[arg(long = "final", value_name = "FILE", help_heading = "Output")]
    pub final_csv: Option<PathBuf>,
    /// What the run did, as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// No progress and no summary
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,
}

/// What of a scene is to be otherwise.
#[derive(Debug, Clone, Default, Args)]
pub struct Overrides {
    /// Stiffness of every spring, N/m
    #[arg(long, value_name = "K", allow_negative_numbers = true, help_heading = "Overrides of the scene")]
    pub stiffness: Option<f64>,
    /// Mass of every particle, kg
    #[arg(long, value_name = "M", allow_negative_numbers = true, help_heading = "Overrides of the scene")]
    pub mass: Option<f64>,
    /// Gravity, m/s²
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Overrides of the scene")]
    pub gravity: Option<[f64; 3]>,
    /// Initial velocity of the free particles, m/s
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Overrides of the scene")]
    pub velocity: Option<[f64; 3]>,
    /// Pins instead of the scene's: none, min-y:D (within D m of the lowest y) or vertices:0,31
    #[arg(long, value_name = "RULE", value_parser = pin_rule, help_heading = "Overrides of the scene")]
    pub pin: Option<PinRule>,
    /// Begin with the positions and velocities of this file, which --final of a run, or hooke rest, has written
    #[arg(long, value_name = "FILE", help_heading = "Overrides of the scene")]
    pub from: Option<PathBuf>,
}

/// Precision of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Precision {
    /// Double.
    #[default]
    F64,
    /// Single.
    F32,
}

/// How the particles are numbered inside a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Renumber {
    /// As the scene has them.
    #[default]
    None,
    /// Reverse Cuthill–McKee.
    Rcm,
}

/// Three numbers, `X,Y,Z`.
pub(crate) fn triple(text: &str) -> Result<[f64; 3], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [x, y, z] = parts.as_slice() else { return Err("expected three numbers, as in 0,-9.81,0".into()) };
    let number = |part: &str| match part.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("'{part}' is not a finite number")),
    };
    Ok([number(x)?, number(y)?, number(z)?])
}

pub(crate) fn pin_rule(text: &str) -> Result<PinRule, String> {
    text.parse().map_err(|error: InputError| error.message)
}

/// The catalogue, for the end of `--help`.
fn scenes() -> String {
    let mut text = String::from("Scenes:\n");
    for (_, form, what) in crate::scene::catalog::NAMES {
        text.push_str(&format!("  {form:<16} {what}\n"));
    }
    text.push_str("  FILE             a mesh (.obj .mesh .msh .ply .vtk .vtu .vtp .stl) or a scene (.toml)");
    text
}

/// Parses arguments (the program's name first). `Err(Ok(text))` is help or version to print, `Err(Err(e))` bad input.
pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Command, Result<String, InputError>> {
    let mut arguments: Vec<String> = arguments.into_iter().collect();
    // Options without a command belong to `run`.
    let is_option = |first: &String| {
        first.starts_with('-') && !matches!(first.as_str(), "-h" | "--help" | "-V" | "--version")
    };
    if arguments.get(1).is_some_and(is_option) {
        arguments.insert(1, "run".into());
    }
    match Cli::try_parse_from(&arguments) {
        Ok(Cli { command: Some(command) }) => Ok(command),
        Ok(Cli { command: None }) => match Cli::try_parse_from(["hooke", "run"]) {
            Ok(Cli { command: Some(command) }) => Ok(command),
            _ => Err(Err(InputError::new("nothing to do; try hooke --help"))),
        },
        Err(error) if error.kind() == ErrorKind::DisplayHelp && arguments.len() == 2 => {
            Err(Ok(format!("{}\n\nOptions of run:\n{}", error.render(), run_options())))
        }
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            Err(Ok(error.render().to_string()))
        }
        Err(error) => Err(Err(one_line(&error))),
    }
}

/// The options of `run`, as its own help shows them.
fn run_options() -> String {
    let mut cli = Cli::command();
    let help = cli.find_subcommand_mut("run").map(|run| run.render_help().to_string()).unwrap_or_default();
    let options = help.find("Time:").map_or("", |from| &help[from..]);
    let end = options.find("Scenes:").unwrap_or(options.len());
    options[..end].trim_end().to_string() + "\n"
}

/// The names of all commands.
fn commands() -> Vec<String> {
    Cli::command().get_subcommands().map(|command| command.get_name().to_string()).collect()
}

/// The names of all options, with their dashes. (Clap's own suggestions miss swapped letters in short names.)
fn options() -> Vec<String> {
    let cli = Cli::command();
    let all = cli.get_subcommands().flat_map(|command| command.get_arguments());
    all.filter_map(|argument| argument.get_long()).map(|long| format!("--{long}")).collect()
}

/// Clap's message, cut down to one line with the nearest known name.
fn one_line(error: &clap::Error) -> InputError {
    let get = |kind| match error.get(kind) {
        Some(ContextValue::String(s)) => Some(s.clone()),
        Some(ContextValue::Strings(list)) => Some(list.join(", ")),
        _ => None,
    };
    let message = match error.kind() {
        ErrorKind::UnknownArgument => {
            let argument = get(ContextKind::InvalidArg).unwrap_or_default();
            if argument.starts_with('-') {
                format!("unknown option '{argument}'{}", nearest::suggestion(&argument, &options()))
            } else {
                format!("unexpected argument '{argument}'")
            }
        }
        ErrorKind::InvalidSubcommand => {
            let command = get(ContextKind::InvalidSubcommand).unwrap_or_default();
            let is_scene = crate::scene::catalog::named(&command).is_some() || command.contains('.');
            let hint = if is_scene {
                format!("; did you mean 'hooke run {command}'?")
            } else {
                nearest::suggestion(&command, &commands())
            };
            format!("unknown command '{command}'{hint}")
        }
        ErrorKind::InvalidValue if get(ContextKind::ValidValue).is_some() => {
            let value = get(ContextKind::InvalidValue).unwrap_or_default();
            let valid = get(ContextKind::ValidValue).unwrap_or_default();
            let option = get(ContextKind::InvalidArg).unwrap_or_default();
            let known: Vec<&str> = valid.split(", ").collect();
            format!("{option}: '{value}' is none of {valid}{}", nearest::suggestion(&value, &known))
        }
        _ => {
            let text = error.to_string();
            let first = text.split("\n\n").next().unwrap_or_default();
            first.trim_start_matches("error: ").to_string()
        }
    };
    InputError::new(format!("{message} (try hooke --help)"))
}
