//! The report's counters: each says what was done, and what was not.

use std::cell::Cell;

use hooke::force::Rows;
use hooke::{Ending, Force, Hessian, LinearlyImplicitEuler, Scaling, Spring, State, StepError};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};

/// Two particles 0.5 m apart on a spring of 1 m: s α = −h²k, c_e = 2.
fn compressed(stiffness: f64) -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene.particle([0.5, 0.0, 0.0], 1.0).unwrap();
    scene.spring_with(0, 1, Spring { stiffness, rest_length: 1.0 }).unwrap();
    scene
}

#[test]
fn a_compressed_spring_is_clamped_exactly_where_mu_is_not_positive() {
    // μ = m − 2h²k: with h = 1/16 positive below k = 128, zero there.
    for (stiffness, clamped) in [(127.0, 0), (128.0, 1), (129.0, 1), (1e6, 1)] {
        let mut scene = compressed(stiffness);
        let report = scene.step(&mut LinearlyImplicitEuler::new(1.0 / 16.0)).unwrap();
        assert_eq!((report.clamped, report.is_certified()), (clamped, clamped == 0), "k = {stiffness}");
    }
}

#[test]
fn a_pinned_or_point_end_counts_once_in_the_certificate() {
    // μ = m − h²k: positive below k = 256.
    for (stiffness, clamped) in [(255.0, 0), (256.0, 1)] {
        let mut scene = compressed(stiffness);
        scene.pin(0).unwrap();
        let report = scene.step(&mut LinearlyImplicitEuler::new(1.0 / 16.0)).unwrap();
        assert_eq!(report.clamped, clamped, "pin, k = {stiffness}");
        let mut scene = VecScene::<f64>::empty();
        scene.particle([0.5, 0.0, 0.0], 1.0).unwrap();
        let point = hooke::PointSpring::new(0, [0.0; 3], stiffness).rest_length(1.0);
        let report = scene.step(&mut LinearlyImplicitEuler::new(1.0 / 16.0).with(point)).unwrap();
        assert_eq!(
            (report.clamped, report.certified),
            (clamped, u32::from(clamped == 0)),
            "point, k = {stiffness}"
        );
    }
}

#[test]
fn drag_helps_the_certificate() {
    // m + h d m = 2: positive below k = 256 instead of 128.
    for (stiffness, clamped) in [(255.0, 0), (256.0, 1)] {
        let mut euler = LinearlyImplicitEuler::new(1.0 / 16.0).with(hooke::Drag(16.0));
        assert_eq!(compressed(stiffness).step(&mut euler).unwrap().clamped, clamped);
    }
}

#[test]
fn only_compressed_springs_at_failing_nodes_are_clamped() {
    // 0 –stretched– 1 –compressed, stiff– 2   3 –compressed, soft– 4 –soft– 2
    let mut scene = VecScene::<f64>::empty();
    for x in 0..5 {
        scene.particle([f64::from(x), 0.0, 0.0], 1.0).unwrap();
    }
    let spring = |stiffness, rest_length| Spring { stiffness, rest_length };
    scene.spring_with(0, 1, spring(1e6, 0.5)).unwrap();
    scene.spring_with(1, 2, spring(1e6, 2.0)).unwrap();
    scene.spring_with(3, 4, spring(1e-3, 2.0)).unwrap();
    scene.spring_with(4, 2, spring(1e-3, 4.0)).unwrap();
    let report = scene.step(&mut LinearlyImplicitEuler::new(0.1)).unwrap();
    // Spring 1 makes nodes 1 and 2 fail; spring 3 meets node 2; springs 0 (stretched) and 2 (elsewhere) stay.
    assert_eq!(report.clamped, 2);
}

#[test]
fn with_no_iteration_allowed_nothing_is_solved_and_the_report_says_so() {
    let data = generate::rope(10);
    let mut scene = build::scene::<f64>(&data);
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity).max_iterations(0);
    let report = scene.step(&mut euler).unwrap();
    assert_eq!((report.iterations, report.capped, report.untouched), (0, 1, 0));
    assert!(0.0 < report.lower && report.lower <= report.upper);
    assert_eq!(scene.velocities(), vec![[0.0; 3]; 10]);
}

#[test]
fn the_report_is_the_sum_of_its_islands() {
    let mut scene = VecScene::<f64>::empty();
    for i in 0..6 {
        scene.particle([f64::from(i), 0.0, 0.0], 1.0).unwrap();
    }
    for a in [0, 2, 4] {
        scene.spring_with(a, a + 1, Spring { stiffness: 1e3 * (a + 1) as f64, rest_length: 1.5 }).unwrap();
    }
    scene.set_position(5, [5.5, 0.0, 0.0]).unwrap();
    let mut islands = Vec::new();
    let mut euler = LinearlyImplicitEuler::new(0.1);
    let report = scene.step_watched(&mut euler, &[], |island| islands.push(*island)).unwrap();
    assert_eq!(report.islands as usize, islands.len());
    assert_eq!(report.iterations, islands.iter().map(|i| i.solve.iterations).sum::<u32>());
    assert_eq!(report.clamped, islands.iter().map(|i| i.clamped).sum::<u32>());
    assert_eq!(report.certified as usize, islands.iter().filter(|i| i.certified).count());
    let ended = |ending| islands.iter().filter(|i| i.solve.ending == ending).count();
    assert_eq!(report.untouched as usize, ended(Ending::Untouched));
    assert_eq!(report.at_floor as usize, ended(Ending::Floor));
    assert_eq!(report.clamped, 2, "the last spring is at its rest length");
    assert_eq!(report.untouched, 1);
}

#[test]
fn one_free_particle_on_many_springs_is_solved_in_one_iteration() {
    // Its diagonal block is all of A, so block Jacobi is exact.
    let mut scene = VecScene::<f64>::empty();
    let i = scene.particle([0.1, 0.2, 0.3], 1.0).unwrap();
    for x in [[1.0, 0.0, 0.0], [0.0, 2.0, 0.5], [-1.0, -1.0, 1.0], [0.5, 0.0, -3.0]] {
        let pin = scene.particle(x, 1.0).unwrap();
        scene.pin(pin).unwrap();
        scene.spring_with(i, pin, Spring { stiffness: 1e3, rest_length: 0.5 }).unwrap();
    }
    let report = scene.step(&mut LinearlyImplicitEuler::new(0.1).tolerance(1e-8)).unwrap();
    assert_eq!(report.iterations, 1);
}

/// How often a step asks a force for what.
#[derive(Default)]
struct Counts {
    add: Cell<u32>,
    damping: Cell<u32>,
    hessians: Cell<u32>,
    clamp: Cell<u32>,
    energy: Cell<u32>,
}

/// A force of all kinds, all of them 0, that counts.
struct Counting<'a>(&'a Counts);

fn one_more(count: &Cell<u32>) {
    count.set(count.get() + 1);
}

impl Force<f64> for Counting<'_> {
    const DAMPS: bool = true;
    const ANCHORS: bool = true;
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn add(&self, _: &Rows<'_, f64>, _: &mut [[f64; 3]]) {
        one_more(&self.0.add);
    }
    fn damping(&self, _: usize) -> f64 {
        one_more(&self.0.damping);
        0.0
    }
    fn clamp(&mut self, _: &Rows<'_, f64>, _: Scaling<f64>, _: impl Fn(usize) -> bool) -> u32 {
        one_more(&self.0.clamp);
        0
    }
    fn hessians(&self, rows: &Rows<'_, f64>, visit: &mut impl FnMut(usize, Hessian<f64>)) {
        one_more(&self.0.hessians);
        if let Some(row) = rows.row(1) {
            visit(row, Hessian::default());
        }
    }
    fn potential_energy(&self, _: State<'_, f64>) -> f64 {
        one_more(&self.0.energy);
        0.0
    }
}

#[test]
fn where_every_node_is_certified_no_projection_pass_is_made() {
    // Assembling asks for a spring's damping, clamping it asks again.
    for (stiffness, passes) in [(127.0, 0), (128.0, 1)] {
        let counts = Counts::default();
        let mut euler = LinearlyImplicitEuler::new(1.0 / 16.0).with(Counting(&counts));
        let report = compressed(stiffness).step(&mut euler).unwrap();
        assert_eq!((counts.clamp.get(), counts.damping.get()), (passes, 1 + passes), "k = {stiffness}");
        assert_eq!((report.clamped, report.certified), (passes, 1 - passes));
    }
}

#[test]
fn an_iteration_is_one_product_a_check_another_and_a_start_that_meets_the_tolerance_needs_neither() {
    let mut data = generate::rope(10);
    // Not straight, so that one iteration is not enough.
    (data.position[4][1], data.position[7][2]) = (0.05, 0.03);
    // Every product, and nothing else that differs between these, asks for the point springs.
    let products = |max_iterations: u32, absolute: f64| {
        let counts = Counts::default();
        let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0)
            .gravity(data.gravity)
            .with(Counting(&counts))
            .tolerance(0.0)
            .absolute(absolute)
            .max_iterations(max_iterations);
        let report = build::scene::<f64>(&data).step(&mut euler).unwrap();
        (counts.hessians.get(), report.iterations, report.untouched)
    };
    let (none, ..) = products(0, 0.0);
    for n in 1..6 {
        assert_eq!(products(n, 0.0), (none + n + 1, n, 0));
    }
    assert_eq!(products(100, 1e3), (none, 0, 1));
}

#[test]
fn a_step_asks_a_force_once_for_all_islands_and_for_no_energy() {
    let mut scene = VecScene::<f64>::empty();
    for i in 0..6 {
        scene.particle([f64::from(i), 0.0, 0.0], 1.0).unwrap();
    }
    for a in [0, 2, 4] {
        scene.spring(a, a + 1, 100.0).unwrap();
    }
    scene.set_velocity(3, [1.0, 0.0, 0.0]).unwrap();
    let counts = Counts::default();
    let mut euler = LinearlyImplicitEuler::new(0.1).with(Counting(&counts));
    assert_eq!(scene.step(&mut euler).unwrap().islands, 3);
    assert_eq!((counts.add.get(), counts.damping.get(), counts.energy.get()), (1, 3, 0));
    // What is asked for is computed, and only then.
    scene.reaction(0, &euler.forces).unwrap();
    euler.forces.potential_energy(scene.state());
    assert_eq!((counts.add.get(), counts.energy.get()), (2, 1));
}
