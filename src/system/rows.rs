//! The constraint rows of supports between nodes, of joints and of inextensible beams.

use super::constraints::Constraint;
use super::polar::Polar;
use super::{BuildError, System};
use crate::linear::Matrix;
use crate::linear::bordered::BorderRow;
use std::collections::BTreeMap;

impl System {
    /// Scaled rows of ∂g/∂q in the supports' frames, without fixed coordinates. Entries of
    /// nonlinear rows that happen to vanish are kept, so that the pattern does not change.
    pub fn border(&self, load: f64, q: &[f64]) -> Vec<BorderRow> {
        self.border_of(&Polar::default(), load, q)
    }

    /// As [`Self::border`], for the unknowns of a motion.
    pub fn border_in_motion(&self, time: f64, q: &[f64]) -> Vec<BorderRow> {
        self.border_of(&self.polar, time, q)
    }

    fn border_of(&self, polar: &Polar, load: f64, q: &[f64]) -> Vec<BorderRow> {
        let mut dense = vec![0.0; self.coordinates()];
        let fixed = self.fixed();
        let mut rows = Vec::with_capacity(self.constraints.len());
        for constraint in &self.constraints {
            let scale = constraint.scale(self.stiffness, self.length);
            let mut touched = Vec::new();
            for (i, value) in constraint.gradient(load, q) {
                dense[i] += scale * value;
                // A support's frame mixes the two components.
                touched.extend([i & !1, i | 1]);
            }
            touched.sort_unstable();
            touched.dedup();
            self.supports.to_frames(load, &mut dense);
            polar.forces(q, &mut dense);
            let keep = |i: &usize| !fixed[*i] && (constraint.is_nonlinear() || dense[*i] != 0.0);
            rows.push(touched.iter().filter(|i| keep(i)).map(|&i| (i, dense[i])).collect());
            touched.iter().for_each(|&i| dense[i] = 0.0);
        }
        rows
    }

    /// Whether any row depends on the state.
    pub fn has_nonlinear_constraints(&self) -> bool {
        self.constraints.iter().any(Constraint::is_nonlinear)
    }

    /// `k += Σ μ ∂²g/∂q∂q` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_stiffness(&self, q: &[f64], multipliers: &[f64], k: &mut Matrix) {
        for (mu, constraint) in multipliers.iter().zip(&self.constraints) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.second_derivative(q).for_each(|(i, j, value)| k.add_at(i, j, mu * value));
        }
    }

    /// `f += Σ μ ∂²g/∂q∂q·v` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_stiffness_product(&self, q: &[f64], multipliers: &[f64], v: &[f64], f: &mut [f64]) {
        for (mu, constraint) in multipliers.iter().zip(&self.constraints) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.second_derivative(q).for_each(|(i, j, value)| f[i] += mu * value * v[j]);
        }
    }

    /// The row that the state `q` violates most: one of its coordinates, and the violation (in beam
    /// lengths; in rad for directions).
    pub fn missed(&self, parameter: f64, q: &[f64]) -> Option<(usize, f64)> {
        let missed = self.constraints.iter().map(|row| (row.first(), row.miss(parameter, q, self.length)));
        missed.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Writes −g(q), scaled.
    pub fn constraint_values(&self, parameter: f64, q: &[f64], values: &mut [f64]) {
        for (value, constraint) in values.iter_mut().zip(&self.constraints) {
            *value = -constraint.scale(self.stiffness, self.length) * constraint.value(parameter, q);
        }
    }

    /// Writes −∂g/∂q·v, scaled, in the state `q`. If `v` are the velocities that supports
    /// prescribe, this is what the rates of the unknowns must contribute.
    pub fn constraint_rates(&self, parameter: f64, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (rate, constraint) in rates.iter_mut().zip(&self.constraints) {
            let scale = constraint.scale(self.stiffness, self.length);
            *rate = -scale * constraint.gradient(parameter, q).map(|(i, value)| value * v[i]).sum::<f64>();
        }
    }

    /// Adds −v·∂²g/∂q∂q·v in the state `q`, scaled: the part of −g̈ that is quadratic in
    /// velocities.
    pub fn add_constraint_curvatures(&self, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (rate, constraint) in rates.iter_mut().zip(&self.constraints) {
            *rate -= constraint.scale(self.stiffness, self.length) * constraint.curvature(q, v);
        }
    }

    /// `f += Bᵀ μ` with the scaled multipliers μ, in the state `q`.
    pub fn add_constraint_forces(&self, parameter: f64, q: &[f64], multipliers: &[f64], f: &mut [f64]) {
        for (mu, constraint) in multipliers.iter().zip(&self.constraints) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.gradient(parameter, q).for_each(|(i, value)| f[i] += mu * value);
        }
    }

    /// Refuses more constraint rows on the same coordinates than these have free ones.
    pub(super) fn check_room(&self) -> Result<(), BuildError> {
        let fixed = self.fixed();
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
