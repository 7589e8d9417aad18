//! A few eigenpairs of A φ = θ B φ on the allowed motions, with A symmetric and positive definite
//! there and B symmetric.
//!
//! The largest 1/θ are wanted: the lowest vibrations (A the stiffness, B the mass matrix) and the
//! lowest critical loads (B the negative geometric stiffness, which need not be definite). Both
//! methods work with A⁻¹, of which the wanted pairs are the dominant ones. With M⁻¹ K they would
//! carry the round-off of the highest frequency: 2e-7 instead of 1e-9 of the first one, for a
//! cantilever of 100 elements.
//!
//! | unknowns | method | file |
//! |---|---|---|
//! | few, or not many more than wanted pairs | Cholesky's A = L Lᵀ, all of L⁻¹ B L⁻ᵀ by faer | [`dense`] |
//! | many | Lanczos with one factorisation of the band | [`lanczos`] |

mod correct;
pub mod dense;
pub mod lanczos;
mod ritz;

pub use correct::{Corrected, corrected, errors, settled};
pub use ritz::ritz;

use crate::lanes::fma;
use crate::linear::bordered::BorderRow;
use crate::linear::{Matrix, Singular};

/// Why eigenpairs could not be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum EigenError {
    /// The stiffness has no inverse on the allowed motions.
    #[error("the stiffness matrix cannot be factorised")]
    #[diagnostic(help("the structure can move without resistance: add supports"))]
    Singular(#[from] Singular),
    /// The stiffness has negative eigenvalues.
    #[error(
        "the state about which to linearise is unstable ({count} negative eigenvalue{} of the tangent)",
        if *.count == 1 { "" } else { "s" }
    )]
    #[diagnostic(help(
        "only about a stable equilibrium are there vibrations: the loads exceed a critical one, which \
         `[analysis.buckling]` estimates and `[analysis.static]` locates on the path; use smaller loads or more supports"
    ))]
    Unstable {
        /// Number of negative eigenvalues.
        count: usize,
    },
    /// A frequency is smaller than the round-off of the stiffness.
    #[error(
        "frequency {number} cannot be told from zero: below {below:.1e} Hz the round-off of the stiffness hides everything, and supports \
         leave only {free} motion{} that nothing resists",
        if *.free == 1 { "" } else { "s" }
    )]
    #[diagnostic(help(
        "use fewer elements or nodes, whose stiffness has less round-off, or none of axial stiffnesses that are far beyond EI/h² with the \
         spacing h: a beam without `axial_stiffness` keeps its length"
    ))]
    Hidden {
        /// Number of the frequency, from 1.
        number: usize,
        /// Frequencies below this are hidden \[Hz\].
        below: f64,
        /// Number of motions that nothing resists.
        free: usize,
    },
    /// Critical load factors are hidden by round-off.
    #[error("the round-off of the stiffness hides {}", hidden(*.above))]
    #[diagnostic(help(
        "use fewer elements or nodes, and none that are close to each other, whose stiffness has less round-off, or leave out axial stiffnesses that are \
         far beyond EI/h² with the spacing h: a beam without `axial_stiffness` keeps its length"
    ))]
    HiddenLoads {
        /// The largest load factor that could have been seen.
        above: f64,
    },
    /// Follower loads, fields without a potential or dry friction make the tangent unsymmetric.
    #[error(
        "follower loads, a `force_field` that is given by its `value`, a force by a function, or dry friction make the tangent \
         unsymmetric, and a {analysis} analysis needs a symmetric one"
    )]
    #[diagnostic(help(
        "use dead loads, a `potential` for a field that has one, and contacts without friction; or a static analysis along the path for limit points, and a \
         motion (`dynamic`) with a small `initial_velocity`, in which a flutter by follower loads grows"
    ))]
    NotSymmetric {
        /// The analysis.
        analysis: &'static str,
    },
    /// Supports and constraints leave no motion.
    #[error("the supports hold every coordinate of the mesh: nothing is left that could move")]
    #[diagnostic(help("use more elements or nodes, or fewer supports"))]
    NoMotion,
    /// The projected problem could not be solved.
    #[error("the projected eigenproblem did not converge")]
    Projection,
    /// Lanczos' method stopped short of the wanted number.
    #[error("found {found} of {wanted} eigenpairs to full accuracy, and then one that is too near to others")]
    #[diagnostic(help(
        "ask for fewer, or take fewer elements or nodes: the stiffness is at the limit of double precision"
    ))]
    NotConverged {
        /// Pairs found.
        found: usize,
        /// Pairs wanted.
        wanted: usize,
        /// The largest reciprocal that there may be.
        largest: f64,
    },
}

fn hidden(above: f64) -> String {
    match above {
        0.0 => "all critical load factors".to_owned(),
        _ => format!("all critical load factors above {above:.2e}, and there are none below"),
    }
}

/// The matrices of A φ = θ B φ in the supports' frames. Rows of fixed coordinates are those of a
/// diagonal matrix in A, and zero in B.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<'a> {
    /// A.
    pub a: &'a Matrix,
    /// B.
    pub b: &'a Matrix,
    /// Rows g with g φ = 0.
    pub border: &'a [BorderRow],
    /// Per coordinate, whether it is fixed.
    pub fixed: &'a [bool],
}

impl Pencil<'_> {
    /// Number of independent motions.
    pub fn motions(&self) -> usize {
        let free = self.fixed.iter().filter(|fixed| !**fixed).count();
        free.saturating_sub(self.border.len())
    }
}

/// Eigenpairs in descending order of 1/θ.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// 1/θ.
    pub reciprocals: Vec<f64>,
    /// φ, coordinates only, φᵀ A φ = 1.
    pub vectors: Vec<Vec<f64>>,
}

/// A value counts as different from zero if it exceeds its round-off by this many standard
/// deviations.
pub(super) const CERTAIN: f64 = 10.0;
/// A reciprocal smaller than this fraction of the largest one is round-off.
const NEGLIGIBLE: f64 = 1e-13;

/// Up to this many motions all eigenpairs are computed, however few are wanted: the dense method is
/// then as fast as the other.
const FEW: usize = 40;
/// If the motions are at most this many times the wanted ones, all eigenpairs are computed, too:
/// the dense method is then as fast.
const SHARE: usize = 4;

/// The `wanted` largest positive 1/θ, fewer where there are not so many, and up to `guards` more, which may be less
/// accurate.
///
/// # Errors
/// [`EigenError`] where there are no allowed motions, A is singular or indefinite on them, or an
/// iteration fails.
pub fn largest_reciprocals(pencil: &Pencil<'_>, wanted: usize, guards: usize) -> Result<Pairs, EigenError> {
    let count = wanted + guards;
    if pencil.motions() == 0 {
        return Err(EigenError::NoMotion);
    }
    if pencil.motions() <= FEW.max(SHARE * count) {
        dense::largest_reciprocals(pencil, count)
    } else {
        lanczos::largest_reciprocals(pencil, wanted, guards)
    }
}

/// In eight sums, which need not wait for each other.
pub(super) fn dot(u: &[f64], v: &[f64]) -> f64 {
    let ((u, last_u), (v, last_v)) = (u.as_chunks::<8>(), v.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (u, v) in u.iter().zip(v) {
        for lane in 0..8 {
            sums[lane] = fma(u[lane], v[lane], sums[lane]);
        }
    }
    let rest: f64 = last_u.iter().zip(last_v).map(|(u, v)| u * v).sum();
    sums.iter().sum::<f64>() + rest
}

/// Standard deviation of φᵀ K φ if the entries of K carry independent round-off.
pub(super) fn round_off(k: &Matrix, shape: &[f64]) -> f64 {
    f64::EPSILON * k.squares_of_terms(shape).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(values: [f64; 8]) -> Matrix {
        let mut matrix = Matrix::zeros(2, 2, true);
        matrix.add_diagonal(1.0, &values);
        matrix
    }

    /// The same of both methods: reciprocals and the squares of the components of their vectors.
    fn pairs(pencil: &Pencil<'_>, count: usize) -> Result<Vec<(f64, Vec<f64>)>, EigenError> {
        let squares = |pairs: Pairs| -> Vec<(f64, Vec<f64>)> {
            let squares = |vector: Vec<f64>| vector.into_iter().map(|x| x * x).collect();
            pairs.reciprocals.into_iter().zip(pairs.vectors.into_iter().map(squares)).collect()
        };
        let dense = dense::largest_reciprocals(pencil, count).map(squares);
        let lanczos = lanczos::largest_reciprocals(pencil, count, 0).map(squares);
        match (&dense, &lanczos) {
            (Ok(a), Ok(b)) => {
                assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
                for ((a, u), (b, v)) in a.iter().zip(b) {
                    assert!((a - b).abs() < 1e-12 && u.iter().zip(v).all(|(u, v)| (u - v).abs() < 1e-12));
                }
            }
            (a, b) => assert_eq!(a, b),
        }
        dense
    }

    const FREE: [bool; 8] = [false; 8];

    /// Of diagonal matrices pairs are the quotients and the axes.
    #[test]
    fn pairs_of_diagonal_matrices_are_known() {
        let a = diagonal([1.0, 2.0, 4.0, 5.0, 8.0, 10.0, 16.0, 20.0]);
        let b = diagonal([3.0, 14.0, -4.0, 0.0, 40.0, 1.0, 4.0, 0.0]);
        let pencil = Pencil { a: &a, b: &b, border: &[], fixed: &FREE };
        let found = pairs(&pencil, 3).unwrap();
        for ((reciprocal, squares), (value, axis, square)) in
            found.iter().zip([(7.0, 1, 0.5), (5.0, 4, 0.125), (3.0, 0, 1.0)])
        {
            assert!((reciprocal - value).abs() < 1e-12, "{found:?}");
            for (i, found) in squares.iter().enumerate() {
                assert!((found - if i == axis { square } else { 0.0 }).abs() < 1e-12, "{squares:?}");
            }
        }
        // Five of eight are positive; the others are no critical loads.
        assert_eq!(
            (found.len(), pairs(&pencil, 8).unwrap().len(), pairs(&pencil, 0).unwrap().len()),
            (3, 5, 0)
        );
        // With the second and the fifth coordinate fixed there are three.
        let fixed = [false, true, false, false, true, false, false, false];
        let a = diagonal([1.0, 1.0, 4.0, 5.0, 1.0, 10.0, 16.0, 20.0]);
        let b = diagonal([3.0, 0.0, -4.0, 0.0, 0.0, 1.0, 4.0, 0.0]);
        let held = Pencil { a: &a, b: &b, border: &[], fixed: &fixed };
        let reciprocals: Vec<f64> = pairs(&held, 8).unwrap().into_iter().map(|pair| pair.0).collect();
        assert!(reciprocals.len() == 3 && (reciprocals[0] - 3.0).abs() < 1e-12, "{reciprocals:?}");
        assert_eq!((pencil.motions(), held.motions()), (8, 6));
    }

    /// x₀ + x₁ = 0 leaves the mean of both; a row that says it again is one too many.
    #[test]
    fn constraint_rows_leave_the_motions_between() {
        let a = diagonal([1.0; 8]);
        let b = diagonal([20.0, 40.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let row = vec![(0, 1.0), (1, 1.0)];
        let pencil = Pencil { a: &a, b: &b, border: std::slice::from_ref(&row), fixed: &FREE };
        let found = pairs(&pencil, 8).unwrap();
        assert_eq!((found.len(), pencil.motions()), (2, 7));
        assert!((found[0].0 - 30.0).abs() < 1e-10 && (found[1].0 - 10.0).abs() < 1e-10, "{found:?}");
        assert!((found[0].1[0] - 0.5).abs() < 1e-12 && (found[0].1[1] - 0.5).abs() < 1e-12, "{found:?}");
        let twice = [row.clone(), row.clone()];
        let pencil = Pencil { border: &twice, ..pencil };
        let found = dense::largest_reciprocals(&pencil, 8);
        assert!(matches!(found, Err(EigenError::Singular(Singular { row: 9 }))), "{found:?}");
    }

    #[test]
    fn negative_directions_are_counted() {
        let a = diagonal([1.0, -2.0, 4.0, 5.0, 8.0, -10.0, 16.0, 20.0]);
        let b = diagonal([1.0; 8]);
        let pencil = Pencil { a: &a, b: &b, border: &[], fixed: &FREE };
        let found = pairs(&pencil, 2);
        assert!(matches!(found, Err(EigenError::Unstable { count: 2 })), "{found:?}");
        let pencil = Pencil { fixed: &[true; 8], ..pencil };
        assert!(matches!(largest_reciprocals(&pencil, 2, 0), Err(EigenError::NoMotion)));
    }

    /// ε √((4·2·2)² + 2 (1·2·3)² + (9·3·3)²) = 83 ε.
    #[test]
    fn round_off_adds_up_as_of_independent_entries() {
        let mut k = diagonal([4.0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        k.add_at(0, 1, 1.0);
        let found = round_off(&k, &[2.0, 3.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((found / f64::EPSILON - 83.0).abs() < 1e-12, "{found}");
    }
}
