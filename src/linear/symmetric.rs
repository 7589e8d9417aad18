//! Symmetric band of 4 × 4 blocks and its factorisation A = L D Lᵀ.
//!
//! Block row I is stored as a panel of four rows, each of which holds the columns of nodes I,
//! I + 1, …, I + b contiguously (b + 1 blocks, 4(b + 1) numbers). Within the diagonal block the
//! entries left of the diagonal are computed along with the others but never read. The
//! factorisation works with blocks, each row of a block in a register, node by node: the node's own
//! four pivots reduce its blocks, and then each block of a later node is updated in one pass, with
//! 4 multiply–adds per number loaded and stored.
//!
//! Per node the updates take 32·b·(b + 1) multiplications, 64 for the cable element (b = 1) and 960
//! for six-node supports (b = 5); a pivoted LU of the same band takes 3.5 to 4 times as many.
//! Another 40 b yield the blocks W of [`Ldl`]. They pay off, because a substitution from pivot to
//! pivot would wait eight times per node for the result before: with blocks, a step of the
//! trapezoidal rule (30 cable elements) takes a fifth less time.

use super::Singular;
use super::band::Band;
use super::order::Order;
use crate::lanes::Lanes;
use crate::lanes::fma;
use crate::threads::{self, ByNodes, LONG};

/// Upper half of a symmetric matrix that is a band of blocks.
#[derive(Clone, Debug)]
pub struct SymmetricBand {
    nodes: usize,
    /// Number of blocks in a panel, the diagonal one included.
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

    /// Multiplies all entries by `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.data.iter_mut().for_each(|entry| *entry *= factor);
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.data.fill(0.0);
    }

    /// The four rows of node `node`, from its own columns on; each row has [`Self::stride`]
    /// numbers.
    #[inline]
    pub fn panel_mut(&mut self, node: usize) -> &mut [f64] {
        let length = 16 * self.blocks;
        &mut self.data[node * length..(node + 1) * length]
    }

    /// The panels of all nodes.
    pub fn panels_mut(&mut self) -> Panels<'_> {
        Panels { first: 0, stride: self.stride(), data: &mut self.data }
    }

    /// The block in the rows of `node` and the columns of the node that is `block` nodes further
    /// on.
    #[inline(always)]
    pub(super) fn block(&self, node: usize, block: usize) -> [Lanes; 4] {
        let rows = self.data.as_chunks::<4>().0;
        std::array::from_fn(|r| Lanes::new(rows[(4 * node + r) * self.blocks + block]))
    }

    /// Number of entries in a row of a panel.
    #[inline]
    pub fn stride(&self) -> usize {
        4 * self.blocks
    }

    /// Number of nodes from `node` to the last one after it with which it is coupled.
    pub(super) fn reach(&self, node: usize) -> usize {
        let coupled = |block: &usize| {
            let zero = [0.0; 4];
            self.block(node, *block).iter().any(|row| row.to_array() != zero)
        };
        (1..self.blocks.min(self.nodes - node)).rev().find(coupled).unwrap_or(0)
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
    ///
    /// # Panics
    /// If they do not.
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        match self.index(i, j) {
            Some(k) => self.data[k] = value,
            None => panic!("({i}, {j}) is outside the band"),
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

    /// Keeps the `STRIDE` entries of x and y that a panel touches in registers.
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
            // Uses each block to the right of the diagonal block, and its transpose, in one pass
            // over it, four columns at a time.
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

    /// Σ (Aᵢⱼ xᵢ xⱼ)² over all entries of both halves.
    pub fn squares_of_terms(&self, x: &[f64]) -> f64 {
        let of_row = |(i, row): (usize, &[f64])| {
            let within = i % 4;
            let (own, later) = x[i - within..].split_at(4);
            let (diagonal, right) = row.split_at(4);
            let square = |entry: f64, other: f64| (entry * other).powi(2);
            let mut lanes = [0.0; 4];
            for (entries, values) in right.as_chunks::<4>().0.iter().zip(later.as_chunks::<4>().0) {
                for lane in 0..4 {
                    lanes[lane] += square(entries[lane], values[lane]);
                }
            }
            let beside = (within + 1..4).map(|c| square(diagonal[c], own[c])).sum::<f64>();
            let twice = beside + lanes.iter().sum::<f64>();
            x[i].powi(2) * (square(diagonal[within], own[within]) + 2.0 * twice)
        };
        self.data.chunks_exact(self.stride()).enumerate().map(of_row).sum()
    }

    /// The same matrix with both halves stored.
    pub fn to_band(&self) -> Band {
        let mut band = Band::zeros(self.size(), self.stride() - 1);
        self.add_to(1.0, &mut band);
        band
    }

    /// Adds `factor` times both halves to a band that is at least as wide.
    pub fn add_to(&self, factor: f64, band: &mut Band) {
        let stride = self.stride();
        for (i, row) in self.data.chunks_exact(stride).enumerate() {
            let (first, size) = (4 * (i / 4), self.size());
            for (j, value) in (first..size).zip(row).skip(i - first) {
                let value = factor * value;
                band.row_mut(i, j, 1)[0] += value;
                if j != i {
                    band.row_mut(j, i, 1)[0] += value;
                }
            }
        }
    }
}

/// The panels of some nodes of a [`SymmetricBand`], one after the other.
#[derive(Debug)]
pub struct Panels<'m> {
    first: usize,
    stride: usize,
    data: &'m mut [f64],
}

impl Panels<'_> {
    /// The four rows of node `node`, from its own columns on, with the length of each.
    #[inline(always)]
    pub fn panel_mut(&mut self, node: usize) -> (&mut [f64], usize) {
        let (from, length) = (node - self.first, 4 * self.stride);
        (&mut self.data[from * length..(from + 1) * length], self.stride)
    }
}

impl ByNodes for Panels<'_> {
    fn nodes(&self) -> usize {
        self.data.len() / (4 * self.stride)
    }

    fn cut(self, node: usize) -> (Self, Self) {
        let Self { first, stride, data } = self;
        let (before, behind) = data.split_at_mut(4 * stride * node);
        (Self { first, stride, data: before }, Self { first: first + node, stride, data: behind })
    }
}

/// A block of 4 × 4 numbers, row by row.
pub(super) type Block = [Lanes; 4];

/// A = L D Lᵀ without pivoting, where D consists of blocks of 4 × 4, each of which is D = l d lᵀ in
/// turn.
///
/// The blocks right of the diagonal hold W = D⁻¹ U. A substitution is then a product of whole
/// registers with W or Wᵀ from node to node, and only these products must come one after the other;
/// the solutions with the diagonal blocks D do not depend on each other. If the matrix contains a
/// mass, which bounds its condition, and couples only neighbouring nodes, the latter are products
/// with D⁻¹, which saves a quarter of the instructions of a substitution.
#[derive(Clone, Debug)]
pub struct Ldl {
    /// Number of blocks of a node, the diagonal one included.
    blocks: usize,
    /// Per node, in the order of elimination: d lᵀ (D⁻¹ if elimination proceeds from both ends),
    /// followed by the blocks W.
    rows: Vec<Block>,
    /// The blocks Wᵀ.
    transposed: Vec<Block>,
    /// 1/d of each node.
    reciprocal: Vec<[f64; 4]>,
    negative: usize,
    from_both_ends: bool,
}

/// A pivot smaller than this fraction of its diagonal entry carries no significant digit.
pub(super) const SMALLEST_PIVOT: f64 = 1e-15;

impl Ldl {
    /// Factorises `matrix`.
    ///
    /// # Errors
    /// [`Singular`] if a pivot vanishes relative to the diagonal entry it came from, or is not
    /// finite.
    pub fn new(matrix: &SymmetricBand) -> Result<Self, Singular> {
        Self::again(None, matrix, None)
    }

    fn of(matrix: &SymmetricBand) -> Self {
        let SymmetricBand { nodes, blocks, .. } = *matrix;
        Self {
            blocks,
            rows: vec![[Lanes::ZERO; 4]; nodes * blocks],
            transposed: vec![[Lanes::ZERO; 4]; nodes * (blocks - 1)],
            reciprocal: vec![[0.0; 4]; nodes],
            negative: 0,
            from_both_ends: false,
        }
    }

    /// Factorises `matrix`, plus c M where `shift` is (c, M), in the memory of an earlier
    /// factorisation of the same pattern.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn again(
        earlier: Option<Self>,
        matrix: &SymmetricBand,
        shift: Option<(f64, &SymmetricBand)>,
    ) -> Result<Self, Singular> {
        let fits = |ldl: &Self| ldl.reciprocal.len() == matrix.nodes && ldl.blocks == matrix.blocks;
        let mut ldl = earlier.filter(fits).unwrap_or_else(|| Self::of(matrix));
        ldl.from_both_ends = shift.is_some() && matrix.blocks == 2;
        match (ldl.blocks, ldl.from_both_ends) {
            (2, true) => ldl.factorize::<2, true>(matrix, shift),
            (2, false) => ldl.factorize::<2, false>(matrix, shift),
            (4, _) => ldl.factorize::<4, false>(matrix, shift),
            (6, _) => ldl.factorize::<6, false>(matrix, shift),
            _ => ldl.factorize::<0, false>(matrix, shift),
        }?;
        Ok(ldl)
    }

    /// Factorises, with the number of blocks as a compile-time constant, or 0 if it is uncommon.
    fn factorize<const BLOCKS: usize, const FROM_BOTH_ENDS: bool>(
        &mut self,
        matrix: &SymmetricBand,
        shift: Option<(f64, &SymmetricBand)>,
    ) -> Result<(), Singular> {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        let order = Order::new(matrix.nodes, FROM_BOTH_ENDS);
        let fill = |position: usize, panel: &mut [Block]| {
            for (b, target) in panel.iter_mut().enumerate() {
                let (node, turned) = order.source(position, b);
                let mut block = matrix.block(node, b);
                if let Some((c, m)) = shift {
                    let (c, m) = (Lanes::splat(c), m.block(node, b));
                    block.iter_mut().zip(m).for_each(|(k, m)| *k = m.mul_add(c, *k));
                }
                *target = if turned { Lanes::transpose(block) } else { block };
            }
        };
        if BLOCKS == 2 {
            threads::each([self.rows.as_chunks_mut::<2>().0], &|range, [panels]| {
                range.zip(panels).for_each(|(position, panel)| fill(position, panel));
            });
        } else {
            let panels = self.rows.chunks_exact_mut(blocks).enumerate();
            panels.for_each(|(position, panel)| fill(position, panel));
        }
        let scale = |node: usize, r: usize| {
            let of = |matrix: &SymmetricBand| matrix.get(4 * node + r, 4 * node + r);
            of(matrix) + shift.map_or(0.0, |(c, m)| c * of(m))
        };
        if FROM_BOTH_ENDS && matrix.nodes >= LONG && rayon::current_num_threads() > 1 {
            return self.eliminate_from_both_ends(&scale);
        }
        self.negative = 0;
        for position in 0..matrix.nodes {
            let (panel, later) = self.rows[position * blocks..].split_at_mut(blocks);
            let reciprocal = &mut self.reciprocal[position];
            let node = order.node(position);
            let singular = |r| Singular { row: 4 * node + r };
            *reciprocal = [
                reduce::<0>(panel, scale(node, 0)).ok_or_else(|| singular(0))?,
                reduce::<1>(panel, scale(node, 1)).ok_or_else(|| singular(1))?,
                reduce::<2>(panel, scale(node, 2)).ok_or_else(|| singular(2))?,
                reduce::<3>(panel, scale(node, 3)).ok_or_else(|| singular(3))?,
            ];
            self.negative += reciprocal.iter().filter(|d| **d < 0.0).count();
            for a in 1..blocks {
                let Some(next) = order.next(position, a) else { break };
                let later = &mut later[(next - position - 1) * blocks..];
                let mut l = panel[a];
                l.iter_mut().zip(&*reciprocal).for_each(|(l, d)| *l *= Lanes::splat(*d));
                for (target, u) in later.iter_mut().zip(&panel[a..]) {
                    update(target, &l, u);
                }
            }
            if let Some((pivots, right)) = panel.split_first_mut() {
                let transposed = &mut self.transposed[position * (blocks - 1)..];
                for (u, transposed) in right.iter_mut().zip(transposed) {
                    *u = divide_by_pivots(pivots, reciprocal, *u);
                    *transposed = Lanes::transpose(*u);
                }
                if FROM_BOTH_ENDS {
                    *pivots = inverse(pivots, reciprocal);
                }
            }
        }
        Ok(())
    }

    /// Eliminates the nodes of a long chain by two threads, each from one end of it to the node before
    /// its middle. `scale` gives the diagonal entry in row r of a node.
    fn eliminate_from_both_ends(
        &mut self,
        scale: &(impl Fn(usize, usize) -> f64 + Sync),
    ) -> Result<(), Singular> {
        let (order, nodes) = (self.order(), self.reciprocal.len());
        let last = nodes.saturating_sub(1);
        let panels = self.rows.as_chunks_mut::<2>().0.iter_mut().zip(&mut self.transposed);
        let mut chains = [(); 2].map(|()| Vec::with_capacity(nodes.div_ceil(2)));
        for (position, ((panel, transposed), reciprocal)) in panels.zip(&mut self.reciprocal).enumerate() {
            let node = order.node(position);
            chains[position % 2].push(Link { node, panel, transposed, reciprocal });
        }
        let Some(mut middle) = chains[last % 2].pop() else { return Ok(()) };
        let [front, back] = chains;
        let (front, back) = rayon::join(|| eliminate_links(front, scale), || eliminate_links(back, scale));
        // The last but one position comes last.
        let ends = if last.is_multiple_of(2) { [front, back] } else { [back, front] };
        self.negative = 0;
        for end in ends {
            let (before, negative) = end?;
            before.iter().for_each(|(l, u)| update(&mut middle.panel[0], l, u));
            self.negative += negative;
        }
        middle.eliminate(scale)?;
        self.negative += middle.negative();
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        match (self.blocks, self.from_both_ends) {
            (2, true) => self.substitute::<2, true>(b),
            (2, false) => self.substitute::<2, false>(b),
            (4, _) => self.substitute::<4, false>(b),
            (6, _) => self.substitute::<6, false>(b),
            _ => self.substitute::<0, false>(b),
        }
    }

    /// Substitutes, with the number of blocks as a compile-time constant, or 0 if it is uncommon.
    fn substitute<const BLOCKS: usize, const FROM_BOTH_ENDS: bool>(&self, b: &mut [f64]) {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        let pivots = |position: usize, rows: &Block, here: [f64; 4]| {
            if FROM_BOTH_ENDS {
                multiply(rows, here)
            } else {
                solve_pivots(rows, &self.reciprocal[position], here)
            }
        };
        substitute::<FROM_BOTH_ENDS>(&self.rows, &self.transposed, blocks, pivots, b);
    }

    /// The order in which nodes are eliminated.
    pub(super) fn order(&self) -> Order {
        Order::new(self.reciprocal.len(), self.from_both_ends)
    }

    /// Solves A x = b in place, where b vanishes outside nodes that are not coupled with others and
    /// are eliminated at the rising `positions`.
    pub(super) fn solve_part(&self, positions: &[u32], b: &mut [f64]) {
        let x = b.as_chunks_mut::<4>().0;
        let order = self.order();
        for position in positions.iter().map(|position| *position as usize) {
            let panel = &self.rows[position * self.blocks..(position + 1) * self.blocks];
            let here = x[order.node(position)];
            for (block, w) in panel.iter().enumerate().skip(1) {
                let Some(next) = order.next(position, block) else { break };
                let target = &mut x[order.node(next)];
                *target = subtract(w, here, *target);
            }
            x[order.node(position)] = if self.from_both_ends {
                multiply(&panel[0], here)
            } else {
                solve_pivots(&panel[0], &self.reciprocal[position], here)
            };
        }
        let right = self.blocks - 1;
        for position in positions.iter().rev().map(|position| *position as usize) {
            let mut here = x[order.node(position)];
            for (block, w) in self.transposed[position * right..(position + 1) * right].iter().enumerate() {
                let Some(next) = order.next(position, block + 1) else { break };
                here = subtract(w, x[order.node(next)], here);
            }
            x[order.node(position)] = here;
        }
    }

    /// Number of negative pivots, which is the number of negative eigenvalues.
    pub fn negative_pivots(&self) -> usize {
        self.negative
    }
}

/// A node of a chain that is eliminated from both ends.
struct Link<'l> {
    node: usize,
    panel: &'l mut [Block; 2],
    transposed: &'l mut Block,
    reciprocal: &'l mut [f64; 4],
}

impl Link<'_> {
    /// Eliminates the node; returns by what the next one changes, as for [`update`].
    #[inline(always)]
    fn eliminate(&mut self, scale: &impl Fn(usize, usize) -> f64) -> Result<(Block, Block), Singular> {
        let (node, panel) = (self.node, &mut self.panel[..]);
        let singular = |r| Singular { row: 4 * node + r };
        *self.reciprocal = [
            reduce::<0>(panel, scale(node, 0)).ok_or_else(|| singular(0))?,
            reduce::<1>(panel, scale(node, 1)).ok_or_else(|| singular(1))?,
            reduce::<2>(panel, scale(node, 2)).ok_or_else(|| singular(2))?,
            reduce::<3>(panel, scale(node, 3)).ok_or_else(|| singular(3))?,
        ];
        let [pivots, right] = &mut *self.panel;
        let (mut l, u) = (*right, *right);
        l.iter_mut().zip(&*self.reciprocal).for_each(|(l, d)| *l *= Lanes::splat(*d));
        *right = divide_by_pivots(pivots, self.reciprocal, u);
        *self.transposed = Lanes::transpose(*right);
        *pivots = inverse(pivots, self.reciprocal);
        Ok((l, u))
    }

    fn negative(&self) -> usize {
        self.reciprocal.iter().filter(|d| **d < 0.0).count()
    }
}

/// Eliminates nodes each of which is coupled with the next. Returns by what the one behind them
/// changes, and the number of negative pivots.
fn eliminate_links(
    links: Vec<Link<'_>>,
    scale: &impl Fn(usize, usize) -> f64,
) -> Result<(Option<(Block, Block)>, usize), Singular> {
    let (mut before, mut negative) = (None, 0);
    for mut link in links {
        if let Some((l, u)) = &before {
            update(&mut link.panel[0], l, u);
        }
        before = Some(link.eliminate(scale)?);
        negative += link.negative();
    }
    Ok((before, negative))
}

/// Subtracts lᵀ u from the block of a later node.
#[inline(always)]
fn update(target: &mut Block, l: &Block, u: &Block) {
    for (r, target) in target.iter_mut().enumerate() {
        let [l0, l1, l2, l3] = l.map(|l| Lanes::splat(l.to_array()[r]));
        let sum = l1.mul_neg_add(u[1], l0.mul_neg_add(u[0], *target));
        *target = l3.mul_neg_add(u[3], l2.mul_neg_add(u[2], sum));
    }
}

/// Solves with a factorised matrix in place. `rows` holds per node what `pivots` needs to solve with
/// its pivots, and its `blocks − 1` blocks to the left of the diagonal, transposed, each divided by
/// the pivots; `transposed` holds those to the right, in the same form.
#[inline(always)]
pub(super) fn substitute<const FROM_BOTH_ENDS: bool>(
    rows: &[Block],
    transposed: &[Block],
    blocks: usize,
    pivots: impl Fn(usize, &Block, [f64; 4]) -> [f64; 4] + Sync,
    b: &mut [f64],
) {
    let x = b.as_chunks_mut::<4>().0;
    if FROM_BOTH_ENDS && x.len() >= LONG && rayon::current_num_threads() > 1 {
        return from_both_ends(rows.as_chunks().0, transposed, pivots, x);
    }
    let order = Order::new(x.len(), FROM_BOTH_ENDS);
    for (position, panel) in rows.chunks_exact(blocks).enumerate() {
        let here = x[order.node(position)];
        for (block, w) in panel.iter().enumerate().skip(1) {
            let Some(next) = order.next(position, block) else { break };
            let target = &mut x[order.node(next)];
            *target = subtract(w, here, *target);
        }
        x[order.node(position)] = pivots(position, &panel[0], here);
    }
    for (position, transposed) in transposed.chunks_exact((blocks - 1).max(1)).enumerate().rev() {
        let mut here = x[order.node(position)];
        for (b, w) in transposed.iter().enumerate() {
            let Some(next) = order.next(position, b + 1) else { break };
            here = subtract(w, x[order.node(next)], here);
        }
        x[order.node(position)] = here;
    }
}

/// The same by two threads, each from one end of a chain to its middle and back.
fn from_both_ends(
    rows: &[[Block; 2]],
    transposed: &[Block],
    pivots: impl Fn(usize, &Block, [f64; 4]) -> [f64; 4] + Sync,
    x: &mut [[f64; 4]],
) {
    let last = x.len() - 1;
    let (front, rest) = x.split_at_mut(last.div_ceil(2));
    let Some((middle, back)) = rest.split_first_mut() else { return };
    let (of_front, of_back) = ((0..last).step_by(2), (1..last).step_by(2));
    let (a, b) = rayon::join(
        || eliminate(of_front.clone().zip(front.iter_mut()), rows, &pivots),
        || eliminate(of_back.clone().zip(back.iter_mut().rev()), rows, &pivots),
    );
    // The last but one position comes last.
    let ends = if last.is_multiple_of(2) { [a, b] } else { [b, a] };
    let here = ends.into_iter().flatten().fold(*middle, |node, (w, before)| subtract(w, before, node));
    *middle = pivots(last, &rows[last][0], here);
    rayon::join(
        || put_in(of_front.rev().zip(front.iter_mut().rev()), transposed, *middle),
        || put_in(of_back.rev().zip(back.iter_mut()), transposed, *middle),
    );
}

/// Eliminates nodes at positions, each coupled with the next. Returns the last as it was before it was
/// divided by its pivots, with the block by which it is coupled.
#[inline(always)]
fn eliminate<'r, 'x>(
    nodes: impl Iterator<Item = (usize, &'x mut [f64; 4])>,
    rows: &'r [[Block; 2]],
    pivots: impl Fn(usize, &Block, [f64; 4]) -> [f64; 4],
) -> Option<(&'r Block, [f64; 4])> {
    let mut before: Option<(&Block, [f64; 4])> = None;
    for (position, node) in nodes {
        let [pivot, next] = &rows[position];
        let here = before.map_or(*node, |(w, before)| subtract(w, before, *node));
        *node = pivots(position, pivot, here);
        before = Some((next, here));
    }
    before
}

/// Puts the solution at a node, `later`, into the one before it, and so on.
#[inline(always)]
fn put_in<'x>(
    nodes: impl Iterator<Item = (usize, &'x mut [f64; 4])>,
    transposed: &[Block],
    mut later: [f64; 4],
) {
    for (position, node) in nodes {
        *node = subtract(&transposed[position], later, *node);
        later = *node;
    }
}

/// Subtracts multiples of row `R` of the panel from the rows below so that the entries below its
/// pivot become zero. Returns 1/pivot, or `None` if the pivot vanishes relative to `scale`.
#[inline(always)]
fn reduce<const R: usize>(panel: &mut [Block], scale: f64) -> Option<f64> {
    let row = panel[0][R].to_array();
    // Written with a negation, so that a NaN fails, too.
    if !(row[R].abs() > SMALLEST_PIVOT * scale.abs() && row[R].is_finite()) {
        return None;
    }
    let reciprocal = 1.0 / row[R];
    for (c, entry) in row.iter().enumerate().skip(R + 1) {
        let l = Lanes::splat(entry * reciprocal);
        for block in panel.iter_mut() {
            block[c] = l.mul_neg_add(block[R], block[c]);
        }
    }
    Some(reciprocal)
}

/// `target − Σ_r rows_r · factors_r`, summed in two independent chains.
#[inline(always)]
fn subtract(rows: &Block, factors: [f64; 4], target: [f64; 4]) -> [f64; 4] {
    let factors = factors.map(Lanes::splat);
    let sum = rows[1].mul_add(factors[1], rows[0] * factors[0]);
    let rest = rows[3].mul_neg_add(factors[3], rows[2].mul_neg_add(factors[2], Lanes::new(target)));
    (rest - sum).to_array()
}

/// `Σ_r rows_r · factors_r`, summed in two independent chains.
#[inline(always)]
pub(super) fn multiply(rows: &Block, factors: [f64; 4]) -> [f64; 4] {
    let factors = factors.map(Lanes::splat);
    let sum = rows[1].mul_add(factors[1], rows[0] * factors[0]);
    (rows[3].mul_add(factors[3], rows[2] * factors[2]) + sum).to_array()
}

/// D⁻¹, from the rows of d lᵀ and 1/d.
fn inverse(pivots: &Block, reciprocal: &[f64; 4]) -> Block {
    let mut inverse: Block =
        std::array::from_fn(|r| Lanes::new(std::array::from_fn(|c| f64::from(u8::from(r == c)))));
    for r in 0..4 {
        let row = pivots[r].to_array();
        for c in r + 1..4 {
            inverse[c] = Lanes::splat(row[c] * reciprocal[r]).mul_neg_add(inverse[r], inverse[c]);
        }
    }
    divide_by_pivots(pivots, reciprocal, inverse)
}

/// W = D⁻¹ U of a block, from the rows of d lᵀ and the block l⁻¹ U that the elimination leaves.
#[inline(always)]
fn divide_by_pivots(pivots: &Block, reciprocal: &[f64; 4], mut u: Block) -> Block {
    for r in (0..4).rev() {
        let row = pivots[r].to_array();
        for c in r + 1..4 {
            u[r] = Lanes::splat(row[c]).mul_neg_add(u[c], u[r]);
        }
        u[r] *= Lanes::splat(reciprocal[r]);
    }
    u
}

/// D⁻¹ b, from the rows of d lᵀ and 1/d.
#[inline(always)]
fn solve_pivots(rows: &Block, reciprocal: &[f64; 4], mut b: [f64; 4]) -> [f64; 4] {
    let rows = rows.map(Lanes::to_array);
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
