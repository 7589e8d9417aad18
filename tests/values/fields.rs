//! Forces that depend on the place.

use super::{Written, near};
use ancf::scene::parse;
use std::f64::consts::TAU;

/// A rigid rod of 2 m and 3 kg in the plane.
fn rod(field: &str, more: &str) -> String {
    format!(
        "beam.rod = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e7, bending_stiffness = 1e6, mass_per_length = 1.5, basis.ancf.elements = 3 }}
        effect.force_field = [{{ beam = 'rod', {field} }}]
        probe = [{{ name = 'start', beam = 'rod', at = 'start' }}, {{ name = 'end', beam = 'rod', at = 'end' }}]
        {more}\n"
    )
}

const GUIDED: &str = "support = [{ beam = 'rod', at = 'start', fix = ['x', 'angle'] }]";

/// Springs are fields, too: in the potential ½ k (y − y₀)² a rod comes to rest at y₀, and has lost
/// ½ k y₀² a length.
#[test]
fn a_potential_pulls_down_its_slope() {
    for (field, y) in [
        ("potential = '20*(y-0.25)^2'", 0.25),
        ("value = ['0', '10-40*y']", 0.25),
        ("potential = '20*(y-0.25)^2', from = 0.5, to = 1.5", 0.25),
    ] {
        let found = Written::of(&rod(field, &format!("{GUIDED}\nanalysis.static = {{}}")));
        near(found.last("probes.csv", "end.y"), y, 1e-7, field);
        let stored = if field.contains("potential") { -20.0 * y * y } else { 0.0 };
        let length = if field.contains("from") { 1.0 } else { 2.0 };
        near(found.last("energy.csv", "potential"), stored * length, 1e-6, field);
    }
}

/// The tangent is exact: a rod in the potential ½ k y² swings with √(k/ρA), whatever the analysis.
#[test]
fn a_potential_has_its_stiffness() {
    let field = "potential = '0.5*60*y^2 + 7*x'";
    let modal = Written::of(&rod(
        field,
        &format!("{GUIDED}\nanalysis.modal = {{ count = 1, about = 'equilibrium' }}"),
    ));
    near(modal.last("frequencies.csv", "frequency") * TAU, (60.0_f64 / 1.5).sqrt(), 1e-6, "ω");
    let motion = rod(
        field,
        &format!(
            "{GUIDED}\ninitial_velocity = [{{ beam = 'rod', value = [0, 0.3] }}]\nanalysis.dynamic = {{ duration = 0.5, output_every = 0.1 }}"
        ),
    );
    let found = Written::of(&motion);
    let omega = (60.0_f64 / 1.5).sqrt();
    near(found.last("probes.csv", "end.y"), 0.3 / omega * (omega * 0.5).sin(), 1e-6, "y");
    for total in found.column("energy.csv", "total") {
        // Radau's method damps by as much as its tolerance allows.
        near(total, 0.5 * 3.0 * 0.09, 1e-5, "total");
    }
}

/// What has no potential does work: a rod in a vortex (−y, x) k/2 is turned by the moment ∫ k s²/2 ds,
/// which the law of time halves.
#[test]
fn a_vortex_turns_a_rod() {
    let motion = "support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]
        analysis.dynamic = { duration = 0.02, output_every = 0.02 }";
    let found = Written::of(&rod("value = ['-1.5*y', '1.5*x'], in_time.polynomial = [0.5]", motion));
    // 0.75 ∫ s² ds over 1.5 ∫ s² ds.
    near(found.last("probes.csv", "end.angle"), 0.5 * 0.5 * 0.02 * 0.02, 1e-8, "angle");
    near(found.last("energy.csv", "work"), found.last("energy.csv", "kinetic"), 1e-8, "work");
}

#[test]
fn formulas_that_cannot_be_read_are_told_with_their_place() {
    for (field, part) in [
        ("potential = '20*z'", "it cannot contain `z`: it knows x, y, pi"),
        ("value = ['x', 'y^2^2']", "a power of a power"),
        ("potential = 'x', value = ['x', 'y']", "exactly one of `potential`, `value`"),
        ("from = 0.5", "exactly one of `potential`, `value`"),
    ] {
        let said = parse("field.toml", &rod(field, &format!("{GUIDED}\nanalysis.static = {{}}")))
            .expect_err(field)
            .to_string();
        assert!(said.contains(part) && said.contains("field.toml:2:"), "{said}");
    }
}
