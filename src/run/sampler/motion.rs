//! The trajectory of a motion.

use super::energy::unbalanced;
use super::{History, LOOKED_AT, Sampler, is_among};
use crate::model::{Dynamic, EventCondition, EventKind, StepControl};
use crate::numeric::plain;
use crate::results::{AnalysisKind, Energy, Event, Trajectory};
use crate::run::balance::too_few_cells;
use crate::run::laws::Reach;
use crate::run::locking::unheld;
use crate::run::tendons::Tendons;
use crate::run::{phase, steps, strings};
use crate::solve::dynamics;

/// Energies below this, in EA L, are due to the round-off of strains.
const LEAST_ENERGY: f64 = 1e-20;
/// The same in EI/L where no beam stretches.
const LEAST_OF_INEXTENSIBLE: f64 = 1e-14;
/// Largest number of states, evenly spread, that are checked for force fields that cells miss …
const FIELDS_AT: usize = 20;
/// … and for loose nodes, which are so in most states or do not matter.
const LOOSE_AT: usize = 40;

impl Sampler<'_> {
    pub(in crate::run) fn dynamics(&self, settings: &Dynamic, solution: dynamics::Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Dynamic);
        trajectory.run.settings.push(("integrator".into(), settings.integrator.to_string()));
        let count = solution.states.len();
        let (mut locking, mut loose) = (self.locking.clone(), self.loose.clone());
        let mut reach = Reach::new(self.model);
        let mut tendons = Tendons::new(self.model, false);
        let mut pressed = strings::Pressed::new(self.model);
        if self.model.outputs.reactions {
            solution.reactions.iter().for_each(|all| self.record_reactions(&mut trajectory, all));
        }
        for (time, tensions) in &solution.tensions {
            tendons.see_tensions(*time, tensions.iter().copied());
        }
        if let Some((_, last)) = solution.tensions.last() {
            trajectory.run.tensions = tendons.tensions(last.iter().copied());
        }
        for (i, state) in solution.states.iter().enumerate() {
            let (q, v) = (&state.q[..], Some(&state.v[..]));
            let energy = self.system.energy(state.time, q, v).with(&state.variables);
            let energy = Energy { work: state.work + energy.work, lost: state.lost, ..energy };
            self.record(
                &mut trajectory,
                state.time,
                (History::Angles(&state.angles), q),
                (v, &state.variables),
                energy,
            );
            if is_among(i, count, self.frames) {
                trajectory.frames.push(self.frame(state.time, q));
            }
            if is_among(i, count, LOOSE_AT) {
                loose.see(self.system, state.time, q);
            }
            if is_among(i, count, LOOKED_AT) {
                locking.see(q);
                if tendons.are_there() {
                    tendons.see(&self.shape(q));
                }
                if reach.watches() {
                    reach.see(&self.shape(q), &trajectory.run.undeformed);
                }
                if pressed.are_there() {
                    pressed.see(state.time, &self.shape(q));
                }
            }
        }
        let stretches = self.model.beams.iter().any(|beam| beam.section.axial_stiffness.is_some());
        let least = if stretches { LEAST_ENERGY } else { LEAST_OF_INEXTENSIBLE };
        let least = least * self.system.stiffness() * self.system.length();
        trajectory.run.warnings.extend(unbalanced(&trajectory.energy, least));
        let count = solution.states.len();
        let states = solution.states.iter().enumerate().filter(|(i, _)| is_among(*i, count, FIELDS_AT));
        let states: Vec<(&[f64], f64)> = states.map(|(_, state)| (&state.q[..], state.time)).collect();
        self.see_fields(&mut trajectory.run, &states);
        if let [first, .., last] = &solution.states[..] {
            let begin = (first.time, &first.q[..]);
            trajectory.run.warnings.extend(steps::too_long(
                self.model,
                self.system,
                settings,
                begin,
                last.time,
            ));
        }
        trajectory.run.warnings.extend(self.far_from_origin(settings, &solution.states));
        let unwatched = self.hardly_moving(settings, &trajectory);
        trajectory.run.warnings.extend(unwatched);
        if let Some(state) = solution.states.last() {
            trajectory.last = match &solution.end {
                Some(balance) => self.loaded(&state.q, &self.system.actions(balance.view())),
                None => self.shape(&state.q),
            };
        }
        if !self.is_compared() {
            let kinetic = trajectory.energy.last().map_or(0.0, |energy| energy.kinetic);
            let time = solution.states.last().map_or(0.0, |state| state.time);
            let told = too_few_cells(self.model, self.system, (time, &trajectory.last), Some(kinetic));
            trajectory.run.warnings.extend(told);
            // What hits something moves on at its own times.
            if solution.contacts.is_empty() {
                let (states, steps) = (&solution.states, solution.statistics.steps);
                trajectory.run.warnings.extend(phase::late(self.system, settings, states, steps));
            }
        }
        for &dynamics::ProbeEvent { watch, time, value, rates } in &solution.events {
            let EventCondition { probe, quantity, when, .. } = &settings.events[watch];
            let turns = match when {
                EventKind::Reaches { .. } => None,
                EventKind::Maximum => Some("maximum"),
                EventKind::Minimum => Some("minimum"),
            };
            let (probe, quantity) = (probe.clone(), quantity.name().0);
            trajectory.events.push(Event::Probe { time, probe, quantity, value, turns, rates });
        }
        if let Some((watch, time)) = solution.unseen {
            let EventCondition { probe, quantity, .. } = &settings.events[watch];
            trajectory.run.warnings.push(format!(
                "the {} at probe `{probe}` was not known in every step from t = {} s on, so that events may have been missed",
                quantity.name().0,
                plain(time, 6)
            ));
        }
        let contacts: Vec<String> = self.system.contact_names().collect();
        for dynamics::Change { contact, touches, time, impulse } in solution.contacts.iter().copied() {
            let contact = contacts.get(contact).cloned().unwrap_or_default();
            trajectory.events.push(Event::Contact { time, contact, touches, impulse });
        }
        trajectory.events.sort_by(|a, b| a.parameter().total_cmp(&b.parameter()));
        for (contact, time) in &solution.crossings {
            trajectory.run.warnings.push(format!(
                "contact {} gave way at t = {} s: the beam was pushed past the middle of the obstacle, which its `stiffness` \
                 is too small to prevent",
                contacts.get(*contact).cloned().unwrap_or_default(),
                plain(*time, 6)
            ));
        }
        trajectory.run.warnings.extend(unheld(self.model, &trajectory.last, &trajectory.run.undeformed));
        let kinetic = trajectory.energy.iter().map(|energy| energy.kinetic).fold(0.0, f64::max);
        trajectory.run.warnings.extend(locking.warnings(kinetic));
        trajectory.run.warnings.extend(loose.warnings());
        trajectory.run.warnings.extend(reach.warnings());
        trajectory.run.warnings.extend(pressed.warnings());
        trajectory.parameter.iter().for_each(|at| tendons.see_factor(*at));
        trajectory.run.warnings.extend(tendons.warnings());
        let divided = solution.statistics.rejected_steps;
        if divided > 0 && matches!(settings.integrator.step_control(), StepControl::Fixed(_)) {
            let smallest = solution.history.iter().map(|r| r.step).fold(f64::INFINITY, f64::min);
            let unseen = if self.model.has_contact() { " or a contact would not have been seen" } else { "" };
            trajectory.run.warnings.push(format!(
                "the step was divided {divided} time{}, down to {smallest:.1e} s, because its equations could not be solved{unseen}: \
                 give `tolerance` instead of `step`, or a smaller `step`",
                if divided == 1 { "" } else { "s" }
            ));
        }
        trajectory.history = solution.history;
        trajectory.run.statistics = solution.statistics;
        trajectory
    }
}
