//! Shapes, with section forces, at any load factor or time of a run that has kept its states.

use super::sampler::Sampler;
use super::{Options, RunError, needs, start};
use crate::assembly::Actions;
use crate::basis::BasisCache;
use crate::model::{Analysis, Model};
use crate::results::{RecordedState, Shape, Trajectory};
use crate::solve::dynamics::RecordedForces;
use crate::solve::dynamics::motion::Motion;
use crate::system::System;

/// Distance of a parameter from a record, relative to the last one, that is round-off.
const SAME: f64 = 1e-12;
/// What to try where a run has kept no states.
const KEEP_STATES: &str = "keep the states of the run (`Options::states`), of statics or of a motion";

/// All beams at a load factor or time \[s\] between the first record and the last: those of the
/// record there, or between two records their mean, weighted by the distance. Points where a force
/// or a couple acts are there twice, as in [`Trajectory::last`].
///
/// `model` and `analysis` are those that were solved.
///
/// # Errors
/// [`RunError::NoShape`] where the run has kept no states, or reaches no such parameter.
pub fn shapes_at(
    model: &Model,
    analysis: &Analysis,
    trajectory: &Trajectory,
    parameter: f64,
    cache: Option<&BasisCache>,
) -> Result<Vec<Shape>, RunError> {
    let no_shape = |reason: &str, advice| RunError::NoShape { reason: reason.to_owned(), advice };
    let Some(kept) = &trajectory.states else {
        return Err(no_shape("the states of this run were not kept", KEEP_STATES));
    };
    let known = &trajectory.parameter;
    let (Some(&first), Some(&last)) = (known.first(), known.last()) else {
        return Err(no_shape("the run has no record", KEEP_STATES));
    };
    let slack = SAME * last.abs();
    let rises = known.windows(2).all(|pair| pair[1] >= pair[0]);
    let (low, high) = known.iter().fold((first, first), |(l, h), p| (l.min(*p), h.max(*p)));
    if !(parameter >= low - slack && parameter <= high + slack) {
        let reason = format!("there is no record at {parameter}: the run reaches from {low} to {high}");
        return Err(no_shape(&reason, "ask for a load factor or time in between"));
    }
    // A path may turn back: the first time that it passes counts.
    let after = match rises {
        true => known.partition_point(|p| *p < parameter - slack),
        false => {
            let passes = |pair: &[f64]| (pair[0] - parameter) * (pair[1] - parameter) <= 0.0;
            known.windows(2).position(passes).map_or(0, |before| before + 1)
        }
    };
    let after = after.min(known.len() - 1);
    let before = after.saturating_sub(1);

    let (model, system) = match &kept.taken_up {
        Some(taken_up) => (&*taken_up.model, start::again(taken_up, analysis, cache)?),
        None => (model, System::build_with(model, needs(analysis), cache)?),
    };
    let sampler = Sampler::new(model, &system, Options::default().detail())?;
    let of = |record: usize| {
        let none = || no_shape("the state of this record was not kept", KEEP_STATES);
        let state = kept.states.get(record).ok_or_else(none)?;
        let unbalanced = || no_shape("the forces of this record are unknown", "ask for another one");
        acting(&system, known[record], state).ok_or_else(unbalanced)
    };
    // Where the parameter is that of a record, the other one does not matter.
    for record in [after, before] {
        if (known[record] - parameter).abs() <= slack {
            let (q, actions) = of(record)?;
            return Ok(sampler.loaded(&q, &actions));
        }
    }
    let share = (parameter - known[before]) / (known[after] - known[before]);
    let [(q, actions), (next_q, next_actions)] = [of(before)?, of(after)?];
    let jumps = |beam: usize, length: f64| {
        let mut jumps = actions[beam].jumps(length);
        jumps.extend(next_actions[beam].jumps(length));
        jumps.sort_by(f64::total_cmp);
        jumps.dedup_by(|a, b| (*a - *b).abs() <= SAME * length);
        jumps
    };
    let mut shapes = sampler.loaded_with(&q, &actions, &jumps);
    for (shape, next) in shapes.iter_mut().zip(sampler.loaded_with(&next_q, &next_actions, &jumps)) {
        blend(shape, &next, share);
    }
    Ok(shapes)
}

/// The coordinates of a recorded state, and what acts on each beam in it.
pub(super) fn acting(
    system: &System,
    parameter: f64,
    state: &RecordedState,
) -> Option<(Vec<f64>, Vec<Actions>)> {
    match state {
        RecordedState::Equilibrium { x, variables } => {
            let actions = system.static_actions(parameter, x, variables);
            Some((x[..system.coordinates()].to_vec(), actions))
        }
        RecordedState::Moving { state, forces } => {
            let motion = || {
                let mut motion = Motion::new(system).ok()?;
                motion.set_accepted(state);
                Some(motion)
            };
            let actions = match forces {
                RecordedForces::Known(balance) => system.actions(balance.view()),
                RecordedForces::Tendency(tendency) => {
                    system.actions(motion()?.settle(state, tendency.clone()).ok()?.view())
                }
                RecordedForces::Positions => system.actions(motion()?.exact_balance(state).ok()?.view()),
            };
            Some((state.q.clone(), actions))
        }
    }
}

/// Moves a shape by a part of the way to the next one.
fn blend(shape: &mut Shape, next: &Shape, share: f64) {
    let mix = |values: &mut Vec<f64>, next: &[f64]| {
        values.iter_mut().zip(next).for_each(|(value, next)| *value += share * (next - *value));
    };
    mix(&mut shape.x, &next.x);
    mix(&mut shape.y, &next.y);
    // Directions are continuous along a beam; from one state to the next a whole turn may lie
    // between their beginnings.
    if let (Some(from), Some(to)) = (shape.angle.first(), next.angle.first()) {
        let turn = std::f64::consts::TAU * ((from - to) / std::f64::consts::TAU).round();
        let next: Vec<f64> = next.angle.iter().map(|angle| angle + turn).collect();
        mix(&mut shape.angle, &next);
    }
    mix(&mut shape.strain, &next.strain);
    mix(&mut shape.curvature, &next.curvature);
    mix(&mut shape.axial_force, &next.axial_force);
    mix(&mut shape.shear_force, &next.shear_force);
    mix(&mut shape.bending_moment, &next.bending_moment);
    for (layer, next) in shape.stress.iter_mut().zip(&next.stress) {
        mix(&mut layer.bottom, &next.bottom);
        mix(&mut layer.top, &next.top);
    }
    for (node, next) in shape.nodes.iter_mut().zip(&next.nodes) {
        node.iter_mut().zip(next).for_each(|(x, next)| *x += share * (next - *x));
    }
}
