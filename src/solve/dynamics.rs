//! Motion in time: M q̈ + f_int(q) + f_load(q) + Bᵀμ = 0 with g(q) = 0, all loads at their full
//! values.
//!
//! | file | what it holds |
//! |---|---|
//! | [`motion`] | the equations, with what is held eliminated |
//! | [`method`] | what a method is to the driver |
//! | [`generalized_alpha`] | second order, numerical damping by choice |
//! | [`collocation`], [`tableau`] | Gauss (order 2, 4, 6; symplectic), Radau IIA (order 3, 5; stiff) |
//! | [`start`] | initial velocities |
//! | [`integrate`] | the driver: steps, restart; with its records and events in `record` and `crossing`, forces and powers in `forces`, steps that gain energy in `balance`, contacts in `touch` |
//!
//! # No explicit method
//! Störmer's and Verlet's rule and the six-stage method of order 4 of Blanes and Moan were built
//! and measured on the soft pendulum (E = 68.95 MPa, the least stiff scene at hand): axial waves
//! limit the step to 90 µs with 23 cable elements and to 70 µs with 20 RPIM nodes, so that the
//! cheaper of the two took 1.8 times (ANCF) and 2.5 times (RPIM) as long as Gauss' method with
//! three stages and 4 ms, whose error is smaller. They were left out.
//!
//! # No energy–momentum scheme
//! Schemes that keep the discrete energy exactly (discrete gradients; Simo & Tarnow 1992, Gonzalez
//! 2000) are of second order, and their tangent is not symmetric. Gauss' methods keep linear and
//! angular momentum to round-off and are symplectic, so that the energy errs by a bounded
//! O(h^{2s}): 1e-7 of the kinetic energy where a step of the same length by an energy–momentum
//! scheme errs by 1e-3 in the motion itself. Its exact energy would be the only digit that it has
//! right; it was left out.

mod balance;
pub mod collocation;
mod contact;
mod crossing;
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
pub use integrate::{Checkpointing, EventWatch, Task, solve};
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
    /// What friction and torsion springs remember.
    #[serde(default)]
    pub variables: InternalVariables,
    /// Directions of r' at the places where they are watched \[rad\], with all turns.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<f64>,
}

impl State {
    /// A state at rest at the time zero.
    pub fn at_rest(q: &[f64]) -> Self {
        Self { q: q.to_vec(), v: vec![0.0; q.len()], ..Self::default() }
    }

    /// The two inner control states of the cubic that has positions and velocities of this state
    /// and a later one.
    pub fn controls(&self, later: &Self) -> [Vec<f64>; 2] {
        let third = (later.time - self.time) / 3.0;
        let moved =
            |state: &Self, time: f64| state.q.iter().zip(&state.v).map(|(q, v)| q + time * v).collect();
        [moved(self, third), moved(later, -third)]
    }

    /// The state at `time` between this one and a later one, by the polynomial that has positions
    /// and velocities of both (cubic, error of the fourth order in the step), and with
    /// `accelerations` those too (quintic, sixth order). Work, loss and angles are this state's.
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
        // From the start: q = q₀ + x h v₀ + x² …; the end's data enter through their defects
        // against the lower terms.
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

/// What an integration found.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// States at the requested times.
    pub states: Vec<State>,
    /// Forces of supports and joints in each of them, where they were asked for.
    pub reactions: Vec<Vec<Reaction>>,
    /// All forces in the last of them.
    pub end: Option<motion::Balance>,
    /// Attempted steps, thinned out where there are very many.
    pub history: Vec<StepRecord>,
    /// Events in the order of their times: (number of the watch, state).
    pub events: Vec<(usize, State)>,
    /// Contacts that gave way, by number, and when they first did \[s\].
    pub crossings: Vec<(usize, f64)>,
    /// Contacts that began or ended, in order.
    pub contacts: Vec<Change>,
    /// Counts.
    pub statistics: Statistics,
    /// From which the motion can be continued.
    pub checkpoint: Option<Checkpoint>,
    /// Why it ends before its time, if it does.
    pub stuck: Option<NoStep>,
}

/// A state with all that a method carries from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The state.
    pub state: State,
    /// The method and its settings, whose memory this is.
    pub method: String,
    /// The method's memory.
    pub memory: Memory,
    /// The next step \[s\].
    pub step: f64,
    /// Error of the last step against what it was allowed.
    pub last_ratio: f64,
    /// Where steps of fixed length are counted from \[s\], and how many were taken.
    pub origin: (f64, u64),
    /// The state that was reached, where the motion's end or an event cut the step from `state`
    /// short: this step is taken once more.
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
    /// The step \[s\].
    pub step: f64,
    /// What went wrong.
    pub failure: Failure,
    /// Beam and arc length \[m\] where the last iterate changed most.
    pub at: (usize, f64),
}
