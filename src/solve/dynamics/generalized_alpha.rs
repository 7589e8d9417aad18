//! The generalised-α method (Chung, Hulbert, *J. Appl. Mech.* 60, 1993, 371–375) with a fixed step.
//!
//! Second order; the spectral radius ρ∞ ∈ [0, 1] sets how fast the highest frequencies die out: 1 is the trapezoidal rule,
//! 0 kills them in one step. Equilibrium holds at the end of each step, and an algorithmic acceleration a carries the
//! averaging (Arnold, Brüls, *Multibody Syst. Dyn.* 18, 2007, 185–202):
//!
//! ```text
//! q₁ = q₀ + h v₀ + h² ((½ − β) a₀ + β a₁)      v₁ = v₀ + h ((1 − γ) a₀ + γ a₁)
//! (1 − α_m) a₁ + α_m a₀ = (1 − α_f) q̈₁ + α_f q̈₀
//! α_m = (2ρ∞ − 1)/(ρ∞ + 1)   α_f = ρ∞/(ρ∞ + 1)   γ = ½ − α_m + α_f   β = ¼ (1 − α_m + α_f)²
//! ```

use super::{Solution, State, Stuck, consistent_acceleration};
use crate::solve::equilibrium::{AtLoad, Equilibrium};
use crate::solve::newton::{self, Failure, Iterations, Settings};
use crate::system::System;
use crate::trajectory::{Statistics, StepRecord};

/// What is to be integrated, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Simulated time \[s\].
    pub duration: f64,
    /// Time between recorded states \[s\].
    pub output_every: f64,
    /// The step \[s\]; the last one is shortened to end in time.
    pub step: f64,
    /// ρ∞.
    pub spectral_radius: f64,
}

/// Newton's increments at which a step is solved: far below the error of a second-order step.
const TOLERANCE: f64 = 1e-10;

/// Integrates from the stress-free state at rest. `observe` is called with (time, step, counts) after every step and ends
/// the integration by returning false.
pub fn solve(
    system: &System,
    task: &Task,
    observe: &mut dyn FnMut(f64, f64, &Statistics) -> bool,
) -> Solution {
    let mut equilibrium = Equilibrium::in_motion(system);
    let mut solution = Solution::default();
    if let Err(stuck) = integrate(&mut equilibrium, task, &mut solution, observe) {
        solution.stuck = Some(stuck);
    }
    solution.statistics = equilibrium.statistics;
    solution
}

fn integrate(
    equilibrium: &mut Equilibrium<'_>,
    task: &Task,
    solution: &mut Solution,
    observe: &mut dyn FnMut(f64, f64, &Statistics) -> bool,
) -> Result<(), Stuck> {
    let system = equilibrium.system();
    let n = system.coordinates();
    let rho = task.spectral_radius;
    let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
    let (gamma, beta) = (0.5 - alpha_m + alpha_f, 0.25 * (1.0 - alpha_m + alpha_f).powi(2));
    let mut x = equilibrium.start();
    system.supports().impose(1.0, &mut x[..n]);
    let mut state = State { time: 0.0, q: x[..n].to_vec(), v: vec![0.0; n] };
    let failed = |state: &State, step, failure: Failure| Stuck { time: state.time, step, failure };
    let mut physical = consistent_acceleration(equilibrium, &state.q)
        .map_err(|singular| failed(&state, 0.0, singular.into()))?;
    let mut algorithmic = physical.clone();
    solution.states.push(state.clone());
    let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
    let steps = (task.duration / task.step * (1.0 - 1e-12)).ceil().max(1.0) as u64;
    let mut next_output = 1_u64;
    for i in 1..=steps {
        let end = if i == steps { task.duration } else { task.step * i as f64 };
        let h = end - state.time;
        // q̈ = c q + e from the three formulas above.
        let a_per_q = 1.0 / (beta * h * h);
        let c = (1.0 - alpha_m) / (1.0 - alpha_f) * a_per_q;
        let before = x.clone();
        let explicit: Vec<f64> =
            (0..n).map(|i| state.q[i] + h * (state.v[i] + h * (0.5 - beta) * algorithmic[i])).collect();
        equilibrium.inertia.coefficient = c;
        for i in 0..n {
            equilibrium.inertia.offset[i] =
                (alpha_m * algorithmic[i] - alpha_f * physical[i]) / (1.0 - alpha_f) - c * explicit[i];
            x[i] = explicit[i] + h * h * beta * algorithmic[i];
        }
        system.supports().impose(1.0, &mut x[..n]);
        let mut record = Iterations::default();
        let mut equations = AtLoad::new(equilibrium, 1.0);
        let result = newton::solve(&mut equations, &mut x, &before, &settings, &mut record);
        solution.history.push(StepRecord {
            parameter: end,
            step: h,
            accepted: result.is_ok(),
            increments: record.increments,
            residuals: record.residuals,
        });
        result.map_err(|failure| failed(&state, h, failure))?;
        let mut new = State { time: end, q: x[..n].to_vec(), v: vec![0.0; n] };
        for i in 0..n {
            let a = (x[i] - explicit[i]) * a_per_q;
            new.v[i] = state.v[i] + h * ((1.0 - gamma) * algorithmic[i] + gamma * a);
            physical[i] = equilibrium.inertia.coefficient * x[i] + equilibrium.inertia.offset[i];
            algorithmic[i] = a;
        }
        equilibrium.statistics.steps += 1;
        // Round-off of the times must not lose a record.
        let slack = 1e-9 * task.step;
        while next_output as f64 * task.output_every <= end + slack {
            let time = next_output as f64 * task.output_every;
            let at_end = (time - end).abs() <= slack;
            solution.states.push(if at_end { new.clone() } else { state.between(&new, time) });
            next_output += 1;
        }
        if i == steps && solution.states.last().is_none_or(|last| last.time < end - slack) {
            solution.states.push(new.clone());
        }
        state = new;
        if !observe(state.time, h, &equilibrium.statistics) {
            return Ok(());
        }
    }
    Ok(())
}
