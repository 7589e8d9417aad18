//! Geometry, sections and the settings of methods: what a scene says is what is computed with.

use super::{Written, near};
use ancf::model::{
    Analysis, ArcLength, Discretization, Dynamic, GaussPoints, Integrator, Kernel, Nodes, ProbeTarget,
    SideCondition, Static, StepControl,
};
use ancf::scene::parse;
use std::f64::consts::PI;

const BAR: &str = "beam.bar = { start = [0, 0], end = [2, 0], axial_stiffness = 10, bending_stiffness = 1, mass_per_length = 1, BASIS }
    support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
    probe = [{ name = 'end', beam = 'bar', at = 'end' }]\n";

/// Every key of a discretisation: would catch one that is dropped, or that takes another's place.
#[test]
fn discretisations_are_as_the_scene_says() {
    let read = |basis: &str| {
        let text = BAR.replace("BASIS", basis) + "analysis.static = {}\n";
        let scene = parse("basis.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let beam = &scene.model().beams[0];
        (beam.discretization.clone(), beam.gauss_points)
    };
    let rpim = |kernel, side_condition, nodes, polynomial_terms, neighbours| Discretization::Rpim {
        nodes,
        kernel,
        polynomial_terms,
        side_condition,
        neighbours,
    };
    let points = |stretch, bend, lobatto| GaussPoints { stretch, bend, lobatto };
    for (basis, discretization, quadrature) in [
        (
            "basis.ancf = { elements = 7, gauss_points = { stretch = 5, bend = 4 } }",
            Discretization::Ancf { nodes: Nodes::Uniform(8) },
            Some(points(5, 4, false)),
        ),
        (
            "basis.ancf = { nodes = 7, spacing = 'chebyshev', gauss_points = { stretch = 4, bend = 2, stretch_rule = 'lobatto' } }",
            Discretization::Ancf { nodes: Nodes::Chebyshev(7) },
            Some(points(4, 2, true)),
        ),
        (
            "basis.ancf = { nodes = [0, '30 cm', 2], gauss_points = { stretch = 3, bend = 2, stretch_rule = 'gauss' } }",
            Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 0.3, 2.0]) },
            Some(points(3, 2, false)),
        ),
        (
            "basis.rpim = { nodes = 9, spacing = 'uniform', kernel.multiquadric = { q = 0.98, shape = 6 }, polynomial_terms = 3, \
             side_condition = 'minus', neighbours = 4, gauss_points = { stretch = 6, bend = 7 } }",
            rpim(Kernel::Multiquadric { q: 0.98, shape: 6.0 }, SideCondition::Minus, Nodes::Uniform(9), 3, 4),
            Some(points(6, 7, false)),
        ),
        (
            "basis.rpim = { nodes = 9, spacing = 'chebyshev', kernel.exponential = { shape = 0.25 }, polynomial_terms = 2, \
             side_condition = 'plus', neighbours = 1 }",
            rpim(Kernel::Exponential { shape: 0.25 }, SideCondition::Plus, Nodes::Chebyshev(9), 2, 1),
            None,
        ),
        (
            "basis.rpim = { nodes = 9, kernel.thin_plate_spline = { exponent = 5 }, polynomial_terms = 2, side_condition = 'plus', \
             neighbours = 2 }",
            rpim(Kernel::ThinPlateSpline { exponent: 5.0 }, SideCondition::Plus, Nodes::Uniform(9), 2, 2),
            None,
        ),
        (
            "basis.rpim = { nodes = 9, kernel.wendland = { radius = 4.5 }, polynomial_terms = 2, side_condition = 'plus', neighbours = 2 }",
            rpim(Kernel::Wendland { radius: 4.5 }, SideCondition::Plus, Nodes::Uniform(9), 2, 2),
            None,
        ),
    ] {
        let (found, points) = read(basis);
        assert_eq!(found, discretization, "{basis}");
        if let Some(quadrature) = quadrature {
            assert_eq!(points, quadrature, "{basis}");
        }
    }
}

/// Every key of an analysis: would catch a tolerance for a step, stages of another method, and the
/// axis of a target.
#[test]
fn analyses_are_as_the_scene_says() {
    let read = |analysis: &str| {
        let text = BAR.replace("BASIS", "basis.ancf.elements = 3") + analysis;
        parse("analysis.toml", &text).unwrap_or_else(|error| panic!("{error}")).analysis().clone()
    };
    let motion = |integrator| {
        Analysis::Dynamic(Dynamic { duration: 0.5, output_every: 0.02, integrator, events: Vec::new() })
    };
    let (fixed, tolerance) = (StepControl::Fixed(0.002), StepControl::Tolerance(3e-5));
    for (text, integrator) in [
        ("gauss = { stages = 2, step = '2 ms' }", Integrator::Gauss { stages: 2, step: fixed }),
        ("gauss = { stages = 1, tolerance = 3e-5 }", Integrator::Gauss { stages: 1, step: tolerance }),
        ("radau = { stages = 2, step = 0.002 }", Integrator::Radau { stages: 2, step: fixed }),
        ("radau = { tolerance = 3e-5 }", Integrator::Radau { stages: 3, step: tolerance }),
        (
            "generalized_alpha = { step = 0.002, spectral_radius = 0.6, newton_tolerance = 1e-7 }",
            Integrator::GeneralizedAlpha { step: fixed, spectral_radius: 0.6, newton_tolerance: 1e-7 },
        ),
        (
            "generalized_alpha = { tolerance = 3e-5, spectral_radius = 0.7 }",
            Integrator::GeneralizedAlpha { step: tolerance, spectral_radius: 0.7, newton_tolerance: 1e-11 },
        ),
    ] {
        let text = format!("analysis.dynamic = {{ duration = '0.5 s', output_every = '20 ms', {text} }}\n");
        assert_eq!(read(&text), motion(integrator), "{text}");
    }
    let arc = ArcLength {
        until_load: Some(0.8),
        max_points: 77,
        max_step: Some(0.03),
        until_probe: Some(ProbeTarget { probe: "end".into(), axis: 1, value: -0.25 }),
    };
    for (text, settings) in [
        (
            "analysis.static = { steps = 6, tolerance = 1e-9 }\n",
            Static { steps: Some(6), tolerance: Some(1e-9), ..Static::default() },
        ),
        ("analysis.static = { max_step = 0.04 }\n", Static { max_step: Some(0.04), ..Static::default() }),
        (
            "analysis.static.arc_length = { until_load = 0.8, max_points = 77, max_step = 0.03, until_probe = { probe = 'end', y = '-25 cm' } }\n",
            Static { arc_length: Some(arc), ..Static::default() },
        ),
    ] {
        assert_eq!(read(text), Analysis::Static(settings), "{text}");
    }
}

/// Records are those of all load steps, or of those of `steps`, between which there may be more. With friction there are 50
/// where nothing is said, and along a path by arc length as many for a beam length.
#[test]
fn load_steps_are_no_longer_than_allowed() {
    let loads = |statics: &str, rough: &str| {
        let contact = "effect.contact = [{ beam = 'bar', half_plane = { point = [0, -9], normal = [0, 1] }, stiffness = 1";
        let load = format!(
            "effect.force = [{{ beam = 'bar', at = 'end', value = [3, 0] }}]\n{contact}{rough} }}]\n"
        );
        let bar = BAR.replace("BASIS", "basis.ancf.elements = 1") + &load;
        let scene =
            parse("scene.toml", &format!("{bar}{statics}\n")).unwrap_or_else(|error| panic!("{error}"));
        let states =
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}")).into_states();
        (states.parameter, states.run.statistics.load_steps)
    };
    let rough = ", friction = { coefficient = 0.5 }";
    let parts = |count: usize| (0..=count).map(|i| i as f64 / count as f64).collect::<Vec<_>>();
    for (statics, rough, records, steps) in [
        ("analysis.static = { max_step = 0.25 }", "", 4, 4),
        ("analysis.static = { max_step = 0.24 }", "", 5, 5),
        ("analysis.static = { max_step = 0.25, steps = 2 }", "", 2, 4),
        ("analysis.static = { max_step = 0.5, steps = 8 }", "", 8, 8),
        ("analysis.static = {}", rough, 50, 50),
        ("analysis.static = { steps = 3 }", rough, 3, 51),
        ("analysis.static = { max_step = 1 }", rough, 1, 1),
    ] {
        let (found, taken) = loads(statics, rough);
        let expected = parts(records);
        assert_eq!((found.len(), taken), (records + 1, steps), "{statics}");
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{statics}: {found:?}");
    }
    for (step, words) in [
        ("1e-300", "1.000e300 load steps"),
        ("5e-7", "2.000e6 load steps, of which 1000000"),
        ("0", "positive"),
    ] {
        let text = format!(
            "{}analysis.static = {{ steps = 2, max_step = {step} }}\n",
            BAR.replace("BASIS", "basis.ancf.elements = 1")
        );
        let error = parse("scene.toml", &text).expect_err("an illegal step").to_string();
        assert!(error.contains(words), "{error}");
    }
    let path = |rough: &str| loads("analysis.static.arc_length = { until_load = 1 }", rough).1;
    assert!(path(rough) >= 2 * path(""), "{} {}", path(rough), path(""));
}

/// A bar whose place follows its load: a path ends where it is told to, with steps no longer than
/// allowed.
#[test]
fn paths_end_where_they_are_told_to() {
    let path = |until: &str| {
        let load = "effect.force = [{ beam = 'bar', at = 'end', value = [3, 0] }]\n";
        let bar = BAR.replace("BASIS", "basis.ancf.elements = 1") + load;
        let found = Written::of(&format!("{bar}analysis.static.arc_length = {{ {until} }}\n"));
        (found.column("probes.csv", "load"), found.column("probes.csv", "end.x"))
    };
    let (loads, places) = path("until_load = 0.7");
    near(*loads.last().expect("a load"), 0.7, 1e-8, "until_load");
    near(*places.last().expect("a place"), 2.42, 1e-8, "until_load");
    // It ends with the first point that has reached the place.
    let (loads, places) = path("until_probe = { probe = 'end', x = '2.3 m' }, max_step = 0.005");
    let [.., before, last] = places[..] else { panic!("{places:?}") };
    assert!(before < 2.3 && (2.3..2.315).contains(&last), "{places:?}");
    near(*loads.last().expect("a load"), (last - 2.0) / 0.6, 1e-8, "until_probe");
    let (_, places) = path("until_load = 0.7, max_step = 0.02");
    // Of the beam's length, in which the path of this bar is no shorter than its end's way over √2.
    assert!(places.windows(2).all(|pair| pair[1] - pair[0] < 0.02 * 2.0 * 1.5), "{places:?}");
    assert!(places.len() > 7, "{places:?}");
}

/// Circles either way round, and a curve through points: where a beam is before anything acts.
#[test]
fn beams_lie_where_their_geometry_says() {
    let shape = |geometry: &str| {
        let text = format!(
            "beam.bow = {{ {geometry}, axial_stiffness = 1e3, bending_stiffness = 1, basis.ancf.elements = 24 }}
             support = [{{ beam = 'bow', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'bow', at = 'end', value = [1e-9, 0] }}]
             analysis.static = {{}}\n"
        );
        let found = Written::of(&text);
        ["s", "x", "y", "angle", "curvature"].map(|name| found.column("shape.csv", name))
    };
    for (from, to) in [(20.0, 140.0), (140.0, 20.0), (200.0, -30.0)] {
        let [s, x, y, angle, curvature] = shape(&format!(
            "arc = {{ center = [1, -2], radius = '150 cm', from = '{from} deg', to = '{to} deg' }}"
        ));
        let (start, sense) = (f64::to_radians(from), f64::signum(to - from));
        for i in 0..s.len() {
            let polar = start + sense * s[i] / 1.5;
            near(x[i], 1.0 + 1.5 * polar.cos(), 1e-5, "x");
            near(y[i], -2.0 + 1.5 * polar.sin(), 1e-5, "y");
            near((angle[i] - polar - sense * 0.5 * PI).sin(), 0.0, 1e-4, "angle");
            near(curvature[i], sense / 1.5, 1e-2, "curvature");
        }
        near(s[s.len() - 1], 1.5 * (to - from).abs().to_radians(), 1e-9, "length");
    }
    let [s, x, y, ..] = shape("points = [[0, 0], ['1 m', 0.2], [2, 0]]");
    let middle = s.iter().position(|at| (at - 0.5 * s[s.len() - 1]).abs() < 1e-9).expect("the middle");
    for (i, exact) in [(0, [0.0, 0.0]), (middle, [1.0, 0.2]), (s.len() - 1, [2.0, 0.0])] {
        near(x[i], exact[0], 1e-5, "x");
        near(y[i], exact[1], 1e-5, "y");
    }
}

/// E A, E I and ρ A from their parts: a bar of steel, whose extension, deflection and weight are
/// known.
#[test]
fn sections_are_products_of_their_parts() {
    let text = "beam.bar = { start = [0, 0], end = [2, 0], youngs_modulus = '200 GPa', area = '3 cm^2', second_moment = '5 cm^4', \
        density = '8 g/cm^3', basis.ancf.elements = 4 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.gravity.acceleration = [2, -0.1]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        output.reactions = true
        analysis.static = {}\n";
    let found = Written::of(text);
    // EA = 6e7 N, EI = 1e4 N m², ρA = 2.4 kg/m.
    let expected = [("support1.fx", -9.6), ("support1.fy", 0.48), ("support1.moment", 0.48)];
    // The pull has a lever of 5e-5 m.
    found.ends("reactions.csv", &expected, 5e-4);
    near(found.last("probes.csv", "end.x") - 2.0, 4.8 * 4.0 / 2.0 / 6e7, 1e-9, "extension");
    near(found.last("probes.csv", "end.y"), -0.24 * 16.0 / 8.0 / 1e4, 5e-8, "deflection");
}

/// In the plane a moment has no direction that could follow the section: the word changes nothing.
#[test]
fn a_moment_that_follows_is_the_same_moment() {
    let bent = |follower: &str| {
        let load = format!("effect.moment = [{{ beam = 'bar', at = 'end', value = 0.6{follower} }}]\n");
        let found =
            Written::of(&(BAR.replace("BASIS", "basis.rpim.nodes = 8") + &load + "analysis.static = {}\n"));
        near(found.last("probes.csv", "end.angle"), 1.2, 1e-5, follower);
        found.last("probes.csv", "end.y")
    };
    assert_eq!(bent(""), bent(", follower = true"));
}

/// An end that is typed with fewer digits than the length has is the end, twelve digits are no
/// other place, and what lies beyond is refused.
#[test]
fn places_are_where_the_scene_says() {
    let of = |at: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 1], axial_stiffness = 1e6, bending_stiffness = 1e4, basis.ancf.elements = 2 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'arm', at = {at}, value = [0, -3] }}]
            analysis.static = {{}}\n"
        )
    };
    for at in ["'end'", "1.4142135623", "1.41421356237309"] {
        let solved = Written::of(&of(at));
        // −F x, with x of the end.
        near(solved.column("shape.csv", "bending_moment")[0], -3.0, 1e-3, at);
    }
    assert!(parse("scene.toml", &of("1.4142136")).is_err());
}

/// Two supports at one place may share the work, but not hold the same twice; as many polynomial
/// terms as a support of shape functions can carry are legal.
#[test]
fn what_is_legal_up_to_its_bound() {
    let of = |supports: &str, terms: u32| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e4, \
             basis.rpim = {{ nodes = 5, neighbours = 1, polynomial_terms = {terms} }} }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}, {supports}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [0, -3] }}]
            analysis.static = {{}}\n"
        )
    };
    let angle = "{ beam = 'arm', at = 'start', fix = ['angle'] }";
    let legal = |supports: &str, terms: u32| {
        parse("scene.toml", &of(supports, terms)).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(legal(angle, 6), Ok(()));
    let refused = legal(angle, 7).expect_err("more terms than the smallest support has coordinates");
    assert!(refused.contains("7 polynomial terms"), "{refused}");
    let twice = legal(&format!("{angle}, {angle}"), 6).expect_err("the angle is held twice");
    assert!(twice.contains("direction"), "{twice}");
}

/// The nodes that the page draws are on the beam: at every quarter of four elements.
#[test]
fn nodes_of_a_shape_are_on_it() {
    let scene = parse(
        "scene.toml",
        "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 300, bending_stiffness = 2, basis.ancf.elements = 4 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, 1.5] }]
        analysis.static = {}\n",
    )
    .expect("a legal scene");
    let solved = scene.model().solve(scene.analysis()).expect("an equilibrium");
    let shape = &solved.states().last[0];
    let every = (shape.s.len() - 1) / 4;
    assert_eq!(shape.nodes.len(), 5);
    for (k, node) in shape.nodes.iter().enumerate() {
        near(node[0], shape.x[k * every], 1e-12, "x");
        near(node[1], shape.y[k * every], 1e-12, "y");
    }
    assert!(shape.nodes[4][1] > 0.5);
}

/// A string carries nothing but its tension, and what moves has an energy but no force of its own
/// in `effects.csv`.
#[test]
fn a_string_has_no_shear_and_inertia_no_force() {
    let found = Written::of(
        "beam.rope = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, mass_per_length = 2, basis.ancf.elements = 4 }
        support = [{ beam = 'rope', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -5]
        output.effects = true
        analysis.dynamic = { duration = 0.1, output_every = 0.05 }\n",
    );
    for name in ["shear_force", "bending_moment"] {
        assert!(found.column("shape.csv", name).iter().all(|value| *value == 0.0), "{name}");
    }
    for name in found.header("effects.csv").iter().filter(|name| name.starts_with("inertia")) {
        if !name.ends_with("energy") {
            assert!(found.column("effects.csv", name).iter().all(|value| *value == 0.0), "{name}");
        }
    }
}
