//! Shape functions: from a [`Discretization`] to tables of numbers.
//!
//! Both discretisations have the same nodal coefficients, the position r_i and the gradient r'_i, and both end as a
//! [`BasisTable`]: at a point of the beam a short row of numbers for each wanted derivative. Whoever holds a table
//! cannot tell which discretisation it came from.
//!
//! ```
//! use ancf::basis::{Basis, Quadrature};
//! use ancf::model::{Discretization, Nodes};
//!
//! let basis = Basis::new(&Discretization::Ancf { nodes: Nodes::Uniform(5) }, 2.0)?;
//! let table = basis.table(Quadrature::Gauss(3), &[1, 2])?;
//! let (weights, rows) = table.block(table.cells[0]);
//! assert_eq!((weights.len(), rows.len()), (3, 3 * 2 * 4));
//! # Ok::<(), ancf::basis::BasisError>(())
//! ```

mod ancf;
mod error;
mod nodes;
mod quadrature;
mod table;

pub use error::BasisError;
pub use quadrature::Quadrature;
pub use table::{BasisTable, Cell};

use crate::model::Discretization;

/// Distance at which a point is taken to be a node, in units of the round-off of the beam's length.
const NODE_SNAP: f64 = 16.0 * f64::EPSILON;

/// How many of the latest distinct cells a new one is compared with: enough for meshes that repeat a pattern.
const RECENT: usize = 16;

/// The shape functions of one beam.
#[derive(Debug)]
pub struct Basis {
    length: f64,
    nodes: Vec<f64>,
    width: usize,
    /// Per cell: the number of its geometry.
    shape_of: Vec<u32>,
    /// Per geometry: the first cell that has it.
    representative: Vec<u32>,
    shapes: Shapes,
}

/// What a discretisation needs to fill a row, besides the nodes.
#[derive(Debug)]
enum Shapes {
    Ancf,
}

/// How well the shape functions satisfy what defines them, over all cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defects {
    /// Largest |N_j(s_i) − δ_ij| and |N'_j(s_i) − δ'_ij|, each in units of the function's largest value or slope.
    pub kronecker: f64,
    /// Largest defect in reproducing 1 and s and their derivatives, in units of the sum of absolute terms.
    pub reproduction: f64,
    /// Largest estimated relative error of any row.
    pub estimated_error: f64,
    /// Bits of the most precise arithmetic that a cell needed: 53 where formulas are exact in double precision.
    pub bits: usize,
    /// Cells of distinct geometry, each solved once.
    pub distinct_cells: usize,
}

impl Basis {
    /// The shape functions of a beam of length `length` [m].
    ///
    /// # Errors
    /// Unusable nodes or kernel parameters, and cells whose shape functions cannot be found to 13 digits.
    pub fn new(discretization: &Discretization, length: f64) -> Result<Self, BasisError> {
        match discretization {
            Discretization::Ancf { nodes } => {
                let nodes = nodes::arc_lengths(nodes, length)?;
                let (shape_of, representative) = distinct_cells(&nodes, 0);
                Ok(Self { length, nodes, width: 4, shape_of, representative, shapes: Shapes::Ancf })
            }
            Discretization::Rpim { .. } => todo!(),
        }
    }

    /// Length of the beam [m].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Arc lengths of the nodes [m]: increasing, the first 0, the last the beam's length.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Coefficients that each row multiplies.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of coefficients of one coordinate: r_i is coefficient 2i, r'_i is 2i + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.nodes.len()
    }

    /// The node at `s` [m], to within round-off of the beam's length.
    pub fn node_at(&self, s: f64) -> Option<usize> {
        let right = self.nodes.partition_point(|&node| node < s);
        [right.saturating_sub(1), right].into_iter().find(|&i| {
            let Some(&node) = self.nodes.get(i) else { return false };
            let cell = self.spacing(i).min(if i == 0 { f64::INFINITY } else { self.spacing(i - 1) });
            (node - s).abs() <= (NODE_SNAP * self.length).min(1e-3 * cell)
        })
    }

    /// Rows of the wanted derivative orders (0 to 2) at the points of `rule` in every cell between neighbouring nodes.
    ///
    /// # Errors
    /// A rule or an order that does not exist.
    pub fn table(&self, rule: Quadrature, orders: &[usize]) -> Result<BasisTable, BasisError> {
        check_orders(orders)?;
        let (xi, w) = rule.rule()?;
        let mut table = BasisTable {
            width: self.width,
            orders: orders.to_vec(),
            points_per_cell: xi.len(),
            cells: Vec::with_capacity(self.shape_of.len()),
            weights: Vec::with_capacity(self.representative.len() * xi.len()),
            rows: vec![0.0; self.representative.len() * xi.len() * orders.len() * self.width],
            s: Vec::with_capacity(self.shape_of.len() * xi.len()),
        };
        let stride = table.row_stride();
        let mut rows = table.rows.chunks_exact_mut(stride.max(1));
        for &cell in &self.representative {
            let h = self.spacing(cell as usize);
            for (xi, w) in xi.iter().zip(&w) {
                table.weights.push(h * w);
                if let Some(rows) = rows.next() {
                    self.fill(cell as usize, *xi, orders, rows);
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

    /// Rows of the wanted derivative orders (0 to 2) at single points, each with weight 1 and its own cell, in the
    /// order given. At a node the rows of order 0 and 1 are exactly 0 and 1; the row of order 2, which jumps there, is
    /// that of the cell to the right, at the beam's end to the left.
    ///
    /// # Errors
    /// A point that is not on the beam, or an order that does not exist.
    pub fn points(&self, s: &[f64], orders: &[usize]) -> Result<BasisTable, BasisError> {
        check_orders(orders)?;
        let mut table = BasisTable {
            width: self.width,
            orders: orders.to_vec(),
            points_per_cell: 1,
            cells: Vec::with_capacity(s.len()),
            weights: vec![1.0; s.len()],
            rows: vec![0.0; s.len() * orders.len() * self.width],
            s: Vec::with_capacity(s.len()),
        };
        let stride = table.row_stride();
        let mut rows = table.rows.chunks_exact_mut(stride.max(1));
        for (block, &s) in s.iter().enumerate() {
            let slack = NODE_SNAP * self.length;
            if !(-slack..=self.length + slack).contains(&s) {
                return Err(BasisError::OffBeam { s, length: self.length });
            }
            let last = self.shape_of.len() - 1;
            let (cell, xi) = match self.node_at(s) {
                Some(node) if node > last => (last, 1.0),
                Some(node) => (node, 0.0),
                None => {
                    let cell = self.nodes.partition_point(|&node| node <= s).saturating_sub(1).min(last);
                    (cell, ((s - self.nodes[cell]) / self.spacing(cell)).clamp(0.0, 1.0))
                }
            };
            table.cells.push(Cell { first: self.first(cell), block: block as u32 });
            table.s.push(s.clamp(0.0, self.length));
            if let Some(rows) = rows.next() {
                self.fill(cell, xi, orders, rows);
            }
        }
        Ok(table)
    }

    /// How well the shape functions satisfy what defines them.
    pub fn defects(&self) -> Defects {
        match &self.shapes {
            Shapes::Ancf => {
                Defects { bits: 53, distinct_cells: self.representative.len(), ..Defects::default() }
            }
        }
    }

    /// Distance from node `cell` to the next [m]; infinite beyond the last.
    fn spacing(&self, cell: usize) -> f64 {
        match self.nodes.get(cell..cell + 2) {
            Some(ends) => ends[1] - ends[0],
            None => f64::INFINITY,
        }
    }

    /// Number of the first coefficient of a cell's rows.
    fn first(&self, cell: usize) -> u32 {
        match &self.shapes {
            Shapes::Ancf => 2 * cell as u32,
        }
    }

    /// Fills the zeroed rows of one point, ξ ∈ [0, 1] of a cell.
    fn fill(&self, cell: usize, xi: f64, orders: &[usize], rows: &mut [f64]) {
        match &self.shapes {
            Shapes::Ancf => {
                let h = self.spacing(cell);
                for (row, &order) in rows.chunks_exact_mut(4).zip(orders) {
                    let mut values = [0.0; 4];
                    ancf::row(h, xi, order, &mut values);
                    row.copy_from_slice(&values);
                }
            }
        }
    }
}

fn check_orders(orders: &[usize]) -> Result<(), BasisError> {
    match orders.iter().find(|&&order| order > 2) {
        Some(&order) => Err(BasisError::Order { order }),
        None => Ok(()),
    }
}

/// Nodes of the support of `cell`, as a half-open range: its own two and `neighbours` more on each side that exists.
fn support(cell: usize, neighbours: usize, nodes: usize) -> std::ops::Range<usize> {
    cell.saturating_sub(neighbours)..cell.saturating_add(neighbours).saturating_add(2).min(nodes)
}

/// Groups cells whose supports are translations of each other: per cell the number of its group, per group its first
/// cell.
///
/// Node positions are rounded to double precision, so the spacings of an even mesh differ in their last digits. Two
/// supports are the same if they agree within that round-off and within 1e-9 of the smallest spacing. The first of a
/// group stands for it: nearest to s = 0, its spacings are rounded the least.
fn distinct_cells(nodes: &[f64], neighbours: usize) -> (Vec<u32>, Vec<u32>) {
    let mut representative: Vec<u32> = Vec::new();
    let shape_of = (0..nodes.len() - 1)
        .map(|cell| {
            let here = support(cell, neighbours, nodes.len());
            let found = representative.iter().enumerate().rev().take(RECENT).find(|(_, other)| {
                let other = **other as usize;
                let there = support(other, neighbours, nodes.len());
                here.len() == there.len() && cell - here.start == other - there.start && {
                    let (here, there) = (&nodes[here.clone()], &nodes[there]);
                    let round_off = 4.0 * f64::EPSILON * here[here.len() - 1].max(there[there.len() - 1]);
                    here.windows(2).zip(there.windows(2)).all(|(a, b)| {
                        let (a, b) = (a[1] - a[0], b[1] - b[0]);
                        (a - b).abs() <= round_off.min(1e-9 * a.min(b))
                    })
                }
            });
            match found {
                Some((group, _)) => group as u32,
                None => {
                    representative.push(cell as u32);
                    (representative.len() - 1) as u32
                }
            }
        })
        .collect();
    (shape_of, representative)
}
