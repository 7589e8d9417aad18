//! Supports between nodes, joints and inextensible beams, as constraint rows with Lagrange multipliers.
//!
//! At an arc length between nodes a support holds a combination of coordinates, g = n(λ)·Σ_a N_a q_a − c(λ) = 0, with the
//! rows N of r or of r' there: a component of the position, a component of the gradient, or, for a held direction θ, the
//! gradient's component across it, n = (−sin θ, cos θ). A joint ties the fields of two points, each with a normal of its own. These rows are linear in q.
//! The length of the gradient, which an inextensible beam keeps ([`super::inextensible`]), is quadratic: its row's normal follows the gradient.

use super::course::Course;
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
        value: Course,
    },
    /// Component `axis` of the gradient, R(φ) r'₀.
    Gradient {
        /// 0 for x', 1 for y'.
        axis: usize,
        /// r'₀.
        reference: [f64; 2],
        /// φ \[rad\].
        rotation: Course,
    },
    /// The direction of the gradient \[rad\].
    Direction(Course),
    /// Σ n·r⁽ᵒ⁾ over several points.
    Joint {
        /// Derivative order of r: 0 or 1.
        order: usize,
        /// n of each point.
        normals: Vec<[f64; 2]>,
        /// What the sum is.
        value: f64,
    },
    /// The gradient's length over part of a beam, Σ_p ½ w_p (r'_p·r'_p − |r'_p|₀²).
    Length {
        /// w_p \[m\].
        weights: Vec<f64>,
        /// Σ_p ½ w_p |r'_p|₀² of the stress-free state.
        value: f64,
    },
}

/// The shape functions of a field at one point.
#[derive(Clone, Debug)]
struct Field {
    /// First coordinate that the shape functions touch.
    first: usize,
    /// N of r or r'.
    shape: Vec<f64>,
}

impl Field {
    /// `table` holds one point with one row; `offset` is the beam's first coefficient.
    fn new(table: &BasisTable, offset: usize) -> Self {
        let (_, shape) = table.block(table.cells[0]);
        Self { first: 2 * (offset + table.cells[0].first as usize), shape: shape.to_vec() }
    }

    /// Σ N_a q_a.
    fn at(&self, q: &[f64]) -> [f64; 2] {
        let terms = self.shape.iter().zip(q[self.first..].chunks_exact(2));
        terms.fold([0.0; 2], |sum, (n, q)| [sum[0] + n * q[0], sum[1] + n * q[1]])
    }
}

/// One constraint.
#[derive(Clone, Debug)]
pub struct Constraint {
    fields: Vec<Field>,
    row: Row,
}

impl Constraint {
    /// `table` holds one point with the single row that `row` needs (order 0 for a position, 1 otherwise); `offset` is the
    /// beam's first coefficient.
    pub fn new(table: &BasisTable, offset: usize, row: Row) -> Self {
        Self { fields: vec![Field::new(table, offset)], row }
    }

    /// The length of the gradient as in the state `reference`, weighted over several points: of each (first coordinate that its shape
    /// functions touch, shape functions of r', weight \[m\]).
    pub fn length(points: &[(usize, &[f64], f64)], reference: &[f64]) -> Self {
        let field = |&(first, shape, _): &(usize, &[f64], f64)| Field { first, shape: shape.to_vec() };
        let fields = points.iter().map(field).collect();
        let weights = points.iter().map(|(.., weight)| *weight).collect();
        let mut row = Self { fields, row: Row::Length { weights, value: 0.0 } };
        let held = row.value(0.0, reference);
        if let Row::Length { value, .. } = &mut row.row {
            *value = held;
        }
        row
    }

    /// Σ n·r⁽ᵒ⁾ = 0 over the points of several tables of one row, each with the first coefficient of its beam.
    pub fn joint<'t>(
        points: impl Iterator<Item = (&'t BasisTable, usize)>,
        order: usize,
        normals: Vec<[f64; 2]>,
    ) -> Self {
        let fields = points.map(|(table, offset)| Field::new(table, offset)).collect();
        Self { fields, row: Row::Joint { order, normals, value: 0.0 } }
    }

    /// Sets what the sum of a joint is.
    pub fn hold(&mut self, held: f64) {
        if let Row::Joint { value, .. } = &mut self.row {
            *value += held;
        }
    }

    /// The same with the sum zero.
    #[must_use]
    pub fn closed(mut self) -> Self {
        if let Row::Joint { value, .. } = &mut self.row {
            *value = 0.0;
        }
        self
    }

    /// Bytes of its shape functions.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.fields.iter().map(|field| size_of_val(&field.shape[..])).sum::<usize>()
    }

    /// Whether ∂g/∂q depends on q.
    pub fn is_nonlinear(&self) -> bool {
        matches!(self.row, Row::Length { .. })
    }

    /// The coordinates that it combines, where they belong to one point.
    pub fn span(&self) -> Option<Range<usize>> {
        match &self.fields[..] {
            [field] => Some(field.first..field.first + 2 * field.shape.len()),
            _ => None,
        }
    }

    /// n, c and their derivatives by λ; of a joint without the normals.
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
            Row::Joint { value, .. } => ([0.0; 2], *value, [0.0; 2], 0.0),
            Row::Length { value, .. } => ([0.0; 2], *value, [0.0; 2], 0.0),
        }
    }

    /// The normal of field `k` in the state `q`, that of all fields being `n` for what is no joint and no length.
    fn normal_of(&self, k: usize, n: [f64; 2], q: &[f64]) -> [f64; 2] {
        match &self.row {
            Row::Joint { normals, .. } => normals.get(k).copied().unwrap_or(n),
            Row::Length { weights, .. } => self.fields[k].at(q).map(|r| weights[k] * r),
            _ => n,
        }
    }

    fn combine(&self, n: impl Fn(usize) -> [f64; 2], q: &[f64]) -> f64 {
        let fields = self.fields.iter().enumerate().map(|(k, field)| {
            let (n, r) = (n(k), field.at(q));
            n[0] * r[0] + n[1] * r[1]
        });
        fields.sum()
    }

    /// The number by which the row is multiplied so that its entries compare with those of the tangent: EA/L \[N/m\] for
    /// a position and for a length, EA L \[N m\] for a gradient.
    pub fn scale(&self, stiffness: f64, length: f64) -> f64 {
        match self.row {
            Row::Position { .. } | Row::Length { .. } | Row::Joint { order: 0, .. } => stiffness / length,
            Row::Gradient { .. } | Row::Direction(_) | Row::Joint { .. } => stiffness * length,
        }
    }

    /// g(q, λ).
    pub fn value(&self, load: f64, q: &[f64]) -> f64 {
        let (n, c, _, _) = self.normal(load);
        let degree = if self.is_nonlinear() { 0.5 } else { 1.0 };
        degree * self.combine(|k| self.normal_of(k, n, q), q) - c
    }

    /// ∂g/∂λ.
    pub fn rate(&self, load: f64, q: &[f64]) -> f64 {
        match &self.row {
            Row::Joint { .. } | Row::Length { .. } => 0.0,
            _ => {
                let (_, _, n, c) = self.normal(load);
                self.combine(|_| n, q) - c
            }
        }
    }

    /// The normal of the last field, and of a row of gradients the field r' itself.
    pub fn last_field(&self, load: f64, q: &[f64]) -> ([f64; 2], Option<[f64; 2]>) {
        let (n, _, _, _) = self.normal(load);
        let k = self.fields.len().saturating_sub(1);
        let normal = self.normal_of(k, n, q);
        if matches!(self.row, Row::Position { .. } | Row::Joint { order: 0, .. }) {
            return (normal, None);
        }
        (normal, Some(self.fields[k].at(q)))
    }

    /// (coordinate, ∂g/∂q) in the state `q`.
    pub fn gradient<'q>(&'q self, load: f64, q: &'q [f64]) -> impl Iterator<Item = (usize, f64)> + 'q {
        let (n, _, _, _) = self.normal(load);
        self.fields.iter().enumerate().flat_map(move |(k, field)| {
            let n = self.normal_of(k, n, q);
            let entries = field.shape.iter().enumerate();
            entries.flat_map(move |(a, shape)| (0..2).map(move |d| (field.first + 2 * a + d, n[d] * shape)))
        })
    }

    /// (coordinate, coordinate, ∂²g/∂q∂q), symmetric; nothing for what is linear.
    pub fn second_derivative(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let weights = match &self.row {
            Row::Length { weights, .. } => &weights[..],
            _ => &[],
        };
        self.fields.iter().zip(weights).flat_map(|(field, weight)| {
            let at = move |a: usize, d: usize| field.first + 2 * a + d;
            let rows = field.shape.iter().enumerate();
            rows.flat_map(move |(a, na)| {
                let columns = field.shape.iter().enumerate();
                columns.flat_map(move |(b, nb)| (0..2).map(move |d| (at(a, d), at(b, d), weight * na * nb)))
            })
        })
    }

    /// v·∂²g/∂q∂q·v.
    pub fn curvature(&self, v: &[f64]) -> f64 {
        match &self.row {
            Row::Length { weights, .. } => {
                let rates = self.fields.iter().map(|field| field.at(v));
                rates.zip(weights).map(|([x, y], weight)| weight * (x * x + y * y)).sum()
            }
            _ => 0.0,
        }
    }
}
