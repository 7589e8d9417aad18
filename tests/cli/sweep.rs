//! Many runs of one scene: one table, whatever happens on the way.

use super::commands::{ROLL_UP, ancf, entries, folder, status, stderr};
use std::fs;
use std::path::Path;

/// Six runs: three moments, each with two meshes.
const GRID: [&str; 4] =
    ["--vary", "effect.moment.0.value=0 N m:300 N m:3", "--vary", "beam.cantilever.basis.ancf.elements=3,2"];

fn sweep(folder: &Path, more: &[&str]) -> std::process::Output {
    ancf(folder, &[&["sweep", "scene.toml"], &GRID[..], more].concat())
}

/// The table by rows and columns.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let texts = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let header = texts(reader.headers().unwrap());
        Self { header, rows: reader.records().map(|row| texts(&row.unwrap())).collect() }
    }

    fn column(&self, name: &str) -> Vec<&str> {
        let at = self.header.iter().position(|n| n == name);
        let at = at.unwrap_or_else(|| panic!("no column {name} in {:?}", self.header));
        self.rows.iter().map(|row| row[at].as_str()).collect()
    }

    fn without_seconds(mut self) -> (Vec<String>, Vec<Vec<String>>) {
        assert_eq!(self.header.pop().unwrap(), "seconds");
        self.rows.iter_mut().for_each(|row| assert!(row.pop().unwrap().parse::<f64>().unwrap() > 0.0));
        (self.header, self.rows)
    }
}

/// What is said of the elements of the grid, which turn by up to half a circle each.
const TOO_FEW: &str = "warning: 4 of 6 runs have warnings (see the columns `warnings.…`): 3–6\n";

/// Runs in the journal, in the order in which they finished.
fn journal(path: &Path) -> Vec<u64> {
    let text = fs::read_to_string(path).unwrap();
    let run = |line: &str| serde_json::from_str::<serde_json::Value>(line).unwrap()["run"].as_u64().unwrap();
    text.lines().map(run).collect()
}

#[test]
fn a_grid_becomes_one_table_with_the_numbers_of_single_runs() {
    let folder = folder(ROLL_UP);
    let output = sweep(folder.path(), &["-o", "grid"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert_eq!(stderr(&output), format!("{TOO_FEW}6 runs: grid/sweep.csv\n"));
    assert_eq!(entries(&folder.path().join("grid")), ["journal-1-of-1.jsonl", "sweep.csv", "sweep.json"]);
    let table = Table::read(&folder.path().join("grid/sweep.csv"));
    assert_eq!(table.column("run"), ["1", "2", "3", "4", "5", "6"]);
    assert_eq!(
        table.column("effect.moment.0.value"),
        ["0 N m", "0 N m", "150 N m", "150 N m", "300 N m", "300 N m"]
    );
    assert_eq!(table.column("beam.cantilever.basis.ancf.elements"), ["3", "2", "3", "2", "3", "2"]);
    assert_eq!(table.column("outcome"), ["solved"; 6]);
    assert_eq!(table.column("message"), [""; 6]);
    let values = [
        "--set",
        "effect.moment.0.value=150 N m",
        "--set",
        "beam.cantilever.basis.ancf.elements=2",
        "--json",
    ];
    let single = ancf(folder.path(), &[&["run", "scene.toml"], &values[..]].concat());
    let summary: serde_json::Value = serde_json::from_slice(&single.stdout).unwrap();
    for (name, pointer) in [
        ("probes.tip.x", "/probes/tip/x"),
        ("probes.tip.curvature", "/probes/tip/curvature"),
        ("energy.total", "/energy/total"),
        ("statistics.newton_iterations", "/statistics/newton_iterations"),
        ("degrees_of_freedom", "/degrees_of_freedom"),
    ] {
        let expected = summary.pointer(pointer).unwrap().as_f64().unwrap();
        assert_eq!(table.column(name)[3].parse::<f64>().unwrap().to_bits(), expected.to_bits(), "{name}");
    }
}

#[test]
fn threads_shards_and_interruptions_change_no_bit() {
    let folder = folder(ROLL_UP);
    let folder = folder.path();
    let read = |name: &str| Table::read(&folder.join(name)).without_seconds();
    assert_eq!(status(&sweep(folder, &["-o", "one", "--threads", "1"])), 0);
    let expected = read("one/sweep.csv");
    assert_eq!(journal(&folder.join("one/journal-1-of-1.jsonl")), [1, 2, 3, 4, 5, 6]);

    assert_eq!(status(&sweep(folder, &["-o", "two", "--threads", "2"])), 0);
    assert_eq!(read("two/sweep.csv"), expected);

    // Three processes in one directory; before the last, the sweep is not whole.
    for (shard, left) in [("3/3", "1–2, 4–5"), ("1/3", "2, 5"), ("2/3", "")] {
        let output = sweep(folder, &["-o", "shards", "--shard", shard]);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        let done = format!("shard {shard}: all of its 2 runs are done");
        assert!(stderr(&output).contains(&done), "{}", stderr(&output));
        let merged = ancf(folder, &["sweep", "--merge", "shards"]);
        assert_eq!(status(&merged), i32::from(!left.is_empty()), "{}", stderr(&merged));
        assert!(stderr(&merged).contains(left), "{left}: {}", stderr(&merged));
        assert_eq!(folder.join("shards/sweep.csv").exists(), left.is_empty());
    }
    assert_eq!(read("shards/sweep.csv"), expected);

    // Both at once, and the directory's manifest made by the faster one.
    std::thread::scope(|scope| {
        for shard in ["1/2", "2/2"] {
            scope.spawn(move || {
                let output = sweep(folder, &["-o", "at-once", "--shard", shard, "--threads", "1"]);
                assert_eq!(status(&output), 0, "{}", stderr(&output));
            });
        }
    });
    let merged = ancf(folder, &["sweep", "--merge", "at-once", "--quiet"]);
    assert_eq!((status(&merged), stderr(&merged).as_str()), (0, TOO_FEW));
    assert_eq!(read("at-once/sweep.csv"), expected);

    // Killed in the middle of a line: the runs before it are not repeated.
    let path = folder.join("one/journal-1-of-1.jsonl");
    let whole = fs::read_to_string(&path).unwrap();
    let kept = whole.match_indices('\n').nth(3).unwrap().0 + 1;
    fs::write(&path, &whole[..kept + 40]).unwrap();
    fs::remove_file(folder.join("one/sweep.csv")).unwrap();
    let merged = ancf(folder, &["sweep", "--merge", "one"]);
    assert_eq!(status(&merged), 1);
    assert!(stderr(&merged).contains("2 of 6 runs are missing: 5–6"), "{}", stderr(&merged));
    assert_eq!(status(&sweep(folder, &["-o", "one"])), 0);
    let resumed = fs::read_to_string(&path).unwrap();
    assert_eq!(resumed[..kept], whole[..kept], "seconds included");
    let mut runs = journal(&path);
    runs.sort_unstable();
    assert_eq!(runs, [1, 2, 3, 4, 5, 6]);
    assert_eq!(read("one/sweep.csv"), expected);

    // What is finished stays as it is, seconds included.
    assert_eq!(status(&sweep(folder, &["-o", "one"])), 0);
    assert_eq!(fs::read_to_string(&path).unwrap(), resumed);
}

#[test]
fn failures_are_rows() {
    let arch = r#"
[beam.arch]
arc = { center = [0.0, 0.0], radius = 1.0, from = "150 deg", to = "30 deg" }
axial_stiffness = 1e4
bending_stiffness = 1.0
basis.ancf.elements = 8
[[support]]
beam = "arch"
at = "start"
fix = ["x", "y"]
[[support]]
beam = "arch"
at = "end"
fix = ["x", "y"]
[[effect.force]]
beam = "arch"
at = 1.0471975511965976
value = [0.0, -1.0]
[[probe]]
name = "crown"
beam = "arch"
at = 1.0471975511965976
[analysis.static]
steps = 1
"#;
    let folder = folder(arch);
    let list = "effect.force.0.value.1 , support.1.fix\n-1,\"[\"\"x\"\", \"\"y\"\"]\"\n\
                -1000,\"['x', 'y']\"\n-2,\"['y', 'x']\"\n";
    fs::write(folder.path().join("runs.csv"), list).unwrap();
    let output = ancf(folder.path(), &["sweep", "scene.toml", "--list", "runs.csv", "-o", "out"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let table = Table::read(&folder.path().join("out/sweep.csv"));
    assert_eq!(table.column("outcome"), ["solved", "failed", "solved"]);
    assert!(stderr(&output).starts_with("warning: 1 of 3 runs were not solved"), "{}", stderr(&output));
    assert!(table.column("message")[1].starts_with("no equilibrium beyond load factor"));
    // How far the failed one came.
    assert_eq!(table.column("complete"), ["true", "false", "true"]);
    assert!((0.0..1.0).contains(&table.column("last")[1].parse().unwrap()));
    assert_eq!(table.column("support.1.fix"), ["[\"x\", \"y\"]", "['x', 'y']", "['y', 'x']"]);
    let again = fs::read(folder.path().join("out/journal-1-of-1.jsonl")).unwrap();
    let output = ancf(folder.path(), &["sweep", "scene.toml", "--list", "runs.csv", "-o", "out"]);
    assert_eq!(status(&output), 0);
    assert_eq!(fs::read(folder.path().join("out/journal-1-of-1.jsonl")).unwrap(), again);
}

/// Some legal scenes cannot be computed, which shows only when their equations are built.
#[test]
fn what_cannot_be_built_is_a_row_too() {
    let pendulum = include_str!("../scenes/soft-pendulum.toml").replace("\"2.5 s\"", "\"30 ms\"");
    let folder = folder(&pendulum);
    let moves = "support.0.move={},{ x = \"1 mm\" }";
    let output = ancf(folder.path(), &["sweep", "scene.toml", "--vary", moves, "-o", "out", "--quiet"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let table = Table::read(&folder.path().join("out/sweep.csv"));
    assert_eq!(table.column("outcome"), ["solved", "refused"]);
    assert!(table.column("message")[1].contains("does not say how in time"));
    assert!(table.column("probes.tip.vx")[0].parse::<f64>().unwrap().is_finite());
    assert_eq!(table.column("probes.tip.vx")[1], "");
    assert!(stderr(&output).contains("1 of 2 runs were not solved"), "{}", stderr(&output));
}

/// A cantilever rolled up into a circle, by cells that turn by 120° each and by ones that follow: the first run has a warning, which the end of
/// the sweep tells.
#[test]
fn runs_with_warnings_are_told() {
    let arm = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 1 }\n\
               support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
               effect.moment = [{ beam = 'arm', at = 'end', value = 6.28 }]\nanalysis.static = {}\n";
    let folder = folder(arm);
    let vary = "beam.arm.basis.ancf.elements=3,12,20";
    let output = ancf(folder.path(), &["sweep", "scene.toml", "--vary", vary, "-o", "out", "--quiet"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert_eq!(
        stderr(&output).trim(),
        "warning: 1 of 3 runs have warnings (see the columns `warnings.…`): 1",
        "{}",
        stderr(&output)
    );
    let table = Table::read(&folder.path().join("out/sweep.csv"));
    let told = table.column("warnings.1");
    assert!(
        told[0].contains("its cells are too few") && told[1].is_empty() && told[2].is_empty(),
        "{told:?}"
    );
}

#[test]
fn eigenvalues_are_columns() {
    let folder = folder(include_str!("../scenes/modal.toml"));
    let output =
        ancf(folder.path(), &["sweep", "scene.toml", "--vary", "analysis.modal.count=2,3", "-o", "m"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let table = Table::read(&folder.path().join("m/sweep.csv"));
    assert_eq!(table.column("frequencies.3")[0], "");
    let frequencies: Vec<f64> =
        (1..=3).map(|i| table.column(&format!("frequencies.{i}"))[1].parse().unwrap()).collect();
    assert!(frequencies.is_sorted() && frequencies[0] > 0.0, "{frequencies:?}");
    let with_two: f64 = table.column("frequencies.1")[0].parse().unwrap();
    assert!((with_two - frequencies[0]).abs() < 1e-9 * frequencies[0], "{with_two}");
}

#[test]
fn another_sweep_in_the_directory_is_refused() {
    let folder = folder(ROLL_UP);
    let folder = folder.path();
    assert_eq!(status(&sweep(folder, &["-o", "s", "--shard", "1/6"])), 0);
    let before = fs::read(folder.join("s/journal-1-of-6.jsonl")).unwrap();
    let refused = |output: std::process::Output, part: &str| {
        assert_eq!(status(&output), 2, "{}", stderr(&output));
        assert!(stderr(&output).contains("s holds another sweep"), "{}", stderr(&output));
        assert!(stderr(&output).contains(part), "{part}: {}", stderr(&output));
        assert_eq!(fs::read(folder.join("s/journal-1-of-6.jsonl")).unwrap(), before);
    };
    refused(sweep(folder, &["-o", "s", "--set", "analysis.static.steps=2"]), "analysis.static.steps=2");
    refused(sweep(folder, &["-o", "s", "--vary", "analysis.static.steps=2"]), "vary");
    let values = "effect.moment.0.value=0 N m:301 N m:3";
    let output = ancf(folder, &["sweep", "scene.toml", "--vary", values, GRID[2], GRID[3], "-o", "s"]);
    refused(output, "the values of effect.moment.0.value are others");
    fs::write(folder.join("scene.toml"), ROLL_UP.replace("\"1.8 m\"", "\"1.9 m\"")).unwrap();
    refused(sweep(folder, &["-o", "s"]), "another content");
    // Without its manifest nobody knows what the journals are of.
    fs::remove_file(folder.join("s/sweep.json")).unwrap();
    let output = sweep(folder, &["-o", "s"]);
    assert_eq!(status(&output), 2);
    assert!(stderr(&output).contains("whose manifest sweep.json is missing"), "{}", stderr(&output));
}

#[test]
fn wrong_input_is_refused_before_anything_is_run() {
    let folder = folder(ROLL_UP);
    fs::write(folder.path().join("ragged.csv"), "a,b\n1\n").unwrap();
    for (arguments, part) in [
        (&["--vary", "effect.moment.1.value=1,2"][..], "has no entry `1`"),
        (&["--vary", "effect.moment.0.value=1,2 N"][..], "in the override `effect.moment.0.value=2 N`"),
        (&["--vary", "beam.cantilever.basis.ancf.elements=1:4:3"][..], "elements=2.5"),
        (&["--vary", "effect.moment.0.value=1:2"][..], "START:STOP:COUNT"),
        (&["--list", "ragged.csv"][..], "ragged.csv"),
        (&["--list", "absent.csv"][..], "absent.csv"),
        (&[][..], "nothing varies"),
        (&["--vary", "title=a,b", "--vary", "title=c,d"][..], "`title` is varied twice"),
        (&["--vary", "title=a,b", "--threads", "0"][..], "--threads"),
        (&["--vary", "title=a,b", "--shard", "3/2"][..], "I/N"),
        (&["--merge", "nowhere"][..], ""),
    ] {
        let output = ancf(folder.path(), &[&["sweep", "scene.toml"], arguments].concat());
        assert_eq!(status(&output), 2, "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(part), "{part}: {}", stderr(&output));
        assert_eq!(entries(folder.path()), ["ragged.csv", "scene.toml"]);
    }
    let output = ancf(folder.path(), &["sweep", "--merge", "nowhere"]);
    assert_eq!(status(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("sweep.json"), "{}", stderr(&output));
}
