//! Results with their errors, as people see them on the terminal.

use super::commands::{ancf, folder, status, stderr};

const ARM: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1, mass_per_length = 1 }\n\
                   support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n";

/// The row of the table that begins with `name`.
fn row(text: &str, name: &str) -> String {
    let row = text.lines().map(str::trim).find(|line| line.starts_with(name));
    row.unwrap_or_else(|| panic!("no row `{name}` in {text}")).to_owned()
}

/// (βL)²/(2π) with βL = 1.8751.
#[test]
fn frequencies_have_no_digit_beyond_their_error() {
    let folder = folder(&format!("{ARM}analysis.modal = {{ count = 1, accuracy = 1e-3 }}"));
    let output = ancf(folder.path(), &["run", "scene.toml", "--json"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let row = row(&stderr(&output), "frequency 1");
    let (value, error) = row.trim_end_matches(") Hz").rsplit_once('(').unwrap();
    let digits = value.rsplit_once('.').unwrap().1.len() as i32;
    let value: f64 = value.split_whitespace().last().unwrap().parse().unwrap();
    // The error in units of the last digit, rounded up.
    let said = error.parse::<f64>().unwrap() * 10.0_f64.powi(-digits);
    let estimated = summary["frequency_errors"][0].as_f64().unwrap();
    assert!(said >= 0.999 * estimated && said <= 2.0 * estimated, "{row}, {estimated:e}");
    assert!((value - 1.875_104_068_711_961_f64.powi(2) / std::f64::consts::TAU).abs() <= said, "{row}");
}

#[test]
fn the_usual_accuracy_is_said_to_be_that() {
    let force = "effect.force = [{ beam = 'arm', at = 'end', value = [0, 1] }]\n";
    for (analysis, said) in [
        ("analysis.static = {}", "(1e-4 wanted, as usual)"),
        ("analysis.static.accuracy = 1e-4", "(1e-4 wanted)"),
        ("analysis.static.accuracy = 1e-3", "(1e-3 wanted)"),
    ] {
        let folder = folder(&format!("{ARM}{force}{analysis}"));
        let output = ancf(folder.path(), &["run", "scene.toml"]);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        let row = row(&stderr(&output), "error");
        assert!(row.contains(said), "{row}");
    }
}

/// Stages have errors, but no accuracy, which is not passed over in silence.
#[test]
fn stages_have_errors_and_no_accuracy() {
    let force = "effect.force = [{ beam = 'arm', at = 'end', value = [0, 1] }]\n";
    let stages = "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.static = {} }]\n";
    let arm = ARM.replace("mass_per_length = 1 }", "mass_per_length = 1, basis.ancf.elements = 4 }");
    let folder = folder(&format!("{arm}{force}{stages}"));
    let output = ancf(folder.path(), &["run", "scene.toml", "--accuracy", "1e-3"]);
    assert_eq!(status(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("stages"), "{}", stderr(&output));
    for (options, errors) in [(&["run", "scene.toml"][..], 0), (&["run", "scene.toml", "--error"], 2)] {
        let output = ancf(folder.path(), options);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        let told = stderr(&output).matches("of a beam length; 3 runs").count();
        assert_eq!(told, errors, "{options:?}: {}", stderr(&output));
    }
}

/// No double has fourteen digits more than it needs: the results are written, with what they are
/// worth.
#[test]
fn an_accuracy_that_cannot_be_had_is_status_1_with_results() {
    let force = "effect.force = [{ beam = 'arm', at = 'end', value = [0, 1] }]\n";
    let folder = folder(&format!("{ARM}{force}analysis.static.accuracy = 1e-14"));
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    let text = stderr(&output);
    for part in ["scene.toml: the wanted accuracy of 1e-14 of a beam length is not met", "round-off"] {
        assert!(text.contains(part), "`{part}` in {text}");
    }
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["error"]["met"], false);
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w.as_str().unwrap().contains("is not met")), "{warnings:?}");
}
