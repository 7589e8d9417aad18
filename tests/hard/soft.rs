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

fn outcome(text: &str) -> Result<Vibrations, String> {
    let scene = parse("bar.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    match scene.model().solve(scene.analysis()) {
        Ok(Results::Vibrations(vibrations)) => Ok(vibrations),
        Ok(other) => panic!("{other:?}"),
        Err(error) => Err(error.to_string()),
    }
}

/// Where round-off hides all that a spring or a bed resists with, that is no motion that nothing resists.
#[test]
fn a_vibration_that_round_off_hides_is_refused() {
    let bar = |resists: &str| {
        format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e16, bending_stiffness = 1e12, mass_per_length = 1, \
             basis.ancf.elements = 40 }}\n{HINGE}{resists}\nanalysis.modal.count = 2"
        )
    };
    for resists in [
        "effect.torsion_spring = [{ beam = 'b', at = 'start', stiffness = 1 }]",
        "effect.spring = [{ beam = 'b', at = 'end', stiffness = 1 }]",
        "effect.foundation = [{ beam = 'b', stiffness = [1, 1] }]",
    ] {
        let error = outcome(&bar(resists)).expect_err(resists);
        assert!(error.contains("frequency 1 cannot be told from zero"), "{resists}: {error}");
    }
    // What nothing resists has no frequency, however stiff the bar is.
    let free = outcome(&bar("")).expect("vibrations");
    assert_eq!((free.modes[0].frequency, free.modes[0].round_off), (0.0, 0.0));
}

/// Of a weight nobody knows whether it resists; that round-off may hide it is said, and part of the error.
#[test]
fn a_weight_that_round_off_hides_is_told() {
    let bar = format!(
        "beam.b = {{ start = [0, 0], end = [0, -1], axial_stiffness = 1e16, bending_stiffness = 1e12, mass_per_length = 1, \
         basis.ancf.elements = 40 }}\n{HINGE}effect.gravity.acceleration = [0, -9.81]\n\
         analysis.modal = {{ count = 2, about = 'equilibrium' }}"
    );
    let hidden = outcome(&bar).expect("vibrations");
    assert_eq!((hidden.modes[0].frequency, hidden.modes[0].round_off), (0.0, 1.0));
    assert!(
        hidden.equilibrium.run.warnings.iter().any(|text| text.contains("may change frequency 1 by 100"))
    );
}

/// Springs resist along themselves alone: what a bar on two of them does along itself, nothing resists. ω² = 2 k/m and, with
/// springs 0.6 m apart, 2 k (0.3 m)²/(m L²/12).
#[test]
fn what_springs_do_not_resist_is_free() {
    let text = "beam.b = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e5, mass_per_length = 1, \
                basis.ancf.elements = 8 }\n\
                effect.spring = [{ beam = 'b', at = 0.2, stiffness = 50, anchor = [0.2, -1] }, \
                { beam = 'b', at = 0.8, stiffness = 50, anchor = [0.8, -1] }]\nanalysis.modal.count = 3\n";
    let found = outcome(text).expect("vibrations").frequencies();
    let expected = [0.0, 100.0_f64.sqrt() / TAU, 108.0_f64.sqrt() / TAU];
    assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-3), "{found:?}");
    // A bed across a bar leaves it free along itself, and one along it free across.
    for (bed, free) in [("[0, 1]", 1), ("[1, 0]", 2)] {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e3, mass_per_length = 1, \
             basis.ancf.elements = 8 }}\neffect.foundation = [{{ beam = 'b', stiffness = {bed} }}]\nanalysis.modal.count = 3\n"
        );
        let found = outcome(&text).expect("vibrations").frequencies();
        assert_eq!(found.iter().filter(|frequency| **frequency == 0.0).count(), free, "{bed}: {found:?}");
    }
}

/// A stiff bar that hangs in its equilibrium stays there, though the entries of its tangent have lost what its weight resists with.
#[test]
fn a_stiff_bar_hangs_still() {
    let text = format!(
        "beam.b = {{ start = [0, 0], end = [0, -1], axial_stiffness = 1e8, bending_stiffness = 1e6, mass_per_length = 1, \
         basis.ancf.elements = 1000 }}\n{HINGE}effect.gravity.acceleration = [0, -9.81]\n\
         probe = [{{ name = 'p', beam = 'b', at = 'end' }}]\nanalysis.static = {{}}\n"
    );
    let scene = parse("bar.toml", &text).expect("a scene");
    let results = scene.model().solve(scene.analysis()).expect("an equilibrium").into_states();
    let tip = results.probes[0].samples.last().expect("a state");
    // By m g L/(2 EA) it is longer.
    assert!((tip.y + 1.0 + 0.5 * 9.81 / 1e8).abs() < 1e-10 && tip.x.abs() < 1e-9, "{tip:?}");
    assert_eq!(results.run.warnings, [""; 0]);
}
