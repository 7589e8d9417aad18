//! What forces remember: those of dry friction and of springs that are wound up depend on the way
//! to a state, not on the state alone.
//!
//! They are functions of the state and of the last accepted one ([`AcceptedState`]), in which their
//! internal variables are known; an accepted state gets its own. So every force has one value in
//! every state of a step, and a step that is taken again starts from the same variables.

use serde::{Deserialize, Serialize};

/// The internal variables of a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InternalVariables {
    /// Energy of the tangential springs of friction \[J\].
    pub friction: f64,
    /// Per contact with friction its pieces, in order.
    pub contacts: Vec<Vec<ContactPiece>>,
    /// Energy of torsion springs beyond that of an angle from −π to π \[J\].
    pub winding: f64,
    /// Per torsion spring its angle with all turns \[rad\]; none stands for stress-free springs.
    pub angles: Vec<f64>,
}

impl InternalVariables {
    /// Energy that no function of the coordinates counts \[J\].
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

/// A piece of a cell that touches, with the elastic slip at the points of its rule.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactPiece {
    /// Number of the cell.
    pub cell: usize,
    /// Where it begins on the cell, from 0 to 1.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// The slip at each point \[m\].
    pub slip: Vec<f64>,
}
