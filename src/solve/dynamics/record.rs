//! What a motion leaves behind on its way: records at the requested times, crossings of probes.

use super::integrate::{Driver, SLACK, worst};
use super::{State, Stuck};
use crate::model::Crossing;
use crate::solve::newton::Failure;

impl Driver<'_, '_> {
    /// Records and events of the step from the last state to `new`, which an event may cut short; true where the motion ends.
    pub(super) fn look(&mut self, new: &mut State) -> bool {
        let slack = SLACK * (new.time - self.state.time);
        let crossed = (0..self.task.watches.len()).any(|w| self.crosses(w, &self.state, new));
        let due = self.next_record as f64 * self.task.output_every < new.time - slack;
        if !self.touching.is_empty() {
            self.notice_contacts(new);
        }
        if !(crossed || due || self.has_work()) {
            self.record_until(new, None);
            return false;
        }
        let accelerations = self.method.end_accelerations(&self.state, new);
        let pair = accelerations.as_ref().map(|[a, b]| [&a[..], &b[..]]);
        let stop = self.locate(new, pair);
        if let Some(state) = stop {
            self.record_until(&state, pair);
            *new = state;
            return true;
        }
        (new.work, new.lost) = self.work(new, new.time, pair);
        self.record_until(new, pair);
        false
    }

    pub(super) fn record_until(&mut self, new: &State, accelerations: Option<[&[f64]; 2]>) {
        let slack = SLACK * (new.time - self.state.time);
        loop {
            let time = self.next_record as f64 * self.task.output_every;
            if time > new.time + slack || time > self.task.duration + slack {
                return;
            }
            let state = if (time - new.time).abs() <= slack {
                new.clone()
            } else {
                self.between(new, time, accelerations)
            };
            if !self.keep(state) {
                return;
            }
            self.next_record += 1;
        }
    }

    /// Keeps a state for the reader, if its energy is a number; else the motion ends.
    pub(super) fn keep(&mut self, state: State) -> bool {
        let energy = self.system.energy(state.time, &state.q, Some(&state.v)).total();
        if !(energy + state.work + state.lost).is_finite() {
            let at = self.system.place_of(worst(&state.v));
            let (time, step) =
                (self.state.time, if self.solution.states.is_empty() { 0.0 } else { self.step });
            self.solution.stuck.get_or_insert(Stuck { time, step, failure: Failure::NotFinite, at });
            return false;
        }
        self.solution.states.push(state);
        true
    }

    pub(super) fn between(&mut self, new: &State, time: f64, accelerations: Option<[&[f64]; 2]>) -> State {
        let mut state = self.state.between(new, time, accelerations);
        (state.work, state.lost) = self.work(new, time, accelerations);
        state
    }

    pub(super) fn crosses(&self, watch: usize, a: &State, b: &State) -> bool {
        let watch = &self.task.watches[watch];
        let distance = |state: &State| watch.view.fields(&state.q).position[watch.axis] - watch.value;
        let (before, after) = (distance(a), distance(b));
        let rising = before < 0.0 && after >= 0.0;
        let falling = before > 0.0 && after <= 0.0;
        match watch.crossing {
            Crossing::Rising => rising,
            Crossing::Falling => falling,
            Crossing::Any => rising || falling,
        }
    }

    /// Locates the events of the step to `new`; returns the state of the first that ends the motion.
    pub(super) fn locate(&mut self, new: &State, accelerations: Option<[&[f64]; 2]>) -> Option<State> {
        let crossed: Vec<usize> =
            (0..self.task.watches.len()).filter(|w| self.crosses(*w, &self.state, new)).collect();
        let mut found: Vec<(usize, State)> =
            crossed.into_iter().map(|w| (w, self.crossing(w, new, accelerations))).collect();
        found.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
        for (watch, state) in found {
            let stop = self.task.watches[watch].stop;
            self.solution.events.push((watch, state.clone()));
            if stop {
                return Some(state);
            }
        }
        None
    }

    /// The state at which a watch crosses its value: bisection of the interpolated motion, to the last bit but a few of the step.
    pub(super) fn crossing(
        &mut self,
        watch: usize,
        new: &State,
        accelerations: Option<[&[f64]; 2]>,
    ) -> State {
        let (mut before, mut after) = (self.state.time, new.time);
        for _ in 0..50 {
            let middle = 0.5 * (before + after);
            let state = self.state.between(new, middle, accelerations);
            if self.crosses(watch, &self.state, &state) {
                after = middle;
            } else {
                before = middle;
            }
        }
        self.between(new, after, accelerations)
    }
}
