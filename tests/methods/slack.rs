//! Cables under every method: slack they are not there, taut they are springs, and between the two energy is kept where a method
//! keeps it.

use hooke::{Cables, Hookean, Law, Spring, SpringDamping};
use hooke_tests::methods::{self, Method, options};
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{allowed, build};

const H: f64 = 1.0 / 64.0;
const K: f64 = 64.0;

/// A particle of 1 kg at x, and one at a pin, with a cable or spring of a metre between them and further ones hanging on it.
fn tied<L: Law>(x: f64, velocity: [f64; 3]) -> VecScene<f64, L> {
    let mut scene = VecScene::<f64, L>::empty();
    for place in [[0.0; 3], [x, 0.0, 0.0], [x, x, 0.0]] {
        scene.particle(place, 1.0).unwrap();
    }
    for ends in [(0, 1), (1, 2)] {
        scene.spring_with(ends.0, ends.1, Spring { stiffness: K, rest_length: 1.0 }).unwrap();
    }
    scene.pin(0).unwrap();
    for i in [1, 2] {
        scene.set_velocity(i, velocity).unwrap();
    }
    scene
}

/// So many damped steps.
fn walk<L: Law>(method: Method, mut scene: VecScene<f64, L>, damping: f64, steps: usize) -> Vec<[u64; 6]> {
    for _ in 0..steps {
        method.step(&mut scene, options(H, 1e-12), SpringDamping(damping), &[]).unwrap();
    }
    build::bits(&scene)
}

#[test]
fn as_long_as_they_are_slack_cables_do_nothing_whatever_their_stiffness_and_damping() {
    for method in methods::ALL {
        // Half a metre, and by its end three quarters.
        let velocity = [0.25, 0.125, -0.25];
        let found = walk(method, tied::<Cables>(0.5, velocity), 2.0, 32);
        for (i, x) in [(1, [0.5, 0.0, 0.0]), (2, [0.5, 0.5, 0.0])] {
            let now = found[i].map(f64::from_bits);
            for d in 0..3 {
                let there = x[d] + velocity[d] * 32.0 * H;
                let off = (now[d] - there).abs().max((now[d + 3] - velocity[d]).abs());
                assert!(off <= 32.0 * allowed::FREE_FALL * allowed::U64, "{method:?}, {i}: {now:?}");
            }
        }
    }
}

#[test]
fn as_long_as_they_are_taut_cables_are_springs_bit_for_bit() {
    for method in methods::ALL {
        let velocity = [2.0, 2.5, 0.5];
        let mut both = (tied::<Cables>(1.5, velocity), tied::<Hookean>(1.5, velocity));
        for _ in 0..8 {
            method.step(&mut both.0, options(H, 1e-12), SpringDamping(0.25), &[]).unwrap();
            method.step(&mut both.1, options(H, 1e-12), SpringDamping(0.25), &[]).unwrap();
            assert!((0..2).all(|j| both.1.springs().length_of(j).unwrap() > 1.0));
            assert_eq!(build::bits(&both.0), build::bits(&both.1), "{method:?}");
        }
        // Later one of them is slack, and it shows.
        let later = (walk(method, both.0, 0.25, 128), walk(method, both.1, 0.25, 128));
        assert_ne!(later.0, later.1, "{method:?}");
    }
}

#[test]
fn energy_momentum_keeps_the_energy_of_cables_that_go_slack_and_taut_again() {
    let mut scene = tied::<Cables>(1.25, [1.0, -0.5, 0.25]);
    let energy =
        |scene: &VecScene<f64, Cables>| scene.springs().kinetic_energy() + scene.springs().potential_energy();
    let taut = |scene: &VecScene<f64, Cables>| [0, 1].map(|j| scene.springs().length_of(j).unwrap() > 1.0);
    let (first, mut before, mut turns) = (energy(&scene), taut(&scene), [0, 0]);
    for step in 0..2000 {
        Method::EnergyMomentum.step(&mut scene, options(H, 1e-14), (), &[]).unwrap();
        let off = (energy(&scene) / first - 1.0).abs();
        assert!(off <= 1e-11, "step {step}: {off:e}");
        let now = taut(&scene);
        (0..2).for_each(|j| turns[usize::from(now[j])] += i32::from(now[j] != before[j]));
        before = now;
    }
    println!("{turns:?} times slack and taut, {:e} of the energy", energy(&scene) / first - 1.0);
    assert!(turns[0] >= 20 && turns[1] >= 20, "{turns:?}");
}

#[test]
fn a_cable_that_is_exactly_a_metre_long_pulls_nothing_under_any_method() {
    for method in methods::ALL {
        let mut scene = tied::<Cables>(1.0, [0.0; 3]);
        let before = build::bits(&scene);
        method.step(&mut scene, options(H, 1e-12), SpringDamping(0.5), &[]).unwrap();
        assert_eq!(build::bits(&scene), before, "{method:?}");
    }
}
