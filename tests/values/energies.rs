//! Energies, section forces and reactions of bars, cantilevers and pendulums that can be written
//! down.

use super::{ROD, SECOND, Written, near};
use ancf::assembly::Needs;
use ancf::model::{Beam, Discretization, Model, Section};
use ancf::system::System;

/// A bar that doubles no small strain: N is the force whatever the measure, and |r'| what follows
/// from it.
///
/// Would catch N as EA ε of Green's strain without the |r'| that goes with it, and the strain of
/// one measure for the other.
#[test]
fn a_stretched_bar_carries_its_force_by_either_measure() {
    // EA = 1000 N. Green's: ½ (g² − 1) g = 0.6 with g = |r'|, by Cardano's formula; engineering: g
    // − 1 = 0.6.
    let root = (1.2_f64 * 1.2 / 4.0 - 1.0 / 27.0).sqrt();
    let green = (0.6 + root).cbrt() + (0.6 - root).cbrt();
    for (measure, stretch, strain) in
        [("green", green, 0.5 * (green * green - 1.0)), ("engineering", 1.6, 0.6)]
    {
        // Radial functions are integrated by Gauss points to some 1e-4.
        for (basis, error) in [("ancf.elements = 4", 1e-9), ("rpim.nodes = 6", 3e-4)] {
            let text = format!(
                "beam.bar = {{ start = [0, 0], end = [0, 2], axial_stiffness = '1 kN', bending_stiffness = 1, strain = '{measure}', \
                 basis.{basis} }}
                 support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
                 effect.force = [{{ beam = 'bar', at = 'end', value = [0, '600 N'] }}]
                 probe = [{{ name = 'end', beam = 'bar', at = 'end' }}]
                 output = {{ reactions = true, effects = true }}\nanalysis.static = {{}}\n"
            );
            let found = Written::of(&text);
            for (name, value) in [("axial_force", 600.0), ("shear_force", 0.0), ("bending_moment", 0.0)] {
                for section in found.column("shape.csv", name) {
                    near(section, value, 1e-4, name);
                }
            }
            found.column("shape.csv", "strain").iter().for_each(|e| near(*e, strain, error, "strain"));
            let (s, y) = (found.column("shape.csv", "s"), found.column("shape.csv", "y"));
            s.iter().zip(&y).for_each(|(s, y)| near(*y, stretch * s, error, "y"));
            found
                .column("shape.csv", "angle")
                .iter()
                .for_each(|a| near(*a, 0.5 * std::f64::consts::PI, 1e-9, "angle"));
            found.ends("probes.csv", &[("end.strain", strain), ("end.y", 2.0 * stretch)], error);
            let (stored, fallen) = (1000.0 * strain * strain, -600.0 * 2.0 * (stretch - 1.0));
            let expected = [
                ("stretch", stored),
                ("bend", 0.0),
                ("kinetic", 0.0),
                ("potential", fallen),
                ("total", stored + fallen),
            ];
            found.ends("energy.csv", &expected, 1e3 * error);
            let expected = [
                ("stretch.bar.energy", stored),
                ("force.bar.energy", fallen),
                ("force.bar.fy", 600.0),
                ("force.bar.fx", 0.0),
            ];
            found.ends("effects.csv", &expected, 1e3 * error);
            found.ends(
                "reactions.csv",
                &[("support1.fx", 0.0), ("support1.fy", -600.0), ("support1.moment", 0.0)],
                1e-3,
            );
        }
    }
}

/// A clamped beam under small loads: N, Q and M by the cut, the deflection by Euler, and what the
/// clamp gives.
///
/// Would catch fx for fy, a moment of the other sense, sections of the other side of the cut, and
/// bending energy for stretching.
#[test]
fn a_cantilever_has_the_sections_of_its_cut() {
    let text = "beam.arm = { start = [1, 2], end = [3, 2], axial_stiffness = 1e7, bending_stiffness = 50, basis.ancf.elements = 8 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0.5, -3e-3] }]
        effect.moment = [{ beam = 'arm', at = 'end', value = 4e-3 }]
        effect.distributed_force = [{ beam = 'arm', value = [0, 2e-3] }]
        probe = [{ name = 'end', beam = 'arm', at = 'end' }]
        output = { reactions = true, effects = true }
        analysis.static = {}\n";
    let found = Written::of(text);
    let columns =
        ["s", "x", "y", "angle", "strain", "curvature", "axial_force", "shear_force", "bending_moment"];
    let columns = columns.map(|name| found.column("shape.csv", name));
    let (ei, l) = (50.0, 2.0);
    for i in 0..columns[0].len() {
        let [s, x, y, angle, strain, curvature, n, q, m] = columns.each_ref().map(|column| column[i]);
        let t = l - s;
        // M, with the small part that the pull has of it left to the tolerance.
        let moment = 4e-3 - 3e-3 * t + 1e-3 * t * t;
        let slope = (4e-3 * s - 3e-3 * (l * s - 0.5 * s * s) + 1e-3 * (l.powi(3) - t.powi(3)) / 3.0) / ei;
        let deflection = (2e-3 * s * s - 3e-3 * (0.5 * l * s * s - s.powi(3) / 6.0)
            + 1e-3 * (l.powi(3) * s + 0.25 * (t.powi(4) - l.powi(4))) / 3.0)
            / ei;
        for (name, value, expected, tolerance) in [
            ("x", x, 1.0 + s, 2e-7),
            ("y", y, 2.0 + deflection, 2e-6),
            ("angle", angle, slope, 2e-6),
            ("strain", strain, 5e-8, 1e-9),
            ("curvature", curvature, moment / ei, 3e-6),
            ("axial_force", n, 0.5, 1e-5),
            // The pull has a part across the section, by its slope.
            ("shear_force", q, -3e-3 + 2e-3 * t - 0.5 * angle, 1e-8),
            ("bending_moment", m, moment - 0.5 * (found.last("probes.csv", "end.y") - y), 1e-8),
        ] {
            near(value, expected, tolerance, &format!("{name} at s = {s}"));
        }
    }
    let lever = 0.5 * (found.last("probes.csv", "end.y") - 2.0);
    // About the clamp: −(4e-3 − 2 · 3e-3 + 4e-3 · 1) + the pull's lever.
    let expected = [("support1.fx", -0.5), ("support1.fy", -1e-3), ("support1.moment", -2e-3 + lever)];
    found.ends("reactions.csv", &expected, 1e-8);
    // ½ ∫ M²/EI ds by the binomials of M.
    let (a, b, c) = (4e-3_f64, -3e-3_f64, 1e-3_f64);
    let square = a * a * l
        + a * b * l * l
        + (b * b + 2.0 * a * c) * l.powi(3) / 3.0
        + 0.5 * b * c * l.powi(4)
        + c * c * l.powi(5) / 5.0;
    near(found.last("energy.csv", "bend") / (0.5 * square / ei), 1.0, 3e-2, "bend");
    near(found.last("energy.csv", "stretch"), 0.5 * 0.25 * l / 1e7, 1e-10, "stretch");
    near(found.last("effects.csv", "bend.arm.energy"), found.last("energy.csv", "bend"), 1e-15, "bend");
}

/// A moment in a static analysis has no potential, and the beam is bent to a circle of curvature
/// M/EI.
#[test]
fn a_couple_bends_to_a_circle() {
    let text = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1e6, bending_stiffness = 10, basis.rpim.nodes = 12 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.moment = [{ beam = 'arm', at = 'end', value = '6 N m' }]
        probe = [{ name = 'end', beam = 'arm', at = 'end' }]
        output.states = true
        analysis.static.steps = 2\n";
    let found = Written::of(text);
    for (i, load) in [(0, 0.0), (1, 0.5), (2, 1.0)] {
        near(found.column("probes.csv", "end.curvature")[i], 0.6 * load, 1e-3, "curvature");
        near(found.column("probes.csv", "end.angle")[i], 1.2 * load, 1e-4, "angle");
        near(found.column("energy.csv", "bend")[i], 0.5 * 10.0 * (0.6 * load).powi(2) * 2.0, 5e-3, "bend");
    }
    // Every state at every arc length: on the circle of its load.
    let [load, s, x, y] = ["load", "s", "x", "y"].map(|name| found.column("states.csv", name));
    assert_eq!(load.len(), 3 * 101);
    assert!(found.words("states.csv", "beam").iter().all(|beam| beam == "arm"));
    for i in 0..load.len() {
        let k = 0.6 * load[i];
        near(s[i], 2.0 * (i % 101) as f64 / 100.0, 1e-15, "s");
        near(load[i], 0.5 * (i / 101) as f64, 1e-15, "load");
        let exact = if k == 0.0 { [s[i], 0.0] } else { [(k * s[i]).sin() / k, (1.0 - (k * s[i]).cos()) / k] };
        near(x[i], exact[0], 1e-4, "x");
        near(y[i], exact[1], 1e-4, "y");
    }
}

/// A rod in free fall with a couple: kinetic energy, potential of the weight, work of the couple,
/// each in its column, record by record.
///
/// Would catch a sign of the potential, work for kinetic or lost energy, a drift that is another,
/// and columns that are swapped.
#[test]
fn a_falling_rod_has_its_energies_in_their_columns() {
    let text = format!(
        "{ROD}effect.gravity.acceleration = [0.3, -0.4]
         effect.moment = [{{ beam = 'rod', at = 0.5, value = 0.05 }}]
         initial_velocity = [{{ beam = 'rod', value = [0.1, 0.2] }}]
         output = {{ effects = true, states = true }}\n{SECOND}"
    );
    let found = Written::of(&text);
    let column = |name: &str| found.column("energy.csv", name);
    for (i, time) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let (vx, vy) = (0.1 + 0.3 * time, 0.2 - 0.4 * time);
        let (x, y) = (0.1 * time + 0.15 * time * time, 0.2 * time - 0.2 * time * time);
        // α = M/I = 0.3, the couple's work is M θ.
        let work = 0.05 * 0.15 * time * time;
        let (kinetic, potential) = (vx * vx + vy * vy + work, -2.0 * (0.3 * x - 0.4 * y));
        for (name, value) in [
            ("time", time),
            ("kinetic", kinetic),
            ("potential", potential),
            ("work", work),
            ("stretch", 0.0),
            ("bend", 0.0),
            ("total", 0.05),
        ] {
            near(column(name)[i], value, 2e-6, name);
        }
        for (name, value) in [
            ("inertia.rod.energy", kinetic),
            ("gravity.rod.energy", potential),
            ("gravity.rod.fx", 0.6),
            ("gravity.rod.fy", -0.8),
            ("moment.rod.fx", 0.0),
            ("moment.rod.fy", 0.0),
        ] {
            near(found.column("effects.csv", name)[i], value, 2e-6, name);
        }
        for (name, value) in [
            ("middle.x", 0.5 + x),
            ("middle.y", y),
            ("middle.vx", vx),
            ("middle.vy", vy),
            ("middle.angle", 0.15 * time * time),
        ] {
            near(found.column("probes.csv", name)[i], value, 2e-6, name);
        }
        let end = found.column("states.csv", "x").len() / 5 * i + 50;
        near(found.column("states.csv", "time")[end], time, 1e-12, "time");
        near(found.column("states.csv", "x")[end], 0.5 + x, 2e-6, "x");
        near(found.column("states.csv", "y")[end], y, 2e-6, "y");
    }
    assert!(!found.header("energy.csv").iter().any(|name| name == "lost" || name == "stored"));
    assert!(found.said("/energy/drift") < 1e-4, "of the integrator alone");
}

/// A support that lifts a rod along y = 0.2 m (10 t³ − 15 t⁴ + 6 t⁵): its work is the rod's kinetic
/// energy, its force m ÿ at half the rod's length.
///
/// Would catch work that is lost, a reaction of the other sign or axis, and the load in place of
/// the reaction.
#[test]
fn a_lift_puts_in_what_the_rod_has() {
    let text = format!(
        "{ROD}support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'], \
         move = {{ y = 0.2, in_time.smooth_ramp = {{ duration = '1 s' }} }} }}]
         output = {{ reactions = true, effects = true }}\n{SECOND}"
    );
    let found = Written::of(&text);
    let (v, a) = (0.2 * 30.0 * (0.25_f64 * 0.75).powi(2), 0.2 * 60.0 * 0.25 * 0.75 * 0.5);
    for (file, name, value, tolerance) in [
        ("energy.csv", "work", v * v, 2e-3),
        ("energy.csv", "kinetic", v * v, 2e-3),
        ("reactions.csv", "support1.fx", 0.0, 0.02),
        ("reactions.csv", "support1.fy", 2.0 * a, 0.2),
        ("reactions.csv", "support1.moment", a, 0.1),
    ] {
        near(found.column(file, name)[1], value, tolerance, name);
    }
    near(found.said("/energy/work"), 0.0, 1e-3, "the rod rests again");
}

/// A section that a program gives a mass keeps its stiffnesses, and moves with its mass: 2 m of 3
/// kg/m at 5 m/s have 75 J.
#[test]
fn a_section_weighs_what_it_is_told_to() {
    let section = Section::new(7.0, 11.0).weighing(3.0);
    let stiffnesses = [&section.axial_stiffness, &section.bending_stiffness];
    assert_eq!(stiffnesses, [&Some(7.0.into()), &Some(11.0.into())]);
    let beam = Beam::line("rod", [0.0, 0.0], [2.0, 0.0], section, Discretization::ancf(2));
    let model = Model { beams: vec![beam], ..Model::default() };
    let system = System::build(&model, Needs { inertia: true, motion: false }).expect("a beam");
    let velocity = [3.0, 4.0, 0.0, 0.0].repeat(system.coordinates() / 4);
    let kinetic = system.energy(0.0, system.reference(), Some(&velocity)).kinetic;
    near(kinetic, 75.0, 1e-10, "the kinetic energy");
}
