//! Events on all quantities of a probe: when they happen, and the values there.

use super::{ROD, Written, near};
use ancf::Options;
use ancf::accuracy::estimate;
use ancf::output::Summary;
use ancf::scene::parse;
use serde_json::json;
use std::f64::consts::PI;

/// Times and values of the events of a scene, and the time at which its motion ends.
fn events(text: &str) -> (Vec<(f64, f64)>, f64) {
    let found = Written::of(text);
    let summary = found.summary();
    let events = summary["events"].as_array().cloned().unwrap_or_default();
    let number = |event: &serde_json::Value, key: &str| event[key].as_f64().expect("a number");
    (
        events.iter().map(|event| (number(event, "time"), number(event, "value"))).collect(),
        found.said("/last"),
    )
}

fn expect(text: &str, expected: &[(f64, f64)], tolerance: f64, what: &str) {
    let (found, _) = events(text);
    assert_eq!(found.len(), expected.len(), "{what}: {found:?}");
    for ((time, value), (t, v)) in found.iter().zip(expected) {
        near(*time, *t, tolerance, what);
        near(*value, *v, tolerance * v.abs().max(1.0), what);
    }
}

const METHODS: [&str; 3] =
    ["radau.tolerance = 1e-9", "gauss = { stages = 3, step = 0.07 }", "generalized_alpha.tolerance = 1e-9"];

/// A rod thrown with (2, 4) m/s against 10 m/s² has vy = 4 − 10 t and its apex at 0.4 s; turned with
/// 9 rad/s it points anywhere, with full turns counted.
#[test]
fn velocities_angles_and_apices_of_a_thrown_rod() {
    for method in METHODS {
        let thrown = |event: &str| {
            format!(
                "{ROD}effect.gravity.acceleration = [0, -10]\ninitial_velocity = [{{ beam = 'rod', value = [2, 4] }}]
                analysis.dynamic = {{ duration = 1, output_every = 0.25, {method}, event = [{{ probe = 'middle', {event} }}] }}\n"
            )
        };
        for (event, expected) in [
            ("vy = '1 m/s'", &[(0.3, 1.0)][..]),
            ("vx = 3", &[]),
            ("speed = 2.5", &[(0.25, 2.5), (0.55, 2.5)]),
            ("speed = 2.5, crossing = 'rising'", &[(0.55, 2.5)]),
            ("maximum = 'y'", &[(0.4, 0.8)]),
            ("minimum = 'y'", &[]),
            ("minimum = 'vy'", &[]),
            ("minimum = 'speed'", &[(0.4, 2.0)]),
            ("maximum = 'speed'", &[]),
        ] {
            expect(&thrown(event), expected, 1e-6, &format!("{event} by {method}"));
        }
        let (_, last) = events(&thrown("maximum = 'y', stop = true"));
        near(last, 0.4, 1e-6, method);
        let turned = format!(
            "{ROD}initial_velocity = [{{ beam = 'rod', rotation = -9, about = [0.5, 0] }}]
            analysis.dynamic = {{ duration = 1, output_every = 0.25, {method}, event = [\
                {{ probe = 'end', angle = '-7.2 rad' }}, {{ probe = 'end', angle = 1 }}, {{ probe = 'end', maximum = 'x' }}] }}\n"
        );
        // x = 0.5 + 0.5 cos 9 t; the rod is a little longer as it turns.
        let turn = std::f64::consts::TAU / 9.0;
        expect(&turned, &[(turn, 1.0), (0.8, -7.2)], 3e-4, method);
    }
}

/// A rod that is guided at its start and pulled at its end by 40 t³ N carries half of it in its middle,
/// and the moment 0.375 m of it where it acts across.
#[test]
fn forces_strains_and_stresses_of_a_rod_that_is_accelerated() {
    let pulled = |along: bool, event: &str| {
        let (fix, force) = if along { ("y", "[40, 0]") } else { ("x", "[0, 40]") };
        format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], section.rectangle = {{ width = 0.1, height = 0.2 }}, youngs_modulus = 5e9, \
             density = 100, basis.ancf.elements = 16 }}
            support = [{{ beam = 'rod', at = 'start', fix = ['{fix}', 'angle'] }}]
            effect.force = [{{ beam = 'rod', at = 'end', value = {force}, in_time.polynomial = [0, 0, 0, 1] }}]
            probe = [{{ name = 'middle', beam = 'rod', at = 0.5 }}]
            analysis.dynamic = {{ duration = 0.8, radau.tolerance = 1e-9, event = [{{ probe = 'middle', {event} }}] }}\n"
        )
    };
    // N = 20 t³, EA = 1e8.
    for (event, value) in
        [("axial_force = '5 N'", 5.0), ("strain = 5e-8", 5e-8), ("stress_top = '250 Pa'", 250.0)]
    {
        expect(&pulled(true, event), &[(0.25_f64.cbrt(), value)], 2e-5, event);
    }
    // Q = 20 t³, M = 15 t³, EI = 5e9 · 6.667e-5, σ = 0.1 M/I on the right.
    for (event, cube, value) in [
        ("shear_force = '5 N'", 0.25, 5.0),
        ("bending_moment = '3 N m'", 0.2, 3.0),
        ("curvature = 9e-6", 0.2, 9e-6),
        ("stress_bottom = '4.5 kPa'", 0.2, 4500.0),
        ("stress_top = '-4500 Pa', crossing = 'falling'", 0.2, -4500.0),
        ("stress_top = '-4500 Pa', crossing = 'rising'", 0.0, 0.0),
    ] {
        let expected: &[(f64, f64)] = if cube > 0.0 { &[(f64::cbrt(cube), value)] } else { &[] };
        // Curvatures at nodes converge slowly.
        let tolerance = if event.starts_with("curvature") { 1e-3 } else { 1e-4 };
        expect(&pulled(false, event), expected, tolerance, event);
    }
}

/// A weight that is thrown down from a bar swings at 5 rad/s: the force in the bar is √(k m) v sin(ω t),
/// with its maximum after a quarter of a period and its minimum after three.
#[test]
fn a_force_has_maxima() {
    let text = "beam.bar = { start = [0, 0], end = [0, -1], axial_stiffness = 100, bending_stiffness = 1, mass_per_length = 1e-6, basis.ancf.elements = 1 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.point_mass = [{ beam = 'bar', at = 'end', mass = 4 }]
        initial_velocity = [{ beam = 'bar', polynomial.vy = [0, -0.05] }]
        probe = [{ name = 'top', beam = 'bar', at = 0.5 }]
        analysis.dynamic = { duration = 3, output_every = 0.1, gauss.tolerance = 1e-9, event = [\
            { probe = 'top', maximum = 'axial_force' }, { probe = 'top', minimum = 'axial_force' }] }\n";
    let quarter = std::f64::consts::FRAC_PI_2 / 5.0;
    let expected = [
        (quarter, 1.0),
        (3.0 * quarter, -1.0),
        (5.0 * quarter, 1.0),
        (7.0 * quarter, -1.0),
        (9.0 * quarter, 1.0),
    ];
    expect(text, &expected, 1e-4, "force");
    // However loose the tolerance, they are seen.
    let (loose, _) = events(&text.replace("1e-9,", "0.2,"));
    assert_eq!(loose.len(), expected.len(), "{loose:?}");
    // The stress on a face of 0.25 m by 0.5 m is eight times the force.
    let stiff = "section.rectangle = { height = 0.5, width = 0.25 }, youngs_modulus = 800";
    let stressed = text
        .replace("axial_stiffness = 100, bending_stiffness = 1", stiff)
        .replace("'axial_force'", "'stress_top'");
    expect(&stressed, &expected.map(|(time, force)| (time, 8.0 * force)), 8e-4, "stress");
}

#[test]
fn events_that_cannot_be_are_refused() {
    let rod = |event: &str| {
        format!("{ROD}analysis.dynamic = {{ duration = 1, event = [{{ probe = 'middle', {event} }}] }}\n")
    };
    for (text, part) in [
        (rod("x = 1, y = 2"), "an event needs exactly one quantity of its probe; found 2"),
        (rod("stop = true"), "found 0"),
        (rod("maximum = 'y', crossing = 'rising'"), "a maximum or a minimum has no `crossing`"),
        (rod("maximum = 'z'"), "found \"z\", expected one of \"x\", \"y\", \"angle\""),
        (rod("stress_top = 1"), "the stress at probe `middle` is not known"),
        (rod("maximum = 'stress_bottom'"), "the stress at probe `middle` is not known"),
        (
            rod("curvature = 1").replace("bending_stiffness = 1e4, ", ""),
            "lies on a string, which has no curvature",
        ),
        (rod("y = 1").replace("probe = 'middle'", "probe = 'centre'"), "there is no probe named `centre`"),
    ] {
        let said = parse("events.toml", &text).expect_err(part).to_string();
        assert!(said.contains(part), "{said}");
    }
}

/// A tip that a small force shakes turns back as often whichever way the beam points: what is small
/// against the direction itself is not small against how it changes.
#[test]
fn turns_of_a_direction_do_not_depend_on_the_direction() {
    let times = |turn: f64| {
        let (sine, cosine) = turn.sin_cos();
        let along = |x: f64, y: f64| format!("[{:e}, {:e}]", cosine * x - sine * y, sine * x + cosine * y);
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = {}, axial_stiffness = 100, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 5 }}\n\
             effect.force = [{{ beam = 'rod', at = 'end', value = {} }}]\n\
             probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]\n\
             analysis.dynamic = {{ duration = 0.1, gauss = {{ stages = 3, step = 1e-3 }}, \
             event = [{{ probe = 'tip', maximum = 'angle' }}, {{ probe = 'tip', minimum = 'angle' }}] }}\n",
            along(1.0, 0.0),
            along(-0.03, -0.02),
        );
        events(&text).0.into_iter().map(|(time, _)| time).collect::<Vec<_>>()
    };
    let straight = times(0.0);
    assert!(straight.len() > 4, "{straight:?}");
    for turn in [1.5, 3.1, -2.0] {
        let turned = times(turn);
        let apart = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6;
        assert!(
            turned.len() == straight.len() && straight.iter().zip(&turned).all(apart),
            "{straight:?} {turned:?}"
        );
    }
}

/// A beam that rests until a force sets in: what it does before is round-off, and an event that ends the
/// motion must not be found in it, wherever the beam lies.
#[test]
fn a_beam_at_rest_has_no_events() {
    let quantities = [
        "x",
        "y",
        "angle",
        "vx",
        "vy",
        "speed",
        "strain",
        "curvature",
        "axial_force",
        "shear_force",
        "bending_moment",
    ];
    let event = |what: &str| format!("{{ probe = 'tip', {what} }}");
    let of = |quantity: &str| {
        let at_rest = match quantity {
            // Places are where the beam lies.
            "x" | "y" => None,
            "angle" => Some(0.6_f64.atan2(0.8)),
            _ => Some(0.0),
        };
        let turns = ["maximum", "minimum"].map(|turn| event(&format!("{turn} = '{quantity}'"))).join(", ");
        at_rest
            .map_or(turns.clone(), |value| format!("{turns}, {}", event(&format!("{quantity} = {value:e}"))))
    };
    let all = quantities.map(of).join(", ");
    for basis in ["ancf.elements = 20", "rpim.nodes = 20"] {
        for [x, y] in [[0.3, 0.2], [20.0, -27.3]] {
            let text = format!(
                "beam.rod = {{ start = [{x}, {y}], end = [{}, {}], axial_stiffness = 1e5, bending_stiffness = 1, mass_per_length = 1, basis.{basis} }}
                support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }}]
                effect.force = [{{ beam = 'rod', at = 'end', value = [0, 1], in_time.step.start = 0.5 }}]
                probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]
                analysis.dynamic = {{ duration = 0.505, radau.tolerance = 1e-4, event = [{}] }}\n",
                x + 0.8,
                y + 0.6,
                all,
            );
            let (found, _) = events(&text);
            let early: Vec<_> = found.iter().filter(|(time, _)| *time < 0.5).collect();
            assert!(early.is_empty() && !found.is_empty(), "{basis} from {x}, {y}: {early:?}");
        }
    }
}

/// A vibration that is smaller than what counts as round-off has no events, and says so.
#[test]
fn motions_too_small_for_events_are_told() {
    let warned = |force: f64| {
        let text = format!(
            "beam.rod = {{ start = [0.3, 0.2], end = [1.1, 0.8], axial_stiffness = 1e5, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
            support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'rod', at = 'end', value = [{:e}, {:e}] }}]
            probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]
            analysis.dynamic = {{ duration = 4, radau.tolerance = 1e-4, event = [{{ probe = 'tip', maximum = 'y' }}] }}\n",
            -0.6 * force,
            0.8 * force,
        );
        let summary = Written::of(&text).summary();
        let told = summary["warnings"].to_string().contains("moves by");
        (told, summary["events"].as_array().is_none_or(Vec::is_empty))
    };
    // Twice the static deflection F L³/(3 EI): 2e-6, 2e-10, and nothing.
    assert_eq!([3e-6, 3e-10, 0.0].map(warned), [(false, false), (true, true), (false, true)]);
}

/// A level beam that is let go falls, and its end comes nearer at once: in the first steps of a loose tolerance it
/// recedes by some billionths of its length, which is an error of the steps and no maximum.
#[test]
fn errors_of_loose_steps_are_no_turns() {
    for method in ["radau", "generalized_alpha"] {
        for tolerance in ["1e-2", "1e-3", "1e-4"] {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}
                support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y'] }}]
                effect.gravity.acceleration = [0, -9.81]
                probe = [{{ name = 'end', beam = 'rod', at = 'end' }}]
                analysis.dynamic = {{ duration = 0.3, {method}.tolerance = {tolerance}, event = [{{ probe = 'end', maximum = 'x' }}] }}\n"
            );
            let summary = Written::of(&text).summary();
            assert!(summary["events"].as_array().is_none_or(Vec::is_empty), "{method}, {tolerance}");
        }
    }
}

/// The moment at a hinge is zero, and what a motion that is known to 1e-4 leaves of it, a ten-millionth of the
/// largest along the beam, does not turn back.
#[test]
fn what_vanishes_at_the_end_of_a_beam_has_no_turns() {
    let text = "beam.cable = { start = [0, 0], end = [-60, -194], mass_per_length = 1.2e-5, axial_stiffness = 2700, \
         bending_stiffness = 277, basis.ancf.nodes = 15 }
        support = [{ beam = 'cable', at = 'start', fix = ['x', 'y'], move = { x = -2.4, in_time.harmonic.frequency = 1.3 } }, \
            { beam = 'cable', at = 'end', fix = ['y'] }]
        effect.damping = [{ beam = 'cable', stiffness_proportional = 7e-4 }]
        probe = [{ name = 'end', beam = 'cable', at = 'end' }]
        analysis.dynamic = { duration = 0.5, radau.tolerance = 1e-4, event = [\
            { probe = 'end', maximum = 'bending_moment' }, { probe = 'end', minimum = 'bending_moment' }] }\n";
    expect(text, &[], 0.0, "moment at a hinge");
}

/// Strains of a stiff piece are a hundred-millionth of those in the soft one beside it, and have their maxima with the
/// force in both.
#[test]
fn strains_of_a_stiff_piece_have_maxima() {
    let text = "beam.bar = { start = [0, 0], end = [0, -2], axial_stiffness.pieces = { until = [1], value = [1e10, 100] }, \
         bending_stiffness = 1, mass_per_length = 1e-6, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.point_mass = [{ beam = 'bar', at = 'end', mass = 4 }]
        initial_velocity = [{ beam = 'bar', table = { s = [0, 1, 2], vy = [0, 0, -0.05] } }]
        probe = [{ name = 'stiff', beam = 'bar', at = 0.5 }, { name = 'soft', beam = 'bar', at = 1.5 }]
        analysis.dynamic = { duration = 3, output_every = 0.1, radau.tolerance = 1e-7, event = [{ probe = 'NAME', maximum = 'strain' }] }\n";
    let times = |probe: &str| -> Vec<f64> {
        events(&text.replace("NAME", probe)).0.into_iter().map(|(time, _)| time).collect()
    };
    let [stiff, soft] = ["stiff", "soft"].map(times);
    assert!(stiff.len() == 3 && soft.len() == 3, "{stiff:?} {soft:?}");
    stiff.iter().zip(&soft).for_each(|(a, b)| near(*a, *b, 1e-4, "stiff and soft"));
}

/// A stiff rod that falls from a level position about a hinge passes the vertical after K(1/2) √(2L/3g), with a speed of √(3gL) at its
/// tip, which is at its lowest there. With an accuracy alone the time and the value are as right as is told of them, and less is told
/// where less is wanted.
#[test]
fn errors_of_times_and_values_of_events_are_told() {
    let (length, gravity, quarter) = (0.8_f64, 9.81_f64, 1.854_074_677_301_371_9_f64);
    let time = quarter * (2.0 * length / (3.0 * gravity)).sqrt();
    let mut told_before = f64::INFINITY;
    for accuracy in ["1e-3", "1e-5"] {
        let found = Written::of(&format!(
            "beam.rod = {{ start = [0, 0], end = [{length}, 0], bending_stiffness = 1e4, mass_per_length = 1 }}
            support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y'] }}]
            effect.gravity.acceleration = [0, -{gravity}]
            probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]
            analysis.dynamic = {{ duration = 0.6, output_every = 0.1, accuracy = {accuracy}, event = [\
                {{ probe = 'tip', x = 0 }}, {{ probe = 'tip', minimum = 'y' }}, {{ probe = 'tip', vx = {} }}] }}",
            -0.9 * (3.0 * gravity * length).sqrt()
        ));
        let summary = found.summary();
        let events = summary["events"].as_array().expect("events");
        let of =
            |quantity: &str| events.iter().find(|event| event["quantity"] == quantity).expect("an event");
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let [crossing, lowest] = [of("x"), of("y")];
        for event in [crossing, lowest] {
            let (found, told) = (number(&event["time"]), number(&event["error"]["time"]));
            assert!((found - time).abs() <= 3.0 * told + 1e-7, "{accuracy}: {found} for {time}, {told} told");
            assert!(told < 1e-2 * time, "{accuracy}: {told} told");
        }
        let (value, told) = (number(&lowest["value"]), number(&lowest["error"]["value"]));
        assert!((value + length).abs() <= 3.0 * told + 1e-7, "{accuracy}: {value}, {told} told");
        assert!(crossing["error"].get("value").is_none(), "what is reached is given");
        assert_eq!((crossing.get("turns"), &lowest["turns"]), (None, &"minimum".into()));
        let told = number(&crossing["error"]["time"]);
        assert!(told < 0.3 * told_before, "{accuracy}: {told} after {told_before}");
        told_before = told;
        assert!(number(&of("vx")["error"]["time"]) > 0.0);
    }
    // A run that does not look for errors tells none.
    let plain = Written::of(&format!(
        "{ROD}initial_velocity = [{{ beam = 'rod', value = [2, 4] }}]
        effect.gravity.acceleration = [0, -10]
        analysis.dynamic = {{ duration = 1, output_every = 0.25, radau.tolerance = 1e-6, event = [{{ probe = 'middle', maximum = 'y' }}] }}"
    ));
    assert!(plain.summary()["events"][0].get("error").is_none());
}

/// Two stiff bars in a hinge, half an apart of 2 m and 0.5 m high, are pressed flat: with the length l of each, at first L, they carry
/// P = 2 EA y (1/l − 1/L) at the height y, most of it where l³ = L, and as much upwards below. A clamped column of 1 m loses stability
/// at π² EI/4.
#[test]
fn limit_loads_and_bifurcations_are_events() {
    let truss = "beam.left = { start = [-1, 0], end = [0, 0.5], axial_stiffness = 1e3, bending_stiffness = 1e3, basis.ancf.elements = 2 }
        beam.right = { start = [0, 0.5], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1e3, basis.ancf.elements = 2 }
        support = [{ beam = 'left', at = 'start', fix = ['x', 'y'] }, { beam = 'right', at = 'end', fix = ['x', 'y'] }]
        joint = [{ type = 'hinge', first = { beam = 'left', at = 'end' }, second = { beam = 'right', at = 'start' } }]
        effect.force = [{ beam = 'left', at = 'end', value = [0, -10] }]
        probe = [{ name = 'apex', beam = 'left', at = 'end' }]
        analysis.static.arc_length = { until_probe = { probe = 'apex', y = -0.6 } }\n";
    let long = 1.25_f64.sqrt();
    let short = long.cbrt();
    let most = 200.0 * (short * short - 1.0).sqrt() * (1.0 / short - 1.0 / long);
    let column = |elements: usize, analysis: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e8, bending_stiffness = 1, basis.ancf.elements = {elements} }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [-4, 0] }}]\nanalysis.static{analysis}\n"
        )
    };
    let critical = PI * PI / 16.0;
    for (text, expected) in [
        (truss.to_owned(), vec![(most, "lost", [0, 1], 2e-7), (-most, "regained", [1, 0], 2e-7)]),
        (column(4, " = {}"), vec![(critical, "lost", [0, 1], 3e-5)]),
        (column(8, ".arc_length.until_load = 0.7"), vec![(critical, "lost", [0, 1], 2e-6)]),
    ] {
        let scene = parse("scene.toml", &text).expect("a scene");
        let found = estimate(scene.model(), scene.analysis(), Options::default()).expect("a path");
        let summary: serde_json::Value =
            serde_json::from_str(&Summary::of(&found).to_json().expect("JSON")).expect("JSON");
        let events = summary["events"].as_array().expect("events");
        assert_eq!(events.len(), expected.len(), "{events:?}");
        for (event, (load, stability, directions, tolerance)) in events.iter().zip(expected) {
            let number = |value: &serde_json::Value| value.as_f64().expect("a number");
            let truth = (number(&event["load_factor"]) - load).abs();
            assert!(truth <= tolerance * load.abs(), "{event}: {load}");
            assert_eq!(
                (&event["stability"], &event["unstable_directions"]),
                (&json!(stability), &json!(directions))
            );
            let told = number(&event["error"]["load_factor"]);
            assert!(truth <= 2.0 * told && told <= (10.0 * truth).max(1e-6), "{event}: {load}");
            assert_eq!(event["error"].get("time"), None);
        }
    }
}
