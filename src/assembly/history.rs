//! Forces with memory: those of dry friction and of torsion springs that turn repeatedly depend on
//! the path to a state, not on the state alone.
//!
//! Such forces are functions of the current state and of the last accepted one ([`AcceptedState`]),
//! whose internal variables are known; when a state is accepted, its own internal variables are
//! stored. Every force thus has one value in every state of a step, and a repeated step starts from
//! the same variables.

use serde::{Deserialize, Serialize};

/// The internal variables of a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InternalVariables {
    /// Energy of the tangential springs of friction \[J\].
    pub friction: f64,
    /// Per contact with friction: the pieces that touch, in order.
    pub contacts: Vec<Vec<ContactPiece>>,
    /// Energy of torsion springs beyond that of an angle between −π and π \[J\].
    pub winding: f64,
    /// Per torsion spring: its angle with all full turns \[rad\]; empty while all springs are
    /// stress-free.
    pub angles: Vec<f64>,
}

impl InternalVariables {
    /// Energy that cannot be computed from the coordinates alone \[J\].
    pub fn energy(&self) -> f64 {
        self.friction + self.winding
    }
}

/// The last accepted state, from which changes of the internal variables are counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AcceptedState {
    /// Its coordinates.
    pub q: Vec<f64>,
    /// Its variables.
    pub variables: InternalVariables,
}

/// A piece of a cell that touches an obstacle, with the elastic slips at the points of its rule.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactPiece {
    /// Number of the cell.
    pub cell: usize,
    /// Start of the piece on the cell, from 0 to 1.
    pub from: f64,
    /// End of the piece.
    pub to: f64,
    /// The slip at each point \[m\].
    pub slip: Vec<f64>,
}
