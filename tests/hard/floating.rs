//! The edge of floating point: what overflows or is no number is found at once, and the same run
//! gives the same bits.

use ancf::effect::Force;
use ancf::model::{Analysis, Model};
use ancf::restart::SavedState;
use ancf::results::{Results, Seconds, Trajectory};
use ancf::run::{Control, Options, Progress, RunError};
use ancf::scene::{self, Scene};
use std::sync::Arc;

const TIP_LOAD: &str = include_str!("../scenes/tip-load.toml");
const PENDULUM: &str = include_str!("../scenes/soft-pendulum.toml");
const ACCURATE: &str = include_str!("../scenes/soft-pendulum-accurate.toml");
const MODAL: &str = include_str!("../scenes/modal.toml");

fn parsed(text: &str) -> Scene {
    scene::parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn outcome(model: &Model, analysis: &Analysis) -> Result<Trajectory, RunError> {
    let mut steps = 0;
    let observer = &mut |_: &Progress| {
        steps += 1;
        assert!(steps < 10_000, "no end in sight");
        Control::Continue
    };
    model
        .solve_with(analysis, Options { observer: Some(observer), ..Options::default() })
        .map(Results::into_states)
}

fn short() -> String {
    PENDULUM.replace("\"2.5 s\"", "0.05")
}

/// A program may hand over what no scene file can say.
#[test]
fn loads_that_are_no_numbers_are_found_at_once() {
    for text in [TIP_LOAD.to_owned(), short()] {
        let scene = parsed(&text);
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut model = scene.model().clone();
            let at = model.probes[0].at;
            model.parts.push(Arc::new(Force::new(at, [value, 0.0])));
            let error = outcome(&model, scene.analysis()).expect_err("a load that is no number");
            let message = error.to_string();
            assert!(message.contains("not finite"), "{message}");
            assert!(
                message.contains("beyond load factor 0") || message.contains("beyond t = 0"),
                "{message}"
            );
        }
    }
}

/// Sizes from the smallest number to the largest: an answer, or a message, and every number of an
/// answer is one.
#[test]
fn numbers_of_any_size_give_finite_results_or_a_message() {
    let extremes = ["5e-324", "1e-310", "1e-300", "1e-160", "1e160", "1e300", "1.7e308"];
    for (text, keys) in [
        (TIP_LOAD, &["axial_stiffness = 1e6", "bending_stiffness = 1.0", "end = [1.0,", "-5.0]"][..]),
        (MODAL, &[]),
    ] {
        for key in keys {
            assert!(text.contains(key), "{key}");
            for extreme in extremes {
                let number = key.trim_end_matches([',', ']']).rsplit([' ', '[']).next().expect("a number");
                let changed = text.replacen(key, &key.replace(number, extreme), 1);
                let Ok(scene) = scene::parse("scene.toml", &changed) else { continue };
                let Ok(trajectory) = outcome(scene.model(), scene.analysis()) else { continue };
                let samples = trajectory.probes.iter().flat_map(|probe| &probe.samples);
                let numbers = samples.flat_map(|s| [s.x, s.y, s.angle, s.curvature, s.strain]);
                let energies = trajectory.energy.iter().flat_map(|e| [e.stretch, e.bend, e.potential]);
                assert!(numbers.chain(energies).all(f64::is_finite), "{key} → {extreme}");
            }
        }
    }
}

/// Steps so short that 1/h² is no number any more are refused by every method.
#[test]
fn steps_whose_square_vanishes_are_refused() {
    for method in ["generalized_alpha", "gauss", "radau"] {
        let (before, _) = PENDULUM.split_once("[analysis.dynamic]").expect("an analysis");
        let motion = format!("[analysis.dynamic]\nduration = 1e-160\n{method} = {{ step = 1e-160 }}\n");
        let scene = parsed(&format!("{before}{motion}"));
        let error = outcome(scene.model(), scene.analysis()).expect_err("a step of nothing");
        let RunError::NoStep { time, step, .. } = error else { panic!("{method}: {error}") };
        assert!(time == 0.0 && step < 1e-160, "{method}: {step:e} beyond {time:e}");
    }
}

/// Steps of a stiff blade err by its round-off, however short they are: the motion ends with the tolerance as
/// the cause, and with all that is right until there.
#[test]
fn tolerances_below_round_off_are_told() {
    let motion = |tolerance: &str| {
        let text = format!(
            "beam.blade = {{ start = [0, 0], end = [10, 0], axial_stiffness = 2.8e7, bending_stiffness = 1.4e4, mass_per_length = 1.2, basis.ancf.elements = 16 }}
            support = [{{ beam = 'blade', at = 'start', fix = ['x', 'y', 'angle'], move.spin_up = {{ speed = 6, duration = 1 }} }}]
            analysis.dynamic = {{ duration = 0.1, output_every = 0.001, radau = {{ stages = 3, tolerance = {tolerance} }} }}\n"
        );
        let scene = parsed(&text);
        outcome(scene.model(), scene.analysis())
    };
    assert!(motion("1e-9").is_ok());
    let mut error = motion("1e-13").expect_err("less than round-off");
    let message = format!("{error} {error:?}");
    assert!(message.contains("err no less") && message.contains("larger `tolerance`"), "{message}");
    assert!(error.partial().is_some_and(|found| !found.run.complete && found.parameter.len() > 1));
}

/// Far from the origin positions have fewer digits, and a motion of them is not silently wrong: at 1e8 beam
/// lengths the velocity of such a tip may err by a quarter.
#[test]
fn motions_far_from_the_origin_are_warned_of() {
    let warned = |x: f64, tolerance: f64| {
        let text = format!(
            "beam.a = {{ start = [{x:e}, 0], end = [{:e}, 0.6], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
            support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{{ beam = 'a', at = 'end', value = [0, -2] }}]
            analysis.dynamic = {{ duration = 0.01, radau.tolerance = {tolerance:e} }}",
            x + 0.8
        );
        let scene = parsed(&text);
        let motion = outcome(scene.model(), scene.analysis()).expect("a motion");
        motion.run.warnings.iter().any(|warning| warning.contains("place the origin near the beams"))
    };
    for (x, tolerance, expected) in
        [(0.0, 1e-9, false), (1e3, 1e-6, false), (1e8, 1e-6, true), (1e4, 1e-9, true), (1e5, 1e-3, false)]
    {
        assert_eq!(warned(x, tolerance), expected, "from {x} with a tolerance of {tolerance}");
    }
}

/// A load of the smallest number does nothing, and does it without a rejected step.
#[test]
fn subnormal_loads_are_no_load() {
    let trajectory =
        outcome(parsed(&TIP_LOAD.replace("-5.0]", "-5e-324]")).model(), parsed(TIP_LOAD).analysis())
            .expect("a straight cantilever");
    assert_eq!(trajectory.run.statistics.rejected_steps, 0);
    let tip = trajectory.probes[0].samples.last().expect("a state");
    assert!((tip.x - 1.0).abs() < 1e-15 && tip.y.abs() < 1e-15, "{tip:?}");
}

/// Goes on from a state whatever its checksum says.
fn resumed(scene: &Scene, state: &serde_json::Value) -> Result<Trajectory, RunError> {
    let saved: SavedState = serde_json::from_str(&state.to_string()).expect("a state");
    scene
        .model()
        .solve_with(scene.analysis(), Options { start: Some(&saved), ..Options::default() })
        .map(Results::into_states)
}

/// The state with a value elsewhere, both before and after a step that was cut short.
fn broken(state: &serde_json::Value, place: &str, value: &serde_json::Value) -> serde_json::Value {
    let mut broken = state.clone();
    for part in ["checkpoint", "checkpoint/state", "checkpoint/cut"] {
        if let Some(place) = broken.pointer_mut(&format!("/saved/{part}/{place}")) {
            *place = value.clone();
        }
    }
    assert_ne!(broken, *state, "{place}");
    broken
}

#[test]
fn saved_states_that_are_no_numbers_are_refused() {
    for text in [PENDULUM, ACCURATE] {
        let short = parsed(&text.replace("\"2.5 s\"", "0.05"));
        let long = parsed(&text.replace("\"2.5 s\"", "0.1"));
        let trajectory = outcome(short.model(), short.analysis()).expect("a motion");
        let state = serde_json::to_value(trajectory.saved.expect("a saved state")).expect("JSON");
        let whole = resumed(&short, &state).expect("a sound state");
        assert!(whole.run.complete);
        let reference = outcome(long.model(), long.analysis()).expect("a motion");

        for (place, value) in [("time", "-1e400"), ("q/5", "1e999"), ("v/5", "NaN"), ("q/5", "null")] {
            let marked = broken(&state, place, &"a mark".into()).to_string();
            let file = tempfile::NamedTempFile::new().expect("a file");
            std::fs::write(file.path(), marked.replace("\"a mark\"", value)).expect("a file");
            let error = SavedState::load(file.path()).expect_err(value);
            assert!(error.to_string().contains("not a saved state"), "{error}");
        }
        for (place, value) in [("step", 0.0), ("step", -1e-3), ("last_ratio", -1.0)] {
            let error = resumed(&short, &broken(&state, place, &value.into())).expect_err(place);
            assert_eq!(error.exit_status(), 2, "{error}");
            assert!(error.to_string().contains("from step to step"), "{error}");
        }
        // Numbers whose squares are none.
        for speed in [1e160, -1e300] {
            let error = resumed(&short, &broken(&state, "v/5", &speed.into())).expect_err("no energy");
            assert!(error.to_string().contains("not finite"), "{error}");
            let RunError::NoStep { partial, advice, .. } = error else { panic!("{error}") };
            assert!(partial.energy.is_empty() && advice.contains("start from another state"), "{advice}");
        }
        // Steps counted from a time that was not: the motion goes on from its state all the same.
        for (start, taken) in [(0.0, 7_u64), (0.0, u64::MAX), (1e300, 0), (-1e300, 3)] {
            let elsewhere = broken(&state, "origin", &serde_json::json!([start, taken]));
            let trajectory = resumed(&short, &elsewhere).expect("a state");
            let last = |t: &Trajectory| *t.probes[0].samples.last().expect("a state");
            let (a, b) = (last(&trajectory), last(&reference));
            assert!((a.x - b.x).hypot(a.y - b.y) < 1e-6, "{start} {taken}: {a:?} {b:?}");
            assert!(trajectory.parameter.is_sorted(), "{:?}", trajectory.parameter);
        }
    }
}

fn bits(scene: &Scene) -> String {
    let mut trajectory = outcome(scene.model(), scene.analysis()).expect("a solution");
    trajectory.run.seconds = Seconds::default();
    serde_json::to_string(&trajectory).expect("JSON")
}

/// The largest problem is one that a parallel linear algebra would share out.
#[test]
fn the_same_run_gives_the_same_bits_on_any_thread() {
    let dense = MODAL.replace("count = 3", "count = 60");
    let fine = TIP_LOAD.replace("nodes = 12", "nodes = 150");
    for text in [TIP_LOAD.to_owned(), fine, short(), ACCURATE.replace("\"2.5 s\"", "0.05"), dense] {
        let scene = parsed(&text);
        let expected = bits(&scene);
        let others = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| bits(&scene))).collect();
            threads.into_iter().map(|thread| thread.join().expect("no panic")).collect::<Vec<_>>()
        });
        assert!(others.iter().all(|other| *other == expected), "{}", scene.model().title);
    }
}
