//! A fixed perspective camera, y up, that sees a whole motion.
//!
//! It looks at the middle of the motion's bounding box from a little above and a little to the right: oblique to
//! all three axes, so that nothing flat along an axis is seen edge-on. With v = p − centre, its parts along the
//! camera's axes and the distance d, the picture of p is (v·right, −v·up) · d/(d + v·forward), in metres at the
//! centre's depth; y points down, as pixels do.

type Vec3 = [f64; 3];

/// Degrees to the right of the z axis and above the horizon.
const AZIMUTH: f64 = 32.0;
const ELEVATION: f64 = 17.0;
/// Distance in units of the motion's radius: enough perspective to tell near from far, no distortion.
const DISTANCE: f64 = 3.4;

/// Where a point appears and how far behind the centre it lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) depth: f64,
    /// Size of things at that depth relative to things at the centre.
    pub(super) scale: f64,
}

pub(super) struct Camera {
    centre: Vec3,
    distance: f64,
    /// Radius of a ball around the centre that holds every point.
    pub(super) radius: f64,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
}

impl Camera {
    /// A camera on all of `points`, which are finite. Without points it looks at the origin.
    pub(super) fn around(points: impl Iterator<Item = Vec3>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        let half: Vec3 = std::array::from_fn(|axis| 0.5 * (high[axis] - low[axis]));
        let radius = dot(half, half).sqrt();
        let (sin_a, cos_a) = AZIMUTH.to_radians().sin_cos();
        let (sin_e, cos_e) = ELEVATION.to_radians().sin_cos();
        Self {
            centre: std::array::from_fn(|axis| low[axis] + half[axis]),
            // A single point has no extent, but must not sit in the camera's eye.
            distance: if radius > 0.0 { DISTANCE * radius } else { 1.0 },
            radius,
            right: [cos_a, 0.0, -sin_a],
            up: [-sin_e * sin_a, cos_e, -sin_e * cos_a],
            forward: [-cos_e * sin_a, -sin_e, -cos_e * cos_a],
        }
    }

    pub(super) fn see(&self, point: Vec3) -> Seen {
        let v: Vec3 = std::array::from_fn(|axis| point[axis] - self.centre[axis]);
        let depth = dot(v, self.forward);
        let scale = self.distance / (self.distance + depth);
        Seen { x: scale * dot(v, self.right), y: -scale * dot(v, self.up), depth, scale }
    }
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
