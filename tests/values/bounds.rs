//! Bounds of what a scene may say: exactly at the bound it is legal, next to it it is not; and what
//! is meant by numbers that are rounded, and by what is left out.

use super::near;
use ancf::model::{Analysis, Discretization, Dynamic, Integrator, Joint, Model, Nodes, StepControl};
use ancf::scene::{Scene, SceneError, parse};

const BEAM: &str = "beam.arm = { start = [0, 0], end = [1.8, 0], axial_stiffness = 1e4, bending_stiffness = 2, mass_per_length = 0.5, basis.BASIS }
    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }MORE]
    probe = [{ name = 'tip', beam = 'arm', at = PLACE }]\n";

/// What a scene says in one of its places; elsewhere it is as plain as can be.
enum Says {
    Basis(&'static str),
    Analysis(&'static str),
    Motion(&'static str),
    Place(&'static str),
    Support(&'static str),
    Part(&'static str),
}

impl Says {
    fn text(&self) -> String {
        let of = |basis: &str, place: &str, more: &str, rest: &str| {
            BEAM.replace("BASIS", basis).replace("PLACE", place).replace("MORE", more) + rest + "\n"
        };
        let (basis, place, still) = ("ancf.elements = 3", "'end'", "analysis.static = {}");
        match self {
            Self::Basis(basis) => of(basis, place, "", still),
            Self::Analysis(analysis) => of(basis, place, "", &format!("analysis.{analysis}")),
            Self::Motion(more) => {
                of(basis, place, "", &format!("analysis.dynamic = {{ duration = 2, {more} }}"))
            }
            Self::Place(place) => of(basis, place, "", still),
            Self::Support(support) => of(basis, place, &format!(", {support}"), still),
            Self::Part(part) => of(basis, place, "", &format!("effect.{part}\n{still}")),
        }
    }
}

fn read(says: &Says) -> Result<Scene, SceneError> {
    parse("scene.toml", &says.text())
}

/// Would catch a bound that is one off, that is of another quantity, and that includes what it
/// should not.
#[test]
fn what_is_legal_at_its_bound_is_refused_beyond() {
    use Says::{Analysis, Basis, Motion, Part, Place, Support};
    for (legal, refused) in [
        (Basis("ancf.elements = 9_999_999"), Basis("ancf.elements = 10_000_000")),
        (Basis("ancf.elements = 1"), Basis("ancf.elements = 0")),
        (
            Basis("rpim.nodes = 7_000_000"),
            Basis(
                "rpim = { nodes = 7_000_000, neighbours = 16, gauss_points = { stretch = 64, bend = 64 } }",
            ),
        ),
        (Basis("rpim = { nodes = 40, neighbours = 16 }"), Basis("rpim = { nodes = 40, neighbours = 17 }")),
        (
            Basis("rpim = { nodes = 3, neighbours = 4, polynomial_terms = 6 }"),
            Basis("rpim = { nodes = 3, neighbours = 4, polynomial_terms = 7 }"),
        ),
        (
            Basis("rpim = { nodes = 30, neighbours = 1, polynomial_terms = 6 }"),
            Basis("rpim = { nodes = 30, neighbours = 1, polynomial_terms = 7 }"),
        ),
        (
            Basis("ancf = { elements = 3, gauss_points = { stretch = 64, bend = 64 } }"),
            Basis("ancf = { elements = 3, gauss_points = { stretch = 65, bend = 64 } }"),
        ),
        (
            Basis("ancf = { elements = 3, gauss_points = { stretch = 1, bend = 1 } }"),
            Basis("ancf = { elements = 3, gauss_points = { stretch = 1, bend = 65 } }"),
        ),
        (
            Basis(
                "ancf = { elements = 3, gauss_points = { stretch = 2, bend = 1, stretch_rule = 'lobatto' } }",
            ),
            Basis(
                "ancf = { elements = 3, gauss_points = { stretch = 1, bend = 2, stretch_rule = 'lobatto' } }",
            ),
        ),
        (
            Basis("rpim = { nodes = 5, kernel.thin_plate_spline.exponent = 3.01 }"),
            Basis("rpim = { nodes = 5, kernel.thin_plate_spline.exponent = 3 }"),
        ),
        (
            Basis("rpim = { nodes = 5, kernel.multiquadric = { q = -1, shape = 1 } }"),
            Basis("rpim = { nodes = 5, kernel.multiquadric = { q = 0, shape = 1 } }"),
        ),
        (
            Basis("rpim = { nodes = 5, kernel.multiquadric = { q = 0.5, shape = 1 } }"),
            Basis("rpim = { nodes = 5, kernel.multiquadric = { q = 2, shape = 1 } }"),
        ),
        // A billionth of the length is 1.8e-9 m.
        (Basis("ancf.nodes = [0, 1, 1.8000000017]"), Basis("ancf.nodes = [0, 1, 1.8000000019]")),
        (Basis("ancf.nodes = [0, 1, 1.7999999983]"), Basis("ancf.nodes = [0, 1, 1.7999999981]")),
        (Basis("ancf.nodes = [1.7e-9, 1, 1.8]"), Basis("ancf.nodes = [1.9e-9, 1, 1.8]")),
        (Basis("ancf.nodes = [-1.7e-9, 1, 1.8]"), Basis("ancf.nodes = [-1.9e-9, 1, 1.8]")),
        (Basis("ancf.nodes = [0, 1.8]"), Basis("ancf.nodes = [1.8]")),
        (Basis("ancf.nodes = 2"), Basis("ancf.nodes = 1")),
        (Basis("ancf.nodes = [0, 0.5, 0.500001, 1.8]"), Basis("ancf.nodes = [0, 0.5, 0.5, 1.8]")),
        (Place("1.8000000017"), Place("1.8000000019")),
        (Place("0"), Place("-1e-12")),
        // A millionth of the length is 1.8e-6 m.
        (
            Support("{ beam = 'arm', at = 1.9e-6, fix = ['y'] }"),
            Support("{ beam = 'arm', at = 1.7e-6, fix = ['y'] }"),
        ),
        (
            Support("{ beam = 'arm', at = 'end', fix = ['y'], move = {} }"),
            Support("{ beam = 'arm', at = 'end', fix = ['y'], move = { in_time.step.start = 1 } }"),
        ),
        (
            Part("spring = [{ beam = 'arm', at = 'end', stiffness = 1, anchor = [0, 1], length = 0 }]"),
            Part("spring = [{ beam = 'arm', at = 'end', stiffness = 1, anchor = [0, 1], length = -1e-9 }]"),
        ),
        (
            Part("foundation = [{ beam = 'arm', stiffness = [0, 1e-9] }]"),
            Part("foundation = [{ beam = 'arm', stiffness = [-1e-9, 1] }]"),
        ),
        (
            Part("moving_force = [{ beam = 'arm', value = [0, 1], speed = -1e-9 }]"),
            Part("moving_force = [{ beam = 'arm', value = [0, 1], speed = 0 }]"),
        ),
        (Analysis("static = { tolerance = 0.999 }"), Analysis("static = { tolerance = 1 }")),
        (Analysis("static = { steps = 1_000_000 }"), Analysis("static = { steps = 1_000_001 }")),
        (
            Analysis("static.arc_length.max_points = 1_000_000"),
            Analysis("static.arc_length.max_points = 1_000_001"),
        ),
        // Four nodes of four coordinates.
        (Analysis("modal.count = 16"), Analysis("modal.count = 17")),
        (Analysis("buckling.count = 16"), Analysis("buckling.count = 17")),
        (Motion("output_every = 2"), Motion("output_every = 2.0000001")),
        (Motion("output_every = 2e-6"), Motion("output_every = 1.999e-6")),
        (Motion("radau.step = 2"), Motion("radau.step = 2.0001")),
        (Motion("radau.step = 2.0001e-9"), Motion("radau.step = 1.999e-9")),
        (Motion("radau = { stages = 3, step = 0.1 }"), Motion("radau = { stages = 4, step = 0.1 }")),
        (Motion("gauss = { stages = 1, step = 0.1 }"), Motion("gauss = { stages = 0, step = 0.1 }")),
        (
            Motion("generalized_alpha = { step = 0.1, spectral_radius = 1 }"),
            Motion("generalized_alpha = { step = 0.1, spectral_radius = 1.0001 }"),
        ),
        (
            Motion("generalized_alpha = { step = 0.1, spectral_radius = 0 }"),
            Motion("generalized_alpha = { step = 0.1, spectral_radius = -1e-9 }"),
        ),
    ] {
        if let Err(error) = read(&legal) {
            panic!("{error}\n{}", legal.text());
        }
        assert!(read(&refused).is_err(), "legal:\n{}", refused.text());
    }
}

/// Of a million nodes and one a state takes 32 bytes a node, and 64 GiB hold 2147 of them: load
/// steps, points of a path, four vectors a mode, positions and velocities of a record.
#[test]
fn states_that_no_memory_holds_are_refused_at_their_number() {
    let text = |analysis: &str| {
        let basis = BEAM.replace("BASIS", "ancf.elements = 1_000_000").replace("PLACE", "'end'");
        basis.replace("MORE", "") + "analysis." + analysis + "\n"
    };
    for (legal, refused, what) in [
        ("static = { steps = 2147 }", "static = { steps = 2148 }", "2148 load steps"),
        (
            "static.arc_length.max_points = 2147",
            "static.arc_length.max_points = 2148",
            "2148 points on the path",
        ),
        ("modal.count = 536", "modal.count = 537", "537 modes"),
        (
            "dynamic = { duration = 1073, output_every = 1 }",
            "dynamic = { duration = 1074, output_every = 1 }",
            "1.074e3 records",
        ),
    ] {
        assert!(parse("scene.toml", &text(legal)).is_ok(), "{legal}");
        let error = parse("scene.toml", &text(refused)).expect_err(refused).to_string();
        let needs = 2148.0 * 1_000_001.0 * 32.0 / 1024f64.powi(3);
        assert!(error.contains(&format!("{what} of 1000001 nodes need about {needs:.3e} GiB")), "{error}");
    }
}

/// Nodes count over all beams, each with the memory of its own tables.
#[test]
fn nodes_of_all_beams_are_counted() {
    let two = |elements: u32| {
        let leg = BEAM.replace("beam.arm", "beam.leg").lines().next().expect("a beam").to_owned();
        let arm = BEAM.replace("MORE", ", { beam = 'leg', at = 'start', fix = ['x', 'y', 'angle'] }");
        let text = format!("{leg}\n{arm}").replace("BASIS", &format!("ancf.elements = {elements}"));
        parse("scene.toml", &(text.replace("PLACE", "'end'") + "analysis.static = {}\n"))
    };
    assert!(two(4_999_999).is_ok());
    let error = two(5_000_000).expect_err("more than ten million").to_string();
    // Five points and a row of 22 entries a coordinate, of four functions.
    let memory = 10_000_002.0 * (5.0 * 3.0 * 4.0 * 8.0 + 4.0 * 22.0 * 8.0) / 1024f64.powi(3);
    assert!(
        error.contains(&format!("asks for 10000002 nodes, which need about {memory:.3e} GiB")),
        "{error}"
    );
    let wide = Says::Basis("rpim = { nodes = 20_000_000, neighbours = 3 }");
    let error = read(&wide).expect_err("more than ten million").to_string();
    // Eight points, sixteen functions.
    let memory = 2e7 * (8.0 * 3.0 * 16.0 * 8.0 + 4.0 * (3.0 * 31.0 + 1.0) * 8.0) / 1024f64.powi(3);
    assert!(
        error.contains(&format!("asks for 20000000 nodes, which need about {memory:.3e} GiB")),
        "{error}"
    );
}

fn model(says: &Says) -> Model {
    read(says).unwrap_or_else(|error| panic!("{error}\n{}", says.text())).model().clone()
}

/// Ends that are typed with fewer digits than the length has are the ends.
#[test]
fn rounded_ends_are_the_ends() {
    for nodes in ["[0, 1, 1.8000000017]", "[1.7e-9, 1, 1.7999999983]", "[-1.7e-9, 1, 1.8]"] {
        let text = BEAM.replace("BASIS", &format!("ancf.nodes = {nodes}")).replace("PLACE", "1.8000000017");
        let text = text.replace("MORE", "") + "analysis.static = {}\n";
        let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let Discretization::Ancf { nodes: Nodes::Given(places) } = &scene.model().beams[0].discretization
        else {
            panic!("given nodes")
        };
        assert_eq!(places, &[0.0, 1.0, 1.8], "{nodes}");
        assert_eq!(scene.model().probes[0].at.s, 1.8);
    }
    for (place, s) in
        [("1.7999999983", 1.8), ("1.7999999981", 1.7999999981), ("'start'", 0.0), ("'90 cm'", 0.9)]
    {
        near(model(&Says::Place(place)).probes[0].at.s, s, 1e-15, place);
    }
}

/// What is left out is what the handbook says: two hundred records, Radau's method to 1e-6, three
/// stages, radius 0.9; a line of a slider has the length one.
#[test]
fn what_is_left_out_has_its_usual_value() {
    let motion = |more: &'static str| {
        let scene = read(&Says::Motion(more)).unwrap_or_else(|error| panic!("{error}"));
        let Analysis::Dynamic(Dynamic { output_every, integrator, .. }) = scene.analysis().clone() else {
            panic!("a motion")
        };
        (output_every, integrator)
    };
    let (every, integrator) = motion("event = []");
    assert_eq!(every, 0.01);
    assert_eq!(integrator, Integrator::Radau { stages: 3, step: StepControl::Tolerance(1e-6) });
    let fixed = StepControl::Fixed(0.5);
    assert_eq!(motion("gauss.step = 0.5").1, Integrator::Gauss { stages: 3, step: fixed });
    assert_eq!(
        motion("generalized_alpha.step = 0.5").1,
        Integrator::GeneralizedAlpha {
            step: fixed,
            spectral_radius: 0.9,
            newton_tolerance: Integrator::NEWTON_TOLERANCE
        }
    );
    let text = Says::Motion("radau.step = 1").text()
        + "joint = [{ type = 'slider', first = { beam = 'arm', at = 0.9 }, along = [-3, 4] }]\n";
    let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let Joint::Slider { at, along } = scene.model().joints[0] else { panic!("a slider") };
    near(at.s, 0.9, 0.0, "place");
    near(along[0], -0.6, 1e-15, "x");
    near(along[1], 0.8, 1e-15, "y");
}

/// Beams are numbered as they stand in the file, not by their names.
#[test]
fn beams_have_the_order_of_the_file() {
    let beam = |name: &str| {
        BEAM.replace("beam.arm", &format!("beam.{name}")).lines().next().expect("a beam").to_owned()
    };
    let held: Vec<String> = ["z", "b", "y", "a"]
        .map(|name| format!("{{ beam = '{name}', at = 'start', fix = ['x', 'y', 'angle'] }}"))
        .into();
    let text = format!(
        "{}\n{}\n{}\n{}\nsupport = [{}]\nanalysis.static = {{}}\n",
        beam("z"),
        beam("b"),
        beam("y"),
        beam("a"),
        held.join(", ")
    );
    let scene =
        parse("scene.toml", &text.replace("BASIS", "ancf.elements = 1")).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<&str> = scene.model().beams.iter().map(|beam| beam.name.as_str()).collect();
    assert_eq!(names, ["z", "b", "y", "a"]);
    let supported: Vec<usize> = scene.model().supports.iter().map(|support| support.at.beam).collect();
    assert_eq!(supported, [0, 1, 2, 3]);
}
