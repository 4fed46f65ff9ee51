//! The `hooke` command.

use std::io::Write;
use std::process::ExitCode;

use hooke_harness::cli::{self, Command};
use hooke_harness::error::InputError;
use hooke_harness::mesh;
use hooke_harness::run::{self, RunError, rest};
use hooke_harness::stress;
use hooke_harness::work_precision;

fn main() -> ExitCode {
    let arguments: Result<Vec<String>, _> = std::env::args_os().map(|a| a.into_string()).collect();
    let arguments = match arguments {
        Ok(arguments) => arguments,
        Err(argument) => {
            let message = format!("the argument '{}' is not UTF-8 text", argument.display());
            return refused(&InputError::new(message));
        }
    };
    let command = match cli::parse(arguments) {
        Ok(command) => command,
        Err(Ok(text)) => return said(&text),
        Err(Err(error)) => return refused(&error),
    };
    match command {
        Command::Run(args) => ended(run::run(&args)),
        Command::Rest(args) => ended(rest::rest(&args)),
        Command::Stress(args) => ended(stress::run(&args)),
        Command::WorkPrecision(args) => ended(work_precision::run(&args)),
        Command::Info(args) => match mesh::info(&args.mesh) {
            Ok(info) if args.json => match serde_json::to_string_pretty(&info) {
                Ok(json) => said(&format!("{json}\n")),
                Err(error) => refused(&InputError::new(error.to_string())),
            },
            Ok(info) => said(&info.to_string()),
            Err(error) => refused(&error),
        },
    }
}

/// What a command that simulates came to.
fn ended(result: Result<String, RunError>) -> ExitCode {
    match result {
        Ok(summary) => said(&summary),
        Err(RunError::Input(error)) => refused(&error),
        Err(RunError::Failed(message)) => complained(&message, 1),
    }
}

/// Success. A reader that has seen enough and closed the pipe is no failure (`print!` would panic).
fn said(text: &str) -> ExitCode {
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

/// Bad input: one line, exit code 2, nothing written.
fn refused(error: &InputError) -> ExitCode {
    complained(&error.to_string(), 2)
}

/// One line on stderr; that nobody can read it is no reason for a panic (`eprintln!` would).
fn complained(message: &str, code: u8) -> ExitCode {
    let _ = writeln!(std::io::stderr(), "hooke: {message}");
    ExitCode::from(code)
}
