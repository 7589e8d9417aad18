//! Observers: what they are told after every step, and what is left of a run that they stop; where
//! its time went; and motions that go on from a saved state.

use super::near;
use ancf::restart::SavedState;
use ancf::results::{Results, Trajectory};
use ancf::run::{Control, Options, Progress, RunError};
use ancf::scene::{Scene, parse};
use std::time::Instant;

fn scene(text: &str) -> Scene {
    parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A run with all that its observer is told; it is stopped by the first progress of which `ends` is
/// true.
fn watched(text: &str, ends: impl Fn(&Progress) -> bool) -> (Results, Vec<Progress>) {
    let scene = scene(text);
    let mut seen: Vec<Progress> = Vec::new();
    let mut observer = |progress: &Progress| {
        seen.push(*progress);
        if ends(progress) { Control::Stop } else { Control::Continue }
    };
    let options = Options { observer: Some(&mut observer), ..Options::default() };
    let found = scene.model().solve_with(scene.analysis(), options);
    (found.unwrap_or_else(|error| panic!("{error}\n{text}")), seen)
}

const ARM: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }
    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
    effect.force = [{ beam = 'arm', at = 'end', value = [0, 3] }]
    probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\n";

const MOTION: &str =
    "analysis.dynamic = { duration = 0.5, output_every = 0.1, gauss = { stages = 1, step = 0.005 } }\n";

/// Would catch progress towards another end, counts that are another's, and steps that are not
/// told.
#[test]
fn an_observer_is_told_of_every_step() {
    let (found, seen) = watched(&format!("{ARM}analysis.static.steps = 4\n"), |_| false);
    let at = |seen: &[Progress]| seen.iter().map(|progress| progress.parameter).collect::<Vec<_>>();
    let parts: Vec<f64> = at(&seen).into_iter().filter(|load| load % 0.25 == 0.0).collect();
    assert_eq!(parts, [0.25, 0.5, 0.75, 1.0], "{seen:?}");
    let (motion, moved) = watched(&format!("{ARM}{MOTION}"), |_| false);
    assert_eq!(moved.len(), 100);
    for (i, progress) in moved.iter().enumerate() {
        near(progress.parameter, 0.005 * (i + 1) as f64, 1e-12, "time");
        near(progress.step, 0.005, 1e-12, "the next step");
    }
    let modal = format!("{ARM}analysis.modal = {{ count = 1, about = 'equilibrium' }}\n");
    let (vibrating, loaded) = watched(&modal, |_| false);
    assert_eq!(
        (vibrating.eigenvalues().len(), loaded.last().map(|progress| progress.parameter)),
        (1, Some(1.0))
    );
    let path = format!("{ARM}analysis.static.arc_length = {{ until_load = 0.5 }}\n");
    let (followed, on_path) = watched(&path, |_| false);
    for (run, seen, target) in
        [(&found, &seen, 1.0), (&motion, &moved, 0.5), (&vibrating, &loaded, 1.0), (&followed, &on_path, 1.0)]
    {
        assert!(run.run().complete && seen.iter().all(|progress| progress.target == target), "{seen:?}");
        assert!(at(seen).is_sorted());
        let counts: Vec<usize> = seen.iter().map(|progress| progress.newton_iterations).collect();
        assert!(counts.is_sorted() && counts[0] > 0, "{counts:?}");
        assert_eq!(counts.last(), Some(&run.run().statistics.newton_iterations));
    }
}

/// What is stopped on the way is incomplete and ends there; a stop after the last step interrupts
/// nothing, but on a path, whose end is not known beforehand.
#[test]
fn a_run_ends_where_its_observer_stops_it() {
    let steps = format!("{ARM}analysis.static.steps = 4\n");
    let path = format!("{ARM}analysis.static.arc_length = {{ until_load = 0.5 }}\n");
    let motion = format!("{ARM}{MOTION}");
    for (text, end, complete) in [
        (&steps, 0.5, false),
        (&steps, 1.0, true),
        (&motion, 0.2, false),
        (&motion, 0.5, true),
        (&path, 0.5, false),
    ] {
        let (found, seen) = watched(text, |progress| progress.parameter >= end - 1e-9);
        assert_eq!(found.run().complete, complete, "stopped at {end}:\n{text}");
        near(*found.states().parameter.last().expect("a record"), end, 1e-12, text);
        near(seen.last().expect("progress").parameter, end, 1e-12, text);
        assert_eq!(found.states().saved.is_some(), complete && text == &steps || text == &motion, "{text}");
    }
    // Of vibrations about an equilibrium that was not reached there are none.
    let modal = format!(
        "{}analysis.modal = {{ count = 2, about = 'equilibrium' }}\n",
        ARM.replace("[0, 3]", "[0, 30]")
    );
    let (found, seen) = watched(&modal, |_| true);
    assert!(seen.len() == 1 && seen[0].parameter < 1.0, "{seen:?}");
    assert!(!found.run().complete && found.eigenvalues().is_empty());
    let (found, _) = watched(&modal, |progress| progress.parameter >= 1.0);
    assert!(found.run().complete && found.eigenvalues().len() == 2);
}

/// A search for a place of rest, which may take thousands of iterations, can be stopped in each of
/// them: from load factor 0, where a shape is given, or on the way to the full load.
#[test]
fn a_search_for_a_place_of_rest_can_be_stopped() {
    let slack = "beam.line = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 20 }
        support = [{ beam = 'line', at = 'start', fix = ['x', 'y'] }, { beam = 'line', at = 'end', fix = ['x', 'y'], move.x = -0.2 }]
        effect.gravity.acceleration = [0, -9.81]
        analysis.static.steps = 2\n";
    let (found, seen) = watched(slack, |_| false);
    assert!(found.run().complete && seen.len() > 10, "{seen:?}");
    let counts: Vec<usize> = seen.iter().map(|progress| progress.newton_iterations).collect();
    assert!(counts.windows(2).all(|pair| pair[1] <= pair[0] + 1), "{counts:?}");
    for (parameter, records) in [(0.0, 1), (0.5, 2)] {
        let (found, seen) = watched(slack, |progress| progress.parameter >= parameter);
        assert!(!found.run().complete && found.states().saved.is_none());
        assert_eq!(
            (seen.last().map(|now| now.parameter), found.states().parameter.len()),
            (Some(parameter), records)
        );
    }
    let bent =
        "initial_shape.arc = { center = [0, 0.5], radius = 0.5, from = '-90 deg', to = '24.6 deg' }, basis";
    let bent = format!("{ARM}analysis.static = {{}}\n").replace("basis", bent);
    let (found, _) = watched(&bent, |_| true);
    assert!(!found.run().complete && found.states().parameter.is_empty());
    assert!(watched(&bent, |_| false).0.run().complete);
}

/// The parts of a run's time are no longer than the run.
#[test]
fn the_times_of_a_run_add_up_to_no_more_than_it_took() {
    for analysis in ["analysis.static.steps = 40\n", MOTION, "analysis.modal.count = 3\n"] {
        let scene = scene(&format!("{ARM}{analysis}"));
        let start = Instant::now();
        let found = scene.model().solve(scene.analysis()).expect("a solution");
        let all = start.elapsed().as_secs_f64();
        let seconds = found.run().seconds;
        assert!(seconds.solve > 0.0 && seconds.build > 0.0 && seconds.write >= 0.0, "{seconds:?}");
        let sum = seconds.build + seconds.solve + seconds.write;
        assert!(sum <= all, "{seconds:?} within {all} s");
        // The rest is the comparison with the memory that is free.
        assert!(sum > 0.02 * all, "{seconds:?} within {all} s");
    }
}

fn go_on(text: &str, from: &SavedState) -> Result<Trajectory, RunError> {
    let scene = scene(text);
    scene
        .model()
        .solve_with(scene.analysis(), Options { start: Some(from), ..Options::default() })
        .map(Results::into_states)
}

fn told(found: &Trajectory) -> &str {
    &found.run.settings.iter().find(|(name, _)| name == "continued").expect("what was continued").1
}

/// A motion that goes on ends when it does as a whole, in decimals, and says from where it came.
#[test]
fn a_motion_that_goes_on_is_told_from_where_and_to_when() {
    let dynamic = |duration: &str, integrator: &str| {
        format!("{ARM}analysis.dynamic = {{ duration = {duration}, output_every = 0.1, {integrator} }}\n")
    };
    let (gauss, radau) = ("gauss = { stages = 1, step = 0.05 }", "radau = { stages = 2, step = 0.05 }");
    let (first, _) = watched(&dynamic("0.1", gauss), |_| false);
    let first = first.into_states().saved.expect("a state");
    // 0.1 + 0.2 is 0.30000000000000004.
    let second = go_on(&dynamic("0.2", gauss), &first).expect("a motion");
    near(*second.parameter.last().expect("a record"), 0.3, 1e-15, "the end");
    assert_eq!(told(&second), "for 0.2 s from t = 0.1 s to 0.3 s, as if it had not stopped");
    let other = go_on(&dynamic("0.2", radau), &first).expect("a motion");
    assert_eq!(
        told(&other),
        "for 0.2 s from t = 0.1 s to 0.3 s, from its positions and velocities alone, for the model or the integrator is another"
    );
    let (still, _) = watched(&format!("{ARM}analysis.static = {{}}\n"), |_| false);
    let still = still.into_states().saved.expect("an equilibrium");
    let moved = go_on(&dynamic("0.3333333333333333", gauss), &still).expect("a motion");
    assert_eq!(moved.parameter.last(), Some(&0.3333333333333333));
    assert_eq!(
        told(&moved),
        "for 0.3333333333333333 s from t = 0 s to 0.3333333333333333 s, from a static equilibrium"
    );
    let alone = watched(&dynamic("0.1", gauss), |_| false).0;
    assert!(alone.run().settings.iter().all(|(name, _)| name != "continued"));
    for (saved, from) in [(&first, "the end of a motion"), (&still, "a static equilibrium")] {
        let equilibrium = go_on(&format!("{ARM}analysis.static = {{}}\n"), saved).expect("an equilibrium");
        let told = equilibrium.run.settings.iter().find(|(name, _)| name == "starts from");
        assert_eq!(told.map(|(_, from)| from.as_str()), Some(from));
    }
    for (analysis, said) in [
        ("buckling", "the state with which this analysis starts is none without its own loads"),
        (
            "modal",
            "a modal analysis about the reference starts from the stress-free state, and from no other",
        ),
    ] {
        let error = go_on(&format!("{ARM}analysis.{analysis}.count = 1\n"), &first).expect_err(analysis);
        assert!(error.to_string().contains(said), "{error}");
        assert_eq!(error.exit_status(), 2);
    }
    assert!(go_on(&format!("{ARM}analysis.buckling.count = 1\n"), &still).is_ok());
}

/// An equilibrium is one under the full loads: a static run that is stopped before leaves none.
#[test]
fn half_of_a_load_leaves_no_equilibrium_to_go_on_from() {
    let steps = format!("{ARM}analysis.static.steps = 4\n");
    assert!(watched(&steps, |progress| progress.parameter >= 0.5).0.states().saved.is_none());
    let (whole, _) = watched(&steps, |_| false);
    assert_eq!(whole.into_states().saved.expect("an equilibrium").time(), 0.0);
}
