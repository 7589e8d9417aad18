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
