//! Faults of what acts on beams, and of second supports and joints: what is refused, at which
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
        "two measures of damping",
        &[(
            "[[probe]]",
            "[[effect.damping]]\nbeam = \"arm\"\nstiffness_proportional = 1\nstrain = 1\n\n[[probe]]",
        )],
        "25:26: `stiffness_proportional` stands for `strain` and `curvature`",
    ),
    (
        "two measures of damping, by curvature",
        &[(
            "[[probe]]",
            "[[effect.damping]]\nbeam = \"arm\"\nstiffness_proportional = 1\ncurvature = 1\n\n[[probe]]",
        )],
        "25:26: `stiffness_proportional` stands for `strain` and `curvature`",
    ),
    (
        "a spring of nothing",
        &[("[[probe]]", "[[effect.spring]]\nbeam = \"arm\"\nat = \"end\"\n\n[[probe]]")],
        "24:8: this spring does nothing",
    ),
    (
        "a negative length",
        &[(
            "[[probe]]",
            "[[effect.spring]]\nbeam = \"arm\"\nat = \"end\"\nstiffness = 1\nanchor = [0, 1]\nlength = -0.1\n\n[[probe]]",
        )],
        "28:10: a spring's length cannot be negative",
    ),
    (
        "a torsion spring of nothing",
        &[("[[probe]]", "[[effect.torsion_spring]]\nbeam = \"arm\"\nat = \"end\"\n\n[[probe]]")],
        "24:8: this spring does nothing",
    ),
    (
        "a mass of nothing",
        &[("[[probe]]", "[[effect.point_mass]]\nbeam = \"arm\"\nat = \"end\"\n\n[[probe]]")],
        "24:8: this mass does nothing",
    ),
    (
        "no foundation",
        &[("[[probe]]", "[[effect.foundation]]\nbeam = \"arm\"\nstiffness = [0, 0]\n\n[[probe]]")],
        "25:13: a foundation needs a positive stiffness",
    ),
    (
        "a negative foundation",
        &[("[[probe]]", "[[effect.foundation]]\nbeam = \"arm\"\nstiffness = [1, -1]\n\n[[probe]]")],
        "25:13: a foundation needs a positive stiffness",
    ),
    (
        "actuation of nothing",
        &[("[[probe]]", "[[effect.actuation]]\nbeam = \"arm\"\n\n[[probe]]")],
        "24:8: this actuation does nothing",
    ),
    (
        "drag of nothing",
        &[("[[probe]]", "[[effect.drag]]\nbeam = \"arm\"\nflow = [1, 1]\n\n[[probe]]")],
        "24:8: this drag does nothing",
    ),
    (
        "a force that stays",
        &[("[[probe]]", "[[effect.moving_force]]\nbeam = \"arm\"\nvalue = [0, 1]\nspeed = 0\n\n[[probe]]")],
        "26:9: a moving force needs a speed",
    ),
    (
        "two obstacles",
        &[(
            "[[probe]]",
            "[[effect.contact]]\nbeam = \"arm\"\nstiffness = 1\ncircle = { center = [0, -2], radius = 1 }\nhalf_plane = { point = [0, -1], normal = [0, 1] }\n\n[[probe]]",
        )],
        "24:8: a contact needs exactly one obstacle",
    ),
    (
        "a normal of no length",
        &[(
            "[[probe]]",
            "[[effect.contact]]\nbeam = \"arm\"\nstiffness = 1\nhalf_plane = { point = [0, -1], normal = [0, 0] }\n\n[[probe]]",
        )],
        "26:42: a normal of no length",
    ),
    (
        "a flat box",
        &[(
            "[[probe]]",
            "[[effect.contact]]\nbeam = \"arm\"\nstiffness = 1\nbox = { center = [0, -2], size = [1, 0] }\n\n[[probe]]",
        )],
        "26:34: a box needs positive sides",
    ),
    (
        "friction by velocity",
        &[(
            "[[probe]]",
            "[[effect.contact]]\nbeam = \"arm\"\nstiffness = 1\nfriction = { coefficient = 1, velocity = 1 }\ncircle = { center = [0, -2], radius = 1 }\n\n[[probe]]",
        )],
        "26:42: friction has no `velocity`: it sticks by elastic springs",
    ),
    (
        "a direction of no length",
        &[(
            "[[probe]]",
            "[[joint]]\ntype = \"slider\"\nfirst = { beam = \"arm\", at = \"end\" }\nalong = [0, 0]\n\n[[probe]]",
        )],
        "26:9: a direction of no length",
    ),
    (
        "a weld along a line",
        &[(
            "[[probe]]",
            "[[joint]]\ntype = \"weld\"\nfirst = { beam = \"arm\", at = \"end\" }\nsecond = { beam = \"arm\", at = 1 }\nalong = [1, 0]\n\n[[probe]]",
        )],
        "24:8: a hinge or a weld joins two points, `first` and `second`",
    ),
    (
        "a hub with a law",
        &[(
            "[[probe]]",
            "[[support]]\nbeam = \"arm\"\nat = \"end\"\nfix = [\"x\", \"angle\"]\nmove = { spin_up = { speed = 1, duration = 1 }, in_time.step.start = 1 }\n\n[[probe]]",
        )],
        "27:20: `spin_up` moves the angle alone, by a law of its own",
    ),
    (
        "a hub that shifts",
        &[(
            "[[probe]]",
            "[[support]]\nbeam = \"arm\"\nat = \"end\"\nfix = [\"x\", \"angle\"]\nmove = { spin_up = { speed = 1, duration = 1 }, x = 1 }\n\n[[probe]]",
        )],
        "27:20: `spin_up` moves the angle alone, by a law of its own",
    ),
    (
        "a hub that lifts",
        &[(
            "[[probe]]",
            "[[support]]\nbeam = \"arm\"\nat = \"end\"\nfix = [\"y\", \"angle\"]\nmove = { spin_up = { speed = 1, duration = 1 }, y = 1 }\n\n[[probe]]",
        )],
        "27:20: `spin_up` moves the angle alone, by a law of its own",
    ),
    (
        "y held twice",
        &[("[[probe]]", "[[support]]\nbeam = \"arm\"\nat = 1e-6\nfix = [\"y\"]\n\n[[probe]]")],
        "26:7: a support before this one already fixes y at the same point",
    ),
    (
        "a direction held twice",
        &[("[[probe]]", "[[support]]\nbeam = \"arm\"\nat = 0\nfix = [\"gradient\"]\n\n[[probe]]")],
        "26:7: a support before this one already fixes the direction of r' at the same point",
    ),
];

/// The scene is legal before the changes, and refused for each with this message at this place.
#[test]
fn each_fault_of_a_part_is_told_with_its_place() {
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
