//! A step of each explicit method against its formula, written out particle by particle; and the errors that steps of `verlet`
//! are estimated to have.

use hooke::{Course, Drag, Embedded, Force, Gravity, Motion, SpringDamping, SymplecticEuler, Verlet};
use hooke_tests::data::{MotionData, SceneData};
use hooke_tests::methods::{Method, options};
use hooke_tests::{allowed, build};

type V = [f64; 3];

fn combine(a: V, s: f64, b: V) -> V {
    std::array::from_fn(|d| a[d] + s * b[d])
}

fn dot(a: V, b: V) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What damps.
#[derive(Debug, Clone, Copy)]
struct Damps {
    drag: bool,
    springs: bool,
}

const ALL: [Damps; 4] = [
    Damps { drag: false, springs: false },
    Damps { drag: true, springs: false },
    Damps { drag: false, springs: true },
    Damps { drag: true, springs: true },
];

/// A pin that moves, one that rests, and three free particles; a triangle among them, stretched and compressed.
fn scene(damps: Damps) -> (SceneData, [MotionData; 1]) {
    let mut data = SceneData { gravity: [0.5, -9.81, 0.25], ..SceneData::default() };
    let places = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.9, -0.3, 0.2], [2.5, 0.8, -0.1], [3.0, 0.0, 0.5]];
    for (place, m) in places.into_iter().zip([1.0, 0.5, 0.75, 1.25, 1.0]) {
        data.particle(place, m);
    }
    (data.pinned[0], data.pinned[4]) = (true, true);
    data.velocity = vec![[0.5, -1.0, 0.25], [0.3, 0.1, -0.2], [-0.4, 0.6, 0.1], [0.2, -0.3, 0.7], [0.0; 3]];
    for (j, (a, b)) in [(0, 1), (1, 2), (2, 3), (1, 3), (3, 4)].into_iter().enumerate() {
        data.spring(a, b, 40.0 + 10.0 * j as f64);
        data.springs[j].l0 = 0.9 + 0.1 * j as f64;
        data.springs[j].c = if damps.springs { 0.25 + 0.125 * j as f64 } else { 0.0 };
    }
    data.drag = if damps.drag { 0.375 } else { 0.0 };
    let motion = MotionData { particle: 0, position: [0.25, -0.3, 0.1], velocity: [1.5, 0.5, -0.75] };
    (data, [motion])
}

/// Positions, velocities, and whose they are.
struct Walk<'d> {
    data: &'d SceneData,
    q: Vec<V>,
    v: Vec<V>,
}

impl Walk<'_> {
    fn free(&self) -> impl Iterator<Item = usize> + use<> {
        let pinned = self.data.pinned.clone();
        (0..pinned.len()).filter(move |i| !pinned[*i])
    }

    /// (f + Mg, what damps alone), N
    fn forces(&self) -> [Vec<V>; 2] {
        let (n, data) = (self.q.len(), self.data);
        let mut elastic: Vec<V> =
            (0..n).map(|i| std::array::from_fn(|d| data.mass[i] * data.gravity[d])).collect();
        let mut damping: Vec<V> =
            (0..n).map(|i| std::array::from_fn(|d| -data.drag * data.mass[i] * self.v[i][d])).collect();
        for s in &data.springs {
            let way = combine(self.q[s.a], -1.0, self.q[s.b]);
            let l = dot(way, way).sqrt();
            let u = way.map(|x| x / l);
            let rate = dot(u, combine(self.v[s.a], -1.0, self.v[s.b]));
            for (list, pull) in [(&mut elastic, s.k * (l - s.l0)), (&mut damping, s.c * rate)] {
                list[s.a] = combine(list[s.a], -pull, u);
                list[s.b] = combine(list[s.b], pull, u);
            }
        }
        [elastic, damping]
    }

    fn kick(&mut self, t: f64, f: &[V]) {
        for i in self.free() {
            self.v[i] = combine(self.v[i], t / self.data.mass[i], f[i]);
        }
    }

    fn drift(&mut self, t: f64) {
        for i in self.free() {
            self.q[i] = combine(self.q[i], t, self.v[i]);
        }
    }

    /// The pin on its cubic, by Hermite's four.
    fn pin(&mut self, s: f64, dt: f64, m: &MotionData) {
        let (b, rate) = (self.data.position[m.particle], self.data.velocity[m.particle]);
        let (s2, s3) = (s * s, s * s * s);
        self.q[m.particle] = std::array::from_fn(|d| {
            (2.0 * s3 - 3.0 * s2 + 1.0) * b[d]
                + (s3 - 2.0 * s2 + s) * dt * rate[d]
                + (3.0 * s2 - 2.0 * s3) * m.position[d]
                + (s3 - s2) * dt * m.velocity[d]
        });
        self.v[m.particle] = std::array::from_fn(|d| {
            (6.0 * s2 - 6.0 * s) / dt * (b[d] - m.position[d])
                + (3.0 * s2 - 4.0 * s + 1.0) * rate[d]
                + (3.0 * s2 - 2.0 * s) * m.velocity[d]
        });
    }
}

/// n substeps of kick, drift and kick; where something damps, with the fading by itself in the middle. Answers where that ends, and
/// ½Σ|error|² as energy and |error| at most, as they are estimated.
fn verlet<'d>(data: &'d SceneData, m: &MotionData, dt: f64, n: u32, lambda: f64) -> (Walk<'d>, f64, f64) {
    let mut walk = Walk { data, q: data.position.clone(), v: data.velocity.clone() };
    let damped = data.drag > 0.0 || data.springs.iter().any(|s| s.c > 0.0);
    let h = dt / f64::from(n);
    let (mut energy, mut most) = (0.0, 0.0f64);
    let [mut f, _] = walk.forces();
    for k in 0..n {
        let before = f;
        walk.kick(0.5 * h, &before);
        if damped {
            walk.drift(0.5 * h);
            walk.pin((f64::from(k) + 0.5) / f64::from(n), dt, m);
            let start = walk.v.clone();
            let [_, first] = walk.forces();
            walk.kick(0.5 * h, &first);
            let [_, second] = walk.forces();
            walk.v.clone_from(&start);
            walk.pin((f64::from(k) + 0.5) / f64::from(n), dt, m);
            walk.kick(h, &second);
            for i in walk.free() {
                let change = combine(second[i], -1.0, first[i]).map(|x| h * x / data.mass[i]);
                energy += 0.5 * data.mass[i] * dot(change, change);
            }
            walk.drift(0.5 * h);
        } else {
            walk.drift(h);
        }
        walk.pin(f64::from(k + 1) / f64::from(n), dt, m);
        [f, _] = walk.forces();
        walk.kick(0.5 * h, &f);
        for i in walk.free() {
            let change = combine(f[i], -1.0, before[i]).map(|x| h * x / data.mass[i] / 6.0);
            energy += (2.0 + h * h * lambda) * 0.5 * data.mass[i] * dot(change, change);
            most = most.max(dot(change, change));
        }
    }
    let n = f64::from(n);
    (walk, n * energy, n * h * most.sqrt())
}

fn same(name: &str, scene: &hooke_tests::vec_memory::VecScene<f64>, expected: &Walk<'_>) {
    let off = build::farthest(&build::positions(scene), &expected.q)
        .max(build::farthest(&build::velocities(scene), &expected.v));
    println!("{name}: {off:.1e}");
    assert!(off <= allowed::EXPLICIT_STEP, "{name}: {off:e}");
}

#[test]
fn a_step_of_verlet_is_its_formula_damped_or_not_in_one_step_and_in_substeps_of_a_pins_cubic() {
    for damps in ALL {
        let (data, motion) = scene(damps);
        let motions = build::motions::<f64>(&motion);
        // The largest λ is 2·(50 + 60 + 70)/1.25 or (40 + 2·(50 + 70))/0.5: 560/s²; 2/√560 = 85 ms.
        for (dt, substeps) in [(0.05, 1), (0.2, 3), (0.6, 8)] {
            let mut scene = build::scene::<f64>(&data);
            scene.set_pin_velocity(0, data.velocity[0]).unwrap();
            let mut forces = build::Forces::<f64>::new(&data);
            let options = hooke_tests::methods::Options { substeps, ..options(dt, 1e-12) };
            Method::Verlet.step(&mut scene, options, forces.all(), &motions).unwrap();
            let (expected, ..) = verlet(&data, &motion[0], dt, substeps, 0.0);
            same(&format!("{damps:?}, {substeps} substeps"), &scene, &expected);
        }
    }
}

#[test]
fn a_step_of_symplectic_euler_is_its_formula_damped_or_not() {
    for damps in ALL {
        let (data, motion) = scene(damps);
        let mut scene = build::scene::<f64>(&data);
        scene.set_pin_velocity(0, data.velocity[0]).unwrap();
        let mut forces = build::Forces::<f64>::new(&data);
        let motions = build::motions::<f64>(&motion);
        Method::SymplecticEuler.step(&mut scene, options(0.03, 1e-12), forces.all(), &motions).unwrap();
        let mut expected = Walk { data: &data, q: data.position.clone(), v: data.velocity.clone() };
        let [f, damping] = expected.forces();
        expected.kick(0.03, &f);
        expected.kick(0.03, &damping);
        expected.drift(0.03);
        expected.pin(1.0, 0.03, &motion[0]);
        same(&format!("{damps:?}"), &scene, &expected);
    }
}

#[test]
fn the_error_of_a_step_of_verlet_is_estimated_by_its_formula_and_what_is_accepted_is_the_step() {
    for damps in ALL {
        let (data, motion) = scene(damps);
        let motions = build::motions::<f64>(&motion);
        let mut forces = build::Forces::<f64>::new(&data);
        let dt = 0.2;
        let mut scene = build::scene::<f64>(&data);
        scene.set_pin_velocity(0, data.velocity[0]).unwrap();
        let mut method = Verlet::new(1.0).with(forces.all());
        let course = Course { motion: &motions, over: dt };
        let (report, found) = method.attempt(&mut scene.parts(), dt, course, 1.0, &mut |_| {}).unwrap();
        assert_eq!(report.islands, 1);
        let lambda = (40.0 + 2.0 * (50.0 + 70.0)) / 0.5;
        let (expected, energy, distance) = verlet(&data, &motion[0], dt, 8, lambda);
        let off = [found.energy / energy - 1.0, found.distance / distance - 1.0].map(f64::abs);
        println!("{damps:?}: {energy:e} J, {distance:e} m, {:.1e} off", off[0].max(off[1]));
        assert!(
            off[0].max(off[1]) <= 64.0 * allowed::U64,
            "{damps:?}: {found:?}, not {energy:e} J and {distance:e} m"
        );
        method.accept(scene.parts(), course).unwrap();
        same(&format!("{damps:?}"), &scene, &expected);
    }
}

#[test]
fn what_damps_by_0_is_not_there_bit_for_bit() {
    fn steps<F: Force<f64> + Copy>(forces: F) -> Vec<Vec<[u64; 6]>> {
        let (data, motion) = scene(ALL[0]);
        let motions: Vec<Motion<f64>> = build::motions(&motion);
        let mut walks = Vec::new();
        for method in [Method::Verlet, Method::SymplecticEuler] {
            let mut scene = build::scene::<f64>(&data);
            method.step(&mut scene, options(0.05, 1e-12), forces, &motions).unwrap();
            walks.push(build::bits(&scene));
        }
        let mut scene = build::scene::<f64>(&data);
        let mut method = hooke::Adaptive::new(Verlet::new(0.05).with(forces), 0.05, 1.0);
        method.end_after(0.05);
        scene.step_moving(&mut method, &motions).unwrap();
        walks.push(build::bits(&scene));
        walks
    }
    let gravity = Gravity([0.5, -9.81, 0.25]);
    assert_eq!(steps((gravity, (Drag(0.0), SpringDamping(0.0)))), steps((gravity, ())));
}

#[test]
fn what_damps_alone_damps_as_it_does_beside_what_damps_by_0() {
    fn step<F: Force<f64>>(method: Method, forces: F) -> Vec<[f64; 3]> {
        let (data, motion) = scene(ALL[0]);
        let mut scene = build::scene::<f64>(&data);
        method.step(&mut scene, options(0.05, 1e-12), forces, &build::motions(&motion)).unwrap();
        [build::positions(&scene), build::velocities(&scene)].concat()
    }
    for method in [Method::Verlet, Method::SymplecticEuler] {
        let plain = step(method, ());
        let drag = step(method, Drag(0.5));
        assert_eq!(drag, step(method, (Drag(0.5), SpringDamping(0.0))));
        let damping = step(method, SpringDamping(0.5));
        assert_eq!(damping, step(method, (Drag(0.0), SpringDamping(0.5))));
        assert!(plain != drag && plain != damping && drag != damping);
    }
}

#[test]
fn a_step_of_exactly_the_limit_is_refused_and_the_particle_is_that_of_the_worst_of_both_limits() {
    // ω = 1/s: the limit is 2 s.
    let mut data = SceneData::default();
    for x in [0.0, 1.0] {
        data.particle([x, 0.0, 0.0], 1.0);
    }
    data.pinned[0] = true;
    data.spring(0, 1, 1.0);
    for method in [Method::Verlet, Method::SymplecticEuler] {
        for (dt, refused) in [(2.0, true), (f64::from_bits(2f64.to_bits() - 1), false)] {
            let made = method.step(&mut build::scene::<f64>(&data), options(dt, 1e-12), (), &[]);
            assert_eq!(made.is_err(), refused, "{method:?}, {dt}: {made:?}");
        }
    }
    // One swings, h²λ = 9.75; one is damped, 2hd = 10.
    data.springs.clear();
    data.particle([0.0, 1.0, 0.0], 1.0);
    data.spring(0, 1, 39.0);
    data.spring(0, 2, 1e-9);
    let damping = [0.0, 10.0];
    let (mut verlet, mut euler) = (
        Verlet::new(0.5).with(SpringDamping(&damping[..])),
        SymplecticEuler::new(0.5).with(SpringDamping(&damping[..])),
    );
    let mut scene = build::scene::<f64>(&data);
    assert_eq!(scene.step(&mut verlet), Err(hooke::StepError::StepLimit(2)));
    assert_eq!(scene.step(&mut euler), Err(hooke::StepError::StepLimit(2)));
}

#[test]
fn a_last_kick_beyond_the_numbers_is_an_error_though_all_positions_are_finite() {
    // Two particles without strain that fly apart: after h = 2⁻⁵⁰⁰ s, h²λ = 2, the spring pulls with 2⁹⁹⁹·2³⁰⁰ N.
    let (h, mut data) = (2f64.powi(-500), SceneData::default());
    for x in [0.0, 1.0] {
        data.particle([x, 0.0, 0.0], 1.0);
    }
    data.spring(0, 1, 2f64.powi(999));
    data.velocity[1] = [2f64.powi(800), 0.0, 0.0];
    let mut scene = build::scene::<f64>(&data);
    let before = build::bits(&scene);
    let made = Method::Verlet.step(&mut scene, options(h, 1e-12), (), &[]);
    assert!(matches!(made, Err(hooke::StepError::NotFinite(_))), "{made:?}");
    assert_eq!(build::bits(&scene), before);
}

#[test]
fn every_method_tells_how_many_springs_join_nothing_but_pins() {
    for method in hooke_tests::methods::ALL {
        let (mut data, _) = scene(ALL[0]);
        data.spring(0, 4, 10.0);
        data.spring(4, 0, 10.0);
        let report = method.step(&mut build::scene::<f64>(&data), options(0.01, 1e-10), (), &[]).unwrap();
        assert_eq!((report.springs_skipped, report.islands), (2, 1), "{method:?}");
    }
}
