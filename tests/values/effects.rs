//! What acts on beams besides loads: springs, masses, damping, foundations, fluids. Expected are
//! systems of one degree of freedom, and columns of `effects.csv` with them.

use super::{ROD, SECOND, Written, near};

/// Velocities along and across an inclined rod in a flow fall as those of a point: exp(−c t/ρA) of
/// what is viscous, 1/(1 + C |u₀| t/ρA) of what is quadratic.
///
/// Would catch coefficients along and across that are swapped, viscous ones that are quadratic, and
/// a flow that is reversed or forgotten.
#[test]
fn drag_slows_a_rod_along_and_across_by_its_own_coefficients() {
    // t = (0.8, 0.6), n = (−0.6, 0.8), ρA = 2 kg/m, 1 m.
    let rod =
        "beam.rod = { start = [0, 0], end = [0.8, 0.6], axial_stiffness = 1e6, bending_stiffness = 1e4, \
        mass_per_length = 2, basis.ancf.elements = 2 }
        probe = [{ name = 'middle', beam = 'rod', at = 0.5 }]\noutput.effects = true\n";
    let flow = [1.2, -0.4];
    let viscous = |c: f64| move |u: f64, t: f64| u * f64::exp(-c * t / 2.0);
    let quadratic = |c: f64| move |u: f64, t: f64| u / (1.0 + c * u.abs() * t / 2.0);
    for (drag, fall, force) in [
        (
            "viscous_tangential = 0.3, viscous_normal = 0.9",
            [&viscous(0.3) as &dyn Fn(f64, f64) -> f64, &viscous(0.9)],
            [&(|u: f64| 0.3 * u) as &dyn Fn(f64) -> f64, &|u| 0.9 * u],
        ),
        (
            "tangential = 0.5, normal = 1.7",
            [&quadratic(0.5), &quadratic(1.7)],
            [&|u| 0.5 * u * u.abs(), &|u| 1.7 * u * u.abs()],
        ),
    ] {
        for flows in [true, false] {
            let fluid = if flows { flow } else { [0.0; 2] };
            let said = if flows { ", flow = ['1.2 m/s', -0.4]" } else { "" };
            let found = Written::of(&format!(
                "{rod}effect.drag = [{{ beam = 'rod', {drag}{said} }}]\n\
                 initial_velocity = [{{ beam = 'rod', value = [0.5, 1.0] }}]\n{SECOND}"
            ));
            let (u, w) = (0.5 - fluid[0], 1.0 - fluid[1]);
            let [along, across] = [0.8 * u + 0.6 * w, 0.8 * w - 0.6 * u];
            let (a, b) = (fall[0](along, 1.0), fall[1](across, 1.0));
            let velocity = [fluid[0] + 0.8 * a - 0.6 * b, fluid[1] + 0.6 * a + 0.8 * b];
            found.ends("probes.csv", &[("middle.vx", velocity[0]), ("middle.vy", velocity[1])], 1e-6);
            let (f, g) = (-force[0](a), -force[1](b));
            let forces = [("drag.rod.fx", 0.8 * f - 0.6 * g), ("drag.rod.fy", 0.6 * f + 0.8 * g)];
            found.ends("effects.csv", &forces, 1e-6);
            if !flows {
                // What is lost is what is missing of ½ m v², m = 2 kg.
                let lost = 1.25 - velocity[0].powi(2) - velocity[1].powi(2);
                found.ends("energy.csv", &[("lost", lost), ("kinetic", 1.25 - lost), ("total", 1.25)], 1e-6);
                near(found.said("/energy/lost"), lost, 1e-6, "lost");
            }
        }
    }
}

/// A flow presses a clamped stiff rod with (c + C |u|) u per length, in statics too.
#[test]
fn a_flow_presses_on_its_supports() {
    let text = "beam.rod = { start = [0, 0], end = [2, 0], axial_stiffness = 1e7, bending_stiffness = 1e6, basis.ancf.elements = 2 }
        support = [{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.drag = [{ beam = 'rod', tangential = 0.5, normal = 1.5, viscous_tangential = 0.25, viscous_normal = 2, flow = [3, -2] }]
        output = { reactions = true, effects = true }
        analysis.static = {}\n";
    let found = Written::of(text);
    // Per length 0.25 · 3 + 0.5 · 9 along, −(2 · 2 + 1.5 · 4) across; 2 m.
    let (x, y) = (10.5, -20.0);
    let expected = [("support1.fx", -x), ("support1.fy", -y), ("support1.moment", -y)];
    found.ends("reactions.csv", &expected, 1e-3);
    found.ends("effects.csv", &[("drag.rod.fx", x), ("drag.rod.fy", y)], 1e-3);
}

/// A bar on rollers along x is pulled against a spring: F = k (ℓ − ℓ₀). Would catch another default
/// of ℓ₀ than the stress-free length, one that is ignored, and the wrong sign of the force.
#[test]
fn springs_pull_by_what_they_are_longer() {
    let bar = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e9, bending_stiffness = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['y'] }, { beam = 'bar', at = 'end', fix = ['y'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = ['2 N', 0] }]
        probe = [{ name = 'start', beam = 'bar', at = 'start' }]
        output.effects = true
        analysis.static = {}\n";
    for (spring, x, energy) in [
        // From (−0.5, 0): 0.5 m long as it is.
        ("anchor = [-0.5, 0], stiffness = '40 N/m'", 0.05, 0.05),
        ("anchor = [-0.5, 0], length = '30 cm', stiffness = 40", -0.15, 0.05),
        ("stiffness = 40", 0.05, 0.05),
    ] {
        let found =
            Written::of(&format!("{bar}effect.spring = [{{ beam = 'bar', at = 'start', {spring} }}]\n"));
        near(found.last("probes.csv", "start.x"), x, 1e-8, spring);
        let expected = [("spring.bar.energy", energy), ("spring.bar.fx", -2.0), ("spring.bar.fy", 0.0)];
        found.ends("effects.csv", &expected, 1e-7);
        near(found.last("energy.csv", "stored"), energy, 1e-8, spring);
        near(found.said("/energy/stored"), energy, 1e-8, spring);
    }
    // Across its line a spring with an anchor does nothing; along it, from (0, −1), it holds with k
    // y.
    let lift = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e9, bending_stiffness = 1e6, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [0, 3e-3] }]
        effect.spring = [{ beam = 'bar', at = 0.5, anchor = [0.5, -1], stiffness = 12 }]
        effect.torsion_spring = [{ beam = 'bar', at = 'start', stiffness = '7 N m' }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        output.effects = true
        analysis.static = {}\n";
    let found = Written::of(lift);
    // Moments about the start: 3e-3 = (7 + 12/4) θ.
    found.ends("probes.csv", &[("end.angle", 3e-4), ("end.y", 3e-4)], 1e-8);
    let expected = [
        ("torsion_spring.bar.energy", 0.5 * 7.0 * 9e-8),
        ("spring.bar.energy", 0.5 * 12.0 * 2.25e-8),
        ("spring.bar.fy", -12.0 * 1.5e-4),
    ];
    found.ends("effects.csv", &expected, 1e-8);
}

/// Dashpots and damping in proportion to the mass let a velocity die as exp(−c t/m).
#[test]
fn dashpots_take_a_velocity_by_their_coefficients() {
    let cross = "[0.3, 0.4]";
    for (acts, rate) in [
        // 2 kg along x; of 0.8 N s/m at both ends.
        (
            "effect.spring = [{ beam = 'rod', at = 'start', damping = '0.8 N s/m' }, \
             { beam = 'rod', at = 'end', damping = 0.8 }]\n",
            [0.8, 0.8],
        ),
        // Along the line to a far anchor on the x axis alone, in the middle.
        ("effect.spring = [{ beam = 'rod', at = 0.5, anchor = [-1e6, 0], damping = 0.8 }]\n", [0.4, 0.0]),
        ("effect.damping = [{ beam = 'rod', mass_proportional = '0.6 1/s' }]\n", [0.6, 0.6]),
    ] {
        let moves = format!("initial_velocity = [{{ beam = 'rod', value = {cross} }}]\n");
        let found = Written::of(&format!("{ROD}{acts}{moves}{SECOND}"));
        let [vx, vy] = [0.3 * f64::exp(-rate[0]), 0.4 * f64::exp(-rate[1])];
        let [x, y] = [(0.3, rate[0]), (0.4, rate[1])]
            .map(|(v, rate)| if rate == 0.0 { v } else { v * (1.0 - f64::exp(-rate)) / rate });
        found.ends("probes.csv", &[("middle.x", 0.5 + x), ("middle.y", y)], 1e-5);
        // Braked so suddenly it vibrates a little.
        found.ends("probes.csv", &[("middle.vx", vx), ("middle.vy", vy)], 5e-4);
        found.ends("energy.csv", &[("lost", 0.25 - vx * vx - vy * vy)], 1e-5);
    }
}

/// A couple turns a rod by M t²/2I, and a dashpot brings its turning to rest: every inertia counts
/// with its own factor.
#[test]
fn inertias_add_up_in_a_rod_that_turns() {
    // 2/12 of the rod, 0.05 about the middle's point, 0.03 · 1 m of sections, 2 · 0.1 kg at 0.5 m,
    // in kg m².
    let inertia = 2.0 / 12.0 + 0.05 + 0.03 + 2.0 * 0.1 * 0.25;
    let masses = "effect.rotary_inertia = [{ beam = 'rod', per_length = '0.03 kg m' }]
        effect.point_mass = [{ beam = 'rod', at = 0.5, rotary_inertia = '0.05 kg m^2' }, \
        { beam = 'rod', at = 'start', mass = '100 g' }, { beam = 'rod', at = 'end', mass = 0.1 }]\n";
    let moment = "effect.moment = [{ beam = 'rod', at = 0.5, value = '0.02 N m' }]\n";
    let found = Written::of(&format!("{ROD}{masses}{moment}{SECOND}"));
    let angle = 0.02 / inertia / 2.0;
    near(found.last("probes.csv", "middle.angle"), angle, 2e-6, "angle");
    // What the couple has done is its moment times the angle, and all of it is kinetic.
    found.ends("energy.csv", &[("work", 0.02 * angle), ("kinetic", 0.02 * angle), ("total", 0.0)], 1e-7);
    near(found.said("/energy/work"), 0.02 * angle, 1e-7, "work");
    let dashpot = "effect.torsion_spring = [{ beam = 'rod', at = 0.5, damping = '0.1 N m s' }]
        initial_velocity = [{ beam = 'rod', rotation = 0.02, about = [0.5, 0] }]\n";
    let found = Written::of(&format!("{ROD}{masses}{dashpot}{SECOND}"));
    let turned = 0.02 * (1.0 - f64::exp(-0.1 / inertia)) * inertia / 0.1;
    near(found.last("probes.csv", "middle.angle"), turned, 1e-6, "angle");
}

/// A light bar under a load that begins at once creeps as exp(−t/η) to its equilibrium, whichever
/// the measure of strain.
///
/// Would catch a coefficient that is doubled, of one measure alone or of bending, and strain for
/// curvature.
#[test]
fn bars_and_beams_creep_by_their_retardation() {
    for measure in ["green", "engineering"] {
        for (damping, strain, curvature) in
            [("strain = '400 ms', curvature = 0.8", 0.4, 0.8), ("stiffness_proportional = 0.5", 0.5, 0.5)]
        {
            let text = format!(
                "beam.bar = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 10, \
                 mass_per_length = 1e-5, strain = '{measure}', basis.ancf.elements = 2 }}
                 support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
                 effect.force = [{{ beam = 'bar', at = 'end', value = [0.01, 0] }}]
                 effect.moment = [{{ beam = 'bar', at = 'end', value = 0.01 }}]
                 effect.damping = [{{ beam = 'bar', {damping} }}]
                 probe = [{{ name = 'end', beam = 'bar', at = 'end' }}]\n{SECOND}"
            );
            let found = Written::of(&text);
            let [e, k] = [strain, curvature].map(|eta: f64| 1.0 - f64::exp(-1.0 / eta));
            near(found.last("probes.csv", "end.strain") / 1e-5, e, 2e-3, &text);
            near(found.last("probes.csv", "end.curvature") / 1e-3, k, 2e-3, &text);
            // ∫ EA η ε̇² = F²/2EA (1 − exp(−2 t/η)), and likewise of the bending.
            let [e, k] = [strain, curvature].map(|eta: f64| 0.5 * (1.0 - f64::exp(-2.0 / eta)));
            let lost = 1e-7 * e + 1e-5 * k;
            near(found.last("energy.csv", "lost") / lost, 1.0, 5e-3, &text);
        }
    }
}

/// A free rod under an even load sinks into a foundation by q/k along each axis.
#[test]
fn a_foundation_gives_way_along_each_axis_by_its_own_stiffness() {
    let text = format!(
        "{ROD}effect.foundation = [{{ beam = 'rod', stiffness = ['40 N/m^2', 100] }}]
         effect.distributed_force = [{{ beam = 'rod', value = ['2 N/m', -3] }}]
         output.effects = true\nanalysis.static = {{}}\n"
    );
    let found = Written::of(&text);
    found.ends("probes.csv", &[("middle.x", 0.55), ("middle.y", -0.03)], 1e-8);
    let energy = 0.5 * (2.0 * 0.05 + 3.0 * 0.03);
    let expected = [
        ("foundation.rod.energy", energy),
        ("foundation.rod.fx", -2.0),
        ("foundation.rod.fy", 3.0),
        ("distributed_force.rod.energy", -2.0 * 0.05 - 3.0 * 0.03),
        ("distributed_force.rod.fx", 2.0),
        ("distributed_force.rod.fy", -3.0),
    ];
    found.ends("effects.csv", &expected, 1e-7);
}

/// What would bend and stretch a beam by itself presses its clamps: N = −EA ε₀ and M = −EI κ₀ where
/// neither is allowed, for both measures of strain.
#[test]
fn held_actuation_presses_with_the_opposite_sign() {
    for measure in ["engineering", "green"] {
        let text = format!(
            "beam.bar = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e3, bending_stiffness = 5, strain = '{measure}', \
             basis.ancf.elements = 4 }}
             support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}, \
             {{ beam = 'bar', at = 'end', fix = ['x', 'y', 'angle'] }}]
             effect.actuation = [{{ beam = 'bar', strain = 1e-3, curvature = '0.2 1/m' }}]
             output = {{ reactions = true }}\nanalysis.static = {{}}\n"
        );
        let found = Written::of(&text);
        for (name, value) in [("axial_force", -1.0), ("shear_force", 0.0), ("bending_moment", -1.0)] {
            for section in found.column("shape.csv", name) {
                near(section, value, 1e-8, name);
            }
        }
        let expected = [
            ("support1.fx", 1.0),
            ("support2.fx", -1.0),
            ("support1.moment", 1.0),
            ("support2.moment", -1.0),
        ];
        found.ends("reactions.csv", &expected, 1e-8);
        // The bar cannot follow: ½ EA ε₀² L and ½ EI κ₀² L.
        found.ends("energy.csv", &[("stretch", 1e-3), ("bend", 0.2)], 1e-8);
    }
}

/// A tapered bar that is damped in proportion to its stiffness creeps everywhere at the same rate: its end
/// moves by F ∫ ds/EA (1 − exp(−t/η)) and turns by M ∫ ds/EI (1 − exp(−t/η)), with ∫ ds/(1 + s) = ln 2.
///
/// Would catch a coefficient that is taken from another place of the bar.
#[test]
fn a_tapered_bar_creeps_everywhere_at_the_same_rate() {
    let text = format!(
        "beam.bar = {{ start = [0, 0], end = [1, 0], axial_stiffness.polynomial = [1e3, 1e3], bending_stiffness.polynomial = [10, 10], \
         mass_per_length = 1e-5, basis.ancf.elements = 4 }}
         support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
         effect.force = [{{ beam = 'bar', at = 'end', value = [0.01, 0] }}]
         effect.moment = [{{ beam = 'bar', at = 'end', value = 1e-3 }}]
         effect.damping = [{{ beam = 'bar', stiffness_proportional = 0.5 }}]
         probe = [{{ name = 'end', beam = 'bar', at = 'end' }}]\n{SECOND}"
    );
    let found = Written::of(&text);
    let part = 2.0_f64.ln() * (1.0 - f64::exp(-2.0));
    near((found.last("probes.csv", "end.x") - 1.0) / 1e-5, part, 2e-3, &text);
    near(found.last("probes.csv", "end.angle") / 1e-4, part, 2e-3, &text);
}

/// Columns belong to the effects of the scene, however many terms these consist of: a torsion spring that is
/// wound up by θ holds ½ k θ², the second of two foundations is the second column, and a beam of layers has
/// one bending energy.
#[test]
fn an_effect_has_one_column_of_each_quantity() {
    let found = Written::of(
        "beam.a = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1, basis.ancf.elements = 20 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]
        probe = [{ name = 'p', beam = 'a', at = 'end' }]
        output.effects = true
        analysis.static = {}
        [effect]
        torsion_spring = [{ beam = 'a', at = 'end', stiffness = 0.5 }]
        moment = [{ beam = 'a', at = 'end', value = 7 }]
        foundation = [{ beam = 'a', stiffness = [0, { pieces = { until = [0.3, 0.6], value = [1e-9, 2e-9, 1e-9] } }] }, { beam = 'a', from = 0.5, stiffness = [1e-12, 0] }]\n",
    );
    let angle = found.last("probes.csv", "p.angle");
    near(found.last("effects.csv", "torsion_spring.a.energy"), 0.25 * angle * angle, 1e-9, "a spring");
    // As exact as 20 elements that turn by 267 degrees.
    near(angle, 7.0 / 1.5, 1e-4, "a beam and a spring");
    let names: Vec<String> =
        found.header("effects.csv").into_iter().filter(|n| n.ends_with(".energy")).collect();
    let expected = ["stretch.a", "bend.a", "torsion_spring.a", "foundation.a.1", "foundation.a.2"];
    assert_eq!(names, expected.map(|name| format!("{name}.energy")));
}
