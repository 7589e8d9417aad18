//! Faults of beams, supports, probes, bases and analyses: what is refused, at which
//! line and column, in which words. The snapshot of `cli::messages` holds others with their help.

use ancf::scene::parse;

const BASE: &str = r#"title = "Cantilever"

[beam.arm]
start = [0.0, 0.0]
end = ["1.8 m", 0.0]
axial_stiffness = 1e4
bending_stiffness = 2.0
mass_per_length = 0.5

[beam.arm.basis.ancf]
elements = 3

[[support]]
beam = "arm"
at = "start"
fix = ["x", "y", "angle"]

[[effect.force]]
beam = "arm"
at = "end"
value = [0.0, "-5 N"]

[[probe]]
name = "tip"
beam = "arm"
at = "end"

[analysis.static]
"#;

/// Title, what stands in the legal scene with what is put in its place, and the message behind the
/// name of the file.
type Case = (&'static str, &'static [(&'static str, &'static str)], &'static str);

const CASES: &[Case] = &[
    (
        "EI given twice",
        &[("bending_stiffness = 2.0", "youngs_modulus = 1.0\nsecond_moment = 2.0\nbending_stiffness = 2.0")],
        "9:21: beam `arm` has `bending_stiffness` twice: by itself, and as `youngs_modulus` times `second_moment`",
    ),
    (
        "mass given twice",
        &[("mass_per_length = 0.5", "area = 2.0\ndensity = 4.0\nmass_per_length = 0.5")],
        "10:19: beam `arm` has `mass_per_length` twice: by itself, and as `density` times `area`",
    ),
    (
        "modulus without area",
        &[("axial_stiffness = 1e4\n", "youngs_modulus = 2.0\n")],
        "6:18: beam `arm` has a `youngs_modulus` but no `area`: is it to stretch?",
    ),
    (
        "area without modulus",
        &[(
            "axial_stiffness = 1e4\nbending_stiffness = 2.0\nmass_per_length = 0.5",
            "area = 2.0\ndensity = 4.0",
        )],
        "6:8: beam `arm` has an `area` but no `youngs_modulus`: is it to stretch or bend?",
    ),
    (
        "section without modulus",
        &[(
            "axial_stiffness = 1e4\nbending_stiffness = 2.0\nmass_per_length = 0.5",
            "density = 4.0\nsection.circle.diameter = 0.1",
        )],
        "7:1: beam `arm` has a `section` but no `youngs_modulus`: is it to stretch or bend?",
    ),
    (
        "section that only stretches",
        &[("bending_stiffness = 2.0\nmass_per_length = 0.5", "density = 4.0\nsection.circle.diameter = 0.1")],
        "8:1: beam `arm` has a `section` but no `youngs_modulus`: is it to bend?",
    ),
    (
        "second moment without modulus",
        &[("bending_stiffness = 2.0", "second_moment = 2.0")],
        "7:17: beam `arm` has a `second_moment` but no `youngs_modulus`: is it to bend?",
    ),
    (
        "no mass to vibrate",
        &[("mass_per_length = 0.5\n", ""), ("[analysis.static]", "[analysis.modal]\ncount = 1")],
        "3:7: beam `arm` has no mass, which a modal analysis needs",
    ),
    (
        "no mass to move",
        &[("mass_per_length = 0.5\n", ""), ("[analysis.static]", "[analysis.dynamic]\nduration = 1")],
        "3:7: beam `arm` has no mass, which a dynamic analysis needs",
    ),
    (
        "no mass to weigh",
        &[
            ("mass_per_length = 0.5\n", ""),
            ("[analysis.static]", "[effect.gravity]\nacceleration = [0, -9.81]\n[analysis.static]"),
        ],
        "3:7: beam `arm` has no mass, which gravity needs",
    ),
    (
        "buckling of a string",
        &[("[analysis.static]", "[analysis.buckling]\ncount = 1"), ("bending_stiffness = 2.0\n", "")],
        "3:7: beam `arm` has no bending stiffness: it resists nothing across it before it is loaded, and a buckling analysis starts from the unloaded structure",
    ),
    ("nothing is fixed", &[(r#"fix = ["x", "y", "angle"]"#, "fix = []")], "16:7: this support fixes nothing"),
    (
        "angle and gradient",
        &[(r#"fix = ["x", "y", "angle"]"#, r#"fix = ["x", "gradient", "angle"]"#)],
        "16:25: this support fixes one quantity twice",
    ),
    (
        "x twice",
        &[(r#"fix = ["x", "y", "angle"]"#, r#"fix = ["x", "y", "x"]"#)],
        "16:18: this support fixes one quantity twice",
    ),
    (
        "y twice",
        &[(r#"fix = ["x", "y", "angle"]"#, r#"fix = ["y", "y", "x"]"#)],
        "16:13: this support fixes one quantity twice",
    ),
    (
        "moves y",
        &[(r#"fix = ["x", "y", "angle"]"#, "fix = [\"x\", \"angle\"]\nmove = { y = 1 }")],
        "17:14: `move.y` of a quantity that this support does not fix",
    ),
    (
        "turns what is free",
        &[(r#"fix = ["x", "y", "angle"]"#, "fix = [\"x\", \"y\"]\nmove = { angle = 1 }")],
        "17:18: `move.angle` of a quantity that this support does not fix",
    ),
    (
        "spins what is free",
        &[(
            r#"fix = ["x", "y", "angle"]"#,
            "fix = [\"x\", \"y\"]\nmove = { spin_up = { speed = 1, duration = 1 } }",
        )],
        "17:20: `move.spin_up` of a quantity that this support does not fix",
    ),
    ("a probe without name", &[(r#"name = "tip""#, r#"name = " ""#)], r#"24:8: " " cannot name a probe"#),
    (
        "a probe of two lines",
        &[(r#"name = "tip""#, "name = \"a\\nb\"")],
        "24:8: \"a\\nb\" cannot name a probe",
    ),
    (
        "two beams that are too many",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.ancf]\nelements = 6_000_000\n[beam.leg]\nstart = [0, 0]\nend = [0, 1]\naxial_stiffness = 1\nbending_stiffness = 1\nbasis.ancf.elements = 6_000_000",
        )],
        "17:1: the scene asks for 12000002 nodes, which need about 1.323e1 GiB",
    ),
    (
        "wide supports",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.rpim]\nnodes = 20_000_000\nneighbours = 3",
        )],
        "10:11: the scene asks for 20000000 nodes, which need about 1.132e2 GiB",
    ),
    (
        "an empty basis",
        &[("[beam.arm.basis.ancf]\nelements = 3", "[beam.arm.basis]")],
        "10:1: beam `arm` has an empty `basis`",
    ),
    (
        "elements and nodes",
        &[("elements = 3", "elements = 3\nnodes = 4")],
        "11:12: beam `arm` has both `elements` and `nodes`",
    ),
    (
        "neither elements nor nodes",
        &[("elements = 3", r#"spacing = "uniform""#)],
        "10:1: beam `arm`: ancf needs `elements` or `nodes`",
    ),
    (
        "neighbours",
        &[("[beam.arm.basis.ancf]\nelements = 3", "[beam.arm.basis.rpim]\nnodes = 5\nneighbours = 17")],
        "12:14: found 17 neighbours on each side",
    ),
    (
        "terms",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.rpim]\nnodes = 3\nneighbours = 4\npolynomial_terms = 7",
        )],
        "13:20: 7 polynomial terms, but the smallest support has 3 nodes",
    ),
    (
        "Gauss points",
        &[("elements = 3", "elements = 3\ngauss_points = { stretch = 3, bend = 65 }")],
        "12:38: found 65 Gauss points in a cell",
    ),
    (
        "Lobatto",
        &[(
            "elements = 3",
            "elements = 3\ngauss_points = { stretch = 1, bend = 2, stretch_rule = \"lobatto\" }",
        )],
        "12:28: found 1 point by Lobatto's rule",
    ),
    (
        "thin plate",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.rpim]\nnodes = 5\nkernel.thin_plate_spline.exponent = 3",
        )],
        "12:37: thin plate spline exponent 3",
    ),
    (
        "q = 0",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.rpim]\nnodes = 5\nkernel.multiquadric = { q = 0, shape = 1 }",
        )],
        "12:29: multiquadric exponent q = 0",
    ),
    (
        "two kernels",
        &[(
            "[beam.arm.basis.ancf]\nelements = 3",
            "[beam.arm.basis.rpim]\nnodes = 5\nkernel = { wendland = { radius = 3 }, exponential = { shape = 1 } }",
        )],
        "12:10: `kernel` must name exactly one radial function",
    ),
    (
        "spacing of given nodes",
        &[("elements = 3", "nodes = [0, 1, 1.8]\nspacing = \"chebyshev\"")],
        "12:11: beam `arm`: `spacing` beside a list of nodes",
    ),
    ("one node", &[("elements = 3", "nodes = [0]")], "11:9: expected 2 nodes or more, found 1"),
    (
        "one node by number",
        &[("elements = 3", "nodes = 1")],
        r#"11:9: `beam.arm.basis.ancf.nodes`: found 1, expected a number of nodes, 2 or more, or a list of arc lengths such as [0.0, "45 cm", 1.8]"#,
    ),
    (
        "first node",
        &[("elements = 3", "nodes = [0.1, 1, 1.8]")],
        "11:10: the first node is at 0.1 m, not at 0",
    ),
    (
        "nodes that fall at the end",
        &[("elements = 3", "nodes = [0, 1.79999999950, 1.8, 1.80000000050]")],
        "11:9: two nodes coincide at an end of the beam",
    ),
    ("no such mode", &[("[analysis.static]", "[analysis.modal]\ncount = 17")], "29:9: found 17 modes"),
    (
        "tolerance",
        &[("[analysis.static]", "[analysis.static]\ntolerance = 1.0")],
        "29:13: found the relative tolerance 1",
    ),
    (
        "steps on a path",
        &[("[analysis.static]", "[analysis.static]\nsteps = 3\narc_length.until_load = 1")],
        "29:9: `steps` beside `arc_length`",
    ),
    (
        "load steps",
        &[("[analysis.static]", "[analysis.static]\nsteps = 1_000_001")],
        "29:9: found 1000001 load steps",
    ),
    (
        "points",
        &[("[analysis.static]", "[analysis.static]\narc_length.max_points = 1_000_001")],
        "29:25: found 1000001 points on the path",
    ),
    (
        "unknown probe",
        &[("[analysis.static]", "[analysis.static]\narc_length.until_probe = { probe = \"tap\", y = 1 }")],
        "29:36: there is no probe named `tap`",
    ),
    (
        "a target without axis",
        &[("[analysis.static]", "[analysis.static]\narc_length.until_probe = { probe = \"tip\" }")],
        "29:36: a probe's target needs either `x` or `y`",
    ),
    (
        "a target with both axes",
        &[(
            "[analysis.static]",
            "[analysis.static]\narc_length.until_probe = { probe = \"tip\", x = 1, y = 1 }",
        )],
        "29:36: a probe's target needs either `x` or `y`",
    ),
    ("nothing to analyse", &[("[analysis.static]", "[analysis]")], "28:1: `analysis` is empty"),
    (
        "records too rare",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\noutput_every = 2.1")],
        "30:16: output_every = 2.1 s is longer than duration = 2 s",
    ),
    (
        "too many records",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\noutput_every = 1.9e-6")],
        "30:16: duration / output_every = 1.053e6 records",
    ),
    (
        "spectral radius",
        &[(
            "[analysis.static]",
            "[analysis.dynamic]\nduration = 2\ngeneralized_alpha = { step = 0.1, spectral_radius = 1.1 }",
        )],
        "30:53: found the spectral radius 1.1",
    ),
    (
        "negative spectral radius",
        &[(
            "[analysis.static]",
            "[analysis.dynamic]\nduration = 2\ngeneralized_alpha = { step = 0.1, spectral_radius = -0.1 }",
        )],
        "30:53: found the spectral radius -0.1",
    ),
    (
        "Newton's tolerance",
        &[(
            "[analysis.static]",
            "[analysis.dynamic]\nduration = 2\ngeneralized_alpha = { tolerance = 1e-3, newton_tolerance = 1e-9 }",
        )],
        "30:60: found `newton_tolerance` beside `tolerance`",
    ),
    (
        "two integrators",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\ngauss.step = 0.1\nradau.step = 0.1")],
        "28:1: more than one integrator",
    ),
    (
        "a long step",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nradau.step = 2.1")],
        "30:14: a step of 2.1 s in a duration of 2 s",
    ),
    (
        "a short step",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nradau.step = 1.9e-9")],
        "30:14: a step of 0.0000000019 s in a duration of 2 s",
    ),
    (
        "step and tolerance",
        &[(
            "[analysis.static]",
            "[analysis.dynamic]\nduration = 2\nradau = { step = 0.1, tolerance = 1e-3 }",
        )],
        "30:18: both `step` and `tolerance`",
    ),
    (
        "relative tolerance",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nradau.tolerance = 1")],
        "30:19: found the relative tolerance 1",
    ),
    (
        "no stages",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nradau = { stages = 1, step = 0.1 }")],
        "30:20: `analysis.dynamic.radau.stages`: found 1, expected a whole number, 2 or more",
    ),
    (
        "an event of no quantity",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nevent = [{ probe = \"tip\" }]")],
        "30:20: an event needs exactly one quantity of its probe; found 0",
    ),
    (
        "an event of no probe",
        &[("[analysis.static]", "[analysis.dynamic]\nduration = 2\nevent = [{ probe = \"tup\", x = 1 }]")],
        "30:20: there is no probe named `tup`",
    ),
];

/// The scene is legal before the changes, and refused for each with this message at this place.
#[test]
fn each_fault_is_told_with_its_place() {
    parse("arm.toml", BASE).unwrap_or_else(|error| panic!("{error}"));
    for (title, changes, message) in CASES {
        let text = changes.iter().fold(BASE.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{title}: {from}");
            text.replacen(from, to, 1)
        });
        let error = parse("arm.toml", &text).err().unwrap_or_else(|| panic!("{title}: not refused\n{text}"));
        let error = error.to_string();
        assert_eq!(error.lines().next(), Some(&*format!("arm.toml:{message}")), "{title}");
    }
}
