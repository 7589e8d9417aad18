//! Forces that depend on the path to a state ([`crate::assembly::AcceptedState`]): dry friction,
//! and torsion springs with their full turns.

use super::System;
use super::turning::{nearest, turns};
use crate::assembly::{AcceptedState, InternalVariables, Winding, Workspace};
use crate::linear::Matrix;

impl System {
    /// Whether there are such forces.
    pub fn has_history(&self) -> bool {
        !self.terms.friction.is_empty() || !self.terms.windings.is_empty()
    }

    /// Whether there are torsion springs, whose full turns count.
    pub fn has_windings(&self) -> bool {
        !self.terms.windings.is_empty()
    }

    /// `f += ` these forces in the state `q`, where `accepted` is the last accepted state.
    pub fn add_history(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]) {
        self.add_friction(accepted, q, f);
        self.terms.windings.iter().for_each(|winding| winding.add_force(accepted, q, f));
    }

    /// `f += ` only those of these forces that dissipate energy.
    pub fn add_friction(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]) {
        self.terms.friction.iter().for_each(|friction| friction.add_force(accepted, q, f));
    }

    /// `f += ` all of these forces, and `k += ` their derivative.
    pub fn add_history_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        self.terms
            .friction
            .iter()
            .for_each(|friction| friction.add_force_and_tangent(accepted, q, f, k, workspace));
        self.terms
            .windings
            .iter()
            .for_each(|winding| winding.add_force_and_tangent(accepted, q, f, k, workspace));
    }

    /// The part of the derivative by which the friction of sliding points follows the force that presses
    /// them together, in the supports' frames; `None` without friction.
    pub fn tangent_of_sliding(&self, load: f64, accepted: &AcceptedState, q: &[f64]) -> Option<Matrix> {
        if self.terms.friction.is_empty() {
            return None;
        }
        let (mut k, mut workspace) = (self.matrix(), Workspace::default());
        for friction in &self.terms.friction {
            friction.add_tangent_by_pressure(accepted, q, &mut k, &mut workspace);
        }
        self.supports.turn_matrix(load, &mut k);
        Some(k)
    }

    /// The internal variables in the state `q`, where `accepted` is the last accepted state.
    pub fn internal_variables(&self, accepted: &AcceptedState, q: &[f64]) -> InternalVariables {
        let mut variables = InternalVariables::default();
        for friction in &self.terms.friction {
            let (pieces, energy) = friction.slips(accepted, q);
            variables.friction += energy;
            variables.contacts.push(pieces);
        }
        for winding in &self.terms.windings {
            let angle = winding.angle(accepted, q);
            variables.winding += winding.energy(angle);
            variables.angles.push(angle);
        }
        variables
    }

    /// The internal variables of a state `q` to which no path is known.
    pub fn variables_without_path(&self, q: &[f64]) -> InternalVariables {
        self.with_energies(InternalVariables { angles: self.turned(q), ..InternalVariables::default() }, q)
    }

    /// The internal variables of a state `q`, with the energies that belong to their slips and angles.
    pub fn with_energies(&self, variables: InternalVariables, q: &[f64]) -> InternalVariables {
        let accepted = AcceptedState { q: q.to_vec(), variables };
        let InternalVariables { friction, winding, .. } = self.internal_variables(&accepted, q);
        InternalVariables { friction, winding, ..accepted.variables }
    }

    /// Per torsion spring, the angle by which its point has turned in the state `q` if no path tells:
    /// followed along the beam from where that has turned least from its stress-free direction \[rad\].
    pub fn turned(&self, q: &[f64]) -> Vec<f64> {
        let of = |winding: &Winding| {
            let (at, part) = (winding.at(), &self.beams[winding.at().beam]);
            winding.angle_near(turns(part, &self.reference, q)[nearest(part, at.s)], q)
        };
        self.terms.windings.iter().map(of).collect()
    }

    /// Energy of the full turns in the state `q`, where `accepted` is the last accepted state
    /// \[J\].
    pub fn winding_energy(&self, accepted: &AcceptedState, q: &[f64]) -> f64 {
        self.terms.windings.iter().map(|winding| winding.energy(winding.angle(accepted, q))).sum()
    }

    /// The largest turn of a torsion spring since the last accepted state \[rad\]. If it exceeds π,
    /// the spring is taken to have turned the other way.
    pub fn winding_turn(&self, accepted: &AcceptedState, q: &[f64]) -> f64 {
        self.terms.windings.iter().fold(0.0, |turn: f64, winding| turn.max(winding.turn(accepted, q).abs()))
    }

    /// `k += ` the tangent of windings in the state `q` with the internal variables `variables`.
    pub fn add_winding_tangent(&self, variables: &InternalVariables, q: &[f64], k: &mut Matrix) {
        for (winding, angle) in self.terms.windings.iter().zip(&variables.angles) {
            winding.add_tangent_at(*angle, q, k);
        }
    }

    /// `f += ` the tangent of windings times `v`.
    pub fn add_winding_tangent_product(
        &self,
        variables: &InternalVariables,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
    ) {
        for (winding, angle) in self.terms.windings.iter().zip(&variables.angles) {
            winding.add_tangent_product_at(*angle, q, v, f);
        }
    }

    /// `f += ` the forces in the state `q` with the internal variables `variables`.
    pub fn add_known_history(&self, variables: &InternalVariables, q: &[f64], f: &mut [f64]) {
        self.terms.friction.iter().for_each(|friction| friction.add_force_of(variables, q, f));
        for (winding, angle) in self.terms.windings.iter().zip(&variables.angles) {
            winding.add_force_at(*angle, q, f);
        }
    }
}
