//! Motion in time: M q̈ + f_int(q) + f_load(q) + Bᵀμ = 0 with g(q) = 0, all loads at their full values.

pub mod generalized_alpha;

use super::equilibrium::Equilibrium;
use super::newton::Failure;
use crate::linear::{Factor, Singular};
use crate::trajectory::{Statistics, StepRecord};

/// A state of motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities of the coordinates.
    pub v: Vec<f64>,
}

impl State {
    /// The state at `time` between this one and a later one: cubic Hermite interpolation of positions and velocities'
    /// matching derivative, with an error of the fourth order in the step.
    pub fn between(&self, later: &Self, time: f64) -> Self {
        let h = later.time - self.time;
        let x = (time - self.time) / h;
        let [p0, m0, p1, m1] = [
            1.0 - x * x * (3.0 - 2.0 * x),
            h * x * (1.0 - x) * (1.0 - x),
            x * x * (3.0 - 2.0 * x),
            -h * x * x * (1.0 - x),
        ];
        let [d0, dm0, d1, dm1] = [
            -6.0 * x * (1.0 - x) / h,
            (1.0 - x) * (1.0 - 3.0 * x),
            6.0 * x * (1.0 - x) / h,
            x * (3.0 * x - 2.0),
        ];
        let combine = |a: f64, b: f64, c: f64, d: f64| -> Vec<f64> {
            let start = self.q.iter().zip(&self.v);
            let end = later.q.iter().zip(&later.v);
            start.zip(end).map(|((q0, v0), (q1, v1))| a * q0 + b * v0 + c * q1 + d * v1).collect()
        };
        Self { time, q: combine(p0, m0, p1, m1), v: combine(d0, dm0, d1, dm1) }
    }
}

/// What an integration found.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// States at the requested times.
    pub states: Vec<State>,
    /// Attempted steps.
    pub history: Vec<StepRecord>,
    /// Counts.
    pub statistics: Statistics,
    /// Why it ends before its time, if it does.
    pub stuck: Option<Stuck>,
}

/// Why a step could not be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Stuck {
    /// Time of the last state \[s\].
    pub time: f64,
    /// The step \[s\].
    pub step: f64,
    /// What went wrong.
    pub failure: Failure,
}

/// The acceleration of a state at which all equations hold: the mass matrix is factorised after the supports' coordinates
/// have been eliminated from it.
///
/// # Errors
/// [`Singular`] where a coordinate has no mass.
pub fn consistent_acceleration(equilibrium: &Equilibrium<'_>, q: &[f64]) -> Result<Vec<f64>, Singular> {
    let system = equilibrium.system();
    let n = system.coordinates();
    let mut mass = equilibrium.mass().cloned().ok_or(Singular { row: 0 })?;
    system.supports().turn_matrix(1.0, &mut mass);
    system.supports().eliminate(1.0, &mut mass);
    let factor = Factor::new(&mass, &system.border(1.0))?;
    let mut right = vec![0.0; equilibrium.unknowns()];
    system.force(1.0, q, &mut right[..n]);
    right.iter_mut().for_each(|r| *r = -*r);
    system.supports().to_frames(1.0, &mut right[..n]);
    factor.solve(&mut right);
    system.supports().from_frames(1.0, &mut right[..n]);
    right.truncate(n);
    Ok(right)
}
