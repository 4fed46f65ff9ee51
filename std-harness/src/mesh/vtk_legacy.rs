//! Holds a legacy VTK file against its own counts before the `vtkio` crate parses it.
//! Source: VTK User's Guide, "VTK file formats", simple legacy formats.
//!
//! The crate names no line, and it stops without an error at the first section of polygonal data that it cannot read:
//! a file cut short there, or with a count too small, would lose its cells in silence. So each section must hold
//! exactly the numbers it announces and be followed by another section. Attributes, which come last, are not read.

use std::path::Path;

use super::format::nearest;
use super::text::real;
use crate::error::InputError;

const LISTS: [&str; 5] = ["CELLS", "VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"];

struct Walk<'a> {
    file: &'a Path,
    rest: &'a [u8],
    line: usize,
    ascii: bool,
}

/// Checks points and cells of an unstructured grid or polygonal data.
pub(super) fn check(file: &Path, bytes: &[u8]) -> Result<(), InputError> {
    let mut walk = Walk { file, rest: bytes, line: 0, ascii: true };
    walk.words()?;
    // The title may be anything, so it is taken as it stands.
    walk.take_line();
    walk.ascii = match walk.words()?.first().map(String::as_str) {
        Some("ASCII") => true,
        Some("BINARY") => false,
        other => return Err(walk.fail(format!("'{}' must be ASCII or BINARY", other.unwrap_or("")))),
    };
    loop {
        let words = walk.words()?;
        let Some(keyword) = words.first() else { return Ok(()) };
        match keyword.as_str() {
            "DATASET"
                if !matches!(words.get(1).map(String::as_str), Some("UNSTRUCTURED_GRID" | "POLYDATA")) =>
            {
                return Ok(());
            }
            "DATASET" => {}
            "POINTS" => {
                let count = walk.count(&words, 1)?;
                let size = match words.get(2).map(String::as_str) {
                    Some("FLOAT") => 4,
                    Some("DOUBLE") => 8,
                    other => {
                        let message =
                            format!("POINTS of type '{}'; it must be float or double", other.unwrap_or(""));
                        return Err(walk.fail(message));
                    }
                };
                walk.data(keyword, count.saturating_mul(3), size)?;
            }
            "CELL_TYPES" => {
                let count = walk.count(&words, 1)?;
                walk.data(keyword, count, 4)?;
            }
            "OFFSETS" | "CONNECTIVITY" => return Err(walk.fail(format!("{keyword} outside a list of cells"))),
            "METADATA" => while walk.take_line().is_some_and(|l| !l.trim_ascii().is_empty()) {},
            "POINT_DATA" | "CELL_DATA" | "FIELD" => return Ok(()),
            list if LISTS.contains(&list) => {
                let (count, size) = (walk.count(&words, 1)?, walk.count(&words, 2)?);
                if walk.rest.trim_ascii_start().get(..7).is_some_and(|w| w.eq_ignore_ascii_case(b"OFFSETS")) {
                    for (part, length) in [("OFFSETS", count), ("CONNECTIVITY", size)] {
                        if walk.words()?.first().map(String::as_str) != Some(part) {
                            return Err(walk.fail(format!("{part} of {list} is missing: a count is wrong")));
                        }
                        walk.data(part, length, 8)?;
                    }
                } else {
                    walk.data(keyword, size, 4)?;
                }
            }
            _ => {
                let known =
                    [&LISTS[..], &["DATASET", "POINTS", "CELL_TYPES", "POINT_DATA", "CELL_DATA"]].concat();
                let near =
                    nearest(keyword, &known).map(|k| format!(", did you mean {k}?")).unwrap_or_default();
                return Err(walk.fail(format!(
                    "'{keyword}' is no VTK section{near}; or a count before it is too small"
                )));
            }
        }
    }
}

impl Walk<'_> {
    fn fail(&self, message: String) -> InputError {
        // Bytes of a binary section are no lines, so there the message must do without.
        if self.ascii {
            InputError::at(self.file, self.line.max(1), message)
        } else {
            InputError::in_file(self.file, message)
        }
    }

    fn take_line(&mut self) -> Option<Vec<u8>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|b| *b == b'\n').unwrap_or(self.rest.len() - 1);
        let (line, rest) = self.rest.split_at(end + 1);
        self.rest = rest;
        self.line += 1;
        Some(line.to_vec())
    }

    /// The words of the next line that has any, in capitals as VTK reads them; none at the end of the file.
    fn words(&mut self) -> Result<Vec<String>, InputError> {
        while let Some(line) = self.take_line() {
            let text = String::from_utf8_lossy(&line).to_uppercase();
            if text.len() > 1000 {
                return Err(self.fail("no VTK section where one should start: a count is wrong".into()));
            }
            let words: Vec<String> = text.split_whitespace().map(str::to_string).collect();
            if !words.is_empty() {
                return Ok(words);
            }
        }
        Ok(Vec::new())
    }

    fn count(&self, words: &[String], at: usize) -> Result<usize, InputError> {
        let word = words.get(at).map(String::as_str).unwrap_or("");
        let number = word.parse::<u32>().ok().and_then(|n| usize::try_from(n).ok());
        number.ok_or_else(|| self.fail(format!("'{word}' is no count of {}", words[0])))
    }

    /// Goes past the numbers of a section.
    fn data(&mut self, section: &str, count: usize, size: usize) -> Result<(), InputError> {
        if !self.ascii {
            let Some(rest) = self.rest.get(count.saturating_mul(size)..) else {
                let have = self.rest.len() / size;
                return Err(self
                    .fail(format!("{section} announces {count} numbers, {have} are left: it is cut short")));
            };
            self.rest = rest;
            return Ok(());
        }
        let mut found = 0;
        while found < count {
            let Some(line) = self.take_line() else {
                return Err(
                    self.fail(format!("{section} announces {count} numbers, the file ends after {found}"))
                );
            };
            for word in String::from_utf8_lossy(&line).split_whitespace() {
                real(word).map_err(|why| self.fail(format!("{why}; {section} announces {count} numbers")))?;
                found += 1;
            }
        }
        if found > count {
            return Err(
                self.fail(format!("{section} announces {count} numbers, by this line there are {found}"))
            );
        }
        Ok(())
    }
}
