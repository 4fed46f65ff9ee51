//! The host side of Hooke: meshes in, simulation, pictures and files out. It holds no numerics; those are in `hooke`.

pub mod batch;
pub mod cli;
pub mod error;
pub mod heap;
pub mod host;
pub mod mesh;
pub mod nearest;
pub mod output;
pub mod run;
pub mod scene;
pub mod stress;
pub mod work_precision;
