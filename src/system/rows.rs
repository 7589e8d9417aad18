//! The constraint rows of supports between nodes, of joints, of inextensible beams and of tendons of given
//! length.

use super::constraints::{Constraint, Holds};
use super::held::{dot, rate_of};
use super::lengths::Lengths;
use super::polar::Polar;
use super::reaction::Source;
use super::{BuildError, System};
use crate::lanes::{self, Lanes};
use crate::linear::Matrix;
use crate::linear::bordered::BorderRow;
use std::collections::BTreeMap;
use std::ops::Range;

impl System {
    /// Scaled rows of ∂g/∂q in the supports' frames, without fixed coordinates. Entries of
    /// nonlinear rows that happen to vanish are kept, so that the pattern does not change.
    pub fn border(&self, load: f64, q: &[f64]) -> Vec<BorderRow> {
        let mut rows = Vec::new();
        self.write_border(&Polar::default(), load, q, &mut rows);
        rows
    }

    /// As [`Self::border`], in memory that was used before.
    pub fn border_again(&self, load: f64, q: &[f64], rows: &mut Vec<BorderRow>) {
        self.write_border(&Polar::default(), load, q, rows);
    }

    /// As [`Self::border`], for the unknowns of a motion.
    pub fn border_in_motion(&self, time: f64, q: &[f64], rows: &mut Vec<BorderRow>) {
        self.write_border(&self.polar, time, q, rows);
    }

    fn write_border(&self, polar: &Polar, load: f64, q: &[f64], rows: &mut Vec<BorderRow>) {
        rows.resize(self.multipliers(), BorderRow::new());
        rows.iter_mut().for_each(Vec::clear);
        let mut dense = Vec::new();
        let mut in_frames = |row: &mut BorderRow, keeps_zeros: bool| {
            dense.resize(self.coordinates(), 0.0);
            row.iter().for_each(|(i, value)| dense[*i] += value);
            // A support's frame mixes the two components.
            let mut touched: Vec<usize> = row.iter().flat_map(|(i, _)| [i & !1, i | 1]).collect();
            touched.sort_unstable();
            touched.dedup();
            self.supports.to_frames(load, &mut dense);
            polar.forces(q, &mut dense);
            let keep = |i: &&usize| !self.fixed[**i] && (keeps_zeros || dense[**i] != 0.0);
            row.clear();
            row.extend(touched.iter().filter(keep).map(|&i| (i, dense[i])));
            touched.iter().for_each(|&i| dense[i] = 0.0);
        };
        for &r in &self.tied {
            let constraint = &self.constraints[r];
            let scale = constraint.scale(self.stiffness, self.length);
            rows[r].extend(constraint.gradient(load, q).map(|(i, value)| (i, scale * value)));
            in_frames(&mut rows[r], constraint.is_nonlinear());
        }
        for lengths in &self.kept {
            lengths.entries(self.unit_of_lengths(), q, |first, numbers, entries| {
                for (number, entries) in numbers.into_iter().zip(entries) {
                    if let Some(row) = number.and_then(|number| rows.get_mut(number)) {
                        add_entries(row, first, entries);
                    }
                }
            });
            let special = |row: &BorderRow| {
                let ends = row.first().zip(row.last());
                ends.is_some_and(|((first, _), (last, _))| self.special[first / 4..=last / 4].contains(&true))
            };
            rows[lengths.numbers()]
                .iter_mut()
                .filter(|row| special(row))
                .for_each(|row| in_frames(row, true));
        }
        for (row, length) in self.held_rows() {
            let mut gradient = vec![0.0; self.coordinates()];
            length.add_gradient(self.unit_of_lengths(), q, &mut gradient);
            let part = &self.beams[length.beam()];
            let coordinates = 4 * part.first_node..4 * (part.first_node + part.basis.nodes().len());
            rows[row].extend(coordinates.map(|i| (i, gradient[i])));
            in_frames(&mut rows[row], true);
        }
    }

    /// What all rows do, as forces \[N\] and moments \[N m\] from the scaled multipliers: those of each
    /// support and then of each joint, in the model's order, of the lengths of beams, and of each
    /// tendon of given length.
    pub fn forces_of_rows(&self, multipliers: &[f64]) -> Vec<Vec<f64>> {
        let of = |row: usize| multipliers[row] * self.unit_of_row(row);
        self.groups_of_rows().into_iter().map(|rows| rows.map(of).collect()).collect()
    }

    /// The scaled multipliers whose groups are such forces; zero where a group has none.
    pub fn multipliers_of<'f>(&self, forces: impl Iterator<Item = Option<&'f [f64]>>) -> Vec<f64> {
        let mut multipliers = vec![0.0; self.multipliers()];
        for (rows, forces) in self.groups_of_rows().into_iter().zip(forces) {
            if let Some(forces) = forces.filter(|forces| forces.len() == rows.len()) {
                rows.zip(forces).for_each(|(row, force)| multipliers[row] = force / self.unit_of_row(row));
            }
        }
        multipliers
    }

    fn groups_of_rows(&self) -> Vec<Range<usize>> {
        let rows = |source: &Source| match source {
            Source::Rows(rows) => rows.clone(),
            Source::Node { .. } => 0..0,
        };
        let mut groups: Vec<Range<usize>> = self.sources.iter().map(rows).collect();
        let lengths = groups.iter().map(|rows| rows.end).max().unwrap_or(0);
        groups.push(lengths..self.constraints.len());
        groups.extend(self.held_rows().map(|(row, _)| row..row + 1));
        groups
    }

    fn unit_of_row(&self, row: usize) -> f64 {
        let constraint = self.constraints.get(row);
        constraint.map_or(self.unit_of_lengths(), |row| row.scale(self.stiffness, self.length))
    }

    /// Factor of the rows of lengths.
    pub(super) fn unit_of_lengths(&self) -> f64 {
        self.stiffness / self.length
    }

    /// Whether any row depends on the state.
    pub fn has_nonlinear_constraints(&self) -> bool {
        !self.terms.held.is_empty() || self.constraints.iter().any(Constraint::is_nonlinear)
    }

    /// `k += Σ μ ∂²g/∂q∂q` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_stiffness(&self, q: &[f64], multipliers: &[f64], k: &mut Matrix) {
        for (mu, constraint) in self.pulling(multipliers) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.second_derivative(q).for_each(|(i, j, value)| k.add_at(i, j, mu * value));
        }
        for lengths in &self.kept {
            lengths.add_stiffness(self.unit_of_lengths(), multipliers, k);
        }
        for (tension, length) in self.tensions(multipliers) {
            length.add_curvature(tension, q, k);
        }
    }

    /// `f += Σ μ ∂²g/∂q∂q·v` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_stiffness_product(&self, q: &[f64], multipliers: &[f64], v: &[f64], f: &mut [f64]) {
        for (mu, constraint) in self.pulling(multipliers) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.second_derivative(q).for_each(|(i, j, value)| f[i] += mu * value * v[j]);
        }
        for lengths in &self.kept {
            lengths.add_forces(self.unit_of_lengths(), v, multipliers, f);
        }
        for (tension, length) in self.tensions(multipliers) {
            length.add_curvature_product(tension, q, v, f);
        }
    }

    /// The constraints that are not summed cell by cell, with their multipliers; none of those whose
    /// multipliers are not known.
    fn pulling<'m>(&'m self, multipliers: &'m [f64]) -> impl Iterator<Item = (f64, &'m Constraint)> {
        self.tied_rows().filter_map(|(r, constraint)| Some((*multipliers.get(r)?, constraint)))
    }

    /// The constraints that are not summed cell by cell, with their numbers.
    fn tied_rows(&self) -> impl Iterator<Item = (usize, &Constraint)> {
        self.tied.iter().map(|&r| (r, &self.constraints[r]))
    }

    /// The row that the state `q` violates most: a beam that it holds and the place there \[m\], whether it is of a length, and
    /// the violation (in beam lengths; in rad for directions).
    pub fn missed(&self, parameter: f64, q: &[f64]) -> Option<((usize, f64), bool, f64)> {
        let missed = self.constraints.iter().map(|row| (row, row.miss(parameter, q, self.length)));
        let (row, miss) = missed.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((self.place_of_row(row), row.is_of_length(), miss))
    }

    /// The place of a row, or the node of its first coordinate.
    pub(super) fn place_of_row(&self, row: &Constraint) -> (usize, f64) {
        let (beam, node) = self.place_of(row.first());
        (beam, row.places().first().copied().unwrap_or(node))
    }

    /// The row whose rate dg/dt the velocities `v` violate most, relative to beam lengths where it is a length: a beam that
    /// it holds and the place there \[m\], what it holds, and the rate (m/s, or rad/s).
    pub fn missed_rate(&self, time: f64, q: &[f64], v: &[f64]) -> Option<((usize, f64), Holds, f64)> {
        let rates = self.constraints.iter().map(|row| {
            let along: f64 = row.gradient(time, q).map(|(i, value)| value * v[i]).sum();
            let rate = (along + row.rate(time, q)).abs();
            let unit = if row.is_of_length() { self.length } else { 1.0 };
            (row, rate, rate / unit)
        });
        let (row, rate, _) = rates.max_by(|a, b| a.2.total_cmp(&b.2))?;
        Some((self.place_of_row(row), row.holds(), rate))
    }

    /// Writes −g(q), scaled.
    pub fn constraint_values(&self, parameter: f64, q: &[f64], values: &mut [f64]) {
        for (r, constraint) in self.tied_rows() {
            values[r] = -constraint.scale(self.stiffness, self.length) * constraint.value(parameter, q);
        }
        self.start_lengths(1.0, values);
        for lengths in &self.kept {
            lengths.add_products(-0.5 * self.unit_of_lengths(), q, q, values);
        }
        for (row, length) in self.held_rows() {
            values[row] = -self.unit_of_lengths() * self.excess(length, parameter, q);
        }
    }

    /// Writes `factor` times the scaled values of the stress-free state into the rows of lengths.
    fn start_lengths(&self, factor: f64, values: &mut [f64]) {
        let factor = factor * self.unit_of_lengths();
        for row in self.kept.iter().flat_map(Lengths::numbers) {
            values[row] = factor * self.constraints[row].kept();
        }
    }

    /// Writes −∂g/∂q·v, scaled, in the state `q`. If `v` are the velocities that supports
    /// prescribe, this is what the rates of the unknowns must contribute.
    pub fn constraint_rates(&self, parameter: f64, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (r, constraint) in self.tied_rows() {
            let scale = constraint.scale(self.stiffness, self.length);
            rates[r] = -scale * constraint.gradient(parameter, q).map(|(i, value)| value * v[i]).sum::<f64>();
        }
        self.start_lengths(0.0, rates);
        for lengths in &self.kept {
            lengths.add_products(-self.unit_of_lengths(), q, v, rates);
        }
        for (row, length) in self.held_rows() {
            rates[row] = -self.unit_of_lengths() * rate_of(length, q, v);
        }
    }

    /// Adds −v·∂²g/∂q∂q·v in the state `q`, scaled: the part of −g̈ that is quadratic in
    /// velocities.
    pub fn add_constraint_curvatures(&self, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (r, constraint) in self.tied_rows() {
            rates[r] -= constraint.scale(self.stiffness, self.length) * constraint.curvature(q, v);
        }
        for lengths in &self.kept {
            lengths.add_products(-self.unit_of_lengths(), v, v, rates);
        }
        for (row, length) in self.held_rows() {
            let mut product = vec![0.0; v.len()];
            length.add_curvature_product(self.unit_of_lengths(), q, v, &mut product);
            rates[row] -= dot(&product, v);
        }
    }

    /// `f += Bᵀ μ` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_forces(&self, parameter: f64, q: &[f64], multipliers: &[f64], f: &mut [f64]) {
        for (mu, constraint) in self.pulling(multipliers) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.gradient(parameter, q).for_each(|(i, value)| f[i] += mu * value);
        }
        for lengths in &self.kept {
            lengths.add_forces(self.unit_of_lengths(), q, multipliers, f);
        }
        for (tension, length) in self.tensions(multipliers) {
            length.add_gradient(tension, q, f);
        }
    }

    /// `f += Bᵀ μ` with the scaled multipliers μ, and writes g, scaled, in the state `q`. Returns
    /// the largest force of a constraint on a node, `scale` or larger; those on gradients are
    /// divided by the beam length.
    pub fn constrain(
        &self,
        parameter: f64,
        [q, multipliers]: [&[f64]; 2],
        f: &mut [f64],
        values: &mut [f64],
        mut scale: f64,
    ) -> f64 {
        let inverse = 1.0 / self.length;
        for (r, constraint) in self.tied_rows() {
            let unit = constraint.scale(self.stiffness, self.length);
            let mu = multipliers[r] * unit;
            for (i, value) in constraint.gradient(parameter, q) {
                scale = scale.max((mu * value).abs() * if i % 4 < 2 { 1.0 } else { inverse });
                f[i] += mu * value;
            }
            values[r] = unit * constraint.value(parameter, q);
        }
        self.start_lengths(-1.0, values);
        for lengths in &self.kept {
            let largest = lengths.balance(self.unit_of_lengths(), q, multipliers, f, values).to_array();
            let units = [1.0, 1.0, inverse, inverse];
            scale =
                largest.into_iter().zip(units).fold(scale, |scale, (force, unit)| scale.max(force * unit));
        }
        for (row, length) in self.held_rows() {
            let forces = self.pull(length, parameter, [q, multipliers], (row, values), f);
            scale = scale.max(forces);
        }
        scale
    }

    /// [`Self::constrain`] in four states, one per lane, each at its own parameter; `scratch` holds
    /// two vectors of coordinates.
    pub fn constrain_in_lanes(
        &self,
        parameters: [f64; 4],
        [q, multipliers]: [&[Lanes]; 2],
        f: &mut [Lanes],
        values: &mut [Lanes],
        mut scale: Lanes,
        scratch: &mut [Vec<f64>; 2],
    ) -> Lanes {
        let inverse = 1.0 / self.length;
        if !self.terms.held.is_empty() {
            let mut scales = scale.to_array();
            let mut of_lane = vec![0.0; multipliers.len()];
            let mut gaps = vec![0.0; multipliers.len()];
            lanes::one_by_one(q, f, scratch, |lane, q, f| {
                let to_lane = |(of_lane, all): (&mut f64, &Lanes)| *of_lane = all.to_array()[lane];
                of_lane.iter_mut().zip(multipliers).for_each(to_lane);
                for (row, length) in self.held_rows() {
                    let largest = self.pull(length, parameters[lane], [q, &of_lane], (row, &mut gaps), f);
                    scales[lane] = scales[lane].max(largest);
                    let mut of_row = values[row].to_array();
                    of_row[lane] = gaps[row];
                    values[row] = Lanes::new(of_row);
                }
            });
            scale = Lanes::new(scales);
        }
        if !self.tied.is_empty() {
            let mut scales = scale.to_array();
            lanes::one_by_one(q, f, scratch, |lane, q, f| {
                for (r, constraint) in self.tied_rows() {
                    let unit = constraint.scale(self.stiffness, self.length);
                    let mu = multipliers[r].to_array()[lane] * unit;
                    for (i, value) in constraint.gradient(parameters[lane], q) {
                        let size = (mu * value).abs() * if i % 4 < 2 { 1.0 } else { inverse };
                        scales[lane] = scales[lane].max(size);
                        f[i] += mu * value;
                    }
                    let mut of_row = values[r].to_array();
                    of_row[lane] = unit * constraint.value(parameters[lane], q);
                    values[r] = Lanes::new(of_row);
                }
            });
            scale = Lanes::new(scales);
        }
        let unit = self.unit_of_lengths();
        for lengths in &self.kept {
            for row in lengths.numbers() {
                values[row] = Lanes::splat(-unit * self.constraints[row].kept());
            }
            let largest = lengths.balance_in_lanes(unit, q, multipliers, f, values);
            for (force, unit) in largest.into_iter().zip([1.0, 1.0, inverse, inverse]) {
                scale = (force * Lanes::splat(unit)).fast_max(scale);
            }
        }
        scale
    }

    /// Refuses more constraint rows on the same coordinates than these have free ones.
    pub(super) fn check_room(&self) -> Result<(), BuildError> {
        let fixed = &self.fixed;
        let mut rows_of: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for span in self.constraints.iter().filter_map(Constraint::span) {
            *rows_of.entry((span.start, span.end)).or_default() += 1;
        }
        for ((start, end), rows) in rows_of {
            let span = start..end;
            let free = fixed[span.clone()].iter().filter(|fixed| !**fixed).count();
            if rows > free {
                let (beam, s) = self.place_of(span.start);
                return Err(BuildError::OverSupported { beam: self.beams[beam].name.clone(), s, rows, free });
            }
        }
        Ok(())
    }
}

/// Adds the entries of a cell, whose first coordinate is `first`, to a row that holds those of the
/// cells before.
fn add_entries(row: &mut BorderRow, first: usize, entries: &[f64]) {
    let start = row.first().map_or(first, |(i, _)| *i);
    let known = row.get_mut(first - start..).unwrap_or_default();
    let (shared, new) = entries.split_at(known.len().min(entries.len()));
    known.iter_mut().zip(shared).for_each(|((_, sum), value)| *sum += value);
    row.extend((first + shared.len()..).zip(new.iter().copied()));
}
