//! The keys of a scene file, as serde reads them; what they mean stands at the top of the module.
//!
//! Elements of long lists stay plain here and are checked by span where they are used: toml would place an error of
//! ours on the first line of the list.

use std::path::PathBuf;

use ::toml::Spanned;
use serde::Deserialize;

use super::value::{NotNegative, Positive, Triple};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub mesh: Option<Spanned<String>>,
    pub generator: Option<Spanned<String>>,
    #[serde(default)]
    pub particle: Vec<Spanned<Particle>>,
    #[serde(default)]
    pub spring: Vec<Spanned<SpringEntry>>,
    pub mass: Option<Spanned<Mass>>,
    pub stiffness: Option<Spanned<Stiffness>>,
    pub bending: Option<Spanned<Bending>>,
    pub damping: Option<NotNegative>,
    pub drag: Option<NotNegative>,
    pub gravity: Option<Triple>,
    pub velocity: Option<Triple>,
    pub cables: Option<bool>,
    pub pin: Option<Spanned<String>>,
    pub pins: Option<Vec<Spanned<usize>>>,
    #[serde(default)]
    pub moving: Vec<Spanned<MovingEntry>>,
    pub dt: Option<Positive>,
    pub seconds: Option<NotNegative>,
    #[serde(default)]
    pub output: Output,
}

/// The keys that stand above every table, for a hint when one of them slipped into one.
pub(super) const TOP: [&str; 11] =
    ["mesh", "generator", "damping", "drag", "gravity", "velocity", "cables", "pin", "pins", "dt", "seconds"];

/// One `[[particle]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Particle {
    pub position: Triple,
    pub velocity: Option<Triple>,
    pub mass: Option<Positive>,
    #[serde(default)]
    pub pinned: bool,
}

/// One `[[spring]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpringEntry {
    pub a: usize,
    pub b: usize,
    pub stiffness: Option<NotNegative>,
    pub ea: Option<NotNegative>,
    pub rest_length: Option<NotNegative>,
    pub damping: Option<NotNegative>,
    pub cable: Option<bool>,
}

/// `[mass]`: one of these.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mass {
    pub each: Option<Positive>,
    pub values: Option<Vec<Spanned<f64>>>,
    pub total: Option<Positive>,
    pub density: Option<Positive>,
    pub area_density: Option<Positive>,
}

/// `[stiffness]`: one of these.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stiffness {
    pub each: Option<NotNegative>,
    pub ea: Option<NotNegative>,
}

/// `[bending]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bending {
    pub stiffness: NotNegative,
}

/// One `[[moving]]`: particles and one of the paths.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MovingEntry {
    pub particles: Vec<Spanned<usize>>,
    pub linear: Option<Linear>,
    pub oscillate: Option<Oscillate>,
    pub through: Option<Spanned<Vec<Spanned<Vec<f64>>>>>,
}

/// A path of constant velocity.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Linear {
    pub velocity: Triple,
}

/// A path that swings.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Oscillate {
    pub amplitude: Triple,
    pub frequency: Positive,
}

/// `[output]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Output {
    pub dir: Option<PathBuf>,
    pub fps: Option<Positive>,
    #[serde(rename = "final")]
    pub final_csv: Option<PathBuf>,
    pub json: Option<PathBuf>,
}
