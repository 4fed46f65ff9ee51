//! The extensible discrete catenary in closed form: pick H and V₀ < 0; V_i = V₀ + iW, T_i = (H, V_i), and each spring is
//! Δ_i = (l₀ + |T_i|/k) T_i/|T_i| long. Then every particle is in equilibrium.

use hooke::{Gravity, LinearlyImplicitEuler};
use hooke_tests::allowed;
use hooke_tests::build;
use hooke_tests::data::SceneData;

const SPRINGS: usize = 24;
const STIFFNESS: f64 = 800.0;
const REST_LENGTH: f64 = 0.1;
const MASS: f64 = 0.02;
const G: f64 = 9.81;

fn catenary() -> SceneData {
    let weight = MASS * G;
    let (horizontal, first) = (1.5, -weight * SPRINGS as f64 / 2.0 + 0.3 * weight);
    let mut data = SceneData { gravity: [0.0, -G, 0.0], ..SceneData::default() };
    let mut x = [0.0, 0.0, 0.0];
    data.particle(x, MASS);
    for i in 0..SPRINGS {
        let pull = [horizontal, first + i as f64 * weight];
        let tension = pull[0].hypot(pull[1]);
        let length = REST_LENGTH + tension / STIFFNESS;
        x = [x[0] + length * pull[0] / tension, x[1] + length * pull[1] / tension, 0.0];
        data.particle(x, MASS);
        data.spring_with(i, i + 1, STIFFNESS, REST_LENGTH);
    }
    data.pinned[0] = true;
    data.pinned[SPRINGS] = true;
    data
}

/// What the tension of a spring can lose: k times the rounding of the positions and of l.
fn allowed() -> f64 {
    let reach = SPRINGS as f64 * 2.0 * REST_LENGTH;
    allowed::CATENARY * allowed::U64 * STIFFNESS * reach
}

#[test]
fn the_residual_force_of_the_extensible_discrete_catenary_is_rounding() {
    let scene = build::scene::<f64>(&catenary());
    let mut f = vec![[0.0; 3]; SPRINGS + 1];
    scene.springs().add_force(&mut f);
    for f in &f[1..SPRINGS] {
        let residual = f[0].abs() + (f[1] - MASS * G).abs() + f[2].abs();
        assert!(residual <= allowed(), "{residual:e} N of {:e}", allowed());
    }
}

#[test]
fn the_catenary_hangs_still_under_euler() {
    let data = catenary();
    let mut scene = build::scene::<f64>(&data);
    let mut euler = LinearlyImplicitEuler::new(1.0 / 60.0).gravity(data.gravity);
    scene.step(&mut euler).unwrap();
    // Δq̇ = A⁻¹ h f, A ⪰ M (every spring is in tension), summed over all particles.
    let fastest = build::farthest(&build::velocities(&scene), &data.velocity);
    assert!(fastest <= (SPRINGS as f64) * allowed() / 60.0 / MASS, "{fastest:e} m/s");
}

#[test]
fn reactions_at_the_pins_of_a_resting_scene_add_up_to_its_weight() {
    let scene = build::scene::<f64>(&catenary());
    let forces = Gravity([0.0, -G, 0.0]);
    let (a, b) = (scene.reaction(0, &forces).unwrap(), scene.reaction(SPRINGS, &forces).unwrap());
    let weight = (SPRINGS + 1) as f64 * MASS * G;
    let sum = [a[0] + b[0], a[1] + b[1] - weight, a[2] + b[2]];
    let missing = sum.iter().map(|s| s.abs()).fold(0.0, f64::max);
    assert!(missing <= (SPRINGS as f64) * allowed(), "{missing:e} N");
    assert!(a[1] > 0.0 && b[1] > 0.0, "the pins hold the catenary up");
}

#[test]
fn reaction_of_a_particle_that_does_not_exist_is_none() {
    let scene = build::scene::<f64>(&catenary());
    assert_eq!(scene.reaction(SPRINGS + 1, &()), None);
}

#[test]
fn a_reaction_is_minus_all_forces_on_the_pin_damping_and_loads_included() {
    // A damped spring along x, stretched by ½ m and growing by 2 m/s: tension k/2, damping 2c; both pull the pin to +x.
    let (k, c, load) = (8.0, 4.0, [1.0, 2.0, 3.0]);
    for swapped in [false, true] {
        let mut data = SceneData::default();
        data.particle([0.0; 3], 0.5);
        data.particle([1.5, 0.0, 0.0], 1.0);
        data.pinned[0] = true;
        data.velocity[1] = [2.0, 5.0, 0.0];
        if swapped {
            data.spring_with(1, 0, k, 1.0)
        } else {
            data.spring_with(0, 1, k, 1.0)
        }
        let scene = build::scene::<f64>(&data);
        let forces = (
            (Gravity([0.0, -10.0, 0.0]), hooke::SpringDamping(c)),
            hooke::PointForce { particle: 0, force: load },
        );
        let reaction = scene.reaction(0, &forces).unwrap();
        let expected = [-(k * 0.5 + c * 2.0) - load[0], 0.5 * 10.0 - load[1], -load[2]];
        for (r, expected) in reaction.iter().zip(expected) {
            assert!((r - expected).abs() <= 8.0 * allowed::U64 * 16.0, "{reaction:?}");
        }
    }
}
