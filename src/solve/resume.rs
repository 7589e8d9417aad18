//! Statics that starts from a state which another analysis has left.

use super::equilibrium::Equilibrium;
use super::newton::RESIDUAL_TOLERANCE;
use crate::assembly::{Earlier, InternalVariables};
use crate::system::System;

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

/// Lets an analysis of `system` begin in the state `q` with the internal `variables`. Multipliers,
/// which no state knows, are those that balance as much as they can; what remains unbalanced fades
/// as the load factor grows.
///
/// What has gone, a support or a joint, acted on few coordinates. Multipliers that make the sum of
/// squares r·D⁻¹r of the unbalanced forces least would take a part of it over, all along a beam that
/// keeps its length. D is therefore made smaller where little is unbalanced, in proportion to
/// |r|^(3/2), so that the sum of √|r| becomes least and the forces gather on few coordinates
/// (iteratively reweighted least squares; Chartrand & Yin, *Proc. ICASSP* 2008, 3869–3872).
pub fn resume(system: &mut System, q: &[f64], variables: &InternalVariables) {
    system.begin_in(q, variables);
    let (x, residual) = {
        let mut equilibrium = Equilibrium::new(system);
        let mut x = equilibrium.start();
        let (n, length, weights) = (q.len(), system.length(), system.weights());
        let (mut increment, still) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        for _ in 0..if x.len() > n { ROUNDS } else { 0 } {
            let earlier = Earlier { q, increment: &still };
            let shift = (SHIFT, &weights[..]);
            // Rows that contradict each other are left to the path, which tells of them.
            if equilibrium.linearize_shifted(0.0, &x, earlier, shift, &mut increment).is_err() {
                break;
            }
            equilibrium.solve(0.0, &mut increment, false);
            x[n..].iter_mut().zip(&increment[n..]).for_each(|(x, change)| *x += change);
        }
        let mut residual = equilibrium.residual(0.0, &x, &mut increment);
        for _ in 0..if x.len() > n { GATHERINGS } else { 0 } {
            if residual <= RESIDUAL_TOLERANCE {
                break;
            }
            // The unit of a force on a gradient is that of a force over the length of the structure.
            let units = [1.0, 1.0, length, length];
            let size = |i: usize| increment[i].abs() / units[i % 4];
            let largest = (0..n).map(size).fold(0.0, f64::max);
            let gathered: Vec<f64> = (0..n)
                .map(|i| {
                    weights[i - i % 4] * units[i % 4].powi(2) * (size(i) / largest).powf(1.5).max(BALANCED)
                })
                .collect();
            let earlier = Earlier { q, increment: &still };
            let shift = (SHIFT / BALANCED, &gathered[..]);
            if equilibrium.linearize_shifted(0.0, &x, earlier, shift, &mut increment).is_err() {
                break;
            }
            equilibrium.solve(0.0, &mut increment, false);
            let size =
                |values: &[f64]| values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            let changes = size(&increment[n..]) > GATHERED * size(&x[n..]);
            x[n..].iter_mut().zip(&increment[n..]).for_each(|(x, change)| *x += change);
            residual = equilibrium.residual(0.0, &x, &mut increment);
            if !changes {
                break;
            }
        }
        (x, residual)
    };
    let unbalanced = (residual > RESIDUAL_TOLERANCE).then(|| system.unbalanced(&x, variables));
    system.leave_unbalanced(&x[q.len()..], unbalanced.as_deref());
}
