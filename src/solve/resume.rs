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

/// Lets an analysis of `system` begin in the state `q` with the internal `variables`. Multipliers,
/// which no state knows, are those that balance as much as they can; what remains unbalanced fades
/// as the load factor grows.
pub fn resume(system: &mut System, q: &[f64], variables: &InternalVariables) {
    system.begin_in(q, variables);
    let (x, residual) = {
        let mut equilibrium = Equilibrium::new(system);
        let mut x = equilibrium.start();
        let (n, weights) = (q.len(), system.weights());
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
        let residual = equilibrium.residual(0.0, &x, &mut increment);
        (x, residual)
    };
    let unbalanced = (residual > RESIDUAL_TOLERANCE).then(|| system.unbalanced(&x, variables));
    system.leave_unbalanced(&x[q.len()..], unbalanced.as_deref());
}
