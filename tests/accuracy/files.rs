//! The errors in the files: `probes.csv`, `summary.json` and the page.

use super::{cantilever, error, run, scene};
use ancf::output::{OutputOptions, write};
use serde_json::Value;
use std::fs;

/// Writes the results of a scene and reads what it said of itself.
fn written(text: &str) -> (tempfile::TempDir, Value, ancf::results::Results) {
    let mut results = run(&scene(text));
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &mut results, &OutputOptions::default()).expect("files");
    let summary = fs::read_to_string(folder.path().join("summary.json")).expect("a summary");
    (folder, serde_json::from_str(&summary).expect("JSON"), results)
}

fn number(summary: &Value, at: &str) -> f64 {
    summary.pointer(at).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {at} in {summary}"))
}

/// A couple bends to an arc: the error that `probes.csv` and the summary have for the tip is about
/// that which it has, and the largest of the whole is no smaller.
#[test]
fn the_error_of_a_probe_is_in_the_table_and_in_the_summary() {
    let rest = "effect.moment = [{ beam = 'arm', at = 'end', value = 2.0 }]\n\
                analysis.static = { steps = 4, accuracy = { position = 1e-5, curvature = 1e-3, section_force = 1e-3 } }";
    let (folder, summary, results) = written(&cantilever(1e7, 1.0, rest));
    let tip = (2.0_f64.sin() / 2.0, (1.0 - 2.0_f64.cos()) / 2.0);
    let truth = (number(&summary, "/probes/tip/x") - tip.0).hypot(number(&summary, "/probes/tip/y") - tip.1);
    let mut table = csv::Reader::from_path(folder.path().join("probes.csv")).expect("a table");
    let at = table.headers().expect("names").iter().position(|name| name == "tip.error").expect("a column");
    let column: Vec<f64> =
        table.records().map(|row| row.expect("a row")[at].parse().expect("a number")).collect();
    let last = *column.last().expect("a row");
    assert!(truth <= 3.0 * last && truth >= 0.05 * last, "{truth:e} {last:e}");
    for quantity in ["x", "y"] {
        assert_eq!(number(&summary, &format!("/probes/tip/error/{quantity}")), last);
    }
    // Of an arc the curvature is 2 and the direction of the tip 2 rad.
    for (quantity, exact) in [("angle", 2.0), ("curvature", 2.0), ("strain", 0.0)] {
        let off = (number(&summary, &format!("/probes/tip/{quantity}")) - exact).abs();
        let estimated = number(&summary, &format!("/probes/tip/error/{quantity}"));
        assert!(off <= 5.0 * estimated + 1e-10, "{quantity}: {off:e} {estimated:e}");
    }
    assert_eq!(number(&summary, "/error/wanted"), 1e-5);
    let estimated = number(&summary, "/error/estimated");
    assert!(estimated >= last && estimated <= 1e-5, "{estimated:e} {last:e}");
    assert_eq!(summary["error"]["met"], true);
    for kind in ["curvature", "section_force"] {
        assert_eq!(number(&summary, &format!("/error/{kind}/wanted")), 1e-3);
        assert!(number(&summary, &format!("/error/{kind}/estimated")) <= 1e-3);
    }
    // The last of the runs is that of the results.
    let runs = summary["error"]["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), error(&results).runs.len());
    let last_run = runs.last().expect("a run");
    assert_eq!(last_run["degrees_of_freedom"], summary["degrees_of_freedom"]);
    assert_eq!(last_run["error"].as_f64(), Some(estimated));
    assert!(last_run["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0));
    assert!(last_run["setting"].as_str().is_some_and(|setting| setting.contains("cells")));
    let page = fs::read_to_string(folder.path().join("report.html")).expect("a page");
    assert!(page.contains("Estimated error of positions"));
    assert!(folder.path().join("chosen.toml").is_file() && folder.path().join("error.svg").is_file());
}

/// In motion velocities have errors too. Of a rod in free fall nothing errs but by round-off.
#[test]
fn velocities_have_errors() {
    let rest = "effect.gravity.acceleration = [0, -9.81]\nanalysis.dynamic = { duration = 0.2, output_every = 0.05, accuracy = 1e-4 }";
    let (_, summary, _) = written(&cantilever(1e4, 1.0, rest));
    for quantity in ["vx", "vy"] {
        let estimated = number(&summary, &format!("/probes/tip/error/{quantity}"));
        assert!(estimated > 0.0 && estimated < 0.1 * 9.81 * 0.2, "{quantity}: {estimated:e}");
    }
}

#[test]
fn frequencies_and_critical_loads_have_errors() {
    let (_, summary, _) = written(&cantilever(1e8, 1.0, "analysis.modal = { count = 2, accuracy = 1e-4 }"));
    let exact = 1.875_104_068_711_961_f64.powi(2) / std::f64::consts::TAU;
    let off = (number(&summary, "/frequencies/0") - exact).abs();
    let estimated = number(&summary, "/frequency_errors/0");
    assert!(off <= 3.0 * estimated + 1e-9 && estimated <= 1e-4 * exact, "{off:e} {estimated:e}");
    let rest = "effect.force = [{ beam = 'arm', at = 'end', value = [-1, 0] }]\nanalysis.buckling = { count = 2, accuracy = 1e-4 }";
    let (_, summary, _) = written(&cantilever(1e8, 1.0, rest));
    let exact = (std::f64::consts::PI / 2.0).powi(2);
    let off = (number(&summary, "/load_factors/0") - exact).abs();
    let estimated = number(&summary, "/load_factor_errors/0");
    assert!(off <= 3.0 * estimated + 1e-7 && estimated <= 1e-4 * exact, "{off:e} {estimated:e}");
}

/// Of a frequency that round-off hides no error is known, and none is written; one that nothing resists has none.
#[test]
fn a_hidden_frequency_has_no_error() {
    let bar = |stiffness: &str, rest: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [0, -1], {stiffness}, mass_per_length = 1 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}]\n{rest}\n"
        )
    };
    let weight = "effect.gravity.acceleration = [0, -9.81]\n\
                  analysis.modal = { count = 2, about = 'equilibrium', accuracy = 1e-3 }";
    let hidden = bar("axial_stiffness = 1e16, bending_stiffness = 1e13", weight);
    let (_, summary, _) = written(&hidden);
    assert_eq!((&summary["frequencies"][0], &summary["error"]["met"]), (&0.0.into(), &false.into()));
    assert!(summary["frequency_errors"][0].is_null(), "{}", summary["frequency_errors"]);
    let free = bar(
        "axial_stiffness = 1e6, bending_stiffness = 1e2",
        "analysis.modal = { count = 2, accuracy = 1e-3 }",
    );
    let (_, summary, _) = written(&free);
    assert_eq!((number(&summary, "/frequencies/0"), number(&summary, "/frequency_errors/0")), (0.0, 0.0));
}

/// What is missed is said with the reason, and in the summary too.
#[test]
fn a_missed_accuracy_has_its_reason() {
    let rest = "effect.moment = [{ beam = 'arm', at = 'end', value = 2.0 }]\nanalysis.static = { steps = 4, accuracy = 1e-9 }";
    let text =
        cantilever(1e7, 1.0, rest).replace("mass_per_length", "basis.ancf.elements = 6, mass_per_length");
    let (_, summary, _) = written(&text);
    assert_eq!(summary["error"]["met"], false);
    assert!(summary["error"]["reason"].as_str().is_some_and(|reason| reason.contains("basis")));
    assert!(number(&summary, "/error/good_until") >= 0.0);
    let short = cantilever(1e2, 1.0, "analysis.static = {}");
    let (_, summary, _) = written(&short);
    assert!(summary["error"]["notes"][0].as_str().is_some_and(|note| note.contains("shear")), "{summary}");
}
