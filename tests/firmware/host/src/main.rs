//! The firmware's jobs on the host, and the judge of every target's trace.
//!
//! - `run`: runs all jobs and prints their trace;
//! - `compare TARGET GOLDEN [JOB PRECISION]`: reads a target's trace from the standard input; fails with the first
//!   target, job and step that differs from the golden file (with a job: only that one is expected);
//! - `log GOLDEN`: fails unless the last change that the golden file's log names is the one it holds;
//! - `bless GOLDEN WHY`: takes the host's trace as golden, and logs why;
//! - `budgets check FILE SEEN RUSTC`, `budgets lower FILE SEEN`, `budgets raise FILE SEEN RUSTC WHY`: compares numbers
//!   seen with the budgets, and takes them as such;
//! - `ratios TABLE MEASURED`: instructions measured over the hand counts of a table;
//! - `stack ELF LISTING ROOT…`: prints the stack of each entry point whose name starts with a root; fails on recursion
//!   and indirect calls;
//! - `refused ELF LISTING ROOT`: fails unless each of these entry points is refused for the reason in its name.

mod arithmetic;
mod budgets;
mod compare;
mod golden;
mod memory;
mod stack;

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
        ["ratios", table, measured] => read(table)
            .and_then(|table| arithmetic::ratios(&table, &read(measured)?))
            .map(|lines| print!("{lines}")),
        ["budgets", "check", file, seen, compiler] => within(file, seen, compiler),
        ["budgets", "lower", file, seen] => {
            read(file).and_then(|old| budgets::lowered(&old, &read(seen)?)).and_then(|new| write(file, &new))
        }
        ["budgets", "raise", file, seen, compiler, why] => {
            let old = std::fs::read_to_string(file).unwrap_or_default();
            let new = read(seen).and_then(|seen| budgets::raised(&old, &seen, compiler, why));
            new.and_then(|new| write(file, &new))
        }
        ["stack", file, listing, roots @ ..] => bounds(file, listing, roots),
        ["refused", file, listing, root] => stack::refused(file, listing, root).map(|n| println!("{n}")),
        _ => Err("see the first lines of src/main.rs".into()),
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

fn write(path: &str, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|why| format!("{path}: {why}"))
}

/// Tells what has left its budget; fails where something is over it, under the budgets' own compiler.
fn within(file: &str, numbers: &str, compiler: &str) -> Result<(), String> {
    let verdict = budgets::check(&read(file)?, &read(numbers)?)?;
    for line in &verdict.over {
        println!("firmware: {line}");
    }
    if !verdict.under.is_empty() {
        println!(
            "firmware: {} budgets can be lowered: `check.sh lower`; the first: {}",
            verdict.under.len(),
            verdict.under[0]
        );
    }
    let own = budgets::compiler(&read(file)?)?;
    if verdict.over.is_empty() {
        return Ok(());
    }
    if own != compiler {
        println!("firmware: the budgets are those of rustc {own}; not enforced under {compiler}");
        return Ok(());
    }
    Err(format!(
        "{} numbers are over their budgets: `check.sh raise WHY` if that must be",
        verdict.over.len()
    ))
}

fn compare(target: &str, golden: &str, only: Option<(&str, &str)>) -> Result<(), String> {
    let mut trace = String::new();
    std::io::stdin().read_to_string(&mut trace).map_err(|why| format!("{target}: {why}"))?;
    let seen = compare::compare(golden::values(&read(golden)?), &trace, only);
    seen.map_err(|why| format!("{target}: {why}")).map(|jobs| println!("{jobs}"))
}

/// Prints the stack of each entry point.
fn bounds(file: &str, listing: &str, roots: &[&str]) -> Result<(), String> {
    for (name, bytes) in stack::bounds(file, listing, roots)? {
        println!("{name}\t{bytes}");
    }
    Ok(())
}

fn bless(golden: &str, why: &str) -> Result<(), String> {
    let text = golden::blessed(&std::fs::read_to_string(golden).unwrap_or_default(), &run()?, why)?;
    std::fs::write(golden, text).map_err(|why| format!("{golden}: {why}"))
}
