//! A scene as plain data, in `f64`: what generators write, the kernel is built from, and the oracles read.

/// A spring between two particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringData {
    /// End A
    pub a: usize,
    /// End B
    pub b: usize,
    /// k, N/m
    pub k: f64,
    /// l₀, m
    pub l0: f64,
    /// Damping along it, N·s/m
    pub c: f64,
}

/// A spring between a particle and a point at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointData {
    /// Which particle
    pub particle: usize,
    /// Where the point is, m
    pub target: [f64; 3],
    /// k, N/m
    pub k: f64,
    /// l₀, m
    pub l0: f64,
}

/// Where a pin is at the end of a step and how fast it then moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionData {
    /// Which particle
    pub particle: usize,
    /// b⁺, m
    pub position: [f64; 3],
    /// ḃ⁺, m/s
    pub velocity: [f64; 3],
}

/// All of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneData {
    /// q, m
    pub position: Vec<[f64; 3]>,
    /// q̇, m/s
    pub velocity: Vec<[f64; 3]>,
    /// mᵢ, kg
    pub mass: Vec<f64>,
    /// Which particles are pinned
    pub pinned: Vec<bool>,
    /// The springs, in order
    pub springs: Vec<SpringData>,
    /// The point springs, in order
    pub points: Vec<PointData>,
    /// g, m/s²
    pub gravity: [f64; 3],
    /// Drag rate d, 1/s
    pub drag: f64,
}

/// |a − b|
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

impl SceneData {
    /// Adds a particle at rest; answers its index.
    pub fn particle(&mut self, position: [f64; 3], mass: f64) -> usize {
        self.position.push(position);
        self.velocity.push([0.0; 3]);
        self.mass.push(mass);
        self.pinned.push(false);
        self.mass.len() - 1
    }

    /// Adds an undamped spring whose rest length is the present distance.
    pub fn spring(&mut self, a: usize, b: usize, k: f64) {
        self.spring_with(a, b, k, distance(self.position[a], self.position[b]));
    }

    /// Adds an undamped spring.
    pub fn spring_with(&mut self, a: usize, b: usize, k: f64, l0: f64) {
        self.springs.push(SpringData { a, b, k, l0, c: 0.0 });
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// No particles?
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// Does the spring have a free end?
    pub fn acts(&self, spring: &SpringData) -> bool {
        !(self.pinned[spring.a] && self.pinned[spring.b])
    }

    /// The same with every number rounded to `f32`, so that an oracle in `f64` sees what an `f32` scene stores.
    pub fn rounded_to_f32(&self) -> Self {
        let r = |x: f64| f64::from(x as f32);
        let r3 = |x: [f64; 3]| x.map(r);
        Self {
            position: self.position.iter().copied().map(r3).collect(),
            velocity: self.velocity.iter().copied().map(r3).collect(),
            mass: self.mass.iter().copied().map(r).collect(),
            pinned: self.pinned.clone(),
            springs: self
                .springs
                .iter()
                .map(|s| SpringData { k: r(s.k), l0: r(s.l0), c: r(s.c), ..*s })
                .collect(),
            points: self
                .points
                .iter()
                .map(|p| PointData { target: r3(p.target), k: r(p.k), l0: r(p.l0), ..*p })
                .collect(),
            gravity: r3(self.gravity),
            drag: r(self.drag),
        }
    }

    /// The same with every position and velocity mapped, and gravity and targets with it (targets like positions,
    /// gravity like velocities).
    pub fn moved(&self, x: impl Fn([f64; 3]) -> [f64; 3], v: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let mut to = self.clone();
        to.position.iter_mut().for_each(|p| *p = x(*p));
        to.velocity.iter_mut().for_each(|p| *p = v(*p));
        to.points.iter_mut().for_each(|p| p.target = x(p.target));
        to.gravity = v(to.gravity);
        to
    }
}
