//! Symmetric band of 4 × 4 blocks and its factorisation A = L D Lᵀ.
//!
//! Block row I is kept as a panel of four rows, each holding the columns of nodes I, I + 1, …, I + b contiguously
//! (b + 1 blocks, 4(b + 1) numbers). Within the diagonal block the entries left of the diagonal are carried along but
//! never read. Elimination works panel by panel: a panel is reduced by its own four pivots, and each row of a later
//! panel then takes the four eliminated rows in one fused pass, 4 multiply–adds per number loaded and stored.
//!
//! Cost per node: 4·4·(b + 1) + 16·(b)(b + 1)/2 · 4 multiply–adds, 112 for the cable element (b = 1) and 1 056 for
//! six-node supports (b = 5); a pivoted LU of the same band takes 3.5 to 4 times as many. Another 40 b give the blocks W of [`Ldl`], which are
//! worth it: a substitution from pivot to pivot waits eight times a node for the result before. With blocks a step of the trapezoidal rule (30 cable
//! elements) takes a fifth less time, one of Radau's method (20 nodes, six-node supports) a twelfth.

use super::Singular;
use super::band::Band;
use super::fma::fma;
use crate::lanes::Lanes;

/// Upper half of a symmetric matrix, banded by blocks.
#[derive(Clone, Debug)]
pub struct SymmetricBand {
    nodes: usize,
    /// Blocks in a panel, the diagonal one included.
    blocks: usize,
    data: Vec<f64>,
}

impl SymmetricBand {
    /// A zero matrix for `nodes` nodes whose supports span `blocks` nodes.
    pub fn zeros(nodes: usize, blocks: usize) -> Self {
        let blocks = blocks.clamp(1, nodes.max(1));
        Self { nodes, blocks, data: vec![0.0; nodes * 16 * blocks] }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        4 * self.nodes
    }

    /// Bytes of the entries.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.data[..])
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.data.fill(0.0);
    }

    /// Four rows of node `node`, from its own columns on; each row has [`Self::stride`] numbers.
    #[inline]
    pub fn panel_mut(&mut self, node: usize) -> &mut [f64] {
        let length = 16 * self.blocks;
        &mut self.data[node * length..(node + 1) * length]
    }

    /// All entries, panel after panel.
    pub(super) fn data(&self) -> &[f64] {
        &self.data
    }

    /// Numbers in a row of a panel.
    #[inline]
    pub fn stride(&self) -> usize {
        4 * self.blocks
    }

    /// Adds `factor` times another matrix of the same pattern.
    pub fn add(&mut self, factor: f64, other: &Self) {
        debug_assert_eq!(self.data.len(), other.data.len());
        for (a, b) in self.data.iter_mut().zip(&other.data) {
            *a = fma(factor, *b, *a);
        }
    }

    fn index(&self, i: usize, j: usize) -> Option<usize> {
        let (i, j) = if i <= j { (i, j) } else { (j, i) };
        let column = j - 4 * (i / 4);
        (column < self.stride() && j < self.size()).then(|| i * self.stride() + column)
    }

    /// The entry in row `i`, column `j`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.index(i, j).map_or(0.0, |k| self.data[k])
    }

    /// Sets the entries (i, j) and (j, i), which must lie in the band.
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        if let Some(k) = self.index(i, j) {
            self.data[k] = value;
        }
    }

    /// Columns that can be different from zero in row `i`.
    pub fn columns(&self, i: usize) -> std::ops::Range<usize> {
        let node = i / 4;
        4 * node.saturating_sub(self.blocks - 1)..(4 * (node + self.blocks)).min(self.size())
    }

    /// `y += factor · A x`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        match self.blocks {
            2 => self.multiply_add_window::<8>(factor, x, y),
            4 => self.multiply_add_window::<16>(factor, x, y),
            6 => self.multiply_add_window::<24>(factor, x, y),
            _ => self.multiply_add_any(factor, x, y),
        }
    }

    /// With the `STRIDE` numbers of x and y that a panel touches in windows of registers.
    fn multiply_add_window<const STRIDE: usize>(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let panels = self.data.as_chunks::<STRIDE>().0.as_chunks::<4>().0;
        let ahead = STRIDE - 4;
        let (mut ours, mut sums) = ([0.0; STRIDE], [0.0; STRIDE]);
        let loaded = x.len().min(STRIDE);
        ours[..loaded].copy_from_slice(&x[..loaded]);
        for (node, panel) in panels.iter().enumerate() {
            for r in 0..4 {
                let scaled = ours[r];
                let mut lanes = [0.0; 4];
                for c in (4..STRIDE).step_by(4) {
                    for lane in 0..4 {
                        let entry = panel[r][c + lane];
                        sums[c + lane] = fma(entry, scaled, sums[c + lane]);
                        lanes[lane] = fma(entry, ours[c + lane], lanes[lane]);
                    }
                }
                let mut sum = (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
                sum = fma(panel[r][r], scaled, sum);
                for c in r + 1..4 {
                    sum = fma(panel[r][c], ours[c], sum);
                    sums[c] = fma(panel[r][c], scaled, sums[c]);
                }
                sums[r] += sum;
            }
            for (y, sum) in y[4 * node..4 * node + 4].iter_mut().zip(&sums) {
                *y = fma(factor, *sum, *y);
            }
            sums.copy_within(4.., 0);
            sums[ahead..].fill(0.0);
            ours.copy_within(4.., 0);
            let next = 4 * node + STRIDE;
            match x.get(next..next + 4) {
                Some(values) => ours[ahead..].copy_from_slice(values),
                None => ours[ahead..].fill(0.0),
            }
        }
    }

    fn multiply_add_any(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let stride = self.stride();
        for (node, panel) in self.data.chunks_exact(4 * stride).enumerate() {
            let first = 4 * node;
            let (x_here, x_later) = x[first..].split_at(4);
            let (y_here, y_later) = y[first..].split_at_mut(4);
            let scaled: [f64; 4] = std::array::from_fn(|r| factor * x_here[r]);
            // The block to the right of the diagonal's, and its transpose: one pass over it, four columns at a time.
            let mut sums = [[0.0; 4]; 4];
            for (b, (x, y)) in
                x_later.chunks_exact(4).zip(y_later.chunks_exact_mut(4)).take(self.blocks - 1).enumerate()
            {
                for r in 0..4 {
                    let from = r * stride + 4 * (b + 1);
                    let row = &panel[from..from + 4];
                    for c in 0..4 {
                        y[c] = fma(row[c], scaled[r], y[c]);
                        sums[r][c] = fma(row[c], x[c], sums[r][c]);
                    }
                }
            }
            for r in 0..4 {
                let row = &panel[r * stride..];
                let mut sum = (sums[r][0] + sums[r][2]) + (sums[r][1] + sums[r][3]);
                sum = fma(row[r], x_here[r], sum);
                for c in r + 1..4 {
                    sum = fma(row[c], x_here[c], sum);
                    y_here[c] = fma(row[c], scaled[r], y_here[c]);
                }
                y_here[r] = fma(factor, sum, y_here[r]);
            }
        }
    }

    /// The same matrix with both halves stored.
    pub fn to_band(&self) -> Band {
        let mut band = Band::zeros(self.size(), self.stride() - 1);
        for i in 0..self.size() {
            for j in self.columns(i) {
                band.set(i, j, self.get(i, j));
            }
        }
        band
    }
}

/// A = L D Lᵀ without pivoting, D of blocks of 4 × 4, which are D = l d lᵀ in turn.
///
/// The blocks right of the diagonal hold W = D⁻¹ U, so that a substitution is a product with W or Wᵀ from node to node: one after
/// the other only as far as it must be, and by whole registers. Solving with the pivots themselves waits for nothing and is waited for by nothing.
#[derive(Clone, Debug)]
pub struct Ldl {
    /// d lᵀ on the diagonal, W right of it.
    rows: SymmetricBand,
    /// The blocks Wᵀ.
    transposed: Vec<[[f64; 4]; 4]>,
    /// 1/d.
    reciprocal: Vec<f64>,
    negative: usize,
}

/// A pivot smaller than this fraction of its diagonal entry carries no significant digit.
const SMALLEST_PIVOT: f64 = 1e-15;

impl Ldl {
    /// Factorises.
    ///
    /// # Errors
    /// [`Singular`] where a pivot vanishes against the diagonal entry it came from, or is not finite.
    pub fn new(matrix: &SymmetricBand) -> Result<Self, Singular> {
        let mut ldl = Self::of(matrix);
        ldl.factorize()?;
        Ok(ldl)
    }

    fn of(matrix: &SymmetricBand) -> Self {
        let transposed = vec![[[0.0; 4]; 4]; matrix.nodes * (matrix.blocks - 1)];
        Self { rows: matrix.clone(), transposed, reciprocal: vec![0.0; matrix.size()], negative: 0 }
    }

    /// Factorises `matrix`, plus c M where `shift` is (c, M), in the memory of this factorisation of the same pattern.
    ///
    /// # Errors
    /// As [`Self::new`]; the factorisation is then unusable.
    pub fn refactorize(
        &mut self,
        matrix: &SymmetricBand,
        shift: Option<(f64, &SymmetricBand)>,
    ) -> Result<(), Singular> {
        if self.rows.data.len() != matrix.data.len() || self.rows.blocks != matrix.blocks {
            *self = Self::of(matrix);
        }
        match shift {
            None => self.rows.data.copy_from_slice(&matrix.data),
            // One pass over memory instead of three.
            Some((c, m)) => {
                let sources = matrix.data.iter().zip(&m.data);
                self.rows.data.iter_mut().zip(sources).for_each(|(row, (k, m))| *row = fma(c, *m, *k));
            }
        }
        self.factorize()
    }

    fn factorize(&mut self) -> Result<(), Singular> {
        // Until its pivot is known, the place of a reciprocal holds the size of the diagonal entry.
        let stride = self.rows.stride();
        for (i, scale) in self.reciprocal.iter_mut().enumerate() {
            *scale = self.rows.data[i * stride + i % 4].abs();
        }
        match self.rows.blocks {
            2 => self.eliminate::<8>(),
            4 => self.eliminate::<16>(),
            6 => self.eliminate::<24>(),
            _ => self.eliminate::<0>(),
        }
    }

    /// `STRIDE` is the panel's row length where it is known at compile time, 0 otherwise.
    fn eliminate<const STRIDE: usize>(&mut self) -> Result<(), Singular> {
        let stride = if STRIDE == 0 { self.rows.stride() } else { STRIDE };
        let nodes = self.rows.nodes;
        self.negative = 0;
        for node in 0..nodes {
            let (panel, later) = self.rows.data[node * 4 * stride..].split_at_mut(4 * stride);
            let mut reciprocal = [0.0; 4];
            for r in 0..4 {
                let (done, rest) = panel.split_at_mut((r + 1) * stride);
                let row = &done[r * stride..];
                let pivot = row[r];
                let i = 4 * node + r;
                let scale = self.reciprocal[i];
                // Written so that a NaN fails too.
                if !(pivot.abs() > SMALLEST_PIVOT * scale && pivot.is_finite()) {
                    return Err(Singular { row: i });
                }
                self.negative += usize::from(pivot < 0.0);
                reciprocal[r] = 1.0 / pivot;
                for (below, target) in rest.chunks_exact_mut(stride).enumerate() {
                    let factor = row[r + 1 + below] * reciprocal[r];
                    for (t, s) in target.iter_mut().zip(row) {
                        *t = fma(-factor, *s, *t);
                    }
                }
            }
            self.reciprocal[4 * node..4 * node + 4].copy_from_slice(&reciprocal);
            let (u0, tail) = panel.split_at(stride);
            let (u1, tail) = tail.split_at(stride);
            let (u2, u3) = tail.split_at(stride);
            let reach = (stride / 4 - 1).min(nodes - 1 - node);
            for (ahead, target_panel) in later.chunks_exact_mut(4 * stride).take(reach).enumerate() {
                let from = 4 * (ahead + 1);
                for (r, target) in target_panel.chunks_exact_mut(stride).enumerate() {
                    let c = from + r;
                    let l = [
                        -u0[c] * reciprocal[0],
                        -u1[c] * reciprocal[1],
                        -u2[c] * reciprocal[2],
                        -u3[c] * reciprocal[3],
                    ];
                    let sources = u0[from..].iter().zip(&u1[from..]).zip(&u2[from..]).zip(&u3[from..]);
                    for (t, (((a, b), c), d)) in target[..stride - from].iter_mut().zip(sources) {
                        *t = fma(l[3], *d, fma(l[2], *c, fma(l[1], *b, fma(l[0], *a, *t))));
                    }
                }
            }
            let transposed = &mut self.transposed[node * (stride / 4 - 1)..];
            for (block, transposed) in (1..stride / 4).zip(transposed) {
                let w = divide_by_pivots(panel, &reciprocal, block);
                for (row, w) in panel.chunks_exact_mut(stride).zip(w) {
                    row[4 * block..4 * block + 4].copy_from_slice(&w.to_array());
                }
                *transposed = Lanes::transpose(w).map(Lanes::to_array);
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        match self.rows.blocks {
            2 => self.substitute::<2>(b),
            4 => self.substitute::<4>(b),
            6 => self.substitute::<6>(b),
            _ => self.substitute::<0>(b),
        }
    }

    /// With the number of blocks a compile-time constant, or 0.
    fn substitute<const BLOCKS: usize>(&self, b: &mut [f64]) {
        let blocks = if BLOCKS == 0 { self.rows.blocks } else { BLOCKS };
        let panels = self.rows.data.chunks_exact(16 * blocks);
        let x = b.as_chunks_mut::<4>().0;
        for (node, (panel, reciprocal)) in panels.zip(self.reciprocal.as_chunks::<4>().0).enumerate() {
            let Some((here, later)) = x[node..].split_first_mut() else { break };
            let rows: [&[f64]; 4] = std::array::from_fn(|r| &panel[4 * blocks * r..4 * blocks * (r + 1)]);
            let sources = here.map(Lanes::splat);
            for (ahead, target) in (1..blocks).zip(later) {
                let w = rows.map(|row| Lanes::new(four(row, ahead)));
                *target = subtract(w, sources, *target);
            }
            *here = solve_pivots(rows.map(|row| four(row, 0)), reciprocal, *here);
        }
        let transposed = self.transposed.chunks_exact((blocks - 1).max(1));
        for (node, transposed) in transposed.enumerate().rev() {
            let Some((here, later)) = x[node..].split_first_mut() else { continue };
            for (w, source) in transposed.iter().zip(later) {
                *here = subtract(w.map(Lanes::new), source.map(Lanes::splat), *here);
            }
        }
    }

    /// Number of negative pivots, which is the number of negative eigenvalues.
    pub fn negative_pivots(&self) -> usize {
        self.negative
    }
}

/// The numbers of a row that belong to block `block`.
#[inline(always)]
fn four(row: &[f64], block: usize) -> [f64; 4] {
    row[4 * block..].first_chunk().copied().unwrap_or_default()
}

/// `target − Σ_r rows_r · factors_r`, in two chains.
#[inline(always)]
fn subtract(rows: [Lanes; 4], factors: [Lanes; 4], target: [f64; 4]) -> [f64; 4] {
    let sum = rows[1].mul_add(factors[1], rows[0] * factors[0]);
    let rest = rows[3].mul_neg_add(factors[3], rows[2].mul_neg_add(factors[2], Lanes::new(target)));
    (rest - sum).to_array()
}

/// W = D⁻¹ U of a block, from the rows of d lᵀ and l⁻¹ U that elimination leaves.
#[inline(always)]
fn divide_by_pivots(panel: &[f64], reciprocal: &[f64; 4], block: usize) -> [Lanes; 4] {
    let stride = panel.len() / 4;
    let mut w = [Lanes::ZERO; 4];
    for r in (0..4).rev() {
        let row = &panel[r * stride..(r + 1) * stride];
        let mut sum = Lanes::new(four(row, block));
        for c in r + 1..4 {
            sum = Lanes::splat(row[c]).mul_neg_add(w[c], sum);
        }
        w[r] = sum * Lanes::splat(reciprocal[r]);
    }
    w
}

/// D⁻¹ b with the rows of d lᵀ.
#[inline(always)]
fn solve_pivots(rows: [[f64; 4]; 4], reciprocal: &[f64; 4], mut b: [f64; 4]) -> [f64; 4] {
    for r in 0..4 {
        let z = b[r] * reciprocal[r];
        for c in r + 1..4 {
            b[c] = fma(-z, rows[r][c], b[c]);
        }
        b[r] = z;
    }
    for r in (0..4).rev() {
        let sum = (r + 1..4).fold(0.0, |sum, c| fma(rows[r][c], b[c], sum));
        b[r] = fma(-sum, reciprocal[r], b[r]);
    }
    b
}
