//! A step of many solves: an island's matrix comes again and again, and a solver that keeps something of it knows whose it is.

use hooke::{
    BandedLdl, BlockIlu, BlockJacobi, EnergyMomentum, Newton, Portable, Real, Rosenbrock2, Rosenbrock3,
    Solver, WideJacobi,
};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::multigrid::multigrid;
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::{allowed, direct, generate, lanes};

/// Three islands, two of them with levels, none with the pattern of another.
fn islands() -> SceneData {
    let (two, _) = side_by_side(&generate::cloth(6), &generate::chain(60));
    side_by_side(&two, &generate::cloth(3)).0
}

#[derive(Debug, Clone, Copy)]
enum Of {
    Newton,
    EnergyMomentum,
    Ros2,
    Ros3,
}

const ALL: [Of; 4] = [Of::Newton, Of::EnergyMomentum, Of::Ros2, Of::Ros3];

/// Where the particles are after three steps, their bits, and how many iterations each step took.
type Walk = (Vec<[f64; 3]>, Vec<[u64; 6]>, Vec<u32>);

fn walk<T: Real>(of: Of, data: &SceneData, solver: impl Solver<T>) -> Walk {
    let (mut scene, mut forces) = (build::scene::<T>(data), Forces::<T>::new(data));
    let (dt, memory) = (T::from_f64(1.0 / 120.0), vec![[T::ZERO; 3]; 8 * data.len()]);
    macro_rules! walk {
        ($method:expr) => {{
            let mut method = $method.with(forces.all()).tolerance(T::from_f64(1e-12)).solver(solver);
            let step = |_| scene.step(&mut method).map(|report| report.iterations);
            let iterations: Result<Vec<u32>, _> = (0..3).map(step).collect();
            (build::positions(&scene), build::bits(&scene), iterations.unwrap())
        }};
    }
    match of {
        Of::Newton => walk!(Newton::new(dt, memory)),
        Of::EnergyMomentum => walk!(EnergyMomentum::new(dt, memory)),
        Of::Ros2 => walk!(Rosenbrock2::new(dt, memory)),
        Of::Ros3 => walk!(Rosenbrock3::new(dt, memory)),
    }
}

/// The room that a solver says it needs for all islands is enough however often they come, the answer is that of a solver which
/// keeps nothing, and who owns the solver touches no bit.
fn keeps_each_islands_own<S: Solver<f64>>(name: &str, make: impl Fn(&SceneData) -> S) {
    let data = islands();
    for of in ALL {
        let (plain, ..) = walk::<f64>(of, &data, BlockJacobi);
        let (places, bits, iterations) = walk::<f64>(of, &data, make(&data));
        let mut lent = make(&data);
        let (_, bits_lent, iterations_lent) = walk::<f64>(of, &data, &mut lent);
        let off = build::farthest(&places, &plain);
        println!("{name}, {of:?}: {iterations:?} iterations, {off:.1e} m from block Jacobi");
        assert!(off <= allowed::TRAJECTORY, "{name}, {of:?}: {off:e} m");
        assert_eq!(iterations, iterations_lent, "{name}, {of:?}");
        assert_eq!(bits, bits_lent, "{name}, {of:?}");
        // Lent once more it begins anew: what lies there from before touches no bit either.
        assert_eq!(walk::<f64>(of, &data, &mut lent).1, bits, "{name}, {of:?}, with what it kept");
    }
}

#[test]
fn many_solves_of_every_island_need_no_more_than_multigrid_says_and_end_where_block_jacobi_ends() {
    keeps_each_islands_own("multigrid", multigrid);
}

#[test]
fn many_solves_of_every_island_end_where_block_jacobi_ends_in_lanes() {
    keeps_each_islands_own("lanes", lanes::wide::<f64>);
    keeps_each_islands_own("lanes in f32", lanes::single::<f64>);
    keeps_each_islands_own("lanes around multigrid", |data| {
        let (numbers, words) = WideJacobi::needs_of(&mut build::scene::<f64>(data), true);
        WideJacobi::new(vec![1.0; numbers], vec![7; words], Portable).around(multigrid(data))
    });
}

#[test]
fn many_solves_of_every_island_end_where_block_jacobi_ends_by_factors_that_are_kept() {
    keeps_each_islands_own("banded", direct::banded::<f64>);
    keeps_each_islands_own("sparse", direct::sparse::<f64>);
    keeps_each_islands_own("banded in lanes", |data| {
        let mut scene = build::scene::<f64>(data);
        let (banded, (numbers, words)) = BandedLdl::needs_in_lanes_of(&mut scene, true);
        let around = BandedLdl::new(vec![1.0; banded.max(BandedLdl::needs(data.len(), data.len()))]);
        WideJacobi::new(vec![1.0; numbers], vec![7; words], Portable).around(around)
    });
    keeps_each_islands_own("D-ILU", |data| BlockIlu::new(vec![1.0; BlockIlu::needs(data.len())]));
}

#[test]
fn factors_that_the_first_stage_did_not_need_are_made_for_the_second() {
    // A particle at rest but for a nanometre a second, which is met before any solve; then its pin is gone.
    fn step(solver: impl Solver<f64>) -> (Vec<[f64; 3]>, hooke::Report<f64>) {
        let mut data = SceneData::default();
        for x in [0.0, 1.0, 2.0] {
            data.particle([x, 0.0, 0.0], 1.0);
        }
        (data.pinned[0], data.velocity[1]) = (true, [1e-9, 0.0, 0.0]);
        data.spring(0, 1, 100.0);
        data.spring(1, 2, 100.0);
        let mut scene = build::scene::<f64>(&data);
        let motion = hooke::Motion { particle: 0, position: [0.5, 0.5, 0.0], velocity: [1.0, 0.0, 0.0] };
        let memory = vec![[0.0; 3]; Rosenbrock2::<f64, ()>::needs(3)];
        let mut ros2 = Rosenbrock2::new(0.1, memory).tolerance(1e-12).absolute(1e-15).solver(solver);
        let report = scene.step_moving(&mut ros2, &[motion]).unwrap();
        (build::positions(&scene), report)
    }
    let data = generate::chain(3);
    let (plain, _) = step(BlockJacobi);
    for (found, report) in [step(direct::banded(&data)), step(direct::sparse(&data))] {
        assert_eq!((report.fallbacks, report.untouched), (0, 0), "{report:?}");
        assert!(build::farthest(&found, &plain) <= 1e-9, "{found:?}, not {plain:?}");
        assert!(found[1][0] - 1.0 > 1e-3, "it was pulled along");
    }
}
