//! Turns of torsion springs.
//!
//! A torsion spring has W = ½ k θ² with the angle θ = α + 2πn of all turns. Of a state one knows α,
//! from −π to π; n is that by which θ is nearest to the angle θ_h of the last accepted state. The
//! part ½ k α² is summed as all elastic energies are, and what a winding adds,
//!
//! ```text
//! W = 2πn k (α + πn),   ∂W/∂α = 2πn k,
//! ```
//!
//! by [`Winding`]: nothing, until the spring has passed half a turn.

use super::{AcceptedState, Actions, Effect, InternalVariables, Workspace};
use crate::linear::Matrix;
use std::f64::consts::TAU;

/// What a torsion spring adds where it has passed half a turn.
pub struct Winding {
    direction: Box<dyn Effect>,
    stiffness: f64,
    number: usize,
}

impl Winding {
    /// Of the spring with k = `stiffness` \[N m/rad\] on the density `direction` of the angle,
    /// number `number` of all.
    pub fn new(direction: Box<dyn Effect>, stiffness: f64, number: usize) -> Self {
        Self { direction, stiffness, number }
    }

    /// Index of the beam.
    pub fn beam(&self) -> usize {
        self.direction.beam()
    }

    /// θ in the state `q` \[rad\].
    pub fn angle(&self, accepted: &AcceptedState, q: &[f64]) -> f64 {
        let known = accepted.variables.angles.get(self.number).copied().unwrap_or(0.0);
        let angle = self.direction.energy(q);
        angle + TAU * ((known - angle) / TAU).round()
    }

    /// 2πn, where θ is `angle`.
    fn beyond(angle: f64) -> f64 {
        TAU * (angle / TAU).round()
    }

    /// W, where θ is `angle` \[J\].
    pub fn energy(&self, angle: f64) -> f64 {
        let beyond = Self::beyond(angle);
        self.stiffness * beyond * (angle - 0.5 * beyond)
    }

    /// `f += ` ∂W/∂q.
    pub fn add_force(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]) {
        self.add_force_at(self.angle(accepted, q), q, f);
    }

    /// The same, where θ is `angle`.
    pub fn add_force_at(&self, angle: f64, q: &[f64], f: &mut [f64]) {
        let beyond = Self::beyond(angle);
        if beyond != 0.0 {
            self.direction.add_force(self.stiffness * beyond, q, f);
        }
    }

    /// The same, and `k += ` ∂²W/∂q∂q.
    pub fn add_force_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let beyond = Self::beyond(self.angle(accepted, q));
        if beyond != 0.0 {
            self.direction.add_force_and_tangent(self.stiffness * beyond, q, None, f, k, workspace);
        }
    }

    /// `k += ` ∂²W/∂q∂q, where θ is `angle`.
    pub fn add_tangent_at(&self, angle: f64, q: &[f64], k: &mut Matrix) {
        let beyond = Self::beyond(angle);
        if beyond != 0.0 {
            let (mut idle, mut workspace) = (vec![0.0; q.len()], Workspace::default());
            let factor = self.stiffness * beyond;
            self.direction.add_force_and_tangent(factor, q, None, &mut idle, k, &mut workspace);
        }
    }

    /// `f += ` ∂²W/∂q∂q `v`, where θ is `angle`.
    pub fn add_tangent_product_at(&self, angle: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.direction.add_tangent_product(self.stiffness * Self::beyond(angle), q, v, f);
    }

    /// What it does to its beam, where θ is the angle among `variables`.
    pub fn add_actions(&self, variables: &InternalVariables, q: &[f64], sum: &mut Actions) {
        let angle = variables.angles.get(self.number).copied().unwrap_or(0.0);
        self.direction.add_actions(self.stiffness * Self::beyond(angle), q, q, sum);
    }

    /// By how much the spring has turned since the last accepted state \[rad\].
    pub fn turn(&self, accepted: &AcceptedState, q: &[f64]) -> f64 {
        let angle = self.angle(accepted, q);
        angle - accepted.variables.angles.get(self.number).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_winding_makes_the_energy_that_of_all_turns() {
        let angles: Vec<f64> = (-40..40).map(|k| 0.37 * f64::from(k)).collect();
        for angle in angles {
            let beyond = Winding::beyond(angle);
            let within = angle - beyond;
            assert!(within.abs() <= PI + 1e-12);
            let sum = 0.5 * within * within + beyond * (angle - 0.5 * beyond);
            assert!((sum - 0.5 * angle * angle).abs() < 1e-12, "{angle}: {sum}");
        }
    }
}
