//! What README and handbook print is what runs.

use super::commands::{ancf, folder, status, stderr};
use std::fs;
use std::path::Path;

/// The scenes that a document prints.
fn scenes(document: &Path) -> Vec<String> {
    let text = fs::read_to_string(document).expect("a document");
    let blocks = text.split("```toml\n").skip(1);
    blocks.map(|rest| rest.split("```").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn printed_scenes_run_as_printed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages = fs::read_dir(root.join("src/handbook")).expect("the handbook");
    let mut documents: Vec<_> = pages.map(|page| page.expect("a page").path()).collect();
    assert_eq!(documents.len(), 8);
    documents.push(root.join("README.md"));
    let mut count = 0;
    for document in documents {
        for scene in scenes(&document) {
            count += 1;
            let folder = folder(&scene);
            let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out", "--json"]);
            assert_eq!(status(&output), 0, "{}: {}", document.display(), stderr(&output));
            assert!(!stderr(&output).contains("warning"), "{}: {}", document.display(), stderr(&output));
            if document.ends_with("README.md") {
                // A full circle brings the tip back to the clamp, but for the stretch of the beam.
                let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
                let [x, y] =
                    ["/probes/tip/x", "/probes/tip/y"].map(|at| summary.pointer(at).and_then(|v| v.as_f64()));
                let apart = x.expect("x").hypot(y.expect("y"));
                assert!(apart < 1e-5 * 1.8, "{apart} m");
            }
        }
    }
    assert_eq!(
        count, 9,
        "one scene in README, one each on motion and stages, two on mechanisms, four on sections"
    );
}
