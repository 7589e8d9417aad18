//! Shapes with section forces at any load factor or time, from the states that a run has kept.

use super::near;
use ancf::results::{Shape, Trajectory};
use ancf::run::{shapes_at, solve_stages};
use ancf::scene::parse;
use ancf::{Options, Scene};

fn kept(text: &str) -> (Scene, Trajectory) {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let options = Options { states: true, ..Options::default() };
    let solved = scene.model().solve_with(scene.analysis(), options);
    let solved = solved.unwrap_or_else(|error| panic!("{error}\n{text}"));
    (scene, solved.into_states())
}

fn at(scene: &Scene, trajectory: &Trajectory, parameter: f64) -> Shape {
    let shapes = shapes_at(scene.model(), scene.analysis(), trajectory, parameter, None);
    shapes.unwrap_or_else(|error| panic!("{error}")).swap_remove(0)
}

const ARM: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 2, basis.ancf.elements = 6 }
    probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\n";

/// Of a cantilever under a tip force P the cut at the clamp carries λP and λP × (tip − clamp), of a
/// hanging one the weight below the cut; at the last record the shape is the last one. Would catch
/// the forces of another record, loads that do not grow, and weights of the mean that are swapped.
#[test]
fn shapes_of_statics_carry_their_share_of_the_load() {
    let (scene, found) = kept(&format!(
        "{ARM}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.force = [{{ beam = 'arm', at = 'end', value = [-0.5, 3] }}]\nanalysis.static.steps = 4\n"
    ));
    for (record, load) in found.parameter.iter().enumerate() {
        let (shape, tip) = (at(&scene, &found, *load), &found.probes[0].samples[record]);
        near(*shape.x.last().unwrap(), tip.x, 1e-14, "x of the tip");
        near(*shape.y.last().unwrap(), tip.y, 1e-14, "y of the tip");
        near(shape.axial_force[0], -0.5 * load, 1e-8, "N at the clamp");
        near(shape.shear_force[0], 3.0 * load, 1e-8, "Q at the clamp");
        near(shape.bending_moment[0], load * (3.0 * tip.x + 0.5 * tip.y), 1e-8, "M at the clamp");
        near(*shape.bending_moment.last().unwrap(), 0.0, 1e-8, "M at the tip");
    }
    let [first, second] = [1, 2].map(|record| at(&scene, &found, found.parameter[record]));
    let between = at(&scene, &found, 0.75 * found.parameter[1] + 0.25 * found.parameter[2]);
    for i in [0, 77, 200] {
        near(between.y[i], 0.75 * first.y[i] + 0.25 * second.y[i], 1e-13, "the mean of places");
        let mean = 0.75 * first.bending_moment[i] + 0.25 * second.bending_moment[i];
        near(between.bending_moment[i], mean, 1e-12, "the mean of moments");
    }
    assert_eq!(format!("{:?}", at(&scene, &found, 1.0)), format!("{:?}", found.last[0]));
}

/// Statics that goes on has the load of the stage before in full, and that of its own in proportion.
#[test]
fn shapes_of_a_stage_carry_the_loads_before_it_in_full() {
    let text = format!(
        "{ARM}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.distributed_force = [{{ beam = 'arm', value = [2, 0] }}]
        effect.force = [{{ beam = 'arm', at = 'end', value = [0.5, 0], stage = 'more' }}]
        stage = [{{ name = 'pull', analysis.static = {{}} }}, {{ name = 'more', analysis.static.steps = 4 }}]\n"
    );
    let scene = parse("scene.toml", &text).expect("a scene");
    let run = solve_stages(scene.stages(), Options { states: true, ..Options::default() });
    for (stage, results) in scene.stages().iter().zip(&run.results) {
        for load in [0.25, 0.6, 1.0] {
            let shapes = shapes_at(&stage.model, &stage.analysis, results.states(), load, None);
            let shape = shapes.unwrap_or_else(|error| panic!("{error}")).swap_remove(0);
            let [before, own] = if stage.name == "pull" { [load, 0.0] } else { [1.0, load] };
            near(shape.axial_force[0], 2.0 * before + 0.5 * own, 1e-8, "N at the clamp");
            near(shape.axial_force[100], before + 0.5 * own, 1e-8, "N in the middle");
        }
    }
}

/// A bar that is pushed down through the line between its hinges: on the way the load turns back, pulls, and
/// turns again. Of several places at one load the first counts, as the probe has seen it; the bar's force and
/// the guide's hold the load there: λ = −N sin α.
#[test]
fn of_a_path_that_turns_back_the_first_passage_counts() {
    let (scene, found) = kept(
        "beam.bar = { start = [0, 0], end = [1, 0.1], axial_stiffness = 1e3, bending_stiffness = 10, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }, { beam = 'bar', at = 'end', fix = ['x'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [0, -1] }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        analysis.static.arc_length = { until_probe = { probe = 'end', y = -0.11 }, max_step = 0.02 }\n",
    );
    let loads = &found.parameter;
    let [least, most] = [f64::min, f64::max].map(|of| loads.iter().copied().fold(0.0, of));
    assert!(least < -0.9 * most && most > 0.1, "{loads:?}");
    for load in [0.3 * most, 0.9 * most, 0.99 * most, 0.1 * least, 0.5 * least, 0.99 * least] {
        let passed = loads.windows(2).position(|pair| (pair[0] - load) * (pair[1] - load) <= 0.0);
        let passed = passed.expect("a passage");
        let [before, after] = [passed, passed + 1].map(|record| found.probes[0].samples[record].y);
        let share = (load - loads[passed]) / (loads[passed + 1] - loads[passed]);
        let shape = at(&scene, &found, load);
        let (end, angle) = (*shape.y.last().expect("a place"), shape.angle[100]);
        near(end, before + share * (after - before), 1e-12, "y of the end");
        near(-shape.axial_force[100] * angle.sin(), load, 0.02 * most, "the load");
    }
}

/// A motion's section forces at every record: what hangs below the hinge is accelerated by them, and
/// at the hinge they are the support's. A motion that goes on from a state knows its forces too.
#[test]
fn shapes_of_motions_carry_weight_and_inertia() {
    for (integrator, allowed) in [
        ("radau = { stages = 3, tolerance = 1e-8 }", 1e-5),
        ("gauss = { stages = 2, step = 0.001 }", 1e-5),
        ("generalized_alpha = { spectral_radius = 0.9, step = 0.0005 }", 1e-5),
    ] {
        let text = format!(
            "{ARM}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}]\neffect.gravity.acceleration = [0, -10]
            analysis.dynamic = {{ duration = 0.1, output_every = 0.02, {integrator} }}\noutput.reactions = true\n"
        );
        let (scene, first) = kept(&text);
        let start = first.saved.clone().expect("a state");
        let options = Options { states: true, start: Some(&start), ..Options::default() };
        let second = scene.model().solve_with(scene.analysis(), options).unwrap().into_states();
        for found in [&first, &second] {
            for (record, time) in found.parameter.iter().enumerate() {
                let shape = at(&scene, found, *time);
                let (sine, cosine) = shape.angle[0].sin_cos();
                let [n, q] = [shape.axial_force[0], shape.shear_force[0]];
                let support = &found.reactions[0].samples[record];
                near(cosine * n - sine * q, -support.fx, allowed, "the force along x");
                near(sine * n + cosine * q, -support.fy, allowed, "the force along y");
                near(*shape.bending_moment.last().unwrap(), 0.0, 1e-6, "M at the free end");
                near(shape.bending_moment[0], 0.0, 1e-6, "M at the hinge");
            }
            let end = found.parameter.last().unwrap();
            let (last, asked) = (&found.last[0], at(&scene, found, *end));
            near(asked.bending_moment[100], last.bending_moment[100], 1e-6, "M in the last state");
        }
    }
}

/// A rod that flies and turns with 6 rad/s, between records on either side of half a turn, where
/// directions begin anew: its direction is the mean of both, but for whole turns. It vibrates by 0.006 rad.
#[test]
fn directions_between_records_take_the_short_way() {
    let (scene, found) = kept(&format!(
        "{ARM}initial_velocity = [{{ beam = 'arm', rotation = 6 }}]
        analysis.dynamic = {{ duration = 2, output_every = 0.1, radau.tolerance = 1e-6 }}\n"
    ));
    let mut widest = 0.0_f64;
    for pair in found.parameter.windows(2) {
        let [before, after] = [pair[0], pair[1]].map(|time| at(&scene, &found, time).angle[0]);
        widest = widest.max((after - before).abs());
        let time = 0.5 * (pair[0] + pair[1]);
        let turns = (at(&scene, &found, time).angle[0] - 6.0 * time) / std::f64::consts::TAU;
        near(turns, turns.round(), 0.01, "turns beyond ω t");
    }
    assert!(widest > 5.0, "no direction begins anew: {widest}");
}

/// The line of a tendon goes from where it begins to where it ends, beside the beam.
#[test]
fn tendons_have_lines_beside_their_beams() {
    let (_, found) = kept(&format!(
        "{ARM}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.tendon = [{{ beam = 'arm', offset = 0.1, tension = 1e-6 }}]\nanalysis.static = {{}}\n"
    ));
    let [line] = &found.last[0].tendons[..] else { panic!("{:?}", found.last[0].tendons) };
    for (point, x) in [(line.first(), 0.0), (line.last(), 1.0)] {
        let point = point.expect("a point");
        near(point[0], x, 1e-6, "x of an end");
        near(point[1], 0.1, 1e-6, "y of an end");
    }
    assert_eq!(line.len(), found.last[0].s.len());
}

#[test]
fn shapes_that_no_record_knows_are_refused() {
    let text = format!(
        "{ARM}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        effect.moment = [{{ beam = 'arm', at = 'end', value = 1 }}]\nanalysis.static = {{}}\n"
    );
    let (scene, mut found) = kept(&text);
    let asked = |found: &Trajectory, parameter: f64| {
        shapes_at(scene.model(), scene.analysis(), found, parameter, None).expect_err("none").to_string()
    };
    for outside in [-0.001, 1.001, f64::NAN, f64::INFINITY] {
        assert!(asked(&found, outside).contains("the run reaches from 0 to 1"), "{outside}");
    }
    found.states = None;
    assert!(asked(&found, 0.5).contains("the states of this run were not kept"));
    found.parameter.clear();
    assert!(!asked(&found, 0.5).is_empty());
}
