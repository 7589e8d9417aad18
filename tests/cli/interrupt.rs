//! Runs that end early, by Ctrl-C or for want of a way on, leave what they have computed.

use super::commands::{ROLL_UP, ancf, entries, folder, status, stderr};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const PENDULUM: &str = include_str!("../scenes/soft-pendulum.toml");

fn summary(folder: &Path) -> serde_json::Value {
    let text = fs::read_to_string(folder.join("out/scene/summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

/// Runs `scene.toml` and sends SIGINT, `times` times, once its directory has been made: the program
/// listens by then.
#[cfg(unix)]
fn interrupted(folder: &Path, times: usize) -> Output {
    let arguments = ["run", "scene.toml", "--json"];
    interrupted_once(|| folder.join("out/scene").is_dir(), folder, &arguments, times)
}

/// The same for any command, once it is `ready`.
#[cfg(unix)]
fn interrupted_once(ready: impl Fn() -> bool, folder: &Path, arguments: &[&str], times: usize) -> Output {
    signalled("-INT", ready, folder, arguments, times)
}

/// The same by any signal.
#[cfg(unix)]
fn signalled(
    signal: &str,
    ready: impl Fn() -> bool,
    folder: &Path,
    arguments: &[&str],
    times: usize,
) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_ancf"))
        .current_dir(folder)
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while !ready() && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(10));
    }
    for _ in 0..times {
        sleep(Duration::from_millis(400));
        let sent =
            Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill exists");
        assert!(sent.success(), "the program ended by itself");
    }
    while child.try_wait().expect("a child").is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            child.kill().expect("a child");
            panic!("the program went on");
        }
        sleep(Duration::from_millis(10));
    }
    child.wait_with_output().expect("its output")
}

#[cfg(unix)]
#[test]
fn an_interrupted_motion_leaves_what_it_computed() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "100").replace("\"1 ms\"", "\"0.1 ms\""));
    let output = interrupted(folder.path(), 1);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let text = stderr(&output);
    for part in [
        "interrupted: the run ends after this step; press Ctrl-C again",
        "complete  no",
        "error: scene.toml: interrupted; what was computed until then is in out/scene",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let written = summary(folder.path());
    assert_eq!(written["complete"], false);
    let last = written["last"].as_f64().expect("a time");
    assert!((0.0..100.0).contains(&last), "{last}");
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(printed, written);
    let page = fs::read_to_string(folder.path().join("out/scene/report.html")).expect("a page");
    assert!(page.contains("<h2>Incomplete</h2>") && page.contains("scene.toml: interrupted"));
    let probes = fs::read_to_string(folder.path().join("out/scene/probes.csv")).expect("a table");
    assert!(probes.lines().count() > 1);
}

/// SIGTERM is what a queue sends before it kills.
#[cfg(unix)]
#[test]
fn a_motion_that_was_told_to_end_goes_on_bit_for_bit() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "8"));
    let run = |arguments: &[&str]| {
        let output = ancf(folder.path(), &[&["run", "scene.toml", "-q"], arguments].concat());
        assert_eq!(status(&output), 0, "{}", stderr(&output));
    };
    run(&["-o", "whole"]);
    let first = folder.path().join("first");
    for signal in ["-INT", "-TERM"] {
        let arguments = ["run", "scene.toml", "-o", "first"];
        let output = signalled(signal, || first.is_dir(), folder.path(), &arguments, 1);
        assert_eq!(status(&output), 1, "{}", stderr(&output));
        let text = fs::read_to_string(first.join("state.json")).expect("a state");
        let saved: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let time = saved["saved"]["checkpoint"]["state"]["time"].as_f64().expect("a time");
        let rest = format!("analysis.dynamic.duration={}", 8.0 - time);
        run(&["-o", "second", "--from", "first/state.json", "--set", &rest]);
        let state = |name: &str| fs::read(folder.path().join(name).join("state.json")).expect("a state");
        assert!(state("whole") == state("second"), "{signal}");
        fs::remove_dir_all(&first).expect("a directory");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_path_leaves_what_it_computed() {
    let folder = folder(&ROLL_UP.replace(
        "[analysis.static]",
        "[analysis.static]\narc_length = { until_load = 1e6, max_points = 1_000_000, max_step = 1e-7 }",
    ));
    let output = interrupted(folder.path(), 1);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let written = summary(folder.path());
    assert_eq!(written["complete"], false);
    assert!(written["last"].as_f64().expect("a load factor") > 0.0);
}

/// Of a scene with stages those before stay as they are, and the one that was interrupted is the last.
#[cfg(unix)]
#[test]
fn an_interrupted_stage_leaves_what_it_computed() {
    let folder = folder(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, 3], until = 'swing' }]
        stage = [{ name = 'bend', analysis.static = {} }, \
        { name = 'swing', analysis.dynamic = { duration = 1000, output_every = 0.1, radau.step = 0.001 } }, \
        { name = 'rest', analysis.static = {} }]\n",
    );
    let output = interrupted(folder.path(), 1);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let said = "error: scene.toml: interrupted; what was computed until then is in out/scene";
    assert!(stderr(&output).contains(said), "{}", stderr(&output));
    let written = summary(folder.path());
    assert_eq!(written["complete"], false);
    let told = |stage: usize| {
        (written["stages"][stage]["name"].as_str(), written["stages"][stage]["complete"].as_bool())
    };
    assert_eq!((told(0), told(1)), ((Some("bend"), Some(true)), (Some("swing"), Some(false))), "{written}");
    assert_eq!(told(2), (None, None));
    let page = fs::read_to_string(folder.path().join("out/scene/report.html")).expect("a page");
    assert!(page.contains("<h2>Incomplete</h2>") && page.contains("scene.toml: interrupted"));
}

#[cfg(unix)]
#[test]
fn a_second_interrupt_ends_the_program_at_once() {
    // Nobody looks at the first one before a step is done.
    let folder = folder(&ROLL_UP.replace("elements = 3 ", "elements = 1_000_000 "));
    let output = interrupted(folder.path(), 2);
    assert_eq!(status(&output), 130, "{}", stderr(&output));
    assert!(!folder.path().join("out/scene/summary.json").exists());
}

/// The runs in progress are finished and recorded, and the next call goes on after them.
#[cfg(unix)]
#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let folder = folder(ROLL_UP);
    let sweep =
        ["sweep", "scene.toml", "--vary", "effect.moment.0.value=0:1:20000", "-o", "s", "--threads", "2"];
    let journal = folder.path().join("s/journal-1-of-1.jsonl");
    let longer = |than: usize| fs::metadata(&journal).is_ok_and(|data| data.len() > than as u64);
    let output = interrupted_once(|| longer(0), folder.path(), &sweep, 1);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let first = fs::read_to_string(&journal).expect("a journal");
    let finished = first.lines().count();
    assert!(first.ends_with('\n') && (1..20000).contains(&finished), "{finished}");
    for part in [
        "interrupted: the sweep ends after the runs in progress; press Ctrl-C again".to_owned(),
        format!("error: interrupted; {finished} of 20000 runs are finished and recorded in s"),
        "call the same command again to go on".to_owned(),
    ] {
        assert!(stderr(&output).contains(&part), "{part} in {}", stderr(&output));
    }
    assert_eq!(entries(&folder.path().join("s")), ["journal-1-of-1.jsonl", "sweep.json"]);
    interrupted_once(|| longer(first.len()), folder.path(), &sweep, 1);
    let second = fs::read_to_string(&journal).expect("a journal");
    assert!(second.starts_with(&first) && second.len() > first.len());
    let run = |line: &str| serde_json::from_str::<serde_json::Value>(line).expect("a record")["run"].as_u64();
    let mut runs: Vec<_> = second.lines().map(run).collect();
    runs.sort_unstable();
    assert!(runs.windows(2).all(|pair| pair[0] < pair[1]), "no run twice");
}

/// No equilibrium follows beyond a limit point.
#[test]
fn a_failed_run_leaves_what_it_computed_and_says_that_it_failed() {
    let snap = r#"
title = "Arch"
[beam.arch]
arc = { center = [0.0, 0.0], radius = 1.0, from = "150 deg", to = "30 deg" }
axial_stiffness = 1e4
bending_stiffness = 1.0
[beam.arch.basis.ancf]
elements = 8
[[support]]
beam = "arch"
at = "start"
fix = ["x", "y"]
[[support]]
beam = "arch"
at = "end"
fix = ["x", "y"]
[[effect.force]]
beam = "arch"
at = "50 %"
value = [0.0, -1000.0]
[[probe]]
name = "crown"
beam = "arch"
at = "50 %"
[analysis.static]
steps = 1
"#;
    let folder = folder(&snap.replace("\"50 %\"", &format!("{}", std::f64::consts::PI / 3.0)));
    let output = ancf(folder.path(), &["run", "scene.toml", "--json"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("no equilibrium beyond load factor"), "{}", stderr(&output));
    assert_eq!(entries(folder.path()), ["out", "scene.toml"]);
    let written = summary(folder.path());
    assert_eq!(written["complete"], false);
    let last = written["last"].as_f64().expect("a load factor");
    assert!(last > 0.0 && last < 1.0, "{last}");
    assert!(written["seconds"]["solve"].as_f64().expect("a time") > 0.0);
    let page = fs::read_to_string(folder.path().join("out/scene/report.html")).expect("a page");
    assert!(page.contains("<h2>Incomplete</h2>") && page.contains("no equilibrium beyond load factor"));
    // A run that reaches its end says so, in the same place.
    let output = ancf(folder.path(), &["run", "scene.toml", "--set", "effect.force.0.value=[0, -1]"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert_eq!(summary(folder.path())["complete"], true);
}

#[cfg(unix)]
#[test]
fn a_study_interrupted_before_it_has_a_reference_leaves_nothing() {
    let folder = folder(PENDULUM);
    let arguments = ["cost", "scene.toml", "--target", "1e-11", "--budget", "5 min"];
    let output = interrupted_once(|| folder.path().join("out/scene").is_dir(), folder.path(), &arguments, 1);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("interrupted before anything was measured"), "{}", stderr(&output));
    assert_eq!(entries(folder.path()), ["scene.toml"]);
}
