//! Equilibria of what has no stiffness before it is loaded: strings and cables.
//!
//! A slack string under ever so small a load takes a shape far from its stress-free one, so that no path of load steps leads there. It is found as the
//! rest of a creeping motion, σ D ẋ = −R(x), by implicit Euler steps (pseudo-transient continuation; Kelley & Keyes, *SIAM J. Numer. Anal.* 35, 1998,
//! 508–523):
//!
//! ```text
//! (K(x) + σ D) δ = −R(x),   σ ← σ |δ|/δ_wanted
//! ```
//!
//! With falling increments σ vanishes and the iteration becomes Newton's. D weighs a node by its share w of the length, EA/L² (w, w³/10) for position and gradient,
//! as a beam's mass matrix does; the first σ lets the load move it by some beam lengths. The axial force in K is extrapolated from the iterate before
//! ([`crate::effect`]). A slack cable of 24 elements whose EA is 100 to 10,000 times its weight takes 17 iterations; without the extrapolation they
//! grow from 18 to 450, and with EA of 100,000 times the weight they are 600 anyway.

use super::equilibrium::Equilibrium;
use super::newton::{Failure, Iterations, Settings};
use crate::effect::Earlier;

/// Largest change of an iterate: positions in beam lengths, gradients as they are.
const LARGEST: f64 = 0.3;
/// σ changes at most by these factors in an iteration.
const LIMITS: (f64, f64) = (0.3, 4.0);
/// Change of an iterate that is aimed at.
const WANTED: f64 = 0.1;
/// σ below which the iteration is Newton's.
const NONE: f64 = 1e-14;
/// Part of the first σ below which increments tell how far the equilibrium is.
const SETTLED: f64 = 1e-3;
/// Most iterations.
const ITERATIONS: usize = 2000;

/// Relaxes `x` to the equilibrium at load factor `load`.
///
/// # Errors
/// [`Failure`] where it does not come to rest.
pub fn relax(
    equilibrium: &mut Equilibrium<'_>,
    load: f64,
    x: &mut [f64],
    settings: &Settings,
    record: &mut Iterations,
) -> Result<(), Failure> {
    let n = equilibrium.system().coordinates();
    let mut increment = vec![0.0; x.len()];
    equilibrium.system().supports().impose(load, &mut x[..n]);
    let weights = equilibrium.system().weights();
    let (mut sigma, mut first) = (0.0, 0.0);
    let (mut size, mut before, mut change) = (f64::INFINITY, x.to_vec(), vec![0.0; x.len()]);
    for _ in 0..ITERATIONS {
        let residual = equilibrium.residual(load, x, &mut increment);
        if !residual.is_finite() {
            return Err(Failure::NotFinite);
        }
        if sigma == 0.0 {
            let (system, (forces, gaps)) = (equilibrium.system(), increment.split_at(n));
            let unbalanced = system.norm(forces);
            // Where nothing acts there is nowhere to go, and no stiffness that would say so.
            let round_off = system.round_off();
            if unbalanced <= round_off && gaps.iter().all(|gap| gap.abs() <= round_off) {
                return Ok(());
            }
            sigma = unbalanced / system.stiffness();
            first = sigma;
        }
        let shift = if sigma < NONE { 0.0 } else { sigma };
        let earlier = Earlier { q: &before, increment: &change };
        match equilibrium.linearize_shifted(load, x, earlier, (shift, &weights), &mut increment) {
            Ok(()) => {}
            Err(singular) if shift == 0.0 => return Err(singular.into()),
            Err(_) => {
                sigma *= LIMITS.1;
                continue;
            }
        }
        equilibrium.solve(load, &mut increment, false);
        equilibrium.statistics.newton_iterations += 1;
        size = equilibrium.size(&increment);
        record.residuals.push(residual);
        record.increments.push(size);
        sigma *= (size / WANTED).clamp(LIMITS.0, LIMITS.1);
        before.copy_from_slice(x);
        let part = if size > LARGEST { LARGEST / size } else { 1.0 };
        change.iter_mut().zip(&increment).for_each(|(change, d)| *change = part * d);
        x.iter_mut().zip(&change).for_each(|(x, d)| *x += d);
        if size <= settings.tolerance && sigma < SETTLED * first && residual <= settings.residual_tolerance {
            return Ok(());
        }
    }
    Err(Failure::TooSlow { iterations: ITERATIONS, last: size })
}
