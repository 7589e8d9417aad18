//! L D Lᵀ of K + ζ M for a complex number ζ and real symmetric bands K and M.
//!
//! K + ζ M is complex *symmetric* (not Hermitian) and has a factorisation L D Lᵀ. It exists without
//! pivoting: if M is positive definite and Im ζ ≠ 0, the imaginary part of x*(K + ζM)x differs from
//! zero for every x ≠ 0, so that no leading minor vanishes (George, Ikramov, Kucherov, *SIAM J.
//! Matrix Anal. Appl.* 21, 2000, 377–387). Numbers are stored by fours, their real parts before
//! their imaginary parts (`Four`), so that all inner loops are real multiply–adds of whole
//! registers.

use super::Singular;
use super::order::Order;
use super::symmetric::SymmetricBand;
use crate::lanes::Lanes;
use faer::c64;

/// Real and imaginary parts of four numbers, which belong to one node in a row.
type Four = [Lanes; 2];

/// A block of 4 × 4 complex numbers, row by row.
type Block = [Four; 4];

const ZERO: Four = [Lanes::ZERO; 2];

/// `target + l · source`.
#[inline(always)]
fn add(l: c64, [s_re, s_im]: Four, [re, im]: Four) -> Four {
    let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
    [l_im.mul_neg_add(s_im, l_re.mul_add(s_re, re)), l_im.mul_add(s_re, l_re.mul_add(s_im, im))]
}

/// `target − l · source`.
#[inline(always)]
fn subtract(l: c64, [s_re, s_im]: Four, [re, im]: Four) -> Four {
    let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
    [l_im.mul_add(s_im, l_re.mul_neg_add(s_re, re)), l_im.mul_neg_add(s_re, l_re.mul_neg_add(s_im, im))]
}

/// `Σ_r rows_r · factors_r`, summed in two independent chains.
#[inline(always)]
fn product(rows: &Block, factors: [c64; 4]) -> Four {
    let one = add(factors[1], rows[1], add(factors[0], rows[0], ZERO));
    let other = add(factors[3], rows[3], add(factors[2], rows[2], ZERO));
    [one[0] + other[0], one[1] + other[1]]
}

#[inline(always)]
fn numbers(four: Four) -> [c64; 4] {
    let [re, im] = four.map(Lanes::to_array);
    std::array::from_fn(|lane| c64::new(re[lane], im[lane]))
}

#[inline(always)]
fn transpose(block: Block) -> Block {
    let (re, im) = (Lanes::transpose(block.map(|row| row[0])), Lanes::transpose(block.map(|row| row[1])));
    std::array::from_fn(|r| [re[r], im[r]])
}

/// L D Lᵀ of a complex symmetric band, where D consists of blocks of 4 × 4.
///
/// It stores D⁻¹, computed by Gauss–Jordan elimination, whose pivots are those of the scalar
/// L D Lᵀ, and the blocks W = D⁻¹ U and Wᵀ right of the diagonal. A substitution then consists of
/// products with blocks, of which only those with W or Wᵀ need the result of the node before.
#[derive(Clone, Debug)]
pub struct ComplexLdl {
    /// Number of blocks of a node, the diagonal one included.
    blocks: usize,
    /// D⁻¹ and W of each node.
    rows: Vec<Block>,
    /// The blocks Wᵀ.
    transposed: Vec<Block>,
}

impl ComplexLdl {
    /// Memory for matrices with the pattern of `pattern`.
    pub fn zeros(pattern: &SymmetricBand) -> Self {
        let (nodes, blocks) = (pattern.size() / 4, pattern.stride() / 4);
        Self {
            blocks,
            rows: vec![[ZERO; 4]; nodes * blocks],
            transposed: vec![[ZERO; 4]; nodes * (blocks - 1)],
        }
    }

    /// Factorises `k` + ζ `m` in the memory of an earlier factorisation.
    ///
    /// # Errors
    /// [`Singular`] where a pivot vanishes.
    pub fn factorize(&mut self, k: &SymmetricBand, m: &SymmetricBand, zeta: c64) -> Result<(), Singular> {
        let order = Order::new(self.rows.len() / self.blocks, self.blocks == 2);
        for (position, panel) in self.rows.chunks_exact_mut(self.blocks).enumerate() {
            for (b, target) in panel.iter_mut().enumerate() {
                let (node, turned) = order.source(position, b);
                let (k, m) = (k.block(node, b), m.block(node, b));
                let [re, im] = [Lanes::splat(zeta.re), Lanes::splat(zeta.im)];
                let mut block = [ZERO; 4];
                for (row, (k, m)) in block.iter_mut().zip(k.iter().zip(&m)) {
                    *row = [m.mul_add(re, *k), *m * im];
                }
                *target = if turned { transpose(block) } else { block };
            }
        }
        match self.blocks {
            2 => self.eliminate::<2>(),
            4 => self.eliminate::<4>(),
            6 => self.eliminate::<6>(),
            _ => self.eliminate::<0>(),
        }
    }

    /// Eliminates, with the number of blocks as a compile-time constant, or 0 if it is uncommon.
    fn eliminate<const BLOCKS: usize>(&mut self) -> Result<(), Singular> {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        let nodes = self.rows.len() / blocks;
        let order = Order::new(nodes, blocks == 2);
        for position in 0..nodes {
            let singular = |position, r| Singular { row: 4 * order.node(position) + r };
            if order.is_pair(position) {
                let (one, other) = self.rows[position * blocks..].split_at_mut(blocks);
                invert([&mut one[0], &mut other[0]]).map_err(|(which, r)| singular(position + which, r))?;
            } else if position == 0 || !order.is_pair(position - 1) {
                invert([&mut self.rows[position * blocks]]).map_err(|(_, r)| singular(position, r))?;
            }
            let (panel, later) = self.rows[position * blocks..].split_at_mut(blocks);
            let Some((diagonal, right)) = panel.split_first_mut() else { break };
            let products = &mut self.transposed[position * (blocks - 1)..(position + 1) * (blocks - 1)];
            for (w, u) in products.iter_mut().zip(&*right) {
                for (w, row) in w.iter_mut().zip(&*diagonal) {
                    *w = product(u, numbers(*row));
                }
            }
            for (a, u) in right.iter().enumerate() {
                let Some(next) = order.next(position, a + 1) else { break };
                let later = &mut later[(next - position - 1) * blocks..];
                for (target, w) in later[..blocks].iter_mut().zip(&products[a..]) {
                    for (source, w) in u.iter().zip(w) {
                        for (target, u) in target.iter_mut().zip(numbers(*source)) {
                            *target = subtract(u, *w, *target);
                        }
                    }
                }
            }
            for (w, transposed) in right.iter_mut().zip(products) {
                (*w, *transposed) = (*transposed, transpose(*transposed));
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self.blocks {
            2 => self.substitute::<2>(re, im),
            4 => self.substitute::<4>(re, im),
            6 => self.substitute::<6>(re, im),
            _ => self.substitute::<0>(re, im),
        }
    }

    /// The order in which nodes are eliminated.
    pub(super) fn order(&self) -> Order {
        Order::new(self.rows.len() / self.blocks, self.blocks == 2)
    }

    /// Solves A x = b in place, where b vanishes outside nodes that are not coupled with others and
    /// are eliminated at the rising `positions`.
    pub(super) fn solve_part(&self, positions: &[u32], re: &mut [f64], im: &mut [f64]) {
        let (re, im) = (re.as_chunks_mut::<4>().0, im.as_chunks_mut::<4>().0);
        let order = self.order();
        for position in positions.iter().map(|position| *position as usize) {
            let panel = &self.rows[position * self.blocks..(position + 1) * self.blocks];
            let node = order.node(position);
            let here = numbers([re[node], im[node]].map(Lanes::new));
            for (b, w) in panel.iter().enumerate().skip(1) {
                let Some(next) = order.next(position, b) else { break };
                let (change, next) = (product(w, here), order.node(next));
                re[next] = (Lanes::new(re[next]) - change[0]).to_array();
                im[next] = (Lanes::new(im[next]) - change[1]).to_array();
            }
            [re[node], im[node]] = product(&panel[0], here).map(Lanes::to_array);
        }
        let right = self.blocks - 1;
        for position in positions.iter().rev().map(|position| *position as usize) {
            let node = order.node(position);
            let mut here = [re[node], im[node]].map(Lanes::new);
            for (b, w) in self.transposed[position * right..(position + 1) * right].iter().enumerate() {
                let Some(next) = order.next(position, b + 1).map(|next| order.node(next)) else { break };
                let change = product(w, numbers([re[next], im[next]].map(Lanes::new)));
                here = [here[0] - change[0], here[1] - change[1]];
            }
            [re[node], im[node]] = here.map(Lanes::to_array);
        }
    }

    /// Substitutes, with the number of blocks as a compile-time constant, or 0 if it is uncommon.
    fn substitute<const BLOCKS: usize>(&self, re: &mut [f64], im: &mut [f64]) {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        let (re, im) = (re.as_chunks_mut::<4>().0, im.as_chunks_mut::<4>().0);
        let order = Order::new(re.len(), blocks == 2);
        for (position, panel) in self.rows.chunks_exact(blocks).enumerate() {
            let node = order.node(position);
            let here = numbers([re[node], im[node]].map(Lanes::new));
            for (b, w) in panel.iter().enumerate().skip(1) {
                let Some(next) = order.next(position, b) else { break };
                let (change, next) = (product(w, here), order.node(next));
                re[next] = (Lanes::new(re[next]) - change[0]).to_array();
                im[next] = (Lanes::new(im[next]) - change[1]).to_array();
            }
            // D⁻¹ is symmetric, so that its rows serve as its columns.
            [re[node], im[node]] = product(&panel[0], here).map(Lanes::to_array);
        }
        for (position, transposed) in self.transposed.chunks_exact((blocks - 1).max(1)).enumerate().rev() {
            let node = order.node(position);
            let mut here = [re[node], im[node]].map(Lanes::new);
            for (b, w) in transposed.iter().enumerate() {
                let Some(next) = order.next(position, b + 1).map(|next| order.node(next)) else { break };
                let change = product(w, numbers([re[next], im[next]].map(Lanes::new)));
                here = [here[0] - change[0], here[1] - change[1]];
            }
            [re[node], im[node]] = here.map(Lanes::to_array);
        }
    }
}

/// Inverts symmetric blocks, of which only the upper parts are read. The blocks advance together,
/// step by step, so that one is computed while another waits for a result. The error is the index
/// of a block with a pivot that vanishes or is not finite, and the row of that pivot.
#[inline(always)]
fn invert<const N: usize>(mut blocks: [&mut Block; N]) -> Result<(), (usize, usize)> {
    for block in &mut blocks {
        let lower = transpose(**block);
        for (r, (row, lower)) in block.iter_mut().zip(lower).enumerate() {
            for (row, lower) in row.iter_mut().zip(lower) {
                let (mut whole, lower) = (row.to_array(), lower.to_array());
                whole[..r].copy_from_slice(&lower[..r]);
                *row = Lanes::new(whole);
            }
        }
    }
    exchange_all::<0, N>(&mut blocks)?;
    exchange_all::<1, N>(&mut blocks)?;
    exchange_all::<2, N>(&mut blocks)?;
    exchange_all::<3, N>(&mut blocks)
}

#[inline(always)]
fn exchange_all<const R: usize, const N: usize>(blocks: &mut [&mut Block; N]) -> Result<(), (usize, usize)> {
    for (which, block) in blocks.iter_mut().enumerate() {
        exchange::<R>(block).map_err(|r| (which, r))?;
    }
    Ok(())
}

/// One step of Gauss–Jordan elimination: exchanges unknown and right-hand side number `R`.
#[inline(always)]
fn exchange<const R: usize>(block: &mut Block) -> Result<(), usize> {
    let with = |lanes: Lanes, value: f64| {
        let mut numbers = lanes.to_array();
        numbers[R] = value;
        Lanes::new(numbers)
    };
    let pivot = numbers(block[R])[R];
    let size = pivot.re * pivot.re + pivot.im * pivot.im;
    // Written with a negation, so that a NaN fails, too.
    if !(size > 0.0 && size.is_finite()) {
        return Err(R);
    }
    let row = [with(block[R][0], 1.0), with(block[R][1], 0.0)];
    let scale = 1.0 / size;
    let row = add(c64::new(pivot.re * scale, -pivot.im * scale), row, ZERO);
    for (r, target) in block.iter_mut().enumerate() {
        let rest = [with(target[0], 0.0), with(target[1], 0.0)];
        *target = if r == R { row } else { subtract(numbers(*target)[R], row, rest) };
    }
    Ok(())
}
