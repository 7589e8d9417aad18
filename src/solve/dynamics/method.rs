//! The interface between a method of time integration and the driver that takes its steps.

use super::State;
use super::memory::Memory;
use super::motion::StageState;
use crate::linear::Singular;
use crate::model::StepControl;
use crate::solve::Statistics;
use crate::solve::newton::{Failure, Iterations};

/// Errors that a step may make, in beam lengths.
#[derive(Clone, Copy, Debug)]
pub struct Allowed {
    /// Of the positions at its end, as the method estimates it.
    pub step: f64,
    /// Of the positions, because its equations are solved by an iteration that stops.
    pub iteration: f64,
    /// The same where what is left has one sign in all steps, as the excess ½ |δ|² of a length that an increment δ makes.
    pub one_sided: f64,
}

impl Allowed {
    /// What the iteration of a step may leave; `one_sided`: where that has one sign in all steps.
    pub fn of_iteration(&self, one_sided: bool) -> f64 {
        if one_sided { self.one_sided } else { self.iteration }
    }
}

/// Part by which a step is shorter than the one that was given and is still that step.
const WHOLE: f64 = 1e-6;

/// Whether a step of the length `h` \[s\] is held against what loads do between the places where the method looks at them: where
/// steps are chosen, and in the parts of a given one that loads divide. A whole step of a given length is the method as it is
/// published.
pub fn may_not_see_loads(control: StepControl, h: f64) -> bool {
    match control {
        StepControl::Fixed(step) => h < (1.0 - WHOLE) * step,
        StepControl::Tolerance(_) => true,
    }
}

/// A method of time integration, with the quantities that it carries from step to step
/// (accelerations, last stages).
pub trait Method: Send {
    /// Order p: the local error is of the order p + 1.
    fn order(&self) -> f64;

    /// A step that could grow by less than this factor keeps its length, so that its factorisation
    /// can be used again.
    fn least_growth(&self) -> f64 {
        1.0
    }

    /// Whether the last step is much too long for vibrations of the mesh, by which states between its ends would err.
    fn vibrates(&self) -> bool;

    /// Prepares the first step from `state`; returns q̈ there.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    fn start(&mut self, state: &State) -> Result<Vec<f64>, Singular>;

    /// Tries a step from `from` to the time `end` and writes the state that it leads to; loads and
    /// supports are smooth between. `allowed` are the errors that the step may make, where the
    /// caller controls them; the method then returns an estimate of its own, and otherwise zero.
    ///
    /// # Errors
    /// [`Failure`] where the equations of the step could not be solved; `record` says how the
    /// iteration went.
    fn attempt(
        &mut self,
        from: &State,
        end: f64,
        allowed: Option<Allowed>,
        to: &mut State,
        record: &mut Iterations,
    ) -> Result<f64, Failure>;

    /// Accepts the step of the last attempt.
    fn accept(&mut self);

    /// Continues from `state`, just after a time at which loads or supports are not smooth; the
    /// last step ended at `before`, just before that time. Returns the jump of the accelerations.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    fn pass(&mut self, before: f64, state: &mut State) -> Result<Vec<f64>, Singular>;

    /// Discards accelerations from before `state`, the end of the last step, because forces have
    /// changed there. A method that only predicts from them need not do anything.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    fn renew(&mut self, _state: &State) -> Result<(), Singular> {
        Ok(())
    }

    /// The accelerations at both ends of the last attempt, for its interpolation; none where
    /// positions and velocities alone match the order of the method.
    fn end_accelerations(&mut self, from: &State, to: &State) -> Option<[Vec<f64>; 2]>;

    /// The stages of the last attempt, which led from `from` to `to`, in the order of their times.
    fn stages(&self, from: &State, to: &State) -> Vec<StageState>;

    /// Accelerations of the unknowns and scaled multipliers at the end of the last accepted step.
    fn end_rates(&self) -> Vec<f64>;

    /// The last Newton increment, which shows the place of a failure.
    fn last_increment(&self) -> &[f64];

    /// Counts of steps, iterations and factorisations so far.
    fn statistics(&mut self) -> &mut Statistics;

    /// The data carried from step to step, for a restart that continues bit for bit.
    fn memory(&self) -> Memory;

    /// Restores what [`Self::memory`] gave; false where it does not fit.
    fn restore(&mut self, memory: Memory) -> bool;
}
