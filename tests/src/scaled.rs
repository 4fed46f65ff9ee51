//! Scenes whose quantities are multiplied by factors.

use crate::data::SceneData;

/// What the quantities of a scene are multiplied by.
#[derive(Debug, Clone, Copy)]
pub struct Factors {
    /// m
    pub length: f64,
    /// m/s
    pub velocity: f64,
    /// kg
    pub mass: f64,
    /// N/m
    pub stiffness: f64,
    /// N·s/m
    pub damping: f64,
    /// 1/s
    pub drag: f64,
    /// m/s²
    pub gravity: f64,
    /// s
    pub time: f64,
    /// J
    pub energy: f64,
}

/// Nothing is scaled.
pub const ONE: Factors = Factors {
    length: 1.0,
    velocity: 1.0,
    mass: 1.0,
    stiffness: 1.0,
    damping: 1.0,
    drag: 1.0,
    gravity: 1.0,
    time: 1.0,
    energy: 1.0,
};

/// The scene so scaled.
pub fn scaled(data: &SceneData, by: Factors) -> SceneData {
    let times = |factor: f64| move |x: [f64; 3]| x.map(|x| x * factor);
    let mut to = data.moved(times(by.length), times(by.velocity));
    to.gravity = times(by.gravity)(data.gravity);
    to.drag *= by.drag;
    to.mass.iter_mut().for_each(|m| *m *= by.mass);
    for s in &mut to.springs {
        (s.k, s.l0, s.c) = (s.k * by.stiffness, s.l0 * by.length, s.c * by.damping);
    }
    for p in &mut to.points {
        (p.k, p.l0) = (p.k * by.stiffness, p.l0 * by.length);
    }
    to
}
