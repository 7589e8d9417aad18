//! Beams that begin in another shape than the stress-free one.

use super::{Written, near};
use ancf::scene::parse;
use std::f64::consts::{PI, TAU};

/// A straight rod of 2π m is bent into a ring of 1 m whose ends are clamped to each other's place:
/// M = EI/R everywhere, no force, and an energy of ½ EI/R² · 2π R.
#[test]
fn a_rod_is_bent_into_a_ring() {
    for basis in ["ancf.elements = 24", "rpim.nodes = 25"] {
        let found = Written::of(&format!(
            "beam.rod = {{ start = [0, 0], end = [{TAU}, 0], axial_stiffness = 1e5, bending_stiffness = 3, basis.{basis}, \
             initial_shape.arc = {{ center = [0, 1], radius = 1, from = '-90 deg', to = '270 deg' }} }}
            support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'rod', at = 'end', fix = ['x', 'y', 'angle'] }}]
            probe = [{{ name = 'top', beam = 'rod', at = {PI} }}]
            output.reactions = true\nanalysis.static = {{}}\n"
        ));
        found.ends("probes.csv", &[("top.x", 0.0), ("top.y", 2.0), ("top.curvature", 1.0)], 1e-2);
        near(found.last("probes.csv", "top.angle").abs(), PI, 1e-3, "top.angle");
        found.ends("energy.csv", &[("bend", 3.0 * PI), ("stretch", 0.0), ("total", 3.0 * PI)], 1e-3);
        let reaction = |name: &str| found.last("reactions.csv", name);
        near(reaction("support1.moment"), -3.0, 2e-3, "support1.moment");
        near(reaction("support2.moment"), 3.0, 2e-3, "support2.moment");
        near(reaction("support1.fx").hypot(reaction("support1.fy")), 0.0, 1e-2, "force");
    }
}

/// A quarter of a circle is pressed flat: M = −EI/R; then a force at its middle is added by load
/// steps, from that equilibrium on.
#[test]
fn an_arc_is_laid_on_a_line() {
    let quarter = 0.5 * PI;
    let text = |load: &str| {
        format!(
            "beam.arm = {{ arc = {{ center = [0, 1], radius = 1, from = '-90 deg', to = 0 }}, axial_stiffness = 1e5, bending_stiffness = 2, \
             basis.ancf.elements = 16, initial_shape.line = {{ start = [0, 0], end = [{quarter}, 0] }} }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'arm', at = 'end', fix = ['x', 'y', 'angle'] }}]
            probe = [{{ name = 'middle', beam = 'arm', at = {} }}]\n{load}
            output.reactions = true\nanalysis.static.steps = 4\n",
            0.5 * quarter
        )
    };
    let flat = Written::of(&text(""));
    flat.ends(
        "probes.csv",
        &[("middle.x", 0.5 * quarter), ("middle.y", 0.0), ("middle.curvature", 0.0)],
        1e-6,
    );
    near(flat.last("reactions.csv", "support1.moment"), 2.0, 1e-3, "support1.moment");
    flat.ends("energy.csv", &[("bend", quarter)], 1e-3);
    // F L³/(192 EI) of a beam with both ends clamped, F small.
    let pressed =
        Written::of(&text("effect.force = [{ beam = 'arm', at = 0.7853981633974483, value = [0, -1e-3] }]"));
    near(pressed.last("probes.csv", "middle.y"), -1e-3 * quarter.powi(3) / 384.0, 1e-8, "middle.y");
    assert_eq!(pressed.column("probes.csv", "load").len(), 5);
}

/// A bent free rod is let go: it begins at rest with ½ EI κ² L, and keeps that energy.
#[test]
fn a_bent_rod_is_let_go() {
    let found = Written::of(
        "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 2, mass_per_length = 1, basis.ancf.elements = 8, \
         initial_shape.arc = { center = [0, 2], radius = 2, from = '-90 deg', to = -1.0707963267948966 } }
        probe = [{ name = 'end', beam = 'rod', at = 'end' }]
        analysis.dynamic = { duration = 0.2, output_every = 0.05, radau.tolerance = 1e-7 }\n",
    );
    let (bend, total) = (found.column("energy.csv", "bend"), found.column("energy.csv", "total"));
    near(bend[0], 0.5 * 2.0 * 0.25, 1e-4, "bend");
    assert!(bend.iter().any(|bend| *bend < 0.9 * 0.25), "{bend:?}");
    for total in total {
        near(total, bend[0], 2e-3, "total");
    }
    let start = [found.column("probes.csv", "end.x")[0], found.column("probes.csv", "end.y")[0]];
    near(start[0], 2.0 * 0.5_f64.sin(), 1e-12, "end.x");
    near(start[1], 2.0 - 2.0 * 0.5_f64.cos(), 1e-12, "end.y");
    near(found.column("probes.csv", "end.vx")[0], 0.0, 1e-15, "end.vx");
}

/// A bow: a straight limb bent so far that a string fits its ends. String and limb are joined where
/// they are at the start; the string carries the thrust N, the limb N and the moment N y.
#[test]
fn a_bow_is_braced() {
    let found = Written::of(
        "beam.limb = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 10, basis.ancf.elements = 20, \
         initial_shape.points = [[0.02, 0], [0.25, 0.1], [0.5, 0.14], [0.75, 0.1], [0.98, 0]] }
        beam.string = { start = [0, -1], end = [0.9, -1], axial_stiffness = 1e6, basis.ancf.elements = 4, \
         initial_shape.line = { start = [0.02, 0], end = [0.98, 0] } }
        joint = [{ type = 'hinge', first = { beam = 'limb', at = 'start' }, second = { beam = 'string', at = 'start' } },
                 { type = 'hinge', first = { beam = 'limb', at = 'end' }, second = { beam = 'string', at = 'end' } }]
        support = [{ beam = 'limb', at = 'start', fix = ['x', 'y'] }, { beam = 'limb', at = 'end', fix = ['y'] }]
        probe = [{ name = 'middle', beam = 'limb', at = 0.5 }]
        output = { section_forces = true }
        analysis.static = {}\n",
    );
    let rows = |beam: &str, name: &str| -> Vec<f64> {
        let beams = found.words("shape.csv", "beam");
        let values = found.column("shape.csv", name);
        beams.iter().zip(values).filter(|(b, _)| *b == beam).map(|(_, value)| value).collect()
    };
    let (tension, thrust) = (rows("string", "axial_force"), rows("limb", "axial_force"));
    let middle = thrust.len() / 2;
    // A little more than Euler's load π² EI/L² of the limb, which is bent far.
    assert!((98.0..125.0).contains(&tension[100]), "{}", tension[100]);
    near(thrust[middle] / tension[100], -1.0, 1e-3, "thrust");
    let rise = rows("limb", "y")[middle] - rows("string", "y")[100];
    near(rows("limb", "bending_moment")[middle] / (-tension[100] * rise), 1.0, 1e-3, "moment");
    // The string is 0.9 m long, and hardly stretched.
    near(rows("limb", "x")[thrust.len() - 1] - rows("limb", "x")[0], 0.9, 1e-3, "chord");
}

#[test]
fn initial_shapes_that_cannot_be_are_refused() {
    let scene = |shape: &str, analysis: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 2, mass_per_length = 1, basis.ancf.elements = 4, \
             initial_shape = {shape} }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.{analysis}\n"
        )
    };
    let line = "{ line = { start = [0, 0], end = [0, 1] } }";
    for (shape, analysis, said) in [
        ("{}", "static = {}", "needs exactly one initial shape"),
        (
            "{ line = { start = [0, 0], end = [1, 1] }, points = [[0, 0], [1, 0]] }",
            "static = {}",
            "needs exactly one",
        ),
        ("{ line = { start = [0, 0], end = [0, 0] } }", "static = {}", "cannot begin in this shape"),
        ("{ line = { start = [0, 0], end = [2, 0] } }", "static = {}", "is 2 m long, and the beam 1 m"),
        (line, "buckling.count = 1", "a buckling analysis starts from the stress-free shape"),
        (line, "modal.count = 1", "a modal analysis about the reference starts from"),
        (line, "static.arc_length = { until_load = 2 }", "a path by arc length starts from"),
    ] {
        let error = parse("arm.toml", &scene(shape, analysis)).expect_err(said).to_string();
        assert!(error.contains(said) && error.contains("arm.toml:1:"), "{error}");
    }
    assert!(parse("arm.toml", &scene(line, "modal = { count = 1, about = 'equilibrium' }")).is_ok());
}

/// An arch between hinges may rest on either side. Where it begins near the middle it rests on the side to
/// which it creeps in a thick fluid, whatever its mesh. The follower load grows from zero afterwards.
#[test]
fn an_arch_rests_on_the_side_to_which_it_creeps() {
    let middle = |elements: usize, rest: &str| {
        let found = Written::of(&format!(
            "beam.arch = {{ arc = {{ center = [-6.628431003630588, 2.451191392803341], radius = 7.06713780918728, \
             from = -0.3542036732051035, to = -0.49570367320510345 }}, mass_per_length = 1, axial_stiffness = 9805, \
             bending_stiffness = 1, initial_shape.points = [[0, 0], [-0.20455, -0.452915], [-0.372591, -0.919332]], \
             basis.ancf.elements = {elements} }}
             support = [{{ beam = 'arch', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'arch', at = 'end', fix = ['x', 'y'] }}]
             effect.torsion_spring = [{{ beam = 'arch', at = 'end', stiffness = 0.5163 }}]
             probe = [{{ name = 'middle', beam = 'arch', at = 0.5 }}]
             {rest}\n"
        ));
        ["middle.x", "middle.y"].map(|name| found.last("probes.csv", name))
    };
    let creeps = "effect.damping = [{ beam = 'arch', mass_proportional = 200 }]
        analysis.dynamic = { duration = 40, radau.tolerance = 1e-3 }";
    let rests = "effect.distributed_force = [{ beam = 'arch', value = [1e-9, 0], follower = true }]
        analysis.static = {}";
    let [x, y] = middle(8, creeps);
    for elements in [4, 8, 16, 32, 128] {
        let found = middle(elements, rests);
        near(found[0], x, 1e-4, &format!("x with {elements} elements"));
        near(found[1], y, 1e-4, &format!("y with {elements} elements"));
    }
}

/// A rod that begins bent by 270 degrees has wound a spring at its end up by as much: at rest it is straight,
/// and let go it begins with ½ k (3π/2)² in the spring, whichever end is held.
#[test]
fn a_spring_knows_by_how_much_a_rod_begins_bent() {
    let length = 3.0 * PI;
    for (held, sprung, center, from, to, rest) in [
        ("start", "end", 0.0, "-90 deg", "180 deg", length),
        ("end", "start", length, "0 deg", "270 deg", 0.0),
    ] {
        let scene = |analysis: &str| {
            Written::of(&format!(
                "beam.rod = {{ start = [0, 0], end = [{length}, 0], axial_stiffness = 1e5, bending_stiffness = 3, mass_per_length = 1, \
                 basis.ancf.elements = 16, initial_shape.arc = {{ center = [{center}, 2], radius = 2, from = '{from}', to = '{to}' }} }}
                support = [{{ beam = 'rod', at = '{held}', fix = ['x', 'y', 'angle'] }}]
                effect.torsion_spring = [{{ beam = 'rod', at = '{sprung}', stiffness = 0.5 }}]
                probe = [{{ name = 'free', beam = 'rod', at = '{sprung}' }}]\n{analysis}\n"
            ))
        };
        let still = scene("analysis.static = {}");
        still.ends("probes.csv", &[("free.x", rest), ("free.y", 0.0)], 1e-9);
        still.ends("energy.csv", &[("total", 0.0)], 1e-12);
        let let_go = scene("analysis.dynamic.duration = 0.01");
        near(
            let_go.column("energy.csv", "stored")[0],
            0.25 * (1.5 * PI).powi(2),
            1e-9,
            "the spring's energy",
        );
    }
}
