//! Which pictures a trajectory has, and what is in them.

use super::made_up::{all, beam, buckling, level, path, rejected, rise, step, swing, vibrations};
use super::picture::{Element, Picture, digest};
use super::{show, snapshot, written};
use ancf::results::{
    AnalysisKind, BeamErrors, Energy, ErrorEstimate, Errors, ProbeErrors, ProbeSample, ProbeSeries, Results,
    Run, StepRecord, Trajectory,
};

/// The colours of series, strongest first.
const COLOURS: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#3C3C3C", "#966E3C"];
const GREY: &str = "#828282";

fn picture(results: &(impl Clone + Into<Results>), name: &str) -> Picture {
    let files = written(results);
    Picture::read(files.get(name).unwrap_or_else(|| panic!("no {name} in {:?}", files.keys())))
}

/// Whoever changes which pictures there are, or what they show, sees here what it changes.
#[test]
fn regress_figures() {
    let mut text = String::new();
    for (name, results) in all() {
        for (file, svg) in written(&results).iter().filter(|(file, _)| file.ends_with(".svg")) {
            show(&format!("{name}/{file}"), svg);
            text += &format!("== {name}/{file}\n{}", digest(svg));
        }
    }
    snapshot("figures", &text);
}

/// The names of the pictures without extension.
fn names(results: &(impl Clone + Into<Results>)) -> Vec<String> {
    written(results).into_keys().filter_map(|name| name.strip_suffix(".svg").map(str::to_owned)).collect()
}

/// Would catch pictures of nothing, and pictures that are missing.
#[test]
fn what_there_is_decides_what_is_drawn() {
    let states = ["curvature", "shape", "strain"];
    let records = ["angle", "curvature", "energy", "position", "shape", "strain", "velocity"];
    assert_eq!(names(&Trajectory::default()), Vec::<String>::new());
    assert_eq!(names(&rise(0)), Vec::<String>::new());
    assert_eq!(names(&rise(1)), states);
    assert_eq!(names(&rise(2)), records);
    // Velocities belong to motions, and quantities of probes to probes.
    let still = Trajectory { run: Run { analysis: AnalysisKind::Static, ..rise(2).run }, ..rise(2) };
    assert_eq!(names(&still), records[..6]);
    let unseen = Trajectory { probes: Vec::new(), ..rise(2) };
    assert_eq!(names(&unseen), ["curvature", "energy", "shape", "strain"]);
    let shapeless = Trajectory { last: Vec::new(), ..rise(2) };
    assert_eq!(names(&shapeless), ["angle", "energy", "position", "velocity"]);
    // The solver's way.
    let history = |steps: &[StepRecord]| names(&Trajectory { history: steps.to_vec(), ..rise(1) });
    let one = step(0.1, 0.1, &[1e-3], &[1e-4]);
    assert_eq!(history(std::slice::from_ref(&one)), ["convergence", "curvature", "shape", "strain"]);
    let with = |more: &[&str]| {
        let mut all: Vec<String> = states.iter().chain(more).map(|name| (*name).to_owned()).collect();
        all.sort();
        all
    };
    assert_eq!(history(&[one.clone(), one.clone()]), with(&["convergence", "newton", "steps"]));
    assert_eq!(history(&[one.clone(), rejected(one.clone())]), with(&["convergence"]));
    let idle = step(0.1, 0.1, &[], &[]);
    assert_eq!(history(&[idle.clone(), idle.clone()]), with(&["steps"]));
    let settled = step(0.1, 0.1, &[], &[1e-9]);
    assert_eq!(history(&[settled.clone(), settled]), with(&["convergence", "steps"]));
    let load_steps = Trajectory {
        run: Run { analysis: AnalysisKind::Static, ..rise(1).run },
        history: vec![one.clone(), one],
        ..rise(1)
    };
    assert_eq!(names(&load_steps), with(&["convergence", "steps"]));
    assert_eq!(names(&buckling()), ["modes"]);
}

/// Up to some two dozen states on the way, evenly, each where it was, and not the last one, which
/// is drawn by itself.
#[test]
fn states_on_the_way_are_drawn_evenly() {
    for (records, stride, count) in [(50, 3, 17), (25, 2, 12), (24, 1, 23), (10, 1, 9), (2, 1, 1)] {
        let picture = picture(&rise(records), "shape.svg");
        let lines = picture.lines(COLOURS[5]);
        // With the sample in the legend.
        assert_eq!(lines.len(), count + 1, "{records} records");
        if records >= 24 {
            for (i, line) in lines.iter().take(count).enumerate() {
                let height = picture.place(1, false, 0.01 * (stride * i) as f64);
                let points = line.points();
                assert!(
                    (points[0][1] - height).abs() < 3.0 && points[0][1] == points[1][1],
                    "{records}, {i}"
                );
            }
        }
        assert_eq!((lines[0].word("stroke-width"), lines[0].word("opacity")), ("10", "0.5"));
        assert_eq!(picture.text("on the way").word("text-anchor"), "start");
    }
    // Without frames nothing is on the way.
    let picture = picture(&Trajectory { frames: Vec::new(), ..rise(3) }, "shape.svg");
    assert_eq!(picture.lines(COLOURS[5]).len(), 0);
}

/// Each beam has its colour and its name; what they share is named once.
#[test]
fn beams_are_told_apart() {
    let heights = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2];
    let mut last: Vec<_> = heights.map(level).to_vec();
    for (i, shape) in last.iter_mut().enumerate() {
        shape.beam = format!("b{i}");
        shape.curvature = vec![0.1 * i as f64; 3];
    }
    let several = Trajectory {
        run: Run { undeformed: last.clone(), ..rise(1).run },
        last,
        frames: Vec::new(),
        ..rise(1)
    };
    let expected = [0, 1, 2, 3, 4, 6, 0].map(|i| COLOURS[i]);
    let found = picture(&several, "shape.svg");
    let wide = found.named("polyline").filter(|line| line.word("stroke-width") == "22");
    assert_eq!(wide.take(7).map(|line| line.word("stroke")).collect::<Vec<_>>(), expected);
    // Two nodes each, in their beam's colour.
    let nodes = found.named("circle").take(14).map(|circle| circle.word("fill"));
    assert_eq!(nodes.collect::<Vec<_>>(), expected.map(|colour| [colour; 2]).concat());
    for shared in ["undeformed", "nodes", "b0", "b1"] {
        assert_eq!(found.text(shared).word("text-anchor"), "start");
    }
    assert!(!found.texts().contains(&"deformed"));
    let along = picture(&several, "curvature.svg");
    let lines = along.named("polyline").filter(|line| line.word("stroke-width") == "18");
    assert_eq!(lines.take(7).map(|line| line.word("stroke")).collect::<Vec<_>>(), expected);
    assert!(along.texts().contains(&"b0") && along.texts().contains(&"b1"));
    // One beam needs no name.
    let found = picture(&rise(3), "shape.svg");
    assert_eq!(found.text("deformed").word("text-anchor"), "start");
    assert!(!found.texts().contains(&"arm"));
    assert!(!picture(&rise(3), "curvature.svg").texts().contains(&"arm"));
}

/// Obstacles, probes' paths and the rest are there, named once, and where they are.
#[test]
fn a_shape_has_its_surroundings() {
    let found = picture(&path(), "shape.svg");
    for name in ["obstacle", "on the way", "undeformed", "arm", "leg", "nodes"] {
        assert_eq!(found.text(name).word("text-anchor"), "start");
    }
    let obstacles: Vec<_> =
        found.lines(GREY).into_iter().filter(|l| l.word("stroke-width") == "16").collect();
    assert_eq!(obstacles.len(), 3, "two, and a sample");
    for (axis, value) in [-0.05, -0.21].into_iter().enumerate() {
        let place = found.place(axis, false, value);
        assert!((obstacles[0].points()[0][axis] - place).abs() < 3.0, "{value}");
    }
    assert!(!found.texts().iter().any(|text| text.starts_with("path of")), "paths belong to motions");
    let found = picture(&swing(), "shape.svg");
    assert_eq!(found.text("path of end").word("text-anchor"), "start");
    assert_eq!(found.text("path of -inner").word("text-anchor"), "start");
    let paths = found.lines(COLOURS[1]);
    assert_eq!(
        (paths[0].points().len(), paths[0].word("stroke-width"), paths[0].word("opacity")),
        (5, "9", "0.8")
    );
}

/// So many nodes along a level beam.
fn nodes(count: usize, height: f64) -> Vec<[f64; 2]> {
    (0..count).map(|i| [i as f64 / count as f64, height]).collect()
}

#[test]
fn many_nodes_are_drawn_smaller_or_not_at_all() {
    for (count, radius, of_a_mode) in [(60, "32", 60), (61, "18", 0)] {
        let mut trajectory = rise(2);
        trajectory.last[0].nodes = nodes(count, 0.01);
        let dots = picture(&trajectory, "shape.svg");
        let dots = dots.dots(COLOURS[0]);
        assert_eq!(dots.len(), count + 1);
        assert!(dots.iter().all(|dot| dot.word("r") == radius), "{count}");
        let mut found = buckling();
        found.unloaded.last[0].nodes = nodes(count, 0.01);
        found.modes[0].shape[0].nodes = nodes(count, 0.1);
        let dots = picture(&found, "modes.svg");
        assert_eq!(dots.dots(COLOURS[0]).len(), of_a_mode);
    }
}

/// Few records have dots on their lines, which would otherwise hide how few they are.
#[test]
fn few_records_have_dots() {
    for (records, count) in [(2, 2), (60, 60), (61, 0)] {
        let trajectory = rise(records);
        // x and y of one probe in one colour; of the energies the kinetic one.
        for (name, colour, count) in [
            ("position.svg", COLOURS[0], 2 * count),
            ("velocity.svg", COLOURS[0], 2 * count),
            ("angle.svg", COLOURS[0], count),
            ("energy.svg", COLOURS[1], count),
        ] {
            let found = picture(&trajectory, name);
            assert_eq!(found.dots(colour).len(), count, "{name} of {records} records");
            assert!(found.dots(colour).iter().all(|dot| dot.word("r") == "18"), "{name}");
        }
    }
}

#[test]
fn probes_have_their_colours_and_two_lines_each() {
    let mut trajectory = rise(70);
    let one = trajectory.probes.remove(0);
    trajectory.probes = (0..10).map(|i| ProbeSeries { name: format!("p{i}"), ..one.clone() }).collect();
    let found = picture(&trajectory, "position.svg");
    let whole = found.named("polyline").filter(|line| line.word("stroke-width") == "18");
    let expected: Vec<&str> = (0..10).map(|i| COLOURS[i % 8]).collect();
    assert_eq!(whole.take(10).map(|line| line.word("stroke")).collect::<Vec<_>>(), expected);
    let found = picture(&rise(70), "position.svg");
    assert_eq!((found.text("end.x").word("fill"), found.text("end.y").word("fill")), ("#282828", "#282828"));
    // x stays, and is drawn whole; y rises, and is drawn dashed.
    let lines = found.lines(COLOURS[0]);
    let place = |axis, value| found.place(axis, false, value);
    let whole = lines.iter().find(|line| line.points().len() == 70).expect("x").points();
    assert!(whole.iter().all(|p| (p[1] - place(1, 1.0)).abs() < 3.0));
    let dashes: Vec<_> = lines.iter().filter(|line| line.word("stroke-width") == "14").collect();
    assert!(dashes.len() > 20);
    let first = dashes[0].points()[0];
    assert!((first[0] - place(0, 0.0)).abs() < 3.0 && (first[1] - place(1, 0.0)).abs() < 3.0);
    let found = picture(&rise(70), "velocity.svg");
    assert_eq!(
        (found.text("end.vx").word("fill"), found.text("end.vy").word("fill")),
        ("#282828", "#282828")
    );
}

/// A beam whose section tells its faces has a thin line on either side, and its tendon has one of its own.
#[test]
fn a_shape_has_the_faces_of_its_beam_and_its_tendons() {
    let mut trajectory = rise(2);
    for shape in &mut trajectory.last {
        shape.angle = vec![0.0; 3];
        shape.faces = vec![[-0.1, 0.2], [-0.1, 0.2], [-0.15, 0.25]];
        shape.tendons = vec![vec![[0.0, 0.05], [1.0, 0.06]]];
    }
    let found = picture(&trajectory, "shape.svg");
    let lines = |width: &str, colour: &'static str| -> Vec<Vec<[f64; 2]>> {
        let own = found.lines(colour).into_iter().filter(|line| line.word("stroke-width") == width);
        own.map(Element::points).filter(|line| line.len() > 1).collect()
    };
    let (faces, tendons) = (lines("9", COLOURS[0]), lines("14", GREY));
    let at = |place: [f64; 2]| [0, 1].map(|axis| found.place(axis, false, place[axis]));
    let expected = [
        vec![[0.0, -0.09], [0.5, -0.09], [1.0, -0.14]],
        vec![[0.0, 0.21], [0.5, 0.21], [1.0, 0.26]],
        vec![[0.0, 0.05], [1.0, 0.06]],
    ];
    let is = |line: &Vec<[f64; 2]>, expected: &Vec<[f64; 2]>| {
        let near = |(a, b): (&[f64; 2], [f64; 2])| (0..2).all(|k| (a[k] - b[k]).abs() < 3.0);
        line.len() == expected.len() && line.iter().zip(expected.iter().map(|place| at(*place))).all(near)
    };
    assert_eq!(faces.len(), 2, "{faces:?}");
    assert!(is(&faces[0], &expected[0]) && is(&faces[1], &expected[1]), "{faces:?}");
    assert!(tendons.iter().any(|line| is(line, &expected[2])), "{tendons:?}");
}

/// About the lines of a probe lie bands from the value less its error to the value with it; along the beam
/// errors have an axis of powers of ten.
#[test]
fn errors_are_drawn_about_the_values_and_along_the_beam() {
    let mut trajectory = rise(3);
    let errors = [0.002, 0.003, 0.004];
    let samples = errors.map(|y| ProbeSample { x: 2.0 * y, y, ..ProbeSample::default() }).to_vec();
    let (s, position) = (vec![0.0, 0.5, 1.0], vec![1e-6, 1e-4, 2e-3]);
    let along =
        BeamErrors { beam: "arm".into(), s: s.clone(), position: position.clone(), curvature: vec![0.0; 3] };
    trajectory.run.error = Some(Box::new(ErrorEstimate {
        estimated: Errors { result: 2e-3, ..Errors::default() },
        probes: vec![ProbeErrors { name: "end".into(), samples }],
        beams: vec![along],
        ..ErrorEstimate::default()
    }));
    let found = picture(&trajectory, "position.svg");
    let bands: Vec<_> = found.named("polygon").map(Element::points).collect();
    assert_eq!(bands.len(), 2);
    let near = |found: [f64; 2], expected: [f64; 2]| {
        assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 3.0), "{found:?} for {expected:?}");
    };
    for (band, height, factor) in [(&bands[0], [1.0; 3], 2.0), (&bands[1], [0.0, 0.01, 0.02], 1.0)] {
        let side = |sign: f64| {
            let place = move |i: usize| [0.125 * i as f64, height[i] + sign * factor * errors[i]];
            (0..3).map(place).collect::<Vec<_>>()
        };
        let round: Vec<_> = side(-1.0).into_iter().chain(side(1.0).into_iter().rev()).collect();
        for (point, [time, value]) in band.iter().zip(round) {
            near(*point, [found.place(0, false, time), found.place(1, false, value)]);
        }
    }
    let mut one = rise(1);
    one.run.error = trajectory.run.error;
    let found = picture(&one, "error.svg");
    let line = found.lines(COLOURS[0])[0].points();
    assert_eq!(line.len(), 3);
    for ((point, s), error) in line.iter().zip(s).zip(position) {
        near(*point, [found.place(0, false, s), found.place(1, true, error)]);
    }
}

/// No line leads to a record that is known between two that are not: it has a dot, however many records there are.
#[test]
fn errors_of_single_records_are_dots() {
    let dots = |every: usize| {
        let mut many = rise(100);
        let records = (0..100).map(|i| if i % every == 0 { 1e-4 } else { f64::NAN }).collect();
        let (s, values) = (vec![0.0, 1.0], vec![1e-4; 2]);
        let along = BeamErrors { beam: "arm".into(), s, position: values.clone(), curvature: values };
        many.run.error = Some(Box::new(ErrorEstimate {
            estimated: Errors { result: 1e-4, ..Errors::default() },
            records,
            beams: vec![along],
            ..ErrorEstimate::default()
        }));
        picture(&many, "error.svg").named("circle").count()
    };
    assert_eq!([dots(1), dots(4)], [0, 25]);
}

/// Would catch a round-off that looks like a signal, and a small signal that is taken for one.
#[test]
fn what_is_negligible_depends_on_the_quantity() {
    let limits = |trajectory: &Trajectory, name: &str| {
        let found = picture(trajectory, name);
        let [_, _, top, bottom] = found.frame();
        [found.value_at(1, bottom), found.value_at(1, top)]
    };
    let near = |found: [f64; 2], expected: f64, what: &str| {
        let scaled = found.map(|v| v / expected);
        assert!((scaled[0] + 1.0).abs() < 0.01 && (scaled[1] - 1.0).abs() < 0.01, "{what}: {found:?}");
    };
    // Of a beam of half a metre a curvature that bends it by 1e-9 of a radian, 2e-9 / m.
    let mut small = rise(3);
    let mut shape = beam("arm", 0.5, &[[0.0, 0.0], [0.25, 0.0], [0.5, 0.0]]);
    shape.s = vec![0.25, 0.5, 0.75];
    shape.strain = vec![4e-10, -9e-10, 0.0];
    shape.curvature = vec![1.5e-9, -1.2e-9, 0.0];
    (small.run.undeformed, small.last) = (vec![shape.clone()], vec![shape.clone()]);
    near(limits(&small, "strain.svg"), 1e-9, "strain");
    near(limits(&small, "curvature.svg"), 2e-9, "curvature");
    shape.strain = vec![4e-9, -4e-9, 0.0];
    shape.curvature = vec![3e-9, -3e-9, 0.0];
    small.last = vec![shape];
    // With a margin of 6 % of the whole.
    near(limits(&small, "strain.svg"), 1.12 * 4e-9, "strain");
    near(limits(&small, "curvature.svg"), 1.12 * 3e-9, "curvature");
    // Positions are held against 1e-9 of the longest beam, directions against 1e-7 degrees.
    for (i, sample) in small.probes[0].samples.iter_mut().enumerate() {
        (sample.x, sample.y, sample.angle) = (1e-10 * i as f64, -1e-10, 5e-10 * i as f64);
    }
    near(limits(&small, "position.svg"), 5e-10, "position");
    near(limits(&small, "angle.svg"), 1e-7, "angle");
    for (i, sample) in small.probes[0].samples.iter_mut().enumerate() {
        sample.x = 7e-10 * (i as f64 - 1.0);
        sample.y = 0.0;
        sample.angle = 4e-9 * (i as f64 - 1.0);
    }
    near(limits(&small, "position.svg"), 1.12 * 7e-10, "position");
    near(limits(&small, "angle.svg"), 1.12 * 4e-9_f64.to_degrees(), "angle");
    // Energies against the largest of them.
    for (i, energy) in small.energy.iter_mut().enumerate() {
        *energy = Energy { bend: 3e-13 * (i as f64 - 1.0), ..Energy::default() };
    }
    near(limits(&small, "energy.svg"), 1.12 * 3e-13, "energy");
}

/// What is zero throughout has no line, and hides no other.
#[test]
fn energies_that_are_not_simulated_are_left_out() {
    let found = picture(&rise(5), "energy.svg");
    assert_eq!(found.texts()[2..5], ["kinetic", "potential", "total"]);
    let found = picture(&swing(), "energy.svg");
    let expected =
        ["stretch", "bend", "kinetic", "potential", "work of loads", "springs and contacts", "lost"];
    for (name, colour) in expected.into_iter().zip([2, 0, 1, 3, 4, 5, 7].map(|i| COLOURS[i])) {
        assert!(found.texts().contains(&name), "{name}");
        assert_eq!(found.lines(colour)[0].points().len(), 5, "{name}");
    }
}

/// So many accepted steps of so many iterations each.
fn marched(steps: usize, iterations: usize) -> Trajectory {
    let history = (1..=steps).map(|i| step(0.01 * i as f64, 0.01, &vec![1e-3; iterations], &[]));
    Trajectory { history: history.collect(), ..rise(1) }
}

/// Up to 400 iterations each has a mark, numbered through, with lines between the steps.
#[test]
fn every_newton_iteration_has_its_place() {
    for (steps, iterations, radius) in [(7, 17, "26"), (8, 15, "18"), (1, 3, "26"), (100, 4, "18")] {
        let files = written(&marched(steps, iterations));
        let found = Picture::read(&files["convergence.svg"]);
        let dots = found.dots(COLOURS[0]);
        assert_eq!(dots.len(), steps * iterations + 1);
        assert!(dots.iter().all(|dot| dot.word("r") == radius), "{steps} steps");
        if steps < 100 && iterations > 3 {
            for (i, dot) in dots.iter().take(steps * iterations).enumerate() {
                let place = found.place(0, false, (i + 1) as f64);
                assert!((dot.number("cx") - place).abs() < 3.0, "{i}");
            }
            for (i, line) in separators(&found).iter().enumerate() {
                let place = found.place(0, false, (iterations * (i + 1)) as f64 + 0.5);
                assert!((line - place).abs() < 3.0, "{i}");
            }
        }
        assert_eq!(separators(&found).len(), steps - 1);
        let plural = if steps == 1 { "" } else { "s" };
        let caption = format!("; {steps} step{plural} between the vertical lines.");
        assert!(files["report.html"].contains(&caption), "{caption}");
        assert_eq!(found.text("Newton iteration, counted through").word("text-anchor"), "middle");
    }
    // Lines are left out where there are more than 150.
    assert_eq!(separators(&picture(&marched(151, 2), "convergence.svg")).len(), 150);
    assert_eq!(separators(&picture(&marched(152, 2), "convergence.svg")).len(), 0);
}

fn separators(picture: &Picture) -> Vec<f64> {
    let lines = picture.lines(GREY).into_iter().filter(|line| line.word("opacity") == "0.35");
    lines.map(|line| line.points()[0][0]).collect()
}

/// Accepted increments and residuals side by side, rejected ones apart; a step without iterations
/// takes no place.
#[test]
fn rejected_iterations_are_told_from_others() {
    let history = vec![
        step(0.1, 0.1, &[1e-2, 1e-4], &[1e-1, 1e-3, 1e-5]),
        step(0.2, 0.1, &[], &[]),
        rejected(step(0.3, 0.1, &[1e-1], &[1.0, 10.0])),
        step(0.3, 0.1, &[1e-3], &[]),
    ];
    let found = picture(&Trajectory { history, ..rise(1) }, "convergence.svg");
    let places = |colour: &'static str| {
        let dots = found.dots(colour);
        dots.iter().map(|dot| [dot.number("cx"), dot.number("cy")]).collect::<Vec<_>>()
    };
    for (colour, expected) in [
        (COLOURS[0], &[[1.0, 1e-2], [2.0, 1e-4], [6.0, 1e-3]][..]),
        (COLOURS[4], &[[1.0, 1e-1], [2.0, 1e-3], [3.0, 1e-5]]),
        (COLOURS[1], &[[4.0, 1e-1], [4.0, 1.0], [5.0, 10.0]]),
    ] {
        let found_places = places(colour);
        assert_eq!(found_places.len(), expected.len() + 1, "{colour}");
        for (found_place, [x, y]) in found_places.iter().zip(expected) {
            let place = [found.place(0, false, *x), found.place(1, true, *y)];
            let near = (0..2).all(|axis| (found_place[axis] - place[axis]).abs() < 3.0);
            assert!(near, "{colour}: {found_place:?}, not {place:?}");
        }
    }
    let lines = |colour: &'static str| {
        let lines = found.lines(colour).into_iter().filter(|line| line.word("stroke-width") == "12");
        lines.map(|line| line.points().len()).collect::<Vec<_>>()
    };
    // Steps are not joined, nor are the increments of a rejected step and its residuals.
    assert_eq!((lines(COLOURS[0]), lines(COLOURS[4]), lines(COLOURS[1])), (vec![2, 1], vec![3], vec![1, 2]));
    let between = separators(&found);
    assert_eq!(between.len(), 2);
    for (line, expected) in between.into_iter().zip([3.5, 5.5]) {
        assert!((line - found.place(0, false, expected)).abs() < 3.0, "{line}");
    }
}

/// Of more than 400 iterations the first and the last of every step; of very many steps some.
#[test]
fn of_many_iterations_the_first_and_last_are_drawn() {
    let long = |steps: usize| {
        let one = |i: usize| step(0.01 * i as f64, 0.01, &[1e-2, 1e-5], &[1e-1, 1e-7]);
        Trajectory { history: (0..steps).map(one).collect(), ..rise(1) }
    };
    let mut history = long(201);
    history.history.push(rejected(step(5.0, 0.01, &[1e-1], &[1e-1])));
    let found = picture(&history, "convergence.svg");
    assert_eq!(found.text("time [s]").word("text-anchor"), "middle");
    for (name, colour, value) in [
        ("first increment", COLOURS[5], 1e-2),
        ("last increment", COLOURS[0], 1e-5),
        ("last residual", COLOURS[4], 1e-7),
    ] {
        assert_eq!(found.text(name).word("text-anchor"), "start");
        let dots = found.dots(colour);
        assert_eq!(dots.len(), 201 + 1, "{name}");
        let height = found.place(1, true, value);
        for (i, dot) in dots.iter().take(201).enumerate() {
            let place = found.place(0, false, 0.01 * i as f64);
            assert!(
                (dot.number("cx") - place).abs() < 3.0 && (dot.number("cy") - height).abs() < 3.0,
                "{name}"
            );
            assert_eq!(dot.word("r"), "16");
        }
    }
    for (steps, count) in [(1200, 1200), (1201, 601), (2400, 1200), (2401, 801)] {
        let found = picture(&long(steps), "convergence.svg");
        assert_eq!(found.dots(COLOURS[0]).len(), count + 1, "{steps}");
    }
    // One more than the others show.
    let found = picture(&marched(401, 1), "convergence.svg");
    assert!(found.texts().contains(&"last increment"));
    // Where none was accepted there is nothing to show but the axes.
    let mut lost = marched(401, 1);
    lost.history = lost.history.into_iter().map(rejected).collect();
    assert_eq!(picture(&lost, "convergence.svg").dots(COLOURS[0]).len(), 1);
}

/// Steps of such sizes; the first two are accepted.
fn sized(sizes: &[f64]) -> Trajectory {
    let one = |(i, &size): (usize, &f64)| {
        let one = step(0.1 * (i + 1) as f64, size, &[1e-3], &[]);
        if i < 2 { one } else { rejected(one) }
    };
    Trajectory { history: sizes.iter().enumerate().map(one).collect(), ..rise(1) }
}

/// Would catch steps of much different sizes on a linear axis, and the reverse.
#[test]
fn sizes_of_steps_have_the_axis_that_shows_them() {
    for (sizes, log) in [
        (&[0.1, 0.5][..], false),
        (&[0.1, 0.51], true),
        (&[-0.1, 0.51], true),
        (&[0.3, -0.3, 0.1], false),
        (&[0.2, 0.2, 0.001], true),
        (&[0.2, 0.2, 0.0], false),
    ] {
        let found = picture(&sized(sizes), "steps.svg");
        let faint = found.named("line").filter(|line| line.word("stroke") == "#F1F1F1").count();
        assert_eq!(faint > 0, log, "{sizes:?}");
        let (dots, line) = (found.dots(COLOURS[0]), found.lines(COLOURS[0]));
        assert_eq!((dots.len(), line[0].points().len(), line[0].word("stroke-width")), (2, 2, "13"));
        for (i, dot) in dots.iter().enumerate() {
            let height = found.place(1, log, sizes[i].abs());
            assert!((dot.number("cy") - height).abs() < 3.0, "{sizes:?}");
        }
        // Rejected ones are crosses, two strokes each, with one in the legend.
        let strokes = found.named("line").filter(|line| line.word("stroke") == COLOURS[1]).count();
        let shown = sizes[2..].iter().filter(|size| !log || **size != 0.0).count();
        assert_eq!(strokes, if sizes.len() > 2 { 2 * shown + 2 } else { 0 }, "{sizes:?}");
        assert_eq!(found.text("step [s]").word("text-anchor"), "middle");
    }
    let still = Trajectory {
        run: Run { analysis: AnalysisKind::Static, ..sized(&[0.1, 0.2]).run },
        ..sized(&[0.1, 0.2])
    };
    let found = picture(&still, "steps.svg");
    assert_eq!(found.text("step").word("text-anchor"), "middle");
    assert_eq!(found.text("load factor").word("text-anchor"), "middle");
    for (steps, count) in [(300, 300), (301, 0)] {
        assert_eq!(picture(&marched(steps, 1), "steps.svg").dots(COLOURS[0]).len(), count);
    }
}

#[test]
fn newton_iterations_are_counted_step_by_step() {
    let history = vec![
        step(0.1, 0.1, &[1e-3; 1], &[]),
        step(0.2, 0.1, &[1e-3; 2], &[]),
        rejected(step(0.4, 0.2, &[1e-3; 5], &[])),
        step(0.3, 0.1, &[], &[]),
        step(0.4, 0.1, &[1e-3; 2], &[]),
    ];
    let files = written(&Trajectory { history, ..rise(1) });
    assert!(files["report.html"].contains("Newton iterations of every step; 1.67 a step on average."));
    let found = Picture::read(&files["newton.svg"]);
    let dots = found.dots(COLOURS[0]);
    assert_eq!(dots.len(), 3 + 1);
    for (dot, [x, y]) in dots.iter().zip([[0.1, 1.0], [0.2, 2.0], [0.4, 2.0]]) {
        let place = [found.place(0, false, x), found.place(1, false, y)];
        assert!((dot.number("cx") - place[0]).abs() < 3.0 && (dot.number("cy") - place[1]).abs() < 3.0);
    }
    let crosses: Vec<_> = found.named("line").filter(|line| line.word("stroke") == COLOURS[1]).collect();
    assert_eq!(crosses.len(), 2 + 2);
    let middle = 0.5 * (crosses[0].number("y1") + crosses[0].number("y2"));
    assert!((middle - found.place(1, false, 5.0)).abs() < 3.0);
    // Two steps are enough for a picture, one is not.
    assert!(names(&marched(2, 1)).contains(&"newton".to_owned()));
    assert!(!names(&marched(1, 1)).contains(&"newton".to_owned()));
}

/// Each mode in a picture of its own, named by its number and its value.
#[test]
fn modes_are_numbered_with_their_values() {
    let found = picture(&vibrations(), "modes.svg");
    for title in ["mode 1: 0 Hz", "mode 2: 12.5 Hz", "mode 3: 77 Hz"] {
        assert_eq!(found.text(title).word("font-weight"), "bold");
    }
    let places: Vec<_> = found.named("svg").skip(1).map(|svg| (svg.word("x"), svg.word("width"))).collect();
    assert_eq!(places, [("0", "460"), ("460", "460"), ("0", "460")]);
    let found = picture(&buckling(), "modes.svg");
    assert_eq!(found.text("mode 1: load factor 2.4674").word("font-weight"), "bold");
}
