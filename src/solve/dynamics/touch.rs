//! Contacts of a motion: when they begin and end, their impulses, and steps that end where they
//! change.
//!
//! Where a contact begins or ends the force has a kink. A step across it has an error of low order,
//! which estimates that presume a smooth motion do not see: a rod that falls flat left the ground
//! at a height wrong by 1e-3 with a tolerance of 1e-8. So a step with a tolerance ends at the kink.
//! Its time is found from the interpolated motion of the step, and the step is repeated until it
//! ends there.
//!
//! No obstacle is stepped over. The interpolated path of every step is swept
//! ([`crate::effect::ContactIntegral`]). A step that carries the beam deeper into a thin obstacle
//! than a part of its thickness is rejected, so that the contact force acts before the beam is
//! through. A step of fixed length that touches an obstacle and leaves it again, without an effect
//! on its equations, is divided.

use super::State;
use super::contact::{Change, ContactState};
use super::integrate::{Driver, SMALLEST_PART};
use crate::model::StepControl;
use crate::numeric::GAUSS_3;
use crate::solve::ContactImpulse;
use crate::solve::newton::Failure;

/// Number of parts of a step at whose ends contacts are checked.
const PARTS: u32 = 4;
/// Part of a step by which its end may miss the kink.
const NEAR: f64 = 1e-6;
/// Part of a step after which it is first checked whether a contact slides.
const BEGUN: f64 = 1e-2;

/// Places in a step and weights of Simpson's rule.
const SIMPSON: [(f64, f64); 3] = [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)];

/// The largest value of three or more points (place, value): that of the parabola through the largest of them and its two neighbours, or
/// through the last three points at an end, where its vertex lies between these.
fn peak(points: &[(f64, f64)]) -> f64 {
    let largest = points.iter().enumerate().max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
    let Some((index, &(_, size))) = largest else { return 0.0 };
    let first = index.clamp(1, points.len().max(3) - 2) - 1;
    let Some([(a, fa), (b, fb), (c, fc)]) = points.get(first..).and_then(<[_]>::first_chunk::<3>) else {
        return size;
    };
    let [left, right] = [(fb - fa) / (b - a), (fc - fb) / (c - b)];
    let bend = (right - left) / (c - a);
    // The slope in the middle of the first two points is `left`.
    let vertex = 0.5 * (a + b) - 0.5 * left / bend;
    if bend < 0.0 && vertex > *a && vertex < *c {
        size.max(fa + (vertex - a) * (left + bend * (vertex - b)))
    } else {
        size
    }
}

impl Driver<'_, '_> {
    /// Refuses a step to `new` that leads through an obstacle, and one of fixed length whose
    /// equations would not see that it touches one.
    pub(super) fn not_crossed(&mut self, new: &State) -> Result<(), Failure> {
        if self.touching.is_empty() {
            return Ok(());
        }
        let [first, second] = self.state.controls(new);
        let way = [&self.state.q[..], &first, &second, &new.q];
        for (contact, state) in self.touching.iter_mut().enumerate() {
            state.deep = self.system.is_deep(contact, way);
        }
        let deep = (0..self.touching.len()).filter(|contact| self.touching[*contact].deep);
        if let Some((part, contact)) = self.system.conflict_of(deep, way, true) {
            return Err(Failure::Crossed { contact, part });
        }
        let StepControl::Fixed(step) = self.control else { return Ok(()) };
        let divisible = new.time - self.state.time > 2.0 * SMALLEST_PART * step;
        let unseen = |contact: &usize| {
            !self.touching[*contact].touches
                && self.system.first_touch(*contact, way).is_some()
                && !self.system.touches(*contact, &new.q)
        };
        match (0..self.touching.len()).find(|contact| divisible && unseen(contact)) {
            Some(contact) => Err(Failure::Unseen { contact }),
            None => Ok(()),
        }
    }

    /// The first time well within the step to `new` at which an interval of a contact begins or
    /// ends, or a contact begins to slide, sticks, or turns.
    pub(super) fn kink_within(&self, new: &State) -> Option<f64> {
        if self.touching.is_empty() {
            return None;
        }
        let near = NEAR * (new.time - self.state.time);
        // The step itself may begin where a contact begins.
        let after = self.state.between(new, self.state.time + near, None);
        let begun: Vec<usize> = self.system.intervals(&after.q).collect();
        let change =
            self.first_change(new, 1.0, |state| self.system.intervals(&state.q).ne(begun.iter().copied()));
        let slide = self.slide_within(new);
        let turn = self.turn_within(new, &after);
        let [first, second] = after.controls(new);
        let way = [&after.q[..], &first, &second, &new.q];
        let free = (0..begun.len()).filter(|contact| begun[*contact] == 0);
        let met = free.filter_map(|contact| {
            let part = NEAR + (1.0 - NEAR) * self.system.first_touch(contact, way)?;
            self.first_change(new, part, |state| self.system.touches(contact, &state.q))
        });
        let first = met.chain(change).chain(slide).chain(turn).fold(f64::INFINITY, f64::min);
        (self.state.time + near..new.time - near).contains(&first).then_some(first)
    }

    /// A time in the step to `new` at which the force of a contact reverses, as where the beam is
    /// pushed through an obstacle; `after` is the state just after the start of the step.
    fn turn_within(&self, new: &State, after: &State) -> Option<f64> {
        let forces = |state: &State| -> Vec<[f64; 2]> {
            let touching = (0..self.touching.len()).filter(|contact| self.touching[*contact].touches);
            touching.map(|contact| self.system.contact_force(contact, &state.q).unwrap_or_default()).collect()
        };
        let begun = forces(after);
        self.first_change(new, 1.0, |state| {
            forces(state).iter().zip(&begun).any(|(now, begun)| now[0] * begun[0] + now[1] * begun[1] < 0.0)
        })
    }

    /// A time in the step to `new` at which a contact begins to slide, sticks, or turns back.
    fn slide_within(&self, new: &State) -> Option<f64> {
        if !self.system.has_friction() {
            return None;
        }
        let sliding = |state: &State| self.system.sliding(&self.accepted, &state.q, &state.v);
        let begun =
            sliding(&self.state.between(new, self.state.time + BEGUN * (new.time - self.state.time), None));
        self.first_change(new, 1.0, |state| sliding(state) != begun)
    }

    /// The time at which `changed` first becomes true in the first `part` of the step to `new`, by
    /// bisection of the interpolated motion.
    fn first_change(&self, new: &State, part: f64, mut changed: impl FnMut(&State) -> bool) -> Option<f64> {
        let (start, h) = (self.state.time, new.time - self.state.time);
        let mut changed = |part: f64| changed(&self.state.between(new, start + part * h, None));
        let step = part / f64::from(PARTS);
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

    /// Adds up the impulses of contacts in the step to `new`, and records those that begin or end
    /// in it. Within a step of second order Simpson's rule is enough for an impulse, and the force
    /// at its start is known; others are summed at three Gauss points. The largest force is that of parabolas through these points and the
    /// ends of the step.
    pub(super) fn notice_contacts(&mut self, new: &State) {
        for contact in 0..self.touching.len() {
            let ContactState { touches: touched, mut impulse, force: before, mut crossed, deep } =
                self.touching[contact];
            let after = self.system.contact_force(contact, &new.q);
            let (touches, force) = (after.is_some(), after.unwrap_or_default());
            if (touched || touches) && !crossed && deep {
                let [first, second] = self.state.controls(new);
                crossed = self.system.crosses(contact, [&self.state.q, &first, &second, &new.q]);
                if crossed {
                    self.solution.crossings.push((contact, new.time));
                }
            }
            let time = (touches != touched).then(|| {
                self.first_change(new, 1.0, |state| self.system.touches(contact, &state.q) == touches)
                    .unwrap_or(new.time)
            });
            // What acts before a motion goes on where another one has ended belongs to that one.
            if (touched || touches) && new.time > self.first.time {
                let (begin, end) = match time {
                    Some(time) if touches => (time, new.time),
                    Some(time) => (self.state.time, time),
                    None => (self.state.time, new.time),
                };
                let taken_up = begin < self.first.time;
                let (begin, end) = (begin.max(self.first.time), end.max(self.first.time));
                let force_at = |at: f64| match at {
                    0.0 if !taken_up => before,
                    1.0 => force,
                    _ => {
                        let state = self.state.between(new, begin + at * (end - begin), None);
                        self.system.contact_force(contact, &state.q).unwrap_or_default()
                    }
                };
                let [first, second, third] = GAUSS_3;
                let gauss = [(0.0, 0.0), first, second, third, (1.0, 0.0)];
                let points = if self.method.order() <= 2.0 { &SIMPSON[..] } else { &gauss[..] };
                let mut sizes = Vec::with_capacity(points.len());
                for (at, weight) in points {
                    let ([x, y], weight) = (force_at(*at), weight * (end - begin));
                    impulse.impulse[0] += weight * x;
                    impulse.impulse[1] += weight * y;
                    sizes.push((*at, x.hypot(y)));
                }
                impulse.largest_force = impulse.largest_force.max(peak(&sizes));
            }
            if let Some(time) = time {
                let ended = (!touches).then_some(impulse);
                self.solution.contacts.push(Change { contact, touches, time, impulse: ended });
                impulse = if touches { impulse } else { ContactImpulse::default() };
            }
            self.touching[contact] = ContactState { touches, impulse, force, crossed, deep };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::peak;

    /// 4 − (x − p)² at five places of a step, with its vertex within, at, or beyond these.
    #[test]
    fn the_largest_force_is_that_of_a_parabola() {
        let places = [0.0, 0.125, 0.5, 0.875, 1.0];
        let largest = |vertex: f64| peak(&places.map(|x| (x, 4.0 - (x - vertex) * (x - vertex))));
        for vertex in [0.03, 0.2, 0.5, 0.6, 0.97] {
            assert!((largest(vertex) - 4.0).abs() < 1e-14, "{vertex}: {}", largest(vertex));
        }
        assert_eq!([largest(-1.0), largest(2.0)], [3.0; 2], "what is beyond belongs to another step");
        assert_eq!(peak(&places.map(|x| (x, x * x))), 1.0, "and no lowest value is largest");
        assert_eq!(peak(&places.map(|x| (x, 2.0))), 2.0);
    }
}
