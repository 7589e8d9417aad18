//! The numbers and words of what a run warns of: energies that go astray, steps that were divided,
//! obstacles that gave way, stability lost and regained, and what an analysis leaves out.

use super::near;
use ancf::results::{Energy, Event, Trajectory};
use ancf::run::Options;
use ancf::scene::parse;
use std::f64::consts::PI;

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// The number that stands between two texts.
fn between(text: &str, before: &str, after: &str) -> f64 {
    let part = text.split(before).nth(1).and_then(|rest| rest.split(after).next());
    part.and_then(|part| part.parse().ok()).unwrap_or_else(|| panic!("`{before}` number `{after}`: {text}"))
}

/// A clamped beam of the length L, EA = 1e4 L² and EI = L⁴ in these units, so that it swings alike
/// whatever its length, pushed off by V at its end.
fn swinging(length: f64, speed: f64, more: &str, integrator: &str) -> Trajectory {
    let (axial, bending, rate) = (1e4 * length.powi(2), length.powi(4), speed / length.powi(2));
    solved(&format!(
        "beam.arm = {{ start = [0, 0], end = [{length:?}, 0], axial_stiffness = {axial:e}, bending_stiffness = {bending:e}, \
         mass_per_length = 1, basis.ancf.elements = 2 }}
         support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
         initial_velocity = [{{ beam = 'arm', polynomial = {{ vy = [0, 0, {rate:e}] }} }}]
         {more}
         analysis.dynamic = {{ duration = 1, output_every = 0.1, {integrator} }}\n"
    ))
}

const LOSSY: &str = "generalized_alpha = { step = 0.1, spectral_radius = 0.0 }";
const EXACT: &str = "radau.tolerance = 1e-6";

fn extremes(energy: &[Energy]) -> [f64; 2] {
    let totals = || energy.iter().map(Energy::total);
    [totals().fold(f64::INFINITY, f64::min), totals().fold(f64::NEG_INFINITY, f64::max)]
}

/// A motion that begins with all of its energy as speed: what it has lost or gained is told with
/// its part of that, however small both are.
///
/// Would catch a balance of other records than the first and the farthest, shares of one joule in
/// place of the motion's own energy, and losses that are told as gains.
#[test]
fn energy_that_goes_astray_is_told_with_its_share() {
    // ½ V² ∫ s⁴ ds at the start.
    for speed in [1.0, 1e-2, 1e-6] {
        let found = swinging(1.0, speed, "", LOSSY);
        let (first, [least, most]) = (found.energy[0].total(), extremes(&found.energy));
        near(first / (0.1 * speed * speed), 1.0, 1e-9, "the first energy");
        assert!(first - least > 0.1 * first && most <= first * (1.0 + 1e-9), "{least} to {most} of {first}");
        let expected = format!(
            "the motion has lost {:.2e} J, {:.2} of its largest energy, that no damping took",
            first - least,
            (first - least) / first
        );
        assert!(found.run.warnings[0].starts_with(&expected), "{expected}: {:?}", found.run.warnings);
    }
    let found = swinging(1.0, 1.0, "", "gauss = { stages = 1, step = 0.1 }");
    let (first, [least, most]) = (found.energy[0].total(), extremes(&found.energy));
    assert!(most > 1.02 * first && least > 0.999 * first, "{least} to {most} of {first}");
    let parts = |e: &Energy| [e.stretch, e.bend, e.kinetic];
    let largest = found.energy.iter().flat_map(parts).fold(0.0, f64::max);
    let expected = format!(
        "the motion has gained {:.2e} J, {:.2} of its largest energy, that nothing put in",
        most - first,
        (most - first) / largest
    );
    assert!(found.run.warnings[0].starts_with(&expected), "{expected}: {:?}", found.run.warnings);
    assert_eq!(swinging(1.0, 1.0, "", EXACT).run.warnings, Vec::<String>::new());
    // A loss of less than a hundredth is none.
    let found = swinging(1.0, 1e-2, "", "radau = { stages = 2, step = 0.05 }");
    let (first, [least, _]) = (found.energy[0].total(), extremes(&found.energy));
    assert!(first - least > 1e-4 * first && first - least < 0.01 * first, "{least} of {first}");
    assert_eq!(found.run.warnings, Vec::<String>::new());
}

/// A rod that hangs has fallen by five joules, which no swing of some millijoules changes: shares
/// are of what changes.
#[test]
fn a_deep_potential_hides_no_loss() {
    let rod = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e4, mass_per_length = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -10]\n";
    let hanging = solved(&format!("{rod}analysis.static = {{}}\n"));
    let text = format!(
        "{rod}initial_velocity = [{{ beam = 'rod', rotation = 0.1 }}]
         analysis.dynamic = {{ duration = 2, output_every = 0.1, {LOSSY} }}\n"
    );
    let scene = parse("scene.toml", &text).expect("a legal scene");
    let options = Options { start: hanging.saved.as_ref(), ..Options::default() };
    let found = scene.model().solve_with(scene.analysis(), options).expect("a motion");
    let (first, [least, _]) = (&found.states().energy[0], extremes(&found.states().energy));
    near(first.potential, -5.0, 1e-3, "of 1 kg whose middle is 0.5 m below");
    near(first.kinetic, 0.5 * 0.01 / 3.0, 1e-6, "of the rotation");
    let lost = first.total() - least;
    assert!(lost > 0.1 * first.kinetic, "{lost} J of {} J", first.kinetic);
    let expected =
        format!("the motion has lost {lost:.2e} J, {:.2} of its largest energy", lost / first.kinetic);
    assert!(found.run().warnings[0].starts_with(&expected), "{expected}: {:?}", found.run().warnings);
}

/// Energies below 1e-20 EA L are those of round-off, about which nothing is said: 1e-12 J of a beam
/// of 100 m with 1e8 N are, 1e-8 J are not.
#[test]
fn energies_of_round_off_are_not_told() {
    let start = |speed: f64| swinging(100.0, speed, "", LOSSY);
    // ½ V² L/5
    for (energy, told) in [(1e-12, false), (1e-8, true)] {
        let found = start(f64::sqrt(0.1 * energy));
        near(found.energy[0].kinetic / energy, 1.0, 1e-6, "the energy at the start");
        assert_eq!(!found.run.warnings.is_empty(), told, "{energy} J: {:?}", found.run.warnings);
    }
}

/// Would catch counts that are of other steps, the largest step for the smallest, and a word for
/// several where there is one.
#[test]
fn divided_steps_are_counted_and_measured() {
    for (integrator, times) in [
        ("generalized_alpha = { step = 0.1, spectral_radius = 1.0 }", "1 time,"),
        ("gauss = { stages = 1, step = 0.1 }", "10 times,"),
    ] {
        let found = swinging(1.0, 1.0, "", integrator);
        let divided = found.run.statistics.rejected_steps;
        assert!(times.starts_with(&format!("{divided} ")), "{integrator}: {divided} divided steps");
        // Half of what was asked for was short enough.
        let expected = format!("the step was divided {times} down to 5.0e-2 s, because");
        let told = found.run.warnings.iter().find(|warning| warning.contains("divided")).expect("a warning");
        assert!(told.starts_with(&expected), "{told}");
    }
    let found = swinging(1.0, 1.0, "", "gauss = { stages = 1, tolerance = 1e-4 }");
    assert!(
        found.run.warnings.iter().all(|warning| !warning.contains("divided")),
        "{:?}",
        found.run.warnings
    );
}

/// A rod that falls onto a pin too soft to stop it: the pin is the second contact, and gives way
/// when the rod is at the height of its middle.
#[test]
fn what_gives_way_is_told_with_its_time() {
    for integrator in ["gauss.tolerance = 1e-5", "radau.step = 0.01"] {
        let found = solved(&format!(
            "beam.a = {{ start = [-0.54, 0.3], end = [0.46, 0.3], axial_stiffness = 1e5, bending_stiffness = 10, mass_per_length = 1, \
             basis.ancf.elements = 12 }}
             effect.gravity.acceleration = [0, -9.81]
             initial_velocity = [{{ beam = 'a', value = [0, -10] }}]
             effect.contact = [{{ beam = 'a', half_plane = {{ point = [0, -5], normal = [0, 1] }}, stiffness = 1e5 }}, \
             {{ beam = 'a', circle = {{ center = [0, -0.001], radius = 0.001 }}, stiffness = 1e7 }}]
             analysis.dynamic = {{ duration = 0.06, output_every = 0.02, {integrator} }}\n"
        ));
        let told = found.run.warnings.iter().find(|warning| warning.contains("gave way")).expect("a warning");
        assert!(told.starts_with("contact a.2 gave way at t = "), "{told}");
        // 0.301 m at 10 m/s and by its weight.
        let time = (f64::sqrt(100.0 + 2.0 * 9.81 * 0.301) - 10.0) / 9.81;
        near(between(told, "gave way at t = ", " s: the beam"), time, 2e-5, integrator);
        let [
            Event::Contact { time: from, touches: true, .. },
            Event::Contact { time: to, touches: false, .. },
        ] = &found.events[..]
        else {
            panic!("{:?}", found.events)
        };
        assert!(*from < time && time < *to, "{from} to {to}");
    }
}

/// A perfect column passes its critical loads π²/4, 9π²/4, 25π²/4 in EI/L²: each is told with its
/// factor of the load and the number of directions that are unstable then.
#[test]
fn stability_lost_is_told_with_its_load_and_directions() {
    let found = solved(
        "beam.column = { start = [0, 0], end = [0.6, 0.8], axial_stiffness = 1e7, bending_stiffness = 1, basis.ancf.elements = 16 }
        support = [{ beam = 'column', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'column', at = 'end', value = [-54, -72] }]
        analysis.static = {}\n",
    );
    assert_eq!(found.run.warnings.len(), 3, "{:?}", found.run.warnings);
    for (n, warning) in found.run.warnings.iter().enumerate() {
        let critical = (PI * (n as f64 + 0.5)).powi(2) / 90.0;
        let load = between(warning, "the tangent loses definiteness at load factor ", ":");
        near(load / critical, 1.0, 1e-3, warning);
        let directions = match n {
            0 => "0 unstable directions before, 1 after",
            1 => "1 unstable direction before, 2 after",
            _ => "2 unstable directions before, 3 after",
        };
        let advice = "beyond it the equilibrium found is unstable: a bifurcation or a limit point";
        assert!(warning.ends_with(&format!(": {directions}; {advice}")), "{warning}");
    }
}

/// A bar that is pushed through its flat position, by 1 m along x: N/EA = ℓ/ℓ₀ − 1 and P = N y/ℓ
/// have their extreme (1 − (1/ℓ₀)^⅔)^1½ EA. It is a state of the path, and told to the last digit.
#[test]
fn limit_points_are_states_of_the_path_and_told() {
    let found = solved(
        "beam.bar = { start = [0, 0], end = [1, 0.3], axial_stiffness = 1e4, bending_stiffness = 1e3, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }, { beam = 'bar', at = 'end', fix = ['x'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [0, -100] }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        analysis.static.arc_length = { until_probe = { probe = 'end', y = -0.29 }, max_step = 0.02 }\n",
    );
    let exact = 1e4 * (1.0 - 1.09_f64.powf(-1.0 / 3.0)).powf(1.5) / 100.0;
    let [lost, regained] = &found.run.warnings[..] else { panic!("{:?}", found.run.warnings) };
    let loads = || found.parameter.iter().copied();
    let (up, down) = (loads().fold(f64::NEG_INFINITY, f64::max), loads().fold(f64::INFINITY, f64::min));
    let load = between(lost, "the tangent loses definiteness at load factor ", ":");
    assert!((load - exact).abs() < 1e-6 && (up - exact).abs() < 1e-9, "{load} and {up}, of {exact}");
    assert!(lost.contains(": 0 unstable directions before, 1 after; beyond it"), "{lost}");
    let load = between(regained, "the tangent regains definiteness at load factor ", ":");
    assert!((load + exact).abs() < 1e-6 && (down + exact).abs() < 1e-9, "{load} and {down}, of {}", -exact);
    let rest = ": 1 unstable direction before, 0 after; the path is back on a more stable branch";
    assert!(regained.ends_with(rest), "{regained}");
}

/// Two rods that are hinged to each other and to the ground and grow: pressed by P = EA ε they
/// buckle n² π² EI/l² ≤ P times each, and stand beside the line as the one mechanism that there is.
#[test]
fn a_pressed_mechanism_is_told_with_its_unstable_directions() {
    let toggle = |strain: &str, steps: usize| {
        solved(&format!(
            "beam.a = {{ start = [0, 0], end = [0.5, 0], axial_stiffness = 3.364e8, bending_stiffness = 0.5893, mass_per_length = 1, basis.ancf.elements = 16 }}
             beam.b = {{ start = [0.5, 0], end = [1, 0], axial_stiffness = 3.364e8, bending_stiffness = 0.5893, mass_per_length = 1, basis.ancf.elements = 16 }}
             joint = [{{ type = 'hinge', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}]
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'b', at = 'end', fix = ['x', 'y'] }}]
             effect.gravity.acceleration = [0, 0.001]
             effect.actuation = [{{ beam = 'a', strain = {strain} }}, {{ beam = 'b', strain = {strain} }}]
             analysis.static.steps = {steps}\n"
        ))
        .run.warnings
    };
    let euler = PI * PI * 0.5893 / 0.25;
    for (strain, steps) in [("3e-7", 1), ("3e-7", 2), ("1e-6", 1)] {
        let load = 1.0 / steps as f64;
        let pressed = 3.364e8 * strain.parse::<f64>().expect("a number") * load;
        let unstable = 2 * (pressed / euler).sqrt() as usize + 1;
        let warnings = toggle(strain, steps);
        let told: Vec<&String> = warnings.iter().filter(|warning| warning.contains("presses")).collect();
        let [warning] = told[..] else { panic!("{warnings:?}") };
        let expected = format!(
            "the load up to factor {load:.6} presses the structure so that it is unstable in {unstable} directions where it stands, and \
             supports and joints leave it 1 to move in"
        );
        assert!(warning.starts_with(&expected), "{expected}: {warning}");
    }
    // By small steps it leaves its line before its rods are pressed by as much.
    assert_eq!(toggle("3e-7", 50), Vec::<String>::new());
}

/// What names velocities has no part in analyses without: would catch a name that is listed twice,
/// that is left out, and the name of another analysis.
#[test]
fn what_an_analysis_leaves_out_is_told_in_one_line() {
    let arm = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.spring = [{ beam = 'arm', at = 'end', damping = 1 }, { beam = 'arm', at = 0.5, damping = 2 }]\n";
    let velocity = "initial_velocity = [{ beam = 'arm', polynomial = { vy = [0, 0, 1] } }]\n";
    for (analysis, name) in [
        ("analysis.static = {}\n", "statics"),
        (
            "effect.force = [{ beam = 'arm', at = 'end', value = [-1, 0] }]\nanalysis.buckling.count = 1\n",
            "a buckling analysis",
        ),
        ("analysis.modal.count = 1\n", "a modal analysis"),
    ] {
        let rest = "which knows no velocities: [analysis.dynamic] computes the motion with all of it";
        let one = format!("`dashpot` of beam `arm` takes no part in {name}, {rest}");
        assert_eq!(solved(&format!("{arm}{analysis}")).run.warnings, [one]);
        let two = format!("`dashpot` of beam `arm`, `initial_velocity` take no part in {name}, {rest}");
        assert_eq!(solved(&format!("{arm}{velocity}{analysis}")).run.warnings, [two]);
    }
    let motion = "analysis.dynamic = { duration = 0.01, output_every = 0.01 }\n";
    let found = solved(&format!("{arm}{velocity}{motion}")).run.warnings;
    assert!(!found.iter().any(|told| told.contains("no part in")), "{found:?}");
}

/// What stretches or bends a beam without being a load takes no part in vibrations about its stress-free
/// state either.
#[test]
fn what_moves_and_pulls_takes_no_part_in_vibrations_about_the_stress_free_state() {
    let told = |support: &str, more: &str, analysis: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 32 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'arm', at = 'end', fix = ['x', 'y'] {support} }}]
             analysis.modal = {{ count = 1{analysis} }}\n{more}"
        );
        let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}")).run().warnings.clone()
    };
    let (moved, tendon) =
        (", move = { x = 0.01 }", "effect.tendon = [{ beam = 'arm', offset = 0.01, shortening = 0.001 }]");
    for (support, more, what) in
        [(moved, "", "`move` of supports"), ("", tendon, "`length` or `shortening` of tendons")]
    {
        let expected = format!("{what} take no part in vibrations about the stress-free state");
        let found = told(support, more, "");
        assert!(found.len() == 1 && found[0].starts_with(&expected), "{found:?}");
        assert!(told(support, more, ", about = 'equilibrium'").is_empty(), "{what}");
    }
    assert!(told("", "", "").is_empty());
}

/// Loads bend a column before it buckles: by the linear solution its end turns by λ F L²/2EI.
#[test]
fn bending_before_buckling_is_told_with_its_angle() {
    for (across, angle) in [(0.5, Some("0.62")), (0.1, Some("0.12")), (0.02, None)] {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1, basis.ancf.elements = 8 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'arm', at = 'end', value = [-1, {across}] }}]
             analysis.buckling.count = 1\n"
        );
        let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let found = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        let (load, warnings) = (found.eigenvalues()[0], &found.run().warnings);
        near(load, 0.25 * PI * PI, 1e-3, "the critical load");
        match angle {
            None => assert!(warnings.is_empty(), "{warnings:?}"),
            Some(angle) => {
                assert_eq!(angle, format!("{:.2}", 0.5 * load * across));
                let expected = format!(
                    "the loads turn the beam by {angle} rad before it buckles at load factor {load:.6}, by"
                );
                assert!(warnings[0].starts_with(&expected), "{expected}: {:?}", warnings);
            }
        }
    }
}

/// A taut string of 2 m, EA = 1000 N, under a force in its middle: a V with 2 EA (l − 1) y/l = P. One string has no kink there, and
/// says how far off it is; two on a hinge have one.
#[test]
fn a_kink_within_a_string_is_told_with_what_it_is_off_by() {
    let (axial, force) = (1000.0, 30.0);
    let residual = |y: f64| 2.0 * axial * (y.hypot(1.0) - 1.0) * y / y.hypot(1.0) - force;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if residual(middle) < 0.0 { low = middle } else { high = middle }
    }
    let ends = "support = [{ beam = 'a', at = 'start', fix = ['x', 'y'] }, { beam = 'b', at = 'end', fix = ['x', 'y'] }]\n\
                effect.force = [{ beam = 'b', at = 1.0, value = [0, -30] }]\nprobe = [{ name = 'p', beam = 'b', at = 1.0 }]\nanalysis.static = {}\n";
    for elements in [8, 40] {
        let one = format!(
            "beam.b = {{ start = [0, 0], end = [2, 0], axial_stiffness = {axial:?}, basis.ancf.elements = {elements} }}\n{}",
            ends.replace("beam = 'a'", "beam = 'b'")
        );
        let found = solved(&one);
        let told = found.run.warnings.iter().find(|warning| warning.contains("has a kink at s = 1.000000 m"));
        let told = between(told.expect("a kink"), "may be off by ", " m there");
        let off = (found.probes[0].samples.last().expect("a state").y + low).abs();
        assert!((0.3..3.0).contains(&(told / off)), "{told:e} m for {off:e} m with {elements} elements");
    }
    let piece = |name: &str, x: f64| {
        let end = x + 1.0;
        format!(
            "beam.{name} = {{ start = [{x:?}, 0], end = [{end:?}, 0], axial_stiffness = {axial:?}, basis.ancf.elements = 8 }}\n"
        )
    };
    let hinge = "joint = [{ type = 'hinge', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]\n";
    let two = [&piece("a", 0.0), &piece("b", 1.0), hinge, &ends.replace("at = 1.0", "at = 'start'")].concat();
    let found = solved(&two);
    assert!(found.run.warnings.is_empty(), "{:?}", found.run.warnings);
    near(found.probes[0].samples.last().expect("a state").y, -low, 1e-9, "the middle of two strings");
}

/// A pinned column on a foundation of k = 1e6 N/m² buckles at 2 √(k EI) = 2000 N in ten half-waves, of which eight cells know nothing: those
/// find other loads than the four that 2200 N pass, and say so. A column of as many cells on no foundation has long waves.
#[test]
fn waves_that_are_shorter_than_cells_are_told() {
    let warnings = |elements: usize, press: f64, foundation: &str| {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e9, bending_stiffness = 1, basis.ancf.elements = {elements} }}
            support = [{{ beam = 'b', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'b', at = 'end', fix = ['y'] }}]
            effect.force = [{{ beam = 'b', at = 'end', value = [{}, 0] }}]
            {foundation}analysis.static = {{}}\n",
            -press
        );
        let scene = parse("scene.toml", &text).expect("a scene");
        let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
        let told =
            results.run().warnings.iter().filter(|warning| warning.contains("might buckle in half-waves"));
        (told.cloned().collect::<Vec<_>>(), results.states().events.len())
    };
    let foundation = "effect.foundation = [{ beam = 'b', stiffness = [0, 1e6] }]\n";
    let (told, events) = warnings(8, 2200.0, foundation);
    assert!(told.len() == 1 && events != 4, "{events}, {told:?}");
    assert!(told[0].contains("of 0.0670 m, shorter than its cells of 0.1250 m"), "{told:?}");
    let (told, events) = warnings(64, 2200.0, foundation);
    assert_eq!((told.len(), events), (0, 4), "{told:?}");
    assert_eq!(warnings(8, 12.0, "").0.len(), 0);
}

/// Degrees that are taken for radians make 90/(2 π) turns of a quarter; one turn and less lie on nothing.
#[test]
fn an_arc_of_many_turns_is_told() {
    let arc = |to: &str| {
        solved(&format!(
            "beam.arm = {{ arc = {{ center = [0, 0], radius = 1, from = 0, to = {to} }}, axial_stiffness = 1e4, bending_stiffness = 1, \
             basis.ancf.elements = 40 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             analysis.static = {{}}\n"
        ))
        .run
        .warnings
    };
    for told in ["90", "-90"] {
        let found = arc(told);
        let expected = format!("beam `arm` is an arc of {:.2} turns", 90.0 / (2.0 * PI));
        assert!(found.iter().any(|text| text.starts_with(&expected)), "{told}: {found:?}");
    }
    for quiet in ["'90 deg'", "'360 deg'", "'-360 deg'"] {
        assert!(!arc(quiet).iter().any(|text| text.contains("turns")), "{quiet}");
    }
}
