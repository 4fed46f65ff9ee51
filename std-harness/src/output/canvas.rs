//! Moments onto pixels: layout, lines from far to near, labels and the colour bar.

use tiny_skia::{FillRule, LineCap, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::camera::{Camera, Seen};
use super::colour::{RELAXED, Rgb, colour, mix, paint, percent, strain_colour, strain_range};
use super::pen::{Pens, hairline};
use super::picture::Moment;
use super::stroke_font;

const BACKGROUND: Rgb = [0.055, 0.071, 0.098];
const PANEL: Rgb = [0.082, 0.102, 0.137];
const TEXT: Rgb = [0.72, 0.76, 0.82];
const PINNED: Rgb = [1.0, 0.80, 0.30];
/// How much of its colour the farthest line loses to the background: depth where lines only cross.
const FOG: f64 = 0.62;
/// Part of the picture in px: left, top, width, height.
#[derive(Clone, Copy)]
struct Area {
    x: f32,
    y: f32,
    w: f32,
    h: f32,
}

/// The bounds of the projected motion and the px per metre with which it fits an area.
struct View {
    camera: Camera,
    middle: (f64, f64),
    extent: (f64, f64),
}

/// Draws the moments in reading order; `None` for a size that cannot be.
pub(super) fn draw((width, height): (u32, u32), moments: &[&Moment]) -> Option<Pixmap> {
    let mut pixmap = Pixmap::new(width, height)?;
    pixmap.fill(colour(BACKGROUND));
    let text = (width.min(2 * height) as f32 / 130.0).clamp(6.0, 20.0);
    let legend = 3.6 * text;
    let view = View::of(moments);
    let range = strain_range(moments);
    let whole = Area { x: 0.0, y: 0.0, w: width as f32, h: (height as f32 - legend).max(1.0) };
    let (columns, rows) = grid(moments.len(), whole, view.extent, text);
    let pens = Pens::of(&view.camera, view.extent, moments);
    for (index, moment) in moments.iter().enumerate() {
        let (w, h) = (whole.w / columns as f32, whole.h / rows as f32);
        let area = Area { x: (index % columns) as f32 * w, y: (index / columns) as f32 * h, w, h };
        panel(&mut pixmap, area, &view, &pens, moment, range, text);
        let label = format!("t = {:.*} s", decimals(moments), moment.time);
        let at = (area.x + 0.5 * (w - stroke_font::width(&label, text)), area.y + h - 2.2 * text);
        stroke_font::draw(&mut pixmap, &label, at, text, &paint(TEXT));
    }
    bar(&mut pixmap, Area { x: 0.0, y: whole.h, w: whole.w, h: legend }, range, text);
    Some(pixmap)
}

impl View {
    fn of(moments: &[&Moment]) -> Self {
        let points = || moments.iter().flat_map(|moment| moment.seen());
        let camera = Camera::around(points());
        // Tighter than the corners of the box: seen obliquely, those stick out where the motion never goes.
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (x, y) = points().map(|point| camera.see(point)).fold((none, none), |(x, y), seen| {
            ((seen.x.min(x.0), seen.x.max(x.1)), (seen.y.min(y.0), seen.y.max(y.1)))
        });
        if x.0 > x.1 {
            return Self { camera, middle: (0.0, 0.0), extent: (1.0, 1.0) };
        }
        // A single particle has no extent; any scale will do.
        let least = if camera.radius > 0.0 { 1e-3 * camera.radius } else { 1.0 };
        Self {
            camera,
            middle: (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1)),
            extent: ((x.1 - x.0).max(least), (y.1 - y.0).max(least)),
        }
    }
}

/// The part of a panel that the motion may fill; below it stands the time.
fn inner(area: Area, text: f32) -> Area {
    let margin = (0.07 * area.w.min(area.h)).max(0.8 * text);
    Area {
        x: area.x + margin,
        y: area.y + margin,
        w: (area.w - 2.0 * margin).max(1.0),
        h: (area.h - margin - 3.6 * text).max(1.0),
    }
}

fn scale((w, h): (f64, f64), area: Area) -> f64 {
    (f64::from(area.w) / w).min(f64::from(area.h) / h)
}

/// The number of columns and rows that shows the motion largest.
fn grid(count: usize, whole: Area, extent: (f64, f64), text: f32) -> (usize, usize) {
    let size = |&columns: &usize| {
        let rows = count.div_ceil(columns);
        let area = Area { w: whole.w / columns as f32, h: whole.h / rows as f32, ..whole };
        // An empty place at the end is picture wasted.
        scale(extent, inner(area, text)) * count as f64 / (columns * rows) as f64
    };
    let columns = (1..=count).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(1);
    (columns, count.div_ceil(columns).max(1))
}

fn panel(pixmap: &mut Pixmap, area: Area, view: &View, pens: &Pens, moment: &Moment, range: f64, text: f32) {
    let gutter = 0.3 * text;
    let card =
        Rect::from_xywh(area.x + gutter, area.y + gutter, area.w - 2.0 * gutter, area.h - 2.0 * gutter);
    if let Some(card) = card {
        pixmap.fill_rect(card, &paint(PANEL), Transform::identity(), None);
    }
    let inner = inner(area, text);
    let px = scale(view.extent, inner);
    let centre = (f64::from(inner.x + 0.5 * inner.w), f64::from(inner.y + 0.5 * inner.h));
    let place = |point: [f64; 3]| {
        let seen = view.camera.see(point);
        let x = centre.0 + px * (seen.x - view.middle.0);
        let y = centre.1 + px * (seen.y - view.middle.1);
        Seen { x, y, ..seen }
    };
    let mut lines: Vec<_> = moment.lines().map(|(ends, strain)| (ends.map(place), strain)).collect();
    let width = (px * pens.width).clamp(0.3, f64::from(0.23 * text));
    let bead = (px * pens.bead).clamp(0.75 * width, f64::from(0.5 * text));
    lines.sort_by(|(a, _), (b, _)| (b[0].depth + b[1].depth).total_cmp(&(a[0].depth + a[1].depth)));
    let fog = |depth: f64| {
        let radius = if view.camera.radius > 0.0 { view.camera.radius } else { 1.0 };
        (FOG * (0.5 + 0.5 * depth / radius)).clamp(0.0, 1.0) as f32
    };
    let mut pen = Stroke { line_cap: LineCap::Round, ..Stroke::default() };
    for ([a, b], strain) in &lines {
        let (from, to) = ((a.x as f32, a.y as f32), (b.x as f32, b.y as f32));
        let tone = mix(strain_colour(strain / range), PANEL, fog(0.5 * (a.depth + b.depth)));
        pen.width = (width * 0.5 * (a.scale + b.scale)) as f32;
        if pen.width <= 1.0 {
            hairline(pixmap, from, to, pen.width, tone);
            continue;
        }
        let mut path = PathBuilder::new();
        path.move_to(from.0, from.1);
        path.line_to(to.0, to.1);
        if let Some(line) = path.finish() {
            pixmap.stroke_path(&line, &paint(tone), &pen, Transform::identity(), None);
        }
    }
    for (point, pinned) in moment.dots() {
        let at = place(point);
        let radius = at.scale * if pinned { (1.6 * width).max(bead).max(1.8) } else { bead };
        if let Some(circle) = PathBuilder::from_circle(at.x as f32, at.y as f32, radius as f32) {
            let tone = paint(if pinned { PINNED } else { RELAXED });
            pixmap.fill_path(&circle, &tone, FillRule::Winding, Transform::identity(), None);
        }
    }
}

/// The colour bar: what blue and red stand for, centred at the bottom.
fn bar(pixmap: &mut Pixmap, area: Area, range: f64, text: f32) {
    let (w, h) = (18.0 * text, 0.9 * text);
    // On whole px: two that share a px would both be blended with what is behind them.
    let (left, top) = ((area.x + 0.5 * (area.w - w)).round(), (area.y + 0.5 * (area.h - h)).round());
    let steps = w.ceil().max(1.0) as usize;
    for step in 0..steps {
        let x = left + step as f32;
        let value = 2.0 * (step as f64 + 0.5) / steps as f64 - 1.0;
        if let Some(rect) = Rect::from_xywh(x, top, 1.0, h) {
            pixmap.fill_rect(rect, &paint(strain_colour(value)), Transform::identity(), None);
        }
    }
    let number = percent(range);
    let paint = paint(TEXT);
    let low = format!("strain  -{number}");
    let y = top + 0.5 * (h - text);
    stroke_font::draw(pixmap, &low, (left - text - stroke_font::width(&low, text), y), text, &paint);
    stroke_font::draw(pixmap, &format!("+{number}"), (left + w + text, y), text, &paint);
}

/// Just enough decimals to tell neighbouring moments apart.
fn decimals(moments: &[&Moment]) -> usize {
    let gaps = moments.windows(2).map(|pair| pair[1].time - pair[0].time).filter(|&gap| gap > 0.0);
    let least = gaps.fold(f64::INFINITY, f64::min);
    if least.is_finite() { (1.0 - least.log10()).ceil().clamp(0.0, 9.0) as usize } else { 2 }
}
