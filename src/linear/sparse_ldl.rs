//! LDLᵀ of a symmetric matrix bordered by constraint rows, such as the tangent of a frame,
//!
//! ```text
//! [ K + BᵀWB  Bᵀ ]
//! [ B         0  ]
//! ```
//!
//! by faer, in an order that fills little. W is a positive diagonal. With f + BᵀW g for the right-hand
//! side f of the unknowns, where g is that of the multipliers, the solution is that for K itself; W keeps
//! pivots away from zero where only the rows give a stiffness: for beams that nothing but their joints
//! hold, and along the axis of an inextensible beam. A multiplier is eliminated as soon as all unknowns
//! of its row are. The order, and where each entry comes to lie, are kept from one matrix to the next
//! of the same pattern.
//!
//! On the motions that m independent rows allow, K has as many negative eigenvalues as this matrix has
//! beyond m (Sylvester's law of inertia; Gould, *Math. Programming* 32, 1985, 90–99): the signs of the
//! pivots tell their number, which is the same for any W.
//!
//! Nothing is interchanged, so that a small pivot may amplify round-off. A factorisation whose
//! solution of some equations does not solve them is therefore refused.

use super::bordered::BorderRow;
use super::symmetric::SMALLEST_PIVOT;
use super::{Matrix, Singular};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{Argsort, Pair, SparseColMat, SparseColMatRef, SymbolicSparseColMat};
use faer::{Par, Side};
use std::sync::Arc;

/// Entries of the longest row that has a weight in W: BᵀWB has the square of their number. Longer are
/// only those of tendons along fine meshes.
const LONGEST: usize = 500;
/// Largest residual, relative to the terms of its row, of a solution that is taken.
const RESIDUAL: f64 = 1e-9;

/// A factorised matrix.
#[derive(Clone, Debug)]
pub struct SparseLdl {
    structure: Arc<Structure>,
    /// L below its diagonal and D on it, column by column.
    values: Vec<f64>,
    /// BᵀW, with which right-hand sides of the unknowns are changed: W, and the rows.
    weights: Vec<f64>,
    border: Vec<BorderRow>,
    factor: f64,
}

/// What depends on the pattern alone.
#[derive(Debug)]
struct Structure {
    /// Blocks of two nodes, the first no later than the second, that are not zero.
    blocks: Vec<[u32; 2]>,
    /// The unknowns of each row.
    rows: Vec<Vec<usize>>,
    /// The position at which each unknown, and then each multiplier, is eliminated.
    place: Vec<usize>,
    /// The upper triangle of what is factorised, in the order of elimination.
    pattern: SymbolicSparseColMat<usize>,
    /// Where the entries come to lie, in the order in which [`entries`] lists them; those at the same place
    /// are summed.
    order: Argsort<usize>,
    /// How many are listed.
    listed: usize,
    symbolic: SymbolicCholesky<usize>,
}

/// Blocks of nodes of `k` that hold an entry other than zero, and all on the diagonal.
fn blocks(k: &Matrix) -> Vec<[u32; 2]> {
    let nodes = k.size() / 4;
    let mut blocks = Vec::with_capacity(2 * nodes);
    for node in 0..nodes {
        let last = k.columns(4 * node).end.div_ceil(4);
        for other in node..last {
            let mut entries = (0..16).map(|e| k.get(4 * node + e / 4, 4 * other + e % 4));
            if node == other || entries.any(|entry| entry != 0.0) {
                blocks.push([node as u32, other as u32]);
            }
        }
    }
    blocks
}

/// Calls `take` with the row, the column and the value of each entry of the upper triangle, in an order that
/// depends on the pattern alone.
fn entries(
    k: &Matrix,
    blocks: &[[u32; 2]],
    border: &[BorderRow],
    weights: &[f64],
    mut take: impl FnMut(usize, usize, f64),
) {
    for &[node, other] in blocks {
        let (first, second) = (4 * node as usize, 4 * other as usize);
        for i in first..first + 4 {
            let from = if node == other { i } else { second };
            (from..second + 4).for_each(|j| take(i, j, k.get(i, j)));
        }
    }
    for (row, weight) in border.iter().zip(weights).filter(|(row, _)| row.len() <= LONGEST) {
        for (a, &(i, x)) in row.iter().enumerate() {
            row[a..].iter().for_each(|&(j, y)| take(i, j, weight * x * y));
        }
    }
    for (r, row) in (k.size()..).zip(border) {
        row.iter().for_each(|&(i, value)| take(i, r, value));
        take(r, r, 0.0);
    }
}

/// The weight in W that makes a row as stiff as the softest of the nodal pairs of unknowns in it. Pairs are
/// compared, because an inextensible beam has no stiffness along its axis, only across it.
fn weight(k: &Matrix, row: &BorderRow) -> f64 {
    let of_pair = |i: usize| k.get(i & !1, i & !1).abs().max(k.get(i | 1, i | 1).abs());
    let held = row.iter().filter(|(i, value)| row.len() <= LONGEST && *value != 0.0 && of_pair(*i) > 0.0);
    let weight = held.fold(f64::INFINITY, |weight, &(i, value)| weight.min(of_pair(i) / (value * value)));
    if weight.is_finite() { weight } else { 0.0 }
}

impl Structure {
    fn new(k: &Matrix, blocks: Vec<[u32; 2]>, border: &[BorderRow]) -> Option<Self> {
        let size = k.size() + border.len();
        let weights = vec![1.0; border.len()];
        let mut pairs = Vec::new();
        entries(k, &blocks, border, &weights, |row, col, _| pairs.push(Pair { row, col }));
        let place = places(k.size(), &pairs, border)?;
        for pair in &mut pairs {
            let (row, col) = (place[pair.row], place[pair.col]);
            (pair.row, pair.col) = (row.min(col), row.max(col));
        }
        let (pattern, order) = SymbolicSparseColMat::try_new_from_indices(size, size, &pairs).ok()?;
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..CholeskySymbolicParams::default()
        };
        let ordering = SymmetricOrdering::Identity;
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Upper, ordering, parameters).ok()?;
        let rows = border.iter().map(|row| row.iter().map(|(i, _)| *i).collect()).collect();
        Some(Self { blocks, rows, place, pattern, order, listed: pairs.len(), symbolic })
    }

    /// Whether it is that of such a matrix.
    fn fits(&self, size: usize, blocks: &[[u32; 2]], border: &[BorderRow]) -> bool {
        let same = |(known, row): (&Vec<usize>, &BorderRow)| known.iter().eq(row.iter().map(|(i, _)| i));
        self.place.len() == size + border.len()
            && self.blocks == blocks
            && self.rows.len() == border.len()
            && self.rows.iter().zip(border).all(same)
    }

    /// The first of the values of each column of L, and the rows that they belong to.
    fn columns(&self) -> Option<(&[usize], &[usize])> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(columns) => Some((columns.col_ptr(), columns.row_idx())),
            SymbolicCholeskyRaw::Supernodal(_) => None,
        }
    }
}

/// The position of each unknown and multiplier in the order of elimination.
fn places(n: usize, upper: &[Pair<usize, usize>], border: &[BorderRow]) -> Option<Vec<usize>> {
    let of_unknowns: Vec<Pair<usize, usize>> = upper.iter().filter(|pair| pair.col < n).copied().collect();
    let (pattern, _) = SymbolicSparseColMat::try_new_from_indices(n, n, &of_unknowns).ok()?;
    let (mut order, mut position) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(n, pattern.compute_nnz())).ok()?;
    let control = amd::Control::default();
    amd::order(&mut order, &mut position, pattern.as_ref(), control, MemStack::new(&mut memory)).ok()?;
    let last = |row: &BorderRow| row.iter().map(|(i, _)| position[*i]).max().unwrap_or(0);
    let mut all: Vec<(usize, usize)> = (0..n).map(|i| (position[i], i)).collect();
    all.extend(border.iter().enumerate().map(|(r, row)| (last(row), n + r)));
    all.sort_unstable();
    let mut place = vec![0; all.len()];
    all.iter().enumerate().for_each(|(at, (_, index))| place[*index] = at);
    Some(place)
}

impl SparseLdl {
    /// Factorises the symmetric `k` bordered by `border`, with `factor` times the usual W, in the order of an
    /// `earlier` factorisation of the same pattern.
    ///
    /// # Errors
    /// [`Singular`] where `k` is unsymmetric, or a pivot vanishes.
    pub fn new(
        earlier: Option<&Self>,
        k: &Matrix,
        border: &[BorderRow],
        factor: f64,
    ) -> Result<Self, Singular> {
        let size = k.size() + border.len();
        let none = Singular { row: size };
        if matches!(k, Matrix::General(_)) {
            return Err(none);
        }
        let blocks = blocks(k);
        let kept = earlier.filter(|earlier| earlier.structure.fits(k.size(), &blocks, border));
        let structure = match kept {
            Some(earlier) => Arc::clone(&earlier.structure),
            None => Arc::new(Structure::new(k, blocks, border).ok_or(none)?),
        };
        let weights: Vec<f64> = border.iter().map(|row| factor * weight(k, row)).collect();
        let (mut listed, mut diagonal) = (Vec::with_capacity(structure.listed), vec![0.0; size]);
        entries(k, &structure.blocks, border, &weights, |row, col, value| {
            listed.push(value);
            if row == col {
                diagonal[structure.place[row]] += value;
            }
        });
        let matrix = SparseColMat::new_from_argsort(structure.pattern.clone(), &structure.order, &listed)
            .map_err(|_| none)?;
        let values = eliminated(&structure, matrix.as_ref()).ok_or(none)??;
        let (first, _) = structure.columns().ok_or(none)?;
        let pivots = first[..size].iter().map(|first| values[*first]);
        if let Some(row) = pivots.zip(&diagonal).position(|(pivot, diagonal)| {
            !(pivot.abs() > SMALLEST_PIVOT * diagonal.abs() && pivot.is_finite())
        }) {
            return Err(Singular { row });
        }
        Ok(Self { structure, values, weights, border: border.to_vec(), factor })
    }

    /// What the usual weights in W were multiplied by.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [f64]) {
        let unknowns = b.len() - self.border.len();
        let (of_unknowns, of_rows) = b.split_at_mut(unknowns);
        for ((row, weight), g) in self.border.iter().zip(&self.weights).zip(of_rows.iter()) {
            row.iter().for_each(|&(i, value)| of_unknowns[i] += weight * value * g);
        }
        let Some((first, rows)) = self.structure.columns() else { return };
        let place = &self.structure.place;
        let mut x = vec![0.0; b.len()];
        place.iter().zip(b.iter()).for_each(|(place, value)| x[*place] = *value);
        for column in 0..x.len() {
            let value = x[column];
            for at in first[column] + 1..first[column + 1] {
                x[rows[at]] -= self.values[at] * value;
            }
        }
        for column in (0..x.len()).rev() {
            let mut value = x[column] / self.values[first[column]];
            for at in first[column] + 1..first[column + 1] {
                value -= self.values[at] * x[rows[at]];
            }
            x[column] = value;
        }
        place.iter().zip(b.iter_mut()).for_each(|(place, value)| *value = x[*place]);
    }

    /// Number of negative eigenvalues on the motions that the rows allow; `None` if there are too few
    /// negative pivots, which round-off has then made.
    pub fn negative_directions(&self) -> Option<usize> {
        let (first, _) = self.structure.columns()?;
        let size = self.structure.place.len();
        let negative = first[..size].iter().filter(|first| self.values[**first] < 0.0).count();
        negative.checked_sub(self.border.len())
    }

    /// Whether it solves equations with `k`: one pivot that is small enough makes it useless.
    pub fn is_sound(&self, k: &Matrix) -> bool {
        let n = k.size();
        // Any right-hand side in which no unknown is like its neighbours.
        let mut x: Vec<f64> = (0..n + self.border.len()).map(|i| 1.0 + (0.7 * i as f64).sin()).collect();
        let b = x.clone();
        self.solve(&mut x);
        let (mut residual, mut terms) = (b.clone(), b.iter().map(|b| b.abs()).collect::<Vec<_>>());
        let mut take = |i: usize, product: f64| {
            residual[i] -= product;
            terms[i] += product.abs();
        };
        for i in 0..n {
            k.columns(i).for_each(|j| take(i, k.get(i, j) * x[j]));
        }
        for (r, row) in (n..).zip(&self.border) {
            for &(j, value) in row {
                take(r, value * x[j]);
                take(j, value * x[r]);
            }
        }
        residual.iter().zip(&terms).all(|(residual, terms)| residual.abs() <= RESIDUAL * terms)
    }
}

/// L and D; `None` where there is no memory for them.
///
/// # Errors
/// [`Singular`] with the row whose pivot is zero.
fn eliminated(
    structure: &Structure,
    matrix: SparseColMatRef<'_, usize, f64>,
) -> Option<Result<Vec<f64>, Singular>> {
    let symbolic = &structure.symbolic;
    let mut values = vec![0.0; symbolic.len_val()];
    let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let (plain, stack) = (LdltRegularization::default(), MemStack::new(&mut memory));
    let (upper, sequential) = (Side::Upper, Par::Seq);
    let done = symbolic
        .factorize_numeric_ldlt(&mut values, matrix, upper, plain, sequential, stack, Default::default())
        .map(drop)
        .map_err(|LdltError::ZeroPivot { index }| Singular { row: index.saturating_sub(1) });
    Some(done.map(|()| values))
}

#[cfg(test)]
mod tests {
    use super::super::Factor;
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// Beams of three nodes, each stiff against differences of neighbours and nothing else, in a ring: the last
    /// node of each is joined to the first of the next, and the first node of the first is held. `soft` is
    /// subtracted from the diagonal.
    fn ring(beams: usize, soft: f64) -> (Matrix, Vec<BorderRow>) {
        let mut k = Matrix::zeros(3 * beams, 2, true);
        for beam in 0..beams {
            for (a, b) in [(3 * beam, 3 * beam + 1), (3 * beam + 1, 3 * beam + 2)] {
                for i in 0..4 {
                    let stiffness = 1.0 + 0.3 * (a + 5 * i) as f64;
                    let (p, q) = (4 * a + i, 4 * b + i);
                    k.set(p, p, k.get(p, p) + stiffness);
                    k.set(q, q, k.get(q, q) + stiffness);
                    k.set(p, q, -stiffness);
                }
            }
        }
        (0..12 * beams).for_each(|i| k.set(i, i, k.get(i, i) - soft));
        let mut border: Vec<BorderRow> = (0..4).map(|i| vec![(i, 1.0)]).collect();
        for beam in 0..beams - 1 {
            let (end, start) = (4 * (3 * beam + 2), 4 * (3 * beam + 3));
            border.extend((0..4).map(|i| vec![(end + i, 1.5), (start + i, -1.5)]));
        }
        border.push(vec![(0, 1.0), (12 * beams - 3, -2.0)]);
        (k, border)
    }

    fn dense(k: &Matrix, border: &[BorderRow]) -> DMatrix<f64> {
        let n = k.size();
        let mut all = DMatrix::zeros(n + border.len(), n + border.len());
        for i in 0..n {
            k.columns(i).for_each(|j| all[(i, j)] = k.get(i, j));
        }
        for (r, row) in (n..).zip(border) {
            for &(j, value) in row {
                (all[(r, j)], all[(j, r)]) = (value, value);
            }
        }
        all
    }

    fn right_hand_side(size: usize) -> Vec<f64> {
        (0..size).map(|i| (1.3 * i as f64).cos()).collect()
    }

    /// Beams that only joints hold, by another code's elimination with pivoting; the number of negative
    /// directions by the eigenvalues on the motions that the rows allow.
    #[test]
    fn joined_beams_are_solved_and_their_negative_directions_counted() {
        let mut seen = Vec::new();
        for soft in [0.0, 0.05, 0.8, 5.0] {
            let (k, border) = ring(4, soft);
            let (n, whole) = (k.size(), dense(&k, &border));
            // A weight as large as a negative diagonal entry cancels it.
            let ldl = SparseLdl::new(None, &k, &border, if soft > 1.0 { 30.0 } else { 1.0 });
            let ldl = ldl.expect("no vanishing pivot");
            assert!(ldl.is_sound(&k), "{soft}");
            let mut found = right_hand_side(whole.nrows());
            ldl.solve(&mut found);
            let b = DVector::from_vec(right_hand_side(whole.nrows()));
            let expected = whole.clone().lu().solve(&b).expect("no singular matrix");
            let error = (DVector::from_vec(found) - &expected).amax();
            assert!(error < 1e-10 * expected.amax(), "{soft}: {error}");
            let rows = whole.view((n, 0), (border.len(), n)).into_owned();
            let of_rows = (rows.transpose() * &rows).symmetric_eigen();
            let free: Vec<usize> = (0..n).filter(|i| of_rows.eigenvalues[*i] < 1e-9).collect();
            assert_eq!(free.len(), n - border.len());
            let motions = of_rows.eigenvectors.select_columns(&free);
            let reduced = motions.transpose() * whole.view((0, 0), (n, n)) * &motions;
            let expected = reduced.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count();
            assert_eq!(ldl.negative_directions(), Some(expected), "{soft}");
            let factor = Factor::new(&k, &border).expect("no singular matrix");
            assert!(matches!(factor, Factor::SparseLdl(_)));
            assert_eq!(factor.negative_directions(&k, &border), Some(expected), "{soft}");
            seen.push(expected);
        }
        assert!(seen[0] == 0 && seen[1] < seen[2] && seen[2] < seen[3], "{seen:?}");
    }

    /// The order is kept for other numbers, and not for another pattern: of rows, or where an entry is no longer zero.
    #[test]
    fn the_order_is_kept_while_the_pattern_is_the_same() {
        let (k, border) = ring(3, 0.0);
        let first = SparseLdl::new(None, &k, &border, 1.0).expect("no vanishing pivot");
        let of = |k: &Matrix, border: &[BorderRow]| {
            let again = SparseLdl::new(Some(&first), k, border, 1.0).expect("no vanishing pivot");
            let size = k.size() + border.len();
            let (mut found, b) = (right_hand_side(size), DVector::from_vec(right_hand_side(size)));
            again.solve(&mut found);
            let expected = dense(k, border).lu().solve(&b).expect("no singular matrix");
            assert!((DVector::from_vec(found) - &expected).amax() < 1e-10 * expected.amax());
            Arc::ptr_eq(&again.structure, &first.structure)
        };
        assert!(of(&ring(3, -0.5).0, &border));
        assert!(!of(&k, &border[..border.len() - 1]));
        let mut other = border.clone();
        other[0][0].0 = 9;
        assert!(!of(&k, &other));
        let mut coupled = k.clone();
        coupled.set(8, 12, 0.1);
        assert!(!of(&coupled, &border));
    }

    /// A pivot of 1e-14 beside entries of size one: eliminated first it leaves nothing of the others' digits, so that
    /// an elimination with pivoting takes its place.
    #[test]
    fn a_factorisation_that_has_lost_its_digits_is_refused() {
        let (mut k, border) = ring(3, 0.0);
        for (i, j, value) in [
            (20, 20, 1e-14),
            (20, 21, 1.0),
            (21, 21, 0.0),
            (16, 20, 0.0),
            (20, 24, 0.0),
            (17, 21, 0.0),
            (21, 25, 0.0),
        ] {
            if k.columns(i).contains(&j) {
                k.set(i, j, value);
            }
        }
        let refused = SparseLdl::new(None, &k, &border, 1.0).map_or(true, |ldl| !ldl.is_sound(&k));
        assert!(refused);
        let whole = dense(&k, &border);
        let mut found = right_hand_side(whole.nrows());
        Factor::new(&k, &border).expect("no singular matrix").solve(&mut found);
        let expected = whole
            .clone()
            .lu()
            .solve(&DVector::from_vec(right_hand_side(whole.nrows())))
            .expect("no singular matrix");
        assert!((DVector::from_vec(found) - &expected).amax() < 1e-9 * expected.amax());
    }

    #[test]
    fn unsymmetric_and_singular_matrices_are_refused() {
        let (k, border) = ring(3, 0.0);
        assert!(SparseLdl::new(None, &Matrix::zeros(9, 2, false), &border, 1.0).is_err());
        let twice: Vec<BorderRow> = border.iter().chain(&border[..1]).cloned().collect();
        assert!(SparseLdl::new(None, &k, &twice, 1.0).map_or(true, |ldl| !ldl.is_sound(&k)));
        assert!(
            SparseLdl::new(None, &k, &border[4..], 1.0).map_or(true, |ldl| !ldl.is_sound(&k)),
            "it floats"
        );
    }
}
