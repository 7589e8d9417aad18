//! Elastic laws that are tables: force against strain, moment against curvature.

use super::{Written, near};
use ancf::scene::parse;
use miette::Diagnostic;
use std::f64::consts::PI;

const ROPE: &str = "{ strain = [-0.05, 0, 0.02, 0.06], force = ['0 N', '0 N', '40 N', '200 N'] }";

fn pulled(basis: &str, strain: &str, law: &str, force: f64) -> Written {
    Written::of(&format!(
        "beam.bar = {{ start = [0, 0], end = [2, 0], axial_law = {law}, bending_stiffness = 1, strain = '{strain}', basis.{basis} }}
        support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.force = [{{ beam = 'bar', at = 'end', value = [{force}, 0] }}]
        probe = [{{ name = 'end', beam = 'bar', at = 'end' }}]
        analysis.static = {{}}\n"
    ))
}

/// A bar is as long as its law says, on each piece of it, and stores the area below the law.
#[test]
fn a_bar_follows_its_law() {
    for basis in ["ancf.elements = 3", "rpim.nodes = 4"] {
        let law = "{ strain = [-0.1, 0, 0.02, 0.06], force = [-300, 0, 40, 200] }";
        for (force, strain, energy) in [
            (20.0, 0.01, 0.1),
            (40.0, 0.02, 0.4),
            (120.0, 0.04, 0.4 + 0.02 * 80.0),
            (-150.0, -0.05, 0.5 * 150.0 * 0.05),
        ] {
            let found = pulled(basis, "engineering", law, force);
            near(found.last("probes.csv", "end.x"), 2.0 * (1.0 + strain), 1e-7, "end.x");
            near(found.last("energy.csv", "stretch"), 2.0 * energy, 1e-5, "stretch");
        }
        // Green's strain: N is the derivative by ε, and the force is N |r'|.
        let found = pulled(basis, "green", law, 20.0);
        let x = 0.5 * found.last("probes.csv", "end.x");
        near(2000.0 * 0.5 * (x * x - 1.0) * x, 20.0, 1e-8, "Green's force");
    }
}

/// A beam under a couple at its end is a circle of the curvature at which its law has that moment.
#[test]
fn a_beam_bends_by_its_law() {
    let text = |moment: f64, arc: bool| {
        let shape = if arc {
            "arc = { center = [0, 2], radius = 2, from = '-90 deg', to = '-61.3521127 deg' }"
        } else {
            "start = [0, 0], end = [1, 0]"
        };
        format!(
            "beam.arm = {{ {shape}, axial_stiffness = 1e4, basis.ancf.elements = 12, \
             bending_law = {{ curvature = [-1, 1, 3], moment = ['-2 N m', 2, 3] }} }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.moment = [{{ beam = 'arm', at = 'end', value = {moment} }}]
            probe = [{{ name = 'end', beam = 'arm', at = 'end' }}]
            analysis.static = {{}}\n"
        )
    };
    for (moment, curvature, energy) in [(1.0, 0.5, 0.25), (2.5, 2.0, 1.0 + 2.25), (-1.0, -0.5, 0.25)] {
        let found = Written::of(&text(moment, false));
        near(found.last("probes.csv", "end.angle"), curvature, 1e-4, "angle");
        near(found.last("energy.csv", "bend"), energy, 2e-4, "bend");
        // Of a curved beam the change of the curvature counts.
        let arc = Written::of(&text(moment, true));
        near(arc.last("probes.csv", "end.angle"), 0.5 + curvature, 2e-4, "angle of the arc");
    }
}

/// A rope that takes no compression: between two holders nearer than its length it hangs slack, in
/// a catenary, and where they are pulled apart it has the force of its law.
#[test]
fn a_rope_takes_no_compression() {
    let text = |apart: f64, weight: f64| {
        format!(
            "beam.rope = {{ start = [0, 0], end = [2, 0], axial_law = {ROPE}, mass_per_length = {weight}, basis.ancf.elements = 40 }}
            support = [{{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'rope', at = 'end', fix = ['x', 'y'], move.x = {apart} }}]
            effect.gravity.acceleration = [0, -10]
            probe = [{{ name = 'middle', beam = 'rope', at = 1 }}]
            output.reactions = true
            analysis.static = {{}}\n"
        )
    };
    let taut = Written::of(&text(0.08, 1e-4));
    near(taut.last("reactions.csv", "support2.fx"), 120.0, 1e-2, "force of the law");
    // The sag of a catenary of 2 m between holders 1.8 m apart: sinh(u)/u = 2/1.8.
    let (mut low, mut high) = (0.1_f64, 3.0_f64);
    for _ in 0..100 {
        let u = 0.5 * (low + high);
        if u.sinh() / u < 2.0 / 1.8 { low = u } else { high = u }
    }
    let sag = 0.9 / low * (low.cosh() - 1.0);
    let slack = Written::of(&text(-0.2, 0.01));
    near(slack.last("probes.csv", "middle.y"), -sag, 2e-3, "sag");
    // Half the weight hangs at each end, and the pull is that of the catenary, w a.
    near(slack.last("reactions.csv", "support2.fy"), 0.1, 1e-4, "half of the weight");
    near(slack.last("reactions.csv", "support2.fx"), 0.1 * 0.9 / low, 2e-3, "the pull");
}

/// A rope with a little bending stiffness hangs as a bar that resists pressure as well, since its weight pulls all of it; where a
/// load presses it, nothing holds it along its axis, which is said.
#[test]
fn a_rope_that_bends_is_pulled_by_its_weight() {
    let hanging = |law: &str| {
        Written::of(&format!(
            "beam.rope = {{ start = [0, 0], end = [1, 0], {law}, bending_stiffness = 1e-3, mass_per_length = 0.4, basis.ancf.elements = 20 }}
            support = [{{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'rope', at = 'end', fix = ['x', 'y'], move.x = -0.05 }}]
            effect.gravity.acceleration = [0, -9.81]
            probe = [{{ name = 'middle', beam = 'rope', at = 0.43 }}]
            output.reactions = true
            analysis.static = {{}}\n"
        ))
    };
    let rope = hanging("axial_law = { strain = [-0.05, 0, 0.02, 0.1], force = [0, 0, 200, 3000] }");
    let bar = hanging("axial_stiffness = 1e4");
    for (file, column, least) in [
        ("probes.csv", "middle.x", 1e-7),
        ("probes.csv", "middle.y", 1e-7),
        ("reactions.csv", "support2.fx", 1e-6),
    ] {
        near(rope.last(file, column), bar.last(file, column), least, column);
    }
    let pressed = "beam.rope = { start = [0, 0], end = [1, 0], axial_law = { strain = [-0.1, 0, 0.1], force = [0, 0, 100] }, bending_stiffness = 1, \
         basis.ancf.elements = 8 }
        support = [{ beam = 'rope', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'rope', at = 'end', value = [-1, 0] }]\nanalysis.static = {}\n";
    let scene = parse("rope.toml", pressed).expect("a scene");
    let said =
        scene.model().solve(scene.analysis()).expect_err("pressed").help().expect("advice").to_string();
    assert!(said.contains("an `axial_law` resists tension only"), "{said}");
}

/// Small vibrations have the slope of the law at the equilibrium: ω = π/2L √(k/ρA) along a bar that
/// is held at one end, with k = 4000 N under 120 N.
#[test]
fn vibrations_have_the_slope_of_the_law() {
    let text = "beam.bar = { start = [0, 0], end = [1, 0], axial_law = { strain = [0, 0.02, 0.06], force = [0, 40, 200] }, bending_stiffness = 1e6, \
         mass_per_length = 1, basis.ancf.elements = 8 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [120, 0] }]
        analysis.modal = { count = 1, about = 'equilibrium' }\n";
    let found = Written::of(text).last("frequencies.csv", "frequency");
    near(found * 2.0 * PI, 0.5 * PI * 4000.0_f64.sqrt(), 0.05, "ω");
}

#[test]
fn a_law_that_is_left_is_told() {
    let said = |force: f64| {
        let found = pulled("ancf.elements = 2", "engineering", ROPE, force);
        let summary = std::fs::read_to_string(found.path("summary.json")).expect("a summary");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        summary["warnings"].to_string()
    };
    assert!(said(280.0).contains("the axial strain of beam `bar` reaches 8.0000e-2"), "{}", said(280.0));
    assert_eq!(said(100.0), "[]");
}

/// Found by the fuzzer: about a state at a corner of a law, round-off chose between two stiffnesses
/// for the frequencies of a scene and of its mirror image, without a word.
#[test]
fn a_linear_solution_at_a_corner_of_a_law_is_told() {
    let warnings = |law: &str, force: f64, analysis: &str| {
        let text = format!(
            "beam.bar = {{ start = [0, 0], end = [1, 0], {law}, mass_per_length = 1, basis.ancf.elements = 4 }}
            support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'bar', at = 'end', value = [-1e-3, {force}] }}]
            analysis.{analysis}\n"
        );
        let found = Written::of(&text);
        let summary = std::fs::read_to_string(found.path("summary.json")).expect("a summary");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        summary["warnings"].to_string()
    };
    let bend = "axial_stiffness = 1e4, bending_law = { curvature = [-9, 0, 9], moment = [-9, 0, 18] }";
    let straight = "axial_stiffness = 1e4, bending_law = { curvature = [-9, -1, 9], moment = [-9, -1, 9] }";
    let axial = "bending_stiffness = 1, axial_law = { strain = [-0.1, 0, 0.1], force = [-1e3, 0, 2e3] }";
    let about = "modal = { count = 1, about = 'equilibrium' }";
    for analysis in [about, "buckling.count = 1"] {
        let said = warnings(bend, 0.0, analysis);
        let corner = "the curvature of beam `bar` is at a corner of its `bending_law`, where its stiffness is 1.0000e0 on one side and 2.0000e0";
        assert!(said.contains(corner), "{said}");
        let said = warnings(straight, 0.0, analysis);
        assert_eq!(said, "[]");
    }
    // Bent, but for its free end.
    assert_eq!(warnings(bend, 0.1, about), "[]");
    let said = warnings(axial, 0.0, "buckling.count = 1");
    assert!(said.contains("the axial strain of beam `bar` is at a corner of its `axial_law`"), "{said}");
    assert_eq!(warnings(axial, 0.0, about), "[]");
}

#[test]
fn what_is_no_elastic_law_is_refused_with_its_place() {
    let refused = |keys: &str| {
        let text = format!(
            "beam.bar = {{ start = [0, 0], end = [1, 0], bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2, {keys} }}
            support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.static = {{}}\n"
        );
        parse("rope.toml", &text).expect_err("no law").to_string()
    };
    for (keys, part) in [
        (
            "axial_law = { strain = [0, 1, 0.5], force = [0, 1, 2] }",
            "0.5 is not larger than the strain before it, 1",
        ),
        ("axial_law = { strain = [0, 1, 2], force = [0, 2, 1] }", "1 is smaller than the force before it, 2"),
        ("axial_law = { strain = [0, 1], force = [1, 2] }", "the force is 1 where the strain is zero"),
        ("axial_law = { strain = [0, 1], force = [0, 0] }", "resists nothing"),
        ("axial_law = { strain = [0, 1], force = [0] }", "found 2 of `strain` and 1 of `force`"),
        (
            "axial_stiffness = 1, axial_law = { strain = [0, 1], force = [0, 1] }",
            "twice: by itself, and by `axial_stiffness`",
        ),
        ("axial_stiffness = 1, bending_law = { curvature = [0, 1], moment = [0, 1] }", "`bending_law` twice"),
    ] {
        let said = refused(keys);
        assert!(said.contains(part) && said.contains("rope.toml:1:"), "{said}");
    }
    let actuated = "beam.bar = { start = [0, 0], end = [1, 0], axial_law = { strain = [0, 1], force = [0, 1] }, bending_stiffness = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.actuation = [{ beam = 'bar', curvature = 1 }]\nanalysis.static = {}\n";
    let scene = parse("scene.toml", actuated).expect("a scene");
    let said = scene.model().solve(scene.analysis()).expect_err("not linear").to_string();
    assert!(said.contains("stiffness that is a number"), "{said}");
}

/// A tip force of 2.3 N bends a cantilever by more than the 1 N m of a corner up to s = 0.4564 m: what follows about that state,
/// vibrations and critical loads, says so, unless a node is there or the force is too small.
#[test]
fn a_stiffness_that_jumps_inside_a_cell_is_told() {
    let told = |force: f64, basis: &str, second: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, mass_per_length = 1, basis.ancf.{basis}, \
             bending_law = {{ curvature = [-2, -0.5, 0.5, 2], moment = [-2, -1, 1, 2] }} }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'arm', at = 'end', value = [0, {force:?}] }}, {{ beam = 'arm', at = 'end', value = [-0.1, 0], stage = 'two' }}]
             stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.{second} }}]\n"
        );
        let scene = ancf::scene::parse("scene", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let run = ancf::run::solve_stages(scene.stages(), ancf::Options::default());
        assert!(run.failure.is_none(), "{:?}", run.failure);
        let warnings = &run.results[1].run().warnings;
        warnings.iter().any(|warning| warning.starts_with("the stiffness of beam `arm` jumps at s = 0.4"))
    };
    for second in ["buckling.count = 1", "modal = { count = 1, about = 'equilibrium' }"] {
        assert!(told(2.3, "elements = 10", second), "{second}");
        assert!(!told(0.9, "elements = 10", second), "{second}");
    }
    assert!(!told(2.3, "nodes = [0, 0.2, 0.456421, 0.7, 1]", "buckling.count = 1"));
}

/// A cantilever under a moment that is just that of a corner of its law: forces tell, where curvatures of elements miss the corner by
/// what they err. A moment less by a millionth is on one side.
#[test]
fn a_moment_at_a_corner_is_told() {
    let of = |moment: f64| {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, mass_per_length = 1, basis.ancf.elements = 10, \
             bending_law = {{ curvature = [-2, -1, 0, 1, 2], moment = [-1.5, -1, 0, 1, 1.5] }} }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.moment = [{{ beam = 'b', at = 'end', value = {moment:?} }}]\nanalysis.modal = {{ count = 1, about = 'equilibrium' }}\n"
        );
        let scene = ancf::scene::parse("corner.toml", &text).expect("a legal scene");
        scene.model().solve(scene.analysis()).expect("vibrations").run().warnings.join("; ")
    };
    let said = "the curvature of beam `b` is at a corner of its `bending_law`";
    let found = [1.0, 1.0 - 1e-6].map(of);
    assert!(found[0].contains(said) && !found[1].contains(said), "{found:?}");
}

/// A beam that lies on a plane and presses it by nothing vibrates with the plane's stiffness or without, by the sign of round-off; one
/// that rests on it, or is clear of it, does not.
#[test]
fn a_contact_that_just_touches_is_told() {
    let of = |height: f64, weight: f64, analysis: &str| {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'b', at = 'end', fix = ['y'] }}]\n\
             effect.gravity.acceleration = [0, {:?}]\n\
             effect.contact = [{{ beam = 'b', stiffness = 1e3, half_plane = {{ point = [0, {height:?}], normal = [0, 1] }} }}]\n\
             analysis.modal = {{ count = 2, about = '{analysis}' }}\n",
            -weight
        );
        let scene = ancf::scene::parse("plane.toml", &text).expect("a legal scene");
        let results = scene.model().solve(scene.analysis()).expect("vibrations");
        results
            .run()
            .warnings
            .iter()
            .any(|told| told.starts_with("contact `b.1` just touches along a stretch"))
    };
    assert!(of(0.0, 0.0, "equilibrium") && of(0.0, 0.0, "reference"));
    assert!(!of(0.0, 1.0, "equilibrium") && !of(-0.1, 0.0, "equilibrium") && !of(-1e-6, 0.0, "reference"));
}
