//! What input may not do: command a terminal, make a spreadsheet compute, take a name twice, or
//! memory that is not there.

use super::commands::{ROLL_UP, ancf, folder, status, stderr};
use std::fs;
use std::path::Path;

const ARM: &str = r#"
beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 4 }
support = [{ beam = "arm", at = "start", fix = ["x", "y", "angle"] }]
effect.force = [{ beam = "arm", at = "end", value = [0, 1] }, { beam = "arm", at = 0.5, value = [0, 2] }, { beam = "arm", at = 0.5, value = [3, 0] }]
effect.moment = [{ beam = "arm", at = "end", value = 0.1 }]
output.effects = true
analysis.static = {}
"#;

fn header(folder: &Path, name: &str) -> Vec<String> {
    let mut table = csv::Reader::from_path(folder.join(name)).expect("a table");
    table.headers().expect("a header").iter().map(str::to_owned).collect()
}

#[test]
fn nothing_commands_the_terminal() {
    let text = ROLL_UP.replace("title = \"", "title = \"\\u001b]0;owned\\u0007\\u001b[2J\\u009b\\r");
    let folder = folder(&text);
    let good = ancf(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&good), 0, "{}", stderr(&good));
    assert!(stderr(&good).contains("\\u{1b}]0;owned\\u{7}\\u{1b}[2J\\u{9b}\\rRoll-up"), "{}", stderr(&good));
    let wrong = ancf(folder.path(), &["run", "scene.toml", "--set", "beam=\"\u{1b}[31m\""]);
    assert_eq!(status(&wrong), 2);
    for output in [good, wrong] {
        let control = |c: &char| c.is_control() && *c != '\n';
        assert_eq!(stderr(&output).chars().find(control), None);
    }
}

/// A name that begins as a formula does is text; numbers are numbers. No column is there twice.
#[test]
fn tables_hold_no_formula_and_no_column_twice() {
    let names = ["=1+1", "+x", "-x", "@SUM", "tip"];
    let probes = names.map(|name| format!("{{ name = \"{name}\", beam = \"=2+2\", at = \"end\" }}"));
    let text = ARM.replace("beam.arm", "beam.\"=2+2\"").replace("\"arm\"", "\"=2+2\"");
    let folder = folder(&format!("probe = [{}]\n{text}", probes.join(", ")));
    let output = ancf(folder.path(), &["run", "scene.toml", "-o", "out", "--set", "output.states=true"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let columns = header(folder.path(), "out/probes.csv");
    for name in ["'=1+1.x", "'+x.x", "'-x.x", "'@SUM.x", "tip.x"] {
        assert!(columns.iter().any(|column| column == name), "{name} in {columns:?}");
    }
    for name in ["shape.csv", "states.csv", "effects.csv", "probes.csv", "energy.csv"] {
        let text = fs::read_to_string(folder.path().join("out").join(name)).expect("a table");
        for cell in text.lines().flat_map(|line| line.split(',')) {
            let formula = cell.starts_with(['=', '@', '+', '-']) && cell.parse::<f64>().is_err();
            assert!(!formula, "{name}: {cell}");
        }
    }
    let mut columns = header(folder.path(), "out/effects.csv");
    assert!(
        columns.contains(&"force.=2+2.3.fy".to_owned()) && columns.contains(&"moment.=2+2.fy".to_owned())
    );
    let count = columns.len();
    columns.sort();
    columns.dedup();
    assert_eq!(columns.len(), count, "{columns:?}");

    let vary = ["sweep", "scene.toml", "--vary", "title==1+1,+x", "-o", "grid"];
    let output = ancf(folder.path(), &vary);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let table = fs::read_to_string(folder.path().join("grid/sweep.csv")).expect("a table");
    let titles: Vec<&str> = table.lines().skip(1).filter_map(|line| line.split(',').nth(1)).collect();
    assert_eq!(titles, ["'=1+1", "'+x"]);
}

#[test]
fn a_bad_row_of_a_list_is_told_by_file_and_line() {
    let folder = folder(ARM);
    for (list, parts) in [
        (
            "effect.force.0.value.1,effect.moment.0.value\n1,2\n\n3\n",
            &["runs.csv:4", "found 1 value, and the header names 2"][..],
        ),
        ("effect.force.0.value.1\n1\n2 N\n3 m\n4\n", &["runs.csv:4", "3 m"]),
        ("effect.force.0.value.1,title\n1,\"a\nb\"\nx,c\n", &["runs.csv:4", "x"]),
        ("effect.force.7.value.1\n1\n", &["runs.csv:2"]),
    ] {
        fs::write(folder.path().join("runs.csv"), list).expect("a folder");
        let output = ancf(folder.path(), &["sweep", "scene.toml", "--list", "runs.csv", "-o", "grid"]);
        assert_eq!(status(&output), 2, "{}", stderr(&output));
        for part in parts {
            assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
        }
    }
}

/// Address space that this process may not have is memory that is not there.
#[cfg(target_os = "linux")]
#[test]
fn memory_that_is_not_there_is_a_message() {
    let dynamic = "analysis.dynamic = { duration = 1, output_every = 1e-6 }";
    let moving = ARM
        .replace("analysis.static = {}", dynamic)
        .replace("bending_stiffness = 1,", "bending_stiffness = 1, mass_per_length = 1,");
    for text in [
        ARM.replace("elements = 4", "elements = 5_000_000"),
        moving.replace("elements = 4", "elements = 1000"),
    ] {
        let folder = folder(&text);
        for command in ["run", "check"] {
            let line = format!("ulimit -v 2000000; exec {} {command} scene.toml", env!("CARGO_BIN_EXE_ancf"));
            let output =
                std::process::Command::new("sh").current_dir(folder.path()).args(["-c", &line]).output();
            let output = output.expect("a shell");
            assert_eq!(status(&output), 1, "{}", stderr(&output));
            assert!(stderr(&output).contains("GiB of memory, and"), "{}", stderr(&output));
        }
    }
}
