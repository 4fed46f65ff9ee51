//! The numbers of an MSH file, whether they stand there as text or as bytes, and its section marks.
//!
//! In a binary file `int` is 4 bytes, `size_t` as many as the header says (4 or 8), `double` 8; the header's integer 1
//! tells the byte order. Errors name the line of a text file and the byte of a binary one.

use std::path::Path;

use super::text::Words;
use crate::error::InputError;

/// An opened MSH file, past its header.
pub(super) enum Input<'a> {
    Text(Words<'a>),
    Binary { file: &'a Path, bytes: &'a [u8], at: usize, big: bool, wide: bool },
}

impl<'a> Input<'a> {
    /// Reads the header; also says whether the file is of version 2.2.
    pub(super) fn open(file: &'a Path, bytes: &'a [u8], text: &'a str) -> Result<(Self, bool), InputError> {
        let mut words = Words::new(file, text);
        if words.next() != Some("$MeshFormat") {
            return Err(words.error("not a Gmsh mesh: it does not start with $MeshFormat"));
        }
        let version = words.word("the version")?;
        let legacy = match version {
            "4.1" => false,
            "2.2" | "2.1" | "2" => true,
            _ => {
                let advice = "known are 4.1 and 2.2; save it as 4.1 (gmsh -save -format msh41)";
                return Err(words.error(format!("MSH version {version}: {advice}")));
            }
        };
        let kind = words.count("0 (ASCII) or 1 (binary)")?;
        let size = words.count("the size of size_t")?;
        match (kind, legacy) {
            (0, _) => {
                words.skip_past("$EndMeshFormat")?;
                Ok((Input::Text(words), legacy))
            }
            (1, true) => Err(words.error("binary MSH 2: save it as 4.1 (gmsh -save -format msh41)")),
            (1, false) if matches!(size, 4 | 8) => {
                let mark = b"$EndMeshFormat";
                let Some(end) = bytes.windows(mark.len()).position(|w| w == mark) else {
                    return Err(words.error("the file ends before $EndMeshFormat: it is cut short"));
                };
                let one = bytes[..end].strip_suffix(b"\n").unwrap_or(&bytes[..end]);
                let big = match one {
                    [.., 0, 0, 0, 1] => true,
                    [.., 1, 0, 0, 0] => false,
                    _ => return Err(words.error("the header's integer 1 is missing: byte order unknown")),
                };
                let at = end + mark.len();
                Ok((Input::Binary { file, bytes, at, big, wide: size == 8 }, false))
            }
            (1, false) => Err(words.error(format!("size_t of {size} bytes; it must be 4 or 8"))),
            _ => Err(words.error(format!("file type {kind}; it must be 0 (ASCII) or 1 (binary)"))),
        }
    }

    /// An error at the place read last.
    pub(super) fn fail(&self, message: impl Into<String>) -> InputError {
        match self {
            Input::Text(words) => words.error(message),
            Input::Binary { file, at, .. } => {
                InputError::in_file(file, format!("before byte {at}: {}", message.into()))
            }
        }
    }

    /// The name of the next section, `None` at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<String>, InputError> {
        let Some(mark) = self.mark() else { return Ok(None) };
        match mark.strip_prefix('$') {
            Some(name) if !name.is_empty() && !name.starts_with("End") => Ok(Some(name.to_string())),
            _ => Err(self.fail(format!("'{mark}' stands where a section should start"))),
        }
    }

    /// The mark that closes a section.
    pub(super) fn end(&mut self, section: &str) -> Result<(), InputError> {
        match self.mark() {
            Some(mark) if mark.strip_prefix("$End") == Some(section) => Ok(()),
            Some(mark) => {
                Err(self.fail(format!("'{mark}' stands where $End{section} should: the counts are wrong")))
            }
            None => Err(self.fail(format!("the file ends before $End{section}: it is cut short"))),
        }
    }

    /// Goes past the end of a section that is not read.
    pub(super) fn skip(&mut self, section: &str) -> Result<(), InputError> {
        let mark = format!("$End{section}");
        match self {
            Input::Text(words) => words.skip_past(&mark),
            Input::Binary { bytes, at, .. } => {
                let rest = bytes.get(*at..).unwrap_or_default();
                match rest.windows(mark.len()).position(|w| w == mark.as_bytes()) {
                    Some(place) => {
                        *at += place + mark.len();
                        Ok(())
                    }
                    None => Err(self.fail(format!("the file ends before {mark}: it is cut short"))),
                }
            }
        }
    }

    /// A word: in a binary file, the rest of a line, after blank lines.
    fn mark(&mut self) -> Option<String> {
        match self {
            Input::Text(words) => words.next().map(str::to_string),
            Input::Binary { bytes, at, .. } => {
                let start = *at + bytes.get(*at..)?.iter().position(|b| !b.is_ascii_whitespace())?;
                let length = bytes[start..].iter().take(64).position(|b| *b == b'\n').unwrap_or(64);
                let end = (start + length).min(bytes.len());
                // Past the line end: what follows is bytes, the first of which may look like white space.
                *at = (end + 1).min(bytes.len());
                Some(String::from_utf8_lossy(&bytes[start..end]).trim_end().to_string())
            }
        }
    }

    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N], InputError> {
        if let Input::Binary { bytes, at, big, .. } = self
            && let Some(Ok(mut taken)) = bytes.get(*at..).and_then(|b| b.get(..N)).map(<[u8; N]>::try_from)
        {
            *at += N;
            if *big {
                taken.reverse();
            }
            return Ok(taken);
        }
        Err(self.fail(format!("the file ends where {what} should stand: it is cut short")))
    }

    /// A `size_t`: a count or a tag.
    pub(super) fn size(&mut self, what: &str) -> Result<usize, InputError> {
        let number = match self {
            Input::Text(words) => return words.count(what),
            Input::Binary { wide: true, .. } => u64::from_le_bytes(self.take(what)?),
            Input::Binary { .. } => u64::from(u32::from_le_bytes(self.take(what)?)),
        };
        usize::try_from(number).map_err(|_| self.fail(format!("{number} is too large for {what}")))
    }

    /// An `int`.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, InputError> {
        match self {
            Input::Text(words) => words.integer(what),
            Input::Binary { .. } => Ok(i64::from(i32::from_le_bytes(self.take(what)?))),
        }
    }

    /// A finite `double`.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, InputError> {
        if let Input::Text(words) = self {
            return words.real(what);
        }
        let x = f64::from_le_bytes(self.take(what)?);
        if x.is_finite() {
            Ok(x)
        } else {
            Err(self.fail(format!("{what} is {x}, coordinates must be finite")))
        }
    }
}
