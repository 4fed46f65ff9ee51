//! Growth as a picture: time and memory of a step against the number of particles, both axes logarithmic.

use std::error::Error;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::family::{Family, Point};

const SIZE: (u32, u32) = (1100, 500);
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x22, 0x6d, 0xc9),
    RGBColor(0xd6, 0x45, 0x0f),
    RGBColor(0x2b, 0x96, 0x4a),
    RGBColor(0x8a, 0x3f, 0xa0),
    RGBColor(0xb0, 0x80, 0x10),
    RGBColor(0x1f, 0x29, 0x33),
];

/// The plot as the text of an SVG file.
pub(crate) fn svg(families: &[Family]) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let panels = root.split_evenly((1, 2));
        panel(&panels[0], "ms per step", families, |p| p.ms, |f| f.time)?;
        panel(&panels[1], "MB of workspace", families, |p| p.workspace_bytes as f64 / 1e6, |f| f.memory)?;
        root.present()?;
    }
    Ok(text)
}

/// From a little below the smallest to a little above the largest.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) =
        values.filter(|x| *x > 0.0).fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), x| (l.min(x), h.max(x)));
    if low <= high { low / 1.5..high * 1.5 } else { 0.1..1.0 }
}

/// The same with room above for a legend of so many lines: about 16 of a panel's 430 pixels each.
fn under_a_legend(range: Range<f64>, lines: usize) -> Range<f64> {
    let share = (0.04 * (lines + 1) as f64).min(0.7);
    let span = (range.end / range.start).powf(1.0 / (1.0 - share));
    range.start..range.start * span
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    what: &str,
    families: &[Family],
    value: fn(&Point) -> f64,
    power: fn(&Family) -> Option<f64>,
) -> Result<(), Box<dyn Error>> {
    let points = || families.iter().flat_map(|family| &family.points);
    let x = range(points().map(|p| p.particles as f64));
    let y = under_a_legend(range(points().map(value)), families.len());
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    let label = |v: &f64| if *v >= 1e4 { format!("{v:.0e}") } else { format!("{v}") };
    chart
        .configure_mesh()
        .max_light_lines(0)
        .x_desc("particles")
        .y_desc(what)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .draw()?;
    for (family, colour) in families.iter().zip(COLOURS.iter().cycle()) {
        let at = || family.points.iter().map(|p| (p.particles as f64, value(p)));
        let law = power(family).map_or(String::new(), |p| format!(": n^{p:.2}"));
        chart
            .draw_series(LineSeries::new(at(), colour.stroke_width(2)))?
            .label(format!("{}{law}", family.label.replace("hooke ", "")))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        chart.draw_series(at().map(|point| Circle::new(point, 3, colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .draw()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_end_below_the_legend() {
        let range = under_a_legend(1.0..100.0, 4);
        let top = 100f64.ln() / range.end.ln();
        assert!((top - 0.8).abs() < 1e-12 && range.start == 1.0, "{top}");
    }
}
