//! A symmetric positive definite matrix in envelope (skyline) storage, ordered by reverse Cuthill–McKee, and its Cholesky
//! factor. Sources: George & Liu, *Computer Solution of Large Sparse Positive Definite Systems*, ch. 4.

/// The order of reverse Cuthill–McKee: by breadth first from a node of least degree, neighbours by degree, reversed.
pub fn reverse_cuthill_mckee(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let n = neighbours.len();
    let mut order: Vec<usize> = Vec::with_capacity(n);
    let mut met = vec![false; n];
    let mut starts: Vec<usize> = (0..n).collect();
    starts.sort_by_key(|i| neighbours[*i].len());
    for start in starts {
        if met[start] {
            continue;
        }
        met[start] = true;
        let mut next = order.len();
        order.push(start);
        while next < order.len() {
            let mut fresh: Vec<usize> =
                neighbours[order[next]].iter().copied().filter(|i| !met[*i]).collect();
            fresh.sort_by_key(|i| neighbours[*i].len());
            for i in fresh {
                if !met[i] {
                    met[i] = true;
                    order.push(i);
                }
            }
            next += 1;
        }
    }
    order.reverse();
    order
}

/// The lower triangle by rows: row i holds columns first(i)..=i.
#[derive(Debug, Clone)]
pub struct Envelope {
    first: Vec<usize>,
    start: Vec<usize>,
    value: Vec<f64>,
}

impl Envelope {
    /// Zeros, with row i reaching left to `first[i]`.
    pub fn new(first: Vec<usize>) -> Self {
        let mut start = vec![0];
        for (i, f) in first.iter().enumerate() {
            start.push(start[i] + i + 1 - f);
        }
        let value = vec![0.0; start[first.len()]];
        Self { first, start, value }
    }

    /// Adds to entry (i, j), i ≥ j; the upper triangle is left out.
    pub fn add(&mut self, i: usize, j: usize, x: f64) {
        if j <= i {
            self.value[self.start[i] + j - self.first[i]] += x;
        }
    }

    /// A = L Lᵀ in place.
    ///
    /// # Panics
    /// If a pivot is not positive.
    pub fn factor(&mut self) {
        for i in 0..self.first.len() {
            let (before, rest) = self.value.split_at_mut(self.start[i]);
            let row = &mut rest[..i + 1 - self.first[i]];
            for j in self.first[i]..i {
                let other = &before[self.start[j]..self.start[j + 1]];
                let from = self.first[i].max(self.first[j]);
                let sum = dot(
                    &row[from - self.first[i]..j - self.first[i]],
                    &other[from - self.first[j]..j - self.first[j]],
                );
                row[j - self.first[i]] = (row[j - self.first[i]] - sum) / other[j - self.first[j]];
            }
            let last = i - self.first[i];
            let pivot = row[last] - dot(&row[..last], &row[..last]);
            assert!(pivot > 0.0, "pivot {i} is {pivot}");
            row[last] = pivot.sqrt();
        }
    }

    /// Solves A x = b in place, after `factor`.
    pub fn solve(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let row = &self.value[self.start[i]..self.start[i + 1]];
            let last = row.len() - 1;
            x[i] = (x[i] - dot(&row[..last], &x[self.first[i]..i])) / row[last];
        }
        for i in (0..x.len()).rev() {
            let row = &self.value[self.start[i]..self.start[i + 1]];
            let last = row.len() - 1;
            x[i] /= row[last];
            let known = x[i];
            for (x, l) in x[self.first[i]..i].iter_mut().zip(row) {
                *x -= l * known;
            }
        }
    }
}

/// Σ aᵢbᵢ in eight partial sums, for speed.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: f64 = a8.remainder().iter().zip(b8.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a8.zip(b8) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + tail
}
