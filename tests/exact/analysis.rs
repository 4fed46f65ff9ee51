//! What a sparse factorisation is analysed to need, whose analysis it is, and that exactly so much is enough.

use hooke::{LinearlyImplicitEuler, Newton, Real, Report, Rosenbrock3, SparseLdl, StepError};
use hooke_tests::data::SceneData;
use hooke_tests::random::Random;
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, direct, generate};

const H: f64 = 1.0 / 60.0;

type Sized = SparseLdl<Vec<u32>, Vec<f64>, Vec<u32>>;

fn sized(order: &[u32], [numbers, words]: [usize; 2]) -> Sized {
    SparseLdl::new(order.to_vec(), vec![0.0; numbers], vec![u32::MAX; words])
}

/// What is asked for, from nothing, until nothing more is.
fn asked(scene: &mut VecScene<f64>, order: &[u32]) -> Vec<[usize; 2]> {
    let mut asked: Vec<[usize; 2]> = Vec::new();
    loop {
        let room = asked.last().copied().unwrap_or_default();
        match sized(order, room).prepare(scene) {
            Ok(()) => return asked,
            Err(StepError::Workspace { numbers, words }) => {
                assert!(numbers >= room[0] && words >= room[1] && [numbers, words] != room, "more");
                asked.push([numbers, words]);
            }
            Err(other) => panic!("{other:?}"),
        }
    }
}

/// A scene, an order, and what was asked for.
type Case = (SceneData, Vec<u32>, &'static [[usize; 2]]);

/// Scenes, orders, and what was asked for: of a chain of 11 rows and springs first 9 + 9·11 + 4·11 + 2 words, to analyse it in.
fn cases() -> [Case; 5] {
    let islands = side_by_side(&generate::cloth(4), &generate::chain(7)).0;
    let three = side_by_side(&islands, &generate::lattice(2, 3, 2)).0;
    let backwards = (0..three.len() as u32).rev().collect();
    let mut random = Random::new(7);
    let shuffled = random.permutation(64).into_iter().map(|i| i as u32).collect();
    [
        (generate::chain(12), vec![], &[[0, 154], [0, 207], [369, 207]]),
        (generate::cloth(8), vec![], &[[0, 1409], [0, 1679], [7479, 1679]]),
        (generate::cloth(8), shuffled, &[[0, 1409], [0, 1673], [14724, 1673]]),
        (three.clone(), vec![], &[[0, 319], [0, 346], [0, 526], [0, 576], [1512, 576]]),
        (three, backwards, &[[0, 319], [0, 346], [0, 526], [0, 581], [1512, 581]]),
    ]
}

#[test]
fn numbers_and_words_are_asked_for_as_they_were_found_once() {
    for (data, order, expected) in cases() {
        assert_eq!(asked(&mut build::scene(&data), &order), expected);
    }
}

/// Bits and report of each step.
type Walk = Vec<(Vec<[u64; 6]>, Report<f64>)>;

/// Three steps by each of three methods, two of them of many solves.
fn walks(data: &SceneData, make: impl Fn() -> Sized) -> Result<Walk, StepError> {
    let mut seen = Vec::new();
    let memory = || vec![[0.0; 3]; 8 * data.len()];
    macro_rules! walk {
        ($method:expr) => {{
            let (mut scene, mut solver) = (build::scene::<f64>(data), make());
            let mut method = $method.gravity(data.gravity).solver(&mut solver);
            for _ in 0..3 {
                let report = scene.step(&mut method)?;
                seen.push((build::bits(&scene), report));
            }
        }};
    }
    walk!(LinearlyImplicitEuler::new(H));
    walk!(Newton::new(H, memory()));
    walk!(Rosenbrock3::new(H, memory()));
    Ok(seen)
}

#[test]
fn exactly_so_much_is_enough_however_often_an_island_comes_and_one_less_is_not() {
    for (data, order, _) in cases() {
        let room = asked(&mut build::scene(&data), &order).pop().unwrap();
        let [numbers, words] = room;
        let generous = walks(&data, || sized(&order, [2 * numbers, 2 * words])).unwrap();
        assert!(generous.iter().all(|(_, report)| report.fallbacks == 0), "{generous:?}");
        assert_eq!(walks(&data, || sized(&order, room)).unwrap(), generous);
        // Analysed beforehand it is the same.
        let ready = || {
            let mut solver = sized(&order, room);
            solver.prepare(&mut build::scene::<f64>(&data)).unwrap();
            solver
        };
        assert_eq!(walks(&data, ready).unwrap(), generous);
        for less in [[numbers - 1, words], [numbers, words - 1]] {
            let needs = StepError::Workspace { numbers, words };
            assert_eq!(sized(&order, less).prepare(&mut build::scene::<f64>(&data)), Err(needs));
            assert!(matches!(walks(&data, || sized(&order, less)), Err(StepError::Workspace { .. })));
        }
    }
}

#[test]
fn another_pattern_of_as_many_rows_and_springs_is_analysed_anew_whatever_it_is() {
    let mut random = Random::new(31);
    let mut data = SceneData::default();
    for _ in 0..10 {
        data.particle(random.vector(1.0), 1.0);
    }
    for i in 1..10 {
        data.spring_with(i - 1, i, 1e3, 0.1);
    }
    for (a, b) in [(0, 2), (3, 7), (1, 9), (5, 8)] {
        data.spring_with(a, b, 1e3, 0.1);
    }
    let (mut kept, mut scene) = (direct::sparse_in::<f64>(&data, vec![]), build::scene::<f64>(&data));
    for round in 0..200 {
        // One of the last four springs joins two others.
        let last = data.springs.len() - 1 - random.below(4);
        let [a, b] = [random.below(10), random.below(10)];
        if a == b {
            continue;
        }
        (data.springs[last].a, data.springs[last].b) = (a, b);
        let mut fresh = build::scene::<f64>(&data);
        let mut tied = build::scene::<f64>(&data);
        std::mem::swap(&mut scene, &mut tied);
        let step = |scene: &mut VecScene<f64>, solver: &mut direct::Sparse<f64>| {
            let report = scene.step(&mut LinearlyImplicitEuler::new(H).solver(solver)).unwrap();
            (build::bits(scene), report)
        };
        let other = step(&mut fresh, &mut direct::sparse_in::<f64>(&data, vec![]));
        let found = step(&mut scene, &mut kept);
        assert_eq!((found.1.fallbacks, found.1.iterations), (0, other.1.iterations), "round {round}");
        assert_eq!(found, other, "round {round}: {a} and {b}");
    }
}

#[test]
fn sizes_do_not_depend_on_the_precision() {
    fn words<T: Real>(data: &SceneData) -> StepError {
        let mut solver = SparseLdl::new([], vec![T::ZERO; 0], vec![0; 100_000]);
        solver.prepare(&mut build::scene::<T>(data)).unwrap_err()
    }
    for (data, ..) in cases() {
        assert_eq!(words::<f32>(&data), words::<f64>(&data));
    }
}
