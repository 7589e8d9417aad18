//! Layers at the ends of tight beams that no cell shows.
//!
//! Under a tension N a beam bends otherwise than a string only within a few λ = √(EI/N) of an end, or of what acts in a point. At an end
//! that turns freely its curvature goes over from that of the string to M/EI. With κ the difference of both, at the distance d, this
//! changes its curvature by κ e^(−d/λ), its direction by κ λ e^(−d/λ) and its position by κ λ² (1 − e^(−d/λ)). Where all cells are longer
//! than λ every mesh has the curvature of the string up to the end, so that coarser meshes tell nothing of that.

use super::{Difference, larger};
use crate::accuracy::mesh::turning;
use crate::centreline::Curve;
use crate::effect::Moment;
use crate::model::{FixedRotation, Joint, Model, Place};
use crate::results::{AnalysisKind, Trajectory};
use std::any::Any;

/// The part of κ λ² by which positions are off within the cell: on average over it they are right.
const OF_CELL: f64 = 0.5;
/// Centrelines that turn by less are straight \[rad\].
const STRAIGHT: f64 = 1e-9;
/// Cells that are so many times longer than λ begin to see it.
const SEEN: f64 = 3.0;

/// A layer at an end of a beam that is shorter than the cell there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::accuracy) struct Layer {
    /// Index of the beam.
    pub beam: usize,
    /// The end, as an arc length \[m\].
    pub end: f64,
    /// λ \[m\].
    pub length: f64,
    /// By how much the curvature is off for it, as a part of the largest.
    pub curvature: f64,
    /// By how much positions in the cell are off for it, in beam lengths.
    pub position: f64,
}

/// What results err by for layers that are shorter than the cells at the ends of beams with the `nodes` \[m\] given, in the records of
/// another `difference`, and these layers; `None` where there are none.
pub(in crate::accuracy) fn layers(
    model: &Model,
    nodes: &[Vec<f64>],
    run: &Trajectory,
    difference: &Difference,
) -> Option<(Difference, Vec<Layer>)> {
    if run.run.analysis != AnalysisKind::Static {
        return None;
    }
    let (mut sum, mut found) = (difference.none(), Vec::new());
    for (index, ((beam, nodes), shape)) in model.beams.iter().zip(nodes).zip(&run.last).enumerate() {
        let (Some(bending), &[first, second, .., before, last]) =
            (&beam.section.bending_stiffness, &nodes[..])
        else {
            continue;
        };
        // Of others the moment is not EI κ.
        let straight = Curve::new(&beam.centreline).is_ok_and(|curve| turning(&curve) < STRAIGHT);
        let actuated = model.parts.iter().any(|part| part.actuation(index).is_some());
        if !straight || actuated || !beam.section.is_linear() {
            continue;
        }
        for (end, cell, k) in
            [(first, second - first, 0), (last, last - before, shape.s.len().saturating_sub(1))]
        {
            let of = |along: &[f64]| along.get(k).copied();
            let values = of(&shape.axial_force).zip(of(&shape.bending_moment)).zip(of(&shape.curvature));
            let Some(((tension, moment), seen)) = values.filter(|((tension, _), _)| *tension > 0.0) else {
                continue;
            };
            let stiffness = bending.at(end, 0.5 * last);
            let layer = (stiffness / tension).sqrt();
            // Cells that are little longer see a part of the layer, and other meshes tell the rest.
            let hidden = 1.0 - SEEN * layer / cell;
            if hidden <= 0.0 || !turns_freely(model, index, end, last) {
                continue;
            }
            let curvature = hidden * (seen - moment / stiffness).abs();
            let of_largest = |scale: f64| if scale > 0.0 { curvature / scale } else { 0.0 };
            let error = of_largest(difference.scales.curvature);
            sum.errors.curvature = sum.errors.curvature.map(|most| larger(most, error));
            let off = OF_CELL * curvature * layer * layer;
            found.push(Layer { beam: index, end, length: layer, curvature: error, position: off / last });
            sum.errors.result = larger(sum.errors.result, off / last);
            sum.records.iter_mut().for_each(|record| *record = larger(*record, off / last));
            let left = |s: f64| (-(s - end).abs() / layer).exp();
            let off = |s: f64| off * (1.0 - left(s)) * (1.0 - (s - end).abs() / cell).max(0.0);
            if let Some(along) = sum.beams.get_mut(index) {
                for ((s, position), bent) in along.s.iter().zip(&mut along.position).zip(&mut along.curvature)
                {
                    *position = larger(*position, off(*s) / last);
                    *bent = larger(*bent, curvature * left(*s));
                }
            }
            let here = model.probes.iter().zip(&mut sum.probes).filter(|(probe, _)| probe.at.beam == index);
            for (s, error) in
                here.flat_map(|(probe, errors)| errors.samples.iter_mut().map(|e| (probe.at.s, e)))
            {
                let left = left(s);
                (error.x, error.y) = (larger(error.x, off(s)), larger(error.y, off(s)));
                let slope = if (s - end).abs() < cell { OF_CELL * layer / cell } else { 0.0 };
                error.angle = larger(error.angle, curvature * layer * left.max(slope));
                error.curvature = larger(error.curvature, curvature * left);
            }
        }
    }
    (!found.is_empty()).then_some((sum, found))
}

/// Whether neither a support, a joint nor a torsion spring holds the direction of a beam at its end.
fn turns_freely(model: &Model, beam: usize, end: f64, length: f64) -> bool {
    let here = |at: &Place| at.beam == beam && (at.s - end).abs() <= super::SAME * length;
    let held = model.supports.iter().any(|s| s.fix.rotation != FixedRotation::Free && here(&s.at));
    let weld = |joint: &&Joint| matches!(joint, Joint::Weld { .. });
    let welded = model.joints.iter().filter(weld).flat_map(Joint::places).any(|at| here(&at));
    let sprung = model.parts.iter().any(|part| {
        let load: &dyn Any = part.as_ref();
        part.couple().is_some_and(|at| here(&at)) && !load.is::<Moment>()
    });
    !held && !welded && !sprung
}

#[cfg(test)]
mod tests {
    use super::super::Scales;
    use super::super::tests::scene;
    use super::*;
    use crate::results::{BeamErrors, Errors, ProbeErrors, ProbeSample, Run, Shape};

    /// The clamped arm of 2 m and EI = 1 N m² with a last cell of 1 m, pulled by a force N; at its free end the moment is 0.3 N m and the
    /// curvature 0.1 /m.
    fn of(tension: f64, more: &str) -> Option<(Difference, Vec<Layer>)> {
        let scene = scene(&format!("static = {{}}\n{more}"));
        let arm = Shape {
            s: vec![0.0, 2.0],
            axial_force: vec![tension; 2],
            bending_moment: vec![0.3; 2],
            curvature: vec![0.1; 2],
            ..Shape::default()
        };
        let run = Run { analysis: AnalysisKind::Static, ..Run::default() };
        let run = Trajectory { run, last: vec![arm, Shape::default()], ..Trajectory::default() };
        let along = BeamErrors {
            beam: "arm".into(),
            s: vec![0.5, 1.9, 2.0],
            position: vec![9.0; 3],
            curvature: vec![9.0; 3],
        };
        let difference = Difference {
            errors: Errors { curvature: Some(9.0), ..Errors::default() },
            records: vec![9.0],
            probes: vec![ProbeErrors { name: "tip".into(), samples: vec![ProbeSample::default()] }],
            beams: vec![along, BeamErrors::default()],
            scales: Scales { curvature: 0.28, ..Scales::default() },
            ..Difference::default()
        };
        layers(scene.model(), &[vec![0.0, 0.5, 1.0, 2.0], vec![0.0, 4.0]], &run, &difference)
    }

    /// N = 100 N makes λ = 0.1 m, of which a cell of ten times the length hides 1 − 3/10: κ = 0.7 · 0.2 /m.
    #[test]
    fn a_free_end_has_the_curvature_of_its_moment() {
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        let (sum, found) = of(100.0, "").expect("a layer at the free end, and none at the clamp");
        let [Layer { beam: 0, end: 2.0, length, curvature, position }] = found[..] else {
            panic!("{found:?}")
        };
        near(length, 0.1);
        near(curvature, 0.5);
        near(position, 0.5 * 0.14 * 0.01 / 2.0);
        near(sum.errors.curvature.expect("an error"), 0.5);
        near(sum.errors.result, position);
        near(sum.records[0], position);
        let tip = sum.probes[0].samples[0];
        near(tip.curvature, 0.14);
        near(tip.angle, 0.014);
        assert_eq!(tip.x, 0.0, "the end itself is where it is");
        let [far, beside, end] = sum.beams[0].curvature[..] else { panic!("three places") };
        near(beside, 0.14 / std::f64::consts::E);
        near(end, 0.14);
        assert!(far < 1e-6);
        assert_eq!((sum.beams[0].position[0], sum.beams[0].position[2]), (0.0, 0.0));
        near(sum.beams[0].position[1], position * (1.0 - (-1.0_f64).exp()) * 0.9);
    }

    #[test]
    fn layers_are_at_ends_that_turn_freely_under_tension() {
        assert!(of(10.0, "").is_some() && of(8.9, "").is_none(), "cells of three λ begin to see it");
        assert!(of(-100.0, "").is_none(), "no tension");
        assert!(of(100.0, "effect.torsion_spring = [{ beam = 'arm', at = 'end', stiffness = 1 }]").is_none());
        assert!(of(100.0, "effect.moment = [{ beam = 'arm', at = 'end', value = 1 }]").is_some());
        assert!(of(100.0, "effect.actuation = [{ beam = 'arm', curvature = 1 }]").is_none());
    }
}
