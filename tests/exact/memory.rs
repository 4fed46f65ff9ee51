//! Who owns the memory does not touch a bit of the result.

use hooke::{Hookean, MassSpring, Memory, Real, Report, Scene, SceneIn};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;
use hooke_tests::vec_memory::VecScene;

type Trace<T> = Vec<(Vec<[u64; 6]>, Report<T>)>;

fn trace<M: Memory>(scene: &mut MassSpring<M>, data: &SceneData) -> Trace<M::Real> {
    build::fill(scene, data).unwrap();
    let mut forces = Forces::<M::Real>::new(data);
    let mut euler = forces.euler(M::Real::from_f64(1.0 / 60.0));
    let step = |_| {
        let report = scene.step(&mut euler).unwrap();
        (build::bits(scene), report)
    };
    (0..25).map(step).collect()
}

fn alike<T: Real>() {
    for seed in 0..5 {
        let data = generate::gentle_network(seed, 12);
        let grown = trace(&mut VecScene::<T, Hookean>::empty(), &data);
        assert_eq!(trace(&mut Scene::<T, 12, 24>::new(), &data), grown, "fixed");
        assert_eq!(trace(&mut Scene::<T, 50, 90>::new(), &data), grown, "fixed, with room to spare");
        let (n, s) = (data.len(), data.springs.len());
        let (reals, words) = SceneIn::<T>::needs(n, s);
        let (mut reals, mut words) = (vec![T::ONE; reals], vec![7; words]);
        let mut slices = SceneIn::<T>::in_buffers(&mut reals, &mut words, n, s).expect("just enough");
        assert_eq!(trace(&mut slices, &data), grown, "slices");
    }
}

#[test]
fn fixed_slices_and_growable_memory_give_the_same_bits_and_reports() {
    alike::<f64>();
    alike::<f32>();
}

#[test]
fn one_number_or_word_less_than_needed_is_refused() {
    let (reals, words) = SceneIn::<f64>::needs(5, 4);
    for (less_reals, less_words) in [(1, 0), (0, 1)] {
        let (mut reals, mut words) = (vec![0.0; reals - less_reals], vec![0; words - less_words]);
        assert!(SceneIn::<f64>::in_buffers(&mut reals, &mut words, 5, 4).is_none());
    }
    let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    assert!(SceneIn::<f64>::in_buffers(&mut reals, &mut words, usize::MAX, 4).is_none());
}

#[test]
fn an_empty_scene_steps() {
    let report = Scene::<f32, 0, 0>::new().step(&mut hooke::LinearlyImplicitEuler::new(0.1)).unwrap();
    assert_eq!((report.islands, report.iterations, report.springs_skipped), (0, 0, 0));
    assert!(report.is_certified());
}

/// A scene in buffers after some steps, with how far they are filled; edited since, or not.
fn left_in_buffers(edited: bool) -> (SceneData, Vec<f64>, Vec<u32>, [u32; 6]) {
    let data = generate::gentle_network(3, 12);
    let (n, s) = (data.len(), data.springs.len());
    let (reals, words) = SceneIn::<f64>::needs(n, s);
    let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    let mut scene = SceneIn::<f64>::in_buffers(&mut reals, &mut words, n, s).expect("just enough");
    build::fill(&mut scene, &data).unwrap();
    let mut forces = Forces::<f64>::new(&data);
    for _ in 0..5 {
        scene.step(&mut forces.euler(1.0 / 60.0)).unwrap();
    }
    if edited {
        scene.pin(7).unwrap();
        scene.break_spring(2).unwrap();
    }
    let counts = scene.counts();
    (data, reals, words, counts)
}

#[test]
fn a_scene_attached_to_its_buffers_again_goes_on_as_if_nothing_had_happened() {
    for edited in [false, true] {
        let (data, mut reals, mut words, counts) = left_in_buffers(edited);
        let (n, s) = (data.len(), data.springs.len());
        let mut stayed = build::scene::<f64>(&data);
        let mut forces = Forces::<f64>::new(&data);
        for _ in 0..5 {
            stayed.step(&mut forces.euler(1.0 / 60.0)).unwrap();
        }
        if edited {
            stayed.pin(7).unwrap();
            stayed.break_spring(2).unwrap();
        }
        let mut again = SceneIn::<f64>::attach(&mut reals, &mut words, n, s, counts).expect("it is there");
        assert_eq!((again.counts(), build::bits(&again)), (counts, build::bits(&stayed)));
        for _ in 0..5 {
            let report = stayed.step(&mut forces.euler(1.0 / 60.0)).unwrap();
            assert_eq!(again.step(&mut forces.euler(1.0 / 60.0)), Ok(report));
            assert_eq!(build::bits(&again), build::bits(&stayed));
        }
        // A step has found the islands anew, and says so.
        assert_eq!(again.counts()[5], 1);
    }
    let [particles, springs, islands, free, tied, current] = left_in_buffers(false).3;
    assert!(islands > 0 && islands < free && free < particles && tied <= springs && current == 1);
    assert_eq!(left_in_buffers(true).3[5], 0);
}

#[test]
fn counts_that_no_scene_has_are_refused_and_those_at_the_edge_are_not() {
    let fits = |counts: [u32; 6]| {
        let (data, mut reals, mut words, _) = left_in_buffers(false);
        let (n, s) = (data.len(), data.springs.len());
        SceneIn::<f64>::attach(&mut reals, &mut words, n, s, counts).is_some()
    };
    let (data, .., counts) = left_in_buffers(false);
    let (n, s) = (data.len() as u32, data.springs.len() as u32);
    assert!(fits(counts));
    for (good, bad) in [
        // Particles and springs up to the room, islands up to free particles, those up to all, tied springs up to all.
        ([n, s, 1, n, s, 1], [n + 1, s, 1, n, s, 1]),
        ([n, s, n, n, s, 0], [n, s + 1, n, n, s, 0]),
        ([n, s, 3, 3, s, 1], [n, s, 4, 3, s, 1]),
        ([4, s, 3, 4, s, 1], [4, s, 3, 5, s, 1]),
        ([n, 6, 1, 2, 6, 1], [n, 6, 1, 2, 7, 1]),
        ([n, s, 0, 0, 0, 1], [n, s, 0, 0, 0, 2]),
    ] {
        assert!(fits(good), "{good:?}");
        assert!(!fits(bad), "{bad:?}");
    }
}
