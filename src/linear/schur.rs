//! The Schur complement S = B K⁻¹ Bᵀ of constraint rows, and its LU.
//!
//! An entry of S differs from zero only where two rows touch a common part, such as a beam. Of many
//! rows, as the joints of a frame have them, S is therefore numbered anew so that rows with a common
//! part are neighbours (Cuthill, McKee, *Proc. 24th Nat. Conf. ACM*, 1969, 157–172), and becomes a
//! band. Of few rows, or where the band is no narrower, it is a dense matrix.

use std::collections::VecDeque;

use super::band::{Band, BandLu, Number};
use nalgebra::{ComplexField, DMatrix, DVector, Dyn, LU};

/// New numbers of rows, and how far apart those of rows with a common part are at most.
#[derive(Clone, Debug)]
pub struct Numbering {
    /// The new number of each row.
    new: Vec<usize>,
    /// The largest difference.
    half: usize,
}

impl Numbering {
    /// Of `count` rows, where `parts` holds per part the rows that touch it.
    pub fn new(count: usize, parts: &[Vec<usize>]) -> Self {
        let mut of_row = vec![Vec::new(); count];
        for (part, rows) in parts.iter().enumerate() {
            rows.iter().for_each(|row| of_row[*row].push(part));
        }
        let neighbours = |row: usize| of_row[row].iter().flat_map(|part| &parts[*part]).copied();
        let mut new = vec![usize::MAX; count];
        let mut next = 0;
        for row in 0..count {
            if new[row] != usize::MAX {
                continue;
            }
            // The row that is reached last from any row lies at an end of what is coupled.
            let (mut seen, mut queue, mut end) = (vec![false; count], VecDeque::from([row]), row);
            seen[row] = true;
            while let Some(here) = queue.pop_front() {
                end = here;
                for other in neighbours(here) {
                    if !std::mem::replace(&mut seen[other], true) {
                        queue.push_back(other);
                    }
                }
            }
            let mut queue = VecDeque::from([end]);
            new[end] = next;
            next += 1;
            while let Some(here) = queue.pop_front() {
                for other in neighbours(here) {
                    if new[other] == usize::MAX {
                        new[other] = next;
                        next += 1;
                        queue.push_back(other);
                    }
                }
            }
        }
        let spread = |rows: &Vec<usize>| {
            let numbers = rows.iter().map(|row| new[*row]);
            numbers.clone().max().unwrap_or(0) - numbers.min().unwrap_or(0)
        };
        let half = parts.iter().map(spread).max().unwrap_or(0);
        Self { new, half }
    }

    /// The new number of each row.
    pub fn places(self) -> Vec<usize> {
        self.new
    }

    /// Multiplications of a factorisation.
    pub fn work(&self) -> usize {
        self.new.len() * self.half.min(self.new.len()).pow(2)
    }
}

/// S under assembly.
#[derive(Clone, Debug)]
pub enum Schur<T: ComplexField + Number> {
    /// All entries.
    Dense(DMatrix<T>),
    /// Those of a band in another order.
    Band(Vec<usize>, Band<T>),
}

impl<T: ComplexField + Number> Schur<T> {
    /// A zero matrix of `count` rows, where `parts` holds per part the rows that touch it.
    pub fn zeros(count: usize, parts: &[Vec<usize>]) -> Self {
        let Numbering { new, half } = Numbering::new(count, parts);
        // With the interchanges of its rows, a band of half the width is dense.
        if 3 * half < count {
            Self::Band(new, Band::zeros(count, half))
        } else {
            Self::Dense(DMatrix::zeros(count, count))
        }
    }

    /// Adds to the entry of two rows with a common part.
    pub fn add(&mut self, r: usize, c: usize, value: T) {
        match self {
            Self::Dense(matrix) => matrix[(r, c)] += value,
            Self::Band(new, band) => {
                let (r, c) = (new[r], new[c]);
                band.set(r, c, band.get(r, c) + value);
            }
        }
    }

    /// Its LU; `None` if it is singular.
    pub fn factorise(self) -> Option<SchurLu<T>> {
        match self {
            Self::Dense(matrix) => {
                let lu = matrix.lu();
                lu.is_invertible().then_some(SchurLu::Dense(lu))
            }
            Self::Band(new, band) => Some(SchurLu::Band(new, BandLu::new(&band).ok()?)),
        }
    }
}

/// S, factorised.
#[derive(Clone, Debug)]
pub enum SchurLu<T: ComplexField + Number> {
    /// Of all entries.
    Dense(LU<T, Dyn, Dyn>),
    /// Of a band in another order.
    Band(Vec<usize>, BandLu<T>),
}

impl<T: ComplexField + Number> SchurLu<T> {
    /// Solves S μ = b in place.
    pub fn solve(&self, b: &mut DVector<T>) {
        match self {
            Self::Dense(lu) => {
                lu.solve_mut(b);
            }
            Self::Band(new, lu) => {
                let mut x = vec![T::default(); b.len()];
                new.iter().zip(b.iter()).for_each(|(new, b)| x[*new] = *b);
                lu.solve(&mut x);
                new.iter().zip(b.iter_mut()).for_each(|(new, b)| *b = x[*new]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows at both ends of the beams of a ladder, in an order without sense.
    fn ladder(rungs: usize) -> (usize, Vec<Vec<usize>>) {
        let count = 3 * rungs;
        let mixed = |row: usize| (7 * row + 3) % count;
        let parts = (0..rungs).map(|k| (3 * k..(3 * k + 6).min(count)).map(mixed).collect()).collect();
        (count, parts)
    }

    #[test]
    fn rows_of_a_ladder_become_a_narrow_band() {
        let (count, parts) = ladder(40);
        let Numbering { new, half } = Numbering::new(count, &parts);
        let mut sorted = new.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..count).collect::<Vec<_>>());
        assert!(half <= 9, "{half}");
    }

    #[test]
    fn the_band_solves_what_the_dense_matrix_does() {
        let (count, parts) = ladder(20);
        let mut schur = Schur::zeros(count, &parts);
        assert!(matches!(schur, Schur::Band(..)));
        let mut dense = DMatrix::zeros(count, count);
        for rows in &parts {
            for (k, r) in rows.iter().enumerate() {
                for (l, c) in rows.iter().enumerate() {
                    let value = if k == l { 9.0 } else { 1.0 / (1.0 + (k * l) as f64) };
                    schur.add(*r, *c, value);
                    dense[(*r, *c)] += value;
                }
            }
        }
        let x = DVector::from_fn(count, |i, _| (i as f64).cos());
        let mut b = &dense * &x;
        schur.factorise().expect("regular").solve(&mut b);
        assert!((b - x).amax() < 1e-13);
    }

    #[test]
    fn rows_that_depend_on_each_other_are_singular() {
        let parts = [vec![0, 1]];
        let mut schur = Schur::zeros(2, &parts);
        for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            schur.add(r, c, 1.0);
        }
        assert!(schur.factorise().is_none());
    }
}
