//! Records that solvers leave: attempted steps, counts of work, impulses of contacts.

use super::dynamics::{RecordedForces, State};
use super::resume::Holding;
use crate::assembly::InternalVariables;
use crate::model::Model;
use serde::Serialize;
use std::sync::Arc;

/// One attempted step.
#[derive(Clone, Debug, Default, Serialize)]
pub struct StepRecord {
    /// Load factor or time \[s\] at the end of the step.
    pub parameter: f64,
    /// Step size in the load factor, along the path, or in time \[s\].
    pub step: f64,
    /// Whether it was kept.
    pub accepted: bool,
    /// Per Newton iteration: the scaled increment (dimensionless).
    pub increments: Vec<f64>,
    /// Per Newton iteration: the scaled residual (dimensionless).
    pub residuals: Vec<f64>,
}

/// Counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Statistics {
    /// Steps kept.
    pub steps: usize,
    /// Steps tried again smaller.
    pub rejected_steps: usize,
    /// Load steps kept (statics).
    pub load_steps: usize,
    /// Newton iterations in all.
    pub newton_iterations: usize,
    /// Evaluations of the residual.
    pub residual_evaluations: usize,
    /// Evaluations of the tangent.
    pub tangent_evaluations: usize,
    /// Matrix factorisations.
    pub factorizations: usize,
}

/// The impulse of a contact on a beam from its beginning to its end, without friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ContactImpulse {
    /// ∫ F dt \[N s\].
    pub impulse: [f64; 2],
    /// The largest \|F\| \[N\], from parabolas through points of every step.
    pub largest_force: f64,
}

/// A recorded state with all that its section forces follow from.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordedState {
    /// An equilibrium.
    Equilibrium {
        /// Coordinates and scaled multipliers.
        x: Vec<f64>,
        /// Internal variables of friction.
        variables: InternalVariables,
    },
    /// A state of a motion.
    Moving {
        /// Positions, velocities and internal variables.
        state: State,
        /// What all forces in it follow from.
        forces: RecordedForces,
    },
}

/// The recorded states of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedStates {
    /// One per record.
    pub states: Vec<RecordedState>,
    /// The state from which the run started, where another one has left it.
    pub taken_up: Option<TakenUp>,
}

/// A state from which a run started.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TakenUp {
    /// The model that went on from it.
    pub model: Arc<Model>,
    /// Its coordinates, in which supports without a law of time hold the beams.
    pub q: Vec<f64>,
    /// Its internal variables.
    pub variables: InternalVariables,
    /// What held it, where that is known.
    pub holding: Option<Holding>,
}
