//! Waking: any change of what an island's step depends on wakes it, and none is missed.

use hooke::{LinearlyImplicitEuler, Mixed, Motion, Rest, Snapshot, Spring};
use hooke_tests::build;
use hooke_tests::random::Random;
use hooke_tests::vec_memory::{VecMemory, VecScene};

use crate::sleeping::{DT, JOULES, Memory, Set, but_for_asleep, euler, hanging, memory, roomy, set, thrown};

/// A scene asleep, what it remembers, and the same scene under the rule alone.
struct Asleep {
    scene: VecScene<f64>,
    awake: VecScene<f64>,
    memory: Memory<f64>,
    forces: Set<f64>,
}

const ISLANDS: u32 = 3;

fn asleep() -> Asleep {
    let data = hanging();
    let (mut scene, mut awake) = (build::scene::<f64>(&data), build::scene::<f64>(&data));
    let mut kept = roomy(JOULES, &data);
    let forces = set(&data);
    for _ in 0..600 {
        let report = scene.step(&mut euler(DT, JOULES, forces, &mut kept)).unwrap();
        awake.step(&mut euler(DT, JOULES, forces, Rest(JOULES))).unwrap();
        if report.asleep == ISLANDS {
            return Asleep { scene, awake, memory: kept, forces };
        }
    }
    panic!("it does not fall asleep");
}

/// Steps of the scene that sleeps and of the one that does not, alike from now on; answers how many islands were asleep in
/// the first.
fn alike(a: &mut Asleep, dt: f64, absolute: f64, motion: &[Motion<f64>]) -> u32 {
    let mut first = None;
    for step in 0..30 {
        let motion = if step == 0 { motion } else { &[] };
        let mut sleeping = euler(dt, absolute, a.forces, &mut a.memory);
        let report = a.scene.step_moving(&mut sleeping, motion).unwrap();
        let other = a.awake.step_moving(&mut euler(dt, absolute, a.forces, Rest(JOULES)), motion).unwrap();
        assert_eq!(but_for_asleep(report), other, "step {step}");
        assert_eq!(build::bits(&a.scene), build::bits(&a.awake), "step {step}");
        first.get_or_insert(report.asleep);
    }
    first.unwrap()
}

/// Does a change of both scenes wake so many islands?
fn wakes(how_many: u32, change: impl Fn(&mut VecScene<f64>)) {
    let mut a = asleep();
    change(&mut a.scene);
    change(&mut a.awake);
    assert_eq!(ISLANDS - alike(&mut a, DT, JOULES, &[]), how_many);
}

fn force_wakes(how_many: u32, change: impl Fn(&mut Set<f64>)) {
    let mut a = asleep();
    change(&mut a.forces);
    assert_eq!(ISLANDS - alike(&mut a, DT, JOULES, &[]), how_many);
}

#[test]
fn nothing_wakes_where_nothing_changes() {
    let before = build::bits(&asleep().scene);
    wakes(0, |_| {});
    let mut a = asleep();
    alike(&mut a, DT, JOULES, &[]);
    assert_eq!(build::bits(&a.scene), before);
}

#[test]
fn a_changed_field_wakes() {
    force_wakes(ISLANDS, |forces| forces.0.0.0.1.0[1] = -9.82);
    force_wakes(ISLANDS, |forces| forces.0.0.0.1.0[1] = -9.810_000_000_000_002);
}

#[test]
fn a_changed_drag_wakes_though_nothing_moves() {
    force_wakes(ISLANDS, |forces| forces.0.0.1.0 = 6.5);
}

#[test]
fn changed_damping_wakes_though_nothing_moves() {
    force_wakes(ISLANDS, |forces| forces.0.1.0 = 0.02);
}

#[test]
fn a_force_on_one_particle_wakes_its_island() {
    force_wakes(1, |forces| forces.1.force = [0.0, 0.5, 0.0]);
}

#[test]
fn a_pin_that_moves_wakes_its_island() {
    let mut a = asleep();
    let [x, y, z] = a.scene.positions()[0];
    let motion = Motion { particle: 0, position: [x, y + 0.01, z], velocity: [0.0; 3] };
    assert_eq!(alike(&mut a, DT, JOULES, &[motion]), ISLANDS - 1);
}

#[test]
fn a_pin_that_is_told_to_stay_wakes_nothing() {
    let mut a = asleep();
    let motion = Motion { particle: 0, position: a.scene.positions()[0], velocity: [0.0; 3] };
    assert_eq!(alike(&mut a, DT, JOULES, &[motion]), ISLANDS);
}

#[test]
fn a_pin_put_elsewhere_wakes_its_island() {
    wakes(1, |scene| {
        let [x, y, z] = scene.positions()[0];
        scene.set_position(0, [x, y + 1e-9, z]).unwrap();
    });
}

#[test]
fn a_particle_put_elsewhere_wakes_its_island() {
    wakes(1, |scene| {
        let [x, y, z] = scene.positions()[4];
        scene.set_position(4, [x, y + 1e-9, z]).unwrap();
    });
}

#[test]
fn an_impulse_wakes_its_island() {
    wakes(1, |scene| scene.impulse(4, [0.0, 0.0, 1e-9]).unwrap());
    wakes(1, |scene| scene.impulse(4, [0.0, 0.0, 1.0]).unwrap());
}

#[test]
fn a_velocity_wakes_its_island() {
    wakes(1, |scene| scene.set_velocity(4, [1e-300, 0.0, 0.0]).unwrap());
}

#[test]
fn a_changed_stiffness_wakes_its_island() {
    wakes(1, |scene| scene.set_stiffness(2, 999.0).unwrap());
}

#[test]
fn a_changed_rest_length_wakes_its_island() {
    wakes(1, |scene| {
        let old = scene.state().spring(2).rest_length;
        scene.set_rest_length(2, old * (1.0 + 1e-15)).unwrap();
    });
}

#[test]
fn a_changed_mass_wakes_its_island() {
    wakes(1, |scene| scene.set_mass(4, 0.5).unwrap());
}

#[test]
fn a_broken_spring_wakes() {
    wakes(ISLANDS, |scene| scene.break_spring(2).unwrap());
}

#[test]
fn an_added_particle_wakes() {
    // One more island, which falls.
    wakes(ISLANDS, |scene| _ = scene.particle([0.0, 5.0, 0.0], 1.0).unwrap());
}

#[test]
fn an_added_spring_wakes() {
    wakes(ISLANDS, |scene| _ = scene.spring(3, 12, 10.0).unwrap());
}

#[test]
fn a_particle_pinned_or_released_wakes() {
    wakes(ISLANDS, |scene| scene.pin(4).unwrap());
    wakes(ISLANDS, |scene| scene.release(0).unwrap());
}

#[test]
fn another_dt_wakes() {
    assert_eq!(alike(&mut asleep(), DT / 2.0, JOULES, &[]), 0);
}

#[test]
fn another_dt_wakes_though_no_force_is_scaled_by_it() {
    let mut scene = thrown(0.0);
    let mut kept = memory(1.0, 1, 0);
    let mut asleep = |dt| scene.step(&mut LinearlyImplicitEuler::new(dt).sleeping(&mut kept)).unwrap().asleep;
    assert_eq!([0.1, 0.1, 0.1, 0.2, 0.2].map(&mut asleep), [0, 1, 1, 0, 1]);
}

#[test]
fn another_tolerance_wakes() {
    assert_eq!(alike(&mut asleep(), DT, 2.0 * JOULES, &[]), 0);
    assert_eq!(alike(&mut asleep(), DT, JOULES / 1e6, &[]), 0);
}

#[test]
fn a_restored_snapshot_wakes_and_goes_on_bit_for_bit() {
    let mut moving = Snapshot::<VecMemory<f64>>::empty();
    build::scene::<f64>(&hanging()).save(&mut moving).unwrap();
    wakes(ISLANDS, |scene| scene.restore(&moving).unwrap());
    // Restored as it was when it fell asleep it is what is remembered.
    wakes(0, |scene| {
        let mut now = Snapshot::<VecMemory<f64>>::empty();
        scene.save(&mut now).unwrap();
        scene.restore(&now).unwrap();
    });
}

#[test]
fn what_another_method_does_meanwhile_is_noticed() {
    wakes(ISLANDS, |scene| {
        let mut heavier = LinearlyImplicitEuler::new(DT).gravity([0.0, -20.0, 0.0]);
        scene.step(&mut heavier).unwrap();
    });
}

#[test]
fn what_another_method_did_and_an_edit_undid_leaves_no_trace() {
    wakes(0, |scene| {
        let before = scene.positions().to_vec();
        scene.step(&mut LinearlyImplicitEuler::new(DT).gravity([0.0, -20.0, 0.0])).unwrap();
        for (i, x) in before.into_iter().enumerate() {
            scene.set_position(i, x).unwrap();
            _ = scene.set_velocity(i, [0.0; 3]);
        }
    });
}

#[test]
fn a_memory_taken_to_another_scene_of_the_same_pattern_is_of_no_use_there() {
    let mut a = asleep();
    (a.scene, a.awake) = (build::scene(&hanging()), build::scene(&hanging()));
    assert_eq!(alike(&mut a, DT, JOULES, &[]), 0);
}

/// Springs, pins, and whether the springs are cables.
type Pattern = (&'static [(usize, usize)], &'static [usize], bool);

/// Three particles in one place, joined by springs of rest length 0: nothing but the pattern tells such scenes apart.
fn in_one_place(springs: &[(usize, usize)], pinned: &[usize], cables: bool) -> VecScene<f64, Mixed> {
    let mut scene = VecScene::empty();
    for i in 0..3 {
        scene.particle([0.0; 3], 1.0).unwrap();
        if pinned.contains(&i) {
            scene.pin(i).unwrap();
        }
    }
    let spring = Spring { stiffness: 100.0, rest_length: 0.0 };
    for (a, b) in springs {
        if cables { scene.cable(*a, *b, spring) } else { scene.spring_with(*a, *b, spring) }.unwrap();
    }
    scene
}

#[test]
fn scenes_that_differ_in_their_pattern_alone_are_told_apart() {
    let scenes: [Pattern; 8] = [
        (&[(0, 1), (1, 2)], &[], false),
        (&[(0, 1), (1, 2)], &[], true),
        (&[(0, 1), (0, 2)], &[], false),
        (&[(0, 2), (1, 2)], &[], false),
        (&[(0, 1), (0, 2)], &[2], false),
        (&[(0, 1), (0, 2)], &[1, 2], false),
        (&[(0, 1)], &[], false),
        (&[(1, 2)], &[], false),
    ];
    for (i, a) in scenes.iter().enumerate() {
        for (j, b) in scenes.iter().enumerate().filter(|(j, _)| *j != i) {
            let mut euler = LinearlyImplicitEuler::new(DT).sleeping(memory(0.0, 3, 2));
            let [mut a, mut b] =
                [a, b].map(|(springs, pinned, cables)| in_one_place(springs, pinned, *cables));
            let mut asleep = |scene: &mut VecScene<f64, Mixed>| {
                let report = scene.step(&mut euler).unwrap();
                (report.asleep, report.islands)
            };
            let islands = asleep(&mut a).1;
            assert_eq!(asleep(&mut a), (islands, islands));
            let (sleep, islands) = asleep(&mut b);
            assert_eq!(sleep, 0, "{i}, {j}");
            assert_eq!(asleep(&mut b), (islands, islands));
        }
    }
}

/// One change of a kind, to be made in both scenes alike; what is refused in one is refused in the other.
fn change(
    scene: &mut VecScene<f64>,
    kind: usize,
    i: usize,
    j: usize,
    x: f64,
    kept: &Snapshot<VecMemory<f64>>,
) {
    let data = hanging();
    let at = scene.positions()[i];
    _ = match kind {
        0 => scene.set_mass(i, x),
        1 => scene.set_stiffness(j, 1e3 * x),
        2 => scene.set_rest_length(j, 0.4 * x),
        3 => scene.impulse(i, [0.0, 0.0, 1e-3 * x]),
        4 => scene.break_spring(j),
        5 => scene.pin(i),
        6 => scene.release(i),
        7 => scene.set_position(i, at.map(|q| q + 1e-6 * x)),
        8 => scene.set_velocity(i, [0.0; 3]),
        9 => scene.restore(kept),
        10 if scene.positions().len() < data.len() + 4 => scene.particle([x, 1.0, 0.0], x).map(|_| ()),
        11 if scene.state().springs() < data.springs.len() + 4 => scene.spring(i, 12, 100.0 * x).map(|_| ()),
        12 => {
            scene.step(&mut LinearlyImplicitEuler::new(DT)).unwrap();
            Ok(())
        }
        _ => Ok(()),
    };
}

#[test]
fn random_changes_of_a_scene_that_sleeps_are_never_missed() {
    let mut random = Random::new(Random::seed(5));
    let mut a = asleep();
    let (mut skipped, mut kept) = (0, Snapshot::empty());
    a.scene.save(&mut kept).unwrap();
    for _ in 0..150 {
        let (i, j) = (random.below(a.scene.positions().len()), random.below(a.scene.state().springs()));
        let (x, kind) = (random.between(0.5, 2.0), random.below(24));
        for scene in [&mut a.scene, &mut a.awake] {
            change(scene, kind, i, j, x, &kept);
        }
        match kind {
            13 => a.forces.1.force = [0.0, 0.0, x],
            14 => a.forces.0.0.1.0 = 4.0 * x,
            15 => a.scene.save(&mut kept).unwrap(),
            _ => {}
        }
        // A restored scene may have fewer particles.
        let i = i % a.scene.positions().len();
        let [q, y, z] = a.scene.positions()[i];
        let motion = Motion { particle: i, position: [q + 1e-3 * x, y, z], velocity: [0.0; 3] };
        let motion = if kind == 16 && a.scene.is_pinned(i) { &[motion][..] } else { &[] };
        let dt = if kind == 17 { DT / 2.0 } else { DT };
        skipped += alike(&mut a, dt, JOULES, motion);
    }
    assert!(skipped > 0, "nothing ever slept, so nothing could be missed");
}

#[test]
fn each_island_says_whether_it_is_asleep() {
    let mut a = asleep();
    a.scene.impulse(4, [0.0, 0.0, 1.0]).unwrap();
    let mut seen = Vec::new();
    let mut sleeping = euler(DT, JOULES, a.forces, &mut a.memory);
    let report = a
        .scene
        .step_watched(&mut sleeping, &[], |i| seen.push((i.first_particle, i.particles, i.asleep)))
        .unwrap();
    assert_eq!(seen, [(1, 7, false), (10, 7, true), (19, 3, true)]);
    assert_eq!((report.islands, report.asleep, report.untouched), (3, 2, 2));
}
