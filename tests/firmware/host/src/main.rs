//! The firmware's jobs on the host, and the judge of every target's trace.
//!
//! - `run`: runs all jobs and prints their trace;
//! - `compare TARGET GOLDEN [JOB PRECISION]`: reads a target's trace from the standard input; fails with the first
//!   target, job and step that differs from the golden file (with a job: only that one is expected);
//! - `log GOLDEN`: fails unless the last change that the golden file's log names is the one it holds;
//! - `bless GOLDEN WHY`: takes the host's trace as golden, and logs why.

mod compare;
mod golden;
mod memory;

use std::io::Read;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let answer = match arguments.as_slice() {
        ["run"] => run().map(|trace| print!("{trace}")),
        ["compare", target, golden] => compare(target, golden, None),
        ["compare", target, golden, job, precision] => compare(target, golden, Some((job, precision))),
        ["log", golden] => read(golden).and_then(|text| golden::check_log(&text)),
        ["bless", golden, why] => bless(golden, why),
        _ => Err("usage: run | compare TARGET GOLDEN [JOB PRECISION] | log GOLDEN | bless GOLDEN WHY".into()),
    };
    match answer {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("firmware: {why}");
            ExitCode::FAILURE
        }
    }
}

/// The trace of all jobs on this machine.
fn run() -> Result<String, String> {
    let mut out = String::new();
    for job in firmware_jobs::ALL {
        job.run(&mut out).map_err(|why| format!("{} {}: {why:?}", job.name, job.precision))?;
    }
    Ok(out)
}

fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|why| format!("{path}: {why}"))
}

fn compare(target: &str, golden: &str, only: Option<(&str, &str)>) -> Result<(), String> {
    let mut trace = String::new();
    std::io::stdin().read_to_string(&mut trace).map_err(|why| format!("{target}: {why}"))?;
    let seen = compare::compare(golden::values(&read(golden)?), &trace, only);
    seen.map_err(|why| format!("{target}: {why}")).map(|jobs| println!("{jobs}"))
}

fn bless(golden: &str, why: &str) -> Result<(), String> {
    let text = golden::blessed(&std::fs::read_to_string(golden).unwrap_or_default(), &run()?, why)?;
    std::fs::write(golden, text).map_err(|why| format!("{golden}: {why}"))
}
