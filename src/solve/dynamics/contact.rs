//! What a motion remembers of its contacts.

use crate::solve::ContactImpulse;

/// A contact as it is after the last step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactState {
    /// Whether it touches.
    pub touches: bool,
    /// Since it began.
    pub impulse: ContactImpulse,
    /// Whether it has given way once.
    pub crossed: bool,
}

/// A contact begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Number of the contact.
    pub contact: usize,
    /// Whether it touches from then on.
    pub touches: bool,
    /// When \[s\].
    pub time: f64,
    /// What it did since it began, or since the motion was taken up; where it ends.
    pub impulse: Option<ContactImpulse>,
}

impl ContactState {
    /// A contact that touches already, or not.
    pub(super) fn new(touches: bool) -> Self {
        Self { touches, ..Self::default() }
    }
}
