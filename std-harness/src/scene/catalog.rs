//! The reference scenes, by name: ids are 0-based, in the order given.

use super::Model;
use crate::error::InputError;
use crate::nearest;

/// Names with their forms, for help and suggestions.
pub const NAMES: [(&str, &str, &str); 8] = [
    ("curtain", "curtain", "a 32×32 curtain on rings, set swinging: the default"),
    ("cloth", "cloth:N", "N×N cloth, 1 m, 0.3 kg, two corners pinned, starts flat"),
    ("net", "net:N", "cloth:N, 100 times as stiff"),
    ("syrup", "syrup:N", "cloth:N, damped along springs and by drag"),
    ("chain", "chain:N", "N particles over 1 m, 0.1 kg, one end pinned"),
    ("lattice", "lattice:AxBxC", "a free block of particles, spinning"),
    ("spring", "spring", "one particle on a wall, k = 1 N/m"),
    ("pair", "pair", "two free particles that orbit each other"),
];

/// The most particles a generated scene may have.
pub const MOST: usize = 1 << 24;

/// The scene of that name, or `None` if the name is not one of the catalogue's.
pub fn named(scene: &str) -> Option<Result<Model, InputError>> {
    let (name, size) = match scene.split_once(':') {
        Some((name, size)) => (name, Some(size)),
        None => (scene, None),
    };
    let model = match name {
        "curtain" | "spring" | "pair" if size.is_some() => {
            Err(InputError::new(format!("scene '{scene}': {name} has no size; say just '{name}'")))
        }
        "curtain" => Ok(curtain()),
        "spring" => Ok(spring()),
        "pair" => Ok(pair()),
        "cloth" => square(scene, name, size).map(|n| cloth(scene, n, 1.0)),
        "net" => square(scene, name, size).map(|n| cloth(scene, n, 100.0)),
        "syrup" => square(scene, name, size).map(|n| syrup(scene, n)),
        "chain" => sizes::<1>(scene, name, size, 2).map(|[n]| chain(scene, n)),
        "lattice" => sizes::<3>(scene, name, size, 1).map(|dims| lattice(scene, dims)),
        _ => return None,
    };
    Some(model)
}

/// The error for a name that is none of the catalogue's.
pub fn unknown(scene: &str) -> InputError {
    let name = scene.split(':').next().unwrap_or(scene);
    let names: Vec<&str> = NAMES.iter().map(|known| known.0).collect();
    let forms: Vec<&str> = NAMES.iter().map(|known| known.1).collect();
    let size = &scene[name.len()..];
    InputError::new(match nearest::nearest(name, &names) {
        Some(near) => format!("unknown scene '{scene}'; did you mean '{near}{size}'?"),
        None => format!("unknown scene '{scene}': neither a file nor one of {}", forms.join(", ")),
    })
}

/// The sizes after the colon, each at least `least`, their product within [`MOST`].
fn sizes<const D: usize>(
    scene: &str,
    name: &str,
    size: Option<&str>,
    least: usize,
) -> Result<[usize; D], InputError> {
    let form = NAMES.iter().find(|known| known.0 == name).map_or(name, |known| known.1);
    let refuse = |why: String| InputError::new(format!("scene '{scene}': {why}; the form is {form}"));
    let size = size.ok_or_else(|| refuse("its size is missing".into()))?;
    let parts: Vec<&str> = size.split('x').collect();
    if parts.len() != D {
        return Err(refuse(format!("'{size}' is not {D} whole number{}", if D == 1 { "" } else { "s" })));
    }
    let mut dims = [0; D];
    for (dim, part) in dims.iter_mut().zip(parts) {
        let digits = !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
        *dim = match part.parse::<usize>() {
            Ok(n) if n >= least => n,
            Err(_) if digits => usize::MAX,
            _ => return Err(refuse(format!("'{part}' is not a whole number of at least {least}"))),
        };
    }
    let total = dims.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    let total = if D == 1 && name != "chain" { dims[0].checked_mul(dims[0]) } else { total };
    match total {
        Some(n) if n < 2 => Err(refuse("a scene needs at least 2 particles".into())),
        Some(n) if n <= MOST => Ok(dims),
        _ => Err(refuse(format!("'{size}' makes more than {MOST} particles, the most that is allowed"))),
    }
}

fn square(scene: &str, name: &str, size: Option<&str>) -> Result<usize, InputError> {
    sizes::<1>(scene, name, size, 2).map(|[n]| n)
}

/// N×N, id = i·N + j at (j/(N−1), 0, i/(N−1)); ids 0 and N−1 pinned. Springs by index offset (1, N−1, N, N+1) and then
/// by id: each kind is one run of constant offset.
fn cloth(name: &str, n: usize, stiffer: f64) -> Model {
    let side = (n - 1) as f64;
    let position = (0..n * n).map(|id| [(id % n) as f64 / side, 0.0, (id / n) as f64 / side]).collect();
    let mut model = Model::at_rest(name, position, 0.3 / (n * n) as f64);
    grid_springs(&mut model, n, n, 1e3 * stiffer, 5e2 * stiffer);
    model.pinned[0] = true;
    model.pinned[n - 1] = true;
    model
}

/// Structural and shear springs of a grid of rows × columns, at rest as placed.
fn grid_springs(model: &mut Model, rows: usize, columns: usize, structural: f64, shear: f64) {
    let id = |i: usize, j: usize| i * columns + j;
    for i in 0..rows {
        for j in 1..columns {
            model.join(id(i, j - 1), id(i, j), structural);
        }
    }
    for (from, to, stiffness) in [(1, 0, shear), (0, 0, structural), (0, 1, shear)] {
        for i in 1..rows {
            for j in 0..columns {
                if j >= from && j + to < columns {
                    model.join(id(i - 1, j), id(i, j + to - from), stiffness);
                }
            }
        }
    }
}

fn syrup(name: &str, n: usize) -> Model {
    let mut model = cloth(name, n, 1.0);
    for spring in &mut model.springs {
        spring.damping = 1.0;
    }
    model.drag = 1e-3;
    model
}

/// N particles on x ∈ [0, 1], id 0 pinned.
fn chain(name: &str, n: usize) -> Model {
    let position = (0..n).map(|i| [i as f64 / (n - 1) as f64, 0.0, 0.0]).collect();
    let mut model = Model::at_rest(name, position, 0.1 / n as f64);
    for i in 1..n {
        model.join(i - 1, i, 1e4);
    }
    model.pinned[0] = true;
    model
}

/// id = (z·B + y)·A + x, spacing 0.1 m; edges, all face and all body diagonals; spinning 2 rad/s about its own z axis.
fn lattice(name: &str, [a, b, c]: [usize; 3]) -> Model {
    let place = |id: usize| [id % a, id / a % b, id / (a * b)];
    let position: Vec<[f64; 3]> = (0..a * b * c).map(|id| place(id).map(|k| 0.1 * k as f64)).collect();
    let mut model = Model::at_rest(name, position, 0.01);
    let mut offsets = Vec::new();
    for z in 0..=1i64 {
        for y in -1..=1i64 {
            for x in -1..=1i64 {
                if (z, y, x) > (0, 0, 0) {
                    offsets.push([x, y, z]);
                }
            }
        }
    }
    for offset in offsets {
        for id in 0..a * b * c {
            let from = place(id);
            let to: [i64; 3] = std::array::from_fn(|d| from[d] as i64 + offset[d]);
            if (0..3).all(|d| to[d] >= 0 && to[d] < [a, b, c][d] as i64) {
                let [x, y, z] = to.map(|k| k as usize);
                model.join(id, (z * b + y) * a + x, 1e3);
            }
        }
    }
    let centre = [0.05 * (a - 1) as f64, 0.05 * (b - 1) as f64];
    for (v, x) in model.velocity.iter_mut().zip(&model.position) {
        *v = [-2.0 * (x[1] - centre[1]), 2.0 * (x[0] - centre[0]), 0.0];
    }
    model.gravity = [0.0; 3];
    model
}

/// A wall at x = 0, k = 1 N/m, l₀ = 1 m, a particle of 1 kg at x = 1.5 m.
fn spring() -> Model {
    let mut model = Model::at_rest("spring", vec![[0.0; 3], [1.5, 0.0, 0.0]], 1.0);
    model.join(0, 1, 1.0);
    model.springs[0].rest_length = 1.0;
    model.pinned[0] = true;
    model.gravity = [0.0; 3];
    model.seconds = 10.0;
    model
}

/// Two particles of 1 kg at x = ±0.5 m, k = 100 N/m, l₀ = 0.8 m, velocities (0, ±0.5, 0).
fn pair() -> Model {
    let mut model = Model::at_rest("pair", vec![[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]], 1.0);
    model.join(0, 1, 100.0);
    model.springs[0].rest_length = 0.8;
    model.velocity = vec![[0.0, 0.5, 0.0], [0.0, -0.5, 0.0]];
    model.gravity = [0.0; 3];
    model.seconds = 10.0;
    model
}

/// A sheet of 32×32 particles, 1.1 m long, gathered into folds on rings at every fourth particle of the top edge (and
/// the last), swinging out of its plane. Made to be looked at.
fn curtain() -> Model {
    const N: usize = 32;
    let length = 1.1;
    let (folds, width) = folds(N);
    let (along, down) = (|id: usize| (id % N) as f64 / 31.0, |id: usize| (id / N) as f64 / 31.0);
    let flat = (0..N * N).map(|id| [along(id) * width, -down(id) * length, 0.0]).collect();
    let mut model = Model::at_rest("curtain", flat, 0.4 / (N * N) as f64);
    grid_springs(&mut model, N, N, 300.0, 60.0);
    // Bending springs over every second particle keep the folds wide.
    for (di, dj) in [(0, 2), (2, 0)] {
        for i in 0..N - di {
            for j in 0..N - dj {
                model.join(i * N + j, (i + di) * N + j + dj, 10.0);
            }
        }
    }
    for spring in &mut model.springs {
        spring.damping = 0.02;
    }
    model.drag = 0.15;
    for id in 0..N * N {
        let [x, z] = folds[id % N];
        model.position[id] = [x, -length * down(id), z];
        model.velocity[id] = [1.2 * down(id) * down(id), 0.0, 2.6 * down(id) * (0.6 + along(id))];
        model.pinned[id] = id < N && (id % 4 == 0 || id == N - 1);
    }
    model.dt = 1.0 / 120.0;
    model.seconds = 3.0;
    model
}

/// `n` points at equal distances along the curve z = 0.055 sin(8πx), x ∈ [0, 1], and the length of the curve.
fn folds(n: usize) -> (Vec<[f64; 2]>, f64) {
    const FINE: usize = 20_000;
    let point = |i: usize| {
        let x = i as f64 / FINE as f64;
        [x, 0.055 * (8.0 * std::f64::consts::PI * x).sin()]
    };
    let mut lengths = vec![0.0];
    for i in 1..=FINE {
        let ([x0, z0], [x1, z1]) = (point(i - 1), point(i));
        lengths.push(lengths[i - 1] + ((x1 - x0).powi(2) + (z1 - z0).powi(2)).sqrt());
    }
    let whole = lengths[FINE];
    let at = |k: usize| lengths.partition_point(|l| *l < whole * k as f64 / (n - 1) as f64).min(FINE);
    ((0..n).map(|k| point(at(k))).collect(), whole)
}
