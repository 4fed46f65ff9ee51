//! Strain as colour: blue where compressed, light grey where relaxed, red where stretched.
//!
//! The scale is symmetric around 0, so that grey always means "at rest length".

use tiny_skia::{Color, Paint};

use super::picture::Moment;

/// Red, green and blue in [0, 1].
pub(super) type Rgb = [f32; 3];

const COMPRESSED: Rgb = [0.16, 0.48, 1.0];
pub(super) const RELAXED: Rgb = [0.80, 0.82, 0.85];
const STRETCHED: Rgb = [1.0, 0.23, 0.15];
/// Where neither end is larger, strains below this are rounding, not motion.
const LEAST_RANGE: f64 = 1e-6;

/// −1 blue, 0 grey, 1 red; beyond them the ends, and grey for what is no number.
pub(super) fn strain_colour(value: f64) -> Rgb {
    let end = if value < 0.0 { COMPRESSED } else { STRETCHED };
    mix(RELAXED, end, if value.is_nan() { 0.0 } else { value.abs().min(1.0) as f32 })
}

pub(super) fn mix(from: Rgb, to: Rgb, share: f32) -> Rgb {
    std::array::from_fn(|channel| from[channel] + share * (to[channel] - from[channel]))
}

pub(super) fn colour([r, g, b]: Rgb) -> Color {
    Color::from_rgba(r, g, b, 1.0).unwrap_or(Color::BLACK)
}

pub(super) fn paint(tone: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(tone));
    paint
}

/// Half the width of the colour scale. Not the largest strain: the few springs at a pin would leave all others grey.
pub(super) fn strain_range(moments: &[&Moment]) -> f64 {
    let strains = moments.iter().flat_map(|moment| moment.lines()).map(|(_, strain)| strain.abs());
    let mut strains: Vec<f64> = strains.filter(|strain| strain.is_finite()).collect();
    let range = quantile(&mut strains, 0.96).max(LEAST_RANGE);
    // Two digits are what the label shows.
    let step = 10_f64.powf(range.log10().floor() - 1.0);
    (range / step).ceil() * step
}

/// The value below which a share of the values lies; 0 without values.
pub(super) fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let index = (share * (values.len() - 1) as f64).round() as usize;
    *values.select_nth_unstable_by(index, f64::total_cmp).1
}

/// A strain as a label.
pub(super) fn percent(range: f64) -> String {
    let percent = 100.0 * range;
    if percent < 1e6 {
        format!("{percent:.*}%", (1.0 - percent.log10().floor()).max(0.0) as usize)
    } else {
        format!("{percent:.1e}%")
    }
}
