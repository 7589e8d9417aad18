//! All eigenpairs of a small problem, multiple ones included.
//!
//! Fixed coordinates are left out, and constraints are satisfied by a basis Z of their null space
//! (QR):
//!
//! ```text
//! A = L Lᵀ,   L⁻¹ B L⁻ᵀ y = (1/θ) y,   φ = Z L⁻ᵀ y
//! ```

use super::{EigenError, NEGLIGIBLE, Pairs, Pencil};
use crate::linear::{Matrix, Singular};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, Side};

/// A constraint row that is a combination of others to within this fraction is redundant.
const DEPENDENT: f64 = 1e-12;

/// The `count` largest positive 1/θ, fewer where there are not so many.
///
/// # Errors
/// [`EigenError`] where A is singular or indefinite on the allowed motions.
pub fn largest_reciprocals(pencil: &Pencil<'_>, count: usize) -> Result<Pairs, EigenError> {
    let free: Vec<usize> = (0..pencil.fixed.len()).filter(|&i| !pencil.fixed[i]).collect();
    // Positions and gradients have different units: every coordinate is measured by the stiffness of
    // its pair, for along the axis of an inextensible beam there is none but round-off.
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| pencil.a.get(i & !1, i & !1).max(pencil.a.get(i | 1, i | 1)))
        .map(|a| if a > 0.0 && a.is_finite() { 1.0 / a.sqrt() } else { 1.0 })
        .collect();
    let null_space = null_space(pencil, &free, &scale)?;
    let reduce = |matrix: &Matrix| {
        let n = free.len();
        let full = Mat::from_fn(n, n, |i, j| scale[i] * matrix.get(free[i], free[j]) * scale[j]);
        match &null_space {
            Some(z) => z.transpose() * full * z,
            None => full,
        }
    };
    let a = reduce(pencil.a);
    let Ok(cholesky) = a.llt(Side::Lower) else {
        let values = a.self_adjoint_eigenvalues(Side::Lower).map_err(|_| EigenError::Projection)?;
        return Err(match values.iter().filter(|value| **value < 0.0).count() {
            0 => Singular { row: 0 }.into(),
            count => EigenError::Unstable { count },
        });
    };
    let lower = cholesky.L();
    let mut b = reduce(pencil.b);
    // L⁻¹ B, then L⁻¹ (L⁻¹ B)ᵀ.
    solve_lower_triangular_in_place(lower, b.as_mut(), Par::Seq);
    let mut b = b.transpose().to_owned();
    solve_lower_triangular_in_place(lower, b.as_mut(), Par::Seq);
    let eigen = b.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::Projection)?;
    let (values, mut vectors) = (eigen.S().column_vector(), eigen.U().to_owned());
    solve_upper_triangular_in_place(lower.transpose(), vectors.as_mut(), Par::Seq);
    let vectors = match &null_space {
        Some(z) => z * vectors,
        None => vectors,
    };
    let m = vectors.ncols();
    let largest = (0..m).fold(0.0_f64, |largest, i| largest.max(values[i].abs()));
    let mut pairs = Pairs::default();
    for i in (0..m).rev().filter(|&i| values[i] > NEGLIGIBLE * largest).take(count) {
        let mut vector = vec![0.0; pencil.fixed.len()];
        for (k, (&coordinate, scale)) in free.iter().zip(&scale).enumerate() {
            vector[coordinate] = scale * vectors[(k, i)];
        }
        pairs.reciprocals.push(values[i]);
        pairs.vectors.push(vector);
    }
    Ok(pairs)
}

/// Orthonormal columns that span the motions which the constraint rows allow, in scaled free
/// coordinates.
fn null_space(pencil: &Pencil<'_>, free: &[usize], scale: &[f64]) -> Result<Option<Mat<f64>>, EigenError> {
    let (n, m) = (free.len(), pencil.border.len());
    if m == 0 {
        return Ok(None);
    }
    let mut place = vec![None; pencil.fixed.len()];
    for (k, &coordinate) in free.iter().enumerate() {
        place[coordinate] = Some(k);
    }
    let mut rows = Mat::<f64>::zeros(n, m);
    for (r, row) in pencil.border.iter().enumerate() {
        for &(coordinate, value) in row {
            if let Some(k) = place[coordinate] {
                rows[(k, r)] = value * scale[k];
            }
        }
    }
    let sizes: Vec<f64> = (0..m).map(|r| rows.col(r).norm_l2()).collect();
    let qr = rows.qr();
    let upper = qr.thin_R();
    if let Some(row) = (0..m).find(|&r| r >= n || upper[(r, r)].abs() <= DEPENDENT * sizes[r]) {
        return Err(Singular { row: pencil.fixed.len() + row }.into());
    }
    Ok(Some(qr.compute_Q().get(.., m..).to_owned()))
}
