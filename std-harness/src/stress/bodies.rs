//! The islands of a model that nothing holds: they keep their momentum.

use crate::scene::Model;

/// An island that nothing holds.
pub struct Body {
    /// Its particles.
    pub particles: Vec<usize>,
    /// Its springs.
    pub springs: Vec<usize>,
    /// Its mass, kg.
    pub mass: f64,
}

/// The islands that no spring joins with a pin, and how many islands there are in all.
pub fn bodies(model: &Model) -> (Vec<Body>, usize) {
    let n = model.pinned.len();
    let mut root: Vec<usize> = (0..n).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    for [a, b] in model.springs.iter().map(|spring| spring.ends) {
        if !model.pinned[a] && !model.pinned[b] {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            root[a] = b;
        }
    }
    let mut held = vec![false; n];
    for [a, b] in model.springs.iter().map(|spring| spring.ends) {
        for (end, other) in [(a, b), (b, a)] {
            if model.pinned[other] && !model.pinned[end] {
                held[find(&mut root, end)] = true;
            }
        }
    }
    let (mut place, mut bodies, mut islands) = (vec![usize::MAX; n], Vec::<Body>::new(), 0);
    for i in (0..n).filter(|i| !model.pinned[*i]) {
        let own = find(&mut root, i);
        islands += usize::from(own == i);
        if held[own] {
            continue;
        }
        if place[own] == usize::MAX {
            place[own] = bodies.len();
            bodies.push(Body { particles: Vec::new(), springs: Vec::new(), mass: 0.0 });
        }
        bodies[place[own]].particles.push(i);
        bodies[place[own]].mass += model.mass[i];
    }
    for (j, spring) in model.springs.iter().enumerate() {
        let [a, _] = spring.ends;
        if !model.pinned[a] {
            let own = place[find(&mut root, a)];
            if let Some(body) = bodies.get_mut(own) {
                body.springs.push(j);
            }
        }
    }
    (bodies, islands)
}
