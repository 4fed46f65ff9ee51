//! Multigrid's hierarchy: its cycle is the one that is written down, on levels as they are inspected, and what was
//! found of a pattern is kept for that pattern only.

use hooke::solver::LevelPart;
use hooke::{Multigrid, Portable};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{PointData, SceneData, distance};
use hooke_tests::multigrid::{OwnMultigrid, multigrid};
use hooke_tests::random::Random;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, generate};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

const H: f64 = 1.0 / 60.0;

type System<'s, 'f> = hooke::System<'s, f64, build::Everything<'f, f64>>;
type Vectors = Vec<Vector3<f64>>;

/// One level as it is inspected.
#[derive(Default)]
struct Level {
    blocks: Vec<(usize, usize, Matrix3<f64>)>,
    /// D⁻¹
    inverse: Vec<Matrix3<f64>>,
    /// Each row's row on the next level
    up: Vec<usize>,
}

impl Level {
    fn block(&mut self, row: usize, column: usize, block: [[f32; 3]; 3]) {
        let block = Matrix3::from_fn(|i, k| f64::from(block[i][k]));
        self.blocks.push((row, column, block));
        if row == column {
            self.inverse.resize(self.inverse.len().max(row + 1), Matrix3::zeros());
            self.inverse[row] += block;
        }
    }

    fn rows(&self) -> usize {
        self.inverse.len()
    }

    /// b − A x
    fn residual(&self, b: &Vectors, x: &Vectors) -> Vectors {
        let mut r = b.clone();
        self.blocks.iter().for_each(|(row, column, block)| r[*row] -= block * x[*column]);
        r
    }

    /// Chebyshev's semi-iteration for λ(D⁻¹A) in [1/5, 2], of centre c and half width w: after k steps the error's
    /// polynomial is T_k((c − λ)/w)/T_k(c/w), from T_{k+1}(t) = 2t T_k(t) − T_{k−1}(t).
    fn smooth(&self, b: &Vectors, x: &mut Vectors, steps: usize) {
        let (centre, half) = ((2.0 + 0.2) / 2.0, (2.0 - 0.2) / 2.0);
        let t: f64 = centre / half;
        let (mut polynomial_before, mut polynomial) = (1.0, t);
        let mut before = x.clone();
        for step in 0..steps {
            let omega = if step == 0 {
                1.0
            } else {
                let next = 2.0 * t * polynomial - polynomial_before;
                let omega = 2.0 * t * polynomial / next;
                (polynomial_before, polynomial) = (polynomial, next);
                omega
            };
            let r = self.residual(b, x);
            for (row, (x, before)) in x.iter_mut().zip(&mut before).enumerate() {
                let next = *before + omega * (*x - *before + self.inverse[row] * r[row] / centre);
                (*before, *x) = (*x, next);
            }
        }
    }

    /// A⁻¹ b, or two steps towards it if there are more rows than are factored.
    fn coarsest(&self, b: &Vectors) -> Vectors {
        if self.rows() <= 24 {
            return self.solve(b);
        }
        let mut x = vec![Vector3::zeros(); b.len()];
        self.smooth(b, &mut x, 2);
        x
    }

    /// A⁻¹ b
    fn solve(&self, b: &Vectors) -> Vectors {
        let n = 3 * self.rows();
        let mut matrix = DMatrix::zeros(n, n);
        for (row, column, block) in &self.blocks {
            let mut place = matrix.fixed_view_mut::<3, 3>(3 * row, 3 * column);
            place += block;
        }
        let right = DVector::from_iterator(n, b.iter().flat_map(|b| b.iter().copied()));
        let x = matrix.cholesky().expect("A is positive").solve(&right);
        (0..self.rows()).map(|row| Vector3::new(x[3 * row], x[3 * row + 1], x[3 * row + 2])).collect()
    }
}

/// One cycle from x on, on the first of these levels.
fn cycle(levels: &[Level], steps: usize, b: &Vectors, x: &mut Vectors) {
    let (level, rest) = levels.split_first().unwrap();
    level.smooth(b, x, steps);
    let mut below = vec![Vector3::zeros(); rest[0].rows()];
    level.residual(b, x).iter().zip(&level.up).for_each(|(r, to)| below[*to] += r);
    let coarse = if let [coarsest] = rest {
        coarsest.coarsest(&below)
    } else {
        let mut coarse = vec![Vector3::zeros(); below.len()];
        (0..2).for_each(|_| cycle(rest, 2, &below, &mut coarse));
        coarse
    };
    x.iter_mut().zip(&level.up).for_each(|(x, to)| *x += coarse[*to]);
    level.smooth(b, x, steps);
}

/// The levels of a system, and what their numbers were divided by.
fn inspected(solver: &mut OwnMultigrid, system: &System<'_, '_>) -> (Vec<Level>, f64) {
    let mut levels: Vec<Level> = Vec::new();
    let visit = |l: usize, part| {
        levels.resize_with(levels.len().max(l + 1), Level::default);
        match part {
            LevelPart::Block(row, column, block) => levels[l].block(row, column, block),
            LevelPart::Aggregate(row, to) => {
                assert_eq!(row, levels[l].up.len(), "rows in their order");
                levels[l].up.push(to);
            }
        }
    };
    let scale = solver.inspect(system, visit).unwrap();
    for level in &mut levels {
        level.inverse.iter_mut().for_each(|block| *block = block.try_inverse().unwrap());
    }
    (levels, scale)
}

/// Positions, masses and damping that differ, a pin in its midst and a point spring.
fn uneven(mut data: SceneData, seed: u64, shift: f64) -> SceneData {
    let mut random = Random::new(seed);
    for i in 0..data.len() {
        let by = random.vector(shift);
        (0..3).for_each(|k| data.position[i][k] += by[k]);
        data.mass[i] *= random.decade(0.3, 3.0);
    }
    data.springs.iter_mut().enumerate().for_each(|(j, spring)| spring.c = 0.01 * (j % 3) as f64);
    let middle = data.len() / 2;
    data.pinned[middle] = true;
    data.points.push(PointData { particle: middle + 2, target: [0.3, 0.4, 0.1], k: 40.0, l0: 0.1 });
    data
}

/// A system on `count` levels: the largest difference of its cycle from the one that is written down, relative to that
/// one's largest component.
fn difference(solver: &mut OwnMultigrid, system: &System<'_, '_>, count: usize, random: &mut Random) -> f64 {
    let (levels, scale) = inspected(solver, system);
    let sizes: Vec<usize> = levels.iter().map(Level::rows).collect();
    assert_eq!((sizes.len(), sizes[0]), (count, system.particles()), "{sizes:?}");
    for (level, next) in levels.iter().zip(&sizes[1..]) {
        assert_eq!(level.up.len(), level.rows());
        assert_eq!(level.up.iter().max(), Some(&(next - 1)));
    }
    assert!(levels[count - 1].up.is_empty(), "the coarsest level has no next one");
    let mut most: f64 = 0.0;
    for _ in 0..3 {
        let size = random.decade(1e-20, 1e10);
        let r: Vec<[f64; 3]> = (0..sizes[0]).map(|_| random.vector(size)).collect();
        let mut z = vec![[0.0; 3]; r.len()];
        let product = solver.apply(system, &r, &mut z).unwrap();
        let right = r.iter().map(|r| Vector3::from(*r) / scale).collect();
        let mut expected = vec![Vector3::zeros(); r.len()];
        cycle(&levels, 3, &right, &mut expected);
        let largest = expected.iter().map(|e| e.amax()).fold(0.0, f64::max);
        for (z, e) in z.iter().zip(&expected) {
            most = most.max((Vector3::from(*z) - e).amax() / largest);
        }
        let terms = || r.as_flattened().iter().zip(z.as_flattened()).map(|(r, z)| r * z);
        let (sum, of_sizes): (f64, f64) = (terms().sum(), terms().map(f64::abs).sum());
        // In both sums one rounding for each product and each addition.
        let rounding = 2.0 * (terms().count() + 1) as f64 * allowed::U64 * of_sizes;
        assert!((product - sum).abs() <= rounding, "{product:e} {sum:e}");
    }
    println!("{sizes:?}: {:.1} u", most / allowed::U32);
    most
}

/// Checks this difference in a scene's first island.
fn check(data: &SceneData, count: usize) {
    let mut random = Random::new(Random::seed(6));
    let (mut scene, mut forces) = (build::scene::<f64>(data), Forces::<f64>::new(data));
    let (mut solver, mut first) = (multigrid(data), true);
    forces
        .euler(H)
        .inspect(scene.parts(), &[], |system, _, _| {
            if first {
                let off = difference(&mut solver, system, count, &mut random);
                assert!(off <= allowed::WRITTEN_CYCLE * allowed::U32, "{off:e} on {count} levels");
            }
            first = false;
        })
        .unwrap();
    assert!(!first);
}

#[test]
fn the_cycle_is_the_one_that_is_written_down_on_three_levels_and_four() {
    check(&uneven(generate::cloth(16), 1, 0.01), 3);
    check(&uneven(generate::lattice(7, 8, 9), 2, 0.01), 3);
    check(&uneven(generate::cloth(44), 4, 0.004), 4);
}

/// A random net has no order, so the room for its edges is used up by two levels of 299 and 78 rows.
#[test]
fn a_coarsest_level_of_too_many_rows_to_factor_is_smoothed() {
    let mut net = generate::network(&mut Random::new(3), 300, generate::Ingredients::default());
    net.springs.iter_mut().for_each(|spring| spring.k = 100.0);
    net.mass.fill(0.1);
    check(&uneven(net, 3, 0.0), 2);
}

/// What lies where the analysis works, unless it has worked there since.
const MARK: u32 = 0xA5A5_5A5A;

/// Words that the analysis of these data works in, if they are one island and none of their springs has two pins.
fn worked_in(data: &SceneData) -> usize {
    let rows = data.pinned.iter().filter(|pinned| !**pinned).count();
    7 * data.springs.len() + 4 * rows + 2
}

/// The memory that a scene's solvers share, one after another.
struct Memory {
    numbers: Vec<f32>,
    words: Vec<u32>,
}

impl Memory {
    fn new(data: &SceneData) -> Self {
        let (numbers, words) = Multigrid::needs(data.len(), data.springs.len());
        Self { numbers: vec![f32::NAN; numbers], words: vec![7; words] }
    }

    /// A step by a new solver; it has the bits of one by a solver with memory of its own.
    fn step(&mut self, data: &mut SceneData) {
        let mut forces = Forces::<f64>::new(data);
        let mut step = |scene: &mut VecScene<f64>, numbers: &mut [f32], words: &mut [u32]| {
            let solver = Multigrid::new(numbers, words, Portable);
            let report = scene.step(&mut forces.euler(H).tolerance(1e-6).solver(solver)).unwrap();
            assert!(report.iterations > 1 && report.capped + report.stalled == 0, "{report:?}");
            (build::bits(scene), report)
        };
        let (mut scene, mut other, mut fresh) = (build::scene(data), build::scene(data), Self::new(data));
        let found = step(&mut scene, &mut self.numbers, &mut self.words);
        assert_eq!(found, step(&mut other, &mut fresh.numbers, &mut fresh.words));
        build::read_back(&scene, data);
    }

    /// The last so many words.
    fn back(&mut self, count: usize) -> &mut [u32] {
        let from = self.words.len() - count;
        &mut self.words[from..]
    }

    /// A step; answers which of the last so many words, marked before, it has written.
    fn written(&mut self, data: &mut SceneData, count: usize) -> Vec<bool> {
        self.back(count).fill(MARK);
        self.step(data);
        self.back(count).iter().map(|word| *word != MARK).collect()
    }

    /// Does a step analyse these data, one island, anew?
    fn analyses(&mut self, data: &mut SceneData) -> bool {
        self.written(data, worked_in(data)).contains(&true)
    }
}

/// Spring j between others, at its rest length.
fn rewire(data: &mut SceneData, j: usize, a: usize, b: usize) {
    let l0 = distance(data.position[a], data.position[b]);
    let spring = &mut data.springs[j];
    (spring.a, spring.b, spring.l0) = (a, b, l0);
}

/// 47 rows: ids of a row are 7 i … 7 i + 6.
fn net() -> SceneData {
    let mut random = Random::new(11);
    let mut net = generate::cloth(7);
    for i in 0..net.len() {
        let by = random.vector(0.02);
        (0..3).for_each(|k| net.position[i][k] += by[k]);
        net.mass[i] *= random.between(0.5, 2.0);
    }
    net
}

/// Where the spring between two particles is.
fn spring(data: &SceneData, a: usize, b: usize) -> usize {
    data.springs.iter().position(|spring| [spring.a, spring.b] == [a, b]).unwrap()
}

#[test]
fn a_hierarchy_is_found_once_and_again_where_the_pattern_changes() {
    let first = net();
    let mut memory = Memory::new(&first);
    let mut moving = first.clone();
    assert!(memory.analyses(&mut moving), "nothing is known yet");
    for _ in 0..3 {
        assert!(!memory.analyses(&mut moving), "known, although everything has moved");
    }
    // Which end a spring names first is no matter of the pattern, nor what it and the particles are like.
    for (j, spring) in moving.springs.iter_mut().enumerate() {
        if j % 3 == 0 {
            (spring.a, spring.b) = (spring.b, spring.a);
        }
        spring.k *= 1.0 + 0.001 * j as f64;
    }
    moving.mass.iter_mut().for_each(|mass| *mass *= 1.5);
    let mut same = first.clone();
    same.mass = moving.mass.clone();
    assert!(!memory.analyses(&mut same));

    type Change = fn(&mut SceneData);
    let changes: [(&str, Change); 9] = [
        ("one end elsewhere", |data| rewire(data, spring(data, 23, 24), 23, 44)),
        ("the other end elsewhere", |data| rewire(data, spring(data, 16, 24), 10, 24)),
        ("both ends elsewhere", |data| rewire(data, spring(data, 16, 24), 20, 40)),
        ("the first spring", |data| rewire(data, 0, 0, 10)),
        ("the last spring", |data| rewire(data, data.springs.len() - 1, 40, 48)),
        ("the last row's neighbour", |data| rewire(data, spring(data, 40, 48), 40, 46)),
        ("two springs that exchange their owners", |data| {
            let (one, other) = (spring(data, 9, 17), spring(data, 16, 24));
            rewire(data, one, 16, 17);
            rewire(data, other, 9, 24);
        }),
        ("the same other end, owned by the next row", |data| rewire(data, spring(data, 16, 24), 17, 24)),
        ("two springs of a row in another order", |data| {
            let (one, other) = (spring(data, 23, 24), spring(data, 23, 30));
            data.springs.swap(one, other);
        }),
    ];
    for (name, change) in changes {
        let mut second = first.clone();
        change(&mut second);
        assert_eq!((second.len(), second.springs.len()), (first.len(), first.springs.len()));
        let mut memory = Memory::new(&first);
        for (data, times) in [(&first, "first"), (&second, "then"), (&first, "back")] {
            let mut data = data.clone();
            assert!(memory.analyses(&mut data), "{name}, {times}");
            assert!(!memory.analyses(&mut data), "{name}, {times}, again");
        }
    }
}

#[test]
fn a_record_of_another_fingerprint_of_other_springs_levels_or_rows_is_not_believed() {
    let mut data = net();
    let mut memory = Memory::new(&data);
    memory.step(&mut data);
    // The record lies in front: two words of fingerprint, springs, levels, the finest level's rows.
    for place in 0..5 {
        for change in [1 << 3, 1 << 31] {
            assert!(!memory.analyses(&mut data));
            memory.words[place] ^= change;
            assert!(memory.analyses(&mut data), "word {place}");
        }
    }
    memory.words[3] = 0;
    assert!(memory.analyses(&mut data), "no levels");
}

#[test]
fn both_of_two_islands_are_kept_and_only_the_one_that_changes_is_found_anew() {
    let (large, small) = (net(), generate::cloth(6));
    let mut data = large.clone();
    for i in 0..small.len() {
        let added = data.particle(small.position[i], small.mass[i]);
        data.pinned[added] = small.pinned[i];
    }
    for spring in &small.springs {
        data.spring_with(spring.a + large.len(), spring.b + large.len(), spring.k, spring.l0);
    }
    // The smaller island is analysed in the last of the words that the larger one is analysed in.
    let (all, last) = (worked_in(&large), worked_in(&small));
    let mut memory = Memory::new(&data);
    let mut written = |data: &mut SceneData| {
        let written = memory.written(data, all);
        let (before, behind) = written.split_at(all - last);
        [before, behind].map(|words| words.contains(&true))
    };
    assert_eq!(written(&mut data), [true, true], "nothing is known yet");
    assert_eq!(written(&mut data), [false, false], "both are known");
    assert_eq!(written(&mut data), [false, false], "both are known");
    let (a, b) = (large.len() + 14, large.len() + 29);
    let j = spring(&data, a, a + 1);
    rewire(&mut data, j, a, b);
    assert_eq!(written(&mut data), [false, true], "the smaller one is found anew");
    assert_eq!(written(&mut data), [false, false], "both are known");
    let j = spring(&data, 23, 24);
    rewire(&mut data, j, 23, 44);
    assert!(written(&mut data)[0], "the larger one is found anew");
    assert_eq!(written(&mut data), [false, false], "both are known");
}
