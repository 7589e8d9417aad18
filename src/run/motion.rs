//! Motions of a model.

use super::sampler::Sampler;
use super::shapes::acting;
use super::velocities;
use super::{Options, RunError, Solve, Stopwatch, Watch, left, memory, needs, timed};
use crate::model::{Analysis, Dynamic, Model};
use crate::restart::{self, SavedState};
use crate::results::{RecordedState, RecordedStates, Statistics, TakenUp, Trajectory};
use crate::solve::dynamics::{self, Checkpoint, State, start};
use crate::solve::resume::Holding;
use crate::system::{Energy, System};
use std::borrow::Cow;
use std::sync::Arc;

/// Kinetic energies that differ by less, relative to the larger one, are the same.
const SAME_ENERGY: f64 = 1e-6;
/// Part of the largest energy of the beams in a motion, above which that of contacts at its start is said.
const THROWN: f64 = 0.01;

impl Solve for Dynamic {
    type Results = Trajectory;

    fn solve(&self, model: &Model, options: Options<'_>) -> Result<Trajectory, RunError> {
        let mut stopwatch = Stopwatch::start();
        let analysis = Analysis::Dynamic(self.clone());
        let asked = model;
        let model = options.start.map_or(Cow::Borrowed(model), |saved| Cow::Owned(saved.gone_on(model)));
        let model = &*model;
        memory::check(model, &analysis)?;
        let mut system = System::build_with(model, needs(&analysis), options.cache)?;
        let Beginning { start, end, motion, told, brought, missed } =
            beginning(model, self, &mut system, options.start)?;
        let taken_up = (options.states && options.start.is_some()).then(|| TakenUp {
            model: Arc::new(model.clone()),
            q: start.state.q.clone(),
            variables: start.state.variables.clone(),
            holding: None,
        });
        let sampler = Sampler::new(model, &system, options.detail())?;
        stopwatch.built();
        self.integrator.suits(model)?;
        let watches = sampler.watches(self)?;
        let directions = sampler.directions();
        let keep = options.checkpoints;
        let take = |checkpoint| {
            if let Some(keep) = keep {
                (keep.take)(&SavedState::new(asked, &system, motion.clone(), checkpoint, None));
            }
        };
        let task = dynamics::Task {
            duration: end,
            output_every: self.output_every,
            integrator: self.integrator,
            start,
            watches: &watches,
            reactions: model.outputs.reactions || system.has_held_lengths(),
            forces: options.states || model.outputs.section_forces,
            directions: &directions,
            keep: keep.map(|keep| dynamics::Checkpointing { every: keep.every, take: &take }),
        };
        let mut watch = Watch::new(options.observer);
        let report =
            &mut |time: f64, step: f64, statistics: &Statistics| watch.goes_on(time, end, step, statistics);
        let mut solution = dynamics::solve(&system, &task, report);
        stopwatch.solved();
        let saved = solution.checkpoint.take().filter(|_| options.saved);
        let saved = saved.map(|checkpoint| {
            let end = solution.end.as_ref().filter(|end| end.state.time == checkpoint.reached().time);
            let holding = end.map(|end| Holding {
                supports: end.support_forces.clone(),
                multipliers: end.multipliers.clone(),
            });
            SavedState::new(asked, &system, motion.clone(), checkpoint, holding)
        });
        let kept = (options.states || model.outputs.section_forces).then(|| {
            let states = solution.states.iter().cloned().zip(std::mem::take(&mut solution.forces));
            let states = states.map(|(state, forces)| RecordedState::Moving { state, forces });
            RecordedStates { states: states.collect(), taken_up }
        });
        let begins = options.start.is_none().then(|| task.start.reached());
        let thrown = begins.and_then(|start| thrown_out(&system, start, &solution.states));
        let mut outcome = match solution.stuck.clone() {
            None => Ok(sampler.dynamics(self, solution)),
            Some(stuck) => Err(sampler.lost(self, &stuck, solution)),
        };
        if let Some(trajectory) = left(&mut outcome) {
            trajectory.saved = saved;
            if let Some(kept) = kept.as_ref().filter(|_| model.outputs.section_forces) {
                let acted = kept.states.iter().filter_map(|kept| {
                    let RecordedState::Moving { state, .. } = kept else { return None };
                    let actions = acting(&system, state.time, kept).map(|(_, actions)| actions);
                    Some((&state.q[..], Some(&state.v[..]), actions))
                });
                sampler.record_sections(trajectory, acted);
            }
            trajectory.states = kept.filter(|_| options.states);
            trajectory.run.warnings.extend(brought);
            trajectory.run.misses_fields |= !missed.is_empty();
            trajectory.run.warnings.extend(missed);
            trajectory.run.warnings.extend(thrown);
            trajectory.run.settings.extend(told.map(|told| ("continued".into(), told)));
        }
        timed(outcome, |trajectory| trajectory, &watch, stopwatch)
    }
}

/// Where a motion begins, and when it ends.
struct Beginning {
    start: Checkpoint,
    /// End time \[s\].
    end: f64,
    /// The motion's fingerprint.
    motion: String,
    /// A message on how a saved state was taken up.
    told: Option<String>,
    /// Warnings about energy that it has and the saved state had not.
    brought: Vec<String>,
    /// Warnings about velocities that cells do not follow.
    missed: Vec<String>,
}

/// Where a motion begins. If it starts from a saved state, supports without a law of time fix the
/// beams where they are in that state.
fn beginning(
    model: &Model,
    settings: &Dynamic,
    system: &mut System,
    saved: Option<&SavedState>,
) -> Result<Beginning, RunError> {
    let motion = restart::fingerprint(model, settings.integrator);
    let Some(saved) = saved else {
        let start = start::from_rest(system, &model.initial_velocities)?;
        let end = settings.duration;
        start::check_jumps(system, 0.0, end)?;
        let missed = velocities::missed(model, system);
        return Ok(Beginning { start, end, motion, told: None, brought: Vec::new(), missed });
    };
    let (start, same) = saved.take_up(model, system, &motion)?;
    let brought = match same {
        true => Vec::new(),
        false => {
            let gone_on = saved.gone_on(model);
            let pressed = pressed(system, &start.state, |part| gone_on.stands(part));
            brought(system, &start.state, saved.kinetic()).into_iter().chain(pressed).collect()
        }
    };
    system.freeze(&start.state.q);
    let (begin, end) = (saved.time(), later(saved.time(), settings.duration));
    start::check_jumps(system, begin, end)?;
    let start = match same {
        true => start,
        // The scene's velocities apply at the start of a motion; one that is under way has its own.
        false if saved.is_equilibrium() => start::from_state(system, start.state, &model.initial_velocities)?,
        false => start::from_state(system, start.state, &[])?,
    };
    let how = match same {
        true => "as if it had not stopped",
        false if saved.is_equilibrium() => "from a static equilibrium",
        false => "from its positions and velocities alone, for the model or the integrator is another",
    };
    let idle = !model.initial_velocities.is_empty() && (same || !saved.is_equilibrium());
    let adds = if idle {
        "; `initial_velocity` belongs to the start of a motion, and adds nothing to one that is under way"
    } else {
        ""
    };
    let told = format!("for {} s from t = {begin} s to {end} s, {how}{adds}", settings.duration);
    let missed = if idle { Vec::new() } else { velocities::missed(model, system) };
    Ok(Beginning { start, end, motion, told: Some(told), brought, missed })
}

/// A warning where other masses than those of the saved state, which had the energy `before` \[J\], move in `state`.
fn brought(system: &System, state: &State, before: f64) -> Option<String> {
    let now = system.energy(state.time, &state.q, Some(&state.v)).kinetic;
    ((now - before).abs() > SAME_ENERGY * now.max(before)).then(|| {
        format!(
            "the motion begins with a kinetic energy of {now:.6e} J, and the one before it ended with {before:.6e} J: a mass that comes has the \
             velocity of the beam where it sits, as if it had been carried along, and one that goes takes its own with it; a beam that catches \
             a mass at rest would be slowed down, which is not computed"
        )
    })
}

/// The energy \[J\] with which contacts begin, of those parts that are `asked` for, and the first beam of which they have one.
fn within_obstacles(system: &System, q: &[f64], asked: impl Fn(usize) -> bool) -> Option<(f64, usize)> {
    let contacts = system.contact_energies(q).filter(|(part, _, energy)| asked(*part) && *energy > 0.0);
    let contacts: Vec<(usize, f64)> = contacts.map(|(_, beam, energy)| (beam, energy)).collect();
    Some((contacts.iter().map(|(_, energy)| energy).sum(), contacts.first()?.0))
}

/// A warning where contacts with obstacles that did not stand in the saved state begin deep within these.
fn pressed(system: &System, state: &State, stands: impl Fn(usize) -> bool) -> Option<String> {
    let (energy, beam) = within_obstacles(system, &state.q, |part| !stands(part))?;
    let beam = system.beams().get(beam)?;
    let kinetic = system.energy(state.time, &state.q, Some(&state.v)).kinetic;
    (energy > SAME_ENERGY * kinetic).then(|| {
        format!(
            "an obstacle that comes has beam `{}` within it already: its contact begins with {energy:.6e} J, which nothing put in, and throws the \
             beam out; let it come in a static stage, in which contacts grow, or where the beam is not",
            beam.name
        )
    })
}

/// A warning where contacts in which a motion begins let go most of their energy, and that is a part of what moves in its recorded
/// `states` that matters. What lies as deep as its weight presses it keeps that energy.
fn thrown_out(system: &System, start: &State, states: &[State]) -> Option<String> {
    let (energy, beam) = within_obstacles(system, &start.q, |_| true)?;
    let beam = system.beams().get(beam)?;
    let left = |state: &State| within_obstacles(system, &state.q, |_| true).map_or(0.0, |(energy, _)| energy);
    let of_beams = |state: &State| {
        let Energy { kinetic, stretch, bend, .. } = system.energy(state.time, &state.q, Some(&state.v));
        kinetic + stretch + bend
    };
    let keeps = states.iter().map(left).fold(energy, f64::min) > 0.5 * energy;
    let least = THROWN * states.iter().map(of_beams).fold(0.0, f64::max);
    (!keeps && energy > least.max(system.round_off() * system.length())).then(|| {
        format!(
            "beam `{}` begins within an obstacle, and its contact with {energy:.6e} J, which nothing put in and which throws the beam out: begin beside \
             the obstacle, or with a static stage before, in which the beam comes to rest on it",
            beam.name
        )
    })
}

/// The sum of two times, rounded as decimals, so that a motion in parts ends exactly when it does
/// as a whole.
fn later(time: f64, duration: f64) -> f64 {
    let sum = time + duration;
    if time == 0.0 { sum } else { format!("{sum:.14e}").parse().unwrap_or(sum) }
}
