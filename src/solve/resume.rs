//! Statics that starts from a state which another analysis has left.

use super::equilibrium::Equilibrium;
use super::newton::RESIDUAL_TOLERANCE;
use crate::assembly::{Earlier, InternalVariables};
use crate::system::{System, Unbalanced};

/// The forces that hold a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Holding {
    /// The generalised forces of supports on the coordinates that they fix, in fixed axes; others are
    /// zero.
    pub supports: Vec<f64>,
    /// The scaled multipliers of all rows.
    pub multipliers: Vec<f64>,
}

/// σ of the shifted tangent K + σ D that finds multipliers: it outweighs every stiffness but that
/// against stretch, and keeps the sum definite.
const SHIFT: f64 = 1e3;
/// The multipliers are improved so often.
const ROUNDS: usize = 2;
/// So often they are improved again at most where something is left unbalanced, and until they change by
/// this part of the largest.
const GATHERINGS: usize = 20;
const GATHERED: f64 = 1e-6;
/// The smallest part of D that a coordinate without an unbalanced force keeps.
const BALANCED: f64 = 1e-8;

/// Lets an analysis of `system` begin in the state `q` with the internal `variables`. Supports and
/// rows begin with the forces of `holding`, or, where these are not known, with those that balance as
/// much as they can. What remains unbalanced fades as the load factor grows.
pub fn resume(system: &mut System, q: &[f64], variables: &InternalVariables, holding: Option<&Holding>) {
    system.begin_in(q, variables);
    let (x, residual) = match holding {
        Some(holding) => {
            let x = [q, &holding.multipliers].concat();
            let residual = Equilibrium::new(system).residual(0.0, &x, &mut vec![0.0; x.len()]);
            (x, residual)
        }
        None => with_multipliers(system, q),
    };
    let supports = holding.map(|holding| &holding.supports[..]);
    let Unbalanced { force, on_fixed } = system.unbalanced(&x, variables, supports);
    let left = (residual > RESIDUAL_TOLERANCE || on_fixed > RESIDUAL_TOLERANCE).then_some(&force[..]);
    system.leave_unbalanced(&x[q.len()..], left);
}

/// The state `q` in which `system` begins, with its multipliers, and the scaled residual.
///
/// What has gone, a support or a joint, acted on few coordinates. Multipliers that make the sum of
/// squares r·D⁻¹r of the unbalanced forces least would take a part of it over, all along a beam that
/// keeps its length. D is therefore made smaller where little is unbalanced, in proportion to
/// |r|^(3/2), so that the sum of √|r| becomes least and the forces gather on few coordinates
/// (iteratively reweighted least squares; Chartrand & Yin, *Proc. ICASSP* 2008, 3869–3872).
fn with_multipliers(system: &System, q: &[f64]) -> (Vec<f64>, f64) {
    let mut equilibrium = Equilibrium::new(system);
    let mut x = equilibrium.start();
    let (n, weights) = (q.len(), system.weights());
    let (mut increment, still) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    let mut residual = equilibrium.residual(0.0, &x, &mut increment);
    for round in 0..if x.len() > n { ROUNDS + GATHERINGS } else { 0 } {
        let gathers = round >= ROUNDS;
        if gathers && residual <= RESIDUAL_TOLERANCE {
            break;
        }
        let (sigma, diagonal) = if gathers {
            (SHIFT / BALANCED, gathered(system, &weights, &increment[..n]))
        } else {
            (SHIFT, weights.clone())
        };
        let earlier = Earlier { q, increment: &still };
        // Rows that contradict each other are left to the path, which tells of them.
        if equilibrium.linearize_shifted(0.0, &x, earlier, (sigma, &diagonal), &mut increment).is_err() {
            residual = equilibrium.residual(0.0, &x, &mut increment);
            break;
        }
        equilibrium.solve(0.0, &mut increment, false);
        let changes = largest(&increment[n..]) > GATHERED * largest(&x[n..]);
        x[n..].iter_mut().zip(&increment[n..]).for_each(|(x, change)| *x += change);
        residual = equilibrium.residual(0.0, &x, &mut increment);
        if gathers && !changes {
            break;
        }
    }
    (x, residual)
}

/// D for unbalanced forces `force`. The unit of a force on a gradient is that of a force over the
/// length of the structure.
fn gathered(system: &System, weights: &[f64], force: &[f64]) -> Vec<f64> {
    let units = [1.0, 1.0, system.length(), system.length()];
    let sizes: Vec<f64> = force.iter().enumerate().map(|(i, force)| force.abs() / units[i % 4]).collect();
    let all = largest(&sizes);
    let of = |(i, size): (usize, &f64)| {
        weights[i - i % 4] * units[i % 4].powi(2) * (size / all).powf(1.5).max(BALANCED)
    };
    sizes.iter().enumerate().map(of).collect()
}

/// The largest size of a number.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}
