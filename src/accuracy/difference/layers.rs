//! Layers at the ends of tight beams, and at points within them, that no cell shows.
//!
//! Under a tension N a beam bends otherwise than a string only within a few λ = √(EI/N) of an end, or of what acts in a point. At an end
//! that turns freely its curvature goes over from that of the string to M/EI. With κ the difference of both, at the distance d, this
//! changes its curvature by κ e^(−d/λ), its direction by κ λ e^(−d/λ) and its position by κ λ² (1 − e^(−d/λ)). Where all cells are longer
//! than λ every mesh has the curvature of the string up to the end, so that coarser meshes tell nothing of that.
//!
//! At an end that is held the direction goes over from the θ₀ of the string to another one, θ, and the curvature there is
//! κ = κ₀ ± (θ₀ − θ)/λ, with κ₀ that of the string and the sign of the start or the end of the beam. A clamp gives θ; a torsion spring turns
//! until its moment is EI κ. Long cells bend by far less. At a clamp positions err by a part of the cell's length times θ₀ − θ, which coarser
//! meshes do tell; a moment of a spring that is off by ΔM moves the string by ΔM/N, which they do not.

use super::{Difference, larger};
use crate::accuracy::mesh::turning;
use crate::centreline::Curve;
use crate::effect::{Moment, TorsionSpring};
use crate::model::{FixedRotation, Joint, Model, Place};
use crate::results::places::interpolated;
use crate::results::{AnalysisKind, Shape, Trajectory};
use std::any::Any;
use std::f64::consts::TAU;

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
        let (Some(bending), &[_, _, .., _, last]) = (&beam.section.bending_stiffness, &nodes[..]) else {
            continue;
        };
        // Of others the moment is not EI κ.
        let straight = Curve::new(&beam.centreline).is_ok_and(|curve| turning(&curve) < STRAIGHT);
        let actuated = model.parts.iter().any(|part| part.actuation(index).is_some());
        if !straight || actuated || !beam.section.is_linear() {
            continue;
        }
        let is_point =
            |s: f64| model.points().any(|at| at.beam == index && (at.s - s).abs() <= super::SAME * last);
        // Both sides of a point within the beam end there.
        let ends = nodes.windows(2).enumerate().flat_map(|(i, cell)| {
            let begins = i == 0 || is_point(cell[0]);
            let ends = i + 2 == nodes.len() || is_point(cell[1]);
            let length = cell[1] - cell[0];
            let begin = begins.then_some((cell[0], 1.0, length));
            begin.into_iter().chain(ends.then_some((cell[1], -1.0, length)))
        });
        for (end, side, cell) in ends {
            let of = |along: &[f64]| interpolated(&shape.s, along, end, side > 0.0);
            let values = of(&shape.axial_force).zip(of(&shape.bending_moment)).zip(of(&shape.curvature));
            let Some((((tension, moment), seen), angle)) = values.zip(of(&shape.angle)) else { continue };
            let stiffness = bending.at(end, 0.5 * last);
            let layer = (stiffness / tension).sqrt();
            // Cells that are little longer see a part of the layer, and other meshes tell the rest.
            let hidden = 1.0 - SEEN * layer / cell;
            let Some(resists) = resistance(model, index, end, last).filter(|_| tension > 0.0 && hidden > 0.0)
            else {
                continue;
            };
            let here = End { s: end, side, cell, stiffness, layer, moment, curvature: seen, angle };
            let Some(off) = here.off(shape, resists) else { continue };
            let Off { curvature, turned, beside, position, shift } = off.times(hidden);
            let most = larger(position, shift) / last;
            let of_largest = |scale: f64| if scale > 0.0 { curvature / scale } else { 0.0 };
            let error = of_largest(difference.scales.curvature);
            sum.errors.curvature = sum.errors.curvature.map(|most| larger(most, error));
            found.push(Layer { beam: index, end, length: layer, curvature: error, position: most });
            sum.errors.result = larger(sum.errors.result, most);
            sum.records.iter_mut().for_each(|record| *record = larger(*record, most));
            let left = |s: f64| (-(s - end).abs() / layer).exp();
            let off = |s: f64| {
                let far = |length: f64| (1.0 - (s - end).abs() / length).max(0.0);
                (1.0 - left(s)) * larger(position * far(cell), shift * far(last))
            };
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
                let beside = if (s - end).abs() < cell { beside * (1.0 - left) } else { 0.0 };
                error.angle = larger(error.angle, larger(turned * left, beside));
                error.curvature = larger(error.curvature, curvature * left);
            }
        }
    }
    (!found.is_empty()).then_some((sum, found))
}

/// An end of a beam as a mesh sees it.
struct End {
    /// Its arc length \[m\].
    s: f64,
    /// 1 for the start, −1 for the end.
    side: f64,
    /// Length of the cell there \[m\].
    cell: f64,
    /// EI \[N m²\].
    stiffness: f64,
    /// λ \[m\].
    layer: f64,
    /// Moment that balances the beam there \[N m\].
    moment: f64,
    /// \[1/m\]
    curvature: f64,
    /// \[rad\]
    angle: f64,
}

/// What a mesh is off by for a layer.
struct Off {
    /// Curvature at the end \[1/m\].
    curvature: f64,
    /// Direction at the end \[rad\] …
    turned: f64,
    /// … and elsewhere within the cell.
    beside: f64,
    /// Position within the cell \[m\].
    position: f64,
    /// Position of the whole beam, which falls to nothing at its other end \[m\].
    shift: f64,
}

impl Off {
    fn times(self, factor: f64) -> Self {
        let Self { curvature, turned, beside, position, shift } = self;
        Self {
            curvature: factor * curvature,
            turned: factor * turned,
            beside: factor * beside,
            position: factor * position,
            shift: factor * shift,
        }
    }
}

impl End {
    /// By how much a mesh is off where a couple of k = `resists` \[N m/rad\] resists a turn of the end; `None` where it does not tell.
    fn off(&self, shape: &Shape, resists: f64) -> Option<Off> {
        let Self { side, cell, stiffness, layer, moment, .. } = *self;
        if resists == 0.0 {
            let curvature = (self.curvature - moment / stiffness).abs();
            let position = OF_CELL * curvature * layer * layer;
            return Some(Off {
                curvature,
                turned: curvature * layer,
                beside: position / cell,
                position,
                shift: 0.0,
            });
        }
        let [direction, string] = self.string(shape)?;
        let angle = if resists.is_finite() {
            let bends = stiffness / layer;
            let moments = side * (stiffness * string - moment) + bends * direction + resists * self.angle;
            moments / (resists + bends)
        } else {
            self.angle
        };
        let curvature = (self.curvature - string - side * (direction - angle) / layer).abs();
        let (turned, beside) = ((self.angle - angle).abs(), (direction - angle).abs());
        let square = layer * layer;
        let [position, shift] = match resists.is_finite() {
            true => [OF_CELL * curvature * square, resists * turned * square / stiffness],
            false => [0.0; 2],
        };
        Some(Off { curvature, turned, beside, position, shift })
    }

    /// The direction \[rad\] and the curvature \[1/m\] that a string would have at the end: those of the chord of the cell and of the middle of
    /// the next one.
    fn string(&self, shape: &Shape) -> Option<[f64; 2]> {
        let Self { s, side, cell, angle, .. } = *self;
        let at = |values: &[f64], s: f64| interpolated(&shape.s, values, s, true);
        let next = s + side * cell;
        let [x, y] = [&shape.x, &shape.y].map(|of| Some(side * (at(of, next)? - at(of, s)?)));
        let chord = y?.atan2(x?);
        let curvature = at(&shape.curvature, s + 1.5 * side * cell)?;
        let turn = chord - side * 0.5 * cell * curvature - angle;
        Some([angle + turn - TAU * (turn / TAU).round(), curvature])
    }
}

/// The stiffness against a turn of a beam at a place \[N m/rad\], infinite where its direction is known; `None` where another part decides
/// on it.
fn resistance(model: &Model, beam: usize, end: f64, length: f64) -> Option<f64> {
    let near = super::SAME * length;
    let here = |at: &Place| at.beam == beam && (at.s - end).abs() <= near;
    let held = model.supports.iter().any(|s| s.fix.rotation != FixedRotation::Free && here(&s.at));
    let weld = |joint: &&Joint| matches!(joint, Joint::Weld { .. });
    let welded = model.joints.iter().filter(weld).flat_map(Joint::places).any(|at| here(&at));
    // Within a beam, and in a weld, the direction lies between those of two strings, where meshes have it too.
    if held || welded || (end > near && end < length - near) {
        return Some(f64::INFINITY);
    }
    let couples = model.parts.iter().filter(|part| part.couple().is_some_and(|at| here(&at)));
    let stiffnesses = couples.map(|part| {
        let part: &dyn Any = part.as_ref();
        let spring = part.downcast_ref::<TorsionSpring>().map(|spring| spring.stiffness.unwrap_or(0.0));
        spring.or(part.is::<Moment>().then_some(0.0))
    });
    stiffnesses.sum()
}

#[cfg(test)]
mod tests {
    use super::super::Scales;
    use super::super::tests::scene;
    use super::*;
    use crate::results::{BeamErrors, Errors, ProbeErrors, ProbeSample, Run, Shape};

    /// The clamped arm of 2 m and EI = 1 N m² with a first cell of half a metre and a last one of one, pulled by a force N; it lies along
    /// x, has the curvature 0.1 /m everywhere, and the moment 0.3 N m.
    fn of(tension: f64, more: &str) -> Option<(Difference, Vec<Layer>)> {
        let scene = scene(&format!("static = {{}}\n{more}"));
        let arm = Shape {
            s: vec![0.0, 2.0],
            x: vec![0.0, 2.0],
            y: vec![0.0; 2],
            angle: vec![0.0; 2],
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
        let (sum, found) = of(100.0, "").expect("layers");
        let [Layer { end: 0.0, .. }, Layer { beam: 0, end: 2.0, length, curvature, position }] = found[..]
        else {
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
        // A clamp has a layer of its own, in which it bends by 0.25 /m less.
        near(far, 0.4 * 0.25 * (-5.0_f64).exp());
        assert_eq!((sum.beams[0].position[0], sum.beams[0].position[2]), (0.0, 0.0));
        near(sum.beams[0].position[1], position * (1.0 - (-1.0_f64).exp()) * 0.9);
    }

    /// The string that would be there has the directions −0.025 rad at the start, a quarter of a cell's turn, and 0.05 rad at the end. The
    /// clamp bends it by 0.1 − 0.025/0.1 at the start. A spring of 10 N m/rad, as stiff as the layer, holds the end half as much, with
    /// −10 θ = EI κ − 0.3 = 0.1 − (0.05 − θ)/0.1 − 0.3.
    #[test]
    fn ends_that_are_held_bend_the_string() {
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        let spring = "effect.torsion_spring = [{ beam = 'arm', at = 'end', stiffness = 10 }]";
        let (sum, found) = of(100.0, spring).expect("layers");
        let [Layer { end: 0.0, curvature: clamp, .. }, Layer { end: 2.0, curvature, position, .. }] =
            found[..]
        else {
            panic!("{found:?}")
        };
        near(clamp, 0.4 * 0.25 / 0.28);
        let angle = (0.2 + 0.5) / 20.0;
        let bent = 0.1 - (0.05 - angle) / 0.1;
        near(-10.0 * angle, bent - 0.3);
        near(curvature, 0.7 * (bent - 0.1).abs() / 0.28);
        near(sum.probes[0].samples[0].angle, 0.7 * angle);
        near(sum.probes[0].samples[0].curvature, 0.7 * (bent - 0.1).abs());
        near(position, 0.7 * 10.0 * angle / 100.0 / 2.0);
        near(sum.errors.result, position);
        near(sum.beams[0].position[0], 0.7 * 10.0 * angle / 100.0 / 2.0 * 0.25 * (1.0 - (-15.0_f64).exp()));
    }

    #[test]
    fn layers_are_at_ends_under_tension() {
        let ends = |tension: f64, more: &str| -> Vec<f64> {
            of(tension, more)
                .map_or_else(Vec::new, |(_, found)| found.iter().map(|layer| layer.end).collect())
        };
        assert_eq!((ends(10.0, ""), ends(8.9, "")), (vec![2.0], vec![]), "cells of three λ begin to see it");
        assert!(of(-100.0, "").is_none(), "no tension");
        assert_eq!(ends(100.0, "effect.moment = [{ beam = 'arm', at = 'end', value = 1 }]"), [0.0, 2.0]);
        // Of a point within the beam the side on which a cell follows the next one tells.
        assert_eq!(
            ends(100.0, "effect.force = [{ beam = 'arm', at = 1.0, value = [0, 1] }]"),
            [0.0, 1.0, 2.0]
        );
        assert!(of(100.0, "effect.actuation = [{ beam = 'arm', curvature = 1 }]").is_none());
    }
}
