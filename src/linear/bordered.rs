//! A band bordered by constraint rows,
//!
//! ```text
//! [ K  Bᵀ ]
//! [ B  0  ]
//! ```
//!
//! factorised by faer's sparse LU with a fill-reducing ordering. The symbolic part is kept as long
//! as the pattern stays.

use super::equilibrate::scales;
use super::{Matrix, Singular};
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::traits::ComplexField;
use faer::traits::math_utils::{from_f64, mul};

/// One row of B: (unknown, entry), in rising order of the unknowns.
pub type BorderRow = Vec<(usize, f64)>;

/// Sparse LU of a bordered matrix, real or complex.
#[derive(Clone, Debug)]
pub struct Bordered<T = f64> {
    symbolic: SymbolicLu<usize>,
    lu: Lu<usize, T>,
    /// By what unknowns and multipliers are scaled.
    scales: Vec<f64>,
    size: usize,
}

fn assemble<T: ComplexField>(
    pattern: &Matrix,
    entry: impl Fn(usize, usize) -> T,
    border: &[BorderRow],
    scales: &[f64],
) -> Option<SparseColMat<usize, T>> {
    let n = pattern.size();
    let mut entries = Vec::new();
    for i in 0..n {
        // Zeros inside the band stay in the pattern, so that it is the same for every tangent.
        let scaled = |j: usize| mul(&entry(i, j), &from_f64(scales[i] * scales[j]));
        entries.extend(pattern.columns(i).map(|j| Triplet::new(i, j, scaled(j))));
    }
    for (r, row) in border.iter().enumerate() {
        for &(j, value) in row {
            let value = from_f64::<T>(value * scales[n + r] * scales[j]);
            entries.push(Triplet::new(n + r, j, value.clone()));
            entries.push(Triplet::new(j, n + r, value));
        }
    }
    SparseColMat::try_new_from_triplets(n + border.len(), n + border.len(), &entries).ok()
}

impl Bordered {
    /// Factorises `matrix` bordered by `border`; `earlier` lends its symbolic factorisation if the
    /// pattern is the same.
    ///
    /// # Errors
    /// [`Singular`] where the whole matrix is.
    pub fn new(matrix: &Matrix, border: &[BorderRow], earlier: Option<Self>) -> Result<Self, Singular> {
        let diagonal = |i: usize| matrix.get(i, i);
        Self::from_entries(matrix, |i, j| matrix.get(i, j), diagonal, border, earlier)
    }
}

impl<T: ComplexField> Bordered<T> {
    /// The same for a matrix with the pattern of `pattern`, the entries `entry(row, column)` and a
    /// diagonal of the sizes `diagonal`.
    ///
    /// # Errors
    /// As [`Bordered::new`].
    pub fn from_entries(
        pattern: &Matrix,
        entry: impl Fn(usize, usize) -> T,
        diagonal: impl Fn(usize) -> f64,
        border: &[BorderRow],
        earlier: Option<Self>,
    ) -> Result<Self, Singular> {
        let size = pattern.size() + border.len();
        let singular = Singular { row: size };
        let scales = scales(pattern.size(), diagonal, border);
        let sparse = assemble(pattern, entry, border, &scales).ok_or(singular)?;
        let symbolic = match earlier {
            Some(earlier) if earlier.size == size => earlier.symbolic,
            _ => SymbolicLu::try_new(sparse.symbolic()).map_err(|_| singular)?,
        };
        let lu =
            Lu::try_new_with_symbolic(symbolic.clone(), sparse.as_ref()).map_err(|error| match error {
                faer::sparse::linalg::LuError::SymbolicSingular { index } => Singular { row: index },
                faer::sparse::linalg::LuError::Generic(_) => singular,
            })?;
        Ok(Self { symbolic, lu, scales, size })
    }

    /// Solves in place: unknowns first, multipliers last.
    pub fn solve(&self, b: &mut [T]) {
        let scaled = |value: &T, i: usize| mul(value, &from_f64(self.scales[i]));
        let mut column = faer::Mat::from_fn(b.len(), 1, |i, _| scaled(&b[i], i));
        self.lu.solve_in_place(&mut column);
        for (i, value) in b.iter_mut().enumerate() {
            *value = scaled(&column[(i, 0)], i);
        }
    }
}
