//! A file is either whole or not there.
//!
//! Content goes to a temporary sibling, which is renamed when it is complete: within one folder a rename is
//! atomic, so a failed run leaves the earlier file, or none, and never half a one. (No `fsync`: this guards
//! against a run that dies, not against a power cut.) The two `prepare` functions ask *before* a simulation
//! whether its results will have a place to go.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::InputError;

/// Writes a file through `fill`, all or nothing. A symbolic link keeps pointing where it did.
///
/// # Errors
/// Whatever `fill` or the file system reports, with the path in front.
pub fn write_file(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let written = match fs::metadata(path) {
        // A pipe or a device such as /dev/stdout is written to; a rename would replace the device itself.
        Ok(meta) if !meta.is_file() => {
            OpenOptions::new().write(true).open(path).and_then(|file| filled(file, fill))
        }
        Ok(_) => fs::canonicalize(path).and_then(|target| replace(&target, fill)),
        Err(_) => replace(path, fill),
    };
    written.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))
}

/// Makes sure that files can be written into `dir`, creating it and its parents where they are missing.
///
/// # Errors
/// Names the directory and the reason; whatever was created on the way is gone again.
pub fn prepare_dir(dir: &Path) -> Result<(), InputError> {
    let mut created = Vec::new();
    create_missing(dir, &mut created).and_then(|()| probe(dir)).map_err(|error| {
        for made in created.iter().rev() {
            // Only ever an empty directory of our own; if that fails there is nothing better to do.
            let _ = fs::remove_dir(made);
        }
        InputError::in_file(dir, format!("cannot write into this directory: {error}"))
    })
}

/// Makes sure that `path` can be written: its directory is there and takes new files, and nothing that must not
/// be replaced stands in the way. Touches neither the file nor what is in it.
///
/// # Errors
/// Names the file and the reason; nothing is left behind.
pub fn prepare_file(path: &Path) -> Result<(), InputError> {
    let refuse = |reason: &str| Err(InputError::in_file(path, format!("cannot write this file: {reason}")));
    if path.file_name().is_none() || path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
        return refuse("the path has no file name");
    }
    let target = match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return refuse("it is a directory"),
        // A rename would replace a write-protected file without asking.
        Ok(meta) if meta.permissions().readonly() => return refuse("it is write-protected"),
        Ok(meta) if !meta.is_file() => return Ok(()),
        Ok(_) => fs::canonicalize(path),
        Err(_) => Ok(path.to_path_buf()),
    };
    match target.and_then(|target| probe(parent(&target))) {
        Err(error) => refuse(&error.to_string()),
        Ok(()) => Ok(()),
    }
}

/// A temporary file that removes itself unless it was renamed in time.
struct Part {
    path: PathBuf,
    armed: bool,
}

impl Drop for Part {
    fn drop(&mut self) {
        if self.armed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn replace(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "no file name"))?;
    let (file, mut part) = temporary(parent(path), &name.to_string_lossy())?;
    filled(file, fill)?;
    fs::rename(&part.path, path)?;
    part.armed = false;
    Ok(())
}

fn filled(file: File, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    fill(&mut writer)?;
    // Dropping a BufWriter swallows the error of its last write.
    writer.flush()
}

/// A new file `.NAME.N.part`; never one that is there, which may belong to a run beside this one.
fn temporary(dir: &Path, name: &str) -> io::Result<(File, Part)> {
    let mut attempt = 0_u32;
    loop {
        let path = dir.join(format!(".{name}.{}-{attempt}.part", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((file, Part { path, armed: true })),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < 100 => attempt += 1,
            Err(error) => return Err(error),
        }
    }
}

fn probe(dir: &Path) -> io::Result<()> {
    temporary(dir, "hooke").map(drop)
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|dir| !dir.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn create_missing(dir: &Path, created: &mut Vec<PathBuf>) -> io::Result<()> {
    let missing: Vec<_> =
        dir.ancestors().take_while(|dir| !dir.as_os_str().is_empty() && !dir.exists()).collect();
    for dir in missing.into_iter().rev() {
        match fs::create_dir(dir) {
            Ok(()) => created.push(dir.to_path_buf()),
            Err(_) if dir.is_dir() => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
