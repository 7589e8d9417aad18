//! Where the model itself errs: what a beam without shear, of small strains, does not describe.
//! No finer mesh mends that.

use crate::model::Model;
use crate::results::Trajectory;

/// Strain beyond which a linear law of small strains is not to be trusted.
const STRAIN: f64 = 0.03;
/// Thickness times curvature beyond which sections are no longer thin against the radius.
const BENDING: f64 = 0.3;
/// Part of the deflection by shear beyond which it is worth a word.
const SHEAR: f64 = 0.01;
/// E/(k G) of a rectangular section, k = 5/6, of a material with Poisson's ratio 0.3.
const SHEAR_COMPLIANCE: f64 = 3.12;

/// What there is to say of each beam. `largest` is, per beam, the largest strain and curvature
/// \[1/m\] of all records, where they are known, `lengths` are the beams' lengths \[m\].
pub(super) fn notes(model: &Model, lengths: &[f64], largest: &[[f64; 2]]) -> Vec<String> {
    let mut notes = Vec::new();
    for ((beam, length), [strain, curvature]) in model.beams.iter().zip(lengths).zip(largest) {
        let name = &beam.name;
        if *strain > STRAIN {
            notes.push(format!(
                "beam `{name}` strains by up to {strain:.2}; the linear law between strain and force is one of small strains, so that \
                 the model may err by as much"
            ));
        }
        let section = &beam.section;
        let (Some(stretch), Some(bend)) = (&section.axial_stiffness, &section.bending_stiffness) else {
            continue;
        };
        let (stretch, bend) = (stretch.mean(*length), bend.mean(*length));
        // Of a rectangle: EI/EA = h²/12.
        let radius = (bend / stretch).sqrt();
        let middle = 0.5 * length;
        let thickness =
            section.faces(middle, middle).map_or(12.0_f64.sqrt() * radius, |[low, high]| high - low);
        if thickness * curvature > BENDING {
            notes.push(format!(
                "beam `{name}` bends to a radius of {:.1} of its thickness, as its stiffnesses tell it; a beam is thin against its radius",
                (thickness * curvature).recip()
            ));
        }
        // Of a cantilever under a force at its tip: 3 EI/(k G A L²) of the deflection.
        let shear = 3.0 * SHEAR_COMPLIANCE * (radius / length).powi(2);
        if shear > SHEAR {
            notes.push(format!(
                "beam `{name}` is {:.0} times as long as thick, as its stiffnesses tell it; shear, which the model leaves out, would make about \
                 {:.0} % of its deflection",
                length / thickness,
                100.0 * shear
            ));
        }
    }
    notes
}

/// Per beam the largest strain and curvature that the given probes saw.
pub(super) fn largest<'t>(
    of_beams: impl Iterator<Item = &'t [crate::results::ProbeSeries]>,
    t: &Trajectory,
) -> Vec<[f64; 2]> {
    of_beams
        .enumerate()
        .map(|(beam, stations)| {
            let samples = stations.iter().flat_map(|station| &station.samples);
            let seen = samples.fold([0.0_f64; 2], |[strain, curvature], sample| {
                [strain.max(sample.strain.abs()), curvature.max(sample.curvature.abs())]
            });
            t.last.get(beam).map_or(seen, |shape| {
                let most = |values: &[f64], start: f64| values.iter().fold(start, |m, v| m.max(v.abs()));
                [most(&shape.strain, seen[0]), most(&shape.curvature, seen[1])]
            })
        })
        .collect()
}
