//! Forces side by side: a list acts as its sum, a force that is constant is as good as gravity, also where a method searches by
//! their potential.

use hooke::{
    BlockJacobi, Drag, Force, Gravity, LinearlyImplicitEuler, Newton, PointForce, PointSpring, SpringDamping,
    StepError, Verlet, WideJacobi,
};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{build, generate};

/// A pinned chain of particles of half a kilogram, stretched.
fn chain(n: usize) -> VecScene<f64> {
    let mut scene = VecScene::empty();
    for i in 0..n {
        let at = scene.particle([i as f64, 0.25 * (i % 3) as f64, 0.0], 0.5).unwrap();
        scene.set_velocity(at, [0.0, 1.0, -0.5]).unwrap();
    }
    for i in 1..n {
        scene.spring(i - 1, i, 64.0).unwrap();
    }
    scene.pin(0).unwrap();
    scene
}

/// Bits after some steps of 1/64 s.
fn run<F: Force<f64>>(mut scene: VecScene<f64>, forces: F) -> Vec<[u64; 6]> {
    let mut euler = LinearlyImplicitEuler::new(1.0 / 64.0).with(forces);
    for _ in 0..20 {
        scene.step(&mut euler).unwrap();
    }
    build::bits(&scene)
}

#[test]
fn drags_and_dampings_that_are_named_twice_or_listed_act_as_their_sum() {
    // Coefficients are powers of two or sums of few: their sum does not round.
    let one = run(chain(7), (Drag(0.75), SpringDamping(3.0)));
    assert_eq!(run(chain(7), ((Drag(0.5), Drag(0.25)), (SpringDamping(1.0), SpringDamping(2.0)))), one);
    let (mut drags, mut dampings) = ([Drag(0.5), Drag(0.25)], [SpringDamping(1.0), SpringDamping(2.0)]);
    assert_eq!(run(chain(7), (drags.as_mut_slice(), dampings.as_mut_slice())), one);
    assert_ne!(run(chain(7), (Drag(0.5), SpringDamping(3.0))), one, "a part of the drag");
    assert_ne!(run(chain(7), (Drag(0.75), SpringDamping(2.0))), one, "a part of the damping");
}

#[test]
fn its_weight_as_a_force_on_each_particle_is_gravity_bit_for_bit() {
    let weights =
        || (0..7).map(|particle| PointForce { particle, force: [0.0, 0.0, -4.0] }).collect::<Vec<_>>();
    assert_eq!(run(chain(7), weights().as_mut_slice()), run(chain(7), Gravity([0.0, 0.0, -8.0])));
}

#[test]
fn newton_searches_by_the_potential_of_every_force() {
    let step = |forces: &mut dyn FnMut(&mut VecScene<f64>)| {
        let mut scene = chain(7);
        forces(&mut scene);
        build::bits(&scene)
    };
    // Half a second, twenty springs' periods: without a force's potential the search finds no way down.
    let mut memory = vec![[0.0; 3]; 64];
    let gravity = step(&mut |scene| {
        let mut newton = Newton::new(0.5, memory.as_mut_slice()).with(Gravity([0.0, 0.0, -8.0]));
        scene.step(&mut newton).unwrap();
    });
    let mut weights: Vec<_> =
        (0..7).map(|particle| PointForce { particle, force: [0.0, 0.0, -4.0] }).collect();
    let weighed = step(&mut |scene| {
        let mut newton = Newton::new(0.5, memory.as_mut_slice()).with(weights.as_mut_slice());
        scene.step(&mut newton).unwrap();
    });
    assert_eq!(weighed, gravity);
}

#[test]
fn the_energy_of_a_spring_to_a_point_is_half_k_times_its_strain_squared() {
    let scene = chain(3);
    let mut points = [
        PointSpring::new(1, [1.0, 0.25, 3.0], 8.0).rest_length(1.0),
        PointSpring::new(2, [2.0, 0.5, 1.0], 2.0),
    ];
    // Of strains 2 m and 1 m: 16 J and 1 J.
    let energies = points.each_ref().map(|point| Force::<f64>::potential_energy(point, scene.state()));
    assert_eq!(energies, [16.0, 1.0]);
    assert_eq!(Force::<f64>::potential_energy(&points.as_mut_slice(), scene.state()), 17.0);
    assert_eq!(Force::<f64>::potential_energy(&(points[0], points[1]), scene.state()), 17.0);
    let nowhere = PointSpring::new(3, [0.0; 3], 1.0);
    assert_eq!(Force::<f64>::potential_energy(&nowhere, scene.state()), 0.0);
}

#[test]
fn springs_to_points_are_equal_if_they_pull_alike_whatever_they_have_been_through() {
    let used = || PointSpring::new(1, [5.0, 0.0, 0.0], 8.0);
    let mut point = [used()];
    run(chain(3), point.as_mut_slice());
    assert_eq!(point[0], used());
    assert_ne!(point[0], PointSpring::new(2, [5.0, 0.0, 0.0], 8.0));
    assert_ne!(point[0], PointSpring::new(1, [5.0, 0.5, 0.0], 8.0));
    assert_ne!(point[0], used().rest_length(1.0));
}

#[test]
fn another_time_step_holds_from_the_next_step_on() {
    let (mut changed, mut two) = (chain(7), chain(7));
    let mut euler = LinearlyImplicitEuler::new(1.0 / 64.0);
    changed.step(&mut euler).unwrap();
    euler.set_dt(1.0 / 32.0);
    assert_eq!(euler.dt(), 1.0 / 32.0);
    changed.step(&mut euler).unwrap();
    two.step(&mut LinearlyImplicitEuler::new(1.0 / 64.0)).unwrap();
    two.step(&mut LinearlyImplicitEuler::new(1.0 / 32.0)).unwrap();
    assert_eq!(build::bits(&changed), build::bits(&two));
}

/// A force that pushes one particle of a net off, as no spring does.
struct Repelling(usize);

impl Force<f64> for Repelling {
    const ANCHORS: bool = true;

    fn check(&self, _: usize, _: usize) -> Result<(), StepError> {
        Ok(())
    }
    fn hessians(
        &self,
        rows: &hooke::force::Rows<'_, f64>,
        visit: &mut impl FnMut(usize, hooke::Hessian<f64>),
    ) {
        if let Some(row) = rows.row(self.0) {
            visit(row, hooke::Hessian { alpha: -1e9, w: [0.0; 3] });
        }
    }
}

#[test]
fn a_matrix_that_a_force_makes_indefinite_is_an_error_that_names_the_particle_also_in_lanes() {
    for particle in [9, 24, 38] {
        let mut scene = build::scene::<f64>(&generate::cloth(7));
        let (numbers, words) = WideJacobi::needs_of(&mut scene, true);
        let before = build::bits(&scene);
        let wide = WideJacobi::new(vec![0.0; numbers], vec![0; words], hooke::Portable);
        let mut lanes = LinearlyImplicitEuler::new(0.01).with(Repelling(particle)).solver(wide);
        assert_eq!(scene.step(&mut lanes).unwrap_err(), StepError::NotCertified(particle));
        let mut plain = LinearlyImplicitEuler::new(0.01).with(Repelling(particle)).solver(BlockJacobi);
        assert_eq!(scene.step(&mut plain).unwrap_err(), StepError::NotCertified(particle));
        assert_eq!(build::bits(&scene), before);
    }
}

#[test]
fn a_force_that_repels_shortens_the_longest_step_of_verlet_as_one_that_attracts() {
    // h² ≤ 4m/k with m = 1 kg and |α| = h²k, whichever its sign: 10⁹ N/m allow no step of a hundredth of a second.
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    let mut verlet = Verlet::new(0.01).with(Repelling(0));
    assert_eq!(scene.step(&mut verlet).unwrap_err(), StepError::StepLimit(0));
    scene.step(&mut Verlet::new(0.01)).unwrap();
}

#[test]
fn potential_energies_of_forces_are_those_of_all_particles_and_add_up() {
    let mut scene = VecScene::<f64>::empty();
    for (x, m) in [([1.0, 2.0, 0.5], 2.0), ([-4.0, 0.25, 1.0], 0.5)] {
        scene.particle(x, m).unwrap();
    }
    let state = scene.state();
    // −m g·x: −2·(0.5 − 16 + 1) = 29 of the first, −0.5·(−2 − 2 + 2) = 1 of the second.
    let gravity = Gravity([0.5, -8.0, 2.0]);
    assert_eq!(gravity.potential_energy(state), 30.0);
    // ½·4·(3 − 1)² and ½·2·(2 − 0)².
    let mut points = [
        PointSpring::new(0, [1.0, 2.0, 3.5], 4.0).rest_length(1.0),
        PointSpring::new(1, [-4.0, -1.75, 1.0], 2.0),
    ];
    let points = points.as_mut_slice();
    assert_eq!((gravity, points).potential_energy(state), 30.0 + 8.0 + 4.0);
    assert_eq!(Force::<f64>::potential_energy(&(Drag(1.0), SpringDamping(1.0)), state), 0.0);
}

#[test]
fn every_point_spring_of_a_list_that_has_no_length_is_counted() {
    for many in 1..4 {
        let mut scene = VecScene::<f64>::empty();
        let mut points: Vec<_> = (0..many)
            .map(|i| {
                scene.particle([i as f64, 0.0, 0.0], 1.0).unwrap();
                PointSpring::new(i, [i as f64, 0.0, 0.0], 8.0).rest_length(0.5)
            })
            .collect();
        let mut euler = LinearlyImplicitEuler::new(0.01).with(points.as_mut_slice());
        assert_eq!(scene.step(&mut euler).unwrap().clamped, many as u32);
    }
}

#[test]
fn every_point_spring_of_a_list_that_must_be_clamped_is_and_is_counted() {
    // Compressed to a tenth, h²k(l₀/l − 1) = 9 kg against 1.
    for many in 1..4 {
        let mut scene = VecScene::<f64>::empty();
        let mut points: Vec<_> = (0..many)
            .map(|i| {
                scene.particle([i as f64, 0.0, 0.1], 1.0).unwrap();
                PointSpring::new(i, [i as f64, 0.0, 0.0], 100.0).rest_length(1.0)
            })
            .collect();
        let mut euler = LinearlyImplicitEuler::new(0.1).with(points.as_mut_slice());
        let report = scene.step(&mut euler).unwrap();
        assert_eq!((report.clamped, report.certified), (many as u32, 0));
    }
}

#[test]
fn a_pin_that_is_dragged_along_needs_a_reaction_against_its_drag() {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 2.0).unwrap();
    scene.pin(0).unwrap();
    scene.set_pin_velocity(0, [1.0, -2.0, 4.0]).unwrap();
    // −(−d m q̇), d = ¼.
    assert_eq!(scene.reaction(0, &Drag(0.25)), Some([0.5, -1.0, 2.0]));
}
