//! Band matrix without symmetry, real or complex, and its LU factorisation with partial pivoting.
//!
//! Rows are contiguous, so that an elimination step consists of a few row updates of fixed length.
//! Pivoting widens the upper band by the lower bandwidth, as in LAPACK's `gbtrf`.

use super::Singular;
use crate::lanes::fma;
use faer::c64;
use std::fmt;
use std::ops::{Div, Mul, Sub};

/// The numbers of a matrix, real or complex.
pub trait Number:
    Copy + fmt::Debug + Default + Mul<Output = Self> + Sub<Output = Self> + Div<Output = Self> + std::iter::Sum
{
    /// The real number `value`.
    fn from_real(value: f64) -> Self;

    /// a b + c.
    fn fma(a: Self, b: Self, c: Self) -> Self;

    /// The size by which pivots are compared: |a|, or |Re a| + |Im a| for a complex number.
    fn size(self) -> f64;
}

impl Number for f64 {
    #[inline(always)]
    fn from_real(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn fma(a: Self, b: Self, c: Self) -> Self {
        fma(a, b, c)
    }

    #[inline(always)]
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Number for c64 {
    fn from_real(value: f64) -> Self {
        Self::new(value, 0.0)
    }

    fn fma(a: Self, b: Self, c: Self) -> Self {
        a * b + c
    }

    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}

/// A square band matrix with equal lower and upper bandwidth.
#[derive(Clone, Debug)]
pub struct Band<T = f64> {
    n: usize,
    half: usize,
    data: Vec<T>,
}

impl<T: Number> Band<T> {
    /// A zero matrix of `n` rows with `half` diagonals on either side of the main one.
    pub fn zeros(n: usize, half: usize) -> Self {
        Self { n, half, data: vec![T::default(); n * (2 * half + 1)] }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.n
    }

    /// Number of diagonals on either side of the main one.
    pub fn half_bandwidth(&self) -> usize {
        self.half
    }

    /// Bytes of the entries.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.data[..])
    }

    /// Multiplies all entries by `factor`.
    pub fn scale(&mut self, factor: T) {
        self.data.iter_mut().for_each(|entry| *entry = *entry * factor);
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.data.fill(T::default());
    }

    fn index(&self, i: usize, j: usize) -> Option<usize> {
        (i.abs_diff(j) <= self.half && j < self.n).then(|| i * (2 * self.half + 1) + j + self.half - i)
    }

    /// The entry in row `i`, column `j`; zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> T {
        self.index(i, j).map_or_else(T::default, |k| self.data[k])
    }

    /// Sets an entry, which must lie in the band.
    ///
    /// # Panics
    /// If it does not.
    pub fn set(&mut self, i: usize, j: usize, value: T) {
        match self.index(i, j) {
            Some(k) => self.data[k] = value,
            None => panic!("({i}, {j}) is outside the band"),
        }
    }

    /// Entries `from .. from + length` of row `i`, which must lie in the band.
    #[inline]
    pub fn row_mut(&mut self, i: usize, from: usize, length: usize) -> &mut [T] {
        let start = i * (2 * self.half + 1) + from + self.half - i;
        &mut self.data[start..start + length]
    }

    /// Four entries of row `i` from column `from` on, which must lie in the band.
    #[inline]
    pub(super) fn block_row(&self, i: usize, from: usize) -> &[T; 4] {
        let start = i * (2 * self.half + 1) + from + self.half - i;
        &self.data[start..].as_chunks().0[0]
    }

    /// Columns that can be different from zero in row `i`.
    pub fn columns(&self, i: usize) -> std::ops::Range<usize> {
        i.saturating_sub(self.half)..(i + self.half + 1).min(self.n)
    }

    /// `y += factor · A x`.
    pub fn multiply_add(&self, factor: T, x: &[T], y: &mut [T]) {
        for (i, yi) in y.iter_mut().enumerate() {
            let sum: T = self.columns(i).map(|j| self.get(i, j) * x[j]).sum();
            *yi = T::fma(factor, sum, *yi);
        }
    }
}

/// P A = L U with row interchanges.
#[derive(Clone, Debug)]
pub struct BandLu<T = f64> {
    n: usize,
    half: usize,
    /// Row i holds U from its diagonal on: 2·half + 1 numbers.
    upper: Vec<T>,
    /// Multipliers of column k: `half` numbers.
    lower: Vec<T>,
    pivots: Vec<usize>,
}

impl<T: Number> BandLu<T> {
    /// Factorises `matrix`.
    ///
    /// # Errors
    /// [`Singular`] if a column has no pivot that is finite and different from zero.
    pub fn new(matrix: &Band<T>) -> Result<Self, Singular> {
        let (n, half) = (matrix.n, matrix.half);
        let width = 2 * half + 1;
        // The stored row i starts at column `max(0, i − half)` until its elimination begins, and at
        // column k while column k is eliminated.
        let mut rows = vec![T::default(); n * width];
        for i in 0..n {
            let columns = matrix.columns(i);
            let source = i * width + columns.start + half - i;
            rows[i * width..i * width + columns.len()]
                .copy_from_slice(&matrix.data[source..source + columns.len()]);
        }
        let mut lower = vec![T::default(); n * half];
        let mut pivots = vec![0; n];
        for k in 0..n {
            let last = (k + half).min(n - 1);
            let mut pivot_row = k;
            for i in k + 1..=last {
                if rows[i * width].size() > rows[pivot_row * width].size() {
                    pivot_row = i;
                }
            }
            pivots[k] = pivot_row;
            let pivot = rows[pivot_row * width];
            if !(pivot.size() > 0.0 && pivot.size().is_finite()) {
                return Err(Singular { row: k });
            }
            let (head, tail) = rows.split_at_mut((k + 1) * width);
            let current = &mut head[k * width..];
            if pivot_row != k {
                current.swap_with_slice(&mut tail[(pivot_row - k - 1) * width..(pivot_row - k) * width]);
            }
            for (row, l) in tail.chunks_exact_mut(width).zip(&mut lower[k * half..]).take(last - k) {
                *l = row[0] / pivot;
                let negative = T::default() - *l;
                // The row moves one column to the left: its first entry has just been eliminated.
                for c in 1..width {
                    row[c - 1] = T::fma(negative, current[c], row[c]);
                }
                row[width - 1] = T::default();
            }
        }
        Ok(Self { n, half, upper: rows, lower, pivots })
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [T]) {
        let width = 2 * self.half + 1;
        for k in 0..self.n {
            b.swap(k, self.pivots[k]);
            let bk = b[k];
            let last = (k + self.half).min(self.n - 1);
            for (t, l) in b[k + 1..=last].iter_mut().zip(&self.lower[k * self.half..]) {
                *t = T::fma(T::default() - *l, bk, *t);
            }
        }
        for k in (0..self.n).rev() {
            let end = (k + width).min(self.n);
            let row = &self.upper[k * width..(k + 1) * width];
            let sum: T = b[k + 1..end].iter().zip(&row[1..]).map(|(x, u)| *x * *u).sum();
            b[k] = (b[k] - sum) / row[0];
        }
    }
}

impl BandLu {
    /// Whether the elimination of row `k` changes the sign of the determinant, by an interchange or by a
    /// negative pivot.
    pub fn turns_sign(&self, k: usize) -> bool {
        (self.pivots[k] != k) != (self.upper[k * (2 * self.half + 1)] < 0.0)
    }
}
