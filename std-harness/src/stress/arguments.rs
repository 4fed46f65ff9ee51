//! The options of `hooke stress`, as they are typed. What they mean is decided in [`super::suite`].

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Options of `hooke stress`.
#[derive(Debug, Clone, Default, Args)]
pub struct Arguments {
    /// Cases, by name or by the beginning of names (dt- is all that begin so) [default: all; --list tells them]
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// Methods, as --list tells them: those of run, and ros2, ros3, verlet and auto with -accuracy, which choose their steps
    /// [default: all]
    #[arg(long = "integrator", value_name = "A,B,…", value_delimiter = ',', help_heading = "What is tried")]
    pub integrators: Vec<String>,
    /// Linear solvers, as for run, or all; methods that solve nothing run once
    #[arg(
        long = "solver",
        value_name = "A,B,…",
        value_delimiter = ',',
        default_value = "jacobi,auto",
        help_heading = "What is tried"
    )]
    pub solvers: Vec<String>,
    /// Precision
    #[arg(long, value_enum, value_name = "P", default_value_t = Precisions::Both, help_heading = "What is tried")]
    pub precision: Precisions,
    /// Three steps, and the large scenes smaller: what the tests do
    #[arg(long, help_heading = "What is tried")]
    pub quick: bool,
    /// Say which cases and methods there are, and try nothing
    #[arg(long)]
    pub list: bool,

    /// The tables as Markdown: a file that has the marks of an earlier table is changed between them alone
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub out: Option<PathBuf>,
    /// Every trial, as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// No progress and no table
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,
}

/// In which precisions a case is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Precisions {
    /// Double.
    F64,
    /// Single.
    F32,
    /// Both.
    #[default]
    Both,
}
