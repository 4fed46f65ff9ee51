//! The few characters a picture's labels need, as pen strokes.
//!
//! tiny-skia draws paths and no text, and a font file with its reader would be larger than all the rest of the
//! pictures. A glyph is a list of strokes on a grid: capitals and digits 8 wide and 12 high, y downwards.

use tiny_skia::{LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

type Glyph = &'static [&'static [(u8, u8)]];

const HEIGHT: f32 = 12.0;
const GAP: f32 = 3.5;
/// How much of a corner is rounded off, in grid units.
const ROUNDING: f32 = 1.7;

fn glyph(character: char) -> Glyph {
    match character {
        '0' => &[&[(4, 0), (6, 0), (8, 3), (8, 9), (6, 12), (2, 12), (0, 9), (0, 3), (2, 0), (4, 0)]],
        '1' => &[&[(1, 3), (5, 0), (5, 12)]],
        '2' => &[&[(0, 3), (2, 0), (6, 0), (8, 2), (8, 5), (0, 12), (8, 12)]],
        '3' => &[
            &[(0, 2), (2, 0), (6, 0), (8, 2), (8, 4), (6, 6), (3, 6)],
            &[(3, 6), (6, 6), (8, 8), (8, 10), (6, 12), (2, 12), (0, 10)],
        ],
        '4' => &[&[(6, 12), (6, 0), (0, 8), (8, 8)]],
        '5' => &[&[(7, 0), (1, 0), (1, 6), (3, 5), (6, 5), (8, 7), (8, 10), (6, 12), (2, 12), (0, 10)]],
        '6' => {
            &[&[(6, 0), (3, 1), (0, 5), (0, 10), (2, 12), (6, 12), (8, 10), (8, 7), (6, 5), (2, 5), (0, 8)]]
        }
        '7' => &[&[(0, 0), (8, 0), (3, 12)]],
        '8' => &[
            &[(4, 6), (2, 6), (0, 4), (0, 2), (2, 0), (6, 0), (8, 2), (8, 4), (6, 6), (4, 6)],
            &[(4, 6), (2, 6), (0, 8), (0, 10), (2, 12), (6, 12), (8, 10), (8, 8), (6, 6), (4, 6)],
        ],
        '9' => &[&[(8, 4), (6, 7), (2, 7), (0, 5), (0, 2), (2, 0), (6, 0), (8, 2), (8, 7), (5, 11), (2, 12)]],
        '.' => &[&[(1, 11), (1, 12)]],
        '-' => &[&[(1, 7), (7, 7)]],
        '+' => &[&[(0, 7), (8, 7)], &[(4, 3), (4, 11)]],
        '=' => &[&[(0, 5), (8, 5)], &[(0, 9), (8, 9)]],
        '%' => &[
            &[(9, 0), (1, 12)],
            &[(2, 0), (3, 0), (4, 2), (3, 5), (1, 5), (0, 2), (1, 0), (2, 0)],
            &[(8, 7), (9, 7), (10, 9), (9, 12), (7, 12), (6, 9), (7, 7), (8, 7)],
        ],
        'a' => &[
            &[(1, 5), (3, 4), (5, 4), (7, 6), (7, 12)],
            &[(7, 7), (2, 8), (0, 10), (2, 12), (5, 12), (7, 10)],
        ],
        'e' => &[&[(0, 8), (7, 8), (7, 6), (5, 4), (2, 4), (0, 6), (0, 10), (2, 12), (6, 12), (7, 11)]],
        'i' => &[&[(1, 4), (1, 12)], &[(1, 0), (1, 1)]],
        'n' => &[&[(0, 4), (0, 12)], &[(0, 6), (2, 4), (5, 4), (7, 6), (7, 12)]],
        'r' => &[&[(0, 4), (0, 12)], &[(0, 7), (2, 4), (5, 4)]],
        's' => &[&[
            (6, 5),
            (4, 4),
            (2, 4),
            (0, 5),
            (0, 7),
            (2, 8),
            (4, 8),
            (6, 9),
            (6, 11),
            (4, 12),
            (2, 12),
            (0, 11),
        ]],
        't' => &[&[(2, 1), (2, 10), (3, 12), (6, 12)], &[(0, 4), (5, 4)]],
        _ => &[],
    }
}

fn advance(character: char) -> f32 {
    // Digits are equally wide, so that the labels of two moments align.
    let width = match character {
        '0'..='9' => 8,
        _ => glyph(character).iter().flat_map(|stroke| stroke.iter()).map(|point| point.0).max().unwrap_or(3),
    };
    f32::from(width) + GAP
}

/// The width of `text` whose capitals are `height` px high.
pub(super) fn width(text: &str, height: f32) -> f32 {
    (text.chars().map(advance).sum::<f32>() - GAP).max(0.0) * height / HEIGHT
}

/// Draws `text` with its upper left corner at (x, y).
pub(super) fn draw(pixmap: &mut Pixmap, text: &str, (x, y): (f32, f32), height: f32, paint: &Paint<'_>) {
    let scale = height / HEIGHT;
    let pen = Stroke {
        width: 0.115 * height,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..Stroke::default()
    };
    let mut left = x;
    for character in text.chars() {
        for stroke in glyph(character) {
            if let Some(path) = rounded(stroke, |gx, gy| (left + scale * gx, y + scale * gy)) {
                pixmap.stroke_path(&path, paint, &pen, Transform::identity(), None);
            }
        }
        left += scale * advance(character);
    }
}

fn rounded(stroke: &[(u8, u8)], place: impl Fn(f32, f32) -> (f32, f32)) -> Option<Path> {
    let at = |k: usize| stroke.get(k).map(|&(x, y)| (f32::from(x), f32::from(y)));
    // From corner `a` towards `b`, but no further than half way: the next corner needs the rest.
    let towards = |a: (f32, f32), b: (f32, f32)| {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let share = (ROUNDING / length).min(0.5);
        place(a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1))
    };
    let mut path = PathBuilder::new();
    let start = at(0)?;
    let (x, y) = place(start.0, start.1);
    path.move_to(x, y);
    for k in 1..stroke.len() {
        let (before, corner) = (at(k - 1)?, at(k)?);
        let (cx, cy) = place(corner.0, corner.1);
        match at(k + 1) {
            None => path.line_to(cx, cy),
            Some(after) => {
                let (x, y) = towards(corner, before);
                path.line_to(x, y);
                let (x, y) = towards(corner, after);
                path.quad_to(cx, cy, x, y);
            }
        }
    }
    path.finish()
}
