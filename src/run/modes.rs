//! Vibrations and critical loads of a model.

use super::laws::{at_corners, divided, within_cells};
use super::sampler::Sampler;
use super::start::Start;
use super::{Options, RunError, Solve, Stopwatch, Watch, memory, timed, waves};
use crate::assembly::{InternalVariables, Part, Side, nodes};
use crate::effect::Tendon;
use crate::model::{About, Analysis, Buckling, Displacement, Modal, Model, Static};
use crate::numeric::plain;
use crate::results::{
    AnalysisKind, BucklingMode, CriticalLoads, ModeShape, Shape, Statistics, Trajectory, Vibration,
    Vibrations,
};
use crate::solve::eigen::EigenError;
use crate::solve::{buckling, modal, statics};
use crate::system::System;
use std::any::Any;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Accuracy of the equilibrium: as far as round-off lets Newton's method come, because stress, and
/// with it the stiffness, is a small difference of large numbers.
const TO_THE_END: f64 = 1e-14;
/// A long step past the critical load of a nearly perfect structure may end on the unstable branch
/// of a perfect one. Before a state is refused as unstable, its path is followed again in so many
/// parts of the load.
const FINER: [usize; 2] = [20, 200];
/// Turn of a node before buckling up to which the linear solution is trusted \[rad\].
const STRAIGHT: f64 = 0.1;
/// What round-off may change a frequency by, relative to it, before a warning says so.
const UNSURE: f64 = 1e-3;
/// Axial strain before buckling up to which it is trusted; critical loads err by as much.
const STRAINED: f64 = 0.05;
/// Part of themselves by which loads may change before buckling, as those do that turn with the beam.
const CHANGED: f64 = STRAIGHT;
/// Part of the first critical load up to which forces of springs and obstacles in the unloaded state do
/// not matter.
const NEGLIGIBLE: f64 = 1e-3;

impl Solve for Modal {
    type Results = Vibrations;

    fn solve(&self, model: &Model, options: Options<'_>) -> Result<Vibrations, RunError> {
        if self.about == About::Reference {
            options.refuses_a_start("modal analysis about the reference")?;
        }
        let analysis = Analysis::Modal(*self);
        let mut stopwatch = Stopwatch::start();
        memory::check(model, &analysis)?;
        let start = Start::new(model, &analysis, &options)?;
        let mut sampler = Sampler::new(&start.model, &start.system, options.detail())?;
        sampler.angles = start.angles();
        stopwatch.built();
        let mut watch = Watch::new(options.observer);
        let outcome = match self.about {
            About::Reference => sampler.about_reference(self.count),
            // No equilibrium has to be found to see it.
            About::Equilibrium if !start.system.is_symmetric() => {
                Err(EigenError::NotSymmetric { analysis: "modal" }.into())
            }
            About::Equilibrium => {
                // The stiffness of a cell in which it jumps is that of its parts.
                let about = &|model: &Model| start.with_model(model, &analysis, options.cache);
                sampler.about_equilibrium(self.count, about, &mut watch)
            }
        };
        stopwatch.solved();
        timed(outcome, |vibrations| &mut vibrations.equilibrium, &watch, stopwatch)
    }
}

impl Solve for Buckling {
    type Results = CriticalLoads;

    fn solve(&self, model: &Model, options: Options<'_>) -> Result<CriticalLoads, RunError> {
        let analysis = Analysis::Buckling(*self);
        let mut stopwatch = Stopwatch::start();
        memory::check(model, &analysis)?;
        let start = Start::new(model, &analysis, &options)?;
        if start.system.is_fading() {
            return Err(RunError::Unbalanced);
        }
        let mut sampler = Sampler::new(&start.model, &start.system, options.detail())?;
        sampler.angles = start.angles();
        stopwatch.built();
        let modes = buckling::solve(&start.system, self.count)?;
        stopwatch.solved();
        if modes.prestress > NEGLIGIBLE * modes.load_factors.first().copied().unwrap_or(0.0) {
            return Err(RunError::Unbalanced);
        }
        let mut loads = sampler.critical_loads(&modes);
        loads.unloaded.run.seconds = stopwatch.finish();
        Ok(loads)
    }
}

impl Sampler<'_> {
    /// The `count` lowest vibrations about the stress-free state.
    fn about_reference(&self, count: usize) -> Result<Vibrations, RunError> {
        let mut trajectory = self.empty(AnalysisKind::Modal);
        trajectory.last = self.unloaded();
        let mut x = self.system.reference().to_vec();
        x.resize(x.len() + self.system.multipliers(), 0.0);
        self.modal(trajectory, self.system, (0.0, &x, &InternalVariables::default()), count)
    }

    /// The `count` lowest vibrations about the equilibrium under all loads, which is found first. `equations` gives those
    /// of another model with the same unknowns.
    fn about_equilibrium(
        &self,
        count: usize,
        equations: &dyn Fn(&Model) -> Result<System, RunError>,
        watch: &mut Watch<'_>,
    ) -> Result<Vibrations, RunError> {
        let report =
            &mut |load: f64, step: f64, statistics: &Statistics| watch.goes_on(load, 1.0, step, statistics);
        let (mut parts, mut finer) = (1, FINER.into_iter());
        loop {
            let steps = (parts > 1).then_some(parts);
            let settings = Static { tolerance: Some(TO_THE_END), steps, ..Static::default() };
            let mut solution = statics::solve(self.system, &settings, None, &mut *report);
            if let Some(stuck) = &solution.stuck {
                return Err(self.stuck(stuck, &solution, false));
            }
            // Of the path to the last equilibrium only the turns matter that the probes have made on it.
            let angles = self.last_angles(&solution);
            solution.keep_last();
            let mut trajectory = self.equilibria(AnalysisKind::Modal, &solution, &angles);
            let variables = solution.variables.last().cloned().unwrap_or_default();
            let vibrations = match solution.states.last() {
                Some((load, x)) if *load == 1.0 => {
                    let actions = self.system.static_actions(*load, x, &variables);
                    let q = self.coordinates_of(x);
                    let forces_at = |beam: usize, s: f64| {
                        let cut = self.cut_shape(beam, &[s], &[Side::Right], q, &actions[beam]);
                        Some([*cut.axial_force.first()?, cut.bending_moment.first().copied().unwrap_or(0.0)])
                    };
                    let divided = divided(self.model, &trajectory.last, &forces_at);
                    let inside = divided.as_ref().and_then(|divided| within_cells(divided, self.system));
                    trajectory.run.warnings.extend(inside);
                    let system = divided.as_ref().map(equations).transpose()?;
                    let system = system.as_ref().unwrap_or(self.system);
                    self.modal(trajectory, system, (*load, x, &variables), count)
                }
                // Stopped on the way.
                _ => Ok(Vibrations { equilibrium: trajectory, modes: Vec::new() }),
            };
            match (vibrations, finer.next()) {
                (Err(RunError::Eigen(EigenError::Unstable { .. })), Some(next)) => parts = next,
                (found, _) => return found,
            }
        }
    }

    fn modal(
        &self,
        mut equilibrium: Trajectory,
        system: &System,
        (load, x, variables): (f64, &[f64], &InternalVariables),
        count: usize,
    ) -> Result<Vibrations, RunError> {
        let run = &mut equilibrium.run;
        let left_out = [
            (self.system.has_loads(), "loads"),
            (
                self.model.supports.iter().any(|support| support.displacement != Displacement::default()),
                "`move` of supports",
            ),
            (self.model.parts.iter().any(shortens), "`length` or `shortening` of tendons"),
        ];
        if load == 0.0 {
            run.warnings.extend(left_out.into_iter().filter(|(is, _)| *is).map(|(_, what)| {
                format!(
                    "{what} take no part in vibrations about the stress-free state: `about = \"equilibrium\"` in [analysis.modal] finds those about the \
                     equilibrium under them"
                )
            }));
        }
        let unbalanced = if load == 0.0 { self.system.force_at_start(buckling::STRESSING) } else { 0.0 };
        if unbalanced > 0.0 {
            run.warnings.push(format!(
                "springs or obstacles act with {unbalanced:.3e} N in the stress-free state, which is no equilibrium, and what this stresses takes no part \
                 in vibrations about it: `about = \"equilibrium\"` in [analysis.modal] finds those about the state to which they lead"
            ));
        }
        let about = if load == 0.0 { "the stress-free state" } else { "the equilibrium under all loads" };
        run.settings.push(("vibrations about".into(), about.into()));
        run.warnings.extend(at_corners(self.model, &equilibrium.last, &run.undeformed));
        run.warnings.extend(lying_along(system, self.coordinates_of(x)));
        let modes = modal::solve(system, load, x, variables, count)?;
        run.statistics.factorizations += modes.factorizations;
        run.warnings.extend(unsure("frequency", &modes.round_off, self.model));
        let q = self.coordinates_of(x);
        let shapes: Vec<&[f64]> = modes.shapes.iter().map(Vec::as_slice).collect();
        let shapes = self.mode_shapes(&equilibrium.last, q, &shapes);
        let vibrations = modes.frequencies.iter().zip(&modes.round_off).zip(shapes);
        let vibration = |((&frequency, &round_off), shape)| Vibration { frequency, round_off, shape };
        let modes: Vec<Vibration> = vibrations.map(vibration).collect();
        // With φᵀ M φ = 1 twice the elastic energy is ω².
        if !self.is_compared() {
            let of = |mode: &'_ Vibration| Some((TAU * mode.frequency).powi(2));
            let shapes = modes.iter().map(|mode| (&mode.shape[..], of(mode)));
            let told = waves::too_short((self.model, self.system), "frequency", 0.5, shapes);
            equilibrium.run.warnings.extend(told);
        }
        Ok(Vibrations { equilibrium, modes })
    }

    fn critical_loads(&self, modes: &buckling::Modes) -> CriticalLoads {
        let mut unloaded = self.empty(AnalysisKind::Buckling);
        let x = buckling::base(self.system);
        let q = self.coordinates_of(&x);
        let (_, variables) = self.system.start_history();
        unloaded.last = self.loaded(q, &self.system.static_actions(0.0, &x, &variables));
        unloaded.run.statistics.factorizations = modes.factorizations;
        if modes.load_factors.is_empty() {
            unloaded.run.warnings.push(
                "no load factor makes the structure buckle: the loads press on nothing that could give way (a tendon goes along with its beam), \
                 unless they are turned round (negative factors are not sought)"
                    .into(),
            );
        }
        unloaded.run.warnings.extend(unsure("load factor", &modes.round_off, self.model));
        if let Some(above) = modes.hidden {
            unloaded.run.warnings.push(format!(
                "there are fewer load factors than were asked for: above {above:.2e} the round-off of the stiffness hides them"
            ));
        }
        let strained = unloaded.last.iter().flat_map(|shape| &shape.strain);
        let strained = strained.fold(0.0, |largest: f64, strain| largest.max(strain.abs()));
        unloaded.run.warnings.extend(beyond_the_linear(modes, strained));
        let corners = at_corners(self.model, &unloaded.last, &unloaded.run.undeformed);
        unloaded.run.warnings.extend(corners);
        unloaded.run.warnings.extend(lying_along(self.system, q));
        let divided = divided(self.model, &unloaded.last, &|_, _| None);
        unloaded.run.warnings.extend(divided.and_then(|divided| within_cells(&divided, self.system)));
        let scaled = |mode: &Vec<f64>| -> Vec<f64> {
            let largest = nodes(mode).map(|node| node.shift()).fold(0.0, f64::max);
            let by = if largest > 0.0 { largest } else { 1.0 };
            mode.iter().map(|change| change / by).collect()
        };
        let scaled: Vec<Vec<f64>> = modes.shapes.iter().map(scaled).collect();
        let shapes: Vec<&[f64]> = scaled.iter().map(Vec::as_slice).collect();
        let shapes = self.mode_shapes(&unloaded.last, q, &shapes);
        let loads = modes.load_factors.iter().zip(&modes.round_off).zip(shapes);
        let mode = |((&load_factor, &round_off), shape)| BucklingMode { load_factor, round_off, shape };
        let modes: Vec<BucklingMode> = loads.map(mode).collect();
        if !self.is_compared() {
            let shapes = modes.iter().map(|mode| (&mode.shape[..], None));
            let told = waves::too_short((self.model, self.system), "critical load", 1.0, shapes);
            unloaded.run.warnings.extend(told);
        }
        CriticalLoads { unloaded, modes }
    }

    /// The stress-free state.
    fn unloaded(&self) -> Vec<Shape> {
        let reference = self.system.reference();
        self.loaded(reference, &self.system.static_actions(0.0, reference, &InternalVariables::default()))
    }

    /// Each of the modes of the state `q`, at the arc lengths of its `shapes`.
    fn mode_shapes(&self, shapes: &[Shape], q: &[f64], modes: &[&[f64]]) -> Vec<Vec<ModeShape>> {
        let mut all = vec![Vec::with_capacity(shapes.len()); modes.len()];
        for (beam, shape) in shapes.iter().enumerate() {
            let of_beam = self.changes(beam, &shape.s, q, modes);
            all.iter_mut().zip(of_beam).for_each(|(mode, shape)| mode.push(shape));
        }
        all
    }
}

/// The warning about the value of which round-off may change the largest part, if that is not small.
fn unsure(what: &str, round_off: &[f64], model: &Model) -> Option<String> {
    let most = |(number, change): (usize, &f64)| (number + 1, *change);
    let (number, change) = round_off.iter().enumerate().map(most).max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let stretches = model.beams.iter().any(|beam| beam.section.axial_stiffness.is_some());
    let or = if stretches { ", or leave out an `axial_stiffness` that is of no interest" } else { "" };
    (change > UNSURE).then(|| {
        format!(
            "round-off of the stiffness may change {what} {number} by {:.1} %: use fewer elements or nodes, and none that are close to each \
             other{or}",
            100.0 * change
        )
    })
}

/// Whether a part is a tendon that is shorter than it would be on the stress-free beam.
fn shortens(part: &Arc<dyn Part>) -> bool {
    let part: &dyn Any = part.as_ref();
    part.downcast_ref::<Tendon>()
        .and_then(|tendon| tendon.shortening)
        .is_some_and(|shortening| shortening != 0.0)
}

/// The warning about critical loads at which the linear solution would turn or strain the beams, or
/// change the loads, by more than it may, where they are `strained` already by what acts before.
fn beyond_the_linear(modes: &buckling::Modes, strained: f64) -> Option<String> {
    let numbered = || modes.load_factors.iter().zip(1..);
    let (turned, number) = numbered().find(|(load, _)| *load * modes.turn > STRAIGHT).unzip();
    let strain = |load: f64| strained + load * modes.strain;
    let (strained, second) = numbered().find(|(load, _)| strain(**load) > STRAINED).unzip();
    let changed = numbered().zip(&modes.changes).find(|(_, change)| **change > CHANGED);
    let which = |number: Option<usize>| match number {
        Some(1) | None => String::new(),
        Some(number) => format!("critical loads from number {number} on are beyond the linear solution: "),
    };
    match (turned, strained, changed) {
        (Some(load), ..) => Some(format!(
            "{}the loads turn the beam by {:.2} rad before it buckles at load factor {}, by the linear solution, which holds for small turns only: \
             follow the path with `arc_length` in [analysis.static], which finds limit points and bifurcations of the bent structure",
            which(number),
            load * modes.turn,
            plain(*load, 6),
        )),
        (None, _, Some(((load, number), change))) => Some(format!(
            "{}loads, or the stiffness of loads or contacts, change by {:.0} % before the beam buckles at load factor {}, by the linear \
             solution, which takes them to be as they are: follow the path with `arc_length` in [analysis.static], which finds limit points and bifurcations as all acts on the way",
            which(Some(number)),
            100.0 * change,
            plain(*load, 6),
        )),
        (None, Some(load), None) => Some(format!(
            "{}the loads strain the beam by {:.2} before it buckles at load factor {}, by the linear solution, which holds for small strains only, as \
             does the beam itself: give a larger `axial_stiffness`, or ask for fewer critical loads",
            which(second),
            strain(*load),
            plain(*load, 6),
        )),
        (None, None, None) => None,
    }
}
/// The warning on a beam that lies along an obstacle and presses it by nothing, in a state about which a linear solution is sought.
fn lying_along(system: &System, q: &[f64]) -> Option<String> {
    let contact = system.lies_along(q)?;
    Some(format!(
        "contact `{}` just touches along a stretch of its beam and presses it by nothing: round-off decides whether its stiffness acts there, or where; \
         move the obstacle away, or load the beam so that it rests on it or leaves it",
        system.contact_names().nth(contact)?
    ))
}
