//! Scenes as plain data, from their definitions, independent of the harness.

use crate::data::{PointData, SceneData};
use crate::random::Random;

/// `cloth:N`: N×N particles, id = i·N + j at (j/(N−1), 0, i/(N−1)) m, 0.3 kg in all; springs right and down 1e3 N/m, both
/// diagonals 5e2 N/m; ids 0 and N−1 pinned; gravity.
pub fn cloth(n: usize) -> SceneData {
    let mut cloth = SceneData { gravity: [0.0, -9.81, 0.0], ..SceneData::default() };
    let at = |i: usize| i as f64 / (n - 1) as f64;
    for i in 0..n {
        for j in 0..n {
            cloth.particle([at(j), 0.0, at(i)], 0.3 / (n * n) as f64);
        }
    }
    for i in 0..n {
        for j in 0..n {
            let id = i * n + j;
            if j + 1 < n {
                cloth.spring(id, id + 1, 1e3);
            }
            if i + 1 < n {
                cloth.spring(id, id + n, 1e3);
            }
            if j + 1 < n && i + 1 < n {
                cloth.spring(id, id + n + 1, 5e2);
                cloth.spring(id + 1, id + n, 5e2);
            }
        }
    }
    cloth.pinned[0] = true;
    cloth.pinned[n - 1] = true;
    cloth
}

/// `chain:N`: N particles on x ∈ [0, 1] m, 0.1 kg in all, k = 1e4 N/m, id 0 pinned, gravity.
pub fn chain(n: usize) -> SceneData {
    let mut chain = SceneData { gravity: [0.0, -9.81, 0.0], ..SceneData::default() };
    for i in 0..n {
        chain.particle([i as f64 / (n - 1) as f64, 0.0, 0.0], 0.1 / n as f64);
    }
    for i in 1..n {
        chain.spring(i - 1, i, 1e4);
    }
    chain.pinned[0] = true;
    chain
}

/// A rope like the README's: n particles of 10 g every 0.1 m along x, k = 1e3 N/m, the first pinned, gravity.
pub fn rope(n: usize) -> SceneData {
    let mut rope = SceneData { gravity: [0.0, -9.81, 0.0], ..SceneData::default() };
    for i in 0..n {
        rope.particle([0.1 * i as f64, 0.0, 0.0], 0.010);
    }
    for i in 1..n {
        rope.spring(i - 1, i, 1e3);
    }
    rope.pinned[0] = true;
    rope
}

/// `lattice:AxBxC`: id = (z·B + y)·A + x, spacing 0.1 m, springs along edges, face and body diagonals 1e3 N/m, 0.01 kg
/// each, nothing pinned, no gravity, spinning 2 rad/s about its z axis.
pub fn lattice(a: usize, b: usize, c: usize) -> SceneData {
    let mut lattice = SceneData::default();
    let middle = [a, b, c].map(|n| 0.05 * (n - 1) as f64);
    for z in 0..c {
        for y in 0..b {
            for x in 0..a {
                let at = [0.1 * x as f64, 0.1 * y as f64, 0.1 * z as f64];
                let i = lattice.particle(at, 0.01);
                lattice.velocity[i] = [-2.0 * (at[1] - middle[1]), 2.0 * (at[0] - middle[0]), 0.0];
            }
        }
    }
    let id = |x: usize, y: usize, z: usize| (z * b + y) * a + x;
    for z in 0..c {
        for y in 0..b {
            for x in 0..a {
                for (dx, dy, dz) in HALF_OF_THE_NEIGHBOURS {
                    let (u, v, w) = (x as isize + dx, y as isize + dy, z as isize + dz);
                    let inside = |i: isize, n: usize| (0..n as isize).contains(&i);
                    if inside(u, a) && inside(v, b) && inside(w, c) {
                        lattice.spring(id(x, y, z), id(u as usize, v as usize, w as usize), 1e3);
                    }
                }
            }
        }
    }
    lattice
}

const HALF_OF_THE_NEIGHBOURS: [(isize, isize, isize); 13] = [
    (1, 0, 0),
    (0, 1, 0),
    (0, 0, 1),
    (1, 1, 0),
    (1, -1, 0),
    (1, 0, 1),
    (-1, 0, 1),
    (0, 1, 1),
    (0, -1, 1),
    (1, 1, 1),
    (-1, 1, 1),
    (1, -1, 1),
    (-1, -1, 1),
];

/// Box lattice with springs of rest length 0 along the axes only, walls (pinned) all around: a·b·c free particles of mass
/// m, spacing 1 m.
pub fn box_lattice(size: [usize; 3], k: f64, m: f64) -> SceneData {
    let mut scene = SceneData::default();
    let [a, b, c] = size.map(|n| n + 2);
    let id = |x: usize, y: usize, z: usize| (z * b + y) * a + x;
    for z in 0..c {
        for y in 0..b {
            for x in 0..a {
                let i = scene.particle([x as f64, y as f64, z as f64], m);
                scene.pinned[i] = x == 0 || y == 0 || z == 0 || x == a - 1 || y == b - 1 || z == c - 1;
            }
        }
    }
    for z in 0..c {
        for y in 0..b {
            for x in 0..a {
                for (u, v, w) in [(x + 1, y, z), (x, y + 1, z), (x, y, z + 1)] {
                    if u < a && v < b && w < c {
                        scene.spring_with(id(x, y, z), id(u, v, w), k, 0.0);
                    }
                }
            }
        }
    }
    scene
}

/// A blob: a ball cut out of a jittered lattice, each cell split into six tetrahedra, every edge a spring (k = 1e5 N/m,
/// 1 kg each), the lowest particles pinned, gravity.
pub fn blob(cells: usize, seed: u64) -> SceneData {
    let mut random = Random::new(seed);
    let mut blob = SceneData { gravity: [0.0, -9.8, 0.0], ..SceneData::default() };
    let n = cells + 1;
    let mut ids = vec![None; n * n * n];
    let place = |x: usize, y: usize, z: usize| (z * n + y) * n + x;
    let half = cells as f64 / 2.0;
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let at = [x, y, z].map(|i| i as f64 - half);
                if crate::data::distance(at, [0.0; 3]) <= half * 1.15 {
                    let jitter = random.vector(0.2);
                    ids[place(x, y, z)] =
                        Some(blob.particle([0, 1, 2].map(|d| 0.1 * (at[d] + jitter[d])), 1.0));
                }
            }
        }
    }
    let mut edges = std::collections::BTreeSet::new();
    // Kuhn's six tetrahedra of a cube: one per order of the axes, along its main diagonal.
    for z in 0..cells {
        for y in 0..cells {
            for x in 0..cells {
                for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let mut corner = [x, y, z];
                    let mut corners = vec![corner];
                    for axis in order {
                        corner[axis] += 1;
                        corners.push(corner);
                    }
                    let known: Option<Vec<usize>> =
                        corners.iter().map(|[x, y, z]| ids[place(*x, *y, *z)]).collect();
                    let Some(tetrahedron) = known else { continue };
                    for (i, a) in tetrahedron.iter().enumerate() {
                        for b in &tetrahedron[i + 1..] {
                            edges.insert((*a.min(b), *a.max(b)));
                        }
                    }
                }
            }
        }
    }
    for (a, b) in edges {
        blob.spring(a, b, 1e5);
    }
    let lowest = blob.position.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min);
    for (pinned, x) in blob.pinned.iter_mut().zip(&blob.position) {
        *pinned = x[1] < lowest + 0.06;
    }
    blob
}

/// What a random network may have.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ingredients {
    /// Pinned particles
    pub pins: bool,
    /// Springs far from their rest lengths, so that some must be clamped
    pub compressed: bool,
    /// Damping along springs and drag
    pub damped: bool,
    /// Point springs
    pub points: bool,
    /// Gravity
    pub gravity: bool,
    /// Random initial velocities
    pub moving: bool,
}

/// A random network of n particles: a random tree and some springs more; lengths about 1 m, masses 1 g … 10 kg,
/// stiffness 0.1 … 1e5 N/m.
pub fn network(random: &mut Random, n: usize, with: Ingredients) -> SceneData {
    let mut net = SceneData::default();
    let (low, high) = if random.chance(0.5) { (0.05, 0.1) } else { (1e-3, 10.0) };
    for _ in 0..n {
        let at = random.vector(1.0);
        let mass = random.decade(low, high);
        net.particle(at, mass);
    }
    let soft = random.chance(0.3);
    let join = |net: &mut SceneData, random: &mut Random, a: usize, b: usize| {
        let length = crate::data::distance(net.position[a], net.position[b]);
        let stretch = if with.compressed { random.between(0.1, 4.0) } else { random.between(0.6, 1.05) };
        let l0 = if random.chance(0.1) { 0.0 } else { length * stretch };
        let k = if soft { random.decade(0.1, 10.0) } else { random.decade(10.0, 1e5) };
        let (a, b) = if random.chance(0.5) { (a, b) } else { (b, a) };
        net.spring_with(a, b, k, l0);
        if with.damped
            && random.chance(0.7)
            && let Some(spring) = net.springs.last_mut()
        {
            spring.c = random.decade(1e-3, 10.0);
        }
    };
    for i in 1..n {
        let other = random.below(i);
        join(&mut net, random, i, other);
    }
    for _ in 0..n {
        let (a, b) = (random.below(n), random.below(n));
        if a != b {
            join(&mut net, random, a, b);
        }
    }
    if with.pins {
        for _ in 0..1 + n / 4 {
            let i = random.below(n);
            net.pinned[i] = true;
        }
    }
    if with.points {
        for _ in 0..2 {
            let (particle, target) = (random.below(n), random.vector(2.0));
            let k = random.decade(1.0, 1e4);
            let l0 = if random.chance(0.5) { 0.0 } else { random.between(0.1, 4.0) };
            net.points.push(PointData { particle, target, k, l0 });
        }
    }
    if with.damped {
        net.drag = random.decade(1e-2, 10.0);
    }
    if with.gravity {
        net.gravity = [0.0, -9.81, 0.0];
    }
    if with.moving {
        for i in 0..n {
            if !net.pinned[i] {
                net.velocity[i] = random.vector(1.0);
            }
        }
    }
    net
}

/// A random network whose lengths, masses and constants are within a few units of one another, with everything in it.
pub fn gentle_network(seed: u64, n: usize) -> SceneData {
    let mut random = Random::new(seed);
    let with = Ingredients {
        pins: true,
        compressed: false,
        damped: true,
        points: true,
        gravity: true,
        moving: true,
    };
    let mut net = network(&mut random, n, with);
    for m in &mut net.mass {
        *m = random.between(0.5, 2.0);
    }
    for s in &mut net.springs {
        s.k = random.between(50.0, 200.0);
        s.c = random.between(0.0, 2.0);
    }
    for p in &mut net.points {
        p.k = random.between(5.0, 20.0);
    }
    net.drag = 0.1;
    net
}
