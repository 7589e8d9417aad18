//! What a system asks of contacts and their friction, beside forces.

use super::{AcceptedState, Actions, ContactPiece, Effect, InternalVariables, Workspace};
use crate::linear::Matrix;

/// Control states of a cubic: θ = 0, two between, θ = 1.
pub type CubicStates<'q> = [&'q [f64]; 4];

/// A contact of one beam with one obstacle.
pub trait ContactEffect: Effect {
    /// Number of separate intervals of the beam that touch in the state `q`.
    fn intervals(&self, q: &[f64]) -> usize;

    /// The first part of the way at which the beam touches by more than round-off, if it does.
    fn first_touch(&self, way: CubicStates<'_>) -> Option<f64>;

    /// The first part of the way at which the beam is deeper than before by so much of the
    /// obstacle's thickness that the force on the way is not seen; and, unless it `may_cross`, at
    /// which it might leave the obstacle on the other side.
    fn conflict(&self, way: CubicStates<'_>, may_cross: bool) -> Option<f64>;

    /// Whether the beam might leave the obstacle on the other side.
    fn crosses(&self, way: CubicStates<'_>) -> bool;

    /// Whether anything touches in the state `q`.
    fn touches(&self, q: &[f64]) -> bool {
        self.intervals(q) > 0
    }
}

/// Dry friction of a contact. Its forces depend on the last accepted state too.
pub trait FrictionEffect: Send + Sync {
    /// Index of the beam.
    fn beam(&self) -> usize;

    /// Points, and bytes of its tables.
    fn size(&self) -> (usize, usize);

    /// `f += ` the forces ∂U/∂q in the state `q`, where `held` was the last.
    fn add_force(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]);

    /// The same, and `k += ` its derivative.
    fn add_force_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    );

    /// The pieces that touch in the state `q` with their elastic slips, and the energy of these
    /// \[J\].
    fn slips(&self, accepted: &AcceptedState, q: &[f64]) -> (Vec<ContactPiece>, f64);

    /// `f += ` the forces of slips that are known in the state `q`.
    fn add_force_of(&self, variables: &InternalVariables, q: &[f64], f: &mut [f64]);

    /// What these do to their beam in the state `q`.
    fn add_actions_of(&self, variables: &InternalVariables, q: &[f64], sum: &mut Actions);

    /// Whether points slide that can bear more than half of what all can, and then whether against
    /// friction; `v` are the velocities.
    fn sliding(&self, accepted: &AcceptedState, q: &[f64], v: &[f64]) -> Option<bool>;
}
