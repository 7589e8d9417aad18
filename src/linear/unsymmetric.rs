//! LU of a band of 4 × 4 blocks without symmetry, node by node.
//!
//! A tangent with follower loads is not symmetric, but with a mass that is large enough for the
//! step its symmetric part is definite, and elimination without exchange of nodes is as safe as for
//! a symmetric matrix (Golub, Van Loan, *Matrix Computations*, 2013, §4.3.2). Within a node, rows
//! are exchanged. With a node's pivots D, the blocks U to its right and L below it,
//!
//! ```text
//! A_jk ← A_jk − (L_j D⁻¹) U_k        for all nodes j, k that it is coupled with
//! ```
//!
//! A substitution takes as long as that of [`super::symmetric::Ldl`], whose loops it shares: a
//! quarter of that of an LU with exchanges in the whole band. Without a mass, as in statics,
//! [`super::band::BandLu`] is used.

use super::Singular;
use super::band::Band;
use super::order::Order;
use super::symmetric::{Block, SMALLEST_PIVOT, multiply, substitute};
use crate::lanes::Lanes;

/// A = L U by blocks, in the order of elimination.
#[derive(Clone, Debug)]
pub struct BlockLu {
    /// Number of blocks of a node to the right of the diagonal, the diagonal one included.
    blocks: usize,
    /// Per node: D⁻ᵀ, followed by the blocks (L D⁻¹)ᵀ.
    rows: Vec<Block>,
    /// The blocks (D⁻¹ U)ᵀ.
    transposed: Vec<Block>,
    from_both_ends: bool,
}

impl BlockLu {
    /// Factorises `matrix`, which must be a band of whole blocks.
    ///
    /// # Errors
    /// [`Singular`] where a node has a pivot that vanishes relative to its column, or is not finite.
    pub fn new(matrix: &Band) -> Result<Self, Singular> {
        let (nodes, blocks) = (matrix.size() / 4, matrix.half_bandwidth() / 4 + 1);
        let from_both_ends = blocks == 2;
        let order = Order::new(nodes, from_both_ends);
        debug_assert!(
            (0..4 * nodes).all(|i| {
                let outside = |j: &usize| (i / 4).abs_diff(j / 4) >= blocks;
                matrix.columns(i).filter(outside).all(|j| matrix.get(i, j) == 0.0)
            }),
            "an entry lies outside the blocks"
        );
        // The blocks right of and below the diagonal as they stand, in the order of elimination.
        let mut right = vec![[Lanes::ZERO; 4]; nodes * blocks];
        let mut below = vec![[Lanes::ZERO; 4]; nodes * (blocks - 1)];
        for position in 0..nodes {
            let node = order.node(position);
            right[position * blocks] = block(matrix, node, node);
            for b in 1..blocks {
                let Some(next) = order.next(position, b) else { break };
                right[position * blocks + b] = block(matrix, node, order.node(next));
                below[position * (blocks - 1) + b - 1] = block(matrix, order.node(next), node);
            }
        }
        let mut lu = Self {
            blocks,
            rows: vec![[Lanes::ZERO; 4]; nodes * blocks],
            transposed: vec![[Lanes::ZERO; 4]; nodes * (blocks - 1)],
            from_both_ends,
        };
        for position in 0..nodes {
            let node = order.node(position);
            let inverse = inverse(right[position * blocks]).map_err(|r| Singular { row: 4 * node + r })?;
            lu.rows[position * blocks] = Lanes::transpose(inverse);
            let later = |b: usize| order.next(position, b).map(|next| (b, next));
            for (a, next) in (1..blocks).map_while(later) {
                let l = product(&below[position * (blocks - 1) + a - 1], &inverse);
                lu.rows[position * blocks + a] = Lanes::transpose(l);
                for (b, other) in (1..blocks).map_while(later) {
                    let change = product(&l, &right[position * blocks + b]);
                    let target = if other >= next {
                        &mut right[next * blocks + (b - a)]
                    } else {
                        &mut below[other * (blocks - 1) + (a - b) - 1]
                    };
                    target.iter_mut().zip(change).for_each(|(target, change)| *target -= change);
                }
                let w = product(&inverse, &right[position * blocks + a]);
                lu.transposed[position * (blocks - 1) + a - 1] = Lanes::transpose(w);
            }
        }
        Ok(lu)
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        let pivots = |_: usize, rows: &Block, here: [f64; 4]| multiply(rows, here);
        match (self.blocks, self.from_both_ends) {
            (2, true) => substitute::<true>(&self.rows, &self.transposed, 2, pivots, b),
            (blocks, _) => substitute::<false>(&self.rows, &self.transposed, blocks, pivots, b),
        }
    }
}

/// The block in the rows of one node and the columns of another.
fn block(matrix: &Band, row: usize, column: usize) -> Block {
    std::array::from_fn(|r| Lanes::new(*matrix.block_row(4 * row + r, 4 * column)))
}

/// A B.
#[inline(always)]
fn product(a: &Block, b: &Block) -> Block {
    a.map(|row| {
        let [a0, a1, a2, a3] = row.to_array().map(Lanes::splat);
        a3.mul_add(b[3], a2.mul_add(b[2], a1.mul_add(b[1], a0 * b[0])))
    })
}

/// A⁻¹ by Gauss and Jordan's elimination with exchanges of rows; the column without a pivot where
/// there is none. Pivots are measured by their columns, because positions and gradients have units
/// of their own.
fn inverse(mut a: Block) -> Result<Block, usize> {
    let rows = a.map(Lanes::to_array);
    let largest: [f64; 4] =
        std::array::from_fn(|c| rows.iter().fold(0.0_f64, |largest, row| largest.max(row[c].abs())));
    let mut inverse: Block =
        std::array::from_fn(|r| Lanes::new(std::array::from_fn(|c| f64::from(u8::from(r == c)))));
    for c in 0..4 {
        let size = |row: &Lanes| row.to_array()[c].abs();
        let pivot = (c..4).fold(c, |best, r| if size(&a[r]) > size(&a[best]) { r } else { best });
        a.swap(c, pivot);
        inverse.swap(c, pivot);
        let entry = a[c].to_array()[c];
        // Written with a negation, so that a NaN fails, too.
        if !(entry.abs() > SMALLEST_PIVOT * largest[c] && entry.is_finite()) {
            return Err(c);
        }
        let reciprocal = Lanes::splat(1.0 / entry);
        a[c] *= reciprocal;
        inverse[c] *= reciprocal;
        for r in (0..4).filter(|r| *r != c) {
            let factor = Lanes::splat(a[r].to_array()[c]);
            a[r] = factor.mul_neg_add(a[c], a[r]);
            inverse[r] = factor.mul_neg_add(inverse[c], inverse[r]);
        }
    }
    Ok(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of blocks whose symmetric part is definite.
    fn matrix(nodes: usize, blocks: usize) -> Band {
        let mut matrix = Band::zeros(4 * nodes, 4 * blocks - 1);
        for i in 0..4 * nodes {
            for j in matrix.columns(i).filter(|j| (i / 4).abs_diff(j / 4) < blocks) {
                let (a, b) = (i.min(j), i.max(j));
                let symmetric = ((3 * a + 5 * b) % 7) as f64 - 3.0;
                let skew = 2.0 * (((a + 2 * b) % 5) as f64 - 2.0) * if i < j { 1.0 } else { -1.0 };
                matrix.set(i, j, if i == j { 40.0 + (i % 3) as f64 } else { symmetric + skew });
            }
        }
        matrix
    }

    #[test]
    fn solutions_satisfy_the_equations() {
        for (nodes, blocks) in [(1, 1), (2, 2), (3, 2), (8, 2), (9, 2), (7, 4), (9, 6), (3, 6)] {
            let matrix = matrix(nodes, blocks);
            let x: Vec<f64> = (0..4 * nodes).map(|i| f64::from((i * i % 11) as u8) - 3.0).collect();
            let mut b = vec![0.0; x.len()];
            matrix.multiply_add(1.0, &x, &mut b);
            BlockLu::new(&matrix).expect("pivots").solve(&mut b);
            for (found, x) in b.iter().zip(&x) {
                assert!((found - x).abs() < 1e-12, "{nodes} nodes, {blocks} blocks: {found} {x}");
            }
        }
    }

    #[test]
    fn a_node_without_a_pivot_is_named() {
        let mut matrix = matrix(5, 2);
        for i in 0..20 {
            if matrix.columns(9).contains(&i) {
                matrix.set(9, i, 0.0);
            }
        }
        let row = BlockLu::new(&matrix).expect_err("no pivot").row;
        assert_eq!(row / 4, 2);
    }

    #[test]
    fn rows_are_exchanged_within_a_node() {
        let mut matrix = Band::zeros(4, 3);
        for (i, j) in [(0, 1), (1, 0), (2, 3), (3, 2)] {
            matrix.set(i, j, 2.0);
        }
        let mut b = [1.0, 2.0, 3.0, 4.0];
        BlockLu::new(&matrix).expect("pivots").solve(&mut b);
        assert_eq!(b, [1.0, 0.5, 2.0, 1.5]);
    }
}
