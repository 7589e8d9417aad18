//! The forces and couples that act on a beam, concentrated or distributed, by arc length, and their
//! sum up to a cut.
//!
//! Consider a rigid motion δr = δa + δθ J r of the piece of beam over which a density W(r, r', r'')
//! is summed. By its virtual work, the density acts on that piece with
//!
//! ```text
//! force   −∂W/∂r        moment about the origin   −(r × ∂W/∂r + r' × ∂W/∂r' + r'' × ∂W/∂r'')
//! ```
//!
//! per length. Both vanish at every point for a density that does not change when the beam is
//! translated and rotated. Elasticity, its actuation and its damping therefore drop out without
//! special treatment, and the remaining actions balance the section forces at the cut.

use super::TendonPath;
use crate::beam::Along;
use nalgebra::Vector2;
use std::ops::{AddAssign, Mul};

/// A force \[N\] and its moment about the origin \[N m\], or both per length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Action {
    /// The force.
    pub force: Vector2<f64>,
    /// The moment about the origin, counter-clockwise, couples included.
    pub moment: f64,
}

impl Action {
    /// The action of a force at the position `place`.
    pub fn at(place: Vector2<f64>, force: Vector2<f64>) -> Self {
        Self { force, moment: place.perp(&force) }
    }

    /// The action of a couple.
    pub fn couple(moment: f64) -> Self {
        Self { moment, ..Self::default() }
    }

    /// The action of the nodal forces conjugate to the coordinates x, y, x′, y′ of a node.
    pub fn of_node([x, y, dx, dy]: [f64; 4], [fx, fy, gx, gy]: [f64; 4]) -> Self {
        let mut action = Self::at(Vector2::new(x, y), Vector2::new(fx, fy));
        action.moment += dx * gy - dy * gx;
        action
    }

    /// The action of a density whose derivatives by its fields are `gradient`; `orders` are the
    /// derivative orders of the fields and `fields` their values in the present state.
    pub fn of_density<const M: usize>(
        orders: [usize; M],
        fields: &[Vector2<f64>; M],
        gradient: &[Vector2<f64>; M],
    ) -> Self {
        let mut sum = Self::default();
        for ((order, z), g) in orders.into_iter().zip(fields).zip(gradient) {
            sum.moment -= z.perp(g);
            if order == 0 {
                sum.force -= g;
            }
        }
        sum
    }
}

impl AddAssign for Action {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

impl Mul<f64> for Action {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { force: self.force * factor, moment: self.moment * factor }
    }
}

/// The side of a point on which a cut is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Just before the point: a force at the point acts beyond the cut.
    Left,
    /// Just after the point.
    Right,
}

/// All actions on one beam.
#[derive(Clone, Debug, Default)]
pub struct Actions {
    points: Vec<(f64, Action)>,
    spread: Vec<Spread>,
    /// The tendons beside it, each with its amplitude.
    tendons: Vec<(f64, TendonPath)>,
    /// The strains that are imposed on single layers of its section, each with its amplitude and the
    /// index of the layer.
    layers: Vec<(f64, usize, Along)>,
}

/// The distributed action of one density, cell after cell in the order of arc length.
#[derive(Clone, Debug, Default)]
struct Spread {
    cells: Vec<Cell>,
    points: usize,
    /// Per cell, per point: arc length, weight, action per length.
    values: Vec<(f64, f64, Action)>,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    start: f64,
    end: f64,
    /// Sum over all cells before this one.
    before: Action,
}

/// Distance below which two places are the same, in beam lengths.
const SAME: f64 = 1e-9;

impl Actions {
    /// Adds a force or a couple at the arc length `s`.
    pub fn add_point(&mut self, s: f64, action: Action) {
        self.points.push((s, action));
    }

    /// Adds the pull of a tendon, times `factor`. It acts on no piece of the beam together with its
    /// tendon, and it is not a force of the section, though it passes through a cut.
    pub fn add_tendon(&mut self, factor: f64, path: &TendonPath) {
        self.tendons.push((factor, path.clone()));
    }

    /// Adds a strain that is imposed on layer number `layer` of the section, times `factor`. It acts on
    /// no piece of the beam, but stresses depend on it.
    pub fn add_layer_strain(&mut self, factor: f64, layer: usize, strain: &Along) {
        self.layers.push((factor, layer, strain.clone()));
    }

    /// The strains that are imposed on the layers at `s`, up to the last layer that has one; `inside`
    /// as for [`Along::at`].
    pub fn layer_strains(&self, s: f64, inside: f64) -> Vec<f64> {
        let count = self.layers.iter().map(|(_, layer, _)| layer + 1).max().unwrap_or(0);
        let mut strains = vec![0.0; count];
        for (factor, layer, strain) in &self.layers {
            strains[*layer] += factor * strain.at(s, inside);
        }
        strains
    }

    /// What tendons carry through a cut at `s`, as (N, Q, M) \[N, N, N m\]; `inside` is a place on
    /// the side of the cut, at which the beam has the stretch |r'| and the curvature κ.
    pub fn of_tendons(&self, s: f64, inside: f64, strains: [f64; 2]) -> [f64; 3] {
        self.tendons.iter().fold([0.0; 3], |sum, (factor, path)| {
            let carries = path.carries(s, inside, strains);
            std::array::from_fn(|i| factor.mul_add(carries[i], sum[i]))
        })
    }

    /// Adds actions per length at the points of a quadrature rule, cell after cell, as (s, weight,
    /// action), with `points` of them in a cell.
    pub fn add_spread(&mut self, points: usize, values: Vec<(f64, f64, Action)>) {
        let mut before = Action::default();
        let cells = values.chunks(points.max(1)).map(|cell| {
            // A rule that is exact for 1 and s determines where its cell begins and ends.
            let length: f64 = cell.iter().map(|(_, weight, _)| weight).sum();
            let middle = cell.iter().map(|(s, weight, _)| s * weight).sum::<f64>() / length;
            let here = Cell { start: middle - 0.5 * length, end: middle + 0.5 * length, before };
            cell.iter().for_each(|(_, weight, action)| before += *action * *weight);
            here
        });
        let cells = cells.collect();
        self.spread.push(Spread { cells, points: points.max(1), values });
    }

    /// Arc lengths strictly between the ends 0 and `length` at which a concentrated action acts or a
    /// tendon ends, in rising order.
    pub fn jumps(&self, length: f64) -> Vec<f64> {
        let inner = SAME * length..(1.0 - SAME) * length;
        let acting = self.points.iter().filter(|(_, action)| *action != Action::default());
        let ends = self.tendons.iter().flat_map(|(_, path)| path.ends);
        let mut places: Vec<f64> =
            acting.map(|(s, _)| *s).chain(ends).filter(|s| inner.contains(s)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| *a - *b <= SAME * length);
        places
    }

    /// The sum of all actions between the beam's start and a cut on the given side of `s`; `length`
    /// is the length of the beam.
    pub fn until(&self, s: f64, side: Side, length: f64) -> Action {
        let mut sum = Action::default();
        let same = SAME * length;
        let cut = if side == Side::Left { s - same } else { s + same };
        self.points.iter().filter(|(at, _)| *at <= cut).for_each(|(_, action)| sum += *action);
        self.spread.iter().for_each(|spread| sum += spread.until(s));
        sum
    }
}

impl Spread {
    fn until(&self, s: f64) -> Action {
        let cell = self.cells.partition_point(|cell| cell.start <= s).saturating_sub(1);
        let (Some(Cell { start, end, before }), Some(values)) =
            (self.cells.get(cell), self.values.chunks(self.points).nth(cell))
        else {
            return Action::default();
        };
        let mut sum = *before;
        let part = ((s - start) / (end - start)).clamp(0.0, 1.0);
        if part == 1.0 {
            values.iter().for_each(|(_, weight, action)| sum += *action * *weight);
            return sum;
        }
        // The action per length is interpolated by the polynomial through its values at the cell's
        // points, and this polynomial is integrated by the same rule over the part of the cell
        // before the cut.
        for (s, weight, _) in values {
            let at = start + part * (s - start);
            for (k, (here, _, action)) in values.iter().enumerate() {
                let others = values.iter().enumerate().filter(|(j, _)| *j != k);
                let share: f64 = others.map(|(_, (other, ..))| (at - other) / (here - other)).product();
                sum += *action * (part * weight * share);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a beam of any length, places that are the same but for round-off are one; the ends are none, nor is where nothing acts.
    #[test]
    fn section_forces_jump_where_something_acts_inside_a_beam() {
        for length in [0.01, 1.0, 40.0] {
            let mut actions = Actions::default();
            for part in [0.75, 0.0, 0.25, 0.75 + 5e-10, 0.25 + 2e-9, 1.0] {
                actions.add_point(part * length, Action::couple(1.0));
            }
            actions.add_point(0.5 * length, Action::default());
            assert_eq!(
                actions.jumps(length),
                [0.25, 0.25 + 2e-9, 0.75].map(|part| part * length),
                "{length} m"
            );
        }
    }
}
