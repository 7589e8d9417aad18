//! Constraint rows that are linearly dependent.
//!
//! The multipliers of linearly dependent rows are undetermined, and a factorisation finds no pivot
//! for them. Dependence is detected in the state in which an analysis begins, by the Gram matrix G = B Bᵀ of the
//! rows, each normalised to length 1, without coordinates fixed by supports at nodes. The smallest
//! eigenvalue of G is the squared length of the shortest combination of rows with coefficients of
//! norm 1. Inverse iteration finds it together with the combination. (Row-by-row elimination is not
//! suitable: the rows of a chain of cells that is fixed at both ends become exponentially close to
//! each other before the last of them decides whether they are dependent.) A closed loop of beams
//! that bend may be constrained more often than necessary and still has determined multipliers; a
//! loop of straight inextensible beams may not.

use super::reaction::Source;
use super::{BuildError, System};
use crate::linear::bordered::BorderRow;
use crate::model::{Joint, Model, Place};
use crate::numeric::{GOLDEN, plain};
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use std::collections::BTreeMap;

/// Largest eigenvalue that counts as zero: far below that of a shallow arch's thrust, far above
/// round-off.
const DEPENDENT: f64 = 1e-12;
/// Added to the diagonal, so that G can be factorised even if rows are dependent.
const SHIFT: f64 = 1e-13;
/// Number of inverse iterations. Each amplifies the share of an eigenvalue that counts as zero more
/// than a thousandfold relative to eigenvalues ten thousand times as large.
const ITERATIONS: usize = 6;
/// Smallest coefficient with which a row counts as part of a combination.
const SHARE: f64 = 1e-6;

impl System {
    /// Refuses linearly dependent rows.
    pub(super) fn check_rows(&self, model: &Model) -> Result<(), BuildError> {
        let rows = self.directions();
        let Some(involved) = dependent(&rows) else { return Ok(()) };
        // A row that is empty because supports at nodes fix all of its coordinates.
        let held = involved.first().copied().filter(|row| rows[*row].is_empty());
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
        let tendons = self.held_rows().filter(|(row, _)| involved.contains(row));
        let pulled: Vec<usize> = tendons.map(|(_, length)| length.beam()).collect();
        parts.extend(pulled.iter().map(|&beam| format!("a tendon of beam `{}`", self.beams[beam].name)));
        // Of a tendon whose row is empty, supports alone give the length.
        if held.is_some() {
            beams.extend(pulled);
        }
        // The supports at the places of the joint of such a row are named, too.
        let tie = held.and_then(|row| self.joint_of(row, model));
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
            Some(joint) => Err(BuildError::ToItself { joint: self.joint_in_words(joint) }),
            None => Err(BuildError::Redundant { parts: enumerate(parts) }),
        }
    }

    fn joint_of(&self, row: usize, model: &Model) -> Option<Joint> {
        let mut joints = self.sources[model.supports.len()..].iter().zip(&model.joints);
        let of_joint = |source: &Source| matches!(source, Source::Rows(rows) if rows.contains(&row));
        joints.find(|(source, _)| of_joint(source)).map(|(_, joint)| *joint)
    }

    /// The rows in the state in which an analysis begins, with positions in beam lengths, each normalised
    /// to length 1; a row is empty if supports at nodes fix all of its coordinates.
    fn directions(&self) -> Vec<BorderRow> {
        let mut rows = self.border(0.0, self.start());
        let of_lengths = self.stiffness / self.length;
        let usual = self.constraints.iter().map(|row| match row.scale(self.stiffness, self.length) {
            scale if row.is_of_length() => scale,
            scale => scale / self.length,
        });
        let usual = usual.chain(self.terms.held.iter().map(|_| of_lengths));
        for (row, usual) in rows.iter_mut().zip(usual) {
            // Dividing the entries for gradients by the length gives them the unit of the entries
            // for positions: none, or an inverse length.
            row.iter_mut().filter(|(i, _)| i % 4 > 1).for_each(|(_, value)| *value /= self.length);
            let size = row.iter().map(|(_, value)| value * value).sum::<f64>().sqrt();
            if size > SHARE * SHARE * usual {
                row.iter_mut().for_each(|(_, value)| *value /= size);
                row.retain(|(_, value)| *value != 0.0);
            } else {
                row.clear();
            }
        }
        rows
    }

    fn place_in_words(&self, place: Place) -> String {
        format!("s = {} m of beam `{}`", plain(place.s, 4), self.beams[place.beam].name)
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

/// The rows of a linear combination that vanishes, or a single empty row; `None` if all rows are
/// independent.
fn dependent(rows: &[BorderRow]) -> Option<Vec<usize>> {
    if let Some(empty) = rows.iter().position(Vec::is_empty) {
        return Some(vec![empty]);
    }
    if rows.is_empty() {
        return None;
    }
    let mut touching: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
    for (r, row) in rows.iter().enumerate() {
        row.iter().for_each(|(i, value)| touching.entry(*i).or_default().push((r, *value)));
    }
    let pairs = touching.values().flat_map(|rows| {
        let later = rows.iter().enumerate();
        later.flat_map(move |(k, &(r, a))| rows[k..].iter().map(move |&(c, b)| Triplet::new(r, c, a * b)))
    });
    let shift = (0..rows.len()).map(|r| Triplet::new(r, r, SHIFT));
    let gram: Vec<_> = pairs.chain(shift).collect();
    let gram = SparseColMat::<usize, f64>::try_new_from_triplets(rows.len(), rows.len(), &gram).ok()?;
    let factor = gram.sp_cholesky(Side::Upper).ok()?;
    // Irregular starting values, the same in every run.
    let mut shares = Mat::from_fn(rows.len(), 1, |i, _| ((i + 1) as f64 * GOLDEN).fract() - 0.5);
    for _ in 0..ITERATIONS {
        shares = factor.solve(&shares);
        let size = shares.norm_l2();
        shares *= faer::Scale(1.0 / size);
    }
    let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
    for (r, row) in rows.iter().enumerate() {
        row.iter().for_each(|(i, value)| *sum.entry(*i).or_default() += shares[(r, 0)] * value);
    }
    let square: f64 = sum.values().map(|value| value * value).sum();
    let involved = (0..rows.len()).filter(|r| shares[(*r, 0)].abs() > SHARE);
    (square <= DEPENDENT).then(|| involved.collect())
}

/// Joins the parts as `a, b and c`.
fn enumerate(parts: Vec<String>) -> String {
    match &parts[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => parts.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows normalised to length 1.
    fn rows(of: &[&[(usize, f64)]]) -> Vec<BorderRow> {
        let unit = |row: &&[(usize, f64)]| {
            let size = row.iter().map(|(_, value)| value * value).sum::<f64>().sqrt();
            row.iter().map(|(i, value)| (*i, value / size)).collect()
        };
        of.iter().map(unit).collect()
    }

    #[test]
    fn combinations_are_found_with_their_rows() {
        let (a, b): (&[_], &[_]) = (&[(0, 1.0), (1, 2.0)], &[(1, 1.0), (2, -3.0)]);
        let sum: &[_] = &[(0, 1.0), (1, 3.0), (2, -3.0)];
        let other: &[_] = &[(1, 1.0), (4, 1.0)];
        assert_eq!(dependent(&rows(&[])), None);
        assert_eq!(dependent(&rows(&[a, other, b])), None);
        assert_eq!(dependent(&rows(&[a, other, b, sum])), Some(vec![0, 2, 3]));
        assert_eq!(dependent(&[rows(&[a]), vec![Vec::new()]].concat()), Some(vec![1]));
        // The last row differs from a combination by an angle of 1e-4, or of 1e-8.
        for (angle, found) in [(1e-4, None), (1e-8, Some(vec![0, 2, 3]))] {
            let nearly: &[_] = &[(0, 1.0), (1, 3.0), (2, -3.0), (5, angle * 19.0_f64.sqrt())];
            assert_eq!(dependent(&rows(&[a, other, b, nearly])), found);
        }
    }
}
