//! Snapshots: a restored scene goes on bit for bit, whatever owns its memory.

use hooke::{Fixed, LinearlyImplicitEuler, MassSpring, Memory, Scene, SceneIn, Snapshot};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use hooke_tests::vec_memory::{VecMemory, VecScene};

const DT: f64 = 1.0 / 60.0;

fn run<M: Memory<Real = f64>>(scene: &mut MassSpring<M>, data: &SceneData, steps: usize) -> Vec<[u64; 6]> {
    let mut forces = Forces::<f64>::new(data);
    let mut euler = forces.euler(DT);
    for _ in 0..steps {
        scene.step(&mut euler).unwrap();
    }
    build::bits(scene)
}

#[test]
fn a_restored_scene_resumes_bit_for_bit() {
    for seed in 0..10 {
        let data = generate::gentle_network(seed, 12);
        let mut scene = build::scene::<f64>(&data);
        run(&mut scene, &data, 7);
        let mut saved = Snapshot::<VecMemory<f64>>::empty();
        scene.save(&mut saved).unwrap();
        let first = run(&mut scene, &data, 13);
        scene.restore(&saved).unwrap();
        assert_eq!(run(&mut scene, &data, 13), first, "the same scene");
        let mut other = VecScene::<f64>::empty();
        other.restore(&saved).unwrap();
        assert_eq!(run(&mut other, &data, 13), first, "an empty one");
        let mut other = build::scene::<f64>(&generate::rope(40));
        other.restore(&saved).unwrap();
        assert_eq!(run(&mut other, &data, 13), first, "a larger one, whose particles are gone");
        assert_eq!((other.positions().len(), other.state().springs()), (data.len(), data.springs.len()));
    }
}

#[test]
fn a_snapshot_undoes_edits_bit_for_bit() {
    let data = generate::gentle_network(3, 12);
    let mut scene = build::scene::<f64>(&data);
    run(&mut scene, &data, 3);
    scene.set_stiffness(1, 77.0).unwrap();
    scene.break_spring(2).unwrap();
    let mut saved = Snapshot::<VecMemory<f64>>::empty();
    scene.save(&mut saved).unwrap();
    let expected = run(&mut scene, &data, 10);
    let free = data.pinned.iter().position(|pinned| !pinned).unwrap();
    let i = scene.particle([9.0; 3], 1.0).unwrap();
    scene.spring(i, free, 1e3).unwrap();
    scene.break_spring(0).unwrap();
    scene.pin(free).unwrap();
    scene.set_mass(free, 50.0).unwrap();
    scene.set_rest_length(3, 4.0).unwrap();
    scene.step(&mut LinearlyImplicitEuler::new(DT)).unwrap();
    scene.restore(&saved).unwrap();
    assert_eq!(run(&mut scene, &data, 10), expected);
    assert_eq!(scene.state().ends(2), None, "broken before the snapshot, broken after");
    assert!(scene.state().ends(0).is_some() && !scene.is_pinned(free));
    assert_eq!(scene.state().spring(1).stiffness, 77.0);
}

#[test]
fn a_snapshot_restores_into_fixed_slices_and_growable_memory_alike() {
    let data = generate::gentle_network(4, 12);
    let mut scene = build::scene::<f64>(&data);
    run(&mut scene, &data, 5);
    let mut saved = Snapshot::<Fixed<f64, 16, 64>>::new();
    scene.save(&mut saved).unwrap();
    let expected = run(&mut scene, &data, 10);

    let mut fixed = Scene::<f64, 12, 40>::new();
    fixed.restore(&saved).unwrap();
    assert_eq!(run(&mut fixed, &data, 10), expected);

    let (reals, words) = SceneIn::<f64>::needs(12, data.springs.len());
    let (mut reals, mut words) = (vec![f64::NAN; reals], vec![u32::MAX; words]);
    let mut slices =
        SceneIn::<f64>::in_buffers(&mut reals, &mut words, 12, data.springs.len()).expect("just enough");
    slices.restore(&saved).unwrap();
    assert_eq!(run(&mut slices, &data, 10), expected, "what was in the buffers before does not matter");

    // Into what is not empty any more.
    fixed.restore(&saved).unwrap();
    slices.restore(&saved).unwrap();
    assert_eq!(
        (run(&mut fixed, &data, 10), run(&mut slices, &data, 10)),
        (expected.clone(), expected.clone())
    );

    // Room for the particles but not for the springs, and the other way round.
    let mut few_springs = Scene::<f64, 12, 3>::new();
    let mut few_particles = Scene::<f64, 11, 40>::new();
    assert!(few_springs.restore(&saved).is_err() && few_particles.restore(&saved).is_err());
    assert_eq!(
        (few_springs.positions().len(), few_particles.positions().len()),
        (0, 0),
        "and nothing has changed"
    );

    let mut grown = VecScene::<f64>::empty();
    grown.restore(&saved).unwrap();
    assert_eq!(run(&mut grown, &data, 10), expected);
    // And what is added after a restore works as ever.
    let i = grown.particle([0.5; 3], 1.0).unwrap();
    grown.spring(i, 0, 10.0).unwrap();
    grown.step(&mut LinearlyImplicitEuler::new(DT)).unwrap();
}
