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

/// What has added a term: a beam by its section, a part of the model, or one that has gone and fades; by
/// their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Owner {
    /// A beam.
    Beam(usize),
    /// A part.
    Part(usize),
    /// A part that has gone.
    Gone(usize),
}

/// Per term of the lists of [`Terms`], what has added it.
#[derive(Default)]
pub struct Owners {
    /// Of [`Terms::internal`].
    pub internal: Vec<Owner>,
    /// Of [`Terms::loads`].
    pub loads: Vec<Owner>,
    /// Of [`Terms::inertia`].
    pub inertia: Vec<Owner>,
    /// Of [`Terms::turning`].
    pub turning: Vec<Owner>,
    /// Of [`Terms::damping`].
    pub damping: Vec<Owner>,
    /// Of [`Terms::timed_loads`].
    pub timed_loads: Vec<Owner>,
    /// Of [`Terms::friction`].
    pub friction: Vec<Owner>,
    /// Of [`Terms::windings`].
    pub windings: Vec<Owner>,
    /// Of [`Terms::held`].
    pub held: Vec<Owner>,
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
    /// What has added them.
    pub owners: Owners,
}

impl Terms {
    /// Notes `owner` as that of all terms of which none is noted yet.
    pub fn belong_to(&mut self, owner: Owner) {
        let owners = &mut self.owners;
        for (of, count) in [
            (&mut owners.internal, self.internal.len()),
            (&mut owners.loads, self.loads.len()),
            (&mut owners.inertia, self.inertia.len()),
            (&mut owners.turning, self.turning.len()),
            (&mut owners.damping, self.damping.len()),
            (&mut owners.timed_loads, self.timed_loads.len()),
            (&mut owners.friction, self.friction.len()),
            (&mut owners.windings, self.windings.len()),
            (&mut owners.held, self.held.len()),
        ] {
            of.resize(count, owner);
        }
    }
}
