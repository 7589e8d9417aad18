//! Equilibria of what nothing holds before its loads do, each relaxed from the one before.

mod jump;

use super::{Solution, Turned, steps_between};
use crate::model::Static;
use crate::numeric::GOLDEN;
use crate::solve::equilibrium::Equilibrium;
use crate::solve::newton::{Iterations, Settings};
use crate::solve::path::NoStep;
use crate::solve::relax::relax;
use crate::solve::stability::{Stability, StabilityChange};
use crate::solve::statics::{Observer, UnstableMechanism};
use crate::solve::{Statistics, StepRecord, Work};
use jump::{change, jump};

/// Largest perturbation that pushes a structure off an unstable equilibrium: positions in beam
/// lengths, gradients as they are.
const PUSH: f64 = 1e-3;
/// Largest turn of a support in a step, so that the structure follows to the side of the turn \[rad\].
const LARGEST_TURN: f64 = 0.5;
/// Two equilibria that differ by less are the same: positions in beam lengths, gradients as they
/// are.
const SAME_SIDE: f64 = 1e-5;
/// Inverse iterations after which the softest motion stands out.
const INVERSE_ITERATIONS: usize = 4;

/// The equilibria at the parts of the load, each relaxed from the one before.
pub(super) fn relaxed(
    equilibrium: &mut Equilibrium<'_>,
    mut x: Vec<f64>,
    settings: &Static,
    newton: Settings,
    solution: &mut Solution,
    observe: Observer<'_>,
) -> Result<(), NoStep> {
    let mut work = Work::default();
    let mut turned = Turned::new(settings);
    solution.record(equilibrium, 0.0, &x, work, &mut turned);
    let recorded = settings.steps.unwrap_or(1).max(1);
    let between = steps_between(equilibrium.system(), settings, recorded, LARGEST_TURN);
    let parts = recorded.saturating_mul(between);
    let mut before = Stability::Directions(0);
    for part in 1..=parts {
        let load = part as f64 / parts as f64;
        let step = 1.0 / parts as f64;
        let mut stopped = false;
        let goes_on = &mut |counts: &Statistics| {
            stopped = stopped || !observe(load - step, step, counts);
            !stopped
        };
        let moved = moved(equilibrium, load - step, load, &x);
        if let (None, Some(free)) = (solution.pressed, equilibrium.system().free_motions()) {
            let pressed = |unstable| UnstableMechanism { load, unstable, free };
            let unstable = moved.as_ref().and_then(|x| equilibrium.directions_at(load, x));
            // Where drag or follower forces act, the tangent has no symmetry: directions may lose stiffness and yet nothing buckles.
            let tells = equilibrium.is_symmetric();
            solution.pressed = unstable.filter(|unstable| tells && *unstable > free).map(pressed);
        }
        let start = x.clone();
        set_out(equilibrium, load, moved, &mut x);
        let mut record = Iterations::default();
        let mut outcome = relax(equilibrium, load, &mut x, &newton, &mut record, goes_on);
        if outcome.is_ok() && may_leave(equilibrium, load, &x) {
            // An unstable equilibrium, such as a pendulum that stands on its head: both sides are
            // tried.
            let mut other = x.clone();
            push(equilibrium, -1.0, &mut other);
            let other = rest(equilibrium, load, other, &newton, goes_on);
            push(equilibrium, 1.0, &mut x);
            outcome = relax(equilibrium, load, &mut x, &newton, &mut record, goes_on);
            if outcome.is_ok() && other.is_some_and(|other| differ(equilibrium, &x, &other)) {
                solution.crest.get_or_insert(load);
            }
            if let (Ok(_), Some(after)) = (&outcome, stability(equilibrium, load, &x))
                && before.is_lost(after)
            {
                solution.events.push(StabilityChange { load, resolution: step, before, after });
                before = after;
            }
        }
        solution.history.push(StepRecord {
            parameter: load,
            step,
            accepted: outcome.is_ok(),
            increments: record.increments,
            residuals: record.residuals,
        });
        let sure = outcome.map_err(|failure| {
            let at = equilibrium.system().place_of(failure.unknown().unwrap_or(0));
            NoStep { load: load - step, step, failure, at }
        })?;
        if !sure {
            solution.softened.get_or_insert(load);
        }
        let bends = equilibrium.system().bending_beams().next().is_some();
        if bends && solution.jump.is_none() && solution.crest.is_none() {
            solution.jump = jump(equilibrium, [(load - step, &start), (load, &x)], &newton, goes_on);
        }
        equilibrium.statistics.load_steps += 1;
        work.add_states(equilibrium.system(), (load - step, &start), (load, &x));
        turned.add_step(equilibrium.system(), (load - step, &start), (load, &x));
        if part.is_multiple_of(between) {
            solution.record(equilibrium, load, &x, work, &mut turned);
        }
        equilibrium.set_accepted(&x);
        if stopped || !observe(load, step, &equilibrium.statistics) {
            break;
        }
    }
    Ok(())
}

/// Where a state goes as supports move from where they are at one load factor to where they are at another; `None` where that is not
/// known.
fn moved(equilibrium: &mut Equilibrium<'_>, from: f64, load: f64, x: &[f64]) -> Option<Vec<f64>> {
    if equilibrium.system().supports().moves() {
        equilibrium.moved_with_supports(from, load, x)
    } else {
        Some(x.to_vec())
    }
}

/// Moves `x` to where it sets out to the equilibrium at the load factor `load`.
fn set_out(equilibrium: &Equilibrium<'_>, load: f64, moved: Option<Vec<f64>>, x: &mut Vec<f64>) {
    // Between supports that come together or part, all cells share the change of their distance: left to
    // the cells beside the supports, it would fold these back.
    if equilibrium.system().shared_move(load, x) == [0.0; 2]
        && let Some(moved) = moved
    {
        *x = moved;
    }
}

/// Looks at the state `x`; whether its tangent could be factorised.
pub(super) fn look(equilibrium: &mut Equilibrium<'_>, load: f64, x: &[f64]) -> bool {
    let (mut residual, mut rate) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    equilibrium.linearize(load, x, None, &mut residual, &mut rate).is_ok()
}

/// Stability in the state `x`, where the factorisation tells.
fn stability(equilibrium: &mut Equilibrium<'_>, load: f64, x: &[f64]) -> Option<Stability> {
    look(equilibrium, load, x).then(|| equilibrium.stability()).flatten()
}

/// Whether the state `x` is known to be unstable, or, where loads have no potential, directions lack
/// stiffness in it.
fn may_leave(equilibrium: &mut Equilibrium<'_>, load: f64, x: &[f64]) -> bool {
    look(equilibrium, load, x)
        && match equilibrium.stability_and_softness() {
            (_, Some(soft)) => soft > 0,
            _ => equilibrium.is_unstable() && !is_stiff_without_matrix(equilibrium, load, x),
        }
}

/// Whether the softest motion at the last linearised state, the only one that its matrix calls unstable, is stable by products
/// with the tangent that are evaluated without a matrix: its entries have then lost what resists this motion, as those of a stiff
/// bar on many elements that hangs.
fn is_stiff_without_matrix(equilibrium: &Equilibrium<'_>, load: f64, x: &[f64]) -> bool {
    let system = equilibrium.system();
    // The products leave out the full turns of torsion springs.
    let applies = equilibrium.is_symmetric() && !system.has_windings();
    if !applies || equilibrium.unstable_directions() != Some(1) {
        return false;
    }
    let (q, multipliers) = x.split_at(system.coordinates());
    let weights = system.weights();
    let mut v = vec![0.0; x.len()];
    push(equilibrium, 1.0, &mut v);
    // The inverse of the matrix leaves the motion with the least stiffness, whatever its sign.
    let mut by_matrix = 0.0;
    for _ in 0..INVERSE_ITERATIONS {
        let size = v.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
        v.iter_mut().zip(&weights).for_each(|(v, weight)| *v *= weight / size);
        v[q.len()..].fill(0.0);
        system.supports().to_frames(load, &mut v[..q.len()]);
        v.iter_mut().zip(system.fixed()).filter(|(_, fixed)| **fixed).for_each(|(v, _)| *v = 0.0);
        let mut force = v[..q.len()].to_vec();
        system.supports().from_frames(load, &mut force);
        equilibrium.solve(load, &mut v, false);
        by_matrix = v.iter().zip(&force).map(|(v, f)| v * f).sum();
    }
    let (v, mut force) = (&v[..q.len()], vec![0.0; q.len()]);
    system.tangent_product(load, q, v, &mut force);
    system.add_constraint_stiffness_product(q, multipliers, v, &mut force);
    let stiffness: f64 = v.iter().zip(&force).map(|(v, f)| v * f).sum();
    by_matrix < 0.0 && stiffness > 0.0
}

/// The equilibrium to which `x` relaxes; `None` where it does not come to rest. Nothing is accepted.
fn rest(
    equilibrium: &mut Equilibrium<'_>,
    load: f64,
    mut x: Vec<f64>,
    newton: &Settings,
    goes_on: &mut dyn FnMut(&Statistics) -> bool,
) -> Option<Vec<f64>> {
    let rests = equilibrium.without_trace(|equilibrium| {
        relax(equilibrium, load, &mut x, newton, &mut Iterations::default(), goes_on).is_ok()
    });
    rests.then_some(x)
}

/// Whether two equilibria are not the same.
fn differ(equilibrium: &Equilibrium<'_>, a: &[f64], b: &[f64]) -> bool {
    change(equilibrium.system(), a, b) > SAME_SIDE
}

/// Perturbs every free coordinate a little and unevenly, in the same way in every run, to one side
/// or the other.
fn push(equilibrium: &Equilibrium<'_>, side: f64, x: &mut [f64]) {
    let system = equilibrium.system();
    let mut push: Vec<f64> = (1..=system.coordinates())
        .map(|i| {
            let unit = if i % 4 == 1 || i % 4 == 2 { system.length() } else { 1.0 };
            side * PUSH * unit * ((i as f64 * GOLDEN).fract() - 0.4)
        })
        .collect();
    system.supports().to_frames(0.0, &mut push);
    system.supports().from_frames(0.0, &mut push);
    x.iter_mut().zip(&push).for_each(|(x, push)| *x += push);
}
