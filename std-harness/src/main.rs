//! The `hooke` command.

use std::process::ExitCode;

use hooke_harness::cli::{self, Command};
use hooke_harness::error::InputError;
use hooke_harness::mesh;
use hooke_harness::run::{self, RunError};

fn main() -> ExitCode {
    let command = match cli::parse(std::env::args()) {
        Ok(command) => command,
        Err(Ok(text)) => {
            print!("{text}");
            return ExitCode::SUCCESS;
        }
        Err(Err(error)) => return refused(&error),
    };
    match command {
        Command::Run(args) => match run::run(&args) {
            Ok(summary) => {
                print!("{summary}");
                ExitCode::SUCCESS
            }
            Err(RunError::Input(error)) => refused(&error),
            Err(RunError::Failed(message)) => {
                eprintln!("hooke: {message}");
                ExitCode::from(1)
            }
        },
        Command::Info(args) => match mesh::info(&args.mesh) {
            Ok(info) if args.json => match serde_json::to_string_pretty(&info) {
                Ok(json) => {
                    println!("{json}");
                    ExitCode::SUCCESS
                }
                Err(error) => refused(&InputError::new(error.to_string())),
            },
            Ok(info) => {
                print!("{info}");
                ExitCode::SUCCESS
            }
            Err(error) => refused(&error),
        },
    }
}

/// Bad input: one line, exit code 2, nothing written.
fn refused(error: &InputError) -> ExitCode {
    eprintln!("hooke: {error}");
    ExitCode::from(2)
}
