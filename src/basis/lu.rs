//! LU factorisation with partial pivoting, at any precision.

use super::arithmetic::Arithmetic;

/// P A = L U of a square matrix.
#[derive(Clone, Debug)]
pub struct Lu<N> {
    size: usize,
    /// L below the diagonal (its diagonal is one), U above it, reciprocal pivots on it; stored
    /// column by column, because a substitution then updates numbers that are independent of each
    /// other, whereas each term of a sum along a row would have to wait for the term before.
    factors: Vec<N>,
    /// Per row of P A: the index of the same row in A.
    order: Vec<u32>,
}

impl<N: Clone> Lu<N> {
    /// Factorises the matrix of `size` rows stored row by row; `None` if a pivot is zero or not
    /// finite.
    pub fn new<A: Arithmetic<Number = N>>(arithmetic: &A, size: usize, matrix: Vec<N>) -> Option<Self> {
        let n = size;
        let mut a = matrix;
        let mut order: Vec<u32> = (0..n as u32).collect();
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if arithmetic.exceeds(&a[i * n + k], &a[pivot * n + k]) {
                    pivot = i;
                }
            }
            if pivot != k {
                order.swap(k, pivot);
                let (upper, lower) = a.split_at_mut(pivot * n);
                upper[k * n..(k + 1) * n].swap_with_slice(&mut lower[..n]);
            }
            arithmetic.exponent(&a[k * n + k])?;
            let reciprocal = arithmetic.div(&arithmetic.number(1.0), &a[k * n + k]);
            let (upper, lower) = a.split_at_mut((k + 1) * n);
            let pivot_row = &mut upper[k * n + k..];
            for row in lower.chunks_exact_mut(n) {
                if arithmetic.is_zero(&row[k]) {
                    continue;
                }
                let factor = arithmetic.mul(&row[k], &reciprocal);
                arithmetic.sub_scaled(&mut row[k + 1..], &factor, &pivot_row[1..]);
                row[k] = factor;
            }
            pivot_row[0] = reciprocal;
        }
        let factors = (0..n * n).map(|at| a[at % n * n + at / n].clone()).collect();
        Some(Self { size, factors, order })
    }

    /// x with A x = b.
    pub fn solve<A: Arithmetic<Number = N>>(&self, arithmetic: &A, b: &[N]) -> Vec<N> {
        let mut x: Vec<N> = self.order.iter().map(|&row| b[row as usize].clone()).collect();
        let columns = || self.factors.chunks_exact(self.size).enumerate();
        for (j, column) in columns() {
            let (done, rest) = x.split_at_mut(j + 1);
            arithmetic.sub_scaled(rest, &done[j], &column[j + 1..]);
        }
        for (j, column) in columns().rev() {
            x[j] = arithmetic.mul(&x[j], &column[j]);
            let (rest, done) = x.split_at_mut(j);
            arithmetic.sub_scaled(rest, &done[0], &column[..j]);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::double_double::DoubleDouble;
    use super::*;

    #[test]
    fn hilbert_matrix_of_order_twelve() {
        let (n, d) = (12, DoubleDouble);
        let entry = |i: usize, j: usize| d.div(&d.number(1.0), &d.number((i + j + 1) as f64));
        let matrix: Vec<_> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        let exact: Vec<_> = (0..n).map(|i| d.number(1.0 + i as f64)).collect();
        let b: Vec<_> = (0..n)
            .map(|i| (0..n).fold(d.number(0.0), |sum, j| d.add(&sum, &d.mul(&entry(i, j), &exact[j]))))
            .collect();
        let x = Lu::new(&d, n, matrix).unwrap().solve(&d, &b);
        for (x, exact) in x.iter().zip(&exact) {
            assert!(d.nearest(&d.sub(x, exact)).abs() < 1e-13, "condition 1.7e16, 32 digits");
        }
    }

    #[test]
    fn a_singular_matrix_has_no_factors() {
        let d = DoubleDouble;
        let matrix: Vec<_> = [1.0, 2.0, 2.0, 4.0].map(|x| d.number(x)).to_vec();
        assert!(Lu::new(&d, 2, matrix).is_none());
    }
}
