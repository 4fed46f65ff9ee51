//! How bold lines are, and lines thinner than a px.

use tiny_skia::{Pixmap, PremultipliedColorU8};

use super::camera::Camera;
use super::colour::{Rgb, quantile};
use super::picture::Moment;

/// Sizes in metres at the centre's depth, the same in all moments.
pub(super) struct Pens {
    pub(super) width: f64,
    /// Radius of a particle's dot.
    pub(super) bead: f64,
}

impl Pens {
    /// As bold as the motion allows: so that the springs of a moment together could cover four fifths of the area
    /// they lie in. In a lattice, where they cross, that is thin; in a rope it would be a beam, so a panel has its
    /// own limits.
    pub(super) fn of(camera: &Camera, extent: (f64, f64), moments: &[&Moment]) -> Self {
        let mut lengths = Vec::new();
        let (mut crowd, mut least) = (f64::INFINITY, 0.1 * extent.0.max(extent.1));
        least *= least;
        for moment in moments {
            let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            let mut sum = 0.0;
            for (ends, _) in moment.lines() {
                let [a, b] = ends.map(|point| camera.see(point));
                for (axis, value) in [(0, a.x), (1, a.y), (0, b.x), (1, b.y)] {
                    low[axis] = low[axis].min(value);
                    high[axis] = high[axis].max(value);
                }
                lengths.push((a.x - b.x).hypot(a.y - b.y));
                sum += (a.x - b.x).hypot(a.y - b.y);
            }
            if sum > 0.0 {
                crowd = crowd.min(((high[0] - low[0]) * (high[1] - low[1])).max(least) / sum);
            }
        }
        let length = quantile(&mut lengths, 0.5);
        // Particles without any spring are all there is to see.
        let bead = if length > 0.0 { 0.12 * length } else { f64::INFINITY };
        Self { width: 0.8 * crowd, bead }
    }
}

/// A line at most a px wide, as a row of soft dots: what a path would give in a fraction of the time, and down to
/// lines shorter than a px, which a large mesh has by the hundred thousand.
pub(super) fn hairline(pixmap: &mut Pixmap, a: (f32, f32), b: (f32, f32), width: f32, tone: Rgb) {
    let length = (b.0 - a.0).hypot(b.1 - a.1);
    let dots = length.ceil().max(1.0);
    // All dots together cover the line's area.
    let cover = (width * length / dots).min(1.0);
    for dot in 0..dots as u32 {
        let along = (dot as f32 + 0.5) / dots;
        let (x, y) = (a.0 + along * (b.0 - a.0) - 0.5, a.1 + along * (b.1 - a.1) - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right, down) = (x - left, y - top);
        for (dx, dy, share) in [
            (0.0, 0.0, (1.0 - right) * (1.0 - down)),
            (1.0, 0.0, right * (1.0 - down)),
            (0.0, 1.0, (1.0 - right) * down),
            (1.0, 1.0, right * down),
        ] {
            blend(pixmap, (left + dx, top + dy), tone, cover * share);
        }
    }
}

fn blend(pixmap: &mut Pixmap, (x, y): (f32, f32), tone: Rgb, share: f32) {
    let (width, height) = (pixmap.width(), pixmap.height());
    if !(x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32) {
        return;
    }
    let index = y as usize * width as usize + x as usize;
    if let Some(pixel) = pixmap.pixels_mut().get_mut(index) {
        let under = [pixel.red(), pixel.green(), pixel.blue()].map(f32::from);
        let [r, g, b] =
            std::array::from_fn(|c| (under[c] + share * (255.0 * tone[c] - under[c])).round() as u8);
        // The background is opaque, so every colour is premultiplied.
        *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255).unwrap_or(*pixel);
    }
}
