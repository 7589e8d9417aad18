//! Constraint rows that hold what others hold already.
//!
//! The multipliers of rows that depend on each other have no values, and no factorisation a pivot
//! for them. Whether rows do is seen in the stress-free state from the Gram matrix G = B Bᵀ of the
//! rows, each of length 1, without what supports at nodes hold: eliminated row by row, its pivots
//! are the squares of the sines of each row's angle to all before it. A loop of beams that bend may
//! be closed more often than it needs to be, and keeps its multipliers; one of straight beams that
//! keep their length may not.

use super::reaction::Source;
use super::{System, SystemError};
use crate::linear::bordered::BorderRow;
use crate::linear::inertia;
use crate::model::{Joint, Model, Place};
use faer::linalg::solvers::Solve;
use faer::sparse::Triplet;
use faer::{Mat, Side};
use std::collections::BTreeMap;

/// Square of the sine of an angle that is none: far below that of a shallow arch's thrust, far
/// above round-off.
const DEPENDENT: f64 = 1e-12;
/// Share of a row in a combination that counts.
const SHARE: f64 = 1e-6;
/// Rows up to which the partners of a dependent row are looked for.
const MOST_ROWS: usize = 2000;

impl System {
    /// Refuses rows that depend on each other.
    pub(super) fn check_rows(&self, model: &Model) -> Result<(), SystemError> {
        let rows = self.directions();
        let Some(dependent) = dependent(&rows) else { return Ok(()) };
        let mut involved = vec![dependent];
        if !rows[dependent].is_empty() && dependent <= MOST_ROWS {
            involved.extend(partners(&rows, dependent));
        }
        involved.sort_unstable();
        let mut parts: Vec<String> = Vec::new();
        for (source, joint) in self.sources[model.supports.len()..].iter().zip(&model.joints) {
            if let Source::Rows(of_joint) = source
                && involved.iter().any(|row| of_joint.contains(row))
            {
                parts.push(self.joint_in_words(*joint));
            }
        }
        let first_length = self.constraints.len() - self.lengths.len();
        let lengths = involved.iter().filter_map(|row| self.lengths.get(row.checked_sub(first_length)?));
        let mut beams: Vec<usize> = lengths.map(|row| row.beam).collect();
        beams.dedup();
        parts.extend(
            beams.iter().map(|&beam| format!("the length that beam `{}` keeps", self.beams[beam].name)),
        );
        // A row of which supports at nodes leave nothing names them.
        let tie = if rows[dependent].is_empty() { self.joint_of(dependent, model) } else { None };
        let ties: Vec<Place> = tie.map_or(Vec::new(), |joint| joint.places().collect());
        for (source, support) in self.sources.iter().zip(&model.supports) {
            let takes_part = match source {
                Source::Rows(of_support) => involved.iter().any(|row| of_support.contains(row)),
                Source::Node { .. } => beams.contains(&support.at.beam) || ties.contains(&support.at),
            };
            if takes_part {
                parts.push(format!("the support at {}", self.place_in_words(support.at)));
            }
        }
        let itself = model.joints.iter().find_map(|joint| match *joint {
            Joint::Hinge { first, second } | Joint::Weld { first, second } if first == second => Some(*joint),
            _ => None,
        });
        match itself {
            Some(joint) => Err(SystemError::ToItself { joint: self.joint_in_words(joint) }),
            None => Err(SystemError::Redundant { parts: enumerate(parts) }),
        }
    }

    fn joint_of(&self, row: usize, model: &Model) -> Option<Joint> {
        let mut joints = self.sources[model.supports.len()..].iter().zip(&model.joints);
        let of_joint = |source: &Source| matches!(source, Source::Rows(rows) if rows.contains(&row));
        joints.find(|(source, _)| of_joint(source)).map(|(_, joint)| *joint)
    }

    /// The rows in the stress-free state, positions in beam lengths, each of length 1; empty where
    /// supports at nodes hold all of it.
    fn directions(&self) -> Vec<BorderRow> {
        let mut rows = self.border(0.0, &self.reference);
        for (row, constraint) in rows.iter_mut().zip(&self.constraints) {
            // Entries for gradients are lengths where those for positions are none, or have no unit
            // where these are inverse lengths.
            row.iter_mut().filter(|(i, _)| i % 4 > 1).for_each(|(_, value)| *value /= self.length);
            let scale = constraint.scale(self.stiffness, self.length);
            let size = row.iter().map(|(_, value)| value * value).sum::<f64>().sqrt();
            if size > SHARE * SHARE * scale / self.length {
                row.iter_mut().for_each(|(_, value)| *value /= size);
                row.retain(|(_, value)| *value != 0.0);
            } else {
                row.clear();
            }
        }
        rows
    }

    fn place_in_words(&self, place: Place) -> String {
        format!("s = {:.4} m of beam `{}`", place.s, self.beams[place.beam].name)
    }

    fn joint_in_words(&self, joint: Joint) -> String {
        match joint {
            Joint::Hinge { first, second } => {
                format!("the hinge of {} and {}", self.place_in_words(first), self.place_in_words(second))
            }
            Joint::Weld { first, second } => {
                format!("the weld of {} and {}", self.place_in_words(first), self.place_in_words(second))
            }
            Joint::Slider { at, .. } => format!("the slider at {}", self.place_in_words(at)),
        }
    }
}

/// The first row that is a combination of those before it.
fn dependent(rows: &[BorderRow]) -> Option<usize> {
    if rows.is_empty() {
        return None;
    }
    if let Some(empty) = rows.iter().position(Vec::is_empty) {
        return Some(empty);
    }
    let mut touching: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
    for (r, row) in rows.iter().enumerate() {
        row.iter().for_each(|(i, value)| touching.entry(*i).or_default().push((r, *value)));
    }
    let pairs = touching.values().flat_map(|rows| {
        let later = rows.iter().enumerate();
        later.flat_map(move |(k, &(r, a))| rows[k..].iter().map(move |&(c, b)| Triplet::new(r, c, a * b)))
    });
    match inertia::pivots(rows.len(), &pairs.collect::<Vec<_>>()) {
        Ok(pivots) => pivots.iter().position(|pivot| *pivot <= DEPENDENT),
        Err(singular) => Some(singular.row.min(rows.len() - 1)),
    }
}

/// Those rows before row `last` of which it is the combination.
fn partners(rows: &[BorderRow], last: usize) -> Vec<usize> {
    let product = |a: &BorderRow, b: &BorderRow| -> f64 {
        let b: BTreeMap<usize, f64> = b.iter().copied().collect();
        a.iter().filter_map(|(i, value)| Some(value * b.get(i)?)).sum()
    };
    let gram = Mat::from_fn(last, last, |i, j| product(&rows[i], &rows[j]));
    let side = Mat::from_fn(last, 1, |i, _| product(&rows[i], &rows[last]));
    let Ok(factor) = gram.llt(Side::Lower) else { return Vec::new() };
    let shares = factor.solve(&side);
    (0..last).filter(|i| shares[(*i, 0)].abs() > SHARE).collect()
}

/// `a, b and c`.
fn enumerate(parts: Vec<String>) -> String {
    match &parts[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => parts.concat(),
    }
}
