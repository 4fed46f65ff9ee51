//! Two scenes in one.

use crate::data::{PointData, SceneData, SpringData};

/// Both scenes, particles and springs of both taking turns, and where the first one's particles are.
pub fn side_by_side(a: &SceneData, b: &SceneData) -> (SceneData, Vec<usize>) {
    let mut both = SceneData { gravity: a.gravity, drag: a.drag, ..SceneData::default() };
    let mut places = [vec![0; a.len()], vec![0; b.len()]];
    for i in 0..a.len().max(b.len()) {
        for (which, from) in [b, a].into_iter().enumerate() {
            if i < from.len() {
                let to = both.particle(from.position[i], from.mass[i]);
                both.velocity[to] = from.velocity[i];
                both.pinned[to] = from.pinned[i];
                places[1 - which][i] = to;
            }
        }
    }
    for i in 0..a.springs.len().max(b.springs.len()) {
        for (from, place) in [(b, &places[1]), (a, &places[0])] {
            if let Some(s) = from.springs.get(i) {
                both.springs.push(SpringData { a: place[s.a], b: place[s.b], ..*s });
            }
        }
    }
    for (from, place) in [(b, &places[1]), (a, &places[0])] {
        let moved = |p: &PointData| PointData { particle: place[p.particle], ..*p };
        both.points.extend(from.points.iter().map(moved));
    }
    let [places, _] = places;
    (both, places)
}
