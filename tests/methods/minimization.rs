//! `newton`: its incremental potential, its goal, large steps, and what it does where it cannot converge.

use hooke::{Ending, Force, Gravity, Memory, Newton, Spring, StepError, force::Rows};
use hooke_tests::data::SceneData;
use hooke_tests::methods::{self, Method, options};
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build, generate};
use nalgebra::Vector3;

/// E(v) = ½‖v − q̇‖²_M + ½h vᵀDv + V(q + hv), D lagged in its directions; and the sum of its terms' sizes.
fn potential(data: &SceneData, h: f64, v: &[[f64; 3]]) -> (f64, f64) {
    let at = |list: &[[f64; 3]], i: usize| Vector3::from(list[i]);
    let (mut sum, mut size) = (0.0, 0.0);
    let mut add = |x: f64| {
        sum += x;
        size += x.abs();
    };
    let moved = |i: usize| at(&data.position, i) + h * at(v, i);
    for i in (0..data.len()).filter(|i| !data.pinned[*i]) {
        let (m, v) = (data.mass[i], at(v, i));
        add(0.5 * m * (v - at(&data.velocity, i)).norm_squared());
        add(0.5 * h * data.drag * m * v.norm_squared());
        add(-m * Vector3::from(data.gravity).dot(&moved(i)));
    }
    for s in data.springs.iter().filter(|s| data.acts(s)) {
        add(0.5 * s.k * ((moved(s.a) - moved(s.b)).norm() - s.l0).powi(2));
        let u = (at(&data.position, s.a) - at(&data.position, s.b)).normalize();
        add(0.5 * h * s.c * u.dot(&(at(v, s.a) - at(v, s.b))).powi(2));
    }
    for p in data.points.iter().filter(|p| !data.pinned[p.particle]) {
        add(0.5 * p.k * ((moved(p.particle) - Vector3::from(p.target)).norm() - p.l0).powi(2));
    }
    (sum, size)
}

/// −∂E/∂v by central differences, N·s per row.
fn descent(data: &SceneData, h: f64, v: &[[f64; 3]]) -> Vec<Vector3<f64>> {
    let step = 1e-5;
    let mut v = v.to_vec();
    (0..data.len())
        .map(|i| {
            Vector3::from_fn(|d, _| {
                let was = v[i][d];
                v[i][d] = was + step;
                let above = potential(data, h, &v).0;
                v[i][d] = was - step;
                let below = potential(data, h, &v).0;
                v[i][d] = was;
                (below - above) / (2.0 * step)
            })
        })
        .collect()
}

fn violent(seed: u64) -> SceneData {
    let with = generate::Ingredients {
        pins: true,
        compressed: true,
        damped: true,
        points: true,
        gravity: true,
        moving: true,
    };
    let mut data = generate::network(&mut Random::new(seed), 12, with);
    data.pinned[0] = true;
    data.velocity[0] = [0.0; 3];
    // Compressed to a quarter or stretched tenfold, but within two powers of ten of one another.
    data.mass.iter_mut().for_each(|m| *m = m.clamp(0.1, 1.0));
    data.springs.iter_mut().for_each(|s| s.k = s.k.clamp(10.0, 1e3));
    data.points.iter_mut().for_each(|p| p.k = p.k.clamp(10.0, 1e3));
    data
}

#[test]
fn the_incremental_potential_of_the_answer_is_below_that_of_rest_and_a_minimum() {
    let mut ends = [[0; 2]; 3];
    for seed in 0..30 {
        let data = violent(seed);
        for (case, h) in [1e-3, 1.0 / 60.0, 1.0].into_iter().enumerate() {
            let mut newton = build::scene::<f64>(&data);
            let before = build::bits(&newton);
            let mut forces = build::Forces::<f64>::new(&data);
            let made = Method::Newton.step(&mut newton, options(h, 1e-7), forces.all(), &[]);
            ends[case][usize::from(made.is_err())] += 1;
            if let Err(error) = made {
                assert!(matches!(error, StepError::NotConverged(_)), "seed {seed}, {h} s: {error:?}");
                assert_eq!(build::bits(&newton), before);
                continue;
            }
            let answer = build::velocities(&newton);
            let (reached, size) = potential(&data, h, &answer);
            let rounding = 1e3 * allowed::U64 * size;
            let rest = potential(&data, h, &vec![[0.0; 3]; data.len()]).0;
            assert!(reached <= rest + rounding, "seed {seed}, {h} s: {reached} above {rest} at rest");
            // No way along any axis leads lower.
            for i in (0..data.len()).filter(|i| !data.pinned[*i]) {
                for d in 0..3 {
                    for way in [1e-3, -1e-3] {
                        let mut aside = answer.clone();
                        aside[i][d] += way / h.max(1.0);
                        let there = potential(&data, h, &aside).0;
                        assert!(
                            there >= reached - rounding,
                            "seed {seed}, {h} s: particle {i} finds {there} < {reached}"
                        );
                    }
                }
            }
        }
    }
    println!("converged, and not, at 1 ms, 1/60 s, 1 s: {ends:?}");
    assert_eq!(ends[0][1], 0, "short steps converge");
}

#[test]
fn what_is_left_of_the_gradient_is_the_reported_part_of_what_it_was_at_rest() {
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 12);
        let h = 1.0 / 60.0;
        let mut scene = build::scene::<f64>(&data);
        let mut forces = build::Forces::<f64>::new(&data);
        let tolerance = 1e-4;
        let report = Method::Newton.step(&mut scene, options(h, tolerance), forces.all(), &[]).unwrap();
        // μ of a gentle scene is M + hD to a tenth: springs are hardly compressed.
        let beta = |v: &[[f64; 3]]| -> f64 {
            let rows = descent(&data, h, v).into_iter().zip(&data.mass).zip(&data.pinned);
            rows.filter(|(_, pinned)| !**pinned)
                .map(|((b, m), _)| 0.5 * b.norm_squared() / (m * (1.0 + h * data.drag)))
                .sum()
        };
        let start = beta(&vec![[0.0; 3]; data.len()]);
        let end = beta(&build::velocities(&scene));
        println!("seed {seed}: {start:.2e} J, then {end:.1e}, reported {:.1e}", report.upper);
        assert!(end <= 1.2 * tolerance * tolerance * start + 1e-14, "seed {seed}: {end:e} of {start:e}");
        assert!(report.upper <= tolerance * tolerance * start * 1.2, "{}", report.upper);
        assert_eq!((report.capped, report.stalled), (0, 0));
    }
}

#[test]
fn newton_and_euler_take_the_same_step_where_the_forces_are_linear() {
    let mut data = generate::gentle_network(4, 10);
    data.springs.iter_mut().for_each(|s| s.l0 = 0.0);
    data.springs.iter_mut().for_each(|s| s.c = 0.0);
    data.points.iter_mut().for_each(|p| p.l0 = 0.0);
    let [newton, euler] = [Method::Newton, Method::Euler]
        .map(|method| build::velocities(&method.run::<f64>(&data, options(0.1, 1e-13), 1)));
    let off = build::farthest(&newton, &euler);
    println!("{off:.1e} m/s apart");
    assert!(off <= allowed::TRAJECTORY, "{off:e}");
}

#[test]
fn a_crumpled_cloth_survives_steps_of_any_length() {
    let mut cloth = generate::cloth(6);
    let mut random = Random::new(5);
    for (x, pinned) in cloth.position.iter_mut().zip(&cloth.pinned) {
        if !pinned {
            *x = random.vector(0.3);
        }
    }
    for h in [1e-3, 1.0 / 60.0, 1.0, 1e3] {
        let mut scene = build::scene::<f64>(&cloth);
        let mut forces = build::Forces::<f64>::new(&cloth);
        for step in 0..5 {
            let report = Method::Newton.step(&mut scene, options(h, 1e-6), forces.all(), &[]);
            assert!(report.is_ok(), "{h} s, step {step}: {report:?}");
        }
        let farthest = build::positions(&scene).into_iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(farthest < 10.0, "{h} s: {farthest} m");
        if h >= 1e3 {
            // A thousand seconds under backward Euler are rest.
            let fastest =
                build::velocities(&scene).into_iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
            assert!(fastest < 1e-5, "{fastest} m/s");
        }
    }
}

/// A push of 1 N that does not say its potential.
struct Silent;

impl Force<f64> for Silent {
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn add(&self, rows: &Rows<'_, f64>, f: &mut [[f64; 3]]) {
        if let Some(f) = rows.row(1).and_then(|row| f.get_mut(row)) {
            f[0] += 1.0;
        }
    }
}

#[test]
fn a_step_that_does_not_converge_is_an_error_that_names_the_island_and_leaves_no_trace() {
    let data = generate::rope(5);
    let (mut tried, untouched) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    let error = Method::Newton.step(&mut tried, options(0.01, 1e-6), Silent, &[]);
    assert_eq!(error, Err(StepError::NotConverged(1)));
    assert_eq!(build::bits(&tried), build::bits(&untouched));
}

#[test]
fn a_solver_that_may_not_iterate_is_no_success() {
    let data = generate::rope(5);
    for method in [Method::Newton, Method::EnergyMomentum] {
        let mut scene = build::scene::<f64>(&data);
        let mut forces = build::Forces::<f64>::new(&data);
        let none = methods::Options { max_iterations: 0, ..options(0.01, 1e-6) };
        let made = method.step(&mut scene, none, forces.all(), &[]);
        assert!(made.is_err(), "{method:?}: {made:?}");
    }
}

#[test]
fn few_iterations_of_each_solve_still_reach_the_goal() {
    let data = generate::cloth(5);
    for method in [Method::Newton, Method::EnergyMomentum] {
        let few = methods::Options { max_iterations: 6, ..options(0.01, 1e-3) };
        let scene = method.run::<f64>(&data, few, 3);
        let exact = method.run::<f64>(&data, options(0.01, 1e-9), 3);
        let off = build::farthest(&build::positions(&scene), &build::positions(&exact));
        println!("{method:?}: {off:.1e} m off");
        assert!(off <= 1e-3 * 0.01, "{method:?}: {off:e}");
    }
}

fn at_rest_it_is_untouched<M: Memory<Real = f64>>(scene: &mut hooke::MassSpring<M>) {
    let memory = [[0.0; 3]; 4];
    let mut newton = Newton::new(0.01, memory).with(Gravity([0.0; 3]));
    let mut endings = Vec::new();
    scene.step_watched(&mut newton, &[], |island| endings.push(island.solve.ending)).unwrap();
    assert_eq!(endings, [Ending::Untouched]);
}

#[test]
fn what_rests_is_untouched() {
    let mut scene = VecScene::<f64>::empty();
    let (a, b) = (scene.particle([0.0; 3], 1.0).unwrap(), scene.particle([1.0, 0.0, 0.0], 1.0).unwrap());
    scene.spring(a, b, 10.0).unwrap();
    at_rest_it_is_untouched(&mut scene);
}

/// A step that the slope promised next to nothing of was once taken unseen: V went to 262, 3.1e3, 9.4e4 J. Where particles weigh
/// next to nothing, such a step leaves the numbers.
#[test]
fn from_rest_without_gravity_the_potential_stays_at_rounding_also_where_springs_are_soft_and_stiff_in_turn() {
    let mut data = generate::cloth(6);
    data.gravity = [0.0; 3];
    data.springs.iter_mut().enumerate().for_each(|(j, s)| s.k = if j % 2 == 0 { 1e-6 } else { 1e12 });
    for (mass, tolerance, steps) in [(None, 1e-4, 3), (Some(1e-30), 1e-6, 8)] {
        if let Some(mass) = mass {
            data.mass.fill(mass);
        }
        let mut scene = build::scene::<f32>(&data);
        // Rest lengths are rounded, and at 1e12 N/m that is the size of what moves: Σ ½k(u·l)².
        let unit = f64::from(f32::EPSILON);
        let rounding: f64 = data.springs.iter().map(|s| 0.5 * s.k * (unit * (1.0 + s.l0)).powi(2)).sum();
        let most = f64::from(scene.springs().potential_energy()) + rounding;
        for step in 0..steps {
            let options = methods::Options { max_iterations: 1000, ..options(1.0 / 60.0, tolerance) };
            Method::Newton.step(&mut scene, options, Gravity([0.0; 3]), &[]).unwrap();
            let v = f64::from(scene.springs().potential_energy());
            assert!(v <= most, "step {step}: {v:e} J above {most:e}");
        }
    }
}

/// All but at rest a tension is 0, and what rounds V is k(u·x)²: without it no step was flat, and none was found.
#[test]
fn two_stiff_particles_that_all_but_rest_converge() {
    let mut scene = VecScene::<f64>::empty();
    for x in [0.4, -0.4] {
        let i = scene.particle([x, 0.0, 0.0], 1.0).unwrap();
        scene.set_velocity(i, [x / 0.4 * 4.0056589580328174e-15, 0.0, 0.0]).unwrap();
    }
    scene.spring_with(0, 1, Spring { stiffness: 1e6, rest_length: 0.8 }).unwrap();
    let made = scene.step(&mut Newton::new(1.0 / 64.0, [[0.0; 3]; 4]));
    assert!(made.is_ok(), "{made:?}");
}
