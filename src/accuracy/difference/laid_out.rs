//! By how much meshfree shape functions miss the curves along which beams are laid out.
//!
//! Where nothing acts a beam keeps the shape that its nodes give it, between which it differs from its centreline by the error of
//! the interpolation. Of cable elements half as long it is a sixteenth, so that two meshes tell it; of radial functions on
//! uneven nodes it falls as it may. The curve itself is known.

use super::{Difference, larger};
use crate::basis::{Basis, Cell};
use crate::centreline::Curve;
use crate::model::{Discretization, Model};

/// Distances below this part of a beam's length are round-off.
const ROUND_OFF: f64 = 1e-14;

/// What meshfree beams are off their stress-free curves, at the places and in the records of another `difference`; `None` where
/// that is nothing.
pub(in crate::accuracy) fn laid_out(model: &Model, difference: &Difference) -> Option<Difference> {
    let mut sum = difference.none();
    for (index, beam) in model.beams.iter().enumerate() {
        let (Discretization::Rpim { .. }, Ok(curve)) = (&beam.discretization, Curve::new(&beam.centreline))
        else {
            continue;
        };
        let Ok(basis) = Basis::broken(&beam.discretization, curve.length(), &model.breaks(index)) else {
            continue;
        };
        let off = |places: &[f64]| off(&basis, &curve, places).unwrap_or_default();
        if let Some(along) = sum.beams.get_mut(index) {
            for (error, off) in along.position.iter_mut().zip(off(&along.s)) {
                *error = larger(*error, off / curve.length());
                sum.errors.result = larger(sum.errors.result, *error);
            }
        }
        for (probe, errors) in
            model.probes.iter().zip(&mut sum.probes).filter(|(probe, _)| probe.at.beam == index)
        {
            let off = off(&[probe.at.s]).first().copied().unwrap_or(0.0);
            sum.errors.result = larger(sum.errors.result, off / curve.length());
            errors.samples.iter_mut().for_each(|sample| (sample.x, sample.y) = (off, off));
        }
    }
    let result = sum.errors.result;
    sum.records.fill(result);
    (result > ROUND_OFF).then_some(sum)
}

/// The distances \[m\] at `places` from a curve of what shape functions make of its positions and tangents at their nodes.
fn off(basis: &Basis, curve: &Curve, places: &[f64]) -> Option<Vec<f64>> {
    let at_nodes = basis.nodes().iter().flat_map(|s| [curve.position(*s), curve.tangent(*s)]);
    let q: Vec<[f64; 2]> = at_nodes.collect();
    let table = basis.points(places, &[0]).ok()?;
    let of = |(cell, s): (&Cell, &f64)| {
        let (_, row) = table.block(*cell);
        let values = &q[cell.first as usize..];
        let [x, y] = [0, 1].map(|axis| row.iter().zip(values).map(|(n, q)| n * q[axis]).sum::<f64>());
        let [exact_x, exact_y] = curve.position(*s);
        (x - exact_x).hypot(y - exact_y)
    };
    Some(table.cells.iter().zip(places).map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{BeamErrors, ProbeErrors, ProbeSample};
    use crate::scene;

    /// A quarter circle on few uneven nodes: what a probe and a place between nodes are off the circle, and nothing at nodes, nor of
    /// a straight beam.
    #[test]
    fn meshfree_beams_are_off_their_curves_between_nodes() {
        let of = |centreline: &str| {
            let text = format!(
                "beam.a = {{ {centreline}, axial_stiffness = 1e4, bending_stiffness = 1, basis.rpim.nodes = [0, 0.3, 0.8, 1] }}\n\
                 support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 probe = [{{ name = 'p', beam = 'a', at = 0.55 }}]\nanalysis.static = {{}}\n"
            );
            let scene = scene::parse("arc.toml", &text).expect("a scene");
            let along = BeamErrors {
                beam: "a".into(),
                s: vec![0.3, 0.55],
                position: vec![7.0; 2],
                curvature: vec![7.0; 2],
            };
            let probe = ProbeErrors {
                name: "p".into(),
                samples: vec![ProbeSample { x: 7.0, ..ProbeSample::default() }; 2],
            };
            let difference = Difference {
                beams: vec![along],
                probes: vec![probe],
                records: vec![7.0; 2],
                ..Difference::default()
            };
            laid_out(scene.model(), &difference)
        };
        let found = of("arc = { center = [0, 0], radius = 0.6366197723675814, from = 0, to = '90 deg' }")
            .expect("a curve");
        let off = found.beams[0].position[1];
        assert!(off > 1e-6 && off < 1e-2 && found.beams[0].position[0] < 1e-12, "{:?}", found.beams);
        for sample in &found.probes[0].samples {
            assert!((sample.x - off).abs() < 1e-15 && sample.x == sample.y, "{sample:?}");
        }
        assert_eq!((found.errors.result, &found.records[..]), (off, &[off; 2][..]));
        assert!(of("start = [0, 0], end = [1, 0]").is_none());
    }
}
