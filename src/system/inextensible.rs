//! Beams whose axis keeps its length: the constraint |r'| = |r'₀|, with the axial force as its multiplier.
//!
//! A beam that names no axial stiffness is not given a large one. At its nodes and in the middle of every cell between them a row holds the length of the
//! gradient,
//!
//! ```text
//! g_p = ½ w_p (r'(s_p)·r'(s_p) − |r'₀(s_p)|²) = 0,   force  Σ_p N_p w_p r'(s_p) N'(s_p),   tangent  Σ_p N_p w_p N'ᵀN' ⊗ I
//! ```
//!
//! with the weights w_p \[m\] of Simpson's rule, so that the multipliers N_p \[N\] are the axial force there. No stretch is stored, no axial wave limits a
//! step, and no digit is lost to a ratio EA L²/EI.
//!
//! # Where the rows stand
//! A node adds four coordinates. Two rows a cell leave two for bending, three would leave one and a chain of cells that cannot take the shape of
//! an arc (membrane locking). The n + 1 nodes and n midpoints hold the 2n + 2 coordinates of a straight beam along its axis but for the
//! translation. Two Gauss points a cell would hold one less: all nodal gradients could shrink together, and those of a pendulum do, to nothing.
//!
//! A gradient that a support holds wholly needs no row of its own, and of gradients welded to each other one row holds all.

use super::constraints::Constraint;
use super::{BeamPart, System, SystemError};
use crate::basis::BasisTable;
use crate::model::{FixedRotation, Joint, Model, Place};

/// A row: where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Index of the beam.
    pub beam: usize,
    /// Arc length \[m\].
    pub s: f64,
}

/// The rows of all inextensible beams in the order of their arc lengths.
pub(super) fn rows(system: &System, model: &Model) -> Result<(Vec<Row>, Vec<Constraint>), SystemError> {
    let held = held_lengths(system, model);
    let (mut places, mut rows) = (Vec::new(), Vec::new());
    for (index, (beam, part)) in model.beams.iter().zip(&system.beams).enumerate() {
        if beam.section.axial_stiffness.is_some() {
            continue;
        }
        let nodes = part.basis.nodes();
        let spacing = |cell: usize| nodes.get(cell + 1).map_or(0.0, |end| end - nodes[cell]);
        // Simpson's weights: h/6 from either side at a node, 2h/3 in the middle.
        let mut points = Vec::with_capacity(2 * nodes.len());
        for (i, &s) in nodes.iter().enumerate() {
            if !held.contains(&(part.first_node + i)) {
                let before = if i > 0 { spacing(i - 1) } else { 0.0 };
                points.push((s, (before + spacing(i)) / 6.0));
            }
            if i + 1 < nodes.len() {
                points.push((s + 0.5 * spacing(i), spacing(i) * 2.0 / 3.0));
            }
        }
        let s: Vec<f64> = points.iter().map(|(s, _)| *s).collect();
        let table = part.basis.points(&s, &[1]).map_err(|e| SystemError::basis(&part.name, e))?;
        places.extend(s.iter().map(|&s| Row { beam: index, s }));
        let weights = points.iter().map(|(_, weight)| *weight);
        rows.extend(constraints(part, &table, weights, &system.reference));
    }
    Ok((places, rows))
}

fn constraints<'t>(
    part: &'t BeamPart,
    table: &'t BasisTable,
    weights: impl Iterator<Item = f64> + 't,
    reference: &'t [f64],
) -> impl Iterator<Item = Constraint> + 't {
    table.cells.iter().zip(weights).map(move |(cell, weight)| {
        let (_, shape) = table.block(*cell);
        // At a node all functions but one vanish.
        let from = shape.iter().position(|n| *n != 0.0).unwrap_or(0);
        let to = shape.iter().rposition(|n| *n != 0.0).map_or(from, |last| last + 1);
        let first = 2 * (part.offset() + cell.first as usize + from);
        Constraint::length(first, &shape[from..to], weight, reference)
    })
}

/// Nodes whose gradient keeps its length already: supports hold all of it, or a weld ties it to another that has a row.
fn held_lengths(system: &System, model: &Model) -> Vec<usize> {
    let node_at = |at: Place| {
        let part = system.beams.get(at.beam)?;
        Some(part.first_node + part.basis.node_at(part.arc_length("a support", at.s).ok()?)?)
    };
    let supports = model.supports.iter().filter(|support| support.fix.rotation == FixedRotation::Gradient);
    let mut held: Vec<usize> = supports.filter_map(|support| node_at(support.at)).collect();
    // Nodes tied to each other, each tie naming the group that it joins.
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for joint in &model.joints {
        let Joint::Weld { first, second } = *joint else { continue };
        let (Some(a), Some(b)) = (node_at(first), node_at(second)) else { continue };
        let (mut tied, others): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.contains(&a) || group.contains(&b));
        let mut group: Vec<usize> = tied.drain(..).flatten().chain([a, b]).collect();
        group.sort_unstable();
        group.dedup();
        groups = others;
        groups.push(group);
    }
    let inextensible = |node: &usize| {
        let (beam, _) = system.place_of(4 * node);
        model.beams[beam].section.axial_stiffness.is_none()
    };
    for group in groups {
        let keeps = if group.iter().any(|node| held.contains(node)) { 0 } else { 1 };
        held.extend(group.into_iter().filter(inextensible).skip(keeps));
    }
    held
}

impl System {
    /// Per row the beam, and the row's bytes.
    pub(super) fn lengths(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let first = self.constraints.len() - self.lengths.len();
        self.lengths.iter().zip(&self.constraints[first..]).map(|(row, c)| (row.beam, c.bytes()))
    }

    /// (s \[m\], axial force \[N\]) along an inextensible beam, in the order of s; nothing for any other. `multipliers` are the scaled μ.
    pub fn axial_forces(&self, beam: usize, multipliers: &[f64]) -> Vec<(f64, f64)> {
        let first = self.constraints.len() - self.lengths.len();
        let rows = self.constraints[first..].iter().zip(multipliers.get(first..).unwrap_or(&[]));
        let of_beam = self.lengths.iter().zip(rows).filter(|(row, _)| row.beam == beam);
        of_beam.map(|(row, (c, mu))| (row.s, mu * c.scale(self.stiffness, self.length))).collect()
    }
}
