//! The contacts of a system: whether they touch, their forces, and obstacles met between two
//! states.

use super::System;
use crate::assembly::AcceptedState;

/// Distances of this part of a beam's length are round-off of positions.
const ALONG: f64 = 1e-13;

impl System {
    /// Whether there are any contacts.
    pub fn has_contacts(&self) -> bool {
        !self.terms.contacts.is_empty()
    }

    /// Number of contacts.
    pub fn contacts(&self) -> usize {
        self.terms.contacts.len()
    }

    /// Per contact: the number of separate intervals of the beam that touch in the state `q`.
    pub fn intervals<'q>(&'q self, q: &'q [f64]) -> impl Iterator<Item = usize> + 'q {
        self.terms.contacts.iter().map(|contact| contact.intervals(q))
    }

    /// Whether contact number `contact` touches in the state `q`.
    pub fn touches(&self, contact: usize, q: &[f64]) -> bool {
        self.terms.contacts.get(contact).is_some_and(|contact| contact.touches(q))
    }

    /// The first contact whose beam lies along its obstacle in the state `q`, as far as positions tell, and whose stiffness acts there or
    /// does not by chance.
    pub fn lies_along(&self, q: &[f64]) -> Option<usize> {
        let near = ALONG * self.length();
        self.terms.contacts.iter().position(|contact| contact.lies_along(q, near))
    }

    /// The resultant \[N\] of contact number `contact` on its beam in the state `q`, without
    /// friction; `None` where it does not touch.
    pub fn contact_force(&self, contact: usize, q: &[f64]) -> Option<[f64; 2]> {
        self.terms.contacts.get(contact).and_then(|contact| contact.resultant(q))
    }

    /// Whether the path `way` leads deep into the obstacle of contact number `contact`: without
    /// that it neither conflicts with it nor crosses it.
    pub fn is_deep(&self, contact: usize, way: [&[f64]; 4]) -> bool {
        self.terms.contacts.get(contact).is_some_and(|contact| contact.is_deep(way))
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
        let deep = (0..self.contacts()).filter(|contact| self.is_deep(*contact, way));
        self.conflict_of(deep, way, may_cross)
    }

    /// [`Self::conflict`] with one of the `contacts`, for which the path is deep.
    pub fn conflict_of(
        &self,
        contacts: impl Iterator<Item = usize>,
        way: [&[f64]; 4],
        may_cross: bool,
    ) -> Option<(f64, usize)> {
        let contacts = contacts.filter_map(|i| Some((i, self.terms.contacts.get(i)?)));
        let met = contacts.filter_map(|(i, contact)| contact.conflict(way, may_cross).map(|part| (part, i)));
        met.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether contact number `contact` is crossed on the deep path `way`.
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
