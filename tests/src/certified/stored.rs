//! What an island's system stores, exactly: the inertia, and α and w of every spring, taken apart from the blocks that the
//! kernel shows (whose entries α + w² are rounded, which at R = 1e-12 would matter).

use hooke::{Hessian, Real, Scaling, Spring, Stretched};

use super::case::Case;
use crate::build::{self, Everything, Forces, real3};
use crate::precise::{Big, with_bits};

/// One spring or point spring of an island.
#[derive(Debug, Clone, Copy)]
pub struct Tie<T> {
    /// A free end's row
    pub row: usize,
    /// The other end's, if that is free too
    pub other: Option<usize>,
    /// H as stored
    pub used: Hessian<T>,
    /// H before any clamping
    pub raw: Hessian<T>,
}

/// One island's A x = b as stored.
#[derive(Debug, Clone)]
pub struct Stored<T> {
    /// The particle of each row
    pub particles: Vec<usize>,
    /// m̃ per row
    pub inertia: Vec<T>,
    /// The springs
    pub ties: Vec<Tie<T>>,
    /// b
    pub right: Vec<[T; 3]>,
    /// μ per row
    pub mu: Vec<T>,
    /// Springs found clamped
    pub clamped: usize,
}

/// A spring as it is met: row, other row, its Hessian and the clamped one, and the block that the kernel shows.
type Met<T> = (usize, Option<usize>, [Hessian<T>; 2], [[T; 3]; 3]);

/// Which nodes have no certificate before any clamping, by the kernel's own sums: a block alone does not tell, since α can
/// be lost in αI + wwᵀ.
fn failing<T: Real>(inertia: &[T], met: &[Met<T>]) -> Vec<bool> {
    let four = T::from_f64(4.0) * T::UNIT_ROUNDOFF;
    let mut charges = vec![T::ZERO; inertia.len()];
    for (row, other, [raw, _], _) in met {
        if !(raw.alpha >= T::ZERO) {
            let c = if other.is_some() { T::TWO } else { T::ONE };
            for end in [Some(*row), *other].into_iter().flatten() {
                charges[end] = (charges[end] - c * raw.alpha) * (T::ONE + four);
            }
        }
    }
    inertia.iter().zip(charges).map(|(m, charge)| !((*m - charge) * (T::ONE - four) > T::ZERO)).collect()
}

fn difference<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// All islands of a case; or the kernel's error, or `Overflow` where an entry is no finite number, by name.
pub fn islands<T: Real>(case: &Case) -> Result<Vec<Stored<T>>, String> {
    let mut scene = build::scene::<T>(&case.data);
    let mut forces = Forces::<T>::new(&case.data);
    let motion = build::motions::<T>(&case.motion);
    let (mut islands, mut overflow) = (Vec::new(), false);
    let mut euler = forces.euler(T::from_f64(case.h));
    let assembled = euler.inspect(scene.parts(), &motion, |system, b, mu| {
        let mut finite = b.iter().flatten().all(|b| b.is_finite());
        system.blocks(|_, _, block| finite &= block.iter().flatten().all(|x| x.is_finite()));
        overflow |= !finite;
        if finite {
            islands.push(Stored::new(case, system, b, mu));
        }
    });
    assembled.map_err(|error| {
        let name = format!("{error:?}");
        name.split('(').next().unwrap_or_default().to_owned()
    })?;
    if overflow { Err("Overflow".into()) } else { Ok(islands) }
}

impl<T: Real> Stored<T> {
    /// Takes a system apart. Every block must be the true Hessian of its spring or, where the rule asks for it,
    /// the clamped one, bit for bit.
    ///
    /// # Panics
    /// If one is not.
    pub fn new(
        case: &Case,
        system: &hooke::System<'_, T, Everything<'_, T>>,
        b: &[[T; 3]],
        mu: &[T],
    ) -> Self {
        let data = &case.data;
        let h = T::from_f64(case.h);
        let particles: Vec<usize> =
            (0..system.particles()).map(|row| system.particle(row).unwrap()).collect();
        let row_of = |particle: usize| particles.iter().position(|i| *i == particle);
        let n = particles.len();
        let mut visited = Vec::new();
        system.blocks(|r, c, block| visited.push((r, c, block)));
        let mut visited = visited.into_iter();
        let mut inertia = Vec::new();
        for row in 0..n {
            let (r, c, block) = visited.next().unwrap();
            assert_eq!((r, c), (row, row));
            inertia.push(block[0][0]);
        }
        let scaling = Scaling { stiffness: h * h, damping: h };
        let both = |spring: Spring<T>, stretched: Stretched<T>, c: T| {
            let raw = Hessian::new(spring, stretched, c, scaling);
            [raw, Hessian::clamped(spring, stretched, c, scaling)]
        };
        let mut met: Vec<Met<T>> = Vec::new();
        let constants = |k: f64, l0: f64| Spring { stiffness: T::from_f64(k), rest_length: T::from_f64(l0) };
        let x = |i: usize| real3::<T>(data.position[i]);
        // Row after row, the springs whose lower free end it is.
        for (a, s) in (0..n).flat_map(|a| data.springs.iter().map(move |s| (a, s))) {
            let rows = [s.a, s.b].map(row_of);
            if rows.iter().flatten().min() != Some(&a) {
                continue;
            }
            let stretched = Stretched::new(difference(x(s.a), x(s.b)));
            let hessians = both(constants(s.k, s.l0), stretched, T::from_f64(s.c));
            if let [Some(one), Some(other)] = rows {
                let b = one.max(other);
                let blocks: Vec<_> = (0..4).map(|_| visited.next().unwrap()).collect();
                let places: Vec<(usize, usize)> = blocks.iter().map(|(r, c, _)| (*r, *c)).collect();
                assert_eq!(places, [(a, a), (a, b), (b, a), (b, b)]);
                assert_eq!(blocks[0].2, blocks[3].2);
                assert_eq!(blocks[1].2, blocks[0].2.map(|row| row.map(|x| -x)));
                assert_eq!(blocks[1].2, blocks[2].2);
                met.push((a, Some(b), hessians, blocks[0].2));
            } else {
                let (r, c, block) = visited.next().unwrap();
                assert_eq!((r, c), (a, a));
                met.push((a, None, hessians, block));
            }
        }
        for p in &data.points {
            if let Some(a) = row_of(p.particle) {
                let (r, c, block) = visited.next().unwrap();
                assert_eq!((r, c), (a, a));
                let stretched = Stretched::new(difference(x(p.particle), real3(p.target)));
                met.push((a, None, both(constants(p.k, p.l0), stretched, T::ZERO), block));
            }
        }
        assert!(visited.next().is_none(), "a block that belongs to nothing");
        let fails = failing(&inertia, &met);
        let mut clamped = 0;
        let ties = met.into_iter().map(|(row, other, [raw, instead], block)| {
            let clamp = raw.alpha < T::ZERO && (fails[row] || other.is_some_and(|other| fails[other]));
            let used = if clamp { instead } else { raw };
            clamped += usize::from(clamp);
            assert_eq!(used.dense(), block, "not the Hessian that the rule asks for");
            Tie { row, other, used, raw }
        });
        let ties = ties.collect();
        Self { particles, inertia, ties, right: b.to_vec(), mu: mu.to_vec(), clamped }
    }

    /// A, each sum rounded to so many bits.
    pub fn matrix(&self, bits: usize) -> Vec<Vec<Big>> {
        self.matrix_of(bits, |tie| tie.used)
    }

    /// M + hD − h²K before any clamping.
    pub fn raw_matrix(&self, bits: usize) -> Vec<Vec<Big>> {
        self.matrix_of(bits, |tie| tie.raw)
    }

    fn matrix_of(&self, bits: usize, of: impl Fn(&Tie<T>) -> Hessian<T>) -> Vec<Vec<Big>> {
        let n = 3 * self.inertia.len();
        let exact = |x: T| with_bits(x.to_f64(), bits);
        let mut matrix = vec![vec![exact(T::ZERO); n]; n];
        for i in 0..n {
            matrix[i][i] = exact(self.inertia[i / 3]);
        }
        for tie in &self.ties {
            let h = of(tie);
            let (alpha, w) = (exact(h.alpha), h.w.map(exact));
            for i in 0..3 {
                for j in 0..3 {
                    let outer = &w[i] * &w[j];
                    let entry = if i == j { outer + &alpha } else { outer };
                    let a = 3 * tie.row;
                    matrix[a + i][a + j] += &entry;
                    if let Some(other) = tie.other {
                        let b = 3 * other;
                        matrix[b + i][b + j] += &entry;
                        matrix[a + i][b + j] -= &entry;
                        matrix[b + i][a + j] -= &entry;
                    }
                }
            }
        }
        matrix
    }

    /// b − A x
    pub fn residual(&self, matrix: &[Vec<Big>], x: &[f64], bits: usize) -> Vec<Big> {
        let x: Vec<Big> = x.iter().map(|x| with_bits(*x, bits)).collect();
        let row = |(row, b): (&Vec<Big>, &T)| {
            row.iter().zip(&x).fold(with_bits(b.to_f64(), bits), |sum, (a, x)| sum - a * x)
        };
        matrix.iter().zip(self.right.iter().flatten()).map(row).collect()
    }

    /// A − (1 − 2⁻⁶⁰) diag(μ): positive definite if A ⪰ diag(μ) > 0.
    pub fn beyond_mu(&self, matrix: &[Vec<Big>], bits: usize) -> Vec<Vec<Big>> {
        let less = with_bits(1.0, bits) - with_bits(2f64.powi(-60), bits);
        let mut matrix = matrix.to_vec();
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] -= &less * with_bits(self.mu[i / 3].to_f64(), bits);
        }
        matrix
    }
}
