//! The motion as one picture: several moments side by side, springs coloured by their strain.
//!
//! PNG, because a hundred thousand lines are smaller as pixels than as paths, and every page shows it.
//! Moments are chosen while the run goes on, when nobody knows yet how many frames there will be: every `stride`-th
//! is kept, and the stride doubles whenever too many are.

use std::io;
use std::path::Path;
use std::sync::Arc;

use super::{Frame, canvas, safe};

/// Springs drawn of a moment. More make a picture no clearer.
const MAX_SPRINGS: usize = 300_000;
/// Frames kept for each moment shown: enough to choose moments that look evenly spaced.
const KEPT: usize = 6;
/// Up to so many particles each one gets a dot; in a crowd only those that are pinned or have no spring.
const FEW: usize = 64;

/// The springs to draw, by number and ends. Shared by all moments between which nothing breaks.
#[derive(Debug)]
struct Network {
    particles: usize,
    springs: usize,
    drawn: Vec<(usize, [usize; 2])>,
    /// Particles drawn as dots: those without a spring, and all where they are few.
    dotted: Vec<usize>,
}

/// What a picture needs to know of a frame. f32 is exact to a hundredth of a px; NaN where there is no such point.
#[derive(Debug)]
pub(super) struct Moment {
    pub(super) time: f64,
    network: Arc<Network>,
    points: Vec<[f32; 3]>,
    strain: Vec<f32>,
    pinned: Vec<usize>,
}

/// A picture strip being collected.
#[derive(Debug)]
pub struct Strip {
    size: (u32, u32),
    moments: usize,
    origin: Option<[f64; 3]>,
    network: Option<Arc<Network>>,
    kept: Vec<Moment>,
    /// The latest frame, where the stride passes over it: the end of a motion is always shown.
    last: Option<Moment>,
    stride: usize,
    added: usize,
}

impl Default for Strip {
    fn default() -> Self {
        Self::new(1800, 1100, 6)
    }
}

impl Strip {
    /// An empty strip of `moments` pictures (at least one) in a file of `width` × `height` px.
    #[must_use]
    pub fn new(width: u32, height: u32, moments: usize) -> Self {
        Self {
            size: (width, height),
            moments: moments.max(1),
            origin: None,
            network: None,
            kept: Vec::new(),
            last: None,
            stride: 1,
            added: 0,
        }
    }

    /// Takes note of a frame. With as many calls as moments each of them is shown; with more, the first, the last
    /// and an even choice between. Points that are not finite are left out, with the springs that end in them.
    ///
    /// # Errors
    /// Lists that contradict each other.
    pub fn add(&mut self, time: f64, frame: &Frame<'_>) -> io::Result<()> {
        frame.check()?;
        // Relative to some point of the motion, so that f32 is enough far from the origin too.
        let first = || frame.positions.iter().copied().find(|p| p.iter().all(|x| x.is_finite()));
        self.origin = self.origin.or_else(first);
        let network = match self.network.take() {
            Some(network) if network.is_of(frame) => network,
            _ => Arc::new(Network::of(frame)),
        };
        self.network = Some(Arc::clone(&network));
        let moment = Moment::of(time, frame, self.origin.unwrap_or_default(), network);
        if self.added.is_multiple_of(self.stride) {
            self.kept.push(moment);
            self.last = None;
        } else {
            self.last = Some(moment);
        }
        self.added += 1;
        if self.kept.len() > KEPT * self.moments {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
        }
        Ok(())
    }

    /// Draws the strip and writes it as PNG. Without frames it is an empty picture.
    ///
    /// # Errors
    /// A size of zero or beyond memory, or the file system's error; then no file is left.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        let all: Vec<&Moment> = self.kept.iter().chain(&self.last).collect();
        let shown: Vec<&Moment> = if all.len() <= self.moments {
            all
        } else if self.moments == 1 {
            all.last().copied().into_iter().collect()
        } else {
            let gaps = self.moments - 1;
            (0..=gaps).map(|i| all[(i * (all.len() - 1) + gaps / 2) / gaps]).collect()
        };
        let picture = canvas::draw(self.size, &shown).ok_or_else(|| {
            let message = format!("cannot draw a picture of {} x {} px", self.size.0, self.size.1);
            io::Error::new(io::ErrorKind::InvalidInput, message)
        })?;
        let png = picture.encode_png().map_err(|error| io::Error::other(error.to_string()))?;
        safe::write_file(path, |out| out.write_all(&png))
    }
}

impl Network {
    fn of(frame: &Frame<'_>) -> Self {
        let (particles, springs) = (frame.positions.len(), frame.springs.len());
        let mut loose = vec![true; particles];
        for &[a, b] in frame.springs {
            (loose[a], loose[b]) = (false, false);
        }
        let share = MAX_SPRINGS as f64 / springs as f64;
        let drawn = frame.springs.iter().copied().enumerate();
        let drawn = drawn.filter(|&(j, _)| scattered(j as u64) < share).collect();
        let dotted = (0..particles).filter(|&id| particles <= FEW || loose[id]).collect();
        Self { particles, springs, drawn, dotted }
    }

    fn is_of(&self, frame: &Frame<'_>) -> bool {
        self.particles == frame.positions.len()
            && self.springs == frame.springs.len()
            && self.drawn.iter().all(|&(j, ends)| frame.springs[j] == ends)
    }
}

impl Moment {
    fn of(time: f64, frame: &Frame<'_>, origin: [f64; 3], network: Arc<Network>) -> Self {
        let relative = |position: &[f64; 3]| {
            let point: [f32; 3] = std::array::from_fn(|axis| (position[axis] - origin[axis]) as f32);
            // Beyond this even squares of coordinates overflow; such a point is as lost as an infinite one.
            if point.iter().all(|x| x.abs() < 1e18) { point } else { [f32::NAN; 3] }
        };
        let points = frame.positions.iter().map(relative).collect();
        let strain = network.drawn.iter().map(|&(j, _)| frame.strain[j] as f32).collect();
        let pinned = (0..frame.fixed.len()).filter(|&id| frame.fixed[id]).collect();
        Self { time, network, points, strain, pinned }
    }

    /// The ends and the strain of every spring that can be seen.
    pub(super) fn lines(&self) -> impl Iterator<Item = ([[f64; 3]; 2], f64)> {
        let all = self.network.drawn.iter().zip(&self.strain);
        all.map(|(&(_, ends), &strain)| (ends.map(|id| self.points[id].map(f64::from)), f64::from(strain)))
            .filter(|(ends, _)| ends.as_flattened().iter().all(|x| x.is_finite()))
    }

    /// The particles drawn as dots and whether they are pinned; those last, to lie on top.
    pub(super) fn dots(&self) -> impl Iterator<Item = ([f64; 3], bool)> {
        let free = self.network.dotted.iter().map(|&id| (id, false));
        let pinned = self.pinned.iter().map(|&id| (id, true));
        free.chain(pinned)
            .map(|(id, pinned)| (self.points[id].map(f64::from), pinned))
            .filter(|(point, _)| point.iter().all(|x| x.is_finite()))
    }

    /// Every point of every line and dot.
    pub(super) fn seen(&self) -> impl Iterator<Item = [f64; 3]> {
        self.lines().flat_map(|(ends, _)| ends).chain(self.dots().map(|dot| dot.0))
    }
}

/// A number in [0, 1) that looks random and is the same in every run (the finisher of SplitMix64). Any regular
/// choice falls into step with some mesh: it takes springs of one kind only, or shows stripes.
fn scattered(j: u64) -> f64 {
    let mut bits = j.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
