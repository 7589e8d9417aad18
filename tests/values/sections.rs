//! Sections that vary along a beam, or tell their shape. Expected are integrals of M/EI, N/EA and ρA
//! by hand, and stresses N/A ∓ M/W.

use super::{Written, near};
use ancf::scene::parse;
use std::f64::consts::PI;

/// A cantilever of 1 m along x with the given properties and loads at its end.
fn arm(section: &str, loads: &str, basis: &str) -> String {
    format!(
        "beam.arm = {{ start = [0, 0], end = [1, 0], {section}, basis.{basis} }}
        support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]\n{loads}\nanalysis.static = {{}}\n"
    )
}

const COUPLE: &str = "effect.moment = [{ beam = 'arm', at = 'end', value = 1 }]";
const PULL: &str = "effect.force = [{ beam = 'arm', at = 'end', value = [2, 0] }]";

/// A couple of 1 N m turns the tip by ∫ ds/EI: ln 2 for 2 − s, ½ for (1 + s)², and for a polygon and
/// a step, whose ends lie inside cells, the sums of their pieces.
///
/// Would catch a cell whose stiffness is that of its middle, a rule that reaches over a kink, and a
/// coefficient of the wrong power.
#[test]
fn a_couple_turns_a_tip_by_the_integral_of_its_compliance() {
    let polygon = 0.37 * 2.0_f64.ln() + 0.315 * 3.0_f64.ln();
    for (stiffness, angle, allowed) in [
        ("{ table = { s = [0, 1], value = [2, 1] } }", 2.0_f64.ln(), 1e-7),
        ("{ polynomial = [1, 2, 1] }", 0.5, 5e-7),
        ("{ table = { s = [0, 0.37, 1], value = [2, '1 N m^2', 3] } }", polygon, 3e-5),
        ("{ table = { s = ['start', 0.37, 'end'], value = [2, 1, 3] } }", polygon, 3e-5),
        ("{ pieces = { until = [0.33, 1], value = [4, '1 N m^2'] } }", 0.0825 + 0.67, 2e-7),
        ("{ pieces = { until = [0.33, 'end'], value = [4, 1] } }", 0.0825 + 0.67, 2e-7),
        ("{ pieces = { until = ['33 cm'], value = [4, 1] } }", 0.0825 + 0.67, 2e-7),
    ] {
        for basis in ["ancf.elements = 20", "rpim.nodes = 21"] {
            let section = format!("axial_stiffness = 1e5, bending_stiffness = {stiffness}");
            let found = Written::of(&arm(&section, COUPLE, basis));
            found.ends("probes.csv", &[("tip.angle", angle)], allowed);
        }
    }
}

/// A couple M at the end of a bow turns its end by M L/EI, however its axial stiffness varies, which carries no force. It is 3e9 EI/L², and has a
/// corner within a cell.
///
/// Would catch cells that are divided at the corner for the sum of the stretch: held at so many points they hardly bend, and the end
/// turned by 0.015 rad too little.
#[test]
fn slender_cells_bend_where_the_axial_stiffness_has_a_corner() {
    for (basis, allowed) in [("ancf.elements = 12", 3e-6), ("rpim.nodes = 13", 3e-6)] {
        let turned = |moment: f64| {
            let found = Written::of(&format!(
                "beam.bow = {{ points = [[0, 0], [0.333, 0.00666], [0.667, -0.0266], [1, -0.177]], bending_stiffness = 1.4,
                   axial_stiffness = {{ table = {{ s = [0, 0.5, 'end'], value = [5e9, 3.5e9, 4e9] }} }}, basis.{basis} }}
                 support = [{{ beam = 'bow', at = 'start', fix = ['x', 'y', 'angle'] }}]
                 probe = [{{ name = 'tip', beam = 'bow', at = 'end' }}]
                 effect.moment = [{{ beam = 'bow', at = 'end', value = {moment} }}]
                 analysis.static = {{}}\n"
            ));
            (found.last("probes.csv", "tip.angle"), found.last("shape.csv", "s"))
        };
        let ((free, _), (bent, length)) = (turned(0.0), turned(0.922));
        near(bent - free, 0.922 * length / 1.4, allowed, basis);
    }
}

/// An arc that its axial stiffness of 1e8 EI/L² hardly lets stretch moves as it does without it where the strain of a part of it is damped, which ends
/// within cells.
///
/// Would catch cells that are divided at the ends of that part for the sum of the damping, which then damps how they bend: the tip was off by
/// 1.3e-4 m.
#[test]
fn damping_of_a_strain_that_vanishes_does_nothing() {
    let tip = |damping: &str| {
        let found = Written::of(&format!(
            "beam.arc = {{ arc = {{ center = [0, 1], radius = 1, from = '-90 deg', to = '-40 deg' }}, axial_stiffness = 1e8, bending_stiffness = 1,
               mass_per_length = 1, basis.ancf.elements = 10 }}
             support = [{{ beam = 'arc', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'arc', at = 'end', value = [0, 1] }}]
             {damping}
             probe = [{{ name = 'tip', beam = 'arc', at = 'end' }}]
             analysis.dynamic = {{ duration = 1, radau.tolerance = 1e-6 }}\n"
        ));
        ["tip.x", "tip.y"].map(|column| found.last("probes.csv", column))
    };
    let (free, damped) =
        (tip(""), tip("effect.damping = [{ beam = 'arc', strain = 0.01, from = 0.21, to = 0.55 }]"));
    for (free, damped) in free.iter().zip(damped) {
        near(damped, *free, 2e-6, "of a damped arc");
    }
}

/// 2 N lengthen a bar by 2 ∫ ds/EA, and a support carries the weight g ∫ ρA ds.
#[test]
fn stretch_and_weight_are_integrals_too() {
    let section = "axial_stiffness = { table = { s = [0, 1], value = [2000, 1000] } }, bending_stiffness = 1";
    let found = Written::of(&arm(section, PULL, "ancf.elements = 40"));
    found.ends("probes.csv", &[("tip.x", 1.0 + 2e-3 * 2.0_f64.ln())], 1e-9);
    for (mass, whole) in [
        ("{ table = { s = [0, 0.3, 1], value = [1, 3, 2] } }", 0.6 + 1.75),
        ("{ polynomial = [1, 0, 6] }", 3.0),
        ("{ pieces = { until = [0.2, 0.7], value = [5, 3, 1] } }", 2.8),
    ] {
        let section = format!("axial_stiffness = 1e6, bending_stiffness = 1e6, mass_per_length = {mass}");
        let loads = "effect.gravity.acceleration = [0, -10]\noutput.reactions = true";
        let found = Written::of(&arm(&section, loads, "ancf.elements = 7"));
        found.ends("reactions.csv", &[("support1.fy", 10.0 * whole)], 1e-8);
    }
}

/// EA, EI, ρA and ρI of rectangles, circles and tubes, from the lengthening, the turn, the weight
/// and the frequency that they cause.
#[test]
fn a_section_has_the_stiffness_and_the_weight_of_its_shape() {
    let circle = |d: f64| [PI * d * d / 4.0, PI * d.powi(4) / 64.0];
    let [outer, inner] = [circle(0.02), circle(0.014)];
    for (shape, [area, second_moment]) in [
        ("section.rectangle = { width = '30 mm', height = 0.01 }", [3e-4, 2.5e-9]),
        ("section.circle = { diameter = '2 cm' }", outer),
        ("section.tube = { diameter = '2 cm', wall = '3 mm' }", [outer[0] - inner[0], outer[1] - inner[1]]),
        (
            "section.rectangle = { width = { table = { s = [0, 1], value = [0.03, 0.03] } }, height = 0.01 }",
            [3e-4, 2.5e-9],
        ),
    ] {
        let section = format!("{shape}, youngs_modulus = '1 MPa', density = 1500");
        let turned = Written::of(&arm(
            &section,
            "effect.moment = [{ beam = 'arm', at = 'end', value = 1e-6 }]",
            "ancf.elements = 4",
        ));
        let angle = 1e-6 / (1e6 * second_moment);
        near(turned.said("/probes/tip/angle") / angle, 1.0, 1e-7, shape);
        let pull = "effect.force = [{ beam = 'arm', at = 'end', value = [1e-4, 0] }]";
        let pulled = Written::of(&arm(&section, pull, "ancf.elements = 4"));
        near((pulled.said("/probes/tip/x") - 1.0) / (1e-4 / (1e6 * area)), 1.0, 1e-7, shape);
        let scene = parse("arm.toml", &arm(&section, "", "ancf.elements = 4")).expect("a scene");
        let section = &scene.model().beams[0].section;
        let mean = |quantity: &Option<ancf::model::Along>| quantity.as_ref().expect("is known").mean(1.0);
        near(mean(&section.mass_per_length), 1500.0 * area, 1e-12, shape);
        near(mean(&section.rotary_inertia), 1500.0 * second_moment, 1e-15, shape);
    }
}

/// Frequencies with the rotary inertia of a section that tells it, and with the same ρI typed.
#[test]
fn the_rotary_inertia_of_a_section_is_known() {
    let scene = |inertia: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], youngs_modulus = 1e6, density = 1500, \
             section.rectangle = {{ width = 0.02, height = {{ table = {{ s = [0, 1], value = [0.2, 0.1] }} }} }}, \
             basis.ancf.elements = 8 }}
             effect.rotary_inertia = [{{ beam = 'arm'{inertia} }}]\nanalysis.modal.count = 4\n"
        )
    };
    // ρ b h³/12 with h = 0.2 − 0.1 s, multiplied out.
    let typed = ", per_length = { polynomial = [0.02, -0.03, 0.015, -0.0025] }";
    let [known, typed] =
        [scene(""), scene(typed)].map(|text| Written::of(&text).column("frequencies.csv", "frequency"));
    for (a, b) in known.iter().zip(&typed) {
        near(*a, *b, 1e-9 * b.max(1.0), "frequency");
    }
    assert!(known[3] > 1.0, "{known:?}");
}

/// An arc whose layer lies beside its centreline, and the same arc described by its middle line: as the
/// distance, 0.1 mm, is 3e-4 of the radius, frequencies differ by as much. Elements are a thousand times
/// as long as that distance.
///
/// Would catch strains between the points for stretch that count as curvatures, divided by the distance,
/// by which the third frequency was wrong by a quarter.
#[test]
fn a_thin_curved_beam_need_not_be_described_by_its_middle_line() {
    let frequencies = |offset: &str, basis: &str| {
        let layers = format!(
            "section.layers = [{{ youngs_modulus = 7e10, density = 2700, width = 0.01, height = 2e-4{offset} }}]"
        );
        let scene = format!(
            "beam.a = {{ arc = {{ center = [0, 0], radius = 0.3, from = '0 deg', to = '270 deg' }}, {layers}, basis.{basis} }}
            support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
            analysis.modal.count = 4\n"
        );
        Written::of(&scene).column("frequencies.csv", "frequency")
    };
    for basis in ["ancf.elements = 14", "rpim.nodes = 15"] {
        let in_the_middle = frequencies("", basis);
        for offset in [", offset = '0.1 mm'", ", offset = '-0.1 mm'"] {
            for (beside, middle) in frequencies(offset, basis).iter().zip(&in_the_middle) {
                near(beside / middle, 1.0, 2e-3, &format!("{basis}{offset}"));
            }
        }
    }
}

/// The energy of layers whose offsets have kinks within cells is positive at the points of any rule:
/// what rests without load is stable, and a free laminate has three motions without frequency.
///
/// Would catch squares of which the terms are summed over cells that are divided at different places.
#[test]
fn the_energy_of_layers_with_kinks_is_positive() {
    let wavy = "points = [[0, 0], [0.22, 0.16], [0.43, -0.07], [0.65, 0.06], [0.87, 0.06]]";
    let layers = "section.layers = [
        { youngs_modulus = 1e11, density = 2000, width = 0.001, height = 8e-4, offset = -2e-4 },
        { youngs_modulus = 3e11, density = 2000, width = 0.001, height = 6e-4, offset = { table = { s = [0, 0.4, 1.2], value = [6e-4, 4e-4, 3e-4] } } },
    ]";
    for basis in [
        "ancf.elements = 5",
        "ancf.elements = 8",
        "ancf = { elements = 6, gauss_points = { stretch = 2, bend = 2 } }",
        "ancf = { elements = 6, gauss_points = { stretch = 3, bend = 3, stretch_rule = 'lobatto' } }",
        "rpim.nodes = 9",
    ] {
        let scene = format!("beam.a = {{ {wavy}, {layers}, basis.{basis} }}\nanalysis.modal.count = 5\n");
        let found = Written::of(&scene).column("frequencies.csv", "frequency");
        assert_eq!(found.iter().filter(|f| **f == 0.0).count(), 3, "{basis}: {found:?}");
    }
}

/// A bar bent by 1 N m and pulled by 2 N: σ = N/A ± M/W on its right and left face, largest where it
/// is thinnest.
#[test]
fn stresses_are_those_of_the_faces() {
    let loads = format!("{COUPLE}\n{PULL}");
    let section = "youngs_modulus = '10 GPa', section.rectangle = { width = 0.02, height = { table = { s = [0, 1], value = [0.02, 0.01] } } }";
    let found = Written::of(&arm(section, &loads, "ancf.elements = 20"));
    let (s, bottom) = (found.column("shape.csv", "s"), found.column("shape.csv", "stress_bottom"));
    let (top, moments) =
        (found.column("shape.csv", "stress_top"), found.column("shape.csv", "bending_moment"));
    let forces = found.column("shape.csv", "axial_force");
    assert_eq!(s.len(), 201);
    for i in 0..s.len() {
        let h = 0.02 - 0.01 * s[i];
        let (pull, bend) = (forces[i] / (0.02 * h), 6.0 * moments[i] / (0.02 * h * h));
        near(bottom[i], pull + bend, 1.0, "stress_bottom");
        near(top[i], pull - bend, 1.0, "stress_top");
        near(moments[i], 1.0, 0.02, "bending_moment");
        near(forces[i], 2.0, 1e-3, "axial_force");
    }
    let stress = &found.summary()["stress"][0];
    assert_eq!((&stress["beam"], &stress["face"]), (&"arm".into(), &"bottom".into()));
    assert_eq!((&stress["layer"], &stress["s"]), (&1.into(), &1.0.into()));
    near(found.said("/stress/0/value"), 1e4 + 3e6, 5.0, "value");
    // A stiffness alone does not tell the faces.
    let plain = Written::of(&arm("axial_stiffness = 1, bending_stiffness = 1", "", "ancf.elements = 2"));
    assert!(!plain.header("shape.csv").iter().any(|name| name.starts_with("stress")));
    assert!(plain.summary().get("stress").is_none());
}

/// Layers of 100 and 300 GPa, 1 and 2 mm high: by default they lie on each other about the centreline;
/// with offsets where these say. Turned upside down by their offsets they bend the other way.
#[test]
fn layers_lie_where_they_are_said_to() {
    let layer = |modulus: &str, height: &str, offset: &str| {
        format!(
            "{{ youngs_modulus = '{modulus}', density = 1000, width = 0.02, height = '{height}'{offset} }}"
        )
    };
    let scene = |layers: &str| arm(&format!("section.layers = [{layers}]"), COUPLE, "ancf.elements = 10");
    let stacked = scene(&[layer("100 GPa", "1 mm", ""), layer("300 GPa", "2 mm", "")].join(", "));
    let placed = scene(
        &[layer("100 GPa", "1 mm", ", offset = '-1 mm'"), layer("300 GPa", "2 mm", ", offset = 5e-4")]
            .join(", "),
    );
    let (a, b) = (Written::of(&stacked), Written::of(&placed));
    let tip =
        |of: &Written| [of.said("/probes/tip/x"), of.said("/probes/tip/y"), of.said("/probes/tip/strain")];
    for (a, b) in tip(&a).into_iter().zip(tip(&b)) {
        near(a, b, 1e-12, "tip");
    }
    // EA = 0.02 (1e11 · 1e-3 + 3e11 · 2e-3), EB = −Σ E A y, EI = Σ E A (h²/12 + y²).
    let (ea, eb) = (1.4e7, -(2e6 * -1e-3 + 1.2e7 * 5e-4));
    let ei = 2e6 * (1e-6 / 12.0 + 1e-6) + 1.2e7 * (4e-6 / 12.0 + 2.5e-7);
    let determinant: f64 = ea * ei - eb * eb;
    near(tip(&a)[2], -eb / determinant, 1e-9, "strain");
    near(a.said("/probes/tip/angle"), ea / determinant, 1e-6, "angle");
    // Of layer 2, which is the last in the table: both faces, by E (ε − y κ).
    let sigma = |y: f64| 3e11 * (-eb / determinant - y * ea / determinant);
    a.ends("layers.csv", &[("layer", 2.0), ("s", 1.0)], 0.0);
    a.ends("layers.csv", &[("stress_bottom", sigma(-0.5e-3)), ("stress_top", sigma(1.5e-3))], 200.0);
    assert_eq!(a.words("layers.csv", "beam").len(), 2 * 201);
    let turned = scene(
        &[layer("100 GPa", "1 mm", ", offset = '1 mm'"), layer("300 GPa", "2 mm", ", offset = -5e-4")]
            .join(", "),
    );
    near(tip(&Written::of(&turned))[2], eb / determinant, 1e-9, "strain");
    let model = parse("arm.toml", &stacked).expect("a scene");
    let section = &model.model().beams[0].section;
    let mean = |quantity: &Option<ancf::model::Along>| quantity.as_ref().expect("is known").mean(1.0);
    near(mean(&section.mass_per_length), 1000.0 * 0.02 * 3e-3, 1e-15, "mass");
    near(
        mean(&section.rotary_inertia),
        1000.0 * (2e-5 * (1e-6 / 12.0 + 1e-6) + 4e-5 * (4e-6 / 12.0 + 2.5e-7)),
        1e-18,
        "rotary inertia",
    );
}

/// A laminate that actuation gives ε₀ and κ₀ takes both, without any force, and needs no energy.
#[test]
fn an_actuated_laminate_takes_its_strain_and_curvature() {
    let section = "section.layers = [{ youngs_modulus = '1 GPa', width = 0.02, height = '1 mm' }, \
                   { youngs_modulus = '3 GPa', width = 0.02, height = '2 mm' }]";
    let actuation = "effect.actuation = [{ beam = 'arm', strain = 2e-3, curvature = 0.5 }]";
    let found = Written::of(&arm(section, actuation, "ancf.elements = 16"));
    near(found.said("/probes/tip/strain"), 2e-3, 1e-7, "strain");
    near(found.said("/probes/tip/curvature"), 0.5, 1e-4, "curvature");
    near(found.said("/probes/tip/angle"), 0.5, 1e-5, "angle");
    let scale = 0.5 * 1.4e5 * 2e-3_f64.powi(2);
    for part in ["/energy/stretch", "/energy/bend", "/energy/total"] {
        near(found.said(part), 0.0, 2e-4 * scale, part);
    }
}

/// Timoshenko's bimetal (1925): a strip of two metals of which one would be longer by e bends by
/// κ = 6 e (1 + m)²/(h (3 (1 + m)² + (1 + m n)(m² + 1/(m n)))), with m = h₁/h₂ and n = E₁/E₂. No section
/// carries a force or a couple, and at the bond the stresses differ by what the strains miss.
#[test]
fn a_bimetal_bends_as_timoshenko_said() {
    let section = "section.layers = [{ youngs_modulus = '100 GPa', width = 0.02, height = '1 mm' }, \
                   { youngs_modulus = '300 GPa', width = 0.02, height = '2 mm' }]";
    let bent = |layer: u32, basis: &str| {
        let heat = format!("effect.actuation = [{{ beam = 'arm', layer = {layer}, strain = 1e-3 }}]");
        Written::of(&arm(section, &heat, basis))
    };
    let (m, n): (f64, f64) = (0.5, 1.0 / 3.0);
    let kappa = 6e-3 * (1.0 + m).powi(2)
        / (3e-3 * (3.0 * (1.0 + m).powi(2) + (1.0 + m * n) * (m * m + 1.0 / (m * n))));
    // The strain of the bond, where layer 2 has the stress of its own force P and curvature.
    let stiffness = [1e11 * 0.02 * 1e-3, 3e11 * 0.02 * 2e-3];
    let rigidity: f64 = [1e11 * 1e-9, 3e11 * 8e-9].iter().map(|eh: &f64| eh * 0.02 / 12.0).sum();
    let force = rigidity * kappa / 1.5e-3;
    for basis in ["ancf.elements = 16", "rpim.nodes = 9"] {
        for (layer, sign) in [(1, 1.0), (2, -1.0)] {
            let found = bent(layer, basis);
            near(found.said("/probes/tip/curvature"), sign * kappa, 2e-3 * kappa, "curvature");
            near(found.said("/probes/tip/angle"), sign * kappa, 1e-4 * kappa, "angle");
            for column in ["axial_force", "bending_moment"] {
                near(found.last("shape.csv", column), 0.0, 1e-6 * force, column);
            }
            // The last rows are those of layer 2: pulled by P if layer 1 is longer, and bent.
            let sigma = |y: f64| sign * (force / 4e-5 - 3e11 * y * kappa);
            let stresses = [("stress_bottom", sigma(-1e-3)), ("stress_top", sigma(1e-3))];
            found.ends("layers.csv", &stresses, 2e-4 * sigma(-1e-3).abs());
            // ½ P² (1/EA₁ + 1/EA₂) + ½ (EI₁ + EI₂) κ².
            let energy = 0.5 * force * force * stiffness.map(f64::recip).iter().sum::<f64>()
                + 0.5 * rigidity * kappa * kappa;
            near(found.said("/energy/stretch") + found.said("/energy/bend"), energy, 1e-4 * energy, "energy");
        }
    }
    // Both layers alike are the whole section.
    let both = "effect.actuation = [{ beam = 'arm', layer = 1, strain = 1e-3 }, { beam = 'arm', layer = 2, strain = 1e-3 }]";
    let found = Written::of(&arm(section, both, "ancf.elements = 4"));
    near(found.said("/probes/tip/strain"), 1e-3, 1e-9, "strain");
    near(found.said("/energy/total"), 0.0, 1e-9, "energy");
    for (heat, part) in [
        ("layer = 3, strain = 1e-3", "beam `arm` has no layer 3: its `section` has 2 layers"),
        ("layer = 1, strain = 1e-3, curvature = 1", "no `curvature` can be imposed on a single layer"),
    ] {
        let scene =
            arm(section, &format!("effect.actuation = [{{ beam = 'arm', {heat} }}]"), "ancf.elements = 4");
        let said = parse("arm.toml", &scene).expect_err(part).to_string();
        assert!(said.contains(part), "{said}");
    }
}

/// Layers that lie evenly about the centreline have no coupling of stretch and bending but round-off, which is none in any unit; one that is thicker by a
/// millionth of a millionth has.
#[test]
fn even_layers_do_not_couple_stretch_and_bending() {
    for unit in [1e-9, 1.0, 1e6] {
        let couples = |top: f64| {
            let layers: Vec<String> = [(0.1, 7e10), (0.3, 3.1e9), (top, 7e10)]
                .map(|(height, modulus)| {
                    format!(
                        "{{ width = {unit:e}, height = {:e}, youngs_modulus = {modulus:e} }}",
                        height * unit
                    )
                })
                .into();
            let section = format!("section.layers = [{}]", layers.join(", "));
            let scene = parse("layers.toml", &arm(&section, "", "ancf.elements = 4")).expect("a scene");
            scene.model().beams[0].section.coupling.is_some()
        };
        assert_eq!([couples(0.1), couples(0.1 * (1.0 + 1e-12))], [false, true], "{unit}");
    }
}

/// Of a strip of two layers one is heated between 0.2 and 0.8 of its length. Nothing holds it, so that the force and the moment of the heat, either
/// of which is far more than what bends the strip, give it a strain and a curvature there, and its tip lies at the end of an arc. Cells
/// that bend through a quarter of a right angle follow.
#[test]
fn a_heated_layer_bends_long_cells_as_it_should() {
    let (width, heat) = (0.01, 0.004);
    let (heights, moduli) = ([0.0004, 0.0011], [70e9, 3e9]);
    let bottom = -0.5 * (heights[0] + heights[1]);
    let layer = |modulus: f64, [a, b]: [f64; 2]| {
        let of = |power: i32, factor: f64| factor * modulus * width * (b.powi(power) - a.powi(power));
        [of(1, 1.0), of(2, -0.5), of(3, 1.0 / 3.0)]
    };
    let heated = layer(moduli[0], [bottom, bottom + heights[0]]);
    let other = layer(moduli[1], [bottom + heights[0], -bottom]);
    let [ea, eb, ei] = [0, 1, 2].map(|k| heated[k] + other[k]);
    let both = ea * ei - eb * eb;
    let strain = heat * (ei * heated[0] - eb * heated[1]) / both;
    let curvature = heat * (ea * heated[1] - eb * heated[0]) / both;
    let (turn, radius) = (0.6 * curvature, (1.0 + strain) / curvature);
    let tip = [0.2 + radius * turn.sin() + 0.2 * turn.cos(), radius * (1.0 - turn.cos()) + 0.2 * turn.sin()];
    let section = "section.layers = [{ width = 0.01, height = 0.0004, youngs_modulus = 70e9 }, { width = 0.01, height = 0.0011, youngs_modulus = 3e9 }]";
    let load = "effect.actuation = [{ beam = 'arm', layer = 1, strain = 0.004, from = 0.2, to = 0.8 }]";
    for (elements, allowed) in [(5, 1e-2), (10, 1.5e-3), (20, 2e-4)] {
        let found = Written::of(&arm(section, load, &format!("ancf.elements = {elements}")));
        found.ends("probes.csv", &[("tip.x", tip[0]), ("tip.y", tip[1])], allowed);
    }
}

/// One of two equal layers is heated between two of the even places of `shape.csv`. Nothing else acts: with ε₀ the layers strain along
/// a line ε₀ (1/2 + 3/4 z/H) through their height 2 H, z from their middle, and the stresses of the cold one are E ε₀ (−1/4, 1/2) at its faces,
/// those of the heated one E ε₀ (−1/2, 1/4). At the ends of the range the tangents of both sides are one; in its middle its strain ε₀/2 is seen.
#[test]
fn a_short_heated_range_has_the_largest_stress() {
    let section = "section.layers = [{ width = 0.02, height = 0.01, youngs_modulus = 70e9 }, { width = 0.02, height = 0.01, youngs_modulus = 70e9 }]";
    let load = "effect.actuation = [{ beam = 'arm', layer = 2, strain = 1e-3, from = 0.5012, to = 0.5042 }]";
    let found = Written::of(&arm(section, load, "ancf.nodes = [0, 0.5012, 0.5042, 1]"));
    let [layer, s, bottom, top] =
        ["layer", "s", "stress_bottom", "stress_top"].map(|name| found.column("layers.csv", name));
    let within: Vec<usize> =
        (0..s.len()).filter(|i| (0.50119..0.50421).contains(&s[*i]) && top[*i].abs() > 1e6).collect();
    assert_eq!(within.len(), 6, "{within:?}");
    let strains = found.column("shape.csv", "strain");
    let largest = strains.iter().fold(0.0_f64, |most, strain| most.max(*strain));
    near(largest / 5e-4, 1.0, 1e-3, "strain");
    for i in within {
        let faces = if layer[i] < 1.5 { [-17.5e6, 35e6] } else { [-35e6, 17.5e6] };
        near(bottom[i], faces[0], 1e4, "stress_bottom");
        near(top[i], faces[1], 1e4, "stress_top");
    }
    for (i, s) in s.iter().enumerate().filter(|(_, s)| !(0.5012..=0.5042).contains(*s)) {
        assert!(bottom[i].abs().max(top[i].abs()) < 1e4, "{s}: {} and {}", bottom[i], top[i]);
    }
}

/// What is imposed on a range between two of the even places of `shape.csv` has a row in its middle; where the range has such a place, no other one
/// is needed.
#[test]
fn a_short_range_has_a_row_inside() {
    for (from, to, rows) in [(0.5012, 0.5042, 202), (0.0, 0.003, 202), (0.4999, 0.5001, 201)] {
        let load = format!(
            "effect.actuation = [{{ beam = 'arm', strain = 5e-4, curvature = 2, from = {from}, to = {to} }}]"
        );
        let nodes: Vec<String> =
            [0.0, from, to, 1.0].iter().skip(usize::from(from == 0.0)).map(f64::to_string).collect();
        let found = Written::of(&arm(
            "axial_stiffness = 1e6, bending_stiffness = 1",
            &load,
            &format!("ancf.nodes = [{}]", nodes.join(", ")),
        ));
        let [s, strain, curvature] = ["s", "strain", "curvature"].map(|name| found.column("shape.csv", name));
        assert_eq!(s.len(), rows, "{from} to {to}");
        let middle = (0..s.len()).find(|i| (s[*i] - 0.5 * (from + to)).abs() < 1e-9).expect("a row inside");
        near(strain[middle] / 5e-4, 1.0, 1e-3, "strain");
        near(curvature[middle] / 2.0, 1.0, 1e-3, "curvature");
    }
}

/// A tube of diameter D and wall w bends under a force F at its end: σ = ∓F L (D/2)/I with I = π (D⁴ − (D − 2 w)⁴)/64 at its root.
#[test]
fn faces_of_a_tube_carry_what_bends_it() {
    let section = "youngs_modulus = '1e14 Pa', section.tube = { diameter = 0.02, wall = 0.003 }";
    let load = "effect.force = [{ beam = 'arm', at = 'end', value = [0, -2] }]";
    let found = Written::of(&arm(section, load, "ancf.elements = 4"));
    let stress = 2.0 * 0.01 / (PI * (0.02_f64.powi(4) - 0.014_f64.powi(4)) / 64.0);
    let [bottom, top] = ["stress_bottom", "stress_top"].map(|name| found.column("shape.csv", name)[0]);
    near(bottom / -stress, 1.0, 1e-4, "stress_bottom");
    near(top / stress, 1.0, 1e-4, "stress_top");
}

/// A column of EI = (1 + s/4)² on hinges: with z = 1 + s/4 its shape is √z sin(β ln z), β = nπ/ln 1.25,
/// under P = (β² + ¼)/16.
#[test]
fn a_tapered_column_buckles_as_euler_said() {
    let found = Written::of(
        "beam.column = { start = [0, 0], end = [0, 1], axial_stiffness = 1e8, bending_stiffness = { polynomial = [1, 0.5, 0.0625] }, basis.rpim.nodes = 15 }
        support = [{ beam = 'column', at = 'start', fix = ['x', 'y'] }, { beam = 'column', at = 'end', fix = ['x'] }]
        effect.force = [{ beam = 'column', at = 'end', value = [0, -1] }]
        analysis.buckling.count = 2\n",
    );
    for (n, load) in (1..).zip(found.column("load_factors.csv", "load_factor")) {
        let beta = f64::from(n) * PI / 1.25_f64.ln();
        near(load / ((beta * beta + 0.25) / 16.0), 1.0, 1e-7, "load_factor");
    }
}

/// A probe at 0.3 m of a cantilever of 1 m under (5, −2) N: N = 5, Q = −2, M = −2 · 0.7 at full load,
/// in proportion before; the stresses on its faces are N/A ± 6 M/(b h²). The summary has the forces
/// of the support.
#[test]
fn sections_at_probes_carry_what_is_beyond_them() {
    let section = "youngs_modulus = '1e14 Pa', section.rectangle = { width = 0.02, height = 0.01 }";
    let loads = "effect.force = [{ beam = 'arm', at = 'end', value = [5, -2] }]\noutput = { section_forces = true, reactions = true, states = true, vtu = true }";
    let text = arm(section, loads, "ancf.elements = 4")
        .replace("name = 'tip', beam = 'arm', at = 'end'", "name = 'inner', beam = 'arm', at = 0.3")
        .replace("analysis.static = {}", "analysis.static.steps = 2");
    let found = Written::of(&text);
    let (load, moment) =
        (found.column("probes.csv", "load"), found.column("probes.csv", "inner.bending_moment"));
    assert_eq!(load.len(), 3);
    for (load, moment) in load.iter().zip(&moment) {
        near(*moment, -1.4 * load, 1e-4, "bending_moment");
    }
    found.ends("probes.csv", &[("inner.axial_force", 5.0), ("inner.shear_force", -2.0)], 1e-4);
    let (pull, bend) = (5.0 / 2e-4, -6.0 * 1.4 / (0.02 * 1e-4));
    found.ends(
        "probes.csv",
        &[("inner.stress_bottom", pull + bend), ("inner.stress_top", pull - bend)],
        100.0,
    );
    near(found.said("/probes/inner/bending_moment"), -1.4, 1e-4, "bending_moment");
    near(found.said("/probes/inner/axial_force"), 5.0, 1e-4, "axial_force");
    near(found.said("/probes/inner/shear_force"), -2.0, 1e-4, "shear_force");
    near(found.said("/probes/inner/stress_bottom"), pull + bend, 100.0, "stress_bottom");
    near(found.said("/probes/inner/stress_top"), pull - bend, 100.0, "stress_top");
    for (name, expected) in [("fx", -5.0), ("fy", 2.0), ("moment", 2.0)] {
        near(found.said(&format!("/reactions/support1/{name}")), expected, 1e-4, name);
    }
    let (s, moment) = (found.column("states.csv", "s"), found.column("states.csv", "bending_moment"));
    assert_eq!(s.len(), 3 * 101);
    let last = 2 * 101;
    for i in 0..101 {
        near(moment[last + i], -2.0 * (1.0 - s[last + i]), 1e-4, "bending_moment");
        near(moment[101 + i], -(1.0 - s[last + i]), 1e-4, "bending_moment");
    }
    found.ends("states.csv", &[("axial_force", 5.0), ("shear_force", -2.0), ("stress_top", pull)], 100.0);
    for name in ["angle", "strain", "curvature"] {
        // Of shape.csv every second place; at its end both have the tip.
        near(found.last("states.csv", name), found.last("shape.csv", name), 1e-15, name);
    }
    let plain = Written::of(&text.replace("section_forces = true, ", ""));
    assert!(!plain.header("probes.csv").iter().any(|name| name.ends_with("force")));
}

/// A rod that spins about its start at 3 rad/s pulls its section at s by ½ ρA ω² (L² − s²), at all
/// times, and moves there at ω s.
#[test]
fn sections_of_a_spinning_rod_hold_what_is_beyond_them() {
    let text = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e7, bending_stiffness = 1e3, mass_per_length = 2, basis.ancf.elements = 6 }
        support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]
        probe = [{ name = 'inner', beam = 'rod', at = 0.4 }]
        effect.damping = [{ beam = 'rod', strain = 1e-3 }]
        initial_velocity = [{ beam = 'rod', rotation = 3 }]
        output = { section_forces = true, states = true }
        analysis.dynamic = { duration = 0.5, output_every = 0.1, radau.tolerance = 1e-9 }\n";
    let found = Written::of(text);
    for force in found.column("probes.csv", "inner.axial_force").iter().skip(1) {
        near(*force, 9.0 * (1.0 - 0.16), 0.05, "axial_force");
    }
    let column = |name: &str| found.column("states.csv", name);
    let (s, angle, vx, vy) = (column("s"), column("angle"), column("vx"), column("vy"));
    assert_eq!(s.len(), 6 * 101);
    for i in 0..s.len() {
        near(vx[i], -3.0 * s[i] * angle[i].sin(), 2e-3, "vx");
        near(vy[i], 3.0 * s[i] * angle[i].cos(), 2e-3, "vy");
    }
    near(*angle.last().expect("a row"), 1.5, 1e-3, "angle");
}

/// A contact keeps a round rod at the distance of its radius, unless it says another one.
#[test]
fn a_contact_touches_the_surface_of_a_section() {
    let half = |contact: &str| {
        let text = arm(
            "youngs_modulus = 1e9, section.circle = { diameter = 0.02 }",
            &format!(
                "effect.contact = [{{ beam = 'arm', half_plane = {{ point = [0, -1], normal = [0, 1] }}, stiffness = 1e5{contact} }}]"
            ),
            "ancf.elements = 4",
        );
        format!("{:?}", parse("arm.toml", &text).expect("a scene").model().parts[0])
    };
    assert!(half("").contains("half_thickness: 0.01"), "{}", half(""));
    assert!(half(", half_thickness = 0.3").contains("half_thickness: 0.3"));
    let tapered = arm(
        "youngs_modulus = 1e9, section.circle = { diameter = { table = { s = [0, 1], value = [0.02, 0.01] } } }",
        "effect.contact = [{ beam = 'arm', half_plane = { point = [0, -1], normal = [0, 1] }, stiffness = 1e5 }]",
        "ancf.elements = 4",
    );
    let error = parse("arm.toml", &tapered).expect_err("tapered").to_string();
    assert!(error.contains("not everywhere equally far") && error.contains("half_thickness"), "{error}");
}

/// What cannot be, each with its place and a way out.
#[test]
fn impossible_sections_are_refused() {
    for (section, said) in [
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = [0, 0.9], value = [2, 1] } }",
            "ends at 0.9 m, before the end",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = [0.1, 1], value = [2, 1] } }",
            "begins at 0.1 m, after the start",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = [0, 1, 1], value = [2, 1, 1] } }",
            "arc lengths must rise; 1 m follows 1 m",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = [0, 1], value = [2, 1, 1] } }",
            "2 places and 3 values",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = ['end', 1], value = [2, 1] } }",
            "arc lengths must rise; 1 m follows 1 m",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { pieces = { until = ['start', 1], value = [2, 1] } }",
            "the first piece has no length",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { table = { s = [0, 1], value = [2, -1] } }",
            "found -1, expected a positive",
        ),
        ("axial_stiffness = 1, bending_stiffness = { polynomial = [1, -4, 3.9] }", "reaches -2.56"),
        ("axial_stiffness = 1, bending_stiffness = { polynomial = [] }", "without coefficients"),
        (
            "axial_stiffness = 1, bending_stiffness = { pieces = { until = [0.5], value = [1] } }",
            "2 pieces on the beam",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { pieces = { until = [0.5, 1.2, 1.4], value = [1, 2, 3] } }",
            "begins beyond the end",
        ),
        (
            "axial_stiffness = 1, bending_stiffness = { pieces = { until = [0], value = [1, 2] } }",
            "the first piece has no length",
        ),
        ("axial_stiffness = 1, bending_stiffness = {}", "is an empty table"),
        (
            "axial_stiffness = 1, bending_stiffness = { polynomial = [1], pieces = { until = [], value = [1] } }",
            "varies in more than one way",
        ),
        ("youngs_modulus = 1, section = {}", "an empty `section`"),
        (
            "youngs_modulus = 1, section = { circle = { diameter = 1 }, tube = { diameter = 1, wall = 0.1 } }",
            "more than one shape",
        ),
        ("youngs_modulus = 1, section.tube = { diameter = 1, wall = 0.6 }", "overlap"),
        (
            "youngs_modulus = 1, area = 1, section.circle = { diameter = 1 }",
            "`area` twice: by itself, and by the shape",
        ),
        (
            "youngs_modulus = 1, bending_stiffness = 1, section.circle = { diameter = 1 }",
            "`bending_stiffness` twice",
        ),
        (
            "youngs_modulus = 1, section.layers = [{ youngs_modulus = 1, width = 1, height = 1 }]",
            "`youngs_modulus` beside layers",
        ),
        ("section.layers = []", "without any layer"),
        (
            "section.layers = [{ youngs_modulus = 1, width = 1, height = 1 }, { youngs_modulus = 1, width = 1, height = 1, offset = 1 }]",
            "some layers have what this one has not",
        ),
    ] {
        let error = parse("arm.toml", &arm(section, "", "ancf.elements = 4")).expect_err(section).to_string();
        assert!(error.contains(said) && error.contains("arm.toml:1:"), "{section}: {error}");
    }
    let damped = arm(
        "section.layers = [{ youngs_modulus = 1e9, density = 1, width = 1, height = 1 }, { youngs_modulus = 2e9, density = 1, width = 1, height = 1 }]",
        "effect.damping = [{ beam = 'arm', strain = 0.1 }]",
        "ancf.elements = 4",
    )
    .replace("analysis.static = {}", "analysis.dynamic.duration = 1");
    let scene = parse("arm.toml", &damped).expect("a scene");
    let error = scene.model().solve(scene.analysis()).expect_err("coupled").to_string();
    assert!(error.contains("damped by different times"), "{error}");
}

/// A bent laminate is free of stress in its own shape: without a load it stays there, and has no energy.
#[test]
fn a_bent_laminate_rests_in_its_shape() {
    for strain in ["green", "engineering"] {
        let found = Written::of(&format!(
            "beam.arch = {{ arc = {{ center = [0, 0], radius = 1, from = '180 deg', to = '0 deg' }}, strain = '{strain}', basis.ancf.elements = 8, \
             section.layers = [{{ youngs_modulus = 1e6, width = 0.02, height = 0.01 }}, {{ youngs_modulus = 3e6, width = 0.02, height = 0.02 }}] }}
             support = [{{ beam = 'arch', at = 'start', fix = ['x', 'y', 'angle'] }}]
             probe = [{{ name = 'tip', beam = 'arch', at = 'end' }}]
             analysis.static = {{}}\n"
        ));
        found.ends("probes.csv", &[("tip.x", 1.0), ("tip.y", 0.0)], 1e-9);
        found.ends("energy.csv", &[("stretch", 0.0), ("bend", 0.0), ("total", 0.0)], 1e-12);
    }
}

/// A table may be that of a longer beam: what it says beyond the ends is not asked for, even where
/// the walls would overlap there.
#[test]
fn a_table_may_go_on_beyond_the_ends() {
    let tip = |wall: &str| {
        let section = format!(
            "section.tube = {{ diameter = 0.02, wall = {wall} }}, youngs_modulus = 1e9, density = 1500"
        );
        let pull = "effect.force = [{ beam = 'arm', at = 'end', value = [0, -1] }]";
        Written::of(&arm(&section, pull, "ancf.elements = 4")).said("/probes/tip/y")
    };
    for wall in [
        "{ table = { s = [0, 1, 3], value = [0.002, 0.002, 0.05] } }",
        "{ table = { s = [-2, 0, 1], value = [0.05, 0.002, 0.002] } }",
    ] {
        near(tip(wall), tip("0.002"), 1e-12, wall);
    }
}
