//! The state of the contacts of a motion.

use crate::solve::ContactImpulse;

/// A contact as it is after the last step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactState {
    /// Whether it touches.
    pub touches: bool,
    /// Its impulse since it began.
    pub impulse: ContactImpulse,
    /// Its force on the beam \[N\].
    pub force: [f64; 2],
    /// Whether the beam has been pushed past the middle of the obstacle.
    pub crossed: bool,
    /// Whether the step that is tried leads deep into the obstacle.
    pub deep: bool,
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
    /// Its impulse since it began, or since the motion was taken up; only where it ends.
    pub impulse: Option<ContactImpulse>,
}

impl ContactState {
    /// A contact at the start of a motion, which has a force if it touches already.
    pub(super) fn new(force: Option<[f64; 2]>) -> Self {
        Self { touches: force.is_some(), force: force.unwrap_or_default(), ..Self::default() }
    }
}
