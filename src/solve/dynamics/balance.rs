//! The energy balance of a motion: work of loads and supports, energy taken by damping, and the
//! refusal of steps that gain energy without any work.

use super::State;
use super::integrate::Driver;
use crate::solve::newton::Failure;
use crate::threads;

/// A step of fixed length that turns a node by more than this is checked for a gain of energy
/// \[rad\].
const COARSE_TURN: f64 = 0.1;
/// Largest turn of a torsion spring in one step \[rad\]; beyond it the sense of the turn is
/// doubtful.
const LARGEST_WINDING: f64 = 2.0;
/// Largest energy that such a coarse step may gain, relative to the kinetic energy.
const LARGEST_GAIN: f64 = 1e-3;

impl Driver<'_, '_> {
    /// Refuses a coarse step to `new` that gains energy.
    pub(super) fn without_gain(&mut self, new: &State) -> Result<(), Failure> {
        let states = [&new.q, &self.state.q].map(|q| q.as_chunks::<4>().0);
        let turn = threads::over(
            states,
            &|_, [new, old]| {
                let turn =
                    |([.., x, y], [.., x0, y0]): (&[f64; 4], &[f64; 4])| (x - x0).powi(2) + (y - y0).powi(2);
                new.iter().zip(old).map(turn).fold(0.0, f64::max)
            },
            &f64::max,
        );
        if turn.sqrt() <= COARSE_TURN {
            return Ok(());
        }
        let energy = |state: &State| self.system.energy(state.time, &state.q, Some(&state.v));
        let (before, after) = (energy(&self.state), energy(new));
        let (work, _) = self.work(new, new.time, None);
        // The springs of sticking friction can give back no more than they store.
        let put_in =
            work - self.state.work - self.taken_by_damping(new, new.time) + self.state.variables.friction;
        let wound = self.system.winding_energy(&self.accepted, &new.q) - self.state.variables.winding;
        let gain = (after.total() + wound - before.total() - put_in) / before.kinetic.max(after.kinetic);
        match gain {
            _ if gain <= LARGEST_GAIN => Ok(()),
            _ if gain.is_nan() => Err(Failure::NotFinite),
            _ => Err(Failure::Gain { gain }),
        }
    }

    /// Whether energy enters or leaves through forces without a potential or moving supports.
    pub(super) fn has_work(&self) -> bool {
        self.system.has_work()
            || self.system.is_damped()
            || self.system.has_friction()
            || self.system.works_by_constraints()
    }

    /// Sets the internal variables of a state of the present step. The energy that the springs of
    /// friction store is not counted as lost.
    pub(super) fn settle(&self, state: &mut State) {
        if self.system.has_history() {
            state.variables = self.system.internal_variables(&self.accepted, &state.q);
            state.lost -= state.variables.friction - self.state.variables.friction;
        }
    }

    /// Refuses a step in which a torsion spring turns so far that it could have turned the other
    /// way.
    pub(super) fn not_overwound(&self, new: &State) -> Result<(), Failure> {
        let turn = self.system.winding_turn(&self.accepted, &new.q);
        if turn > LARGEST_WINDING { Err(Failure::Overwound { turn }) } else { Ok(()) }
    }

    /// Work of the loads without potential and of moving supports, and energy taken by damping and
    /// friction, until `time` in the step to `new`. The powers of loads and friction, which follow
    /// from a state alone, are integrated by the trapezoidal rule if the method is of second order,
    /// and otherwise at three Gauss points. Of loads that have a potential times a factor, the former rule is taken along the
    /// potential: velocities of second order would not tell how strains follow those that actuation imposes.
    pub(super) fn work(&mut self, new: &State, time: f64, accelerations: Option<[&[f64]; 2]>) -> (f64, f64) {
        let (mut work, mut lost) = (self.state.work, self.state.lost);
        if !self.has_work() {
            return (work, lost);
        }
        work += self.work_of_supports(new, time);
        lost += self.taken_by_damping(new, time);
        if !(self.system.has_work() || self.system.has_friction()) {
            return (work, lost);
        }
        let h = time - self.state.time;
        if self.method.order() <= 2.0 {
            let before = self.power_at_start();
            let between = (time != new.time).then(|| self.state.between(new, time, accelerations));
            let end = between.as_ref().unwrap_or(new);
            let after = self.power(end, true);
            if time == new.time {
                self.powers[1] = (time, after);
            }
            work += self.system.work_of_laws([&self.state, end].map(|state| (state.time, &state.q[..])));
            return (work + 0.5 * h * (before.0 + after.0), lost + 0.5 * h * (before.1 + after.1));
        }
        let offset = 0.6_f64.sqrt();
        for (x, weight) in [(-offset, 5.0), (0.0, 8.0), (offset, 5.0)] {
            let state = self.state.between(new, self.state.time + 0.5 * h * (1.0 + x), accelerations);
            let weight = weight * h / 18.0;
            let (put_in, taken) = self.power(&state, false);
            work += weight * put_in;
            lost += weight * taken;
        }
        (work, lost)
    }

    /// Power at the start of the step. It is known from the end of the last step, unless an attempt
    /// since then ended elsewhere. With friction it is computed anew, because friction depends on
    /// the last accepted state, which has changed.
    pub(super) fn power_at_start(&mut self) -> (f64, f64) {
        let known = self.powers.iter().find(|(time, _)| *time == self.state.time).map(|(_, power)| *power);
        let power = known.filter(|_| !self.system.has_friction()).unwrap_or_else(|| {
            let state = self.state.clone();
            self.power(&state, true)
        });
        self.powers[0] = (self.state.time, power);
        power
    }

    /// Power \[W\] put in by loads without potential, or only by those that have none at any time, and taken by friction.
    pub(super) fn power(&self, state: &State, at_no_time: bool) -> (f64, f64) {
        let mut scratch = vec![0.0; state.q.len()];
        let loads = self.system.power(state.time, &state.q, &state.v, at_no_time, &mut scratch);
        if !self.system.has_friction() {
            return (loads, 0.0);
        }
        scratch.fill(0.0);
        self.system.add_friction(&self.accepted, &state.q, &mut scratch);
        (loads, scratch.iter().zip(&state.v).map(|(f, v)| f * v).sum())
    }
}
