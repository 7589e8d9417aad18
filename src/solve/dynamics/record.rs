//! Records of a motion at the requested times.

use super::integrate::{Driver, SLACK, turned, worst};
use super::{NoStep, State};
use crate::solve::newton::Failure;

impl Driver<'_, '_> {
    /// Records states and events of the step from the last state to `new`, which an event may cut
    /// short; returns whether the motion ends.
    pub(super) fn look(&mut self, new: &mut State) -> bool {
        let slack = SLACK * (new.time - self.state.time);
        let due = self.next_record as f64 * self.task.output_every < new.time - slack;
        let between = due || self.has_work() || !self.task.watches.is_empty();
        let accelerations = if between { self.method.end_accelerations(&self.state, new) } else { None };
        let pair = accelerations.as_ref().map(|[a, b]| [&a[..], &b[..]]);
        (new.work, new.lost) = self.work(new, new.time, pair);
        new.angles.clone_from(&self.state.angles);
        new.angles = turned(self.task.directions, new);
        self.settle(new);
        let stop = self.note_events(new, pair);
        self.record_until(new, stop.as_ref().unwrap_or(new), pair);
        let stops = stop.is_some();
        if let Some(state) = stop {
            self.solution.end = self.balance_within(new, &state);
            *new = state;
        }
        if !self.touching.is_empty() {
            self.notice_contacts(new);
        }
        stops
    }

    /// Records the step to `new` as far as `end`.
    fn record_until(&mut self, new: &State, end: &State, accelerations: Option<[&[f64]; 2]>) {
        let slack = SLACK * (end.time - self.state.time);
        loop {
            let time = self.next_record as f64 * self.task.output_every;
            if time > end.time + slack || time > self.task.duration + slack {
                return;
            }
            let at_end = (time - end.time).abs() <= slack;
            let state =
                if at_end { State { time, ..end.clone() } } else { self.between(new, time, accelerations) };
            let balance = if self.settles() {
                // A step ends just before a kink, and the laws of supports are not looked at beyond.
                let before = State { time: state.time.min(end.time), ..state.clone() };
                self.balance_within(new, &before)
            } else {
                None
            };
            let settled = balance.as_ref().filter(|_| !at_end).map(|balance| balance.state.clone());
            if !self.keep(settled.unwrap_or(state)) {
                return;
            }
            if self.task.forces {
                let tendency = self.tendency_within(new, time);
                self.keep_forces(balance.as_ref(), tendency);
            }
            if self.task.reactions {
                self.keep_reactions(balance);
            }
            self.next_record += 1;
        }
    }

    /// Records a state if its energy is finite; otherwise the motion ends.
    pub(super) fn keep(&mut self, state: State) -> bool {
        let energy = self.system.energy(state.time, &state.q, Some(&state.v)).total();
        if !(energy + state.work + state.lost).is_finite() {
            let at = self.system.place_of(worst(&state.v));
            let (time, step) =
                (self.state.time, if self.solution.states.is_empty() { 0.0 } else { self.step });
            self.solution.stuck.get_or_insert(NoStep { time, step, failure: Failure::NotFinite, at });
            return false;
        }
        self.solution.states.push(state);
        true
    }

    pub(super) fn between(&mut self, new: &State, time: f64, accelerations: Option<[&[f64]; 2]>) -> State {
        let mut state = self.state.between(new, time, accelerations);
        (state.work, state.lost) = self.work(new, time, accelerations);
        state.angles = turned(self.task.directions, &state);
        self.settle(&mut state);
        state
    }
}
