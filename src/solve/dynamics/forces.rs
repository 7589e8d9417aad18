//! Forces and powers of a motion from the stages of its steps, in which the equations of motion
//! hold.

use super::integrate::Driver;
use super::motion::{Balance, Motion, StageState};
use super::{RecordedForces, State, Tendency};
use crate::system::Reaction;

/// Lagrange's polynomials on `times`, at the time `at`.
fn lagrange(times: &[f64], at: f64) -> Vec<f64> {
    let share = |k: usize| {
        let others = times.iter().enumerate().filter(|(j, _)| *j != k);
        others.map(|(_, other)| (at - other) / (times[k] - other)).product()
    };
    (0..times.len()).map(share).collect()
}

/// The integrals of Lagrange's polynomials on up to four `times` from `start` to `end`.
fn integrals(times: &[f64], start: f64, end: f64) -> Vec<f64> {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let offset = half / 3.0_f64.sqrt();
    let [a, b] = [middle - offset, middle + offset].map(|at| lagrange(times, at));
    a.iter().zip(&b).map(|(a, b)| half * (a + b)).collect()
}

impl<'a> Driver<'_, 'a> {
    /// Work of moving supports and of tendons that are pulled until `time` in the step to `new`, by
    /// the quadrature rule of the method itself.
    pub(super) fn work_of_supports(&mut self, new: &State, time: f64) -> f64 {
        if !self.system.works_by_constraints() {
            return 0.0;
        }
        if self.support_powers.is_empty() {
            let stages = self.method.stages(&self.state, new);
            let start = self.state.time;
            // Friction depends on the last accepted state, which has changed.
            let known = self.support_power_at_start.filter(|_| !self.system.has_history());
            let power = |stage: StageState| match known {
                Some((time, power)) if time == start && time == stage.state.time => (time, power),
                _ => (stage.state.time, self.observer().map_or(f64::NAN, |m| m.support_power(stage))),
            };
            self.support_powers = stages.into_iter().map(power).collect();
        }
        self.until(time, &self.support_powers)
    }

    /// Energy taken by damping until `time` in the step to `new`, by the quadrature rule of the
    /// method itself. Where vibrations decay faster than a step can follow, only this rule gives
    /// the energy that the computed motion loses; the powers at the step's ends are arbitrarily
    /// larger. With methods of second order a whole step takes what damping takes in the mean state
    /// of its ends.
    pub(super) fn taken_by_damping(&mut self, new: &State, time: f64) -> f64 {
        if !self.system.is_damped() {
            return 0.0;
        }
        let mut scratch = vec![0.0; new.q.len()];
        if self.method.order() <= 2.0 {
            let mean =
                |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect() };
            let (q, v) = (mean(&self.state.q, &new.q), mean(&self.state.v, &new.v));
            return (time - self.state.time) * self.system.lost_power(&q, &v, &mut scratch);
        }
        if self.damping_powers.is_empty() {
            for StageState { mut state, .. } in self.method.stages(&self.state, new) {
                if let Some(motion) = self.observer() {
                    motion.carry(&mut state);
                }
                let power = self.system.lost_power(&state.q, &state.v, &mut scratch);
                self.damping_powers.push((state.time, power));
            }
        }
        self.until(time, &self.damping_powers)
    }

    /// The integral of powers at the times of stages from the last state until `time`.
    fn until(&self, time: f64, powers: &[(f64, f64)]) -> f64 {
        let times: Vec<f64> = powers.iter().map(|(time, _)| *time).collect();
        let weights = integrals(&times, self.state.time, time);
        weights.iter().zip(powers).map(|(weight, (_, power))| weight * power).sum()
    }

    /// Equations of motion for evaluating states, separate from those of the method and its counts.
    /// Friction depends on the last accepted state.
    fn observer(&mut self) -> Option<&mut Motion<'a>> {
        if self.observer.is_none() {
            self.observer = Motion::new(self.system).ok();
        }
        let motion = self.observer.as_mut()?;
        motion.set_accepted(&self.state);
        Some(motion)
    }

    /// How the motion goes on at a time within the step to `new`.
    pub(super) fn tendency_within(&mut self, new: &State, time: f64) -> Option<Tendency> {
        let stages = self.method.stages(&self.state, new);
        let times: Vec<f64> = stages.iter().map(|stage| stage.state.time).collect();
        let shares = lagrange(&times, time);
        let mut rates = vec![0.0; stages.first()?.rates.len()];
        for (share, stage) in shares.iter().zip(&stages) {
            rates.iter_mut().zip(&stage.rates).for_each(|(sum, rate)| *sum += share * rate);
        }
        Some(Tendency { rates, step: new.time - self.state.time })
    }

    /// How it goes on at the end of the last step.
    pub(super) fn tendency_at_end(&self) -> Tendency {
        Tendency { rates: self.method.end_rates(), step: self.last_step }
    }

    /// The state `state` within the step to `new`, with all forces.
    pub(super) fn balance_within(&mut self, new: &State, state: &State) -> Option<Balance> {
        let tendency = self.tendency_within(new, state.time)?;
        self.settled(state, tendency)
    }

    /// All forces in the first record `first`. They are exact at the start of a motion; in one that
    /// is continued, they follow from the rates at the end of the last step.
    pub(super) fn balance_at_start(&mut self, first: &State) -> Option<Balance> {
        if self.state.time > 0.0 {
            let tendency = self.tendency_at_end();
            return self.settled(first, tendency);
        }
        let first = first.clone();
        self.observer()?.exact_balance(&first).ok()
    }

    /// All forces in the last state.
    pub(super) fn balance_at_end(&mut self) -> Option<Balance> {
        let (state, tendency) = (self.state.clone(), self.tendency_at_end());
        self.settled(&state, tendency)
    }

    fn settled(&mut self, state: &State, tendency: Tendency) -> Option<Balance> {
        let balance = self.observer()?.settle(state, tendency).ok()?;
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        (finite(&balance.state.q) && finite(&balance.state.v)).then_some(balance)
    }

    /// Whether states between the ends of steps are moved into balance: where forces are wanted,
    /// with moving supports, whose energy balance would suffer from the strain error of an
    /// interpolated state, and where steps are much too long for vibrations of the mesh, which
    /// would bend that state.
    pub(super) fn settles(&self) -> bool {
        self.task.reactions || self.system.works_by_constraints() || self.method.vibrates()
    }

    /// Keeps what all forces in a record follow from.
    pub(super) fn keep_forces(&mut self, balance: Option<&Balance>, tendency: Option<Tendency>) {
        self.solution.forces.push(match (balance, tendency) {
            (Some(balance), _) => RecordedForces::Known(Box::new(balance.clone())),
            (None, Some(tendency)) => RecordedForces::Tendency(tendency),
            (None, None) => RecordedForces::Positions,
        });
    }

    /// Keeps the forces of supports and joints in a record.
    pub(super) fn keep_reactions(&mut self, balance: Option<Balance>) {
        if let Some(balance) = balance.as_ref().filter(|_| self.system.has_held_lengths()) {
            let tensions = self.system.tensions(&balance.multipliers).map(|(tension, _)| tension);
            self.solution.tensions.push((balance.state.time, tensions.collect()));
        }
        let reactions = match (balance, self.observer()) {
            (Some(balance), Some(motion)) => motion.reactions_in(&balance),
            _ => vec![Reaction { fx: f64::NAN, fy: f64::NAN, moment: f64::NAN }],
        };
        self.solution.reactions.push(reactions);
    }
}
