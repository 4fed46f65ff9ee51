//! Bits are a function of (ordered scene, options, precision): the digests below are those of every target and profile. The
//! scenes are made with + − × ÷ √ only, so that they are the same everywhere too.
//!
//! If this fails after a change of the kernel that was *meant* to change the arithmetic, replace the digests and say so in the
//! commit; if it fails on one target or profile only, the kernel has broken its promise.

use hooke::Real;
use hooke_tests::build::{self, Forces};
use hooke_tests::data::SceneData;
use hooke_tests::generate;

/// FNV-1a over the bits of positions and velocities.
fn digest<T: Real>(data: &SceneData, h: f64, steps: usize) -> u64 {
    let mut scene = build::scene::<T>(data);
    let mut forces = Forces::<T>::new(data);
    let mut euler = forces.euler(T::from_f64(h));
    for _ in 0..steps {
        scene.step(&mut euler).unwrap();
    }
    let bytes = build::bits(&scene).concat().into_iter().flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn a_cloth_that_must_be_clamped_has_the_same_bits_on_every_target() {
    let cloth = generate::cloth(16);
    let found = (digest::<f64>(&cloth, 1.0 / 60.0, 15), digest::<f32>(&cloth, 1.0 / 60.0, 15));
    assert_eq!(found, CLOTH, "{found:#x?}");
}

#[test]
fn a_network_with_everything_in_it_has_the_same_bits_on_every_target() {
    let network = generate::gentle_network(7, 12);
    let found = (digest::<f64>(&network, 1.0 / 60.0, 40), digest::<f32>(&network, 1.0 / 60.0, 40));
    assert_eq!(found, NETWORK, "{found:#x?}");
}

/// (f64, f32)
const CLOTH: (u64, u64) = (0xbe5d_1aad_177b_bd76, 0xdcc8_b53b_b4a8_d655);
/// (f64, f32)
const NETWORK: (u64, u64) = (0xd6ee_21c4_cca2_7d66, 0x180c_0a08_2ff8_f4bd);
