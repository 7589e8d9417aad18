//! By how much two runs of a model differ: where along the beams, when, and in which cells.

mod bent;
mod equilibrium;
mod events;
mod kinks;
mod laid_out;
mod layers;
mod modes;
mod negligible;
mod section_forces;
mod states;
mod stations;
mod strain_jumps;

use super::judgement::scaled;
use super::mesh::{CellErrors, Mesh};
use crate::model::{Analysis, Model};
use crate::results::{BeamErrors, Errors, EventErrors, ProbeErrors, ProbeSample, Results};

pub(super) use bent::{bent, defects};
pub(super) use events::events;
pub(super) use kinks::kink;
pub(super) use laid_out::laid_out;
pub(super) use layers::{Layer, layers};
use modes::modes;
pub(super) use modes::round_off;
pub(super) use states::jumps;
use states::states;
pub(super) use stations::stations;
pub(super) use strain_jumps::{StrainJump, fixed_gradients, jumps_of_modes, stiffness_jumps, strain_jumps};

/// Parameters of records are the same when they differ by less, relative to the last one.
const SAME: f64 = 1e-9;

/// How a coarse run and a finer one differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Difference {
    /// As a whole.
    pub errors: Errors,
    /// Relative, of each frequency or load factor.
    pub eigenvalues: Vec<f64>,
    /// Per own probe and record of the finer run.
    pub probes: Vec<ProbeErrors>,
    /// Per event of the finer run.
    pub events: Vec<EventErrors>,
    /// Per record of the finer run.
    pub records: Vec<f64>,
    /// Along each beam.
    pub beams: Vec<BeamErrors>,
    /// Of the cells of the coarse meshes, per beam.
    pub cells: Vec<CellErrors>,
    /// By what errors of curvatures and section forces are relative.
    pub scales: Scales,
}

/// The largest of a finer run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// \[1/m\], of all records.
    pub curvature: f64,
    /// \[N\], in the last record, M/L included.
    pub force: f64,
    /// \[N m\], in the last record.
    pub moment: f64,
}

impl Difference {
    /// Divided by these: positions, velocities, values and events by the first, curvatures, strains and forces by the
    /// second, angles, which are derivatives of positions as curvatures are of them, by what is between both.
    #[must_use]
    pub fn divided(mut self, by: [f64; 2]) -> Self {
        let [result, curvature] = by;
        self.errors = scaled(self.errors, by);
        self.eigenvalues.iter_mut().for_each(|error| *error /= result);
        self.records.iter_mut().for_each(|error| *error /= result);
        for sample in self.probes.iter_mut().flat_map(|probe| &mut probe.samples) {
            sample.x /= result;
            sample.y /= result;
            sample.angle /= (result * curvature).sqrt();
            sample.strain /= curvature;
            sample.curvature /= curvature;
            sample.vx = sample.vx.map(|v| v / result);
            sample.vy = sample.vy.map(|v| v / result);
        }
        for event in &mut self.events {
            event.parameter /= result;
            event.value = event.value.map(|value| value / result);
            event.impulse = event.impulse.map(|impulse| impulse / result);
            event.largest_force = event.largest_force.map(|force| force / curvature);
        }
        for beam in &mut self.beams {
            beam.position.iter_mut().for_each(|error| *error /= result);
            beam.curvature.iter_mut().for_each(|error| *error /= curvature);
        }
        self
    }

    /// None at all, of the same quantities.
    fn none(&self) -> Self {
        let mut none = self.clone();
        let zero = |of: Option<f64>| of.map(|_| 0.0);
        let Errors { curvature, section_force, .. } = self.errors;
        none.errors = Errors { result: 0.0, curvature: zero(curvature), section_force: zero(section_force) };
        none.records.fill(0.0);
        for event in &mut none.events {
            *event = EventErrors {
                parameter: 0.0,
                value: zero(event.value),
                impulse: zero(event.impulse),
                largest_force: zero(event.largest_force),
            };
        }
        for beam in &mut none.beams {
            beam.position.fill(0.0);
            beam.curvature.fill(0.0);
        }
        for sample in none.probes.iter_mut().flat_map(|probe| &mut probe.samples) {
            *sample = ProbeSample { vx: zero(sample.vx), vy: zero(sample.vy), ..ProbeSample::default() };
        }
        none
    }

    /// None at all of the same quantities but of the events, of which nothing is known where none are given.
    pub fn with_events_alone(&self, events: Option<Vec<EventErrors>>) -> Self {
        let unknown = || self.events.iter().map(|_| EventErrors::UNKNOWN).collect();
        Self { events: events.unwrap_or_else(unknown), ..self.none() }
    }

    /// The errors of both together, in the cells of this one; `None` where they are not of as many records.
    pub fn plus(&self, other: &Self) -> Option<Self> {
        if self.records.len() != other.records.len() {
            return None;
        }
        let of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a + b);
        let (mine, others) = (self.errors, other.errors);
        let mut sum = self.clone();
        sum.errors = Errors {
            result: mine.result + others.result,
            curvature: of(mine.curvature, others.curvature),
            section_force: of(mine.section_force, others.section_force),
        };
        let add = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        add(&mut sum.eigenvalues, &other.eigenvalues);
        add(&mut sum.records, &other.records);
        for (a, b) in sum.probes.iter_mut().zip(&other.probes) {
            for (a, b) in a.samples.iter_mut().zip(&b.samples) {
                *a = ProbeSample {
                    x: a.x + b.x,
                    y: a.y + b.y,
                    angle: a.angle + b.angle,
                    curvature: a.curvature + b.curvature,
                    strain: a.strain + b.strain,
                    vx: of(a.vx, b.vx),
                    vy: of(a.vy, b.vy),
                };
            }
        }
        for (a, b) in sum.events.iter_mut().zip(&other.events) {
            *a = EventErrors {
                parameter: a.parameter + b.parameter,
                value: of(a.value, b.value),
                impulse: of(a.impulse, b.impulse),
                largest_force: of(a.largest_force, b.largest_force),
            };
        }
        for (a, b) in sum.beams.iter_mut().zip(&other.beams) {
            add(&mut a.position, &b.position);
            add(&mut a.curvature, &b.curvature);
        }
        Some(sum)
    }
}

/// The difference of two runs of `model`, both kept at the [`stations`] of `meshes`.
///
/// # Errors
/// In words, where they cannot be compared.
pub(super) fn between(
    model: &Model,
    analysis: &Analysis,
    meshes: &[Mesh],
    coarse: &Results,
    fine: &Results,
) -> Result<Difference, String> {
    match analysis {
        Analysis::Modal(_) | Analysis::Buckling(_) => modes(model, meshes, coarse, fine),
        Analysis::Static(_) | Analysis::Dynamic(_) | Analysis::Stages => {
            states(model, analysis, meshes, coarse.states(), fine.states())
        }
    }
}

/// Pairs of records that belong together. Along a path each run takes points of its own, and only
/// the ends do. So do the ends of motions that an event ends, which are moments of their own.
///
/// # Errors
/// In words, where no records belong together.
pub(crate) fn pairs(
    analysis: &Analysis,
    run: &[f64],
    reference: &[f64],
) -> Result<Vec<(usize, usize)>, String> {
    let ends = run.len().checked_sub(1).zip(reference.len().checked_sub(1)).ok_or("no record")?;
    if is_path(analysis) {
        return Ok(vec![ends]);
    }
    let mut pairs = common(run, reference)?;
    if matches!(analysis, Analysis::Dynamic(_)) && pairs.iter().all(|&(i, j)| i != ends.0 && j != ends.1) {
        pairs.push(ends);
    }
    Ok(pairs)
}

/// Whether an analysis follows a path, of which each run takes points of its own.
pub(super) fn is_path(analysis: &Analysis) -> bool {
    matches!(analysis, Analysis::Static(settings) if settings.arc_length.is_some())
}

/// Pairs of records at the same time or load factor; both lists ascend. At least one is required.
pub(crate) fn common(run: &[f64], reference: &[f64]) -> Result<Vec<(usize, usize)>, String> {
    let last = *reference.last().ok_or("no record")?;
    let (mut pairs, mut i) = (Vec::new(), 0);
    for (j, &at) in reference.iter().enumerate() {
        while i < run.len() && run[i] < at - SAME * last.abs() {
            i += 1;
        }
        if run.get(i).is_some_and(|found| (found - at).abs() <= SAME * last.abs()) {
            pairs.push((i, j));
        }
    }
    if pairs.is_empty() { Err("no record at the times or loads of the reference".into()) } else { Ok(pairs) }
}

/// A maximum that keeps what is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The larger error of each quantity; of two of which one is not a number the other.
pub(super) fn each_larger(a: &ProbeSample, b: &ProbeSample) -> ProbeSample {
    let of = |a: Option<f64>, b: Option<f64>| b.map(|b| a.map_or(b, |a| a.max(b)));
    ProbeSample {
        x: a.x.max(b.x),
        y: a.y.max(b.y),
        angle: a.angle.max(b.angle),
        curvature: a.curvature.max(b.curvature),
        strain: a.strain.max(b.strain),
        vx: of(a.vx, b.vx),
        vy: of(a.vy, b.vy),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::scene::{Scene, parse};

    /// A beam of 2 m with a probe at its tip, and a string of 4 m.
    pub fn scene(analysis: &str) -> Scene {
        let text = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1 }\n\
                    beam.rope = { start = [0, 1], end = [4, 1], axial_stiffness = 1, mass_per_length = 1 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, \
                    { beam = 'rope', at = 'start', fix = ['x', 'y'] }, { beam = 'rope', at = 'end', fix = ['x', 'y'] }]\n\
                    probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\n";
        parse("scene", &format!("{text}analysis.{analysis}\n")).unwrap()
    }

    pub fn meshes() -> [Mesh; 2] {
        [Mesh::of(&[0.0, 0.5, 2.0]), Mesh::of(&[0.0, 4.0])]
    }

    /// Each kind of value by its own factor, and the sum of every one.
    #[test]
    fn differences_are_divided_and_added_value_by_value() {
        let of = |k: f64| Difference {
            errors: Errors { result: k, curvature: Some(3.0 * k), section_force: Some(6.0 * k) },
            eigenvalues: vec![2.0 * k],
            probes: vec![ProbeErrors {
                name: "tip".into(),
                samples: vec![ProbeSample {
                    x: k,
                    y: 2.0 * k,
                    angle: 3.0 * k,
                    curvature: 6.0 * k,
                    strain: 9.0 * k,
                    vx: Some(4.0 * k),
                    vy: None,
                }],
            }],
            events: vec![EventErrors {
                parameter: 13.0 * k,
                value: Some(14.0 * k),
                impulse: None,
                largest_force: Some(15.0 * k),
            }],
            records: vec![5.0 * k],
            beams: vec![BeamErrors {
                beam: "arm".into(),
                s: vec![0.5],
                position: vec![7.0 * k],
                curvature: vec![12.0 * k],
            }],
            cells: vec![CellErrors { squares: vec![k], order: 2.0 }],
            scales: Scales::default(),
        };
        let same = |found: &Difference, [first, second, angle]: [f64; 3]| {
            let errors =
                Errors { result: first, curvature: Some(3.0 * second), section_force: Some(6.0 * second) };
            assert_eq!(found.errors, errors);
            assert_eq!((found.eigenvalues[0], found.records[0]), (2.0 * first, 5.0 * first));
            let sample = ProbeSample {
                x: first,
                y: 2.0 * first,
                angle: 3.0 * angle,
                curvature: 6.0 * second,
                strain: 9.0 * second,
                vx: Some(4.0 * first),
                vy: None,
            };
            assert_eq!(found.probes[0].samples, [sample]);
            let event = EventErrors {
                parameter: 13.0 * first,
                value: Some(14.0 * first),
                impulse: None,
                largest_force: Some(15.0 * second),
            };
            assert_eq!(found.events, [event]);
            assert_eq!(found.beams[0].s, [0.5]);
            assert_eq!(
                (found.beams[0].position[0], found.beams[0].curvature[0]),
                (7.0 * first, 12.0 * second)
            );
            assert_eq!(found.cells[0].squares, [16.0], "cells are told apart by size only");
        };
        let divided = of(16.0).divided([2.0, 8.0]);
        same(&divided, [8.0, 2.0, 4.0]);
        same(&divided.plus(&of(1.0)).expect("as many records"), [9.0, 3.0, 5.0]);
        assert!(divided.plus(&Difference::default()).is_none(), "an event has ended one of the motions");
    }

    #[test]
    fn records_at_the_same_time_or_load_belong_together() {
        assert_eq!(common(&[0.0, 0.5, 1.0], &[0.25, 0.5, 1.0 + 1e-10]), Ok(vec![(1, 1), (2, 2)]));
        assert_eq!(common(&[-1.0, -0.5], &[-0.5]), Ok(vec![(1, 0)]));
        // A billionth of the last one apart, times three.
        assert!(common(&[0.0, 100.0], &[3e-7, 100.0]).is_ok_and(|pairs| pairs == [(1, 1)]));
        assert!(common(&[0.0, 1.0], &[0.5]).is_err() && common(&[1.0], &[]).is_err());
        let (still, motion) = (scene("static = {}"), scene("dynamic = { duration = 1 }"));
        let path = super::super::runner::tests::scene("analysis.static.arc_length.max_points = 9");
        let of = |scene: &Scene, run: &[f64], reference: &[f64]| pairs(scene.analysis(), run, reference);
        assert_eq!(of(&still, &[0.0, 0.5, 1.0], &[0.0, 0.7, 1.0]), Ok(vec![(0, 0), (2, 2)]));
        assert_eq!(of(&path, &[0.0, 0.5, 1.0], &[0.0, 1.0]), Ok(vec![(2, 1)]));
        assert!(of(&path, &[], &[0.0]).is_err() && of(&path, &[0.0], &[]).is_err());
        // An event has ended both motions, at times that differ a little.
        assert_eq!(of(&motion, &[0.0, 0.5, 0.7], &[0.0, 0.5, 0.71]), Ok(vec![(0, 0), (1, 1), (2, 2)]));
        assert_eq!(of(&motion, &[0.0, 0.5, 0.71], &[0.0, 0.71]), Ok(vec![(0, 0), (2, 1)]));
        // One of them has gone on: the last record of the other has a partner.
        assert_eq!(of(&motion, &[0.0, 0.5, 1.0], &[0.0, 0.5]), Ok(vec![(0, 0), (1, 1)]));
    }

    #[test]
    fn a_maximum_keeps_what_is_not_a_number() {
        assert_eq!((larger(1.0, 2.0), larger(2.0, 1.0)), (2.0, 2.0));
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }
}
