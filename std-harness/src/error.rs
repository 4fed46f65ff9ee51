//! What is wrong with an input, and where: the one line that `hooke` prints before it exits with 2.

use std::fmt;
use std::path::{Path, PathBuf};

/// Bad input: the file and line it stands in (where known) and a message that names the offending value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// The file, if the input came from one.
    pub file: Option<PathBuf>,
    /// The line in that file, counted from 1, if known.
    pub line: Option<usize>,
    /// What is wrong, naming the value, and where it helps what to do.
    pub message: String,
}

impl InputError {
    /// An error that belongs to no file: an option, a scene name.
    pub fn new(message: impl Into<String>) -> Self {
        Self { file: None, line: None, message: message.into() }
    }

    /// An error in a file as a whole.
    pub fn in_file(file: &Path, message: impl Into<String>) -> Self {
        Self { file: Some(file.to_path_buf()), line: None, message: message.into() }
    }

    /// An error on one line (counted from 1) of a file.
    pub fn at(file: &Path, line: usize, message: impl Into<String>) -> Self {
        Self { file: Some(file.to_path_buf()), line: Some(line), message: message.into() }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", file.display())?;
            if let Some(line) = self.line {
                write!(f, "{line}:")?;
            }
            write!(f, " ")?;
        }
        // One line, whatever a parser put into its message.
        write!(f, "{}", self.message.split_whitespace().collect::<Vec<_>>().join(" "))
    }
}

impl std::error::Error for InputError {}
