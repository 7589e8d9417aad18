//! What a change of the solver would shift without breaking a tolerance: what is built for each
//! case's scenes, and how much work they take. Accept a wanted change with `cargo insta review`.

mod searches;

use ancf::results::Results;
use ancf::run::{Options, inspect, inspect_stages, solve_stages};
use ancf::scene::Scene;
use ancf_check::Suite;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The scenes of the verification cases, by `case/file`; not of those that take minutes.
fn scenes() -> Vec<(String, PathBuf)> {
    let suite = Suite::here();
    let mut scenes = Vec::new();
    for case in suite.names().expect("the cases") {
        if suite.case(&case).expect("a legal case").text.nightly {
            continue;
        }
        for file in std::fs::read_dir(suite.cases_folder().join(&case)).expect("a case is a folder").flatten()
        {
            let path = file.path();
            let is_scene = path.extension().is_some_and(|e| e == "toml") && file.file_name() != "case.toml";
            if is_scene {
                let name = format!("{case}/{}", file.file_name().display());
                scenes.push((name, path));
            }
        }
    }
    scenes.sort();
    scenes
}

fn snapshot(name: &str, text: &str) {
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!(name, text);
    });
}

#[test]
fn regress_inventories() {
    let mut text = String::new();
    for (name, path) in scenes() {
        let scene = Scene::load(&path, &[]).expect("a case's scene is legal");
        if scene.stages().is_empty() {
            let inventory = inspect(scene.model(), scene.analysis()).expect("a case's scene can be built");
            writeln!(text, "{name}\n{inventory}\n").expect("text takes text");
        }
        for (stage, inventory) in inspect_stages(scene.stages(), inspect).expect("stages that can be built") {
            writeln!(text, "{name} {stage}\n{inventory}\n").expect("text takes text");
        }
    }
    snapshot("inventories", &text);
}

/// Counts, not clocks, which depend on decisions of the step control alone, and round-off hardly
/// ever turns those; and what the runs find, to ten digits.
#[test]
fn regress_statistics_and_results() {
    let (mut counts, mut results) = (String::new(), String::new());
    for (name, path) in scenes() {
        let scene = Scene::load(&path, &[]).expect("a case's scene is legal");
        let mut solved = Vec::new();
        if scene.stages().is_empty() {
            let alone = scene.model().solve(scene.analysis());
            solved.push((name, alone.expect("a case's scene can be solved")));
        } else {
            let run = solve_stages(scene.stages(), Options::default());
            assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
            let names = scene.stages().iter().map(|stage| format!("{name} {}", stage.name));
            solved.extend(names.zip(run.results));
        }
        for (name, solved) in solved {
            let s = solved.run().statistics;
            writeln!(
                counts,
                "{name}: {} unknowns, {} steps, {} rejected, {} Newton iterations, {} residuals, {} tangents, {} factorisations, {} warnings",
                solved.run().degrees_of_freedom,
                s.steps,
                s.rejected_steps,
                s.newton_iterations,
                s.residual_evaluations,
                s.tangent_evaluations,
                s.factorizations,
                solved.run().warnings.len(),
            )
            .expect("text takes text");
            results.push_str(&found(&name, &solved));
        }
    }
    snapshot("statistics", &counts);
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots/results.snap");
    let stored = std::fs::read_to_string(stored).unwrap_or_default();
    // After the header, which ends with the second line of dashes.
    let stored = stored.splitn(3, "---\n").nth(2).unwrap_or_default();
    // Asserted in either case: a snapshot that no test asserts is refused by
    // `cargo insta test --unreferenced=reject`.
    snapshot("results", if agree(stored, &results) { stored } else { &results });
}

/// What a stated accuracy takes, by every method: error estimates and tolerances of iterations that
/// were off by some factor would show nowhere else.
#[test]
fn regress_work_for_a_tolerance() {
    let pendulum = Suite::here().cases_folder().join("soft-pendulum/scene.toml");
    let mut text = String::new();
    for method in [
        "generalized_alpha={spectral_radius=1.0,TOL}",
        "generalized_alpha={spectral_radius=0.8,TOL}",
        "gauss={stages=1,TOL}",
        "gauss={stages=2,TOL}",
        "gauss={stages=3,TOL}",
        "radau={stages=2,TOL}",
        "radau={stages=3,TOL}",
    ] {
        for tolerance in ["tolerance=1e-3", "tolerance=1e-5"] {
            let method = method.replace("TOL", tolerance);
            let analysis = format!("analysis.dynamic={{duration='0.4 s',output_every='0.4 s',{method}}}");
            let set = ["beam.arm.basis={ancf={elements=12}}".to_owned(), analysis];
            let scene = Scene::load(&pendulum, &set).expect("a legal scene");
            let trajectory = scene.model().solve(scene.analysis()).expect("a motion");
            let s = trajectory.run().statistics;
            writeln!(
                text,
                "{method}: {} steps, {} rejected, {} iterations",
                s.steps, s.rejected_steps, s.newton_iterations
            )
            .expect("text takes text");
        }
    }
    snapshot("work_for_a_tolerance", &text);
}

/// Last positions of the probes, energies, frequencies, critical loads.
fn found(name: &str, results: &Results) -> String {
    let trajectory = results.states();
    let mut lines = vec![name.to_owned()];
    let mut line = |what: &str, numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(|v| format!("{v:.9e}")).collect();
        lines.push(format!("  {what} {}", numbers.join(" ")));
    };
    for probe in &trajectory.probes {
        if let Some(last) = probe.samples.last() {
            line(&probe.name, &[last.x, last.y]);
        }
    }
    if let Some(e) = trajectory.energy.last() {
        line("energy", &[e.stretch, e.bend, e.kinetic, e.potential]);
    }
    let eigenvalues = results.eigenvalues();
    if !eigenvalues.is_empty() {
        line(if matches!(results, Results::Vibrations(_)) { "frequencies" } else { "loads" }, &eigenvalues);
    }
    lines.join("\n") + "\n\n"
}

/// Another machine rounds otherwise; a motion of thousands of steps carries that to so many parts
/// of the largest number in a line, or of 1 where all are smaller: what is zero but for round-off
/// has no digits to compare.
const ROUND_OFF: f64 = 1e-8;

fn agree(stored: &str, now: &str) -> bool {
    let lines = |text: &str| text.trim().lines().map(str::to_owned).collect::<Vec<_>>();
    let (stored, now) = (lines(stored), lines(now));
    stored.len() == now.len()
        && stored.iter().zip(&now).all(|(stored, now)| {
            let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
            let (stored, now) = (words(stored), words(now));
            let number = |word: &String| word.parse::<f64>().ok();
            let scale = stored.iter().filter_map(number).fold(1.0_f64, |m, v| m.max(v.abs()));
            stored.len() == now.len()
                && stored.iter().zip(&now).all(|(a, b)| match (number(a), number(b)) {
                    (Some(a), Some(b)) => (a - b).abs() <= ROUND_OFF * scale,
                    _ => a == b,
                })
        })
}

#[test]
fn the_comparison_of_results_sees_a_lost_digit() {
    let stored = "scene\n  tip 1.234567890e0 -2.000000000e-3\n";
    assert!(agree(stored, "scene\n  tip 1.234567891e0 -2.000000001e-3\n"));
    assert!(!agree(stored, "scene\n  tip 1.234567990e0 -2.000000000e-3\n"));
    assert!(!agree(stored, "scene\n  tip 1.234567890e0 -2.000100000e-3\n"));
    assert!(!agree(stored, "scene\n  end 1.234567890e0 -2.000000000e-3\n"));
    assert!(!agree(stored, "scene\n"));
}
