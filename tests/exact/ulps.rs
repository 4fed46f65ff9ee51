//! The kernel's scalar quantities are as exact as `src/ulps` says: length, energy, tension, gradient, Hessian, blocks and their
//! inverses, products and residuals, in `f32` and `f64`, against 62 digits.

use hooke::Real;
use hooke_tests::random::Random;
use hooke_tests::ulps::inputs::{KINDS, inputs};
use hooke_tests::ulps::{COUNT, QUANTITIES, quantities, rows};

/// Springs of each kind, and networks.
const SPRINGS: usize = 3_000;
const NETWORKS: usize = 200;

fn within<T: Real>(seed: u64) {
    let mut most = rows::errors::<T>(NETWORKS, Random::seed(seed));
    for (k, kind) in KINDS.into_iter().enumerate() {
        let found = quantities::errors(kind, &inputs::<T>(kind, SPRINGS, Random::seed(seed + k as u64)));
        for place in 0..COUNT {
            let allowed = QUANTITIES[place].allowed;
            let (name, error) = (QUANTITIES[place].name, found[place]);
            assert!(error <= allowed, "{name}, {kind:?}: {error} of {allowed} allowed");
            most[place] = most[place].max(error);
        }
    }
    for (quantity, most) in QUANTITIES.iter().zip(most) {
        assert!(most <= quantity.allowed, "{}: {most} of {} allowed", quantity.name, quantity.allowed);
        // Each is measured, and none is allowed so much that nothing could break it.
        assert!(most >= quantity.allowed / 40.0, "{}: {most} of {} allowed", quantity.name, quantity.allowed);
    }
}

#[test]
fn every_scalar_quantity_is_within_its_allowed_error_in_f64() {
    within::<f64>(640);
}

#[test]
fn every_scalar_quantity_is_within_its_allowed_error_in_f32() {
    within::<f32>(320);
}
