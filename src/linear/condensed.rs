//! A band bordered by few constraint rows, condensed onto their multipliers.
//!
//! If K itself has an inverse, as K + c M of a motion does, the bordered system needs only a
//! factorisation of the band and one of a matrix S as large as the number r of rows:
//!
//! ```text
//! S = B K⁻¹ Bᵀ,   S μ = B K⁻¹ f − g,   x = K⁻¹ f − K⁻¹Bᵀ μ
//! ```
//!
//! This takes r substitutions for K⁻¹Bᵀ at factorisation and one per solution, which is a fifth of
//! the time of a sparse LU for a chain of two beams.

use super::bordered::BorderRow;
use super::complex_ldl::ComplexLdl;
use super::interleaved::fits;
use super::symmetric::Ldl;
use super::{Matrix, Singular};
use faer::c64;
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};

/// Number of rows above which a sparse LU is faster.
const MOST_ROWS: usize = 48;
/// Number of local rows above which the LU of a wider band is faster ([`super::interleaved`]).
const MOST_LOCAL_ROWS: usize = 12;

/// Whether the rows are few enough for this method to be the fastest.
pub fn serves(matrix: &Matrix, border: &[BorderRow]) -> bool {
    border.len() <= if fits(matrix, border) { MOST_LOCAL_ROWS } else { MOST_ROWS }
}

fn dot(row: &BorderRow, x: &[f64]) -> f64 {
    row.iter().map(|(i, value)| value * x[*i]).sum()
}

fn dense(row: &BorderRow, size: usize) -> Vec<f64> {
    let mut dense = vec![0.0; size];
    row.iter().for_each(|(i, value)| dense[*i] = *value);
    dense
}

/// A bordered matrix, by the LDLᵀ of its band and the LU of S.
#[derive(Clone, Debug)]
pub struct Condensed {
    ldl: Ldl,
    border: Vec<BorderRow>,
    /// K⁻¹ Bᵀ.
    columns: Vec<Vec<f64>>,
    schur: LU<f64, Dyn, Dyn>,
}

impl Condensed {
    /// Borders the factorised band `ldl` of `size` unknowns.
    ///
    /// # Errors
    /// [`Singular`] if the rows are linearly dependent.
    pub fn new(ldl: Ldl, size: usize, border: &[BorderRow]) -> Result<Self, Singular> {
        let mut columns: Vec<Vec<f64>> = border.iter().map(|row| dense(row, size)).collect();
        columns.iter_mut().for_each(|column| ldl.solve(column));
        let schur = DMatrix::from_fn(border.len(), border.len(), |r, c| dot(&border[r], &columns[c])).lu();
        let condensed = Self { ldl, border: border.to_vec(), columns, schur };
        if condensed.schur.is_invertible() { Ok(condensed) } else { Err(Singular { row: size }) }
    }

    /// The factorised band, whose memory the next factorisation reuses.
    pub fn into_ldl(self) -> Ldl {
        self.ldl
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [f64]) {
        let (x, g) = b.split_at_mut(b.len() - self.border.len());
        self.ldl.solve(x);
        let mut mu = DVector::from_fn(g.len(), |r, _| dot(&self.border[r], x) - g[r]);
        self.schur.solve_mut(&mut mu);
        for (column, mu) in self.columns.iter().zip(mu.iter()) {
            x.iter_mut().zip(column).for_each(|(x, c)| *x -= mu * c);
        }
        g.copy_from_slice(mu.as_slice());
    }
}

/// As [`Condensed`], for the complex matrices of collocation's stages.
#[derive(Clone, Debug)]
pub struct ComplexCondensed {
    ldl: ComplexLdl,
    border: Vec<BorderRow>,
    /// K⁻¹ Bᵀ, column by column, as real and imaginary parts.
    columns: Vec<[Vec<f64>; 2]>,
    schur: LU<Complex<f64>, Dyn, Dyn>,
}

impl ComplexCondensed {
    /// Borders the factorised band `ldl` of `size` unknowns.
    ///
    /// # Errors
    /// [`Singular`] if the rows are linearly dependent.
    pub fn new(ldl: ComplexLdl, size: usize, border: &[BorderRow]) -> Result<Self, Singular> {
        let solved = |row: &BorderRow| {
            let (mut re, mut im) = (dense(row, size), vec![0.0; size]);
            ldl.solve(&mut re, &mut im);
            [re, im]
        };
        let columns: Vec<_> = border.iter().map(solved).collect();
        let entry = |r: usize, c: usize| {
            let [re, im] = &columns[c];
            c64::new(dot(&border[r], re), dot(&border[r], im))
        };
        let schur = DMatrix::from_fn(border.len(), border.len(), entry).lu();
        let condensed = Self { ldl, border: border.to_vec(), columns, schur };
        if condensed.schur.is_invertible() { Ok(condensed) } else { Err(Singular { row: size }) }
    }

    /// The factorised band, whose memory the next factorisation reuses.
    pub fn into_ldl(self) -> ComplexLdl {
        self.ldl
    }

    /// Solves in place; `re` and `im` hold the unknowns first and the multipliers last.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        let unknowns = re.len() - self.border.len();
        let ((xr, gr), (xi, gi)) = (re.split_at_mut(unknowns), im.split_at_mut(unknowns));
        self.ldl.solve(xr, xi);
        let mut mu = DVector::from_fn(gr.len(), |r, _| {
            let row = &self.border[r];
            c64::new(dot(row, xr) - gr[r], dot(row, xi) - gi[r])
        });
        self.schur.solve_mut(&mut mu);
        for ([re, im], mu) in self.columns.iter().zip(mu.iter()) {
            for ((xr, xi), (re, im)) in xr.iter_mut().zip(xi.iter_mut()).zip(re.iter().zip(im)) {
                *xr -= mu.re * re - mu.im * im;
                *xi -= mu.re * im + mu.im * re;
            }
        }
        for ((gr, gi), mu) in gr.iter_mut().zip(gi).zip(mu.iter()) {
            (*gr, *gi) = (mu.re, mu.im);
        }
    }
}
