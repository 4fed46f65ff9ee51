//! The energy plot: T, V of the springs, V of gravity and their sum over time.
//!
//! SVG, because a plot of four lines should stay sharp at any size and needs no font at hand when it is written.

use std::io;
use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::{Energy, safe};

/// Size of the picture in px.
const SIZE: (u32, u32) = (960, 540);
/// plotters rounds to whole units. With units of a quarter px smooth curves stay smooth.
const FINE: u32 = 4;
/// The most ticks that an axis gets.
const TICKS: usize = 10;
const INK: RGBColor = RGBColor(0x1f, 0x29, 0x33);
const FAINT: RGBColor = RGBColor(0xe4, 0xe7, 0xeb);

struct Curve {
    name: &'static str,
    colour: RGBColor,
    width: u32,
    value: fn(&Energy) -> f64,
}

/// In the order of drawing: the total lies on top.
const CURVES: [Curve; 4] = [
    Curve { name: "kinetic T", colour: RGBColor(0x22, 0x6d, 0xc9), width: 7, value: |e| e.kinetic },
    Curve { name: "springs V", colour: RGBColor(0xd6, 0x45, 0x0f), width: 7, value: |e| e.springs },
    Curve { name: "gravity V", colour: RGBColor(0x2b, 0x96, 0x4a), width: 7, value: |e| e.gravity },
    Curve { name: "total T + V", colour: INK, width: 9, value: |e| e.total },
];

/// Writes the plot. Values that are not finite are skipped; without samples the axes stand alone and say so.
///
/// # Errors
/// The file system's; then no file is left.
pub fn write(path: &Path, title: &str, samples: &[Energy]) -> io::Result<()> {
    let picture = svg(title, samples)?;
    safe::write_file(path, |out| out.write_all(picture.as_bytes()))
}

/// The plot as the text of an SVG file.
///
/// # Errors
/// None that samples can cause; what the plotting library reports.
pub fn svg(title: &str, samples: &[Energy]) -> io::Result<String> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, (SIZE.0 * FINE, SIZE.1 * FINE)).into_drawing_area();
    draw(&root, title, samples).map_err(|error| io::Error::other(format!("energy plot: {error}")))?;
    drop(root);
    let fine = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINE, SIZE.1 * FINE);
    Ok(text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1))
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(root: &DrawingArea<SVGBackend<'_>, Shift>, title: &str, samples: &[Energy]) -> Drawn {
    let curves = CURVES.map(|curve| {
        let points = samples.iter().map(|sample| (sample.time, (curve.value)(sample)));
        let points: Vec<_> = points.filter(|(t, e)| t.is_finite() && e.is_finite()).collect();
        (curve, thin(&points))
    });
    let all = || curves.iter().flat_map(|(_, points)| points);
    let time = Axis::over(all().map(|point| point.0), "s", 0.0);
    // A little air, so that no curve runs along the frame.
    let energy = Axis::over(all().map(|point| point.1), "J", 0.04);

    root.fill(&WHITE)?;
    let px = |px: u32| px * FINE;
    let at = |x: u32, y: u32| (px(x) as i32, px(y) as i32);
    let font = |size: u32, colour: &RGBColor| ("sans-serif", px(size)).into_font().color(colour);
    root.draw_text(title, &font(22, &INK), at(80, 16))?;

    let mut chart = ChartBuilder::on(root)
        .margin_top(px(74))
        .margin_right(px(30))
        .margin_left(px(14))
        .margin_bottom(px(10))
        .x_label_area_size(px(46))
        .y_label_area_size(px(66))
        .build_cartesian_2d(time.range.clone(), energy.range.clone())?;
    chart
        .configure_mesh()
        .axis_style(RGBColor(0x9a, 0xa5, 0xb1).stroke_width(FINE))
        .bold_line_style(FAINT.stroke_width(FINE))
        .max_light_lines(0)
        .set_all_tick_mark_size(px(5))
        .x_labels(TICKS)
        .y_labels(TICKS)
        .x_desc(format!("time ({})", time.unit))
        .y_desc(format!("energy ({})", energy.unit))
        .x_label_formatter(&|&value| time.label(value))
        .y_label_formatter(&|&value| energy.label(value))
        .label_style(font(15, &INK))
        .axis_desc_style(font(17, &INK))
        .draw()?;

    let mut x = 80;
    for (curve, points) in &curves {
        let scaled = points.iter().map(|&(t, e)| (t / time.factor, e / energy.factor));
        let style = curve.colour.stroke_width(curve.width);
        if points.len() == 1 {
            // A line through one sample has no length.
            chart.draw_series(scaled.map(|point| Circle::new(point, 3 * FINE, curve.colour.filled())))?;
        } else {
            chart.draw_series(LineSeries::new(scaled, style))?;
        }
        // Above the frame: inside it, some run would have its curve under the legend.
        root.draw(&PathElement::new(vec![at(x, 56), at(x + 26, 56)], style))?;
        root.draw_text(curve.name, &font(16, &INK), at(x + 33, 48))?;
        x += 52 + 8 * curve.name.len() as u32;
    }
    if all().next().is_none() {
        root.draw_text("no samples", &font(20, &INK), at(SIZE.0 / 2 - 20, SIZE.1 / 2 - 20))?;
    }
    root.present()?;
    Ok(())
}

/// At most two points for each px across: of a long run each stretch keeps its lowest and its highest value, in
/// their order, so that no peak is lost.
fn thin(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let stretch = points.len().div_ceil(SIZE.0 as usize);
    if stretch <= 2 {
        return points.to_vec();
    }
    let mut kept = Vec::new();
    for part in points.chunks(stretch) {
        let by_energy = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        if let (Some(&low), Some(&high)) = (part.iter().min_by(by_energy), part.iter().max_by(by_energy)) {
            kept.extend(if low.0 <= high.0 { [low, high] } else { [high, low] });
        }
    }
    // The last sample is where the run ended; it counts even if it is no extreme.
    kept.extend(points.last());
    kept
}

/// A range of values with the power of 1000 that makes its labels short: 0.0000021 J are read as 2.1 µJ.
struct Axis {
    range: Range<f64>,
    factor: f64,
    unit: String,
    decimals: usize,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, unit: &str, air: f64) -> Self {
        let (low, high) = values.fold((f64::INFINITY, -f64::INFINITY), |(l, h), v| (v.min(l), v.max(h)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let largest = low.abs().max(high.abs());
        let thousands = if largest < 1e-290 { 0 } else { (largest.log10() / 3.0 + 1e-12).floor() as i32 };
        // 0.2 s and 0.05 J need no prefix.
        let thousands = if thousands == -1 && largest >= 0.05 { 0 } else { thousands };
        let factor = 10_f64.powi(3 * thousands);
        let unit = match ["p", "n", "µ", "m", "", "k", "M", "G", "T"].get((thousands + 4) as usize) {
            Some(prefix) => format!("{prefix}{unit}"),
            None => format!("10^{} {unit}", 3 * thousands),
        };
        let (mut low, mut high) = (low / factor, high / factor);
        let largest = largest / factor;
        // Constant but for rounding: labels could not tell the ticks apart.
        if high - low <= 1e-9 * largest || largest < 1e-290 {
            let half = if largest < 1e-290 { 1.0 } else { 0.1 * largest };
            (low, high) = (low - half, high + half);
        }
        let air = air * (high - low);
        let mut axis = Self { range: low - air..high + air, factor, unit, decimals: 0 };
        axis.decimals = axis.least_decimals();
        axis
    }

    /// As many decimals as the ticks have: 0.25, 0.50, but 0.2, 0.4.
    fn least_decimals(&self) -> usize {
        let ticks = RangedCoordf64::from(self.range.clone()).key_points(TICKS);
        let step = ticks.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let whole = |decimals: &usize| {
            let scaled = step * 10_f64.powi(*decimals as i32);
            (scaled - scaled.round()).abs() < 1e-3 && scaled > 0.5
        };
        (0..12).find(whole).unwrap_or(12)
    }

    fn label(&self, value: f64) -> String {
        // Rounding may leave a −0.
        let text = format!("{:.*}", self.decimals, value);
        if text.bytes().any(|byte| matches!(byte, b'1'..=b'9')) {
            text.replace('-', "−")
        } else {
            text.replace('-', "")
        }
    }
}
