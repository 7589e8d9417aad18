//! Tables of many runs: `sweep.csv` and `cost.csv` against closed forms and single runs.

use super::covered::{is_listed, listed};
use super::{column, header, near};
use crate::cli::commands::{ancf, folder, status, stderr};
use std::path::Path;

fn numbers(path: &Path, name: &str) -> Vec<f64> {
    column(path, name).iter().map(|cell| cell.parse().unwrap_or_else(|_| panic!("{name}: {cell}"))).collect()
}

const BAR: &str = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 1 }
support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
effect.force = [{ beam = 'bar', at = 'end', value = [0.1, 0] }]
probe = [{ name = 'end', beam = 'bar', at = 'end' }]
analysis.static = {}
";

/// Would catch values of a range that are rounded, a logarithmic range that is even, results in
/// another run's row, and columns with another's results.
#[test]
fn a_sweep_runs_what_its_range_says() {
    let folder = folder(BAR);
    let sweep = |values: &str, name: &str| {
        let vary = format!("effect.force.0.value.0={values}");
        let output = ancf(folder.path(), &["sweep", "scene.toml", "--vary", &vary, "-o", name]);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        folder.path().join(name).join("sweep.csv")
    };
    let even = sweep("0:0.1:8", "even");
    let found = [numbers(&even, "effect.force.0.value.0"), numbers(&even, "probes.end.strain")];
    for i in 0..8 {
        // EA = 1 N: the strain is the force.
        for values in &found {
            near(values[i], 0.1 * i as f64 / 7.0, 1e-14, "evenly spaced");
        }
    }
    let steps = sweep("1e-4:1e-2:4:log", "log");
    let strains = numbers(&steps, "probes.end.strain");
    for (i, strain) in strains.iter().enumerate() {
        near(strain / 1e-4_f64, 100.0_f64.powf(i as f64 / 3.0), 1e-9, "logarithmically spaced");
    }
    // All columns of a row are those of the single run.
    let set = format!("effect.force.0.value.0={}", column(&even, "effect.force.0.value.0")[3]);
    let single = ancf(folder.path(), &["run", "scene.toml", "--set", &set, "--json", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_slice(&single.stdout).expect("JSON");
    let names = header(&even);
    // What is not of the summary, and not what varies, is the sweep's own.
    let said = listed("summary.json");
    let plain = names.iter().map(|name| name.replace("probes.end.", "probes."));
    is_listed("sweep.csv", plain.filter(|name| !said.contains(name) && !name.starts_with("effect.")));
    let mut compared = 0;
    for name in &names {
        let cell = &column(&even, name)[3];
        match (name.as_str(), summary.pointer(&format!("/{}", name.replace('.', "/")))) {
            ("run", _) => assert_eq!(cell, "4"),
            ("outcome", _) => assert_eq!(cell, "solved"),
            ("message", _) => assert_eq!(cell, ""),
            ("seconds", _) => {
                assert!(cell.parse::<f64>().is_ok_and(|seconds| seconds > 0.0 && seconds < 60.0))
            }
            ("effect.force.0.value.0", _) => {}
            (_, Some(serde_json::Value::Number(value))) => {
                assert_eq!(cell.parse::<f64>().ok(), value.as_f64(), "{name}");
                compared += 1;
            }
            (_, Some(serde_json::Value::String(value))) => assert_eq!(cell, value, "{name}"),
            (_, Some(serde_json::Value::Bool(value))) => assert_eq!(cell, &value.to_string(), "{name}"),
            (_, Some(serde_json::Value::Null)) => assert_eq!(cell, "", "{name}"),
            (_, value) => panic!("{name}: {cell}, and {value:?} by itself"),
        }
    }
    assert!(compared > 15, "{compared} of {names:?}");
}

/// Cubic elements under an even load are exact at their nodes, and in between miss by a bubble, q
/// h⁴/384 EI in the middle. Their curvature is the straight line that is nearest to the parabola q
/// t²/2 EI, so that its root mean square error is q h²/2 EI √180, and their energy misses
/// (h/L)⁴/36.
///
/// Would catch an error of the curvature without its root, one in metres and not in lengths, a
/// relative error that is none, and counts of another setting.
#[test]
fn what_a_setting_errs_by_is_known_by_hand() {
    // q L³/EI = 0.01, L = 2 m, two elements; the probe is in the middle of the first one.
    let scene = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1e5, bending_stiffness = 10, basis.ancf.elements = 2 }
support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
effect.distributed_force = [{ beam = 'arm', value = [0, 0.0125] }]
probe = [{ name = 'middle', beam = 'arm', at = 0.5 }]
analysis.static = {}
";
    let folder = folder(scene);
    let arguments = ["cost", "scene.toml", "--target", "1e-6", "--budget", "15 s", "-o", "cost", "--quiet"];
    let output = ancf(folder.path(), &arguments);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let path = folder.path().join("cost/cost.csv");
    is_listed("cost.csv", header(&path).into_iter());
    let rows = |name: &str| column(&path, name);
    let values = |name: &str| numbers(&path, name);
    let scene =
        rows("discretization").iter().position(|name| name == "as the scene is").expect("the scene itself");
    let (cells, solver) = (rows("cells"), rows("solver"));
    assert_eq!((cells[scene].as_str(), solver[scene].as_str()), ("2", "as the scene is"));
    let single = ancf(folder.path(), &["run", "scene.toml", "--json", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_slice(&single.stdout).expect("JSON");
    for (name, pointer) in [
        ("degrees_of_freedom", "/degrees_of_freedom"),
        ("tangent_evaluations", "/statistics/tangent_evaluations"),
        ("factorizations", "/statistics/factorizations"),
        ("residual_evaluations", "/statistics/residual_evaluations"),
        ("newton_iterations", "/statistics/newton_iterations"),
        ("steps", "/statistics/load_steps"),
    ] {
        assert_eq!(
            values(name)[scene],
            summary.pointer(pointer).and_then(|v| v.as_f64()).expect("a count"),
            "{name}"
        );
    }
    // Three nodes with four coordinates each, three of which the clamp holds.
    assert_eq!(values("degrees_of_freedom")[scene], 9.0);
    let bubble = 0.0125 / (384.0 * 10.0) / 2.0;
    near(values("error")[scene] / bubble, 1.0, 0.03, "error");
    near(values("energy_error")[scene] * 576.0, 1.0, 0.03, "energy_error");
    let json: serde_json::Value = serde_json::from_str(
        &std::fs::read_to_string(folder.path().join("cost/cost.json")).expect("a report"),
    )
    .expect("JSON");
    let uncertainty = json["uncertainty"]["error"].as_f64().expect("an uncertainty");
    let (errors, seconds, runs) = (values("error"), values("seconds"), values("runs"));
    let mut seen = 0;
    for (i, kind) in rows("discretization").iter().enumerate() {
        if kind.starts_with("ANCF") || i == scene {
            let n: f64 = cells[i].parse().expect("a count");
            // Of 201 places, which lie unevenly about the ends of elements.
            near(
                values("curvature_error")[i] * n * n * 180.0_f64.sqrt(),
                1.0,
                0.06 + 0.004 * n,
                &format!("{kind}, {n} cells"),
            );
            seen += 1;
        }
        assert!(runs[i] >= 1.0 && seconds[i] > 0.0 && seconds[i] < 15.0);
        assert_eq!(rows("below_uncertainty")[i], (errors[i] < uncertainty).to_string(), "{kind}");
        let warned = json["trials"][i]["warnings"].as_array().is_some_and(|w| !w.is_empty());
        let meets = !warned && errors[i] + uncertainty <= 1e-6;
        assert_eq!(rows("meets_target")[i], meets.to_string(), "{kind}: {} and {uncertainty}", errors[i]);
        let beaten = (0..errors.len()).any(|j| seconds[j] < seconds[i] && errors[j] < errors[i]);
        assert!(!(beaten && rows("front")[i] == "true"), "{kind} is beaten");
    }
    assert!(seen > 2, "{seen} settings of cubic elements");
    assert!(rows("front").iter().any(|front| front == "true"));
}

/// Lines that others compute are recorded once each, whatever comes twice, and the table is that of a
/// sweep in one process; what is no line of this sweep is refused.
#[test]
fn lines_of_runs_are_recorded_once() {
    use ancf::sweep::{Axis, Grid, Lines, Recorder, Runs, Shard, SweepError, merge};
    let scene = ancf::scene::parse("scene.toml", BAR).expect("a scene");
    let axis = |values: &[&str]| Axis {
        paths: vec!["effect.force.0.value.0".into()],
        values: values.iter().map(|value| vec![(*value).to_owned()]).collect(),
        lines: Lines::default(),
    };
    let runs = |values: &[&str]| Runs::new(scene.clone(), Grid::new(vec![axis(values)]).expect("a grid"));
    let five = runs(&["0.01", "0.02", "0.03", "0.04", "0.05"]);
    five.check().expect("legal");
    let folder = tempfile::tempdir().expect("a folder");
    let mut recorder = Recorder::open(&five, folder.path(), Shard::WHOLE).expect("a journal");
    assert_eq!(recorder.missing(), [1, 2, 3, 4, 5]);
    assert!(recorder.enter(&five.line(4)).expect("new") && recorder.enter(&five.line(2)).expect("new"));
    assert!(!recorder.enter(&five.line(4)).expect("known"));
    assert_eq!(recorder.missing(), [1, 3, 5]);
    for wrong in [
        "",
        "{}",
        &five.line(4).replace("\"run\":4", "\"run\":6"),
        &five.line(4).replace("\"run\":4", "\"run\":0"),
    ] {
        assert!(matches!(recorder.enter(wrong), Err(SweepError::Journal { .. })), "{wrong}");
    }
    assert!(matches!(merge(folder.path()), Err(SweepError::Missing { count: 3, runs: 5, .. })));
    drop(recorder);
    // Another process goes on; another sweep does not.
    let other = Recorder::open(&runs(&["1"]), folder.path(), Shard::WHOLE);
    assert!(matches!(other, Err(SweepError::Another { .. })), "{other:?}");
    let mut recorder = Recorder::open(&five, folder.path(), Shard::WHOLE).expect("a journal");
    for run in recorder.missing() {
        assert!(recorder.enter(&five.line(run)).expect("new"));
    }
    let merged = merge(folder.path()).expect("complete");
    assert_eq!((merged.runs, merged.unsolved.len()), (5, 0));
    let strains = numbers(&merged.table, "probes.end.strain");
    for (index, strain) in strains.iter().enumerate() {
        near(*strain, 0.01 * (index as f64 + 1.0), 1e-14, "the strain is the force");
    }
    let illegal = runs(&["0.1", "2 m"]).check().expect_err("a length").to_string();
    assert!(illegal.contains("effect.force.0.value.0=2 m"), "{illegal}");
}
