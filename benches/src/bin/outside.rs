//! `hooke work-precision` with two codes from outside in its table and diagram: `outside [SCENE] [OPTIONS]`, options as there.

use std::process::ExitCode;

fn main() -> ExitCode {
    hooke_benches::outside()
}
