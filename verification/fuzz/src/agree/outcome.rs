//! Runs a scene, and keeps the results that are compared: in natural units, turned back to where
//! the scene was drawn.

use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};

use ancf::accuracy;
use ancf::model::{Beam, Discretization};
use ancf::restart::SavedState;
use ancf::results::{Event, ProbeSample, Results, Shape};
use ancf::run::{self, Control, RunError, StagesRun};
use ancf::scene;
use toml::Table;

use super::frame::Frame;

/// Newton iterations times nodes after which a run is given up: about a second. No clock decides,
/// so that a seed gives the same verdicts.
const WORK: usize = 60_000;
/// Steps after which a run is given up.
const STEPS: usize = 4_000;
/// Nodes that a beam is taken to have where they are chosen for an accuracy.
const NODES_CHOSEN: usize = 40;

thread_local! {
    /// The message of the last panic of this thread.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// The outcome of a scene.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// Status 0.
    Solved(Box<Seen>),
    /// Status 1.
    Failed(String),
    /// Status 2, found by the reader or later.
    Refused(String),
    /// It took too long and was given up.
    TooLong,
    /// A panic.
    Panicked(String),
}

/// The results of a run, in natural units.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    pub warnings: Vec<String>,
    /// Load factors, or times.
    pub parameter: Vec<f64>,
    pub probes: Vec<Vec<Sample>>,
    /// Parts of the energy, of which the differences from the first record are compared.
    pub energy: Vec<[f64; 7]>,
    /// The last state of each beam.
    pub beams: Vec<Line>,
    /// Per support and joint the force and moment in the last record.
    pub reactions: Vec<(String, [f64; 3])>,
    /// The sum of all forces of effects in the last record, and of their sizes.
    pub effects: ([f64; 2], f64),
    /// Frequencies or critical load factors.
    pub eigenvalues: Vec<f64>,
    /// Times or load factors of events …
    pub events: Vec<f64>,
    /// … and their errors, where a run tells them.
    pub event_errors: Vec<f64>,
    /// Steps, rejected steps, iterations.
    pub counts: [usize; 3],
    pub saved: Option<SavedState>,
    /// Whether these are results of a motion.
    pub moves: bool,
    /// The results of the stages before, if this is the last of several.
    pub before: Vec<Seen>,
    /// Estimated error of positions in the last state [beam lengths], or of eigenvalues, of a run
    /// that chose its mesh.
    pub estimated: Option<f64>,
}

impl Seen {
    /// The largest change of a part of the energy \[EI/L\].
    pub fn energy_exchanged(&self) -> f64 {
        let first = self.energy.first().copied().unwrap_or_default();
        let changes =
            self.energy.iter().flat_map(|parts| parts.iter().zip(first).map(|(e, f)| (e - f).abs()));
        changes.fold(0.0, f64::max)
    }
}

/// A sample of a probe.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    pub place: [f64; 2],
    /// Turn since the first record …
    pub angle: f64,
    /// … and with the direction there, which lies within half a turn.
    pub direction: f64,
    pub curvature: f64,
    pub strain: f64,
    pub velocity: [f64; 2],
}

/// The last state of a beam.
#[derive(Clone, Debug, Default)]
pub struct Line {
    pub places: Vec<[f64; 2]>,
    pub angle: Vec<f64>,
    /// N, Q, M.
    pub forces: Vec<[f64; 3]>,
}

/// Keeps the messages of panics, and does not print them.
pub fn hear_panics() {
    panic::set_hook(Box::new(|info| SAID.with(|said| *said.borrow_mut() = info.to_string())));
}

/// Runs a scene that was drawn in natural units.
pub fn run(natural: &Table, frame: &Frame) -> Outcome {
    run_from(natural, frame, None)
}

/// [`run()`] from a saved state.
pub fn run_from(natural: &Table, frame: &Frame, saved: Option<&SavedState>) -> Outcome {
    let text = frame.write(natural).to_string();
    match panic::catch_unwind(AssertUnwindSafe(|| solve(&text, frame, saved))) {
        Ok(outcome) => outcome,
        Err(_) => Outcome::Panicked(SAID.with(|said| said.borrow().clone())),
    }
}

/// Whether a scene is legal, and the reader's first line where it is not.
pub fn check(natural: &Table, frame: &Frame) -> Result<(), String> {
    let text = frame.write(natural).to_string();
    match panic::catch_unwind(AssertUnwindSafe(|| scene::parse("drawn.toml", &text).map(|_| ()))) {
        Ok(read) => read.map_err(|error| first_line(&error.to_string())),
        // The run will show the panic.
        Err(_) => Ok(()),
    }
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

fn solve(text: &str, frame: &Frame, saved: Option<&SavedState>) -> Outcome {
    let scene = match scene::parse("drawn.toml", text) {
        Ok(scene) => scene,
        Err(error) => return Outcome::Refused(first_line(&error.to_string())),
    };
    let nodes = |beam: &Beam| match beam.discretization {
        Discretization::Open => NODES_CHOSEN,
        _ => beam.discretization.nodes().count(),
    };
    let nodes: usize = scene.model().beams.iter().map(nodes).sum();
    let (mut steps, mut gave_up) = (0, false);
    // Iterations of the stages before, and of this one.
    let (mut before, mut now) = (0, 0);
    let observer = &mut |progress: &run::Progress| {
        steps += 1;
        if progress.newton_iterations < now {
            before += now;
        }
        now = progress.newton_iterations;
        gave_up = steps > STEPS || (before + now) * nodes > WORK;
        if gave_up { Control::Stop } else { Control::Continue }
    };
    let options = run::Options { start: saved, observer: Some(observer), ..run::Options::default() };
    if !scene.stages().is_empty() {
        let StagesRun { results, failure } = run::solve_stages(scene.stages(), options);
        if gave_up {
            return Outcome::TooLong;
        }
        return match failure {
            None => Outcome::Solved(Box::new(see_all(&results, frame))),
            Some(error) => without_result(&error),
        };
    }
    let outcome = accuracy::run(&scene, options);
    if gave_up {
        return Outcome::TooLong;
    }
    match outcome {
        Ok(results) if results.run().error.as_ref().is_some_and(|error| !error.met) => {
            let missed = results.run().error.as_ref().and_then(|error| error.missed(results.run().analysis));
            Outcome::Failed(missed.unwrap_or_default())
        }
        Ok(results) => Outcome::Solved(Box::new(see(&results, frame))),
        Err(error) => without_result(&error),
    }
}

/// The error that the program itself estimates for a scene with a mesh of its own, the largest of its stages; `None` where it has no
/// estimate.
pub fn own_estimate(natural: &Table, frame: &Frame) -> Option<f64> {
    let text = frame.write(natural).to_string();
    let estimate = || {
        let scene = scene::parse("drawn.toml", &text).ok()?;
        let error = |results: &Results| results.run().error.as_ref().map(|error| error.estimated.result);
        if scene.stages().is_empty() {
            let results =
                accuracy::estimate(scene.model(), scene.analysis(), run::Options::default()).ok()?;
            return error(&results);
        }
        let StagesRun { results, failure } =
            accuracy::estimate_stages(scene.stages(), run::Options::default());
        let errors = results.iter().map(|results| error(results).unwrap_or(f64::INFINITY));
        failure.is_none().then(|| errors.fold(0.0, f64::max))
    };
    panic::catch_unwind(AssertUnwindSafe(estimate)).ok().flatten()
}

fn without_result(error: &RunError) -> Outcome {
    let said = first_line(&error.to_string());
    if error.exit_status() == 2 { Outcome::Refused(said) } else { Outcome::Failed(said) }
}

/// The last stage, with those before it; the warnings and the counts are those of all.
fn see_all(results: &[Results], frame: &Frame) -> Seen {
    let mut before: Vec<Seen> = results.iter().map(|results| see(results, frame)).collect();
    let mut last = before.pop().unwrap_or_default();
    for seen in before.iter().rev() {
        last.warnings.splice(0..0, seen.warnings.iter().cloned());
        last.counts.iter_mut().zip(seen.counts).for_each(|(all, count)| *all += count);
    }
    last.before = before;
    last
}

fn see(results: &Results, frame: &Frame) -> Seen {
    let t = results.states();
    let time = match t.run.analysis {
        ancf::results::AnalysisKind::Dynamic => frame.unit([0, 0, 1]),
        _ => 1.0,
    };
    let energy = frame.unit([2, 1, -2]);
    let parts = |e: &ancf::results::Energy| {
        [e.stretch, e.bend, e.stored, e.kinetic, e.potential, e.work, e.lost].map(|part| part / energy)
    };
    let force = frame.unit([1, 1, -2]);
    let reactions = t.reactions.iter().filter_map(|series| {
        let last = series.samples.last()?;
        let [fx, fy] = frame.back([last.fx / force, last.fy / force]);
        Some((series.name.clone(), [fx, fy, frame.sign() * last.moment / energy]))
    });
    let mut sum = ([0.0; 2], 0.0);
    for sample in t.effects.iter().filter_map(|series| series.samples.last()) {
        let [_, fx, fy] = sample;
        let f = frame.back([fx / force, fy / force]);
        sum.0[0] += f[0];
        sum.0[1] += f[1];
        sum.1 += f[0].hypot(f[1]);
    }
    let rate = frame.unit([0, 0, -1]);
    let unit = if t.run.analysis == ancf::results::AnalysisKind::Modal { rate } else { 1.0 };
    let told = t.run.error.as_ref();
    let events: Vec<_> = t.events.iter().enumerate().filter(|(_, event)| has_time(event, &t.last)).collect();
    Seen {
        moves: t.run.analysis == ancf::results::AnalysisKind::Dynamic,
        before: Vec::new(),
        warnings: t.run.warnings.clone(),
        parameter: t.parameter.iter().map(|p| p / time).collect(),
        probes: t.probes.iter().map(|probe| samples(&probe.samples, frame)).collect(),
        energy: t.energy.iter().map(parts).collect(),
        beams: t.last.iter().map(|shape| line(shape, frame)).collect(),
        reactions: reactions.collect(),
        effects: sum,
        eigenvalues: results.eigenvalues().iter().map(|value| value / unit).collect(),
        events: events.iter().map(|(_, event)| event.parameter() / time).collect(),
        event_errors: events
            .iter()
            .filter_map(|(i, _)| Some(told?.events.get(*i)?.parameter / time))
            .collect(),
        counts: [t.run.statistics.steps, t.run.statistics.rejected_steps, t.run.statistics.newton_iterations],
        saved: t.saved.clone(),
        estimated: t.run.error.as_ref().map(|error| match error.records.last() {
            Some(last) => *last,
            None => error.estimated.result,
        }),
    }
}

/// Whether an event has a time that more than round-off decides on: not so a turn of a strain that is zero but for the errors of a mesh, as at
/// a free end, or of a moment that is nothing beside those in the beams, as where a wave has not arrived yet.
fn has_time(event: &Event, last: &[Shape]) -> bool {
    const NOTHING: f64 = 1e-9;
    const OF_LARGEST: f64 = 1e-5;
    let Event::Probe { quantity, turns: Some(_), value, .. } = event else { return true };
    let most = |of: fn(&Shape) -> &[f64]| {
        last.iter().flat_map(of).fold(0.0_f64, |most, value| most.max(value.abs()))
    };
    let least = match *quantity {
        "strain" => NOTHING,
        "curvature" => OF_LARGEST * most(|shape| &shape.curvature),
        "axial_force" => OF_LARGEST * most(|shape| &shape.axial_force),
        "shear_force" => OF_LARGEST * most(|shape| &shape.shear_force),
        "bending_moment" => OF_LARGEST * most(|shape| &shape.bending_moment),
        _ => return true,
    };
    value.abs() >= least
}

fn samples(samples: &[ProbeSample], frame: &Frame) -> Vec<Sample> {
    let (length, velocity) = (frame.unit([1, 0, 0]), frame.unit([1, 0, -1]));
    let first = samples.first().map_or(0.0, |s| s.angle);
    let (sine, cosine) = first.sin_cos();
    let [x, y] = frame.back([cosine, sine]);
    let natural = samples.iter().map(|s| Sample {
        place: frame.point_back([s.x, s.y]),
        angle: frame.sign() * (s.angle - first),
        direction: y.atan2(x) + frame.sign() * (s.angle - first),
        curvature: frame.sign() * s.curvature * length,
        strain: s.strain,
        velocity: frame.back([s.vx.unwrap_or(0.0) / velocity, s.vy.unwrap_or(0.0) / velocity]),
    });
    natural.collect()
}

fn line(shape: &Shape, frame: &Frame) -> Line {
    let (force, moment) = (frame.unit([1, 1, -2]), frame.unit([2, 1, -2]));
    let sign = frame.sign();
    let places = shape.x.iter().zip(&shape.y).map(|(x, y)| frame.point_back([*x, *y]));
    let forces = shape.axial_force.iter().zip(&shape.shear_force).zip(&shape.bending_moment);
    let angles = shape.angle.iter().map(|a| {
        let (sine, cosine) = a.sin_cos();
        let [x, y] = frame.back([cosine, sine]);
        y.atan2(x)
    });
    Line {
        places: places.collect(),
        angle: angles.collect(),
        forces: forces.map(|((n, q), m)| [n / force, sign * q / force, sign * m / moment]).collect(),
    }
}
