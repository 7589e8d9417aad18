//! Stages: analyses that start where the one before them ended, and what comes and goes between
//! them.

use super::{Written, near};
use ancf::output::{OutputOptions, write};
use ancf::results::{Event, Results};
use ancf::run::{Options, model_of_stage, solve_stages};
use ancf::scene::{Scene, parse};
use std::f64::consts::PI;

fn scene(text: &str) -> Scene {
    parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The results of all stages.
fn solved(text: &str) -> Vec<Results> {
    let run = solve_stages(scene(text).stages(), Options::default());
    assert!(
        run.failure.is_none(),
        "{}\n{text}",
        run.failure.map(|error| error.to_string()).unwrap_or_default()
    );
    run.results
}

/// The files of each stage.
fn stages(text: &str) -> Vec<Written> {
    let files = |mut results: Results| {
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), &mut results, &OutputOptions::default()).expect("files");
        Written(folder)
    };
    solved(text).into_iter().map(files).collect()
}

const ARM: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 2, mass_per_length = 0.5, \
     basis.ancf.elements = 8 }
    beam.leg = { start = [1, 0], end = [1, -0.5], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 0.3, basis.rpim.nodes = 5 }
    probe = [{ name = 'tip', beam = 'arm', at = 'end' }, { name = 'knee', beam = 'leg', at = 'start' }]
    output = { reactions = true, section_forces = true }\n";
const HELD: &str = "{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'leg', at = 'end', fix = ['x', 'y', 'angle'] }";
const WEIGHT: &str = "gravity.acceleration = [0, -9.81]\n";
const LOAD: &str =
    "distributed_force = [{ beam = 'arm', value = [0, -2] }, { beam = 'leg', value = [1, 0] }]\n";

/// A scene with more supports, joints and effects, and this analysis.
fn with(supports: &str, joints: &str, effects: &str, analysis: &str) -> String {
    format!("{ARM}support = [{HELD}{supports}]\njoint = [{joints}]\n{analysis}\n[effect]\n{effects}")
}

const THREE: &str = "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = { steps = 2 } }, { name = 'three', analysis.static = {} }]";

/// What a table is without stages, and what it is in the second stage only.
fn in_second(table: &str) -> [String; 2] {
    let staged = table.trim_end().trim_end_matches('}').to_owned() + ", stage = 'two', until = 'three' }";
    [table.to_owned(), staged]
}

fn states_agree(first: &Results, second: &Results, within: f64, what: &str) {
    for (a, b) in first.states().probes.iter().zip(&second.states().probes) {
        let (Some(a), Some(b)) = (a.samples.last(), b.samples.last()) else { panic!("{what}: no sample") };
        for (a, b) in [(a.x, b.x), (a.y, b.y), (a.angle, b.angle), (a.curvature, b.curvature)] {
            near(a, b, within, what);
        }
    }
    let forces = |results: &Results| {
        let shape = &results.states().last[0];
        [shape.axial_force[40], shape.shear_force[40], shape.bending_moment[40]]
    };
    for (a, b) in forces(first).into_iter().zip(forces(second)) {
        near(a, b, 1e3 * within, what);
    }
}

/// Effects of all kinds that may come and go.
const EFFECTS: [(&str, &str); 15] = [
    ("force", "{ beam = 'arm', at = 'end', value = [1, -0.7], follower = true }"),
    ("moment", "{ beam = 'arm', at = 0.5, value = 1.5 }"),
    ("spring", "{ beam = 'arm', at = 0.75, stiffness = 40 }"),
    ("spring", "{ beam = 'arm', at = 0.75, anchor = [0.75, 1], length = 0.9, stiffness = 40 }"),
    ("torsion_spring", "{ beam = 'arm', at = 0.5, stiffness = 7 }"),
    ("foundation", "{ beam = 'arm', stiffness = [3, 30] }"),
    ("actuation", "{ beam = 'arm', strain = 1e-4, curvature = 0.8 }"),
    ("tendon", "{ beam = 'arm', offset = 0.05, tension = 20, from = 0.25 }"),
    ("tendon", "{ beam = 'arm', offset = 0.05, shortening = 1e-3, from = 0.25 }"),
    ("drag", "{ beam = 'leg', normal = 2, flow = [1.5, 0] }"),
    (
        "electrostatic",
        "{ beam = 'arm', voltage = 400, width = 0.5, permittivity = 1e-6, electrode = { point = [0, -0.8], normal = [0, 1] } }",
    ),
    ("force_field", "{ beam = 'leg', value = ['-y', '3*(x-1)'] }"),
    ("buoyancy", "{ beam = 'arm', displaced_mass_per_length = 0.9 }"),
    ("point_mass", "{ beam = 'arm', at = 0.5, mass = 0.2 }"),
    ("contact", "{ beam = 'arm', half_plane = { point = [0, -0.05], normal = [0, 1] }, stiffness = 1e4 }"),
];

/// Whatever comes in the second of three static stages leads to the equilibrium that a single
/// analysis with it finds, and when it goes, back to the one without it.
#[test]
fn what_comes_and_goes_leads_to_the_same_equilibria() {
    let mut scenes = Vec::new();
    for (kind, table) in EFFECTS {
        let [plain, staged] = in_second(table);
        let of = |table: String| {
            move |analysis: &str| with("", "", &format!("{WEIGHT}{kind} = [{table}]\n{LOAD}"), analysis)
        };
        scenes.push((kind, of(plain)(ALONE), of(staged)(THREE)));
    }
    let [plain, staged] = in_second("{ beam = 'arm', value = [0, -3.5], from = 0.2 }");
    let own = |table: String| {
        with("", "", &format!("{WEIGHT}{}", LOAD.replace("}]", &format!("}}, {table}]"))), "")
    };
    scenes.push((
        "distributed_force",
        own(plain).replace("\n[effect]", &format!("{ALONE}\n[effect]")),
        own(staged).replace("\n[effect]", &format!("{THREE}\n[effect]")),
    ));
    let without = with("", "", &format!("{WEIGHT}{LOAD}"), ALONE);
    let [plain, staged] = in_second("{ beam = 'arm', at = 'end', fix = ['y'], move.y = 0.1 }");
    // A support that comes later moves the beam from where it is then.
    let tip = solved_alone(&without).states().probes[0].samples.last().expect("a sample").y;
    let plain = plain.replace("move.y = 0.1", &format!("move.y = {}", 0.1 + tip));
    let support =
        |table: &str, analysis: &str| with(&format!(", {table}"), "", &format!("{WEIGHT}{LOAD}"), analysis);
    scenes.push(("support", support(&plain, ALONE), support(&staged, THREE)));
    let [plain, staged] = in_second(
        "{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'leg', at = 'start' } }",
    );
    let joint = |table: &str, analysis: &str| with("", table, &format!("{WEIGHT}{LOAD}"), analysis);
    scenes.push(("joint", joint(&plain, ALONE), joint(&staged, THREE)));

    let without = solved_alone(&without);
    for (kind, plain, staged) in scenes {
        let [one, two, three]: [Results; 3] = solved(&staged).try_into().expect("three stages");
        states_agree(&one, &without, 1e-8, kind);
        states_agree(&two, &solved_alone(&plain), 1e-7, kind);
        states_agree(&three, &without, 1e-7, kind);
        // The second begins where the first one ended.
        let start = two.states().probes[0].samples[0];
        let end = one.states().probes[0].samples.last().expect("a sample");
        near(start.x, end.x, 1e-9, kind);
        near(start.y, end.y, 1e-9, kind);
    }
    // Gravity alone.
    let [_, staged] = in_second("{ acceleration = [0, -9.81] }");
    let found = solved(&with("", "", &format!("gravity = {staged}\n{LOAD}"), THREE));
    states_agree(&found[1], &without, 1e-7, "gravity");
    states_agree(&found[2], &solved_alone(&with("", "", LOAD, ALONE)), 1e-7, "gravity");
}

/// A path by arc length beyond load factor 1 leads to the equilibria under what is new, so many times
/// over: what has gone does not come back with the opposite sign, and what has come holds as it is.
#[test]
fn what_has_come_or_gone_stays_so_beyond_load_factor_one() {
    let push = |times: f64, when: &str| {
        let list = format!("}}, {{ beam = 'leg', value = [{}, {}]{when} }}]", -2.0 * times, 0.5 * times);
        format!("{WEIGHT}{}", LOAD.replace("}]", &list))
    };
    let one = "{ name = 'one', analysis.static = {} }";
    let two = format!("stage = [{one}, {{ name = 'two', analysis.static.arc_length.until_load = 2.5 }}]");
    let alone =
        |supports: &str, joints: &str, effects: &str| solved_alone(&with(supports, joints, effects, ALONE));
    let last = |text: &str| solved(text).pop().expect("two stages");
    let parts = |list: &str, table: &str| match list {
        "support" => (format!(", {table}"), String::new(), String::new()),
        "joint" => (String::new(), table.to_owned(), String::new()),
        _ => (String::new(), String::new(), format!("{list} = [{table}]\n")),
    };
    let weld =
        "{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'leg', at = 'start' } }";
    let held = "{ beam = 'arm', at = 'end', fix = ['y'] }";
    let without = alone("", "", &push(2.5, ""));
    for (list, table) in EFFECTS.into_iter().chain([("joint", weld), ("support", held)]) {
        let when =
            |key: &str| table.trim_end().trim_end_matches('}').to_owned() + &format!(", {key} = 'two' }}");
        let (supports, joints, effects) = parts(list, &when("until"));
        let gone = last(&with(&supports, &joints, &(effects + &push(1.0, ", stage = 'two'")), &two));
        states_agree(&gone, &without, 1e-7, &format!("{list} that goes"));
        // A load that comes would grow, and a support holds what has moved before.
        if ["spring", "torsion_spring", "foundation", "contact", "joint"].contains(&list) {
            let (supports, joints, effects) = parts(list, &when("stage"));
            let come = last(&with(&supports, &joints, &(effects + &push(1.0, ", stage = 'two'")), &two));
            let (supports, joints, effects) = parts(list, table);
            let there = alone(&supports, &joints, &(effects + &push(2.5, "")));
            states_agree(&come, &there, 1e-7, &format!("{list} that comes"));
        }
    }
}

/// A path that ends before load factor 1 says what is still as it was, and one along which nothing else
/// than what comes and goes changes ends where that has come and gone.
#[test]
fn paths_tell_what_has_not_come_or_gone() {
    let of = |value: f64, stays: &str| {
        let goes = "force = [{ beam = 'arm', at = 'end', value = [0, 2], until = 'two' }]\n";
        let path = format!(
            "stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.static.arc_length.until_probe = {{ probe = 'tip', y = {value} }} }}]"
        );
        let run =
            solve_stages(scene(&with("", "", &format!("{goes}{stays}"), &path)).stages(), Options::default());
        (run.results, run.failure.map(|error| error.to_string()))
    };
    let tip = |results: &Results| results.states().probes[0].samples.last().expect("a sample").y;
    let (results, failure) = of(0.1, "");
    assert_eq!(failure, None);
    let load = *results[1].states().parameter.last().expect("a state");
    near(tip(&results[1]), 0.1, 1e-9, "tip");
    assert!((0.0..1.0).contains(&load), "{load}");
    let left = format!("{:.0} % of it is still as it was before", 100.0 * (1.0 - load));
    let told = &results[1].run().warnings;
    assert!(told.iter().any(|warning| warning.ends_with(&left)), "{told:?}");
    assert!(results[0].run().warnings.is_empty(), "{:?}", results[0].run().warnings);
    let (results, failure) = of(-0.1, "");
    let why = failure.expect("nothing pushes the tip down");
    assert!(
        why.starts_with(
            "stage `two`: the path leads nowhere beyond load factor 1, before y = -0.1 m of probe `tip`"
        ),
        "{why}"
    );
    near(tip(&results[1]), 0.0, 1e-9, "tip of the beam without a load");
    // With a load that grows the path goes on.
    let new = "moment = [{ beam = 'arm', at = 'end', value = -0.1, stage = 'two' }]\n";
    let (results, failure) = of(-0.1, new);
    assert_eq!(failure, None);
    near(tip(&results[1]), -0.1, 1e-9, "tip under a moment");
    assert!(*results[1].states().parameter.last().expect("a state") > 1.0);
    assert!(results[1].run().warnings.is_empty(), "{:?}", results[1].run().warnings);
}

const ALONE: &str = "analysis.static = {}";

fn solved_alone(text: &str) -> Results {
    ancf::accuracy::run(&scene(text), Options::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Motions in stages are those of three scenes, each of which goes on from the state that the one
/// before it has saved: what damps, resists, turns or travels acts in the second one only.
#[test]
fn motions_go_on_with_what_is_there() {
    for (kind, table) in [
        ("damping", "{ beam = 'arm', mass_proportional = 3 }"),
        ("rotary_inertia", "{ beam = 'arm', per_length = 2e-3 }"),
        ("moving_force", "{ beam = 'arm', value = [0, -3], speed = 4 }"),
        ("point_mass", "{ beam = 'arm', at = 'end', mass = 0.2 }"),
    ] {
        let motion = "analysis.dynamic = { duration = 0.05, output_every = 0.01, radau.tolerance = 1e-6 }";
        let three = ["one", "two", "three"].map(|name| format!("{{ name = '{name}', {motion} }}")).join(", ");
        let text =
            |table: &str, analysis: &str| with("", "", &format!("{WEIGHT}{kind} = [{table}]\n"), analysis);
        let [plain, staged] = in_second(table);
        let staged = solved(&text(&staged, &format!("stage = [{three}]")));
        let (with, without) = (scene(&text(&plain, motion)), scene(&text("", motion)));
        let mut saved = None;
        for (stage, scene) in [&without, &with, &without].into_iter().enumerate() {
            let options = Options { start: saved.as_ref(), ..Options::default() };
            let by_hand =
                scene.model().solve_with(scene.analysis(), options).expect("a motion").into_states();
            let of_stage = staged[stage].states();
            assert_eq!(by_hand.parameter, of_stage.parameter, "{kind} {stage}");
            let same = by_hand.probes[0].samples == of_stage.probes[0].samples;
            assert!(same, "{kind} {stage}");
            saved = by_hand.saved;
        }
        assert_eq!(staged[2].states().parameter.last(), Some(&0.15));
        let quiet = solved(&text("", &format!("stage = [{three}]")));
        assert_ne!(quiet[1].states().probes[0].samples, staged[1].states().probes[0].samples, "{kind}");
    }
}

/// In a static stage new loads grow in proportion to the load factor while the old ones stay, and
/// what has gone fades: a cantilever of EI = 1 N m² and 1 m under a small force F has the tip at F/3.
#[test]
fn new_loads_grow_and_old_ones_stay() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 4 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, 3e-5] },
            { beam = 'arm', at = 'end', value = [0, 6e-5], stage = 'more' }, { beam = 'arm', at = 'end', value = [0, 9e-5], until = 'less' }]
        probe = [{ name = 'tip', beam = 'arm', at = 'end' }]
        output = { reactions = true, section_forces = true }
        stage = [{ name = 'first', analysis.static.steps = 2 }, { name = 'more', analysis.static.steps = 4 }, { name = 'less', analysis.static.steps = 2 }]";
    let [first, more, less]: [Written; 3] =
        stages(text).try_into().unwrap_or_else(|_| panic!("three stages"));
    let is = |written: &Written, tips: &[f64]| {
        let found = written.column("probes.csv", "tip.y");
        assert_eq!(found.len(), tips.len());
        for (found, expected) in found.iter().zip(tips) {
            near(*found, 1e-5 * expected, 1e-12, "tip.y");
        }
        // The clamp carries all forces, those that fade included.
        for (column, factor) in [("support1.fy", -3.0), ("support1.moment", -3.0)] {
            for (found, expected) in written.column("reactions.csv", column).iter().zip(tips) {
                near(*found, factor * 1e-5 * expected, 1e-10, column);
            }
        }
    };
    is(&first, &[0.0, 2.0, 4.0]);
    is(&more, &[4.0, 4.5, 5.0, 5.5, 6.0]);
    is(&less, &[6.0, 4.5, 3.0]);
    assert_eq!(more.column("probes.csv", "load"), [0.0, 0.25, 0.5, 0.75, 1.0]);
}

/// A support that goes leaves its force behind, which fades. The prop of a cantilever under the load
/// q carries 3/8 q L; without it the tip is at q L⁴/8 EI, and half-way there when half of the
/// prop's force has gone.
#[test]
fn the_force_of_a_support_that_goes_fades() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 8 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 'end', fix = ['y'], until = 'free' }]
        effect.distributed_force = [{ beam = 'arm', value = [0, -8e-5] }]
        probe = [{ name = 'tip', beam = 'arm', at = 'end' }]
        output.reactions = true
        stage = [{ name = 'propped', analysis.static = {} }, { name = 'free', analysis.static.steps = 2 }]";
    let found = stages(text);
    near(found[0].last("reactions.csv", "support2.fy"), 3e-5, 1e-11, "the prop");
    let tips = found[1].column("probes.csv", "tip.y");
    for (tip, expected) in tips.iter().zip([0.0, -0.5e-5, -1e-5]) {
        near(*tip, expected, 1e-12, "tip.y");
    }
    let clamp = found[1].column("reactions.csv", "support1.fy");
    for (force, expected) in clamp.iter().zip([5e-5, 6.5e-5, 8e-5]) {
        near(*force, expected, 1e-11, "support1.fy");
    }
}

/// A cantilever that a force has bent is let go and swings: w(t) = Σ w_k cos ω_k t with
/// ω_k = β_k² and, for a tip force F, w_k = 4 F/β_k⁴ at the tip (EI = ρA = L = 1).
#[test]
fn a_bent_cantilever_that_is_let_go_swings_by_its_modes() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, \
         basis.ancf.elements = 12 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, 3e-4], until = 'swing' }]
        probe = [{ name = 'tip', beam = 'arm', at = 'end' }]
        stage = [{ name = 'bend', analysis.static = {} }, \
            { name = 'swing', analysis.dynamic = { duration = 1.6, output_every = 0.1, radau.tolerance = 1e-7 } }]";
    let found = stages(text);
    let swing = found[1].column("probes.csv", "tip.y");
    // β of cos β cosh β = −1, by bisection.
    let root = |k: usize| {
        let (mut low, mut high) = (PI * (k as f64), PI * (k as f64 + 1.0));
        let f = |b: f64| b.cos() + 1.0 / b.cosh();
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if (f(low) < 0.0) == (f(middle) < 0.0) { low = middle } else { high = middle }
        }
        low
    };
    let betas: Vec<f64> = (0..8).map(root).collect();
    for (i, found) in swing.iter().enumerate() {
        let t = 0.1 * i as f64;
        let modes = betas.iter().map(|b| 4.0 * 3e-4 / b.powi(4) * (b * b * t).cos());
        near(*found, modes.sum(), 2e-7, "tip.y");
    }
}

/// A string under tension has the frequencies n/2L √(T/ρA): prestress first, then the vibrations
/// about it.
#[test]
fn vibrations_are_those_about_the_stage_before() {
    let text = "beam.string = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, mass_per_length = 0.01, basis.ancf.elements = 20 }
        support = [{ beam = 'string', at = 'start', fix = ['x', 'y'] }, { beam = 'string', at = 'end', fix = ['x', 'y'], move.x = 0.01 }]
        stage = [{ name = 'tune', analysis.static = {} }, { name = 'sound', analysis.modal.count = 3 }]";
    let found = stages(text);
    let frequencies = found[1].column("frequencies.csv", "frequency");
    for (n, found) in (1..).zip(frequencies) {
        // T = EA ε, and ρA of the stretched string over its length of 1.01 m.
        let speed = (100.0_f64 * 1.01 / 0.01).sqrt();
        near(found, f64::from(n) / (2.0 * 1.01) * speed, 2e-3 * f64::from(n), "a frequency");
    }
}

/// What a hand does on a bow is the energy that the bow gains, and what the bow loses the arrow and
/// the bow itself have as kinetic energy.
#[test]
fn a_bow_gives_back_what_the_hand_has_put_in() {
    let page = include_str!("../../src/handbook/stages.md");
    let text = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a scene");
    let text = text.replace("analysis.static.steps = 8", "analysis.static.steps = 40");
    let names: Vec<String> = scene(&text).stages().iter().map(|stage| stage.name.clone()).collect();
    assert_eq!(names, ["rest", "brace", "draw", "tones", "loose"]);
    let found = stages(&text);
    let [brace, draw, loose] = [1, 2, 4].map(|stage| &found[stage]);
    let (drawn, braced) = (draw.last("energy.csv", "total"), brace.last("energy.csv", "total"));
    near(draw.column("energy.csv", "total")[0], braced, 1e-6, "total");
    let pull = draw.column("reactions.csv", "support5.fx");
    let work: f64 = pull.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]) * (-0.4 / 40.0)).sum();
    near(work, drawn - braced, 1e-2 * work, "work");
    near(draw.last("probes.csv", "nock.x"), -0.55, 1e-12, "nock.x");
    for total in loose.column("energy.csv", "total") {
        near(total, drawn, 1e-4 * drawn, "total");
    }
    let speed = loose.last("probes.csv", "nock.vx");
    assert!(0.5 * 0.012 * speed * speed > 0.5 * loose.last("energy.csv", "kinetic"), "{speed}");
}

/// A motion that an event has ended within a step goes on in the next stage, with joints and lengths
/// that its state holds to the accuracy of the step.
#[test]
fn a_motion_goes_on_after_an_event() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], bending_stiffness = 2, mass_per_length = 0.5, basis.ancf.elements = 3 }
        beam.leg = { start = [1, 0], end = [2, 0], bending_stiffness = 1, mass_per_length = 0.3, basis.ancf.elements = 3 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        joint = [{ type = 'hinge', first = { beam = 'arm', at = 'end' }, second = { beam = 'leg', at = 'start' } }]
        effect.gravity.acceleration = [0, -9.81]
        probe = [{ name = 'end', beam = 'leg', at = 'end' }]
        stage = [{ name = 'fall', analysis.dynamic = { duration = 2, output_every = 0.1, radau.tolerance = 1e-4, \
            event = [{ probe = 'end', y = -0.7, stop = true }] } }, \
            { name = 'on', analysis.dynamic = { duration = 0.2, output_every = 0.1, radau.tolerance = 1e-4 } }]";
    let found = stages(text);
    let (fall, on) = (&found[0], &found[1]);
    near(fall.last("probes.csv", "end.y"), -0.7, 1e-9, "end.y");
    for column in ["end.x", "end.y", "end.vx", "end.vy"] {
        let (before, after) = (fall.last("probes.csv", column), on.column("probes.csv", column)[0]);
        near(after, before, 1e-3, column);
    }
    near(on.last("energy.csv", "total"), fall.column("energy.csv", "total")[0], 1e-3, "total");
}

/// In two files a state says what acted in it: what both scenes have stays, what is new grows.
#[test]
fn statics_goes_on_from_the_state_of_another_scene() {
    let force = |value: &str| format!("force = [{{ beam = 'arm', at = 'end', value = [0, {value}] }}]\n");
    let of = |effects: &str, steps: usize| {
        scene(&with("", "", &format!("{WEIGHT}{effects}"), &format!("analysis.static.steps = {steps}")))
    };
    let (first, second) = (of(&force("-0.5"), 1), of(&force("0.9"), 2));
    let before = first.model().solve(first.analysis()).expect("an equilibrium").into_states();
    let options = Options { start: before.saved.as_ref(), ..Options::default() };
    let going_on = second.model().solve_with(second.analysis(), options).expect("an equilibrium");
    let alone = |value: &str| of(&force(value), 1).model().solve(first.analysis()).expect("an equilibrium");
    states_agree(&going_on, &alone("0.9"), 1e-8, "the end");
    // −0.5 N fades while 0.9 N grows: 0.2 N half-way.
    let (half, tip) = (&going_on.states().probes[0].samples[1], alone("0.2"));
    let tip = tip.states().probes[0].samples.last().expect("a sample").y;
    near(half.y, tip, 1e-8, "half-way");
}

/// A couple at the end bends a cantilever into 0.9 of a circle, by a moment of another file or by a support that
/// turns the end. Where it has gone it fades as a couple, through any angle: the end is turned by M L/EI all the way.
#[test]
fn couples_of_what_has_gone_fade_through_large_turns() {
    let of = |support: &str, effect: &str, analysis: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 32 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}{support}]
            probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]
            {effect}
            {analysis}"
        );
        scene(&text)
    };
    let whole = 1.8 * PI;
    let unloads = |found: &Results, of_what: &str| {
        let states = found.states();
        assert_eq!(states.parameter, [0.0, 0.25, 0.5, 0.75, 1.0]);
        for (load, tip) in states.parameter.iter().zip(&states.probes[0].samples) {
            let angle = whole * (1.0 - load);
            let sinc = if angle == 0.0 { 1.0 } else { angle.sin() / angle };
            near(tip.x, sinc, 2e-5, &format!("x at {load} of {of_what}"));
            let height = if angle == 0.0 { 0.0 } else { (1.0 - angle.cos()) / angle };
            near(tip.y, height, 2e-5, &format!("y at {load} of {of_what}"));
        }
    };
    let moment = format!("effect.moment = [{{ beam = 'arm', at = 'end', value = {whole} }}]");
    let (bent, free) = (of("", &moment, "analysis.static = {}"), of("", "", "analysis.static.steps = 4"));
    let bent = bent.model().solve(bent.analysis()).expect("an equilibrium").into_states();
    let options = Options { start: bent.saved.as_ref(), ..Options::default() };
    unloads(&free.model().solve_with(free.analysis(), options).expect("an equilibrium"), "a moment");

    let turned =
        format!(", {{ beam = 'arm', at = 'end', fix = ['angle'], move.angle = {whole}, until = 'free' }}");
    let stages = "stage = [{ name = 'turned', analysis.static.steps = 4 }, { name = 'free', analysis.static.steps = 4 }]";
    let run = solve_stages(of(&turned, "", stages).stages(), Options::default());
    assert!(run.failure.is_none());
    unloads(&run.results[1], "a support");
}

/// Stages need nodes of all stages in each, a basis by name, and say in which of them something went
/// wrong.
#[test]
fn stages_share_their_nodes_and_name_themselves_in_errors() {
    let [_, joint] = in_second(
        "{ type = 'weld', first = { beam = 'arm', at = 0.6180339887 }, second = { beam = 'leg', at = 'start' } }",
    );
    let text = with("", &joint, &format!("{WEIGHT}{LOAD}"), THREE);
    for stage in scene(&text).stages() {
        assert!(stage.model.breaks(0).contains(&0.6180339887), "{}", stage.name);
    }
    let open = text.replace(", \n     basis.ancf.elements = 8", "").replace("basis.ancf.elements = 8", "");
    let refused = parse("scene.toml", &open.replace("mass_per_length = 0.5,  }", "mass_per_length = 0.5 }"));
    assert!(
        refused
            .expect_err("no basis")
            .to_string()
            .contains("has no basis, which a scene with stages must name")
    );
    let timed = text.replace(
        "distributed_force = [{ beam = 'arm', value = [0, -2] }",
        "distributed_force = [{ beam = 'arm', value = [0, -2], in_time.step.start = 1, stage = 'three' }",
    );
    let run = solve_stages(scene(&timed).stages(), Options::default());
    let failure = run.failure.expect("a law without time").to_string();
    assert!(
        failure.starts_with("stage `three`: a load (`distributed_force`) follows a law of time"),
        "{failure}"
    );
    assert_eq!(run.results.len(), 2);
}

/// With friction the order matters: pressed first and then pushed, a rod sticks; pushed first and
/// then pressed, it has moved already.
#[test]
fn with_friction_the_order_of_stages_decides() {
    let text = |push: &str, press: &str| {
        format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 50, basis.ancf.elements = 4 }}
            effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = 1e5, \
                friction = {{ coefficient = 0.5, stiffness = 1e5 }} }}]
            effect.spring = [{{ beam = 'rod', at = 0.5, anchor = [0.5, 5], length = 5, stiffness = 1e-3 }}, \
                {{ beam = 'rod', at = 'start', anchor = [-1, 0], stiffness = 40 }}]
            effect.distributed_force = [{{ beam = 'rod', value = [0, -10] }}, \
                {{ beam = 'rod', value = [0, -90], stage = '{press}' }}, {{ beam = 'rod', value = [20, 0], stage = '{push}' }}]
            probe = [{{ name = 'end', beam = 'rod', at = 'end' }}]
            stage = [{{ name = 'lay', analysis.static = {{}} }}, {{ name = 'first', analysis.static.steps = 8 }}, \
                {{ name = 'second', analysis.static.steps = 8 }}]"
        )
    };
    let moved = |text: &str| stages(text)[2].last("probes.csv", "end.x") - 1.0;
    let (sticks, slid) = (moved(&text("second", "first")), moved(&text("first", "second")));
    assert!(sticks.abs() < 1e-3, "{sticks}");
    // 20 N less friction of 5 N on a spring of 40 N/m.
    near(slid, 15.0 / 40.0, 1e-2, "the way");
}

/// A column that is pressed already needs so much less to buckle, and one that is pulled so much more;
/// its shapes, and what a spring that is there adds, are those of one analysis with the whole load.
#[test]
fn critical_loads_of_a_stage_come_on_top_of_what_acts() {
    const EI: f64 = 2.0;
    let column = |before: &str, stages: &str| {
        format!(
            "beam.column = {{ start = [0, 0], end = [0, 1], axial_stiffness = 1e9, bending_stiffness = {EI}, basis.ancf.elements = 16 }}
            support = [{{ beam = 'column', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{before}{{ beam = 'column', at = 'end', value = [0, -1], stage = 'more' }}]
            {stages}"
        )
    };
    let stages =
        "stage = [{ name = 'first', analysis.static = {} }, { name = 'more', analysis.buckling.count = 2 }]";
    let factors = |text: &str| match solved(text).pop().expect("stages") {
        Results::CriticalLoads(found) => found.modes.iter().map(|mode| mode.load_factor).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let critical = |mode: f64| ((2.0 * mode - 1.0) * PI / 2.0).powi(2) * EI;
    for before in [-3.0, 0.5, 40.0] {
        let acts = format!("{{ beam = 'column', at = 'end', value = [0, {before}] }}, ");
        for (found, mode) in factors(&column(&acts, stages)).into_iter().zip([1.0, 2.0]) {
            near(found, critical(mode) + before, 1e-4 * critical(mode), "critical load");
        }
    }
    // A motion that is not at rest, and a support that goes, leave no equilibrium.
    let moved = "stage = [{ name = 'first', analysis.dynamic = { duration = 0.01 } }, { name = 'more', analysis.buckling.count = 1 }]";
    let side = "{ beam = 'column', at = 'end', value = [0.1, 0], until = 'more' }, ";
    for text in [
        column(side, moved).replace("bending_stiffness", "mass_per_length = 1, bending_stiffness"),
        column(side, stages),
    ] {
        let scene = parse("column.toml", &text).expect("a scene");
        let run = solve_stages(scene.stages(), Options::default());
        let said = run.failure.expect("no equilibrium").to_string();
        assert!(said.contains("is none without its own loads"), "{said}");
    }
}

/// A support with a law holds what the law does not move where the stage before has brought it: a string
/// that statics has stretched is shaken across, and stays as long as it is.
#[test]
fn what_a_law_does_not_move_stays_where_statics_brought_it() {
    let text = "beam.string = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, mass_per_length = 0.01, basis.ancf.elements = 8 }
        support = [
            { beam = 'string', at = 'start', fix = ['x', 'y'] },
            { beam = 'string', at = 'end', fix = ['x', 'y'], move.x = 0.01, until = 'shake' },
            { beam = 'string', at = 'end', fix = ['x', 'y'], move = { y = 1e-3, in_time.harmonic.frequency = 20 }, stage = 'shake' },
        ]
        probe = [{ name = 'end', beam = 'string', at = 'end' }]
        stage = [{ name = 'stretch', analysis.static = {} }, { name = 'shake', analysis.dynamic = { duration = 0.0125 } }]";
    let shaken = solved(text).pop().expect("stages");
    let samples = &shaken.states().probes[0].samples;
    assert!(samples.iter().all(|sample| (sample.x - 1.01).abs() < 1e-12));
    near(samples.last().expect("an end").y, 1e-3, 1e-12, "a quarter of a turn");
}

/// A support that statics has moved stays where it is when statics goes on.
#[test]
fn a_support_that_was_moved_stays_moved() {
    let text = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 8 }
        support = [
            { beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] },
            { beam = 'bar', at = 'end', fix = ['x', 'y'], move = { x = 0.01, y = 0.2 } },
        ]
        effect.force = [{ beam = 'bar', at = 0.5, value = [0, -1], stage = 'load' }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        stage = [{ name = 'pull', analysis.static = {} }, { name = 'load', analysis.static = {} }]";
    for results in solved(text) {
        let end = *results.states().probes[0].samples.last().expect("an end");
        near(end.x, 1.01, 1e-12, "x");
        near(end.y, 0.2, 1e-12, "y");
    }
}

/// What is built of a stage that goes on: in statics supports bring what they move to its place, which
/// they have done in the stage before; in a motion only what is new, or what a law moves, is elsewhere than
/// where it was.
#[test]
fn a_stage_is_built_with_what_its_supports_have_moved() {
    let text = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }
        support = [
            { beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'], move.y = 0.1 },
            { beam = 'bar', at = 0.5, fix = ['x'], move = { x = 0.2, in_time.polynomial = [1] } },
            { beam = 'bar', at = 'end', fix = ['y'], move.y = 0.3, stage = 'second' },
        ]
        stage = [{ name = 'first', analysis.static = {} }, { name = 'second', analysis.KIND }]";
    for (kind, expected) in [("static = {}", [0.1, 0.2, 0.3]), ("dynamic.duration = 1", [0.0, 0.2, 0.3])] {
        let scene = scene(&text.replace("KIND", kind));
        let (model, _) = model_of_stage(scene.stages(), 1);
        let moved: Vec<f64> =
            model.supports.iter().map(|support| support.displacement.x + support.displacement.y).collect();
        assert_eq!(moved, expected, "{kind}");
    }
}

/// Where the weight of a frame, and a force on its foot, leave, its supports carry (1 − λ) of them:
/// their forces and those of joints begin with what they were. A first part of a motion leaves
/// forces of inertia, too, which fade with the rest.
#[test]
fn supports_and_joints_begin_with_the_forces_that_they_had() {
    let (weight, foot) = (9.81 * (0.5 + 0.3 * 0.5), 0.7);
    let leaving = format!(
        "gravity = {{ acceleration = [0, -9.81], until = 'two' }}\n\
         force = [{{ beam = 'leg', at = 'end', value = [0, -{foot}], until = 'two' }}]\n"
    );
    let moved = "stage = [{ name = 'one', analysis.dynamic = { duration = 0.05, output_every = 0.01, radau.tolerance = 1e-6 } }, \
                 { name = 'two', analysis.static = { steps = 2 } }]";
    let still =
        "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = { steps = 2 } }]";
    let bent = "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static.arc_length.until_load = 1 }]";
    for joint in ["hinge", "weld"] {
        for analysis in [still, bent, moved] {
            let joint = format!(
                "{{ type = '{joint}', first = {{ beam = 'arm', at = 'end' }}, second = {{ beam = 'leg', at = 'start' }} }}"
            );
            let found = stages(&with("", &joint, &leaving, analysis));
            for column in [
                "support1.fx",
                "support1.fy",
                "support1.moment",
                "support2.fx",
                "support2.fy",
                "support2.moment",
                "joint1.fx",
                "joint1.fy",
            ] {
                let before = found[0].last("reactions.csv", column);
                let after = found[1].column("reactions.csv", column)[0];
                near(after, before, 1e-6 * weight, &format!("{joint}, {column}"));
            }
            if analysis == moved {
                continue;
            }
            let of = |column| found[1].column("reactions.csv", column);
            for ((load, a), b) in of("load").iter().zip(of("support1.fy")).zip(of("support2.fy")) {
                near(a + b, (1.0 - load) * (weight + foot), 1e-6 * weight, &format!("{joint} at {load}"));
            }
        }
    }
}

/// What holds on does so with the force that it had, whatever goes beside it: a prop at a welded knee,
/// a load of two hinged chains, whose unit of forces is their load, weight on a beam that keeps its
/// length and is bent by a tendon of given length.
#[test]
fn what_holds_on_keeps_its_force_whatever_goes() {
    let prop = ", { beam = 'arm', at = 'end', fix = ['y'], until = 'two' }";
    let weld =
        "{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'leg', at = 'start' } }";
    let stages_of =
        "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = { steps = 2 } }]";
    let frame = with(prop, weld, &format!("{WEIGHT}{LOAD}"), stages_of);
    let chain = format!(
        "beam.left = {{ points = [[0, 0], [0.2, -0.2], [0.4, -0.25]], mass_per_length = 0.2, basis.ancf.elements = 3 }}
        beam.right = {{ points = [[0.4, -0.25], [0.6, -0.2], [0.8, 0]], mass_per_length = 0.2, basis.ancf.elements = 3 }}
        support = [{{ beam = 'left', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'right', at = 'end', fix = ['x', 'y'] }}]
        joint = [{{ type = 'hinge', first = {{ beam = 'left', at = 'end' }}, second = {{ beam = 'right', at = 'start' }} }}]
        effect.gravity.acceleration = [0, -9.81]
        effect.force = [{{ beam = 'left', at = 0.1, value = [0.3, -5], until = 'two' }}]
        output.reactions = true
        {stages_of}\n"
    );
    let bent = format!(
        "beam.arm = {{ start = [0, 0], end = [1, 0], bending_stiffness = 2, mass_per_length = 0.5, basis.ancf.elements = 6 }}
        beam.leg = {{ start = [1, 0], end = [1, -0.5], bending_stiffness = 1, mass_per_length = 0.3, basis.ancf.elements = 4 }}
        support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        joint = [{weld}]
        effect.gravity = {{ acceleration = [0, -9.81], until = 'two' }}
        effect.tendon = [{{ beam = 'arm', offset = 0.05, shortening = 0.01 }}]
        output.reactions = true
        {stages_of}\n"
    );
    for (name, scene) in [("frame", frame), ("chain", chain), ("bent", bent)] {
        let found = stages(&scene);
        let text = std::fs::read_to_string(found[1].0.path().join("reactions.csv")).expect("reactions");
        let columns = text.lines().next().expect("a header").split(',').skip(1);
        let sizes = columns.clone().map(|column| found[0].last("reactions.csv", column).abs());
        let largest = sizes.fold(0.0, f64::max);
        for column in columns {
            let before = found[0].last("reactions.csv", column);
            near(
                found[1].column("reactions.csv", column)[0],
                before,
                1e-6 * largest,
                &format!("{name}, {column}"),
            );
        }
    }
}

/// A string that hardly moves yet, held at its end, swings over to where its weight and the wind take it: along both, longer by half the
/// weight over EA. No path of load steps leads there from the state in which a motion left it.
#[test]
fn a_string_comes_to_rest_from_the_state_of_a_motion() {
    let (weight, flow, drag) = ([1.135_f64, -0.4463_f64], [0.1939, -0.09302], 0.07656);
    let of = |more: &str| {
        scene(&format!(
            "beam.rope = {{ start = [0, 0], end = [1, 0], mass_per_length = 1, axial_stiffness = 1004, basis.ancf.nodes = 9 }}
            support = [{{ beam = 'rope', at = 'end', fix = ['x', 'y'] }}]
            probe = [{{ name = 'tip', beam = 'rope', at = 'start' }}]
            effect.gravity.acceleration = {weight:?}
            effect.drag = [{{ beam = 'rope', normal = {drag}, flow = {flow:?} }}]
            {more}\n"
        ))
    };
    let law = "1-cos(4.3689922480620154e1*t)/(1+(1.7054263565891475e1*t)^2)";
    let motion = of(&format!(
        "effect.distributed_force = [{{ beam = 'rope', value = [0, -0.6275], in_time.expression = '{law}' }}]
        effect.actuation = [{{ beam = 'rope', strain.polynomial = [-0.0149292, -0.000142857, -0.001084941] }}]
        analysis.dynamic.duration = 0.129"
    ));
    let before = motion.model().solve(motion.analysis()).expect("a motion").into_states();
    let rest = of("analysis.static = {}");
    let options = Options { start: before.saved.as_ref(), ..Options::default() };
    let found = rest.model().solve_with(rest.analysis(), options).expect("an equilibrium");
    let tip = found.states().probes[0].samples.last().expect("a sample");
    let (mut load, mut along) = (weight, [0.0; 2]);
    for _ in 0..50 {
        let size = load[0].hypot(load[1]);
        let [x, y] = load.map(|component| component / size);
        let across = flow[1] * x - flow[0] * y;
        let wind = drag * across.abs() * across;
        along = [x, y].map(|component| component * (1.0 + 0.5 * size / 1004.0));
        load = [weight[0] - wind * y, weight[1] + wind * x];
    }
    near(tip.x, 1.0 + along[0], 1e-7, "x");
    near(tip.y, along[1], 1e-7, "y");
}

/// A tendon of given length on a beam that begins bent keeps its length in later stages: its tension is T (e²/EI + 1/EA) L = Δ, and it
/// turns the end by T e L/EI.
#[test]
fn a_tendon_keeps_its_length_where_the_beam_began_bent() {
    let found = stages(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 8,
                      initial_shape.points = [[0, 0], [0.5, 0.1], [0.9, 0.3]] }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        probe = [{ name = 'foot', beam = 'arm', at = 'start' }, { name = 'tip', beam = 'arm', at = 'end' }]
        effect.tendon = [{ beam = 'arm', offset = 0.01, shortening = 2e-3 }]
        effect.moment = [{ beam = 'arm', at = 'end', value = 0.1, stage = 'two', until = 'three' }]
        stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static.steps = 2 },
                 { name = 'three', analysis.static.steps = 2 }]\n",
    );
    let turn = |written: &Written| {
        written.last("probes.csv", "tip.angle") - written.last("probes.csv", "foot.angle")
    };
    for (stage, written) in found.iter().enumerate() {
        // What the moment turns, the tendon takes but for the part by which it is stretched in turn.
        let moment = if stage == 1 { 0.1 } else { 0.0 };
        let tension = (2e-3 - 0.01 * moment) / (1e-4 + 1e-4);
        near(turn(written), 0.01 * tension + moment, 1e-8, &format!("the turn in stage {stage}"));
    }
    for column in ["tip.x", "tip.y"] {
        let began = found[1].column("probes.csv", column)[0];
        near(began, found[0].last("probes.csv", column), 1e-9, column);
    }
}

/// A cantilever with `effects`, whose state is looked at inside an element.
fn cantilever(effects: &str, stages: &str) -> Vec<Written> {
    self::stages(&format!(
        "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 0.3, \
         basis.ancf.elements = 4 }}
        support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
        probe = [{{ name = 'mid', beam = 'arm', at = 0.55 }}]
        output = {{ reactions = true, section_forces = true }}
        stage = [{stages}]
        {effects}\n"
    ))
}

/// The columns of `file` but the load factor, by name and with their values.
fn columns(written: &Written, file: &str) -> Vec<(String, Vec<f64>)> {
    let text = std::fs::read_to_string(written.0.path().join(file)).expect("a file");
    let names = text.lines().next().expect("a header").split(',').skip(1).map(str::to_owned);
    names.map(|name| (name.clone(), written.column(file, &name))).collect()
}

/// What goes takes the way back on which it came: where it has faded to a quarter, positions, forces in
/// sections, reactions and energies are those of a quarter of it.
#[test]
fn what_goes_takes_the_way_back_on_which_it_came() {
    let two = "{ name = 'on', analysis.static.steps = 4 }, { name = 'off', analysis.static.steps = 4 }";
    for effect in [
        "distributed_force = [{ beam = 'arm', value = [0.2, -1.5]",
        "distributed_force = [{ beam = 'arm', value = [0.2, -1.5], follower = true",
        "force = [{ beam = 'arm', at = 0.4, value = [0.3, -1.5]",
        "force = [{ beam = 'arm', at = 'end', value = [0.3, -1.5], follower = true",
        "moment = [{ beam = 'arm', at = 0.4, value = 2.5",
        "gravity = { acceleration = [0, -9.81]",
        "tendon = [{ beam = 'arm', offset = 0.1, tension = 3",
        "tendon = [{ beam = 'arm', offset = 0.1, shortening = 0.05",
        "actuation = [{ beam = 'arm', curvature = 1.2, strain = 0.01",
        "drag = [{ beam = 'arm', normal = 1, tangential = 0.1, flow = [0, 1.2]",
        "force_field = [{ beam = 'arm', potential = '0.5*x^2 + y'",
        "electrostatic = [{ beam = 'arm', electrode = { point = [0, -0.2], normal = [0, 1] }, width = 1, voltage = 4e4",
    ] {
        let close = if effect.contains('[') && !effect.starts_with("gravity") { "}]" } else { "}" };
        let found = cantilever(&format!("effect.{effect}, until = 'off' {close}"), two);
        for file in ["probes.csv", "reactions.csv", "energy.csv"] {
            let pairs = columns(&found[0], file).into_iter().zip(columns(&found[1], file));
            for ((name, there), (_, mut back)) in pairs {
                // The work of actuators counts from the start of each stage.
                if effect.starts_with("actuation") && ["work", "total"].contains(&&name[..]) {
                    continue;
                }
                back.reverse();
                let largest = there.iter().fold(0.01, |largest: f64, value| largest.max(value.abs()));
                assert_eq!(there.len(), 5);
                for (a, b) in there.iter().zip(&back) {
                    near(*b, *a, 1e-6 * largest, &format!("{effect}: {name}"));
                }
            }
        }
    }
}

/// A foundation gets softer where it goes: half-way it is one of half the stiffness.
#[test]
fn a_foundation_that_goes_gets_softer() {
    let stages = "{ name = 'on', analysis.static.steps = 2 }, { name = 'off', analysis.static.steps = 2 }";
    let effects = |stiffness: f64, until: &str| {
        format!(
            "effect.foundation = [{{ beam = 'arm', stiffness = [3, {stiffness}]{until} }}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [0, -3] }}]"
        )
    };
    let going = cantilever(&effects(90.0, ", until = 'off'"), stages);
    let effect = "effect.foundation = [{ beam = 'arm', stiffness = [1.5, 45] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, -3] }]";
    let half = cantilever(effect, "{ name = 'on', analysis.static = {} }");
    for (name, of_half) in columns(&half[0], "probes.csv") {
        let there = going[1].column("probes.csv", &name)[1];
        near(there, of_half[1], 1e-7 * of_half[1].abs().max(1.0), &name);
    }
}

/// A load that followed a law fades from where the law had brought it, and one that stands twice in the
/// scene and goes once fades once.
#[test]
fn loads_fade_from_what_they_were() {
    let stages = "{ name = 'on', analysis.static = {} }, \
        { name = 'rest', analysis.dynamic = { duration = 0.1, output_every = 0.1, radau.tolerance = 1e-8 } }, \
        { name = 'off', analysis.static.steps = 4 }";
    let load = |rest: &str| format!("{{ beam = 'arm', value = [0, -1.5]{rest} }}");
    let of = |value: f64| {
        let load = format!("{{ beam = 'arm', value = [0, {value}], until = 'off' }}");
        cantilever(&format!("effect.distributed_force = [{load}]"), stages)
    };
    let half = of(-0.75);
    let by_law = [
        "{ beam = 'arm', value = [0, -0.75], until = 'rest' }".to_owned(),
        load(", in_time.polynomial = [0.5], stage = 'rest', until = 'off'"),
    ];
    let by_law = cantilever(&format!("effect.distributed_force = [{}]", by_law.join(", ")), stages);
    let twice = [load(", until = 'off'"), load("")].join(", ");
    let twice = cantilever(&format!("effect.distributed_force = [{twice}]"), stages);
    for (name, expected) in columns(&half[2], "probes.csv") {
        let found = by_law[2].column("probes.csv", &name);
        let largest = expected.iter().fold(0.01, |largest: f64, value| largest.max(value.abs()));
        for (a, b) in found.iter().zip(&expected) {
            near(*a, *b, 1e-6 * largest, &format!("by law: {name}"));
        }
    }
    // Of two, one remains: half-way there are one and a half.
    let more = of(-2.25);
    for (name, expected) in columns(&more[0], "probes.csv") {
        let expected = expected.last().expect("a value");
        let there = twice[2].column("probes.csv", &name)[2];
        near(there, *expected, 1e-6 * expected.abs().max(0.01), &format!("one remains: {name}"));
    }
}

/// Vibrations do not know of loads that have gone before them, not even of those whose direction turns
/// with the beam or which have no potential.
#[test]
fn vibrations_know_nothing_of_a_load_that_has_gone() {
    let stages = "{ name = 'on', analysis.static = {} }, { name = 'tones', analysis.modal.count = 3 }";
    let stays = "force = [{ beam = 'arm', at = 'end', value = [0.5, -1] }]";
    let frequencies = |effects: &str| cantilever(effects, stages)[1].column("frequencies.csv", "frequency");
    let expected = frequencies(&format!("effect.{stays}"));
    for goes in [
        "moment = [{ beam = 'arm', at = 'end', value = 0.5",
        "distributed_force = [{ beam = 'arm', value = [2, -1], follower = true",
        "drag = [{ beam = 'arm', normal = 2, flow = [0, 1]",
    ] {
        let found = frequencies(&format!("effect.{stays}\neffect.{goes}, until = 'tones' }}]"));
        for (found, expected) in found.iter().zip(&expected) {
            near(*found, *expected, 1e-7 * expected, goes);
        }
    }
}

/// A rod of 1 kg that flies sideways with 2 m/s takes a mass of 3 kg along, whose energy is 6 J.
#[test]
fn a_mass_that_comes_in_a_motion_is_told_with_its_energy() {
    let warned = |more: &str| {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
             initial_velocity = [{{ beam = 'rod', polynomial = {{ vy = [2] }} }}]
             effect.point_mass = [{{ beam = 'rod', at = 0.5, mass = 3{more} }}]
             stage = [{{ name = 'one', analysis.dynamic.duration = 0.01 }}, {{ name = 'two', analysis.dynamic.duration = 0.01 }}]"
        );
        let results = solved(&text);
        let energy = |stage: usize| results[stage].states().energy.last().expect("a record").kinetic;
        ([energy(0), energy(1)], results[1].run().warnings.clone())
    };
    let (energies, told) = warned(", stage = 'two'");
    near(energies[0], 2.0, 1e-9, "the energy of the rod");
    near(energies[1], 8.0, 1e-9, "with the mass");
    let expected = "the motion begins with a kinetic energy of 8.000000e0 J, and the one before it ended with 2.000000e0 J";
    assert!(told.iter().any(|warning| warning.starts_with(expected)), "{told:?}");
    let (energies, told) = warned("");
    near(energies[0], 8.0, 1e-9, "with the mass from the start");
    assert!(told.is_empty(), "{told:?}");
    // A scene of its own that starts from the saved state knows as much.
    let alone = |effect: &str| {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
             analysis.dynamic.duration = 0.01\n{effect}"
        );
        scene(&text)
    };
    let bare = alone("initial_velocity = [{ beam = 'rod', polynomial = { vy = [2] } }]");
    let before = ancf::accuracy::run(&bare, Options { saved: true, ..Options::default() }).expect("a motion");
    let saved = before.states().saved.clone().expect("a state");
    let after = |effect: &str| {
        let options = Options { start: Some(&saved), ..Options::default() };
        ancf::accuracy::run(&alone(effect), options).expect("a motion").run().warnings.clone()
    };
    let told = after("effect.point_mass = [{ beam = 'rod', at = 0.5, mass = 3 }]");
    assert!(told.iter().any(|warning| warning.starts_with(expected)), "{told:?}");
    let told = after("effect.spring = [{ beam = 'rod', at = 0.5, stiffness = 1 }]");
    assert!(told.is_empty(), "{told:?}");
}

/// A stiff bar of 10 N lies on two grounds of 100 N/m², about 5 cm deep, and is held by the friction of one
/// of them. When that one is gone, a motion begins with the energy ½ k y² of the other and of the spring: not
/// with what the friction had stored.
#[test]
fn friction_takes_its_energy_with_it() {
    let ground = "beam = 'bar', stiffness = 100, half_plane = { point = [0, 0], normal = [0, 1] }";
    let text = format!(
        "beam.bar = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e4, mass_per_length = 1, basis.ancf.elements = 8 }}
         support = [{{ beam = 'bar', at = 'start', fix = ['angle'] }}]
         probe = [{{ name = 'start', beam = 'bar', at = 'start' }}]
         effect.gravity.acceleration = [0, -10]
         effect.spring = [{{ beam = 'bar', at = 'start', stiffness = 5 }}]
         effect.force = [{{ beam = 'bar', at = 'end', value = [2, 0] }}]
         effect.contact = [{{ {ground}, friction.coefficient = 0.5, until = 'two' }}, {{ {ground} }}]
         stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.dynamic.duration = 0.001 }}]"
    );
    let results = solved(&text);
    let states = results[1].states();
    let (x, y) = (states.probes[0].samples[0].x, states.probes[0].samples[0].y);
    let (ground, spring) = (50.0 * y * y, 2.5 * (x * x + y * y));
    near(states.energy[0].stored, ground + spring, 1e-4, "the energy that is stored");
    let held = results[0].states().energy.last().expect("a record").stored - (2.0 * ground + spring);
    assert!(held > 1e-3, "the friction had stored {held} J");
}

/// A moment M rolls a rod up against a spring by M/(EI/L + k) = 8.1453, more than a full turn. When another
/// spring that stands before it in the scene has gone or come, it still knows its turns. Elements of a third
/// of a radian err by a ten-thousandth.
#[test]
fn springs_keep_their_turns_when_others_come_or_go() {
    let (bending, length, moment, stiffness) = (3.0, 3.0 * PI, 3.0, 0.05);
    let angle = moment / (bending / length + stiffness);
    for when in ["until = 'two'", "stage = 'two'"] {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [{length}, 0], axial_stiffness = 1e5, bending_stiffness = {bending}, basis.ancf.elements = 24 }}
             support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }}]
             probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]
             effect.moment = [{{ beam = 'rod', at = 'end', value = {moment} }}]
             effect.torsion_spring = [{{ beam = 'rod', at = 0.5, stiffness = 1e-9, {when} }}, {{ beam = 'rod', at = 'end', stiffness = {stiffness} }}]
             stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.static = {{}} }}]"
        );
        for results in solved(&text) {
            let states = results.states();
            near(states.probes[0].samples.last().expect("a record").angle, angle, 2e-3, when);
            near(states.energy.last().expect("a record").stored, 0.5 * stiffness * angle.powi(2), 1e-3, when);
        }
    }
}

/// A spring that catches a rod in a motion counts the turns by which the rod has been rolled up: half of the
/// stiffness times (3π/2)².
#[test]
fn a_spring_that_comes_counts_the_turns_along_the_beam() {
    let (bending, length) = (3.0, 3.0 * PI);
    let text = format!(
        "beam.rod = {{ start = [0, 0], end = [{length}, 0], axial_stiffness = 1e5, bending_stiffness = {bending}, mass_per_length = 1, \
         basis.ancf.elements = 24 }}
         support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }}]
         effect.moment = [{{ beam = 'rod', at = 'end', value = {}, until = 'two' }}]
         effect.torsion_spring = [{{ beam = 'rod', at = 'end', stiffness = 0.5, stage = 'two' }}]
         stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.dynamic.duration = 0.01 }}]",
        1.5 * PI * bending / length
    );
    let energy = solved(&text)[1].states().energy[0];
    near(energy.stored, 0.25 * (1.5 * PI).powi(2), 1e-3, "the spring's energy");
}

/// A bar that lies on rough ground stays where it has been pulled to, when other ground that it never
/// touched, and that stands before it in the scene, has gone or come.
#[test]
fn friction_is_remembered_by_its_contact() {
    for when in ["until = 'two'", "stage = 'two'"] {
        let text = format!(
            "beam.bar = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}
             support = [{{ beam = 'bar', at = 'start', fix = ['angle'] }}]
             probe = [{{ name = 'tip', beam = 'bar', at = 'end' }}]
             effect.gravity.acceleration = [0, -10]
             effect.spring = [{{ beam = 'bar', at = 'start', stiffness = 5 }}]
             effect.force = [{{ beam = 'bar', at = 'end', value = [2, 0] }}]
             effect.contact = [
                 {{ beam = 'bar', stiffness = 100, half_plane = {{ point = [0, -5], normal = [0, 1] }}, friction.coefficient = 0.5, {when} }},
                 {{ beam = 'bar', stiffness = 100, half_plane = {{ point = [0, 0], normal = [0, 1] }}, friction.coefficient = 0.5 }},
             ]
             stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.static = {{}} }}]"
        );
        let at = |results: &Results| results.states().probes[0].samples.last().expect("a record").x;
        let found: Vec<f64> = solved(&text).iter().map(at).collect();
        assert!(found[0] > 1.01, "it is pulled: {found:?}");
        near(found[1], found[0], 1e-9, when);
    }
}

/// A plane that comes in a motion where the beam is 0.3 m within it is told with the energy k/2 ∫ g² ds of its contact.
#[test]
fn an_obstacle_that_comes_around_a_beam_is_told_with_its_energy() {
    let warned = |height: f64| {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
             effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, {height:?}], normal = [0, 1] }}, stiffness = 100, stage = 'two' }}]
             stage = [{{ name = 'one', analysis.dynamic.duration = 0.01 }}, {{ name = 'two', analysis.dynamic.duration = 0.01 }}]"
        );
        solved(&text)[1].run().warnings.clone()
    };
    let told = warned(0.3);
    let expected =
        "an obstacle that comes has beam `rod` within it already: its contact begins with 4.500000e0 J";
    assert!(told.iter().any(|warning| warning.starts_with(expected)), "{told:?}");
    assert!(warned(-0.3).is_empty());
}

/// Shortened by P/EA, a column buckles where P (1 − P/EA) = π² EI/4L² = 2.467. What acts before has strained it: the linear solution for
/// what is added errs by that strain, and says so.
#[test]
fn critical_loads_count_the_strain_of_what_acts_before() {
    let column = |axial_stiffness: f64| {
        let results = solved(&format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = {axial_stiffness}, bending_stiffness = 1, basis.ancf.elements = 24 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [-2, 0] }}, {{ beam = 'arm', at = 'end', value = [-1, 0], stage = 'two' }}]
            stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.buckling.count = 1 }}]\n"
        ));
        let exact = 0.5 * axial_stiffness * (1.0 - (1.0 - PI.powi(2) / axial_stiffness).sqrt()) - 2.0;
        let load = results[1].eigenvalues()[0];
        (load / exact - 1.0, results[1].run().warnings.clone())
    };
    let (off, warnings) = column(1e4);
    assert!(off.abs() < 1e-3 && warnings.is_empty(), "{off} {warnings:?}");
    let (off, warnings) = column(40.0);
    assert!(off < -0.05 && warnings[0].contains("strain the beam by 0.07"), "{off} {warnings:?}");
}

/// A bar falls flat on the ground by 0.3 m and is stopped where it is lowest, at rest. From there on the ground gives it the momentum with which it
/// leaves, m √(2 g h), and takes its weight: what acted before belongs to the stage before.
#[test]
fn impulses_count_from_where_a_stage_begins() {
    for method in ["radau.tolerance = 1e-6", "generalized_alpha.step = 2e-4", "gauss.step = 1e-3"] {
        let results = solved(&format!(
            "beam.b = {{ start = [0, 0.3], end = [1, 0.3], axial_stiffness = 1e4, bending_stiffness = 1e2, mass_per_length = 2, basis.ancf.elements = 4 }}
            probe = [{{ name = 'm', beam = 'b', at = 0.5 }}]
            [effect]
            gravity.acceleration = [0, -10]
            contact = [{{ beam = 'b', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = 5e4 }}]
            [[stage]]
            name = 'falls'
            analysis.dynamic = {{ duration = 1, {method}, event = [{{ probe = 'm', minimum = 'y', stop = true }}] }}
            [[stage]]
            name = 'rises'
            analysis.dynamic = {{ duration = 0.1, {method} }}\n"
        ));
        let [Results::Trajectory(falls), Results::Trajectory(rises)] = &results[..] else {
            panic!("two motions")
        };
        let start = falls.parameter.last().copied().expect("an end");
        let ended = rises.events.iter().find_map(|event| match event {
            Event::Contact { time, impulse: Some(impulse), .. } => Some((*time, impulse.impulse[1])),
            _ => None,
        });
        let (end, impulse) = ended.expect("an end of the contact");
        let expected = 2.0 * (6.0_f64.sqrt() + 10.0 * (end - start));
        near(impulse, expected, 5e-4, method);
    }
}

/// Angles at the ends of a beam that is clamped at a support which turns by `turn`, at the end of the last stage.
fn turned(turn: &str, more: &str, analysis: &str) -> Vec<f64> {
    let text = format!(
        "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 20, mass_per_length = 0.5, \
         basis.ancf.elements = 6 }}
        support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'], move.angle = '{turn}' }}]
        probe = [{{ name = 'start', beam = 'arm', at = 'start' }}, {{ name = 'tip', beam = 'arm', at = 'end' }}]
        {analysis}\n[effect]\n{more}"
    );
    let last = solved(&text).pop().expect("a stage");
    last.states().probes.iter().map(|probe| probe.samples.last().expect("a sample").angle).collect()
}

/// A support that turns by 800° takes its beam along, however few states are recorded: the tip of a stiff one, which its weight
/// of 3 N bends by PL²/(6 EI) = 1/40 at most, stands at 800° within 2°.
#[test]
fn full_turns_of_a_support_are_counted_however_few_states_are_kept() {
    let gravity = "gravity.acceleration = [0, -6]\n";
    let full = 800.0_f64.to_radians();
    for (turn, sign) in [("800 deg", 1.0), ("-800 deg", -1.0)] {
        for analysis in [
            "analysis.static = {}",
            "analysis.static.steps = 1",
            "analysis.static.steps = 2",
            "analysis.modal = { count = 1, about = 'equilibrium' }",
        ] {
            let stage = format!("stage = [{{ name = 'one', {analysis} }}]");
            let [start, tip] = turned(turn, gravity, &stage)[..] else { panic!("two probes") };
            assert!((start - sign * full).abs() < 1e-9, "{turn}, {analysis}: {start}");
            assert!((tip - sign * full).abs() < 2.0_f64.to_radians(), "{turn}, {analysis}: {tip}");
        }
    }
}

/// A couple M at its end bends a beam to M L/(EI), by 6 rad here, in few load steps: at the clamp it has turned by as much as the clamp
/// does, where another node has all but made a full turn, and at the end by 6 rad more. So it does where it is two beams.
#[test]
fn full_turns_are_counted_from_clamps_and_across_welds() {
    let one = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 12 }\n";
    let two = "beam.arm = { start = [0, 0], end = [0.5, 0], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 6 }
        beam.rest = { start = [0.5, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 6 }
        joint = [{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'rest', at = 'start' } }]\n";
    for (beams, last) in [(one, "arm"), (two, "rest")] {
        for (turn, steps) in
            [(90.0, ""), (90.0, "steps = 1"), (-30.0, ""), (0.0, "steps = 1"), (30.0, "steps = 3")]
        {
            let text = format!(
                "{beams}support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'], move.angle = '{turn} deg' }}]
                effect.moment = [{{ beam = '{last}', at = 'end', value = 6 }}]
                probe = [{{ name = 'clamp', beam = 'arm', at = 'start' }}, {{ name = 'tip', beam = '{last}', at = 'end' }}]
                stage = [{{ name = 'one', analysis.static = {{ {steps} }} }}]"
            );
            let last = solved(&text).pop().expect("a stage");
            let angle = |probe: usize| last.states().probes[probe].samples.last().expect("a sample").angle;
            near(angle(0), f64::to_radians(turn), 1e-9, &text);
            near(angle(1), f64::to_radians(turn) + 6.0, 1e-2, &text);
        }
    }
}

/// Vibrations about an equilibrium that is another one than that of the stage before: the probe has the angle of this one, which
/// a static stage finds, too.
#[test]
fn probes_of_a_modal_stage_see_its_own_equilibrium() {
    let force = "force = [{ beam = 'arm', at = 'end', value = [0, -4], stage = 'two' }]\n";
    let angles = |analysis: &str| {
        turned(
            "30 deg",
            force,
            &format!("stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', {analysis} }}]"),
        )
    };
    let [still, vibrating] = [angles("analysis.static = {}"), angles("analysis.modal.count = 1")];
    assert!((still[1] - still[0]).abs() > 0.05, "the force bends the beam: {still:?}");
    for (still, vibrating) in still.iter().zip(&vibrating) {
        assert!((still - vibrating).abs() < 1e-9, "{still} {vibrating}");
    }
}

/// A jack that lifts an end by 0.1 m, and another one that does so after it; a force that goes while the same comes, along a path to twice
/// as much; and a couple that comes after a stage of vibrations: in the same words as what goes they do what they do in others.
#[test]
fn what_comes_in_the_words_of_what_goes_is_new() {
    let scene = |supports: &str, effects: &str, stages: &str| {
        format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}
            support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}{supports}]
            probe = [{{ name = 'tip', beam = 'a', at = 'end' }}]
            {effects}
            stage = [{stages}]\n"
        )
    };
    let statics = "{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = {} }";
    let path =
        "{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static.arc_length.until_load = 2 }";
    let modes = "{ name = 'one', analysis.static = {} }, { name = 'modes', analysis.modal = { count = 2 } }, { name = 'two', analysis.static = {} }";
    let jack = |y: &str, when: &str| {
        format!(", {{ beam = 'a', at = 'end', fix = ['y'], move = {{ y = {y} }}, {when} }}")
    };
    let jacks = |y: &str, stages: &str| {
        scene(&(jack("0.1", "until = 'two'") + &jack(y, "stage = 'two'")), "", stages)
    };
    let load = |kind: &str, first: &str, then: &str, stages: &str| {
        let one = |value: &str, when: &str| format!("{{ beam = 'a', at = 'end', value = {value}, {when} }}");
        let both = [one(first, "until = 'two'"), one(then, "stage = 'two'")].join(", ");
        scene("", &format!("effect.{kind} = [{both}]"), stages)
    };
    let tip = |text: &str| {
        let results = solved(text);
        *results.last().expect("stages").states().probes[0].samples.last().expect("a state")
    };
    for (same, other, beside) in [
        (jacks("0.1", statics), jacks("0.1000001", statics), 0.1),
        (jacks("0.1", modes), jacks("0.1000001", modes), 0.1),
        (load("force", "[0, 1]", "[0, 1]", path), load("force", "[0, 1]", "[0, 1.0000001]", path), 0.15),
        (load("moment", "1.0", "1.0", modes), load("moment", "1.0", "1.0000001", modes), 0.0),
    ] {
        let (found, expected) = (tip(&same), tip(&other));
        near(found.y, expected.y, 1e-6, &same);
        near(found.angle, expected.angle, 1e-6, &same);
        let first = solved(&same)[0].states().probes[0].samples.last().expect("a state").y;
        assert!((found.y - first).abs() >= beside, "{} after {first}\n{same}", found.y);
    }
    // What is there all the time is the same, however many of the same words come and go beside it.
    let two = "effect.force = [{ beam = 'a', at = 'end', value = [0, 1] }, { beam = 'a', at = 'end', value = [0, 1], stage = 'two' }]";
    let results = solved(&scene("", two, path));
    let standing = solved(&scene("", "effect.force = [{ beam = 'a', at = 'end', value = [0, 3] }]", statics));
    near(
        results[1].states().probes[0].samples.last().expect("a state").y,
        standing[0].states().probes[0].samples.last().expect("a state").y,
        1e-7,
        two,
    );
}

/// Of every kind of table one is there from the start and another one comes in the second stage: without what is entering, that has
/// what the first has.
#[test]
fn what_is_entering_is_told_from_what_was_there() {
    let kinds = [
        ("force", "at = 0.5, value = [0, V]"),
        ("moment", "at = 0.5, value = V"),
        ("distributed_force", "value = [0, V]"),
        ("damping", "mass_proportional = V"),
        ("spring", "at = 0.5, stiffness = V"),
        ("torsion_spring", "at = 0.5, stiffness = V"),
        ("point_mass", "at = 0.5, mass = V"),
        ("rotary_inertia", "per_length = V"),
        ("foundation", "stiffness = [0, V]"),
        ("actuation", "curvature = V"),
        ("tendon", "offset = 0, tension = V"),
        ("drag", "normal = V"),
        ("buoyancy", "displaced_mass_per_length = V"),
        ("electrostatic", "voltage = V, electrode = { point = [0, -1], normal = [0, 1] }, width = 0.01"),
        ("force_field", "potential = 'V*x'"),
        ("moving_force", "value = [0, V], speed = 1"),
        ("contact", "half_plane = { point = [0, -2], normal = [0, 1] }, stiffness = V"),
    ];
    let table = |(kind, keys): (&str, &str)| {
        let one = |value: &str, when: &str| format!("{{ beam = 'a', {}{when} }}", keys.replace('V', value));
        format!("{kind} = [{}, {}]\n", one("2.0", ""), one("3.0", ", stage = 'two'"))
    };
    let effects: String = kinds.into_iter().map(table).collect();
    let text = format!(
        "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}
        beam.b = {{ start = [1, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }}
        support = [{{ beam = 'b', at = 'end', fix = ['x'], stage = 'two' }}, {{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
        joint = [{{ type = 'hinge', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}, \
            {{ type = 'weld', first = {{ beam = 'a', at = 0.5 }}, second = {{ beam = 'b', at = 0.5 }}, stage = 'two' }}]
        stage = [{{ name = 'one', analysis.dynamic.duration = 1 }}, {{ name = 'two', analysis.dynamic.duration = 1 }}]
        [effect]\ngravity.acceleration = [0, -9.81]\n{effects}"
    );
    let scene = scene(&text);
    let [one, two] = [0, 1].map(|index| &scene.stages()[index].model);
    let old =
        |count: usize, entering: &[usize]| (0..count).filter(|i| !entering.contains(i)).collect::<Vec<_>>();
    assert!(one.entering == ancf::model::Entering::default());
    assert_eq!((one.parts.len(), two.entering.parts.len()), (kinds.len() + 1, kinds.len()));
    for (part, i) in one.parts.iter().zip(old(two.parts.len(), &two.entering.parts)) {
        assert_eq!(format!("{part:?}"), format!("{:?}", two.parts[i]));
    }
    assert_eq!((&two.entering.supports[..], &two.entering.joints[..]), (&[0][..], &[1][..]));
    assert_eq!((&one.supports[0], &one.joints[0]), (&two.supports[1], &two.joints[0]));
}
