//! What accuracy costs: settings are measured against a reference, and the cheapest one that is
//! good enough is a scene.

use super::commands::{ROLL_UP, ancf, entries, folder, status, stderr};
use super::output::elements;
use ancf::cost::{
    Best, Deviation, Family, LeftOut, Measured, Options, Reference, Setting, Solver, Study, Trial,
};
use ancf::model::{Integrator, StepControl};
use ancf::results::{AnalysisKind, Run, Statistics, Trajectory};
use std::fs;
use std::time::Duration;

const MODAL: &str = include_str!("../scenes/modal.toml");
const FILES: [&str; 6] = ["best.toml", "cost-work.svg", "cost.csv", "cost.html", "cost.json", "cost.svg"];

#[test]
fn errors_fall_with_the_mesh_and_the_cheapest_setting_is_a_scene() {
    let folder = folder(ROLL_UP);
    let folder = folder.path();
    let output = ancf(folder, &["cost", "scene.toml", "--target", "1e-3", "--budget", "30 s", "--json"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert_eq!(entries(&folder.join("out/scene")), FILES);
    let text = stderr(&output);
    for part in
        ["Roll-up, ANCF, 4 nodes", "uncertainty of the reference", "best.toml", "[beam.cantilever.basis."]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let uncertainty = printed["uncertainty"]["error"].as_f64().unwrap();
    assert!(uncertainty > 0.0 && uncertainty <= 1e-4, "{uncertainty}");

    // Cable elements of fourth order, 4 to 16 of them.
    let mut rows = csv::Reader::from_path(folder.join("out/scene/cost.csv")).unwrap();
    let column = |rows: &mut csv::Reader<fs::File>, name: &str| {
        rows.headers().unwrap().iter().position(|header| header == name).unwrap()
    };
    let [kind, cells, solver, error, curvature, energy] =
        ["discretization", "cells", "solver", "error", "curvature_error", "energy_error"]
            .map(|n| column(&mut rows, n));
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let of = |count: &str, column: usize| {
        let row = rows.iter().find(|row| {
            &row[kind] == "ANCF, 3L/2 points" && &row[cells] == count && &row[solver] == "as the scene is"
        });
        row.unwrap()[column].parse::<f64>().unwrap()
    };
    for column in [error, curvature, energy] {
        let errors = ["4", "8", "16"].map(|count| of(count, column));
        assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?}");
    }

    let best = ["out/scene/best.toml"];
    assert_eq!(status(&ancf(folder, &["check", best[0]])), 0);
    let solved = ancf(folder, &["run", best[0], "--json", "--quiet"]);
    let solved: serde_json::Value = serde_json::from_slice(&solved.stdout).unwrap();
    let [x, y] = ["/probes/tip/x", "/probes/tip/y"].map(|at| solved.pointer(at).unwrap().as_f64().unwrap());
    // The exact tip of a full circle, but for the stretch of the beam, is at the clamp.
    assert!(x.hypot(y) < 2e-3 * 1.8, "{x} {y}");
    // What is pasted is what is in the scene.
    let (lines, scene) =
        (printed["lines"].as_str().unwrap(), fs::read_to_string(folder.join(best[0])).unwrap());
    assert!(lines.lines().all(|line| scene.contains(line)), "{lines}\n{scene}");
}

#[test]
fn frequencies_have_a_price_too() {
    let folder = folder(MODAL);
    let arguments =
        ["cost", "scene.toml", "--target", "1e-3", "--budget", "20s", "-o", "modal", "--quiet", "--json"];
    let output = ancf(folder.path(), &arguments);
    assert_eq!((status(&output), stderr(&output).as_str()), (0, ""));
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed["error"], "relative error of frequencies");
    let best = &printed["trials"][printed["best"].as_u64().unwrap() as usize];
    assert!(best["deviation"]["error"].as_f64().unwrap() <= 1e-3);
    assert_eq!(status(&ancf(folder.path(), &["check", "modal/best.toml"])), 0);
}

#[test]
fn a_reference_that_is_not_good_enough_is_not_hidden() {
    let folder = folder(ROLL_UP);
    fs::create_dir(folder.path().join("costs")).unwrap();
    fs::write(folder.path().join("costs/best.toml"), "# of an older study").unwrap();
    let output =
        ancf(folder.path(), &["cost", "scene.toml", "--target", "1e-12", "--budget", "4s", "-o", "costs"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("warning: the reference is not good enough"), "{}", stderr(&output));
    assert_eq!(entries(&folder.path().join("costs")), FILES[1..]);
}

#[test]
fn what_cannot_be_asked_for_ends_with_2_and_leaves_nothing() {
    let folder = folder(ROLL_UP);
    for (option, value, expected) in [
        ("--target", "0", "target error 0e0"),
        ("--target", "2", "target error 2e0"),
        ("--target", "NaN", "target error NaN"),
        ("--target", "small", "invalid value 'small'"),
        ("--budget", "60", "no unit"),
        ("--budget", "2 m", "dimension"),
        ("--budget", "-3s", "positive time"),
        ("--budget", "1 us", "budget of"),
        ("--set", "analysis.static.arc_length.max_points=20", "number of points"),
    ] {
        let output = ancf(folder.path(), &["cost", "scene.toml", &format!("{option}={value}")]);
        assert_eq!(status(&output), 2, "{option} {value}");
        assert!(stderr(&output).contains(expected), "{option} {value}: {}", stderr(&output));
        assert_eq!(entries(folder.path()), ["scene.toml"]);
    }
}

#[test]
fn a_scene_that_cannot_be_solved_has_no_reference() {
    // A moment that rolls the beam up into millions of turns.
    let folder = folder(&ROLL_UP.replace("312.885175 ", "1e9 "));
    let output = ancf(folder.path(), &["cost", "scene.toml", "--budget", "1s"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("no reference could be made"), "{}", stderr(&output));
    assert_eq!(entries(folder.path()), ["scene.toml"]);
}

/// A study whose numbers are made up: discretisations of every kind on three meshes, one of them
/// with other solvers, too.
fn study() -> Study {
    let scene = ancf::scene::parse("roll-up.toml", ROLL_UP).expect("a legal scene");
    let alpha = |step| Integrator::GeneralizedAlpha { step, spectral_radius: 0.9, newton_tolerance: 1e-10 };
    let solvers = [
        Solver::Scene,
        Solver::Tolerance(1e-5),
        Solver::Integrator(Integrator::Radau { stages: 3, step: StepControl::Tolerance(1e-4) }),
        Solver::Integrator(alpha(StepControl::Fixed(2e-3))),
    ];
    let mut trials = Vec::new();
    let all = Family::all();
    let families = [0, 1, 2, 3, 7, 10].map(|i| all[i]);
    for (kind, family) in std::iter::once(Family::Scene).chain(families).enumerate() {
        for (mesh, cells) in [4, 8, 16].into_iter().enumerate() {
            let many = if kind == 3 { solvers.len() } else { 1 };
            for (way, solver) in solvers[..many].iter().copied().enumerate() {
                let order = 2.0 + 0.1 * kind as f64;
                // The last digit of a power is not the same in every build.
                let error = format!("{:.6e}", 0.3 * (cells as f64).powf(-order) / (1.0 + way as f64));
                let deviation = Deviation {
                    error: error.parse().expect("a number"),
                    curvature: (kind > 0).then_some(0.5 / cells as f64),
                    energy: (kind > 1).then_some(0.25 / cells as f64),
                };
                let statistics = Statistics {
                    tangent_evaluations: 3 * (mesh + 1) + way,
                    factorizations: 5 + kind,
                    steps: 10,
                    ..Statistics::default()
                };
                let measured = Measured {
                    degrees_of_freedom: 4 * cells,
                    seconds: 1e-4 * (1.0 + 0.2 * kind as f64) * cells as f64 * (1.0 + 0.5 * way as f64),
                    runs: 3,
                    statistics,
                    deviation,
                    warnings: if kind == 5 { vec!["it is warned of".to_owned()] } else { vec![] },
                };
                trials.push(Trial { family, cells, setting: Setting { beams: vec![], solver }, measured });
            }
        }
    }
    let best = Best { trial: 7, lines: "[beam.cantilever.basis.ancf]\nelements = 8\n".to_owned(), scene };
    Study {
        options: Options { target: 2e-3, budget: Duration::from_secs(20) },
        reference: Reference {
            results: Trajectory {
                run: Run { title: "Made up".to_owned(), analysis: AnalysisKind::Static, ..Run::default() },
                ..Trajectory::default()
            }
            .into(),
            uncertainty: Deviation { error: 1.5e-4, curvature: Some(2e-3), energy: None },
            warnings: vec!["it locks".to_owned()],
            pair: ["RPIM, 32 cells".to_owned(), "ANCF, 128 cells".to_owned()],
            seconds: 1.25,
        },
        trials,
        front: vec![0, 4, 7, 12],
        best: Some(best),
        alone: None,
        left_out: ["one", "two", "three", "four"]
            .map(|what| LeftOut { what: what.to_owned(), why: "no time is left in the budget".to_owned() })
            .into(),
        complete: true,
        seconds: 17.5,
    }
}

/// Whoever changes how a study is drawn or written sees here what it changes.
#[test]
fn regress_pages_of_a_study() {
    let directory = tempfile::tempdir().expect("a directory");
    let study = study();
    ancf::cost::write(directory.path(), &study).expect("written");
    let read = |name: &str| fs::read_to_string(directory.path().join(name)).expect("a file");
    let mut text = read("cost.csv");
    for picture in ["cost.svg", "cost-work.svg"] {
        text += &format!("== {picture}\n{}", elements(&read(picture)));
    }
    let page = read("cost.html");
    for row in page.split("<tr").skip(1).map(|row| row.split("</tr>").next().unwrap_or_default()) {
        text += &format!("<tr{}\n", row.split_whitespace().collect::<Vec<_>>().join(" "));
    }
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("pages_of_a_study", text);
    });
    // Every family that was measured is in the picture.
    let families: Vec<String> = study.trials.iter().skip(3).map(|trial| trial.family.to_string()).collect();
    for kind in families.iter().map(|family| family.split(", shape").next().unwrap_or_default()) {
        assert!(read("cost.svg").contains(kind), "{kind}");
    }
}

/// A reference has to be ten times as certain as what is asked for.
#[test]
fn how_good_a_reference_must_be() {
    let told = |error: f64| {
        let mut study = study();
        study.reference.uncertainty.error = error;
        (study.reference_is_good(), study.warnings().join("; "))
    };
    assert!(told(2e-4).0 && !told(2e-4).1.contains("uncertain"));
    let (good, warning) = told(2.1e-4);
    assert!(!good && warning.contains("more than a tenth of the target"), "{warning}");
    let (good, warning) = told(2e-3);
    assert!(!good && warning.contains("not good enough"), "{warning}");
}
