//! Evaluates states of a system: probes, shapes, frames, and the trajectories made of them.

use super::electrodes::pulled_in;
use super::laws::Reach;
use super::locking::{Locking, unheld};
use super::loose::Loose;
use super::stability;
use super::tendons::Tendons;
use super::{Detail, RunError};
use super::{fields, imbalance, steps, strings, surfaces};
use crate::assembly::{Actions, BuildError, InternalVariables, Kind, Side, TendonPath, nodes, remaining};
use crate::linear::Singular;
use crate::model::{
    ArcLength, Beam, Dynamic, EventCondition, EventKind, Model, ProbeTarget, StepControl, StrainMeasure,
};
use crate::numeric::plain;
use crate::restart::SavedState;
use crate::results::{
    AnalysisKind, EffectSeries, Energy, Event, Frame, LayerStress, ModeShape, ProbeSample, ProbeSeries,
    ReactionSeries, Run, Shape, Trajectory,
};
use crate::solve::Work;
use crate::solve::dynamics;
use crate::solve::newton::Failure;
use crate::solve::path::NoStep;
use crate::solve::resume::Holding;
use crate::solve::statics::{Solution, Unreached};
use crate::system::{Change, Fields, Reaction, System, View, turning, unfold};
use nalgebra::Vector2;
use std::f64::consts::FRAC_PI_2;

/// Places nearer to each other than this, in beam lengths, are one.
const SAME_PLACE: f64 = 1e-9;
/// A frame of the animation takes every so many of these points.
const FRAME_STRIDE: usize = 2;
/// A load factor of next to nothing.
const NEXT_TO_NOTHING: f64 = 1e-3;
/// Part of the loads beyond which the round-off of internal forces prevents convergence.
const DROWNED: f64 = 1e-2;
/// Increments below this that do not vanish are round-off \[beam lengths\].
const STALLED: f64 = 1e-6;
/// What to try where a beam has no stiffness along its axis against what loads it.
const WITHOUT_BOUNDS: &str = "an `axial_law` resists tension only, or pressure only, and what loads the other way shortens or lengthens its beam \
                              without bounds: let loads strain it where the law has a stiffness, or give the law a small one on both sides";
/// What to try where a beam is crushed for another reason.
const TOO_SOFT: &str = "a beam is a model for small strains: use smaller loads, or a larger axial stiffness";
/// What to try where a beam is pushed through an obstacle.
const PUSHED_THROUGH: &str = "the obstacle gives way by more than half its thickness: give the contact a larger `stiffness`, or the obstacle a larger size";
/// Part of the largest energy by which the work of actuators may err without a warning.
const WORK_KNOWN: f64 = 1e-2;
/// Change of the total energy, relative to the largest energy, that is worth a warning.
const LARGEST_DRIFT: f64 = 1e-2;
/// Energies below this, in EA L, are due to the round-off of strains.
const LEAST_ENERGY: f64 = 1e-20;
/// The same in EI/L where no beam stretches.
const LEAST_OF_INEXTENSIBLE: f64 = 1e-14;
/// Largest number of states, evenly spread, that are checked for locking …
const LOOKED_AT: usize = 400;
/// … and, of a motion, for force fields that cells miss …
const FIELDS_AT: usize = 20;
/// … and for loose nodes, which are so in most states or do not matter.
const LOOSE_AT: usize = 40;

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

/// The warning about a motion whose balance of energy is off by more than a hundredth of its
/// largest energy, if that is more than `least` \[J\].
fn unbalanced(energy: &[Energy], least: f64) -> Option<String> {
    let first = energy.first()?;
    let change = |e: &Energy| e.total() - first.total();
    let off = energy.iter().map(change).fold(0.0_f64, |m, c| if c.abs() > m.abs() { c } else { m });
    let parts =
        |e: &Energy| [e.stretch, e.bend, e.stored, e.kinetic, e.potential - first.potential, e.work, e.lost];
    let largest = energy.iter().flat_map(parts).fold(0.0_f64, |m, part| m.max(part.abs()));
    let share = off.abs() / largest;
    (largest > least && share > LARGEST_DRIFT).then(|| {
        let (what, meaning) = if off > 0.0 {
            ("gained", "that nothing put in: it is not the motion of this beam")
        } else {
            (
                "lost",
                "that no damping took: vibrations that are too fast for the steps are missing, or more than these",
            )
        };
        format!(
            "the motion has {what} {:.2e} J, {:.2} of its largest energy, {meaning}; compare with a smaller `tolerance` or `step`, or with \
             a finer mesh",
            off.abs(),
            share
        )
    })
}

/// The warning about the work of actuators, if its error is not small against the energies of the
/// state.
fn put_in(work: &Work, energy: &Energy) -> Option<String> {
    let parts = [energy.stretch, energy.bend, energy.stored, energy.potential, work.value, work.size];
    let largest = parts.iter().fold(0.0_f64, |m, part| m.max(part.abs()));
    (work.error > WORK_KNOWN * largest).then(|| {
        format!(
            "the energy that actuation has put in, {:.3e} J, is a sum over the states of the path and may err by {:.0e} J: give more `steps`, \
             or a smaller `max_step` of the arc length",
            work.value, work.error
        )
    })
}

/// The places `even`, and those of `jumps` twice; each with the side of the cut there.
fn stations(even: &[f64], jumps: &[f64]) -> (Vec<f64>, Vec<Side>) {
    let end = even.last().copied().unwrap_or(0.0);
    let apart = |s: &&f64| jumps.iter().all(|jump| (jump - **s).abs() > SAME_PLACE * end);
    // At the beam's end the cut is before the forces that act there.
    let plain = even.iter().filter(apart).map(|s| (*s, if *s == end { Side::Left } else { Side::Right }));
    let mut stations: Vec<_> =
        plain.chain(jumps.iter().flat_map(|s| [(*s, Side::Left), (*s, Side::Right)])).collect();
    stations.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    stations.into_iter().unzip()
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

fn incomplete(mut trajectory: Trajectory) -> Trajectory {
    trajectory.run.complete = false;
    trajectory
}

fn evenly(length: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| length * i as f64 / (count - 1) as f64).collect()
}

impl<'a> Sampler<'a> {
    pub(super) fn new(
        model: &'a Model,
        system: &'a System,
        Detail { frames, shape_points, stations }: Detail<'_>,
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
        Ok(Self { model, system, shapes, stations, probes, locking, loose, frames, angles: Vec::new() })
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

    /// All beams in the state `q`.
    pub(super) fn shape(&self, q: &[f64]) -> Vec<Shape> {
        self.shapes.iter().enumerate().map(|(beam, view)| self.shape_of(beam, view, q)).collect()
    }

    /// One beam in the state `q`, as `view` sees it.
    fn shape_of(&self, beam: usize, view: &View, q: &[f64]) -> Shape {
        let part = &self.system.beams()[beam];
        let first = 4 * part.first_node;
        let nodes = nodes(&q[first..first + 4 * part.basis.nodes().len()]);
        Shape { nodes: nodes.map(|node| node.position).collect(), ..self.seen(beam, view, q) }
    }

    /// [`Self::shape_of`] without the nodes.
    fn seen(&self, beam: usize, view: &View, q: &[f64]) -> Shape {
        let (part, beam) = (&self.system.beams()[beam], &self.model.beams[beam]);
        let places = || Vec::with_capacity(view.s().len());
        let mut shape = Shape {
            beam: beam.name.clone(),
            s: view.s().to_vec(),
            x: places(),
            y: places(),
            angle: places(),
            strain: places(),
            curvature: places(),
            ..Shape::default()
        };
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
        // The stress-free shape of a curved beam has a strain by its interpolation, which does not
        // count.
        if !part.straight {
            let reference = view.all(self.system.reference());
            for (strain, reference) in shape.strain.iter_mut().zip(reference) {
                *strain -= reference.strain(beam.strain);
            }
        }
        shape
    }

    /// The changes of one beam by modes of the state `q`, at the arc lengths `s`.
    pub(super) fn changes(&self, beam: usize, s: &[f64], q: &[f64], modes: &[&[f64]]) -> Vec<ModeShape> {
        let part = &self.system.beams()[beam];
        let (name, measure) = (&self.model.beams[beam].name, self.model.beams[beam].strain);
        let view = View::points(&part.basis, part.offset(), s);
        let view = view.as_ref().unwrap_or(&self.shapes[beam]);
        let state: Vec<Fields> = view.all(q).collect();
        let first = 4 * part.first_node;
        let coordinates = first..first + 4 * part.basis.nodes().len();
        let shape = |mode: &&[f64]| {
            let places = || Vec::with_capacity(state.len());
            let mut shape = ModeShape {
                beam: name.clone(),
                s: view.s().to_vec(),
                x: places(),
                y: places(),
                angle: places(),
                strain: places(),
                curvature: places(),
                nodes: nodes(&mode[coordinates.clone()]).map(|node| node.position).collect(),
            };
            for (fields, by) in state.iter().zip(view.all(mode)) {
                shape.x.push(by.position[0]);
                shape.y.push(by.position[1]);
                let Change { angle, strain, curvature } = fields.change(&by, measure);
                shape.angle.push(angle);
                shape.strain.push(strain);
                shape.curvature.push(curvature);
            }
            shape
        };
        modes.iter().map(shape).collect()
    }

    /// [`Self::shape`] with section forces, from the forces that act on each beam. A point where a
    /// force or a couple acts has two rows, before and behind it.
    pub(super) fn loaded(&self, q: &[f64], actions: &[Actions]) -> Vec<Shape> {
        self.loaded_with(q, actions, &|beam, length| actions[beam].jumps(length))
    }

    /// [`Self::loaded`], with two rows at the places that `jumps` gives for a beam and its length.
    pub(super) fn loaded_with(
        &self,
        q: &[f64],
        actions: &[Actions],
        jumps: &dyn Fn(usize, f64) -> Vec<f64>,
    ) -> Vec<Shape> {
        let beams = self.shapes.iter().zip(actions).enumerate();
        beams
            .map(|(beam, (even, actions))| {
                let part = &self.system.beams()[beam];
                let length = part.basis.length();
                let mut jumps = jumps(beam, length);
                jumps.extend(self.model.beams[beam].section.jumps());
                jumps.sort_by(f64::total_cmp);
                jumps.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE * length);
                let (s, sides) = stations(even.s(), &jumps);
                let more =
                    (s != even.s()).then(|| View::points(&part.basis, part.offset(), &s).ok()).flatten();
                let mut shape = self.shape_of(beam, more.as_ref().unwrap_or(even), q);
                self.bend_before(beam, &sides, q, &mut shape);
                self.cut(beam, actions, &sides, &mut shape);
                shape.tendons = self.tendons(beam, &shape);
                shape
            })
            .collect()
    }

    /// Gives rows before a cut the strain and the curvature there: those of a node are the ones behind it.
    fn bend_before(&self, beam: usize, sides: &[Side], q: &[f64], shape: &mut Shape) {
        let part = &self.system.beams()[beam];
        let length = part.basis.length();
        let is_before = |i: &usize| sides[*i] == Side::Left && shape.s[*i] < length;
        let rows: Vec<usize> = (0..sides.len()).filter(is_before).collect();
        if rows.is_empty() {
            return;
        }
        let places: Vec<f64> = rows.iter().map(|i| (shape.s[*i] - SAME_PLACE * length).max(0.0)).collect();
        let Ok(view) = View::points(&part.basis, part.offset(), &places) else { return };
        let before = self.seen(beam, &view, q);
        for (i, (strain, curvature)) in rows.into_iter().zip(before.strain.iter().zip(&before.curvature)) {
            (shape.strain[i], shape.curvature[i]) = (*strain, *curvature);
        }
    }

    /// One beam at the arc lengths `s` \[m\], with section forces on the given sides of the cuts.
    pub(super) fn cut_shape(
        &self,
        beam: usize,
        s: &[f64],
        sides: &[Side],
        q: &[f64],
        actions: &Actions,
    ) -> Shape {
        let part = &self.system.beams()[beam];
        let view = View::points(&part.basis, part.offset(), s);
        view.map_or_else(|_| Shape::default(), |view| self.cut_view(beam, &view, sides, q, actions))
    }

    /// The same of a view of the beam.
    pub(super) fn cut_view(
        &self,
        beam: usize,
        view: &View,
        sides: &[Side],
        q: &[f64],
        actions: &Actions,
    ) -> Shape {
        let mut shape = self.shape_of(beam, view, q);
        if shape.s.len() == sides.len() {
            self.cut(beam, actions, sides, &mut shape);
        }
        shape
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

    /// The lines of the tendons of a beam.
    fn tendons(&self, beam: usize, shape: &Shape) -> Vec<Vec<[f64; 2]>> {
        let paths = self.model.parts.iter().filter_map(|part| part.tendon());
        let line = |path: &TendonPath| {
            let [from, to] = path.ends;
            let points = (0..shape.s.len()).filter(|i| (from..=to).contains(&shape.s[*i]));
            points.map(|i| shape.beside(i, path.offset.at(shape.s[i], shape.s[i]))).collect()
        };
        paths.filter(|(of, ..)| *of == beam).map(|(_, path, _)| line(path)).collect()
    }

    /// Adds the section forces; a string has only N.
    fn cut(&self, beam: usize, actions: &Actions, sides: &[Side], shape: &mut Shape) {
        let Beam { section, strain: measure, .. } = &self.model.beams[beam];
        let bends = section.bending_stiffness.is_some();
        let length = self.system.beams()[beam].basis.length();
        for forces in [&mut shape.axial_force, &mut shape.shear_force, &mut shape.bending_moment] {
            forces.reserve_exact(sides.len());
        }
        for (i, side) in sides.iter().enumerate() {
            let before = actions.until(shape.s[i], *side, length);
            let (r, (sine, cosine)) = (Vector2::new(shape.x[i], shape.y[i]), shape.angle[i].sin_cos());
            let force = -before.force;
            let inside = shape.s[i] + if *side == Side::Left { -SAME_PLACE } else { SAME_PLACE } * length;
            let stretch = measure.stretch(shape.strain[i]);
            let [axial, shear, moment] =
                actions.of_tendons(shape.s[i], inside, [stretch, shape.curvature[i]]);
            let along = force.x * cosine + force.y * sine - axial;
            let across = force.y * cosine - force.x * sine - shear;
            // The force in a string has the direction of the string, which at a kink is not that of the node.
            shape.axial_force.push(if bends { along } else { along.hypot(across).copysign(along) });
            shape.shear_force.push(if bends { across } else { 0.0 });
            let couple = r.perp(&before.force) - before.moment - moment;
            shape.bending_moment.push(if bends { couple } else { 0.0 });
            shape.faces.extend(section.faces(shape.s[i], inside));
            let forces = [shape.axial_force[i], shape.bending_moment[i]];
            let imposed = actions.layer_strains(shape.s[i], inside);
            for (layer, [bottom, top]) in
                section.stresses(shape.s[i], inside, forces, &imposed).into_iter().flatten().enumerate()
            {
                if layer == shape.stress.len() {
                    shape.stress.push(LayerStress::default());
                }
                shape.stress[layer].bottom.push(bottom);
                shape.stress[layer].top.push(top);
            }
        }
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

    pub(super) fn statics(&self, solution: &Solution) -> Trajectory {
        self.equilibria(AnalysisKind::Static, solution, &self.angles)
    }

    /// The directions at all probes in the last of some equilibria \[rad\], with the full turns since the start.
    pub(super) fn last_angles(&self, solution: &Solution) -> Vec<f64> {
        let mut series = vec![ProbeSeries::default(); self.probes.len()];
        for (i, (load, x)) in solution.states.iter().enumerate() {
            self.see_probes(
                &mut series,
                (i + 1, *load),
                (self.history(solution, i, &self.angles), self.coordinates_of(x)),
                None,
            );
        }
        series.iter().filter_map(|series| series.samples.last()).map(|sample| sample.angle).collect()
    }

    /// From where turns are counted in a state of this number, if these are the angles of the first.
    fn history<'h>(&self, solution: &'h Solution, number: usize, angles: &'h [f64]) -> History<'h> {
        match number.checked_sub(1) {
            None => History::Angles(angles),
            Some(before) => {
                let turned = solution.turned.get(number).map_or(&[][..], |turned| turned);
                let (load, x) = &solution.states[before];
                History::Before { load: *load, q: self.coordinates_of(x), turned }
            }
        }
    }

    /// The trajectory of equilibria that an analysis needs; `angles` are those of the probes in the first of them, where they are known.
    pub(super) fn equilibria(
        &self,
        analysis: AnalysisKind,
        solution: &Solution,
        angles: &[f64],
    ) -> Trajectory {
        let mut trajectory = self.empty(analysis);
        let count = solution.states.len();
        let (mut locking, mut loose) = (self.locking.clone(), self.loose.clone());
        let mut reach = Reach::new(self.model);
        let mut tendons = Tendons::new(self.model, true);
        let states = solution.states.iter().zip(&solution.variables).zip(&solution.work);
        for (i, (((load, x), variables), work)) in states.enumerate() {
            let q = self.coordinates_of(x);
            if self.model.outputs.reactions {
                self.record_reactions(&mut trajectory, &self.system.static_reactions(*load, x, variables));
            }
            let energy = Energy { work: work.value, ..self.system.energy(*load, q, None).with(variables) };
            let history = self.history(solution, i, angles);
            self.record(&mut trajectory, *load, (history, q), (None, variables), energy);
            if is_among(i, count, self.frames) {
                trajectory.frames.push(self.frame(*load, q));
            }
            tendons.see_tensions(*load, self.system.tensions(&x[q.len()..]).map(|(tension, _)| tension));
            if i + 1 == count {
                loose.see(self.system, *load, q);
            }
            if is_among(i, count, LOOKED_AT) {
                locking.see(q);
                if tendons.are_there() {
                    tendons.see(&self.shape(q));
                }
                if reach.watches() {
                    reach.see(&self.shape(q), &trajectory.run.undeformed);
                }
            }
        }
        if let (Some((load, x)), Some(variables)) = (solution.states.last(), solution.variables.last()) {
            let known = self.system.tensions(&x[self.system.coordinates()..]);
            trajectory.run.tensions = tendons.tensions(known.map(|(tension, _)| tension));
            let actions = self.system.static_actions(*load, x, variables);
            trajectory.last = self.loaded(self.coordinates_of(x), &actions);
            trajectory.run.warnings.extend(imbalance::out_of_balance(self.system, *load, x, variables));
        }
        let states = [solution.states.first(), solution.states.last()].into_iter().flatten();
        let states: Vec<(&[f64], f64)> = states.map(|(_, x)| (self.coordinates_of(x), 0.0)).collect();
        self.see_fields(&mut trajectory.run, &states);
        trajectory.run.warnings.extend(self.folds(&trajectory.last));
        trajectory.run.warnings.extend(strings::kinks(self.model, self.system, &trajectory.last));
        let known = solution.work.last().zip(trajectory.energy.last());
        trajectory.run.warnings.extend(known.and_then(|(work, energy)| put_in(work, energy)));
        let work = trajectory.energy.last().map_or(0.0, |energy| energy.potential.abs());
        trajectory.run.warnings.extend(locking.jammed(&trajectory.last, work));
        trajectory.run.warnings.extend(unheld(self.model, &trajectory.last, &trajectory.run.undeformed));
        trajectory.run.warnings.extend(locking.warnings(0.0));
        trajectory.run.warnings.extend(loose.warnings());
        trajectory.run.warnings.extend(reach.warnings());
        trajectory.parameter.iter().for_each(|at| tendons.see_factor(*at));
        trajectory.run.warnings.extend(tendons.warnings());
        trajectory.history = solution.history.clone();
        trajectory.run.statistics = solution.statistics;
        trajectory.run.warnings.extend(stability::warnings(solution));
        if analysis == AnalysisKind::Static {
            let unseen = stability::unseen_waves(self.model, self.system, &trajectory.last);
            trajectory.run.warnings.extend(unseen);
        }
        trajectory.events.extend(solution.events.iter().map(stability::event));
        trajectory
    }

    /// The message on a path that ends while things come and go.
    pub(super) fn on_the_way(&self, solution: &Solution) -> Option<String> {
        let (load, _) = solution.states.last().filter(|(load, _)| self.system.is_between(*load))?;
        Some(format!(
            "the last state, at load factor {load:.4}, lies on the way to load factor 1, where all that goes with this stage has gone \
             and all that comes has come: {:.0} % of it is still as it was before",
            100.0 * remaining(*load)[0]
        ))
    }

    /// Looks at force fields in states, coordinates and times \[s\].
    fn see_fields(&self, run: &mut Run, states: &[(&[f64], f64)]) {
        let missed = fields::missed(self.model, self.system, states);
        run.misses_fields = !missed.is_empty();
        run.warnings.extend(missed);
    }

    /// The last state, if it is the equilibrium under the full loads.
    /// `asked` is the model before it went on from another state, and `time` that of this state.
    pub(super) fn equilibrium(
        &self,
        solution: &Solution,
        seen: &Trajectory,
        asked: &Model,
        time: f64,
    ) -> Option<SavedState> {
        let (_, x) = solution.states.last().filter(|(load, _)| *load == 1.0)?;
        let mut state = dynamics::State::at_rest(self.coordinates_of(x));
        state.time = time;
        state.variables = solution.variables.last().cloned().unwrap_or_default();
        state.angles = seen.probes.iter().filter_map(|p| p.samples.last()).map(|s| s.angle).collect();
        let checkpoint = dynamics::Checkpoint { state, ..dynamics::Checkpoint::default() };
        let supports = self.system.static_support_forces(1.0, x, &checkpoint.state.variables);
        let holding = Holding { supports, multipliers: x[self.system.coordinates()..].to_vec() };
        Some(SavedState::new(asked, self.system, String::new(), checkpoint, Some(holding)))
    }

    /// The points whose directions are watched: those of the probes.
    pub(super) fn directions(&self) -> Vec<View> {
        self.probes.iter().map(|probe| probe.view.clone()).collect()
    }

    /// Messages on beams that turn back within a cell. In a string only the axial stiffness resists
    /// such a fold; in a beam it lies between the quadrature points of bending, so that it may
    /// remain where a large step has left it.
    fn folds(&self, shapes: &[Shape]) -> Vec<String> {
        let beams = shapes.iter().zip(self.system.beams()).zip(&self.model.beams);
        let folds = beams.filter_map(|((shape, part), beam)| {
            let is_string = beam.section.bending_stiffness.is_none();
            let s = part.basis.nodes().windows(2).find_map(|cell| match *cell {
                [start, end] => {
                    let from = shape.s.partition_point(|s| *s < start).saturating_sub(1);
                    let to = (shape.s.partition_point(|s| *s <= end) + 1).min(shape.s.len());
                    let angles = shape.angle.get(from..to)?;
                    let turn = if is_string {
                        let (low, high) = angles
                            .iter()
                            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
                        high - low
                    } else {
                        // Even a beam that bends strongly turns little from one point to the next.
                        angles.windows(2).fold(0.0_f64, |turn, pair| turn.max((pair[1] - pair[0]).abs()))
                    };
                    (turn > FRAC_PI_2).then_some(start)
                }
                _ => None,
            })?;
            let (what, advice) = if is_string {
                ("string", "begin from an arc of its length, reach the load in smaller `steps`, or use more nodes")
            } else {
                ("beam", "reach the load in smaller `steps`, begin nearer to the equilibrium, or use other nodes")
            };
            Some(format!(
                "{what} `{}` turns by more than a right angle within its cell from s = {} m: it may have folded back, \
                 which is no equilibrium of a real {what}; {advice}",
                shape.beam,
                plain(s, 4)
            ))
        });
        folds.collect()
    }

    /// Why there is no way on; `along_arc`, where a path was followed by arc length already.
    pub(super) fn stuck(&self, stuck: &NoStep, solution: &Solution, along_arc: bool) -> RunError {
        let (beam, s) = stuck.at;
        let pulled_in = self.pulled_in(solution.states.last().map(|(_, q)| &q[..]));
        let advice = match stuck.failure {
            _ if self.limited_by_round_off(&stuck.failure)
                && self.system.has_friction()
                && stuck.load < NEXT_TO_NOTHING =>
            {
                "a contact that sticks as it begins finds no first step, and shorter ones press it by round-off only: give a `max_step` of some thousandths, \
                 or friction a smaller `stiffness`"
            }
            _ if self.limited_by_round_off(&stuck.failure) => {
                "double precision cannot resolve these loads: the stiffness is so large, or nodes are so close, that the \
                 round-off of positions alone makes forces of their size; use fewer nodes, even spacing, or an axial \
                 stiffness that is not far beyond EI/h² with the spacing h"
            }
            Failure::Singular(Singular { row }) if row >= self.system.coordinates() => {
                "supports between nodes hold the same motion more than once: leave some out, or use more nodes"
            }
            Failure::Crossed { .. } => PUSHED_THROUGH,
            Failure::Crushed { .. } if self.system.goes_slack() => WITHOUT_BOUNDS,
            _ if self.system.goes_slack() && stuck.load < NEXT_TO_NOTHING => WITHOUT_BOUNDS,
            Failure::Crushed { .. } => TOO_SOFT,
            _ if stuck.load == 0.0 && self.system.force_at_start(&[Kind::Contact]) > 0.0 => {
                "the structure begins inside an obstacle, which presses it before any load does: begin beside it, or let the obstacle \
                 be softer, or a beam come to it by a support that moves"
            }
            _ if self.system.is_fading() => {
                "what held the state with which this analysis starts and has gone fades on the way, that of supports, joints, springs, \
                 tendons and everything of another file as forces of fixed directions and couples: let it go in a `[[stage]]` of one file, \
                 where loads and tendons fade as they are, or in a damped motion, which passes states that are unstable"
            }
            _ if self.system.is_floppy() => {
                "strings and beams on hinges come to rest where loads of fixed direction hold them: let such a load act on all \
                 that can move, add a support, or begin nearer to the equilibrium"
            }
            Failure::NotFinite if stuck.step == 0.0 => {
                "a load or a stiffness is no number, or beyond what its products leave room for: use other units"
            }
            _ if stuck.step == 0.0 => {
                "the undeformed structure can move without resistance: add a support, or give the beam a bending stiffness"
            }
            _ if along_arc => {
                "no step along the path converges from here: where the load is far beyond what the structure carries, give less of it, or a \
                 smaller `max_step`; if the shape is folded there, use more nodes"
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
            advice: pulled_in.unwrap_or_else(|| advice.into()),
            partial: Box::new(incomplete(self.statics(solution))),
        }
    }

    /// The error of a path that has not reached its target.
    pub(super) fn unreached(&self, why: Unreached, arc: &ArcLength, solution: &Solution) -> RunError {
        let load = arc.until_load.map(|load| format!("load factor {load}"));
        let probe = arc.until_probe.as_ref().map(|ProbeTarget { probe, axis, value }| {
            format!("{} = {value} m of probe `{probe}`", if *axis == 0 { "x" } else { "y" })
        });
        let target = load.into_iter().chain(probe).collect::<Vec<_>>().join(" or ");
        let target = if target.is_empty() { format!("its {} points", arc.max_points) } else { target };
        let load = solution.states.last().map_or(0.0, |(load, _)| *load);
        let partial = Box::new(incomplete(self.statics(solution)));
        match why {
            Unreached::OutOfPoints => RunError::OutOfPoints { points: arc.max_points, load, target, partial },
            Unreached::NothingGrows => RunError::NothingGrows { target, partial },
            Unreached::NothingMoves => RunError::NothingMoves { load, target, partial },
        }
    }

    /// Whether increments are small but do not vanish, or the round-off of internal forces compares
    /// with the loads, so that there is nothing to converge to.
    fn limited_by_round_off(&self, failure: &Failure) -> bool {
        let mut loads = vec![0.0; self.system.coordinates()];
        self.system.add_load_rate(1.0, 0.0, self.system.reference(), &mut loads);
        let length = self.system.length();
        let total: f64 = nodes(&loads).map(|f| f.shift().max(f.slope() / length)).sum();
        matches!(failure, Failure::TooSlow { last, .. } if *last < STALLED)
            || total > 0.0 && self.system.round_off() > DROWNED * total
    }

    pub(super) fn dynamics(&self, settings: &Dynamic, solution: dynamics::Solution) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Dynamic);
        trajectory.run.settings.push(("integrator".into(), settings.integrator.to_string()));
        let count = solution.states.len();
        let (mut locking, mut loose) = (self.locking.clone(), self.loose.clone());
        let mut reach = Reach::new(self.model);
        let mut tendons = Tendons::new(self.model, false);
        let mut pressed = strings::Pressed::new(self.model);
        if self.model.outputs.reactions {
            solution.reactions.iter().for_each(|all| self.record_reactions(&mut trajectory, all));
        }
        for (time, tensions) in &solution.tensions {
            tendons.see_tensions(*time, tensions.iter().copied());
        }
        if let Some((_, last)) = solution.tensions.last() {
            trajectory.run.tensions = tendons.tensions(last.iter().copied());
        }
        for (i, state) in solution.states.iter().enumerate() {
            let (q, v) = (&state.q[..], Some(&state.v[..]));
            let energy = self.system.energy(state.time, q, v).with(&state.variables);
            let energy = Energy { work: state.work + energy.work, lost: state.lost, ..energy };
            self.record(
                &mut trajectory,
                state.time,
                (History::Angles(&state.angles), q),
                (v, &state.variables),
                energy,
            );
            if is_among(i, count, self.frames) {
                trajectory.frames.push(self.frame(state.time, q));
            }
            if is_among(i, count, LOOSE_AT) {
                loose.see(self.system, state.time, q);
            }
            if is_among(i, count, LOOKED_AT) {
                locking.see(q);
                if tendons.are_there() {
                    tendons.see(&self.shape(q));
                }
                if reach.watches() {
                    reach.see(&self.shape(q), &trajectory.run.undeformed);
                }
                if pressed.are_there() {
                    pressed.see(state.time, &self.shape(q));
                }
            }
        }
        let stretches = self.model.beams.iter().any(|beam| beam.section.axial_stiffness.is_some());
        let least = if stretches { LEAST_ENERGY } else { LEAST_OF_INEXTENSIBLE };
        let least = least * self.system.stiffness() * self.system.length();
        trajectory.run.warnings.extend(unbalanced(&trajectory.energy, least));
        let count = solution.states.len();
        let states = solution.states.iter().enumerate().filter(|(i, _)| is_among(*i, count, FIELDS_AT));
        let states: Vec<(&[f64], f64)> = states.map(|(_, state)| (&state.q[..], state.time)).collect();
        self.see_fields(&mut trajectory.run, &states);
        if let [first, .., last] = &solution.states[..] {
            let begin = (first.time, &first.q[..]);
            trajectory.run.warnings.extend(steps::too_long(
                self.model,
                self.system,
                settings,
                begin,
                last.time,
            ));
        }
        trajectory.run.warnings.extend(self.far_from_origin(settings, &solution.states));
        let unwatched = self.hardly_moving(settings, &trajectory);
        trajectory.run.warnings.extend(unwatched);
        if let Some(state) = solution.states.last() {
            trajectory.last = match &solution.end {
                Some(balance) => self.loaded(&state.q, &self.system.actions(balance.view())),
                None => self.shape(&state.q),
            };
        }
        for &dynamics::ProbeEvent { watch, time, value, rates } in &solution.events {
            let EventCondition { probe, quantity, when, .. } = &settings.events[watch];
            let turns = match when {
                EventKind::Reaches { .. } => None,
                EventKind::Maximum => Some("maximum"),
                EventKind::Minimum => Some("minimum"),
            };
            let (probe, quantity) = (probe.clone(), quantity.name().0);
            trajectory.events.push(Event::Probe { time, probe, quantity, value, turns, rates });
        }
        if let Some((watch, time)) = solution.unseen {
            let EventCondition { probe, quantity, .. } = &settings.events[watch];
            trajectory.run.warnings.push(format!(
                "the {} at probe `{probe}` was not known in every step from t = {} s on, so that events may have been missed",
                quantity.name().0,
                plain(time, 6)
            ));
        }
        let contacts: Vec<String> = self.system.contact_names().collect();
        for dynamics::Change { contact, touches, time, impulse } in solution.contacts.iter().copied() {
            let contact = contacts.get(contact).cloned().unwrap_or_default();
            trajectory.events.push(Event::Contact { time, contact, touches, impulse });
        }
        trajectory.events.sort_by(|a, b| a.parameter().total_cmp(&b.parameter()));
        for (contact, time) in &solution.crossings {
            trajectory.run.warnings.push(format!(
                "contact {} gave way at t = {} s: the beam was pushed past the middle of the obstacle, which its `stiffness` \
                 is too small to prevent",
                contacts.get(*contact).cloned().unwrap_or_default(),
                plain(*time, 6)
            ));
        }
        trajectory.run.warnings.extend(unheld(self.model, &trajectory.last, &trajectory.run.undeformed));
        let kinetic = trajectory.energy.iter().map(|energy| energy.kinetic).fold(0.0, f64::max);
        trajectory.run.warnings.extend(locking.warnings(kinetic));
        trajectory.run.warnings.extend(loose.warnings());
        trajectory.run.warnings.extend(reach.warnings());
        trajectory.run.warnings.extend(pressed.warnings());
        trajectory.parameter.iter().for_each(|at| tendons.see_factor(*at));
        trajectory.run.warnings.extend(tendons.warnings());
        let divided = solution.statistics.rejected_steps;
        if divided > 0 && matches!(settings.integrator.step_control(), StepControl::Fixed(_)) {
            let smallest = solution.history.iter().map(|r| r.step).fold(f64::INFINITY, f64::min);
            let unseen = if self.model.has_contact() { " or a contact would not have been seen" } else { "" };
            trajectory.run.warnings.push(format!(
                "the step was divided {divided} time{}, down to {smallest:.1e} s, because its equations could not be solved{unseen}: \
                 give `tolerance` instead of `step`, or a smaller `step`",
                if divided == 1 { "" } else { "s" }
            ));
        }
        trajectory.history = solution.history;
        trajectory.run.statistics = solution.statistics;
        trajectory
    }

    /// What to try after the last state `q` that was found, if an electrode has closed its gap there.
    fn pulled_in(&self, q: Option<&[f64]>) -> Option<String> {
        pulled_in(self.model, &self.shape(q?), &self.shape(self.system.reference()))
    }

    pub(super) fn lost(
        &self,
        settings: &Dynamic,
        stuck: &dynamics::NoStep,
        solution: dynamics::Solution,
    ) -> RunError {
        let (beam, s) = stuck.at;
        let pulled_in = self.pulled_in(solution.states.last().map(|state| &state.q[..]));
        let advice = match settings.integrator.step_control() {
            _ if matches!(stuck.failure, Failure::Crushed { .. }) => TOO_SOFT,
            _ if matches!(stuck.failure, Failure::Crossed { .. }) => PUSHED_THROUGH,
            _ if stuck.failure == Failure::NotFinite && stuck.step == 0.0 => {
                "a velocity, a load or a stiffness is beyond what its products leave room for: start from another state, or use other units"
            }
            _ if stuck.failure == Failure::StepsErr => {
                "the tolerance is below the round-off of these positions, or the motion jumps here: give a larger `tolerance`"
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
            advice: pulled_in.unwrap_or_else(|| advice.into()),
            partial: Box::new(incomplete(self.dynamics(settings, solution))),
        }
    }
}
