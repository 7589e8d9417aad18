//! The contacts of a system: whether they touch, their forces, and obstacles met between two
//! states.

use super::System;
use super::sums::resultant;
use crate::assembly::{AcceptedState, Effect};

impl System {
    /// Whether there are any contacts.
    pub fn has_contacts(&self) -> bool {
        !self.terms.contacts.is_empty()
    }

    /// Per contact: the number of separate intervals of the beam that touch in the state `q`.
    pub fn intervals<'q>(&'q self, q: &'q [f64]) -> impl Iterator<Item = usize> + 'q {
        self.terms.contacts.iter().map(|contact| contact.intervals(q))
    }

    /// Whether contact number `contact` touches in the state `q`.
    pub fn touches(&self, contact: usize, q: &[f64]) -> bool {
        self.terms.contacts.get(contact).is_some_and(|contact| contact.touches(q))
    }

    /// The resultant \[N\] of contact number `contact` on its beam in the state `q`, without
    /// friction; `scratch` is overwritten.
    pub fn contact_force(&self, contact: usize, q: &[f64], scratch: &mut [f64]) -> [f64; 2] {
        scratch.fill(0.0);
        if let Some(contact) = self.terms.contacts.get(contact) {
            contact.add_force(1.0, q, scratch);
        }
        resultant(scratch)
    }

    /// Names of the contacts: the beam's name and the number of the contact, such as `arm.1`.
    pub fn contact_names(&self) -> impl Iterator<Item = String> + '_ {
        let names = self.terms.contacts.iter().enumerate();
        names.map(|(i, contact)| format!("{}.{}", self.beams[contact.beam()].name, i + 1))
    }

    /// The first conflict with an obstacle on the cubic path with the control states `way`, if
    /// there is one: the θ of the path at which it occurs, and the index of the contact. With
    /// `may_cross`, crossing an obstacle is allowed, and only penetrating it so fast that a step
    /// would miss the force is a conflict; see [`crate::assembly::ContactEffect::conflict`].
    pub fn conflict(&self, way: [&[f64]; 4], may_cross: bool) -> Option<(f64, usize)> {
        let contacts = self.terms.contacts.iter().enumerate();
        let met = contacts.filter_map(|(i, contact)| contact.conflict(way, may_cross).map(|part| (part, i)));
        met.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether contact number `contact` is crossed on the path `way`.
    pub fn crosses(&self, contact: usize, way: [&[f64]; 4]) -> bool {
        self.terms.contacts.get(contact).is_some_and(|contact| contact.crosses(way))
    }

    /// The θ of the path `way` at which contact number `contact`, which does not touch at the
    /// start, begins to touch, if it does.
    pub fn first_touch(&self, contact: usize, way: [&[f64]; 4]) -> Option<f64> {
        self.terms.contacts.get(contact).and_then(|contact| contact.first_touch(way))
    }

    /// Whether any contact has friction.
    pub fn has_friction(&self) -> bool {
        !self.terms.friction.is_empty()
    }

    /// Per contact with friction: whether the greater part of it slides, and if so, whether against
    /// the friction ([`crate::assembly::FrictionEffect::sliding`]).
    pub fn sliding(&self, accepted: &AcceptedState, q: &[f64], v: &[f64]) -> Vec<Option<bool>> {
        self.terms.friction.iter().map(|friction| friction.sliding(accepted, q, v)).collect()
    }
}
