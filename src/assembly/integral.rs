//! The sum of a density over a table of shape functions, in which much of the time of a Newton
//! iteration is spent.
//!
//! The table's width is dispatched once per effect, so that the inner loops are compiled for a
//! known number of shape functions (4 for the cable element; 8 and 12 for radial point
//! interpolation): forces in `force.rs`, those that depend on velocities, too, in `pairs.rs`,
//! tangents in `tangent.rs`. Other widths are summed by the loops of this file.
//!
//! # Reasons for this structure
//! The forces of a cable element consist of short dependent sums for the local fields and of the
//! divisions of the curvature, which leave the processor waiting. Four elements are therefore
//! computed side by side in the lanes of a register; together they take the time of one and a half.
//! Tangents gain less, since the tiles of a single element fill the lanes already.
//!
//! In factorisations and substitutions the number of instructions matters less than the waiting for
//! earlier results: elimination in two chains from both ends (the private module `linear::order`)
//! executes more instructions in three fifths of the time.
//!
//! With many elements the memory bandwidth decides: a step of 100 000 elements takes 2.6 times as
//! long per element as one of 100, although forces cost the same. Passes over vectors are therefore
//! few: accelerations are not stored, the largest force is found while the inertia is added, the
//! largest residual while the residual is turned into the supports' frames, and an increment is
//! turned, measured and added in one pass. Processing an iteration in sections that stay in a cache
//! was tried and was slower, because memory idles while forces are computed.

mod force;
mod pairs;
mod tangent;

use super::{Action, Actions, CompiledFor, Density, Earlier, Effect, Gradient, Hessian, Kind};
use crate::basis::BasisTable;
use crate::lanes::fma;
use crate::lanes::{self, Lanes, Pair};
use crate::linear::Matrix;
use nalgebra::Vector2;

/// Memory for the assembly of a cell; the caller keeps it, so that nothing is allocated in the
/// loops.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    pub(crate) products: Vec<f64>,
    pub(super) lanes: Vec<Lanes>,
    pub(super) pairs: Vec<Pair<Lanes>>,
}

/// A density, the shape functions at its quadrature points, and the position of its beam among the
/// coordinates.
#[derive(Clone, Debug)]
pub struct Integral<D, const M: usize> {
    pub(super) kind: Kind,
    pub(super) beam: usize,
    /// First coefficient of the beam; coefficient c has the coordinates 2c and 2c + 1.
    pub(super) offset: usize,
    pub(super) table: BasisTable,
    /// The first cells of groups of four equal cells, each one node after the cell before, as
    /// [`BasisTable::by_fours`] finds them; `singles` are all other cells.
    pub(super) fours: Vec<u32>,
    pub(super) singles: Vec<u32>,
    /// All cells, where forces are summed by fours and tangents are not.
    tangents_by_ones: Vec<u32>,
    pub(super) density: D,
}

/// Shape functions of a cable element.
const CABLE: usize = 4;
/// Numbers of points per cell for which cells are summed four at a time.
const POINTS_BY_FOURS: std::ops::RangeInclusive<usize> = 2..=5;

/// Calls `method::<WIDTH>(arguments…)` with the table's width as a compile-time constant, or 0 for
/// uncommon widths.
macro_rules! with_width {
    ($self:ident . $method:ident ( $($argument:expr),* )) => {
        match $self.table.width {
            4 if Self::CABLES => $self.$method::<4>($($argument),*),
            8 if Self::COMMON => $self.$method::<8>($($argument),*),
            12 if Self::COMMON => $self.$method::<12>($($argument),*),
            _ => $self.$method::<0>($($argument),*),
        }
    };
}

impl<D: Density<M>, const M: usize> Integral<D, M> {
    /// Whether the loops for all common tables exist.
    pub(super) const COMMON: bool = matches!(D::COMPILED_FOR, CompiledFor::CommonTables);
    /// Whether those for cable elements do.
    const CABLES: bool = !matches!(D::COMPILED_FOR, CompiledFor::None);

    /// `offset` is the beam's first coefficient (two per node) in the system; `table` must hold the
    /// rows [`Density::ORDERS`].
    pub fn new(kind: Kind, beam: usize, offset: usize, table: BasisTable, density: D) -> Self {
        debug_assert_eq!(table.orders, D::ORDERS);
        let compiled = if Self::COMMON {
            POINTS_BY_FOURS.contains(&table.points_per_cell)
        } else {
            Self::CABLES && table.width == 4 && matches!(table.points_per_cell, 2 | 3)
        };
        let (fours, singles) = if D::BY_FOURS && compiled {
            table.by_fours()
        } else {
            (Vec::new(), (0..table.cells.len() as u32).collect())
        };
        let by_fours = D::TANGENTS_BY_FOURS && table.width == CABLE;
        let tangents_by_ones = match fours.is_empty() || by_fours {
            true => Vec::new(),
            false => (0..table.cells.len() as u32).collect(),
        };
        Self { kind, beam, offset, table, fours, singles, tangents_by_ones, density }
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
            // Two shape functions at a time fill the four lanes of a register.
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

    /// Index of the first coordinate of a cell.
    #[inline(always)]
    pub(super) fn first(&self, cell: usize) -> usize {
        2 * (self.offset + self.table.cells[cell].first as usize)
    }

    /// Adds to `sum` the actions of the forces Σ_m N⁽ᵒᵐ⁾ g_m(z, x), where z are the fields of `q`,
    /// x those of `other`, and g is `force`.
    pub(super) fn actions_of_pairs(
        &self,
        factor: f64,
        q: &[f64],
        other: &[f64],
        sum: &mut Actions,
        force: impl Fn(usize, &Gradient<M>, &Gradient<M>) -> Gradient<M>,
    ) {
        let (width, points) = (self.table.width, self.table.points_per_cell);
        let mut values = Vec::with_capacity(self.table.s.len());
        for (cell, (entry, s)) in self.table.cells.iter().zip(self.table.s.chunks(points)).enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let (q, other) = (&q[first..], &other[first..]);
            let rows = rows.chunks_exact(M * width);
            for (p, ((s, weight), rows)) in s.iter().zip(weights).zip(rows).enumerate() {
                let (z, x) = (self.fields::<0>(rows, q), self.fields::<0>(rows, other));
                let gradient = force(cell * points + p, &z, &x);
                values.push((*s, *weight, Action::of_density(D::ORDERS, &z, &gradient) * factor));
            }
        }
        if self.table.concentrated {
            values.into_iter().for_each(|(s, weight, action)| sum.add_point(s, action * weight));
        } else {
            sum.add_spread(points, values);
        }
    }

    /// `f += factor · ∫ Σ_m Σ_n N⁽ᵒᵐ⁾ H_mn v_n ds`, where H is `hessian` of the fields of `q`, and v_n are
    /// the fields of `v`.
    pub(super) fn product_of<const W: usize>(
        &self,
        factor: f64,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        hessian: impl Fn(usize, &Gradient<M>) -> Hessian<M>,
    ) {
        let width = self.width::<W>();
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let range = first..first + 2 * width;
            let (q, v, f) = (&q[range.clone()], &v[range.clone()], &mut f[range]);
            for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
                let (z, change) = (self.fields::<W>(rows, q), self.fields::<W>(rows, v));
                let hessian = hessian(cell * weights.len() + p, &z);
                let mut product = [Vector2::zeros(); M];
                for (product, row) in product.iter_mut().zip(&hessian) {
                    for (h, change) in row.iter().zip(&change) {
                        *product += h * change;
                    }
                }
                self.add_gradient::<W>(factor * weight, rows, &product, f);
            }
        }
    }

    /// Force and tangent, times `factor`, of the densities whose first and second derivatives `derivatives`
    /// gives for a point, its fields, those of the earlier iterate, and the change.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn tangent_of(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
        derivatives: impl Fn(usize, &Gradient<M>, &Gradient<M>, &Gradient<M>) -> (Gradient<M>, Hessian<M>),
    ) {
        let width = self.table.width;
        let columns = 2 * width;
        let products = &mut workspace.products;
        products.resize(self.table.points_per_cell * 2 * M * columns, 0.0);
        for (cell, entry) in self.table.cells.iter().enumerate() {
            let (weights, rows) = self.table.block(*entry);
            let first = 2 * (self.offset + entry.first as usize);
            let range = first..first + columns;
            let earlier =
                earlier.map(|Earlier { q, increment }| (&q[range.clone()], &increment[range.clone()]));
            let (q, f) = (&q[range.clone()], &mut f[range]);
            for (p, ((weight, rows), products)) in weights
                .iter()
                .zip(rows.chunks_exact(M * width))
                .zip(products.chunks_exact_mut(2 * M * columns))
                .enumerate()
            {
                let weight = factor * weight;
                let z = self.fields::<0>(rows, q);
                let [before, change] = match earlier {
                    Some((q, increment)) => [self.fields::<0>(rows, q), self.fields::<0>(rows, increment)],
                    None => [z, [Vector2::zeros(); M]],
                };
                let point = cell * weights.len() + p;
                let (gradient, hessian) = derivatives(point, &z, &before, &change);
                self.add_gradient::<0>(weight, rows, &gradient, f);
                multiply_rows::<M>(weight, &hessian, rows, width, products);
            }
            add_tiles::<M>(rows, products, width, first / 4, k);
        }
    }
}

/// `P_md[2b + e] = w Σ_n H_mn(d, e) N_b⁽ᵒⁿ⁾`.
pub(crate) fn multiply_rows<const M: usize>(
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

/// Adds all tiles of a cell to the matrix; `node` is the index of the cell's first node in the
/// system.
pub(crate) fn add_tiles<const M: usize>(
    rows: &[f64],
    products: &[f64],
    width: usize,
    node: usize,
    k: &mut Matrix,
) {
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

/// The tile in the rows of node `a` and the columns of node `b`: Σ_points Σ_m N_a⁽ᵒᵐ⁾ P_md.
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
            4 if Self::CABLES => self.force_within::<4>(factor, q, f),
            8 if Self::COMMON => self.force_within::<8>(factor, q, f),
            12 if Self::COMMON => self.force_within::<12>(factor, q, f),
            _ => self.force_any(factor, q, f),
        }
    }

    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        match self.table.width {
            4 if Self::CABLES => self.forces_in_lanes::<4>(factors, q, f),
            8 if Self::COMMON => self.forces_in_lanes::<8>(factors, q, f),
            12 if Self::COMMON => self.forces_in_lanes::<12>(factors, q, f),
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
            4 if Self::CABLES => self.tangent_within::<4>(factor, q, earlier, f, k, workspace),
            8 if Self::COMMON => self.tangent_within::<8>(factor, q, earlier, f, k, workspace),
            12 if Self::COMMON => self.tangent_within::<12>(factor, q, earlier, f, k, workspace),
            _ => self.tangent_of(factor, q, earlier, f, k, workspace, |point, z, before, change| {
                self.density.gradient_and_hessian(point, z, before, change)
            }),
        }
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        if D::HAS_TANGENT {
            let still = [Vector2::zeros(); M];
            let hessian = |point, z: &Gradient<M>| self.density.gradient_and_hessian(point, z, z, &still).1;
            with_width!(self.product_of(factor, q, v, f, hessian));
        }
    }

    fn add_actions(&self, factor: f64, q: &[f64], a: &[f64], sum: &mut Actions) {
        if let Some(path) = self.density.tendon() {
            return sum.add_tendon(factor, path);
        }
        self.actions_of_pairs(factor, q, a, sum, |point, _, x| self.density.gradient(point, x));
    }

    fn size(&self) -> (usize, usize) {
        (self.table.cells.len() * self.table.points_per_cell, self.table.bytes())
    }
}
