//! What a change of the solver would shift without breaking a tolerance: what is built for each case's scenes, and how
//! much work they take. Accept a wanted change with `cargo insta review`.

use ancf::run::{Control, inspect, run};
use ancf::scene::Scene;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Every scene of the verification cases, by `case/file`.
fn scenes() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("verification/cases");
    let mut scenes = Vec::new();
    for case in std::fs::read_dir(root).expect("the cases").flatten() {
        for file in std::fs::read_dir(case.path()).expect("a case is a folder").flatten() {
            let path = file.path();
            let is_scene = path.extension().is_some_and(|e| e == "toml") && file.file_name() != "case.toml";
            if is_scene {
                let name = format!("{}/{}", case.file_name().display(), file.file_name().display());
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
        let inventory = inspect(scene.model(), scene.analysis()).expect("a case's scene can be built");
        writeln!(text, "{name}\n{inventory}\n").expect("text takes text");
    }
    snapshot("inventories", &text);
}

/// Counts, not clocks. They depend on decisions of the step control alone, which round-off hardly ever turns.
#[test]
fn regress_statistics() {
    let mut text = String::new();
    for (name, path) in scenes() {
        let scene = Scene::load(&path, &[]).expect("a case's scene is legal");
        let trajectory = run(scene.model(), scene.analysis(), &mut |_| Control::Continue);
        let trajectory = trajectory.expect("a case's scene can be solved");
        let s = trajectory.statistics;
        writeln!(
            text,
            "{name}: {} unknowns, {} steps, {} rejected, {} Newton iterations, {} residuals, {} tangents, {} factorisations, {} warnings",
            trajectory.degrees_of_freedom,
            s.steps,
            s.rejected_steps,
            s.newton_iterations,
            s.residual_evaluations,
            s.tangent_evaluations,
            s.factorizations,
            trajectory.warnings.len(),
        )
        .expect("text takes text");
    }
    snapshot("statistics", &text);
}
