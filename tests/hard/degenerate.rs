//! Degenerate scenes: solved, or refused with a message that names the cause and the place; never a
//! panic, a hang, or a meaningless state with exit status 0.

use ancf::results::Results;
use ancf::run::RunError;
use ancf::scene;

/// A beam of 1 m with EI = 1, ρA = 1; what differs from scene to scene comes as tables of the scene
/// file.
#[derive(Clone, Copy)]
struct Scene {
    basis: &'static str,
    axial_stiffness: &'static str,
    strain: &'static str,
    supports: &'static str,
    effects: &'static str,
    analysis: &'static str,
}

const CLAMP: &str = "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'angle']\n";
const BOTH_ENDS: &str = "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'gradient']
[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y', 'gradient']\n";

const PLAIN: Scene = Scene {
    basis: "ancf = { elements = 8 }",
    axial_stiffness: "1e4",
    strain: "engineering",
    supports: CLAMP,
    effects: "",
    analysis: "static = {}",
};

impl Scene {
    fn text(&self) -> String {
        let Self { basis, axial_stiffness, strain, supports, effects, analysis } = self;
        format!(
            "title = 'degenerate'\n[beam.arm]\nstart = [0.0, 0.0]\nend = [1.0, 0.0]\nstrain = '{strain}'\n\
             axial_stiffness = {axial_stiffness}\nbending_stiffness = 1.0\nmass_per_length = 1.0\nbasis.{basis}\n\
             {supports}\n{effects}\n[[probe]]\nname = 'tip'\nbeam = 'arm'\nat = 'end'\n[analysis]\n{analysis}\n"
        )
    }

    fn outcome(&self) -> Result<Results, String> {
        let scene = scene::parse("scene.toml", &self.text()).map_err(|error| error.to_string())?;
        let whole = |error: ancf::run::RunError| {
            let help = miette::Diagnostic::help(&error).map(|help| help.to_string()).unwrap_or_default();
            format!("{error}\n{help}")
        };
        scene.model().solve(scene.analysis()).map_err(whole)
    }

    fn solved(&self) -> Results {
        self.outcome().unwrap_or_else(|message| panic!("{message}"))
    }

    /// Refused with a message that has all of these parts.
    fn refused(&self, parts: &[&str]) {
        let Err(message) = self.outcome() else { panic!("solved, and not refused with {parts:?}") };
        for part in parts {
            assert!(message.contains(part), "no `{part}` in: {message}");
        }
    }
}

fn tip(results: &Results) -> [f64; 2] {
    let last = results.states().probes[0].samples.last().expect("a state");
    [last.x, last.y]
}

const PUSH: &str = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [-2e4, 0.0]";
const LIFT: &str = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 1.0]";

/// EA ε = P gives |r'| = 1 + P/EA, which is zero at half the load; Green's force has its extreme at
/// |r'| = 1/√3.
#[test]
fn a_beam_pushed_together_says_that_it_is_crushed() {
    let place = ["at a node", "of beam `arm`"];
    Scene { effects: PUSH, ..PLAIN }.refused(&[&place[..], &["load factor 0.47", "crushed"]].concat());
    Scene { effects: PUSH, strain: "green", ..PLAIN }.refused(&["load factor 0.0962", "of beam `arm`"]);
    let onto_itself = |by: &'static str| -> Scene {
        let supports = match by {
            "-1.0" => {
                "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'angle']\n[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y']\nmove = { x = -1.0 }"
            }
            _ => {
                "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'angle']\n[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y']\nmove = { x = -1.5 }"
            }
        };
        Scene { supports, ..PLAIN }
    };
    // Green's strain would let the beam through its own support.
    for strain in ["engineering", "green"] {
        Scene { strain, ..onto_itself("-1.0") }.refused(&["load factor 0.9", "crushed", "of beam `arm`"]);
        Scene { strain, ..onto_itself("-1.5") }.refused(&["load factor 0.6", "crushed", "of beam `arm`"]);
    }
}

#[test]
fn a_fold_between_two_elements_is_refused_with_its_place() {
    let effects = "[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 1e3";
    let basis = "ancf = { elements = 2, gauss_points = { stretch = 5, bend = 3 } }";
    let folded = Scene { basis, effects, ..PLAIN };
    folded.refused(&["no equilibrium beyond load factor 0.2", "at s = 1.0000 m of beam `arm`", "more nodes"]);
    let alpha = "dynamic = { duration = 0.5, generalized_alpha = { step = 1e-3 } }";
    Scene { analysis: alpha, ..folded }.refused(&[
        "beyond t = 0.0",
        "crushed",
        "of beam `arm`",
        "axial stiffness",
    ]);
}

/// A load that acts at once and the other way: statics knows no before, and in motion it is one
/// step of the load.
#[test]
fn a_load_reversed_at_once_is_solved() {
    let down = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, -10.0]";
    let up = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 10.0]";
    let [a, b] = [down, up].map(|effects| tip(&Scene { effects, ..PLAIN }.solved()));
    assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] + b[1]).abs() < 1e-12, "{a:?} {b:?}");
    let motion = "dynamic = { duration = 0.5 }";
    let [a, b] = [down, up].map(|effects| tip(&Scene { effects, analysis: motion, ..PLAIN }.solved()));
    assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] + b[1]).abs() < 1e-9, "{a:?} {b:?}");
}

#[test]
fn without_load_nothing_moves() {
    let zero = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 0.0]";
    // Shape functions with one polynomial term do not form a straight line exactly: the strain of
    // what they form is none of the beam's.
    let constant = "rpim = { nodes = 5, neighbours = 1, polynomial_terms = 1 }";
    let [x, y] = tip(&Scene { basis: constant, ..PLAIN }.solved());
    assert!((x - 1.0).abs() < 1e-12 && y.abs() < 1e-12, "{x} {y}");
    for effects in ["", zero] {
        for analysis in [
            "static = {}",
            "static = { steps = 3 }",
            "static.arc_length = { until_load = 1.0 }",
            "dynamic = { duration = 1.0 }",
        ] {
            let [x, y] = tip(&Scene { effects, analysis, ..PLAIN }.solved());
            assert!((x - 1.0).abs() < 1e-12 && y.abs() < 1e-12, "{analysis}: {x} {y}");
        }
        let buckling = Scene { effects, analysis: "buckling = { count = 3 }", ..PLAIN }.solved();
        assert!(buckling.eigenvalues().is_empty(), "{:?}", buckling.eigenvalues());
    }
}

/// A force on what is held goes into the support.
#[test]
fn a_load_on_a_support_moves_nothing() {
    let effects = "[[effect.force]]\nbeam = 'arm'\nat = 'start'\nvalue = [3.0, -3.0]";
    let [x, y] = tip(&Scene { effects, ..PLAIN }.solved());
    assert!((x - 1.0).abs() < 1e-12 && y.abs() < 1e-12, "{x} {y}");
}

/// Small tip load: one cubic is the exact linear solution, PL³/3EI.
#[test]
fn one_element_or_two_nodes_are_a_beam() {
    let effects = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 1e-3]";
    for basis in ["ancf = { elements = 1 }", "rpim = { nodes = 2 }"] {
        let [_, y] = tip(&Scene { basis, effects, ..PLAIN }.solved());
        assert!((y / (1e-3 / 3.0) - 1.0).abs() < 2e-3, "{basis}: {y}");
        let motion = Scene { basis, effects, analysis: "dynamic = { duration = 1.0 }", ..PLAIN }.solved();
        assert!(tip(&motion)[1].abs() < 1e-3);
    }
    let one = Scene { basis: "ancf = { elements = 1 }", analysis: "modal = { count = 5 }", ..PLAIN };
    assert_eq!(one.solved().eigenvalues().len(), 5);
    Scene { analysis: "modal = { count = 9 }", ..one }.refused(&["found 9 modes", "8 coordinates"]);
}

#[test]
fn where_everything_is_held_nothing_moves_or_vibrates() {
    let held = Scene { basis: "ancf = { elements = 1 }", supports: BOTH_ENDS, effects: LIFT, ..PLAIN };
    assert_eq!(tip(&held.solved()), [1.0, 0.0]);
    for analysis in [
        "dynamic = { duration = 1.0 }",
        "dynamic = { duration = 1.0, radau = { tolerance = 1e-6 } }",
        "dynamic = { duration = 1.0, generalized_alpha = { step = 0.01 } }",
        "dynamic = { duration = 1.0, generalized_alpha = { tolerance = 1e-4 } }",
    ] {
        assert_eq!(tip(&Scene { analysis, ..held }.solved()), [1.0, 0.0], "{analysis}");
    }
    let modal = Scene { analysis: "modal = { count = 1 }", ..held };
    modal.refused(&["nothing is left that could move", "more elements"]);
}

/// Round-off of positions makes forces of ε EI L/h³: at h = L/1e5 a thirtieth of the load, at two
/// nodes that nearly coincide far more.
#[test]
fn what_double_precision_cannot_resolve_says_so() {
    let nodes = "two nodes coincide";
    Scene { basis: "ancf.nodes = [0, 0.5, 0.5, 1.0]", ..PLAIN }
        .refused(&["scene.toml:", "nodes out of order"]);
    Scene { basis: "ancf.nodes = [0, 0.9999999999, 1.0, 1.0]", ..PLAIN }.refused(&["nodes out of order"]);
    Scene { basis: "ancf.nodes = [0, 0.5, 1.0, 1.0000000001]", ..PLAIN }.refused(&[nodes]);
    Scene { basis: "ancf.nodes = [0, 0.5, 0.5000000000000001, 1.0]", ..PLAIN }
        .refused(&["beam `arm`: nodes 1 and 2", "apart"]);
    Scene { basis: "rpim.nodes = [0, 0.25, 0.5, 0.500000000001, 0.75, 1.0]", ..PLAIN }
        .refused(&["beam `arm`: nodes 2 and 3", "round-off"]);
    for basis in ["ancf.nodes = [0, 0.5, 0.500000000001, 1.0]", "ancf.nodes = [0, 1e-300, 1.0]"] {
        Scene { basis, effects: LIFT, ..PLAIN }.refused(&[
            "of beam `arm`",
            "double precision",
            "fewer nodes",
        ]);
    }
    let stiff = Scene { axial_stiffness: "1e17", effects: LIFT, ..PLAIN };
    stiff.refused(&["of beam `arm`", "double precision", "axial stiffness"]);
}

#[test]
#[ignore = "a minute or two"]
fn a_hundred_thousand_elements_move_or_say_why_not() {
    let many = Scene { basis: "ancf = { elements = 100000 }", effects: LIFT, ..PLAIN };
    many.refused(&["of beam `arm`", "double precision", "fewer nodes"]);
    // Inertia makes a step well-conditioned.
    let motion = "dynamic = { duration = 2e-5, generalized_alpha = { step = 1e-5 } }";
    let y =
        tip(&Scene { analysis: motion, effects: "[effect.gravity]\nacceleration = [0.0, -10.0]", ..many }
            .solved())[1];
    assert!((y + 2e-9).abs() < 1e-12, "{y}");
}

#[test]
fn over_supported_scenes_are_solved_or_refused() {
    let at = |places: &[&str], fix: &str| -> &'static str {
        let supports: String =
            places.iter().map(|s| format!("[[support]]\nbeam = 'arm'\nat = {s}\nfix = {fix}\n")).collect();
        Box::leak(supports.into_boxed_str())
    };
    let one = Scene { basis: "ancf = { elements = 1 }", effects: LIFT, ..PLAIN };
    // More than rigid motions need, and the element has coordinates for it.
    let [_, y] = tip(&Scene { supports: at(&["0.1", "0.3", "0.5"], "['x', 'y']"), ..one }.solved());
    assert!(y > 0.0, "{y}");
    // There are nodes where directions are held.
    let clamps = at(&["0.1", "0.3"], "['x', 'y', 'angle']");
    let [_, y] = tip(&Scene { supports: clamps, ..one }.solved());
    let [_, fine] = tip(&Scene { supports: clamps, basis: "ancf = { elements = 40 }", ..one }.solved());
    assert!(fine > 0.0 && (y - fine).abs() < 0.02 * fine, "{y}, not {fine}");
    Scene { supports: at(&["0.1", "0.3", "0.5", "0.7", "0.9"], "['x', 'y']"), ..one }.refused(&[
        "beam `arm`",
        "hold 10 quantities",
        "8 free coordinates",
        "more elements",
    ]);
    // The same place twice, to round-off and to what equations can tell.
    for near in ["0.2", "0.2000000001"] {
        Scene { supports: at(&["0.2", near], "['x', 'y', 'angle']"), ..PLAIN }
            .refused(&["scene.toml:", "already fixes x at the same point"]);
    }
}

#[test]
fn under_supported_scenes_are_refused_where_there_must_be_an_equilibrium() {
    let supports = "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y']\n";
    let hinged = Scene { supports, effects: LIFT, ..PLAIN };
    let equilibrium = "modal = { count = 2, about = 'equilibrium' }";
    for analysis in ["static = {}", "buckling = { count = 1 }", equilibrium] {
        Scene { analysis, ..hinged }.refused(&["scene.toml:", "free for rotation about the point (0, 0)"]);
    }
    let free = Scene { supports: "", analysis: "modal = { count = 4 }", ..PLAIN }.solved();
    assert_eq!(free.eigenvalues()[..3], [0.0; 3]);
    let [x, y] = tip(&Scene { analysis: "dynamic = { duration = 0.1 }", ..hinged }.solved());
    assert!(x < 1.0 && y > 0.0);
}

#[test]
fn what_no_memory_holds_is_refused_with_what_it_would_need() {
    let (small, large) = ("ancf = { elements = 8 }", "ancf = { elements = 1_000_000 }");
    for (basis, analysis, part) in [
        ("ancf = { elements = 1_000_000_000_000 }", "static = {}", "nodes, which need about 1."),
        (
            "rpim = { nodes = 1_000_000, neighbours = 16, gauss_points = { stretch = 64, bend = 64 } }",
            "static = {}",
            "nodes, which need about 2.",
        ),
        (
            large,
            "dynamic = { duration = 1.0, output_every = 1e-5 }",
            "1.000e5 records of 1000001 nodes need about",
        ),
        (large, "static = { steps = 1_000_000 }", "1000000 load steps of 1000001 nodes need about"),
        (
            large,
            "static.arc_length = { max_points = 1_000_000 }",
            "points on the path of 1000001 nodes need about",
        ),
        (large, "modal = { count = 100_000 }", "100000 modes of 1000001 nodes need about"),
        (small, "dynamic = { duration = 1.0, output_every = 1e-9 }", "1.000e9 records"),
        (
            small,
            "dynamic = { duration = 1.0, generalized_alpha = { step = 1e-12 } }",
            "the step must lie between",
        ),
        ("rpim = { nodes = 8, polynomial_terms = 1_000_000 }", "static = {}", "carry at most 8 terms"),
        ("rpim = { nodes = 8, neighbours = 1_000_000 }", "static = {}", "from 0 to 16 are legal"),
        (
            "ancf = { elements = 8, gauss_points = { stretch = 1_000_000, bend = 3 } }",
            "static = {}",
            "from 1 to 64 are legal",
        ),
    ] {
        Scene { basis, analysis, ..PLAIN }.refused(&["scene.toml:", part]);
    }
}

/// A node beside another, at a part of the spacing: what no digits would be left of is refused with its place, and nothing else has a
/// warning or another tip than elements find.
#[test]
fn meshfree_nodes_are_as_close_as_round_off_lets_them_be() {
    let sideways = "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.1, -1.5]";
    for axial_stiffness in ["1e3", "1e7"] {
        let scene = Scene { axial_stiffness, effects: sideways, ..PLAIN };
        let expected = tip(&Scene { basis: "ancf = { elements = 200 }", ..scene }.solved());
        for count in [12, 48] {
            let mut refused = 0;
            for part in [0.5, 0.1, 0.05, 0.03, 0.02, 0.01, 1e-3] {
                let middle = f64::from(count / 2);
                let places = (0..=count).map(f64::from).chain([middle - part]);
                let mut places: Vec<f64> = places.map(|place| place / f64::from(count)).collect();
                places.sort_by(f64::total_cmp);
                let basis = String::leak(format!("rpim = {{ nodes = {places:?} }}"));
                match (Scene { basis, ..scene }).outcome() {
                    Ok(found) => {
                        assert!(found.run().warnings.is_empty(), "{part}: {:?}", found.run().warnings);
                        let off = std::iter::zip(tip(&found), expected).map(|(a, b)| (a - b).abs());
                        assert!(off.fold(0.0, f64::max) < 1e-6, "{count}, {part}");
                        assert_eq!(refused, 0, "{part} is solved, and more was refused");
                    }
                    Err(why) => {
                        let pair = format!("nodes {} and {}", count / 2, count / 2 + 1);
                        assert!(why.contains(&pair) && why.contains("remove one"), "{part}: {why}");
                        refused += 1;
                    }
                }
            }
            assert!((1..=4).contains(&refused), "{refused}");
        }
    }
}

/// A spring on one beam does not hold another that hangs from it by a hinge: both rest where they do
/// without the spring, which is on a clamp and stays as it is.
#[test]
fn a_spring_elsewhere_does_not_hold_what_hangs() {
    let shapes = |unit: f64, spring: &str| {
        let (ea, ei, m) = (1e7 * unit.powi(2), 2.0 * unit.powi(3), 0.7);
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [{}, {}], axial_stiffness = {ea:?}, bending_stiffness = {ei:?}, \
             mass_per_length = {m}, basis.rpim.nodes = 5 }}
             beam.rod = {{ start = [{}, {}], end = [{}, {}], axial_stiffness = {ea:?}, bending_stiffness = {ei:?}, \
             mass_per_length = {m}, basis.rpim.nodes = 7 }}
             joint = [{{ type = 'hinge', first = {{ beam = 'arm', at = 'end' }}, second = {{ beam = 'rod', at = 'start' }} }}]
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.gravity.acceleration = [0, {:?}]
             {spring}
             probe = [{{ name = 'end', beam = 'rod', at = 'end' }}]
             analysis.static = {{}}\n",
            -0.7 * unit,
            -0.8 * unit,
            -0.7 * unit,
            -0.8 * unit,
            -0.6 * unit,
            -1.7 * unit,
            -0.5 * unit,
        );
        let scene = scene::parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let found = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        tip(&found)
    };
    for unit in [1.0, 3.1, 1e-3] {
        let free = shapes(unit, "");
        let found = shapes(unit, "effect.torsion_spring = [{ beam = 'arm', at = 'start', stiffness = 3 }]");
        let apart = (found[0] - free[0]).hypot(found[1] - free[1]);
        assert!(apart < 1e-9 * unit, "{unit}: {found:?}, {free:?}");
        assert!(free[1] < -1.5 * unit, "{free:?}");
    }
}

/// A tendon along a straight string between two pins has the length that they give it: its tension is not
/// determined, in whatever units and direction.
/// A spring that is stretched from the start pulls with less than what the round-off of positions would make of two short cells, and still moves
/// a beam that has them as it does one of even cells.
#[test]
fn a_stretched_spring_acts_beside_short_cells() {
    const SHORT: &str =
        "ancf = { nodes = [0, 0.1, 0.199995, 0.2, 0.200005, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1] }";
    let effects =
        "[[effect.spring]]\nbeam = 'arm'\nat = 0.8\nanchor = [0.6, 0.45]\nlength = 0.42\nstiffness = 60\n
        [[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, -1.0]";
    let tip = |basis| tip(&Scene { basis, effects, ..PLAIN }.solved());
    let even = tip("ancf = { elements = 40 }");
    let short = tip(SHORT);
    let apart = (short[0] - even[0]).hypot(short[1] - even[1]);
    assert!(even[1] > 0.05 && apart < 1e-6, "{apart:.1e} of {}", even[1]);
    // Critical loads are asked for of a state which it presses already.
    let effects =
        "[[effect.spring]]\nbeam = 'arm'\nat = 'end'\nanchor = [-9, 0]\nlength = 9.9\nstiffness = 10\n
        [[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [-1.0, 0.0]";
    for basis in ["ancf = { elements = 20 }", SHORT] {
        Scene { basis, effects, analysis: "buckling = { count = 1 }", ..PLAIN }
            .refused(&["springs that pull"]);
    }
    // Two that press from both sides balance each other, and leave the column unstable: that is no round-off.
    let effects =
        "[[effect.spring]]\nbeam = 'arm'\nat = 'end'\nanchor = [2, 0]\nlength = 1.5\nstiffness = 2.4\n
        [[effect.spring]]\nbeam = 'arm'\nat = 'end'\nanchor = [0.5, 0]\nlength = 0.75\nstiffness = 4.8\n
        [[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [-1.0, 0.0]";
    Scene { effects, analysis: "buckling = { count = 1 }", ..PLAIN }.refused(&["unstable"]);
}

#[test]
fn a_tendon_between_pins_holds_what_they_hold() {
    for unit in [1e-6, 1.0, 1e3] {
        for turn in [0.0_f64, 0.7, 2.9] {
            let (sine, cosine) = turn.sin_cos();
            let text = format!(
                "beam.string = {{ start = [{:?}, {:?}], end = [{:?}, {:?}], axial_stiffness = 100, mass_per_length = 1e-3, \
                 basis.ancf.elements = 9 }}
                 support = [{{ beam = 'string', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'string', at = 'end', fix = ['x', 'y'] }}]
                 effect.tendon = [{{ beam = 'string', offset = 0, length = {:?}, in_time.smooth_ramp.duration = 1 }}]
                 analysis.dynamic.duration = 1e-3\n",
                1.3 * unit,
                -0.3 * unit,
                (1.3 + cosine) * unit,
                (-0.3 + sine) * unit,
                0.999 * unit,
            );
            let scene = scene::parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let refused = scene.model().solve(scene.analysis()).err().map(|error| error.to_string());
            let said = refused.unwrap_or_default();
            assert!(said.contains("hold the same motion more than once"), "{unit}, {turn}: {said}");
            assert!(said.contains("a tendon") && said.contains("the support at"), "{said}");
        }
    }
}

/// A beam is pressed over the corner of a soft box, beyond which the box pushes it the other way: there is no equilibrium behind. Step after step
/// near the shortest one succeeds there, and each longer one fails, which is said after some hundreds of them.
#[test]
fn paths_that_creep_end_with_a_reason() {
    let scene = scene::parse(
        "corner",
        "beam.b = { start = [0, 0], end = [1, 0], axial_stiffness = 60780.0, bending_stiffness = 1.0, basis.ancf.elements = 40 }\n\
         support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
         effect.distributed_force = [{ beam = 'b', value = [0, -5.061] }]\n\
         effect.contact = [{ beam = 'b', circle = { center = [0.5055, -0.1618], radius = 0.04273 }, stiffness = 1556.0, half_thickness = 0.002108 }, \
         { beam = 'b', box = { center = [0.4705, -0.0858], size = [0.07503, 0.06206], angle = -0.3513 }, stiffness = 1597.0 }]\n\
         analysis.static = {}\n",
    )
    .unwrap_or_else(|error| panic!("{error}"));
    let Err(RunError::NoEquilibrium { load, partial, .. }) = scene.model().solve(scene.analysis()) else {
        panic!("there is no equilibrium behind the corner")
    };
    assert!((0.580..0.583).contains(&load), "{load}");
    let steps = partial.run.statistics.steps;
    assert!((300..2000).contains(&steps), "{steps} steps");
}

/// A clamped beam that lies a little inside a half-plane comes to rest as a beam on a foundation that is bent away from its ground: the tip
/// by finite differences of EI w⁗ + k (w − d) = 0 where w < d, on 300 cells.
#[test]
fn a_beam_that_begins_inside_an_obstacle_comes_to_rest() {
    for (depth, effects) in [
        (
            1e-3,
            "[[effect.contact]]\nbeam = 'arm'\nhalf_plane = { point = [0, 1e-3], normal = [0, 1] }\nstiffness = 1e4",
        ),
        (
            1e-4,
            "[[effect.contact]]\nbeam = 'arm'\nhalf_plane = { point = [0, 1e-4], normal = [0, 1] }\nstiffness = 1e4",
        ),
    ] {
        for basis in ["ancf = { elements = 60 }", "rpim = { nodes = 40 }"] {
            let [_, y] = tip(&Scene { basis, effects, ..PLAIN }.solved());
            assert!((y / depth - 5.3841).abs() < 1e-3, "{basis}: {y}");
        }
    }
}
