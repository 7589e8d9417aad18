//! The terms of the equations of a system.

use super::{ActingLoad, ContactEffect, Damping, Effect, FrictionEffect, Kind, MovingLoad, Winding};
use std::sync::Arc;

/// What an analysis asks of the system; nothing else is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Whether inertia takes part.
    pub inertia: bool,
    /// Whether loads and supports follow time, and damping takes part; otherwise loads and
    /// prescribed displacements follow the load factor.
    pub motion: bool,
}

/// An inertia whose matrix follows the state.
pub struct Turning {
    /// Its momentum as a function of state and velocity; and so its force as a function of state
    /// and acceleration, but for what velocities add.
    pub momentum: Box<dyn Damping>,
    /// What velocities add.
    pub rate: Box<dyn Damping>,
}

/// What the parts of a model have added to its equations.
#[derive(Default)]
pub struct Terms {
    /// What has an energy.
    pub internal: Vec<Box<dyn Effect>>,
    /// What acts.
    pub loads: Vec<ActingLoad>,
    /// Inertia with a constant matrix.
    pub inertia: Vec<Box<dyn Effect>>,
    /// Inertia with a matrix that follows the state.
    pub turning: Vec<Turning>,
    /// Dissipation functions.
    pub damping: Vec<Box<dyn Damping>>,
    /// Loads whose place moves.
    pub moving_loads: Vec<Box<dyn MovingLoad>>,
    /// The contacts, which are among the internal effects.
    pub contacts: Vec<Arc<dyn ContactEffect>>,
    /// Friction in contacts.
    pub friction: Vec<Box<dyn FrictionEffect>>,
    /// Turns of torsion springs.
    pub windings: Vec<Winding>,
    /// What the analysis leaves out, and on which beam.
    pub left_out: Vec<(Kind, usize)>,
}
