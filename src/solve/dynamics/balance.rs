//! The balance of energy of a motion: what loads and supports put in, what damping takes, and steps
//! that gain what nobody put in.

use super::State;
use super::integrate::Driver;
use crate::assembly::nodes;
use crate::solve::newton::Failure;

/// Turn of a node beyond which a step of fixed length is asked what it does to the energy \[rad\].
const COARSE_TURN: f64 = 0.1;
/// Turn of a torsion spring in one step \[rad\].
const LARGEST_WINDING: f64 = 2.0;
/// Energy that such a step may gain, relative to the kinetic energy.
const LARGEST_GAIN: f64 = 1e-3;

impl Driver<'_, '_> {
    /// Refuses a coarse step to `new` that gains energy.
    pub(super) fn without_gain(&mut self, new: &State) -> Result<(), Failure> {
        let turns = nodes(&new.q).zip(nodes(&self.state.q)).map(|(new, old)| {
            let ([x, y], [x0, y0]) = (new.gradient, old.gradient);
            (x - x0).powi(2) + (y - y0).powi(2)
        });
        if turns.fold(0.0, f64::max).sqrt() <= COARSE_TURN {
            return Ok(());
        }
        let energy = |state: &State| self.system.energy(state.time, &state.q, Some(&state.v));
        let (before, after) = (energy(&self.state), energy(new));
        let (work, _) = self.work(new, new.time, None);
        // Springs of friction give back what they hold at most.
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

    /// Whether energy enters or leaves by other ways than potentials.
    pub(super) fn has_work(&self) -> bool {
        self.system.has_work()
            || self.system.is_damped()
            || self.system.has_friction()
            || self.system.supports().moves_in_time()
    }

    /// Gives a state of the present step its internal variables. What the springs of friction hold
    /// is not lost.
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

    /// Work of the loads without potential and of moving supports, and what damping and friction
    /// took, until `time` in the step to `new`: of what a state tells by the trapezoidal rule where
    /// the method itself is of second order, and else by three Gauss points.
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
            let after = if time == new.time {
                self.power(new)
            } else {
                let state = self.state.between(new, time, accelerations);
                self.power(&state)
            };
            if time == new.time {
                self.powers[1] = (time, after);
            }
            return (work + 0.5 * h * (before.0 + after.0), lost + 0.5 * h * (before.1 + after.1));
        }
        let offset = 0.6_f64.sqrt();
        for (x, weight) in [(-offset, 5.0), (0.0, 8.0), (offset, 5.0)] {
            let state = self.state.between(new, self.state.time + 0.5 * h * (1.0 + x), accelerations);
            let weight = weight * h / 18.0;
            let (put_in, taken) = self.power(&state);
            work += weight * put_in;
            lost += weight * taken;
        }
        (work, lost)
    }

    /// Power at the start of the step, which was its end before, unless an attempt since then ended
    /// elsewhere. Friction counts from another state since.
    pub(super) fn power_at_start(&mut self) -> (f64, f64) {
        let known = self.powers.iter().find(|(time, _)| *time == self.state.time).map(|(_, power)| *power);
        let power = known.filter(|_| !self.system.has_friction()).unwrap_or_else(|| {
            let state = self.state.clone();
            self.power(&state)
        });
        self.powers[0] = (self.state.time, power);
        power
    }

    /// Power \[W\] put in by loads without potential, and taken by friction.
    pub(super) fn power(&self, state: &State) -> (f64, f64) {
        let mut scratch = vec![0.0; state.q.len()];
        let loads = self.system.power(state.time, &state.q, &state.v, &mut scratch);
        if !self.system.has_friction() {
            return (loads, 0.0);
        }
        scratch.fill(0.0);
        self.system.add_friction(&self.accepted, &state.q, &mut scratch);
        (loads, scratch.iter().zip(&state.v).map(|(f, v)| f * v).sum())
    }
}
