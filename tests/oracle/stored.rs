//! What an island's system stores, exactly: the inertia, and α and w of every spring, taken apart from the blocks that the
//! kernel shows (whose entries α + w² are rounded, which at R = 1e-12 would matter).

use hooke::{Hessian, Real, Scaling, Spring, Stretched};
use hooke_tests::build::{Everything, real3};
use hooke_tests::data::SceneData;
use hooke_tests::precise::{Big, big};

/// One island's A x = b as stored, in exact arithmetic.
pub struct Stored {
    /// The particle of each row
    pub particles: Vec<usize>,
    /// A
    pub matrix: Vec<Vec<Big>>,
    /// b
    pub right: Vec<Big>,
    /// μ per row
    pub mu: Vec<f64>,
    /// Springs found clamped
    pub clamped: usize,
}

fn difference<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

impl Stored {
    /// Takes a system apart. Every block must be the true or the clamped Hessian of its spring, bit for bit.
    pub fn new<T: Real>(
        data: &SceneData,
        h: T,
        system: &hooke::System<'_, T, Everything<'_, T>>,
        b: &[[T; 3]],
        mu: &[T],
    ) -> Self {
        let particles: Vec<usize> =
            (0..system.particles()).map(|row| system.particle(row).unwrap()).collect();
        let row_of = |particle: usize| particles.iter().position(|i| *i == particle);
        let n = particles.len();
        let mut visited = Vec::new();
        system.blocks(|r, c, block| visited.push((r, c, block)));
        let mut visited = visited.into_iter();
        let mut matrix = vec![vec![big(0.0); 3 * n]; 3 * n];
        for row in 0..n {
            let (r, c, block) = visited.next().unwrap();
            assert_eq!((r, c), (row, row));
            for d in 0..3 {
                matrix[3 * row + d][3 * row + d] += big(block[d][d].to_f64());
            }
        }
        let scaling = Scaling { stiffness: h * h, damping: h };
        let mut clamped = 0;
        let mut take = |block: [[T; 3]; 3], spring: Spring<T>, stretched: Stretched<T>, c: T| {
            let hessian = Hessian::new(spring, stretched, c, scaling);
            if hessian.dense() == block {
                return hessian;
            }
            let hessian = Hessian::clamped(spring, stretched, c, scaling);
            assert_eq!(hessian.dense(), block, "neither the true nor the clamped Hessian");
            clamped += 1;
            hessian
        };
        let add = |matrix: &mut Vec<Vec<Big>>, r: usize, c: usize, h: &Hessian<T>, sign: f64| {
            for i in 0..3 {
                for j in 0..3 {
                    let outer = big(h.w[i].to_f64()) * big(h.w[j].to_f64());
                    let entry = if i == j { outer + big(h.alpha.to_f64()) } else { outer };
                    matrix[3 * r + i][3 * c + j] += big(sign) * entry;
                }
            }
        };
        let constants = |k: f64, l0: f64| Spring { stiffness: T::from_f64(k), rest_length: T::from_f64(l0) };
        let x = |i: usize| real3::<T>(data.position[i]);
        // Row after row, the springs whose lower free end it is.
        for (a, s) in (0..n).flat_map(|a| data.springs.iter().map(move |s| (a, s))) {
            let rows = [s.a, s.b].map(row_of);
            if rows.iter().flatten().min() != Some(&a) {
                continue;
            }
            let stretched = Stretched::new(difference(x(s.a), x(s.b)));
            let mut take = |block| take(block, constants(s.k, s.l0), stretched, T::from_f64(s.c));
            if let [Some(one), Some(other)] = rows {
                let b = one.max(other);
                let blocks: Vec<_> = (0..4).map(|_| visited.next().unwrap()).collect();
                let places: Vec<(usize, usize)> = blocks.iter().map(|(r, c, _)| (*r, *c)).collect();
                assert_eq!(places, [(a, a), (a, b), (b, a), (b, b)]);
                assert_eq!(blocks[0].2, blocks[3].2);
                assert_eq!(blocks[1].2, blocks[0].2.map(|row| row.map(|x| -x)));
                assert_eq!(blocks[1].2, blocks[2].2);
                let h = take(blocks[0].2);
                for (r, c, sign) in [(a, a, 1.0), (a, b, -1.0), (b, a, -1.0), (b, b, 1.0)] {
                    add(&mut matrix, r, c, &h, sign);
                }
            } else {
                let (r, c, block) = visited.next().unwrap();
                assert_eq!((r, c), (a, a));
                add(&mut matrix, a, a, &take(block), 1.0);
            }
        }
        for p in &data.points {
            if let Some(a) = row_of(p.particle) {
                let (r, c, block) = visited.next().unwrap();
                assert_eq!((r, c), (a, a));
                let stretched = Stretched::new(difference(x(p.particle), real3(p.target)));
                let h = take(block, constants(p.k, p.l0), stretched, T::ZERO);
                add(&mut matrix, a, a, &h, 1.0);
            }
        }
        assert!(visited.next().is_none(), "a block that belongs to nothing");
        let right = b.iter().flatten().map(|b| big(b.to_f64())).collect();
        Self { particles, matrix, right, mu: mu.iter().map(|mu| mu.to_f64()).collect(), clamped }
    }

    /// b − A x
    pub fn residual(&self, x: &[f64]) -> Vec<Big> {
        let row = |(row, b): (&Vec<Big>, &Big)| {
            let product = row.iter().zip(x).fold(big(0.0), |sum, (a, x)| sum + a * big(*x));
            b - product
        };
        self.matrix.iter().zip(&self.right).map(row).collect()
    }

    /// A − (1 − 2⁻⁶⁰) diag(μ): positive definite if A ⪰ diag(μ) > 0.
    pub fn beyond_mu(&self) -> Vec<Vec<Big>> {
        let less = big(1.0) - big(2f64.powi(-60));
        let mut matrix = self.matrix.clone();
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] -= &less * big(self.mu[i / 3]);
        }
        matrix
    }
}
