//! Evaluates states of a system: probes, shapes, frames, and the trajectories made of them.

mod energy;
mod equilibria;
mod failure;
mod motion;
mod shape;

use super::coils::coils;
use super::locking::Locking;
use super::loose::Loose;
use super::{Detail, RunError};
use super::{fields, strings, surfaces};
use crate::assembly::{BuildError, InternalVariables};
use crate::model::{ArcLength, Model, ProbeTarget, StrainMeasure};
use crate::results::{
    AnalysisKind, EffectSeries, Energy, Frame, ProbeSample, ProbeSeries, ReactionSeries, Run, Trajectory,
};
use crate::system::{Reaction, System, View, turning, unfold};

/// A frame of the animation takes every so many of these points.
const FRAME_STRIDE: usize = 2;
/// Largest number of states, evenly spread, that are checked for locking.
const LOOKED_AT: usize = 400;

/// Everything needed to evaluate states of one system.
pub(super) struct Sampler<'a> {
    pub(super) model: &'a Model,
    pub(super) system: &'a System,
    shapes: Vec<View>,
    /// Of each beam, where every record is kept; none where that was not asked for.
    stations: Vec<View>,
    pub(super) probes: Vec<ProbePoint>,
    locking: Locking,
    loose: Loose,
    /// How many frames are kept.
    frames: usize,
    /// Whether the results are compared with those of another mesh.
    compared: bool,
    /// Directions at the probes in the state from which statics starts, with full turns included;
    /// empty or not finite where they are not known.
    pub(super) angles: Vec<f64>,
}

/// A probe with the shape functions at its point.
pub(super) struct ProbePoint {
    pub(super) name: String,
    pub(super) beam: usize,
    pub(super) view: View,
    pub(super) measure: StrainMeasure,
    /// ε of the stress-free state there.
    pub(super) reference_strain: f64,
}

/// From where the turns of directions are counted.
#[derive(Clone, Copy)]
pub(super) enum History<'h> {
    /// Since the record before.
    Before {
        load: f64,
        q: &'h [f64],
        /// By how much all nodes have turned since then \[rad\]; empty where that is to be found.
        turned: &'h [f64],
    },
    /// Directions at all probes, with full turns included already.
    Angles(&'h [f64]),
}

/// Whether record `i` of `count` is kept, if about `most` of them are, evenly spread and with the
/// last.
fn is_among(i: usize, count: usize, most: usize) -> bool {
    most > 0 && (i.is_multiple_of(count.div_ceil(most)) || i + 1 == count)
}

fn evenly(length: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| length * i as f64 / (count - 1) as f64).collect()
}

impl<'a> Sampler<'a> {
    pub(super) fn new(
        model: &'a Model,
        system: &'a System,
        Detail { frames, shape_points, stations, compared }: Detail<'_>,
    ) -> Result<Self, RunError> {
        let view = |beam: usize, s: &[f64]| {
            let part = &system.beams()[beam];
            View::points(&part.basis, part.offset(), s).map_err(|e| BuildError::basis(&part.name, e))
        };
        let shapes = (0..system.beams().len())
            .map(|beam| view(beam, &evenly(system.beams()[beam].basis.length(), shape_points.max(2))))
            .collect::<Result<_, BuildError>>()?;
        let stations = stations.iter().take(system.beams().len()).enumerate();
        let stations = stations.map(|(beam, s)| view(beam, s)).collect::<Result<_, BuildError>>()?;
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
                Ok(ProbePoint { name: probe.name.clone(), beam, view, measure, reference_strain })
            })
            .collect::<Result<_, BuildError>>()?;
        let locking = Locking::new(model, system)?;
        let loose = Loose::new(model, system)?;
        Ok(Self {
            model,
            system,
            shapes,
            stations,
            probes,
            locking,
            loose,
            frames,
            compared,
            angles: Vec::new(),
        })
    }

    /// The probe at which a path is to end, as (view, axis, value).
    pub(super) fn end_of_path(&self, arc: &ArcLength) -> Result<Option<(View, usize, f64)>, RunError> {
        let Some(target) = &arc.until_probe else { return Ok(None) };
        Ok(Some((self.view_of(target)?, target.axis, target.value)))
    }

    fn view_of(&self, target: &ProbeTarget) -> Result<View, RunError> {
        Ok(self.probes[self.probe_named(&target.probe)?].view.clone())
    }

    pub(super) fn probe_named(&self, name: &str) -> Result<usize, RunError> {
        let found = self.probes.iter().position(|probe| probe.name == name);
        found.ok_or_else(|| RunError::NoSuchProbe {
            probe: name.to_owned(),
            known: self.probes.iter().map(|probe| probe.name.as_str()).collect::<Vec<_>>().join(", "),
        })
    }

    pub(super) fn empty(&self, analysis: AnalysisKind) -> Trajectory {
        let undeformed = self.shape(self.system.reference());
        let last = undeformed.clone();
        let run = Run {
            title: self.model.title.clone(),
            analysis,
            complete: true,
            degrees_of_freedom: self.system.degrees_of_freedom(),
            warnings: self
                .left_out(analysis)
                .into_iter()
                .chain(strings::couples(self.model))
                .chain(surfaces::couples(self.model, self.system))
                .chain(coils(self.model))
                .collect(),
            settings: self.settings(),
            undeformed,
            outlines: self.outlines(),
            ..Run::default()
        };
        Trajectory {
            run,
            last,
            probes: self
                .probes
                .iter()
                .map(|probe| ProbeSeries { name: probe.name.clone(), samples: vec![] })
                .collect(),
            ..Trajectory::default()
        }
    }

    /// A message on parts of the model that the analysis ignores.
    fn left_out(&self, analysis: AnalysisKind) -> Option<String> {
        let name = match analysis {
            AnalysisKind::Static => "statics",
            AnalysisKind::Modal => "a modal analysis",
            AnalysisKind::Buckling => "a buckling analysis",
            AnalysisKind::Dynamic => return None,
        };
        let mut names: Vec<String> = self
            .system
            .left_out()
            .map(|(kind, beam)| format!("`{}` of beam `{beam}`", kind.name()))
            .collect();
        names.extend((!self.model.initial_velocities.is_empty()).then(|| "`initial_velocity`".to_owned()));
        names.sort();
        names.dedup();
        let verb = if names.len() == 1 { "takes" } else { "take" };
        (!names.is_empty()).then(|| {
            format!(
                "{} {verb} no part in {name}, which knows no velocities: [analysis.dynamic] computes the motion with all of it",
                names.join(", ")
            )
        })
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
        let mut kinds: Vec<&str> = Vec::new();
        for name in inventory.effects.iter().map(|effect| effect.kind.name()) {
            if !kinds.contains(&name) {
                kinds.push(name);
            }
        }
        settings.push(("effects".into(), kinds.join(", ")));
        settings.push(("linear solver".into(), inventory.solver.into()));
        settings
    }

    /// The coordinates in a vector of all unknowns, without the multipliers behind them.
    pub(super) fn coordinates_of<'x>(&self, x: &'x [f64]) -> &'x [f64] {
        &x[..self.system.coordinates()]
    }

    /// Beam and arc length \[m\] of each probe.
    pub(super) fn probe_places(&self) -> impl Iterator<Item = (usize, f64)> {
        self.probes.iter().map(|probe| (probe.beam, probe.view.s()[0]))
    }

    /// The arc lengths \[m\] of a frame's points on a beam, and their velocities \[m/s\].
    pub(super) fn frame_places(&self, beam: usize, v: Option<&[f64]>) -> (Vec<f64>, Vec<[f64; 2]>) {
        let view = &self.shapes[beam];
        let s = view.s().iter().copied().step_by(FRAME_STRIDE).collect();
        (s, v.map_or_else(Vec::new, |v| view.positions(FRAME_STRIDE, v).collect()))
    }

    /// Adds one record of forces of supports and joints.
    fn record_reactions(&self, trajectory: &mut Trajectory, reactions: &[Reaction]) {
        if trajectory.reactions.is_empty() {
            let [of_supports, of_joints] = &self.model.numbers;
            let number = |numbers: &[usize], i: usize| numbers.get(i).copied().unwrap_or(i + 1);
            let supports = 0..self.model.supports.len();
            let supports = supports.map(|i| format!("support{}", number(of_supports, i)));
            let joints = (0..self.model.joints.len()).map(|i| format!("joint{}", number(of_joints, i)));
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
        (velocity, variables): (Option<&[f64]>, &InternalVariables),
    ) {
        let effects = self.system.effects(parameter, q, velocity, variables);
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
        (history, q): (History<'_>, &[f64]),
        (velocity, variables): (Option<&[f64]>, &InternalVariables),
        energy: Energy,
    ) {
        trajectory.parameter.push(parameter);
        trajectory.energy.push(energy);
        if !self.stations.is_empty() {
            let beams = self.stations.iter().enumerate();
            trajectory.stations.push(beams.map(|(beam, view)| self.seen(beam, view, q)).collect());
        }
        if self.model.outputs.effects {
            self.record_effects(trajectory, parameter, q, (velocity, variables));
        }
        let records = trajectory.parameter.len();
        self.see_probes(&mut trajectory.probes, (records, parameter), (history, q), velocity);
    }

    /// Adds what the probes see to their `series`: in this one of so many `records`, at a load factor or time.
    fn see_probes(
        &self,
        series: &mut [ProbeSeries],
        (records, load): (usize, f64),
        (history, q): (History<'_>, &[f64]),
        velocity: Option<&[f64]>,
    ) {
        let mut of_strings = vec![None; self.system.beams().len()];
        let mut turns = None;
        for (probe, (ProbePoint { beam, view, measure, reference_strain, .. }, series)) in
            self.probes.iter().zip(series).enumerate()
        {
            let fields = view.fields(q);
            // A string that nothing loads yet has no shape of its own: the turns of the first two records count from where it was laid out.
            let is_first = records <= 2 && self.system.starts_bent();
            let is_slack = is_first && self.model.beams[*beam].section.bending_stiffness.is_none();
            let start = is_slack.then(|| self.system.start());
            let known = match history {
                History::Angles(angles) => angles.get(probe).copied().filter(|angle| angle.is_finite()),
                History::Before { .. } => None,
            };
            let angle = known.unwrap_or_else(|| {
                let (now, part) = (fields.angle(), &self.system.beams()[*beam]);
                let node = turning::nearest(part, view.s()[0]);
                match (start, history) {
                    (Some(start), _) => {
                        let turns = of_strings[*beam].get_or_insert_with(|| turning::turns(part, start, q));
                        unfold(now, Some(view.fields(start).angle() + turns[node]))
                    }
                    (None, History::Before { load: before, q: shape, turned }) => {
                        let node = part.first_node + node;
                        let found = || {
                            turns.get_or_insert_with(|| self.system.node_turns((before, shape), (load, q)))
                                [node]
                        };
                        let turn = turned.get(node).copied().unwrap_or_else(found);
                        unfold(now, series.samples.last().map(|sample| sample.angle + turn))
                    }
                    (None, History::Angles(_)) => unfold(now, None),
                }
            });
            series.samples.push(ProbeSample {
                x: fields.position[0],
                y: fields.position[1],
                angle,
                curvature: fields.curvature(),
                strain: fields.strain(*measure) - reference_strain,
                vx: velocity.map(|v| view.at_point(v)[0]),
                vy: velocity.map(|v| view.at_point(v)[1]),
            });
        }
    }

    /// Looks at force fields in states, coordinates and times \[s\].
    fn see_fields(&self, run: &mut Run, states: &[(&[f64], f64)]) {
        let missed = fields::missed(self.model, self.system, states);
        run.misses_fields = !missed.is_empty();
        run.warnings.extend(missed);
    }

    /// Whether the results are compared with those of another mesh, so that single runs need not tell what cells miss.
    pub(super) fn is_compared(&self) -> bool {
        self.compared
    }

    /// The points whose directions are watched: those of the probes.
    pub(super) fn directions(&self) -> Vec<View> {
        self.probes.iter().map(|probe| probe.view.clone()).collect()
    }
}
