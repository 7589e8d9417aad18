//! What a run leaves besides numbers of probes: frames, outlines, what it was solved with, energies
//! and forces of effects, shapes that are free of stress.

use super::near;
use ancf::results::Trajectory;
use ancf::run::Options;
use ancf::scene::parse;
use std::f64::consts::PI;

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

const BAR: &str = "beam.bar = { start = [0, 0], end = [2, 0], axial_stiffness = 10, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 1 }
    support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
    effect.force = [{ beam = 'bar', at = 'end', value = [1, 0] }]\n";

/// Up to four hundred frames, evenly spaced and with the last record; a frame is a hundred parts of
/// each beam.
#[test]
fn frames_are_thinned_evenly_and_end_with_the_last_record() {
    let steps = |steps: usize| solved(&format!("{BAR}analysis.static.steps = {steps}\n"));
    let motion = |records: f64| {
        solved(&format!(
            "{BAR}analysis.dynamic = {{ duration = {:?}, output_every = 0.01, gauss = {{ stages = 1, step = 0.01 }} }}\n",
            0.01 * records
        ))
    };
    for (found, records, every) in [
        (steps(399), 400, 1),
        (steps(400), 401, 2),
        (steps(501), 502, 2),
        (steps(810), 811, 3),
        (motion(399.0), 400, 1),
        (motion(401.0), 402, 2),
    ] {
        assert_eq!(found.parameter.len(), records);
        let mut expected: Vec<f64> = found.parameter.iter().copied().step_by(every).collect();
        if (records - 1) % every != 0 {
            expected.push(found.parameter[records - 1]);
        }
        let frames: Vec<f64> = found.frames.iter().map(|frame| frame.parameter).collect();
        assert_eq!(frames, expected, "{records} records");
        assert!(found.frames.iter().all(|frame| frame.beams.len() == 1 && frame.beams[0].len() == 101));
    }
    // P s/EA of the load is added evenly along the bar.
    let found = steps(501);
    for frame in &found.frames {
        for (i, [x, y]) in frame.beams[0].iter().enumerate() {
            near(*x, 0.02 * i as f64 * (1.0 + 0.1 * frame.parameter), 1e-9, "x");
            near(*y, 0.0, 1e-12, "y");
        }
    }
}

/// A frame of two beams of other lengths, contacts and joints.
const FRAME: &str = "beam.a = { start = [0, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, strain = 'green', \
    basis.ancf.elements = 3 }
    beam.b = { start = [2, 0], end = [2, 1.5], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, \
    basis.rpim = { nodes = 4, spacing = 'chebyshev', side_condition = 'minus' } }
    title = 'All that is said'
    joint = [{ type = 'weld', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]
    support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]
    effect.force = [{ beam = 'b', at = 'end', value = [0.1, 0] }]
    effect.spring = [{ beam = 'b', at = 'end', stiffness = 1 }]
    effect.contact = [{ beam = 'a', circle = { center = [1, -3], radius = 0.5 }, stiffness = 10 }, \
    { beam = 'b', half_plane = { point = [0.5, -4], normal = [3, 4] }, stiffness = 10 }, \
    { beam = 'b', box = { center = [5, 6], size = [2, 1], angle = '90 deg' }, stiffness = 10 }]
    output = { reactions = true, effects = true }\n";

/// Obstacles have a border that belongs in a picture, springs have none: a circle by parts of five
/// degrees, a half-plane as long as the longest beam on either side, a box by its corners.
#[test]
fn outlines_are_those_of_the_obstacles() {
    let found = solved(&format!("{FRAME}analysis.static = {{}}\n"));
    let [circle, plane, corners] = &found.run.outlines[..] else { panic!("{:?}", found.run.outlines) };
    assert_eq!(circle.len(), 73);
    for (i, [x, y]) in circle.iter().enumerate() {
        let angle = i as f64 * PI / 36.0;
        near(*x, 1.0 + 0.5 * angle.cos(), 1e-12, "x");
        near(*y, -3.0 + 0.5 * angle.sin(), 1e-12, "y");
    }
    let close = |found: &[[f64; 2]], expected: &[[f64; 2]]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (a, b) in found.iter().zip(expected) {
            near(a[0], b[0], 1e-12, "x");
            near(a[1], b[1], 1e-12, "y");
        }
    };
    close(plane, &[[0.5 + 1.6, -4.0 - 1.2], [0.5 - 1.6, -4.0 + 1.2]]);
    close(corners, &[[4.5, 7.0], [4.5, 5.0], [5.5, 5.0], [5.5, 7.0], [4.5, 7.0]]);
}

/// The lines that say what was solved and how: would catch the other beam's length, points of one
/// energy for those of the other, and a rule for the other.
#[test]
fn what_was_solved_is_told() {
    let motion = "analysis.dynamic = { duration = 0.01, output_every = 0.01, generalized_alpha = { step = 0.005, spectral_radius = 0.6 } }\n";
    let found = solved(&format!("{FRAME}{motion}"));
    assert_eq!(found.run.title, "All that is said");
    let told = |name: &str| {
        let line = found.run.settings.iter().find(|(of, _)| of == name);
        line.unwrap_or_else(|| panic!("{name} in {:?}", found.run.settings)).1.as_str()
    };
    for (name, value) in [
        ("beam a", "2 m, ANCF cable elements, 4 uniform nodes"),
        ("beam a, strain", "green; Lobatto points 3 (stretch), Gauss points 2 (bend) a cell"),
        (
            "beam b",
            "1.5 m, RPIM, 4 Chebyshev nodes, multiquadric (q = 1.03, shape 5), 2 polynomial terms, side condition −, 2 neighbours a side",
        ),
        ("beam b, strain", "engineering; Gauss points 4 (stretch), Gauss points 4 (bend) a cell"),
        ("linear solver", "banded LDLᵀ, constraints condensed"),
        ("integrator", "generalised-α (ρ∞ = 0.6), step 0.005 s"),
    ] {
        assert_eq!(told(name), value);
    }
    let effects: Vec<&str> = told("effects").split(", ").collect();
    for kind in ["stretch", "bend", "inertia", "contact", "force", "spring"] {
        assert!(effects.contains(&kind), "{kind} in {effects:?}");
    }
    assert!(effects.windows(2).all(|pair| pair[0] != pair[1]), "{effects:?}");
    let names: Vec<&str> = found.reactions.iter().map(|series| series.name.as_str()).collect();
    assert_eq!(names, ["support1", "joint1"]);
    assert_eq!((found.parameter.len(), found.reactions[1].samples.len()), (2, 2));
    assert!(found.run.statistics.steps == 2 && found.frames.len() == 2);
}

/// Where an effect has no energy its samples have none, and inertia no force.
#[test]
fn effects_without_energy_have_none() {
    let found = solved(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 2, basis.ancf.elements = 2 }
        initial_velocity = [{ beam = 'arm', value = [0.5, 1] }]
        effect.drag = [{ beam = 'arm', viscous_normal = 0.3, viscous_tangential = 0.2 }]
        effect.damping = [{ beam = 'arm', mass_proportional = 0.1 }]
        output.effects = true
        analysis.dynamic = { duration = 0.1, output_every = 0.05 }\n",
    );
    for (name, has_energy) in
        [("stretch.arm", true), ("inertia.arm", true), ("drag.arm", false), ("damping.arm", false)]
    {
        let series = found.effects.iter().find(|series| series.name == name);
        let series = series.unwrap_or_else(|| panic!("{name} in {:?}", found.effects));
        assert_eq!((series.has_energy, series.samples.len()), (has_energy, 3), "{name}");
        if !has_energy {
            assert!(series.samples.iter().all(|sample| sample[0] == 0.0), "{name}: {:?}", series.samples);
            assert!(series.samples[0][1] < 0.0 && series.samples[0][2] < 0.0, "it brakes");
        }
    }
    let inertia = found.effects.iter().find(|series| series.name == "inertia.arm").expect("mass");
    assert!(inertia.samples.iter().all(|sample| sample[1..] == [0.0, 0.0]), "{:?}", inertia.samples);
    near(inertia.samples[0][0], 1.25, 1e-12, "½ m v²");
}

/// A curved beam of few cells is free of stress as it is: its strain is counted from there, in
/// shapes and in probes, and under a load both say the same.
#[test]
fn strains_of_a_curved_beam_are_zero_without_load() {
    for basis in ["ancf.elements = 2", "rpim.nodes = 3"] {
        for measure in ["green", "engineering"] {
            let found = solved(&format!(
                "beam.other = {{ start = [3, 0], end = [3, 1], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 3 }}
                 beam.bow = {{ arc = {{ center = [0, 0], radius = 1, from = '0 deg', to = '150 deg' }}, axial_stiffness = 1e3, \
                 bending_stiffness = 1, strain = '{measure}', basis.{basis} }}
                 support = [{{ beam = 'bow', at = 'start', fix = ['x', 'y', 'angle'] }}, \
                 {{ beam = 'other', at = 'start', fix = ['x', 'y', 'angle'] }}]
                 effect.force = [{{ beam = 'bow', at = 'end', value = [5, 3] }}]
                 probe = [{{ name = 'third', beam = 'bow', at = '50 cm' }}, {{ name = 'end', beam = 'bow', at = 'end' }}]
                 analysis.static.steps = 2\n"
            ));
            let free = &found.run.undeformed[1];
            assert_eq!(free.strain.len(), 201);
            // The positions alone are stretched by some hundredths within the cells.
            assert!(free.strain.iter().all(|strain| *strain == 0.0), "{basis}, {measure}");
            for probe in &found.probes {
                assert_eq!(probe.samples[0].strain, 0.0, "{basis}, {measure}, {}", probe.name);
            }
            let last = &found.last[1];
            let end = found.probes[1].samples[2];
            let rows = last.s.len() - 1;
            near(end.strain, last.strain[rows], 1e-13, "strain");
            near(end.x, last.x[rows], 1e-13, "x");
            near(end.y, last.y[rows], 1e-13, "y");
            near(end.curvature, last.curvature[rows], 1e-10, "curvature");
            assert!(end.strain.abs() > 1e-5, "{}", end.strain);
            assert_eq!(last.nodes.len(), 3);
            near(last.nodes[0][0], 1.0, 1e-13, "the first node");
            near(last.nodes[2][0], end.x, 1e-12, "the last node");
            near(last.nodes[2][1], end.y, 1e-12, "the last node");
        }
    }
}

/// Places that are one to a billionth of the length have two rows where a force acts, not three: at
/// a place between rows, and at one that misses a row by less than that.
#[test]
fn a_force_next_to_a_row_takes_its_place() {
    for (at, rows) in [("255.0000003", 202), ("252.5", 203), ("255.01", 203)] {
        let found = solved(&format!(
            "beam.bar = {{ start = [0, 0], end = [1000, 0], axial_stiffness = 1e7, bending_stiffness = 1e10, basis.ancf.elements = 4 }}
             support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{{ beam = 'bar', at = {at}, value = [3, 0] }}, {{ beam = 'bar', at = 'end', value = [2, 0] }}]
             analysis.static = {{}}\n"
        ));
        let shape = &found.last[0];
        assert_eq!(shape.s.len(), rows, "{at}");
        let place: f64 = at.parse().expect("a number");
        let first = shape.s.iter().position(|s| *s == place).expect("a row at the force");
        assert_eq!(shape.s[first + 1], place);
        for (i, n) in shape.axial_force.iter().enumerate() {
            near(*n, if i <= first { 5.0 } else { 2.0 }, 1e-6, &format!("N in row {i} of {at}"));
        }
        assert!(shape.s.is_sorted());
    }
}

/// One load step winds the second of two beams up by two turns, clockwise, from a direction that is
/// not along an axis: its places turn by M s/EI each.
#[test]
fn angles_count_turns_of_any_beam_in_any_direction() {
    for (at, tip) in [("start", "end"), ("end", "start")] {
        let found = solved(&format!(
            "beam.a = {{ start = [0, 0], end = [0.6, 0.8], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 2 }}
             beam.b = {{ start = [2, 0], end = [1, 1.7320508], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 64 }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'b', at = '{at}', fix = ['x', 'y', 'angle'] }}]
             effect.moment = [{{ beam = 'b', at = '{tip}', value = {} }}]
             probe = [{{ name = 'near', beam = 'b', at = 0.7 }}, {{ name = 'tip', beam = 'b', at = '{tip}' }}]
             analysis.static.steps = 2\n",
            -2.0 * PI
        ));
        let direction = 2.0 * PI / 3.0;
        let from = if at == "start" { 0.0 } else { 2.0 };
        for (probe, s) in found.probes.iter().zip([0.7_f64, 2.0 - from]) {
            for (sample, load) in probe.samples.iter().zip([0.0, 0.5, 1.0]) {
                let angle = direction - load * 2.0 * PI * (s - from).abs();
                near(sample.angle, angle, 2e-3, &format!("{} clamped at its {at}, load {load}", probe.name));
            }
        }
    }
}

/// A bent beam on a hinge whose stress-free shape is an arc, and a string; in statics and in motion. What is kept at
/// places of each is what probes there see, record by record; without places nothing is kept, and without the
/// wish to go on no state.
#[test]
fn runs_keep_every_record_where_they_are_asked_to() {
    let text = |probes: bool, analysis: &str| {
        let places = if probes {
            "probe = [{ name = 'a', beam = 'bow', at = 0.3 }, { name = 'b', beam = 'bow', at = 1.5 }, { name = 'c', beam = 'rope', at = 0.45 }]\n"
        } else {
            ""
        };
        format!(
            "beam.bow = {{ arc = {{ center = [0, 0], radius = 1, from = 0, to = 1.5 }}, axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 6 }}\n\
             beam.rope = {{ start = [0, 2], end = [1, 2], axial_stiffness = 10, mass_per_length = 1, basis.ancf.elements = 5 }}\n\
             support = [{{ beam = 'bow', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}, \
             {{ beam = 'rope', at = 'end', fix = ['x', 'y'] }}]\n\
             effect.gravity = {{ acceleration = [0, -2] }}\n{places}{analysis}\n"
        )
    };
    let stations = [vec![0.3, 1.5], vec![0.45]];
    for analysis in [
        "analysis.static.steps = 3",
        "analysis.dynamic = { duration = 0.3, output_every = 0.1, radau.tolerance = 1e-5 }",
    ] {
        let options = || Options { stations: &stations, saved: false, ..Options::default() };
        let run = |probes: bool, options: Options<'_>| {
            let scene = parse("kept.toml", &text(probes, analysis)).expect("a scene");
            scene.model().solve_with(scene.analysis(), options).expect("an end").into_states()
        };
        let (kept, seen) = (run(false, options()), run(true, Options::default()));
        assert!(kept.saved.is_none() && seen.saved.is_some() && seen.stations.is_empty());
        assert_eq!((kept.parameter.len(), kept.stations.len()), (4, 4), "{analysis}");
        for (record, beams) in kept.stations.iter().enumerate() {
            assert_eq!(beams.iter().map(|shape| &shape.beam[..]).collect::<Vec<_>>(), ["bow", "rope"]);
            let places = beams.iter().flat_map(|shape| (0..shape.s.len()).map(move |k| (shape, k)));
            for ((shape, k), probe) in places.zip(&seen.probes) {
                let sample = probe.samples[record];
                let found = [shape.x[k], shape.y[k], shape.angle[k], shape.strain[k], shape.curvature[k]];
                let expected = [sample.x, sample.y, sample.angle, sample.strain, sample.curvature];
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{analysis}, {record}, {}: {found:?} {expected:?}",
                        probe.name
                    );
                }
            }
        }
        assert!(
            kept.stations[3][1].y[0] < 2.0 - 1e-3 && kept.stations[3][0].curvature[0].abs() > 0.1,
            "it moves"
        );
    }
}
