//! The diagram: errors against times, both axes logarithmic, a curve for each method. Down and to the left is better.

use std::io;
use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::prelude::*;

use super::curve::{Curve, Steps};
use super::diagram::Diagram;
use super::study::Study;
use crate::output::safe;
use crate::run::integrator::INTEGRATORS;

/// Size of the picture in px.
const SIZE: (u32, u32) = (1020, 600);
/// plotters rounds to whole units: a quarter of a px.
const FINE: u32 = 4;
/// Room for the legend, px.
const LEGEND: u32 = 210;
const INK: RGBColor = RGBColor(0x1f, 0x29, 0x33);
const FAINT: RGBColor = RGBColor(0xe4, 0xe7, 0xeb);
/// A colour for each method, in the order of [`INTEGRATORS`].
const COLOURS: [RGBColor; 9] = [
    RGBColor(0x1f, 0x6f, 0xc9),
    RGBColor(0xd9, 0x48, 0x0f),
    RGBColor(0x2b, 0x96, 0x4a),
    RGBColor(0x8a, 0x3f, 0xa0),
    RGBColor(0x12, 0x9a, 0xa8),
    RGBColor(0xb5, 0x87, 0x00),
    RGBColor(0x1f, 0x29, 0x33),
    RGBColor(0xd6, 0x33, 0x84),
    RGBColor(0x86, 0x8e, 0x96),
];

/// For curves that are not Hooke's.
const OUTSIDE: [RGBColor; 2] = [RGBColor(0x8c, 0x5a, 0x3c), RGBColor(0xc0, 0x39, 0x2b)];

type Drawn = Result<(), Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Writes the diagram.
///
/// # Errors
/// The file system's; then no file is left.
pub fn write(path: &Path, study: &Study, diagram: &Diagram) -> io::Result<()> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, (SIZE.0 * FINE, SIZE.1 * FINE)).into_drawing_area();
    draw(&root, study, diagram).map_err(|error| io::Error::other(format!("diagram: {error}")))?;
    drop(root);
    let fine = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINE, SIZE.1 * FINE);
    let text = text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1);
    safe::write_file(path, |out| out.write_all(text.as_bytes()))
}

fn px(px: u32) -> u32 {
    px * FINE
}

fn at(x: u32, y: u32) -> (i32, i32) {
    (px(x) as i32, px(y) as i32)
}

fn draw(root: &Area<'_>, study: &Study, diagram: &Diagram) -> Drawn {
    root.fill(&WHITE)?;
    let font = |size: u32| ("sans-serif", px(size)).into_font().color(&INK);
    let title = format!("{}: position error after {} s against time", diagram.scene, diagram.seconds);
    root.draw_text(&title, &font(22), at(80, 14))?;
    root.draw_text(&format!("reference: {}", diagram.certificate()), &font(12), at(80, 44))?;

    let points = |name: &str| -> Vec<(f64, f64)> {
        let own = diagram.runs.iter().filter(|row| row.curve == name).filter_map(|row| row.point());
        own.map(|(ms, error)| (ms.log10(), error.log10())).collect()
    };
    let looks = looks(study, diagram);
    let all: Vec<(f64, f64)> = looks.iter().flat_map(|look| points(&look.name)).collect();
    let (x, y) = (Axis::over(all.iter().map(|p| p.0)), Axis::over(all.iter().map(|p| p.1)));
    let mut chart = ChartBuilder::on(root)
        .margin_top(px(68))
        .margin_right(px(LEGEND))
        .margin_left(px(12))
        .margin_bottom(px(10))
        .x_label_area_size(px(46))
        .y_label_area_size(px(66))
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .axis_style(RGBColor(0x9a, 0xa5, 0xb1).stroke_width(FINE))
        .bold_line_style(FAINT.stroke_width(FINE))
        .max_light_lines(0)
        .set_all_tick_mark_size(px(5))
        .x_labels(x.ticks.len())
        .y_labels(y.ticks.len())
        .x_desc("time of the steps (ms)")
        .y_desc("error of the worst particle (m)")
        .x_label_formatter(&|&value| plain(value))
        .y_label_formatter(&|&value| power(value))
        .label_style(font(14))
        .axis_desc_style(font(16))
        .draw()?;

    let floor = diagram.reference.certain_from.log10();
    if diagram.dropped > 0 && y.range.contains(&floor) {
        let ends = [(x.range.start, floor), (x.range.end, floor)];
        let (dash, gap) = (px(3), px(3));
        chart.draw_series(DashedLineSeries::new(ends, dash, gap, INK.stroke_width(FINE)))?;
    }
    let mut row = 0;
    for look in &looks {
        let own = points(&look.name);
        if own.is_empty() {
            continue;
        }
        let (style, colour) = (look.colour.stroke_width(px(2)), look.colour);
        if look.dashed {
            chart.draw_series(DashedLineSeries::new(own.iter().copied(), px(7), px(4), style))?;
        } else {
            chart.draw_series(LineSeries::new(own.iter().copied(), style))?;
        }
        let own = own.into_iter();
        match look.mark {
            Mark::Ring => {
                chart.draw_series(own.map(|p| Circle::new(p, px(4), colour.stroke_width(px(2)))))?
            }
            Mark::Cross => {
                chart.draw_series(own.map(|p| Cross::new(p, px(5), colour.stroke_width(px(3)))))?
            }
            Mark::Triangle => {
                chart.draw_series(own.map(|p| TriangleMarker::new(p, px(6), colour.filled())))?
            }
            Mark::Disc => chart.draw_series(own.map(|p| Circle::new(p, px(4), colour.filled())))?,
        };
        legend(root, look, row)?;
        row += 1;
    }
    if all.is_empty() {
        root.draw_text("no run has an error that is certain", &font(18), at(250, SIZE.1 / 2))?;
    }
    root.present()?;
    Ok(())
}

/// What a curve's points are drawn as.
#[derive(Clone, Copy)]
enum Mark {
    /// An implicit method
    Disc,
    /// An explicit method
    Triangle,
    /// Chosen steps
    Ring,
    /// Steps cut into substeps
    Cross,
}

/// How a curve is drawn.
struct Look {
    name: String,
    colour: RGBColor,
    dashed: bool,
    mark: Mark,
}

/// Of Hooke's curves, and of those that somebody else has added to the runs.
fn looks(study: &Study, diagram: &Diagram) -> Vec<Look> {
    let own = |curve: &Curve| {
        let mark = match curve.steps {
            Steps::Chosen => Mark::Ring,
            Steps::Cut => Mark::Cross,
            Steps::Fixed if curve.method.is_explicit() => Mark::Triangle,
            Steps::Fixed => Mark::Disc,
        };
        Look { name: curve.name(), colour: colour(*curve), dashed: curve.steps == Steps::Chosen, mark }
    };
    let mut looks: Vec<Look> = study.curves.iter().map(own).collect();
    for row in &diagram.runs {
        if looks.iter().all(|look| look.name != row.curve) {
            let colour = OUTSIDE[(looks.len() - study.curves.len()) % OUTSIDE.len()];
            looks.push(Look { name: row.curve.clone(), colour, dashed: true, mark: Mark::Ring });
        }
    }
    looks
}

/// A curve's line and name, beside the frame.
fn legend(root: &Area<'_>, look: &Look, row: u32) -> Drawn {
    let (left, y) = (SIZE.0 - LEGEND + 14, 80 + 26 * row);
    let (middle, colour) = (at(left + 15, y), look.colour);
    let style = colour.stroke_width(px(2));
    if look.dashed {
        for part in 0..3 {
            root.draw(&PathElement::new([at(left + 11 * part, y), at(left + 11 * part + 7, y)], style))?;
        }
    } else {
        root.draw(&PathElement::new([at(left, y), at(left + 30, y)], style))?;
    }
    match look.mark {
        Mark::Ring => root.draw(&Circle::new(middle, px(4), colour.stroke_width(px(2))))?,
        Mark::Cross => root.draw(&Cross::new(middle, px(5), colour.stroke_width(px(3))))?,
        Mark::Triangle => root.draw(&TriangleMarker::new(middle, px(6), colour.filled()))?,
        Mark::Disc => root.draw(&Circle::new(middle, px(4), colour.filled()))?,
    }
    let font = ("sans-serif", px(14)).into_font().color(&INK);
    root.draw_text(&look.name, &font, at(left + 38, y - 8))?;
    Ok(())
}

fn colour(curve: Curve) -> RGBColor {
    let place = INTEGRATORS.iter().position(|(_, method)| *method == curve.method).unwrap_or(0);
    COLOURS[place % COLOURS.len()]
}

/// A logarithmic axis: the range of log₁₀, and where its ticks are.
#[derive(Clone)]
struct Axis {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (-1.0, 1.0) };
        let air = 0.04 * (high - low) + 0.08;
        let range = low - air..high + air;
        // On a short axis the powers of ten alone would be too few.
        let digits: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let powers = range.start.floor() as i32..=range.end.ceil() as i32;
        let ticks = powers.flat_map(|power| digits.iter().map(move |digit| f64::from(power) + digit.log10()));
        Self { ticks: ticks.filter(|tick| range.contains(tick)).collect(), range }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// 0.05, 1, 200, 10⁵
fn plain(log: f64) -> String {
    match log.round() as i32 {
        -3..=4 => {
            let value = 10_f64.powf(log);
            let decimals = (-(log + 1e-9).floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => power(log),
    }
}

/// 10⁻³, 2·10⁻³
fn power(log: f64) -> String {
    let exponent = (log + 1e-9).floor();
    let digit = 10_f64.powf(log - exponent).round();
    let raised: String = format!("{exponent}")
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
        })
        .collect();
    if digit == 1.0 { format!("10{raised}") } else { format!("{digit}·10{raised}") }
}
