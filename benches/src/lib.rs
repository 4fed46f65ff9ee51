//! What Hooke costs, beside what a user would otherwise pick.
//!
//! `cargo run --release -p hooke-benches --bin compare -- --help` says how; `cargo bench -p hooke-benches` times the parts
//! of a step. Times hold for one machine and one hour: only ratios within one run mean anything.

// From the ground up: a scene at several states, ...
mod moving;
mod scenario;
#[cfg(test)]
mod testing;

// ... its matrix, whoever solves with it, and what the answers are worth, ...
mod contender;
mod judge;
mod median;
mod methods;
mod pattern;
mod peers;

// ... what the machine can do, ...
mod bandwidth;
mod iteration;
mod memory;
mod operator;

// ... and what is made of it.
mod args;
mod choose;
mod compare;
mod family;
mod fit;
mod growth;
mod growth_plot;
mod measure;
mod output;
mod outside;
mod row;
mod summary;
mod table;
mod weights;

pub use compare::main as compare;
pub use moving::{Euler, HostScene, moving};
pub use outside::main as outside;
