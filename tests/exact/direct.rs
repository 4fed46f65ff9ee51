//! Direct solvers: one solve is exact to rounding; a small workspace, a changed pattern or a breakdown is never a wrong answer.

use std::cell::Cell;
use std::rc::Rc;

use hooke::{
    BandedLdl, Ending, IslandReport, LinearlyImplicitEuler, Real, Report, Single, Solver, SparseLdl,
    StepError,
};
use hooke_harness::host::Host;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{direct, generate};

const H: f64 = 1.0 / 60.0;

fn step<T: Real>(
    scene: &mut VecScene<T>,
    data: &SceneData,
    relative: f64,
    solver: impl Solver<T>,
) -> (Report<T>, Vec<IslandReport<T>>) {
    let mut forces = Forces::<T>::new(data);
    let euler = forces.euler(T::from_f64(H)).tolerance(T::from_f64(relative));
    let mut islands = Vec::new();
    let report = scene.step_watched(&mut euler.solver(solver), &[], |island| islands.push(*island)).unwrap();
    (report, islands)
}

/// The bits and the report of each of ten steps.
fn walk<T: Real>(data: &SceneData, solver: impl Solver<T>) -> Vec<(Vec<[u64; 6]>, Report<T>)> {
    let (mut scene, mut forces) = (build::scene::<T>(data), Forces::<T>::new(data));
    let mut euler = forces.euler(T::from_f64(H)).solver(solver);
    let step = |_| {
        let report = scene.step(&mut euler).unwrap();
        (build::bits(&scene), report)
    };
    (0..10).map(step).collect()
}

/// Steps of some scenes end so, with no help from PCG. Answers how many end at the floor, and the most
/// solves that one took.
fn ends<T: Real, S: Solver<T>>(
    relative: f64,
    endings: &[Ending],
    solver: impl Fn(&SceneData) -> S,
) -> (u32, u32) {
    let (mut floors, mut most) = (0, 0);
    for data in [generate::chain(2), generate::chain(3), generate::chain(200), generate::cloth(7)] {
        let mut scene = build::scene::<T>(&data);
        for _ in 0..20 {
            let (report, islands) = step(&mut scene, &data, relative, solver(&data));
            assert_eq!(report.fallbacks, 0);
            assert!(islands.iter().all(|island| endings.contains(&island.solve.ending)), "{islands:?}");
            floors += report.at_floor;
            most = most.max(report.iterations);
        }
    }
    (floors, most)
}

#[test]
fn in_f64_two_solves_at_most_give_twelve_digits_or_end_at_the_floor() {
    let endings = [Ending::Converged, Ending::Floor];
    assert!(ends::<f64, _>(1e-12, &endings, direct::banded).1 <= 2);
    assert!(ends::<f64, _>(1e-12, &endings, direct::sparse).1 <= 2);
}

#[test]
fn twelve_digits_in_f32_end_at_the_floor_unless_the_residual_is_zero() {
    let endings = [Ending::Converged, Ending::Floor];
    // The longer chain and the cloth in all their steps.
    assert!(ends::<f32, _>(1e-12, &endings, direct::banded).0 >= 40);
    assert!(ends::<f32, _>(1e-12, &endings, direct::sparse).0 >= 40);
}

#[test]
fn at_the_default_tolerance_one_solve_is_enough() {
    let data = generate::cloth(9);
    for (_, report) in
        walk::<f64>(&data, direct::banded(&data)).into_iter().chain(walk(&data, direct::sparse(&data)))
    {
        assert_eq!((report.iterations, report.fallbacks), (1, 0));
    }
}

#[test]
fn what_is_at_rest_takes_no_solve() {
    let mut data = generate::chain(5);
    data.gravity = [0.0; 3];
    let report = walk::<f64>(&data, direct::banded(&data)).pop().unwrap().1;
    assert_eq!((report.iterations, report.untouched, report.upper), (0, 1, 0.0));
}

/// Two scenes side by side.
fn beside(a: &SceneData, b: &SceneData) -> SceneData {
    let (mut both, n) = (a.clone(), a.len());
    both.position.extend(&b.position);
    both.velocity.extend(&b.velocity);
    both.mass.extend(&b.mass);
    both.pinned.extend(&b.pinned);
    both.springs.extend(b.springs.iter().map(|s| hooke_tests::data::SpringData {
        a: s.a + n,
        b: s.b + n,
        ..*s
    }));
    both
}

#[test]
fn an_island_has_the_bits_that_it_has_alone() {
    let (a, b) = (generate::cloth(5), generate::chain(9));
    let (n, both) = (a.len(), beside(&a, &b));
    let order = |n: usize| (0..n as u32).rev().collect::<Vec<_>>();
    for ((pair, _), (alone, _)) in
        walk::<f64>(&both, direct::banded(&both)).iter().zip(walk::<f64>(&a, direct::banded(&a)))
    {
        assert_eq!(pair[..n], alone);
    }
    let sparse = |data: &SceneData| direct::sparse_in::<f64>(data, order(data.len()));
    for ((pair, _), (alone, _)) in walk(&both, sparse(&both)).iter().zip(walk(&b, sparse(&b))) {
        assert_eq!(pair[n..], alone);
    }
}

#[test]
fn a_broken_spring_a_released_pin_and_another_scene_are_analysed_anew() {
    let data = beside(&generate::cloth(6), &generate::chain(9));
    let (mut kept, mut forces) = (direct::sparse::<f64>(&data), Forces::<f64>::new(&data));
    let (mut scene, mut fresh) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    for k in 0..12 {
        for scene in [&mut scene, &mut fresh] {
            match k {
                3 => scene.break_spring(20).unwrap(),
                5 => scene.release(0).unwrap(),
                7 => scene.pin(14).unwrap(),
                _ => (),
            }
        }
        // A scene of as many islands, particles and springs, but not tied alike.
        let other = beside(&generate::chain(9), &generate::cloth(6));
        step(&mut build::scene(&other), &other, 1e-6, &mut kept);
        let a = scene.step(&mut forces.euler(H).solver(&mut kept)).unwrap();
        let b = fresh.step(&mut forces.euler(H).solver(direct::sparse(&data))).unwrap();
        assert_eq!((build::bits(&scene), a), (build::bits(&fresh), b), "step {k}");
        assert_eq!(a.fallbacks, 0);
    }
}

#[test]
fn any_order_is_right() {
    let data = generate::cloth(6);
    let exact = walk::<f64>(&data, direct::banded(&data));
    let far = |order: Vec<u32>| {
        let last = walk::<f64>(&data, direct::sparse_in(&data, order)).pop().unwrap();
        assert_eq!((last.1.fallbacks, last.1.iterations), (0, 1));
        let number = |bits: &[u64; 6]| f64::from_bits(bits[1]);
        let pairs = last.0.iter().zip(&exact.last().unwrap().0);
        pairs.map(|(a, b)| (number(a) - number(b)).abs()).fold(0.0, f64::max)
    };
    for order in [vec![], vec![35, 35, 99, u32::MAX, 2], (0..36).rev().collect()] {
        assert!(far(order) < hooke_tests::allowed::TRAJECTORY);
    }
}

#[test]
fn arrays_slices_and_vectors_as_workspace_give_the_same_bits() {
    const ROOM: usize = BandedLdl::needs(9, 1);
    let data = generate::chain(9);
    let grown = walk::<f64>(&data, BandedLdl::new(vec![7.0; ROOM + 5]));
    assert_eq!(walk(&data, BandedLdl::new([0.0; ROOM])), grown);
    assert_eq!(walk(&data, BandedLdl::new([0.5; ROOM].as_mut_slice())), grown);
    let order = [3, 1, 4, 0, 5];
    let grown = walk::<f64>(&data, direct::sparse_in(&data, order.to_vec()));
    assert_eq!(walk(&data, SparseLdl::new(order, [0.0; 1_000], [0; 500])), grown);
    assert_eq!(
        walk(&data, SparseLdl::new(&order, [7.0; 1_000].as_mut_slice(), [9; 500].as_mut_slice())),
        grown
    );
}

#[test]
fn a_host_s_instructions_give_the_same_bits() {
    let data = generate::cloth(9);
    for order in [vec![], (0..81).rev().collect()] {
        let portable = walk::<f64>(&data, direct::sparse_in(&data, order.clone()));
        assert_eq!(walk(&data, direct::sparse_in(&data, order.clone()).dispatched_by(Host::new())), portable);
        let portable = walk::<f32>(&data, direct::sparse_in(&data, order.clone()));
        assert_eq!(walk(&data, direct::sparse_in(&data, order).dispatched_by(Host::new())), portable);
    }
    let portable = walk::<f64>(&data, direct::single(&data));
    assert_eq!(walk(&data, direct::single(&data).dispatched_by(Host::new())), portable);
}

#[test]
fn a_factor_in_less_precision_takes_few_iterations_and_half_the_room() {
    let data = generate::cloth(12);
    let mut scene = build::scene::<f64>(&data);
    for (relative, most) in [(1e-3, 1), (1e-6, 2), (1e-10, 4)] {
        let (report, _) = step(&mut scene, &data, relative, direct::single(&data));
        assert!((1..=most).contains(&report.iterations) && report.fallbacks == 0, "{relative:e}: {report:?}");
    }
    let asks = |solver: Result<(), StepError>| match solver {
        Err(StepError::Workspace { numbers, .. }) => numbers,
        other => panic!("{other:?}"),
    };
    let words = vec![0; 10_000];
    let own = asks(SparseLdl::new([], vec![0.0_f64; 0], words.clone()).prepare(&mut scene));
    let less = asks(SparseLdl::new([], Single(vec![0.0; 0]), words).prepare(&mut scene));
    assert_eq!(own, less, "as many numbers, of half the size");
}

#[test]
fn too_little_workspace_is_an_error_that_says_how_much_and_changes_nothing() {
    let data = beside(&generate::cloth(4), &generate::chain(3));
    let mut scene = build::scene::<f64>(&data);
    let before = build::bits(&scene);
    let numbers = BandedLdl::needs_of(&mut scene);
    // Rows of four, two of them pinned: the diagonal ones reach five on.
    assert_eq!(numbers, BandedLdl::needs(14, 5));
    let mut euler = LinearlyImplicitEuler::new(H).solver(BandedLdl::new(vec![0.0; numbers - 1]));
    assert_eq!(scene.step(&mut euler), Err(StepError::Workspace { numbers, words: 0 }));
    assert_eq!(build::bits(&scene), before);
    let (mut numbers, mut words, mut tries) = (0, 0, 0);
    let step = |scene: &mut VecScene<f64>, numbers: usize, words: usize| {
        let solver = SparseLdl::new([], vec![0.0; numbers], vec![0; words]);
        scene.step(&mut LinearlyImplicitEuler::new(H).gravity([0.0, -1.0, 0.0]).solver(solver))
    };
    while let Err(error) = step(&mut scene, numbers, words) {
        let StepError::Workspace { numbers: n, words: w } = error else { panic!("{error}") };
        assert!(n >= numbers && w >= words && (n, w) != (numbers, words), "it asks for more");
        assert_eq!(build::bits(&scene), before);
        (numbers, words, tries) = (n, w, tries + 1);
    }
    assert!(tries <= 6, "{tries} tries");
    assert!(
        matches!(step(&mut scene, numbers - 1, words), Err(StepError::Workspace { numbers: n, .. }) if n == numbers)
    );
    assert!(
        matches!(step(&mut scene, numbers, words - 1), Err(StepError::Workspace { words: w, .. }) if w == words)
    );
}

/// A free chain so stiff that in rounded arithmetic its matrix is as good as singular.
fn singular() -> SceneData {
    let mut data = generate::chain(12);
    data.pinned.fill(false);
    data.mass.fill(1e-6);
    data.springs.iter_mut().for_each(|s| s.k = 1e12);
    for (k, v) in data.velocity.iter_mut().enumerate() {
        *v = [0.1 * k as f64, 0.0, 0.3];
    }
    data
}

#[test]
fn a_pivot_that_rounding_makes_negative_is_told_and_pcg_answers() {
    let data = singular();
    let mut seen = 0;
    let mut check = |(report, islands): (Report<f32>, Vec<IslandReport<f32>>), scene: &VecScene<f32>| {
        seen += report.fallbacks;
        assert_eq!(report.fallbacks, islands.iter().map(|i| u32::from(i.solve.fallback)).sum::<u32>());
        assert!(report.upper.is_finite() && report.lower <= report.upper, "{report:?}");
        assert!(build::velocities(scene).iter().flatten().all(|v| v.is_finite()));
    };
    for _ in 0..3 {
        let (mut a, mut b) = (build::scene::<f32>(&data), build::scene::<f32>(&data));
        check(step(&mut a, &data, 1e-4, direct::banded(&data)), &a);
        check(step(&mut b, &data, 1e-4, direct::sparse(&data)), &b);
    }
    assert_eq!(seen, 6);
}

/// Words of which one changes behind the solver's back.
struct Tampered {
    words: Vec<u32>,
    change: Rc<Cell<Option<(usize, u32)>>>,
}

impl AsMut<[u32]> for Tampered {
    fn as_mut(&mut self) -> &mut [u32] {
        if let Some((at, value)) = self.change.take() {
            self.words[at] = value;
        }
        &mut self.words
    }
}

#[test]
fn a_wrong_analysis_is_caught_by_the_certificate_whatever_word_of_it_is_wrong() {
    let data = generate::cloth(4);
    let exact = walk::<f64>(&data, direct::banded(&data));
    let (mut fallbacks, mut fine) = (0, 0);
    // Behind the header: rows, supernodes, places of blocks, lists.
    for at in 9..9 + 2 * 14 + 2 * 42 + 3 * 10 + 40 {
        for value in [0, 1, 13, 1_000, u32::MAX] {
            let change = Rc::new(Cell::new(None));
            let words = Tampered { words: vec![0; 1_000], change: Rc::clone(&change) };
            let mut solver = SparseLdl::new([7, 1], vec![0.0; 9 * 16 * 16], words);
            let mut scene = build::scene::<f64>(&data);
            step(&mut scene, &data, 1e-6, &mut solver);
            change.set(Some((at, value)));
            let (report, _) = step(&mut scene, &data, 1e-6, &mut solver);
            assert!(report.lower <= report.upper && report.upper < 1e-12, "word {at} = {value}: {report:?}");
            let expected = exact[1].0.iter().map(|bits| f64::from_bits(bits[1]));
            for (x, y) in scene.positions().iter().zip(expected) {
                assert!((x[1] - y).abs() < 1e-6, "word {at} = {value}: {x:?}, not {y}");
            }
            fallbacks += report.fallbacks;
            fine += u32::from(report.fallbacks == 0);
        }
    }
    assert!(fallbacks > 100 && fine > 100, "{fallbacks} caught, {fine} harmless");
}

#[test]
fn one_solve_is_enough_whichever_way_a_chain_lies_in_space() {
    for seed in 0..20 {
        let mut random = hooke_tests::random::Random::new(seed);
        for n in [1, 2, 3, 6, 9, 12] {
            let mut data = SceneData::default();
            for _ in 0..=n {
                data.particle(random.vector(1.0), random.between(0.5, 2.0));
            }
            data.pinned[0] = seed % 3 != 0;
            for i in 1..=n {
                // Stretched, so that nothing is clamped.
                data.spring_with(i - 1, i, random.between(100.0, 1e4), 0.01);
            }
            let mut forces = Forces::<f64>::new(&data);
            let mut scene = build::scene::<f64>(&data);
            let mut euler = forces.euler(H).tolerance(1e-10).solver(direct::banded(&data));
            for step in 0..3 {
                let report = scene.step(&mut euler).unwrap();
                assert_eq!(
                    (report.iterations, report.fallbacks),
                    (1, 0),
                    "seed {seed}, {n} rows, step {step}"
                );
            }
        }
    }
}

#[test]
fn between_two_rows_the_lower_bound_is_the_error_itself_where_they_move_against_each_other() {
    // Stretched along x, h²k = 64 kg: the answer's energy is ½·2·b²/(m + 2h²k), and ν = m + 2h²k.
    let mut data = SceneData::default();
    for (i, (x, v)) in [(0.0, -1.0), (1.0, 1.0)].into_iter().enumerate() {
        data.particle([x, 0.0, 0.0], 1.0);
        data.velocity[i] = [v, 0.0, 0.0];
    }
    data.spring(0, 1, 64.0);
    for solver in [0, 1] {
        let mut scene = build::scene::<f64>(&data);
        let euler = LinearlyImplicitEuler::new(1.0).tolerance(1.0);
        let solve = |island: &IslandReport<f64>| assert_bound(island.solve.lower, 64.0);
        if solver == 0 {
            scene.step_watched(&mut euler.solver(direct::banded(&data)), &[], solve).unwrap();
        } else {
            scene.step_watched(&mut euler.solver(direct::sparse(&data)), &[], solve).unwrap();
        }
        fn assert_bound(lower: f64, h2k: f64) {
            // b = −h²k·Δq̇ = 128 at both ends.
            let energy = (2.0 * h2k) * (2.0 * h2k) / (1.0 + 2.0 * h2k);
            assert!(lower <= energy && lower >= 0.999 * energy, "{lower}, not {energy}");
        }
    }
}

#[test]
fn a_factor_in_less_precision_has_the_same_digits_where_all_masses_and_stiffnesses_are_beyond_it() {
    // By powers of two f64 scales them without rounding, and f32 has no 2¹⁵⁰.
    let walks = [0, 150, -150].map(|power| {
        let mut data = generate::cloth(5);
        let scale = 2f64.powi(power);
        data.mass.iter_mut().for_each(|m| *m *= scale);
        data.springs.iter_mut().for_each(|s| (s.k, s.c) = (s.k * scale, s.c * scale));
        let walk = walk::<f64>(&data, direct::single(&data));
        walk.into_iter().map(|(bits, report)| (bits, report.iterations, report.fallbacks)).collect::<Vec<_>>()
    });
    assert!(walks[0].iter().all(|(.., fallbacks)| *fallbacks == 0));
    assert!(walks[0] == walks[1] && walks[0] == walks[2]);
}

#[test]
fn a_factor_in_less_precision_takes_two_iterations_however_stiff_a_stretched_cloth_is() {
    for power in [3, 4, 5, 6, 7] {
        let mut data = generate::cloth(8);
        data.springs.iter_mut().for_each(|s| (s.k, s.l0) = (s.k * 10f64.powi(power), 0.9 * s.l0));
        data.velocity.iter_mut().enumerate().for_each(|(i, v)| *v = [0.0, 0.1 * (i % 3) as f64, 0.0]);
        let mut scene = build::scene::<f64>(&data);
        let (report, _) = step(&mut scene, &data, 1e-9, direct::single(&data));
        assert_eq!((report.iterations, report.fallbacks), (2, 0), "{report:?}");
    }
}
