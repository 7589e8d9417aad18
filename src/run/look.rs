//! Looking at the states of a system: probes, shapes, frames, and the trajectories made of them.

use super::RunError;
use super::angle::{self, unfold};
use crate::linear::Singular;
use crate::model::{ArcLength, Beam, Dynamic, Model, ProbeTarget, StepControl, StrainMeasure};
use crate::restart::SavedState;
use crate::solve::dynamics;
use crate::solve::newton::Failure;
use crate::solve::path::Stuck;
use crate::solve::statics::Solution;
use crate::system::{Fields, Reaction, System, SystemError, View};
use crate::trajectory::{
    AnalysisKind, EffectSeries, Energy, Event, Frame, ProbeSample, ProbeSeries, ReactionSeries, Shape,
    Trajectory,
};
use std::f64::consts::FRAC_PI_2;

/// Points at which shapes are sampled.
const SHAPE_POINTS: usize = 201;
/// Every so many of them are in a frame of the animation.
const FRAME_STRIDE: usize = 2;
/// Round-off of internal forces, relative to the loads, that leaves nothing to converge to.
const DROWNED: f64 = 1e-2;
/// An increment so small that did not vanish is round-off \[beam lengths\].
const STALLED: f64 = 1e-6;
/// What to try where a beam is crushed.
const TOO_SOFT: &str = "a beam is a model for small strains: use smaller loads, or a larger axial stiffness";
/// Frames kept for the animation.
const FRAMES: usize = 400;

/// Everything needed to look at states of one system.
pub(super) struct Look<'a> {
    model: &'a Model,
    pub(super) system: &'a System,
    shapes: Vec<View>,
    probes: Vec<Watched>,
}

/// A probe with the rows that see its point.
struct Watched {
    name: String,
    beam: usize,
    view: View,
    measure: StrainMeasure,
    /// ε of the stress-free state there.
    reference_strain: f64,
}

fn evenly(length: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| length * i as f64 / (count - 1) as f64).collect()
}

impl<'a> Look<'a> {
    pub(super) fn new(model: &'a Model, system: &'a System) -> Result<Self, RunError> {
        let view = |beam: usize, s: &[f64]| {
            let part = &system.beams()[beam];
            View::points(&part.basis, part.offset(), s).map_err(|e| SystemError::basis(&part.name, e))
        };
        let shapes = (0..system.beams().len())
            .map(|beam| view(beam, &evenly(system.beams()[beam].basis.length(), SHAPE_POINTS)))
            .collect::<Result<_, SystemError>>()?;
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
                Ok(Watched { name: probe.name.clone(), beam: probe.at.beam, view, measure, reference_strain })
            })
            .collect::<Result<_, SystemError>>()?;
        Ok(Self { model, system, shapes, probes })
    }

    /// The probe at which a path is to end, as (view, axis, value).
    pub(super) fn end_of_path(&self, arc: &ArcLength) -> Result<Option<(View, usize, f64)>, RunError> {
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
    pub(super) fn watches(&self, settings: &Dynamic) -> Result<Vec<dynamics::Watch>, RunError> {
        let watch = |event: &crate::model::Event| {
            let view = self.view_of(&event.target)?;
            let (axis, value) = (event.target.axis, event.target.value);
            Ok(dynamics::Watch { view, axis, value, crossing: event.crossing, stop: event.stop })
        };
        settings.events.iter().map(watch).collect()
    }

    pub(super) fn empty(&self, analysis: AnalysisKind) -> Trajectory {
        let reference = self.system.reference();
        Trajectory {
            title: self.model.title.clone(),
            analysis,
            complete: true,
            degrees_of_freedom: self.system.degrees_of_freedom(),
            settings: self.settings(),
            undeformed: self.shape(reference),
            outlines: self.outlines(),
            last: self.shape(reference),
            probes: self
                .probes
                .iter()
                .map(|probe| ProbeSeries { name: probe.name.clone(), samples: vec![] })
                .collect(),
            ..Trajectory::default()
        }
    }

    fn outlines(&self) -> Vec<Vec<[f64; 2]>> {
        let lines = self.model.parts.iter().map(|part| part.outline(self.system.length()));
        lines.filter(|line| !line.is_empty()).collect()
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
                    "{}; {} points {} (stretch), Gauss points {} (bend) a cell",
                    beam.strain,
                    if beam.gauss_points.lobatto { "Lobatto" } else { "Gauss" },
                    beam.gauss_points.stretch,
                    beam.gauss_points.bend
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

    /// The coordinates of coordinates and multipliers.
    pub(super) fn coordinates_of<'x>(&self, x: &'x [f64]) -> &'x [f64] {
        &x[..self.system.coordinates()]
    }

    /// All beams in the state `q`.
    pub(super) fn shape(&self, q: &[f64]) -> Vec<Shape> {
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

    /// The same with section forces, `x` being coordinates and scaled multipliers.
    pub(super) fn loaded(&self, parameter: f64, x: &[f64]) -> Vec<Shape> {
        let (q, multipliers) = x.split_at(self.system.coordinates());
        let mut shapes = self.shape(q);
        for (index, shape) in shapes.iter_mut().enumerate() {
            self.section_forces(parameter, index, self.shapes[index].all(q), shape);
            if let Some(forces) = self.system.axial_force(index, multipliers, &shape.s) {
                shape.axial_force = forces;
            }
        }
        shapes
    }

    /// N = ∂U/∂|r'| per length, EA ε for engineering strain and EA ε |r'| for Green's, and M = EI κ, each less what an actuation takes. N of an
    /// inextensible beam is that of its constraints.
    fn section_forces(
        &self,
        parameter: f64,
        beam: usize,
        fields: impl Iterator<Item = Fields>,
        shape: &mut Shape,
    ) {
        let Beam { section, strain, .. } = &self.model.beams[beam];
        let own = self.model.parts.iter().filter_map(|part| part.actuation(beam));
        let (own_strain, own_curvature) = own.fold((0.0, 0.0), |(e, k), (strain, curvature, law)| {
            let part = law.map_or_else(|| self.system.amplitude(parameter), |law| law.at(parameter)[0]);
            (e + part * strain, k + part * curvature)
        });
        let (ea, ei) = (section.axial_stiffness.unwrap_or(0.0), section.bending_stiffness.unwrap_or(0.0));
        let reference: Vec<f64> = if self.system.beams()[beam].straight {
            vec![0.0; shape.s.len()]
        } else {
            self.shapes[beam].all(self.system.reference()).map(|fields| fields.curvature()).collect()
        };
        for (i, fields) in fields.enumerate() {
            let stretch = match strain {
                StrainMeasure::Green => fields.gradient[0].hypot(fields.gradient[1]),
                StrainMeasure::Engineering => 1.0,
            };
            shape.axial_force.push(ea * (shape.strain[i] - own_strain) * stretch);
            shape.bending_moment.push(ei * (shape.curvature[i] - reference[i] - own_curvature));
        }
    }

    /// Adds one record of forces of supports and joints.
    fn record_reactions(&self, trajectory: &mut Trajectory, reactions: &[Reaction]) {
        if trajectory.reactions.is_empty() {
            let supports = (1..=self.model.supports.len()).map(|i| format!("support{i}"));
            let joints = (1..=self.model.joints.len()).map(|i| format!("joint{i}"));
            trajectory.reactions =
                supports.chain(joints).map(|name| ReactionSeries { name, samples: Vec::new() }).collect();
        }
        trajectory.reactions.iter_mut().zip(reactions).for_each(|(series, r)| series.samples.push(*r));
    }

    /// Adds one record of energies and forces of effects.
    fn record_effects(
        &self,
        trajectory: &mut Trajectory,
        parameter: f64,
        q: &[f64],
        velocity: Option<&[f64]>,
    ) {
        let effects = self.system.effects(parameter, q, velocity);
        if trajectory.effects.is_empty() {
            let series = |(name, energy, _): &(String, Option<f64>, [f64; 2])| EffectSeries {
                name: name.clone(),
                has_energy: energy.is_some(),
                samples: Vec::new(),
            };
            trajectory.effects = effects.iter().map(series).collect();
        }
        for (series, (_, energy, [fx, fy])) in trajectory.effects.iter_mut().zip(effects) {
            series.samples.push([energy.unwrap_or(0.0), fx, fy]);
        }
    }

    pub(super) fn frame(&self, parameter: f64, q: &[f64]) -> Frame {
        let beams = self.shapes.iter().map(|view| view.positions(FRAME_STRIDE, q).collect()).collect();
        Frame { parameter, beams }
    }

    pub(super) fn record(
        &self,
        trajectory: &mut Trajectory,
        parameter: f64,
        (before, q): (Option<&[f64]>, &[f64]),
        velocity: Option<&[f64]>,
        energy: Energy,
    ) {
        trajectory.parameter.push(parameter);
        trajectory.energy.push(energy);
        if self.model.outputs.effects {
            self.record_effects(trajectory, parameter, q, velocity);
        }
        for (Watched { beam, view, measure, reference_strain, .. }, series) in
            self.probes.iter().zip(&mut trajectory.probes)
        {
            let fields = view.fields(q);
            let turned =
                before.map_or(0.0, |before| angle::turn(&self.system.beams()[*beam], view.s()[0], before, q));
            let angle = unfold(fields.angle(), series.samples.last().map(|s| s.angle + turned));
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

    pub(super) fn statics(&self, solution: &Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Static);
        let every = solution.states.len().div_ceil(FRAMES).max(1);
        for (i, (load, x)) in solution.states.iter().enumerate() {
            let q = self.coordinates_of(x);
            if self.model.outputs.reactions {
                self.record_reactions(&mut trajectory, &self.system.static_reactions(*load, x));
            }
            let before = i.checked_sub(1).map(|i| self.coordinates_of(&solution.states[i].1));
            self.record(&mut trajectory, *load, (before, q), None, self.system.energy(*load, q, None));
            if i % every == 0 || i + 1 == solution.states.len() {
                trajectory.frames.push(self.frame(*load, q));
            }
        }
        if let Some((load, x)) = solution.states.last() {
            trajectory.last = self.loaded(*load, x);
        }
        trajectory.warnings.extend(self.folds(&trajectory.last));
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

    /// Strings that turn back within a cell. Nothing resists such a fold but the string's length, so that it may stay where a large step has left it.
    fn folds(&self, shapes: &[Shape]) -> Vec<String> {
        let strings = shapes.iter().zip(self.system.beams()).zip(&self.model.beams);
        let strings = strings.filter(|(_, beam)| beam.section.bending_stiffness.is_none());
        let folds = strings.filter_map(|((shape, part), _)| {
            let s = part.basis.nodes().windows(2).find_map(|cell| match *cell {
                [start, end] => {
                    let from = shape.s.partition_point(|s| *s < start).saturating_sub(1);
                    let to = (shape.s.partition_point(|s| *s <= end) + 1).min(shape.s.len());
                    let angles = shape.angle.get(from..to)?.iter();
                    let (low, high) =
                        angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
                    (high - low > FRAC_PI_2).then_some(start)
                }
                _ => None,
            })?;
            Some(format!(
                "string `{}` turns by more than a right angle within its cell from s = {s:.4} m: it may have folded back, \
                 which is no equilibrium of a real string; begin from an arc of its length, reach the load in smaller `steps`, \
                 or use more nodes",
                shape.beam
            ))
        });
        folds.collect()
    }

    pub(super) fn stuck(&self, stuck: &Stuck, solution: &Solution) -> RunError {
        let (beam, s) = stuck.at;
        let advice = match stuck.failure {
            _ if self.limited_by_round_off(&stuck.failure) => {
                "double precision cannot resolve these loads: the stiffness is so large, or nodes are so close, that the \
                 round-off of positions alone makes forces of their size; use fewer nodes, even spacing, or an axial \
                 stiffness that is not far beyond EI/h² with the spacing h"
            }
            Failure::Singular(_) if self.model.is_inextensible() && stuck.step == 0.0 => {
                "an inextensible beam cannot move between supports that hold both ends along its straight axis: let one slide, \
                 give the beam an `axial_stiffness`, or use more nodes"
            }
            Failure::Singular(Singular { row }) if row >= self.system.coordinates() => {
                "supports between nodes hold the same motion more than once: leave some out, or use more nodes"
            }
            Failure::Crushed { .. } => TOO_SOFT,
            Failure::NotFinite if stuck.step == 0.0 => {
                "a load or a stiffness is no number, or beyond what its products leave room for: use other units"
            }
            _ if stuck.step == 0.0 => {
                "the undeformed structure can move without resistance: add a support, or give the beam a bending stiffness"
            }
            _ => {
                "near a limit point the load cannot grow: follow the path with `arc_length` in [analysis.static]; \
                 if the shape is folded there, use more nodes or smaller loads"
            }
        };
        RunError::NoEquilibrium {
            load: stuck.load,
            step: stuck.step,
            cause: stuck.failure.to_string(),
            beam: self.model.beams.get(beam).map(|b| b.name.clone()).unwrap_or_default(),
            s,
            advice: advice.into(),
            partial: Box::new(Trajectory { complete: false, ..self.statics(solution) }),
        }
    }

    /// Whether increments are small but do not vanish, or the round-off of internal forces compares with the loads, so that there is nothing
    /// to converge to.
    fn limited_by_round_off(&self, failure: &Failure) -> bool {
        let mut loads = vec![0.0; self.system.coordinates()];
        self.system.add_load_rate(1.0, self.system.reference(), &mut loads);
        let length = self.system.length();
        let total: f64 = loads.chunks_exact(4).map(|f| f[0].hypot(f[1]).max(f[2].hypot(f[3]) / length)).sum();
        matches!(failure, Failure::TooSlow { last, .. } if *last < STALLED)
            || total > 0.0 && self.system.round_off() > DROWNED * total
    }

    pub(super) fn dynamics(&self, settings: &Dynamic, solution: dynamics::Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Dynamic);
        trajectory.settings.push(("integrator".into(), settings.integrator.to_string()));
        let every = solution.states.len().div_ceil(FRAMES).max(1);
        let mut motion =
            if self.model.outputs.reactions { dynamics::motion::Motion::new(self.system).ok() } else { None };
        for (i, state) in solution.states.iter().enumerate() {
            if let Some(motion) = &mut motion {
                let reactions = motion.reactions(state).unwrap_or_default();
                self.record_reactions(&mut trajectory, &reactions);
            }
            let (q, v) = (&state.q[..], Some(&state.v[..]));
            let energy = self.system.energy(state.time, q, v);
            let energy = Energy { work: state.work, lost: state.lost, ..energy };
            self.record(&mut trajectory, state.time, (None, q), v, energy);
            if i % every == 0 || i + 1 == solution.states.len() {
                trajectory.frames.push(self.frame(state.time, q));
            }
        }
        if let Some(state) = solution.states.last() {
            let mut x = state.q.clone();
            if self.system.has_nonlinear_constraints()
                && let Ok(mut motion) = dynamics::motion::Motion::new(self.system)
                && motion.reactions(state).is_ok()
            {
                x.extend_from_slice(motion.multipliers());
            }
            trajectory.last = self.loaded(state.time, &x);
        }
        for (watch, state) in &solution.events {
            let ProbeTarget { probe, axis, value } = settings.events[*watch].target.clone();
            let axis = ["x", "y"][axis].into();
            trajectory.events.push(Event::Crossing { time: state.time, probe, axis, value });
        }
        let contacts: Vec<String> = self.system.contacts().collect();
        for dynamics::Change { contact, touches, time, blow } in solution.contacts.iter().copied() {
            let contact = contacts.get(contact).cloned().unwrap_or_default();
            trajectory.events.push(Event::Contact { time, contact, touches, blow });
        }
        trajectory.events.sort_by(|a, b| a.time().total_cmp(&b.time()));
        let divided = solution.statistics.rejected_steps;
        if divided > 0 && matches!(settings.integrator.step_control(), StepControl::Fixed(_)) {
            let smallest = solution.history.iter().map(|r| r.step).fold(f64::INFINITY, f64::min);
            trajectory.warnings.push(format!(
                "the step was divided {divided} time{}, down to {smallest:.1e} s, because its equations could not be solved: \
                 give `tolerance` instead of `step`, or a smaller `step`",
                if divided == 1 { "" } else { "s" }
            ));
        }
        trajectory.history = solution.history;
        trajectory.statistics = solution.statistics;
        trajectory.saved = solution.checkpoint.map(|checkpoint| SavedState::new(self.system, checkpoint));
        trajectory
    }

    pub(super) fn lost(
        &self,
        settings: &Dynamic,
        stuck: &dynamics::Stuck,
        solution: dynamics::Solution,
    ) -> RunError {
        let (beam, s) = stuck.at;
        let advice = match settings.integrator.step_control() {
            _ if matches!(stuck.failure, Failure::Crushed { .. }) => TOO_SOFT,
            _ if stuck.failure == Failure::NotFinite && stuck.step == 0.0 => {
                "a velocity, a load or a stiffness is beyond what its products leave room for: start from another state, or use other units"
            }
            StepControl::Fixed(_) => {
                "give `tolerance` instead of `step`, so that steps are as short as the motion needs them; a smaller `step`; \
                 or more nodes where the beam bends most"
            }
            StepControl::Tolerance(_) => {
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
            partial: Box::new(Trajectory { complete: false, ..self.dynamics(settings, solution) }),
        }
    }
}
