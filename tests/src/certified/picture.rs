//! upper/lower against the condition number: median and nine in ten of all solves, per precision. Both axes logarithmic.

use std::io;

use plotters::prelude::*;

use super::seen::{Record, Seen, quantile};
use super::table::{LAST, row};

/// Size of the picture in px.
const SIZE: (u32, u32) = (900, 480);
/// plotters rounds to whole units: a quarter of a px.
const FINE: u32 = 4;
const INK: RGBColor = RGBColor(0x1f, 0x29, 0x33);
const FAINT: RGBColor = RGBColor(0xe4, 0xe7, 0xeb);
/// The highest ratio that is drawn: above it, and where more than half have no lower bound, a curve ends.
const TOP: f64 = 20.0;

/// Name, precision (`f32`?), part, what, colour.
type Curve = (&'static str, bool, f64, fn(&Record) -> f64, RGBColor);

const CURVES: [Curve; 6] = [
    ("f64, upper/lower, median", false, 0.5, Record::ratio, RGBColor(0x1f, 0x6f, 0xc9)),
    ("f64, upper/lower, nine in ten", false, 0.9, Record::ratio, RGBColor(0x9c, 0xc3, 0xee)),
    ("f64, upper/true, median", false, 0.5, |r| r.upper / r.energy, RGBColor(0x2b, 0x96, 0x4a)),
    ("f32, upper/lower, median", true, 0.5, Record::ratio, RGBColor(0xd9, 0x48, 0x0f)),
    ("f32, upper/lower, nine in ten", true, 0.9, Record::ratio, RGBColor(0xf0, 0xb8, 0x9c)),
    ("f32, upper/true, median", true, 0.5, |r| r.upper / r.energy, RGBColor(0xb5, 0x87, 0x00)),
];

type Drawn = Result<(), Box<dyn std::error::Error>>;

/// The picture as the text of an SVG file.
///
/// # Errors
/// What the plotting library reports.
pub fn svg(seen: &Seen) -> io::Result<String> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, (SIZE.0 * FINE, SIZE.1 * FINE)).into_drawing_area();
    draw(&root, seen).map_err(|error| io::Error::other(format!("picture: {error}")))?;
    drop(root);
    let fine = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINE, SIZE.1 * FINE);
    Ok(text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1))
}

fn px(px: u32) -> u32 {
    px * FINE
}

/// (decade + ½, log₁₀ of the ratio)
fn points(seen: &Seen, single: bool, part: f64, value: fn(&Record) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for decade in 0..=LAST {
        let fits = |r: &&Record| r.single == single && row(r.decade) == decade && r.above;
        let mut ratios: Vec<f64> = seen.solves.iter().filter(fits).map(value).collect();
        // Fewer say nothing of a tenth.
        if ratios.len() >= 50 {
            points.push((decade as f64 + 0.5, quantile(&mut ratios, part).log10()));
        }
    }
    points.retain(|point| point.1 <= TOP);
    points
}

fn draw(root: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>, seen: &Seen) -> Drawn {
    root.fill(&WHITE)?;
    let font = |size: u32| ("sans-serif", px(size)).into_font().color(&INK);
    let at = |x: u32, y: u32| (px(x) as i32, px(y) as i32);
    root.draw_text("How far apart are the bounds on a solve's error?", &font(20), at(70, 14))?;
    let mut chart = ChartBuilder::on(root)
        .margin_top(px(46))
        .margin_right(px(240))
        .margin_left(px(12))
        .margin_bottom(px(10))
        .x_label_area_size(px(44))
        .y_label_area_size(px(56))
        .build_cartesian_2d(0.0..LAST as f64 + 1.0, 0.0..TOP)?;
    chart
        .configure_mesh()
        .axis_style(RGBColor(0x9a, 0xa5, 0xb1).stroke_width(FINE))
        .bold_line_style(FAINT.stroke_width(FINE))
        .max_light_lines(0)
        .x_labels(LAST + 2)
        .y_labels(TOP as usize + 1)
        .x_desc("condition number of A (all beyond 1e16 in the last place)")
        .y_desc("upper/lower")
        .x_label_formatter(&|&x| format!("1e{x:.0}"))
        .y_label_formatter(&|&y| format!("1e{y:.0}"))
        .label_style(font(13))
        .axis_desc_style(font(15))
        .draw()?;
    for (k, (name, single, part, value, colour)) in CURVES.into_iter().enumerate() {
        let style = colour.stroke_width(px(2));
        let own = points(seen, single, part, value);
        chart.draw_series(LineSeries::new(own.iter().copied(), style))?;
        chart.draw_series(own.into_iter().map(|point| Circle::new(point, px(3), colour.filled())))?;
        let (left, y) = (SIZE.0 - 228, 70 + 26 * k as u32);
        root.draw(&PathElement::new([at(left, y), at(left + 28, y)], style))?;
        root.draw_text(name, &font(13), at(left + 36, y - 7))?;
    }
    root.present()?;
    Ok(())
}
