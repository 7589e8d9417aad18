//! A few eigenpairs of A φ = θ B φ with A symmetric and positive definite on the allowed motions, B symmetric.
//!
//! Lanczos' method for the operator A⁻¹ B in the inner product of A, with full reorthogonalisation: it finds the largest
//! 1/θ first, that is the lowest vibrations (B the mass matrix, A the stiffness shifted by a little mass) and the
//! lowest critical loads (B the negative geometric stiffness, which need not be definite). One factorisation of A serves
//! all steps. The projected tridiagonal problem is solved by faer.

use crate::linear::{Factor, Matrix, Singular};
use faer::Side;

/// Why eigenpairs could not be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum EigenError {
    /// The stiffness has no inverse on the allowed motions.
    #[error("the stiffness matrix cannot be factorised: {0}")]
    #[diagnostic(help("the structure can move without resistance: add supports"))]
    Singular(#[from] Singular),
    /// The stiffness has negative eigenvalues.
    #[error("the state about which to linearise is unstable ({count} negative eigenvalues of the tangent)")]
    Unstable {
        /// Number of negative eigenvalues.
        count: usize,
    },
    /// Follower loads make the tangent unsymmetric.
    #[error("follower loads make the tangent unsymmetric, and a {analysis} analysis needs a symmetric one")]
    #[diagnostic(help("use dead loads, or a static analysis along the path"))]
    NotSymmetric {
        /// The analysis.
        analysis: &'static str,
    },
    /// The projected problem could not be solved.
    #[error("the projected eigenproblem did not converge")]
    Projection,
}

/// Eigenpairs in ascending order of θ (descending 1/θ).
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// 1/θ.
    pub reciprocal: Vec<f64>,
    /// φ, coordinates only, φᵀ A φ = 1.
    pub vectors: Vec<Vec<f64>>,
    /// Largest relative residual estimate of the wanted pairs.
    pub residual: f64,
}

/// Vectors that Lanczos' method may keep, over twice the wanted ones.
const EXTRA_VECTORS: usize = 120;

/// The `count` largest positive 1/θ. `a` is factorised in `factor` (with `multipliers` constraint rows); held rows of
/// `b` must be zero.
///
/// # Errors
/// [`EigenError::Projection`] where the small problem fails.
pub fn largest_reciprocals(
    a: &Matrix,
    factor: &Factor,
    multipliers: usize,
    b: &Matrix,
    count: usize,
) -> Result<Pairs, EigenError> {
    let n = a.size();
    let dot = |u: &[f64], v: &[f64]| -> f64 { u.iter().zip(v).map(|(u, v)| u * v).sum() };
    let apply = |v: &[f64]| -> Vec<f64> {
        let mut w = vec![0.0; n + multipliers];
        b.multiply_add(1.0, v, &mut w[..n]);
        factor.solve(&mut w);
        w.truncate(n);
        w
    };
    let times_a = |v: &[f64]| -> Vec<f64> {
        let mut w = vec![0.0; n];
        a.multiply_add(1.0, v, &mut w);
        w
    };
    // A start with a share of every mode: low-discrepancy numbers, the same in every run.
    let seed: Vec<f64> = (1..=n).map(|i| (i as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
    let mut w = apply(&seed);
    let mut vectors: Vec<Vec<f64>> = Vec::new();
    let mut weighted: Vec<Vec<f64>> = Vec::new();
    let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let limit = n.min(2 * count + EXTRA_VECTORS);
    let mut pairs = Pairs::default();
    loop {
        // Twice is enough (Kahan, Parlett).
        for _ in 0..2 {
            for (v, av) in vectors.iter().zip(&weighted) {
                let share = dot(av, &w);
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= share * v);
            }
        }
        let aw = times_a(&w);
        let norm = dot(&w, &aw).max(0.0).sqrt();
        let scale = alpha.iter().chain(&beta).fold(0.0_f64, |m, a| m.max(a.abs()));
        let exhausted = norm.is_nan() || norm <= 1e-14 * scale || norm == 0.0;
        let m = vectors.len();
        if m > 0 && (exhausted || m >= limit || (m > count && m.is_multiple_of(5))) {
            let tridiagonal = faer::Mat::<f64>::from_fn(m, m, |i, j| match i.abs_diff(j) {
                0 => alpha[i],
                1 => beta[i.max(j)],
                _ => 0.0,
            });
            let eigen = tridiagonal.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::Projection)?;
            let (values, small) = (eigen.S().column_vector(), eigen.U());
            let wanted: Vec<usize> =
                (0..m).rev().filter(|&i| values[i] > 1e-13 * scale).take(count).collect();
            let last = if exhausted { 0.0 } else { norm };
            let residual =
                wanted.iter().map(|&i| (last * small[(m - 1, i)] / values[i]).abs()).fold(0.0, f64::max);
            if exhausted || m >= limit || (wanted.len() == count && residual < 1e-13) {
                pairs.residual = residual;
                for &i in &wanted {
                    let mut vector = vec![0.0; n];
                    for (j, v) in vectors.iter().enumerate() {
                        let share = small[(j, i)];
                        vector.iter_mut().zip(v).for_each(|(x, v)| *x += share * v);
                    }
                    pairs.reciprocal.push(values[i]);
                    pairs.vectors.push(vector);
                }
                return Ok(pairs);
            }
        }
        if exhausted {
            return Ok(pairs);
        }
        beta.push(norm);
        w.iter_mut().for_each(|w| *w /= norm);
        weighted.push(aw.iter().map(|a| a / norm).collect());
        vectors.push(w);
        let last = vectors.len() - 1;
        w = apply(&vectors[last]);
        alpha.push(dot(&weighted[last], &w));
    }
}
