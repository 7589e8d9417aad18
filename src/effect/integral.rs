//! The sum of a density over a table of shape functions: where the time of a Newton iteration goes.
//!
//! The work is dispatched once per effect on the table's width, so that the loops below are compiled with the number
//! of functions known (4 for the cable element; 8, 10 and 12 for radial point interpolation), and runs in two passes
//! per cell. The first evaluates the density at the cell's points and multiplies its second derivatives into the rows,
//!
//! ```text
//! P_md = w Σ_n H_mn(d, ·) N⁽ᵒⁿ⁾        (2 M rows of 2 W numbers, x and y interleaved, per point)
//! ```
//!
//! the second adds Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md to row (a, d) of the matrix, a tile of 4 × 4 numbers (two nodes) at a
//! time, so that the tile stays in registers while the points go by and is loaded and stored once per cell. Of a
//! symmetric matrix only the tiles on and above the diagonal are computed.
//!
//! # What was measured
//! A Newton iteration of 1000 cable elements with 5/3 points takes 0.31 µs an element on one core of a 2023 server
//! (0.34 µs with 10 000, 0.46 µs with 100 000, where the matrices leave the caches): 0.19 µs are spent here, 0.04 µs in the
//! LDLᵀ, the rest in the substitutions and the supports. The tiles' 528 multiply–adds would take 0.02 µs at the machine's
//! peak: what bounds this loop are the short dependent sums of the local fields and the divisions of the curvature, not
//! the tiles. Fields are summed two functions at a time, x and y of both in the four lanes of a register; without a closure around the
//! loop, which the compiler does not inline. With 12 functions that halves the instructions of a force, with 4 it changes
//! nothing.
//!
//! A force alone keeps the cell's coordinates and sums in registers: 520 instructions an element with 5/3 points, a third of what the
//! same loop over slices took. A step of the trapezoidal rule (30 elements, 1 ms, two iterations with a kept tangent) takes 76 000 instructions:
//! 41 % are forces, 11 % substitutions, 9 % products with the mass matrix, 3 % new tangents, the rest passes over vectors. The windows in
//! registers of [`crate::linear::symmetric`] made substitution and product six times as short as loops over slices. Four elements side by
//! side in the lanes of the registers were tried for forces, with densities written for arrays: the compiler kept them scalar, and a tenth was gained.
//!
//! Gauss collocation on 20 RPIM nodes (three stages, 5 ms, 8 iterations a step) takes 1.44 million instructions a step: a third are forces, a
//! quarter the tangent with its real and its complex factorisation, a fifth substitutions, a tenth products with the mass matrix.

use super::{Density, Earlier, Effect, Gradient, Hessian, Kind};
use crate::basis::BasisTable;
use crate::lanes::{self, Lanes, Pair, Points};
use crate::linear::Matrix;
use crate::linear::fma::fma;
use nalgebra::Vector2;

/// Memory that the assembly of a cell uses; kept by the caller so that nothing is allocated in the loops.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    products: Vec<f64>,
    pub(super) lanes: Vec<Lanes>,
}

/// A density, the shape functions at its quadrature points, and the place of its beam among the coordinates.
#[derive(Clone, Debug)]
pub struct Integral<D, const M: usize> {
    pub(super) kind: Kind,
    pub(super) beam: usize,
    /// First coefficient of the beam; coefficient c has the coordinates 2c and 2c + 1.
    offset: usize,
    pub(super) table: BasisTable,
    /// First cells of four that are alike, each a node further than the one before, and all cells that are in no such four.
    fours: Vec<u32>,
    singles: Vec<u32>,
    pub(super) density: D,
}

/// Points in a cell with which cells are summed four at a time.
const POINTS_BY_FOURS: std::ops::RangeInclusive<usize> = 2..=5;

/// `f(const width, arguments…)`, the width a compile-time constant for the common tables and 0 for all others.
macro_rules! with_width {
    ($self:ident . $method:ident ( $($argument:expr),* )) => {
        match $self.table.width {
            4 => $self.$method::<4>($($argument),*),
            8 => $self.$method::<8>($($argument),*),
            12 => $self.$method::<12>($($argument),*),
            _ => $self.$method::<0>($($argument),*),
        }
    };
}

impl<D: Density<M>, const M: usize> Integral<D, M> {
    /// `offset` is the beam's first coefficient (two per node) in the system; `table` must hold the rows
    /// [`Density::ORDERS`].
    pub fn new(kind: Kind, beam: usize, offset: usize, table: BasisTable, density: D) -> Self {
        debug_assert_eq!(table.orders, D::ORDERS);
        let (fours, singles) = if D::BY_FOURS && POINTS_BY_FOURS.contains(&table.points_per_cell) {
            table.by_fours()
        } else {
            (Vec::new(), (0..table.cells.len() as u32).collect())
        };
        Self { kind, beam, offset, table, fours, singles, density }
    }

    fn width<const W: usize>(&self) -> usize {
        if W == 0 { self.table.width } else { W }
    }

    /// Local fields of `q` from the rows of one point; `q` starts at the cell's first coefficient.
    #[inline(always)]
    fn fields<const W: usize>(&self, rows: &[f64], q: &[f64]) -> Gradient<M> {
        let width = self.width::<W>();
        let mut fields = [Vector2::zeros(); M];
        for (field, row) in fields.iter_mut().zip(rows.chunks_exact(width)) {
            // Two functions at a time in the four lanes of a register.
            let mut sum = [0.0; 4];
            for (n, q) in row.chunks_exact(2).zip(q[..2 * width].chunks_exact(4)) {
                let n = [n[0], n[0], n[1], n[1]];
                for lane in 0..4 {
                    sum[lane] = fma(n[lane], q[lane], sum[lane]);
                }
            }
            *field = Vector2::new(sum[0] + sum[2], sum[1] + sum[3]);
        }
        fields
    }

    #[inline(always)]
    fn add_gradient<const W: usize>(&self, weight: f64, rows: &[f64], gradient: &Gradient<M>, f: &mut [f64]) {
        let width = self.width::<W>();
        for (m, g) in gradient.iter().enumerate() {
            let (gx, gy) = (weight * g.x, weight * g.y);
            let g = [gx, gy, gx, gy];
            let row = &rows[m * width..(m + 1) * width];
            for (n, f) in row.chunks_exact(2).zip(f[..2 * width].chunks_exact_mut(4)) {
                let n = [n[0], n[0], n[1], n[1]];
                for lane in 0..4 {
                    f[lane] = fma(n[lane], g[lane], f[lane]);
                }
            }
        }
    }

    fn energy_of<const W: usize>(&self, q: &[f64]) -> f64 {
        let width = self.width::<W>();
        let mut sum = 0.0;
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let q = &q[2 * (self.offset + entry.first as usize)..];
            for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
                let z = self.fields::<W>(rows, q);
                sum += weight * self.density.energy(cell * weights.len() + p, &z);
            }
        }
        sum
    }

    fn force_any(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        let width = self.table.width;
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let (q, f) = (&q[first..first + 2 * width], &mut f[first..first + 2 * width]);
            for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
                let z = self.fields::<0>(rows, q);
                let gradient = self.density.gradient(cell * weights.len() + p, &z);
                self.add_gradient::<0>(factor * weight, rows, &gradient, f);
            }
        }
    }

    fn force_within<const W: usize>(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        if D::BY_FOURS {
            match self.table.points_per_cell {
                2 => self.forces_of_fours::<W, 2>(factor, q, f),
                3 => self.forces_of_fours::<W, 3>(factor, q, f),
                4 => self.forces_of_fours::<W, 4>(factor, q, f),
                5 => self.forces_of_fours::<W, 5>(factor, q, f),
                _ => {}
            }
        }
        for &cell in &self.singles {
            let cell = cell as usize;
            let first = self.first(cell);
            let range = first..first + 2 * W;
            self.force_of_cell::<W>(cell, factor, &q[range.clone()], &mut f[range]);
        }
    }

    /// The first coordinate of a cell.
    #[inline(always)]
    pub(super) fn first(&self, cell: usize) -> usize {
        2 * (self.offset + self.table.cells[cell].first as usize)
    }

    /// `q` and `f` are the coefficients of the cell.
    #[inline(always)]
    fn force_of_cell<const W: usize>(&self, cell: usize, factor: f64, q: &[f64], f: &mut [f64]) {
        let (weights, rows) = self.table.block(self.table.cells[cell]);
        // Both stay in registers while the points go by.
        let mut here = [[0.0; 2]; W];
        let mut sums = [[0.0; 2]; W];
        here.copy_from_slice(&q.as_chunks().0[..W]);
        for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * W)).enumerate() {
            let point = cell * weights.len() + p;
            let weight = factor * weight;
            let rows = &rows.as_chunks::<W>().0[..M];
            let mut z = [Vector2::zeros(); M];
            for (z, row) in z.iter_mut().zip(rows) {
                let mut sum = [0.0; 2];
                for a in 0..W {
                    sum[0] = fma(row[a], here[a][0], sum[0]);
                    sum[1] = fma(row[a], here[a][1], sum[1]);
                }
                *z = Vector2::new(sum[0], sum[1]);
            }
            let gradient = self.density.gradient(point, &z);
            for (g, row) in gradient.iter().zip(rows) {
                let g = [weight * g.x, weight * g.y];
                for a in 0..W {
                    sums[a][0] = fma(row[a], g[0], sums[a][0]);
                    sums[a][1] = fma(row[a], g[1], sums[a][1]);
                }
            }
        }
        for (f, sum) in f.as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
            f[0] += sum[0];
            f[1] += sum[1];
        }
    }

    /// The same of all cells that come by fours, `P` points in each.
    fn forces_of_fours<const W: usize, const P: usize>(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        for &cell in &self.fours {
            let cell = cell as usize;
            let first = self.first(cell);
            let range = first..first + 2 * W + 12;
            let here = lanes::gather::<W>(&q[range.clone()]);
            let sums = self.sums_of_four::<W, P>(cell, P, factor, &here);
            lanes::scatter(&sums, &mut f[range]);
        }
    }

    /// Forces on the coefficients `here` of four cells, the first of them `cell` and each with `stride` points more before it; or of one cell in four states, without
    /// a stride.
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
        // All points first: the sums would not fit into the registers beside the coefficients.
        let mut gradients = [[[Lanes::ZERO; 2]; M]; P];
        for p in 0..P {
            let mut z = [[Lanes::ZERO; 2]; M];
            for m in 0..M {
                for a in 0..W {
                    let n = Lanes::splat(rows[p * M + m][a]);
                    z[m] = [n.mul_add(here[a][0], z[m][0]), n.mul_add(here[a][1], z[m][1])];
                }
            }
            let points = Points { first: cell * P + p, stride };
            gradients[p] = self.density.gradients(factor * weights[p], points, &z);
        }
        // Loaded anew: carried on from above they would be stored to and loaded from the stack, as all registers are taken.
        let rows = std::hint::black_box(rows);
        let mut sums = [[Lanes::ZERO; 2]; W];
        for a in 0..W {
            for p in 0..P {
                for m in 0..M {
                    let n = Lanes::splat(rows[p * M + m][a]);
                    let g = gradients[p][m];
                    sums[a] = [n.mul_add(g[0], sums[a][0]), n.mul_add(g[1], sums[a][1])];
                }
            }
        }
        sums
    }

    /// All cells in four states.
    fn forces_in_lanes<const W: usize>(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes]) {
        match self.table.points_per_cell {
            1 => self.forces_in_lanes_of::<W, 1>(factors, q, f),
            2 => self.forces_in_lanes_of::<W, 2>(factors, q, f),
            3 => self.forces_in_lanes_of::<W, 3>(factors, q, f),
            4 => self.forces_in_lanes_of::<W, 4>(factors, q, f),
            _ => self.forces_in_lanes_of::<W, 5>(factors, q, f),
        }
    }

    fn forces_in_lanes_of<const W: usize, const P: usize>(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes]) {
        for cell in 0..self.table.cells.len() {
            let first = self.first(cell);
            let range = first..first + 2 * W;
            let Some(here) = q[range.clone()].as_chunks::<2>().0.first_chunk::<W>() else { continue };
            let sums = self.sums_of_four::<W, P>(cell, 0, 1.0, here);
            for (f, sum) in f[range].as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
                *f = [factors.mul_add(sum[0], f[0]), factors.mul_add(sum[1], f[1])];
            }
        }
    }

    /// `f += ∫ Σ_m N⁽ᵒᵐ⁾ g_m(z, ż) ds` with the fields of `q` and `v`.
    pub(super) fn force_of_pairs(
        &self,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        force: impl Fn(usize, &Gradient<M>, &Gradient<M>) -> Gradient<M>,
    ) {
        match self.table.width {
            4 => self.force_of_pairs_within::<4>(q, v, f, force),
            8 => self.force_of_pairs_within::<8>(q, v, f, force),
            12 => self.force_of_pairs_within::<12>(q, v, f, force),
            _ => self.force_of_pairs_within::<0>(q, v, f, force),
        }
    }

    fn force_of_pairs_within<const W: usize>(
        &self,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        force: impl Fn(usize, &Gradient<M>, &Gradient<M>) -> Gradient<M>,
    ) {
        let width = self.width::<W>();
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let range = first..first + 2 * width;
            let (q, v, f) = (&q[range.clone()], &v[range.clone()], &mut f[range]);
            for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
                let (z, rate) = (self.fields::<W>(rows, q), self.fields::<W>(rows, v));
                let gradient = force(cell * weights.len() + p, &z, &rate);
                self.add_gradient::<W>(*weight, rows, &gradient, f);
            }
        }
    }

    fn product_of<const W: usize>(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        let width = self.width::<W>();
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let range = first..first + 2 * width;
            let (q, v, f) = (&q[range.clone()], &v[range.clone()], &mut f[range]);
            for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
                let (z, change) = (self.fields::<W>(rows, q), self.fields::<W>(rows, v));
                let (_, hessian) = self.density.gradient_and_hessian(
                    cell * weights.len() + p,
                    &z,
                    &z,
                    &[Vector2::zeros(); M],
                );
                let product = std::array::from_fn(|m| {
                    hessian[m].iter().zip(&change).map(|(h, change)| h * change).sum::<Vector2<f64>>()
                });
                self.add_gradient::<W>(factor * weight, rows, &product, f);
            }
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn tangent_any(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let width = self.table.width;
        let columns = 2 * width;
        let products = &mut workspace.products;
        products.resize(self.table.points_per_cell * 2 * M * columns, 0.0);
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let range = first..first + columns;
            let earlier = earlier.map(|earlier| [earlier.q, earlier.increment].map(|q| &q[range.clone()]));
            let (q, f) = (&q[range.clone()], &mut f[range]);
            for (p, ((weight, rows), products)) in weights
                .iter()
                .zip(rows.chunks_exact(M * width))
                .zip(products.chunks_exact_mut(2 * M * columns))
                .enumerate()
            {
                let weight = factor * weight;
                let z = self.fields::<0>(rows, q);
                let [before, change] =
                    earlier.map_or([z, [Vector2::zeros(); M]], |q| q.map(|q| self.fields::<0>(rows, q)));
                let point = cell * weights.len() + p;
                let (gradient, hessian) = self.density.gradient_and_hessian(point, &z, &before, &change);
                self.add_gradient::<0>(weight, rows, &gradient, f);
                multiply_rows::<M>(weight, &hessian, rows, width, products);
            }
            add_tiles::<M>(rows, products, width, first / 4, k);
        }
    }
}

/// `P_md[2b + e] = w Σ_n H_mn(d, e) N_b⁽ᵒⁿ⁾`.
fn multiply_rows<const M: usize>(
    weight: f64,
    hessian: &Hessian<M>,
    rows: &[f64],
    width: usize,
    products: &mut [f64],
) {
    let columns = 2 * width;
    for m in 0..M {
        for d in 0..2 {
            let out = &mut products[(2 * m + d) * columns..(2 * m + d + 1) * columns];
            let h: [[f64; 2]; M] =
                std::array::from_fn(|n| [weight * hessian[m][n][(d, 0)], weight * hessian[m][n][(d, 1)]]);
            for (b, pair) in out.chunks_exact_mut(2).enumerate() {
                let (mut x, mut y) = (0.0, 0.0);
                for n in 0..M {
                    let shape = rows[n * width + b];
                    x = fma(h[n][0], shape, x);
                    y = fma(h[n][1], shape, y);
                }
                pair[0] = x;
                pair[1] = y;
            }
        }
    }
}

/// Adds all tiles of a cell to the matrix; the cell's first node is `node` of the system.
fn add_tiles<const M: usize>(rows: &[f64], products: &[f64], width: usize, node: usize, k: &mut Matrix) {
    let nodes = width / 2;
    match k {
        Matrix::Symmetric(matrix) => {
            let stride = matrix.stride();
            for a in 0..nodes {
                let panel = matrix.panel_mut(node + a);
                for b in a..nodes {
                    let tile = tile::<M>(rows, products, width, a, b);
                    for (r, values) in tile.iter().enumerate() {
                        let start = r * stride + 4 * (b - a);
                        for (target, value) in panel[start..start + 4].iter_mut().zip(values) {
                            *target += value;
                        }
                    }
                }
            }
        }
        Matrix::General(matrix) => {
            for a in 0..nodes {
                for b in 0..nodes {
                    let tile = tile::<M>(rows, products, width, a, b);
                    for (r, values) in tile.iter().enumerate() {
                        let row = matrix.row_mut(4 * (node + a) + r, 4 * (node + b), 4);
                        for (target, value) in row.iter_mut().zip(values) {
                            *target += value;
                        }
                    }
                }
            }
        }
    }
}

/// Rows of node `a`, columns of node `b`: Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md.
fn tile<const M: usize>(rows: &[f64], products: &[f64], width: usize, a: usize, b: usize) -> [[f64; 4]; 4] {
    let columns = 2 * width;
    let mut tile = [[0.0; 4]; 4];
    for (rows, products) in rows.chunks_exact(M * width).zip(products.chunks_exact(2 * M * columns)) {
        for m in 0..M {
            let shape = &rows[m * width + 2 * a..m * width + 2 * a + 2];
            for d in 0..2 {
                let start = (2 * m + d) * columns + 4 * b;
                let product = &products[start..start + 4];
                for e in 0..4 {
                    tile[d][e] = fma(shape[0], product[e], tile[d][e]);
                    tile[2 + d][e] = fma(shape[1], product[e], tile[2 + d][e]);
                }
            }
        }
    }
    tile
}

impl<D: Density<M>, const M: usize> Effect for Integral<D, M> {
    fn kind(&self) -> Kind {
        self.kind
    }

    fn beam(&self) -> usize {
        self.beam
    }

    fn is_symmetric(&self) -> bool {
        D::SYMMETRIC
    }

    fn is_constant(&self) -> bool {
        !D::HAS_TANGENT
    }

    fn is_conservative(&self) -> bool {
        D::CONSERVATIVE
    }

    fn energy(&self, q: &[f64]) -> f64 {
        with_width!(self.energy_of(q))
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        match self.table.width {
            4 => self.force_within::<4>(factor, q, f),
            8 => self.force_within::<8>(factor, q, f),
            12 => self.force_within::<12>(factor, q, f),
            _ => self.force_any(factor, q, f),
        }
    }

    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        let by_fours = self.table.points_per_cell <= *POINTS_BY_FOURS.end();
        match self.table.width {
            4 if by_fours => self.forces_in_lanes::<4>(factors, q, f),
            8 if by_fours => self.forces_in_lanes::<8>(factors, q, f),
            12 if by_fours => self.forces_in_lanes::<12>(factors, q, f),
            _ => {
                let factors = factors.to_array();
                lanes::one_by_one(q, f, scratch, |lane, q, f| self.add_force(factors[lane], q, f));
            }
        }
    }

    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        if !D::HAS_TANGENT {
            return self.add_force(factor, q, f);
        }
        match self.table.width {
            4 => self.tangent_within::<4>(factor, q, earlier, f, k, workspace),
            8 => self.tangent_within::<8>(factor, q, earlier, f, k, workspace),
            12 => self.tangent_within::<12>(factor, q, earlier, f, k, workspace),
            _ => self.tangent_any(factor, q, earlier, f, k, workspace),
        }
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        if D::HAS_TANGENT {
            with_width!(self.product_of(factor, q, v, f));
        }
    }

    fn size(&self) -> (usize, usize) {
        (self.table.cells.len() * self.table.points_per_cell, self.table.bytes())
    }
}
