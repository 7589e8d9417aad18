//! Events of a motion: every time at which a probe's coordinate reaches a value, whatever the
//! steps.

use ancf::results::{Event, Trajectory};
use proptest::prelude::*;

const G: f64 = 9.81;
/// Initial velocity \[m/s\].
const UP: f64 = 4.0;
const INTEGRATORS: [&str; 7] = [
    "generalized_alpha = { step = 0.07 }",
    "generalized_alpha = { tolerance = 1e-8 }",
    "gauss = { stages = 1, step = 0.07 }",
    "gauss = { stages = 2, step = 0.11 }",
    "gauss = { tolerance = 1e-8 }",
    "radau = { stages = 2, step = 0.07 }",
    "radau = { tolerance = 1e-8 }",
];

/// A beam thrown in the direction `turn` degrees from up, against a weight along it, by which no
/// point of it bends; the events watch its middle.
fn thrown(integrator: &str, axis: &str, sign: f64, scale: f64, events: &[(f64, &str, bool)]) -> Trajectory {
    let vector = |value: f64| if axis == "x" { format!("[{value}, 0]") } else { format!("[0, {value}]") };
    let events: Vec<String> = events
        .iter()
        .map(|(value, crossing, stop)| {
            let value = sign * value * scale;
            format!("{{ probe = \"middle\", {axis} = {value:e}, crossing = \"{crossing}\", stop = {stop} }}")
        })
        .collect();
    let text = format!(
        "effect.gravity.acceleration = {gravity}
        beam.rod = {{ start = [0, 0], end = {end}, axial_stiffness = 1e4, bending_stiffness = {stiffness:e}, mass_per_length = 1, basis.ancf.elements = 3 }}
        initial_velocity = [{{ beam = \"rod\", value = {velocity} }}]
        probe = [{{ name = \"middle\", beam = \"rod\", at = {middle} }}]
        analysis.dynamic = {{ duration = 0.9, {integrator}, event = [{events}] }}",
        end = if axis == "x" { format!("[0, {scale}]") } else { format!("[{scale}, 0]") },
        gravity = vector(-sign * G * scale),
        velocity = vector(sign * UP * scale),
        middle = 0.4 * scale,
        stiffness = scale * scale,
        events = events.join(", "),
    );
    let scene = ancf::scene::parse("thrown.toml", &text).expect("a legal scene");
    scene.model().solve(scene.analysis()).expect("a motion").into_states()
}

fn times(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.events.iter().map(Event::parameter).collect()
}

proptest! {
    #![proptest_config(super::cases(24))]

    /// A throw reaches every height below its apex twice, at the roots of a parabola, also where
    /// both lie within one step.
    #[test]
    fn a_throw_reaches_every_height_twice(
        method in 0..INTEGRATORS.len(), along_x: bool, down: bool, exponent in -7..0_i32, digits in 1.0..10.0_f64, size in -6..4_i32,
    ) {
        let below = 1.0 - digits * 10f64.powi(exponent - 1);
        let (axis, sign, scale) = (if along_x { "x" } else { "y" }, if down { -1.0 } else { 1.0 }, 10f64.powi(size));
        let height = below * UP * UP / (2.0 * G);
        let [away, back] = if down { ["falling", "rising"] } else { ["rising", "falling"] };
        let trajectory = thrown(INTEGRATORS[method], axis, sign, scale, &[(height, "any", false), (height, away, false), (height, back, true)]);
        let apart = (UP * UP - 2.0 * G * height).sqrt();
        let expected = [(UP - apart) / G, (UP - apart) / G, (UP + apart) / G, (UP + apart) / G];
        let found = times(&trajectory);
        prop_assert_eq!(found.len(), 4, "{:?} for {:?}", found, expected);
        for (found, expected) in found.iter().zip(expected) {
            prop_assert!((found - expected).abs() < 1e-8 / apart, "{} for {}", found, expected);
        }
        // The motion ends there, with its records and energies.
        prop_assert_eq!(trajectory.parameter.last(), found.last());
        prop_assert_eq!(trajectory.energy.len(), trajectory.parameter.len());
    }

    /// It touches its apex once, from the side from which it came, and reaches nothing beyond.
    #[test]
    fn a_throw_touches_its_apex_once(method in 0..INTEGRATORS.len(), along_x: bool, down: bool, size in -6..4_i32) {
        let (axis, sign, scale) = (if along_x { "x" } else { "y" }, if down { -1.0 } else { 1.0 }, 10f64.powi(size));
        let apex = UP * UP / (2.0 * G);
        let [away, back] = if down { ["falling", "rising"] } else { ["rising", "falling"] };
        let trajectory = thrown(
            INTEGRATORS[method], axis, sign, scale,
            &[(apex, "any", false), (apex, away, false), (apex, back, true), (apex * (1.0 + 1e-7), "any", true)],
        );
        let found = times(&trajectory);
        // A motion that rises higher by its own error passes the height, up and down, at once; here
        // by less than 1e-8 beam lengths.
        prop_assert!(matches!(found.len(), 2 | 4), "{:?}", found);
        prop_assert!(found.iter().all(|time| (time - UP / G).abs() < 5e-5), "{:?} for {}", found, UP / G);
    }
}

/// Steps that end at the very top, or where a height is reached, count nothing twice and lose
/// nothing.
#[test]
fn steps_that_end_at_an_event_count_it_once() {
    let apex = UP * UP / (2.0 * G);
    for parts in 1..=4 {
        let step = UP / G / f64::from(parts);
        for kind in ["generalized_alpha", "gauss", "radau"] {
            let integrator = format!("{kind} = {{ step = {step:e} }}");
            let found = thrown(&integrator, "y", 1.0, 1.0, &[(apex, "any", false), (0.0, "any", false)]);
            let found = times(&found);
            // It starts at the height 0, which is no event, and returns to it.
            assert_eq!(found.len(), 2, "{integrator}: {found:?}");
            assert!((found[0] - UP / G).abs() < 1e-5 && (found[1] - 2.0 * UP / G).abs() < 1e-8, "{found:?}");
        }
    }
}

/// Both ends of a swing, many times, with steps that are long and short against it: a hinged rigid
/// rod in no gravity turns evenly.
#[test]
fn every_turn_of_a_spinning_rod_is_seen() {
    for integrator in
        ["gauss = { step = 0.05 }", "gauss = { tolerance = 1e-7 }", "radau = { tolerance = 1e-7 }"]
    {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e7, bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 2 }}
            support = [{{ beam = \"rod\", at = \"start\", fix = [\"x\", \"y\"] }}]
            initial_velocity = [{{ beam = \"rod\", rotation = 6.283185307179586 }}]
            probe = [{{ name = \"tip\", beam = \"rod\", at = \"end\" }}]
            analysis.dynamic = {{ duration = 5.1, output_every = 5.1, {integrator}, event = [
                {{ probe = \"tip\", y = 0.99 }}, {{ probe = \"tip\", x = -0.99, crossing = \"falling\" }} ] }}"
        );
        let scene = ancf::scene::parse("rod.toml", &text).expect("a legal scene");
        let trajectory = scene.model().solve(scene.analysis()).expect("a motion");
        let found = times(trajectory.states());
        let apart = 0.99_f64.acos() / std::f64::consts::TAU;
        let turn = |k: i32| {
            let start = f64::from(k);
            [start + 0.25 - apart, start + 0.25 + apart, start + 0.5 - apart]
        };
        let expected: Vec<f64> = (0..5).flat_map(turn).collect();
        assert_eq!(found.len(), expected.len(), "{integrator}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-4, "{integrator}: {found} for {expected}");
        }
    }
}

/// Nothing acts beyond the free end of a cantilever: what its forces there do is round-off, and no
/// turn of theirs is an event.
#[test]
fn forces_that_are_round_off_do_not_turn() {
    let watched = |probe: &str| {
        let of = |quantity: &str| {
            ["maximum", "minimum"]
                .map(|turn| format!("{{ probe = \"{probe}\", {turn} = \"{quantity}\" }}"))
                .join(", ")
        };
        ["axial_force", "shear_force", "bending_moment", "stress_top", "stress_bottom"].map(of).join(", ")
    };
    // A small load, as long as it does more than round-off, turns them as well.
    for (end, axial, load) in
        [("[1, 0]", 2e5_f64, 1.0), ("[-0.5, 0.9]", 2e5, 1.0), ("[0, -1]", 2e9, 1.0), ("[1, 0]", 2e5, 1e-5)]
    {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = {end}, youngs_modulus = {modulus:e}, density = 1e4, section.rectangle = {{ width = 0.01, height = {height:e} }}, basis.ancf.elements = 12 }}
            support = [{{ beam = \"a\", at = \"start\", fix = [\"x\", \"y\", \"angle\"] }}]
            effect.gravity.acceleration = [{:e}, {:e}]
            probe = [{{ name = \"tip\", beam = \"a\", at = \"end\" }}, {{ name = \"middle\", beam = \"a\", at = 0.4 }}]
            analysis.dynamic = {{ duration = 0.05, event = [{}, {}] }}",
            0.3 * load,
            0.2 * load,
            watched("tip"),
            watched("middle"),
            // EI = 1.
            height = (12.0 / axial).sqrt(),
            modulus = axial / (0.01 * (12.0 / axial).sqrt()),
        );
        let scene =
            ancf::scene::parse("cantilever.toml", &text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
        let states = scene.model().solve(scene.analysis()).expect("a motion").into_states();
        let of = |probe: &str| {
            states
                .events
                .iter()
                .filter(|event| matches!(event, Event::Probe { probe: of, .. } if of == probe))
                .count()
        };
        assert_eq!(of("tip"), 0, "{end}: {:?}", states.events);
        assert!(of("middle") > if load < 1.0 { 1 } else { 5 }, "{end}: {:?}", states.events);
    }
}

/// A speed falls to zero and grows again where what is thrown up turns round: it has a corner there, and is met on both sides of
/// it, however near.
#[test]
fn speeds_are_met_on_both_sides_of_a_reversal() {
    for integrator in INTEGRATORS {
        let text = format!(
            "effect.gravity.acceleration = [0, -10]
            beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2 }}
            initial_velocity = [{{ beam = 'rod', value = [0, 10] }}]
            probe = [{{ name = 'm', beam = 'rod', at = 0.5 }}]
            analysis.dynamic = {{ duration = 2, {integrator}, event = [{{ probe = 'm', speed = 0.02 }}, {{ probe = 'm', speed = 3 }}, \
            {{ probe = 'm', minimum = 'speed' }}, {{ probe = 'm', speed = 0 }}] }}"
        );
        let scene = ancf::scene::parse("thrown.toml", &text).expect("a legal scene");
        let found = scene.model().solve(scene.analysis()).expect("a motion").into_states();
        let times: Vec<f64> = found.events.iter().map(Event::parameter).collect();
        let expected = [0.7, 0.998, 1.0, 1.0, 1.002, 1.3];
        let near = times.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(times.len() == 6 && near, "{times:?} by {integrator}");
        let at_rest = |event: &Event| matches!(event, Event::Probe { value, .. } if value.abs() < 1e-5);
        assert!(found.events[2..4].iter().all(at_rest), "{:?}", found.events);
    }
}
