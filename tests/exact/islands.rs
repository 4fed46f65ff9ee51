//! Islands: what is solved apart does not feel the rest, bit for bit.

use hooke::{IslandReport, LinearlyImplicitEuler, Real};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use hooke_tests::random::Random;
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::vec_memory::VecScene;

fn alone_and_beside<T: Real>(seed: u64) {
    let a = generate::gentle_network(seed, 11);
    let mut b = generate::gentle_network(seed + 100, 6);
    (b.gravity, b.drag) = (a.gravity, a.drag);
    let (both, places) = side_by_side(&a, &b);
    let (mut alone, mut beside) = (build::scene::<T>(&a), build::scene::<T>(&both));
    let (mut of_a, mut of_both) = (Forces::<T>::new(&a), Forces::<T>::new(&both));
    let h = T::from_f64(1.0 / 60.0);
    let (mut euler, mut eulers) = (of_a.euler(h), of_both.euler(h));
    for _ in 0..20 {
        alone.step(&mut euler).unwrap();
        beside.step(&mut eulers).unwrap();
        let together = build::bits(&beside);
        let picked: Vec<_> = places.iter().map(|i| together[*i]).collect();
        assert_eq!(picked, build::bits(&alone));
    }
}

#[test]
fn a_and_b_together_give_a_the_bits_of_a_alone() {
    for seed in 0..10 {
        alone_and_beside::<f64>(seed);
        alone_and_beside::<f32>(seed);
    }
}

#[test]
fn two_ropes_on_one_pin_are_two_islands() {
    let mut data = SceneData { gravity: [0.0, -9.81, 0.0], ..SceneData::default() };
    let pin = data.particle([0.0; 3], 1.0);
    data.pinned[pin] = true;
    for side in [-1.0, 1.0] {
        let mut above = pin;
        for i in 1..=5 {
            let below = data.particle([side * 0.1 * f64::from(i), 0.0, 0.0], 0.01);
            data.spring(above, below, 1e3);
            above = below;
        }
    }
    let mut scene = build::scene::<f64>(&data);
    assert_eq!((scene.islands(), scene.free_particles()), (2, 10));
    scene.release(pin).unwrap();
    assert_eq!((scene.islands(), scene.free_particles()), (1, 11));
    scene.pin(pin).unwrap();
    let mut seen = Vec::new();
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    scene
        .step_watched(&mut euler, &[], |island: &IslandReport<f64>| {
            seen.push((island.first_particle, island.particles, island.solve.iterations));
        })
        .unwrap();
    assert_eq!(seen[0].2, seen[1].2, "mirror images need the same iterations");
    assert_eq!([(seen[0].0, seen[0].1), (seen[1].0, seen[1].1)], [(1, 5), (6, 5)]);
}

#[test]
fn an_island_at_rest_takes_no_iterations_beside_one_that_moves() {
    let mut scene = VecScene::<f64>::empty();
    for x in 0..4 {
        scene.particle([f64::from(x), 0.0, 0.0], 1.0).unwrap();
    }
    scene.spring(0, 1, 100.0).unwrap();
    scene.spring(2, 3, 100.0).unwrap();
    scene.set_velocity(3, [1.0, 0.0, 0.0]).unwrap();
    let mut iterations = Vec::new();
    let mut euler = LinearlyImplicitEuler::new(0.1);
    let report =
        scene.step_watched(&mut euler, &[], |island| iterations.push(island.solve.iterations)).unwrap();
    assert_eq!((report.islands, report.untouched), (2, 1));
    assert_eq!(iterations[0], 0);
    assert!(iterations[1] > 0);
    assert_eq!(scene.velocities()[..2], [[0.0; 3]; 2]);
}

#[test]
fn springs_between_two_pins_and_broken_springs_are_skipped_and_counted() {
    let data = generate::rope(5);
    let mut scene = build::scene::<f64>(&data);
    let mut euler = LinearlyImplicitEuler::new(0.01).gravity(data.gravity);
    assert_eq!(scene.step(&mut euler).unwrap().springs_skipped, 0);
    scene.pin(1).unwrap();
    assert_eq!(scene.step(&mut euler).unwrap().springs_skipped, 1);
    scene.break_spring(3).unwrap();
    let report = scene.step(&mut euler).unwrap();
    assert_eq!((report.springs_skipped, report.islands), (2, 2));
}

#[test]
fn a_spring_between_two_pins_changes_no_bit_of_the_rest() {
    let mut data = generate::rope(8);
    data.pinned[7] = true;
    let mut tied = data.clone();
    tied.spring(0, 7, 1e6);
    let (mut a, mut b) = (build::scene::<f64>(&data), build::scene::<f64>(&tied));
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    for _ in 0..10 {
        a.step(&mut euler).unwrap();
        b.step(&mut euler).unwrap();
        assert_eq!(build::bits(&a), build::bits(&b));
    }
}

#[test]
fn islands_are_the_connected_components_over_free_particles() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let n = 3 + random.below(30);
        let mut data = SceneData::default();
        for _ in 0..n {
            data.particle(random.vector(1.0), 1.0);
        }
        for _ in 0..random.below(2 * n) {
            let (a, b) = (random.below(n), random.below(n));
            if a != b {
                data.spring(a, b, 1.0);
            }
        }
        for i in 0..n {
            data.pinned[i] = random.chance(0.2);
        }
        // Components by repeated relabelling: no union–find here.
        let mut label: Vec<usize> = (0..n).collect();
        loop {
            let before = label.clone();
            for s in &data.springs {
                if !data.pinned[s.a] && !data.pinned[s.b] {
                    let low = label[s.a].min(label[s.b]);
                    (label[s.a], label[s.b]) = (low, low);
                }
            }
            if label == before {
                break;
            }
        }
        let mut expected: Vec<(usize, usize)> = Vec::new();
        for i in 0..n {
            let members = label.iter().zip(&data.pinned).filter(|(l, p)| **l == i && !**p).count();
            if !data.pinned[i] && label[i] == i {
                expected.push((i, members));
            }
        }
        let mut scene = build::scene::<f64>(&data);
        let mut found = Vec::new();
        let mut euler = LinearlyImplicitEuler::new(0.01);
        let report = scene
            .step_watched(&mut euler, &[], |island| found.push((island.first_particle, island.particles)))
            .unwrap();
        assert_eq!(found, expected, "seed {seed}");
        assert_eq!(report.springs_skipped as usize, data.springs.iter().filter(|s| !data.acts(s)).count());
    }
}
