//! One model, one analysis: build, solve, and look at the states.

mod balance;
mod coils;
mod electrodes;
mod error;
mod events;
mod fields;
mod imbalance;
mod laws;
mod locking;
mod loose;
mod memory;
mod modes;
mod motion;
mod origin;
mod phase;
mod sampler;
mod sections;
mod shapes;
mod stability;
mod stages;
mod start;
mod statics;
mod steps;
mod strings;
mod surfaces;
mod tendons;
mod velocities;
mod waves;

pub(crate) use balance::{OffBalance, StressFree};
pub use error::RunError;
pub(crate) use laws::stiffness_jumps;
pub use shapes::shapes_at;
pub(crate) use stages::solve_stages_by;
pub use stages::{StagesRun, inspect_stages, model_of_stage, solve_stages};

use crate::assembly::Needs;
use crate::basis::BasisCache;
use crate::model::{Analysis, Model};
use crate::restart::{RestartError, SavedState};
use crate::results::{PICTURES, Results, Seconds, Statistics, Trajectory};
use crate::system::{Inventory, System};
use std::time::{Duration, Instant};

/// How far a computation has got.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Load factor or time \[s\] reached.
    pub parameter: f64,
    /// Load factor or time \[s\] at which it ends.
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
    /// End with the results so far.
    Stop,
}

/// Called after every step, and after every iteration where a structure without stiffness comes to
/// rest: [`Progress::parameter`] is then that of the step before.
pub type Observer<'o> = &'o mut dyn FnMut(&Progress) -> Control;

fn needs(analysis: &Analysis) -> Needs {
    let motion = matches!(analysis, Analysis::Dynamic(_));
    Needs { inertia: motion || matches!(analysis, Analysis::Modal(_)), motion }
}

/// Builds the model's equations and lists them.
///
/// # Errors
/// [`RunError`] where the model contradicts itself.
pub fn inspect(model: &Model, analysis: &Analysis) -> Result<Inventory, RunError> {
    memory::check(model, analysis)?;
    Ok(System::build(model, needs(analysis))?.inventory())
}

/// [`inspect`], with the time that each effect and the linear algebra take.
///
/// # Errors
/// As [`inspect`].
pub fn measure(model: &Model, analysis: &Analysis) -> Result<Inventory, RunError> {
    memory::check(model, analysis)?;
    Ok(System::build(model, needs(analysis))?.measured_inventory())
}

/// Receives states from which a motion can be continued, at intervals of wall time.
#[derive(Clone, Copy)]
pub struct Checkpointing<'k> {
    /// Wall time between them.
    pub every: Duration,
    /// Receives them.
    pub take: &'k dyn Fn(&SavedState),
}

/// Places of each beam at which the last shape is known, unless a run asks for others.
pub const SHAPE_POINTS: usize = 201;

/// Options of a run besides the model and the analysis.
pub struct Options<'o> {
    /// A saved state from which the analysis starts; the duration of a motion counts from the time
    /// of that state. Supports without a law of time hold a beam where it is in the state, and those
    /// that are new move it from there.
    pub start: Option<&'o SavedState>,
    /// Called on the way.
    pub observer: Option<Observer<'o>>,
    /// Leaves states on the way, from which a motion can go on.
    pub checkpoints: Option<Checkpointing<'o>>,
    /// Shape functions that other runs have computed.
    pub cache: Option<&'o BasisCache>,
    /// Whether recorded states are kept, so that [`shapes_at`] knows shapes with section forces at
    /// any load factor or time.
    pub states: bool,
    /// Number of records, evenly spread, whose centrelines are kept: [`PICTURES`] by default.
    pub frames: usize,
    /// Number of places, evenly spread, at which the last shape of each beam is known, with its
    /// section forces: [`SHAPE_POINTS`] by default, and two at least.
    pub shape_points: usize,
    /// Per beam, arc lengths \[m\] at which every record is kept, as [`Trajectory::stations`]; none
    /// by default.
    pub stations: &'o [Vec<f64>],
    /// Whether the end is kept as a state from which another run can start, [`Trajectory::saved`]: it
    /// is by default.
    pub saved: bool,
    /// Whether the results are compared with those of another mesh, which tells more of what cells miss than the warnings that
    /// one run can give, and are given by default.
    pub compared: bool,
}

/// How much of the states of a run is kept.
#[derive(Clone, Copy)]
struct Detail<'o> {
    /// How many centrelines.
    frames: usize,
    /// Places of the last shapes.
    shape_points: usize,
    /// Per beam, arc lengths \[m\] at which every record is kept.
    stations: &'o [Vec<f64>],
    /// Whether results are compared with others.
    compared: bool,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            start: None,
            observer: None,
            checkpoints: None,
            cache: None,
            states: false,
            frames: PICTURES,
            shape_points: SHAPE_POINTS,
            stations: &[],
            saved: true,
            compared: false,
        }
    }
}

impl<'o> Options<'o> {
    /// The same options, without an observer.
    fn copied(&self) -> Self {
        Self { observer: None, ..*self }
    }

    /// The same options for one run of several.
    pub(crate) fn again(&mut self) -> Options<'_> {
        let Self {
            start,
            observer,
            checkpoints,
            cache,
            states,
            frames,
            shape_points,
            stations,
            saved,
            compared,
        } = self;
        Options {
            start: *start,
            observer: observer.as_mut().map(|observer| &mut **observer as _),
            checkpoints: *checkpoints,
            cache: *cache,
            states: *states,
            frames: *frames,
            shape_points: *shape_points,
            stations,
            saved: *saved,
            compared: *compared,
        }
    }

    fn detail(&self) -> Detail<'o> {
        let Self { frames, shape_points, stations, compared, .. } = *self;
        Detail { frames, shape_points, stations, compared }
    }

    /// Refuses a saved state for an analysis that starts from the stress-free one.
    fn refuses_a_start(&self, analysis: &'static str) -> Result<(), RunError> {
        self.start.map_or(Ok(()), |_| Err(RestartError::Analysis { analysis }.into()))
    }
}

/// An analysis, with the type of its results.
pub trait Solve {
    /// The results of the analysis.
    type Results;

    /// Solves a model by this analysis.
    ///
    /// # Errors
    /// As [`Model::solve_with`].
    fn solve(&self, model: &Model, options: Options<'_>) -> Result<Self::Results, RunError>;
}

impl Model {
    /// Solves the model from its beginning to the end of the analysis.
    ///
    /// # Errors
    /// [`RunError`]: what was expected, what was found, where, and what to try.
    pub fn solve<A: Solve>(&self, analysis: &A) -> Result<A::Results, RunError> {
        self.solve_with(analysis, Options::default())
    }

    /// [`Self::solve`] with a start, an observer, or checkpoints.
    ///
    /// # Errors
    /// As [`Self::solve`], and where the saved state does not fit.
    pub fn solve_with<A: Solve>(&self, analysis: &A, options: Options<'_>) -> Result<A::Results, RunError> {
        analysis.solve(self, options)
    }
}

/// The analysis of a scene, of any kind.
impl Solve for Analysis {
    type Results = Results;

    fn solve(&self, model: &Model, options: Options<'_>) -> Result<Results, RunError> {
        match self {
            Self::Static(statics) => statics.solve(model, options).map(Results::Trajectory),
            Self::Dynamic(dynamic) => dynamic.solve(model, options).map(Results::Trajectory),
            Self::Modal(modal) => modal.solve(model, options).map(Results::Vibrations),
            Self::Buckling(buckling) => buckling.solve(model, options).map(Results::CriticalLoads),
            Self::Stages => Err(RunError::Stages),
        }
    }
}

/// Asks the observer after every step.
struct Watch<'o> {
    observer: Option<Observer<'o>>,
    /// Whether the end of the computation is not known beforehand: to stop it anywhere is then an
    /// interruption.
    open: bool,
    /// Whether the observer has stopped a computation that was not at its end.
    stopped: bool,
}

impl<'o> Watch<'o> {
    fn new(observer: Option<Observer<'o>>) -> Self {
        Self { observer, open: false, stopped: false }
    }

    /// Whether to go on.
    fn goes_on(&mut self, parameter: f64, target: f64, step: f64, statistics: &Statistics) -> bool {
        let Some(observer) = &mut self.observer else { return true };
        let newton_iterations = statistics.newton_iterations;
        let control = observer(&Progress { parameter, target, step, newton_iterations });
        self.stopped |= control == Control::Stop && (self.open || parameter < target);
        control == Control::Continue
    }
}

/// Measures the parts of a run, one after the other.
struct Stopwatch {
    since: Instant,
    seconds: Seconds,
}

impl Stopwatch {
    fn start() -> Self {
        Self { since: Instant::now(), seconds: Seconds::default() }
    }

    fn lap(&mut self) -> f64 {
        let lap = self.since.elapsed().as_secs_f64();
        self.since = Instant::now();
        lap
    }

    fn built(&mut self) {
        self.seconds.build += self.lap();
    }

    fn solved(&mut self) {
        self.seconds.solve += self.lap();
    }

    /// Ends the measurement; the time since the last part was spent on evaluating the states.
    fn finish(mut self) -> Seconds {
        self.seconds.write += self.lap();
        self.seconds
    }
}

/// The trajectory that a computation has left, whole or partial.
fn left(outcome: &mut Result<Trajectory, RunError>) -> Option<&mut Trajectory> {
    match outcome {
        Ok(trajectory) => Some(trajectory),
        Err(error) => error.partial(),
    }
}

/// Adds to results, whole or partial, how long they took and whether they were stopped. `states`
/// gives the states of whole results.
fn timed<R>(
    mut outcome: Result<R, RunError>,
    states: fn(&mut R) -> &mut Trajectory,
    watch: &Watch<'_>,
    stopwatch: Stopwatch,
) -> Result<R, RunError> {
    let left = match &mut outcome {
        Ok(results) => Some(states(results)),
        Err(error) => error.partial(),
    };
    if let Some(Trajectory { run, .. }) = left {
        run.complete &= !watch.stopped;
        run.seconds = stopwatch.finish();
    }
    outcome
}
