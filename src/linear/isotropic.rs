//! A symmetric band that treats x and y equally and does not couple them: c ⊗ 1₂, like a mass
//! matrix.
//!
//! Of the sixteen numbers of a block for a pair of nodes only four differ: the products of the two
//! nodes' shape functions of position and slope. A product of this matrix with a vector takes a
//! fifth of the instructions that [`super::symmetric`] needs, and a quarter of the memory traffic.

use super::Matrix;
use super::symmetric::SymmetricBand;
use crate::lanes::{self, Lanes};
use crate::threads;

/// The upper half of a band c ⊗ 1₂.
#[derive(Clone, Debug)]
pub struct IsotropicBand {
    nodes: usize,
    /// Number of blocks in a row, the diagonal one included.
    blocks: usize,
    /// Per node, per block from the diagonal on:
    /// \[position–position, position–slope, slope–position, slope–slope\].
    data: Vec<[f64; 4]>,
}

impl IsotropicBand {
    /// `matrix` in this form; `None` if it couples x and y or treats them differently.
    pub fn new(matrix: &SymmetricBand) -> Option<Self> {
        let (nodes, blocks) = (matrix.size() / 4, matrix.stride() / 4);
        let mut data = vec![[0.0; 4]; nodes * blocks];
        for (k, block) in data.iter_mut().enumerate() {
            let (row, column) = (4 * (k / blocks), 4 * (k / blocks + k % blocks));
            for (place, value) in block.iter_mut().enumerate() {
                let (i, j) = (row + 2 * (place / 2), column + 2 * (place % 2));
                *value = matrix.get(i, j);
                if matrix.get(i + 1, j + 1) != *value
                    || matrix.get(i, j + 1) != 0.0
                    || matrix.get(i + 1, j) != 0.0
                {
                    return None;
                }
            }
        }
        Some(Self { nodes, blocks, data })
    }

    /// The matrix with all of its entries.
    pub fn to_symmetric(&self) -> SymmetricBand {
        let mut matrix = SymmetricBand::zeros(self.nodes, self.blocks);
        for (k, block) in self.data.iter().enumerate() {
            let (row, column) = (4 * (k / self.blocks), 4 * (k / self.blocks + k % self.blocks));
            if column >= matrix.size() {
                // The rows of the last nodes are stored with full length, too.
                continue;
            }
            for (place, value) in block.iter().enumerate() {
                for d in 0..2 {
                    matrix.set(row + 2 * (place / 2) + d, column + 2 * (place % 2) + d, *value);
                }
            }
        }
        matrix
    }

    /// `y += factor · A x`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let x = x.as_chunks::<4>().0;
        self.multiply_add_seen(factor, |node| x[node], (0, y.as_chunks_mut().0), |_| ());
    }

    /// The rows of the same product that belong to the nodes of y from number `first` on, with x given
    /// node by node. `see` is called for each node with the entries of y before the addition.
    #[inline(always)]
    pub fn multiply_add_seen(
        &self,
        factor: f64,
        x: impl Fn(usize) -> [f64; 4],
        (first, y): (usize, &mut [[f64; 4]]),
        see: impl FnMut([f64; 4]),
    ) {
        match self.blocks {
            2 => self.add_rows::<2>(factor, x, (first, y), see),
            4 => self.add_rows::<4>(factor, x, (first, y), see),
            6 => self.add_rows::<6>(factor, x, (first, y), see),
            _ => self.add_rows_any(factor, x, (first, y), see),
        }
    }

    /// `y += A x` for four vectors side by side.
    pub fn multiply_add_lanes(&self, x: &[Lanes], y: &mut [Lanes]) {
        let (x, y) = (x.as_chunks::<4>().0, y.as_chunks_mut::<4>().0);
        for (node, row) in self.data.chunks_exact(self.blocks).enumerate() {
            let [a, b, c, d] = row[0].map(Lanes::splat);
            let mut sums = add_block([a, b, c, d], &x[node], &y[node]);
            for (ahead, block) in row[1..].iter().enumerate().take(self.nodes - 1 - node) {
                let [a, b, c, d] = block.map(Lanes::splat);
                let other = node + 1 + ahead;
                sums = add_block([a, b, c, d], &x[other], &sums);
                y[other] = add_block([a, c, b, d], &x[node], &y[other]);
            }
            y[node] = sums;
        }
    }

    /// Keeps in registers the part of x that a row needs, and the contributions of earlier rows to
    /// later ones.
    #[inline(always)]
    fn add_rows<const BLOCKS: usize>(
        &self,
        factor: f64,
        x: impl Fn(usize) -> [f64; 4],
        (first, y): (usize, &mut [[f64; 4]]),
        mut see: impl FnMut([f64; 4]),
    ) {
        let (nodes, factor) = (self.nodes, Lanes::splat(factor));
        let at = |node| if node < nodes { halves(x(node)) } else { [Lanes::ZERO; 2] };
        let rows = self.data.as_chunks::<BLOCKS>().0;
        // What the rows before the first contribute.
        let from = first.saturating_sub(BLOCKS - 1);
        let mut window: [_; BLOCKS] = std::array::from_fn(|ahead| at(from + ahead));
        let mut left = [Lanes::ZERO; BLOCKS];
        for (node, row) in (from..).zip(&rows[from..first]) {
            contribute(row, window[0], &mut left);
            slide(&mut window, at(node + BLOCKS));
        }
        for (node, (row, y)) in (first..).zip(rows[first..].iter().zip(y)) {
            see(*y);
            let mut sum = product(row[0], window[0], left[0]);
            for b in 1..BLOCKS {
                sum = product(row[b], window[b], sum);
            }
            contribute(row, window[0], &mut left);
            *y = sum.mul_add(factor, Lanes::new(*y)).to_array();
            slide(&mut window, at(node + BLOCKS));
        }
    }

    fn add_rows_any(
        &self,
        factor: f64,
        x: impl Fn(usize) -> [f64; 4],
        (first, y): (usize, &mut [[f64; 4]]),
        mut see: impl FnMut([f64; 4]),
    ) {
        let block = |row: usize, ahead: usize| self.data[row * self.blocks + ahead];
        for (node, y) in (first..).zip(y) {
            see(*y);
            let mut sum = product(block(node, 0), halves(x(node)), Lanes::ZERO);
            for ahead in 1..self.blocks {
                if node + ahead < self.nodes {
                    sum = product(block(node, ahead), halves(x(node + ahead)), sum);
                }
                if let Some(before) = node.checked_sub(ahead) {
                    sum = product(transpose(block(before, ahead)), halves(x(before)), sum);
                }
            }
            *y = sum.mul_add(Lanes::splat(factor), Lanes::new(*y)).to_array();
        }
    }
}

/// What a row adds to later ones, in turn: `left` holds what those before it have added.
#[inline(always)]
fn contribute<const BLOCKS: usize>(row: &[[f64; 4]; BLOCKS], x: [Lanes; 2], left: &mut [Lanes; BLOCKS]) {
    for b in 1..BLOCKS {
        let before = if b + 1 < BLOCKS { left[b] } else { Lanes::ZERO };
        left[b - 1] = product(transpose(row[b]), x, before);
    }
}

/// Drops the first and appends the `next`.
#[inline(always)]
fn slide<const BLOCKS: usize>(window: &mut [[Lanes; 2]; BLOCKS], next: [Lanes; 2]) {
    for b in 1..BLOCKS {
        window[b - 1] = window[b];
    }
    window[BLOCKS - 1] = next;
}

fn transpose([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, c, b, d]
}

/// `sum` plus a block times the coefficients of a node, in four states at once.
#[inline(always)]
fn add_block([a, b, c, d]: [Lanes; 4], x: &[Lanes; 4], sum: &[Lanes; 4]) -> [Lanes; 4] {
    [
        b.mul_add(x[2], a.mul_add(x[0], sum[0])),
        b.mul_add(x[3], a.mul_add(x[1], sum[1])),
        d.mul_add(x[2], c.mul_add(x[0], sum[2])),
        d.mul_add(x[3], c.mul_add(x[1], sum[3])),
    ]
}

/// The first two numbers twice, and the last two numbers twice.
#[inline(always)]
fn halves([x, y, along, across]: [f64; 4]) -> [Lanes; 2] {
    [Lanes::new([x, y, x, y]), Lanes::new([along, across, along, across])]
}

/// `sum` plus a block times the coefficients of a node.
#[inline(always)]
fn product([a, b, c, d]: [f64; 4], [low, high]: [Lanes; 2], sum: Lanes) -> Lanes {
    Lanes::new([b, b, d, d]).mul_add(high, Lanes::new([a, a, c, c]).mul_add(low, sum))
}

/// The constant mass matrix.
#[derive(Clone, Debug)]
pub enum Inertia {
    /// A matrix that treats x and y equally and does not couple them, as that of every effect in
    /// this crate does.
    Isotropic(IsotropicBand),
    /// Any other.
    Any(Matrix),
}

impl Inertia {
    /// `matrix`, in the isotropic form if possible.
    pub fn new(matrix: Matrix) -> Self {
        let isotropic = if let Matrix::Symmetric(band) = &matrix { IsotropicBand::new(band) } else { None };
        isotropic.map_or(Self::Any(matrix), Self::Isotropic)
    }

    /// The matrix in the general form.
    pub fn to_matrix(&self) -> Matrix {
        match self {
            Self::Isotropic(band) => Matrix::Symmetric(band.to_symmetric()),
            Self::Any(matrix) => matrix.clone(),
        }
    }

    /// `y += factor · M x`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Isotropic(band) => band.multiply_add(factor, x, y),
            Self::Any(matrix) => matrix.multiply_add(factor, x, y),
        }
    }

    /// `y += M x` with x given node by node. Returns what `see` makes of the entries of y before the
    /// addition, node by node from `begin` on, merged where several threads have seen a part each.
    #[inline(always)]
    pub fn multiply_add_seen<S: Copy + Send + Sync>(
        &self,
        x: impl Fn(usize) -> [f64; 4] + Sync,
        y: &mut [f64],
        begin: S,
        see: impl Fn(&mut S, [f64; 4]) + Sync,
        merge: impl Fn(S, S) -> S + Sync,
    ) -> S {
        match self {
            Self::Isotropic(band) => threads::over(
                [y.as_chunks_mut::<4>().0],
                &|range, [y]| {
                    let mut seen = begin;
                    band.multiply_add_seen(1.0, &x, (range.start, y), |y| see(&mut seen, y));
                    seen
                },
                &merge,
            ),
            Self::Any(matrix) => {
                let mut seen = begin;
                y.as_chunks::<4>().0.iter().for_each(|y| see(&mut seen, *y));
                let x: Vec<f64> = (0..y.len() / 4).flat_map(x).collect();
                matrix.multiply_add(1.0, &x, y);
                seen
            }
        }
    }

    /// `y += M x` for four vectors side by side; `scratch` holds two vectors of the same length.
    pub fn multiply_add_lanes(&self, x: &[Lanes], y: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        match self {
            Self::Isotropic(band) => band.multiply_add_lanes(x, y),
            Self::Any(matrix) => {
                lanes::one_by_one(x, y, scratch, |_, x, y| matrix.multiply_add(1.0, x, y));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(blocks: usize) -> SymmetricBand {
        let mut matrix = SymmetricBand::zeros(7, blocks);
        for i in 0..28_usize {
            for j in matrix.columns(i).filter(|j| *j >= i && (i + j) % 2 == 0) {
                let (a, b) = (i / 2, j / 2);
                matrix.set(i, j, 1.0 / (1.0 + (a + b) as f64) + ((3 * a + 5 * b) % 7) as f64);
            }
        }
        matrix
    }

    #[test]
    fn products_are_those_of_the_whole_matrix() {
        for blocks in [1, 2, 4, 6] {
            let matrix = matrix(blocks);
            let band = IsotropicBand::new(&matrix).expect("isotropic");
            let x: Vec<f64> = (0..28).map(|i| f64::from(i * i % 11) - 3.0).collect();
            let (mut y, mut expected) = (vec![0.25; 28], vec![0.25; 28]);
            let mut seen = Vec::new();
            let nodes = (0, y.as_chunks_mut().0);
            band.multiply_add_seen(-0.5, |node| x.as_chunks().0[node], nodes, |before| seen.push(before));
            assert_eq!(seen, [[0.25; 4]; 7]);
            matrix.multiply_add(-0.5, &x, &mut expected);
            for (y, expected) in y.iter().zip(&expected) {
                assert!((y - expected).abs() <= 1e-13 * expected.abs().max(1.0), "{y} {expected}");
            }
            let whole = band.to_symmetric();
            assert!((0..28).all(|i| (0..28).all(|j| whole.get(i, j) == matrix.get(i, j))));
        }
    }

    #[test]
    fn other_matrices_stay_what_they_are() {
        for (i, j) in [(4, 5), (4, 9), (5, 5), (6, 11)] {
            let mut matrix = matrix(2);
            matrix.set(i, j, 77.0);
            assert!(IsotropicBand::new(&matrix).is_none());
            let inertia = Inertia::new(Matrix::Symmetric(matrix));
            let mut y = vec![0.0; 28];
            let mut x = vec![0.0; 28];
            x[i] = 1.0;
            inertia.multiply_add(1.0, &x, &mut y);
            assert_eq!(y[j], 77.0);
            assert_eq!(inertia.to_matrix().get(j, i), 77.0);
        }
    }
}
