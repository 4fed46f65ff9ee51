//! Words of a text file with the line each stands on: what our own readers (MEDIT, Gmsh) read from.
//!
//! `#` starts a comment that ends with the line. Counts come from the file and are never trusted with memory: nothing
//! is reserved for them, so that a header that announces too much ends in "end of file", not in an allocation.

use std::path::Path;

use crate::error::InputError;

/// A file as words, one line at a time.
pub(super) struct Words<'a> {
    file: &'a Path,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    words: std::str::SplitWhitespace<'a>,
    /// The line of the last word taken.
    pub(super) line: usize,
    ahead: Option<&'a str>,
}

impl<'a> Words<'a> {
    pub(super) fn new(file: &'a Path, text: &'a str) -> Self {
        Self { file, lines: text.lines().enumerate(), words: "".split_whitespace(), line: 0, ahead: None }
    }

    /// The next word, if there is one.
    pub(super) fn next(&mut self) -> Option<&'a str> {
        if let Some(word) = self.ahead.take() {
            return Some(word);
        }
        loop {
            if let Some(word) = self.words.next() {
                return Some(word);
            }
            let (index, line) = self.lines.next()?;
            self.line = index + 1;
            self.words = line.split('#').next().unwrap_or("").split_whitespace();
        }
    }

    /// The next word without taking it.
    pub(super) fn peek(&mut self) -> Option<&'a str> {
        self.ahead = self.next();
        self.ahead
    }

    /// Skips lines up to and including the one that reads `end`.
    pub(super) fn skip_past(&mut self, end: &str) -> Result<(), InputError> {
        self.ahead = None;
        self.words = "".split_whitespace();
        for (index, line) in self.lines.by_ref() {
            self.line = index + 1;
            if line.trim() == end {
                return Ok(());
            }
        }
        Err(self.error(format!("the file ends before {end}: it is cut short")))
    }

    /// An error on the line of the last word taken.
    pub(super) fn error(&self, message: impl Into<String>) -> InputError {
        InputError::at(self.file, self.line.max(1), message)
    }

    /// The next word; `what` says what should stand there.
    pub(super) fn word(&mut self, what: &str) -> Result<&'a str, InputError> {
        self.next()
            .ok_or_else(|| self.error(format!("the file ends where {what} should stand: it is cut short")))
    }

    /// The next word as an unsigned integer.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, InputError> {
        let word = self.word(what)?;
        word.parse()
            .map_err(|_| self.error(format!("'{word}' is not a whole number; here should stand {what}")))
    }

    /// The next word as an integer.
    pub(super) fn integer(&mut self, what: &str) -> Result<i64, InputError> {
        let word = self.word(what)?;
        word.parse().map_err(|_| self.error(format!("'{word}' is not an integer; here should stand {what}")))
    }

    /// The next word as a finite number.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, InputError> {
        let word = self.word(what)?;
        real(word).map_err(|why| self.error(format!("{why}; here should stand {what}")))
    }
}

/// A finite number, or why the word is none.
pub(super) fn real(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(format!("'{word}' is not finite")),
        Err(_) => Err(format!("'{word}' is not a number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_line_and_comments_end_with_it() {
        let mut words = Words::new(Path::new("m.x"), "a # b\n\n  7 x\n1e999");
        assert_eq!((words.next(), words.line), (Some("a"), 1));
        assert_eq!(words.peek(), Some("7"));
        assert_eq!((words.count("n").unwrap(), words.line), (7, 3));
        assert_eq!(
            words.count("a count").unwrap_err().to_string(),
            "m.x:3: 'x' is not a whole number; here should stand a count"
        );
        assert_eq!(
            words.real("x").unwrap_err().to_string(),
            "m.x:4: '1e999' is not finite; here should stand x"
        );
        assert!(words.word("y").unwrap_err().to_string().starts_with("m.x:4: the file ends where y"));
    }
}
