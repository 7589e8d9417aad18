//! What acts on a stretch of a beam, or by values that vary along it. Expected are resultants and
//! deflections by hand.

use super::{SECOND, Written, near};
use ancf::scene::parse;

const ARM: &str =
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 100, \
    mass_per_length = 2, basis.ancf.elements = 9 }
    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
    probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\noutput.reactions = true\n";

/// q between 0.25 and 0.7 m of a cantilever: the support carries q (b − a) and q (b² − a²)/2, and the
/// tip gives way by q/(6 EI) [s³ L − s⁴/4]. A load that grows as s has the resultant (b² − a²)/2.
///
/// Would catch a load on whole cells only, and `from` and `to` that are swapped or forgotten.
#[test]
fn a_distributed_force_acts_from_one_place_to_another() {
    let (a, b) = (0.25_f64, 0.7_f64);
    let text = |value: &str| {
        format!(
            "{ARM}effect.distributed_force = [{{ beam = 'arm', value = {value}, from = '25 cm', to = 0.7 }}]\nanalysis.static = {{}}\n"
        )
    };
    let found = Written::of(&text("[0, -0.3]"));
    let resultant = 0.3 * (b - a);
    found.ends(
        "reactions.csv",
        &[("support1.fy", resultant), ("support1.moment", 0.15 * (b * b - a * a))],
        1e-7,
    );
    let primitive = |s: f64| s.powi(3) - s.powi(4) / 4.0;
    found.ends("probes.csv", &[("tip.y", -0.3 / 600.0 * (primitive(b) - primitive(a)))], 1e-8);
    let shear = found.column("shape.csv", "shear_force");
    // Of 201 even places: before the load, in its middle, and behind it.
    for (place, expected) in [(40, -resultant), (95, -0.3 * (0.7 - 0.475)), (150, 0.0)] {
        near(shear[place], expected, 1e-7, "shear_force");
    }
    let found =
        Written::of(&text("[{ polynomial = [0, 2] }, { table = { s = [0, 1], value = [0, '-1 N/m'] } }]"));
    found.ends(
        "reactions.csv",
        &[("support1.fx", -(b * b - a * a)), ("support1.fy", 0.5 * (b * b - a * a))],
        1e-6,
    );
}

/// A curvature between 0.3 and 0.7 m turns the tip by its integral, a strain moves it by its own.
#[test]
fn actuation_bends_a_stretch() {
    let text = |what: &str| {
        format!("{ARM}effect.actuation = [{{ beam = 'arm', {what} }}]\nanalysis.static = {{}}\n")
    };
    let bent = Written::of(&text("curvature = 0.02, from = 0.3, to = 0.7"));
    bent.ends("probes.csv", &[("tip.angle", 0.008), ("tip.y", 0.004)], 1e-6);
    bent.ends("energy.csv", &[("bend", 0.0), ("total", 0.0)], 1e-9);
    let curvature = bent.column("shape.csv", "curvature");
    for (place, expected) in [(40, 0.0), (100, 0.02), (160, 0.0)] {
        near(curvature[place], expected, 1e-5, "curvature");
    }
    let grown =
        Written::of(&text("strain = { table = { s = [0, 0.5, 1], value = [0, 1e-3, 0] } }, from = 0.5"));
    grown.ends("probes.csv", &[("tip.x", 1.00025), ("tip.y", 0.0)], 1e-8);
}

/// A stiff rod on a bed of 50 N/m² below 0.2 to 0.6 m, pressed in the middle of that, gives way by
/// F/(k 0.4).
#[test]
fn a_foundation_carries_a_stretch() {
    let text = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e5, basis.ancf.elements = 7 }
        effect.foundation = [{ beam = 'rod', stiffness = [10, { polynomial = [50] }], from = 0.2, to = 0.6 }]
        effect.force = [{ beam = 'rod', at = 0.4, value = [0.02, -0.1] }]
        probe = [{ name = 'middle', beam = 'rod', at = 0.4 }]\nanalysis.static = {}\n";
    let found = Written::of(text);
    found.ends("probes.csv", &[("middle.x", 0.4 + 0.005), ("middle.y", -0.005), ("middle.angle", 0.0)], 1e-6);
}

/// A flow and a fluid on a stretch of a stiff arm, by what the support carries.
#[test]
fn a_fluid_wets_a_stretch() {
    let text = "effect.drag = [{ beam = 'arm', viscous_normal = 0.5, normal = { table = { s = [0, 1], value = [1, 3] } }, flow = [0, 0.2], from = 0.5 }]
        effect.gravity.acceleration = [0, -10]
        effect.buoyancy = [{ beam = 'arm', displaced_mass_per_length = { pieces = { until = [0.5], value = [1, 2] } }, to = '75 cm' }]
        analysis.static = {}\n";
    let found = Written::of(&format!("{ARM}{text}"));
    // 0.5 · 0.5 u + ∫ (1 + 2 s) ds u², u = 0.2; the weight is 20 N, the lift 10 (0.5 + 0.5).
    let drag = 0.05 + (0.5 + 0.75) * 0.04;
    found.ends("reactions.csv", &[("support1.fy", 20.0 - 10.0 - drag)], 1e-3);
}

/// A rod that is held upright slows by α on 0.4 of its length.
#[test]
fn damping_of_a_stretch_takes_its_part() {
    let text = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e9, bending_stiffness = 1e9, mass_per_length = 2, basis.ancf.elements = 5 }
        support = [{ beam = 'rod', at = 'start', fix = ['x', 'angle'] }]
        probe = [{ name = 'end', beam = 'rod', at = 'end' }]
        effect.damping = [{ beam = 'rod', mass_proportional = 3, from = 0.6 }]
        initial_velocity = [{ beam = 'rod', value = [0, 1] }]\n";
    let found = Written::of(&format!("{text}{SECOND}"));
    found.ends("probes.csv", &[("end.vy", f64::exp(-1.2))], 1e-4);
}

/// Two stretches that meet are one: each effect on both is that effect on the whole beam.
#[test]
fn stretches_that_meet_are_the_whole() {
    let motion = "effect.force = [{ beam = 'arm', at = 'end', value = [3, -5] }]
        effect.gravity.acceleration = [1, -9.81]
        analysis.dynamic = { duration = 0.2, radau.step = 0.01 }\n";
    for (table, what) in [
        ("distributed_force", "value = [4, 7], follower = true"),
        ("actuation", "strain = 0.01, curvature = 0.4"),
        ("foundation", "stiffness = [30, 80]"),
        (
            "drag",
            "normal = 3, tangential = 0.4, viscous_normal = 2, viscous_tangential = 0.7, flow = [0.3, -0.4]",
        ),
        ("buoyancy", "displaced_mass_per_length = 1.5"),
        ("damping", "mass_proportional = 2, stiffness_proportional = 0.01"),
        ("damping", "strain = 0.02, curvature = 0.003"),
    ] {
        let run = |stretches: &[&str]| {
            let parts: Vec<String> =
                stretches.iter().map(|ends| format!("{{ beam = 'arm', {what}{ends} }}")).collect();
            let found = Written::of(
                &format!("{ARM}effect.{table} = [{}]\n{motion}", parts.join(", "))
                    .replace("elements = 9", "elements = 5"),
            );
            ["tip.x", "tip.y", "tip.angle"].map(|name| found.last("probes.csv", name))
        };
        let (whole, parts) = (run(&[""]), run(&[", to = 0.4", ", from = 0.4"]));
        for (a, b) in whole.into_iter().zip(parts) {
            near(a, b, 1e-9, &format!("{table}: {what}"));
        }
        let half = run(&[", to = 0.4"]);
        assert!((half[1] - whole[1]).abs() > 1e-6, "{table}: {what}: {half:?} {whole:?}");
    }
}

#[test]
fn impossible_stretches_are_refused() {
    for (ends, said) in [
        ("from = 0.5, to = 0.2", "a stretch from 0.5 m to 0.2 m has no length"),
        ("from = 'end'", "has no length"),
        ("to = 1.5", "arc length 1.5 m is not on beam `arm`"),
    ] {
        let text = format!(
            "{ARM}effect.distributed_force = [{{ beam = 'arm', value = [0, 1], {ends} }}]\nanalysis.static = {{}}\n"
        );
        let error = parse("arm.toml", &text).expect_err(ends).to_string();
        assert!(error.contains(said) && error.contains("arm.toml:5:"), "{ends}: {error}");
    }
    let soft = format!(
        "{ARM}effect.foundation = [{{ beam = 'arm', stiffness = [0, {{ polynomial = [1, -2] }}] }}]\nanalysis.static = {{}}\n"
    );
    let error = parse("arm.toml", &soft).expect_err("negative").to_string();
    assert!(error.contains("a foundation needs a positive stiffness"), "{error}");
}
