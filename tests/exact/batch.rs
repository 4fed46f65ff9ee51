//! Many scenes on several threads: each has the bits that it has alone, whatever the others do.

use hooke::{Drag, Gravity, LinearlyImplicitEuler, StepError};
use hooke_harness::batch::{self, Failed, Member};
use hooke_harness::heap::Heap;
use hooke_harness::run::solver::{AnySolver, METHODS};
use hooke_harness::scene::{Model, catalog};

type Euler = LinearlyImplicitEuler<f64, (((), Gravity<f64>), Drag<f64>), AnySolver<f64>>;
type Scenes = Vec<Member<Heap<f64>, Euler>>;

fn model(name: &str) -> Model {
    catalog::named(name).unwrap().unwrap()
}

fn member(model: &Model, dt: f64, k: usize) -> Member<Heap<f64>, Euler> {
    let mut scene = model.build().unwrap();
    let solver = AnySolver::new(METHODS[k % METHODS.len()].1, &mut scene, model);
    let euler = LinearlyImplicitEuler::new(dt).gravity(model.gravity).with(Drag(0.1 * k as f64));
    Member { scene, integrator: euler.tolerance(1e-8).solver(solver) }
}

/// Scenes of different sizes, steps, drags and solvers.
fn scenes() -> Scenes {
    let names = ["chain:9", "cloth:7", "lattice:3x3x3", "pair", "chain:40", "net:5", "spring", "cloth:12"];
    let scene = |k: usize| member(&model(names[k % names.len()]), 0.01 + 1e-3 * k as f64, k);
    (0..19).map(scene).collect()
}

fn bits(member: &Member<Heap<f64>, Euler>) -> Vec<[u64; 6]> {
    let both = member.scene.positions().iter().zip(member.scene.velocities());
    both.map(|(x, v)| [x[0], x[1], x[2], v[0], v[1], v[2]].map(f64::to_bits)).collect()
}

#[test]
fn any_number_of_threads_gives_the_bits_and_reports_of_one_scene_after_the_other() {
    let mut alone = scenes();
    let mut expected = Vec::new();
    for Member { scene, integrator } in &mut alone {
        let reports: Vec<_> = (0..12).map(|_| scene.step(integrator).unwrap()).collect();
        expected.push(Ok(reports.last().copied()));
    }
    for threads in [0, 1, 2, 3, 7, 100] {
        let mut together = scenes();
        // Two calls are one long one.
        batch::step(&mut together, 5, threads);
        assert_eq!(batch::step(&mut together, 7, threads), expected, "{threads} threads");
        for (a, b) in alone.iter().zip(&together) {
            assert_eq!(bits(a), bits(b), "{threads} threads");
        }
    }
}

#[test]
fn a_scene_that_fails_says_where_and_disturbs_no_other() {
    for threads in [1, 2, 3] {
        let (mut with, mut without) = (scenes(), scenes());
        // Two steps of 5e307 m/s each over 1.5 s stay within the range of f64, the third does not.
        let mut far = model("pair");
        far.springs[0].stiffness = 0.0;
        far.velocity = vec![[5e307, 0.0, 0.0]; 2];
        with.insert(4, member(&far, 1.5, 0));
        with.insert(9, member(&model("cloth:5"), f64::NAN, 0));
        let mut answers = batch::step(&mut with, 6, threads);
        assert_eq!(answers[4], Err(Failed { step: 3, error: StepError::NotFinite(0) }));
        assert_eq!(answers[9], Err(Failed { step: 1, error: StepError::TimeStep }));
        assert_eq!(with[4].scene.velocities()[0], [5e307, 0.0, 0.0]);
        assert_eq!(with[9].scene.positions(), model("cloth:5").position);
        for k in [9, 4] {
            answers.remove(k).unwrap_err();
            with.remove(k);
        }
        assert_eq!(answers, batch::step(&mut without, 6, 1));
        assert!(with.iter().zip(&without).all(|(a, b)| bits(a) == bits(b)));
    }
}

#[test]
fn nothing_to_do_is_done() {
    assert_eq!(batch::step(&mut scenes(), 0, 3), vec![Ok(None); 19]);
    assert_eq!(batch::step(&mut Scenes::new(), 3, 4), vec![]);
}

#[test]
fn answers_come_in_the_order_of_the_items_and_each_is_worked_on_once() {
    let mut items = vec![0; 1000];
    let answers = batch::each(&mut items, 4, |k, item| {
        *item += 1;
        // Some take longer than others.
        (0..k % 7 * 1000).fold(k, |x, i| if i == usize::MAX { 0 } else { x })
    });
    assert_eq!(answers, (0..1000).collect::<Vec<_>>());
    assert_eq!(items, vec![1; 1000]);
}
