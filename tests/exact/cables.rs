//! Cables only pull.

use hooke::{Cables, Hookean, Law, LinearlyImplicitEuler, Mixed, Spring, SpringDamping};
use hooke_tests::build;
use hooke_tests::vec_memory::VecScene;

const SPRING: Spring<f64> = Spring { stiffness: 100.0, rest_length: 1.0 };

fn hanging<L: Law>(length: f64) -> VecScene<f64, L> {
    let mut scene = VecScene::<f64, L>::empty();
    let a = scene.particle([0.0; 3], 1.0).unwrap();
    let b = scene.particle([length, 0.0, 0.0], 1.0).unwrap();
    scene.pin(a).unwrap();
    scene.spring_with(a, b, SPRING).unwrap();
    scene
}

#[test]
fn a_slack_cable_has_no_force_no_energy_and_no_stiffness() {
    let mut scene = hanging::<Cables>(0.75);
    scene.set_velocity(1, [0.5, 0.25, 0.0]).unwrap();
    let springs = scene.springs();
    assert_eq!(
        (springs.potential_energy(), springs.tension_of(0), springs.length_of(0)),
        (0.0, 0.0, Some(0.75))
    );
    let (mut f, mut y) = ([[0.0; 3]; 2], [[0.0; 3]; 2]);
    springs.add_force(&mut f);
    springs.stiffness_product(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], &mut y);
    assert_eq!((f, y), ([[0.0; 3]; 2], [[0.0; 3]; 2]));
    springs.stiffness_blocks(|_, _, _| panic!("a slack cable has no block"));
    // The step sees neither its force, nor its stiffness, nor its damping: the particle flies on.
    let mut euler = LinearlyImplicitEuler::new(1.0 / 64.0).with(SpringDamping(10.0));
    let report = scene.step(&mut euler).unwrap();
    assert_eq!((report.iterations, report.clamped), (0, 0));
    assert_eq!(scene.velocities()[1], [0.5, 0.25, 0.0]);
    assert_eq!(scene.positions()[1], [0.75 + 0.5 / 64.0, 0.25 / 64.0, 0.0]);
}

#[test]
fn a_slack_cable_has_no_hessian() {
    // The same question as above, asked of `MassSpring::hessian`.
    let scene = hanging::<Cables>(0.75);
    let hessian = scene.springs().hessian_of(0).unwrap();
    assert_eq!((hessian.alpha, hessian.w), (0.0, [0.0; 3]));
}

#[test]
fn a_taut_cable_is_a_spring_bit_for_bit() {
    let (mut cable, mut spring) = (hanging::<Cables>(1.25), hanging::<Hookean>(1.25));
    let mut euler = LinearlyImplicitEuler::new(0.001).gravity([0.0, -1.0, 0.0]);
    for _ in 0..20 {
        cable.step(&mut euler).unwrap();
        spring.step(&mut euler).unwrap();
        assert!(cable.springs().tension_of(0) > 0.0);
        assert_eq!(build::bits(&cable), build::bits(&spring));
    }
}

#[test]
fn in_a_mixed_scene_exactly_the_cables_go_slack() {
    let mut scene = VecScene::<f64, Mixed>::empty();
    for x in [0.0, 0.5, 1.0] {
        scene.particle([x, 0.0, 0.0], 1.0).unwrap();
    }
    let spring = scene.spring_with(0, 1, SPRING).unwrap();
    let cable = scene.cable(1, 2, SPRING).unwrap();
    assert_eq!((scene.springs().tension_of(spring), scene.springs().tension_of(cable)), (-50.0, 0.0));
    assert_eq!(scene.springs().potential_energy(), 12.5);
    let mut f = [[0.0; 3]; 3];
    scene.springs().add_force(&mut f);
    assert_eq!(f, [[-50.0, 0.0, 0.0], [50.0, 0.0, 0.0], [0.0; 3]]);
}

#[test]
fn a_cable_at_its_rest_length_is_taut_without_force() {
    let scene = hanging::<Cables>(1.0);
    assert_eq!(scene.springs().tension_of(0), 0.0);
    let mut blocks = 0;
    scene.springs().stiffness_blocks(|_, _, _| blocks += 1);
    assert_eq!(blocks, 4);
}

#[test]
fn springs_and_cables_are_numbered_together_as_they_are_added() {
    let mut scene = VecScene::<f64, hooke::Mixed>::empty();
    for x in 0..5 {
        scene.particle([f64::from(x), 0.0, 0.0], 1.0).unwrap();
    }
    assert_eq!(scene.cable(0, 1, SPRING), Ok(0));
    assert_eq!(scene.cable(1, 2, SPRING), Ok(1));
    assert_eq!(scene.spring_with(2, 3, SPRING), Ok(2));
    assert_eq!(scene.cable(3, 4, SPRING), Ok(3));
}
