//! The certificate of a solve, judged: random systems with condition numbers up to 1e16 and beyond, solved by every solver,
//! cut short or not, and the energy of the true error found in 62 digits.
//!
//! [`case`] makes a network and a step, [`solvers`] solves it, [`stored`] takes the kernel's matrix apart, [`judge`]
//! compares, [`projection`] asks the certificate that no projection is needed against exact inertia, [`seen`] adds up,
//! [`table`] and [`picture`] show. `oracle/bounds.rs` runs some thousand systems, `bin/certify.rs` 10⁵.

pub mod case;
pub mod condition;
pub mod judge;
pub mod picture;
pub mod projection;
pub mod rounding;
pub mod seen;
pub mod solvers;
pub mod stored;
pub mod table;
