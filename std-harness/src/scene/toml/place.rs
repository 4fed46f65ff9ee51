//! The text of a scene file, and errors that name its lines.

use std::ops::Range;
use std::path::Path;

use super::schema::{SceneFile, TOP};
use crate::error::InputError;
use crate::nearest;

/// A scene file's text.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    text: &'a str,
}

impl<'a> Source<'a> {
    /// The bytes as text.
    pub fn new(file: &'a Path, bytes: &'a [u8]) -> Result<Self, InputError> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self { file, text }),
            Err(error) => {
                let line = line(&bytes[..error.valid_up_to()]);
                Err(InputError::at(file, line, "not UTF-8 text, as TOML must be"))
            }
        }
    }

    /// An error on the line where a span begins.
    pub fn error(&self, at: &Range<usize>, message: impl Into<String>) -> InputError {
        InputError::at(self.file, self.line(at), message)
    }

    /// The line of a span, counted from 1.
    pub fn line(&self, at: &Range<usize>) -> usize {
        line(&self.text.as_bytes()[..at.start.min(self.text.len())])
    }

    /// The file's keys and values.
    pub fn parse(&self) -> Result<SceneFile, InputError> {
        ::toml::from_str(self.text).map_err(|error| {
            let (message, span) = (error.message(), error.span());
            let known = unknown_key(message);
            let text = known.unwrap_or_else(|| match &span {
                // toml says what is wrong but not of which key: the line does.
                Some(at) => match self.text.lines().nth(self.line(at) - 1).map(str::trim) {
                    Some(line) if !line.is_empty() && line.len() <= 80 => format!("{message} in '{line}'"),
                    _ => message.to_string(),
                },
                None => message.to_string(),
            });
            match span {
                Some(at) => self.error(&at, text),
                None => InputError::in_file(self.file, text),
            }
        })
    }
}

fn line(before: &[u8]) -> usize {
    1 + before.iter().filter(|b| **b == b'\n').count()
}

/// serde's "unknown field `x`, expected one of `a`, `b`", in our words and with the nearest key.
fn unknown_key(message: &str) -> Option<String> {
    let names: Vec<&str> = message.strip_prefix("unknown field ")?.split('`').skip(1).step_by(2).collect();
    let (name, keys) = names.split_first()?;
    let hint = if TOP.contains(name) {
        "; it belongs above the first [table]".into()
    } else {
        nearest::suggestion(name, keys)
    };
    Some(format!("unknown key '{name}'{hint} (known here: {})", keys.join(", ")))
}
