//! Forces of the cells of a table whose width is known at compile time.
//!
//! The four lanes of a register hold either four equal cells, each one node after the cell before,
//! or one cell in four states, which are the stages of a collocation method. By fours, an element
//! takes 40 % of the instructions that it takes alone; the compiler did not vectorise the loops by
//! itself.

use crate::assembly::{Density, Gradient, Integral};
use crate::lanes::fma;
use crate::lanes::{self, Lanes, Pair, Points};
use crate::threads::{self, BLOCK, LONG};
use nalgebra::Vector2;
use std::ops::Range;

impl<D: Density<M>, const M: usize> Integral<D, M> {
    pub(super) fn force_within<const W: usize>(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        if self.table.cells.len() < LONG {
            return self.forces_of::<W>([&self.fours, &self.singles], factor, q, f, 0);
        }
        // Cells that reach from one block of nodes into the next come after all others.
        let nodes = f.as_chunks_mut::<4>().0;
        threads::each([nodes], &|range, [nodes]| {
            let range = 4 * range.start..4 * range.end;
            let fours = self.inside(&self.fours, 2 * W + 12, range.clone());
            let singles = self.inside(&self.singles, 2 * W, range.clone());
            let (q, f) = (&q[range.clone()], nodes.as_flattened_mut());
            self.forces_of::<W>([fours, singles], factor, q, f, range.start);
        });
        for end in (4 * BLOCK..f.len()).step_by(4 * BLOCK) {
            let fours = self.across(&self.fours, 2 * W + 12, end);
            let singles = self.across(&self.singles, 2 * W, end);
            self.forces_of::<W>([fours, singles], factor, q, f, 0);
        }
    }

    /// Those of the rising `cells` whose `width` coordinates all lie within `range`.
    pub(super) fn inside<'c>(&self, cells: &'c [u32], width: usize, range: Range<usize>) -> &'c [u32] {
        let from = cells.partition_point(|cell| self.first(*cell as usize) < range.start);
        let to = cells.partition_point(|cell| self.first(*cell as usize) + width <= range.end);
        &cells[from..to.max(from)]
    }

    /// Those of the rising `cells` whose `width` coordinates lie before and behind `end`.
    pub(super) fn across<'c>(&self, cells: &'c [u32], width: usize, end: usize) -> &'c [u32] {
        let from = cells.partition_point(|cell| self.first(*cell as usize) + width <= end);
        let to = cells.partition_point(|cell| self.first(*cell as usize) < end);
        &cells[from..to.max(from)]
    }

    /// Adds the forces of cells by fours and of single ones to `f`, which begins with coordinate number
    /// `start`, as `q` does.
    fn forces_of<const W: usize>(
        &self,
        [fours, singles]: [&[u32]; 2],
        factor: f64,
        q: &[f64],
        f: &mut [f64],
        start: usize,
    ) {
        if D::BY_FOURS {
            match self.table.points_per_cell {
                2 => self.forces_of_fours::<W, 2>(fours, factor, q, f, start),
                3 => self.forces_of_fours::<W, 3>(fours, factor, q, f, start),
                4 if Self::COMMON => self.forces_of_fours::<W, 4>(fours, factor, q, f, start),
                5 if Self::COMMON => self.forces_of_fours::<W, 5>(fours, factor, q, f, start),
                _ => {}
            }
        }
        for &cell in singles {
            let cell = cell as usize;
            let first = self.first(cell) - start;
            let range = first..first + 2 * W;
            self.force_of_cell::<W>(cell, factor, &q[range.clone()], &mut f[range]);
        }
    }

    /// `q` and `f` are the parts of the vectors that belong to the cell.
    #[inline(always)]
    fn force_of_cell<const W: usize>(&self, cell: usize, factor: f64, q: &[f64], f: &mut [f64]) {
        let (weights, rows) = self.table.block(self.table.cells[cell]);
        // Coefficients and sums stay in registers during the loop over the points.
        let here = coefficients::<W>(q);
        let mut sums = [[0.0; 2]; W];
        for (p, (weight, rows)) in weights.iter().zip(rows.as_chunks::<W>().0.chunks_exact(M)).enumerate() {
            let weight = factor * weight;
            let gradient = self.density.gradient(cell * weights.len() + p, &fields(rows, &here));
            for (g, row) in gradient.iter().zip(rows) {
                let g = [weight * g.x, weight * g.y];
                for a in 0..W {
                    sums[a] = [fma(row[a], g[0], sums[a][0]), fma(row[a], g[1], sums[a][1])];
                }
            }
        }
        for (f, sum) in f.as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
            *f = [f[0] + sum[0], f[1] + sum[1]];
        }
    }

    /// The forces of cells that are grouped by four, with `P` points in each.
    fn forces_of_fours<const W: usize, const P: usize>(
        &self,
        fours: &[u32],
        factor: f64,
        q: &[f64],
        f: &mut [f64],
        start: usize,
    ) {
        for &cell in fours {
            let cell = cell as usize;
            let first = self.first(cell) - start;
            let range = first..first + 2 * W + 12;
            let here = lanes::gather::<W>(&q[range.clone()]);
            let sums = self.sums_of_four::<W, P>(cell, P, factor, &here);
            lanes::scatter(&sums, &mut f[range]);
        }
    }

    /// Forces on the coefficients `here` of four cells, the first of them `cell`, whose points are
    /// numbered `stride` apart; or of one cell in four states, with `stride` 0.
    #[inline(always)]
    fn sums_of_four<const W: usize, const P: usize>(
        &self,
        cell: usize,
        stride: usize,
        factor: f64,
        here: &[Pair<Lanes>; W],
    ) -> [Pair<Lanes>; W] {
        let (weights, rows) = self.table.block(self.table.cells[cell]);
        let (weights, rows) = (&weights[..P], &rows.as_chunks::<W>().0[..P * M]);
        // The gradients at all points come first: the sums would not fit into the registers beside
        // the coefficients.
        let mut gradients = [[[Lanes::ZERO; 2]; M]; P];
        for p in 0..P {
            let z = fields_of_four(&rows[p * M..(p + 1) * M], here);
            let points = Points { first: cell * P + p, stride };
            gradients[p] = self.density.gradients(factor * weights[p], points, &z);
        }
        // `black_box` makes the compiler load the rows again. Kept from above, they would be
        // spilled to the stack, since all registers are in use.
        sums_of_points(std::hint::black_box(rows), &gradients)
    }

    /// The forces of all cells in four states, one per lane.
    pub(super) fn forces_in_lanes<const W: usize>(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes]) {
        if D::BY_FOURS {
            match self.table.points_per_cell {
                2 => return self.forces_in_lanes_of::<W, 2>(factors, q, f),
                3 => return self.forces_in_lanes_of::<W, 3>(factors, q, f),
                4 if Self::COMMON => return self.forces_in_lanes_of::<W, 4>(factors, q, f),
                5 if Self::COMMON => return self.forces_in_lanes_of::<W, 5>(factors, q, f),
                _ => {}
            }
        }
        self.forces_in_lanes_by_points::<W>(factors, q, f);
    }

    fn forces_in_lanes_of<const W: usize, const P: usize>(
        &self,
        factors: Lanes,
        q: &[Lanes],
        f: &mut [Lanes],
    ) {
        for cell in 0..self.table.cells.len() {
            let first = self.first(cell);
            let range = first..first + 2 * W;
            let Some(here) = q[range.clone()].as_chunks::<2>().0.first_chunk::<W>() else { continue };
            let sums = self.sums_of_four::<W, P>(cell, 0, 1.0, here);
            add_sums(factors, &sums, &mut f[range]);
        }
    }

    /// The same for any number of points, one after the other.
    fn forces_in_lanes_by_points<const W: usize>(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes]) {
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let first = self.first(cell);
            let range = first..first + 2 * W;
            let Some(here) = q[range.clone()].as_chunks::<2>().0.first_chunk::<W>() else { continue };
            let (weights, rows) = self.table.block(*entry);
            let mut sums = [[Lanes::ZERO; 2]; W];
            for (p, (weight, rows)) in weights.iter().zip(rows.as_chunks::<W>().0.chunks_exact(M)).enumerate()
            {
                let points = Points { first: cell * weights.len() + p, stride: 0 };
                let gradients = self.density.gradients(*weight, points, &fields_of_four(rows, here));
                for (row, g) in rows.iter().zip(&gradients) {
                    for (n, sum) in row.iter().zip(&mut sums) {
                        let n = Lanes::splat(*n);
                        *sum = [n.mul_add(g[0], sum[0]), n.mul_add(g[1], sum[1])];
                    }
                }
            }
            add_sums(factors, &sums, &mut f[range]);
        }
    }
}

/// Adds the forces on a cell's coefficients in four states, each times its factor.
#[inline(always)]
fn add_sums<const W: usize>(factors: Lanes, sums: &[Pair<Lanes>; W], f: &mut [Lanes]) {
    for (f, sum) in f.as_chunks_mut::<2>().0.iter_mut().zip(sums) {
        *f = [factors.mul_add(sum[0], f[0]), factors.mul_add(sum[1], f[1])];
    }
}

/// The coefficients of a cell as pairs (x, y).
#[inline(always)]
pub(super) fn coefficients<const W: usize>(q: &[f64]) -> [Pair<f64>; W] {
    let mut here = [[0.0; 2]; W];
    here.copy_from_slice(&q.as_chunks().0[..W]);
    here
}

/// The local fields at a point, from its `M` rows.
#[inline(always)]
pub(super) fn fields<const M: usize, const W: usize>(
    rows: &[[f64; W]],
    here: &[Pair<f64>; W],
) -> Gradient<M> {
    let mut z = [Vector2::zeros(); M];
    for (z, row) in z.iter_mut().zip(rows) {
        for a in 0..W {
            *z = Vector2::new(fma(row[a], here[a][0], z.x), fma(row[a], here[a][1], z.y));
        }
    }
    z
}

/// The local fields at four points.
#[inline(always)]
pub(super) fn fields_of_four<const M: usize, const W: usize>(
    rows: &[[f64; W]],
    here: &[Pair<Lanes>; W],
) -> [Pair<Lanes>; M] {
    let mut z = [[Lanes::ZERO; 2]; M];
    for (z, row) in z.iter_mut().zip(rows) {
        for (n, here) in row.iter().zip(here) {
            let n = Lanes::splat(*n);
            *z = [n.mul_add(here[0], z[0]), n.mul_add(here[1], z[1])];
        }
    }
    z
}

/// Forces on the coefficients, from the gradients at all points.
#[inline(always)]
pub(super) fn sums_of_points<const M: usize, const W: usize, const P: usize>(
    rows: &[[f64; W]],
    gradients: &[[Pair<Lanes>; M]; P],
) -> [Pair<Lanes>; W] {
    let mut sums = [[Lanes::ZERO; 2]; W];
    for (a, sum) in sums.iter_mut().enumerate() {
        for (p, gradients) in gradients.iter().enumerate() {
            for (m, g) in gradients.iter().enumerate() {
                let n = Lanes::splat(rows[p * M + m][a]);
                *sum = [n.mul_add(g[0], sum[0]), n.mul_add(g[1], sum[1])];
            }
        }
    }
    sums
}
