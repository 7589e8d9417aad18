//! The end of the process or the disk at any moment: nothing half-written has a final name, and
//! what was finished is not done again.

use crate::cli::commands::{ROLL_UP, ancf, entries, folder, status, stderr};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

const PENDULUM: &str = include_str!("../scenes/soft-pendulum.toml");

/// Runs the program and kills it, as by SIGKILL, after a while.
fn killed(folder: &Path, arguments: &[&str], after: Duration) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_ancf"))
        .current_dir(folder)
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    sleep(after);
    child.kill().expect("a child");
    child.wait().expect("a child");
}

/// Runs the program with files limited to so many blocks of 512 or 1024 bytes, as on a full disk.
fn on_a_full_disk(folder: &Path, blocks: usize, arguments: &[&str]) -> Output {
    Command::new("sh")
        .current_dir(folder)
        .args([
            "-c",
            &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\""),
            env!("CARGO_BIN_EXE_ancf"),
        ])
        .args(arguments)
        .output()
        .expect("a shell")
}

/// Every file under a final name is whole.
fn whole(directory: &Path) {
    let names = if directory.exists() { entries(directory) } else { Vec::new() };
    for name in names.iter().filter(|name| !name.starts_with(".ancf-")) {
        let text = fs::read_to_string(directory.join(name)).expect("a text");
        let is_whole = match name.rsplit('.').next() {
            Some("json") => serde_json::from_str::<serde_json::Value>(&text).is_ok(),
            Some("csv") => {
                let columns = |line: &str| line.matches(',').count();
                let first = text.lines().next().map(columns);
                text.ends_with('\n') && text.lines().all(|line| Some(columns(line)) == first)
            }
            Some("html") => text.trim_end().ends_with("</html>"),
            Some("svg") => text.trim_end().ends_with("</svg>"),
            _ => panic!("{name}?"),
        };
        assert!(is_whole, "{name} is torn");
    }
}

/// Delays that cover a run from its start to its end, none twice.
fn moments(longest: u64, count: u64) -> impl Iterator<Item = Duration> {
    (1..=count).map(move |i| Duration::from_millis(longest * ((i * 7) % (count + 1)) / count))
}

#[test]
fn a_run_killed_at_any_moment_leaves_no_torn_file() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "0.2"));
    let arguments = ["run", "scene.toml", "-o", "out", "--quiet"];
    let start = std::time::Instant::now();
    assert_eq!(status(&ancf(folder.path(), &arguments)), 0);
    let lasts = start.elapsed().as_millis() as u64;
    let probes = fs::read(folder.path().join("out/probes.csv")).expect("a table");
    for (number, after) in moments(lasts + 20, 12).enumerate() {
        // Half of them over the results of another run.
        if number % 2 == 0 {
            fs::remove_dir_all(folder.path().join("out")).expect("a directory");
        }
        killed(folder.path(), &arguments, after);
        whole(&folder.path().join("out"));
        fs::create_dir_all(folder.path().join("out")).expect("a directory");
    }
    assert_eq!(status(&ancf(folder.path(), &arguments)), 0);
    assert_eq!(fs::read(folder.path().join("out/probes.csv")).expect("a table"), probes);
}

#[test]
fn a_sweep_killed_again_and_again_repeats_no_finished_run() {
    let folder = folder(ROLL_UP);
    let sweep = |output: &'static str| {
        [
            "sweep",
            "scene.toml",
            "--vary",
            "effect.moment.0.value=0:300:400",
            "-o",
            output,
            "--threads",
            "2",
            "-q",
        ]
    };
    let start = std::time::Instant::now();
    assert_eq!(status(&ancf(folder.path(), &sweep("whole"))), 0);
    let lasts = start.elapsed().as_millis() as u64;
    let journal = folder.path().join("torn/journal-1-of-1.jsonl");
    let mut before = String::new();
    for after in moments(lasts / 2, 8) {
        killed(folder.path(), &sweep("torn"), after);
        let now = fs::read_to_string(&journal).unwrap_or_default();
        let finished = before.rfind('\n').map_or(0, |end| end + 1);
        assert_eq!(now.get(..finished), before.get(..finished), "what was recorded stays");
        before = now;
    }
    assert_eq!(status(&ancf(folder.path(), &sweep("torn"))), 0);
    let runs = fs::read_to_string(&journal).expect("a journal");
    let mut runs: Vec<u64> = runs
        .lines()
        .map(|line| {
            serde_json::from_str::<serde_json::Value>(line).expect("a record")["run"].as_u64().expect("a run")
        })
        .collect();
    runs.sort_unstable();
    assert_eq!(runs, (1..=400).collect::<Vec<_>>());
    let table = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.path().join(name).join("sweep.csv")).expect("a table");
        // All but the last column, the seconds.
        text.lines().map(|line| line.rsplit_once(',').map_or(line, |(row, _)| row).to_owned()).collect()
    };
    assert_eq!(table("torn"), table("whole"));
}

#[test]
fn a_full_disk_leaves_nothing_half_written() {
    let folder = folder(&PENDULUM.replace("\"2.5 s\"", "0.2"));
    let run = ["run", "scene.toml", "-o", "out", "-q"];
    for blocks in [0, 1, 4, 16] {
        let output = on_a_full_disk(folder.path(), blocks, &run);
        assert_ne!(status(&output), 0, "{blocks}");
        assert!(stderr(&output).contains("cannot write"), "{}", stderr(&output));
        assert_eq!(entries(folder.path()), ["scene.toml"], "{blocks}");
    }
    // What was there before stays as it was.
    assert_eq!(status(&ancf(folder.path(), &run)), 0);
    let before = fs::read(folder.path().join("out/summary.json")).expect("a summary");
    let names = entries(&folder.path().join("out"));
    assert_eq!(status(&on_a_full_disk(folder.path(), 4, &run)), 1);
    assert_eq!(fs::read(folder.path().join("out/summary.json")).expect("a summary"), before);
    assert_eq!(entries(&folder.path().join("out")), names);
}

#[test]
fn a_sweep_on_a_full_disk_goes_on_when_there_is_room() {
    let folder = folder(ROLL_UP);
    let sweep = [
        "sweep",
        "scene.toml",
        "--vary",
        "effect.moment.0.value=0:300:40",
        "-o",
        "s",
        "--threads",
        "2",
        "-q",
    ];
    let output = on_a_full_disk(folder.path(), 8, &sweep);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    for part in ["the journal of the sweep", "call the same command again"] {
        assert!(stderr(&output).contains(part), "{part} in {}", stderr(&output));
    }
    let journal = folder.path().join("s/journal-1-of-1.jsonl");
    let first = fs::read_to_string(&journal).expect("a journal");
    assert!(first.ends_with('\n') && (1..40).contains(&first.lines().count()), "{first}");
    assert_eq!(status(&ancf(folder.path(), &sweep)), 0);
    let second = fs::read_to_string(&journal).expect("a journal");
    assert!(second.starts_with(&first));
    assert_eq!(second.lines().count(), 40);
}

/// Nobody may write into /proc, not even root.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_refused_before_anything_is_solved() {
    let folder = folder(ROLL_UP);
    for directory in ["/proc", "/proc/results"] {
        for command in [&["run", "scene.toml"][..], &["sweep", "scene.toml", "--vary", "title=a,b"]] {
            let output = ancf(folder.path(), &[command, &["-o", directory]].concat());
            assert_eq!(status(&output), 2, "{}", stderr(&output));
            assert!(stderr(&output).contains(&format!("cannot write results into {directory}: ")));
        }
    }
    assert_eq!(entries(folder.path()), ["scene.toml"]);
}

/// A motion that is killed goes on from its last checkpoint, and ends to the last bit where the
/// whole motion does.
#[test]
fn a_killed_motion_goes_on_from_its_checkpoint() {
    let text = PENDULUM.replace("\"2.5 s\"", "\"60 s\"").replace("\"10 ms\"", "\"1 s\"");
    let folder = folder(&text);
    let run = ["run", "scene.toml", "--quiet", "--checkpoint", "20 ms", "-o", "killed"];
    killed(folder.path(), &run, Duration::from_millis(700));
    let state = folder.path().join("killed/state.json");
    assert!(state.is_file(), "no checkpoint in 0.7 s");
    let saved: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&state).expect("a text")).expect("a whole state");
    let time = saved["saved"]["checkpoint"]["state"]["time"].as_f64().expect("a time");
    assert!(time > 0.0 && time < 60.0, "saved at {time} s");
    // Both to the same end, soon after.
    let end = time.ceil().max(1.0) + 1.0;
    let last = |directory: &str, duration: f64, more: &[&str]| {
        let duration = format!("analysis.dynamic.duration={duration}");
        let mut arguments = vec!["run", "scene.toml", "--quiet", "--set", &duration, "-o", directory];
        arguments.extend(more);
        let output = ancf(folder.path(), &arguments);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        let summary =
            fs::read_to_string(folder.path().join(directory).join("summary.json")).expect("a summary");
        serde_json::from_str::<serde_json::Value>(&summary).expect("JSON")["probes"]["tip"].clone()
    };
    // With its full turns.
    let resumed = last("resumed", end - time, &["--from", "killed/state.json"]);
    assert_eq!(resumed, last("whole", end, &[]), "resumed at {time} s");
}
