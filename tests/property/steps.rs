//! Steps of a path by themselves: how long they are, where they end, what lies between them, and
//! how an increment moves nodes.

use ancf::assembly::Needs;
use ancf::scene::parse;
use ancf::solve::equilibrium::Equilibrium;
use ancf::solve::newton::Settings;
use ancf::solve::path::{Parameter, Path, Point};
use ancf::solve::retraction::Retraction;
use ancf::solve::stability::Stability;
use ancf::system::System;

fn system(text: &str) -> System {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    System::build(scene.model(), Needs::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// A bar that its load stretches evenly to 1.1 times its length.
fn bar() -> System {
    system(
        "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 10, bending_stiffness = 1, basis.ancf.elements = 1 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [1, 0] }]
        analysis.static = {}\n",
    )
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, not {expected}");
}

/// Where nothing turns each step may be two and a half times as long as the one before; no sliver
/// is left before the end, and what was limited stays so.
#[test]
fn steps_grow_and_leave_no_sliver() {
    let system = bar();
    for (first, limit, expected) in [
        (2.0, f64::INFINITY, &[1.0][..]),
        (1.0, f64::INFINITY, &[1.0]),
        (0.6, f64::INFINITY, &[0.5, 1.0]),
        (0.5, f64::INFINITY, &[0.5, 1.0]),
        (0.4, f64::INFINITY, &[0.4, 1.0]),
        (0.1, f64::INFINITY, &[0.1, 0.35, 0.675, 1.0]),
        (0.1, 0.3, &[0.1, 0.35, 0.65, 0.825, 1.0]),
    ] {
        let mut equilibrium = Equilibrium::new(&system);
        let x = equilibrium.start();
        let start = Path::new(&mut equilibrium, Parameter::Load, Settings::default(), first, x);
        let mut path = start.expect("a start");
        assert_eq!((path.last().load, path.next_step()), (0.0, first));
        assert!(path.last_two().is_none());
        let mut loads: Vec<f64> = Vec::new();
        while loads.last().is_none_or(|load| *load < 1.0) && loads.len() < 9 {
            path.limit_step(limit);
            let point: Point = path.advance(1.0).expect("a step").clone();
            assert_eq!(point.parameter, point.load);
            near(point.x[4], 1.0 + 0.1 * point.load, 1e-12, "the bar's end");
            loads.push(point.load);
        }
        assert_eq!(loads.len(), expected.len(), "{first}: {loads:?}");
        for ((load, expected), before) in loads.iter().zip(expected).zip([0.0].iter().chain(expected)) {
            near(*load, *expected, 1e-12, &format!("{first}: {loads:?}"));
            assert!(path.history.iter().any(|record| (record.step - (expected - before)).abs() < 1e-12));
        }
        assert_eq!(loads.last(), Some(&1.0));
        assert!(path.history.iter().all(|record| record.accepted));
        let statistics = path.equilibrium.statistics;
        assert_eq!(
            (statistics.steps, statistics.load_steps, statistics.rejected_steps),
            (loads.len(), loads.len(), 0)
        );
        if let [.., before, last] = expected {
            let [a, b] = path.last_two().expect("two points");
            near(a.load, *before, 1e-12, "the last but one");
            near(b.load, *last, 1e-12, "the last");
        }
    }
}

/// Between two points of a straight path lies the state between; the last step can be taken anew to
/// where something vanishes.
#[test]
fn states_between_and_ends_are_found() {
    let system = bar();
    let mut equilibrium = Equilibrium::new(&system);
    let x = equilibrium.start();
    let mut path =
        Path::new(&mut equilibrium, Parameter::Load, Settings::default(), 0.4, x).expect("a start");
    assert!(path.between(0.1).is_none(), "one point has nothing between");
    path.advance(1.0).expect("a step");
    path.advance(1.0).expect("a step");
    for load in [0.5, 0.77, 1.0, 0.2] {
        let point = path.between(load).expect("a state");
        assert_eq!((point.load, point.stability), (load, Some(Stability::Directions(0))));
        near(point.x[4], 1.0 + 0.1 * load, 1e-12, "the bar's end");
    }
    assert_eq!(path.last().load, 1.0);
    for (wanted, near_by) in [(0.9, 1e-3), (0.77, 1e-12), (0.41, 1e-12)] {
        let found = path.end_where(|point| point.x[4] - (1.0 + 0.1 * wanted), near_by).expect("an end");
        near(found.x[4], 1.0 + 0.1 * wanted, near_by, "the bar's end");
        near(found.load, wanted, 10.0 * near_by + 1e-11, "its load");
        // The next one begins where this step began.
        let [a, _] = path.last_two().expect("two points");
        near(a.load, 0.4, 1e-12, "where the step begins");
    }
}

/// A couple that turns the tip by 5 rad in all, or by 20: a step turns no node by more than 7 rad
/// where nothing asks for the way, by half a radian where a contact or a wound spring does, and by
/// 0.8 where rows of constraints keep nodes from turning; of that it takes 95 parts in a hundred.
#[test]
fn no_step_turns_a_node_by_more_than_it_may() {
    let arm = |turn: f64, more: &str| {
        system(&format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 96 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.moment = [{{ beam = 'arm', at = 'end', value = {turn:?} }}]
             {more}
             analysis.static = {{}}\n"
        ))
    };
    let contact = "effect.contact = [{ beam = 'arm', half_plane = { point = [0, -9], normal = [0, 1] }, stiffness = 1 }]";
    let spring = "effect.torsion_spring = [{ beam = 'arm', at = 'end', stiffness = 1e-9 }]";
    // A slider far from all others, between its nodes.
    let rows = "beam.other = { start = [5, 0], end = [6, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 1 }
        joint = [{ type = 'slider', first = { beam = 'other', at = 0.5 }, along = [1, 0] }]";
    let held = "{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }";
    let both = format!("{held}, {{ beam = 'other', at = 'start', fix = ['x', 'y', 'angle'] }}");
    for (turn, more, largest) in
        [(5.0, "", 7.0), (20.0, "", 7.0), (5.0, contact, 0.5), (5.0, spring, 0.5), (5.0, rows, 0.8)]
    {
        let system = if more == rows {
            let text = format!(
                "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 96 }}
                 support = [{both}]
                 effect.moment = [{{ beam = 'arm', at = 'end', value = {turn:?} }}]
                 {rows}
                 analysis.static = {{}}\n"
            );
            self::system(&text)
        } else {
            arm(turn, more)
        };
        let mut equilibrium = Equilibrium::new(&system);
        let x = equilibrium.start();
        let start = Path::new(&mut equilibrium, Parameter::Load, Settings::default(), 1.0, x);
        let mut path = start.expect("a start");
        path.advance(1.0).expect("a step");
        let first = path.history[0].step;
        let expected = if turn <= largest { 1.0 } else { 0.95 * largest / turn };
        near(first / expected, 1.0, 1e-6, &format!("the first step to {turn} rad, {more}"));
    }
}

/// Two cells along x, held at the ends that `held` names.
fn two_cells(held: &[&str]) -> System {
    let supports: Vec<String> =
        held.iter().map(|at| format!("{{ beam = 'arm', at = {at}, fix = ['x', 'y'] }}")).collect();
    system(&format!(
        "beam.arm = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2 }}
         support = [{}]
         effect.gravity.acceleration = [0, -1]
         analysis.static = {{}}\n",
        supports.join(", ")
    ))
}

/// Where nodes land: gradients and chords turn and stretch, a chord shrinks by what its ends turn
/// against it, and held nodes stay on their linear way, between which the others share the error.
#[test]
fn nodes_turn_by_their_increments() {
    // Chords turn by 0.3 and 0.5 and stretch by 1.1 and 0.9; gradients turn by themselves.
    let increment = [[0.0, 0.0, 0.0, 0.2], [0.1, 0.3 * 1.0, 0.05, 0.4], [0.1 - 0.1, 0.3 + 0.5, 0.0, 0.7]];
    let flat: Vec<f64> = increment.concat();
    let gradient = |stretch: f64, turn: f64| [stretch * turn.cos(), stretch * turn.sin()];
    let gradients = [gradient(1.0, 0.2), gradient(1.05, 0.4), gradient(1.0, 0.7)];
    let chord = |stretch: f64, turn: f64, ends: [f64; 2]| {
        let [a, b] = ends.map(|end| end - turn);
        let length = stretch * (1.0 - (2.0 * a * a - a * b + 2.0 * b * b) / 30.0);
        [length * turn.cos(), length * turn.sin()]
    };
    let (first, second) = (chord(1.1, 0.3, [0.2, 0.4]), chord(0.9, 0.5, [0.4, 0.7]));
    let free = [[0.0, 0.0], first, [first[0] + second[0], first[1] + second[1]]];
    let linear = [[0.0, 0.0], [1.1, 0.3], [2.0, 0.8]];
    let beside: Vec<[f64; 2]> =
        free.iter().zip(linear).map(|(a, b): (&[f64; 2], [f64; 2])| [a[0] - b[0], a[1] - b[1]]).collect();
    let add = |a: [f64; 2], b: [f64; 2], share: f64| [a[0] - share * b[0], a[1] - share * b[1]];
    for (held, expected) in [
        (&["'start'"][..], free),
        (&["'end'"], [0, 1, 2].map(|i| add(free[i], beside[2], 1.0))),
        (&["1"], [0, 1, 2].map(|i| add(free[i], beside[1], 1.0))),
        (&["'start'", "'end'"], [free[0], add(free[1], beside[2], 0.5), add(free[2], beside[2], 1.0)]),
    ] {
        let system = two_cells(held);
        let mut x = system.reference().to_vec();
        Retraction::new(&system).apply(&flat, &mut x);
        for (i, node) in x.chunks_exact(4).enumerate() {
            for d in 0..2 {
                near(node[d], expected[i][d], 1e-14, &format!("{held:?}, node {i}, axis {d}"));
                near(node[2 + d], gradients[i][d], 1e-14, &format!("{held:?}, gradient {i}, axis {d}"));
            }
        }
    }
}

/// Small increments are added as they are, and nothing shrinks to less than a tenth at once.
#[test]
fn small_increments_are_added_and_large_ones_bounded() {
    let system = two_cells(&["'start'"]);
    let retraction = Retraction::new(&system);
    assert!(retraction.turns());
    let reference = system.reference().to_vec();
    for (largest, added) in [(0.01, true), (0.0101, false)] {
        for place in [2, 3, 6, 11] {
            let mut increment = vec![0.001; 12];
            increment[place] = -largest;
            let mut x = reference.clone();
            retraction.apply(&increment, &mut x);
            let sums = x.iter().zip(&reference).zip(&increment).all(|((x, q), d)| *x == q + d);
            assert_eq!(sums, added, "{largest} in {place}");
        }
    }
    let mut increment = vec![0.0; 12];
    increment[2] = -0.95;
    increment[6] = -0.85;
    increment[10] = -2.5;
    let mut x = reference.clone();
    retraction.apply(&increment, &mut x);
    for (i, expected) in [(2, 0.1), (6, 0.15), (10, 0.1)] {
        near(x[i], expected, 1e-15, "a gradient");
    }
    let slider = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        joint = [{ type = 'slider', first = { beam = 'arm', at = 0.5 }, along = [1, 0] }]
        analysis.static = {}\n";
    let system = self::system(slider);
    let retraction = Retraction::new(&system);
    assert!(!retraction.turns(), "rows of constraints are linear");
    let increment: Vec<f64> = (0..12).map(|i| 0.1 * f64::from(i)).collect();
    let mut x = system.reference().to_vec();
    retraction.apply(&increment, &mut x);
    assert!(x.iter().zip(system.reference()).zip(&increment).all(|((x, q), d)| *x == q + d));
}
