//! Tables as CSV: the final state and the energies over time.
//!
//! Numbers are Rust's `{}`: the shortest decimals that read back as the same bits, for f32 and f64 alike, so a
//! comparison of two runs can be a comparison of two files. Lines end in LF on every system for the same reason.

use std::fmt::Display;
use std::io;
use std::path::Path;

use super::{Energy, safe};

/// Writes `id,x,y,z,vx,vy,vz`, a row per particle in id order. `T` is the precision of the run: an f32 printed
/// by way of f64 would show digits that it does not have.
///
/// # Errors
/// Lists of different length, or the file system's error; then no file is left.
pub fn write_final<T: Display>(path: &Path, positions: &[[T; 3]], velocities: &[[T; 3]]) -> io::Result<()> {
    if positions.len() != velocities.len() {
        let message = format!("{} positions, but {} velocities", positions.len(), velocities.len());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    safe::write_file(path, |out| {
        out.write_all(b"id,x,y,z,vx,vy,vz\n")?;
        for (id, ([x, y, z], [vx, vy, vz])) in positions.iter().zip(velocities).enumerate() {
            writeln!(out, "{id},{x},{y},{z},{vx},{vy},{vz}")?;
        }
        Ok(())
    })
}

/// Writes `time,kinetic,springs,gravity,total` in s and J, a row per sample.
///
/// # Errors
/// The file system's; then no file is left.
pub fn write_energy(path: &Path, samples: &[Energy]) -> io::Result<()> {
    safe::write_file(path, |out| {
        out.write_all(b"time,kinetic,springs,gravity,total\n")?;
        for Energy { time, kinetic, springs, gravity, total } in samples {
            writeln!(out, "{time},{kinetic},{springs},{gravity},{total}")?;
        }
        Ok(())
    })
}
