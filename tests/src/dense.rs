//! The whole scheme with dense matrices, each built from its definition in the lecture: S_i (3×3n) and E_j (6×3n) select,
//! B = [I −I] (3×6) subtracts, P (3f×3n) drops the fixed particles. O(n²) memory, O(n³) per step: for small scenes.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::data::{MotionData, SceneData};
use crate::textbook::{Clamping, Stretch, clamping, stretch_of, stretch_of_point};

/// A scene seen through matrices.
#[derive(Debug, Clone)]
pub struct Dense<'a> {
    data: &'a SceneData,
    n: usize,
}

/// The linear system of a step on the free particles: A v⁺ = r.
#[derive(Debug, Clone)]
pub struct DenseStep {
    /// P(M + hD − h²K̃)Pᵀ
    pub matrix: DMatrix<f64>,
    /// P(Mq̇ + hf) − A_fp p
    pub right: DVector<f64>,
    /// What was clamped
    pub clamping: Clamping,
}

fn stacked(of: &[[f64; 3]]) -> DVector<f64> {
    DVector::from_iterator(3 * of.len(), of.iter().flatten().copied())
}

fn unstacked(of: &DVector<f64>) -> Vec<[f64; 3]> {
    of.as_slice().chunks(3).map(|x| [x[0], x[1], x[2]]).collect()
}

fn dense3(m: &Matrix3<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(3, 3, |r, c| m[(r, c)])
}

impl<'a> Dense<'a> {
    /// Of a scene.
    pub fn new(data: &'a SceneData) -> Self {
        Self { data, n: data.len() }
    }

    /// S_i: x_i = S_i q.
    pub fn particle_selection(&self, i: usize) -> DMatrix<f64> {
        let mut s = DMatrix::zeros(3, 3 * self.n);
        s.view_mut((0, 3 * i), (3, 3)).fill_with_identity();
        s
    }

    /// E_j = [S_A; S_B]: q_j = E_j q.
    pub fn spring_selection(&self, a: usize, b: usize) -> DMatrix<f64> {
        let mut e = DMatrix::zeros(6, 3 * self.n);
        e.view_mut((0, 0), (3, 3 * self.n)).copy_from(&self.particle_selection(a));
        e.view_mut((3, 0), (3, 3 * self.n)).copy_from(&self.particle_selection(b));
        e
    }

    /// B = [I −I]: Δx = B q_j.
    pub fn difference(&self) -> DMatrix<f64> {
        let mut b = DMatrix::zeros(3, 6);
        b.view_mut((0, 0), (3, 3)).fill_with_identity();
        b.view_mut((0, 3), (3, 3)).copy_from(&-DMatrix::<f64>::identity(3, 3));
        b
    }

    /// P: q̂ = P q keeps the free particles' rows, in order.
    pub fn pins(&self) -> DMatrix<f64> {
        let free: Vec<usize> = (0..self.n).filter(|i| !self.data.pinned[*i]).collect();
        let mut p = DMatrix::zeros(3 * free.len(), 3 * self.n);
        for (row, i) in free.iter().enumerate() {
            p.view_mut((3 * row, 0), (3, 3 * self.n)).copy_from(&self.particle_selection(*i));
        }
        p
    }

    /// M
    pub fn mass_matrix(&self) -> DMatrix<f64> {
        let diagonal = DVector::from_fn(3 * self.n, |r, _| self.data.mass[r / 3]);
        DMatrix::from_diagonal(&diagonal)
    }

    /// q
    pub fn position(&self) -> DVector<f64> {
        stacked(&self.data.position)
    }

    /// q̇
    pub fn velocity(&self) -> DVector<f64> {
        stacked(&self.data.velocity)
    }

    /// V(q) = Σ ½ k (√(qᵀE_jᵀBᵀB E_j q) − l₀)² of the springs.
    pub fn potential_energy(&self) -> f64 {
        let (q, b) = (self.position(), self.difference());
        let one = |s: &crate::data::SpringData| {
            let e = self.spring_selection(s.a, s.b);
            let squared = (q.transpose() * e.transpose() * b.transpose() * &b * &e * &q)[(0, 0)];
            0.5 * s.k * (squared.sqrt() - s.l0).powi(2)
        };
        self.data.springs.iter().map(one).sum()
    }

    /// f = −Σ E_jᵀBᵀ ∂V/∂Δx of the springs.
    pub fn spring_force(&self) -> DVector<f64> {
        let b = self.difference();
        let mut f = DVector::zeros(3 * self.n);
        for (j, s) in self.data.springs.iter().enumerate() {
            let gradient = stretch_of(self.data, j).gradient();
            f -= self.spring_selection(s.a, s.b).transpose() * b.transpose() * gradient;
        }
        f
    }

    /// K = −Σ E_jᵀBᵀ (∂²V/∂Δx²) B E_j, nothing clamped.
    pub fn stiffness_matrix(&self) -> DMatrix<f64> {
        self.assembled(|_, stretch| stretch.hessian()) * -1.0
    }

    /// Σ E_jᵀBᵀ H_j B E_j
    fn assembled(&self, block: impl Fn(usize, &Stretch) -> Matrix3<f64>) -> DMatrix<f64> {
        let b = self.difference();
        let mut sum = DMatrix::zeros(3 * self.n, 3 * self.n);
        for (j, s) in self.data.springs.iter().enumerate() {
            let e = &b * self.spring_selection(s.a, s.b);
            sum += e.transpose() * dense3(&block(j, &stretch_of(self.data, j))) * &e;
        }
        sum
    }

    /// The linear system of one step of linearly-implicit Euler.
    pub fn system(&self, h: f64, motion: &[MotionData]) -> DenseStep {
        let data = self.data;
        let clamping = clamping(data, h);
        let mass = self.mass_matrix();
        let p = self.pins();
        // A = M + hD − h²K̃: drag on the diagonal, damping along u, clamped Hessians.
        let mut matrix = &mass * (1.0 + h * data.drag);
        matrix += self.assembled(|j, stretch| {
            let c = data.springs[j].c;
            h * h * stretch.used(clamping.springs[j]) + h * c * stretch.u * stretch.u.transpose()
        });
        let mut force = self.spring_force();
        for (i, m) in data.mass.iter().enumerate() {
            force += self.particle_selection(i).transpose() * (*m * Vector3::from(data.gravity));
        }
        for (j, point) in data.points.iter().enumerate() {
            let (s, stretch) = (self.particle_selection(point.particle), stretch_of_point(data, j));
            matrix += s.transpose() * dense3(&(h * h * stretch.used(clamping.points[j]))) * &s;
            force -= s.transpose() * stretch.gradient();
        }
        // The pins' velocity over the step is known: it goes to the right side.
        let mut pins = DVector::zeros(3 * self.n);
        for m in motion {
            let over = (Vector3::from(m.position) - Vector3::from(data.position[m.particle])) / h;
            pins.fixed_rows_mut::<3>(3 * m.particle).copy_from(&over);
        }
        let right = &p * (&mass * self.velocity() + h * force - &matrix * pins);
        DenseStep { matrix: &p * matrix * p.transpose(), right, clamping }
    }

    /// The scene after one step, and how many springs were clamped or replaced.
    pub fn step(&self, h: f64, motion: &[MotionData]) -> (SceneData, usize) {
        let DenseStep { matrix, right, clamping } = self.system(h, motion);
        let p = self.pins();
        let solved = matrix.clone().cholesky().map(|c| c.solve(&right));
        let free = solved.unwrap_or_else(|| matrix.lu().solve(&right).expect("the step's matrix is regular"));
        let velocity = p.transpose() * free;
        let mut after = self.data.clone();
        after.position = unstacked(&(self.position() + h * &velocity));
        after.velocity = unstacked(&velocity);
        for m in motion {
            after.position[m.particle] = m.position;
            after.velocity[m.particle] = m.velocity;
        }
        (after, clamping.count)
    }
}
