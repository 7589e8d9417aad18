//! Accuracies that cannot be had end with what was reached, and why.

use super::{cantilever, error, estimate, last, run, scene};
use ancf::results::AnalysisKind;
use ancf::run::{Control, Progress};
use ancf::{Options, accuracy};

/// No mesh of its own to refine.
#[test]
fn a_basis_that_is_named_cannot_be_refined() {
    let rest =
        "effect.force = [{ beam = 'arm', at = 'end', value = [0, 5] }]\nanalysis.static.accuracy = 1e-9";
    let text =
        cantilever(1e4, 1.0, rest).replace("mass_per_length", "basis.ancf.elements = 6, mass_per_length");
    let results = run(&scene(&text));
    assert!(!error(&results).met && error(&results).estimated.result > 1e-9);
    let missed = error(&results).missed(AnalysisKind::Static).expect("a message");
    assert!(missed.contains("1e-9") && missed.contains("names the basis"), "{missed}");
}

/// Beyond round-off nothing converges.
#[test]
fn round_off_is_an_end() {
    let rest =
        "effect.force = [{ beam = 'arm', at = 'end', value = [0, 5] }]\nanalysis.static.accuracy = 1e-15";
    let results = run(&scene(&cantilever(1e9, 1.0, rest)));
    assert!(!error(&results).met, "{:?}", error(&results).estimated);
    let missed = error(&results).missed(AnalysisKind::Static).expect("a message");
    assert!(missed.contains("1e-15"), "{missed}");
}

/// A model that is wrong is refused at once, not after rounds of finer meshes.
#[test]
fn accuracies_of_one_and_more_are_no_accuracies() {
    for (accuracy, said) in [
        ("1.0", "smaller than 1"),
        ("0.0", "positive"),
        ("{ positions = 1e-3 }", "positions"),
        ("'x'", "expected"),
    ] {
        let text = cantilever(1e4, 1.0, &format!("analysis.static.accuracy = {accuracy}"));
        let error = ancf::scene::parse("scene.toml", &text).expect_err(accuracy).to_string();
        assert!(error.contains(said), "{accuracy}: {error}");
    }
}

/// What a beam without shear and of small strains does not describe is said.
#[test]
fn errors_of_the_model_are_noted() {
    let note = |stretch: f64, bend: f64, moment: f64| {
        let rest = format!(
            "effect.moment = [{{ beam = 'arm', at = 'end', value = {moment:e} }}]\nanalysis.static = {{}}"
        );
        error(&run(&scene(&cantilever(stretch, bend, &rest)))).notes.join("; ")
    };
    // A rectangle of the thickness h = 0.01: EI = EA h²/12.
    assert_eq!(note(1e6, 1e6 * 1e-4 / 12.0, 1.0), "");
    assert!(note(1e6, 1e6 * 0.3 * 0.3 / 12.0, 1.0).contains("shear"));
    assert!(note(1e6, 1e6 * 0.05 * 0.05 / 12.0, 1e6 * 0.05 * 0.05 / 12.0 * 7.0).contains("radius"));
}

/// A search that is stopped leaves what was computed, and claims nothing of it.
#[test]
fn an_interrupted_search_claims_nothing() {
    let rest =
        "effect.gravity.acceleration = [0, -9.81]\nanalysis.dynamic = { duration = 2.0, accuracy = 1e-4 }";
    let scene = scene(&cantilever(1e4, 1.0, rest));
    let observer = &mut |now: &Progress| if now.parameter > 0.5 { Control::Stop } else { Control::Continue };
    let options = Options { observer: Some(observer), ..Options::default() };
    let results = accuracy::run(&scene, options).expect("a part");
    assert!(!results.run().complete);
    assert!(!error(&results).met && error(&results).estimated.result.is_infinite());
    let missed = error(&results).missed(AnalysisKind::Dynamic).expect("a message");
    assert!(missed.contains("nothing is known") && missed.contains("interrupted"), "{missed}");
}

/// Two motions with the same steps tell nothing of the errors of these.
#[test]
fn steps_that_do_not_follow_the_tolerance_are_not_judged() {
    let rest = "effect.gravity.acceleration = [0, -9.81]\n\
                analysis.dynamic = { duration = 0.02, output_every = 0.001, radau.tolerance = 1e-2 }";
    let text =
        cantilever(1e2, 1.0, rest).replace("mass_per_length", "basis.ancf.elements = 4, mass_per_length");
    let scene = scene(&text);
    let results = estimate(&scene);
    assert!(error(&results).estimated.result.is_infinite());
    assert!(error(&results).reason.as_ref().is_some_and(|reason| reason.contains("hardly fewer steps")));
}

/// How much of a cell a contact takes decides about its error, by chance: a few meshes in succession that err alike are no reason to give up. Both
/// scenes are met, as finer even meshes confirm.
#[test]
fn contacts_are_not_given_up_early() {
    let beam = "probe = [{ name = 'p', beam = 'b', at = 0.4 }]\n";
    let pressed = "beam.b = { start = [0, 0], end = [1, 0], axial_stiffness = 7811.0, bending_stiffness = 1.0 }\n\
         support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
         effect.distributed_force = [{ beam = 'b', value = [0, 2.356] }]\n\
         effect.contact = [{ beam = 'b', box = { center = [0.7004, 0.1749], size = [0.1264, 0.06661], angle = 0.4104 }, \
         stiffness = 77260.0, half_thickness = 0.02955 }]\n";
    let arch = "beam.b = { arc = { center = [0, 0.6402], radius = 0.6402, from = -1.5707963267948966, to = -0.008796326794896503 }, \
         section.layers = [{ youngs_modulus = 34510.0, width = 1.0, height = 0.03469 }, \
         { youngs_modulus = 12770.0, width = 1.0, height = 0.01653 }] }\n\
         support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'b', at = 'end', fix = ['x', 'y'] }]\n\
         effect.distributed_force = [{ beam = 'b', value = [0, 14.7] }]\n\
         effect.contact = [{ beam = 'b', box = { center = [0.3389, 0.2746], size = [0.0506, 0.1153], angle = -0.1189 }, \
         stiffness = 20990.0, from = 0.3761, to = 0.9367 }, \
         { beam = 'b', circle = { center = [0.3828, 0.3773], radius = 0.1211 }, stiffness = 5832.0 }]\n";
    let cases = [
        (pressed, "accuracy = { position = 7e-4, curvature = 4e-4, section_force = 1e-3 }", 7e-4),
        (arch, "accuracy = 7e-7", 7e-7),
    ];
    for (text, accuracy, wanted) in cases {
        let results = run(&scene(&format!("{text}{beam}analysis.static.{accuracy}\n")));
        assert!(error(&results).met, "{:?}", error(&results));
        let fine = text.replace("beam.b = {", "beam.b = { basis.ancf.elements = 600,");
        let fine = scene(&format!("{fine}{beam}analysis.static = {{}}\n"));
        let fine = fine.model().solve(fine.analysis()).unwrap_or_else(|error| panic!("{error}"));
        let [p, q] = [last(&results), last(&fine)];
        let off = (p.x - q.x).hypot(p.y - q.y);
        assert!(off < wanted, "{off:.1e} apart");
    }
}
