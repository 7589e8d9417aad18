//! A band bordered by constraint rows,
//!
//! ```text
//! [ K  Bᵀ ]
//! [ B  0  ]
//! ```
//!
//! factorised by faer's sparse LU with a fill-reducing ordering. The symbolic part is kept as long
//! as the pattern does not change.

use super::equilibrate::scales;
use super::{Matrix, Singular};
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat, SymbolicSparseColMatRef, Triplet};
use faer::traits::ComplexField;
use faer::traits::math_utils::{from_f64, mul};

/// One row of B: (unknown, entry), in rising order of the unknowns.
pub type BorderRow = Vec<(usize, f64)>;

/// Sparse LU of a bordered matrix, real or complex.
#[derive(Clone, Debug)]
pub struct Bordered<T = f64> {
    symbolic: SymbolicLu<usize>,
    /// What the symbolic factorisation is of.
    pattern: SymbolicSparseColMat<usize>,
    lu: Lu<usize, T>,
    /// Scales of unknowns and multipliers.
    scales: Vec<f64>,
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
        // Zeros inside the band are stored as well, so that the pattern is the same for every
        // tangent.
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

/// Whether two patterns are the same.
fn same(a: SymbolicSparseColMatRef<'_, usize>, b: SymbolicSparseColMatRef<'_, usize>) -> bool {
    a.col_ptr() == b.col_ptr() && a.row_idx() == b.row_idx()
}

impl Bordered {
    /// Factorises `matrix` bordered by `border`. The symbolic factorisation of `earlier` is reused
    /// if its pattern is the same.
    ///
    /// # Errors
    /// [`Singular`] if the bordered matrix is singular.
    pub fn new(matrix: &Matrix, border: &[BorderRow], earlier: Option<Self>) -> Result<Self, Singular> {
        let diagonal = |i: usize| matrix.get(i, i);
        Self::from_entries(matrix, |i, j| matrix.get(i, j), diagonal, border, earlier)
    }
}

impl<T: ComplexField> Bordered<T> {
    /// Factorises a bordered matrix with the pattern of `pattern`, the entries `entry(row, column)`
    /// and diagonal entries of the sizes `diagonal`.
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
        let (symbolic, pattern) = match earlier {
            Some(earlier) if same(earlier.pattern.as_ref(), sparse.symbolic()) => {
                (earlier.symbolic, earlier.pattern)
            }
            _ => {
                let symbolic = SymbolicLu::try_new(sparse.symbolic()).map_err(|_| singular)?;
                (symbolic, sparse.symbolic().to_owned().map_err(|_| singular)?)
            }
        };
        let lu =
            Lu::try_new_with_symbolic(symbolic.clone(), sparse.as_ref()).map_err(|error| match error {
                faer::sparse::linalg::LuError::SymbolicSingular { index } => Singular { row: index },
                faer::sparse::linalg::LuError::Generic(_) => singular,
            })?;
        Ok(Self { symbolic, pattern, lu, scales })
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [T]) {
        let scaled = |value: &T, i: usize| mul(value, &from_f64(self.scales[i]));
        let mut column = faer::Mat::from_fn(b.len(), 1, |i, _| scaled(&b[i], i));
        self.lu.solve_in_place(&mut column);
        for (i, value) in b.iter_mut().enumerate() {
            *value = scaled(&column[(i, 0)], i);
        }
    }
}
