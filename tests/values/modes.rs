//! Vibrations and critical loads: the state about which they are, how their shapes are drawn, and
//! how far the linear solution before buckling is trusted.

use super::near;
use ancf::scene::parse;
use ancf::trajectory::{AnalysisKind, Shape, Trajectory};

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Largest distance between the rows of two states.
fn apart(mode: &[Shape], rest: &[Shape]) -> f64 {
    let of = |(mode, rest): (&Shape, &Shape)| -> f64 {
        assert_eq!((mode.s.len(), &mode.beam), (201, &rest.beam));
        (0..201).map(|i| (mode.x[i] - rest.x[i]).hypot(mode.y[i] - rest.y[i])).fold(0.0, f64::max)
    };
    mode.iter().zip(rest).map(of).fold(0.0, f64::max)
}

/// A beam of 2 m that bends and one of 1 m that stretches more easily: whichever moves, at its most
/// by a tenth of the longest beam.
#[test]
fn modes_are_drawn_with_a_tenth_of_the_longest_beam() {
    let found = solved(
        "beam.a = { start = [1, 0], end = [3, 0], axial_stiffness = 1e6, bending_stiffness = 3, mass_per_length = 0.5, basis.ancf.elements = 24 }
        beam.b = { start = [1, 5], end = [1.6, 5.8], axial_stiffness = 1, bending_stiffness = 1e4, mass_per_length = 0.5, basis.ancf.elements = 4 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y'] }, { beam = 'a', at = 'end', fix = ['y'] }, \
        { beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]
        analysis.modal.count = 3\n",
    );
    assert_eq!(found.modes.len(), 3);
    for (mode, moves) in found.modes.iter().zip([1, 0, 1]) {
        near(apart(mode, &found.undeformed), 0.2, 1e-3, "the largest displacement");
        near(
            apart(&mode[1 - moves..2 - moves], &found.undeformed[1 - moves..2 - moves]),
            0.0,
            1e-9,
            "at rest",
        );
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
        let found = solved(&format!("{arm}{load}analysis.modal = {{ count = 2, about = '{about}' }}\n"));
        let told =
            found.settings.iter().find(|(name, _)| name == "vibrations about").expect("a line").1.clone();
        assert_eq!((found.analysis, found.frequencies.len(), found.modes.len()), (AnalysisKind::Modal, 2, 2));
        assert!(found.complete && found.statistics.factorizations > 0);
        (found, told)
    };
    let (free, told) = about("reference", "");
    assert_eq!((told.as_str(), free.warnings.len(), free.parameter.len()), ("the stress-free state", 0, 0));
    assert_eq!(free.last[0].axial_force, vec![0.0; 201]);
    let (unloaded, told) = about("reference", load);
    assert_eq!(told, "the stress-free state");
    assert_eq!(unloaded.frequencies, free.frequencies);
    let [warning] = &unloaded.warnings[..] else { panic!("{:?}", unloaded.warnings) };
    assert!(
        warning.starts_with("loads take no part in vibrations about the stress-free state:"),
        "{warning}"
    );
    let (loaded, told) = about("equilibrium", load);
    assert_eq!((told.as_str(), loaded.warnings.len()), ("the equilibrium under all loads", 0));
    assert!(loaded.statistics.factorizations > unloaded.statistics.factorizations);
    assert_eq!((&loaded.parameter[..], loaded.probes[0].samples.len()), (&[1.0][..], 1));
    assert_eq!((loaded.energy.len(), loaded.frames.len()), (1, 1));
    let still = solved(&format!("{arm}{load}analysis.static = {{}}\n"));
    let (here, there) =
        (loaded.probes[0].samples[0], still.probes[0].samples.last().expect("an equilibrium"));
    near(here.x, there.x, 1e-9, "x");
    near(here.y, there.y, 1e-9, "y");
    // The modes are added to the loaded state, and pressed beams vibrate more slowly.
    assert!(here.y > 0.3 && loaded.frequencies[0] < 0.9 * free.frequencies[0], "{:?}", loaded.frequencies);
    near(apart(&loaded.modes[0], &loaded.last), 0.2, 2e-3, "the largest displacement");
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
            assert_eq!(found.warnings, Vec::<String>::new());
            continue;
        };
        let load = found.load_factors[number - 1];
        let which =
            if number == 1 { "" } else { "critical loads from number 2 on are beyond the linear solution: " };
        let what = if across == 0.0 {
            format!("the loads strain the beam by {:.2} before", load / axial_stiffness)
        } else {
            format!("the loads turn the beam by {:.2} rad before", 0.5 * across * load)
        };
        let expected = format!("{which}{what} it buckles at load factor {load:.6}, by the linear solution");
        let [warning] = &found.warnings[..] else { panic!("{:?}", found.warnings) };
        assert!(warning.starts_with(&expected), "{expected}: {warning}");
    }
}
