//! The options of `hooke work-precision`, as they are typed. What they mean is decided in [`super::study`].

use std::path::PathBuf;

use clap::Args;

use crate::cli::Overrides;

/// Options of `hooke work-precision`.
#[derive(Debug, Clone, Default, Args)]
pub struct Arguments {
    /// A scene's name, a mesh file or a scene .toml, as for run [default: curtain]
    pub scene: Option<String>,

    /// Methods to compare, as --integrator of run calls them; auto only with --accuracy [default: all]
    #[arg(long = "method", value_name = "A,B,…", value_delimiter = ',', help_heading = "What is compared")]
    pub methods: Vec<String>,
    /// Steps to try, s, each made a little shorter so that --seconds is a whole number of them [default: the scene's own, for
    /// explicit methods 0.95 of their limit, and its half, quarter, … until the error is below --smallest, or some other run
    /// was 10 times faster with no larger error]
    #[arg(
        long,
        value_name = "S,S,…",
        value_delimiter = ',',
        allow_hyphen_values = true,
        help_heading = "What is compared"
    )]
    pub dt: Vec<f64>,
    /// Also choose the steps, so that each is wrong by so many joules: another curve for each of ros2, ros3, verlet and auto
    #[arg(
        long,
        value_name = "J,J,…",
        value_delimiter = ',',
        allow_hyphen_values = true,
        help_heading = "What is compared"
    )]
    pub accuracy: Vec<f64>,
    /// The moment at which positions are compared, s
    #[arg(
        long,
        value_name = "T",
        default_value_t = 0.25,
        allow_negative_numbers = true,
        help_heading = "What is compared"
    )]
    pub seconds: f64,
    /// Linear solver of the implicit methods, as for run; auto chooses anew for every step
    #[arg(long, value_name = "NAME", default_value = "auto", help_heading = "What is compared")]
    pub solver: String,
    /// Relative tolerance of a solve: so small that what a diagram shows is the step's error, not the solve's
    #[arg(
        long,
        value_name = "R",
        default_value = "1e-8",
        allow_negative_numbers = true,
        help_heading = "What is compared"
    )]
    pub tolerance: f64,

    /// Time each run so often and keep the least; one of more than a second is timed once
    #[arg(long, value_name = "N", default_value_t = 3, help_heading = "Effort")]
    pub repeats: u32,
    /// Also count the instructions of each run's steps, under valgrind, some fifty times slower: the same on a busy machine
    #[arg(long, help_heading = "Effort")]
    pub instructions: bool,
    /// Makes one run and nothing else: what --instructions calls under valgrind
    #[arg(long, hide = true)]
    pub count_run: Option<String>,
    /// The smallest error of interest, m; the reference is to be 100 times as certain [default: the power of ten at or below a millionth of the scene's size]
    #[arg(long, value_name = "E", allow_negative_numbers = true, help_heading = "Effort")]
    pub smallest: Option<f64>,
    /// At most so much time for the reference, s; where it is not certain, the diagram is cut
    #[arg(
        long,
        value_name = "S",
        default_value_t = 20.0,
        allow_negative_numbers = true,
        help_heading = "Effort"
    )]
    pub effort: f64,

    /// What of the scene is to be otherwise.
    #[command(flatten)]
    pub overrides: Overrides,

    /// Folder for work-precision.csv and work-precision.svg
    #[arg(long, value_name = "DIR", default_value = "out", help_heading = "Output")]
    pub out: PathBuf,
    /// All of it as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// No progress, no table and no verdict
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,
}
