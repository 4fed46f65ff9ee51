//! Runs jobs and prints their traces.

use core::fmt::Write;

use firmware_jobs::Job;

use crate::console::{Console, exit};

/// Runs them all, then ends the program: with 0 if each did what it is there to show.
pub fn run(jobs: &[Job]) -> ! {
    let mut console = Console::new();
    let mut code = 0;
    for job in jobs {
        if let Err(why) = job.run(&mut console) {
            _ = writeln!(console, "\nfailed {} {}: {why:?}", job.name, job.precision);
            code = 1;
        }
    }
    exit(code)
}
