//! Motion in time: M q̈ + f_int(q) + f_load(q) + Bᵀμ = 0 with g(q) = 0, all loads at their full
//! values.
//!
//! | file | what it holds |
//! |---|---|
//! | [`motion`] | the equations of motion, with the fixed coordinates eliminated |
//! | [`method`] | the interface between a method and the driver |
//! | [`generalized_alpha`] | second order, numerical damping by choice |
//! | [`collocation`], [`tableau`] | Gauss (order 2, 4, 6; symplectic), Radau IIA (order 3, 5; stiff) |
//! | [`start`] | initial velocities |
//! | [`integrate`] | the driver: steps, restart; with its records in `record`, events in `event` and `crossing`, forces and powers in `forces`, steps that gain energy in `balance`, contacts in `touch` |
//!
//! # No explicit method
//! Störmer's and Verlet's rule and the six-stage method of order 4 of Blanes and Moan were measured
//! on the soft pendulum, the least stiff scene at hand, and left out. Axial waves limit their step
//! so much that they take about twice as long as Gauss' method with three stages, whose error is
//! smaller.
//!
//! # No energy–momentum scheme
//! Schemes that keep the discrete energy exactly (discrete gradients; Simo & Tarnow 1992, Gonzalez
//! 2000) are of second order, and their tangent is not symmetric. Gauss' methods keep linear and
//! angular momentum to round-off and are symplectic, so that the error of the energy stays bounded,
//! O(h^{2s}). With steps at which it is 1e-7 of the kinetic energy, an energy–momentum scheme errs
//! by 1e-3 in the motion itself: exact energy would be the only gain. So they were left out.

mod balance;
pub mod collocation;
mod contact;
mod crossing;
mod event;
mod forces;
pub mod generalized_alpha;
pub mod integrate;
pub mod memory;
pub mod method;
pub mod motion;
mod record;
pub mod stages;
pub mod start;
pub mod tableau;
mod touch;
pub mod turns;

use super::newton::Failure;
use crate::assembly::InternalVariables;
use crate::solve::{Statistics, StepRecord};
use crate::system::Reaction;
use serde::{Deserialize, Serialize};

pub use contact::Change;
pub use event::{EventWatch, Observed, ProbeEvent, Quantity, least_change};
pub use integrate::{Checkpointing, STEP_PART, Task, solve};
pub use memory::Memory;

/// A state of motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities of the coordinates.
    pub v: Vec<f64>,
    /// Work of the loads without potential since the start \[J\].
    pub work: f64,
    /// Energy that damping has taken since the start \[J\].
    pub lost: f64,
    /// Internal variables of friction and torsion springs, which depend on the path.
    #[serde(default)]
    pub variables: InternalVariables,
    /// Directions of r' at the watched points \[rad\], full turns included.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<f64>,
}

impl State {
    /// A state at rest at the time zero.
    pub fn at_rest(q: &[f64]) -> Self {
        Self { q: q.to_vec(), v: vec![0.0; q.len()], ..Self::default() }
    }

    /// The two inner control states of the cubic Bézier curve that has the positions and velocities
    /// of this state and a later one.
    pub fn controls(&self, later: &Self) -> [Vec<f64>; 2] {
        let third = (later.time - self.time) / 3.0;
        let moved =
            |state: &Self, time: f64| state.q.iter().zip(&state.v).map(|(q, v)| q + time * v).collect();
        [moved(self, third), moved(later, -third)]
    }

    /// The state at `time` between this one and a later one, by the polynomial that has the
    /// positions and velocities of both (cubic, error of the fourth order in the step), and with
    /// `accelerations` those too (quintic, sixth order). Work, loss and angles are copied from this
    /// state.
    pub fn between(&self, later: &Self, time: f64, accelerations: Option<[&[f64]; 2]>) -> Self {
        let h = later.time - self.time;
        let x = (time - self.time) / h;
        let mut state = Self {
            time,
            q: vec![0.0; self.q.len()],
            v: vec![0.0; self.q.len()],
            work: self.work,
            lost: self.lost,
            variables: InternalVariables::default(),
            angles: self.angles.clone(),
        };
        // At the start q = q₀ + x h v₀ + x² …; the higher coefficients follow from the data at the
        // end, less the lower terms.
        for i in 0..self.q.len() {
            let (q0, v0, v1) = (self.q[i], h * self.v[i], h * later.v[i]);
            let rise = later.q[i] - q0;
            let (q, v) = match accelerations {
                None => {
                    let (second, third) = (3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise);
                    (x * (v0 + x * (second + x * third)), v0 + x * (2.0 * second + x * 3.0 * third))
                }
                Some([a0, a1]) => {
                    let (a0, a1) = (0.5 * h * h * a0[i], 0.5 * h * h * a1[i]);
                    let (d, s, c) = (rise - v0 - a0, v1 - v0 - 2.0 * a0, a1 - a0);
                    let third = 10.0 * d - 4.0 * s + c;
                    let fourth = -15.0 * d + 7.0 * s - 2.0 * c;
                    let fifth = 6.0 * d - 3.0 * s + c;
                    (
                        x * (v0 + x * (a0 + x * (third + x * (fourth + x * fifth)))),
                        v0 + x * (2.0 * a0 + x * (3.0 * third + x * (4.0 * fourth + x * 5.0 * fifth))),
                    )
                }
            };
            state.q[i] = q0 + q;
            state.v[i] = v / h;
        }
        state
    }
}

/// The results of an integration.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// States at the requested times.
    pub states: Vec<State>,
    /// Forces of supports and joints in each of them, where they were asked for.
    pub reactions: Vec<Vec<Reaction>>,
    /// The time of each state, and the tensions \[N\] of the tendons of given length there, where
    /// reactions are known.
    pub tensions: Vec<(f64, Vec<f64>)>,
    /// What all forces in each of them follow from, where that was asked for.
    pub forces: Vec<RecordedForces>,
    /// All forces in the last state.
    pub end: Option<motion::Balance>,
    /// Attempted steps, thinned out where there are very many.
    pub history: Vec<StepRecord>,
    /// Events in the order of their times.
    pub events: Vec<ProbeEvent>,
    /// The first watch whose quantity was not known, and from when on \[s\].
    pub unseen: Option<(usize, f64)>,
    /// Contacts in which the beam was pushed past the middle of the obstacle: the number of the
    /// contact, and the end of the first such step \[s\].
    pub crossings: Vec<(usize, f64)>,
    /// Contacts that began or ended, in order.
    pub contacts: Vec<Change>,
    /// Counts of steps, iterations and factorisations.
    pub statistics: Statistics,
    /// The state from which the motion can be continued.
    pub checkpoint: Option<Checkpoint>,
    /// Why the motion ended early, if it did.
    pub stuck: Option<NoStep>,
}

/// How a state between the ends of a step moves on: enough to find all forces in it later.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tendency {
    /// Accelerations of the unknowns, followed by the scaled multipliers.
    pub rates: Vec<f64>,
    /// Length of the step \[s\].
    pub step: f64,
}

/// What all forces in a recorded state follow from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum RecordedForces {
    /// The positions alone, which are exact at the start of a motion.
    #[default]
    Positions,
    /// How the state moves on.
    Tendency(Tendency),
    /// They are known.
    Known(Box<motion::Balance>),
}

/// A state with all that a method carries from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The state from which the next step is taken.
    pub state: State,
    /// The method with its settings, to which `memory` belongs.
    pub method: String,
    /// The quantities that the method carries from step to step.
    pub memory: Memory,
    /// The next step \[s\].
    pub step: f64,
    /// Error of the last step relative to the allowed one.
    pub last_ratio: f64,
    /// For steps of fixed length: the time from which they are counted \[s\], and how many were
    /// taken.
    pub origin: (f64, u64),
    /// The state that was reached, where the motion's end or an event cut the step from `state`
    /// short. A continued motion takes this step again in full.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cut: Option<State>,
}

impl Checkpoint {
    /// The last state that was reached.
    pub fn reached(&self) -> &State {
        self.cut.as_ref().unwrap_or(&self.state)
    }
}

/// Why a step could not be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct NoStep {
    /// Time of the last state \[s\].
    pub time: f64,
    /// Length of the step \[s\].
    pub step: f64,
    /// What went wrong.
    pub failure: Failure,
    /// Beam and arc length \[m\] where the last iterate changed most.
    pub at: (usize, f64),
}
