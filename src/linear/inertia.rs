//! Number of directions in which a tangent is negative, among the motions that constraint rows
//! allow.
//!
//! On the motions that m independent rows B allow, K has as many negative eigenvalues as the
//! bordered matrix has beyond m (Sylvester's law of inertia; Gould, *Math. Programming* 32, 1985,
//! 90–99). These eigenvalues are counted by the signs of the pivots in an LDLᵀ without pivoting of
//!
//! ```text
//! [ K + BᵀWB  Bᵀ ]
//! [ B         0  ]
//! ```
//!
//! The positive diagonal W changes nothing on those motions, so that the number is exact for any W.
//! Its purpose is to keep pivots away from zero where only the rows give a stiffness: for beams
//! that are held by nothing but their joints, and along the axis of an inextensible beam. A
//! multiplier is eliminated as soon as all unknowns of its row are. The unknowns are ordered for
//! little fill by faer, which also performs the elimination.

use super::bordered::BorderRow;
use super::symmetric::SMALLEST_PIVOT;
use super::{Matrix, Singular};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Par, Side};

type Entry = Triplet<usize, usize, f64>;

/// Factors of W that are tried until two of them yield the same number. One is not enough: without
/// pivoting, a small pivot may amplify round-off to the size of entries eliminated after it.
const TRIES: [f64; 5] = [1.0, 30.0, 0.03, 7.0, 0.2];
/// Entries of the longest row that has a weight in W: BᵀWB has the square of their number. Longer are
/// only those of tendons along fine meshes.
const LONGEST: usize = 500;

/// Number of negative eigenvalues of the symmetric `k` on the motions that the rows of `border`
/// allow; `None` if `k` is unsymmetric, or if no two eliminations without a vanishing pivot agree.
pub fn negative_directions(k: &Matrix, border: &[BorderRow]) -> Option<usize> {
    if matches!(k, Matrix::General(_)) {
        return None;
    }
    let mut counts = Vec::with_capacity(TRIES.len());
    for factor in TRIES {
        let Some(count) = count(k, border, factor) else { continue };
        if counts.contains(&count) {
            return Some(count);
        }
        counts.push(count);
    }
    None
}

/// The same number from one elimination, with `factor` W; `None` if a pivot vanishes.
fn count(k: &Matrix, border: &[BorderRow], factor: f64) -> Option<usize> {
    let n = k.size();
    let mut entries: Vec<Entry> = Vec::new();
    for i in 0..n {
        let right = k.columns(i).filter(|j| *j >= i).map(|j| Triplet::new(i, j, k.get(i, j)));
        entries.extend(right.filter(|entry| entry.val != 0.0 || entry.row == entry.col));
    }
    for row in border.iter().filter(|row| row.len() <= LONGEST) {
        let weight = factor * weight(k, row);
        for (a, &(i, x)) in row.iter().enumerate() {
            entries.extend(row[a..].iter().map(|&(j, y)| Triplet::new(i, j, weight * x * y)));
        }
    }
    let place = places(n, &entries, border)?;
    for (r, row) in border.iter().enumerate() {
        entries.extend(row.iter().map(|&(i, value)| Triplet::new(i, n + r, value)));
        entries.push(Triplet::new(n + r, n + r, 0.0));
    }
    for entry in &mut entries {
        let (row, col) = (place[entry.row], place[entry.col]);
        (entry.row, entry.col) = (row.min(col), row.max(col));
    }
    let pivots = pivots(place.len(), &entries).ok()?;
    let mut diagonal = vec![0.0; place.len()];
    entries.iter().filter(|entry| entry.row == entry.col).for_each(|entry| diagonal[entry.row] += entry.val);
    let vanishes = |(pivot, diagonal): (&f64, &f64)| pivot.abs() <= SMALLEST_PIVOT * diagonal.abs();
    if pivots.iter().zip(&diagonal).any(vanishes) {
        return None;
    }
    pivots.iter().filter(|pivot| **pivot < 0.0).count().checked_sub(border.len())
}

/// The weight in W that makes a row as stiff as the softest of the nodal pairs of unknowns in it.
/// Pairs are compared, because an inextensible beam has no stiffness along its axis, only across
/// it.
fn weight(k: &Matrix, row: &BorderRow) -> f64 {
    let of_pair = |i: usize| k.get(i & !1, i & !1).abs().max(k.get(i | 1, i | 1).abs());
    let held = row.iter().filter(|(i, value)| *value != 0.0 && of_pair(*i) > 0.0);
    let weight = held.fold(f64::INFINITY, |weight, &(i, value)| weight.min(of_pair(i) / (value * value)));
    if weight.is_finite() { weight } else { 0.0 }
}

/// The position of each unknown and multiplier in the order of elimination.
fn places(n: usize, entries: &[Entry], border: &[BorderRow]) -> Option<Vec<usize>> {
    let pattern = SparseColMat::try_new_from_triplets(n, n, entries).ok()?;
    let (mut order, mut position) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(n, pattern.compute_nnz())).ok()?;
    let control = amd::Control::default();
    amd::order(&mut order, &mut position, pattern.symbolic(), control, MemStack::new(&mut memory)).ok()?;
    let last = |row: &BorderRow| row.iter().map(|(i, _)| position[*i]).max().unwrap_or(0);
    let mut all: Vec<(usize, usize)> = (0..n).map(|i| (position[i], i)).collect();
    all.extend(border.iter().enumerate().map(|(r, row)| (last(row), n + r)));
    all.sort_unstable();
    let mut place = vec![0; all.len()];
    all.iter().enumerate().for_each(|(at, (_, index))| place[*index] = at);
    Some(place)
}

/// The pivots of a symmetric matrix, eliminated row by row in the given order. `upper` holds its
/// upper entries; entries at the same place are summed.
///
/// # Errors
/// [`Singular`] with the row whose pivot is zero.
fn pivots(size: usize, upper: &[Entry]) -> Result<Vec<f64>, Singular> {
    let none = Singular { row: size };
    let matrix = SparseColMat::try_new_from_triplets(size, size, upper).map_err(|_| none)?;
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
        ..CholeskySymbolicParams::default()
    };
    let symbolic =
        factorize_symbolic_cholesky(matrix.symbolic(), Side::Upper, SymmetricOrdering::Identity, parameters)
            .map_err(|_| none)?;
    let mut values = vec![0.0; symbolic.len_val()];
    let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| none)?;
    let (plain, stack) = (LdltRegularization::default(), MemStack::new(&mut memory));
    let (matrix, upper, sequential) = (matrix.as_ref(), Side::Upper, Par::Seq);
    symbolic
        .factorize_numeric_ldlt(&mut values, matrix, upper, plain, sequential, stack, Default::default())
        .map_err(|LdltError::ZeroPivot { index }| Singular { row: index - 1 })?;
    let SymbolicCholeskyRaw::Simplicial(columns) = symbolic.raw() else { return Err(none) };
    // The first value of each column of L is its pivot.
    Ok(columns.col_ptr()[..size].iter().map(|first| values[*first]).collect())
}
