//! Full turns of torsion springs.
//!
//! A torsion spring has the energy W = ½ k θ² with the angle θ = α + 2πn that counts all turns. A
//! state determines only α, from −π to π; n is chosen so that θ is nearest to the angle θ_h of the
//! last accepted state. The part ½ k α² is summed like all elastic energies. The full turns add
//!
//! ```text
//! W = 2πn k (α + πn),   ∂W/∂α = 2πn k,
//! ```
//!
//! which a [`Winding`] computes. It is zero until the spring has passed half a turn.

use super::{AcceptedState, Actions, Effect, InternalVariables, Workspace};
use crate::beam::Place;
use crate::linear::Matrix;
use std::f64::consts::TAU;

/// The terms that a torsion spring adds once it has passed half a turn.
pub struct Winding {
    at: Place,
    direction: Box<dyn Effect>,
    stiffness: f64,
    number: usize,
}

impl Winding {
    /// The winding of the spring at the point `at` with k = `stiffness` \[N m/rad\], whose angle is the
    /// density `direction`; `number` is its index among all windings.
    pub fn new(at: Place, direction: Box<dyn Effect>, stiffness: f64, number: usize) -> Self {
        Self { at, direction, stiffness, number }
    }

    /// Where the spring is.
    pub fn at(&self) -> Place {
        self.at
    }

    /// Index of the beam.
    pub fn beam(&self) -> usize {
        self.direction.beam()
    }

    /// The angle θ with all turns in the state `q` \[rad\].
    pub fn angle(&self, accepted: &AcceptedState, q: &[f64]) -> f64 {
        self.angle_near(accepted.variables.angles.get(self.number).copied().unwrap_or(0.0), q)
    }

    /// The angle θ in the state `q` that is nearest to one that is `known` \[rad\].
    pub fn angle_near(&self, known: f64, q: &[f64]) -> f64 {
        let angle = self.direction.energy(q);
        angle + TAU * ((known - angle) / TAU).round()
    }

    /// 2πn for the angle θ = `angle`.
    fn beyond(angle: f64) -> f64 {
        TAU * (angle / TAU).round()
    }

    /// 2πn for the angle θ = `angle` in the state `q`: after just half a turn n is the one that belongs to α, which may be π or −π.
    fn beyond_in(&self, angle: f64, q: &[f64]) -> f64 {
        Self::beyond(angle - self.direction.energy(q))
    }

    /// W \[J\] for the angle θ = `angle`. After just half a turn either n gives the same.
    pub fn energy(&self, angle: f64) -> f64 {
        let beyond = Self::beyond(angle);
        self.stiffness * beyond * (angle - 0.5 * beyond)
    }

    /// `f += ` ∂W/∂q.
    pub fn add_force(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]) {
        self.add_force_at(self.angle(accepted, q), q, f);
    }

    /// As [`Self::add_force`], for a known angle θ = `angle`.
    pub fn add_force_at(&self, angle: f64, q: &[f64], f: &mut [f64]) {
        let beyond = self.beyond_in(angle, q);
        if beyond != 0.0 {
            self.direction.add_force(self.stiffness * beyond, q, f);
        }
    }

    /// As [`Self::add_force`], and `k += ` ∂²W/∂q∂q.
    pub fn add_force_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let beyond = self.beyond_in(self.angle(accepted, q), q);
        if beyond != 0.0 {
            self.direction.add_force_and_tangent(self.stiffness * beyond, q, None, f, k, workspace);
        }
    }

    /// `k += ` ∂²W/∂q∂q for a known angle θ = `angle`.
    pub fn add_tangent_at(&self, angle: f64, q: &[f64], k: &mut Matrix) {
        let beyond = self.beyond_in(angle, q);
        if beyond != 0.0 {
            let (mut idle, mut workspace) = (vec![0.0; q.len()], Workspace::default());
            let factor = self.stiffness * beyond;
            self.direction.add_force_and_tangent(factor, q, None, &mut idle, k, &mut workspace);
        }
    }

    /// `f += ` ∂²W/∂q∂q `v` for a known angle θ = `angle`.
    pub fn add_tangent_product_at(&self, angle: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.direction.add_tangent_product(self.stiffness * self.beyond_in(angle, q), q, v, f);
    }

    /// Adds to `sum` the actions on its beam, with the angle θ known from `variables`.
    pub fn add_actions(&self, variables: &InternalVariables, q: &[f64], sum: &mut Actions) {
        let angle = variables.angles.get(self.number).copied().unwrap_or(0.0);
        self.direction.add_actions(self.stiffness * self.beyond_in(angle, q), q, q, sum);
    }

    /// The angle by which the spring has turned since the last accepted state \[rad\].
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
