//! Evaluation of a state: position, gradient, strain and curvature anywhere on a beam.

use crate::basis::{Basis, BasisError, BasisTable};
use crate::effect::{Engineering, Green, Strain, curvature};
use crate::model::StrainMeasure;
use nalgebra::Vector2;
use std::f64::consts::{PI, TAU};

/// Local fields at one arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    /// r \[m\].
    pub position: [f64; 2],
    /// r'.
    pub gradient: [f64; 2],
    /// r'' \[1/m\].
    pub second: [f64; 2],
}

impl Fields {
    /// κ \[1/m\].
    pub fn curvature(&self) -> f64 {
        curvature(&Vector2::from(self.gradient), &Vector2::from(self.second))
    }

    /// ε by the given measure, relative to a reference with |r'| = 1.
    pub fn strain(&self, measure: StrainMeasure) -> f64 {
        let gradient = Vector2::from(self.gradient);
        match measure {
            StrainMeasure::Green => Green::strain(&gradient),
            StrainMeasure::Engineering => Engineering::strain(&gradient),
        }
    }

    /// First-order changes of direction, strain and curvature when the fields change by `by`.
    pub fn change(&self, by: &Self, measure: StrainMeasure) -> Change {
        let [first, second] = [self.gradient, self.second].map(Vector2::from);
        let [by_first, by_second] = [by.gradient, by.second].map(Vector2::from);
        let square = first.norm_squared();
        let (along, across) = (first.dot(&by_first), first.perp(&by_first));
        let strain = match measure {
            StrainMeasure::Green => along,
            StrainMeasure::Engineering => along / square.sqrt(),
        };
        let numerator = by_first.perp(&second) + first.perp(&by_second);
        let curvature = (numerator - 2.0 * self.curvature() * along) / square;
        Change { angle: across / square, strain, curvature }
    }

    /// Direction of r' in (−π, π].
    pub fn angle(&self) -> f64 {
        self.gradient[1].atan2(self.gradient[0])
    }
}

/// First-order changes at a point caused by a change of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Change of the direction of r' \[rad\].
    pub angle: f64,
    /// Change of ε.
    pub strain: f64,
    /// Change of κ \[1/m\].
    pub curvature: f64,
}

/// Directions so near to −π are of the other sign by round-off \[rad\].
const ROUND_OFF: f64 = 1e-9;

/// `angle` plus the multiple of a full turn that brings it nearest to `near`; without one within half a turn, and just half a turn is π.
pub fn unfold(angle: f64, near: Option<f64>) -> f64 {
    match near {
        Some(near) => angle + TAU * ((near - angle) / TAU).round(),
        None if angle <= ROUND_OFF - PI => angle + TAU,
        None => angle,
    }
}

/// Shape functions of r, r', r'' at one or several points of a beam.
#[derive(Clone, Debug)]
pub struct View {
    table: BasisTable,
    offset: usize,
}

impl View {
    /// A view at one arc length; `offset` is the beam's first coefficient in the system.
    pub fn point(basis: &Basis, offset: usize, s: f64) -> Result<Self, BasisError> {
        Self::points(basis, offset, &[s])
    }

    /// A view at several arc lengths.
    pub fn points(basis: &Basis, offset: usize, s: &[f64]) -> Result<Self, BasisError> {
        Ok(Self { table: basis.points(s, &[0, 1, 2])?, offset })
    }

    /// Arc lengths \[m\].
    pub fn s(&self) -> &[f64] {
        &self.table.s
    }

    /// Fields at the first point.
    pub fn fields(&self, q: &[f64]) -> Fields {
        self.fields_at(0, q)
    }

    /// Fields at all points.
    pub fn all<'a>(&'a self, q: &'a [f64]) -> impl Iterator<Item = Fields> + 'a {
        (0..self.table.s.len()).map(move |point| self.fields_at(point, q))
    }

    /// Positions of every `stride`-th point \[m\].
    pub fn positions<'a>(&'a self, stride: usize, q: &'a [f64]) -> impl Iterator<Item = [f64; 2]> + 'a {
        (0..self.table.s.len()).step_by(stride).map(move |point| self.combine(point, 0, q))
    }

    fn fields_at(&self, point: usize, q: &[f64]) -> Fields {
        let row = |row: usize| self.combine(point, row, q);
        let (position, gradient, second) = (row(0), row(1), row(2));
        Fields { position, gradient, second }
    }

    /// The vector that nodal values `vector` have at the first point: its position for coordinates,
    /// its velocity for their rates.
    pub fn at_point(&self, vector: &[f64]) -> [f64; 2] {
        self.combine(0, 0, vector)
    }

    // The row is a constant in each caller; as a call of its own it takes twice the instructions.
    #[inline(always)]
    fn combine(&self, point: usize, row: usize, q: &[f64]) -> [f64; 2] {
        let width = self.table.width;
        let (_, rows) = self.table.block(self.table.cells[point]);
        let q = &q[2 * (self.offset + self.table.cells[point].first as usize)..];
        let mut sum = [0.0; 2];
        for (n, q) in rows[row * width..(row + 1) * width].iter().zip(q.chunks_exact(2)) {
            sum[0] += n * q[0];
            sum[1] += n * q[1];
        }
        sum
    }
}
