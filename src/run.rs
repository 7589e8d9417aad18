//! One model, one analysis: build, solve, and look at the states.

use crate::model::{
    Analysis, ArcLength, Displacement, Dynamic, Model, ProbeTarget, StepControl, StrainMeasure,
};
use crate::restart::{RestartError, SavedState};
use crate::solve::dynamics;
use crate::solve::dynamics::start::{self, StartError};
use crate::solve::newton::Failure;
use crate::solve::path::Stuck;
use crate::solve::statics::{self, Solution, Target};
use crate::solve::{buckling, modal};
use crate::system::{Inventory, Needs, System, SystemError, View};
use crate::trajectory::{AnalysisKind, Energy, Event, Frame, ProbeSample, ProbeSeries, Shape, Trajectory};
use std::f64::consts::TAU;
use std::time::Instant;

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

/// Why there is no result.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    /// The model cannot be turned into equations.
    #[error(transparent)]
    #[diagnostic(transparent)]
    System(#[from] SystemError),
    /// No equilibrium was found beyond some load factor.
    #[error(
        "no equilibrium beyond load factor {load:.6}: {cause}; smallest step tried {step:.1e}, worst at s = {s:.4} m of beam `{beam}`"
    )]
    #[diagnostic(help("{advice}"))]
    NoEquilibrium {
        /// Load factor of the last equilibrium.
        load: f64,
        /// Smallest step tried.
        step: f64,
        /// What went wrong.
        cause: String,
        /// The beam on which the iteration went worst.
        beam: String,
        /// Where on it \[m\].
        s: f64,
        /// What to try.
        advice: String,
        /// What was computed until then.
        partial: Box<Trajectory>,
    },
    /// A setting refers to a probe that does not exist.
    #[error("there is no probe `{probe}`; the probes are: {known}")]
    NoSuchProbe {
        /// The name given.
        probe: String,
        /// The names that exist.
        known: String,
    },
    /// An eigenvalue problem could not be solved.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Eigen(#[from] crate::solve::eigen::EigenError),
    /// A time step could not be taken.
    #[error(
        "no step of {step:.1e} s beyond t = {time:.6} s: {cause}; the last iterate changed most at s = {s:.4} m of beam `{beam}`"
    )]
    #[diagnostic(help("{advice}"))]
    NoStep {
        /// Time of the last state \[s\].
        time: f64,
        /// The step \[s\].
        step: f64,
        /// What went wrong.
        cause: String,
        /// The beam on which the iteration went worst.
        beam: String,
        /// Where on it \[m\].
        s: f64,
        /// What to try.
        advice: String,
        /// What was computed until then.
        partial: Box<Trajectory>,
    },
    /// The motion cannot start as the scene says.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Start(#[from] StartError),
    /// A saved state cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Restart(#[from] RestartError),
    /// The scene is legal, but this version cannot compute it.
    #[error("{what} is not available in this version")]
    #[diagnostic(help("{instead}"))]
    Unavailable {
        /// What the scene asks for.
        what: &'static str,
        /// What to use.
        instead: &'static str,
    },
}

impl RunError {
    /// 2 where the input is at fault, 1 where the computation failed.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::System(_)
            | Self::NoSuchProbe { .. }
            | Self::Start(_)
            | Self::Restart(_)
            | Self::Unavailable { .. } => 2,
            Self::NoEquilibrium { .. } | Self::NoStep { .. } | Self::Eigen(_) => 1,
        }
    }
}

fn needs(analysis: &Analysis) -> Needs {
    Needs { inertia: matches!(analysis, Analysis::Modal { .. } | Analysis::Dynamic(_)) }
}

/// Builds the model's equations and lists them.
///
/// # Errors
/// [`RunError`] where the model contradicts itself.
pub fn inspect(model: &Model, analysis: &Analysis) -> Result<Inventory, RunError> {
    Ok(System::build(model, needs(analysis))?.inventory())
}

/// Solves `model`. `observer` is called after every step.
///
/// # Errors
/// [`RunError`]: what was expected, what was found, where, and what to try.
pub fn run(model: &Model, analysis: &Analysis, observer: Observer<'_>) -> Result<Trajectory, RunError> {
    run_from(model, analysis, None, observer)
}

/// The same, a motion starting from a saved state if one is given.
///
/// # Errors
/// As [`run`], and where the saved state does not fit.
pub fn run_from(
    model: &Model,
    analysis: &Analysis,
    saved: Option<&SavedState>,
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
    let system = System::build(model, needs(analysis))?;
    let look = Look::new(model, &system)?;
    let build = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut trajectory = match analysis {
        Analysis::Static(settings) => {
            let report = &mut |load: f64, step: f64, statistics: &crate::trajectory::Statistics| {
                let iterations = statistics.newton_iterations;
                observer(&Progress { parameter: load, target: 1.0, step, newton_iterations: iterations })
                    == Control::Continue
            };
            let target = match &settings.arc_length {
                None => None,
                Some(arc) => Some(Target { arc, probe: look.end_of_path(arc)? }),
            };
            let solution = statics::solve(&system, settings, target.as_ref(), report);
            match &solution.stuck {
                None => look.statics(&solution),
                Some(stuck) => return Err(look.stuck(stuck, &solution)),
            }
        }
        Analysis::Buckling { count } => look.buckling(&buckling::solve(&system, *count)?),
        Analysis::Modal { count } => look.modal(&modal::solve(&system, *count)?),
        Analysis::Dynamic(settings) => {
            let watches = look.watches(settings)?;
            let task = dynamics::Task {
                duration: settings.duration,
                output_every: settings.output_every,
                integrator: settings.integrator,
                start: beginning(model, settings, &system, saved)?,
                watches: &watches,
            };
            let report = &mut |time: f64, step: f64, statistics: &crate::trajectory::Statistics| {
                let newton_iterations = statistics.newton_iterations;
                observer(&Progress { parameter: time, target: task.duration, step, newton_iterations })
                    == Control::Continue
            };
            let solution = dynamics::solve(&system, &task, report);
            match &solution.stuck {
                None => look.dynamics(settings, solution),
                Some(stuck) => return Err(look.lost(settings, &stuck.clone(), solution)),
            }
        }
    };
    trajectory.seconds.solve = start.elapsed().as_secs_f64();
    trajectory.seconds.build = build;
    Ok(trajectory)
}

/// Where a motion begins.
fn beginning(
    model: &Model,
    settings: &Dynamic,
    system: &System,
    saved: Option<&SavedState>,
) -> Result<dynamics::Checkpoint, RunError> {
    if model.supports.iter().any(|support| support.displacement != Displacement::default()) {
        return Err(RunError::Unavailable {
            what: "prescribed motion of a support in a dynamic analysis",
            instead: "hold the support without `move`, or use a static analysis",
        });
    }
    match saved {
        None => Ok(start::from_rest(system, &model.initial_velocities)?),
        Some(saved) if saved.time() >= settings.duration => {
            Err(RestartError::Over { time: saved.time(), duration: settings.duration }.into())
        }
        Some(saved) => Ok(saved.checkpoint(system)?),
    }
}

/// Points at which shapes are sampled.
const SHAPE_POINTS: usize = 201;
/// Points of a beam in a frame of the animation.
const FRAME_POINTS: usize = 101;
/// Frames kept for the animation.
const FRAMES: usize = 400;

/// Everything needed to look at states of one system.
struct Look<'a> {
    model: &'a Model,
    system: &'a System,
    shapes: Vec<View>,
    frames: Vec<View>,
    probes: Vec<Watched>,
}

/// A probe with the rows that see its point.
struct Watched {
    name: String,
    view: View,
    measure: StrainMeasure,
    /// ε of the stress-free state there.
    reference_strain: f64,
}

fn evenly(length: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| length * i as f64 / (count - 1) as f64).collect()
}

impl<'a> Look<'a> {
    fn new(model: &'a Model, system: &'a System) -> Result<Self, RunError> {
        let view = |beam: usize, s: &[f64]| {
            let part = &system.beams()[beam];
            View::points(&part.basis, part.offset(), s).map_err(|e| SystemError::basis(&part.name, e))
        };
        let sampled = |count: usize| -> Result<Vec<View>, SystemError> {
            (0..system.beams().len())
                .map(|beam| view(beam, &evenly(system.beams()[beam].basis.length(), count)))
                .collect()
        };
        let probes = model
            .probes
            .iter()
            .map(|probe| {
                let beam = probe.at.beam;
                let s = system.arc_length("a probe", probe.at)?;
                let (view, measure) = (view(beam, &[s])?, model.beams[beam].strain);
                let reference_strain = if system.beams()[beam].straight {
                    0.0
                } else {
                    view.fields(system.reference()).strain(measure)
                };
                Ok(Watched { name: probe.name.clone(), view, measure, reference_strain })
            })
            .collect::<Result<_, SystemError>>()?;
        Ok(Self { model, system, shapes: sampled(SHAPE_POINTS)?, frames: sampled(FRAME_POINTS)?, probes })
    }

    /// The probe at which a path is to end, as (view, axis, value).
    fn end_of_path(&self, arc: &ArcLength) -> Result<Option<(View, usize, f64)>, RunError> {
        let Some(target) = &arc.until_probe else { return Ok(None) };
        Ok(Some((self.view_of(target)?, target.axis, target.value)))
    }

    fn view_of(&self, target: &ProbeTarget) -> Result<View, RunError> {
        let found = self.probes.iter().find(|probe| probe.name == target.probe);
        let probe = found.ok_or_else(|| RunError::NoSuchProbe {
            probe: target.probe.clone(),
            known: self.probes.iter().map(|probe| probe.name.as_str()).collect::<Vec<_>>().join(", "),
        })?;
        Ok(probe.view.clone())
    }

    /// The events of a motion, each with the view of its probe.
    fn watches(&self, settings: &Dynamic) -> Result<Vec<dynamics::Watch>, RunError> {
        let watch = |event: &crate::model::Event| {
            let view = self.view_of(&event.target)?;
            let (axis, value) = (event.target.axis, event.target.value);
            Ok(dynamics::Watch { view, axis, value, crossing: event.crossing, stop: event.stop })
        };
        settings.events.iter().map(watch).collect()
    }

    fn empty(&self, analysis: AnalysisKind) -> Trajectory {
        let reference = self.system.reference();
        Trajectory {
            title: self.model.title.clone(),
            analysis,
            degrees_of_freedom: self.system.degrees_of_freedom(),
            settings: self.settings(),
            undeformed: self.shape(reference),
            last: self.shape(reference),
            probes: self
                .probes
                .iter()
                .map(|probe| ProbeSeries { name: probe.name.clone(), samples: vec![] })
                .collect(),
            ..Trajectory::default()
        }
    }

    fn settings(&self) -> Vec<(String, String)> {
        let mut settings = Vec::new();
        for (beam, part) in self.model.beams.iter().zip(self.system.beams()) {
            let name = &beam.name;
            settings.push((
                format!("beam {name}"),
                format!("{} m, {}", part.basis.length(), beam.discretization),
            ));
            settings.push((
                format!("beam {name}, strain"),
                format!(
                    "{}; Gauss points {} (stretch), {} (bend) a cell",
                    beam.strain, beam.gauss_points.stretch, beam.gauss_points.bend
                ),
            ));
        }
        let inventory = self.system.inventory();
        let mut kinds: Vec<_> = inventory.effects.iter().map(|e| e.kind.name()).collect();
        kinds.dedup();
        settings.push(("effects".into(), kinds.join(", ")));
        settings.push(("linear solver".into(), inventory.solver.into()));
        settings
    }

    fn shape(&self, q: &[f64]) -> Vec<Shape> {
        let beams = self.model.beams.iter().zip(self.system.beams()).zip(&self.shapes);
        beams
            .map(|((beam, part), view)| {
                let mut shape = Shape { beam: beam.name.clone(), s: view.s().to_vec(), ..Shape::default() };
                let mut angle = None;
                for fields in view.all(q) {
                    shape.x.push(fields.position[0]);
                    shape.y.push(fields.position[1]);
                    let unfolded = unfold(fields.angle(), angle);
                    angle = Some(unfolded);
                    shape.angle.push(unfolded);
                    shape.strain.push(fields.strain(beam.strain));
                    shape.curvature.push(fields.curvature());
                }
                let first = 4 * part.first_node;
                let nodes = q[first..first + 4 * part.basis.nodes().len()].chunks_exact(4);
                shape.nodes = nodes.map(|n| [n[0], n[1]]).collect();
                // A curved beam is free of stress with the strain that its interpolated shape has.
                if !part.straight {
                    let reference = view.all(self.system.reference());
                    for (strain, reference) in shape.strain.iter_mut().zip(reference) {
                        *strain -= reference.strain(beam.strain);
                    }
                }
                shape
            })
            .collect()
    }

    fn frame(&self, parameter: f64, q: &[f64]) -> Frame {
        let beams = self.frames.iter().map(|view| view.all(q).map(|f| f.position).collect()).collect();
        Frame { parameter, beams }
    }

    fn record(
        &self,
        trajectory: &mut Trajectory,
        parameter: f64,
        q: &[f64],
        velocity: Option<&[f64]>,
        energy: Energy,
    ) {
        trajectory.parameter.push(parameter);
        trajectory.energy.push(energy);
        for (Watched { view, measure, reference_strain, .. }, series) in
            self.probes.iter().zip(&mut trajectory.probes)
        {
            let fields = view.fields(q);
            let angle = unfold(fields.angle(), series.samples.last().map(|s| s.angle));
            series.samples.push(ProbeSample {
                x: fields.position[0],
                y: fields.position[1],
                angle,
                curvature: fields.curvature(),
                strain: fields.strain(*measure) - reference_strain,
                vx: velocity.map(|v| view.velocity(v)[0]),
                vy: velocity.map(|v| view.velocity(v)[1]),
            });
        }
    }

    fn statics(&self, solution: &Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Static);
        let every = solution.states.len().div_ceil(FRAMES).max(1);
        for (i, (load, q)) in solution.states.iter().enumerate() {
            self.record(&mut trajectory, *load, q, None, self.system.energy(*load, q, None));
            if i % every == 0 || i + 1 == solution.states.len() {
                trajectory.frames.push(self.frame(*load, q));
            }
        }
        if let Some((_, q)) = solution.states.last() {
            trajectory.last = self.shape(q);
        }
        trajectory.history = solution.history.clone();
        trajectory.statistics = solution.statistics;
        for event in &solution.events {
            let (change, advice) = if event.after > event.before {
                ("loses", "beyond it the equilibrium found is unstable: a bifurcation or a limit point")
            } else {
                ("regains", "the path is back on a more stable branch")
            };
            trajectory.warnings.push(format!(
                "the tangent {change} definiteness at load factor {:.6}: {} unstable direction{} before, {} after; {advice}",
                event.load,
                event.before,
                if event.before == 1 { "" } else { "s" },
                event.after,
            ));
        }
        trajectory
    }

    fn stuck(&self, stuck: &Stuck, solution: &Solution) -> RunError {
        let (beam, s) = stuck.at;
        let advice = if stuck.step == 0.0 {
            "the undeformed structure can move without resistance: add a support, or give the beam a bending stiffness"
        } else {
            "near a limit point the load cannot grow: follow the path with `arc_length` in [analysis.static]; \
             if the shape is folded there, use more nodes or smaller loads"
        };
        RunError::NoEquilibrium {
            load: stuck.load,
            step: stuck.step,
            cause: stuck.failure.to_string(),
            beam: self.model.beams.get(beam).map(|b| b.name.clone()).unwrap_or_default(),
            s,
            advice: advice.into(),
            partial: Box::new(self.statics(solution)),
        }
    }

    fn dynamics(&self, settings: &Dynamic, solution: dynamics::Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Dynamic);
        trajectory.settings.push(("integrator".into(), settings.integrator.to_string()));
        let every = solution.states.len().div_ceil(FRAMES).max(1);
        for (i, state) in solution.states.iter().enumerate() {
            let (q, v) = (&state.q[..], Some(&state.v[..]));
            let energy = Energy { work: state.work, ..self.system.energy(1.0, q, v) };
            self.record(&mut trajectory, state.time, q, v, energy);
            if i % every == 0 || i + 1 == solution.states.len() {
                trajectory.frames.push(self.frame(state.time, q));
            }
        }
        if let Some(state) = solution.states.last() {
            trajectory.last = self.shape(&state.q);
        }
        for (watch, state) in &solution.events {
            let ProbeTarget { probe, axis, value } = settings.events[*watch].target.clone();
            trajectory.events.push(Event { time: state.time, probe, axis: ["x", "y"][axis].into(), value });
        }
        trajectory.history = solution.history;
        trajectory.statistics = solution.statistics;
        trajectory.saved = solution.checkpoint.map(|checkpoint| SavedState::new(self.system, checkpoint));
        trajectory
    }

    fn lost(&self, settings: &Dynamic, stuck: &dynamics::Stuck, solution: dynamics::Solution) -> RunError {
        let (beam, s) = stuck.at;
        let advice = match (settings.integrator.step_control(), stuck.failure) {
            (_, Failure::Unstable { .. }) => {
                "give `tolerance` instead of `step`, a step below the limit, or an implicit integrator"
            }
            (StepControl::Fixed(_), _) => {
                "give `tolerance` instead of `step`, so that steps are as short as the motion needs them; a smaller `step`; \
                 or more nodes where the beam bends most"
            }
            (StepControl::Tolerance(_), _) => {
                "the motion has no continuation that the beam model can follow: look at the states until here, and use more \
                 nodes or softer loads if the beam folds"
            }
        };
        RunError::NoStep {
            time: stuck.time,
            step: stuck.step,
            cause: stuck.failure.to_string(),
            beam: self.model.beams.get(beam).map(|b| b.name.clone()).unwrap_or_default(),
            s,
            advice: advice.into(),
            partial: Box::new(self.dynamics(settings, solution)),
        }
    }

    /// The reference with a mode added, its largest displacement a tenth of a beam length.
    fn mode_shape(&self, mode: &[f64]) -> Vec<Shape> {
        let largest = mode.chunks_exact(4).fold(0.0_f64, |m, d| m.max(d[0].hypot(d[1])));
        let factor = if largest > 0.0 { 0.1 * self.system.length() / largest } else { 0.0 };
        let q: Vec<f64> = self.system.reference().iter().zip(mode).map(|(q, m)| q + factor * m).collect();
        self.shape(&q)
    }

    fn modal(&self, modes: &modal::Modes) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Modal);
        trajectory.frequencies = modes.frequencies.clone();
        trajectory.modes = modes.shapes.iter().map(|m| self.mode_shape(m)).collect();
        trajectory.statistics.factorizations = modes.factorizations;
        trajectory
    }

    fn buckling(&self, modes: &buckling::Modes) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Buckling);
        trajectory.load_factors = modes.load_factors.clone();
        trajectory.modes = modes.shapes.iter().map(|m| self.mode_shape(m)).collect();
        trajectory.statistics.factorizations = modes.factorizations;
        trajectory
    }
}

/// The representative of an angle nearest to the one before.
fn unfold(angle: f64, before: Option<f64>) -> f64 {
    before.map_or(angle, |before| angle + TAU * ((before - angle) / TAU).round())
}
