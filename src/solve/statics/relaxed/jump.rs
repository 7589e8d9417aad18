//! Jumps and forks of what comes to rest under each of its loads.
//!
//! It goes on beyond a load that its equilibrium cannot bear: it jumps to another one, as an arch does that is pulled through by a string. That is
//! told. Where the rates dx/dλ at two equilibria that follow each other do not lead from the one to the other, the load between them is gone
//! through in steps in which they do. Where none is short enough for that, the structure jumps, or gives way to one of two sides.

use super::{may_leave, moved, rest, set_out};
use crate::assembly::DiscretizedBeam;
use crate::solve::Statistics;
use crate::solve::equilibrium::{Equilibrium, size};
use crate::solve::newton::Settings;
use crate::solve::statics::{Jump, is_slack};
use crate::system::System;

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

/// How the structure jumps on its way from one equilibrium to the next, if it does; `None` also where that is not found. What was slack
/// takes its shape first.
pub(super) fn jump(
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
        let follows = !leaves
            && next.as_ref().is_some_and(|next| leads(equilibrium, [&low, next], changes_of_beams, &least));
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
    let moved_by = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        let rates = first.iter().zip(&second).map(|(first, second)| of(*first, *second));
        low.1.iter().zip(rates).map(|(x, rate)| x + (high.0 - low.0) * rate).collect()
    };
    let led = moved_by(&|first, second| 0.5 * (first + second));
    let turned = moved_by(&|first, second| second - first);
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

pub(super) fn change(system: &System, a: &[f64], b: &[f64]) -> f64 {
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
