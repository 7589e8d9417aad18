//! Shape functions: from a [`Discretization`] to tables of numbers.
//!
//! Both discretisations have the same nodal coefficients, the position r_i and the gradient r'_i,
//! and both are tabulated as a [`BasisTable`], which holds, at a point of the beam, a short row of
//! numbers for each wanted derivative. Code that uses a table does not depend on the discretisation
//! it came from.
//!
//! ```
//! use ancf::basis::{Basis, Discretization, Nodes, Quadrature};
//!
//! let basis = Basis::new(&Discretization::Ancf { nodes: Nodes::Uniform(5) }, 2.0)?;
//! let table = basis.table(Quadrature::Gauss(3), &[1, 2])?;
//! let (weights, rows) = table.block(table.cells[0]);
//! assert_eq!((weights.len(), rows.len()), (3, 3 * 2 * 4));
//! # Ok::<(), ancf::basis::BasisError>(())
//! ```

mod ancf;
mod arithmetic;
mod cache;
mod cells;
mod discretization;
mod double_double;
mod error;
mod even;
mod interpolation;
mod kernel;
mod lu;
mod moments;
mod multiprecision;
mod nodes;
mod profile;
mod quadrature;
mod rpim;
mod table;

pub use cache::BasisCache;
pub use discretization::{Discretization, Kernel, Nodes, SideCondition};
pub use error::BasisError;
pub use quadrature::Quadrature;
pub use table::{BasisTable, Cell};

use cache::{Request, Tables};
use cells::{Supports, distinct_cells};
use even::Even;
use interpolation::{Amount, Interpolation, Quality, Wanted};
use rpim::{Interpolant, Precisions};

/// Distance at which a point is taken to coincide with a node, as a fraction of the beam's length.
const NODE_SNAP: f64 = 16.0 * f64::EPSILON;

/// From so many different ξ on, polynomials of the rows of evenly spaced cells are worth their price.
const MANY: usize = 100;

/// Part of a cell that is too short to be a piece of its own.
const SLIVER: f64 = 1e-9;

/// Largest number of nodes in a support: the work for a cell grows with its third power, and the
/// number of digits needed in proportion to it.
const MOST_SUPPORT: usize = 64;

/// The shape functions of one beam.
#[derive(Debug)]
pub struct Basis {
    /// Tables that were computed, where a cache keeps this basis for other runs. Those of a cable
    /// element are not worth it.
    tables: Option<Tables>,
    length: f64,
    nodes: Vec<f64>,
    supports: Supports,
    width: usize,
    /// Per cell: the number of its geometry, shared by cells whose supports are translations of
    /// each other.
    shape_of: Vec<u32>,
    /// Per geometry: the first cell that has it.
    representative: Vec<u32>,
    shapes: Shapes,
}

/// The data of a discretisation, besides the nodes, from which rows are computed.
#[derive(Debug)]
enum Shapes {
    Ancf,
    Rpim {
        interpolation: Interpolation,
        /// Per geometry: its solved shape functions.
        shapes: Vec<Solved>,
    },
}

/// The shape functions of a cell.
#[derive(Debug)]
enum Solved {
    /// Of evenly spaced nodes, which share them with all others.
    Even(Even),
    /// Of others.
    Uneven(Interpolant),
}

impl Solved {
    fn quality(&self) -> Quality {
        match self {
            Self::Even(even) => even.quality(),
            Self::Uneven(shape) => shape.quality,
        }
    }
}

/// How well the shape functions satisfy the conditions that define them, over all cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defects {
    /// Largest |N_j(s_i) − δ_ij| and |N'_j(s_i) − δ'_ij| at the ends of a cell, made dimensionless
    /// with the cell's length.
    pub kronecker: f64,
    /// Largest defect in reproducing 1 and s and their derivatives, in units of the sum of absolute
    /// terms.
    pub reproduction: f64,
    /// Largest estimated relative error of any row.
    pub estimated_error: f64,
    /// Decimal logarithm of the largest estimated condition number of a moment matrix; 0 where
    /// there is none.
    pub condition_log10: f64,
    /// Bits of the most precise arithmetic that a cell needed; 53, double precision, for ANCF,
    /// whose formulas are explicit.
    pub bits: usize,
    /// Number of cells of distinct geometry; the shape functions of each are computed once.
    pub distinct_cells: usize,
}

impl Basis {
    /// The shape functions of a beam of length `length` \[m\].
    ///
    /// # Errors
    /// Unusable nodes or kernel parameters, and cells whose shape functions cannot be found to 13
    /// digits.
    pub fn new(discretization: &Discretization, length: f64) -> Result<Self, BasisError> {
        Self::broken(discretization, length, &[])
    }

    /// The shape functions of a beam whose curvature, or its derivative, jumps at the arc lengths
    /// `breaks` \[m\]. There is a node at each break, and every support ends there, because a
    /// smooth function cannot follow the jump. Uniform and Chebyshev nodes keep their number: the
    /// nearest node is shifted to the break, and the nodes between breaks keep their kind of
    /// spacing. Given nodes stay where they are, and a node is added at each break that has none
    /// very near.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn broken(discretization: &Discretization, length: f64, breaks: &[f64]) -> Result<Self, BasisError> {
        let nodes = discretization.nodes();
        let places = nodes::arc_lengths(nodes, length)?;
        let (nodes, breaks) = nodes::meet(places, matches!(nodes, Nodes::Given(_)), breaks);
        match discretization {
            Discretization::Ancf { .. } => {
                let supports = Supports::new(0, nodes.len(), &breaks);
                let (shape_of, representative) = distinct_cells(&nodes, &supports);
                let shapes = Shapes::Ancf;
                Ok(Self { tables: None, length, nodes, supports, width: 4, shape_of, representative, shapes })
            }
            Discretization::Rpim { kernel, polynomial_terms, side_condition, neighbours, .. } => {
                let interpolation = Interpolation {
                    kernel: *kernel,
                    terms: *polynomial_terms,
                    side_condition: *side_condition,
                    length,
                    spacings: nodes.len() - 1,
                };
                let supports = Supports::new(*neighbours, nodes.len(), &breaks);
                Self::rpim(nodes, interpolation, supports)
            }
            Discretization::Open => Err(BasisError::Open),
        }
    }

    fn rpim(nodes: Vec<f64>, interpolation: Interpolation, supports: Supports) -> Result<Self, BasisError> {
        let Interpolation { length, spacings, terms, ref kernel, .. } = interpolation;
        let widest = supports.widest();
        if widest > MOST_SUPPORT {
            return Err(BasisError::SupportTooWide { nodes: widest, limit: MOST_SUPPORT });
        }
        let smallest = (0..spacings).map(|cell| supports.of(cell).len()).min().unwrap_or(2);
        if !(1..=2 * smallest).contains(&terms) {
            return Err(BasisError::PolynomialTerms { found: terms, limit: 2 * smallest });
        }
        let widest_cell =
            nodes.windows(2).map(|p| p[1] - p[0]).fold(0.0, f64::max) / length * spacings as f64;
        kernel::check(kernel, widest_cell)?;

        let (shape_of, representative) = distinct_cells(&nodes, &supports);
        let mut precisions = Precisions::default();
        let mut shapes = Vec::with_capacity(representative.len());
        for &cell in &representative {
            let cell = cell as usize;
            let here = supports.of(cell);
            let place = rpim::place(&nodes, here.clone(), cell);
            let shape = if even::is_even(place.nodes, length / spacings as f64) {
                Even::find(&interpolation, here.len(), place.left, &mut precisions).map(Solved::Even)
            } else {
                Interpolant::solve(&interpolation, place, &mut precisions).map(Solved::Uneven)
            };
            let failed = |quality| ill_conditioned(cell, here.start, place.nodes, kernel, quality);
            let shape = shape.map_err(failed)?;
            if let Solved::Uneven(shape) = &shape {
                let amplification = shape.amplification(&interpolation, place, &mut precisions);
                if amplification > rpim::MOST_AMPLIFICATION {
                    return Err(too_close(here.start, place.nodes, amplification));
                }
            }
            shapes.push(shape);
        }
        let shapes = Shapes::Rpim { interpolation, shapes };
        let width = 2 * widest;
        Ok(Self { tables: None, length, nodes, supports, width, shape_of, representative, shapes })
    }

    /// Length of the beam \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Arc lengths of the nodes \[m\]: increasing, the first 0, the last the beam's length.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Arc lengths \[m\] of the nodes between the ends at which supports end.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.supports.breaks().map(|node| self.nodes[node])
    }

    /// Number of coefficients that each row multiplies.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of coefficients of one coordinate: r_i is coefficient 2i, r'_i is 2i + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.nodes.len()
    }

    /// The node at `s` \[m\], to within the round-off of the beam's length.
    pub fn node_at(&self, s: f64) -> Option<usize> {
        let right = self.nodes.partition_point(|&node| node < s);
        [right.saturating_sub(1), right].into_iter().find(|&i| {
            let Some(&node) = self.nodes.get(i) else { return false };
            let cell = self.spacing(i).min(if i == 0 { f64::INFINITY } else { self.spacing(i - 1) });
            (node - s).abs() <= (NODE_SNAP * self.length).min(1e-3 * cell)
        })
    }

    /// The cell between neighbouring nodes that contains `s` \[m\]: of two that meet there the later one, beyond an end the one beside it.
    pub fn cell_at(&self, s: f64) -> usize {
        let after = self.nodes.partition_point(|&node| node <= s);
        after.saturating_sub(1).min(self.nodes.len().saturating_sub(2))
    }

    /// Rows of the wanted derivative orders (0 to 2) at the points of `rule` in every cell between
    /// neighbouring nodes.
    ///
    /// # Errors
    /// A rule or an order that does not exist.
    pub fn table(&self, rule: Quadrature, orders: &[usize]) -> Result<BasisTable, BasisError> {
        let compute = || self.of_cells(rule, orders);
        match &self.tables {
            Some(tables) => tables.get(Request::Cells(rule, orders.to_vec()), compute),
            None => compute(),
        }
    }

    /// As [`Self::table`], but with the points of `rule` in every piece of a cell between the arc
    /// lengths `kinks` \[m\]: a rule is exact for smooth integrands only. Cells that no kink
    /// divides share their rows as in [`Self::table`].
    ///
    /// # Errors
    /// A rule or an order that does not exist.
    pub fn divided_table(
        &self,
        rule: Quadrature,
        orders: &[usize],
        kinks: &[f64],
    ) -> Result<BasisTable, BasisError> {
        let mut table = self.table(rule, orders)?;
        let mut inside: Vec<(usize, f64)> = Vec::new();
        for &s in kinks.iter().filter(|s| **s > 0.0 && **s < self.length) {
            let cell = self.nodes.partition_point(|node| *node <= s) - 1;
            let xi = (s - self.nodes[cell]) / self.spacing(cell);
            if xi > SLIVER && xi < 1.0 - SLIVER {
                inside.push((cell, xi));
            }
        }
        if inside.is_empty() {
            return Ok(table);
        }
        inside.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        inside.dedup_by(|a, b| a.0 == b.0 && (a.1 - b.1).abs() <= SLIVER);
        let (points, weights) = rule.rule()?;
        let whole = std::mem::take(&mut table.cells);
        let places = std::mem::take(&mut table.s);
        let mut precisions = Precisions::default();
        for (number, (cell, s)) in whole.into_iter().zip(places.chunks_exact(points.len())).enumerate() {
            let mut ends: Vec<f64> =
                inside.iter().filter(|(at, _)| *at == number).map(|(_, xi)| *xi).collect();
            if ends.is_empty() {
                table.cells.push(cell);
                table.s.extend(s);
                continue;
            }
            ends.push(1.0);
            let h = self.spacing(number);
            let mut from = 0.0;
            for to in ends {
                table.cells.push(Cell { first: cell.first, block: table.blocks() as u32 });
                for (xi, weight) in points.iter().zip(&weights) {
                    let xi = from + xi * (to - from);
                    table.weights.push(h * (to - from) * weight);
                    table.s.push(self.nodes[number] + xi * h);
                    let start = table.rows.len();
                    table.rows.resize(start + table.row_stride(), 0.0);
                    let wanted = Wanted { xi, orders, stride: self.width, amount: Amount::Few };
                    self.fill(number, wanted, &mut table.rows[start..], &mut precisions);
                }
                from = to;
            }
        }
        Ok(table)
    }

    /// Keeps its tables from now on.
    fn keep_tables(mut self) -> Self {
        self.tables = matches!(self.shapes, Shapes::Rpim { .. }).then(Tables::default);
        self
    }

    fn of_cells(&self, rule: Quadrature, orders: &[usize]) -> Result<BasisTable, BasisError> {
        check_orders(orders)?;
        let (xi, w) = rule.rule()?;
        let mut table = BasisTable {
            width: self.width,
            orders: orders.to_vec(),
            points_per_cell: xi.len(),
            concentrated: false,
            cells: Vec::with_capacity(self.shape_of.len()),
            weights: Vec::with_capacity(self.representative.len() * xi.len()),
            rows: vec![0.0; self.representative.len() * xi.len() * orders.len() * self.width],
            s: Vec::with_capacity(self.shape_of.len() * xi.len()),
        };
        let stride = table.row_stride();
        let mut precisions = Precisions::default();
        let mut rows = table.rows.chunks_exact_mut(stride.max(1));
        for &cell in &self.representative {
            let h = self.spacing(cell as usize);
            for (xi, w) in xi.iter().zip(&w) {
                table.weights.push(h * w);
                if let Some(rows) = rows.next() {
                    let wanted = Wanted { xi: *xi, orders, stride: self.width, amount: Amount::Few };
                    self.fill(cell as usize, wanted, rows, &mut precisions);
                }
            }
        }
        for (cell, &block) in self.shape_of.iter().enumerate() {
            table.cells.push(Cell { first: self.first(cell), block });
            let (s, h) = (self.nodes[cell], self.spacing(cell));
            table.s.extend(xi.iter().map(|xi| s + xi * h));
        }
        Ok(table)
    }

    /// Rows of the wanted derivative orders (0 to 2) at single points, in the given order; each
    /// point has weight 1 and its own cell. At a node, rows of order 0 and 1 consist of exact zeros
    /// and a one. The row of order 2 jumps there: it is taken from the cell to the right, or from
    /// the last cell at the beam's end.
    ///
    /// # Errors
    /// A point that is not on the beam, or an order that does not exist.
    pub fn points(&self, s: &[f64], orders: &[usize]) -> Result<BasisTable, BasisError> {
        let compute = || self.of_points(s, orders);
        match &self.tables {
            Some(tables) => tables.get(Request::Points(s.to_vec(), orders.to_vec()), compute),
            None => compute(),
        }
    }

    fn of_points(&self, s: &[f64], orders: &[usize]) -> Result<BasisTable, BasisError> {
        check_orders(orders)?;
        let mut table = BasisTable {
            width: self.width,
            orders: orders.to_vec(),
            points_per_cell: 1,
            concentrated: true,
            cells: Vec::with_capacity(s.len()),
            weights: vec![1.0; s.len()],
            rows: vec![0.0; s.len() * orders.len() * self.width],
            s: Vec::with_capacity(s.len()),
        };
        let places = s.iter().map(|s| self.place(*s)).collect::<Result<Vec<_>, _>>()?;
        let mut different: Vec<u64> = places.iter().map(|(_, xi)| xi.to_bits()).collect();
        different.sort_unstable();
        different.dedup();
        let amount = if different.len() < MANY { Amount::Few } else { Amount::Many };
        let mut precisions = Precisions::default();
        let stride = table.row_stride().max(1);
        let mut rows = table.rows.chunks_exact_mut(stride);
        for (block, (&s, (cell, xi))) in s.iter().zip(places).enumerate() {
            table.cells.push(Cell { first: self.first(cell), block: block as u32 });
            table.s.push(s.clamp(0.0, self.length));
            if let Some(rows) = rows.next() {
                self.fill(cell, Wanted { xi, orders, stride: self.width, amount }, rows, &mut precisions);
            }
        }
        Ok(table)
    }

    /// The cell of an arc length, and ξ ∈ [0, 1] in it.
    fn place(&self, s: f64) -> Result<(usize, f64), BasisError> {
        let slack = NODE_SNAP * self.length;
        if !(-slack..=self.length + slack).contains(&s) {
            return Err(BasisError::OffBeam { s, length: self.length });
        }
        let last = self.shape_of.len() - 1;
        Ok(match self.node_at(s) {
            Some(node) if node > last => (last, 1.0),
            Some(node) => (node, 0.0),
            None => {
                let cell = self.cell_at(s);
                (cell, ((s - self.nodes[cell]) / self.spacing(cell)).clamp(0.0, 1.0))
            }
        })
    }

    /// How well the shape functions satisfy the conditions that define them.
    pub fn defects(&self) -> Defects {
        match &self.shapes {
            Shapes::Ancf => {
                Defects { bits: 53, distinct_cells: self.representative.len(), ..Defects::default() }
            }
            Shapes::Rpim { shapes, .. } => {
                let start = Defects { distinct_cells: shapes.len(), ..Defects::default() };
                shapes.iter().map(Solved::quality).fold(start, |worst, cell| Defects {
                    kronecker: worst.kronecker.max(cell.kronecker),
                    reproduction: worst.reproduction.max(cell.reproduction),
                    estimated_error: worst.estimated_error.max(cell.error),
                    condition_log10: worst
                        .condition_log10
                        .max(cell.log2_condition * std::f64::consts::LOG10_2),
                    bits: worst.bits.max(cell.bits),
                    ..worst
                })
            }
        }
    }

    /// Distance from node `cell` to the next \[m\]; infinite beyond the last.
    pub fn spacing(&self, cell: usize) -> f64 {
        match self.nodes.get(cell..cell + 2) {
            Some(ends) => ends[1] - ends[0],
            None => f64::INFINITY,
        }
    }

    /// Number of the first coefficient of a cell's rows.
    fn first(&self, cell: usize) -> u32 {
        2 * self.supports.first(cell) as u32
    }

    /// Fills the zeroed rows of one point, ξ ∈ [0, 1] of a cell.
    fn fill(&self, cell: usize, wanted: Wanted<'_>, rows: &mut [f64], precisions: &mut Precisions) {
        let Wanted { xi, orders, .. } = wanted;
        match &self.shapes {
            Shapes::Ancf => {
                let h = self.spacing(cell);
                for (row, &order) in rows.chunks_exact_mut(4).zip(orders) {
                    let mut values = [0.0; 4];
                    ancf::row(h, xi, order, &mut values);
                    row.copy_from_slice(&values);
                }
            }
            Shapes::Rpim { interpolation, shapes } => {
                let Some(shape) = shapes.get(self.shape_of[cell] as usize) else { return };
                // Cells of one geometry share the factors of its representative, so rows are
                // evaluated there, too.
                let solved = self.representative[self.shape_of[cell] as usize] as usize;
                let here = self.supports.of(solved);
                let padding = 2 * self.supports.padding(cell);
                let place = rpim::place(&self.nodes, here, solved);
                if let Some(rows) = rows.get_mut(padding..) {
                    match shape {
                        Solved::Even(even) => even.rows(precisions, wanted, rows),
                        Solved::Uneven(shape) => shape.rows(interpolation, place, precisions, wanted, rows),
                    }
                }
            }
        }
        // At a node, value and slope are themselves coefficients: the row is exactly a unit vector,
        // and round-off in the other entries is removed.
        if xi == 0.0 || xi == 1.0 {
            let node = cell + usize::from(xi == 1.0);
            for (row, &order) in
                rows.chunks_exact_mut(self.width).zip(orders).filter(|(_, order)| **order < 2)
            {
                row.fill(0.0);
                row[2 * node + order - self.first(cell) as usize] = 1.0;
            }
        }
    }
}

/// The error for a cell whose shape functions are so large since two nodes of its support are close.
fn too_close(first_node: usize, nodes: &[f64], amplification: f64) -> BasisError {
    let spacings: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let closest = (0..spacings.len()).min_by(|a, b| spacings[*a].total_cmp(&spacings[*b])).unwrap_or(0);
    let beside = |index: usize| spacings.get(index).copied().unwrap_or(0.0);
    BasisError::NodesTooClose {
        index: first_node + closest,
        left: nodes[closest],
        spacing: spacings[closest],
        beside: beside(closest.wrapping_sub(1)).max(beside(closest + 1)),
        amplification,
        most: rpim::MOST_AMPLIFICATION,
    }
}

/// The error for a cell whose shape functions no precision could find.
fn ill_conditioned(
    cell: usize,
    first_node: usize,
    nodes: &[f64],
    kernel: &Kernel,
    quality: Quality,
) -> BasisError {
    let spacings = || nodes.windows(2).map(|p| p[1] - p[0]);
    let (min_spacing, max_spacing) =
        (spacings().fold(f64::INFINITY, f64::min), spacings().fold(0.0, f64::max));
    BasisError::IllConditioned {
        cell,
        first_node,
        last_node: first_node + nodes.len() - 1,
        min_spacing,
        max_spacing,
        kernel: kernel::describe(kernel),
        bits: quality.bits,
        error: quality.error,
        condition_log10: quality.log2_condition * std::f64::consts::LOG10_2,
        advice: if max_spacing > 100.0 * min_spacing {
            "space the nodes more evenly, use fewer neighbours, or another shape parameter"
        } else {
            "use another shape parameter, fewer neighbours, fewer polynomial terms, or the other side condition"
        },
    }
}

fn check_orders(orders: &[usize]) -> Result<(), BasisError> {
    match orders.iter().find(|&&order| order > 2) {
        Some(&order) => Err(BasisError::Order { order }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No scene is known in which every precision fails, so the test makes up the quality of such a
    /// cell.
    #[test]
    fn what_no_precision_solves_is_described_with_its_place_and_spacings() {
        let quality = Quality { error: 0.3, log2_condition: 100.0, bits: 212, ..Quality::default() };
        let kernel = Kernel::Multiquadric { q: 1.03, shape: 4.0 };
        let described = |nodes: &[f64]| match ill_conditioned(7, 5, nodes, &kernel, quality) {
            BasisError::IllConditioned {
                cell,
                first_node,
                last_node,
                min_spacing,
                max_spacing,
                bits,
                error,
                condition_log10,
                advice,
                ..
            } => {
                assert_eq!((cell, first_node, last_node, bits, error), (7, 5, 8, 212, 0.3));
                assert!((condition_log10 - 30.1).abs() < 0.01, "{condition_log10}");
                (min_spacing, max_spacing, advice.contains("evenly"))
            }
            other => panic!("{other}"),
        };
        assert_eq!(described(&[1.0, 1.5, 3.5, 4.5]), (0.5, 2.0, false));
        assert_eq!(described(&[1.0, 1.0078125, 3.0, 4.0]), (0.0078125, 1.9921875, true));
        assert!(!described(&[0.0, 1.0, 101.0, 102.0]).2, "a hundred times is not too uneven");
    }

    /// ∫ |s − ¾| ds from 0 to 2 is (¾² + 1¼²)/2, by one point a piece, which integrates lines. Kinks at the
    /// ends of cells, and twice at one place, divide nothing.
    #[test]
    fn cells_are_divided_at_kinks() {
        for discretization in [Discretization::ancf(2), Discretization::rpim(3)] {
            let basis = Basis::new(&discretization, 2.0).unwrap();
            let (rule, orders) = (Quadrature::Gauss(1), &[0, 1]);
            let whole = basis.table(rule, orders).unwrap();
            assert_eq!(
                basis.divided_table(rule, orders, &[0.0, 2.0, 1.0, -1.0, 3.0, 1.0 - 1e-10]).unwrap(),
                whole
            );
            let kinks = [1.5, 0.75, 1.0, 0.0, 0.75 + 1e-10, 1.25, 2.0];
            let table = basis.divided_table(rule, orders, &kinks).unwrap();
            let middles = [0.375, 0.875, 1.125, 1.375, 1.75];
            assert!(
                table.s.iter().zip(middles).all(|(s, middle)| (s - middle).abs() < 1e-9),
                "{:?}",
                table.s
            );
            assert_eq!((table.cells.len(), table.s.len()), (5, 5));
            let mut sum = 0.0;
            // Positions and slopes of a line with slope one at the nodes 0, 1 and 2.
            let line = [0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
            for (cell, s) in table.cells.iter().zip(&table.s) {
                let (weights, rows) = table.block(*cell);
                sum += weights[0] * (s - 0.75).abs();
                let of = |row: &[f64]| -> f64 {
                    row.iter().zip(&line[cell.first as usize..]).map(|(n, q)| n * q).sum()
                };
                let [value, slope] = [&rows[..table.width], &rows[table.width..]].map(of);
                assert!((value - s).abs() < 1e-12 && (slope - 1.0).abs() < 1e-12, "{value} {slope} at {s}");
            }
            assert!((sum - 0.5 * (0.75 * 0.75 + 1.25 * 1.25)).abs() < 1e-9, "{sum}");
        }
    }
}
