//! Contacts of a motion: when they begin and end, what they did, and steps that end where they do.
//!
//! Where a contact begins or ends the force has a kink. A step across it has an error of low order, which estimates that presume a smooth motion do not
//! see: with Gauss' method and a tolerance of 1e-8 a rod that falls flat left the ground at a height wrong by 1e-3. So a step that is to meet an
//! accuracy ends at the kink: the place is found by the interpolated motion of the step, which is tried again until it hits. The rod then
//! errs by 1e-10.

use super::State;
use super::integrate::Driver;
use crate::trajectory::Blow;

/// Parts of a step after which contacts are looked at.
const PARTS: u32 = 4;
/// Part of a step by which its end may miss the kink.
const NEAR: f64 = 1e-6;
/// The rule of Gauss with three points on (0, 1).
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// A contact as it is after the last step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Touch {
    touches: bool,
    /// Since it began.
    blow: Blow,
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
    pub blow: Option<Blow>,
}

impl Touch {
    /// A contact that touches already, or not.
    pub(super) fn new(touches: bool) -> Self {
        Self { touches, blow: Blow::default() }
    }
}

impl Driver<'_, '_> {
    /// A time well within the step to `new` at which a contact first begins or ends.
    pub(super) fn kink_within(&self, new: &State) -> Option<f64> {
        if self.touching.is_empty() {
            return None;
        }
        let near = NEAR * (new.time - self.state.time);
        // The step may have been made to begin where a contact does.
        let begun = self.state.between(new, self.state.time + near, None);
        let begun: Vec<bool> = self.system.touching(&begun.q).collect();
        let first = self.first_change(new, |q| self.system.touching(q).ne(begun.iter().copied()))?;
        (first < new.time - near).then_some(first)
    }

    /// When coordinates first are `changed` in the step to `new`: bisection of the interpolated motion.
    fn first_change(&self, new: &State, changed: impl Fn(&[f64]) -> bool) -> Option<f64> {
        let (start, h) = (self.state.time, new.time - self.state.time);
        let changed = |part: f64| changed(&self.state.between(new, start + part * h, None).q);
        let step = 1.0 / f64::from(PARTS);
        let mut after = (1..=PARTS).map(|k| f64::from(k) * step).find(|part| changed(*part))?;
        let mut before = after - step;
        for _ in 0..40 {
            let middle = 0.5 * (before + after);
            if changed(middle) {
                after = middle;
            } else {
                before = middle;
            }
        }
        Some(start + after * h)
    }

    /// Sums up what contacts do in the step to `new`, and records those that begin or end in it.
    pub(super) fn notice_contacts(&mut self, new: &State) {
        let now: Vec<bool> = self.system.touching(&new.q).collect();
        let mut scratch = Vec::new();
        for (contact, touches) in now.into_iter().enumerate() {
            let Touch { touches: touched, mut blow } = self.touching[contact];
            let time = (touches != touched).then(|| {
                self.first_change(new, |q| self.system.touches(contact, q) == touches).unwrap_or(new.time)
            });
            if touched || touches {
                let (begin, end) = match time {
                    Some(time) if touches => (time, new.time),
                    Some(time) => (self.state.time, time),
                    None => (self.state.time, new.time),
                };
                scratch.resize(new.q.len(), 0.0);
                for (at, weight) in GAUSS {
                    let state = self.state.between(new, begin + at * (end - begin), None);
                    let force = self.system.contact_force(contact, &state.q, &mut scratch);
                    let weight = weight * (end - begin);
                    blow.impulse[0] += weight * force[0];
                    blow.impulse[1] += weight * force[1];
                    blow.largest_force = blow.largest_force.max(force[0].hypot(force[1]));
                }
            }
            if let Some(time) = time {
                let ended = (!touches).then_some(blow);
                self.solution.contacts.push(Change { contact, touches, time, blow: ended });
                blow = if touches { blow } else { Blow::default() };
            }
            self.touching[contact] = Touch { touches, blow };
        }
    }
}
