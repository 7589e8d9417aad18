//! The interfaces through which a system uses contacts and their friction, besides forces.

use super::{AcceptedState, Actions, ContactPiece, Effect, InternalVariables, Workspace};
use crate::linear::Matrix;

/// A path from one state to another as a cubic of θ ∈ [0, 1]: its four control states, of which the
/// first is the state at θ = 0 and the last that at θ = 1.
pub type CubicStates<'q> = [&'q [f64]; 4];

/// A contact of one beam with one obstacle.
pub trait ContactEffect: Effect {
    /// Number of separate intervals of the beam that touch in the state `q`.
    fn intervals(&self, q: &[f64]) -> usize;

    /// The resultant \[N\] of its forces on the beam in the state `q`; `None` where nothing touches.
    fn resultant(&self, q: &[f64]) -> Option<[f64; 2]>;

    /// The first θ on the path `way` at which the beam touches by more than a negligible depth, if
    /// it does.
    fn first_touch(&self, way: CubicStates<'_>) -> Option<f64>;

    /// Whether the path `way` leads so deep that it may be in [`Self::conflict`] with the obstacle,
    /// or cross it. Most paths do not, and this is the cheapest test.
    fn is_deep(&self, way: CubicStates<'_>) -> bool;

    /// The first θ on a deep path `way` that conflicts with the obstacle, if there is one: where
    /// the beam is deeper than at the start by so large a fraction of the obstacle's thickness that
    /// a step would miss the contact force on the way; and, unless it `may_cross`, where it might
    /// leave the obstacle on the other side.
    fn conflict(&self, way: CubicStates<'_>, may_cross: bool) -> Option<f64>;

    /// Whether the beam might leave the obstacle on the other side on a deep path `way`.
    fn crosses(&self, way: CubicStates<'_>) -> bool;

    /// Whether a stretch of the beam lies along the border of the obstacle, nearer to it than `near` \[m\], in the state `q`: at the kink of
    /// its force.
    fn lies_along(&self, q: &[f64], near: f64) -> bool;

    /// Whether anything touches in the state `q`.
    fn touches(&self, q: &[f64]) -> bool {
        self.intervals(q) > 0
    }
}

/// Dry friction of a contact. Its forces depend on the state and on the last accepted state.
pub trait FrictionEffect: Send + Sync {
    /// Index of the beam.
    fn beam(&self) -> usize;

    /// Number of points, and bytes of its tables.
    fn size(&self) -> (usize, usize);

    /// `f += ` the forces in the state `q`, where `accepted` is the last accepted state.
    fn add_force(&self, accepted: &AcceptedState, q: &[f64], f: &mut [f64]);

    /// As [`Self::add_force`], and `k += ` the derivative of the forces.
    fn add_force_and_tangent(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    );

    /// `k += ` the part of the derivative by which the forces of sliding points follow the pressure.
    fn add_tangent_by_pressure(
        &self,
        accepted: &AcceptedState,
        q: &[f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    );

    /// The pieces that touch in the state `q` with their elastic slips, and the energy of these
    /// slips \[J\].
    fn slips(&self, accepted: &AcceptedState, q: &[f64]) -> (Vec<ContactPiece>, f64);

    /// `f += ` the forces in the state `q` of the elastic slips known from `variables`.
    fn add_force_of(&self, variables: &InternalVariables, q: &[f64], f: &mut [f64]);

    /// Adds to `sum` the actions of these forces on their beam in the state `q`.
    fn add_actions_of(&self, variables: &InternalVariables, q: &[f64], sum: &mut Actions);

    /// `None` unless sliding points carry more than half of the largest friction that all touching
    /// points can carry; otherwise whether the velocities `v` of the sliding points are directed
    /// against their friction.
    fn sliding(&self, accepted: &AcceptedState, q: &[f64], v: &[f64]) -> Option<bool>;
}
