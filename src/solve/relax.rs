//! Equilibria of structures that have no stiffness before they are loaded: strings and cables, and
//! beams that hang on hinges.
//!
//! A slack string or a pendulum under ever so small a load takes a shape far from its stress-free
//! one, so that no path of load steps leads there. The equilibrium is found as the end of a
//! creeping motion, σ D ẋ = −R(x), by implicit Euler steps (pseudo-transient continuation; Kelley &
//! Keyes, *SIAM J. Numer. Anal.* 35, 1998, 508–523):
//!
//! ```text
//! (K(x) + σ D) δ = −R(x),   σ ← σ |δ|/δ_wanted
//! ```
//!
//! With falling increments σ vanishes and the iteration becomes Newton's. D weighs a node by its
//! share w of the length, EA/L² (w, w³/10) for position and gradient, as a beam's mass matrix does;
//! the first σ lets the load move it by some beam lengths. The axial force in K is extrapolated
//! from the iterate before ([`crate::effect`]). Otherwise the iterations of a slack cable would
//! grow with its EA: to 450, in place of 17, where EA is 10,000 times the weight.
//!
//! A structure that is stiff comes to rest so where it begins in another shape than a stress-free one. An
//! arch may then rest on either side, and rests on the one to which the creeping motion leads: its steps
//! are short enough to follow that.

use super::equilibrium::Equilibrium;
use super::newton::{self, Failure, Iterations, ROUND_OFF, Settings};
use crate::assembly::{Earlier, Kind};
use crate::solve::Statistics;
use crate::system::System;

/// How fast a structure creeps.
struct Pace {
    /// Largest change of an iterate: positions in beam lengths, gradients as they are.
    largest: f64,
    /// Change of an iterate that is aimed at.
    wanted: f64,
}

/// Of what has no stiffness before it is loaded, which has far to go.
const FLOPPY: Pace = Pace { largest: 0.3, wanted: 0.1 };
/// Of what is stiff, and may rest in several places near to each other.
const STIFF: Pace = Pace { largest: 0.03, wanted: 0.01 };
/// The first σ grows at most by this factor until it makes the first change small enough. Gaps of
/// constraints are closed whatever it is.
const SLOWER: f64 = 1e6;
/// Smallest clear part of a change that is still taken, where the whole would lead through an
/// obstacle.
const SHORTEST: f64 = 1e-3;
/// σ changes at most by these factors in an iteration.
const LIMITS: (f64, f64) = (0.3, 4.0);
/// σ below which the iteration is Newton's.
const NONE: f64 = 1e-14;
/// Part of the first σ below which increments measure the distance from the equilibrium.
const SETTLED: f64 = 1e-3;
/// Gaps of constraints below this part of the stiffness are closed.
const CLOSED: f64 = 1e-13;
/// Forces out of balance by more than this part of the loads are no round-off, whatever the stiffness is.
const BALANCED: f64 = 0.1;
/// Most iterations.
const ITERATIONS: usize = 2000;

/// Relaxes `x` to an equilibrium at load factor `load`: a minimum of the energy, or an unstable
/// equilibrium in which it begins. K + σ D is kept definite, so that every increment leads
/// downhill. `goes_on` is called with the counts after every iteration and ends the search by
/// returning false.
///
/// Where loads have no potential, what has no stiffness before it is loaded is followed by the sign of
/// the determinant first, which does not see two directions that lose their stiffness. If some have in
/// the end, the motion is followed again by all directions of the symmetric part. Whether that, where it
/// was needed, came to rest is returned: otherwise the equilibrium may be unstable.
///
/// # Errors
/// [`Failure`] where it does not come to rest, or is ended before.
pub fn relax(
    equilibrium: &mut Equilibrium<'_>,
    load: f64,
    x: &mut [f64],
    settings: &Settings,
    record: &mut Iterations,
    goes_on: &mut dyn FnMut(&Statistics) -> bool,
) -> Result<bool, Failure> {
    let (start, floppy) = (x.to_vec(), equilibrium.system().is_floppy());
    let before = equilibrium.accepted().clone();
    creep(equilibrium, load, x, settings, record, goes_on, !floppy)?;
    if !floppy || equilibrium.is_symmetric() || equilibrium.directions_at(load, x) == Some(0) {
        return Ok(true);
    }
    let (after, mut other) = (equilibrium.accepted().clone(), start);
    equilibrium.restore(before);
    match creep(equilibrium, load, &mut other, settings, record, goes_on, true) {
        Ok(()) => x.copy_from_slice(&other),
        Err(Failure::Stopped) => return Err(Failure::Stopped),
        Err(_) => {
            equilibrium.restore(after);
            return Ok(false);
        }
    }
    Ok(true)
}

/// [`relax`], by the sign of the determinant of a tangent without symmetry, or by the directions of its
/// symmetric part.
fn creep(
    equilibrium: &mut Equilibrium<'_>,
    load: f64,
    x: &mut [f64],
    settings: &Settings,
    record: &mut Iterations,
    goes_on: &mut dyn FnMut(&Statistics) -> bool,
    by_directions: bool,
) -> Result<(), Failure> {
    let n = equilibrium.system().coordinates();
    let mut increment = vec![0.0; x.len()];
    // Where supports move together, the whole structure moves with them: moving the supports alone
    // would fold back the adjacent cells, and nothing would unfold these.
    let shared = equilibrium.system().shared_move(load, &x[..n]);
    for node in x[..n].chunks_exact_mut(4) {
        node[0] += shared[0];
        node[1] += shared[1];
    }
    equilibrium.system().supports().impose(load, &mut x[..n]);
    let weights = equilibrium.system().weights();
    let loads = loads(equilibrium.system(), load, &x[..n]);
    let floppy = equilibrium.system().is_floppy();
    let pace = if floppy { FLOPPY } else { STIFF };
    let (mut sigma, mut first, mut on_a_crest, mut closes) = (0.0, 0.0, false, false);
    let (mut size, mut before, mut change) = (f64::INFINITY, x.to_vec(), vec![0.0; x.len()]);
    for _ in 0..ITERATIONS {
        let residual = equilibrium.residual(load, x, &mut increment);
        if !residual.is_finite() {
            return Err(Failure::NotFinite);
        }
        if sigma == 0.0 || closes {
            let (system, (forces, gaps)) = (equilibrium.system(), increment.split_at(n));
            let unbalanced = system.norm(forces);
            // Without unbalanced forces `x` is an equilibrium already, and the tangent may be
            // singular.
            // Of what is stiff against bending alone, axial forces are known better than that.
            let hidden = loads <= system.stress_round_off();
            let balanced = if hidden { f64::INFINITY } else { BALANCED * loads };
            let round_off = system.round_off().min(balanced);
            let closed = if closes { round_off.max(CLOSED * system.stiffness()) } else { round_off };
            if unbalanced <= closed && gaps.iter().all(|gap| gap.abs() <= closed) {
                return Ok(());
            }
            if sigma == 0.0 {
                // Gaps of constraints where nothing acts are closed by the smallest change, at any pace.
                closes = unbalanced <= round_off;
                sigma = if closes { 1.0 } else { unbalanced / system.stiffness() };
                first = sigma;
            }
        }
        let shift = if sigma < NONE { 0.0 } else { sigma };
        let earlier = Earlier { q: &before, increment: &change };
        match equilibrium.linearize_shifted(load, x, earlier, (shift, &weights), &mut increment) {
            Ok(()) if is_soft(equilibrium, by_directions) => {
                sigma = sigma.max(NONE) * LIMITS.1;
                on_a_crest = true;
                continue;
            }
            Ok(()) => {}
            Err(singular) if shift == 0.0 => return Err(singular.into()),
            Err(_) => {
                sigma *= LIMITS.1;
                continue;
            }
        }
        equilibrium.solve(load, &mut increment, false);
        equilibrium.statistics.newton_iterations += 1;
        let found = equilibrium.size(&increment);
        if !floppy && found > pace.largest && sigma < SLOWER * first {
            sigma *= LIMITS.1;
            continue;
        }
        let last = std::mem::replace(&mut size, found);
        record.residuals.push(residual);
        record.increments.push(size);
        sigma *= (size / pace.wanted).clamp(LIMITS.0, LIMITS.1);
        before.copy_from_slice(x);
        let mut part = if size > pace.largest { pace.largest / size } else { 1.0 };
        if equilibrium.system().has_contacts() {
            part *= clear(equilibrium.system(), &x[..n], &increment, part)?;
        }
        change.iter_mut().zip(&increment).for_each(|(change, d)| *change = part * d);
        x.iter_mut().zip(&change).for_each(|(x, d)| *x += d);
        // A beam that nothing resists along its axis could be pressed through a point; strings may shrink on their way.
        if !equilibrium.system().has_strings() {
            newton::not_crushed_since(&before[..n], &x[..n])?;
        }
        equilibrium.follow_windings(x);
        // On an unstable equilibrium σ stays large enough to outweigh the unstable directions.
        let settled = sigma < SETTLED * first || on_a_crest;
        on_a_crest = false;
        // Increments of Newton's method that no longer shrink are round-off.
        let stalled = shift == 0.0 && size <= ROUND_OFF && size >= last;
        if (size <= settings.tolerance || stalled) && settled && residual <= settings.residual_tolerance {
            return Ok(());
        }
        if !goes_on(&equilibrium.statistics) {
            return Err(Failure::Stopped);
        }
    }
    Err(Failure::TooSlow { iterations: ITERATIONS, last: size })
}

/// The size of the loads \[N\] at a load factor in a state, and of the forces of springs and obstacles; infinite where there are none, but
/// for moving supports.
fn loads(system: &System, load: f64, q: &[f64]) -> f64 {
    let mut forces = vec![0.0; q.len()];
    system.add_load_rate(1.0, load, q, &mut forces);
    let size = load * system.norm(&forces)
        + system.internal_force(q, |kind| matches!(kind, Kind::Spring | Kind::Contact));
    if size > 0.0 { size } else { f64::INFINITY }
}

/// Whether a direction lacks stiffness. Where follower loads are part of the equations, the sign of the
/// determinant does not see two such directions, and a structure would creep uphill.
fn is_soft(equilibrium: &Equilibrium<'_>, by_directions: bool) -> bool {
    let soft = if by_directions { equilibrium.stability_and_softness().1 } else { None };
    soft.map_or_else(|| equilibrium.is_unstable(), |directions| directions > 0)
}

/// The part of the straight path from `q`, along `part` of an increment, that is clear of
/// obstacles.
fn clear(system: &System, q: &[f64], increment: &[f64], part: f64) -> Result<f64, Failure> {
    let moved = |part: f64| -> Vec<f64> { q.iter().zip(increment).map(|(q, d)| q + part * d).collect() };
    let (first, second, end) = (moved(part / 3.0), moved(part / 1.5), moved(part));
    match system.conflict([q, &first, &second, &end], false) {
        Some((part, contact)) if part < SHORTEST => Err(Failure::Crossed { contact, part }),
        Some((part, _)) => Ok(part),
        None => Ok(1.0),
    }
}
