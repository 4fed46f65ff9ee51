//! Hooke beside what a user would otherwise pick: see `compare --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    hooke_benches::compare()
}
