//! Why there is no result: the words and numbers of every refusal of a run, and what is left of it.

use super::near;
use ancf::model::{ArcLength, ProbeTarget, Static};
use ancf::results::Trajectory;
use ancf::run::RunError;
use ancf::scene::parse;
use miette::Diagnostic;

/// A trajectory of so many records.
fn records(count: usize) -> Box<Trajectory> {
    let parameter = (0..count).map(|i| i as f64).collect();
    Box::new(Trajectory { parameter, ..Trajectory::default() })
}

fn stuck(load: f64, s: f64, records: Box<Trajectory>) -> RunError {
    let (cause, beam, advice) = ("no reason".into(), "arm".into(), "try again".into());
    RunError::NoEquilibrium { load, step: 1.2e-9, cause, beam, s, advice, partial: records }
}

fn refused(text: &str) -> RunError {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).err().unwrap_or_else(|| panic!("solved:\n{text}"))
}

fn advice(error: &RunError) -> String {
    error.help().map(|help| help.to_string()).unwrap_or_default()
}

/// Numbers have as many decimals as tell them from zero, and powers of ten beyond a million.
#[test]
fn numbers_in_refusals_can_be_read() {
    for (load, written) in [
        (0.0, "0.000000"),
        (0.01, "0.010000"),
        (0.009_999, "9.999000e-3"),
        (0.5, "0.500000"),
        (-0.25, "-0.250000"),
        (-1e-7, "-1.000000e-7"),
        (1.0, "1.000000"),
        (999_999.5, "999999.500000"),
        (1e6, "1.000000e6"),
    ] {
        assert_eq!(
            stuck(load, 0.25, records(0)).to_string(),
            format!(
                "no equilibrium beyond load factor {written}: no reason; smallest step tried 1.2e-9, worst at s = 0.2500 m of beam `arm`"
            )
        );
    }
    let place = stuck(0.5, 2e-3, records(0)).to_string();
    assert!(place.ends_with("worst at s = 2.0000e-3 m of beam `arm`"), "{place}");
    let (cause, beam, advice) = ("no reason".into(), "arm".into(), "try again".into());
    let time =
        RunError::NoStep { time: 0.125, step: 3e-4, cause, beam, s: 30.0, advice, partial: records(0) };
    assert_eq!(
        time.to_string(),
        "no step of 3.0e-4 s beyond t = 0.125000 s: no reason; the last iterate changed most at s = 30.0000 m of beam `arm`"
    );
    let path = RunError::OutOfPoints { points: 7, load: 0.25, target: "y = 3 m".into(), partial: records(0) };
    assert_eq!(
        path.to_string(),
        "the path ends after `max_points = 7` at load factor 0.250000, before y = 3 m"
    );
    let nowhere = RunError::NothingGrows { target: "y = 3 m".into(), partial: records(0) };
    assert!(nowhere.to_string().starts_with("the path leads nowhere beyond load factor 1, before y = 3 m: "));
    let still = RunError::NothingMoves { load: 3e14, target: "y = 3 m".into(), partial: records(0) };
    assert_eq!(
        still.to_string(),
        "the path leads nowhere up to load factor 3.0e14, before y = 3 m: the loads grow, and nothing moves"
    );
    let gib = 1024.0 * 1024.0 * 1024.0;
    let memory = RunError::Memory { needed: 3.0 * gib, free: 1.5 * gib };
    assert_eq!(memory.to_string(), "this needs about 3.000 GiB of memory, and 1.500 GiB are free");
}

/// Input at fault is told apart from a computation that failed; and what was computed until then
/// can be had where it is more than the start.
#[test]
fn refusals_have_their_status_and_what_is_left() {
    let probe = RunError::NoSuchProbe { probe: "nose".into(), known: "tip".into() };
    let version = RunError::Unavailable { what: "this", instead: "that" };
    let path = || RunError::OutOfPoints { points: 7, load: 0.25, target: String::new(), partial: records(2) };
    let nowhere = || RunError::NothingGrows { target: String::new(), partial: records(2) };
    let still = || RunError::NothingMoves { load: 1.0, target: String::new(), partial: records(2) };
    let step = |count: usize| RunError::NoStep {
        time: 0.0,
        step: 1.0,
        cause: String::new(),
        beam: String::new(),
        s: 0.0,
        advice: String::new(),
        partial: records(count),
    };
    let memory = || RunError::Memory { needed: 2.0, free: 1.0 };
    for (error, status) in [
        (probe, 2),
        (version, 2),
        (path(), 1),
        (nowhere(), 1),
        (still(), 1),
        (step(2), 1),
        (stuck(0.5, 0.0, records(2)), 1),
        (memory(), 1),
    ] {
        assert_eq!(error.exit_status(), status, "{error}");
    }
    for (mut error, left) in [
        (step(0), None),
        (step(1), None),
        (step(2), Some(2)),
        (path(), Some(2)),
        (nowhere(), Some(2)),
        (stuck(0.5, 0.0, records(1)), None),
        (stuck(0.5, 0.0, records(3)), Some(3)),
        (memory(), None),
    ] {
        let had = error.partial().is_some();
        assert_eq!(had, !matches!(error, RunError::Memory { .. }), "{error}");
        assert_eq!(error.take_partial().map(|partial| partial.states().parameter.len()), left, "{error}");
    }
}

const CLAMPED: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }
    probe = [{ name = 'tip', beam = 'arm', at = 'end' }, { name = 'middle', beam = 'arm', at = 0.5 }]
    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n";

/// A load beyond the limit of a bar that is pushed flat, 1 m along x and 0.3 m high, for which P =
/// (1 − (1/ℓ₀)^⅔)^1½ EA: the last equilibrium is at it to all digits that are written.
#[test]
fn a_load_beyond_the_limit_is_refused_at_the_limit() {
    let bar = "beam.bar = { start = [0, 0], end = [1, 0.3], axial_stiffness = 1e4, bending_stiffness = 1e3, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }, { beam = 'bar', at = 'end', fix = ['x'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [0, -100] }]\n";
    let exact = 1e4 * (1.0 - 1.09_f64.powf(-1.0 / 3.0)).powf(1.5) / 100.0;
    for steps in ["{}", "{ steps = 20 }"] {
        let mut error = refused(&format!("{bar}analysis.static = {steps}\n"));
        assert!(
            advice(&error).contains("near a limit point the load cannot grow: follow the path"),
            "{error}"
        );
        let RunError::NoEquilibrium { load, step, ref beam, .. } = error else { panic!("{error}") };
        near(load, exact, 1e-6, steps);
        assert!(step < 1e-8 && beam == "bar", "{step} of {beam}");
        let partial = error.take_partial().expect("a path to the limit");
        assert!(!partial.run().complete);
        assert_eq!(partial.states().parameter.last(), Some(&load), "where it ends early is a record");
    }
}

/// A path needs something that grows with the load factor: without it only a load factor is a target that
/// can be reached, and a stage in which nothing is new has no path.
#[test]
fn paths_along_which_nothing_changes_are_refused() {
    let load = "effect.force = [{ beam = 'arm', at = 'end', value = [0, -2] }]\n";
    let moved = CLAMPED
        .replace("'angle'] }", "'angle'] }, { beam = 'arm', at = 'end', fix = ['y'], move = { y = -0.2 } }");
    let to = |target: &str| format!("analysis.static.arc_length = {{ {target}max_points = 40 }}\n");
    let probe = "until_probe = { probe = 'tip', y = -0.1 }, ";
    for target in [probe, ""] {
        let error = refused(&format!("{CLAMPED}{}", to(target)));
        assert!(matches!(error, RunError::NoPath) && error.exit_status() == 2, "{error}");
        assert!(advice(&error).contains("a load, a support that moves or an actuation"), "{error}");
    }
    for (arm, target) in
        [(&moved, probe), (&format!("{CLAMPED}{load}"), probe), (&CLAMPED.to_owned(), "until_load = 1, ")]
    {
        let scene = parse("scene.toml", &format!("{arm}{}", to(target))).expect("a scene");
        let found = scene.model().solve(scene.analysis()).expect("a path").into_states();
        let tip = found.probes[0].samples.last().expect("a point").y;
        near(tip, if target == probe { -0.1 } else { 0.0 }, 1e-9, target);
    }
    let staged = |more: &str| {
        format!(
            "{CLAMPED}{load}stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', {} }}]\n{more}",
            to("until_probe = { probe = 'tip', y = -0.1 }, ").trim_end()
        )
    };
    let run = |text: &str| {
        let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        ancf::run::solve_stages(scene.stages(), ancf::run::Options::default())
    };
    let failure = run(&staged("")).failure.expect("no path").to_string();
    assert!(failure.contains("two") && failure.contains("leads nowhere"), "{failure}");
    let lifted = "effect.moment = [{ beam = 'arm', at = 'end', value = 3.0, stage = 'two' }]\n";
    assert!(run(&staged(lifted)).failure.is_none());
    // A weld that is open by the round-off of positions in a state that was computed closes nothing.
    let welded = "beam.leg = { start = [1, 0], end = [0.7, -0.4], axial_stiffness = 1e4, bending_stiffness = 10, \
                  basis.ancf.elements = 3 }\njoint = [{ type = 'weld', first = { beam = 'arm', at = 'end' }, \
                  second = { beam = 'leg', at = 'start' } }]\n";
    let failure = run(&staged(welded)).failure.expect("no path").to_string();
    assert!(failure.contains("leads nowhere"), "{failure}");
    // A load where it can move nothing: whether it drives anything would be decided by round-off.
    for angle in [0.0, 0.3f64] {
        let held = format!(
            "effect.force = [{{ beam = 'arm', at = 'start', value = [{}, {}] }}]\n",
            angle.cos(),
            angle.sin()
        );
        let error = refused(&format!("{CLAMPED}{held}{}", to(probe)));
        assert!(!matches!(error, RunError::NoPath), "{error}");
    }
}

/// Would catch the advice of another failure, the other beam, and loads of less than a newton that
/// count for nothing.
#[test]
fn each_failure_of_statics_has_its_own_advice() {
    let crushed = "a beam is a model for small strains: use smaller loads, or a larger axial stiffness";
    let two = "beam.first = { start = [3, 0], end = [3.5, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 2 }
        beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'first', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [-2e4, 0] }]\n";
    let moved = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 'end', fix = ['x', 'y'], move = { x = -1 } }]\n";
    let shelf = "effect.force = [{ beam = 'arm', at = 'end', value = [0, -5] }]
        effect.contact = [{ beam = 'arm', box = { center = [0.8, -0.12], size = [0.5, 0.02] }, stiffness = 1 }]\n";
    let near_nodes = |force: &str| {
        let arm = CLAMPED.replace("elements = 4", "nodes = [0, 0.5, 0.500000000001, 1]");
        format!("{arm}effect.force = [{{ beam = 'arm', at = 'end', value = [0, {force}] }}]\n")
    };
    let rope = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 4 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, -1], follower = true }]\n";
    for (text, cause, help) in [
        (two.to_owned(), "load factor 0.475", crushed),
        // Without any load, to which a round-off could be compared.
        (moved.to_owned(), "load factor 0.95", crushed),
        (
            format!("{CLAMPED}{shelf}"),
            "through the obstacle of contact 1",
            "the obstacle gives way by more than half its thickness: give the contact a larger `stiffness`",
        ),
        (near_nodes("1"), "of beam `arm`", "double precision cannot resolve these loads"),
        (near_nodes("1e-3"), "of beam `arm`", "double precision cannot resolve these loads"),
        (rope.to_owned(), "no convergence", "strings and beams on hinges come to rest where loads"),
    ] {
        let mut error = refused(&format!("{text}analysis.static = {{}}\n"));
        assert!(error.to_string().contains(cause), "{error}");
        assert!(error.to_string().ends_with(" m of beam `arm`"), "{error}");
        assert!(advice(&error).starts_with(help), "{error}\n{}", advice(&error));
        assert!(!error.partial().expect("the start at least").run.complete);
    }
}

/// Would catch advice for steps where there is a tolerance, and forces without bound at the start
/// for those of a step.
#[test]
fn each_failure_of_a_motion_has_its_own_advice() {
    let force = |value: &str| format!("effect.force = [{{ beam = 'arm', at = 'end', value = {value} }}]\n");
    let step = "give `tolerance` instead of `step`, so that steps are as short as the motion needs them";
    for (value, integrator, cause, help) in [
        ("[-1e6, 0]", "generalized_alpha.step = 0.1", "no step of 2.0e-4 s", step),
        ("[0, 1e300]", "gauss.step = 0.1", "is not finite", step),
        ("[0, 1e300]", "radau.tolerance = 1e-4", "no step of", "the motion has no continuation that"),
        (
            "[-1e6, 0]",
            "radau.tolerance = 1e-4",
            "crushed",
            "a beam is a model for small strains: use smaller loads",
        ),
    ] {
        let motion = format!("analysis.dynamic = {{ duration = 1, output_every = 0.1, {integrator} }}\n");
        let mut error = refused(&format!("{CLAMPED}{}{motion}", force(value)));
        assert!(error.to_string().contains(cause), "{integrator}: {error}");
        assert!(error.to_string().ends_with(" m of beam `arm`"), "{error}");
        assert!(advice(&error).starts_with(help), "{error}\n{}", advice(&error));
        assert!(!error.partial().expect("the start at least").run.complete);
    }
}

/// What a path was to reach is told in full: a load factor, a probe's place along its axis, or
/// both.
#[test]
fn a_path_that_is_too_short_tells_what_it_was_to_reach() {
    let load = "effect.force = [{ beam = 'arm', at = 'end', value = [0, 4] }]\n";
    for (until, target) in [
        ("until_load = 2.5", "load factor 2.5"),
        ("until_probe = { probe = 'tip', x = 0.1 }", "x = 0.1 m of probe `tip`"),
        ("until_probe = { probe = 'middle', y = 0.7 }", "y = 0.7 m of probe `middle`"),
        (
            "until_load = 2.5, until_probe = { probe = 'tip', x = 0.1 }",
            "load factor 2.5 or x = 0.1 m of probe `tip`",
        ),
    ] {
        let path = format!("analysis.static.arc_length = {{ {until}, max_points = 3, max_step = 0.05 }}\n");
        let mut error = refused(&format!("{CLAMPED}{load}{path}"));
        let message = error.to_string();
        let partial = error.partial().expect("four states");
        let last = *partial.parameter.last().expect("a state");
        assert!(!partial.run.complete && partial.parameter.len() == 4);
        assert_eq!(
            message,
            format!("the path ends after `max_points = 3` at load factor {last:.6}, before {target}")
        );
    }
}

/// A library may ask for a probe that is not there, which no scene can.
#[test]
fn a_probe_that_is_not_there_is_named_with_those_that_are() {
    let scene = parse("scene.toml", &format!("{CLAMPED}analysis.static = {{}}\n")).expect("a legal scene");
    let target = ProbeTarget { probe: "nose".into(), axis: 0, value: 0.1 };
    let arc = ArcLength { until_load: None, max_points: 3, max_step: None, until_probe: Some(target) };
    let settings = Static { arc_length: Some(arc), ..Static::default() };
    let error = scene.model().solve(&settings).expect_err("no such probe");
    assert_eq!(error.to_string(), "there is no probe `nose`; the probes are: tip, middle");
    assert_eq!(error.exit_status(), 2);
}

/// A load at a held end, on a beam in a contact that touches nothing: its path to another place of that end ends after some dozens of
/// points, with what was found until then.
#[test]
fn a_path_along_which_nothing_moves_ends() {
    let run = |target: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 2], axial_stiffness = 1e3, bending_stiffness = 1, basis.ancf.elements = 4 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'arm', at = 'end', fix = ['x', 'y'] }}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [0.7, 2.1] }}]
            effect.contact = [{{ beam = 'arm', half_plane = {{ point = [0, -1], normal = [0, 1] }}, stiffness = 1e4 }}]
            probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]
            analysis.static.arc_length = {{ {target} }}\n"
        );
        let scene = parse("scene.toml", &text).expect("a scene");
        scene.model().solve(scene.analysis())
    };
    let mut error = run("until_probe = { probe = 'tip', x = 0.9 }").expect_err("it is held");
    assert!(
        error.to_string().contains("leads nowhere") && error.to_string().contains("nothing moves"),
        "{error}"
    );
    let partial = error.take_partial().expect("what was found").into_states();
    assert!((30..60).contains(&partial.parameter.len()), "{}", partial.parameter.len());
    // Nor is it less than what was asked for where that is a number of points.
    let error = run("max_points = 200").expect_err("it is held").to_string();
    assert!(error.contains("before its 200 points: the loads grow, and nothing moves"), "{error}");
    // A straight column that keeps its length does not move either, and its path to a load factor goes there.
    let text = "beam.arm = { start = [0, 0], end = [1, 0], bending_stiffness = 1e9, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [-1, 0] }]
        analysis.static.arc_length = { until_load = 1e6, max_points = 10000 }\n";
    let scene = parse("scene.toml", text).expect("a scene");
    assert!(scene.model().solve(scene.analysis()).is_ok());
    // Fewer points than that can be had.
    assert!(run("max_points = 20").is_ok());
}
