//! Where the model itself errs: what a beam without shear, of small strains, does not describe.
//! No finer mesh mends that.

use crate::model::{Model, Probe};
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
        if *strain > STRAIN && beam.section.axial_stiffness.is_some() {
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

/// What there is to say of probes where what acts in a point makes strains jump, which shape functions do not: `jumps` tells of
/// each whether it is there.
pub(super) fn at_jumps(model: &Model, jumps: impl Fn(&Probe) -> bool) -> Option<String> {
    let names: Vec<String> =
        model.probes.iter().filter(|probe| jumps(probe)).map(|probe| format!("`{}`", probe.name)).collect();
    let (s, sees) = if names.len() == 1 { ("", "sees") } else { ("s", "see") };
    (!names.is_empty()).then(|| {
        format!(
            "the strain, the curvature or a string's direction jumps where probe{s} {} {sees} it: it is that of one side, or between both, and its \
             error is the distance to the other; a probe more than a cell away tells each",
            names.join(", ")
        )
    })
}

/// The largest strain and curvature of each of so many beams, at the stations of all records and in
/// the last shape.
pub(super) fn largest(beams: usize, t: &Trajectory) -> Vec<[f64; 2]> {
    let most = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let of = |beam: usize| {
        // Where the first record is that before any load, it is the shape in which the scene begins, whatever that strains.
        let before = t.parameter.iter().take_while(|at| **at == 0.0).count();
        let shapes = t.stations.iter().skip(before).chain([&t.last]).filter_map(|beams| beams.get(beam));
        shapes.fold([0.0_f64; 2], |[strain, curvature], shape| {
            [strain.max(most(&shape.strain)), curvature.max(most(&shape.curvature))]
        })
    };
    (0..beams).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Shape;
    use crate::scene::parse;

    /// A beam whose stiffnesses are those of a rectangle of 0.6 m, or of 0.1 m where its section is
    /// given, and a string.
    fn model(section: &str) -> Model {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [6, 0], {section} }}\n\
             beam.rope = {{ start = [0, 1], end = [1, 1], axial_stiffness = 1 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}, \
             {{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'rope', at = 'end', fix = ['x', 'y'] }}]\n\
             analysis.static = {{}}\n"
        );
        parse("scene", &text).unwrap().model().clone()
    }

    #[test]
    fn what_the_model_leaves_out_is_told_where_it_is_large() {
        let stiff = model("axial_stiffness = 100, bending_stiffness = 3");
        let of = |model: &Model, lengths: [f64; 2], largest: [[f64; 2]; 2]| notes(model, &lengths, &largest);
        // h² = 12·3/100; the note comes with curvatures beyond 0.3/0.6 m, and with lengths below
        // (3·3.12/0.01·0.03)^½ = 5.3 m.
        assert_eq!(of(&stiff, [6.0, 1.0], [[0.03, 0.4999], [0.0, 1e9]]), [""; 0]);
        let found = of(&stiff, [6.0, 1.0], [[0.04, 0.6], [0.25, 1e9]]);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(found[0].starts_with("beam `arm` strains by up to 0.04;"), "{found:?}");
        assert!(found[1].starts_with("beam `arm` bends to a radius of 2.8 of its thickness,"), "{found:?}");
        assert!(found[2].starts_with("beam `rope` strains by up to 0.25;"), "{found:?}");
        assert_eq!(of(&stiff, [5.31, 1.0], [[0.0; 2]; 2]), [""; 0]);
        let found = of(&stiff, [3.0, 1.0], [[0.0; 2]; 2]);
        // 3·3.12·0.03/3² of the deflection.
        assert!(found[0].starts_with("beam `arm` is 5 times as long as thick,"), "{found:?}");
        assert!(found[0].ends_with("would make about 3 % of its deflection"), "{found:?}");
        // A section of 0.1 m height is as thick as it says.
        let thin = model("section.rectangle = { width = 0.1, height = 0.1 }, youngs_modulus = 1e9");
        assert_eq!(of(&thin, [6.0, 1.0], [[0.0, 2.99], [0.0; 2]]), [""; 0]);
        assert_eq!(of(&thin, [6.0, 1.0], [[0.0, 3.01], [0.0; 2]]).len(), 1);
    }

    #[test]
    fn probes_where_strains_jump_are_named() {
        let text = "beam.arm = { start = [0, 0], end = [6, 0], axial_stiffness = 1, bending_stiffness = 1 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                    probe = [{ name = 'a', beam = 'arm', at = 1.0 }, { name = 'b', beam = 'arm', at = 2.0 }]\nanalysis.static = {}\n";
        let scene = parse("scene", text).unwrap();
        let of =
            |jumps: &[f64]| at_jumps(scene.model(), |probe| jumps.contains(&probe.at.s)).unwrap_or_default();
        assert!(of(&[2.0]).contains("where probe `b` sees it: it is that of one side, or between both"));
        assert!(of(&[1.0, 2.0]).contains("where probes `a`, `b` see it"));
        assert_eq!(of(&[]), "");
    }

    /// Of all records of the stations of a beam, and of all places of the last.
    #[test]
    fn the_largest_strain_and_curvature_are_those_of_all_that_was_seen() {
        let shape = |strain: &[f64], curvature: &[f64]| Shape {
            strain: strain.into(),
            curvature: curvature.into(),
            ..Shape::default()
        };
        let stations = vec![
            vec![shape(&[0.1, 0.2], &[0.0, -3.0]), shape(&[0.0], &[5.0])],
            vec![shape(&[-0.4, 0.0], &[1.0, 2.0])],
        ];
        let last = vec![shape(&[0.0, -0.5], &[2.0, -1.0])];
        let run = |parameter: &[f64]| Trajectory {
            parameter: parameter.into(),
            stations: stations.clone(),
            last: last.clone(),
            ..Trajectory::default()
        };
        assert_eq!(largest(2, &run(&[0.5, 1.0])), [[0.5, 3.0], [0.0, 5.0]]);
        assert_eq!(largest(2, &run(&[0.0, 1.0])), [[0.5, 2.0], [0.0, 0.0]], "the beginning is no result");
    }
}
