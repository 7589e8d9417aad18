//! By how much the curvatures and strains of an equilibrium are off those of the forces that balance it.
//!
//! Where errors fall as the method promises, two meshes differ by three times as much. At the edge of a contact, beside a stiff
//! spring and in a layer they may agree by chance, and differ at least by what the finer one is [off balance](OffBalance).

use super::{Difference, larger};
use crate::accuracy::mesh::{CellErrors, Mesh};
use crate::model::{Beam, Model};
use crate::results::places::interpolated;
use crate::results::{AnalysisKind, Shape, Trajectory};
use crate::run::{OffBalance, StressFree};

/// Makes what curvatures and strains of the last record of a `run` differ by from those of a coarser one at least what they are off the
/// forces that balance it, where it ends with an equilibrium.
pub fn at_least_off_balance(difference: &mut Difference, model: &Model, meshes: &[Mesh], run: &Trajectory) {
    if run.run.analysis != AnalysisKind::Static || !run.run.complete {
        return;
    }
    for (index, ((beam, mesh), shape)) in model.beams.iter().zip(meshes).zip(&run.last).enumerate() {
        let actuated = model.parts.iter().any(|part| part.actuation(index).is_some());
        let known = difference.errors.result * mesh.length();
        let off = if actuated { None } else { Off::of(beam, shape, known) };
        let Some(Off { strain, curvature }) = off else { continue };
        if let Some(most) = &mut difference.errors.curvature {
            let here = curvature.iter().copied().fold(0.0, larger);
            *most = larger(*most, here / difference.scales.curvature);
        }
        for (probe, errors) in model.probes.iter().zip(&mut difference.probes) {
            if let Some(error) = errors.samples.last_mut().filter(|_| probe.at.beam == index) {
                let least = |off: &[f64]| {
                    let sides = [false, true].map(|after| interpolated(&shape.s, off, probe.at.s, after));
                    sides.into_iter().flatten().reduce(f64::min).unwrap_or(0.0)
                };
                error.curvature = larger(error.curvature, least(&curvature));
                error.strain = larger(error.strain, least(&strain));
            }
        }
        if let Some(along) = difference.beams.get_mut(index) {
            for (s, error) in along.s.iter().zip(&mut along.curvature) {
                *error = larger(*error, interpolated(&shape.s, &curvature, *s, true).unwrap_or(0.0));
            }
        }
        if let Some(CellErrors { squares, .. }) =
            difference.cells.get_mut(index).filter(|_| beam.section.bending_stiffness.is_some())
        {
            for (cell, square) in mesh.nodes.windows(2).zip(squares) {
                let within = |s: f64| s >= cell[0] && s <= cell[1];
                let here = shape.s.iter().zip(&curvature).filter(|(s, _)| within(**s));
                let (sum, places) =
                    here.fold((0.0, 0), |(sum, places), (_, off)| (sum + off * off, places + 1));
                *square = larger(*square, (cell[1] - cell[0]) * sum / f64::from(places.max(1)));
            }
        }
    }
}

/// Sizes of what is off at each place of a shape.
struct Off {
    strain: Vec<f64>,
    curvature: Vec<f64>,
}

impl Off {
    /// What is certain of them where positions are `known` to be off by so much \[m\], and moments by as much times the largest force. `None`
    /// where forces do not tell strains.
    fn of(beam: &Beam, shape: &Shape, known: f64) -> Option<Self> {
        let OffBalance { strain, curvature } = OffBalance::of(beam, shape, &StressFree::curve(beam, shape)?)?;
        let forces = shape.axial_force.iter().chain(&shape.shear_force);
        let unsure = known * forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let inside = 0.5 * shape.s.last()?;
        let bending = |s: f64| beam.section.bending_stiffness.as_ref().map(|along| along.at(s, inside));
        let certain =
            |(s, off): (&f64, f64)| (off.abs() - bending(*s).map_or(0.0, |ei| unsure / ei)).max(0.0);
        Some(Self {
            strain: strain.into_iter().map(f64::abs).collect(),
            curvature: shape.s.iter().zip(curvature).map(certain).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Scales;
    use super::super::tests::{meshes, scene};
    use super::*;
    use crate::model::{Along, StrainMeasure};
    use crate::results::{BeamErrors, Errors, ProbeErrors, ProbeSample, Run};

    /// The arm of 2 m, EA = 1 N and EI = 1 N m² with cells of 0.5 m and 1.5 m, in an equilibrium of N = 0.25 N everywhere
    /// and a moment of 2 N m that falls to nothing, behind a jump at 1 m.
    fn run() -> Trajectory {
        let arm = Shape {
            s: vec![0.0, 1.0, 1.0, 1.5, 2.0],
            strain: vec![0.25, 0.25, 0.25, 0.25, 0.5],
            curvature: vec![2.0, 0.0, 0.0, 0.75, -0.5],
            axial_force: vec![0.25; 5],
            bending_moment: vec![2.5, 2.0, 1.0, 0.5, 0.0],
            ..Shape::default()
        };
        let run = Run { analysis: AnalysisKind::Static, complete: true, ..Run::default() };
        Trajectory { run, last: vec![arm, Shape::default()], ..Trajectory::default() }
    }

    fn seen(curvature: f64) -> Difference {
        let sample = ProbeSample { strain: 0.125, curvature, ..ProbeSample::default() };
        Difference {
            errors: Errors { curvature: Some(curvature / 4.0), ..Errors::default() },
            probes: vec![ProbeErrors { name: "tip".into(), samples: vec![ProbeSample::default(), sample] }],
            beams: vec![
                BeamErrors {
                    beam: "arm".into(),
                    s: vec![0.5, 1.75],
                    position: vec![0.0; 2],
                    curvature: vec![curvature; 2],
                },
                BeamErrors::default(),
            ],
            cells: vec![
                CellErrors { squares: vec![0.0, 0.0], order: 2.0 },
                CellErrors { squares: vec![9.0], order: 3.0 },
            ],
            scales: Scales { curvature: 4.0, ..Scales::default() },
            ..Difference::default()
        }
    }

    /// Worked out by hand: the curvature is off by 0.5, 0.25 and 0.5 /m at the start, at 1.5 m and at the end, the strain by 0.25
    /// at the end; at the jump nothing is told.
    #[test]
    fn what_is_off_the_balance_is_the_least_error() {
        let model = scene("static = {}").model().clone();
        let mut found = seen(0.0);
        at_least_off_balance(&mut found, &model, &meshes(), &run());
        assert_eq!(found.errors.curvature, Some(0.5 / 4.0));
        let [first, tip] = found.probes[0].samples[..] else { panic!("two records") };
        assert_eq!((first.curvature, tip.curvature, tip.strain), (0.0, 0.5, 0.25));
        assert_eq!(found.beams[0].curvature, [0.25, 0.375]);
        // One place in the first cell, four in the second, of which two are those of the jump.
        let squares = [0.5 * 0.25, 1.5 * (0.0625 + 0.25) / 4.0];
        assert_eq!((&found.cells[0].squares[..], found.cells[1].squares[0]), (&squares[..], 9.0));
        let mut larger = seen(1.0);
        at_least_off_balance(&mut larger, &model, &meshes(), &run());
        assert_eq!((larger.errors.curvature, larger.beams[0].curvature[1]), (Some(0.25), 1.0));
        assert_eq!(larger.probes[0].samples[1].curvature, 1.0);
    }

    #[test]
    fn nothing_is_told_where_forces_tell_no_strains() {
        let told = |text: &str, change: fn(&mut Trajectory)| {
            let (mut found, mut run) = (seen(0.0), run());
            change(&mut run);
            at_least_off_balance(&mut found, scene(text).model(), &meshes(), &run);
            found.errors.curvature.expect("an error")
        };
        assert_eq!(told("static = {}\neffect.actuation = [{ beam = 'arm', curvature = 1 }]", |_| ()), 0.0);
        assert_eq!(told("static = {}", |run| run.run.analysis = AnalysisKind::Dynamic), 0.0);
        assert_eq!(told("static = {}", |run| run.run.complete = false), 0.0);
        assert_eq!(told("static = {}", |run| run.last[0].axial_force.clear()), 0.0);
    }

    /// EA = 1, EI = 1 and EB = 0.5: N = 0.25 and M = 2.5 make ε = −4/3 and κ = 19/6. Green's strain: the force along a tangent of the length
    /// 2 is twice EA ε.
    #[test]
    fn strains_are_those_of_the_section() {
        let scene = scene("static = {}");
        let mut arm = scene.model().beams[0].clone();
        arm.section.coupling = Some(Along::from(0.5));
        let off = Off::of(&arm, &run().last[0], 0.0).expect("forces");
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        near(off.strain[0], 0.25 + (2.5 * 0.5 - 0.25) / 0.75);
        near(off.curvature[0], (2.5 - 0.25 * 0.5) / 0.75 - 2.0);
        let mut green = scene.model().beams[0].clone();
        green.strain = StrainMeasure::Green;
        let shape = Shape {
            s: vec![0.0, 2.0],
            strain: vec![1.5; 2],
            curvature: vec![0.0; 2],
            axial_force: vec![3.0; 2],
            bending_moment: vec![0.0; 2],
            ..Shape::default()
        };
        assert_eq!(Off::of(&green, &shape, 0.0).expect("forces").strain, [0.0, 0.0]);
    }
}
