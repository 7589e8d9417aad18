//! Supports between nodes, joints and inextensible beams, as constraint rows with Lagrange
//! multipliers.
//!
//! A support at an arc length between nodes constrains a combination of coordinates,
//! g = n(λ)·Σ_a N_a q_a − c(λ) = 0, with the shape functions N of r or of r' there: a component of
//! the position, a component of the gradient, or, for a fixed direction θ, the component of the
//! gradient across it, n = (−sin θ, cos θ). A joint ties the fields of two points, each with its
//! own normal. These rows are linear in q. The length of the gradient, which an inextensible beam
//! keeps ([`super::inextensible`]), is quadratic in q: the normal of its row depends on the
//! gradient. So does the normal of the angle between two directions, which a weld keeps.

use super::prescribed::{Prescribed, ROUND_OFF};
use crate::assembly::{Action, remaining};
use crate::basis::BasisTable;
use nalgebra::Vector2;
use std::ops::Range;

/// The quantity that a constraint row fixes.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Component `axis` of the position \[m\].
    Position {
        /// 0 for x, 1 for y.
        axis: usize,
        /// Its prescribed value.
        value: Prescribed,
    },
    /// Component `axis` of the gradient, which is to be R(φ) r'₀.
    Gradient {
        /// 0 for x', 1 for y'.
        axis: usize,
        /// r'₀.
        reference: [f64; 2],
        /// φ \[rad\].
        rotation: Prescribed,
    },
    /// The direction of the gradient, with its prescribed angle \[rad\].
    Direction(Prescribed),
    /// The sum Σ n·r⁽ᵒ⁾ over several points.
    Joint {
        /// Derivative order of r: 0 or 1.
        order: usize,
        /// The normal n of each point.
        normals: Vec<[f64; 2]>,
        /// The value that the sum must have.
        value: f64,
    },
    /// The angle from the direction of the first gradient to that of the second, θ_b − θ_a \[rad\].
    Angle(f64),
    /// The length of the gradient over a part of a beam, Σ_p ½ w_p (r'_p·r'_p − |r'_p|₀²).
    Length {
        /// The weights w_p \[m\].
        weights: Vec<f64>,
        /// Σ_p ½ w_p |r'_p|₀² in the stress-free state.
        value: f64,
    },
}

/// What a constraint row holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// A point, or the direction of a beam, where a support has it.
    Place,
    /// Points of beams, in a joint.
    Together,
    /// The angle between beams, in a weld.
    Angle,
    /// The length of an inextensible beam.
    Length,
}

/// The shape functions of a field at one point.
#[derive(Clone, Debug)]
struct Field {
    /// Index of the first coordinate on which the field depends.
    first: usize,
    /// The shape functions N of r or r'.
    shape: Vec<f64>,
}

impl Field {
    /// `table` holds one point with one row; `offset` is the beam's first coefficient.
    fn new(table: &BasisTable, offset: usize) -> Self {
        let (_, shape) = table.block(table.cells[0]);
        Self { first: 2 * (offset + table.cells[0].first as usize), shape: shape.to_vec() }
    }

    /// The value of the field, Σ N_a q_a.
    fn at(&self, q: &[f64]) -> [f64; 2] {
        let terms = self.shape.iter().zip(q[self.first..].chunks_exact(2));
        terms.fold([0.0; 2], |sum, (n, q)| [sum[0] + n * q[0], sum[1] + n * q[1]])
    }
}

/// One constraint row.
#[derive(Clone, Debug)]
pub struct Constraint {
    fields: Vec<Field>,
    /// Arc lengths of the fields \[m\]; empty for the length of an inextensible beam, whose force
    /// is not an external action on the beam.
    places: Vec<f64>,
    row: Row,
    /// g at load factor 0, from which it closes in proportion to the load factor: zero unless the
    /// state in which statics begins misses the row.
    open: f64,
}

impl Constraint {
    /// A row at one point. `table` holds the point with the single row of shape functions that
    /// `row` needs (order 0 for a position, 1 otherwise); `offset` is the beam's first coefficient.
    pub fn new(table: &BasisTable, offset: usize, row: Row) -> Self {
        Self { fields: vec![Field::new(table, offset)], places: vec![table.s[0]], row, open: 0.0 }
    }

    /// Keeps the length of the gradient as in the state `reference`, weighted over several points.
    /// Each point is given by the first coordinate on which it depends, its shape functions of r',
    /// and its weight \[m\].
    pub fn length(points: &[(usize, &[f64], f64)], reference: &[f64]) -> Self {
        let field = |&(first, shape, _): &(usize, &[f64], f64)| Field { first, shape: shape.to_vec() };
        let fields = points.iter().map(field).collect();
        let weights = points.iter().map(|(.., weight)| *weight).collect();
        let mut row =
            Self { fields, places: Vec::new(), row: Row::Length { weights, value: 0.0 }, open: 0.0 };
        let sum = row.value_of_row(0.0, reference);
        if let Row::Length { value, .. } = &mut row.row {
            *value = sum;
        }
        row
    }

    /// The row Σ n·r⁽ᵒ⁾ = 0. Each of its points is given by a table with one row, and the first
    /// coefficient of its beam.
    pub fn joint<'t>(
        points: impl Iterator<Item = (&'t BasisTable, usize)>,
        order: usize,
        normals: Vec<[f64; 2]>,
    ) -> Self {
        let (fields, places) = points.map(|(table, offset)| (Field::new(table, offset), table.s[0])).unzip();
        Self { fields, places, row: Row::Joint { order, normals, value: 0.0 }, open: 0.0 }
    }

    /// Keeps `angle` from the direction of the first of two gradients to that of the second. Each
    /// gradient is given by a table with one row, and the first coefficient of its beam.
    pub fn angle(points: [(&BasisTable, usize); 2], angle: f64) -> Self {
        let (fields, places) =
            points.into_iter().map(|(table, offset)| (Field::new(table, offset), table.s[0])).unzip();
        Self { fields, places, row: Row::Angle(angle), open: 0.0 }
    }

    /// For a support that fixes a component of a position: the axis, and the distance of that
    /// component in `q` from its value at the load factor `load` \[m\].
    pub fn position_change(&self, load: f64, q: &[f64]) -> Option<(usize, f64)> {
        match (&self.row, &self.fields[..]) {
            (Row::Position { axis, value }, [field]) => Some((*axis, value.at(load) - field.at(q)[*axis])),
            _ => None,
        }
    }

    /// For a support that fixes a direction: its angle \[rad\].
    pub fn angle_of_support(&self) -> Option<&Prescribed> {
        match &self.row {
            Row::Gradient { rotation: angle, .. } | Row::Direction(angle) => Some(angle),
            _ => None,
        }
    }

    /// Whether it is a slider: a single point on a fixed line.
    pub fn is_slider(&self) -> bool {
        matches!((&self.row, &self.fields[..]), (Row::Joint { .. }, [_]))
    }

    /// Adds `sum` to the value that the sum of a joint must have.
    pub fn add_to_sum(&mut self, sum: f64) {
        if let Row::Joint { value, .. } = &mut self.row {
            *value += sum;
        }
    }

    /// The same row, except that the sum of a joint must be zero.
    #[must_use]
    pub fn closed(mut self) -> Self {
        if let Row::Joint { value, .. } = &mut self.row {
            *value = 0.0;
        }
        self
    }

    /// Memory that it takes \[bytes\].
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.fields.iter().map(|field| size_of_val(&field.shape[..])).sum::<usize>()
    }

    /// The value in the stress-free state of a length that is kept \[m\]; 0 for other rows.
    pub fn kept(&self) -> f64 {
        match self.row {
            Row::Length { value, .. } => value,
            _ => 0.0,
        }
    }

    /// Whether ∂g/∂q depends on q.
    pub fn is_nonlinear(&self) -> bool {
        matches!(self.row, Row::Length { .. } | Row::Angle(_))
    }

    /// Index of the first coordinate that it combines.
    pub fn first(&self) -> usize {
        self.fields.first().map_or(0, |field| field.first)
    }

    /// Arc lengths of the points that it holds \[m\]; none for the length of an inextensible beam.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// |g(q, λ)|: positions in units of `length`, gradients and angles unscaled.
    pub fn miss(&self, load: f64, q: &[f64], length: f64) -> f64 {
        let value = self.value(load, q).abs();
        match self.row {
            Row::Position { .. } | Row::Length { .. } | Row::Joint { order: 0, .. } => value / length,
            Row::Gradient { .. } | Row::Direction(_) | Row::Joint { .. } | Row::Angle(_) => value,
        }
    }

    /// Fixes a quantity of a support that no law moves at the value that it has in the state `q`;
    /// `length` is the scale of lengths.
    pub fn freeze(&mut self, q: &[f64], length: f64) {
        let Some(field) = self.fields.first().map(|field| field.at(q)) else { return };
        match &mut self.row {
            Row::Position { axis, value } => value.freeze(field[*axis], length),
            Row::Gradient { reference, rotation, .. } => rotation.freeze_angle(*reference, field),
            Row::Direction(angle) => angle.freeze_angle([1.0, 0.0], field),
            Row::Joint { .. } | Row::Length { .. } | Row::Angle(_) => {}
        }
    }

    /// The indices of the coordinates that it combines, if they belong to one point.
    pub fn span(&self) -> Option<Range<usize>> {
        match &self.fields[..] {
            [field] => Some(field.first..field.first + 2 * field.shape.len()),
            _ => None,
        }
    }

    /// n, c and their derivatives with respect to λ; for joints, lengths and angles, n is not
    /// meaningful.
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
            Row::Length { value, .. } | Row::Angle(value) => ([0.0; 2], *value, [0.0; 2], 0.0),
        }
    }

    /// The normal of field `k` in the state `q`; `n` is the normal of the rows that are neither
    /// joints, lengths nor angles.
    fn normal_of(&self, k: usize, n: [f64; 2], q: &[f64]) -> [f64; 2] {
        match &self.row {
            Row::Joint { normals, .. } => normals.get(k).copied().unwrap_or(n),
            Row::Length { weights, .. } => self.fields[k].at(q).map(|r| weights[k] * r),
            Row::Angle(_) => {
                let [x, y] = self.fields[k].at(q);
                let inverse = Self::sign(k) / (x * x + y * y);
                [-y * inverse, x * inverse]
            }
            _ => n,
        }
    }

    /// Sign of the direction of field `k` in an angle.
    fn sign(k: usize) -> f64 {
        if k == 0 { -1.0 } else { 1.0 }
    }

    fn combine(&self, n: impl Fn(usize) -> [f64; 2], q: &[f64]) -> f64 {
        let fields = self.fields.iter().enumerate().map(|(k, field)| {
            let (n, r) = (n(k), field.at(q));
            n[0] * r[0] + n[1] * r[1]
        });
        fields.sum()
    }

    /// What the row holds.
    pub(super) fn holds(&self) -> Holds {
        match self.row {
            Row::Position { .. } | Row::Gradient { .. } | Row::Direction(_) => Holds::Place,
            Row::Joint { order: 0, .. } => Holds::Together,
            Row::Joint { .. } | Row::Angle(_) => Holds::Angle,
            Row::Length { .. } => Holds::Length,
        }
    }

    /// Whether the row is a length \[m\], not the component of a gradient or an angle.
    pub(super) fn is_of_length(&self) -> bool {
        matches!(self.row, Row::Position { .. } | Row::Length { .. } | Row::Joint { order: 0, .. })
    }

    /// Factor of the row that makes its entries comparable with those of the tangent: EA/L \[N/m\]
    /// for a position or a length, EA L \[N m\] for a gradient.
    pub fn scale(&self, stiffness: f64, length: f64) -> f64 {
        if self.is_of_length() { stiffness / length } else { stiffness * length }
    }

    /// The constraint g(q, λ).
    pub fn value(&self, load: f64, q: &[f64]) -> f64 {
        self.value_of_row(load, q) - remaining(load)[0] * self.open
    }

    /// Lets the row be open in the state `q` at load factor 0.
    pub fn begin_open(&mut self, q: &[f64]) {
        self.open = self.value_of_row(0.0, q);
    }

    fn value_of_row(&self, load: f64, q: &[f64]) -> f64 {
        if let (Row::Angle(angle), [a, b]) = (&self.row, &self.fields[..]) {
            let ([ax, ay], [bx, by]) = (a.at(q), b.at(q));
            let (sine, cosine) = angle.sin_cos();
            // Measured from the direction that the second gradient should have, so that full turns
            // do not count.
            let (wx, wy) = (cosine * ax - sine * ay, sine * ax + cosine * ay);
            return (wx * by - wy * bx).atan2(wx * bx + wy * by);
        }
        let (n, c, _, _) = self.normal(load);
        let degree = if self.is_nonlinear() { 0.5 } else { 1.0 };
        degree * self.combine(|k| self.normal_of(k, n, q), q) - c
    }

    /// ∂g/∂λ in the state `q`.
    pub fn rate(&self, load: f64, q: &[f64]) -> f64 {
        let closing = match &self.row {
            Row::Joint { .. } | Row::Length { .. } | Row::Angle(_) => 0.0,
            _ => {
                let (_, _, n, c) = self.normal(load);
                self.combine(|_| n, q) - c
            }
        };
        closing - remaining(load)[1] * self.open
    }

    /// Whether it changes with the load factor from `load` on, by more than the round-off of positions in a system of
    /// this `length` where it only closes.
    pub fn is_driven(&self, load: f64, length: f64) -> bool {
        let (_, _, normal, value) = self.normal(load);
        normal != [0.0; 2] || value != 0.0 || remaining(load)[1] != 0.0 && self.begins_open(length)
    }

    /// Whether it is open at load factor 0, by more than the round-off of positions in a system of this
    /// `length`.
    pub fn begins_open(&self, length: f64) -> bool {
        let unit = if self.is_of_length() { length } else { 1.0 };
        self.open.abs() > ROUND_OFF * unit
    }

    /// The normal of the last field, and, for a row of gradients, the field r' itself.
    pub fn last_field(&self, load: f64, q: &[f64]) -> ([f64; 2], Option<[f64; 2]>) {
        let (n, _, _, _) = self.normal(load);
        let k = self.fields.len().saturating_sub(1);
        let normal = self.normal_of(k, n, q);
        if self.is_of_positions() {
            return (normal, None);
        }
        (normal, Some(self.fields[k].at(q)))
    }

    /// The actions of a support or joint with the multiplier `mu` in the state `q`: per point its
    /// first coordinate, its arc length, and the action on the beam.
    pub fn actions<'q>(
        &'q self,
        load: f64,
        q: &'q [f64],
        mu: f64,
    ) -> impl Iterator<Item = (usize, f64, Action)> + 'q {
        let (n, _, _, _) = self.normal(load);
        let fields = self.fields.iter().zip(&self.places).enumerate();
        fields.map(move |(k, (field, s))| {
            let force = Vector2::from(self.normal_of(k, n, q)) * -mu;
            let action = Action::at(field.at(q).into(), force);
            (field.first, *s, if self.is_of_positions() { action } else { Action::couple(action.moment) })
        })
    }

    /// Whether it constrains positions, not gradients.
    fn is_of_positions(&self) -> bool {
        matches!(self.row, Row::Position { .. } | Row::Joint { order: 0, .. })
    }

    /// The entries of ∂g/∂q in the state `q` as (coordinate, value).
    pub fn gradient<'q>(&'q self, load: f64, q: &'q [f64]) -> impl Iterator<Item = (usize, f64)> + 'q {
        let (n, _, _, _) = self.normal(load);
        self.fields.iter().enumerate().flat_map(move |(k, field)| {
            let n = self.normal_of(k, n, q);
            let entries = field.shape.iter().enumerate();
            entries.flat_map(move |(a, shape)| (0..2).map(move |d| (field.first + 2 * a + d, n[d] * shape)))
        })
    }

    /// ∂²g/∂r'∂r' of field `k` in the state `q`; `None` for a linear row. No row couples two
    /// fields.
    fn hessian(&self, k: usize, q: &[f64]) -> Option<[[f64; 2]; 2]> {
        match &self.row {
            Row::Length { weights, .. } => Some([[weights[k], 0.0], [0.0, weights[k]]]),
            Row::Angle(_) => {
                let [x, y] = self.fields[k].at(q);
                let factor = Self::sign(k) / (x * x + y * y).powi(2);
                let (same, mixed) = (2.0 * x * y * factor, (y * y - x * x) * factor);
                Some([[same, mixed], [mixed, -same]])
            }
            _ => None,
        }
    }

    /// The entries of ∂²g/∂q∂q in the state `q` as (coordinate, coordinate, value); none for a
    /// linear row.
    pub fn second_derivative<'q>(&'q self, q: &'q [f64]) -> impl Iterator<Item = (usize, usize, f64)> + 'q {
        let hessians =
            self.fields.iter().enumerate().filter_map(|(k, field)| Some((field, self.hessian(k, q)?)));
        hessians.flat_map(|(field, hessian)| {
            let at = move |a: usize, d: usize| field.first + 2 * a + d;
            let rows = field.shape.iter().enumerate();
            rows.flat_map(move |(a, na)| {
                let columns = field.shape.iter().enumerate();
                columns.flat_map(move |(b, nb)| {
                    let entry = move |(d, e): (usize, usize)| (at(a, d), at(b, e), hessian[d][e] * na * nb);
                    [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().map(entry)
                })
            })
        })
    }

    /// v·∂²g/∂q∂q·v in the state `q`.
    pub fn curvature(&self, q: &[f64], v: &[f64]) -> f64 {
        let of = |(k, field): (usize, &Field)| {
            let ([[a, b], [c, d]], [x, y]) = (self.hessian(k, q)?, field.at(v));
            Some(x * (a * x + b * y) + y * (c * x + d * y))
        };
        self.fields.iter().enumerate().filter_map(of).sum()
    }
}
