//! The wrappers, by what they wrap.

mod buffers;
mod control;
mod direct;
mod editing;
mod equations;
mod forces;
mod integrator;
mod measuring;
mod methods;
mod multigrid;
mod preconditioned;
mod sleeping;
mod snapshots;
mod stepping;
mod system;
mod vectors;
mod wide;
