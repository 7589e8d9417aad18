//! Folds: where a string or a beam turns by more than a right angle within a cell, by the angles of
//! the last shape.

use ancf::results::{Shape, Trajectory};
use ancf::scene::parse;

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// What is told of folds.
fn told(found: &Trajectory) -> Vec<&String> {
    found.run.warnings.iter().filter(|warning| warning.contains("right angle")).collect()
}

/// A string of three even cells that begins as an arc, its end brought nearer by `way`.
fn hanging(way: f64) -> Trajectory {
    solved(&format!(
        "beam.c = {{ arc = {{ center = [0, 0], radius = 1, from = '210 deg', to = '330 deg' }}, axial_stiffness = 1e4, \
         mass_per_length = 1, basis.ancf.elements = 3 }}
         support = [{{ beam = 'c', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'c', at = 'end', fix = ['x', 'y'], move = {{ x = {way} }} }}]
         effect.gravity.acceleration = [0, -9.81]
         analysis.static.steps = 20\n"
    ))
}

/// By how much the angles between two arc lengths differ \[degrees\].
fn turn(shape: &Shape, from: f64, to: f64) -> f64 {
    let inside = |s: f64| (from - 1e-9..to + 1e-9).contains(&s);
    let angles = || shape.s.iter().zip(&shape.angle).filter(|(s, _)| inside(**s)).map(|(_, angle)| *angle);
    let (low, high) = angles().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(a), h.max(a)));
    (high - low).to_degrees()
}

/// The first cell that turns by more than a right angle is told, and none that turns by less.
#[test]
fn a_string_that_turns_within_a_cell_is_told_where() {
    for (way, folded) in
        [(-0.4, None), (-0.55, Some("0.6981")), (-1.4, Some("0.6981")), (-1.65, Some("0.0000"))]
    {
        let found = hanging(way);
        let shape = &found.last[0];
        let length = shape.s[shape.s.len() - 1];
        let turns = [0.0, 1.0, 2.0].map(|k| turn(shape, k * length / 3.0, (k + 1.0) * length / 3.0));
        let first = turns.iter().position(|turn| *turn > 90.0);
        assert_eq!(first.map(|k| format!("{:.4}", k as f64 * length / 3.0)).as_deref(), folded, "{turns:?}");
        // So far from a right angle that the points beside a cell do not matter.
        assert!(turns.iter().all(|turn| (turn - 90.0).abs() > 0.2), "{turns:?}");
        match (folded, &told(&found)[..]) {
            (None, []) => {}
            (Some(s), [warning]) => {
                let begins =
                    format!("string `c` turns by more than a right angle within its cell from s = {s} m:");
                assert!(warning.starts_with(&begins), "{warning}");
                assert!(warning.contains("no equilibrium of a real string; begin from an arc"), "{warning}");
            }
            (_, told) => panic!("{way}: {told:?}"),
        }
    }
}

/// A beam almost without bending stiffness whose ends are brought together hangs from them in a
/// hairpin: it is a fold where a point and the next differ by more than a right angle, and bending
/// where they differ by less.
#[test]
fn a_beam_that_turns_from_one_point_to_the_next_is_told() {
    for (stiffness, folded) in [(1e-6, false), (1e-7, true)] {
        let found = solved(&format!(
            "beam.c = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = {stiffness:e}, mass_per_length = 1, \
             basis.ancf.elements = 100 }}
             support = [{{ beam = 'c', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'c', at = 'end', fix = ['x', 'y'], move = {{ x = -1 }} }}]
             effect.gravity.acceleration = [0, -100]
             analysis.static.steps = 1\n"
        ));
        let shape = &found.last[0];
        let largest = shape.angle.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert_eq!(largest.to_degrees() > 90.0, folded, "{largest} rad");
        // From the start to the end it turns by two right angles in either case.
        assert!(turn(shape, 0.0, 1.0) > 150.0);
        match &told(&found)[..] {
            [] => assert!(!folded),
            [warning] => {
                let begins = "beam `c` turns by more than a right angle within its cell from s = 0.4900 m:";
                assert!(folded && warning.starts_with(begins), "{warning}");
                assert!(warning.contains("no equilibrium of a real beam; reach the load"), "{warning}");
            }
            told => panic!("{told:?}"),
        }
    }
}

/// Two strings in one system: the one that is folded is told by its name.
#[test]
fn of_two_strings_the_folded_one_is_told() {
    let found = solved(
        "beam.taut = { start = [0, 1], end = [1, 1], axial_stiffness = 1e4, mass_per_length = 1, basis.ancf.elements = 2 }
        beam.slack = { arc = { center = [0, 0], radius = 1, from = '210 deg', to = '330 deg' }, axial_stiffness = 1e4, mass_per_length = 1, \
        basis.ancf.elements = 3 }
        support = [{ beam = 'taut', at = 'start', fix = ['x', 'y'] }, { beam = 'taut', at = 'end', fix = ['x', 'y'] }, \
        { beam = 'slack', at = 'start', fix = ['x', 'y'] }, { beam = 'slack', at = 'end', fix = ['x', 'y'], move = { x = -1 } }]
        effect.gravity.acceleration = [0, -9.81]
        analysis.static.steps = 20\n",
    );
    let [warning] = &told(&found)[..] else { panic!("{:?}", found.run.warnings) };
    assert!(warning.starts_with("string `slack` turns"), "{warning}");
}

/// A string passes no couple on: what asks it to is told, each with its place, and of the beam
/// beside it nothing.
#[test]
fn couples_on_strings_are_told_with_their_places() {
    let found = solved(
        "beam.rope = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 4 }
        beam.arm = { start = [1, 0], end = [2, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2 }
        joint = [{ type = 'weld', first = { beam = 'rope', at = 'end' }, second = { beam = 'arm', at = 'start' } }]
        support = [{ beam = 'arm', at = 'end', fix = ['x', 'y', 'angle'] }, { beam = 'rope', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.moment = [{ beam = 'arm', at = 0.5, value = 0.1 }, { beam = 'rope', at = 0.25, value = 0.1 }]
        analysis.dynamic = { duration = 1e-3, output_every = 1e-3 }\n",
    );
    let told: Vec<&String> =
        found.run.warnings.iter().filter(|warning| warning.contains("no couple")).collect();
    assert_eq!(told.len(), 3, "{:?}", found.run.warnings);
    for (warning, [what, place]) in told.iter().zip([
        ["support 2 holds its direction", "0.000000"],
        ["joint 1 welds it", "1.000000"],
        ["acts on it", "0.250000"],
    ]) {
        assert!(warning.starts_with("beam `rope` has no `bending_stiffness`, and "), "{warning}");
        assert!(warning.contains(&format!("{what} at s = {place} m: a string")), "{warning}");
    }
}
