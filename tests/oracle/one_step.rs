//! One step against the dense solve, and against itself with the springs in another order: no further apart than the bounds
//! and the stated rounding of assembly allow.

use std::cell::Cell;

use hooke::{BlockJacobi, Real, Solver, WideJacobi};
use hooke_harness::scene::Model;
use hooke_harness::scene::renumber::Numbering;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{MotionData, SceneData, distance};
use hooke_tests::dense::Dense;
use hooke_tests::direct;
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::lanes::{single, wide};
use hooke_tests::multigrid::multigrid;
use hooke_tests::random::Random;
use hooke_tests::triangular::{ilu, ssor};
use hooke_tests::{allowed, textbook};
use nalgebra::DVector;

/// A random network that moves; sometimes its pins do too.
fn network(random: &mut Random) -> (SceneData, Vec<MotionData>) {
    let with = Ingredients {
        pins: random.chance(0.6),
        compressed: random.chance(0.4),
        damped: random.chance(0.5),
        points: random.chance(0.3),
        gravity: random.chance(0.7),
        moving: true,
    };
    let mut data = generate::network(random, 10, with);
    data.mass.iter_mut().for_each(|m| *m = m.clamp(0.05, 2.0));
    let mut motion = Vec::new();
    for particle in 0..data.len() {
        if data.pinned[particle] && random.chance(0.5) {
            let mut position = data.position[particle];
            position.iter_mut().zip(random.vector(0.05)).for_each(|(x, d)| *x += d);
            motion.push(MotionData { particle, position, velocity: random.vector(1.0) });
        }
    }
    (data, motion)
}

/// How far, in the A-norm √(J), rounding in the assembly can move the solution: ‖A⁻¹δ‖_A ≤ |δ|/√μ, with
/// |δ| ≤ C u Σ (m|v| + h k(l + l₀) + (h²k(1 + l₀/l) + hc)|Δv|) over rows, |Δv| the largest velocity difference before and after.
fn assembly_rounding(data: &SceneData, after: &SceneData, h: f64, motion: &[MotionData], unit: f64) -> f64 {
    let fastest = |velocity: &[[f64; 3]]| velocity.iter().map(|v| distance(*v, [0.0; 3])).fold(0.0, f64::max);
    let over = motion.iter().map(|m| distance(m.position, data.position[m.particle]) / h).fold(0.0, f64::max);
    let v = fastest(&data.velocity) + fastest(&after.velocity) + over;
    let mut size: f64 = data
        .mass
        .iter()
        .map(|m| m * (1.0 + h * data.drag) * (v + h * distance(data.gravity, [0.0; 3])))
        .sum();
    for (j, s) in data.springs.iter().enumerate() {
        let l = textbook::stretch_of(data, j).l;
        size += 2.0 * (h * s.k * (l + s.l0) + (h * h * s.k * (1.0 + s.l0 / l) + h * s.c) * 2.0 * v);
    }
    for (j, p) in data.points.iter().enumerate() {
        let l = textbook::stretch_of_point(data, j).l;
        size += h * p.k * (l + p.l0) + h * h * p.k * (1.0 + p.l0 / l) * v;
    }
    // A ⪰ diag(μ), μ by the textbook after clamping.
    let clamping = textbook::clamping(data, h);
    let mut mu: Vec<f64> = data.mass.iter().map(|m| m * (1.0 + h * data.drag)).collect();
    for (j, s) in data.springs.iter().enumerate() {
        if !clamping.springs[j] {
            let weight = if data.pinned[s.a] || data.pinned[s.b] { 1.0 } else { 2.0 };
            let alpha = f64::max(0.0, -textbook::stretch_of(data, j).across());
            for end in [s.a, s.b] {
                mu[end] -= weight * h * h * alpha;
            }
        }
    }
    for (j, p) in data.points.iter().enumerate() {
        if !clamping.points[j] {
            mu[p.particle] -= h * h * f64::max(0.0, -textbook::stretch_of_point(data, j).across());
        }
    }
    let free = (0..data.len()).filter(|i| !data.pinned[*i]);
    let least = free.map(|i| mu[i]).fold(f64::INFINITY, f64::min);
    allowed::ASSEMBLY * unit * size / least.sqrt()
}

/// ‖difference of the free velocities‖_A
fn apart(dense: &Dense<'_>, h: f64, motion: &[MotionData], a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let flat = |of: &[[f64; 3]]| DVector::from_vec(of.concat());
    let e = dense.pins() * (flat(a) - flat(b));
    let form = (e.transpose() * dense.system(h, motion).matrix * &e)[(0, 0)];
    form.max(0.0).sqrt()
}

fn step<T: Real>(
    data: &SceneData,
    h: f64,
    relative: f64,
    motion: &[MotionData],
    solver: impl Solver<T>,
) -> (Vec<[f64; 3]>, f64, u32) {
    let mut scene = build::scene::<T>(data);
    let mut forces = Forces::<T>::new(data);
    let mut euler = forces.euler(T::from_f64(h)).tolerance(T::from_f64(relative)).solver(solver);
    let report = scene.step_moving(&mut euler, &build::motions(motion)).unwrap();
    (build::velocities(&scene), report.upper.to_f64(), report.clamped)
}

fn against_dense<T: Real, S: Solver<T>>(
    relatives: &[f64],
    unit: f64,
    seed: u64,
    solver: impl Fn(&SceneData) -> S,
) {
    let mut random = Random::new(Random::seed(seed));
    let (mut with_clamping, mut closest) = (0, f64::INFINITY);
    for case in 0..60 {
        let (data, motion) = network(&mut random);
        let data = data.rounded_to_f32();
        let motion: Vec<MotionData> = motion
            .iter()
            .map(|m| MotionData { position: m.position.map(|x| f64::from(x as f32)), ..*m })
            .collect();
        let h = f64::from(random.decade(1e-3, 0.03) as f32);
        if data.pinned.iter().all(|pinned| *pinned) {
            continue;
        }
        let dense = Dense::new(&data);
        let (after, clamped) = dense.step(h, &motion);
        for relative in relatives {
            let (velocity, upper, count) = step::<T>(&data, h, *relative, &motion, solver(&data));
            assert_eq!(count as usize, clamped, "case {case}");
            let off = apart(&dense, h, &motion, &velocity, &after.velocity);
            let rounding = assembly_rounding(&data, &after, h, &motion, unit);
            let allowed = (2.0 * upper).sqrt() + rounding;
            assert!(
                off <= allowed,
                "case {case}, R = {relative:e}: {off:e} of {allowed:e} ({rounding:e} rounding)"
            );
            closest = closest.min(allowed / off);
        }
        with_clamping += usize::from(clamped > 0);
    }
    println!(
        "against the dense solve: {with_clamping} of 60 with clamping; allowed/seen at least {closest:.2}"
    );
    assert!(with_clamping >= 5);
}

#[test]
fn one_step_is_the_dense_solve_within_the_bound_in_f64() {
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 1, |_| BlockJacobi);
}

#[test]
fn one_step_is_the_dense_solve_within_the_bound_in_f32() {
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 2, |_| BlockJacobi);
}

#[test]
fn a_direct_step_is_the_dense_solve_within_the_bound_whatever_the_tolerance() {
    against_dense::<f64, _>(&[1e-1, 1e-8, 1e-12], allowed::U64, 11, direct::banded);
    against_dense::<f64, _>(&[1e-1, 1e-8, 1e-12], allowed::U64, 12, direct::sparse);
    against_dense::<f32, _>(&[1e-1, 1e-4, 1e-12], allowed::U32, 13, direct::banded);
    against_dense::<f32, _>(&[1e-1, 1e-4, 1e-12], allowed::U32, 14, direct::sparse);
}

#[test]
fn a_step_with_a_factor_in_less_precision_is_the_dense_solve_within_the_bound() {
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 21, direct::single);
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 22, direct::single);
}

#[test]
fn a_step_of_ssor_or_d_ilu_is_the_dense_solve_within_the_bound() {
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 17, ssor);
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 18, ssor);
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 19, ilu);
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 20, ilu);
}

#[test]
fn a_step_in_lanes_is_the_dense_solve_within_the_bound_on_nets_of_any_shape() {
    let laid_out = Cell::new(0);
    let counted = |data: &SceneData| {
        let layout = WideJacobi::needs_of(&mut build::scene::<f64>(data), true).0 > 0;
        laid_out.set(laid_out.get() + usize::from(layout));
        wide(data)
    };
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 23, counted);
    assert!(laid_out.get() > 60, "{} solves in lanes", laid_out.get());
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 24, wide);
}

#[test]
fn a_step_in_lanes_with_iterations_in_less_precision_is_the_dense_solve_within_the_bound() {
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 25, single);
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 26, single);
}

#[test]
fn a_multigrid_step_is_the_dense_solve_within_the_bound() {
    against_dense::<f64, _>(&[1e-1, 1e-3, 1e-6, 1e-8], allowed::U64, 15, multigrid);
    against_dense::<f32, _>(&[1e-1, 1e-3, 1e-4], allowed::U32, 16, multigrid);
}

#[test]
fn moving_pins_reach_their_end_and_velocity_as_in_the_dense_scheme() {
    let mut random = Random::new(3);
    let (mut data, mut motion) = network(&mut random);
    while motion.is_empty() {
        (data, motion) = network(&mut random);
    }
    let (after, _) = Dense::new(&data).step(0.01, &motion);
    let mut scene = build::scene::<f64>(&data);
    let mut forces = Forces::<f64>::new(&data);
    scene.step_moving(&mut forces.euler(0.01).tolerance(1e-12), &build::motions(&motion)).unwrap();
    for m in &motion {
        assert_eq!(scene.positions()[m.particle], after.position[m.particle]);
        assert_eq!(scene.velocities()[m.particle], after.velocity[m.particle]);
    }
}

/// Two steps from one state, with their bounds, differ by no more than the two bounds and the rounding of assembly.
fn within_the_two_bounds(
    data: &SceneData,
    h: f64,
    motion: &[MotionData],
    [(a, upper_a), (b, upper_b)]: [(Vec<[f64; 3]>, f64); 2],
    unit: f64,
    of: &str,
) {
    let dense = Dense::new(data);
    let (after, _) = dense.step(h, motion);
    let off = apart(&dense, h, motion, &a, &b);
    let rounding = assembly_rounding(data, &after, h, motion, unit);
    let allowed = (2.0 * upper_a).sqrt() + (2.0 * upper_b).sqrt() + 2.0 * rounding;
    assert!(off <= allowed, "{of}: {off:e} of {allowed:e}");
}

fn permuted<T: Real>(relatives: &[f64], unit: f64, seed: u64) {
    let mut random = Random::new(Random::seed(seed));
    for case in 0..60 {
        let (data, motion) = network(&mut random);
        let data = data.rounded_to_f32();
        if data.pinned.iter().all(|pinned| *pinned) {
            continue;
        }
        let h = f64::from(random.decade(1e-3, 0.03) as f32);
        let mut shuffled = data.clone();
        shuffled.springs =
            random.permutation(data.springs.len()).into_iter().map(|j| data.springs[j]).collect();
        for relative in relatives {
            let (a, upper_a, clamped_a) = step::<T>(&data, h, *relative, &motion, BlockJacobi);
            let (b, upper_b, clamped_b) = step::<T>(&shuffled, h, *relative, &motion, BlockJacobi);
            assert_eq!(clamped_a, clamped_b);
            let steps = [(a, upper_a), (b, upper_b)];
            within_the_two_bounds(&data, h, &motion, steps, unit, &format!("case {case}, R = {relative:e}"));
        }
    }
}

#[test]
fn permuting_the_springs_moves_one_step_by_no_more_than_the_two_bounds_and_rounding() {
    permuted::<f64>(&[1e-2, 1e-6, 1e-12], allowed::U64, 4);
    permuted::<f32>(&[1e-2, 1e-4], allowed::U32, 5);
}

/// Reverse Cuthill–McKee, and the scene and its pins' motion in that numbering.
fn renumbered(data: &SceneData, motion: &[MotionData]) -> (Numbering, SceneData, Vec<MotionData>) {
    let mut model = Model::at_rest("", data.position.clone(), 1.0);
    (model.velocity, model.mass, model.pinned) =
        (data.velocity.clone(), data.mass.clone(), data.pinned.clone());
    for (j, spring) in data.springs.iter().enumerate() {
        model.join(spring.a, spring.b, j as f64);
    }
    let numbering = Numbering::reverse_cuthill_mckee(&model);
    let new = numbering.model(&model);
    let mut number = vec![0; data.len()];
    (0..data.len()).for_each(|i| number[numbering.users_particle(i)] = i);
    let mut moved = data.clone();
    (moved.position, moved.velocity, moved.mass, moved.pinned) =
        (new.position, new.velocity, new.mass, new.pinned);
    let spring = |s: &hooke_harness::scene::ModelSpring| {
        let [a, b] = s.ends;
        hooke_tests::data::SpringData { a, b, ..data.springs[s.stiffness as usize] }
    };
    moved.springs = new.springs.iter().map(spring).collect();
    moved.points.iter_mut().for_each(|point| point.particle = number[point.particle]);
    let motion = motion.iter().map(|m| MotionData { particle: number[m.particle], ..*m }).collect();
    (numbering, moved, motion)
}

fn in_another_numbering<T: Real>(relatives: &[f64], unit: f64, seed: u64) {
    let mut random = Random::new(Random::seed(seed));
    let mut other_numbers = 0;
    for case in 0..60 {
        let (data, motion) = network(&mut random);
        let data = data.rounded_to_f32();
        if data.pinned.iter().all(|pinned| *pinned) {
            continue;
        }
        let h = f64::from(random.decade(1e-3, 0.03) as f32);
        let (numbering, new, new_motion) = renumbered(&data, &motion);
        other_numbers += usize::from(new.position != data.position);
        for relative in relatives {
            let (a, upper_a, clamped_a) = step::<T>(&data, h, *relative, &motion, BlockJacobi);
            let (b, upper_b, clamped_b) = step::<T>(&new, h, *relative, &new_motion, BlockJacobi);
            assert_eq!(clamped_a, clamped_b);
            let steps = [(a, upper_a), (numbering.restored(&b), upper_b)];
            within_the_two_bounds(&data, h, &motion, steps, unit, &format!("case {case}, R = {relative:e}"));
        }
    }
    assert!(other_numbers > 30);
}

#[test]
fn renumbering_the_particles_moves_one_step_by_no_more_than_the_two_bounds_and_rounding() {
    in_another_numbering::<f64>(&[1e-2, 1e-6, 1e-12], allowed::U64, 6);
    in_another_numbering::<f32>(&[1e-2, 1e-4], allowed::U32, 7);
}
