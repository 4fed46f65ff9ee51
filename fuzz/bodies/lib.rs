//! What the fuzz targets do: any bytes in, and a panic if something does not hold. README.md beside the targets tells what.
//!
//! Each target is a function of bytes without state of its own. The C interface is compiled in from its sources: its own
//! library has a panic handler and would not link with std.

#![allow(non_camel_case_types, clippy::missing_safety_doc)] // As in core/c, for the types of hooke.h.

pub mod bytes;
pub mod kernel;
pub mod kernel_step;
pub mod mesh;
pub mod scene_toml;
pub mod solvers;

pub mod c_api;

// The sources of core/c, whose modules expect to stand at the root.
#[path = "../../core/c/src/buffer.rs"]
mod buffer;
#[path = "../../core/c/src/call.rs"]
mod call;
#[path = "../../core/c/src/double.rs"]
mod double;
#[path = "../../core/c/src/motion.rs"]
mod motion;
#[path = "../../core/c/src/options.rs"]
mod options;
#[path = "../../core/c/src/pointer.rs"]
mod pointer;
#[path = "../../core/c/src/report.rs"]
mod report;
#[path = "../../core/c/src/single.rs"]
mod single;
#[path = "../../core/c/src/status.rs"]
mod status;
