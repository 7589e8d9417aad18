//! The rows of supports between nodes and of joints, all together.

use super::constraints::Constraint;
use super::{System, SystemError};
use crate::linear::bordered::BorderRow;

impl System {
    /// Scaled rows of ∂g/∂q in the supports' frames, without the held coordinates.
    pub fn border(&self, load: f64) -> Vec<BorderRow> {
        let mut dense = vec![0.0; self.coordinates()];
        let rows = self.constraints.iter().map(|constraint| {
            dense.fill(0.0);
            let scale = constraint.scale(self.stiffness, self.length);
            for (i, value) in constraint.gradient(load) {
                dense[i] = scale * value;
            }
            self.supports.to_frames(load, &mut dense);
            dense.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect()
        });
        rows.collect()
    }

    /// Writes −g(q), scaled.
    pub fn constraint_values(&self, parameter: f64, q: &[f64], values: &mut [f64]) {
        for (value, constraint) in values.iter_mut().zip(&self.constraints) {
            *value = -constraint.scale(self.stiffness, self.length) * constraint.value(parameter, q);
        }
    }

    /// Writes −∂g/∂q·v, scaled, which is what the rates of unknowns must make up for where supports have the rates `v`.
    pub fn constraint_rates(&self, parameter: f64, v: &[f64], rates: &mut [f64]) {
        for (rate, constraint) in rates.iter_mut().zip(&self.constraints) {
            let scale = constraint.scale(self.stiffness, self.length);
            *rate = -scale * constraint.gradient(parameter).map(|(i, value)| value * v[i]).sum::<f64>();
        }
    }

    /// `f += Bᵀ μ` with the scaled multipliers μ.
    pub fn add_constraint_forces(&self, parameter: f64, multipliers: &[f64], f: &mut [f64]) {
        for (mu, constraint) in multipliers.iter().zip(&self.constraints) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            constraint.gradient(parameter).for_each(|(i, value)| f[i] += mu * value);
        }
    }

    /// Refuses more constraint rows on the same coordinates than there are free ones.
    pub(super) fn check_room(&self) -> Result<(), SystemError> {
        let held = self.held();
        for span in self.constraints.iter().filter_map(Constraint::span) {
            let rows = self.constraints.iter().filter(|other| other.span() == Some(span.clone())).count();
            let free = held[span.clone()].iter().filter(|held| !**held).count();
            if rows > free {
                let (beam, s) = self.place_of(span.start);
                return Err(SystemError::OverSupported {
                    beam: self.beams[beam].name.clone(),
                    s,
                    rows,
                    free,
                });
            }
        }
        Ok(())
    }
}
