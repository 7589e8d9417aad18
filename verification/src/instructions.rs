//! `verify instructions`: what runs cost, counted instead of timed. Clocks of shared machines lie
//! by tens of per cent; instructions counted by valgrind's callgrind repeat to a part in a
//! thousand.

use std::path::{Path, PathBuf};
use std::process::Command;

use ancf_check::Suite;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::report::now;

/// The list of the runs that are counted, from the root of the repository.
const LIST: &str = "verification/instructions.toml";
/// Where counts of all times are kept, from the root of the repository.
pub const HISTORY: &str = "target/verification/instructions.json";
/// The function whose instructions count, with all that it calls; and its name in builds before
/// every analysis had results of its own, with which this one may be compared. A build must have
/// only one of them: the inner one would end the count of the outer one.
const COUNTED: [&str; 2] = [
    "<ancf::model::analysis::Analysis as ancf::run::Solve>::solve",
    "ancf::run::<impl ancf::model::Model>::solve_with",
];
/// Growth beyond which a count fails: callgrind repeats to a part in a thousand.
const GROWTH: f64 = 1.01;

#[derive(Deserialize)]
struct List {
    count: Vec<Run>,
    price: Price,
}

/// A motion to which effects are added one at a time.
#[derive(Deserialize)]
struct Price {
    #[serde(flatten)]
    base: Run,
    effect: Vec<Added>,
}

/// An effect and the overrides by which it enters a scene.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Added {
    name: String,
    set: Vec<String>,
}

/// A run whose instructions are counted.
#[derive(Clone, Deserialize)]
struct Run {
    name: String,
    /// In the folder of the cases.
    scene: PathBuf,
    /// Overrides of the scene.
    #[serde(default)]
    set: Vec<String>,
    integrator: Option<String>,
    /// Two durations of a motion.
    durations: Option<[String; 2]>,
}

/// The counts of one day.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Day {
    /// Day and time.
    pub date: String,
    /// What was counted: the commit, as `git describe` names it.
    pub commit: String,
    /// Name of the run, instructions per step or of the whole analysis.
    pub counts: Vec<(String, f64)>,
    /// Instructions per step of the base of the price list, and with each effect added.
    #[serde(default)]
    pub prices: Vec<(String, f64)>,
}

/// Counts with `program`, prints the counts beside those of `against` or else of the last time, and
/// adds them to the history. The answer is whether none grew by more than 1 %.
pub fn print(suite: &Suite, program: &Path, against: Option<&Path>) -> Result<bool, Failure> {
    let list: List = toml::from_str(&read(&suite.root.join(LIST))?).map_err(|e| format!("{LIST}: {e}"))?;
    let file = suite.root.join(HISTORY);
    let mut history = history(&file)?;
    let mut today = Day { date: now(), commit: commit(suite), counts: Vec::new(), prices: Vec::new() };
    let before = against.is_none().then(|| history.last().cloned()).flatten();
    let mut held = true;
    eprintln!("{:>12} {:>12} {:>7}", "now", "before", "ratio");
    for run in &list.count {
        let count = count(suite, program, run)?;
        let earlier = match (against, &before) {
            (Some(other), _) => Some(self::count(suite, other, run)?),
            (None, Some(day)) => {
                day.counts.iter().find(|(name, _)| *name == run.name).map(|(_, count)| *count)
            }
            (None, None) => None,
        };
        let beside = earlier.map_or(format!("{:>12} {:>7}", "–", "–"), |earlier| {
            held &= count <= GROWTH * earlier;
            format!("{earlier:>12.0} {:>7.4}", count / earlier)
        });
        eprintln!("{count:>12.0} {beside}  {}", run.name);
        today.counts.push((run.name.clone(), count));
    }
    today.prices = prices(suite, program, &list.price)?;
    history.push(today);
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    std::fs::write(&file, serde_json::to_string_pretty(&history)?)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(held)
}

/// Instructions per step of the base, and with each effect added.
fn prices(suite: &Suite, program: &Path, price: &Price) -> Result<Vec<(String, f64)>, Failure> {
    let base = count(suite, program, &price.base)?;
    eprintln!("{base:>12.0} a step of {}", price.base.name);
    let mut prices = vec![(price.base.name.clone(), base)];
    for added in &price.effect {
        let mut run = price.base.clone();
        run.set.extend(added.set.iter().cloned());
        let with = count(suite, program, &run)?;
        eprintln!("{:>+12.0} {:>7.3}  {}", with - base, with / base, added.name);
        prices.push((added.name.clone(), with));
    }
    Ok(prices)
}

/// Counts of earlier days, the oldest first.
///
/// # Errors
/// Where the file is there but cannot be read.
pub fn history(file: &Path) -> Result<Vec<Day>, Failure> {
    if !file.exists() {
        return Ok(Vec::new());
    }
    Ok(serde_json::from_str(&read(file)?).map_err(|e| format!("{}: {e}", file.display()))?)
}

fn read(file: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()).into())
}

fn commit(suite: &Suite) -> String {
    let git = Command::new("git").args(["describe", "--always", "--dirty"]).current_dir(&suite.root).output();
    git.map_or_else(|_| "unknown".to_owned(), |out| String::from_utf8_lossy(&out.stdout).trim().to_owned())
}

/// Instructions per step, or of a whole analysis.
fn count(suite: &Suite, program: &Path, run: &Run) -> Result<f64, Failure> {
    let Some(durations) = &run.durations else { return Ok(collect(suite, program, run, None)?.0) };
    let (short, few) = collect(suite, program, run, Some(&durations[0]))?;
    let (long, many) = collect(suite, program, run, Some(&durations[1]))?;
    if many <= few {
        return Err(
            format!("{}: {many} steps in {}, {few} in {}", run.name, durations[1], durations[0]).into()
        );
    }
    Ok((long - short) / (many - few))
}

/// Instructions and steps of one run.
fn collect(suite: &Suite, program: &Path, run: &Run, duration: Option<&str>) -> Result<(f64, f64), Failure> {
    let folder = tempfile::tempdir()?;
    let mut set = run.set.clone();
    if let (Some(duration), Some(integrator)) = (duration, &run.integrator) {
        set.push(format!(
            "analysis.dynamic={{duration=\"{duration}\", output_every=\"{duration}\", {integrator}}}"
        ));
    }
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .args(COUNTED.map(|name| format!("--toggle-collect={name}")))
        .arg(program)
        .arg("run")
        .arg(suite.root.join("verification/cases").join(&run.scene))
        .args(["--quiet", "--json"])
        .arg("--output")
        .arg(folder.path().join("out"))
        .args(set.iter().flat_map(|set| ["--set", set]))
        .output()
        .map_err(|e| format!("valgrind: {e}; install it (Debian: apt install valgrind)"))?;
    let told = String::from_utf8_lossy(&output.stderr);
    let number = |label: &str| {
        let rest = told.split(label).nth(1)?;
        rest.trim_start_matches([' ', ':']).split_whitespace().next()?.replace(',', "").parse::<f64>().ok()
    };
    let collected = number("Collected").filter(|count| output.status.success() && *count > 0.0);
    let summary: Option<serde_json::Value> = serde_json::from_slice(&output.stdout).ok();
    let steps = summary.as_ref().and_then(|summary| summary["statistics"]["steps"].as_f64());
    match (collected, steps) {
        (Some(collected), Some(steps)) => Ok((collected, steps)),
        _ => Err(format!(
            "{}: nothing was counted by {}; it must be a build with symbols (cargo build --profile profiling --bin ancf):\n{told}",
            run.name,
            program.display()
        )
        .into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_names_scenes_that_are_there() {
        let suite = Suite::here();
        let list: List = toml::from_str(&read(&suite.root.join(LIST)).expect("a file")).expect("a list");
        for run in list.count {
            assert!(
                suite.root.join("verification/cases").join(&run.scene).exists(),
                "{}",
                run.scene.display()
            );
            assert_eq!(run.durations.is_some(), run.integrator.is_some(), "{}", run.name);
        }
        for added in list.price.effect {
            assert!(!added.set.is_empty(), "{}", added.name);
        }
    }

    #[test]
    fn a_history_that_is_not_there_is_empty() {
        assert!(history(Path::new("nowhere.json")).expect("no error").is_empty());
    }
}
