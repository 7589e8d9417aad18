//! Tendons that run along a beam.

use super::{Written, near};
use ancf::scene::parse;

const EA: f64 = 2e3;
const EI: f64 = 0.4;

/// A cantilever of 0.5 m with a tendon on its left that is pulled with 5 N.
fn finger(basis: &str, tendon: &str, more: &str) -> String {
    format!(
        "beam.finger = {{ start = [0, 0], end = [0.5, 0], axial_stiffness = {EA}, bending_stiffness = {EI}, mass_per_length = 0.2, {basis} }}
        support = [{{ beam = 'finger', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.tendon = [{{ beam = 'finger', tension = '5 N', {tendon} }}]
        probe = [{{ name = 'tip', beam = 'finger', at = 'end' }}, {{ name = 'middle', beam = 'finger', at = 0.25 }}]
        output.section_forces = true
        {more}\n"
    )
}

const CABLE: &str = "basis.ancf.elements = 24";
const MESHFREE: &str = "basis.rpim.nodes = 14";
const STATIC: &str = "analysis.static = {}";

/// At a constant offset e the tendon presses the finger with −T and bends it with T e everywhere: an
/// arc of the curvature T e/EI, whose length is that of the finger less T/EA of it.
#[test]
fn a_tendon_at_a_constant_offset_makes_an_arc() {
    for basis in [CABLE, MESHFREE] {
        for offset in [0.15, -0.15] {
            let found = Written::of(&finger(basis, &format!("offset = {offset}"), STATIC));
            let (stretch, curvature) = (1.0 - 5.0 / EA, 5.0 * offset / EI);
            let radius = stretch / curvature;
            let turn = curvature * 0.5;
            let expected = [
                ("tip.x", radius * turn.sin()),
                ("tip.y", radius * (1.0 - turn.cos())),
                ("tip.angle", turn),
                ("middle.axial_force", -5.0),
                ("middle.shear_force", 0.0),
                ("middle.bending_moment", 5.0 * offset),
                ("middle.strain", stretch - 1.0),
            ];
            found.ends("probes.csv", &expected, 2e-5);
            // T (ℓ − L) with the tendon's length ℓ = (|r'| − e κ) L.
            let shortened = 0.5 * (stretch - offset * curvature - 1.0);
            near(found.last("energy.csv", "potential"), 5.0 * shortened, 1e-4, "potential");
        }
    }
}

/// Between 0.1 m and 0.3 m only, and nothing beyond: what was an arc is straight there.
#[test]
fn a_tendon_ends_where_it_is_told_to() {
    let found = Written::of(&finger(CABLE, "offset = '15 cm', from = '10 cm', to = '30 cm'", STATIC));
    let (stretch, curvature) = (1.0 - 5.0 / EA, 5.0 * 0.15 / EI);
    let (radius, turn) = (stretch / curvature, curvature * 0.2);
    let [x, y] =
        [0.1 + radius * turn.sin() + 0.2 * turn.cos(), radius * (1.0 - turn.cos()) + 0.2 * turn.sin()];
    found.ends("probes.csv", &[("tip.x", x), ("tip.y", y), ("tip.angle", turn)], 2e-5);
    let s = found.column("shape.csv", "s");
    for (column, inside) in [("axial_force", -5.0), ("bending_moment", 0.75), ("shear_force", 0.0)] {
        for (s, value) in s.iter().zip(found.column("shape.csv", column)) {
            if (s - 0.1).abs() > 1e-6 && (s - 0.3).abs() > 1e-6 {
                near(value, if (0.1..0.3).contains(s) { inside } else { 0.0 }, 1e-4, column);
            }
        }
    }
    // Each end has two rows: before and behind it.
    assert_eq!(s.iter().filter(|s| (**s - 0.1).abs() < 1e-9).count(), 2);
}

/// The offset e(s), with its slope.
type Offset = fn(f64) -> [f64; 2];

/// At an offset that varies, the forces on each section follow from the direction of the tendon alone:
/// with a = |r'| − e κ and p = √(a² + e'²), N = −T a/p, Q = −T e'/p and M = T e a/p, where κ = M/EI and
/// |r'| = 1 + N/EA. The angle and the place are integrals of these.
#[test]
fn a_tendon_at_an_offset_that_varies_pulls_along_its_direction() {
    let linear: Offset = |s| [0.2 - 0.3 * s, -0.3];
    let bent: Offset = |s| if s < 0.2 { [0.1 + 0.5 * s, 0.5] } else { [0.2 - 0.25 * (s - 0.2), -0.25] };
    let curved: Offset = |s| [0.05 + 0.4 * s - 0.7 * s * s, 0.4 - 1.4 * s];
    let kinks = "offset.table = { s = [0, 0.2, 0.5], value = [0.1, 0.2, 0.125] }";
    for (offset, text) in [
        (linear, "offset.table = { s = [0, 0.5], value = [0.2, 0.05] }"),
        (bent, kinks),
        (curved, "offset.polynomial = [0.05, 0.4, -0.7]"),
    ] {
        let section = |s: f64| {
            let [e, slope] = offset(s);
            let (mut stretch, mut curvature) = (1.0, 0.0);
            let mut forces = [0.0; 3];
            for _ in 0..60 {
                let along: f64 = stretch - e * curvature;
                let length = along.hypot(slope);
                forces = [-5.0 * along / length, -5.0 * slope / length, 5.0 * e * along / length];
                (stretch, curvature) = (1.0 + forces[0] / EA, forces[2] / EI);
            }
            (stretch, curvature, forces)
        };
        // By Simpson's rule; the kink at 0.2 m is a multiple of the step.
        let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0);
        let count = 1000;
        let h = 0.5 / f64::from(count);
        for i in 0..count {
            let at = |part: f64| section((f64::from(i) + part.clamp(1e-9, 1.0 - 1e-9)) * h);
            let (a, b, c) = (at(0.0), at(0.5), at(1.0));
            let half = angle + h / 24.0 * (5.0 * a.1 + 8.0 * b.1 - c.1);
            let end = angle + h / 6.0 * (a.1 + 4.0 * b.1 + c.1);
            x += h / 6.0 * (a.0 * f64::cos(angle) + 4.0 * b.0 * f64::cos(half) + c.0 * f64::cos(end));
            y += h / 6.0 * (a.0 * f64::sin(angle) + 4.0 * b.0 * f64::sin(half) + c.0 * f64::sin(end));
            angle = end;
        }
        for (basis, tolerance) in [("basis.ancf.elements = 40", 2e-5), ("basis.rpim.nodes = 24", 1e-4)] {
            let found = Written::of(&finger(basis, text, STATIC));
            found.ends("probes.csv", &[("tip.x", x), ("tip.y", y), ("tip.angle", angle)], tolerance);
            let (.., [axial, shear, moment]) = section(0.25);
            let forces = [
                ("middle.axial_force", axial),
                ("middle.shear_force", shear),
                ("middle.bending_moment", moment),
            ];
            found.ends("probes.csv", &forces, 5e-3);
        }
    }
}

/// A tendon on the centreline presses a column without bending it, and follows it when it bends: it
/// never buckles, and its vibrations are those without it.
#[test]
fn a_tendon_on_the_centreline_presses_and_does_not_buckle() {
    // 40 times what a dead force would need: π² EI/(4 L²) = 3.9 N.
    let hard = |analysis: &str| finger(CABLE, "offset = 0", analysis).replace("'5 N'", "'150 N'");
    let found = Written::of(&hard("analysis.static.steps = 3"));
    near(found.last("probes.csv", "tip.x"), 0.5 * (1.0 - 150.0 / EA), 1e-9, "x");
    near(found.last("probes.csv", "tip.y"), 0.0, 1e-12, "y");
    let slender = |tension: &str| {
        let scene = finger(CABLE, "offset = 0", "analysis.modal = { count = 3, about = 'equilibrium' }");
        Written::of(
            &scene.replace("'5 N'", tension).replace("axial_stiffness = 2000", "axial_stiffness = 2e7"),
        )
        .column("frequencies.csv", "frequency")
    };
    for (with, without) in slender("'150 N'").into_iter().zip(slender("'1e-9 N'")) {
        near(with, without, 1e-3 * without, "frequency");
    }
    let text = hard("analysis.buckling.count = 1").replace("output.section_forces = true", "");
    assert_eq!(Written::of(&text).column("load_factors.csv", "load_factor"), [0.0; 0]);
}

/// In a motion a law multiplies the tension, and what the tendon puts in is what the finger has.
#[test]
fn a_tendon_that_is_pulled_in_time_does_work() {
    let motion = "analysis.dynamic = { duration = 0.4, output_every = 0.02, gauss.tolerance = 1e-8 }";
    let tendon = "offset = '15 cm', in_time.smooth_ramp = { start = 0.05, duration = 0.2 }";
    let found = Written::of(&finger(CABLE, tendon, motion));
    let column = |name: &str| found.column("energy.csv", name);
    let largest = column("work").into_iter().fold(0.0, f64::max);
    assert!(largest > 0.1, "{largest}");
    // Less what was put in, nothing.
    for total in column("total") {
        near(total, 0.0, 1e-8 * largest, "total");
    }
}

/// The finger with a tendon of given length, in place of one that is pulled with 5 N.
fn held(basis: &str, tendon: &str, more: &str) -> String {
    finger(basis, tendon, more).replace("tension = '5 N', ", "")
}

/// A tendon at the offset e that is shorter by Δ pulls with T = Δ/(L (1/EA + e²/EI)): the same arc as
/// under this tension.
#[test]
fn a_tendon_of_given_length_has_the_tension_of_its_arc() {
    for basis in [CABLE, MESHFREE] {
        for offset in [0.15, -0.15] {
            let shortening = 5.0 * 0.5 * (1.0 / EA + offset * offset / EI);
            let length = 0.5 - shortening;
            for pull in [format!("shortening = {shortening}"), format!("length = {length}")] {
                let found = Written::of(&held(basis, &format!("offset = {offset}, {pull}"), STATIC));
                near(found.said("/tensions/0/tension"), 5.0, 1e-6, "tension");
                assert!(
                    found
                        .text("report.html")
                        .contains("<caption>Tendons of given length at load factor 1</caption>")
                );
                let turn = 5.0 * offset / EI * 0.5;
                let radius = (1.0 - 5.0 / EA) * 0.5 / turn;
                let expected = [
                    ("tip.x", radius * turn.sin()),
                    ("tip.y", radius * (1.0 - turn.cos())),
                    ("middle.axial_force", -5.0),
                    ("middle.bending_moment", 5.0 * offset),
                ];
                found.ends("probes.csv", &expected, 2e-5);
            }
        }
    }
    // On an arc of radius 1 m, which bends to the left, the way at the offset e is that of 1 − e.
    let arc_with = |offset: &str, length: f64| {
        let text = held("basis.ancf.elements = 60", &format!("{offset}, length = {length}"), STATIC);
        let line = "start = [0, 0], end = [0.5, 0]";
        text.replace(
            line,
            "arc = { center = [0, 1], radius = 1, from = '-90 deg', to = '-61.3521102435088 deg' }",
        )
    };
    let arc = |length: f64| arc_with("offset = 0.1", length);
    assert!(parse("arc.toml", &arc(0.45 + 1e-6)).unwrap_err().to_string().contains("would be slack"));
    near(Written::of(&arc(0.45 - 1e-9)).said("/tensions/0/tension"), 0.0, 1e-4, "tension of an arc");
    // At the offset e = 0.05 + 0.2 s it is that of √(u² + e'²) with u = 1 − e: by the integral of a hyperbola.
    let integral = |u: f64| 0.5 * (u * u.hypot(0.2) + 0.04 * (u / 0.2).asinh());
    let way = (integral(0.95) - integral(0.85)) / 0.2;
    let said = parse("arc.toml", &arc_with("offset.table = { s = [0, 0.5], value = [0.05, 0.15] }", 1.0));
    let said = said.expect_err("a slack tendon").to_string();
    assert!(said.contains(&format!("is {way:.9} m")), "{said}, not {way}");
}

/// If a tendon and the axis do not stretch, ∫(u' − e v'') ds = 0 keeps the direction of the tip: the beam
/// vibrates, and buckles, as one whose tip is guided.
#[test]
fn a_tendon_that_does_not_stretch_guides_the_tip() {
    let stiff = |more: &str| {
        held("basis.ancf.elements = 20", "offset = 0.2, shortening = 0", more)
            .replace("axial_stiffness = 2000", "axial_stiffness = 2e7")
            .replace("output.section_forces = true", "")
    };
    let found = Written::of(&stiff("analysis.modal.count = 2")).column("frequencies.csv", "frequency");
    // tan β + tanh β = 0 for β, in beam lengths.
    for (found, beta) in found.into_iter().zip([2.365_020_372_431_352_f64, 5.497_803_919_000_836]) {
        let omega = (beta / 0.5).powi(2) * (EI / 0.2).sqrt();
        near(found * std::f64::consts::TAU, omega, 1e-4 * omega, "ω");
    }
    let press =
        "effect.force = [{ beam = 'finger', at = 'end', value = [-1, 0] }]\nanalysis.buckling.count = 1";
    let found = Written::of(&stiff(press)).column("load_factors.csv", "load_factor");
    let critical = (std::f64::consts::PI / 0.5).powi(2) * EI;
    near(found[0], critical, 1e-3 * critical, "critical load");
}

/// A law multiplies what is pulled in, whatever integrates the motion; what the tendon puts in is what
/// the finger has.
#[test]
fn a_tendon_that_is_shortened_in_time_does_work() {
    let tendon = "offset = '15 cm', shortening = '60 mm', in_time.smooth_ramp.duration = 0.2";
    let mut tips = Vec::new();
    for method in ["gauss.tolerance = 1e-7", "radau.tolerance = 1e-6", "generalized_alpha.step = 1e-3"] {
        let motion = format!("analysis.dynamic = {{ duration = 0.3, output_every = 0.02, {method} }}");
        let found = Written::of(&held("basis.ancf.elements = 8", tendon, &motion));
        let column = |name: &str| found.column("energy.csv", name);
        let largest = column("work").into_iter().fold(0.0, f64::max);
        assert!(largest > 0.05, "{largest}");
        for total in column("total") {
            near(total, 0.0, 2e-4 * largest, method);
        }
        tips.push([found.last("probes.csv", "tip.x"), found.last("probes.csv", "tip.y")]);
    }
    for tip in &tips[1..] {
        near(tip[0], tips[0][0], 1e-4, "x by another integrator");
        near(tip[1], tips[0][1], 1e-4, "y by another integrator");
    }
}

/// A law that begins with a rate gives the beam at rest a velocity at once, whose energy is put in.
#[test]
fn a_tendon_that_is_pulled_at_once_puts_in_the_energy_of_its_jerk() {
    let tendon = "offset = '15 cm', shortening = '60 mm', in_time.harmonic.frequency = 1";
    let motion = "analysis.dynamic = { duration = 0.1, output_every = 0.02, gauss.tolerance = 1e-7 }";
    let found = Written::of(&held("basis.ancf.elements = 8", tendon, motion));
    let (work, kinetic) = (found.column("energy.csv", "work"), found.column("energy.csv", "kinetic"));
    assert!(kinetic[0] > 1e-8, "{}", kinetic[0]);
    near(work[0], kinetic[0], 1e-12, "put in at the start");
    for total in found.column("energy.csv", "total") {
        near(total, 0.0, 1e-5 * work[work.len() - 1], "total");
    }
}

/// Between stages a tendon keeps its length under other loads and in a motion, and lets go as it is; one
/// that comes to a bent beam is tightened from there.
#[test]
fn a_tendon_of_given_length_comes_and_goes_in_stages() {
    let stages = |tendon: &str, stages: &str| {
        let force = "effect.force = [{ beam = 'finger', at = 'end', value = [0, -0.3], stage = 'push' }]\n";
        held(CABLE, &format!("offset = 0.15, shortening = 0.02, {tendon}"), &format!("{force}{stages}"))
    };
    let stage = |name: &str| format!("[[stage]]\nname = '{name}'\nanalysis.static = {{}}\n");
    let swing = "[[stage]]\nname = 'swing'\nanalysis.dynamic = { duration = 0.02 }\n";
    let tip = |text: &str| {
        let scene = parse("finger.toml", text).unwrap_or_else(|error| panic!("{error}"));
        let run = ancf::run::solve_stages(scene.stages(), ancf::Options::default());
        assert!(run.failure.is_none(), "{:?}", run.failure);
        let results = run.results.last().expect("a stage");
        let sample = *results.states().probes[0].samples.last().expect("a state");
        ([sample.x, sample.y], results.run().tensions.first().map(|of| of.tension))
    };
    let [pull, push, rest] = ["pull", "push", "rest"].map(stage);
    let (both, tension) = tip(&stages("", &format!("{push}{rest}")));
    for (tendon, order) in [
        ("", format!("{pull}{push}")),
        ("", format!("{pull}{push}{swing}")),
        ("stage = 'rest'", format!("{push}{rest}")),
    ] {
        let (found, other) = tip(&stages(tendon, &order));
        near(found[0], both[0], 1e-8, "x");
        near(found[1], both[1], 1e-8, "y");
        near(other.unwrap_or_default(), tension.unwrap_or_default(), 1e-6, "tension");
    }
    let (free, none) = tip(&stages("until = 'rest'", &format!("{push}{rest}")));
    let (alone, _) = tip(&stages("", &push).replace("effect.tendon", "# effect.tendon"));
    assert_eq!(none, None);
    near(free[0], alone[0], 1e-8, "x without a tendon");
    near(free[1], alone[1], 1e-8, "y without a tendon");
}

#[test]
fn tendons_of_a_length_that_cannot_be_are_refused_or_told() {
    for (tendon, part) in [
        ("shortening = 0.01, tension = 3", "needs exactly one of `tension`, `length`, `shortening`"),
        ("length = 0.3, shortening = 0.01", "needs exactly one of"),
        ("", "needs exactly one of"),
        (
            "length = 0.6",
            "would be slack: it is 0.6 m long, and its way along the stress-free beam `finger` is 0.5",
        ),
        ("shortening = '-1 mm'", "would be slack"),
    ] {
        let said = parse("finger.toml", &held(CABLE, &format!("offset = 0.1, {tendon}"), STATIC));
        let said = said.expect_err(part).to_string();
        assert!(said.contains(part) && said.contains("finger.toml:3:"), "{said}");
    }
    let motion = "analysis.dynamic = { duration = 0.1 }";
    let sudden =
        parse("finger.toml", &held(CABLE, "offset = 0.1, shortening = 0.01", motion)).expect("a scene");
    let said = ancf::accuracy::run(&sudden, ancf::Options::default()).expect_err("a jump").to_string();
    assert!(said.contains("a tendon of beam `finger` is 1.000e-2 m too long"), "{said}");
    // However small the forces are.
    for force in [1.0, 1e-4] {
        let up = format!("effect.force = [{{ beam = 'finger', at = 'end', value = [0, {force}] }}]\n");
        let tendon = format!("offset = 0.1, shortening = {}", 1e-4 * force);
        let slack = held(CABLE, &tendon, &format!("{up}{STATIC}"));
        let said = Written::of(&slack).summary()["warnings"].to_string();
        assert!(said.contains("pushes with") && said.contains("it would be slack there"), "{said}");
    }
    // Twice the same length: neither tension is known.
    let one = "{ beam = 'finger', offset = 0.1, shortening = 0.01 }";
    let twice = held(CABLE, "offset = 0.1, shortening = 0.01", STATIC);
    let twice = twice.replace("shortening = 0.01 }]", &format!("shortening = 0.01 }}, {one}]"));
    let twice = parse("finger.toml", &twice).expect("a scene");
    let said = ancf::accuracy::run(&twice, ancf::Options::default()).expect_err("redundant").to_string();
    assert!(said.contains("a tendon of beam `finger` and a tendon of beam `finger`"), "{said}");
}

#[test]
fn tendons_that_cannot_be_are_refused_or_told() {
    let section = |tendon: &str, section: &str| {
        finger(CABLE, tendon, STATIC).replace(
            &format!("axial_stiffness = {EA}, bending_stiffness = {EI}, mass_per_length = 0.2"),
            section,
        )
    };
    let round = "section.circle.diameter = '20 mm', youngs_modulus = '1 MPa', density = 1000";
    for (text, part) in [
        (
            section("offset = '11 mm'", round),
            "leaves the section of beam `finger` at s = 0.000000 m: its offset is 1.1000e-2 m",
        ),
        (section("offset.table = { s = [0, 0.5], value = [0, -0.02] }", round), "leaves the section"),
        (section("offset = '9 mm', from = 0.3, to = 0.2", round), "has no length"),
        (
            section("offset.pieces = { until = [0.2], value = [0.001, 0.002] }", round),
            "jumps to another offset at s = 0.2 m",
        ),
        (section("offset = '1 mm'", "axial_stiffness = 100, mass_per_length = 1"), "is a string"),
    ] {
        let said = parse("finger.toml", &text).expect_err(part).to_string();
        assert!(said.contains(part) && said.contains("finger.toml:3:"), "{said}");
    }
    assert!(parse("finger.toml", &section("offset = '-10 mm'", round)).is_ok());
    // A law that becomes negative, and a bend about a centre within the tendon.
    let pushing = "offset = 0.1, in_time.harmonic = { frequency = '1 Hz' }";
    let motion = "analysis.dynamic = { duration = 1, output_every = 0.25 }";
    let warned = |text: &str| Written::of(text).summary()["warnings"].to_string();
    let said = warned(&finger(CABLE, pushing, motion));
    assert!(
        said.contains("a tendon of beam `finger` pushes with 1.0000 times its tension at 0.75"),
        "{said}"
    );
    let folded = finger(CABLE, "offset = 0.15", "analysis.static.steps = 10").replace("'5 N'", "'18 N'");
    let said = warned(&folded);
    assert!(said.contains("about a centre that lies between it and its tendon"), "{said}");
    assert_eq!(warned(&finger(CABLE, "offset = 0.15", STATIC)), "[]");
}
