//! Equilibria of what nothing holds before its loads do, each relaxed from the one before.
//!
//! # Jumps
//! What comes to rest under each of the loads goes on beyond a load that its equilibrium cannot bear: it jumps to another one, as an
//! arch does that is pulled through by a string. That is told. Where the rates dx/dλ at two equilibria that follow each other do not lead
//! from the one to the other, the load between them is gone through in steps in which they do. Where none is short enough for that, the
//! structure jumps, or gives way to one of two sides.

use super::{Solution, Turned, is_slack, steps_between};
use crate::assembly::DiscretizedBeam;
use crate::model::Static;
use crate::numeric::GOLDEN;
use crate::solve::equilibrium::{Equilibrium, size};
use crate::solve::newton::{Iterations, Settings};
use crate::solve::path::NoStep;
use crate::solve::relax::relax;
use crate::solve::stability::{Stability, StabilityChange};
use crate::solve::statics::{Jump, Observer, UnstableMechanism};
use crate::solve::{Statistics, StepRecord, Work};
use crate::system::System;

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
/// Part of the first load at which what was slack has taken its shape.
const TAUT: f64 = 1e-3;
/// Smallest change that may be a jump: positions in beam lengths, gradients as they are.
const SMALLEST_JUMP: f64 = 1e-3;
/// Changes up to this are those of iterations that end before they are exact.
const SMALLEST_CHANGE: f64 = 1e-6;
/// Part of a change by which rates at both of its ends may miss it, …
const MISSED: f64 = 0.2;
/// … and by which they may differ from each other.
const TURNED: f64 = 1.0;
/// Changes by this part of the whole are no jumps …
const SMALL_PART: f64 = 0.05;
/// … and those by this part may be anything.
const NOTHING: f64 = 1e-3;
/// Two equilibria on either side of a third are so many times as far from each other as from this one.
const OTHER_SIDE: f64 = 1.5;
/// The first step is this part of the load between two equilibria, …
const FIRST_PART: f64 = 0.25;
/// … and the shortest one this; a change in proportion to the root of a load is small in it, but not nothing.
const SHORTEST_PART: f64 = 6e-5;
/// Most steps.
const STEPS: usize = 600;

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
            solution.pressed = unstable.filter(|unstable| *unstable > free).map(pressed);
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

/// How the structure jumps on its way from one equilibrium to the next, if it does; `None` also where that is not found. What was slack
/// takes its shape first.
fn jump(
    equilibrium: &mut Equilibrium<'_>,
    [(from, start), (to, end)]: [(f64, &[f64]); 2],
    newton: &Settings,
    goes_on: &mut dyn FnMut(&Statistics) -> bool,
) -> Option<Jump> {
    let mut rests = |equilibrium: &mut Equilibrium<'_>, (from, start): (f64, &[f64]), load| {
        let moved = moved(equilibrium, from, load, start);
        let mut x = start.to_vec();
        set_out(equilibrium, load, moved, &mut x);
        rest(equilibrium, load, x, newton, goes_on)
    };
    let mut low = (from, start.to_vec());
    if is_slack(equilibrium.system(), start) {
        let load = from + TAUT * (to - from);
        low = (load, rests(equilibrium, (from, start), load)?);
    }
    let system = equilibrium.system();
    let whole = changes(system, &low.1, end);
    let least = vec![SMALLEST_JUMP; whole.len()];
    if leads(equilibrium, [&low, &(to, end.to_vec())], changes, &least) {
        return None;
    }
    let of_beams = changes_of_beams(system, &low.1, end);
    let small =
        |changes: &[f64]| changes.iter().map(|c| SMALLEST_JUMP.max(SMALL_PART * c)).collect::<Vec<_>>();
    let least: Vec<f64> = of_beams.iter().map(|change| SMALLEST_CHANGE.max(NOTHING * change)).collect();
    let shortest = SHORTEST_PART * (to - low.0);
    let mut step = FIRST_PART * (to - low.0);
    let mut lost = None;
    for _ in 0..STEPS {
        let load = if low.0 + step < to { low.0 + step } else { to };
        let next = rests(equilibrium, (low.0, &low.1), load).map(|x| (load, x));
        let leaves =
            lost.is_none() && next.as_ref().is_some_and(|(load, x)| may_leave(equilibrium, *load, x));
        let leads = |next: &(f64, Vec<f64>)| leads(equilibrium, [&low, next], changes_of_beams, &least);
        let follows = !leaves && next.as_ref().is_some_and(leads);
        if !follows && step > shortest {
            step *= 0.5;
            continue;
        }
        let next = next?;
        let change = changes_of_beams(system, &low.1, &next.1);
        if !follows && !within(&change, &small(&of_beams)) {
            return Some(Jump::Between([low.0, next.0]));
        }
        if leaves {
            // What is exactly between two sides may stay there, though a push would decide.
            lost = Some(next.0);
        } else if !follows {
            // Beyond a bifurcation it gives way by the root of the load, and as far on the other side it would rest, too.
            let back: Vec<f64> = low.1.iter().zip(&next.1).map(|(low, next)| low - (next - low)).collect();
            let other = rests(equilibrium, (low.0, &back), next.0);
            let apart = other.map(|other| changes_of_beams(system, &other, &next.1));
            if apart.is_some_and(|apart| are_sides(&apart, &change, &least)) {
                return Some(Jump::Fork(next.0));
            }
        }
        if load == to {
            let same = |changes: fn(&System, &[f64], &[f64]) -> Vec<f64>, whole: &[f64]| {
                within(&changes(system, &next.1, end), &small(whole))
            };
            return match lost {
                Some(lost) if !same(changes_of_beams, &of_beams) => Some(Jump::Fork(lost)),
                // The end of a long way down may be another one, and a slack string without weight rests anywhere.
                _ => (!same(changes, &whole)).then_some(Jump::BesidePath(to)),
            };
        }
        (low, step) = (next, 2.0 * step);
    }
    None
}

/// Whether none of the `changes` is more than is `allowed` of it.
fn within(changes: &[f64], allowed: &[f64]) -> bool {
    changes.iter().zip(allowed).all(|(change, allowed)| change <= allowed)
}

/// Whether the beams of two states are so much farther apart than they have come in a step that the states are on either side of it.
fn are_sides(apart: &[f64], change: &[f64], least: &[f64]) -> bool {
    apart
        .iter()
        .zip(change)
        .zip(least)
        .any(|((apart, change), least)| *apart >= OTHER_SIDE * change.max(*least))
}

/// Whether the rates dx/dλ at two equilibria lead from the one to the other, as far as these `changes` tell, of which those up to the `least`
/// do not count.
fn leads(
    equilibrium: &mut Equilibrium<'_>,
    [low, high]: [&(f64, Vec<f64>); 2],
    changes: fn(&System, &[f64], &[f64]) -> Vec<f64>,
    least: &[f64],
) -> bool {
    let system = equilibrium.system();
    let whole = changes(system, &low.1, &high.1);
    if within(&whole, least) {
        return true;
    }
    let (Some(first), Some(second)) = (rate(equilibrium, low), rate(equilibrium, high)) else { return false };
    let half = 0.5 * (high.0 - low.0);
    let led: Vec<f64> = low
        .1
        .iter()
        .zip(&first)
        .zip(&second)
        .map(|((x, first), second)| x + half * (first + second))
        .collect();
    let turned: Vec<f64> = low
        .1
        .iter()
        .zip(&first)
        .zip(&second)
        .map(|((x, first), second)| x + 2.0 * half * (second - first))
        .collect();
    let (missed, turned) = (changes(system, &led, &high.1), changes(system, &turned, &low.1));
    let part = |part: f64| whole.iter().zip(least).map(|(c, least)| least.max(part * c)).collect::<Vec<_>>();
    // Where the path bends between them, the mean of both rates may lead there by chance.
    within(&missed, &part(MISSED)) && within(&turned, &part(TURNED))
}

/// dx/dλ in an equilibrium, where the tangent tells.
fn rate(equilibrium: &mut Equilibrium<'_>, (load, x): &(f64, Vec<f64>)) -> Option<Vec<f64>> {
    let (mut residual, mut rate) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    equilibrium.linearize(*load, x, None, &mut residual, &mut rate).ok()?;
    equilibrium.solve(*load, &mut rate, true);
    rate.iter().all(|rate| rate.is_finite()).then_some(rate)
}

/// The largest change of a node of all beams, strings among them, from one state to another (positions in beam lengths, gradients as they
/// are), and [`changes_of_beams`].
fn changes(system: &System, a: &[f64], b: &[f64]) -> Vec<f64> {
    std::iter::once(change(system, a, b)).chain(changes_of_beams(system, a, b)).collect()
}

fn change(system: &System, a: &[f64], b: &[f64]) -> f64 {
    let apart: Vec<f64> = a[..system.coordinates()].iter().zip(b).map(|(a, b)| a - b).collect();
    size(system, &apart)
}

/// The largest change of a gradient, and that of a position in beam lengths, of each beam that has a bending stiffness. What a small one does is not
/// lost beside what others do, nor how it bends beside how far supports move it; and slack strings, which fold and unfold from one element
/// to the next, do not count: the beams that they hang on hardly feel that.
fn changes_of_beams(system: &System, a: &[f64], b: &[f64]) -> Vec<f64> {
    let of = |beam: &DiscretizedBeam| {
        let at = 4 * beam.first_node..4 * (beam.first_node + beam.basis.nodes().len());
        let pairs = a[at.clone()].as_chunks().0.iter().zip(b[at].as_chunks().0);
        pairs.fold([0.0_f64; 2], |[turn, shift], ([x, y, u, v], [p, q, r, w]): (&[f64; 4], &[f64; 4])| {
            [turn.max((u - r).hypot(v - w)), shift.max((x - p).hypot(y - q) / beam.basis.length())]
        })
    };
    system.bending_beams().flat_map(of).collect()
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
