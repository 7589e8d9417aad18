//! Rigid motions that supports and joints leave to the beams of a model.
//!
//! A planar rigid motion of a beam is (t_x, t_y, ω): the displacement of its start (x̄, ȳ), divided
//! by a length L, and its rotation. A support at (x₀, y₀) fixes t_x − ω (y₀ − ȳ)/L,
//! t_y + ω (x₀ − x̄)/L or ω, and a joint makes these equal for two beams; each such condition is
//! one row. The motions left are the null space of the rows. It is found by Gauss–Jordan
//! elimination, because a singular value decomposition would return mixtures of motions, which a
//! message could not name.

use super::{FixedRotation, Joint, Model, Place};
use crate::assembly::Resistance;

/// A row is a combination of others if its residual, relative to its size, is at most this.
const DEPENDENT: f64 = 1e-9;

/// Reduced rows that motions must satisfy: each is 1 in a column in which all others are 0.
#[derive(Clone, Debug)]
pub struct Freedom {
    length: f64,
    origins: Vec<[f64; 2]>,
    rows: Vec<(usize, Vec<f64>)>,
}

/// A rigid motion of the model: per beam (t_x, t_y, ω), with the displacements in units of the
/// length.
pub type Motion = Vec<[f64; 3]>;

impl Freedom {
    /// The motions that supports and joints of `model` leave. `position` gives the position of a
    /// place in the stress-free shape \[m\], and `length` is the scale of lengths \[m\].
    pub fn new(model: &Model, length: f64, position: impl Fn(Place) -> [f64; 2]) -> Self {
        let origins = (0..model.beams.len()).map(|beam| position(Place { beam, s: 0.0 })).collect();
        let mut freedom = Self { length, origins, rows: Vec::new() };
        for support in &model.supports {
            let (at, fix) = (support.at, support.fix);
            let axes = [(fix.x, [1.0, 0.0]), (fix.y, [0.0, 1.0])];
            for (_, axis) in axes.into_iter().filter(|(fixed, _)| *fixed) {
                freedom.fix_displacement(&[(at.beam, position(at), axis)]);
            }
            if fix.rotation != FixedRotation::Free {
                freedom.fix_direction(at.beam);
            }
        }
        for joint in &model.joints {
            match *joint {
                Joint::Slider { at, along: [x, y] } => {
                    freedom.fix_displacement(&[(at.beam, position(at), [-y, x])]);
                }
                Joint::Hinge { first, second } | Joint::Weld { first, second } => {
                    let (a, b) = (position(first), position(second));
                    for [x, y] in [[1.0, 0.0], [0.0, 1.0]] {
                        freedom.fix_displacement(&[(first.beam, a, [-x, -y]), (second.beam, b, [x, y])]);
                    }
                    if matches!(joint, Joint::Weld { .. }) {
                        freedom.fix_turns(&[(first.beam, -1.0), (second.beam, 1.0)]);
                    }
                }
            }
        }
        freedom
    }

    /// Removes the motions that the model's parts may resist by elasticity. Contacts count only
    /// where there are springs, which may press beams against them.
    pub fn resist(&mut self, model: &Model, position: impl Fn(Place) -> [f64; 2]) {
        let all: Vec<_> = model.parts.iter().flat_map(|part| part.resists()).collect();
        let springs = all.iter().any(|resistance| !matches!(resistance, Resistance::Contact(_)));
        for resistance in all {
            match resistance {
                Resistance::Displacement(at, axis) => {
                    self.fix_displacement(&[(at.beam, position(at), axis)]);
                }
                Resistance::Direction(at) => self.fix_direction(at.beam),
                Resistance::Contact(beam) if springs => {
                    let start = position(Place { beam, s: 0.0 });
                    for axis in [[1.0, 0.0], [0.0, 1.0]] {
                        self.fix_displacement(&[(beam, start, axis)]);
                    }
                    self.fix_direction(beam);
                }
                Resistance::Contact(_) => {}
            }
        }
    }

    /// Removes the rotation of a beam.
    pub fn fix_direction(&mut self, beam: usize) {
        self.fix_turns(&[(beam, 1.0)]);
    }

    /// Adds the row Σ n·u = 0, with the displacements u of points of beams.
    fn fix_displacement(&mut self, terms: &[(usize, [f64; 2], [f64; 2])]) {
        let mut row = vec![0.0; 3 * self.origins.len()];
        for &(beam, [x, y], n) in terms {
            let [ox, oy] = self.origins[beam];
            let lever = (n[1] * (x - ox) - n[0] * (y - oy)) / self.length;
            for (i, value) in [n[0], n[1], lever].into_iter().enumerate() {
                row[3 * beam + i] += value;
            }
        }
        self.add(row);
    }

    /// Adds the row Σ ±ω = 0, with the rotations ω of beams.
    fn fix_turns(&mut self, terms: &[(usize, f64)]) {
        let mut row = vec![0.0; 3 * self.origins.len()];
        terms.iter().for_each(|(beam, sign)| row[3 * beam + 2] += sign);
        self.add(row);
    }

    fn add(&mut self, mut row: Vec<f64>) {
        let largest = |row: &[f64]| {
            let sizes = row.iter().map(|value| value.abs()).enumerate();
            sizes.fold((0, 0.0), |best, (i, size)| if size > best.1 { (i, size) } else { best })
        };
        let (_, size) = largest(&row);
        for (column, reduced) in &self.rows {
            subtract(row[*column], reduced, &mut row);
        }
        let (column, left) = largest(&row);
        if left <= DEPENDENT * size {
            return;
        }
        let by = row[column];
        row.iter_mut().for_each(|value| *value /= by);
        self.rows.iter_mut().for_each(|(_, other)| subtract(other[column], &row, other));
        self.rows.push((column, row));
    }

    /// A basis of the motions left.
    pub fn motions(&self) -> Vec<Motion> {
        let columns = 3 * self.origins.len();
        let mut pivots = vec![false; columns];
        self.rows.iter().for_each(|(column, _)| pivots[*column] = true);
        let free = (0..columns).filter(|column| !pivots[*column]);
        free.map(|free| {
            let mut motion = vec![0.0; columns];
            motion[free] = 1.0;
            self.rows.iter().for_each(|(column, row)| motion[*column] = -row[free]);
            motion.as_chunks().0.to_vec()
        })
        .collect()
    }

    /// The start of a beam, to which its displacement refers \[m\].
    pub fn origin(&self, beam: usize) -> [f64; 2] {
        self.origins[beam]
    }
}

fn subtract(factor: f64, from: &[f64], row: &mut [f64]) {
    if factor != 0.0 {
        row.iter_mut().zip(from).for_each(|(value, other)| *value -= factor * other);
    }
}
