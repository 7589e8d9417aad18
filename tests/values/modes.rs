//! Vibrations and critical loads: the state about which they are, how their shapes are scaled, and
//! how far the linear solution before buckling is trusted.

use super::near;
use ancf::results::{AnalysisKind, Results, Vibrations};
use ancf::scene::parse;
use std::f64::consts::PI;

fn solved(text: &str) -> Results {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn vibrations(text: &str) -> Vibrations {
    match solved(text) {
        Results::Vibrations(vibrations) => vibrations,
        other => panic!("{other:?}"),
    }
}

/// A pinned beam of 2 m vibrates as A sin(πs/L) with ρA A² L/2 = 1 kg m², one of 1 m that stretches
/// more easily, clamped at one end, as A sin(πs/2L) along itself. Would catch another scale, a turn
/// or a change of strain or curvature that is another's, and a mode of the other beam.
#[test]
fn modes_are_numbers_of_unit_mass() {
    let found = vibrations(
        "beam.a = { start = [1, 0], end = [3, 0], axial_stiffness = 1e6, bending_stiffness = 3, mass_per_length = 0.5, basis.ancf.elements = 24 }
        beam.b = { start = [1, 5], end = [1.6, 5.8], axial_stiffness = 1, bending_stiffness = 1e4, mass_per_length = 0.5, basis.ancf.elements = 16 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y'] }, { beam = 'a', at = 'end', fix = ['y'] }, \
        { beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]
        analysis.modal.count = 2\n",
    );
    let [along, across] = &found.modes[..] else { panic!("{:?}", found.frequencies()) };
    let (rest, stretched) = (&along.shape[0], &along.shape[1]);
    assert_eq!((rest.beam.as_str(), stretched.beam.as_str()), ("a", "b"));
    let sign = stretched.x[200].signum();
    for (i, s) in stretched.s.iter().enumerate() {
        let (sine, cosine) = (0.5 * PI * s).sin_cos();
        near(sign * stretched.x[i], 0.6 * 2.0 * sine, 1e-3, "x");
        near(sign * stretched.y[i], 0.8 * 2.0 * sine, 1e-3, "y");
        near(sign * stretched.strain[i], PI * cosine, 2e-2, "strain");
        near(stretched.angle[i].hypot(stretched.curvature[i]), 0.0, 1e-6, "no turn");
        near(rest.x[i].hypot(rest.y[i]), 0.0, 1e-9, "the other beam is at rest");
    }
    let (bent, rest) = (&across.shape[0], &across.shape[1]);
    let sign = bent.y[100].signum();
    for (i, s) in bent.s.iter().enumerate() {
        let ((sine, cosine), wave) = ((0.5 * PI * s).sin_cos(), 0.5 * PI);
        near(sign * bent.y[i], 2_f64.sqrt() * sine, 1e-4, "y");
        near(sign * bent.angle[i], 2_f64.sqrt() * wave * cosine, 1e-3, "angle");
        near(sign * bent.curvature[i], -2_f64.sqrt() * wave * wave * sine, 1e-2, "curvature");
        near(bent.x[i].hypot(bent.strain[i]), 0.0, 1e-6, "no stretch");
        near(rest.x[i].hypot(rest.y[i]), 0.0, 1e-9, "the other beam is at rest");
    }
    let last = bent.nodes[12];
    near(sign * last[1], 2_f64.sqrt(), 1e-4, "the middle node");
}

/// Of a pinned arc the rows of a mode are those that the state's own fields change by where the
/// mode is added to it in a small part.
#[test]
fn modes_of_curved_beams_change_angle_strain_and_curvature() {
    let arch = |load: f64| {
        format!(
            "beam.a = {{ arc = {{ center = [0, 0], radius = 2, from = '120 deg', to = '60 deg' }}, axial_stiffness = 1e3, bending_stiffness = 3, \
             mass_per_length = 0.5, strain = 'green', basis.ancf.elements = 8 }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'a', at = 'end', fix = ['x', 'y'] }}]
             effect.force = [{{ beam = 'a', at = 0.9, value = [0.3, {load:?}] }}]
             analysis.modal = {{ count = 2, about = 'equilibrium' }}\n"
        )
    };
    let found = vibrations(&arch(-1.0));
    let state = &found.equilibrium.last[0];
    for mode in &found.modes {
        let mode = &mode.shape[0];
        assert_eq!(mode.s, state.s);
        // Central differences over neighbouring places, of the tangent's turn and length.
        let even = |i: &usize| {
            let (before, after) = (state.s[*i] - state.s[i - 1], state.s[i + 1] - state.s[*i]);
            before > 0.0 && (after - before).abs() < 1e-9
        };
        for i in (1..mode.s.len() - 1).filter(even) {
            let step = state.s[i + 1] - state.s[i - 1];
            let slope = |values: &[f64]| (values[i + 1] - values[i - 1]) / step;
            let (rx, ry) = (slope(&state.x), slope(&state.y));
            let (ux, uy) = (slope(&mode.x), slope(&mode.y));
            near(mode.angle[i], (rx * uy - ry * ux) / (rx * rx + ry * ry), 2e-2, "angle");
            near(mode.strain[i], rx * ux + ry * uy, 2e-2, "strain");
        }
    }
}

/// Would catch the state of another load, records that are not those of the one equilibrium, and a
/// warning of loads where they take part.
#[test]
fn vibrations_are_about_the_state_that_was_asked_for() {
    let arm = "beam.a = { start = [1, 0], end = [3, 0], axial_stiffness = 1e3, bending_stiffness = 3, mass_per_length = 0.5, basis.ancf.elements = 4 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]
        probe = [{ name = 'end', beam = 'a', at = 'end' }]\n";
    let load = "effect.force = [{ beam = 'a', at = 'end', value = [-1, 0.5] }]\n";
    let about = |about: &str, load: &str| {
        let found = vibrations(&format!("{arm}{load}analysis.modal = {{ count = 2, about = '{about}' }}\n"));
        let run = &found.equilibrium.run;
        let told =
            run.settings.iter().find(|(name, _)| name == "vibrations about").expect("a line").1.clone();
        assert_eq!((run.analysis, found.modes.len()), (AnalysisKind::Modal, 2));
        assert!(run.complete && run.statistics.factorizations > 0);
        (found, told)
    };
    let (free, told) = about("reference", "");
    assert_eq!(
        (told.as_str(), free.equilibrium.run.warnings.len(), free.equilibrium.parameter.len()),
        ("the stress-free state", 0, 0)
    );
    assert_eq!(free.equilibrium.last[0].axial_force, vec![0.0; 201]);
    let (unloaded, told) = about("reference", load);
    assert_eq!(told, "the stress-free state");
    assert_eq!(unloaded.frequencies(), free.frequencies());
    let [warning] = &unloaded.equilibrium.run.warnings[..] else {
        panic!("{:?}", unloaded.equilibrium.run.warnings)
    };
    assert!(
        warning.starts_with("loads take no part in vibrations about the stress-free state:"),
        "{warning}"
    );
    let (loaded, told) = about("equilibrium", load);
    assert_eq!(
        (told.as_str(), loaded.equilibrium.run.warnings.len()),
        ("the equilibrium under all loads", 0)
    );
    assert!(
        loaded.equilibrium.run.statistics.factorizations > unloaded.equilibrium.run.statistics.factorizations
    );
    assert_eq!(
        (&loaded.equilibrium.parameter[..], loaded.equilibrium.probes[0].samples.len()),
        (&[1.0][..], 1)
    );
    assert_eq!((loaded.equilibrium.energy.len(), loaded.equilibrium.frames.len()), (1, 1));
    let still = solved(&format!("{arm}{load}analysis.static = {{}}\n")).into_states();
    let (here, there) =
        (loaded.equilibrium.probes[0].samples[0], still.probes[0].samples.last().expect("an equilibrium"));
    near(here.x, there.x, 1e-9, "x");
    near(here.y, there.y, 1e-9, "y");
    // Pressed beams vibrate more slowly.
    let [slower, faster] = [&loaded, &free].map(|found| found.frequencies()[0]);
    assert!(here.y > 0.3 && slower < 0.9 * faster, "{slower} {faster}");
}

/// The largest displacement of a buckling mode is 1 m: of a clamped column half a cosine.
#[test]
fn buckling_modes_reach_one_metre() {
    let found = solved(
        "beam.arm = { start = [0, 0], end = [0, 3], axial_stiffness = 1e6, bending_stiffness = 1, basis.ancf.elements = 16 }
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
         effect.force = [{ beam = 'arm', at = 'end', value = [0, -1] }]
         analysis.buckling.count = 1\n",
    );
    let Results::CriticalLoads(found) = found else { panic!("{found:?}") };
    let mode = &found.modes[0].shape[0];
    let sign = mode.x[200].signum();
    for (s, x) in mode.s.iter().zip(&mode.x) {
        near(sign * x, 1.0 - (PI * s / 6.0).cos(), 1e-3, "half a cosine");
    }
}

/// Before a column buckles its loads turn it by λ F L²/2EI and strain it by λ P/EA: critical loads
/// beyond a tenth of a radian and a twentieth of strain are told, the first of them by its number.
#[test]
fn critical_loads_that_linear_theory_does_not_reach_are_told() {
    let column = |axial_stiffness: f64, across: f64| {
        solved(&format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = {axial_stiffness:e}, bending_stiffness = 1, basis.ancf.elements = 8 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'arm', at = 'end', value = [-1, {across:?}] }}]
             analysis.buckling.count = 2\n"
        ))
    };
    for (axial_stiffness, across, number) in [
        (1e6, 0.0, None),
        (1e6, 0.02, Some(2)),
        (1e6, 0.2, Some(1)),
        (200.0, 0.0, Some(2)),
        (40.0, 0.0, Some(1)),
    ] {
        let found = column(axial_stiffness, across);
        let Some(number) = number else {
            assert_eq!(found.run().warnings, Vec::<String>::new());
            continue;
        };
        let load = found.eigenvalues()[number - 1];
        let which =
            if number == 1 { "" } else { "critical loads from number 2 on are beyond the linear solution: " };
        let what = if across == 0.0 {
            format!("the loads strain the beam by {:.2} before", load / axial_stiffness)
        } else {
            format!("the loads turn the beam by {:.2} rad before", 0.5 * across * load)
        };
        let expected = format!("{which}{what} it buckles at load factor {load:.6}, by the linear solution");
        let [warning] = &found.run().warnings[..] else { panic!("{:?}", found.run().warnings) };
        assert!(warning.starts_with(&expected), "{expected}: {warning}");
    }
}

/// A frequency below the round-off of the stiffness is refused, and never zero; one that loses digits
/// to it is told. Of a pinned beam ω₁ = π², whatever its axial stiffness.
#[test]
fn frequencies_that_round_off_hides_are_refused() {
    let scene = |stiffness: &str, elements: usize, hinges: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = {stiffness}, bending_stiffness = 1, mass_per_length = 1, \
             basis.ancf.elements = {elements} }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}{hinges}]\nanalysis.modal.count = 2\n"
        );
        let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        scene.model().solve(scene.analysis())
    };
    let far = ", { beam = 'arm', at = 'end', fix = ['y'] }";
    for (stiffness, allowed, told) in [("1e8", 1e-5, false), ("1e14", 1e-2, true)] {
        let found = match scene(stiffness, 100, far).unwrap() {
            Results::Vibrations(found) => found,
            other => panic!("{other:?}"),
        };
        near(found.frequencies()[0] * 2.0 / PI, 1.0, allowed, "the first frequency");
        let warnings = &found.equilibrium.run.warnings;
        assert_eq!(
            warnings.iter().any(|warning| warning.contains("may change frequency 1")),
            told,
            "{warnings:?}"
        );
    }
    for (hinges, expected) in [
        (far, "frequency 1 cannot be told from zero"),
        // It turns about its one hinge, without any frequency: that motion is not the one that is hidden.
        ("", "frequency 2 cannot be told from zero"),
    ] {
        let message = scene("1e16", 100, hinges).expect_err("hidden").to_string();
        assert!(message.contains(expected), "{message}");
    }
    let free = match scene("1e8", 20, "").unwrap() {
        Results::Vibrations(found) => found.frequencies(),
        other => panic!("{other:?}"),
    };
    assert_eq!(free[0], 0.0);
    // β L = 3.9266 of a hinged and free beam.
    near(free[1] * 2.0 * PI, 15.4182, 1e-3, "the second frequency");
}
