//! Errors beside places where the strain of a beam jumps.
//!
//! Shape functions with continuous tangents have one strain where two cells meet. If the strain jumps there by Δε, as where a force
//! pulls along the beam, elements of the lengths h on both sides move the place by Δε h/12 along the
//! beam, and no others: the cubics that come nearest to a corner in energy do. Where the section couples stretch and bending by
//! a stiffness EB that jumps, the strain that is wrong on one side bends the beam by ΔEB/EI times as much. These errors fall in
//! proportion to h only, beside others that fall faster, so that runs on coarser meshes do not tell them. The strain itself is wrong by
//! Δε/2 beside the place, and right at the other ends of both elements. A support that fixes the gradient leaves no strain in its point,
//! and does to each side what a jump of twice its strain would.

use super::{Difference, larger};
use crate::model::{Along, Beam, FixedRotation, Model, Place, Section};
use crate::results::{Shape, Trajectory};

/// Of Δε h.
const OF_JUMP: f64 = 1.0 / 12.0;
/// Of Δε, what the strain beside the place is wrong by.
const OF_STRAIN: f64 = 0.5;
/// A tangent r' that is too long by a small part makes the curvature r' × r''/|r'|² wrong by at most so many times that part.
pub(super) const OF_CURVATURE: f64 = 2.0;
/// Places that are nearer to each other are one, in lengths of a beam.
const SAME: f64 = 1e-9;
/// Strains below this are round-off.
const ROUND_OFF: f64 = 1e-12;

/// A place within a beam where its strain jumps, and by how much the result errs for that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::accuracy) struct StrainJump {
    /// Index of the beam.
    pub beam: usize,
    /// Arc length \[m\].
    pub s: f64,
    /// In beam lengths, or relative.
    pub error: f64,
}

/// What strains that jump make the positions of a run err by on beams with the `nodes` \[m\] given, in the records of another
/// `difference` of it, and where; `None` where none jumps.
pub(in crate::accuracy) fn strain_jumps(
    model: &Model,
    nodes: &[Vec<f64>],
    run: &Trajectory,
    difference: &Difference,
) -> Option<(Difference, Vec<StrainJump>)> {
    let (mut sum, mut jumps, mut any) = (difference.none(), Vec::new(), false);
    for (index, ((beam, nodes), shape)) in model.beams.iter().zip(nodes).zip(&run.last).enumerate() {
        let length = nodes.last().copied().unwrap_or(0.0);
        let softer = stiffness_jumps(model, index, length);
        let fixed = each_once(fixed_gradients(model, index).collect(), length);
        let is_fixed = |s: f64| fixed.iter().any(|other| (s - other).abs() <= SAME * length);
        let jumps_at = within(points(model, index).chain(model.breaks(index)), length);
        let jumps_at = jumps_at.into_iter().filter(|s| !is_fixed(*s));
        let jumps_at = jumps_at.map(|s| (s, at(model, beam, index, shape, (s, length)), false));
        let held_at = fixed.iter().map(|s| (*s, held_back(model, beam, index, shape, (*s, length)), true));
        for (s, [along, turn], held) in jumps_at.chain(held_at) {
            if along.is_nan() || along <= ROUND_OFF {
                continue;
            }
            any = true;
            let behind = nodes.partition_point(|node| *node <= s + SAME * length).clamp(1, nodes.len() - 1);
            let before = nodes.partition_point(|node| *node < s - SAME * length).max(1) - 1;
            let cells = [s - nodes[before], nodes[behind] - s];
            for ((probe, errors), seen) in model.probes.iter().zip(&mut sum.probes).zip(&run.probes) {
                let away = probe.at.s - s;
                let part = 1.0 - away.abs() / cells[usize::from(away > 0.0)];
                let here = away.abs() <= SAME * length;
                let part = if here { 1.0 } else { part };
                if probe.at.beam != index || here && !held || part <= 0.0 {
                    continue;
                }
                let strain = OF_STRAIN * along * part;
                for (error, seen) in errors.samples.iter_mut().zip(&seen.samples) {
                    error.strain = larger(error.strain, strain);
                    error.curvature = larger(error.curvature, OF_CURVATURE * strain * seen.curvature.abs());
                }
            }
            // What positions err by where a stiffness jumps is told by other runs.
            if softer.iter().any(|other| (s - other).abs() <= SAME * length) {
                continue;
            }
            let cell = cells[0].max(cells[1]);
            let (moved, turned) = (OF_JUMP * cell * along, OF_JUMP * cell * turn);
            let result = (moved + turned * length) / length;
            jumps.push(StrainJump { beam: index, s, error: result });
            // A jump moves its place, a support that holds the strain back all but its place.
            let moves = |place: f64| {
                let away = (place - s).abs();
                let moves = if held { away > SAME * length } else { away <= cell };
                if moves { moved } else { 0.0 }
            };
            sum.errors.result = larger(sum.errors.result, result);
            sum.records.iter_mut().for_each(|record| *record = larger(*record, result));
            if let Some(errors) = sum.beams.get_mut(index) {
                for (place, error) in errors.s.iter().zip(&mut errors.position) {
                    *error = larger(*error, (moves(*place) + turned * length) / length);
                }
            }
            for (probe, errors) in model.probes.iter().zip(&mut sum.probes) {
                let here = if probe.at.beam == index { moves(probe.at.s) } else { 0.0 };
                let error = here + turned * length;
                for sample in &mut errors.samples {
                    (sample.x, sample.y) = (larger(sample.x, error), larger(sample.y, error));
                    sample.angle = larger(sample.angle, turned);
                }
            }
        }
    }
    any.then_some((sum, jumps))
}

/// Where on a beam the strain of a mode may jump, by nobody knows how much beforehand, since modes have no size. Beams that keep their
/// length have no strain, and what a string errs by is told by its kinks.
pub(in crate::accuracy) fn jumps_of_modes(model: &Model, beam: usize, length: f64) -> Vec<f64> {
    let Section { axial_stiffness, bending_stiffness, .. } = &model.beams[beam].section;
    let softer = stiffness_jumps(model, beam, length);
    if axial_stiffness.is_none() || bending_stiffness.is_none() {
        return softer;
    }
    // Where what is imposed ends, or the force of a tendon, the strain of the state about which they are jumps.
    let jumps = model.parts.iter().flat_map(|part| part.jumps()).filter(|at| at.beam == beam);
    let mut places = within(points(model, beam).chain(jumps.map(|at| at.s)).chain(softer), length);
    places.extend(fixed_gradients(model, beam));
    each_once(places, length)
}

/// Where supports fix the gradient of a beam, and so leave no strain in one point, which may be an end.
pub(in crate::accuracy) fn fixed_gradients(model: &Model, beam: usize) -> impl Iterator<Item = f64> {
    let fixed = model.supports.iter().filter(|support| support.fix.rotation == FixedRotation::Gradient);
    fixed.map(|support| support.at).filter(move |at| at.beam == beam).map(|at| at.s)
}

/// The arc lengths at which parts, joints and supports act in a point of a beam.
fn points(model: &Model, beam: usize) -> impl Iterator<Item = f64> {
    model.points().filter(move |at: &Place| at.beam == beam).map(|at| at.s)
}

/// Where within a beam its stiffness against stretching, or its coupling, jumps. The strain that is a compromise there makes the
/// beam longer or shorter as a whole, by an amount in proportion to h, and its vibrations and critical loads wrong.
pub(in crate::accuracy) fn stiffness_jumps(model: &Model, beam: usize, length: f64) -> Vec<f64> {
    let Section { axial_stiffness, coupling, .. } = &model.beams[beam].section;
    let jumps = |along: &Along, s: f64| {
        let [before, behind] = [0.5 * s, 0.5 * (s + length)].map(|inside| along.at(s, inside));
        (behind - before).abs() > SAME * before.abs().max(behind.abs())
    };
    let of_beam = model.breaks(beam).into_iter();
    within(
        of_beam.filter(|s| [axial_stiffness, coupling].into_iter().flatten().any(|along| jumps(along, *s))),
        length,
    )
}

/// Places between the ends of a beam, rising, each once.
fn within(places: impl Iterator<Item = f64>, length: f64) -> Vec<f64> {
    each_once(places.filter(|s| *s > SAME * length && *s < (1.0 - SAME) * length).collect(), length)
}

/// Places along a beam, rising, each once.
fn each_once(mut places: Vec<f64>, length: f64) -> Vec<f64> {
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() <= SAME * length);
    places
}

/// By how much the strain jumps at a place of a beam in its last shape where the section or what is imposed jumps; 0 at the ends of the
/// beam, and for round-off.
pub(super) fn strain_jump(model: &Model, place: Place, shape: &Shape) -> f64 {
    let length = shape.s.last().copied().unwrap_or(0.0);
    let is_break = within(model.breaks(place.beam).into_iter(), length)
        .iter()
        .any(|s| (s - place.s).abs() <= SAME * length);
    if !is_break {
        return 0.0;
    }
    let [jump, _] = at(model, &model.beams[place.beam], place.beam, shape, (place.s, length));
    if jump > ROUND_OFF { jump } else { 0.0 }
}

/// By how much the strain jumps at `s`, and that times the jump of EB over EI.
fn at(model: &Model, beam: &Beam, index: usize, shape: &Shape, place: (f64, f64)) -> [f64; 2] {
    let Some([[strain, coupling, bending], [other, other_coupling, _]]) =
        sides(model, beam, index, shape, place)
    else {
        return [0.0; 2];
    };
    let jump = (other - strain).abs();
    [jump, jump * (other_coupling - coupling).abs() / bending]
}

/// The jump that would be as bad as a fixed gradient at `s`, which leaves no strain there, and that times EB over EI: it keeps the strain of
/// each side from its value by what a jump of twice that does.
fn held_back(model: &Model, beam: &Beam, index: usize, shape: &Shape, place: (f64, f64)) -> [f64; 2] {
    let of = sides(model, beam, index, shape, place).map(|sides| {
        sides.map(|[strain, coupling, bending]| {
            [2.0 * strain.abs(), 2.0 * (strain * coupling).abs() / bending]
        })
    });
    of.map_or([0.0; 2], |[before, behind]| [0, 1].map(|k| larger(before[k], behind[k])))
}

/// Before and behind a place: the strain of the forces there, EB \[N m\] and EI \[N m²\].
fn sides(
    model: &Model,
    beam: &Beam,
    index: usize,
    shape: &Shape,
    (s, length): (f64, f64),
) -> Option<[[f64; 3]; 2]> {
    // Where nothing acts in the point itself, the forces are those of the places beside it.
    let first = shape.s.partition_point(|place| *place < s - SAME * length);
    let behind = shape.s.partition_point(|place| *place <= s + SAME * length);
    let [before, behind] = if first == behind { [first.max(1) - 1, behind] } else { [first, behind - 1] };
    let forces = |k: usize| Some([*shape.axial_force.get(k)?, *shape.bending_moment.get(k)?]);
    let (before, behind) = forces(before).zip(forces(behind))?;
    let side = |[force, moment]: [f64; 2], inside: f64| -> Option<[f64; 3]> {
        let value = |along: &Along| along.at(s, inside);
        let axial = value(beam.section.axial_stiffness.as_ref()?);
        let bending = beam.section.bending_stiffness.as_ref().map_or(f64::INFINITY, value);
        let coupling = beam.section.coupling.as_ref().map_or(0.0, value);
        let imposed: f64 = model
            .parts
            .iter()
            .filter_map(|part| part.actuation(index).filter(|imposed| imposed.layer.is_none()))
            .map(|imposed| value(imposed.strain))
            .sum();
        let strain = (force - coupling / bending * moment) / (axial - coupling * coupling / bending);
        Some([strain + imposed, coupling, bending])
    };
    Some([side(before, 0.5 * s)?, side(behind, 0.5 * (s + length))?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    /// Steps that follow each other within a tenth of the beam, and the last of which leads back to the stiffness of the first piece.
    #[test]
    fn every_step_of_the_stiffness_is_a_jump() {
        let text = "beam.bar = { start = [0, 0], end = [2, 0], mass_per_length = 1, bending_stiffness = 1, \
                    axial_stiffness = { pieces = { until = [0.25, 0.5, 1.5], value = [10, 1000, 10, 10] } } }\n\
                    [analysis.modal]\ncount = 1\n";
        let model = parse("scene", text).unwrap().model().clone();
        assert_eq!(stiffness_jumps(&model, 0, 2.0), [0.25, 0.5]);
    }
}
