//! Solves of generated systems: inside their bounds, in another order, in other memory.

use hooke::{Operator, Preconditioner};
use hooke_tests::build::{self, Forces};
use hooke_tests::generate::{self, Ingredients};
use hooke_tests::random::Random;
use proptest::prelude::*;

use crate::config;

fn everything() -> impl Strategy<Value = Ingredients> {
    prop::array::uniform5(any::<bool>()).prop_map(|[pins, compressed, damped, points, gravity]| Ingredients {
        pins,
        compressed,
        damped,
        points,
        gravity,
        moving: false,
    })
}

proptest! {
    #![proptest_config(config(3, 96))]

    #[test]
    fn the_solution_lies_inside_its_bounds(seed: u64, with in everything(), p in 1..7i32, h in 1e-3..0.05f64) {
        // In f64 with R ≥ 1e-6: the dense solve's own error, some u·κ, is far below the certified one.
        let mut data = generate::network(&mut Random::new(seed), 12, with);
        data.mass.iter_mut().for_each(|m| *m = m.clamp(0.05, 5.0));
        let mut scene = build::scene::<f64>(&data);
        let mut forces = Forces::<f64>::new(&data);
        let mut euler = forces.euler(h).tolerance(10f64.powi(-p));
        let mut systems = Vec::new();
        euler.inspect(scene.parts(), &[], |system, b, _| {
            let n = system.particles();
            let mut a = nalgebra::DMatrix::<f64>::zeros(3 * n, 3 * n);
            system.blocks(|r, c, block| {
                for i in 0..3 {
                    for j in 0..3 {
                        a[(3 * r + i, 3 * c + j)] += block[i][j];
                    }
                }
            });
            let particles: Vec<usize> = (0..n).map(|row| system.particle(row).unwrap()).collect();
            systems.push((particles, a, b.concat()));
        }).unwrap();
        let mut reports = Vec::new();
        scene.step_watched(&mut euler, &[], |island| reports.push(island.solve)).unwrap();
        for ((particles, a, b), solve) in systems.into_iter().zip(reports) {
            let x: Vec<f64> = particles.iter().flat_map(|i| scene.velocities()[*i]).collect();
            let (b, x) = (nalgebra::DVector::from_vec(b), nalgebra::DVector::from_vec(x));
            prop_assert!(a.clone().cholesky().is_some(), "positive definite after clamping");
            let exact = a.clone().cholesky().unwrap().solve(&b);
            let e = &x - &exact;
            let energy = 0.5 * (e.transpose() * &a * &e)[(0, 0)];
            // What the dense solve and the rounding of blocks may add: u·κ of the solution's energy, quadratic in it.
            let own = 0.5 * (exact.transpose() * &a * &exact)[(0, 0)];
            let slack = hooke_tests::allowed::DENSE_ENERGY * own;
            prop_assert!(solve.lower <= energy + slack + 2.0 * (slack * energy).sqrt(), "{energy:e} {solve:?}");
            prop_assert!(energy <= solve.upper + slack + 2.0 * (slack * solve.upper).sqrt(), "{energy:e} {solve:?}");
        }
    }

    #[test]
    fn the_operator_is_its_blocks_and_its_form_is_positive(seed: u64, with in everything(), h in 1e-3..0.05f64) {
        let data = generate::network(&mut Random::new(seed), 9, with);
        let mut scene = build::scene::<f64>(&data);
        let mut forces = Forces::<f64>::new(&data);
        let mut euler = forces.euler(h);
        let mut random = Random::new(seed ^ 2);
        euler.inspect(scene.parts(), &[], |system, _, mu| {
            let n = system.particles();
            let x: Vec<[f64; 3]> = (0..n).map(|_| random.vector(1.0)).collect();
            let (mut y, mut dense, mut size) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n], vec![0.0; n]);
            let form = system.apply(&x, &mut y);
            system.blocks(|r, c, block| for i in 0..3 {
                for j in 0..3 {
                    dense[r][i] += block[i][j] * x[c][j];
                    size[r] += (block[i][j] * x[c][j]).abs();
                }
            });
            let mut inside = 0.0;
            for r in 0..n {
                for i in 0..3 {
                    // α − w² may cancel in a block that does not in the product: size bounds both but for 3 |w|² of blocks.
                    let allowed = hooke_tests::allowed::OPERATOR_ROW * hooke_tests::allowed::U64 * 3.0 * size.iter().sum::<f64>();
                    assert!((y[r][i] - dense[r][i]).abs() <= allowed);
                }
                inside += mu[r] * x[r].iter().map(|x| x * x).sum::<f64>();
            }
            assert!(form >= inside * (1.0 - 1e-9), "xᵀAx ≥ xᵀdiag(μ)x: {form} {inside}");
            // Block Jacobi is symmetric and positive: rᵀz > 0, and exact where one block is all there is.
            let mut blocks = vec![[0.0; 6]; n];
            let jacobi = hooke::Jacobi::new(system, &mut blocks);
            let mut z = vec![[0.0; 3]; n];
            assert!(jacobi.apply(&x, &mut z) > 0.0);
        }).unwrap();
    }
}
