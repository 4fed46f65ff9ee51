//! The host side of Hooke: meshes in, simulation, pictures and files out. It holds no numerics; those are in `hooke`.

pub mod error;
pub mod mesh;
pub mod output;
