//! One model, one analysis: build, solve, and look at the states.

mod angle;
mod error;
mod locking;
mod memory;
mod modes;
mod sampler;
mod strings;

pub use error::RunError;

use crate::assembly::Needs;
use crate::model::{Analysis, Displacement, Dynamic, Model};
use crate::restart::{self, RestartError, SavedState};
use crate::solve::dynamics::{Checkpoint, start};
use crate::solve::statics::{self, Target};
use crate::solve::{buckling, dynamics};
use crate::system::{Inventory, System};
use crate::trajectory::{Statistics, Trajectory};
use sampler::Sampler;
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// How far a computation is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Load factor or time \[s\] reached.
    pub parameter: f64,
    /// Where it ends.
    pub target: f64,
    /// The next step.
    pub step: f64,
    /// Newton iterations so far.
    pub newton_iterations: usize,
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// End with what has been computed.
    Stop,
}

/// Called after every step.
pub type Observer<'o> = &'o mut dyn FnMut(&Progress) -> Control;

fn needs(analysis: &Analysis) -> Needs {
    let motion = matches!(analysis, Analysis::Dynamic(_));
    Needs { inertia: motion || matches!(analysis, Analysis::Modal { .. }), motion }
}

/// Builds the model's equations and lists them.
///
/// # Errors
/// [`RunError`] where the model contradicts itself.
pub fn inspect(model: &Model, analysis: &Analysis) -> Result<Inventory, RunError> {
    memory::check(model, analysis)?;
    Ok(System::build(model, needs(analysis))?.inventory())
}

/// The same, with the time that each effect and the linear algebra take.
///
/// # Errors
/// As [`inspect`].
pub fn measure(model: &Model, analysis: &Analysis) -> Result<Inventory, RunError> {
    memory::check(model, analysis)?;
    Ok(System::build(model, needs(analysis))?.measured_inventory())
}

/// Takes the states from which a motion could go on, every so often by the clock.
#[derive(Clone, Copy)]
pub struct Checkpointing<'k> {
    /// Wall time between them.
    pub every: Duration,
    /// Receives them.
    pub take: &'k dyn Fn(&SavedState),
}

/// What a run takes besides a model and an analysis.
#[derive(Default)]
pub struct Options<'o> {
    /// A saved state from which a motion starts: it lasts for its duration from the time of that
    /// state on. Supports that follow no law of time hold a beam where the state has it.
    pub start: Option<&'o SavedState>,
    /// Called after every step.
    pub observer: Option<Observer<'o>>,
    /// Leaves states on the way, from which a motion can go on.
    pub checkpoints: Option<Checkpointing<'o>>,
}

impl Model {
    /// Solves the model from its beginning to the end of the analysis.
    ///
    /// # Errors
    /// [`RunError`]: what was expected, what was found, where, and what to try.
    pub fn solve(&self, analysis: &Analysis) -> Result<Trajectory, RunError> {
        self.solve_with(analysis, Options::default())
    }

    /// The same with a start, an observer, or checkpoints.
    ///
    /// # Errors
    /// As [`Self::solve`], and where the saved state does not fit.
    pub fn solve_with(&self, analysis: &Analysis, options: Options<'_>) -> Result<Trajectory, RunError> {
        let Options { start, observer, checkpoints } = options;
        let mut goes_on = |_: &Progress| Control::Continue;
        solve(self, analysis, start, checkpoints, observer.unwrap_or(&mut goes_on))
    }
}

fn solve(
    model: &Model,
    analysis: &Analysis,
    saved: Option<&SavedState>,
    keep: Option<Checkpointing<'_>>,
    observer: Observer<'_>,
) -> Result<Trajectory, RunError> {
    let not_a_motion = match analysis {
        Analysis::Static(_) => Some("static"),
        Analysis::Buckling { .. } => Some("buckling"),
        Analysis::Modal { .. } => Some("modal"),
        Analysis::Dynamic(_) => None,
    };
    if let (Some(analysis), Some(_)) = (not_a_motion, saved) {
        return Err(RestartError::Analysis { analysis }.into());
    }
    let start = Instant::now();
    let model = if saved.is_some() { left_where_it_is(model) } else { Cow::Borrowed(model) };
    let model = &*model;
    memory::check(model, analysis)?;
    let mut system = System::build(model, needs(analysis))?;
    let beginning = match analysis {
        Analysis::Dynamic(settings) => Some(beginning(model, settings, &mut system, saved)?),
        _ => None,
    };
    let look = Sampler::new(model, &system)?;
    let build = start.elapsed().as_secs_f64();
    let start = Instant::now();
    // Solving only, where what is looked at afterwards takes its own time.
    let mut solved = None;
    let (mut stopped, follows_path) = (false, follows_path(analysis));
    let observer = &mut |progress: &Progress| {
        let control = observer(progress);
        // An observer that says stop after the last step interrupts nothing. Where a path ends is
        // not known beforehand, so that it is always interrupted.
        stopped |= control == Control::Stop && (follows_path || progress.parameter < progress.target);
        control
    };
    let mut outcome = match analysis {
        Analysis::Static(settings) => {
            let report = &mut |load: f64, step: f64, statistics: &Statistics| {
                let iterations = statistics.newton_iterations;
                observer(&Progress { parameter: load, target: 1.0, step, newton_iterations: iterations })
                    == Control::Continue
            };
            let target = match &settings.arc_length {
                None => None,
                Some(arc) => Some(Target { arc, probe: look.end_of_path(arc)? }),
            };
            let solution = statics::solve(&system, settings, target.as_ref(), report);
            solved = Some(start.elapsed());
            match (&solution.stuck, &settings.arc_length) {
                (Some(stuck), _) => Err(look.stuck(stuck, &solution)),
                (None, Some(arc)) if solution.out_of_points => Err(look.out_of_points(arc, &solution)),
                (None, _) => {
                    let mut trajectory = look.statics(&solution);
                    trajectory.saved = look.equilibrium(&solution, &trajectory);
                    Ok(trajectory)
                }
            }
        }
        Analysis::Buckling { count } => Ok(look.buckling(&buckling::solve(&system, *count)?)),
        Analysis::Modal { count, about } => look.vibrations(*count, *about, observer),
        Analysis::Dynamic(settings) => {
            settings.integrator.suits(model)?;
            let watches = look.watches(settings)?;
            let Beginning { start: begin, end, motion, told } = beginning.unwrap_or_default();
            let directions = look.directions();
            let take = |checkpoint| {
                if let Some(keep) = keep {
                    (keep.take)(&SavedState::new(model, &system, motion.clone(), checkpoint));
                }
            };
            let task = dynamics::Task {
                duration: end,
                output_every: settings.output_every,
                integrator: settings.integrator,
                start: begin,
                watches: &watches,
                reactions: model.outputs.reactions,
                directions: &directions,
                keep: keep.map(|keep| dynamics::Checkpointing { every: keep.every, take: &take }),
            };
            let report = &mut |time: f64, step: f64, statistics: &Statistics| {
                let newton_iterations = statistics.newton_iterations;
                observer(&Progress { parameter: time, target: task.duration, step, newton_iterations })
                    == Control::Continue
            };
            let mut solution = dynamics::solve(&system, &task, report);
            solved = Some(start.elapsed());
            let saved = solution.checkpoint.take();
            let saved = saved.map(|checkpoint| SavedState::new(model, &system, motion.clone(), checkpoint));
            let mut outcome = match solution.stuck.clone() {
                None => Ok(look.dynamics(settings, solution)),
                Some(stuck) => Err(look.lost(settings, &stuck, solution)),
            };
            let left = match &mut outcome {
                Ok(trajectory) => Some(trajectory),
                Err(error) => error.partial(),
            };
            if let Some(trajectory) = left {
                trajectory.saved = saved;
                trajectory.settings.extend(told.map(|told| ("continued".into(), told)));
            }
            outcome
        }
    };
    let left = match &mut outcome {
        Ok(trajectory) => Some(trajectory),
        Err(error) => error.partial(),
    };
    if let Some(trajectory) = left {
        trajectory.complete &= !stopped;
        let all = start.elapsed();
        let solved = solved.unwrap_or(all);
        trajectory.seconds.solve = solved.as_secs_f64();
        trajectory.seconds.write = (all - solved).as_secs_f64();
        trajectory.seconds.build = build;
    }
    outcome
}

fn follows_path(analysis: &Analysis) -> bool {
    matches!(analysis, Analysis::Static(settings) if settings.arc_length.is_some())
}

/// Where a motion begins, and when it ends.
#[derive(Default)]
struct Beginning {
    start: Checkpoint,
    /// \[s\]
    end: f64,
    /// The motion's fingerprint.
    motion: String,
    /// What the reader should know of it.
    told: Option<String>,
}

/// Where a motion begins. Of a motion that is taken up, supports that follow no law hold the beams
/// where the state has them.
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
        return Ok(Beginning { start, end, motion, told: None });
    };
    let (start, same) = saved.take_up(model, system, &motion)?;
    system.hold_as_in(&start.state.q);
    let (begin, end) = (saved.time(), later(saved.time(), settings.duration));
    start::check_jumps(system, begin, end)?;
    let start = match same {
        true => start,
        // Velocities of the scene start a motion; one that is under way has its own.
        false if saved.is_equilibrium() => start::from_state(system, start.state, &model.initial_velocities)?,
        false => start::from_state(system, start.state, &[])?,
    };
    let how = match same {
        true => "as if it had not stopped",
        false if saved.is_equilibrium() => "from a static equilibrium",
        false => "from its positions and velocities alone, for the model or the integrator is another",
    };
    let told = format!("for {} s from t = {begin} s to {end} s, {how}", settings.duration);
    Ok(Beginning { start, end, motion, told: Some(told) })
}

/// The sum of two times as decimals have it, so that a motion in parts ends when it does as a
/// whole.
fn later(time: f64, duration: f64) -> f64 {
    let sum = time + duration;
    if time == 0.0 { sum } else { format!("{sum:.14e}").parse().unwrap_or(sum) }
}

/// The model with supports that hold still unless they follow a law.
fn left_where_it_is(model: &Model) -> Cow<'_, Model> {
    let mut model = model.clone();
    for support in model.supports.iter_mut().filter(|support| support.law.is_none()) {
        support.displacement = Displacement::default();
    }
    Cow::Owned(model)
}
