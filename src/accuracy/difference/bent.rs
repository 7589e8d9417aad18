//! What meshfree shape functions make of a constant curvature.
//!
//! Radial functions reproduce no quadratic polynomials. Near an end of a beam, beyond which there are no nodes, the curvature of their
//! interpolation is wrong by a part that does not fall with the spacing of the nodes, so that coarser meshes do not tell it.

use super::{Difference, larger};
use crate::basis::{Basis, Cell};
use crate::centreline::Curve;
use crate::model::{Discretization, Model};
use crate::results::Trajectory;

/// The part of it by which the curvature of an equilibrium is wrong, whose nodes need not lie on the curve.
const OF_INTERPOLATION: f64 = 0.5;
/// Parts of a curvature below this are round-off.
const ROUND_OFF: f64 = 1e-12;

/// What the curvatures that probes see on meshfree beams are wrong by for that in the records of a run, of which there is another
/// `difference`; `None` where that is nothing.
pub(in crate::accuracy) fn bent(
    model: &Model,
    run: &Trajectory,
    difference: &Difference,
) -> Option<Difference> {
    let (mut sum, mut any) = (difference.none(), false);
    for ((probe, errors), seen) in model.probes.iter().zip(&mut sum.probes).zip(&run.probes) {
        let beam = &model.beams[probe.at.beam];
        let (Discretization::Rpim { .. }, Ok(curve)) = (&beam.discretization, Curve::new(&beam.centreline))
        else {
            continue;
        };
        let basis = Basis::broken(&beam.discretization, curve.length(), &model.breaks(probe.at.beam));
        let Some(part) = basis.ok().and_then(|basis| defects(&basis, &[probe.at.s])?.first().copied()) else {
            continue;
        };
        any |= part > ROUND_OFF;
        for (error, seen) in errors.samples.iter_mut().zip(&seen.samples) {
            error.curvature = larger(error.curvature, OF_INTERPOLATION * part * seen.curvature.abs());
        }
    }
    any.then_some(sum)
}

/// The errors of x'' at some places where the nodal values are those of x = s²/2, whose x'' is 1; `None` where there are no such
/// shape functions.
pub(in crate::accuracy) fn defects(basis: &Basis, places: &[f64]) -> Option<Vec<f64>> {
    let q: Vec<f64> = basis.nodes().iter().flat_map(|s| [0.5 * s * s, *s]).collect();
    let table = basis.points(places, &[2]).ok()?;
    let error = |cell: &Cell| {
        let (_, row) = table.block(*cell);
        let values = &q[cell.first as usize..];
        (row.iter().zip(values).map(|(n, x)| n * x).sum::<f64>() - 1.0).abs()
    };
    Some(table.cells.iter().map(error).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{ProbeErrors, ProbeSample, ProbeSeries};
    use crate::scene::parse;

    fn parts(basis: &str, places: &[f64]) -> Vec<f64> {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [24, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis = {{ {basis} }} }}\n\
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.static = {{}}\n"
        );
        let scene = parse("scene", &text).expect("a scene");
        defects(&Basis::new(&scene.model().beams[0].discretization, 24.0).expect("a basis"), places)
            .expect("shape functions")
    }

    /// At the ends a five-hundredth, whatever the number of nodes, and within the beam a hundredth of that. Elements reproduce parabolas.
    #[test]
    fn radial_functions_miss_constant_curvatures_at_the_ends() {
        let found = [25, 49].map(|nodes| {
            let cell = 24.0 / f64::from(nodes - 1);
            parts(&format!("rpim.nodes = {nodes}"), &[0.0, 24.0, 4.5 * cell])
        });
        for [start, end, within] in found.map(|found| <[f64; 3]>::try_from(found).expect("three")) {
            assert!(
                (start - 2.16e-3).abs() < 1e-5 && (end - start).abs() < 1e-8 && within < 5e-5,
                "{start} {end} {within}"
            );
        }
        assert!(parts("ancf.elements = 24", &[0.0, 5.5]).iter().all(|part| *part < 1e-12));
    }

    /// Half of that part of each curvature that is seen.
    #[test]
    fn what_probes_see_is_wrong_by_a_part_of_it() {
        let of = |basis: &str| {
            let text = format!(
                "beam.a = {{ start = [0, 0], end = [24, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis = {{ {basis} }} }}\n\
                 support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 probe = [{{ name = 'p', beam = 'a', at = 'start' }}]\nanalysis.static = {{}}\n"
            );
            let scene = parse("scene", &text).expect("a scene");
            let samples = |curvatures: [f64; 2]| {
                curvatures.map(|curvature| ProbeSample { curvature, ..ProbeSample::default() }).to_vec()
            };
            let name = || "p".to_owned();
            let run = Trajectory {
                probes: vec![ProbeSeries { name: name(), samples: samples([0.0, -4.0]) }],
                ..Trajectory::default()
            };
            let difference = Difference {
                probes: vec![ProbeErrors { name: name(), samples: samples([7.0, 7.0]) }],
                records: vec![7.0; 2],
                ..Difference::default()
            };
            bent(scene.model(), &run, &difference)
        };
        let found = of("rpim.nodes = 25").expect("something is missed");
        let [still, bent] = [0, 1].map(|record| found.probes[0].samples[record].curvature);
        assert!(still == 0.0 && (bent - 2.0 * 2.16e-3).abs() < 2e-5, "{bent}");
        assert!(of("ancf.elements = 24").is_none());
    }
}
