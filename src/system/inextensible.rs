//! Beams whose axis keeps its length: the constraint |r'| = |r'₀|, with the axial force as its
//! multiplier.
//!
//! A beam without an axial stiffness is not given a large one. Instead, the axial force N(s) is an
//! unknown of its own,
//!
//! ```text
//! L = U − … + ∫ N ½ (r'·r' − |r'₀|²) ds,   N(s) = Σ_k N_k φ_k(s)
//! g_k = ∫ φ_k ½ (r'·r' − |r'₀|²) ds = 0,   force  ∫ N r' N' ds,   tangent  ∫ N N'ᵀN' ds ⊗ I
//! ```
//!
//! where N' are the derivatives of the shape functions, and φ_k are continuous quadratic functions:
//! one for every node and one for every cell between nodes. The multipliers N_k \[N\] are the axial
//! force at nodes and midpoints. The beam stores no energy of stretch, no axial wave limits a step,
//! and no digits are lost to a large ratio EA L²/EI.
//!
//! # How many rows
//! A node adds four coordinates. Two rows per cell leave two of them for bending. Three rows would
//! leave one, and a chain of such cells could not take the shape of an arc (membrane locking). The
//! n + 1 nodes and n cells fix the 2n + 2 coordinates of a straight beam along its axis except for
//! the translation. Two rows per cell without continuity would fix one less, and all nodal
//! gradients could shrink together; those of a pendulum shrink to nothing.
//!
//! Where a support fixes both components of a gradient one row would be too many; there N is linear
//! in a cell.
//!
//! # Why integrals
//! Rows at the nodes and midpoints themselves, |r'| = 1, would yield the same motion. But their
//! multipliers are not the axial force if shape functions are not polynomials: with radial point
//! interpolation they scatter by a tenth about it on any mesh, and a chain, whose only stiffness is
//! ∫ N N'ᵀN' ds, has an error of 5e-4 in its fourth frequency.

use super::constraints::Constraint;
use super::lengths::Lengths;
use super::{BuildError, System};
use crate::basis::Quadrature;
use crate::model::{FixedRotation, Model, Place};
use std::ops::Range;

/// Number of Gauss points per cell: exact for cubic shape functions and a quadratic axial force.
pub(super) const POINTS: usize = 4;

/// The place where a multiplier is the axial force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Index of the beam.
    pub beam: usize,
    /// Arc length \[m\].
    pub s: f64,
}

/// The rows of all inextensible beams.
#[derive(Debug, Default)]
pub(super) struct Rows {
    /// In the order of the beams and their arc lengths.
    pub constraints: Vec<Constraint>,
    /// Their places.
    pub places: Vec<Row>,
    /// The beams whose rows are summed cell by cell, with their rows, counted among all
    /// constraints.
    pub summed: Vec<(Lengths, Range<usize>)>,
}

/// The rows of all inextensible beams, which follow the constraints that `system` has.
pub(super) fn rows(system: &System, model: &Model) -> Result<Rows, BuildError> {
    let held = held_lengths(system, model);
    let before_rows = system.constraints.len();
    let (mut places, mut rows, mut summed) = (Vec::new(), Vec::new(), Vec::new());
    for (index, (beam, part)) in model.beams.iter().zip(&system.beams).enumerate() {
        if beam.section.axial_stiffness.is_some() {
            continue;
        }
        let nodes = part.basis.nodes();
        // N is linear in the cell to the right of a node with a fixed gradient, or to the left if
        // it is the last node.
        let linear = |cell: usize| {
            let held = |node: usize| held.contains(&(part.first_node + node));
            held(cell) || cell + 2 == nodes.len() && held(cell + 1)
        };
        let in_basis = |e| BuildError::basis(&part.name, e);
        let table = part.basis.table(Quadrature::Gauss(POINTS), &[1]).map_err(in_basis)?;
        let (xi, _) = Quadrature::Gauss(POINTS).rule().map_err(in_basis)?;
        // Per node, and per cell: the points at which its function φ does not vanish.
        let mut of_node: Vec<Vec<(usize, &[f64], f64)>> = vec![Vec::new(); nodes.len()];
        let mut of_cell = vec![Vec::new(); nodes.len() - 1];
        for (c, cell) in table.cells.iter().enumerate() {
            let (weights, shapes) = table.block(*cell);
            let first = 2 * (part.offset() + cell.first as usize);
            for ((xi, weight), shape) in xi.iter().zip(weights).zip(shapes.chunks_exact(table.width)) {
                let [left, middle, right] = functions(*xi, linear(c));
                of_node[c].push((first, shape, weight * left));
                of_node[c + 1].push((first, shape, weight * right));
                if middle != 0.0 {
                    of_cell[c].push((first, shape, weight * middle));
                }
            }
        }
        let first = before_rows + rows.len();
        let mut of_cells = vec![[None; 3]; nodes.len() - 1];
        for (i, points) in of_node.iter().enumerate() {
            if let Some(before) = i.checked_sub(1) {
                of_cells[before][2] = Some(before_rows + rows.len());
            }
            if let Some(after) = of_cells.get_mut(i) {
                after[0] = Some(before_rows + rows.len());
            }
            places.push(Row { beam: index, s: nodes[i] });
            rows.push(Constraint::length(points, &system.reference));
            if let Some(points) = of_cell.get(i).filter(|points| !points.is_empty()) {
                of_cells[i][1] = Some(before_rows + rows.len());
                places.push(Row { beam: index, s: 0.5 * (nodes[i] + nodes[i + 1]) });
                rows.push(Constraint::length(points, &system.reference));
            }
        }
        let at_points = |linear| std::array::from_fn(|p| functions(xi[p], linear));
        let functions = [at_points(false), at_points(true)];
        if let Some(lengths) = Lengths::new(part.offset(), table, of_cells, functions) {
            summed.push((lengths, first..before_rows + rows.len()));
        }
    }
    Ok(Rows { constraints: rows, places, summed })
}

/// The functions φ of the left node, the cell and the right node at ξ.
fn functions(xi: f64, linear: bool) -> [f64; 3] {
    if linear {
        [1.0 - xi, 0.0, xi]
    } else {
        [(1.0 - xi) * (1.0 - 2.0 * xi), 4.0 * xi * (1.0 - xi), xi * (2.0 * xi - 1.0)]
    }
}

/// Nodes whose gradient keeps its length already, because supports fix both of its components.
fn held_lengths(system: &System, model: &Model) -> Vec<usize> {
    let node_at = |at: Place| {
        let part = system.beams.get(at.beam)?;
        Some(part.first_node + part.basis.node_at(part.arc_length("a support", at.s).ok()?)?)
    };
    let supports = model.supports.iter().filter(|support| support.fix.rotation == FixedRotation::Gradient);
    supports.filter_map(|support| node_at(support.at)).collect()
}

impl System {
    /// Per row of an inextensible beam: the index of the beam, and the row's bytes.
    pub(super) fn lengths(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let first = self.constraints.len() - self.lengths.len();
        self.lengths.iter().zip(&self.constraints[first..]).map(|(row, c)| (row.beam, c.bytes()))
    }

    /// The axial force \[N\] at the arc lengths `s` of an inextensible beam; `None` for other
    /// beams. `multipliers` are the scaled μ.
    pub fn axial_force(&self, beam: usize, multipliers: &[f64], s: &[f64]) -> Option<Vec<f64>> {
        let first = self.constraints.len() - self.lengths.len();
        let rows = self.constraints[first..].iter().zip(multipliers.get(first..)?);
        let of_beam = self.lengths.iter().zip(rows).filter(|(row, _)| row.beam == beam);
        let known: Vec<(f64, f64)> =
            of_beam.map(|(row, (c, mu))| (row.s, mu * c.scale(self.stiffness, self.length))).collect();
        let basis = &self.beams.get(beam)?.basis;
        let value = |s: f64| known.iter().find(|(at, _)| *at == s).map_or(0.0, |(_, force)| *force);
        let at = |&s: &f64| {
            let cell = basis.cell_at(s);
            let (left, right) = (basis.nodes()[cell], basis.nodes()[cell + 1]);
            let middle = known.iter().find(|(at, _)| *at > left && *at < right);
            let [a, b, c] = functions((s - left) / (right - left), middle.is_none());
            a * value(left) + b * middle.map_or(0.0, |(_, force)| *force) + c * value(right)
        };
        (!known.is_empty()).then(|| s.iter().map(at).collect())
    }
}
