//! What a search for an accuracy tries, what it ends with, and what it says of its errors. Each
//! decision of a search is free as long as its result is good enough; here a changed one shows.

use super::snapshot;
use ancf::model::{Analysis, Discretization, Nodes};
use ancf::results::{ErrorEstimate, Results};
use ancf::scene::{Scene, parse};
use ancf::{Options, accuracy};
use std::fmt::Write as _;

/// A beam without a basis along x; its length is none that leaves a quotient as it is.
const BEAM: &str = "beam.arm = { start = [0, 0], end = [1.5, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1 }\n";
const CLAMP: &str = "support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n";
const PIN: &str = "support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]\n";
const TIP: &str = "probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\n";
const PRESSED: &str = "effect.force = [{ beam = 'arm', at = 'end', value = [-12, 0.3] }]\n";
const ACROSS: &str = "effect.force = [{ beam = 'arm', at = 0.3, value = [0, -7] }]\n";
const WEIGHT: &str = "effect.gravity.acceleration = [1, -9.81]\n";

/// Names, scenes with `{}` for the accuracy, and accuracies.
fn tasks() -> Vec<(&'static str, String, &'static [&'static str])> {
    let cantilever = |rest: &str| format!("{BEAM}{CLAMP}{TIP}{rest}");
    let fall = |beam: &str, of: &str| format!("{beam}{PIN}{TIP}{WEIGHT}analysis.dynamic = {{ {of} }}");
    let named = |basis: &str| BEAM.replace("mass_per_length", &format!("basis = {basis}, mass_per_length"));
    let elements = &named("{ ancf = { elements = 12 } }");
    let meshfree = named("{ rpim = { nodes = 9 } }");
    let narrow = named("{ rpim = { nodes = 13, kernel = { wendland = { radius = 8.0 } } } }");
    let soft = &BEAM.replace("bending_stiffness = 1", "bending_stiffness = 0.1");
    let plain: &[&str] = &["1e-2", "1e-4", "1e-7"];
    let tables: &[&str] =
        &["{ position = 1e-3, curvature = 1e-2 }", "{ position = 1e-4, section_force = 1e-3 }"];
    let string = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 0.01 }\n\
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 'end', fix = ['x', 'y'], move = { x = 0.01 } }]\n\
        effect.distributed_force = [{ beam = 'arm', value = [0, -20] }]\nanalysis.static.accuracy = {}";
    let two = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1 }\n\
        beam.post = { start = [1, 0], end = [1, 0.4], axial_stiffness = 1e4, bending_stiffness = 5 }\n\
        joint = [{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'post', at = 'start' } }]\n\
        effect.force = [{ beam = 'post', at = 'end', value = [2, 0] }]\nanalysis.static.accuracy = {}";
    let arch = "beam.arm = { arc = { center = [0, 0], radius = 1, from = 0.6, to = 2.541592653589793 }, axial_stiffness = 2e3, bending_stiffness = 1 }\n\
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }, { beam = 'arm', at = 'end', fix = ['x', 'y'] }]\n\
        probe = [{ name = 'top', beam = 'arm', at = 0.9707963267948966 }]\neffect.force = [{ beam = 'arm', at = 0.9707963267948966, value = [0.1, -30] }]\n\
        analysis.static = { accuracy = {}, arc_length = { until_probe = { probe = 'top', y = 0.5 } } }";
    let rope = "beam.arm = { start = [0, 0], end = [1, 0], bending_stiffness = 1, mass_per_length = 1 }\n";
    vec![
        ("force inside the span", cantilever(&format!("{ACROSS}analysis.static.accuracy = {{}}")), plain),
        ("pressed", cantilever(&format!("{PRESSED}analysis.static.accuracy = {{}}")), plain),
        ("tables", cantilever(&format!("{ACROSS}analysis.static.accuracy = {{}}")), tables),
        ("string with boundary layers", string.to_owned(), &["1e-3", "1e-6"]),
        ("two beams", format!("{CLAMP}{two}"), &["1e-3", "1e-6"]),
        ("path", arch.to_owned(), &["1e-3", "1e-5"]),
        ("beyond round-off", cantilever(&format!("{ACROSS}analysis.static.accuracy = {{}}")), &["1e-14"]),
        ("modes", cantilever("analysis.modal = { count = 3, accuracy = {} }"), plain),
        (
            "modes about an equilibrium",
            cantilever(&format!(
                "{WEIGHT}analysis.modal = {{ count = 2, about = 'equilibrium', accuracy = {{}} }}"
            )),
            &["1e-3", "1e-6"],
        ),
        (
            "buckling",
            cantilever(&format!("{PRESSED}analysis.buckling = {{ count = 2, accuracy = {{}} }}"))
                .replace(", 0.3]", ", 0]"),
            &["1e-3", "1e-6"],
        ),
        ("fall", fall(BEAM, "duration = 0.5, output_every = 0.1, accuracy = {}"), &["1e-2", "1e-4", "1e-5"]),
        (
            "fall of a soft beam",
            fall(soft, "duration = 0.8, output_every = 0.2, accuracy = {}"),
            &["1e-4", "1e-5"],
        ),
        (
            "fall, integrator named",
            fall(
                BEAM,
                "duration = 0.4, output_every = 0.1, accuracy = {}, gauss = { stages = 2, step = 2e-3 }",
            ),
            &["1e-3"],
        ),
        (
            "fall, mesh named",
            fall(elements, "duration = 0.5, output_every = 0.1, accuracy = {}"),
            &["1e-2", "1e-3", "1e-5"],
        ),
        (
            "fall, all named",
            fall(elements, "duration = 0.3, output_every = 0.1, radau = { stages = 2, tolerance = 1e-4 }"),
            &[""],
        ),
        ("fall, length kept", fall(rope, "duration = 0.4, output_every = 0.1, accuracy = {}"), &["1e-3"]),
        ("statics, all named", format!("{elements}{CLAMP}{TIP}{ACROSS}analysis.static = {{}}"), &[""]),
        ("statics, meshfree", format!("{meshfree}{CLAMP}{TIP}{ACROSS}analysis.static = {{}}"), &[""]),
        ("statics, narrow kernel", format!("{narrow}{CLAMP}{TIP}{ACROSS}analysis.static = {{}}"), &[""]),
        (
            "statics, mesh too coarse",
            format!("{elements}{CLAMP}{TIP}{ACROSS}analysis.static.accuracy = {{}}"),
            &["1e-3", "1e-8"],
        ),
        (
            "until an event",
            fall(
                BEAM,
                "duration = 2, output_every = 0.1, accuracy = {}, event = [{ probe = 'tip', y = -0.6, stop = true }]",
            ),
            &["1e-3"],
        ),
    ]
}

#[test]
fn regress_searches() {
    let mut text = String::new();
    for (name, scene, accuracies) in tasks() {
        for accuracy in accuracies {
            let scene = if accuracy.is_empty() { scene.clone() } else { scene.replace("{}", accuracy) };
            let scene = parse("scene.toml", &scene).unwrap_or_else(|error| panic!("{error}\n{scene}"));
            let found = match accuracy.is_empty() {
                true => accuracy::estimate(scene.model(), scene.analysis(), Options::default()),
                false => accuracy::run(&scene, Options::default()),
            };
            let found = found.unwrap_or_else(|error| panic!("{name}, {accuracy}: {error}"));
            writeln!(text, "{name} {accuracy}\n{}", told(&scene, &found)).expect("text takes text");
        }
    }
    snapshot("searches", &text);
}

/// Errors below this are those of round-off, which other machines do not share.
const ROUND_OFF: f64 = 1e-10;

fn told(scene: &Scene, results: &Results) -> String {
    let error = results.run().error.as_ref().expect("an estimate");
    let ErrorEstimate { estimated, runs, reason, good_until, chosen, .. } = &**error;
    let short = |values: &[f64]| {
        let digits = |v: &f64| if *v < ROUND_OFF { "0".to_owned() } else { format!("{v:.1e}") };
        values.iter().map(digits).collect::<Vec<_>>().join(" ")
    };
    let mut lines: Vec<String> = runs
        .iter()
        .map(|run| match run.error {
            Some(error) => format!("  {}: {}", run.setting, short(&[error])),
            None => format!("  {}", run.setting),
        })
        .collect();
    let mut line = |what: &str, value: String| lines.push(format!("  {what} {value}"));
    let of = |error: Option<f64>| error.map_or("-".to_owned(), |error| short(&[error]));
    let others = [of(estimated.curvature), of(estimated.section_force)];
    line("estimated", format!("{} {}, met {}", short(&[estimated.result]), others.join(" "), error.met));
    if let Some(reason) = reason {
        line("because", reason.clone());
    }
    if let Some(until) = good_until {
        line("good until", format!("{until:.3}"));
    }
    if !error.eigenvalues.is_empty() {
        line("values", short(&error.eigenvalues));
    }
    // Round-off may decide at which load factors before the last one equilibria are.
    let moves = matches!(scene.analysis(), Analysis::Dynamic(_));
    let of_records = |values: Vec<f64>| short(&values[if moves { 0 } else { values.len() - 1 }..]);
    for probe in &error.probes {
        for (what, of) in [
            ("position", probe.samples.iter().map(|s| s.x).collect::<Vec<_>>()),
            ("angle", probe.samples.iter().map(|s| s.angle).collect()),
            ("curvature", probe.samples.iter().map(|s| s.curvature).collect()),
            ("strain", probe.samples.iter().map(|s| s.strain).collect()),
            ("velocity", probe.samples.iter().filter_map(|s| s.vx).collect()),
        ] {
            if !of.is_empty() {
                line(&format!("{} {what}", probe.name), of_records(of));
            }
        }
    }
    if !error.records.is_empty() {
        line("records", of_records(error.records.clone()));
    }
    for beam in &error.beams {
        line(&format!("{} position", beam.beam), short(&beam.position));
        line(&format!("{} curvature", beam.beam), short(&beam.curvature));
    }
    if let Some(chosen) = chosen {
        let chosen = parse("chosen.toml", chosen).expect("a legal scene");
        for beam in &chosen.model().beams {
            let kind = match beam.discretization {
                Discretization::Ancf { .. } => "elements",
                _ => "meshfree",
            };
            let places = match beam.discretization.nodes() {
                Nodes::Given(places) => {
                    places.iter().map(|s| format!("{s:.2}")).collect::<Vec<_>>().join(" ")
                }
                nodes => format!("{} even nodes", nodes.count()),
            };
            line(&beam.name, format!("{kind}, {:?}, {places}", beam.gauss_points));
        }
        if let (Analysis::Dynamic(was), Analysis::Dynamic(is)) = (scene.analysis(), chosen.analysis())
            && was.integrator != is.integrator
        {
            line("integrator", format!("{:?}", is.integrator));
        }
    }
    lines.join("\n")
}
