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
