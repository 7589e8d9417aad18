//! Soft vibrations of stiff beams on fine meshes, whose stiffness matrix is all round-off beside what resists them.

use ancf::results::{Results, Vibrations};
use ancf::scene::parse;
use std::f64::consts::TAU;

/// A bar of 1 m and 1 kg with EI = 1e6 N m², whose first bending vibration, free or on a hinge, is above 2 kHz.
fn vibrations(stiffness: &str, elements: usize, rest: &str) -> Vibrations {
    let text = format!(
        "beam.b = {{ start = [0, 0], end = [1, 0], {stiffness}, bending_stiffness = 1e6, mass_per_length = 1, basis.ancf.elements = {elements} }}\n{rest}\n"
    );
    let scene = parse("bar.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    match scene.model().solve(scene.analysis()) {
        Ok(Results::Vibrations(vibrations)) => vibrations,
        other => panic!("{other:?}\n{text}"),
    }
}

const HINGE: &str = "support = [{ beam = 'b', at = 'start', fix = ['x', 'y'] }]\n";

/// A rigid bar on its end: ω² = 3 k for a torsional spring, 3 k for a spring across its tip, 3/2 g for a weight; and on a bed, k.
/// The bar bends, by k/EI of that.
#[test]
fn what_turns_a_stiff_bar_softly_is_no_motion_that_nothing_resists() {
    let cases = [
        (
            3.0,
            format!(
                "{HINGE}effect.torsion_spring = [{{ beam = 'b', at = 'start', stiffness = 1 }}]\nanalysis.modal.count = 2"
            ),
        ),
        (
            0.03,
            format!(
                "{HINGE}effect.torsion_spring = [{{ beam = 'b', at = 'start', stiffness = 0.01 }}]\nanalysis.modal.count = 2"
            ),
        ),
        (
            3.0,
            format!(
                "{HINGE}effect.spring = [{{ beam = 'b', at = 'end', anchor = [1, 1], stiffness = 1 }}]\nanalysis.modal.count = 2"
            ),
        ),
        (
            1.5 * 9.81,
            format!(
                "{HINGE}effect.gravity.acceleration = [9.81, 0]\nanalysis.modal = {{ count = 2, about = 'equilibrium' }}"
            ),
        ),
        (
            1.0,
            "effect.foundation = [{ beam = 'b', stiffness = [1, 1] }]\nanalysis.modal.count = 3".to_owned(),
        ),
    ];
    for (square, rest) in cases as [(f64, String); 5] {
        // A weight that bends a beam of 1000 elements not at all may fold it, which is told.
        let finest = if rest.contains("gravity") {
            ("axial_stiffness = 1e10", 100)
        } else {
            ("axial_stiffness = 1e8", 1000)
        };
        for (stiffness, elements) in [("axial_stiffness = 1e10", 300), finest, ("axial_stiffness = 1e10", 30)]
        {
            let found = vibrations(stiffness, elements, &rest);
            let (frequency, expected) = (found.modes[0].frequency, square.sqrt() / TAU);
            let off = (frequency / expected - 1.0).abs();
            assert!(
                off < 1e-5 + found.modes[0].round_off,
                "{stiffness}, {elements}: {frequency} Hz for {expected}\n{rest}"
            );
            assert!(found.modes[0].round_off < 1e-2, "{stiffness}, {elements}: {}", found.modes[0].round_off);
        }
    }
}

/// What nothing resists has no frequency on any mesh.
#[test]
fn free_bars_have_three_motions_without_frequency() {
    // cosh βL cos βL = 1.
    let first = 4.730_040_744_862_704_f64.powi(2) * 1e3 / TAU;
    for elements in [10, 100, 300] {
        let found = vibrations("axial_stiffness = 1e10", elements, "analysis.modal.count = 4");
        let frequencies = found.frequencies();
        assert_eq!(frequencies[..3], [0.0; 3], "{elements}");
        assert!((frequencies[3] / first - 1.0).abs() < 1e-4, "{elements}: {} for {first}", frequencies[3]);
    }
}
