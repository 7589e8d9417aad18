//! Which files of an older run go, and what is refused before any file is written.

use super::made_up::{buckling, path, rise, vibrations};
use ancf::output::{OutputError, OutputOptions, write, write_stages};
use ancf::results::{ModeShape, Results, Trajectory};
use std::fs;
use std::path::Path;

const IN_FULL: OutputOptions = OutputOptions { states: true, vtu: true };

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().display().to_string()).collect();
    names.sort();
    names
}

/// Beside a summary the names are those of an older run; without one they are the user's.
#[test]
fn files_that_no_run_has_written_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["modes.svg", "states.csv", "shape.csv"] {
        fs::write(folder.path().join(name), "mine").expect("written");
    }
    fs::create_dir(folder.path().join("vtu")).expect("made");
    fs::write(folder.path().join("vtu/state_00000.vtu"), "mine").expect("written");
    write(folder.path(), &mut rise(2).into(), &OutputOptions::default()).expect("written");
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
    for name in ["modes.svg", "states.csv", "vtu/state_00000.vtu"] {
        assert_eq!(text(name), "mine", "{name}");
    }
    // A file of the same name is replaced.
    assert!(text("shape.csv").starts_with("beam,"));
    // From now on they are an older run's.
    write(folder.path(), &mut rise(2).into(), &OutputOptions::default()).expect("written");
    for name in ["modes.svg", "states.csv", "vtu"] {
        assert!(!names(folder.path()).contains(&name.to_owned()), "{name}");
    }
}

/// Would catch files for ParaView that stay, or go, beside those of a run with fewer frames.
#[test]
fn frames_are_those_of_the_last_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = |count: usize| {
        let mut names: Vec<String> = (0..count).map(|i| format!("state_{i:05}.vtu")).collect();
        names.insert(0, "last.vtu".to_owned());
        names
    };
    for records in [4, 2, 3] {
        write(folder.path(), &mut rise(records).into(), &IN_FULL).expect("written");
        assert_eq!(names(&folder.path().join("vtu")), frames(records as usize));
        let text = fs::read_to_string(folder.path().join("states.pvd")).expect("a file");
        assert_eq!(text.matches("<DataSet").count(), records as usize);
    }
    write(folder.path(), &mut rise(3).into(), &OutputOptions::default()).expect("written");
    assert!(!names(folder.path()).iter().any(|name| name.starts_with("vtu") || name.starts_with("states")));
}

/// Would catch modes for ParaView that stay beside those of a run with fewer of them, and an index of no frames.
#[test]
fn modes_are_those_of_the_last_run() {
    let folder = tempfile::tempdir().expect("a folder");
    for count in [3, 1, 2] {
        let mut results = vibrations();
        results.modes.truncate(count);
        results.equilibrium.frames.clear();
        write(folder.path(), &mut results.into(), &IN_FULL).expect("written");
        let modes = (1..=count).map(|i| format!("mode_{i:05}.vtu"));
        let expected: Vec<String> = ["last.vtu".to_owned()].into_iter().chain(modes).collect();
        assert_eq!(names(&folder.path().join("vtu")), expected);
        let text = fs::read_to_string(folder.path().join("modes.pvd")).expect("a file");
        assert_eq!(text.matches("<DataSet").count(), count);
        assert!(!names(folder.path()).iter().any(|name| name.starts_with("states")));
    }
    write(folder.path(), &mut rise(1).into(), &IN_FULL).expect("written");
    assert_eq!(names(&folder.path().join("vtu")), ["last.vtu", "state_00000.vtu"]);
    assert!(!names(folder.path()).contains(&"modes.pvd".to_owned()));
}

/// Would catch tables that are written of nothing, and some that are not written.
#[test]
fn an_analysis_leaves_the_tables_that_belong_to_it() {
    let tables = |mut results: Results| {
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), &mut results, &OutputOptions::default()).expect("written");
        let own = names(folder.path()).into_iter().filter(|name| !name.ends_with(".svg"));
        own.filter(|name| !["report.html", "shape.csv", "summary.json"].contains(&name.as_str()))
            .collect::<Vec<_>>()
    };
    assert_eq!(tables(Trajectory::default().into()), Vec::<String>::new());
    assert_eq!(tables(rise(2).into()), ["energy.csv", "probes.csv"]);
    assert_eq!(tables(path().into()), ["effects.csv", "energy.csv", "probes.csv", "reactions.csv"]);
    assert_eq!(tables(vibrations().into()), ["energy.csv", "frequencies.csv", "modes.csv", "probes.csv"]);
    assert_eq!(tables(buckling().into()), ["load_factors.csv", "modes.csv"]);
}

/// Each list that another one does not fit is told by its name and both lengths.
#[test]
fn lists_that_do_not_fit_are_refused() {
    type Fault = fn(&mut Trajectory);
    let faults: [(Fault, &str); 9] = [
        (|t| t.energy.truncate(1), "energies: expected 4 entries, found 1"),
        (|t| t.parameter.truncate(3), "energies: expected 3 entries, found 4"),
        (|t| t.probes[1].samples.truncate(2), "samples of probe `foot`: expected 4 entries, found 2"),
        (|t| t.last[0].x.truncate(2), "values along beam `arm`: expected 3 entries, found 2"),
        (|t| t.run.undeformed[1].y.push(0.0), "values along beam `leg`: expected 2 entries, found 3"),
        (|t| t.last[0].angle.truncate(1), "values along beam `arm`: expected 3 entries, found 1"),
        (|t| t.last[1].strain.clear(), "values along beam `leg`: expected 2 entries, found 0"),
        (|t| t.last[0].axial_force.truncate(2), "values along beam `arm`: expected 3 entries, found 2"),
        (|t| t.last[0].bending_moment.push(0.0), "values along beam `arm`: expected 3 entries, found 4"),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let results = folder.path().join("results");
    for (fault, expected) in faults {
        let mut trajectory = path();
        fault(&mut trajectory);
        let error = write(&results, &mut trajectory.into(), &IN_FULL).expect_err(expected);
        assert_eq!(error.to_string(), expected);
        assert!(matches!(error, OutputError::Inconsistent { .. }));
        assert!(!results.exists(), "{expected}");
    }
    type ModeFault = fn(&mut ModeShape);
    let faults: [ModeFault; 5] = [
        |mode| mode.x.truncate(1),
        |mode| mode.y.truncate(1),
        |mode| mode.angle.truncate(1),
        |mode| mode.strain.truncate(1),
        |mode| mode.curvature.truncate(1),
    ];
    for fault in faults {
        let mut found = vibrations();
        fault(&mut found.modes[2].shape[1]);
        let error = write(&results, &mut found.into(), &IN_FULL).expect_err("too short");
        assert_eq!(error.to_string(), "values of a mode along beam `leg`: expected 2 entries, found 1");
        assert!(!results.exists());
    }
    // Shapes without section forces are whole.
    let mut trajectory = path();
    for shape in trajectory.last.iter_mut().chain(&mut trajectory.run.undeformed) {
        shape.axial_force.clear();
        shape.shear_force.clear();
        shape.bending_moment.clear();
    }
    write(&results, &mut trajectory.into(), &IN_FULL).expect("written");
    let text = fs::read_to_string(results.join("shape.csv")).expect("a file");
    assert!(text.lines().skip(1).all(|line| line.ends_with(",NaN,NaN,NaN")), "{text}");
}

/// A stage that a later run does not have leaves no folder, but files of others in it stay.
#[test]
fn folders_are_those_of_the_last_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |stages: &[&'static str]| {
        let mut results: Vec<(&str, Results)> = stages.iter().map(|name| (*name, rise(2).into())).collect();
        write_stages(folder.path(), &mut results, &IN_FULL, true).expect("written");
    };
    run(&["brace", "draw", "loose"]);
    assert_eq!(names(folder.path()), ["brace", "draw", "loose", "report.html", "summary.json"]);
    fs::write(folder.path().join("draw/notes.txt"), "mine").expect("written");
    fs::create_dir(folder.path().join("photos")).expect("made");
    run(&["brace", "let go"]);
    assert_eq!(names(folder.path()), ["brace", "draw", "let go", "photos", "report.html", "summary.json"]);
    assert_eq!(names(&folder.path().join("draw")), ["notes.txt"]);
    assert!(names(&folder.path().join("brace")).contains(&"vtu".to_owned()));
    // One analysis in place of stages, and the other way round.
    write(folder.path(), &mut rise(2).into(), &OutputOptions::default()).expect("written");
    let left = names(folder.path());
    assert!(!left.contains(&"brace".to_owned()) && left.contains(&"probes.csv".to_owned()), "{left:?}");
    run(&["brace"]);
    assert_eq!(names(folder.path()), ["brace", "draw", "photos", "report.html", "summary.json"]);
}
