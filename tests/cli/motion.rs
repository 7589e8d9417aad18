//! Motions by the program: restart from a saved state, events, steps that cannot be taken.

use super::commands::{ROLL_UP, ancf, folder, status, stderr};
use std::fs;
use std::path::Path;

const PENDULUM: &str = include_str!("../scenes/soft-pendulum.toml");

fn summary(folder: &Path, name: &str) -> serde_json::Value {
    let text = fs::read_to_string(folder.join(name).join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_motion_goes_on_from_a_saved_state_as_if_it_had_not_stopped() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "0.2"));
    let run = |arguments: &[&str]| {
        let output = ancf(folder.path(), &[&["run", "scene.toml"], arguments].concat());
        assert_eq!(status(&output), 0, "{}", stderr(&output));
    };
    run(&["-o", "whole"]);
    run(&["-o", "first", "--set", "analysis.dynamic.duration=0.12"]);
    run(&[
        "-o",
        "second",
        "--from",
        "first/state.json",
        "--set",
        "analysis.dynamic.duration=0.08",
        "--error",
    ]);
    let [whole, second] = ["whole", "second"].map(|name| summary(folder.path(), name));
    for part in ["probes", "last"] {
        assert_eq!(whole[part], second[part], "{part}");
    }
    assert_eq!(second["statistics"]["steps"], 80, "from 0.12 s to 0.2 s");
    run(&["-o", "third", "--from", "first/state.json", "--set", "analysis.dynamic.duration=0.01", "--error"]);
    let third = summary(folder.path(), "third");
    let reason = third["error"]["reason"].as_str().expect("a reason");
    assert!(reason.contains("no coarser one to compare with"), "{reason}");
}

#[test]
fn a_saved_state_that_does_not_fit_is_refused() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "0.02"));
    fs::write(folder.path().join("static.toml"), ROLL_UP).expect("a folder");
    let modal =
        PENDULUM.split("[analysis").next().expect("a scene").to_owned() + "[analysis.modal]\ncount = 1\n";
    fs::write(folder.path().join("modal.toml"), modal).expect("a folder");
    fs::write(folder.path().join("broken.json"), "{").expect("a folder");
    assert_eq!(status(&ancf(folder.path(), &["run", "scene.toml", "-o", "out"])), 0);
    let state = fs::read_to_string(folder.path().join("out/state.json")).expect("a state");
    let (digit, other) = if state.contains("0.2") { ("0.2", "0.3") } else { ("0.1", "0.4") };
    fs::write(folder.path().join("altered.json"), state.replacen(digit, other, 1)).expect("a folder");
    fs::write(folder.path().join("old.json"), state.replacen("\"format\":8", "\"format\":2", 1))
        .expect("a folder");
    let from = ["--from", "out/state.json"];
    for (arguments, part) in [
        (&["scene.toml", "--from", "none.json"][..], "none.json"),
        (&["scene.toml", "--from", "broken.json"], "not a saved state"),
        (&["scene.toml", "--from", "altered.json"], "not as it was written"),
        (&["scene.toml", "--from", "old.json"], "has format 2, and this version reads format 8"),
        (
            &[&["scene.toml", "--set", "beam.arm.second_moment=\"0.131 cm^4\""], &from[..]].concat(),
            "beam `arm` had another section",
        ),
        (&[&["scene.toml", "--set", "beam.arm.end=[\"1.8 m\", 1e-3]"], &from[..]].concat(), "beam `arm` had"),
        (
            &[&["scene.toml", "--set", "beam.arm.basis.rpim.nodes=9"], &from[..]].concat(),
            "beam `arm` had 14 nodes",
        ),
        (&[&["static.toml"], &from[..]].concat(), "the saved state does not fit this scene"),
        (&[&["modal.toml"], &from[..]].concat(), "a modal analysis about the reference starts from"),
    ] {
        let output = ancf(folder.path(), &[&["run"], arguments].concat());
        assert_eq!(status(&output), 2, "{}", stderr(&output));
        assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
    }
}

#[test]
fn events_are_reported_and_end_the_motion_where_asked() {
    let event = "\n[[analysis.dynamic.event]]\nprobe = \"tip\"\ny = \"-0.5 m\"\ncrossing = \"falling\"\nstop = true\n";
    let folder = folder(&format!("{PENDULUM}{event}"));
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("event at tip"), "{}", stderr(&output));
    let summary = summary(folder.path(), "out");
    let (event, tip) = (&summary["events"][0], &summary["probes"]["tip"]);
    assert_eq!(event["time"], summary["last"], "the motion ends with the event");
    let y = tip["y"].as_f64().expect("a number");
    assert!((y + 0.5).abs() < 1e-12, "y = {y}");
}

#[test]
fn velocities_of_the_scene_are_where_the_motion_starts() {
    let spin = "\n[[initial_velocity]]\nbeam = \"arm\"\nrotation = \"2 rad/s\"\nabout = [0, 0]\n";
    let folder = folder(&format!("{}{spin}", PENDULUM.replace("\"2.5 s\"", "\"10 ms\"")));
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let probes = fs::read_to_string(folder.path().join("out/probes.csv")).expect("a table");
    let first: Vec<f64> =
        probes.lines().nth(1).expect("a row").split(',').map(|v| v.parse().expect("a number")).collect();
    assert!((first[first.len() - 1] - 3.6).abs() < 1e-12, "vy = {}", first[first.len() - 1]);
    let elsewhere = spin.replace("[0, 0]", "[0.1, 0]");
    fs::write(folder.path().join("scene.toml"), format!("{PENDULUM}{elsewhere}")).expect("a folder");
    let output = ancf(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&output), 2);
    assert!(stderr(&output).contains("moves what a support holds"), "{}", stderr(&output));
}

/// A velocity given by points turns no section that a clamp holds; a polynomial is what it is, and
/// may be refused.
#[test]
fn velocities_along_a_clamped_beam() {
    let clamped =
        PENDULUM.replace("\"2.5 s\"", "\"10 ms\"").replace("[\"x\", \"y\"]", "[\"x\", \"y\", \"angle\"]");
    for (field, admissible) in [
        ("table = { s = [0, 0.9, 1.8], vy = [0, \"25 cm/s\", 1] }", true),
        ("table = { s = [0, 0.9, 1.8], vy = [0.1, \"25 cm/s\", 1] }", false),
        ("polynomial = { vy = [0, 0, 0.3] }", true),
        ("polynomial = { vy = [0, 0.5] }", false),
    ] {
        let folder = folder(&format!("{clamped}\n[[initial_velocity]]\nbeam = \"arm\"\n{field}\n"));
        let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
        assert_eq!(status(&output), if admissible { 0 } else { 2 }, "{field}: {}", stderr(&output));
        assert_eq!(stderr(&output).contains("moves what a support holds"), !admissible, "{field}");
    }
}

/// A step in which the beam would turn by half a radian or more cannot be solved as a whole; it is
/// divided, and said so.
#[test]
fn a_step_that_cannot_be_solved_is_divided() {
    let scene = PENDULUM.replace("\"1 ms\"", "\"100 ms\"").replace("10 ms", "100 ms");
    let folder = folder(&scene);
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("the step was divided"), "{}", stderr(&output));
    let drift = summary(folder.path(), "out")["energy"]["drift"].as_f64().expect("a number");
    assert!(drift < 1.0, "the energy stays bounded: {drift}");
}

/// No step is short enough for a weight that overflows: the message says when and where, and
/// nothing is left behind.
#[test]
fn a_motion_that_cannot_start_says_when_and_where() {
    let folder = folder(&PENDULUM.replace("-9.81", "-1e305"));
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    for part in ["t = 0.000000 s", "is not finite", "of beam `arm`", "tolerance"] {
        assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
    }
    assert!(!folder.path().join("out").exists(), "nothing was computed");
}
