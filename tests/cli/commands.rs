//! The program as people call it: exit status, what goes to which stream, what is left on disk.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

pub(crate) const ROLL_UP: &str = include_str!("../scenes/roll-up-ancf.toml");

/// A folder with `scene.toml` in it.
pub(crate) fn folder(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    folder
}

pub(crate) fn ancf(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ancf")).current_dir(folder).args(arguments).output().unwrap()
}

pub(crate) fn status(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("killed: {}", stderr(output)))
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub(crate) fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn run_writes_its_results_and_says_where() {
    let folder = folder(ROLL_UP);
    let output = ancf(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert!(output.stdout.is_empty());
    assert!(folder.path().join("out/scene/summary.json").is_file());
    let text = stderr(&output);
    for part in ["Roll-up, ANCF, 4 nodes", "tip", "energy", "unknowns", "Newton iterations", "report.html"] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn json_goes_to_standard_output_and_quiet_is_quiet() {
    let folder = folder(ROLL_UP);
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "a/b", "--json", "--quiet"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["title"], "Roll-up, ANCF, 4 nodes");
    assert_eq!(stderr(&output).lines().filter(|line| !line.starts_with("warning: ")).count(), 0);
    assert!(folder.path().join("a/b/summary.json").is_file());
}

#[test]
fn a_wrong_scene_ends_with_2_and_writes_nothing() {
    let folder = folder(&ROLL_UP.replace("elements = 3 ", "elemnts = 3 "));
    for command in ["run", "check", "inspect"] {
        let output = ancf(folder.path(), &[command, "scene.toml"]);
        assert_eq!(status(&output), 2, "{command}");
        assert!(output.stdout.is_empty());
        let text = stderr(&output);
        assert!(text.contains("scene.toml:14:1: unknown key `elemnts`"), "{text}");
        assert!(text.contains("did you mean `elements`?"), "{text}");
        assert_eq!(entries(folder.path()), ["scene.toml"]);
    }
}

#[test]
fn a_wrong_override_ends_with_2() {
    let folder = folder(ROLL_UP);
    let output =
        ancf(folder.path(), &["run", "scene.toml", "--set", "beam.cantilever.basis.ancf.elements=0"]);
    assert_eq!(status(&output), 2);
    assert!(stderr(&output).contains("in the override `beam.cantilever.basis.ancf.elements=0`"));
    assert_eq!(entries(folder.path()), ["scene.toml"]);
}

/// A file that is no TOML is at fault, and not what is set in it.
#[test]
fn a_broken_file_is_told_before_its_overrides() {
    let folder = folder(&ROLL_UP.replace("elements = 3 ", "elements = = 3 "));
    let set = "beam.cantilever.basis.ancf.elements=4";
    let [plain, with] = [&[][..], &["--set", set]].map(|more| {
        let output = ancf(folder.path(), &[&["run", "scene.toml"], more].concat());
        assert_eq!(status(&output), 2, "{}", stderr(&output));
        stderr(&output)
    });
    assert!(plain.contains("scene.toml:14:12: "), "{plain}");
    assert_eq!(plain, with);
}

/// Why stages end early stands beside the results of the last.
#[test]
fn a_stage_that_fails_is_told_in_its_own_results() {
    // A bar that is pushed flat, in the end by more than it resists.
    let text = "beam.bar = { start = [0, 0], end = [1, 0.3], axial_stiffness = 1e4, bending_stiffness = 1e3, basis.ancf.elements = 2 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }, { beam = 'bar', at = 'end', fix = ['x'] }]
        effect.force = [{ beam = 'bar', at = 'end', value = [0, -1] }, { beam = 'bar', at = 'end', value = [0, -100], stage = 'three' }]
        stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = {} }, { name = 'three', analysis.static = {} }]";
    let folder = folder(text);
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let told = |stage: &str| {
        let summary = fs::read_to_string(folder.path().join("out").join(stage).join("summary.json")).unwrap();
        summary.contains("stage `three`")
    };
    // What the third has reached is written, too.
    assert_eq!(["one", "two", "three"].map(told), [false, false, true], "{}", stderr(&output));
    let is_complete = |out: &str| {
        let all = fs::read_to_string(folder.path().join(out).join("summary.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&all).unwrap()["complete"].clone()
    };
    assert_eq!(is_complete("out"), false);
    let less = "effect.force.1.value=[0, -1]";
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "less", "--set", less]);
    assert_eq!((status(&output), is_complete("less")), (0, true.into()), "{}", stderr(&output));
}

#[test]
fn an_unwritable_destination_ends_with_2_before_solving() {
    let folder = folder(ROLL_UP);
    fs::write(folder.path().join("occupied"), "a file").unwrap();
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "occupied/results"]);
    assert_eq!(status(&output), 2, "{}", stderr(&output));
    for part in
        ["cannot write results into occupied/results", "give a directory that can be written with `-o DIR`"]
    {
        assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
    }
    assert_eq!(entries(folder.path()), ["occupied", "scene.toml"]);
}

#[test]
fn a_run_that_computed_nothing_leaves_no_directory() {
    // Standing on its clamp it buckles under its weight, so that it has no vibrations.
    let modal = include_str!("../scenes/modal.toml");
    let folder =
        folder(&format!("{modal}\nabout = \"equilibrium\"\n[effect.gravity]\nacceleration = [-300, 0]\n"));
    let output = ancf(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).starts_with("error: scene.toml: "), "{}", stderr(&output));
    assert_eq!(entries(folder.path()), ["scene.toml"]);
}

/// Frequencies of zero are named as such, and those about an equilibrium come with the equilibrium.
#[test]
fn modal_results_say_what_they_are() {
    let modal = include_str!("../scenes/modal.toml");
    let free = folder(&modal.replace(r#"fix = ["x", "y", "angle"]"#, r#"fix = ["x", "y"]"#));
    let output = ancf(free.path(), &["run", "scene.toml", "--json"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let frequencies = summary["frequencies"].as_array().unwrap();
    assert_eq!((frequencies.len(), frequencies[0].as_f64()), (5, Some(0.0)));
    assert!(stderr(&output).contains("frequency 1  0 Hz (nothing resists)"), "{}", stderr(&output));
    assert!(!free.path().join("out/scene/probes.csv").exists());
    let output = ancf(free.path(), &["check", "scene.toml", "--set", "analysis.modal.about=\"equilibrium\""]);
    assert_eq!(status(&output), 2);
    assert!(stderr(&output).contains("an equilibrium needs every rigid motion held"), "{}", stderr(&output));
    let page = fs::read_to_string(free.path().join("out/scene/report.html")).unwrap();
    assert!(page.contains("the stress-free state") && page.contains("0 (nothing resists)"));

    let loaded = folder(&format!(
        "{modal}\nabout = \"equilibrium\"\n[[probe]]\nname = \"tip\"\nbeam = \"cantilever\"\nat = \"end\"\n\
         [effect.gravity]\nacceleration = [9.81, 0.0]\n"
    ));
    let output = ancf(loaded.path(), &["run", "scene.toml", "--json"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["last"], 1.0);
    assert!(summary["probes"]["tip"]["x"].as_f64().unwrap() > 1.8, "stretched by its weight");
    let energies = fs::read_to_string(loaded.path().join("out/scene/energy.csv")).unwrap();
    assert!(energies.starts_with("load,stretch") && energies.lines().count() == 2, "{energies}");
    let page = fs::read_to_string(loaded.path().join("out/scene/report.html")).unwrap();
    assert!(page.contains("the equilibrium under all loads") && page.contains("Dashed: the equilibrium"));

    let output =
        ancf(loaded.path(), &["run", "scene.toml", "--set", "effect.gravity.acceleration=[-300, 0]"]);
    assert_eq!(status(&output), 1);
    assert!(
        stderr(&output).contains("unstable (1 negative eigenvalue of the tangent)"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn check_tells_all_that_is_wrong() {
    let folder = folder(ROLL_UP);
    fs::write(folder.path().join("bad.toml"), "nonsense = 1").unwrap();
    let output = ancf(folder.path(), &["check", "scene.toml"]);
    assert_eq!((status(&output), stderr(&output).as_str()), (0, "scene.toml: ok\n"));
    let output = ancf(folder.path(), &["check", "bad.toml", "scene.toml", "absent.toml"]);
    assert_eq!(status(&output), 2);
    let text = stderr(&output);
    for part in
        ["scene.toml: ok", "bad.toml:1:1: unknown key `nonsense`", "absent.toml: cannot read the scene"]
    {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert_eq!(entries(folder.path()), ["bad.toml", "scene.toml"]);
}

/// Wrong input weighs more than memory that is not there, whichever comes first.
#[cfg(target_os = "linux")]
#[test]
fn the_worst_failure_is_the_exit_status() {
    let folder = folder(&ROLL_UP.replace("elements = 3 ", "elements = 5_000_000 "));
    fs::write(folder.path().join("bad.toml"), "nonsense = 1").unwrap();
    for scenes in ["scene.toml bad.toml", "bad.toml scene.toml"] {
        let line = format!("ulimit -v 2000000; exec {} check {scenes}", env!("CARGO_BIN_EXE_ancf"));
        let output = Command::new("sh").current_dir(folder.path()).args(["-c", &line]).output().unwrap();
        assert_eq!(status(&output), 2, "{}", stderr(&output));
        for part in ["GiB of memory, and", "bad.toml:1:1: unknown key `nonsense`"] {
            assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
        }
    }
}

#[test]
fn inspect_and_schema_print() {
    let folder = folder(ROLL_UP);
    let output = ancf(folder.path(), &["inspect", "scene.toml", "--json"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let inventory: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(inventory["degrees_of_freedom"], 12);
    let output = ancf(folder.path(), &["inspect", "scene.toml"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("cantilever"));
    let output = ancf(folder.path(), &["schema"]);
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap(), ancf::scene::schema());
}

/// A reader that has left, as `head` does, is no failure; a disk that is full is one.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_takes_nothing() {
    use std::process::Stdio;
    let folder = folder(ROLL_UP);
    let schema = |out: Stdio| {
        let child = Command::new(env!("CARGO_BIN_EXE_ancf"))
            .current_dir(folder.path())
            .arg("schema")
            .stdout(out)
            .stderr(Stdio::piped())
            .spawn();
        child.unwrap().wait_with_output().unwrap()
    };
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = schema(writer.into());
    assert_eq!((status(&output), stderr(&output).as_str()), (0, ""));
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = schema(full.into());
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).starts_with("error: cannot write to standard output: "), "{}", stderr(&output));
}

#[test]
fn wrong_usage_ends_with_2() {
    let folder = folder(ROLL_UP);
    for arguments in [&[][..], &["fly"], &["run"], &["check"], &["run", "scene.toml", "--fast"]] {
        assert_eq!(status(&ancf(folder.path(), arguments)), 2, "{arguments:?}");
    }
}
