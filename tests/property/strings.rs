//! Strings: beams without a bending stiffness, taut and slack.

use super::arm::{ancf, beam, gauss, imbalance, moved, one, still, support, tip};
use ancf::effect::Gravity;
use ancf::model::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// A string: no bending stiffness named, none computed.
#[test]
fn a_string_has_no_bending() {
    let mut model = one(vec![support(0.0, FixedRotation::Free)], vec![]);
    model.beams[0].section.bending_stiffness = None;
    model.parts = vec![Arc::new(Gravity::new([0.0, -9.81]))];
    let analysis = Analysis::Dynamic(Dynamic {
        duration: 0.1,
        output_every: 0.1,
        integrator: gauss(1e-3),
        events: vec![],
    });
    let inventory = ancf::run::inspect(&model, &analysis).expect("a string");
    assert!(inventory.effects.iter().all(|effect| effect.kind != ancf::assembly::Kind::Bend));
    let trajectory = moved(&model, 0.3, gauss(1e-3));
    assert!(trajectory.energy.iter().all(|e| e.bend == 0.0));
    assert!(imbalance(&trajectory) < 1e-4, "{}", imbalance(&trajectory));
}

/// A slack cable between two supports, laid out as an arc, hangs as a catenary: y = a cosh(x/a)
/// with 2 a sinh(w/2a) = L.
#[test]
fn a_slack_cable_hangs_as_a_catenary() {
    let (radius, half) = (1.0_f64, 1.0_f64);
    let mut cable = beam("cable", [0.0; 2], [1.0, 0.0], ancf(24));
    cable.centreline = Centreline::Arc { center: [0.0, 0.0], radius, from: -2.0, to: -2.0 + 2.0 * half };
    cable.section = Section {
        axial_stiffness: Some(1e6.into()),
        bending_stiffness: None,
        mass_per_length: Some(0.4.into()),
        ..Default::default()
    };
    let length = 2.0 * half * radius;
    let ends = [0.0, length].map(|s| support(s, FixedRotation::Free));
    let mut model = one(ends.to_vec(), vec![]);
    model.beams = vec![cable];
    model.parts = vec![Arc::new(Gravity::new([0.0, -9.81]))];
    model.probes = tip(0, 0.5 * length);
    let trajectory = still(&model);
    let [a, b] = [-2.0_f64, 0.0].map(|angle| [radius * angle.cos(), radius * angle.sin()]);
    // The catenary through both ends: √(L² − v²) = 2 c sinh(h/2c), h and v the distances along x
    // and y.
    let (h, v) = (b[0] - a[0], b[1] - a[1]);
    let mut bracket = (0.05_f64, 50.0_f64);
    for _ in 0..200 {
        let c = 0.5 * (bracket.0 + bracket.1);
        if 2.0 * c * (0.5 * h / c).sinh() > (length * length - v * v).sqrt() {
            bracket.0 = c
        } else {
            bracket.1 = c
        }
    }
    let c = bracket.0;
    let tension = c * 0.4 * 9.81;
    let pull = trajectory.reactions[1].samples.last().expect("a record");
    assert!((pull.fx - tension).abs() < 2e-3 * tension, "{} N and not {tension} N", pull.fx);
    let weight: f64 = trajectory.reactions.iter().filter_map(|r| r.samples.last()).map(|r| r.fy).sum();
    assert!((weight - 0.4 * 9.81 * length).abs() < 1e-6, "the supports bear {weight} N");
    assert!(trajectory.last[0].bending_moment.iter().all(|m| *m == 0.0));
}

/// Laid out from its `start` as an arc as long as it is, of 100°, a string hangs as a catenary on any mesh: what the cubics
/// of its cells stretch the arc by is a tension that holds nothing. 2 c sinh(w/2c) = 1 for hooks at a distance w.
#[test]
fn a_string_laid_out_as_long_as_it_is_hangs_on_any_mesh() {
    let half = 50.0_f64.to_radians();
    let radius = 0.5 / half;
    let width = 2.0 * radius * half.sin();
    let mut bracket = (0.05_f64, 50.0_f64);
    for _ in 0..200 {
        let c = 0.5 * (bracket.0 + bracket.1);
        if 2.0 * c * (0.5 * width / c).sinh() > 1.0 { bracket.0 = c } else { bracket.1 = c }
    }
    let height = |s: f64| (bracket.0 * bracket.0 + (s - 0.5).powi(2)).sqrt();
    let expected = height(0.43) - height(0.0);
    for (stiffness, elements) in [(1e5, 10), (1e6, 20), (1e5, 40), (1e6, 80), (1e4, 80)] {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], mass_per_length = 1, axial_stiffness = {stiffness:e}, \
             basis.ancf.elements = {elements}, initial_shape.arc = {{ center = [{}, {}], radius = {radius}, \
             from = '220 deg', to = '320 deg' }} }}\n\
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'a', at = 'end', fix = ['x', 'y'] }}]\n\
             effect.gravity.acceleration = [0, -9.81]\nprobe = [{{ name = 'p', beam = 'a', at = 0.43 }}]\nanalysis.static = {{}}\n",
            radius * half.sin(),
            radius * half.cos()
        );
        let scene = ancf::scene::parse("string.toml", &text).expect("a legal scene");
        let found =
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}, {elements} cells"));
        let y = found.states().probes[0].samples.last().expect("a state").y;
        // The weight stretches the string by 10/EA.
        assert!(
            (y - expected).abs() < 2e-4 + 10.0 / stiffness,
            "{y} for {expected}, EA = {stiffness}, {elements} cells"
        );
    }
}

/// Where nothing acts a string stays where it is, though nothing would resist it.
#[test]
fn a_string_without_load_stays() {
    let arc = Centreline::Arc { center: [0.0, 0.0], radius: 1.0, from: -2.0, to: -0.5 };
    let line = Centreline::Line { start: [0.0; 2], end: [0.9, 1.2] };
    for centreline in [arc, line] {
        let mut model =
            one(vec![support(0.0, FixedRotation::Free), support(1.5, FixedRotation::Free)], vec![]);
        model.beams[0].centreline = centreline;
        model.beams[0].section.bending_stiffness = None;
        for supports in [2, 1, 0] {
            model.supports.truncate(supports);
            let trajectory = still(&model);
            assert_eq!(trajectory.run.statistics.newton_iterations, 0);
            assert_eq!(
                (&trajectory.last[0].x, &trajectory.last[0].y),
                (&trajectory.run.undeformed[0].x, &trajectory.run.undeformed[0].y)
            );
        }
        // A support that has a way to go is not at rest.
        model.supports = vec![support(0.0, FixedRotation::Free), support(1.5, FixedRotation::Free)];
        model.supports[1].displacement = Displacement { x: 0.01, ..Displacement::default() };
        let end = still(&Model { probes: tip(0, 1.5), ..model.clone() }).probes[0]
            .samples
            .last()
            .expect("a record")
            .x;
        let before =
            still(&Model { probes: tip(0, 1.5), supports: vec![], ..model.clone() }).probes[0].samples[0].x;
        assert!((end - before - 0.01).abs() < 1e-9, "{end} from {before}");
    }
}

/// A straight string whose end is brought nearer at once may be left with a fold, and says so; by
/// small steps it hangs without one.
#[test]
fn a_folded_string_is_named() {
    let cable = |steps| {
        let mut model =
            one(vec![support(0.0, FixedRotation::Free), support(1.0, FixedRotation::Free)], vec![]);
        model.beams = vec![beam("cable", [0.0; 2], [1.0, 0.0], ancf(16))];
        model.beams[0].section = Section {
            axial_stiffness: Some(100.0.into()),
            bending_stiffness: None,
            mass_per_length: Some(1.0.into()),
            ..Default::default()
        };
        model.supports[1].displacement = Displacement { x: -0.4, ..Displacement::default() };
        model.parts = vec![Arc::new(Gravity::new([0.0, -9.81]))];
        model.probes = tip(0, 0.5);
        let settings = Static { steps, ..Static::default() };
        model.solve(&settings).expect("an equilibrium")
    };
    for steps in [None, Some(40)] {
        let trajectory = cable(steps);
        let middle = trajectory.probes[0].samples.last().expect("a record");
        // What is free of folds is symmetric.
        let symmetric = (middle.x - 0.3).abs() < 1e-6;
        let named = trajectory
            .run
            .warnings
            .iter()
            .any(|w| w.contains("string `cable` turns by more than a right angle"));
        assert_eq!(named, !symmetric, "{steps:?} steps: x = {}, {:?}", middle.x, trajectory.run.warnings);
        assert!(symmetric || steps.is_none(), "x = {}", middle.x);
    }
}

/// A straight cable of many cells whose ends are brought together at once hangs as an elastic catenary
/// (Irvine, *Cable Structures*, 1981): half of the span is H l/EA + H/w asinh(V/H), the sag
/// V²/(2 EA w) + H/w (√(1 + V²/H²) − 1), with half of the length l and half of the weight V = w l.
#[test]
fn a_cable_of_many_cells_that_is_brought_together_hangs() {
    let (stiffness, weight, half, span) = (1e3, 9.81, 0.5, 0.8);
    let load = weight * half;
    let mut bracket = (1e-3_f64, 100.0_f64);
    for _ in 0..100 {
        let h = 0.5 * (bracket.0 + bracket.1);
        let wide = h * half / stiffness + h / weight * (load / h).asinh();
        *(if wide < 0.5 * span { &mut bracket.0 } else { &mut bracket.1 }) = h;
    }
    let h = bracket.0;
    let sag =
        load * load / (2.0 * stiffness * weight) + h / weight * ((1.0 + (load / h).powi(2)).sqrt() - 1.0);
    for cells in [100, 300] {
        let mut model =
            one(vec![support(0.0, FixedRotation::Free), support(1.0, FixedRotation::Free)], vec![]);
        model.beams = vec![beam("cable", [0.0; 2], [1.0, 0.0], ancf(cells))];
        model.beams[0].section = Section {
            axial_stiffness: Some(stiffness.into()),
            bending_stiffness: None,
            mass_per_length: Some(1.0.into()),
            ..Default::default()
        };
        model.supports[1].displacement = Displacement { x: span - 1.0, ..Displacement::default() };
        model.parts = vec![Arc::new(Gravity::new([0.0, -weight]))];
        model.probes = tip(0, half);
        let trajectory = model.solve(&Static::default()).expect("an equilibrium");
        let middle = trajectory.probes[0].samples.last().expect("a record");
        // Even cells err by their length to the fourth power.
        assert!(
            (middle.x - 0.5 * span).abs() < 1e-7 && (middle.y + sag).abs() < 1e-6,
            "{middle:?}, sag {sag}"
        );
        assert!(trajectory.run.warnings.is_empty(), "{:?}", trajectory.run.warnings);
        let pull = trajectory.reactions[1].samples.last().expect("a record").fx;
        assert!((pull - h).abs() < 1e-3 * h, "{pull} N, not {h} N");
    }
}

/// A clamp that turns by 200° brings the arm and the cable that hangs from it to the same place in one step
/// as in twenty. Turned at once, they came to rest on the other side of the clamp, in an equilibrium to which
/// no turning leads.
#[test]
fn a_clamp_turns_the_way_that_it_is_told() {
    let text = |turn: f64, steps: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 5, mass_per_length = 1, basis.ancf.elements = 8 }}
            beam.cable = {{ start = [1, 0], end = [2, 0], axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 6 }}
            joint = [{{ type = 'hinge', first = {{ beam = 'arm', at = 'end' }}, second = {{ beam = 'cable', at = 'start' }} }}]
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'], move.angle = {turn} }}]
            effect.gravity.acceleration = [0, -9.81]
            probe = [{{ name = 'end', beam = 'cable', at = 'end' }}]
            analysis.static{steps}\n"
        )
    };
    let found = |turn: f64, steps: &str| {
        let text = text(turn, steps);
        let scene = ancf::scene::parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let found = scene.model().solve(scene.analysis()).expect("an equilibrium");
        let seen = found.states().probes[0].samples.last().expect("a record");
        (found.states().parameter.len(), [seen.x, seen.y])
    };
    let (_, expected) = found(3.5, ".steps = 20");
    for (steps, records) in [(" = {}", 2), (".steps = 1", 2), (".steps = 3", 4)] {
        let (count, end) = found(3.5, steps);
        assert_eq!(count, records, "{steps}");
        assert!((0..2).all(|i| (end[i] - expected[i]).abs() < 1e-6), "{steps}: {end:?}, not {expected:?}");
    }
    assert!(expected[0] < -0.5, "{expected:?}");
}

/// A string of few uneven cells that should fold up to its supports' line holds itself in another
/// shape, by thrusts of a thousand newtons that a load of hundredths cannot cause: it is told. A
/// cable that hangs between its supports is not.
#[test]
fn strings_that_hold_themselves_are_told() {
    let string = |length: f64, young: &str, nodes: &str, value: [f64; 2], ends: [&str; 2]| {
        let text = format!(
            "[beam.a]\nstart = [0, 0]\nend = [{length:?}, 0]\naxial_stiffness = {young}\nmass_per_length = 1\nbasis.ancf.{nodes}\n\
             [[support]]\nbeam = \"a\"\nat = \"start\"\nfix = {}\n[[support]]\nbeam = \"a\"\nat = \"end\"\nfix = {}\n\
             [[effect.distributed_force]]\nbeam = \"a\"\nvalue = {value:?}\n[analysis.static]\n",
            ends[0], ends[1]
        );
        let scene = ancf::scene::parse("string.toml", &text).expect("a legal scene");
        scene.model().solve(scene.analysis()).expect("an equilibrium").into_states().run.warnings
    };
    let both = r#"["x", "y"]"#;
    let nodes = "nodes = [0.0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.8]";
    let warnings = string(0.8, "2.5e8", nodes, [-0.003, 0.07], [both, r#"["y"]"#]);
    assert!(warnings.iter().any(|warning| warning.contains("holds itself")), "{warnings:?}");
    for (stiffness, elements) in [("1e3", 4), ("1e5", 10), ("2.5e8", 6), ("2.5e8", 40)] {
        let warnings =
            string(0.8, stiffness, &format!("elements = {elements}"), [-0.003, 0.07], [both, both]);
        assert!(warnings.is_empty(), "{stiffness} {elements}: {warnings:?}");
    }
}

/// A string passes no couple on: where it is held in a direction, welded, or given a moment, the
/// shape depends on the mesh, and is told.
#[test]
fn couples_on_strings_are_told() {
    let warnings = |fix: &str, effects: &str| {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 12 }}
             beam.b = {{ start = [1, 0], end = [2, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
             support = [{{ beam = 'a', at = 'start', fix = {fix} }}, {{ beam = 'b', at = 'end', fix = ['x', 'y', 'angle'] }}]
             effect.gravity.acceleration = [0, -1]\n{effects}\nanalysis.static = {{}}\n"
        );
        let scene = ancf::scene::parse("string.toml", &text).unwrap_or_else(|error| panic!("{error:?}"));
        scene.model().solve(scene.analysis()).expect("an equilibrium").into_states().run.warnings
    };
    let joint = |kind: &str| {
        format!(
            "joint = [{{ type = '{kind}', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}]"
        )
    };
    let (pin, hinge) = ("['x', 'y']", joint("hinge"));
    assert_eq!(warnings(pin, &hinge), Vec::<String>::new());
    for (fix, effects, words) in [
        ("['x', 'y', 'angle']", hinge.clone(), "support 1 holds its direction at s = 0.000000 m"),
        ("['x', 'y', 'gradient']", hinge.clone(), "support 1 holds its direction at s = 0.000000 m"),
        (pin, joint("weld"), "joint 1 welds it at s = 1.000000 m"),
        (
            pin,
            hinge.clone() + "\neffect.moment = [{ beam = 'a', at = 0.5, value = 0.01 }]",
            "a moment, a torsion spring or rotary inertia acts on it at s = 0.500000 m",
        ),
        (
            pin,
            hinge.clone() + "\neffect.torsion_spring = [{ beam = 'a', at = 0.25, stiffness = 1 }]",
            "a moment, a torsion spring or rotary inertia acts on it at s = 0.250000 m",
        ),
    ] {
        let warnings = warnings(fix, &effects);
        let told = |warning: &&String| warning.contains("beam `a` has no `bending_stiffness`");
        assert_eq!(warnings.iter().filter(told).count(), 1, "{words}: {warnings:?}");
        assert!(warnings.iter().any(|warning| warning.contains(words)), "{words}: {warnings:?}");
    }
}

/// A cable between two supports vibrates about its catenary, whether it was laid out as an arc or
/// hinged together of two straight pieces of the same length. Round-off ends Newton's iterations at
/// increments of 1e-13, and is no reason to refuse a fine mesh.
#[test]
fn a_hanging_cable_vibrates_however_it_was_laid_out() {
    let string = |geometry: &str, elements: usize| {
        format!(
            "{{ {geometry}, axial_stiffness = 2e4, mass_per_length = 1, basis.ancf.elements = {elements} }}"
        )
    };
    let held = "support = [{ beam = \"a\", at = \"start\", fix = [\"x\", \"y\"] }, \
                { beam = \"END\", at = \"end\", fix = [\"x\", \"y\"] }]\n\
                effect.gravity.acceleration = [0, -9.81]\n\
                analysis.modal = { about = \"equilibrium\", count = 3 }\n";
    let frequencies = |text: &str| {
        let scene =
            ancf::scene::parse("cable.toml", text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
        let results =
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
        let iterations = results.run().statistics.newton_iterations;
        assert!(iterations < 100, "{iterations} iterations");
        results.eigenvalues()
    };
    // Half a circle of unit diameter, and two legs of a quarter of π each.
    let depth = ((PI / 4.0).powi(2) - 0.25).sqrt();
    for elements in [16, 48] {
        let arc = string(
            "arc = { center = [0.5, 0], radius = 0.5, from = \"180 deg\", to = \"360 deg\" }",
            2 * elements,
        );
        let one = frequencies(&format!("beam.a = {arc}\n{}", held.replace("END", "a")));
        let two = frequencies(&format!(
            "beam.a = {}\nbeam.b = {}\n\
             joint = [{{ type = \"hinge\", first = {{ beam = \"a\", at = \"end\" }}, second = {{ beam = \"b\", at = \"start\" }} }}]\n{}",
            string(&format!("start = [0, 0], end = [0.5, {:?}]", -depth), elements),
            string(&format!("start = [0.5, {:?}], end = [1, 0]", -depth), elements),
            held.replace("END", "b"),
        ));
        for (one, two) in one.iter().zip(&two) {
            // The slope may jump at the hinge, by the error of the mesh.
            assert!((one - two).abs() < 1e-6 * one, "{one} {two}");
        }
    }
}

/// A hanging cable with hardly any bending stiffness vibrates like a chain, at j₀ₖ √(g/L)/(4π), j₀ₖ
/// being the zeros of J₀ (Bernoulli 1732). At its free end the tension vanishes, and with it, on few
/// elements, all that the usual quadrature sees of what holds the end: the frequencies are right, or
/// there is a warning.
#[test]
fn a_loose_end_is_told() {
    const ZEROS: [f64; 3] = [2.404_825_557_695_773, 5.520_078_110_286_311, 8.653_727_912_911_013];
    let mut told = Vec::new();
    const EXACT: &str = ", gauss_points = { stretch = 5, bend = 3 }";
    // The last one is warmed: what heat lengthens is no tension.
    for (elements, points, strain) in [
        (4, "", 0.0),
        (8, "", 0.0),
        (16, "", 0.0),
        (24, "", 0.0),
        (48, "", 0.0),
        (8, EXACT, 0.0),
        (8, "", 1e-3),
    ] {
        let warm = if strain > 0.0 {
            format!("effect.actuation = [{{ beam = \"a\", strain = {strain} }}]")
        } else {
            String::new()
        };
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [0, -1], axial_stiffness = 1e7, bending_stiffness = 1e-6, mass_per_length = 1, \
             basis.ancf = {{ elements = {elements}{points} }} }}
            support = [{{ beam = \"a\", at = \"start\", fix = [\"x\", \"y\"] }}]
            effect.gravity.acceleration = [0, -9.81]
            {warm}
            analysis.modal = {{ about = \"equilibrium\", count = 3 }}"
        );
        let scene = ancf::scene::parse("cable.toml", &text).expect("a legal scene");
        let results = scene.model().solve(scene.analysis()).expect("vibrations");
        let warned =
            results.run().warnings.iter().any(|warning| warning.contains("is loose at s = 1.0000 m"));
        let right =
            results.eigenvalues().iter().zip(ZEROS).all(|(frequency, zero)| {
                (frequency / (zero * 9.81_f64.sqrt() / (4.0 * PI)) - 1.0).abs() < 0.02
            });
        assert!(right || warned, "{elements} elements: {:?}", results.eigenvalues());
        told.push(warned);
    }
    assert_eq!(told, [true, true, true, true, false, false, true]);
}

/// A string whose ends come together hangs, also where its tangent has no symmetry: a faint wind, a faint
/// follower force and a rough obstacle far away change hardly anything. By the sign of the determinant
/// alone it stood as an arch, in which an even number of directions is unstable.
#[test]
fn a_string_in_a_faint_wind_hangs() {
    let sag = |more: &str| {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], mass_per_length = 0.5, axial_stiffness = 200, basis.ancf.elements = 20 }}
            support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'a', at = 'end', fix = ['x', 'y'], move.x = -0.1 }}]
            probe = [{{ name = 'm', beam = 'a', at = 0.5 }}]
            effect.gravity.acceleration = [0, -9.81]\n{more}\nanalysis.static = {{}}"
        );
        let scene = ancf::scene::parse("string.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        results.states().probes[0].samples.last().expect("a state").y
    };
    let still = sag("");
    assert!(still < -0.2, "{still}");
    for more in [
        "effect.drag = [{ beam = 'a', normal = 1e-4, flow = [1, 0] }]",
        "effect.distributed_force = [{ beam = 'a', value = [0, 1e-4], follower = true }]",
        "effect.contact = [{ beam = 'a', stiffness = 1e3, half_plane = { point = [0, -5], normal = [0, 1] }, friction.coefficient = 0.3 }]",
    ] {
        let found = sag(more);
        assert!((found - still).abs() < 1e-3, "{more}: {found} for {still}");
    }
}

/// The direction of a string that nothing loads yet is chance, to a hundredth, and the turns of the first two records count from where it
/// was laid out: whole turns are the same however the whole is turned.
#[test]
fn turns_of_a_slack_string_do_not_depend_on_where_it_is_laid_out() {
    let turn = |by: f64| {
        let (sine, cosine) = by.sin_cos();
        let at = |[x, y]: [f64; 2]| format!("[{}, {}]", cosine * x - sine * y, sine * x + cosine * y);
        let points = [[0.0, 0.0], [-0.29, -0.13], [-0.58, -0.26], [-0.94, -0.31]].map(at).join(", ");
        let text = format!(
            "beam.rope = {{ start = [0, 0], end = {}, axial_stiffness = 5000, mass_per_length = 3, basis.rpim.nodes = 3, initial_shape.points = [{points}] }}
            effect.distributed_force = [{{ beam = 'rope', value = {} }}]
            effect.spring = [{{ beam = 'rope', at = 'end', stiffness = 40 }}]
            probe = [{{ name = 'end', beam = 'rope', at = 'end' }}]
            analysis.static = {{}}\n",
            at([-0.74, -0.672]),
            at([-0.4, 0.44])
        );
        let scene = ancf::scene::parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        let [first, second] = &results.states().probes[0].samples[..] else { panic!("two records") };
        second.angle - first.angle
    };
    let expected = turn(0.0);
    assert!(expected.abs() < std::f64::consts::PI, "{expected}");
    for k in 1..8 {
        let found = turn(0.8 * f64::from(k));
        assert!((found - expected).abs() < 0.1, "turned by {k} times 0.8 rad: {found}, not {expected}");
    }
}
