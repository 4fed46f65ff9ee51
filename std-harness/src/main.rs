//! The `hooke` command.

fn main() {}
