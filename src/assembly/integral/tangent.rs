//! Force and tangent of the cells of a table whose width is known at compile time.
//!
//! Each cell takes two passes. The first evaluates the density at the cell's points and multiplies
//! its second derivatives by the rows:
//!
//! ```text
//! P_md = w Σ_n H_mn(d, ·) N⁽ᵒⁿ⁾        (2 M rows of 2 W numbers per point)
//! ```
//!
//! The second adds Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md to row (a, d) of the matrix, one tile of 4 × 4 numbers
//! (two nodes) at a time, so that the tile stays in registers during the loop over the points and
//! is loaded and stored once per cell. Of a symmetric matrix only the tiles on and above the
//! diagonal are computed.
//!
//! Equal cable elements are summed four at a time, each in its own lane, because the work around
//! their few tiles costs more than the tiles. Wider cells have many tiles; they are summed one at a
//! time, with four columns of a tile in the lanes.

use super::CABLE;
use super::force::{coefficients, fields, fields_of_four, sums_of_points};
use crate::assembly::{Density, Earlier, Integral, Workspace};
use crate::lanes::fma;
use crate::lanes::{self, Lanes, Pair, Points};
use crate::linear::Matrix;
use crate::linear::band::Band;
use crate::linear::symmetric::Panels;
use crate::threads::{self, BLOCK, LONG};
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
        let [fours, singles] = if self.tangents_by_ones.is_empty() {
            [&self.fours[..], &self.singles[..]]
        } else {
            [&[][..], &self.tangents_by_ones[..]]
        };
        let at = At { factor, q, earlier };
        let k = match k {
            Matrix::Symmetric(band) if self.table.cells.len() >= LONG => band,
            Matrix::Symmetric(band) => {
                let (f, k) = ((f, 0), &mut Rows::Panels(band.panels_mut()));
                return self.tangents_of::<W>([fours, singles], at, f, k, workspace);
            }
            Matrix::General(band) => {
                return self.tangents_of::<W>([fours, singles], at, (f, 0), &mut Rows::Band(band), workspace);
            }
        };
        // As for the forces alone.
        threads::each(([f.as_chunks_mut::<4>().0], k.panels_mut()), &|range, ([f], panels)| {
            let range = 4 * range.start..4 * range.end;
            let cells = [
                self.inside(fours, 2 * CABLE + 12, range.clone()),
                self.inside(singles, 2 * W, range.clone()),
            ];
            let f = (f.as_flattened_mut(), range.start);
            self.tangents_of::<W>(cells, at, f, &mut Rows::Panels(panels), &mut Workspace::default());
        });
        for end in (4 * BLOCK..f.len()).step_by(4 * BLOCK) {
            let cells = [self.across(fours, 2 * CABLE + 12, end), self.across(singles, 2 * W, end)];
            self.tangents_of::<W>(cells, at, (&mut *f, 0), &mut Rows::Panels(k.panels_mut()), workspace);
        }
    }

    /// Adds the forces and the tangents of cells by fours, and of single ones. `f` begins with the
    /// coordinate of the given number.
    fn tangents_of<const W: usize>(
        &self,
        [fours, singles]: [&[u32]; 2],
        at: At<'_>,
        (f, start): (&mut [f64], usize),
        k: &mut Rows<'_>,
        workspace: &mut Workspace,
    ) {
        // A condition on a constant alone: for other densities the loops by fours are not compiled.
        #[expect(clippy::collapsible_if, reason = "together they would not be such a condition")]
        if D::TANGENTS_BY_FOURS {
            if W == CABLE {
                match self.table.points_per_cell {
                    2 => self.tangents_of_fours::<2>(fours, at, (f, start), k, workspace),
                    3 => self.tangents_of_fours::<3>(fours, at, (f, start), k, workspace),
                    4 if Self::COMMON => self.tangents_of_fours::<4>(fours, at, (f, start), k, workspace),
                    5 if Self::COMMON => self.tangents_of_fours::<5>(fours, at, (f, start), k, workspace),
                    _ => {}
                }
            }
        }
        for &cell in singles {
            let first = self.first(cell as usize) - start;
            self.tangent_of_cell::<W>(cell as usize, at, &mut f[first..first + 2 * W], k, workspace);
        }
    }

    /// `f` is the part of the vector that belongs to the cell.
    fn tangent_of_cell<const W: usize>(
        &self,
        cell: usize,
        At { factor, q, earlier }: At<'_>,
        f: &mut [f64],
        k: &mut Rows<'_>,
        workspace: &mut Workspace,
    ) {
        let points = self.table.points_per_cell;
        // Arrays of known lengths: the compiler then drops the checks of bounds in the loops.
        let products = &mut workspace.lanes;
        products.resize(points * M * W, Lanes::ZERO);
        let products = products.as_chunks_mut::<W>().0;
        let (weights, rows) = self.table.block(self.table.cells[cell]);
        let rows = rows.as_chunks::<W>().0;
        let first = self.first(cell);
        let range = first..first + 2 * W;
        let here = coefficients::<W>(&q[range.clone()]);
        let earlier = earlier.map(|Earlier { q, increment }| {
            [coefficients::<W>(&q[range.clone()]), coefficients(&increment[range.clone()])]
        });
        let mut sums = [[0.0; 2]; W];
        let by_point = weights.iter().zip(rows.as_chunks::<M>().0).zip(products.as_chunks_mut::<M>().0);
        for (p, ((weight, rows), products)) in by_point.enumerate() {
            let weight = factor * weight;
            let z = fields::<M, W>(rows, &here);
            let [before, change] = match &earlier {
                Some([q, increment]) => [fields(rows, q), fields(rows, increment)],
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
                    let mut h = [Lanes::ZERO; M];
                    for (h, block) in h.iter_mut().zip(&hessian[m]) {
                        let (x, y) = (weight * block[(d, 0)], weight * block[(d, 1)]);
                        *h = Lanes::new([x, y, x, y]);
                    }
                    for b in 0..W / 2 {
                        let mut sum = Lanes::ZERO;
                        for n in 0..M {
                            let [one, other] = [rows[n][2 * b], rows[n][2 * b + 1]];
                            sum = h[n].mul_add(Lanes::new([one, one, other, other]), sum);
                        }
                        products[m][d * (W / 2) + b] = sum;
                    }
                }
            }
        }
        for (f, sum) in f.as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
            *f = [f[0] + sum[0], f[1] + sum[1]];
        }
        add_tiles(k, first / 4, rows, products);
    }

    /// Cable elements that are grouped by four, with `P` points in each.
    fn tangents_of_fours<const P: usize>(
        &self,
        fours: &[u32],
        At { factor, q, earlier }: At<'_>,
        (f, start): (&mut [f64], usize),
        k: &mut Rows<'_>,
        workspace: &mut Workspace,
    ) {
        let products = &mut workspace.pairs;
        products.resize(P * M * 2 * CABLE, [Lanes::ZERO; 2]);
        let products = products.as_chunks_mut::<CABLE>().0.as_chunks_mut::<2>().0.as_chunks_mut::<M>().0;
        for &cell in fours {
            let cell = cell as usize;
            let first = self.first(cell);
            let range = first..first + 2 * CABLE + 12;
            let (weights, rows) = self.table.block(self.table.cells[cell]);
            let (weights, rows) = (&weights[..P], &rows.as_chunks::<CABLE>().0[..P * M]);
            let here = lanes::gather::<CABLE>(&q[range.clone()]);
            let earlier = earlier.map(|Earlier { q, increment }| {
                [lanes::gather::<CABLE>(&q[range.clone()]), lanes::gather(&increment[range.clone()])]
            });
            let mut gradients = [[[Lanes::ZERO; 2]; M]; P];
            for p in 0..P {
                let rows = &rows[p * M..(p + 1) * M];
                let z = fields_of_four::<M, CABLE>(rows, &here);
                let [before, change] = match &earlier {
                    Some([q, increment]) => [fields_of_four(rows, q), fields_of_four(rows, increment)],
                    None => [z, [[Lanes::ZERO; 2]; M]],
                };
                let points = Points { first: cell * P + p, stride: P };
                let states = [&z, &before, &change];
                let (gradient, hessian) =
                    self.density.gradients_and_hessians(factor * weights[p], points, states);
                gradients[p] = gradient;
                for m in 0..M {
                    for d in 0..2 {
                        for b in 0..CABLE {
                            products[p][m][d][b] = hessian[m][0][d].map(|h| h * Lanes::splat(rows[0][b]));
                            for n in 1..M {
                                let shape = Lanes::splat(rows[n][b]);
                                for e in 0..2 {
                                    let sum = &mut products[p][m][d][b][e];
                                    *sum = hessian[m][n][d][e].mul_add(shape, *sum);
                                }
                            }
                        }
                    }
                }
            }
            let f = &mut f[range.start - start..range.end - start];
            lanes::scatter(&sums_of_points::<M, CABLE, P>(rows, &gradients), f);
            add_tiles_of_fours::<M, P>(k, first / 4, rows, products);
        }
    }
}

/// Where forces and tangents are taken.
#[derive(Clone, Copy)]
struct At<'v> {
    factor: f64,
    q: &'v [f64],
    earlier: Option<Earlier<'v>>,
}

/// Rows of a matrix under assembly.
enum Rows<'k> {
    /// Of some nodes, of a symmetric one.
    Panels(Panels<'k>),
    /// All, of another.
    Band(&'k mut Band),
}

/// Adds the tiles of a cell whose first node has the given number. It is the same for all densities, and
/// compiled once for all of them.
#[inline(never)]
fn add_tiles<const W: usize>(k: &mut Rows<'_>, node: usize, rows: &[[f64; W]], products: &[[Lanes; W]]) {
    match k {
        Rows::Panels(panels) => {
            for a in 0..W / 2 {
                let (panel, stride) = panels.panel_mut(node + a);
                for b in a..W / 2 {
                    for (r, values) in tile(rows, products, a, b).iter().enumerate() {
                        add_to(&mut panel[r * stride + 4 * (b - a)..], *values);
                    }
                }
            }
        }
        Rows::Band(_) => {
            for_tiles::<W>(k, |k, a, b| add_tile(k, node + a, node + b, &tile(rows, products, a, b)));
        }
    }
}

/// [`add_tiles`] of four cells with `P` points each, the first of which begins with the given node.
#[inline(never)]
fn add_tiles_of_fours<const M: usize, const P: usize>(
    k: &mut Rows<'_>,
    node: usize,
    rows: &[[f64; CABLE]],
    products: &[[[[Pair<Lanes>; CABLE]; 2]; M]],
) {
    for_tiles::<CABLE>(k, |k, a, b| {
        let mut tiles = [[Lanes::ZERO; 4]; 4];
        tiles_of_four::<M, CABLE, P>(rows, products, [a, b], &mut tiles);
        for (node, tile) in (node..).zip(&tiles) {
            add_tile(k, node + a, node + b, tile);
        }
    });
}

/// Calls `add` for each tile of a cell that `k` needs, with the indices of its two nodes within the
/// cell.
#[inline(always)]
fn for_tiles<'k, const W: usize>(k: &mut Rows<'k>, mut add: impl FnMut(&mut Rows<'k>, usize, usize)) {
    let below = matches!(k, Rows::Band(_));
    for a in 0..W / 2 {
        for b in if below { 0 } else { a }..W / 2 {
            add(k, a, b);
        }
    }
}

/// Adds a tile to the rows of node `a` and the columns of node `b`.
#[inline(always)]
fn add_tile(k: &mut Rows<'_>, a: usize, b: usize, tile: &[Lanes; 4]) {
    match k {
        Rows::Panels(panels) => {
            let (panel, stride) = panels.panel_mut(a);
            let columns = &mut panel[4 * (b - a)..];
            for (r, values) in tile.iter().enumerate() {
                add_to(&mut columns[r * stride..], *values);
            }
        }
        Rows::Band(matrix) => {
            for (r, values) in tile.iter().enumerate() {
                add_to(matrix.row_mut(4 * a + r, 4 * b, 4), *values);
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

/// The tile in the rows of node `a` and the columns of node `b`: Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md.
#[inline(always)]
fn tile<const W: usize>(rows: &[[f64; W]], products: &[[Lanes; W]], a: usize, b: usize) -> [Lanes; 4] {
    let mut tile = [Lanes::ZERO; 4];
    for (row, products) in rows.iter().zip(products) {
        let (one, other) = (Lanes::splat(row[2 * a]), Lanes::splat(row[2 * a + 1]));
        for d in 0..2 {
            let product = products[d * (W / 2) + b];
            tile[d] = one.mul_add(product, tile[d]);
            tile[2 + d] = other.mul_add(product, tile[2 + d]);
        }
    }
    tile
}

/// The tiles of four cells, one per cell.
#[inline(always)]
fn tiles_of_four<const M: usize, const W: usize, const P: usize>(
    rows: &[[f64; W]],
    products: &[[[[Pair<Lanes>; W]; 2]; M]],
    [a, b]: [usize; 2],
    tiles: &mut [[Lanes; 4]; 4],
) {
    for function in 0..2 {
        #[expect(clippy::needless_range_loop)]
        for d in 0..2 {
            let [mut x, mut y, mut along, mut across] = [Lanes::ZERO; 4];
            for p in 0..P {
                for m in 0..M {
                    let shape = Lanes::splat(rows[p * M + m][2 * a + function]);
                    let [one, other] = [&products[p][m][d][2 * b], &products[p][m][d][2 * b + 1]];
                    x = shape.mul_add(one[0], x);
                    y = shape.mul_add(one[1], y);
                    along = shape.mul_add(other[0], along);
                    across = shape.mul_add(other[1], across);
                }
            }
            let [first, second, third, fourth] = Lanes::transpose([x, y, along, across]);
            let r = 2 * function + d;
            tiles[0][r] = first;
            tiles[1][r] = second;
            tiles[2][r] = third;
            tiles[3][r] = fourth;
        }
    }
}
