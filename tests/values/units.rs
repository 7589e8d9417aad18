//! Units: each name and each prefix that a scene may use, by the definitions of the SI and of the
//! international yard and pound.

use ancf::scene::parse;

/// The length and the bending stiffness of a beam in SI, as the scene is read.
fn read(length: &str, bending: &str) -> (f64, f64) {
    let text = format!(
        "beam.a = {{ start = [0, 0], end = ['{length}', 0], axial_stiffness = 1, bending_stiffness = '{bending}', \
         basis.ancf.elements = 1 }}\nsupport = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.static = {{}}"
    );
    let scene = parse("units.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let beam = &scene.model().beams[0];
    let ancf::model::Centreline::Line { end, .. } = &beam.centreline else { panic!("a line") };
    (
        end[0],
        beam.section.bending_stiffness.as_ref().and_then(ancf::model::Along::constant).expect("is named"),
    )
}

fn same(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{what}: {found}, not {expected}");
}

/// Would catch a prefix that is another power of ten.
#[test]
fn prefixes_are_powers_of_ten() {
    for (prefix, power) in [
        ("f", -15),
        ("p", -12),
        ("n", -9),
        ("u", -6),
        ("µ", -6),
        ("μ", -6),
        ("m", -3),
        ("c", -2),
        ("d", -1),
        ("da", 1),
        ("h", 2),
        ("k", 3),
        ("M", 6),
        ("G", 9),
        ("T", 12),
    ] {
        let (length, bending) = read(&format!("3 {prefix}m"), &format!("7 {prefix}N m^2"));
        let factor: f64 = format!("1e{power}").parse().expect("a power");
        same(length, 3.0 * factor, prefix);
        same(bending, 7.0 * factor, prefix);
        // A power of a unit takes its prefix with it.
        let (_, bending) = read("1 m", &format!("7 MN {prefix}m^2"));
        same(bending, 7e6 * factor * factor, prefix);
    }
}

/// Each unit's name in a product that is a bending stiffness \[N m²\], with its definition: would
/// catch any factor or power that is another, and a name of the list that is not tried.
#[test]
fn units_have_their_defined_factors() {
    let (inch, foot, pound, gravity) = (0.0254, 0.3048, 0.453_592_37, 9.806_65);
    let degree = std::f64::consts::PI / 180.0;
    let tried = [
        ("m", "N m^2", 1.0),
        ("g", "g m^3 s^-2", 1e-3),
        ("s", "kg m^3 / s^2", 1.0),
        ("N", "N m m", 1.0),
        ("Pa", "Pa m^4", 1.0),
        ("J", "J m", 1.0),
        ("W", "W s m", 1.0),
        ("Hz", "J m Hz s", 1.0),
        ("A", "V A s m", 1.0),
        ("V", "kV^2 F m", 1e6),
        ("F", "V^2 F m", 1.0),
        ("bar", "bar m^4", 1e5),
        ("t", "t m^3 s^-2", 1e3),
        ("min", "kg m^3 min^-2", 1.0 / 3600.0),
        ("h", "kg m^3 h^-2", 1.0 / 12_960_000.0),
        ("rad", "N m^2 rad rad^-1", 1.0),
        ("deg", "N m^2 deg rad^-1", degree),
        ("°", "N m^2 ° rad^-1", degree),
        ("turn", "N m^2 turn rad^-1", 360.0 * degree),
        ("rev", "N m^2 rev rad^-1", 360.0 * degree),
        ("rpm", "N m^2 s rpm rad^-1", 6.0 * degree),
        ("in", "N in^2", inch * inch),
        ("ft", "N ft^2", foot * foot),
        ("lb", "lb m^3 s^-2", pound),
        ("lbf", "lbf in^2", pound * gravity * inch * inch),
        ("kgf", "kgf m^2", gravity),
        ("psi", "psi in^4", pound * gravity * inch * inch),
    ];
    for (name, unit, factor) in tried {
        let (_, bending) = read("1 m", &format!("5 {unit}"));
        same(bending, 5.0 * factor, name);
    }
    // The message about an unknown unit lists all that there are.
    let text =
        "beam.a = { start = [0, 0], end = ['1 xyz', 0], basis.ancf.elements = 1 }\nanalysis.static = {}";
    let message = parse("units.toml", text).expect_err("no unit").to_string();
    let listed = message.split_once("there are ").and_then(|(_, rest)| rest.split_once(", with SI"));
    let listed = listed.unwrap_or_else(|| panic!("{message}")).0;
    for name in listed.split(", ") {
        assert!(tried.iter().any(|(tried, ..)| *tried == name), "the unit {name} has no value test");
    }
}
