//! The penalty of a contact, integrated over the pieces of a beam that touch.

use super::Penalty;
use super::curve::{self, Border, Cells, Curve, MOST};
use crate::assembly::{Action, Actions, Density, Earlier, Effect, Kind, Workspace, add_tiles, multiply_rows};
use crate::basis::{Basis, BasisError, Quadrature};
use crate::linear::Matrix;
use nalgebra::Vector2;

/// Number of points of the rule on a piece, beyond the polynomial's degree. Forces are then exact
/// for a straight border.
const MORE_POINTS: usize = 2;
/// Longest part of a piece, relative to its distance from the point from which the obstacle's
/// distance is measured. That distance is a square root of a polynomial, which the rule integrates
/// the less accurately the nearer its branch points are; with this limit the relative error is
/// about 1e-5 (3.3⁻¹⁰ for five points).
const LENGTH_TO_MIDDLE: f64 = 4.0 / 3.0;
/// Largest number of parts of a piece. More would be needed only if the beam came close to the
/// obstacle's middle, which analyses refuse or report.
const MOST_PARTS: f64 = 16.0;
/// Pieces shorter than this fraction of a cell are ignored.
const SHORTEST: f64 = 1e-12;

/// A quadrature point of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPoint {
    /// Its place ξ on its cell, from 0 to 1.
    pub place: f64,
    /// Its weight \[m\].
    pub weight: f64,
    /// The Bernstein polynomials at ξ.
    pub values: [f64; MOST],
    /// Its position \[m\].
    pub r: Vector2<f64>,
}

/// A contact of one beam with one obstacle, as an effect.
#[derive(Clone, Debug)]
pub struct ContactIntegral {
    pub(super) penalty: Penalty,
    pub(super) cells: Cells,
    beam: usize,
    borders: Vec<Border>,
    /// Gauss points on (0, 1), each with its weight.
    rule: Vec<(f64, f64)>,
}

impl ContactIntegral {
    /// `offset` is the first coefficient of beam number `beam` in the system. The beam can touch
    /// between the arc lengths `between` \[m\], at which it has nodes.
    ///
    /// # Errors
    /// Where the shape functions cannot be tabulated.
    pub fn new(
        penalty: Penalty,
        beam: usize,
        between: Option<[f64; 2]>,
        basis: &Basis,
        offset: usize,
    ) -> Result<Self, BasisError> {
        let mut cells = Cells::new(basis, offset)?;
        if let Some(ends) = between {
            cells.keep_between(ends);
        }
        let (places, weights) = Quadrature::Gauss(cells.degree() + MORE_POINTS).rule()?;
        let rule = places.into_iter().zip(weights).collect();
        Ok(Self { borders: penalty.obstacle.borders(penalty.gap), penalty, cells, beam, rule })
    }

    /// The cells that may touch in the state `q`.
    pub(super) fn near<'q>(&'q self, q: &'q [f64]) -> impl Iterator<Item = (usize, Curve)> + 'q {
        let cells = (0..self.cells.count()).map(|cell| (cell, self.cells.curve(cell, q)));
        cells.filter(|(_, curve)| self.penalty.obstacle.clearance(curve.points().iter()) < self.penalty.gap)
    }

    /// Calls `visit` with the pieces of a cell that touch, in order: intervals of ξ in which the
    /// distance is a smooth function.
    pub(super) fn for_pieces(&self, curve: &Curve, mut visit: impl FnMut(f64, f64)) {
        let mut roots = Vec::new();
        self.borders.iter().for_each(|border| border.crossings(curve, &mut roots));
        roots.sort_by(f64::total_cmp);
        let mut from = 0.0;
        let mut values = [0.0; MOST];
        for to in roots.into_iter().chain([1.0]) {
            if to - from < SHORTEST {
                continue;
            }
            curve::bernstein(self.cells.degree(), 0.5 * (from + to), &mut values);
            if self.penalty.gap_at(&curve.at(&values)) < 0.0 {
                visit(from, to);
            }
            from = to;
        }
    }

    /// Calls `visit` with the quadrature points of the contact on a cell.
    pub(super) fn for_spots(&self, cell: usize, curve: &Curve, mut visit: impl FnMut(&ContactPoint)) {
        self.for_pieces(curve, |from, to| {
            let parts = self.parts(curve, from, to);
            let place = |part: usize| from + (to - from) * part as f64 / parts as f64;
            for part in 0..parts {
                let piece = [place(part), if part + 1 == parts { to } else { place(part + 1) }];
                self.spots_of(&self.rule, cell, curve, piece).for_each(|spot| visit(&spot));
            }
        });
    }

    /// Number of parts into which a piece is divided for the quadrature.
    fn parts(&self, curve: &Curve, from: f64, to: f64) -> usize {
        let mut values = [0.0; MOST];
        let [start, half, end] = [from, 0.5 * (from + to), to].map(|place| {
            curve::bernstein(self.cells.degree(), place, &mut values);
            curve.at(&values)
        });
        let Some(middle) = self.penalty.obstacle.middle(&half) else { return 1 };
        let away = |a: &Vector2<f64>, b: &Vector2<f64>| {
            let (chord, to_middle) = (b - a, middle - a);
            let along = to_middle.dot(&chord) / chord.norm_squared();
            (to_middle - chord * along.clamp(0.0, 1.0)).norm()
        };
        let distance = away(&start, &half).min(away(&half, &end));
        let length = (half - start).norm() + (end - half).norm();
        let parts = length / (LENGTH_TO_MIDDLE * distance);
        if parts > 1.0 { parts.min(MOST_PARTS).ceil() as usize } else { 1 }
    }

    /// The points of the quadrature rule `rule` on a piece of a cell.
    pub(super) fn spots_of(
        &self,
        rule: &[(f64, f64)],
        cell: usize,
        curve: &Curve,
        piece: [f64; 2],
    ) -> impl Iterator<Item = ContactPoint> {
        let [from, to] = piece;
        let length = (to - from) * self.cells.length(cell);
        rule.iter().map(move |(place, weight)| {
            let (mut values, place) = ([0.0; MOST], from + (to - from) * place);
            curve::bernstein(self.cells.degree(), place, &mut values);
            ContactPoint { place, weight: length * weight, values, r: curve.at(&values) }
        })
    }

    /// The largest depth of any quadrature point of the contact in the state `q` \[m\].
    pub fn depth(&self, q: &[f64]) -> f64 {
        let mut depth = 0.0_f64;
        for (cell, curve) in self.near(q) {
            self.for_spots(cell, &curve, |spot| depth = depth.max(-self.penalty.gap_at(&spot.r)));
        }
        depth
    }

    /// `f += Σ_j C_j F_j` with the forces F_j on the control points of a cell, and the rows C_j of
    /// these.
    pub(super) fn add_control_forces(&self, cell: usize, forces: &[Vector2<f64>; MOST], f: &mut [f64]) {
        let f = f[self.cells.coordinates(cell)].as_chunks_mut::<2>().0;
        for (row, force) in self.cells.control(cell).zip(forces) {
            for (n, f) in row.iter().zip(&mut *f) {
                *f = [f[0] + n * force.x, f[1] + n * force.y];
            }
        }
    }
}

impl Effect for ContactIntegral {
    fn kind(&self) -> Kind {
        Kind::Contact
    }

    fn beam(&self) -> usize {
        self.beam
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn is_constant(&self) -> bool {
        false
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn energy(&self, q: &[f64]) -> f64 {
        let mut energy = 0.0;
        for (cell, curve) in self.near(q) {
            self.for_spots(cell, &curve, |spot| energy += spot.weight * self.penalty.energy(0, &[spot.r]));
        }
        energy
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        for (cell, curve) in self.near(q) {
            let mut forces = [Vector2::zeros(); MOST];
            self.for_spots(cell, &curve, |spot| {
                let [force] = self.penalty.gradient(0, &[spot.r]);
                let force = force * (factor * spot.weight);
                forces.iter_mut().zip(spot.values).for_each(|(f, value)| *f += force * value);
            });
            self.add_control_forces(cell, &forces, f);
        }
    }

    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        _: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        self.add_force(factor, q, f);
        let width = self.cells.width();
        let products = &mut workspace.products;
        products.resize(4 * width, 0.0);
        let mut row = vec![0.0; width];
        for (cell, curve) in self.near(q) {
            let first = self.cells.coordinates(cell).start / 4;
            self.for_spots(cell, &curve, |spot| {
                let z = [spot.r];
                let (_, hessian) = self.penalty.gradient_and_hessian(0, &z, &z, &z);
                self.cells.row(cell, &spot.values, &mut row);
                multiply_rows::<1>(factor * spot.weight, &hessian, &row, width, &mut products[..4 * width]);
                add_tiles::<1>(&row, &products[..4 * width], width, first, k);
            });
        }
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        for (cell, curve) in self.near(q) {
            let change = self.cells.curve(cell, v);
            let mut forces = [Vector2::zeros(); MOST];
            self.for_spots(cell, &curve, |spot| {
                let z = [spot.r];
                let (_, [[hessian]]) = self.penalty.gradient_and_hessian(0, &z, &z, &z);
                let force = hessian * change.at(&spot.values) * (factor * spot.weight);
                forces.iter_mut().zip(spot.values).for_each(|(f, value)| *f += force * value);
            });
            self.add_control_forces(cell, &forces, f);
        }
    }

    fn add_actions(&self, factor: f64, q: &[f64], _: &[f64], sum: &mut Actions) {
        let mut values = Vec::new();
        for (cell, curve) in self.near(q) {
            self.for_spots(cell, &curve, |spot| {
                let [force] = self.penalty.gradient(0, &[spot.r]);
                let s = self.cells.arc_length(cell, spot.place);
                values.push((s, spot.weight, Action::at(spot.r, force * -factor)));
            });
        }
        sum.add_spread(self.rule.len(), values);
    }

    fn size(&self) -> (usize, usize) {
        let data = size_of_val(self.borders.as_slice()) + size_of_val(self.rule.as_slice());
        (self.cells.count() * self.rule.len(), self.cells.bytes() + data)
    }
}
