//! The rows of tendons of given length, which are the last of all constraint rows.

use super::System;
use crate::assembly::{Amplitude, HeldLength};

/// Excess of a tendon's length, in beam lengths, that counts as round-off.
const ROUND_OFF: f64 = 1e-12;

impl System {
    /// The lengths of tendons that are kept, with the numbers of their rows: the last ones.
    pub(super) fn held_rows(&self) -> impl Iterator<Item = (usize, &HeldLength)> {
        (self.constraints.len()..).zip(&self.terms.held)
    }

    /// The lengths of tendons that are kept, with their tensions \[N\]; none whose multipliers are not
    /// known.
    pub fn tensions<'m>(&'m self, multipliers: &'m [f64]) -> impl Iterator<Item = (f64, &'m HeldLength)> {
        let unit = self.unit_of_lengths();
        self.held_rows().filter_map(move |(row, length)| Some((unit * *multipliers.get(row)?, length)))
    }

    pub(super) fn amplitude_of_length<'a>(&'a self, length: &'a HeldLength) -> &'a Amplitude {
        length.amplitude.as_ref().unwrap_or(&self.amplitude)
    }

    /// g of a tendon of given length \[m\].
    pub(super) fn excess(&self, length: &HeldLength, parameter: f64, q: &[f64]) -> f64 {
        let wanted = length.shortening * self.amplitude_of_length(length).at(parameter);
        length.stretch(q) + wanted - length.remains_open(parameter)
    }

    /// Lets the rows of tendons be open in the state `q` at load factor 0.
    pub(super) fn begin_lengths_open(&mut self, q: &[f64]) {
        for k in 0..self.terms.held.len() {
            // Not what is left of another state, such as the one in which the scene begins.
            self.terms.held[k].begin_open(0.0);
            let open = self.excess(&self.terms.held[k], 0.0, q);
            let open = if open.abs() > ROUND_OFF * self.length { open } else { 0.0 };
            self.terms.held[k].begin_open(open);
        }
    }

    /// Whether there are tendons of given length.
    pub fn has_held_lengths(&self) -> bool {
        !self.terms.held.is_empty()
    }

    /// Whether a tendon is pulled by a law of time.
    pub fn pulls_in_time(&self) -> bool {
        self.terms.held.iter().any(|length| self.amplitude_of_length(length).law().is_some())
    }

    /// Whether supports move, or tendons of given length are pulled, by laws of time: both do work.
    pub fn works_by_constraints(&self) -> bool {
        self.supports.moves_in_time() || self.pulls_in_time()
    }

    /// Adds −∂g/∂t, scaled, to the rows of tendons whose lengths follow the time; with `order` 2
    /// −∂²g/∂t².
    pub fn add_prescribed_rates(&self, order: usize, time: f64, rates: &mut [f64]) {
        for (row, length) in self.held_rows() {
            let rate = self.amplitude_of_length(length).rates(time)[order];
            rates[row] -= self.unit_of_lengths() * length.shortening * rate;
        }
    }

    /// Writes −∂g/∂λ − ∂g/∂q·v, scaled, into the rows of tendons, where `v` are the rates that supports
    /// prescribe.
    pub fn held_load_rates(&self, load: f64, q: &[f64], v: Option<&[f64]>, rates: &mut [f64]) {
        let unit = self.unit_of_lengths();
        for (row, length) in self.held_rows() {
            let along = v.map_or(0.0, |v| rate_of(length, q, v));
            let rate = self.amplitude_of_length(length).rate(load);
            rates[row] = -unit * (length.shortening * rate - length.closes(load) + along);
        }
    }

    /// The tendon of given length that is farthest from it in the state `q`: the name of its beam, and
    /// by how much it is too long \[m\].
    pub fn missed_length(&self, parameter: f64, q: &[f64]) -> Option<(&str, f64)> {
        let excess = self.terms.held.iter().map(|length| (length, self.excess(length, parameter, q)));
        let (length, excess) = excess.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some((&self.beams[length.beam()].name, excess))
    }

    /// [`System::constrain`] for the row of one tendon.
    pub(super) fn pull(
        &self,
        length: &HeldLength,
        parameter: f64,
        [q, multipliers]: [&[f64]; 2],
        (row, values): (usize, &mut [f64]),
        f: &mut [f64],
    ) -> f64 {
        let unit = self.unit_of_lengths();
        let mut force = vec![0.0; q.len()];
        length.add_gradient(unit * multipliers[row], q, &mut force);
        values[row] = unit * self.excess(length, parameter, q);
        let inverse = 1.0 / self.length;
        force.iter().zip(f).enumerate().fold(0.0, |largest: f64, (i, (force, f))| {
            *f += force;
            largest.max(force.abs() * if i % 4 < 2 { 1.0 } else { inverse })
        })
    }
}

/// ∂g/∂q·v of a tendon of given length.
pub(super) fn rate_of(length: &HeldLength, q: &[f64], v: &[f64]) -> f64 {
    let mut gradient = vec![0.0; q.len()];
    length.add_gradient(1.0, q, &mut gradient);
    dot(&gradient, v)
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
