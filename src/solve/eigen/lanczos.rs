//! Lanczos' method for the operator A⁻¹ B in the inner product of A, with full reorthogonalisation.
//!
//! One factorisation of A serves all steps. A Krylov space holds one vector of every eigenspace, so
//! that of equal frequencies (of two equal beams, or of the rigid motions of a free one) it finds
//! only one mode. Converged pairs are therefore set aside, and the search is repeated orthogonally
//! to them until it finds nothing larger.
//!
//! The constraint rows hold for A⁻¹ B v. But where orthogonalisation removes most of this vector,
//! round-off in the rows is a larger share of the rest, and grows from vector to vector until it
//! passes for a solution. It is therefore removed from every vector (Nour-Omid, Parlett, Ericsson,
//! Jensen, *Mathematics of Computation* 48, 1987, 663–673).
//!
//! faer's Krylov–Schur iteration works in the Euclidean inner product alone, in which A⁻¹ B is not
//! symmetric, and constraint rows leave no Cholesky factor that would make it so.

use super::{EigenError, NEGLIGIBLE, Pairs, Pencil, dot};
use crate::linear::{Factor, Matrix};
use crate::numeric::GOLDEN;
use faer::Side;

/// A search may keep twice as many vectors as pairs are wanted, and this many more.
const EXTRA_VECTORS: usize = 120;
/// Residual relative to 1/θ at which a pair counts as found; its eigenvalue errs by the square of
/// this.
const TOLERANCE: f64 = 1e-12;
/// That of a pair which only keeps the wanted ones apart from the rest.
const TOLERANCE_OF_GUARDS: f64 = 1e-6;
/// That at which a pair of a later search is known well enough to be told from a larger one.
const TOLERANCE_OF_SMALLER: f64 = 1e-3;
/// A pair found later counts as larger only beyond this fraction.
const LARGER: f64 = 1e-9;
/// Size of a new vector, relative to the operator, at which the Krylov space is exhausted.
const EXHAUSTED: f64 = 1e-14;

/// The `count` largest positive 1/θ, fewer where there are not so many, and `guards` more, which are less accurate.
///
/// # Errors
/// [`EigenError`] where A is singular or indefinite on the allowed motions, or the iteration fails.
pub fn largest_reciprocals(pencil: &Pencil<'_>, wanted: usize, guards: usize) -> Result<Pairs, EigenError> {
    let count = wanted + guards;
    if wanted == 0 {
        return Ok(Pairs::default());
    }
    let factor = Factor::new(pencil.a, pencil.border)?;
    if let Some(count) = factor.negative_directions(pencil.a, pencil.border).filter(|count| *count > 0) {
        return Err(EigenError::Unstable { count });
    }
    let mut search = Search { pencil, factor, wanted, found: Vec::new(), searches: 0 };
    loop {
        let missing = count.saturating_sub(search.found.len()).max(1);
        // The last one that is wanted, if there are enough.
        let bound = search.found.get(count - 1).map_or(0.0, |pair| pair.reciprocal);
        let new = search.krylov(missing, bound)?;
        let ends = !new.iter().any(|pair| pair.reciprocal > bound * (1.0 + LARGER));
        search.found.extend(new);
        search.found.sort_by(|a, b| b.reciprocal.total_cmp(&a.reciprocal));
        if ends {
            break;
        }
    }
    let mut pairs = Pairs::default();
    for pair in search.found.into_iter().take(count) {
        pairs.reciprocals.push(pair.reciprocal);
        pairs.vectors.push(pair.vector);
    }
    Ok(pairs)
}

/// 1/θ and φ, and A φ.
struct Pair {
    reciprocal: f64,
    vector: Vec<f64>,
    weighted: Vec<f64>,
}

struct Search<'a> {
    pencil: &'a Pencil<'a>,
    factor: Factor,
    /// Pairs that are wanted; those found beyond them are less accurate.
    wanted: usize,
    /// Converged pairs, the largest first.
    found: Vec<Pair>,
    searches: usize,
}

impl Search<'_> {
    /// A⁻¹ B v.
    fn apply(&self, v: &[f64]) -> Vec<f64> {
        let n = self.pencil.a.size();
        let mut w = vec![0.0; n + self.pencil.border.len()];
        self.pencil.b.multiply_add(1.0, v, &mut w[..n]);
        self.factor.solve(&mut w);
        w.truncate(n);
        w
    }

    /// Adds to `w` the smallest change in A's norm with which it satisfies the constraint rows.
    fn purify(&self, w: &mut [f64]) {
        let (n, border) = (self.pencil.a.size(), self.pencil.border);
        if border.is_empty() {
            return;
        }
        let violations = border.iter().map(|row| -row.iter().map(|(i, entry)| entry * w[*i]).sum::<f64>());
        let mut change: Vec<f64> = std::iter::repeat_n(0.0, n).chain(violations).collect();
        self.factor.solve(&mut change);
        w.iter_mut().zip(&change).for_each(|(w, change)| *w += change);
    }

    /// The largest pairs orthogonal to those found, up to `count`; empty if there are none, or none larger than `bound`.
    fn krylov(&mut self, count: usize, bound: f64) -> Result<Vec<Pair>, EigenError> {
        let n = self.pencil.a.size();
        // A start with a share of every mode: low-discrepancy numbers, different in every search
        // but the same in every run.
        self.searches += 1;
        let shift = self.searches as f64 * 0.754_877_666_246_693;
        let seed: Vec<f64> = (1..=n).map(|i| (i as f64).mul_add(GOLDEN, shift).fract() - 0.5).collect();
        let mut w = self.apply(&seed);
        // The operator's size, as far as it is known.
        let start = size_of(self.pencil.a, &w);
        let largest = self.found.first().map_or(0.0, |pair| pair.reciprocal);
        let (mut vectors, mut weighted): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        let limit = self.pencil.motions().min(2 * count + EXTRA_VECTORS);
        let mut next_look = count + 5;
        loop {
            let known = self.found.iter().map(|pair| (&pair.vector, &pair.weighted));
            let known = known.chain(vectors.iter().zip(&weighted));
            // Twice is enough (Kahan, Parlett).
            orthogonalize(&mut w, known.clone());
            self.purify(&mut w);
            orthogonalize(&mut w, known);
            let mut aw = times(self.pencil.a, &w);
            let square = dot(&w, &aw);
            let m = vectors.len();
            if m == 0 && square < 0.0 {
                // The signs of the pivots are those of round-off: a motion is softer than that.
                return Err(EigenError::Unstable { count: 1 });
            }
            let norm = square.max(0.0).sqrt();
            let off_diagonal = beta.iter().skip(1);
            let size = match m {
                0 => start,
                _ => alpha.iter().chain(off_diagonal).fold(largest, |size, a: &f64| size.max(a.abs())),
            };
            let exhausted = norm.is_nan() || norm <= EXHAUSTED * size;
            if m > 0 && (exhausted || m >= limit || m >= next_look) {
                next_look = m + (m / 6).max(5);
                let tridiagonal = faer::Mat::<f64>::from_fn(m, m, |i, j| match i.abs_diff(j) {
                    0 => alpha[i],
                    1 => beta[i.max(j)],
                    _ => 0.0,
                });
                let eigen =
                    tridiagonal.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::Projection)?;
                let (values, small) = (eigen.S().column_vector(), eigen.U());
                let last = if exhausted { 0.0 } else { norm };
                let candidates: Vec<usize> =
                    (0..m).rev().filter(|&i| values[i] > NEGLIGIBLE * size).take(count).collect();
                let residual = |i: usize| (last * small[(m - 1, i)]).abs();
                // In a later search as well: what it finds may be among the wanted ones of all.
                let accurate = self.wanted;
                let converged = |(number, i): &(usize, &usize)| {
                    let tolerance = if *number < accurate { TOLERANCE } else { TOLERANCE_OF_GUARDS };
                    residual(**i) <= tolerance * values[**i].abs()
                };
                let found = candidates.iter().enumerate().take_while(converged).count();
                let is_smaller = |i: &usize| {
                    let (value, residual) = (values[*i], residual(*i));
                    residual <= TOLERANCE_OF_SMALLER * value && value + residual <= bound
                };
                if candidates.first().is_some_and(is_smaller) {
                    return Ok(Vec::new());
                }
                if exhausted || m >= limit || found == count {
                    if found == 0 && !candidates.is_empty() {
                        let next = candidates.first().map_or(0.0, |i| values[*i] + residual(*i));
                        let largest = self.found.iter().map(|pair| pair.reciprocal).fold(next, f64::max);
                        return Err(EigenError::NotConverged {
                            found: self.found.len(),
                            wanted: count,
                            largest,
                        });
                    }
                    let pair = |&i: &usize| {
                        let combine = |basis: &[Vec<f64>]| {
                            let mut sum = vec![0.0; n];
                            for (j, v) in basis.iter().enumerate() {
                                let share = small[(j, i)];
                                sum.iter_mut().zip(v).for_each(|(x, v)| *x += share * v);
                            }
                            sum
                        };
                        Pair {
                            reciprocal: values[i],
                            vector: combine(&vectors),
                            weighted: combine(&weighted),
                        }
                    };
                    return Ok(candidates[..found].iter().map(pair).collect());
                }
            }
            if exhausted {
                return Ok(Vec::new());
            }
            beta.push(norm);
            w.iter_mut().for_each(|w| *w /= norm);
            aw.iter_mut().for_each(|a| *a /= norm);
            let next = self.apply(&w);
            alpha.push(dot(&aw, &next));
            vectors.push(std::mem::replace(&mut w, next));
            weighted.push(aw);
        }
    }
}

/// Takes the shares of A-orthonormal vectors out of `w`.
fn orthogonalize<'v>(w: &mut [f64], basis: impl Iterator<Item = (&'v Vec<f64>, &'v Vec<f64>)>) {
    for (v, av) in basis {
        let share = dot(av, w);
        w.iter_mut().zip(v).for_each(|(w, v)| *w -= share * v);
    }
}

fn times(a: &Matrix, v: &[f64]) -> Vec<f64> {
    let mut w = vec![0.0; v.len()];
    a.multiply_add(1.0, v, &mut w);
    w
}

fn size_of(a: &Matrix, v: &[f64]) -> f64 {
    dot(v, &times(a, v)).max(0.0).sqrt()
}
