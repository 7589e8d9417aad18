//! Force and tangent of the cells of a table whose width is known when this is compiled.
//!
//! Two passes a cell. The first evaluates the density at the cell's points and multiplies its second derivatives into the rows,
//!
//! ```text
//! P_md = w Σ_n H_mn(d, ·) N⁽ᵒⁿ⁾        (2 M rows of 2 W numbers, x and y of two functions in a register, per point)
//! ```
//!
//! the second adds Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md to row (a, d) of the matrix, a tile of 4 × 4 numbers (two nodes) at a
//! time, so that the tile stays in registers while the points go by and is loaded and stored once per cell. Of a
//! symmetric matrix only the tiles on and above the diagonal are computed.

use super::{Density, Earlier, Gradient, Integral, Workspace};
use crate::lanes::Lanes;
use crate::linear::Matrix;
use crate::linear::fma::fma;
use nalgebra::Vector2;

impl<D: Density<M>, const M: usize> Integral<D, M> {
    pub(super) fn tangent_within<const W: usize>(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let points = self.table.points_per_cell;
        let products = &mut workspace.lanes;
        products.resize(points * 2 * M * (W / 2), Lanes::ZERO);
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let rows = rows.as_chunks::<W>().0;
            let first = self.first(cell);
            let range = first..first + 2 * W;
            let here = coefficients::<W>(&q[range.clone()]);
            let earlier = earlier
                .map(|earlier| [earlier.q, earlier.increment].map(|q| coefficients::<W>(&q[range.clone()])));
            let mut sums = [[0.0; 2]; W];
            let by_point = weights.iter().zip(rows.chunks_exact(M)).zip(products.chunks_exact_mut(M * W));
            for (p, ((weight, rows), products)) in by_point.enumerate() {
                let weight = factor * weight;
                let z = fields::<M, W>(rows, &here);
                let [before, change] = match &earlier {
                    Some([before, increment]) => {
                        [fields::<M, W>(rows, before), fields::<M, W>(rows, increment)]
                    }
                    None => [z, [Vector2::zeros(); M]],
                };
                let (gradient, hessian) =
                    self.density.gradient_and_hessian(cell * points + p, &z, &before, &change);
                for (g, row) in gradient.iter().zip(rows) {
                    let g = [weight * g.x, weight * g.y];
                    for a in 0..W {
                        sums[a] = [fma(row[a], g[0], sums[a][0]), fma(row[a], g[1], sums[a][1])];
                    }
                }
                for m in 0..M {
                    for d in 0..2 {
                        let h: [Lanes; M] = std::array::from_fn(|n| {
                            let (x, y) = (weight * hessian[m][n][(d, 0)], weight * hessian[m][n][(d, 1)]);
                            Lanes::new([x, y, x, y])
                        });
                        let out = &mut products[(2 * m + d) * (W / 2)..(2 * m + d + 1) * (W / 2)];
                        for b in 0..W / 2 {
                            let mut sum = Lanes::ZERO;
                            for n in 0..M {
                                let [one, other] = [rows[n][2 * b], rows[n][2 * b + 1]];
                                sum = h[n].mul_add(Lanes::new([one, one, other, other]), sum);
                            }
                            out[b] = sum;
                        }
                    }
                }
            }
            for (f, sum) in f[range].as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
                *f = [f[0] + sum[0], f[1] + sum[1]];
            }
            add_tiles::<M, W>(rows, products, first / 4, k);
        }
    }
}

/// The coefficients of a cell.
#[inline(always)]
fn coefficients<const W: usize>(q: &[f64]) -> [[f64; 2]; W] {
    let mut here = [[0.0; 2]; W];
    here.copy_from_slice(&q.as_chunks().0[..W]);
    here
}

/// The local fields at a point.
#[inline(always)]
fn fields<const M: usize, const W: usize>(rows: &[[f64; W]], here: &[[f64; 2]; W]) -> Gradient<M> {
    let mut z = [Vector2::zeros(); M];
    for (z, row) in z.iter_mut().zip(rows) {
        for a in 0..W {
            *z = Vector2::new(fma(row[a], here[a][0], z.x), fma(row[a], here[a][1], z.y));
        }
    }
    z
}

/// Adds all tiles of a cell to the matrix; the cell's first node is `node` of the system.
#[inline(always)]
fn add_tiles<const M: usize, const W: usize>(
    rows: &[[f64; W]],
    products: &[Lanes],
    node: usize,
    k: &mut Matrix,
) {
    match k {
        Matrix::Symmetric(matrix) => {
            let stride = matrix.stride();
            for a in 0..W / 2 {
                let panel = matrix.panel_mut(node + a);
                for b in a..W / 2 {
                    for (r, values) in tile::<M, W>(rows, products, a, b).into_iter().enumerate() {
                        add_to(&mut panel[r * stride + 4 * (b - a)..], values);
                    }
                }
            }
        }
        Matrix::General(matrix) => {
            for a in 0..W / 2 {
                for b in 0..W / 2 {
                    for (r, values) in tile::<M, W>(rows, products, a, b).into_iter().enumerate() {
                        add_to(matrix.row_mut(4 * (node + a) + r, 4 * (node + b), 4), values);
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn add_to(target: &mut [f64], values: Lanes) {
    if let Some(target) = target.first_chunk_mut() {
        *target = (Lanes::new(*target) + values).to_array();
    }
}

/// Rows of node `a`, columns of node `b`: Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md.
#[inline(always)]
fn tile<const M: usize, const W: usize>(
    rows: &[[f64; W]],
    products: &[Lanes],
    a: usize,
    b: usize,
) -> [Lanes; 4] {
    let mut tile = [Lanes::ZERO; 4];
    for (row, products) in rows.iter().zip(products.chunks_exact(W)) {
        let (one, other) = (Lanes::splat(row[2 * a]), Lanes::splat(row[2 * a + 1]));
        for d in 0..2 {
            let product = products[d * (W / 2) + b];
            tile[d] = one.mul_add(product, tile[d]);
            tile[2 + d] = other.mul_add(product, tile[2 + d]);
        }
    }
    tile
}
