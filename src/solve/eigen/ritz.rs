//! Eigenpairs of a pencil that is restricted to a few vectors (Rayleigh and Ritz).

use super::{EigenError, dot};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, Side};

/// θ and B-orthonormal φ of A φ = θ B φ restricted to the span of `vectors`, of which `of_a` and `of_b` are the products
/// with A and B; B is definite. Lowest first.
///
/// # Errors
/// [`EigenError::Projection`] where B is not definite on the vectors, as where they depend on each other.
pub fn ritz(
    vectors: &[Vec<f64>],
    of_a: &[Vec<f64>],
    of_b: &[Vec<f64>],
) -> Result<Vec<(f64, Vec<f64>)>, EigenError> {
    let c = vectors.len();
    if c == 0 {
        return Ok(Vec::new());
    }
    let form = |products: &[Vec<f64>]| {
        Mat::from_fn(c, c, |i, j| 0.5 * (dot(&vectors[i], &products[j]) + dot(&vectors[j], &products[i])))
    };
    let factor = form(of_b).llt(Side::Lower).map_err(|_| EigenError::Projection)?;
    let lower = factor.L();
    let mut k = form(of_a);
    solve_lower_triangular_in_place(lower, k.as_mut(), Par::Seq);
    let mut k = k.transpose().to_owned();
    solve_lower_triangular_in_place(lower, k.as_mut(), Par::Seq);
    let eigen = k.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::Projection)?;
    let mut shares = eigen.U().to_owned();
    solve_upper_triangular_in_place(lower.transpose(), shares.as_mut(), Par::Seq);
    let combined = |of: &[Vec<f64>], k: usize| {
        let mut sum = vec![0.0; of.first().map_or(0, Vec::len)];
        for (i, vector) in of.iter().enumerate() {
            sum.iter_mut().zip(vector).for_each(|(s, v)| *s += shares[(i, k)] * v);
        }
        sum
    };
    // The eigenvalues all have the round-off of the largest one. Rayleigh's quotients have each
    // their own, because they err by the square of the error of the shapes.
    let mut pairs: Vec<(f64, Vec<f64>)> = (0..c)
        .map(|k| {
            let shape = combined(vectors, k);
            let value = dot(&shape, &combined(of_a, k)) / dot(&shape, &combined(of_b, k));
            (value, shape)
        })
        .collect();
    // A pivot that is all round-off passes for a positive one.
    if pairs.iter().any(|(value, _)| !value.is_finite()) {
        return Err(EigenError::Projection);
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = diag(1, 4, 9), B = diag(1, 2, 3) and two vectors in the plane of the last two.
    #[test]
    fn pairs_of_the_plane_of_two_vectors() {
        let product = |by: [f64; 3], of: &[f64]| of.iter().zip(by).map(|(v, by)| by * v).collect::<Vec<_>>();
        let vectors = [vec![0.0, 1.0, 2.0], vec![0.0, 1.0, -1.0]];
        let of = |by: [f64; 3]| vectors.iter().map(|v| product(by, v)).collect::<Vec<_>>();
        let (a, b) = (of([1.0, 4.0, 9.0]), of([1.0, 2.0, 3.0]));
        let found = ritz(&vectors, &a, &b).expect("independent vectors");
        for ((value, shape), (expected, axis, size)) in found.iter().zip([(2.0, 1, 0.5), (3.0, 2, 1.0 / 3.0)])
        {
            assert!((value - expected).abs() < 1e-14, "{found:?}");
            assert!((shape[axis].powi(2) - size).abs() < 1e-14 && shape[0] == 0.0, "{found:?}");
        }
        assert_eq!(ritz(&[], &[], &[]), Ok(vec![]));
        let twice = [vectors[0].clone(), vectors[0].clone()];
        assert!(ritz(&twice, &[a[0].clone(), a[0].clone()], &[b[0].clone(), b[0].clone()]).is_err());
    }
}
