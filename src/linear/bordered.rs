//! A band bordered by constraint rows,
//!
//! ```text
//! [ K  Bᵀ ]
//! [ B  0  ]
//! ```
//!
//! factorised by faer's sparse LU with a fill-reducing ordering. The symbolic part is kept as long as the pattern stays.

use super::{Matrix, Singular};
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};

/// One row of B: (unknown, entry), in rising order of the unknowns.
pub type BorderRow = Vec<(usize, f64)>;

/// Sparse LU of a bordered matrix.
#[derive(Clone, Debug)]
pub struct Bordered {
    symbolic: SymbolicLu<usize>,
    lu: Lu<usize, f64>,
    size: usize,
}

fn assemble(matrix: &Matrix, border: &[BorderRow]) -> Option<SparseColMat<usize, f64>> {
    let n = matrix.size();
    let mut entries = Vec::new();
    for i in 0..n {
        // Zeros inside the band stay in the pattern, so that it is the same for every tangent.
        entries.extend(matrix.columns(i).map(|j| Triplet::new(i, j, matrix.get(i, j))));
    }
    for (r, row) in border.iter().enumerate() {
        for &(j, value) in row {
            entries.push(Triplet::new(n + r, j, value));
            entries.push(Triplet::new(j, n + r, value));
        }
    }
    SparseColMat::try_new_from_triplets(n + border.len(), n + border.len(), &entries).ok()
}

impl Bordered {
    /// Factorises `matrix` bordered by `border`; `earlier` lends its symbolic factorisation if the pattern is the same.
    ///
    /// # Errors
    /// [`Singular`] where the whole matrix is.
    pub fn new(matrix: &Matrix, border: &[BorderRow], earlier: Option<Self>) -> Result<Self, Singular> {
        let size = matrix.size() + border.len();
        let singular = Singular { row: size };
        let sparse = assemble(matrix, border).ok_or(singular)?;
        let symbolic = match earlier {
            Some(earlier) if earlier.size == size => earlier.symbolic,
            _ => SymbolicLu::try_new(sparse.symbolic()).map_err(|_| singular)?,
        };
        let lu =
            Lu::try_new_with_symbolic(symbolic.clone(), sparse.as_ref()).map_err(|error| match error {
                faer::sparse::linalg::LuError::SymbolicSingular { index } => Singular { row: index },
                faer::sparse::linalg::LuError::Generic(_) => singular,
            })?;
        Ok(Self { symbolic, lu, size })
    }

    /// Solves in place: unknowns first, multipliers last.
    pub fn solve(&self, b: &mut [f64]) {
        let mut column = faer::Mat::from_fn(b.len(), 1, |i, _| b[i]);
        self.lu.solve_in_place(&mut column);
        for (i, value) in b.iter_mut().enumerate() {
            *value = column[(i, 0)];
        }
    }
}
