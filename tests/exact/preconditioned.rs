//! What the tests of the preconditioners M = (P + L)P⁻¹(P + Lᵀ) share.

use hooke::{Ending, IslandReport, LinearlyImplicitEuler, Real, Solver, StepError, System};
use hooke_tests::build::{self, Everything, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::{allowed, generate, triangular};
use nalgebra::{DMatrix, Matrix3};

pub const H: f64 = 1.0 / 60.0;

/// Moved by some steps, so that springs are compressed, stretched and turned.
pub fn moved(mut data: SceneData, steps: usize) -> SceneData {
    let (mut scene, mut forces) = (build::scene::<f64>(&data), Forces::<f64>::new(&data));
    let mut euler = forces.euler(H);
    for _ in 0..steps {
        scene.step(&mut euler).unwrap();
    }
    build::read_back(&scene, &mut data);
    data
}

/// Calls `check` with every island's system and μ.
pub fn with_systems<T: Real>(
    data: &SceneData,
    h: f64,
    mut check: impl FnMut(&System<'_, T, Everything<'_, T>>, &[T]),
) {
    let (mut scene, mut forces) = (build::scene::<T>(data), Forces::<T>::new(data));
    let mut euler = forces.euler(T::from_f64(h));
    euler.inspect(scene.parts(), &[], |system, _, mu| check(system, mu)).unwrap();
}

/// Nets with everything that a diagonal block consists of, and springs beside each other.
fn nets() -> Vec<SceneData> {
    let mut doubled = generate::chain(20);
    for i in 1..20 {
        doubled.spring_with(i, i - 1, 2e3, 0.01);
    }
    let nets =
        [generate::cloth(6), generate::lattice(3, 3, 3), generate::blob(2, 1), generate::chain(30), doubled];
    let mut nets: Vec<_> = nets.into_iter().map(|data| moved(data, 8)).collect();
    nets.extend((0..6).map(|seed| moved(generate::gentle_network(seed, 20), 2)));
    nets
}

/// M z = r with M built densely from `pivots`; M⁻¹ is symmetric and positive. Answers the largest relative miss of a row.
pub fn agrees_with_its_definition<T: Real, A>(
    apply: A,
    pivots: impl Fn(&DMatrix<f64>) -> Vec<Matrix3<f64>>,
) -> f64
where
    A: Fn(&SceneData, &System<'_, T, Everything<'_, T>>, &[[T; 3]], &mut [[T; 3]]) -> T,
{
    let (mut random, mut worst) = (Random::new(Random::seed(3)), 0.0_f64);
    for data in nets() {
        with_systems::<T>(&data, H, |system, mu| {
            let matrix = triangular::matrix(system);
            let dense = triangular::preconditioner(&matrix, &pivots(&matrix));
            for _ in 0..5 {
                let size = random.decade(1e-8, 1e8);
                let mut vector =
                    || -> Vec<[T; 3]> { mu.iter().map(|_| random.vector(size).map(T::from_f64)).collect() };
                let [r, s] = [vector(), vector()];
                let [mut z, mut y] = [vec![[T::ZERO; 3]; mu.len()], vec![[T::ZERO; 3]; mu.len()]];
                let rz = apply(&data, system, &r, &mut z).to_f64();
                let sy = apply(&data, system, &s, &mut y).to_f64();
                worst = worst.max(triangular::miss(&dense, &z, &r)).max(triangular::miss(&dense, &y, &s));
                let dot = |a: &[[T; 3]], b: &[[T; 3]]| -> f64 {
                    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a.to_f64() * b.to_f64()).sum()
                };
                assert!(rz > 0.0 && sy > 0.0, "{rz:e} {sy:e}");
                let u = T::UNIT_ROUNDOFF.to_f64();
                assert!((rz - dot(&r, &z)).abs() <= allowed::CYCLE * u * rz, "{rz:e} is rᵀz");
                let off = (dot(&s, &z) - dot(&r, &y)).abs() / (rz * sy).sqrt();
                assert!(off <= allowed::CYCLE * u, "asymmetric by {off:e}");
            }
        });
    }
    println!("off by {:.1} u of a row's size", worst / T::UNIT_ROUNDOFF.to_f64());
    worst
}

/// One number too few is told and changes nothing; more than enough gives the same bits.
pub fn small_workspace<T: Real, S: Solver<T>>(needs: fn(usize) -> usize, solver: fn(Vec<T>) -> S) {
    let mut data = generate::cloth(4);
    // An island beside it.
    let [a, b] = [[2.0; 3], [2.0, 2.0, 3.0]].map(|at| data.particle(at, 0.1));
    data.spring(a, b, 10.0);
    let mut scene = build::scene::<T>(&data);
    let before = build::bits(&scene);
    let step = |scene: &mut _, numbers: usize| {
        let solver = solver(vec![T::from_f64(f64::NAN); numbers]);
        let gravity = build::real3([0.0, -9.81, 0.0]);
        hooke::MassSpring::step(
            scene,
            &mut LinearlyImplicitEuler::new(T::from_f64(H)).gravity(gravity).solver(solver),
        )
    };
    // Two of sixteen are pinned.
    let numbers = needs(14);
    for less in [0, 1, numbers - 1] {
        assert_eq!(step(&mut scene, less), Err(StepError::Workspace { numbers, words: 0 }));
        assert_eq!(build::bits(&scene), before);
    }
    let mut other = build::scene::<T>(&data);
    assert_eq!(step(&mut scene, numbers), step(&mut other, 3 * numbers));
    assert_eq!(build::bits(&scene), build::bits(&other));
    assert_ne!(build::bits(&scene), before);
}

/// Iterations of a step from a state at t = 0.3 s, R = 1e-6.
pub fn iterations(data: &SceneData, solver: impl Solver<f64>) -> u32 {
    let data = moved(data.clone(), 18);
    let report = build::scene::<f64>(&data)
        .step(&mut Forces::new(&data).euler(H).tolerance(1e-6).solver(solver))
        .unwrap();
    assert_eq!(report.capped + report.stalled + report.at_floor + report.fallbacks, 0);
    report.iterations
}

/// The residual is looked at every eighth iteration at least: eight iterations before the end it was above the goal.
pub fn ends_soon_after_the_goal<S: Solver<f64>>(solver: impl Fn(&SceneData) -> S) {
    let data = moved(generate::cloth(12), 18);
    let solve = |relative: f64, max_iterations: u32| {
        let mut islands = Vec::new();
        let mut forces = Forces::new(&data);
        let euler = forces.euler(H).tolerance(relative).max_iterations(max_iterations);
        build::scene::<f64>(&data)
            .step_watched(&mut euler.solver(solver(&data)), &[], |island: &IslandReport<f64>| {
                islands.push(island.solve)
            })
            .unwrap();
        islands[0]
    };
    let start = solve(0.0, 0).upper;
    for relative in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8] {
        let goal = relative * relative * start;
        let end = solve(relative, 10_000);
        assert_eq!(end.ending, Ending::Converged);
        assert!(end.upper <= goal * (1.0 + allowed::STOPPING), "R = {relative:e}: {end:?}, goal {goal:e}");
        let before = solve(relative, end.iterations.saturating_sub(8));
        assert!(before.upper >= goal * (1.0 - allowed::STOPPING), "R = {relative:e}: {end:?}, {before:?}");
    }
}

/// A free chain along x, so stiff that its masses drown in the stiffness.
pub fn stiff(k: f64) -> SceneData {
    let mut data = generate::chain(12);
    data.pinned.fill(false);
    data.mass.fill(1e-6);
    data.springs.iter_mut().for_each(|s| s.k = k);
    for (k, v) in data.velocity.iter_mut().enumerate() {
        *v = [0.1 * k as f64, 0.0, 0.3];
    }
    data
}

/// The same along no axis.
pub fn oblique(k: f64) -> SceneData {
    let mut data = stiff(k);
    data.position.iter_mut().for_each(|x| *x = [x[0], 0.7 * x[0], 1.3 * x[0]]);
    for j in 0..data.springs.len() {
        let (a, b) = (data.springs[j].a, data.springs[j].b);
        data.springs[j].l0 = hooke_tests::data::distance(data.position[a], data.position[b]);
    }
    data
}

/// How many of three first steps report a breakdown. Bounds hold, and every number stays finite.
pub fn breaks_down<T: Real, S: Solver<T>>(data: &SceneData, solver: impl Fn(&SceneData) -> S) -> u32 {
    let mut seen = 0;
    for r in [1e-1, 1e-3, 1e-4] {
        let mut scene = build::scene::<T>(data);
        let mut forces = Forces::<T>::new(data);
        let euler = forces.euler(T::from_f64(H)).tolerance(T::from_f64(r));
        let mut islands = Vec::new();
        let report = scene
            .step_watched(&mut euler.solver(solver(data)), &[], |island: &IslandReport<T>| {
                islands.push(*island)
            })
            .unwrap();
        assert_eq!(report.fallbacks, islands.iter().map(|i| u32::from(i.solve.fallback)).sum::<u32>());
        assert!(report.upper.is_finite() && report.lower <= report.upper, "{report:?}");
        assert!(build::velocities(&scene).iter().flatten().all(|v| v.is_finite()));
        seen += report.fallbacks;
    }
    seen
}
