//! The terms of the equations of a system.

use super::{
    ActingLoad, ContactEffect, Damping, Effect, FrictionEffect, HeldLength, Kind, TimedLoad, Winding,
};
use std::sync::Arc;

/// The kinds of terms that an analysis needs; no others are built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Whether inertia terms are needed.
    pub inertia: bool,
    /// Whether loads and supports follow time, and damping is included; otherwise loads and
    /// prescribed displacements follow the load factor.
    pub motion: bool,
}

/// An inertia whose mass matrix depends on the state.
pub struct Turning {
    /// Its momentum as a function of state and velocity. Evaluated with the acceleration instead of
    /// the velocity, it is the force of inertia without the terms quadratic in velocities.
    pub momentum: Box<dyn Damping>,
    /// The terms of the force of inertia that are quadratic in velocities.
    pub rate: Box<dyn Damping>,
}

/// The terms that the parts of a model have added to its equations.
#[derive(Default)]
pub struct Terms {
    /// Effects with an energy.
    pub internal: Vec<Box<dyn Effect>>,
    /// Loads.
    pub loads: Vec<ActingLoad>,
    /// Inertia with a constant mass matrix.
    pub inertia: Vec<Box<dyn Effect>>,
    /// Inertia whose mass matrix depends on the state.
    pub turning: Vec<Turning>,
    /// Dissipation functions.
    pub damping: Vec<Box<dyn Damping>>,
    /// Loads that depend on time by more than a factor.
    pub timed_loads: Vec<Box<dyn TimedLoad>>,
    /// The contacts; each is also one of the `internal` effects.
    pub contacts: Vec<Arc<dyn ContactEffect>>,
    /// Friction in contacts.
    pub friction: Vec<Box<dyn FrictionEffect>>,
    /// Full turns of torsion springs.
    pub windings: Vec<Winding>,
    /// Lengths that are kept.
    pub held: Vec<HeldLength>,
    /// Effects that the analysis leaves out, each with the index of its beam.
    pub left_out: Vec<(Kind, usize)>,
}
