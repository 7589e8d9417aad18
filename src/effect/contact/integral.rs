//! The penalty of a contact, integrated over the pieces of a beam that touch.

use super::Penalty;
use super::curve::{self, Border, Cells, Curve, MOST};
use crate::assembly::{Action, Actions, Density, Earlier, Effect, Kind, Workspace, add_tiles, multiply_rows};
use crate::basis::{Basis, BasisError, Quadrature};
use crate::lanes::fma;
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

/// A quadrature rule for pieces of cells. Most pieces are a whole cell, or one of the equal parts
/// into which friction divides it: there the Bernstein polynomials at the points are known.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    /// Gauss points on (0, 1), each with its weight.
    points: Vec<(f64, f64)>,
    /// Number of equal parts of a cell.
    parts: usize,
    /// Per part and point.
    values: Vec<[f64; MOST]>,
}

impl Rule {
    /// A rule with these points and weights on (0, 1), for cells of the degree `degree` that are
    /// divided into `parts`.
    pub(super) fn new(points: Vec<(f64, f64)>, degree: usize, parts: usize) -> Self {
        let places =
            (0..parts).flat_map(|part| points.iter().map(move |(xi, _)| (part as f64 + xi) / parts as f64));
        let values = places.map(|place| bernstein(degree, place)).collect();
        Self { parts, values, points }
    }

    /// The Bernstein polynomials at the points on the piece between two places of a cell, if it is
    /// one of the parts.
    fn values(&self, [from, to]: [f64; 2]) -> Option<&[[f64; MOST]]> {
        let parts = self.parts as f64;
        let first = from * parts;
        let is_part = first.fract() == 0.0 && to == (first + 1.0) / parts;
        is_part.then(|| &self.values[first as usize * self.points.len()..][..self.points.len()])
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }
}

/// The Bernstein polynomials at `place`.
fn bernstein(degree: usize, place: f64) -> [f64; MOST] {
    let mut values = [0.0; MOST];
    curve::bernstein(degree, place, &mut values);
    values
}

/// A contact of one beam with one obstacle, as an effect.
#[derive(Clone, Debug)]
pub struct ContactIntegral {
    pub(super) penalty: Penalty,
    pub(super) cells: Cells,
    beam: usize,
    borders: Vec<Border>,
    rule: Rule,
    /// The Bernstein polynomials at ξ = ½.
    half: [f64; MOST],
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
        let rule = Rule::new(places.into_iter().zip(weights).collect(), cells.degree(), 1);
        let (borders, half) = (penalty.obstacle.borders(penalty.gap), bernstein(cells.degree(), 0.5));
        Ok(Self { borders, penalty, cells, beam, rule, half })
    }

    /// Calls `visit` with the cells that may touch in the state `q`. Curves are passed on by reference,
    /// because to copy them would take longer than to compute them.
    pub(super) fn for_near(&self, q: &[f64], mut visit: impl FnMut(usize, &Curve)) {
        for cell in 0..self.cells.count() {
            let curve = self.cells.curve(cell, q);
            if self.penalty.obstacle.clearance(curve.points().iter()) < self.penalty.gap {
                visit(cell, &curve);
            }
        }
    }

    /// Calls `visit` with the pieces of a cell that touch, in order: intervals of ξ in which the
    /// distance is a smooth function.
    pub(super) fn for_pieces(&self, curve: &Curve, mut visit: impl FnMut(f64, f64)) {
        let mut roots = Vec::new();
        self.borders.iter().for_each(|border| border.crossings(&self.cells, curve, &mut roots));
        roots.sort_by(f64::total_cmp);
        let mut from = 0.0;
        for to in roots.into_iter().chain([1.0]) {
            if to - from < SHORTEST {
                continue;
            }
            if self.penalty.gap_at(&self.point(curve, 0.5 * (from + to))) < 0.0 {
                visit(from, to);
            }
            from = to;
        }
    }

    /// The point of a curve at the place ξ.
    fn point(&self, curve: &Curve, place: f64) -> Vector2<f64> {
        match (place, curve.points()) {
            (0.0, [first, ..]) => *first,
            (0.5, _) => curve.at(&self.half),
            (1.0, [.., last]) => *last,
            _ => curve.at(&bernstein(self.cells.degree(), place)),
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
        let [start, half, end] = [from, 0.5 * (from + to), to].map(|place| self.point(curve, place));
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
        rule: &Rule,
        cell: usize,
        curve: &Curve,
        piece: [f64; 2],
    ) -> impl Iterator<Item = ContactPoint> {
        let [from, to] = piece;
        let length = (to - from) * self.cells.length(cell);
        let known = rule.values(piece);
        rule.points.iter().enumerate().map(move |(i, (place, weight))| {
            let place = from + (to - from) * place;
            let values = known.map_or_else(|| bernstein(self.cells.degree(), place), |values| values[i]);
            ContactPoint { place, weight: length * weight, values, r: curve.at(&values) }
        })
    }

    /// The largest depth of any quadrature point of the contact in the state `q` \[m\].
    pub fn depth(&self, q: &[f64]) -> f64 {
        let mut depth = 0.0_f64;
        self.for_near(q, |cell, curve| {
            self.for_spots(cell, curve, |spot| depth = depth.max(-self.penalty.gap_at(&spot.r)));
        });
        depth
    }

    /// `f += Σ_j C_j F_j` with the forces F_j on the control points of a cell, and the rows C_j of
    /// these.
    pub(super) fn add_control_forces(&self, cell: usize, forces: &[Vector2<f64>; MOST], f: &mut [f64]) {
        let f = f[self.cells.coordinates(cell)].as_chunks_mut::<4>().0;
        for (row, force) in self.cells.control(cell).zip(forces) {
            let force = [force.x, force.y, force.x, force.y];
            for (n, f) in row.as_chunks::<2>().0.iter().zip(&mut *f) {
                let n = [n[0], n[0], n[1], n[1]];
                for lane in 0..4 {
                    f[lane] = fma(n[lane], force[lane], f[lane]);
                }
            }
        }
    }

    /// Adds the force at a point to those on the control points.
    #[inline(always)]
    pub(super) fn share(&self, force: Vector2<f64>, values: &[f64; MOST], forces: &mut [Vector2<f64>; MOST]) {
        let count = self.cells.degree() + 1;
        forces[..count].iter_mut().zip(&values[..count]).for_each(|(sum, value)| *sum += force * *value);
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
        self.for_near(q, |cell, curve| {
            self.for_spots(cell, curve, |spot| energy += spot.weight * self.penalty.energy(0, &[spot.r]));
        });
        energy
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        self.for_near(q, |cell, curve| {
            let mut forces = [Vector2::zeros(); MOST];
            self.for_spots(cell, curve, |spot| {
                let [force] = self.penalty.gradient(0, &[spot.r]);
                self.share(force * (factor * spot.weight), &spot.values, &mut forces);
            });
            self.add_control_forces(cell, &forces, f);
        });
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
        let width = self.cells.width();
        let products = &mut workspace.products;
        products.resize(4 * width, 0.0);
        let mut row = vec![0.0; width];
        self.for_near(q, |cell, curve| {
            let first = self.cells.coordinates(cell).start / 4;
            let mut forces = [Vector2::zeros(); MOST];
            self.for_spots(cell, curve, |spot| {
                let z = [spot.r];
                let ([force], hessian) = self.penalty.gradient_and_hessian(0, &z, &z, &z);
                self.share(force * (factor * spot.weight), &spot.values, &mut forces);
                self.cells.row(cell, &spot.values, &mut row);
                multiply_rows::<1>(factor * spot.weight, &hessian, &row, width, &mut products[..4 * width]);
                add_tiles::<1>(&row, &products[..4 * width], width, first, k);
            });
            self.add_control_forces(cell, &forces, f);
        });
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.for_near(q, |cell, curve| {
            let change = self.cells.curve(cell, v);
            let mut forces = [Vector2::zeros(); MOST];
            self.for_spots(cell, curve, |spot| {
                let z = [spot.r];
                let (_, [[hessian]]) = self.penalty.gradient_and_hessian(0, &z, &z, &z);
                let force = hessian * change.at(&spot.values) * (factor * spot.weight);
                self.share(force, &spot.values, &mut forces);
            });
            self.add_control_forces(cell, &forces, f);
        });
    }

    fn add_actions(&self, factor: f64, q: &[f64], _: &[f64], sum: &mut Actions) {
        let mut values = Vec::new();
        self.for_near(q, |cell, curve| {
            self.for_spots(cell, curve, |spot| {
                let [force] = self.penalty.gradient(0, &[spot.r]);
                let s = self.cells.arc_length(cell, spot.place);
                values.push((s, spot.weight, Action::at(spot.r, force * -factor)));
            });
        });
        sum.add_spread(self.rule.len(), values);
    }

    fn size(&self) -> (usize, usize) {
        let rule = size_of_val(&self.rule.points[..]) + size_of_val(&self.rule.values[..]);
        let data = size_of_val(&self.borders[..]) + rule;
        (self.cells.count() * self.rule.len(), self.cells.bytes() + data)
    }
}
