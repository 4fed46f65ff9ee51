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
