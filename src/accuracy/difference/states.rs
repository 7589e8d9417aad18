//! By how much equilibria and motions differ.

use super::equilibrium::at_least_off_balance;
use super::events::events;
use super::negligible::{Negligible, tells};
use super::section_forces::section_forces;
use super::stations::parts;
use super::strain_jumps::{OF_CURVATURE, strain_jump};
use super::{Difference, Scales, each_larger, larger, pairs};
use crate::accuracy::mesh::{CellErrors, Mesh};
use crate::model::{Analysis, Beam, Discretization, Model, Place, Section};
use crate::results::places::{interpolated, is_before, is_twice, same_place};
use crate::results::{BeamErrors, Errors, ProbeErrors, ProbeSample, Shape, Trajectory};
use std::f64::consts::TAU;

/// An axial force that differs on both sides of a place by more than this part of the largest, or of M/L, jumps there; so does a bending
/// moment, by this part of the largest.
const JUMP: f64 = 1e-6;

/// The parts of the largest errors of positions and of angles on its beam that those of a probe are at least.
const LEAST: (f64, f64) = (0.2, 0.1);

/// Velocities, angles, strains and curvatures of so many records before and after tell of their errors, too.
const NEAR_RECORDS: usize = 2;
/// The part of what strains and curvatures err by there that they do at least.
const OF_NEAR_RECORDS: f64 = 0.3;

/// Errors of a record of which nothing is known.
const UNKNOWN: ProbeSample = ProbeSample {
    x: f64::NAN,
    y: f64::NAN,
    angle: f64::NAN,
    curvature: f64::NAN,
    strain: f64::NAN,
    vx: None,
    vy: None,
};

/// The difference of two runs in all records that they have in common.
///
/// # Errors
/// In words, where there are none, or what is kept of them is not enough.
pub fn states<'t>(
    model: &Model,
    analysis: &Analysis,
    meshes: &[Mesh],
    coarse: &'t Trajectory,
    fine: &'t Trajectory,
) -> Result<Difference, String> {
    let mut pairs = pairs(analysis, &coarse.parameter, &fine.parameter)?;
    if is_shapeless_at_first(model, analysis, fine) {
        pairs.retain(|(_, j)| *j > 0);
    }
    let lengths: Vec<f64> = meshes.iter().map(Mesh::length).collect();
    let mut difference = Difference {
        records: vec![0.0; fine.parameter.len()],
        events: events(&fine.events, [&coarse.events, &fine.events]),
        ..Difference::default()
    };
    let mut result = 0.0_f64;
    for ((probe, a), b) in model.probes.iter().zip(&coarse.probes).zip(&fine.probes) {
        let mut samples = vec![ProbeSample::default(); fine.parameter.len()];
        for &(i, j) in &pairs {
            let (Some(a), Some(b)) = (a.samples.get(i), b.samples.get(j)) else { continue };
            samples[j] = differ(a, b);
            let around = |t: &'t Trajectory, record: usize| t.stations.get(record)?.get(probe.at.beam);
            if let Some((a, b)) = around(coarse, i).zip(around(fine, j)) {
                samples[j] = not_by_chance(samples[j], a, b, probe.at.s, &model.beams[probe.at.beam]);
            }
            if jumps(model, &fine.last, probe.at)
                && let Some(around) = around(fine, j)
            {
                let section = &model.beams[probe.at.beam].section;
                let bends = bends(model, &fine.last, probe.at);
                samples[j] = one_sided(samples[j], b, around, probe.at.s, (section, bends));
            }
            let error = samples[j].x / lengths[probe.at.beam];
            difference.records[j] = larger(difference.records[j], error);
            result = larger(result, error);
        }
        if matches!(analysis, Analysis::Dynamic(_)) {
            let known: Vec<usize> = pairs.iter().map(|&(_, j)| j).collect();
            also_before_and_after(&mut samples, &known);
        }
        difference.probes.push(ProbeErrors { name: probe.name.clone(), samples });
    }
    let (mut curvature, mut largest) = (0.0_f64, vec![0.0_f64; model.beams.len()]);
    // Per beam and record: the largest distance and angle.
    let mut most = vec![vec![[0.0_f64; 2]; fine.parameter.len()]; model.beams.len()];
    for (index, (beam, mesh)) in model.beams.iter().zip(meshes).enumerate() {
        let s = fine.stations.first().and_then(|beams| beams.get(index)).map_or(&[][..], |shape| &shape.s);
        let length = mesh.length();
        let bends = beam.section.bending_stiffness.is_some();
        let mut along = BeamErrors {
            beam: beam.name.clone(),
            s: s.to_vec(),
            position: vec![0.0; s.len()],
            curvature: vec![0.0; s.len()],
        };
        let mut squares = vec![0.0_f64; mesh.cells()];
        for &(i, j) in &pairs {
            let mut now = vec![0.0_f64; mesh.cells()];
            let at = |t: &'t Trajectory, record: usize| t.stations.get(record)?.get(index);
            let (Some(a), Some(b)) = (at(coarse, i), at(fine, j)) else {
                return Err(format!("beam `{}` was not kept at record {j}", beam.name));
            };
            for (k, (a, b)) in samples(a).zip(samples(b)).enumerate() {
                let error = differ(&a, &b);
                along.position[k] = larger(along.position[k], error.x / length);
                along.curvature[k] = larger(along.curvature[k], error.curvature);
                difference.records[j] = larger(difference.records[j], error.x / length);
                let now_most = &mut most[index][j];
                *now_most =
                    [larger(now_most[0], error.x), larger(now_most[1], within_half_a_turn(error.angle))];
                let (end, node) = (k + 1 == s.len(), mesh.must_be(s[k]));
                // At inner nodes only positions are compared: strains and curvatures may jump there.
                if bends && (end || !node) {
                    largest[index] = largest[index].max(b.curvature.abs());
                    curvature = larger(curvature, error.curvature);
                }
                if !end && !node {
                    let cell = mesh.cell_at(s[k]);
                    let ends = &mesh.nodes[cell..=cell + 1];
                    let width = (ends[1] - ends[0]) / parts(mesh, ends).len() as f64;
                    let bent = if bends { error.curvature } else { within_half_a_turn(error.angle) / length };
                    // A part that is longer by its strain moves what is behind it by its length, one that is
                    // bent by its distance.
                    let stretched = error.strain / length;
                    now[cell] += width * (bent * bent + stretched * stretched);
                }
            }
            squares.iter_mut().zip(now).for_each(|(most, now)| *most = larger(*most, now));
        }
        result = along.position.iter().copied().fold(result, larger);
        difference.beams.push(along);
        difference.cells.push(CellErrors { squares, order: if bends { 2.0 } else { 3.0 } });
    }
    // A difference that vanishes in one place, where the runs happen to agree, is no error that does.
    for (probe, errors) in model.probes.iter().zip(&mut difference.probes) {
        for (sample, [distance, angle]) in errors.samples.iter_mut().zip(&most[probe.at.beam]) {
            // What is held does not err.
            let least = |seen: f64, least: f64| if seen > 0.0 { larger(seen, least) } else { seen };
            (sample.x, sample.y) = (least(sample.x, LEAST.0 * distance), least(sample.y, LEAST.0 * distance));
            sample.angle = least(sample.angle, LEAST.1 * angle);
        }
    }
    // Stations are inside the cells; where cells meet curvatures err most.
    for (((beam, a), b), largest) in model.beams.iter().zip(&coarse.last).zip(&fine.last).zip(&mut largest) {
        if beam.section.bending_stiffness.is_none() {
            continue;
        }
        *largest = b.curvature.iter().fold(*largest, |largest, value| largest.max(value.abs()));
        for (k, (s, value)) in a.s.iter().zip(&a.curvature).enumerate() {
            let other = interpolated(&b.s, &b.curvature, *s, !is_before(&a.s, k));
            curvature = other.map_or(curvature, |other| larger(curvature, (value - other).abs()));
        }
    }
    let known: Vec<usize> = pairs.iter().map(|&(_, j)| j).collect();
    if matches!(analysis, Analysis::Static(_)) {
        // Each run chooses load factors of its own, and near a critical one even neighbours differ.
        for j in (0..fine.parameter.len()).filter(|j| !known.contains(j)) {
            difference.records[j] = f64::NAN;
            difference.probes.iter_mut().for_each(|probe| probe.samples[j] = UNKNOWN);
        }
    } else {
        fill(&mut difference.records, &known, |a, b| larger(*a, *b));
        for probe in &mut difference.probes {
            fill(&mut probe.samples, &known, each_larger);
        }
    }
    let negligible: Vec<Negligible> = (model.beams.iter().zip(meshes).zip(&fine.last))
        .map(|((beam, mesh), shape)| Negligible::of(beam, mesh, shape, analysis))
        .collect();
    let is_bent =
        largest.iter().zip(&negligible).any(|(largest, none)| tells(*largest, curvature, none.curvature));
    let largest = largest.into_iter().fold(0.0, f64::max);
    let (section_force, [force, moment]) = section_forces(&coarse.last, &fine.last, &negligible);
    difference.errors = Errors { result, curvature: is_bent.then(|| curvature / largest), section_force };
    difference.scales = Scales { curvature: largest, force, moment };
    at_least_off_balance(&mut difference, model, meshes, fine);
    if result.is_finite() { Ok(difference) } else { Err("a position is not a number".into()) }
}

/// Whether the first record of an equilibrium is that of strings laid out in a shape which nothing loads yet: every mesh has another one.
fn is_shapeless_at_first(model: &Model, analysis: &Analysis, run: &Trajectory) -> bool {
    let is_string = |beam: usize| model.beams[beam].section.bending_stiffness.is_none();
    matches!(analysis, Analysis::Static(_))
        && run.parameter.len() > 1
        && run.parameter[0] == 0.0
        && model.initial_shapes.iter().any(|shape| is_string(shape.beam))
}

/// Gives records that the coarse run has not those of the records around them, of which `choose`
/// takes one.
fn fill<T: Clone>(values: &mut [T], known: &[usize], choose: impl Fn(&T, &T) -> T) {
    for i in 0..values.len() {
        let after = known.partition_point(|&k| k < i);
        let (before, after) = (after.checked_sub(1).map(|k| known[k]), known.get(after).copied());
        values[i] = match (before, after) {
            (_, Some(after)) if after == i => continue,
            (Some(before), Some(after)) => choose(&values[before], &values[after]),
            (Some(one), None) | (None, Some(one)) => values[one].clone(),
            (None, None) => continue,
        };
    }
}

/// The sizes of the differences of what a probe sees; that of x and y is the distance.
fn differ(a: &ProbeSample, b: &ProbeSample) -> ProbeSample {
    let distance = (a.x - b.x).hypot(a.y - b.y);
    let of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a - b);
    let speed = of(a.vx, b.vx).zip(of(a.vy, b.vy)).map(|(x, y)| x.hypot(y));
    ProbeSample {
        x: distance,
        y: distance,
        angle: (a.angle - b.angle).abs(),
        curvature: (a.curvature - b.curvature).abs(),
        strain: (a.strain - b.strain).abs(),
        vx: speed,
        vy: speed,
    }
}

/// What a shape holds, place by place.
fn samples(shape: &Shape) -> impl Iterator<Item = ProbeSample> {
    (0..shape.s.len()).filter_map(|k| sample(shape, k))
}

/// What a shape holds at its place of this number.
fn sample(shape: &Shape, k: usize) -> Option<ProbeSample> {
    Some(ProbeSample {
        x: *shape.x.get(k)?,
        y: *shape.y.get(k)?,
        angle: *shape.angle.get(k)?,
        curvature: *shape.curvature.get(k)?,
        strain: *shape.strain.get(k)?,
        vx: None,
        vy: None,
    })
}

/// What a probe at `s` differs by, and no less than what is on both sides of it. Errors are waves along a beam:
/// a probe that lies where one passes zero tells nothing.
/// Directions err by waves within each cell, which have another phase in other cells: by what they do on either side.
fn not_by_chance(seen: ProbeSample, coarse: &Shape, fine: &Shape, s: f64, beam: &Beam) -> ProbeSample {
    let differ_at = |k: usize| Some(differ(&sample(coarse, k)?, &sample(fine, k)?));
    let next = fine.s.partition_point(|place| *place < s);
    let [before, after] = [next.checked_sub(1), Some(next)].map(|k| k.and_then(differ_at));
    // Meshfree shape functions strain alike in all meshes at an end, and a place beside it tells.
    let meshfree = matches!(beam.discretization, Discretization::Rpim { .. });
    let (Some(before), Some(after)) = (before, after) else {
        let Some(beside) = before.or(after) else { return seen };
        let strain = if meshfree { larger(seen.strain, beside.strain) } else { seen.strain };
        let within = s > 0.0 && fine.s.last().is_some_and(|end| s < *end);
        let turns = within && seen.angle > 0.0;
        let angle = if turns { larger(seen.angle, within_half_a_turn(beside.angle)) } else { seen.angle };
        let curvature = if within { larger(seen.curvature, beside.curvature) } else { seen.curvature };
        return ProbeSample { strain, angle, curvature, ..seen };
    };
    let at_end = meshfree && fine.s.last().is_some_and(|end| *end <= s);
    let strain = if at_end { before.strain } else { before.strain.min(after.strain) };
    let [left, right] = [before.angle, after.angle].map(within_half_a_turn);
    let distance = larger(seen.x, before.x.min(after.x));
    ProbeSample {
        x: distance,
        y: distance,
        angle: larger(seen.angle, left.max(right)),
        curvature: larger(seen.curvature, before.curvature.min(after.curvature)),
        strain: larger(seen.strain, strain),
        ..seen
    }
}

/// Velocities and angles of a motion err by no less than they do in the records of these numbers that are near, strains and curvatures, whose
/// errors change more from record to record, by no less than a part of that: they are waves of high frequency, and one record may see
/// where they pass zero.
fn also_before_and_after(samples: &mut [ProbeSample], known: &[usize]) {
    let seen: Vec<ProbeSample> = known.iter().filter_map(|j| samples.get(*j).copied()).collect();
    let most = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| larger(a, b));
    // What is known beforehand does not err.
    let least = |seen: f64, near: f64| if seen > 0.0 { larger(seen, OF_NEAR_RECORDS * near) } else { seen };
    for (k, j) in known.iter().enumerate() {
        let near = &seen[k.saturating_sub(NEAR_RECORDS)..(k + NEAR_RECORDS + 1).min(seen.len())];
        samples[*j] = near.iter().fold(samples[*j], |now, near| ProbeSample {
            angle: larger(now.angle, near.angle),
            strain: least(now.strain, near.strain),
            curvature: least(now.curvature, near.curvature),
            vx: most(now.vx, near.vx),
            vy: most(now.vy, near.vy),
            ..now
        });
    }
}

/// Whether what acts in this place makes the strain or the curvature of its beam jump in the last state, or the direction of a string,
/// so that one value there is not both that before it and that behind.
pub fn jumps(model: &Model, last: &[Shape], at: Place) -> bool {
    let Some((beam, shape)) = model.beams.get(at.beam).zip(last.get(at.beam)) else { return false };
    let length = shape.s.last().copied().unwrap_or(0.0);
    let largest = most_of(&shape.axial_force).max(most_of(&shape.bending_moment) / length);
    let stretched =
        beam.section.axial_stiffness.is_some() && step(shape, &shape.axial_force, at.s) > JUMP * largest;
    let softer = strain_jump(model, at, shape) > JUMP * most_of(&shape.strain);
    let turned = beam.section.bending_stiffness.is_none() && is_twice(&shape.s, at.s);
    stretched || softer || turned || bends(model, last, at)
}

/// Whether the curvature of a beam jumps in this place in the last state: the bending moment does, the bending stiffness, or an imposed
/// curvature.
fn bends(model: &Model, last: &[Shape], at: Place) -> bool {
    let Some((beam, shape)) = model.beams.get(at.beam).zip(last.get(at.beam)) else { return false };
    let Some(bending) = &beam.section.bending_stiffness else { return false };
    let imposed = model.parts.iter().filter_map(|part| part.actuation(at.beam));
    let mut jumps = imposed.flat_map(|imposed| imposed.curvature.jumps()).chain(bending.jumps());
    let moment = &shape.bending_moment;
    let here = |s: f64| (s - at.s).abs() <= same_place(&shape.s);
    step(shape, moment, at.s) > JUMP * most_of(moment) || is_twice(&shape.s, at.s) && jumps.any(here)
}

fn most_of(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |most, value| most.max(value.abs()))
}

/// By how much values along a beam jump at a place; minus infinity where it is none of theirs.
fn step(shape: &Shape, values: &[f64], s: f64) -> f64 {
    let here = |k: &usize| (shape.s[*k] - s).abs() <= same_place(&shape.s);
    let here = (0..shape.s.len()).filter(here).filter_map(|k| values.get(k));
    let [least, most] = here.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
        [least.min(*value), most.max(*value)]
    });
    most - least
}

/// What a probe at such a place errs by: at least by what its strain, or the direction of a string, is off from those at the stations
/// before and behind it. Where the tangent is so much too long or too short, so is the curvature; of a section whose strain and curvature
/// depend on each other it jumps, too, as it does where something `bends` the beam there.
fn one_sided(
    seen: ProbeSample,
    value: &ProbeSample,
    fine: &Shape,
    s: f64,
    (section, bends): (&Section, bool),
) -> ProbeSample {
    let same = same_place(&fine.s);
    let before = fine.s.partition_point(|place| *place < s - same).checked_sub(1);
    let behind = Some(fine.s.partition_point(|place| *place <= s + same));
    let sides = [before, behind].into_iter().flatten().filter_map(|k| sample(fine, k));
    sides.fold(seen, |seen, side| {
        let off = differ(value, &side);
        let curvature = match (&section.bending_stiffness, &section.coupling) {
            (None, _) => 0.0,
            (_, None) if !bends => OF_CURVATURE * off.strain * value.curvature.abs(),
            _ => off.curvature,
        };
        let angle = if section.bending_stiffness.is_some() { 0.0 } else { within_half_a_turn(off.angle) };
        ProbeSample {
            angle: larger(seen.angle, angle),
            curvature: larger(seen.curvature, curvature),
            strain: larger(seen.strain, off.strain),
            ..seen
        }
    })
}

/// The size of an angle without whole turns, which shapes do not tell.
fn within_half_a_turn(angle: f64) -> f64 {
    (angle - TAU * (angle / TAU).round()).abs()
}

#[cfg(test)]
mod tests {
    use super::super::between;
    use super::super::stations::stations;
    use super::super::tests::{meshes, scene};
    use super::*;
    use crate::model::Along;
    use crate::results::{ProbeSeries, Results};
    use crate::scene::Scene;

    /// What one run, at rest but for these samples (record, place, sample), saw at some times: by its probe, and
    /// at the five stations of the beam and the three of the string.
    fn seen(parameter: &[f64], samples: &[(usize, usize, ProbeSample)]) -> Trajectory {
        let at_rest = ProbeSample { vx: Some(0.0), vy: Some(0.0), ..ProbeSample::default() };
        let mut probe = ProbeSeries { name: String::new(), samples: vec![at_rest; parameter.len()] };
        let still = |s: &Vec<f64>| {
            let zero = || vec![0.0; s.len()];
            Shape {
                s: s.clone(),
                x: zero(),
                y: zero(),
                angle: zero(),
                strain: zero(),
                curvature: zero(),
                ..Shape::default()
            }
        };
        let mut stations = vec![stations(&meshes()).iter().map(still).collect::<Vec<_>>(); parameter.len()];
        for &(record, place, sample) in samples {
            let Some(station) = place.checked_sub(1) else {
                probe.samples[record] = sample;
                continue;
            };
            let shape = &mut stations[record][station / 5];
            let k = station % 5;
            (shape.x[k], shape.y[k], shape.angle[k]) = (sample.x, sample.y, sample.angle);
            (shape.strain[k], shape.curvature[k]) = (sample.strain, sample.curvature);
        }
        let last = vec![Shape::default(); 2];
        Trajectory {
            parameter: parameter.into(),
            probes: vec![probe],
            stations,
            last,
            ..Trajectory::default()
        }
    }

    /// Worked out by hand: what differs at nine places in two records, the first and the last of three.
    #[test]
    fn differences_of_motions_are_those_of_all_places_and_records() {
        let bent = |curvature: f64| ProbeSample { curvature, ..ProbeSample::default() };
        let coarse = seen(
            &[0.0, 1.0],
            &[
                (
                    1,
                    0,
                    ProbeSample {
                        x: 0.3,
                        y: 0.4,
                        angle: 0.1,
                        strain: 0.2,
                        vx: Some(1.0),
                        vy: Some(1.5),
                        ..ProbeSample::default()
                    },
                ),
                (0, 1, ProbeSample { angle: 5.0, ..bent(3.0) }),
                (1, 2, bent(2.0)),
                (1, 3, bent(-7.0)),
                (1, 4, bent(4.0)),
                // At the end of the beam, which is in no cell.
                (1, 5, ProbeSample { x: 0.8, ..bent(3.5) }),
                // A string that has gone round once more is where it was.
                (1, 6, ProbeSample { angle: 0.8 + TAU, ..bent(100.0) }),
            ],
        );
        let at_rest = ProbeSample { vx: Some(-1.0), vy: Some(0.0), ..ProbeSample::default() };
        let mut fine = seen(&[0.0, 0.5, 1.0], &[(2, 0, at_rest), (2, 3, bent(-8.0))]);
        let motion = scene("dynamic = { duration = 1 }");
        let of = |scene: &Scene, coarse: &Trajectory, fine: &Trajectory| {
            let results = [coarse, fine].map(|run| Results::from(run.clone()));
            between(scene.model(), scene.analysis(), &meshes(), &results[0], &results[1])
        };
        let found = of(&motion, &coarse, &fine).unwrap();
        assert_eq!(found.errors, Errors { result: 0.4, curvature: Some(0.5), section_force: None });
        assert_eq!(found.records, [0.0, 0.4, 0.4]);
        let tip = &found.probes[0].samples;
        // The curvature is that of the stations beside it, which differ though the probe does not.
        let last = ProbeSample {
            x: 0.5,
            y: 0.5,
            angle: 0.1,
            strain: 0.2,
            curvature: 3.5,
            vx: Some(2.5),
            vy: Some(2.5),
        };
        // Between two records each quantity errs by the larger of both.
        let between = ProbeSample { angle: 0.1 * (TAU - 5.0), ..last };
        assert_eq!((found.probes.len(), tip[0].x, tip[1], tip[2]), (1, 0.0, between, last));
        // Velocities and angles of a record near to one that errs may be those of a wave that passes zero; the angle errs by a
        // tenth of the largest one on the beam.
        assert_eq!((tip[0].angle, tip[0].strain, tip[0].vx), (0.1 * (TAU - 5.0), 0.0, Some(2.5)));
        assert_eq!(found.beams[0].position, [0.0, 0.0, 0.0, 0.0, 0.4]);
        assert_eq!(found.beams[0].curvature, [3.0, 2.0, 1.0, 4.0, 3.5]);
        assert_eq!(found.beams[1].curvature, [100.0, 0.0, 0.0]);
        // Cells of 0.5 m and 1.5 m, with two stations each: the record counts that errs most, 3² of
        // the first, and 1² and 4² of the last. Of the string the direction counts, over its length.
        let cells = [(vec![0.25 * 9.0, 0.75 * (1.0 + 16.0)], 2.0), (vec![2.0 * 0.2 * 0.2], 3.0)];
        for (found, (squares, order)) in found.cells.iter().zip(cells) {
            assert_eq!(found.order, order);
            assert!(found.squares.iter().zip(&squares).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        }
        // In equilibria, records without a partner tell nothing.
        let found = of(&scene("static = {}"), &coarse, &fine).unwrap();
        assert!(found.records[1].is_nan() && found.records[2] == 0.4);
        let sample = found.probes[0].samples[1];
        assert!(sample.x.is_nan() && sample.strain.is_nan());
        assert_eq!(found.probes[0].samples[2], last);
        // Where cells meet, curvatures of the last state count, too, but not those of a string.
        let shape = |curvature: [f64; 3]| Shape {
            s: vec![0.0, 0.5, 2.0],
            curvature: curvature.into(),
            ..Shape::default()
        };
        let of_string = Shape { s: vec![0.0, 4.0], curvature: vec![1e3; 2], ..Shape::default() };
        let coarse = Trajectory { last: vec![shape([0.0, 5.0, 0.0]), Shape::default()], ..coarse };
        fine.last = vec![shape([0.0, -16.0, 1.0]), of_string];
        assert_eq!(of(&motion, &coarse, &fine).unwrap().errors.curvature, Some(21.0 / 16.0));
        // A probe may see more than the stations, and what is not a number is no small difference.
        let far = ProbeSample { y: 2.0, ..ProbeSample::default() };
        let found = of(&motion, &seen(&[0.0, 1.0], &[(1, 0, far)]), &seen(&[0.0, 1.0], &[])).unwrap();
        assert_eq!((found.errors.result, found.errors.curvature), (1.0, None));
        let lost = ProbeSample { x: f64::NAN, ..ProbeSample::default() };
        assert!(of(&motion, &seen(&[0.0, 1.0], &[(0, 7, lost)]), &seen(&[0.0, 1.0], &[])).is_err());
    }

    /// Everything a probe sees differs at least by the smaller one of the differences on both sides of it, its direction by the
    /// larger one; at the start of a beam there is one side only.
    #[test]
    fn probes_differ_no_less_than_both_sides_of_them() {
        let of = |by: f64| Shape {
            s: vec![0.0, 1.0, 3.0],
            x: vec![0.0; 3],
            y: vec![0.0, by, 2.0 * by],
            angle: vec![0.0, 3.0 * by + TAU, 4.0 * by],
            strain: vec![0.0, 6.0 * by, 5.0 * by],
            curvature: vec![0.0, 7.0 * by, -8.0 * by],
            ..Shape::default()
        };
        let none = ProbeSample::default();
        let beam = |bending_stiffness: Option<Along>, discretization| {
            let section = Section { bending_stiffness, ..Section::new(1.0, 1.0) };
            Beam::line("arm", [0.0; 2], [3.0, 0.0], section, discretization)
        };
        let elements = Discretization::ancf(2);
        let stiff = beam(Some(1.0.into()), elements.clone());
        let at = |seen, s| not_by_chance(seen, &of(0.0), &of(0.125), s, &stiff);
        let least = ProbeSample { x: 0.125, y: 0.125, angle: 0.5, strain: 0.625, curvature: 0.875, ..none };
        let found = at(none, 2.0);
        assert!((found.angle - least.angle).abs() < 1e-14);
        assert_eq!(ProbeSample { angle: least.angle, ..found }, least);
        let more =
            ProbeSample { x: 1.0, y: 1.0, angle: 1.0, strain: 1.0, curvature: 1.0, vx: Some(0.0), vy: None };
        assert_eq!(at(more, 2.0), more);
        let of_string = not_by_chance(none, &of(0.0), &of(0.125), 2.0, &beam(None, elements));
        assert_eq!(of_string, found);
        assert_eq!((at(none, 0.0), at(none, 3.5)), (none, none));
        let between = at(none, 0.5);
        assert!((between.angle - 0.375).abs() < 1e-14);
        assert_eq!(ProbeSample { angle: 0.0, ..between }, none);
        let meshfree = beam(Some(1.0.into()), Discretization::rpim(9));
        let strain_at_end = |beam| not_by_chance(none, &of(0.0), &of(0.125), 3.0, beam).strain;
        assert_eq!((strain_at_end(&stiff), strain_at_end(&meshfree)), (0.625, 0.75));
    }

    /// A strain of 2 between 5 before and 0 behind errs by 3; that it is where forces jump, or a string turns, is seen in
    /// the last shape.
    #[test]
    fn one_value_where_strains_jump_errs_by_the_jump() {
        let scene = scene("static = {}");
        let under = |moment: f64, beam: usize, s: f64, axial: [f64; 2]| {
            let shape = |middle: f64| Shape {
                s: vec![0.0, middle, middle, 2.0 * middle],
                axial_force: vec![axial[0], axial[0], axial[1], axial[1]],
                bending_moment: vec![moment; 4],
                ..Shape::default()
            };
            jumps(scene.model(), &[shape(1.0), shape(2.0)], Place::new(beam, s))
        };
        let at = |beam: usize, s: f64, axial: [f64; 2]| under(0.0, beam, s, axial);
        assert!(at(0, 1.0, [1e-9, 0.0]) && !under(8.0, 0, 1.0, [1e-9, 0.0]), "round-off of a moment");
        let couple = |by: f64| {
            let shape = Shape {
                s: vec![0.0, 1.0, 1.0, 2.0],
                axial_force: vec![0.0; 4],
                bending_moment: vec![2.0, 2.0, 2.0 + by, 0.0],
                ..Shape::default()
            };
            jumps(scene.model(), &[shape], Place::new(0, 1.0))
        };
        assert!(couple(1e-5) && !couple(1e-6));
        assert!(at(0, 1.0, [5.0, 0.0]) && !at(0, 0.5, [5.0, 0.0]) && !at(0, 1.0, [5.0, 5.0 - 1e-6]));
        assert!(at(1, 2.0, [5.0, 5.0]) && !at(1, 1.0, [5.0, 5.0]));
        let fine = Shape {
            s: vec![0.0, 1.0, 2.0],
            x: vec![0.0; 3],
            y: vec![0.0; 3],
            angle: vec![1.0, 0.0, -0.5 + TAU],
            strain: vec![5.0, 9.0, 0.0],
            curvature: vec![1.0, 9.0, 4.0],
            ..Shape::default()
        };
        let value = ProbeSample { strain: 2.0, curvature: 2.0, angle: 0.25, ..ProbeSample::default() };
        let seen = ProbeSample { strain: 1e-9, curvature: 1e-9, angle: 1e-9, ..ProbeSample::default() };
        let of = |section: &Section| one_sided(seen, &value, &fine, 1.0, (section, false));
        let [arm, rope] = [0, 1].map(|beam| of(&scene.model().beams[beam].section));
        assert_eq!(arm, ProbeSample { strain: 3.0, curvature: 2.0 * 3.0 * 2.0, ..seen });
        let bent = one_sided(seen, &value, &fine, 1.0, (&scene.model().beams[0].section, true));
        assert_eq!(bent, ProbeSample { strain: 3.0, curvature: 2.0, ..seen });
        assert!((rope.angle - 0.75).abs() < 1e-14 && rope.strain == 3.0 && rope.curvature == 1e-9);
        let coupled = Section { coupling: Some(0.5.into()), ..scene.model().beams[0].section.clone() };
        assert_eq!(of(&coupled), ProbeSample { strain: 3.0, curvature: 2.0, ..seen });
    }

    #[test]
    fn records_without_a_partner_take_the_larger_of_their_neighbours() {
        let mut values = vec![0.0, 3.0, 0.0, 1.0, 0.0];
        fill(&mut values, &[1, 3], |a, b| larger(*a, *b));
        assert_eq!(values, [3.0, 3.0, 3.0, 1.0, 1.0]);
        let mut none = vec![1.0, 2.0];
        fill(&mut none, &[], |a, b| larger(*a, *b));
        assert_eq!(none, [1.0, 2.0]);
    }
}
