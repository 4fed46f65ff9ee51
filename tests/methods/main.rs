//! Methods of time integration: exact identities, what they keep, their limits, and their orders.

// Indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

mod clamped;
mod closed_forms;
mod coefficients;
mod conservation;
mod controller;
mod cubics;
mod dense_step;
mod endings;
mod error_control;
mod every_method;
mod explicit_steps;
mod foretold;
mod many_solves;
mod merged;
mod minimization;
mod moving_pins;
mod orders;
mod pins_under_way;
mod point_springs;
mod probes;
mod slack;
mod step_limits;
