//! Points of growth, sorted into families of one kind of scene, method and tolerance, with the exponents through them.

use serde::Serialize;

use crate::fit::exponent;

/// A method on a scene.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Point {
    pub(crate) scene: String,
    pub(crate) dt: f64,
    pub(crate) tolerance: f64,
    pub(crate) method: String,
    pub(crate) particles: usize,
    pub(crate) springs: usize,
    pub(crate) ms: f64,
    pub(crate) iterations: f64,
    pub(crate) workspace_bytes: usize,
}

/// The points of one method, tolerance and family of scenes (`cloth`), and the exponents through them.
pub(crate) struct Family {
    pub(crate) label: String,
    pub(crate) points: Vec<Point>,
    pub(crate) time: Option<f64>,
    pub(crate) memory: Option<f64>,
}

/// Sorts points into families, in the order of their first points.
pub(crate) fn families(points: &[Point]) -> Vec<Family> {
    let mut families: Vec<Family> = Vec::new();
    for point in points {
        let kind = point.scene.split(':').next().unwrap_or_default();
        let label = format!("{kind}, {}, {:.3} ms, R = {:e}", point.method, 1e3 * point.dt, point.tolerance);
        match families.iter_mut().find(|family| family.label == label) {
            Some(family) => family.points.push(point.clone()),
            None => families.push(Family { label, points: vec![point.clone()], time: None, memory: None }),
        }
    }
    for family in &mut families {
        let against = |value: fn(&Point) -> f64| -> Vec<(f64, f64)> {
            family.points.iter().map(|point| (point.particles as f64, value(point))).collect()
        };
        (family.time, family.memory) =
            (exponent(&against(|p| p.ms)), exponent(&against(|p| p.workspace_bytes as f64)));
    }
    families
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::growth_plot;

    #[test]
    fn points_of_one_kind_method_and_tolerance_share_an_exponent() {
        let point = |scene: &str, n: usize, tolerance: f64| Point {
            scene: scene.into(),
            dt: 1.0 / 60.0,
            tolerance,
            method: "m".into(),
            particles: n,
            springs: 0,
            ms: (n as f64).powf(1.5),
            iterations: 1.0,
            workspace_bytes: 300 * n,
        };
        let points = [("cloth:8", 64), ("cloth:16", 256), ("lattice:4x4x4", 64), ("lattice:8x8x8", 512)];
        let families = families(&points.map(|(scene, n)| point(scene, n, 1e-3)));
        assert_eq!(families.len(), 2);
        for family in &families {
            assert!(
                (family.time.unwrap() - 1.5).abs() < 1e-12 && (family.memory.unwrap() - 1.0).abs() < 1e-12
            );
        }
        assert!(growth_plot::svg(&families).unwrap().contains("lattice, m, 16.667 ms, R = 1e-3"));
    }
}
