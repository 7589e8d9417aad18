//! Dry friction of a contact: elastic tangential springs with Coulomb's limit.
//!
//! Every touching point of the beam is connected to the obstacle by a spring along the surface.
//! With the elastic slip eₙ of the last accepted state and the distance Δσ that the point has moved
//! along the surface since,
//!
//! ```text
//! trial     e' = eₙ + Δσ
//! sticks    e = e'                        where k_t |e'| ≤ μ p
//! slides    e = sign(e') μ p / k_t        else
//! traction  t = −k_t e                    per length, stored ½ k_t e², lost the rest of its work
//! ```
//!
//! (the return mapping of elastoplasticity; Wriggers, *Computational Contact Mechanics*, 2006, ch.
//! 5 and 10). σ is measured along the surface of the obstacle at the beam's distance, so that the
//! spring turns with the surface's normal. For a point that has begun to touch since the last
//! accepted state, Δσ is the part of its way on which it touched.
//!
//! The tangent is that of the return mapping; where points slide it is not symmetric. Newton's
//! method may diverge on a force that levels off if it starts far in the sliding range. Points that
//! touch only since the last accepted state therefore use the secant μ p/|e'| instead.

use super::ContactIntegral;
use super::curve::{Curve, MOST};
use super::integral::Rule;
use crate::assembly::{
    AcceptedState, Action, Actions, ContactPiece, Effect, FrictionEffect, InternalVariables, Workspace,
    add_tiles, multiply_rows,
};
use crate::linear::Matrix;
use crate::numeric::GAUSS_2;
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

/// Relative distance to the limit at which a point counts as sliding already: a point that slid in
/// the last accepted state has exactly the limit, and its tangent must be that of sliding.
const AT_LIMIT: f64 = 1e-9;

/// A point that was nearer to the surface than this part of its distance from the origin touched it already.
const ROUND_OFF: f64 = 1e-13;

/// Number of parts of a cell, in each of which friction is summed and its slips are stored at two
/// points. The division does not move with the contact; only in the parts that contain an edge of
/// the contact, where little load is carried, do the points move with the edge.
const PARTS: usize = 4;

/// Dry friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient of friction μ.
    pub coefficient: f64,
    /// k_t \[N/m²\]: traction per length, divided by the elastic slip.
    pub stiffness: f64,
}

/// A touching point after the return mapping.
struct Touching {
    /// Quadrature weight \[m\]; `values` are the Bernstein polynomials at the point.
    weight: f64,
    values: [f64; MOST],
    /// Elastic slip e after the mapping \[m\].
    slip: f64,
    /// ∂σ/∂r.
    along: Vector2<f64>,
    /// Largest possible |e| \[m\] …
    limit: f64,
    /// … and ∂|e|/∂r of it.
    limit_slope: Vector2<f64>,
    /// Whether it slides.
    slides: bool,
    /// Whether it is pressed in by no more than round-off, which then decides whether it slides.
    barely: bool,
    /// k_t ∂(e ∂σ/∂r)/∂r.
    stiffness: Matrix2<f64>,
    /// The part of it by which the force of a sliding point follows the pressure.
    by_pressure: Matrix2<f64>,
}

/// The friction of a contact.
#[derive(Clone, Debug)]
pub struct FrictionIntegral {
    contact: Arc<ContactIntegral>,
    friction: Friction,
    /// Its index among the contacts with friction.
    number: usize,
    rule: Rule,
}

impl FrictionIntegral {
    /// The friction of `contact`; `number` is its index among the contacts with friction.
    pub fn new(contact: Arc<ContactIntegral>, friction: Friction, number: usize) -> Self {
        let rule = Rule::new(GAUSS_2.to_vec(), contact.cells.degree(), PARTS);
        Self { contact, friction, number, rule }
    }

    /// Calls `visit` with the points of the pieces that touch in the state `q`: the cell, the
    /// piece, and the point; the points of a piece come in the order of the rule.
    fn for_touching(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        mut visit: impl FnMut(usize, [f64; 2], &Touching),
    ) {
        let contact = &*self.contact;
        let empty = Vec::new();
        let pieces = accepted.variables.contacts.get(self.number).unwrap_or(&empty);
        contact.for_near(q, |cell, curve| {
            let before = contact.cells.curve(cell, &accepted.q);
            let first = pieces.partition_point(|piece| piece.cell < cell);
            let known = &pieces[first..first + pieces[first..].partition_point(|piece| piece.cell == cell)];
            self.for_pieces(curve, |piece| {
                for spot in contact.spots_of(&self.rule, cell, curve, piece) {
                    let slip = known.iter().find_map(|piece| slip_at(piece, spot.place));
                    let touching = self.map(spot.weight, spot.values, [&before, curve], slip);
                    visit(cell, piece, &touching);
                }
            });
        });
    }

    /// Calls `visit` with the pieces of a cell that touch, divided at fixed places of the cell.
    fn for_pieces(&self, curve: &Curve, mut visit: impl FnMut([f64; 2])) {
        self.contact.for_pieces(curve, |mut from, to| {
            while from < to {
                let next = ((from * PARTS as f64).floor() + 1.0) / PARTS as f64;
                let end = next.min(to);
                visit([from, end]);
                from = end;
            }
        });
    }

    /// The force \[N\] of a touching point, as a term of the equations of motion.
    fn force(&self, point: &Touching) -> Vector2<f64> {
        point.along * (self.friction.stiffness * point.slip * point.weight)
    }

    /// `k += ` the matrices `of` the touching points.
    fn add_matrices(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
        mut of: impl FnMut(usize, &Touching) -> Matrix2<f64>,
    ) {
        let cells = &self.contact.cells;
        let width = cells.width();
        let products = &mut workspace.products;
        products.resize(4 * width, 0.0);
        let mut row = vec![0.0; width];
        self.for_touching(accepted, q, |cell, _, point| {
            let matrix = of(cell, point);
            cells.row(cell, &point.values, &mut row);
            multiply_rows::<1>(point.weight, &[[matrix]], &row, width, &mut products[..4 * width]);
            add_tiles::<1>(&row, &products[..4 * width], width, cells.coordinates(cell).start / 4, k);
        });
    }

    /// The return mapping at a point.
    fn map(
        &self,
        weight: f64,
        values: [f64; MOST],
        [before, now]: [&Curve; 2],
        slip: Option<f64>,
    ) -> Touching {
        let penalty = &self.contact.penalty;
        let Friction { coefficient, stiffness } = self.friction;
        let (start, r) = (before.at(&values), now.at(&values));
        let (distance, normal, _) = penalty.obstacle.distance(&r);
        // By round-off a point at the end of a piece that touches may be beside the obstacle.
        let depth = (penalty.gap - distance).max(0.0);
        let (way, along, bend) = penalty.obstacle.travel(penalty.gap, &start, &r);
        // For a point that did not touch before: the fraction of its way on which it touches, and
        // the derivative of this fraction.
        let away = penalty.gap_at(&start).max(0.0);
        let new = slip.is_none();
        let round_off = ROUND_OFF * (r.amax() + penalty.gap);
        let (share, growth) = match depth + away {
            sum if new && sum > round_off => (depth / sum, normal * (-away / (sum * sum))),
            _ => (1.0, Vector2::zeros()),
        };
        let trial = slip.unwrap_or(0.0) + share * way;
        let per_depth = coefficient * penalty.stiffness / stiffness;
        let limit = per_depth * depth;
        let slides = trial.abs() > limit * (1.0 - AT_LIMIT);
        let (slip, change) = match slides {
            false => (trial, along * share + growth * way),
            true if new => (limit * trial.signum(), along * (limit / trial.abs().max(f64::MIN_POSITIVE))),
            true => (limit * trial.signum(), normal * (-per_depth * trial.signum())),
        };
        let change = along * change.transpose() * stiffness;
        let by_pressure = if slides && !new { change } else { Matrix2::zeros() };
        let stiffness = change + bend * (slip * stiffness);
        let limit_slope = normal * -per_depth;
        let barely = depth <= round_off;
        Touching { weight, values, slip, along, limit, limit_slope, slides, barely, stiffness, by_pressure }
    }
}

impl FrictionEffect for FrictionIntegral {
    fn beam(&self) -> usize {
        self.contact.beam()
    }

    fn size(&self) -> (usize, usize) {
        (self.contact.cells.count() * PARTS * self.rule.len(), 0)
    }

    fn add_force(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]) {
        let mut sum = ControlForces::default();
        self.for_touching(accepted, q, |cell, _, point| {
            sum.add(&self.contact, cell, self.force(point), &point.values, f);
        });
        sum.finish(&self.contact, f);
    }

    fn add_force_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let mut sum = ControlForces::default();
        self.add_matrices(accepted, q, k, workspace, |cell, point| {
            sum.add(&self.contact, cell, self.force(point), &point.values, f);
            point.stiffness
        });
        sum.finish(&self.contact, f);
    }

    fn add_tangent_by_pressure(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        self.add_matrices(accepted, q, k, workspace, |_, point| point.by_pressure);
    }

    fn slips(&self, accepted: &AcceptedState, q: &[f64]) -> (Vec<ContactPiece>, f64) {
        let (mut pieces, mut energy) = (Vec::<ContactPiece>::new(), 0.0);
        self.for_touching(accepted, q, |cell, [from, to], point| {
            energy += 0.5 * point.weight * self.friction.stiffness * point.slip * point.slip;
            match pieces.last_mut() {
                Some(piece) if (piece.cell, piece.from, piece.to) == (cell, from, to) => {
                    piece.slip.push(point.slip)
                }
                _ => pieces.push(ContactPiece { cell, from, to, slip: vec![point.slip] }),
            }
        });
        (pieces, energy)
    }

    fn add_force_of(&self, variables: &InternalVariables, q: &[f64], f: &mut [f64]) {
        let contact = &*self.contact;
        // A saved state may belong to another scene, with fewer cells.
        let pieces = variables.contacts.get(self.number).into_iter().flatten();
        for piece in pieces.filter(|piece| piece.cell < contact.cells.count()) {
            let curve = contact.cells.curve(piece.cell, q);
            let mut sum = ControlForces::default();
            let spots = contact.spots_of(&self.rule, piece.cell, &curve, [piece.from, piece.to]);
            for (spot, slip) in spots.zip(&piece.slip) {
                let (_, along, _) = contact.penalty.obstacle.travel(contact.penalty.gap, &spot.r, &spot.r);
                let force = along * (self.friction.stiffness * slip * spot.weight);
                sum.add(contact, piece.cell, force, &spot.values, f);
            }
            sum.finish(contact, f);
        }
    }

    fn add_actions_of(&self, variables: &InternalVariables, q: &[f64], sum: &mut Actions) {
        let contact = &*self.contact;
        let pieces = variables.contacts.get(self.number).into_iter().flatten();
        let mut values = Vec::new();
        for piece in pieces.filter(|piece| piece.cell < contact.cells.count()) {
            let curve = contact.cells.curve(piece.cell, q);
            let spots = contact.spots_of(&self.rule, piece.cell, &curve, [piece.from, piece.to]);
            for (spot, slip) in spots.zip(&piece.slip) {
                let (_, along, _) = contact.penalty.obstacle.travel(contact.penalty.gap, &spot.r, &spot.r);
                let s = contact.cells.arc_length(piece.cell, spot.place);
                values.push((s, spot.weight, Action::at(spot.r, along * (-self.friction.stiffness * slip))));
            }
        }
        sum.add_spread(self.rule.len(), values);
    }

    fn sliding(&self, accepted: &AcceptedState, q: &[f64], v: &[f64]) -> Option<bool> {
        let (mut power, mut balance) = (0.0, 0.0);
        self.for_touching(accepted, q, |cell, _, point| {
            if point.barely {
                return;
            }
            let velocity = self.contact.cells.curve(cell, v).at(&point.values);
            let speed = point.along.dot(&velocity);
            // Where the pressure falls, a point slides on while it moves back more slowly than its limit falls. The trial
            // counts that of the whole step, and would have it slide for longer.
            let slides = point.slides && point.slip.signum() * speed > point.limit_slope.dot(&velocity);
            if slides {
                power += point.slip * point.weight * speed;
            }
            balance += point.weight * if slides { point.limit } else { -point.limit };
        });
        (balance > 0.0).then_some(power >= 0.0)
    }
}

/// Sums forces on the control points of one cell after another.
#[derive(Default)]
struct ControlForces {
    cell: Option<usize>,
    forces: [Vector2<f64>; MOST],
}

impl ControlForces {
    fn add(
        &mut self,
        contact: &ContactIntegral,
        cell: usize,
        force: Vector2<f64>,
        values: &[f64; MOST],
        f: &mut [f64],
    ) {
        if self.cell != Some(cell) {
            self.finish(contact, f);
            self.cell = Some(cell);
        }
        contact.share(force, values, &mut self.forces);
    }

    fn finish(&mut self, contact: &ContactIntegral, f: &mut [f64]) {
        if let Some(cell) = self.cell.take() {
            contact.add_control_forces(cell, &self.forces, f);
            self.forces = [Vector2::zeros(); MOST];
        }
    }
}

/// The elastic slip at `place` on a cell, interpolated from the points of `piece`; `None` if the
/// piece does not contain the place.
fn slip_at(piece: &ContactPiece, place: f64) -> Option<f64> {
    if !(piece.from..=piece.to).contains(&place) {
        return None;
    }
    let [(first, _), (second, _)] = GAUSS_2;
    let [start, end] = *piece.slip.first_chunk()?;
    let share = ((place - piece.from) / (piece.to - piece.from) - first) / (second - first);
    // The interpolation is limited, so that no point slips more than its neighbours.
    Some((start + share * (end - start)).max(start.min(end)).min(start.max(end)))
}
