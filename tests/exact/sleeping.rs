//! Sleeping: what the rule stops, that skipping changes no bit, and the work not done.

use std::cell::Cell;

use hooke::solver::Problem;
use hooke::{
    BlockJacobi, Drag, Force, Gravity, LinearlyImplicitEuler, PointForce, PointSpring, Real, Report, Rest,
    Sleep, Sleeping, Solve, Solver, Spring, SpringDamping, StepError, Stop,
};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{direct, generate, lanes, multigrid};

pub(crate) type Memory<T> = Sleeping<T, Vec<T>, Vec<u32>>;

/// The rule with a memory for so many particles and springs.
pub(crate) fn memory<T: Real>(joules: f64, particles: usize, springs: usize) -> Memory<T> {
    let (numbers, words) = Sleeping::needs(particles, springs);
    Sleeping::new(T::from_f64(joules), vec![T::ZERO; numbers], vec![0; words])
}

/// The same with some room for what is added later.
pub(crate) fn roomy<T: Real>(joules: f64, data: &SceneData) -> Memory<T> {
    memory(joules, data.len() + 4, data.springs.len() + 4)
}

/// Two hanging nets and a hanging rope in strong drag, which come to rest one after the other.
pub(crate) fn hanging() -> SceneData {
    let mut data = SceneData { gravity: [0.0, -9.81, 0.0], drag: 6.0, ..SceneData::default() };
    for (net, x) in [(generate::cloth(3), 0.0), (generate::cloth(3), 3.0), (generate::rope(4), 6.0)] {
        let first = data.len();
        for i in 0..net.len() {
            let [at, y, z] = net.position[i];
            let particle = data.particle([at + x, y, z], net.mass[i] * (1.0 + x));
            data.pinned[particle] = net.pinned[i];
        }
        let moved = |s: &hooke_tests::data::SpringData| hooke_tests::data::SpringData {
            a: s.a + first,
            b: s.b + first,
            ..*s
        };
        data.springs.extend(net.springs.iter().map(moved));
    }
    data
}

pub(crate) const DT: f64 = 1.0 / 60.0;
pub(crate) const JOULES: f64 = 1e-5;

pub(crate) type Set<T> = (((((), Gravity<T>), Drag<T>), SpringDamping<T>), PointForce<T>);

/// The forces that the tests change.
pub(crate) fn set<T: Real>(data: &SceneData) -> Set<T> {
    let forces = (((), Gravity(build::real3(data.gravity))), Drag(T::from_f64(data.drag)));
    ((forces, SpringDamping(T::from_f64(0.01))), PointForce { particle: 3, force: [T::ZERO; 3] })
}

/// A method under these forces that does so about islands at rest.
pub(crate) fn euler<T: Real, Z: Sleep<T>>(
    dt: f64,
    absolute: f64,
    forces: Set<T>,
    sleep: Z,
) -> LinearlyImplicitEuler<T, Set<T>, BlockJacobi, Z> {
    let ((((_, gravity), drag), damping), load) = forces;
    LinearlyImplicitEuler::new(T::from_f64(dt))
        .with(gravity)
        .with(drag)
        .with(damping)
        .with(load)
        .absolute(T::from_f64(absolute))
        .sleeping(sleep)
}

/// A report without the number of islands asleep.
pub(crate) fn but_for_asleep<T>(report: Report<T>) -> Report<T> {
    Report { asleep: 0, ..report }
}

#[test]
fn a_method_that_does_not_name_sleeping_and_one_that_is_told_not_to_give_the_same_bits() {
    let data = generate::gentle_network(3, 12);
    let (mut a, mut b) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    let (mut of_a, mut of_b) = (Forces::<f64>::new(&data), Forces::<f64>::new(&data));
    let mut plain = of_a.euler(DT).absolute(1e-6);
    let mut told = of_b.euler(DT).absolute(1e-6).sleeping(None::<Memory<f64>>);
    for _ in 0..50 {
        assert_eq!(a.step(&mut plain).unwrap(), b.step(&mut told).unwrap());
        assert_eq!(build::bits(&a), build::bits(&b));
    }
}

/// Two runs, one with the memory and one with the rule alone; answers how many islands were asleep in all.
fn runs_alike<T: Real>(data: &SceneData, steps: usize, joules: f64) -> u32 {
    let (mut asleep, mut awake) = (build::scene::<T>(data), build::scene::<T>(data));
    let h = T::from_f64(DT);
    let (mut of_asleep, mut of_awake) = (Forces::<T>::new(data), Forces::<T>::new(data));
    let absolute = T::from_f64(joules);
    let mut sleeping = of_asleep.euler(h).absolute(absolute).sleeping(roomy(joules, data));
    let mut resting = of_awake.euler(h).absolute(absolute).sleeping(Rest(absolute));
    let mut skipped = 0;
    for step in 0..steps {
        let (a, b) = (asleep.step(&mut sleeping).unwrap(), awake.step(&mut resting).unwrap());
        assert_eq!(b.asleep, 0);
        assert_eq!(but_for_asleep(a), b, "step {step}");
        assert_eq!(build::bits(&asleep), build::bits(&awake), "step {step}");
        skipped += a.asleep;
    }
    skipped
}

#[test]
fn an_island_asleep_has_the_bits_and_the_report_of_one_that_is_assembled_at_rest() {
    assert!(runs_alike::<f64>(&hanging(), 600, JOULES) > 300);
    assert!(runs_alike::<f32>(&hanging(), 600, JOULES) > 300);
    let mut clamped = 0;
    for seed in 0..8 {
        let mut data = generate::gentle_network(seed, 9);
        (data.drag, data.points) = (8.0, Vec::new());
        // Half of them pushed together, so that what rests is not certified without projection.
        for s in data.springs.iter_mut().filter(|_| seed % 2 == 0) {
            (s.k, s.l0) = (100.0 * s.k, 2.0 * s.l0);
        }
        clamped += runs_alike::<f64>(&data, 400, 1e-3);
    }
    assert!(clamped > 100, "{clamped}");
}

#[test]
fn two_scenes_side_by_side_one_of_them_asleep_give_the_other_the_bits_it_has_alone() {
    let (mut both, mut alone) = (VecScene::<f64>::empty(), VecScene::<f64>::empty());
    // Two at rest, between and before three that swing.
    let resting = [0, 2].map(|y| both.particle([5.0, f64::from(y), 0.0], 1.0).unwrap());
    both.spring(resting[0], resting[1], 100.0).unwrap();
    let mut swinging = Vec::new();
    for (i, x) in [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [2.0, 0.0, 1.0]].into_iter().enumerate() {
        alone.particle(x, 0.5).unwrap();
        swinging.push(both.particle(x, 0.5).unwrap());
        if i > 0 {
            let stretched = Spring { stiffness: 50.0, rest_length: 0.5 };
            alone.spring_with(i - 1, i, stretched).unwrap();
            both.spring_with(swinging[i - 1], swinging[i], stretched).unwrap();
        }
    }
    let mut plain = LinearlyImplicitEuler::new(DT).absolute(1e-12);
    let mut sleeping = LinearlyImplicitEuler::new(DT).absolute(1e-12).sleeping(memory(0.0, 5, 3));
    for step in 0..100 {
        alone.step(&mut plain).unwrap();
        let report = both.step(&mut sleeping).unwrap();
        assert_eq!((report.islands, report.asleep), (2, u32::from(step > 0)));
        assert_eq!(build::bits(&both)[2..], build::bits(&alone));
    }
}

/// Counts the solves that it is asked for.
struct Counted<'a>(&'a Cell<u32>);

impl<T: Real> Solver<T> for Counted<'_> {
    fn solve<F: Force<T>>(
        &mut self,
        problem: Problem<'_, '_, T, F>,
        stop: &Stop<T>,
    ) -> Result<Solve<T>, StepError> {
        self.0.set(self.0.get() + 1);
        BlockJacobi.solve(problem, stop)
    }
}

/// No damping, but counts how often it is asked for that of a spring: once when a spring is assembled, once when it is
/// compared with what is remembered.
struct Asked<'a>(&'a Cell<u32>);

impl Force<f64> for Asked<'_> {
    const DAMPS: bool = true;
    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn damping(&self, _: usize) -> f64 {
        self.0.set(self.0.get() + 1);
        0.0
    }
}

#[test]
fn an_island_asleep_is_compared_and_neither_assembled_nor_solved() {
    let mut scene = VecScene::<f64>::empty();
    for x in 0..4 {
        scene.particle([f64::from(x), 0.0, 0.0], 1.0).unwrap();
    }
    for a in 0..3 {
        scene.spring(a, a + 1, 100.0).unwrap();
    }
    let (solves, asked) = (Cell::new(0), Cell::new(0));
    let mut euler = LinearlyImplicitEuler::new(DT)
        .with(Asked(&asked))
        .absolute(1e-9)
        .solver(Counted(&solves))
        .sleeping(memory(1e-9, 4, 3));
    let mut work = |scene: &mut VecScene<f64>| {
        let report = scene.step(&mut euler).unwrap();
        (solves.take(), asked.take(), report.asleep, report.iterations)
    };
    assert_eq!(work(&mut scene), (0, 6, 0, 0), "at rest: compared, assembled, not solved");
    assert_eq!(work(&mut scene), (0, 3, 1, 0), "asleep: compared");
    assert_eq!(work(&mut scene), (0, 3, 1, 0));
    scene.set_velocity(0, [1.0, 0.0, 0.0]).unwrap();
    let (solves, asked, asleep, iterations) = work(&mut scene);
    assert_eq!((solves, asked, asleep), (1, 3, 0), "moving: assembled and solved, not compared");
    assert!(iterations > 0);
}

/// A particle of 2 kg that no force acts on, with a kinetic energy of v² J.
pub(crate) fn thrown(v: f64) -> VecScene<f64> {
    let mut scene = VecScene::empty();
    scene.particle([0.5; 3], 2.0).unwrap();
    scene.set_velocity(0, [v, 0.0, 0.0]).unwrap();
    scene
}

#[test]
fn an_island_comes_to_rest_exactly_where_its_kinetic_energy_is_at_most_j() {
    for (joules, stops) in [(0.25, true), (0.25 - 1e-16, false), (0.25 + 1e-16, true), (0.0, false)] {
        let mut scene = thrown(0.5);
        let report = scene.step(&mut LinearlyImplicitEuler::new(0.125).sleeping(Rest(joules))).unwrap();
        let (x, v) = if stops { (0.5, 0.0) } else { (0.5625, 0.5) };
        assert_eq!((scene.positions()[0][0], scene.velocities()[0][0]), (x, v), "J = {joules}");
        // The equation's answer is to go on: what was taken away is the error, and inside its bounds.
        let lost = if stops { 0.25 } else { 0.0 };
        assert!(report.lower <= lost && lost <= report.upper, "{report:?}");
        assert!(report.upper < lost * (1.0 + 1e-13) + 1e-300 && report.lower > lost * (1.0 - 1e-13) - 1e-300);
    }
}

#[test]
fn an_island_comes_to_rest_only_where_nothing_would_move_it() {
    // From rest, gravity would give it ½ m g²h² = 1/64 J: a particle at its highest point is slow, but falls.
    for (absolute, stops) in [(0.015_626, true), (0.015_624, false), (0.0, false)] {
        let mut scene = thrown(0.0);
        let euler = LinearlyImplicitEuler::new(0.125).gravity([0.0, -1.0, 0.0]).absolute(absolute);
        scene.step(&mut euler.sleeping(Rest(1.0))).unwrap();
        assert_eq!(scene.velocities()[0][1], if stops { 0.0 } else { -0.125 }, "{absolute}");
    }
}

#[test]
fn with_zero_for_both_energies_the_rule_stops_nothing_and_changes_no_bit() {
    for seed in 0..5 {
        let data = generate::gentle_network(seed, 12);
        let (mut a, mut b) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
        let (mut of_a, mut of_b) = (Forces::<f64>::new(&data), Forces::<f64>::new(&data));
        let (mut plain, mut sleeping) = (of_a.euler(DT), of_b.euler(DT).sleeping(roomy(0.0, &data)));
        for _ in 0..50 {
            assert_eq!(a.step(&mut plain).unwrap(), b.step(&mut sleeping).unwrap());
            assert_eq!(build::bits(&a), build::bits(&b));
        }
    }
}

#[test]
fn an_island_that_a_point_spring_holds_comes_to_rest_but_is_never_asleep() {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    let hold = PointSpring::new(0, [0.0; 3], 10.0);
    let mut euler = LinearlyImplicitEuler::new(DT).with(hold).absolute(1e-9).sleeping(memory(1e-9, 1, 0));
    for _ in 0..5 {
        let report = scene.step(&mut euler).unwrap();
        assert_eq!((report.untouched, report.asleep), (1, 0));
    }
    euler.forces.1.target = [1.0, 0.0, 0.0];
    scene.step(&mut euler).unwrap();
    assert!(scene.velocities()[0][0] > 0.0);
}

/// Three ropes in a row, of which the first soon sleeps, the third wakes again, and the second swings.
fn solves_on<S: Solver<f64>>(solver: impl Fn(&SceneData) -> S) {
    let mut data = SceneData::default();
    for y in 0..3 {
        for x in 0..40 {
            let i = data.particle([0.1 * f64::from(x), f64::from(y), 0.0], 0.1);
            if x > 0 {
                data.spring(i - 1, i, 1e3);
            }
        }
        data.velocity[40 * y as usize + 20] = [0.0, 0.0, if y == 1 { 30.0 } else { 0.0 }];
    }
    let run = |sleeps: bool| {
        let mut scene = build::scene::<f64>(&data);
        let sleep = sleeps.then(|| roomy(1e-9, &data));
        let mut euler = LinearlyImplicitEuler::new(DT).absolute(1e-9).solver(solver(&data)).sleeping(sleep);
        let mut asleep = 0;
        for step in 0..40 {
            if step % 10 == 5 {
                scene.impulse(100, [0.0, 0.0, 0.1]).unwrap();
            }
            asleep += scene.step(&mut euler).unwrap().asleep;
        }
        (build::bits(&scene)[40..80].to_vec(), asleep)
    };
    let (with, without) = (run(true), run(false));
    assert_eq!(with.0, without.0);
    assert!(with.1 > 40 && without.1 == 0, "{}", with.1);
}

#[test]
fn every_solver_goes_on_where_some_islands_need_it_not() {
    solves_on(|_| BlockJacobi);
    solves_on(direct::banded);
    solves_on(direct::sparse);
    solves_on(multigrid::multigrid);
    solves_on(lanes::wide::<f64>);
    solves_on(lanes::single::<f64>);
}

#[test]
fn what_sleeping_cannot_work_with_is_refused_and_changes_nothing() {
    let mut scene = thrown(0.5);
    let before = build::bits(&scene);
    let (numbers, words) = Sleeping::needs(1, 0);
    assert_eq!((numbers, words), (6, 2));
    for (n, w) in [(numbers - 1, words), (numbers, words - 1)] {
        let small = Sleeping::new(1.0, vec![0.0; n], vec![0; w]);
        let refused = scene.step(&mut LinearlyImplicitEuler::new(0.1).sleeping(small));
        assert_eq!(refused, Err(StepError::Workspace { numbers, words }));
    }
    for joules in [-1.0, f64::INFINITY, f64::NAN] {
        let refused = scene.step(&mut LinearlyImplicitEuler::new(0.1).sleeping(Rest(joules)));
        assert_eq!(refused, Err(StepError::Tolerance));
        let refused = scene.step(&mut LinearlyImplicitEuler::new(0.1).sleeping(memory(joules, 1, 0)));
        assert_eq!(refused, Err(StepError::Tolerance));
    }
    assert_eq!(build::bits(&scene), before);
}

#[test]
fn an_island_asleep_tells_how_many_of_its_springs_were_clamped_when_it_last_was_assembled() {
    // Between two pins, pressed by as much from both, to a tenth: h²k·9 is more than a particle weighs, and nothing moves.
    let mut scene = VecScene::<f64>::empty();
    for x in [0.0, 0.125, 0.25] {
        scene.particle([x, 0.0, 0.0], 1.0).unwrap();
    }
    for (a, b) in [(0, 1), (1, 2)] {
        scene.spring_with(a, b, hooke::Spring { stiffness: 1e4, rest_length: 1.25 }).unwrap();
    }
    scene.pin(0).unwrap();
    scene.pin(2).unwrap();
    let mut euler = LinearlyImplicitEuler::new(0.125).absolute(1e-9).sleeping(memory(1e-9, 3, 2));
    for asleep in [0, 1, 1] {
        let report = scene.step(&mut euler).unwrap();
        assert_eq!((report.asleep, report.clamped, report.certified), (asleep, 2, 0));
    }
}
