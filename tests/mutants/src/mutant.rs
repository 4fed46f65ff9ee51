//! What cargo-mutants lists: a place, and what would stand there.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// What goes wrong is told and ends the program.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// One change of one place. Its number is its place in the list, from 1.
pub struct Mutant {
    /// Of the source, from the repository's root.
    pub file: String,
    /// Where, and what: cargo-mutants' own name.
    pub name: String,
    /// What kind of change.
    pub genre: String,
    /// What stands there instead.
    pub replacement: String,
    /// First line and column, from 1.
    pub start: (usize, usize),
}

impl Mutant {
    /// The name without the place.
    pub fn what(&self) -> &str {
        self.name.splitn(4, ':').nth(3).unwrap_or(&self.name).trim()
    }
}

/// What `cargo mutants --list --json` wrote.
pub fn list(path: &Path) -> Result<Vec<Mutant>> {
    let all: Vec<Value> = serde_json::from_str(&fs::read_to_string(path)?)?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let number = |value: &Value| value.as_u64().unwrap_or_default() as usize;
    let mut mutants: Vec<Mutant> = all
        .iter()
        .map(|one| Mutant {
            file: text(&one["file"]),
            name: text(&one["name"]),
            genre: text(&one["genre"]),
            replacement: text(&one["replacement"]),
            start: (number(&one["span"]["start"]["line"]), number(&one["span"]["start"]["column"])),
        })
        .collect();
    mutants.sort_by(|a, b| (&a.file, a.start).cmp(&(&b.file, b.start)));
    Ok(mutants)
}

/// Whether a file is meant by words: it contains one of them (or there is none), and none of those behind a `-`.
pub fn is_meant(file: &str, words: &[&str]) -> bool {
    let (without, with): (Vec<&str>, Vec<&str>) = words.iter().partition(|word| word.starts_with('-'));
    (with.is_empty() || with.iter().any(|word| file.contains(word)))
        && !without.iter().any(|word| file.contains(&word[1..]))
}
