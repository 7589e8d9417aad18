//! Band matrix without symmetry, and its LU factorisation with partial pivoting.
//!
//! Rows are contiguous, so that an elimination step is a handful of row updates of fixed length. Pivoting widens the
//! upper band by the lower bandwidth, as in LAPACK's `gbtrf`.

use super::Singular;
use super::fma::fma;

/// A square band matrix with equal lower and upper bandwidth.
#[derive(Clone, Debug)]
pub struct Band {
    n: usize,
    half: usize,
    data: Vec<f64>,
}

impl Band {
    /// A zero matrix of `n` rows with `half` diagonals on either side of the main one.
    pub fn zeros(n: usize, half: usize) -> Self {
        Self { n, half, data: vec![0.0; n * (2 * half + 1)] }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.n
    }

    /// Diagonals on either side of the main one.
    pub fn half_bandwidth(&self) -> usize {
        self.half
    }

    /// Bytes of the entries.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.data[..])
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.data.fill(0.0);
    }

    fn index(&self, i: usize, j: usize) -> Option<usize> {
        (i.abs_diff(j) <= self.half && j < self.n).then(|| i * (2 * self.half + 1) + j + self.half - i)
    }

    /// The entry in row `i`, column `j`; zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.index(i, j).map_or(0.0, |k| self.data[k])
    }

    /// Sets an entry within the band; entries outside stay zero.
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        if let Some(k) = self.index(i, j) {
            self.data[k] = value;
        }
    }

    /// Entries `from .. from + length` of row `i`, which must lie in the band.
    #[inline]
    pub fn row_mut(&mut self, i: usize, from: usize, length: usize) -> &mut [f64] {
        let start = i * (2 * self.half + 1) + from + self.half - i;
        &mut self.data[start..start + length]
    }

    /// Columns that can be different from zero in row `i`.
    pub fn columns(&self, i: usize) -> std::ops::Range<usize> {
        i.saturating_sub(self.half)..(i + self.half + 1).min(self.n)
    }

    /// `y += factor · A x`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        for (i, yi) in y.iter_mut().enumerate() {
            let sum: f64 = self.columns(i).map(|j| self.get(i, j) * x[j]).sum();
            *yi = fma(factor, sum, *yi);
        }
    }
}

/// P A = L U with row interchanges.
#[derive(Clone, Debug)]
pub struct BandLu {
    n: usize,
    half: usize,
    /// Row i holds U from its diagonal on: 2·half + 1 numbers.
    upper: Vec<f64>,
    /// Multipliers of column k: `half` numbers.
    lower: Vec<f64>,
    pivots: Vec<usize>,
}

impl BandLu {
    /// Factorises.
    ///
    /// # Errors
    /// [`Singular`] where a column has no pivot that is finite and different from zero.
    pub fn new(matrix: &Band) -> Result<Self, Singular> {
        let (n, half) = (matrix.n, matrix.half);
        let width = 2 * half + 1;
        // Row i starts at column `max(0, i − half)` while it waits, at column k while column k is eliminated.
        let mut rows = vec![0.0; n * width];
        for i in 0..n {
            let columns = matrix.columns(i);
            let source = i * width + columns.start + half - i;
            rows[i * width..i * width + columns.len()]
                .copy_from_slice(&matrix.data[source..source + columns.len()]);
        }
        let mut lower = vec![0.0; n * half];
        let mut pivots = vec![0; n];
        for k in 0..n {
            let last = (k + half).min(n - 1);
            let mut pivot_row = k;
            for i in k + 1..=last {
                if rows[i * width].abs() > rows[pivot_row * width].abs() {
                    pivot_row = i;
                }
            }
            pivots[k] = pivot_row;
            let pivot = rows[pivot_row * width];
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return Err(Singular { row: k });
            }
            let (head, tail) = rows.split_at_mut((k + 1) * width);
            let current = &mut head[k * width..];
            if pivot_row != k {
                current.swap_with_slice(&mut tail[(pivot_row - k - 1) * width..(pivot_row - k) * width]);
            }
            for (row, l) in tail.chunks_exact_mut(width).zip(&mut lower[k * half..]).take(last - k) {
                *l = row[0] / pivot;
                // The row moves one column to the left: its first entry has just been eliminated.
                for c in 1..width {
                    row[c - 1] = fma(-*l, current[c], row[c]);
                }
                row[width - 1] = 0.0;
            }
        }
        Ok(Self { n, half, upper: rows, lower, pivots })
    }

    /// Whether det A < 0.
    pub fn determinant_is_negative(&self) -> bool {
        let swaps = self.pivots.iter().enumerate().filter(|(k, pivot)| k != *pivot).count();
        let negative = self.upper.chunks_exact(2 * self.half + 1).filter(|row| row[0] < 0.0).count();
        (swaps + negative) % 2 == 1
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        let width = 2 * self.half + 1;
        for k in 0..self.n {
            b.swap(k, self.pivots[k]);
            let bk = b[k];
            let last = (k + self.half).min(self.n - 1);
            for (t, l) in b[k + 1..=last].iter_mut().zip(&self.lower[k * self.half..]) {
                *t = fma(-*l, bk, *t);
            }
        }
        for k in (0..self.n).rev() {
            let end = (k + width).min(self.n);
            let row = &self.upper[k * width..(k + 1) * width];
            let sum: f64 = b[k + 1..end].iter().zip(&row[1..]).map(|(x, u)| x * u).sum();
            b[k] = (b[k] - sum) / row[0];
        }
    }
}
