//! A band bordered by constraint rows, each of which is local: it spans only a few neighbouring
//! nodes.
//!
//! If a multiplier is numbered directly after the last unknown of its row, the matrix stays a band,
//! which is only widened by the rows at the same place:
//!
//! ```text
//! [ K  Bᵀ ]        x₀ x₁ μ₀ μ₁ x₂ μ₂ μ₃ …
//! [ B  0  ]   →    one band, LU with partial pivoting
//! ```
//!
//! The rows of an inextensible beam of cable elements span two elements and widen the band from 7
//! to 14 diagonals on either side; the cost per cell does not depend on the number of cells.

use super::band::{Band, BandLu, Number};
use super::bordered::BorderRow;
use super::equilibrate::scales;
use super::schur::Numbering;
use super::{Matrix, Singular};

/// Most multiplications for the sign of a determinant: some tenths of a second.
const MOST_WORK: usize = 1_000_000_000;

/// LU of a bordered matrix that is a band in another order, real or complex.
#[derive(Clone, Debug)]
pub struct Interleaved<T = f64> {
    /// Position of each unknown and multiplier in the band.
    place: Vec<usize>,
    /// Scale of each unknown and multiplier.
    scales: Vec<f64>,
    lu: BandLu<T>,
}

/// Number of nodes that the longest row spans.
pub fn reach(border: &[BorderRow]) -> usize {
    let span = |row: &BorderRow| match (row.first(), row.last()) {
        (Some((first, _)), Some((last, _))) => last / 4 - first / 4 + 1,
        _ => 0,
    };
    border.iter().map(span).max().unwrap_or(0)
}

/// Whether all rows are local: each spans at most one node more than the shape functions of a cell.
pub fn fits(matrix: &Matrix, border: &[BorderRow]) -> bool {
    reach(border) <= matrix.columns(0).len() / 4 + 1
}

/// Positions of unknowns and multipliers in the band.
fn places(size: usize, border: &[BorderRow]) -> Vec<usize> {
    let last = |row: &BorderRow| row.last().map_or(0, |(last, _)| *last);
    let mut order: Vec<(usize, usize)> = (0..size).map(|i| (i, i)).collect();
    order.extend(border.iter().enumerate().map(|(r, row)| (last(row), size + r)));
    // A multiplier comes after the unknown; rows with the same last unknown keep their order.
    order.sort_by_key(|(at, index)| (*at, *index));
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(position, (_, index))| place[*index] = position);
    place
}

impl<T: Number> Interleaved<T> {
    /// Factorises the matrix with the pattern of `pattern` and the entries `entry(row, column)`,
    /// bordered by `border`, for which [`fits`] must hold.
    ///
    /// # Errors
    /// [`Singular`] if the bordered matrix is singular.
    pub fn new(
        pattern: &Matrix,
        entry: impl Fn(usize, usize) -> T,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        Self::in_order(places(pattern.size(), border), pattern, entry, border)
    }

    /// As [`Self::new`], with the positions `place` of unknowns and multipliers in the band.
    fn in_order(
        place: Vec<usize>,
        pattern: &Matrix,
        entry: impl Fn(usize, usize) -> T,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        let size = pattern.size();
        let scales = scales(size, |i| entry(i, i).size(), border);
        let apart = |i: usize, j: usize| place[i].abs_diff(place[j]);
        // A band of single rows has corners beyond the blocks of its nodes: with zeros.
        let columns = |i: usize| pattern.columns(i | 3).start..pattern.columns(i & !3).end;
        let of_matrix = (0..size).flat_map(|i| columns(i).map(move |j| (i, j))).map(|(i, j)| apart(i, j));
        let of_rows =
            border.iter().enumerate().flat_map(|(r, row)| row.iter().map(move |(j, _)| (size + r, *j)));
        let half = of_matrix.chain(of_rows.map(|(i, j)| apart(i, j))).max().unwrap_or(0);
        let mut band = Band::<T>::zeros(place.len(), half);
        for i in 0..size {
            let scaled = |j: usize| entry(i, j) * T::from_real(scales[i] * scales[j]);
            columns(i).for_each(|j| band.set(place[i], place[j], scaled(j)));
        }
        for (r, row) in border.iter().enumerate() {
            for &(j, value) in row {
                let value = value * scales[size + r] * scales[j];
                let (mu, j) = (place[size + r], place[j]);
                band.set(mu, j, T::from_real(value));
                band.set(j, mu, T::from_real(value));
            }
        }
        let lu = BandLu::new(&band).map_err(|singular| {
            let row = place.iter().position(|position| *position == singular.row);
            Singular { row: row.unwrap_or(size) }
        })?;
        Ok(Self { place, scales, lu })
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [T]) {
        let mut ordered = b.to_vec();
        let places = || self.place.iter().zip(&self.scales);
        places().zip(&*b).for_each(|((place, scale), value)| ordered[*place] = *value * T::from_real(*scale));
        self.lu.solve(&mut ordered);
        places().zip(b).for_each(|((place, scale), value)| *value = ordered[*place] * T::from_real(*scale));
    }
}

impl Interleaved {
    /// Factorises a matrix that is bordered by rows of any reach, in an order in which unknowns and
    /// multipliers with a common entry are near each other. `None` if it is singular, or if the band
    /// would be so wide that it takes more than [`MOST_WORK`] multiplications, as the row of a tendon
    /// along a fine mesh makes it.
    pub fn of_any_reach(matrix: &Matrix, border: &[BorderRow]) -> Option<Self> {
        let size = matrix.size();
        // The band is at least as wide as the longest row.
        let longest = border.iter().map(Vec::len).max().unwrap_or(0);
        if size * longest * longest > MOST_WORK {
            return None;
        }
        let of_nodes = (0..size).step_by(4).map(|i| (i..matrix.columns(i).end).collect());
        let of_rows = border.iter().enumerate().map(|(r, row)| {
            let unknowns = row.iter().map(|(i, _)| *i);
            unknowns.chain([size + r]).collect()
        });
        let parts: Vec<Vec<usize>> = of_nodes.chain(of_rows).collect();
        let numbering = Numbering::new(size + border.len(), &parts);
        if numbering.work() > MOST_WORK {
            return None;
        }
        Self::in_order(numbering.places(), matrix, |i, j| matrix.get(i, j), border).ok()
    }

    /// Whether the elimination of unknown `i`, or of a multiplier after them, changes the sign of the
    /// determinant.
    pub fn turns_sign(&self, i: usize) -> bool {
        self.lu.turns_sign(self.place[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::bordered::Bordered;
    use faer::c64;

    /// Three nodes, an indefinite K, and rows that overlap.
    fn example() -> (Matrix, Vec<BorderRow>) {
        let mut k = Matrix::zeros(3, 2, true);
        for i in 0..12 {
            for j in k.columns(i) {
                let value = ((3 * i * i + 7 * i * j + 3 * j * j) as f64).sin();
                k.add_at(i.min(j), i.max(j), if i <= j { value } else { 0.0 });
            }
        }
        let row =
            |from: usize, to: usize, f: f64| (from..to).map(|i| (i, (f * (i + 1) as f64).cos())).collect();
        (k, vec![row(0, 8, 1.0), row(0, 8, 2.0), row(4, 12, 3.0), row(5, 12, 0.7)])
    }

    #[test]
    fn it_solves_what_a_sparse_factorisation_solves() {
        let (k, border) = example();
        assert!(fits(&k, &border));
        let mut expected: Vec<f64> = (0..16).map(|i| 1.0 / f64::from(i + 1)).collect();
        let mut found = expected.clone();
        Bordered::new(&k, &border, None).unwrap().solve(&mut expected);
        Interleaved::new(&k, |i, j| k.get(i, j), &border).unwrap().solve(&mut found);
        for (a, b) in expected.iter().zip(&found) {
            assert!((a - b).abs() < 1e-12 * a.abs().max(1.0), "{a} and {b}");
        }
    }

    #[test]
    fn complex_matrices_too() {
        let (k, border) = example();
        let entry = |i: usize, j: usize| c64::new(k.get(i, j), if i == j { 0.3 } else { 0.0 });
        let mut expected: Vec<c64> = (0..16).map(|i| c64::new(1.0, f64::from(i))).collect();
        let mut found = expected.clone();
        Bordered::from_entries(&k, entry, |i| entry(i, i).norm(), &border, None)
            .unwrap()
            .solve(&mut expected);
        Interleaved::new(&k, entry, &border).unwrap().solve(&mut found);
        for (a, b) in expected.iter().zip(&found) {
            assert!((a - b).norm() < 1e-11 * a.norm().max(1.0), "{a} and {b}");
        }
    }

    #[test]
    fn rows_that_depend_on_each_other_are_refused() {
        let (k, mut border) = example();
        border[3] = border[2].clone();
        assert!(Interleaved::new(&k, |i, j| k.get(i, j), &border).is_err());
    }

    #[test]
    fn a_row_across_the_band_does_not_fit() {
        let k = Matrix::zeros(4, 2, true);
        let row = |last: usize| [vec![(0, 1.0), (last, 1.0)]];
        assert_eq!(
            [7, 11, 12].map(|last| (reach(&row(last)), fits(&k, &row(last)))),
            [(2, true), (3, true), (4, false)]
        );
    }
}
