//! What `hooke info MESH` tells of a mesh: its counts, sizes and oddities, without running anything.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Format, KINDS, Lengths, Mesh, load};
use crate::error::InputError;

/// How many cells of one kind a mesh has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct KindCount {
    /// The kind, in the plural.
    pub kind: &'static str,
    /// How many.
    pub count: usize,
}

/// A mesh in numbers; ids are 0-based, in the file's order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Info {
    /// The file.
    pub file: PathBuf,
    /// Its format.
    pub format: &'static str,
    /// Points, used or not: these become particles.
    pub points: usize,
    /// Cells by kind, kinds without any left out.
    pub cells: Vec<KindCount>,
    /// Unique edges: these become springs.
    pub edges: usize,
    /// Pairs that bending springs would join.
    pub bending_pairs: usize,
    /// Connected pieces, isolated points not counted.
    pub components: usize,
    /// Points in no cell.
    pub isolated: Vec<usize>,
    /// Points with exactly the coordinates of an earlier one, as (earlier, later).
    pub repeated: Vec<[usize; 2]>,
    /// Edges of length 0.
    pub zero_length: Vec<[usize; 2]>,
    /// Lowest and highest corner of the box around the points.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// Edge lengths.
    pub lengths: Option<Lengths>,
    /// Area of triangles and quadrilaterals.
    pub area: f64,
    /// Volume of solids.
    pub volume: f64,
    /// What the reader had to say.
    pub notes: Vec<String>,
}

/// Loads a mesh and sums it up.
pub fn info(path: &Path) -> Result<Info, InputError> {
    Ok(Info::of(&load(path)?, path, Format::of(path)?))
}

impl Info {
    /// Sums up a mesh already loaded.
    pub fn of(mesh: &Mesh, file: &Path, format: Format) -> Self {
        let mut counts = [0; KINDS.len()];
        mesh.cells.iter().for_each(|c| counts[c.kind()] += 1);
        let cells = KINDS.into_iter().zip(counts).filter(|(_, count)| *count > 0);
        Self {
            file: file.to_path_buf(),
            format: format.name(),
            points: mesh.points.len(),
            cells: cells.map(|(kind, count)| KindCount { kind, count }).collect(),
            edges: mesh.edges().len(),
            bending_pairs: mesh.bending_pairs().len(),
            components: mesh.components(),
            isolated: mesh.isolated(),
            repeated: mesh.repeated(),
            zero_length: mesh.zero_length(),
            bounds: mesh.bounds(),
            lengths: mesh.lengths(),
            area: mesh.area(),
            volume: mesh.volume(),
            notes: mesh.notes.clone(),
        }
    }
}

/// Digits in threes.
fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Six significant digits, without the tail of zeros; exponents where plain digits would be many.
fn short(x: f64) -> String {
    let magnitude = x.abs();
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-4..1e7).contains(&magnitude) {
        return format!("{x:.5e}");
    }
    let places = (5 - magnitude.log10().floor() as i32).max(0) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// The first few of a list, and how many there are.
fn few<T>(items: &[T], show: impl Fn(&T) -> String) -> String {
    let first: Vec<String> = items.iter().take(5).map(show).collect();
    let more = if items.len() > first.len() { " …" } else { "" };
    match items.len() {
        0 => "0".into(),
        n => format!("{} ({}{more})", grouped(n), first.join(", ")),
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = |name: &str, value: String| writeln!(f, "{name:<14}{value}");
        let pair = |p: &[usize; 2]| format!("{}–{}", p[0], p[1]);
        row("file", self.file.display().to_string())?;
        row("format", self.format.into())?;
        row("points", grouped(self.points))?;
        let cells: Vec<_> = self.cells.iter().map(|c| format!("{} {}", grouped(c.count), c.kind)).collect();
        row("cells", if cells.is_empty() { "none".into() } else { cells.join(", ") })?;
        row("edges", format!("{} (= springs)", grouped(self.edges)))?;
        row("bending pairs", grouped(self.bending_pairs))?;
        row("pieces", grouped(self.components))?;
        row("isolated", few(&self.isolated, usize::to_string))?;
        row("repeated", few(&self.repeated, pair))?;
        row("zero length", few(&self.zero_length, pair))?;
        if let Some([low, high]) = self.bounds {
            for ((axis, low), high) in ["x", "y", "z"].into_iter().zip(low).zip(high) {
                row(axis, format!("{} … {}", short(low), short(high)))?;
            }
        }
        if let Some(Lengths { min, median, max }) = self.lengths {
            row("edge length", format!("{} … {}, median {}", short(min), short(max), short(median)))?;
        }
        row("area", short(self.area))?;
        row("volume", short(self.volume))?;
        for note in &self.notes {
            row("note", note.clone())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_readable() {
        assert_eq!([1, 999, 1_000, 1_234_567].map(grouped), ["1", "999", "1,000", "1,234,567"]);
        assert_eq!([0.0, -1.0, 0.1, 123456.7].map(short), ["0", "-1", "0.1", "123457"]);
        assert_eq!([1_500_000.0, 1.25e-9, f64::MAX].map(short), ["1500000", "1.25000e-9", "1.79769e308"]);
        assert_eq!(few(&[0; 6], usize::to_string), "6 (0, 0, 0, 0, 0 …)");
    }
}
