//! Supports between nodes, as linear constraint rows with Lagrange multipliers.
//!
//! At an arc length between nodes a support holds a combination of coordinates, g = n(λ)·Σ_a N_a q_a − c(λ) = 0, with the
//! rows N of r or of r' there: a component of the position, a component of the gradient, or, for a held direction θ, the
//! gradient's component across it, n = (−sin θ, cos θ).

use super::supports::Ramp;
use crate::basis::BasisTable;
use std::ops::Range;

/// What a row holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Component `axis` of the position \[m\].
    Position {
        /// 0 for x, 1 for y.
        axis: usize,
        /// Its value.
        value: Ramp,
    },
    /// Component `axis` of the gradient, R(φ) r'₀.
    Gradient {
        /// 0 for x', 1 for y'.
        axis: usize,
        /// r'₀.
        reference: [f64; 2],
        /// φ \[rad\].
        rotation: Ramp,
    },
    /// The direction of the gradient \[rad\].
    Direction(Ramp),
}

/// One constraint.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// First coordinate that the shape functions touch.
    first: usize,
    /// N of r or r' at the support.
    shape: Vec<f64>,
    row: Row,
}

impl Constraint {
    /// `table` holds one point with the single row that `row` needs (order 0 for a position, 1 otherwise); `offset` is the
    /// beam's first coefficient.
    pub fn new(table: &BasisTable, offset: usize, row: Row) -> Self {
        let (_, shape) = table.block(table.cells[0]);
        Self { first: 2 * (offset + table.cells[0].first as usize), shape: shape.to_vec(), row }
    }

    /// The coordinates that it combines.
    pub fn span(&self) -> Range<usize> {
        self.first..self.first + 2 * self.shape.len()
    }

    /// n, c and their derivatives by λ.
    fn normal(&self, load: f64) -> ([f64; 2], f64, [f64; 2], f64) {
        let axis = |a: usize| [f64::from(a == 0), f64::from(a == 1)];
        match &self.row {
            Row::Position { axis: a, value } => (axis(*a), value.at(load), [0.0; 2], value.change),
            Row::Gradient { axis: a, reference: [x, y], rotation } => {
                let (sine, cosine) = rotation.at(load).sin_cos();
                let turned = [cosine * x - sine * y, sine * x + cosine * y];
                let rate = [-turned[1] * rotation.change, turned[0] * rotation.change];
                (axis(*a), turned[*a], [0.0; 2], rate[*a])
            }
            Row::Direction(angle) => {
                let (sine, cosine) = angle.at(load).sin_cos();
                ([-sine, cosine], 0.0, [-cosine * angle.change, -sine * angle.change], 0.0)
            }
        }
    }

    fn combine(&self, n: [f64; 2], q: &[f64]) -> f64 {
        self.shape
            .iter()
            .zip(q[self.first..].chunks_exact(2))
            .map(|(shape, q)| shape * (n[0] * q[0] + n[1] * q[1]))
            .sum()
    }

    /// The number by which the row is multiplied so that its entries compare with those of the tangent: EA/L \[N/m\] for
    /// a position, EA L \[N m\] for a gradient.
    pub fn scale(&self, stiffness: f64, length: f64) -> f64 {
        match self.row {
            Row::Position { .. } => stiffness / length,
            Row::Gradient { .. } | Row::Direction(_) => stiffness * length,
        }
    }

    /// g(q, λ).
    pub fn value(&self, load: f64, q: &[f64]) -> f64 {
        let (n, c, _, _) = self.normal(load);
        self.combine(n, q) - c
    }

    /// ∂g/∂λ.
    pub fn rate(&self, load: f64, q: &[f64]) -> f64 {
        let (_, _, n, c) = self.normal(load);
        self.combine(n, q) - c
    }

    /// (coordinate, ∂g/∂q) in rising order.
    pub fn gradient(&self, load: f64) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (n, _, _, _) = self.normal(load);
        let entries = self.shape.iter().enumerate();
        entries.flat_map(move |(a, shape)| (0..2).map(move |d| (self.first + 2 * a + d, n[d] * shape)))
    }
}
