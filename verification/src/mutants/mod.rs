//! `verify mutants`: what cargo-mutants found, kept in `verification/mutants.toml` with a reason for every survivor.
//!
//! A mutant is one small fault put into the sources. It is *caught* where a test fails or does not come to its end, *missed*
//! where all tests pass, *unviable* where it does not compile.

mod reasons;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use ancf_check::Suite;
use ancf_verification::Failure;
use indexmap::IndexMap;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

pub use self::reasons::Survivor;
use self::reasons::{UNEXPLAINED, explain, without_place};
use crate::freeze::store;

/// `verification/mutants.toml`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Record {
    /// Day of the last run.
    pub date: String,
    /// The sources.
    pub commit: String,
    /// Version of the tool.
    pub cargo_mutants: String,
    /// What repeats it.
    pub command: String,
    /// Over all folders.
    pub total: Counts,
    /// By source folder.
    pub folder: IndexMap<String, Counts>,
    /// Missed mutants in the order of the sources.
    #[serde(default)]
    pub survivor: Vec<Survivor>,
}

/// Numbers of mutants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Counts {
    /// There are.
    pub exist: usize,
    /// Tried: all that follow.
    pub tried: usize,
    /// A test failed.
    pub caught: usize,
    /// The tests did not come to their end.
    pub timed_out: usize,
    /// Did not compile.
    pub unviable: usize,
    /// All tests passed.
    pub missed: usize,
}

impl Counts {
    /// Tried and compiled.
    pub fn viable(&self) -> usize {
        self.tried - self.unviable.min(self.tried)
    }

    /// Part of the viable mutants that was caught, those timed out among them. None where none was viable.
    pub fn score(&self) -> Option<f64> {
        (self.viable() > 0).then(|| (self.caught + self.timed_out) as f64 / self.viable() as f64)
    }

    fn add(&mut self, summary: Summary) {
        self.tried += 1;
        match summary {
            Summary::CaughtMutant => self.caught += 1,
            Summary::Timeout => self.timed_out += 1,
            Summary::Unviable => self.unviable += 1,
            Summary::MissedMutant => self.missed += 1,
        }
    }
}

impl Record {
    /// Where the record lies.
    pub fn path(suite: &Suite) -> PathBuf {
        suite.root.join("verification").join("mutants.toml")
    }

    /// Reads it; none where there is no such file.
    pub fn read(path: &Path) -> Result<Option<Self>, Failure> {
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Some(toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{}: {error}", path.display()).into()),
        }
    }

    /// Joins a list of all mutants with the outcomes of some, and keeps the reasons of an earlier record.
    /// A mutant that was tried twice counts as it came out last.
    fn join(known: &[Mutant], runs: &[Outcomes], reasons: &[Survivor]) -> Result<Self, Failure> {
        let mut tried: IndexMap<&Mutant, Summary> = IndexMap::new();
        let mut versions: Vec<&str> = runs.iter().map(|r| r.cargo_mutants_version.as_str()).collect();
        versions.sort_unstable();
        versions.dedup();
        for outcome in runs.iter().flat_map(|run| &run.outcomes) {
            // The tests on the sources as they are say nothing of mutants.
            let Scenario::Mutant(mutant) = &outcome.scenario else { continue };
            let summary = Summary::read(&outcome.summary)
                .ok_or_else(|| format!("{}: no outcome is known as `{}`", mutant.name, outcome.summary))?;
            tried.insert(mutant, summary);
        }
        let listed: HashSet<&Mutant> = known.iter().collect();
        if let Some(foreign) = tried.keys().find(|mutant| !listed.contains(*mutant)) {
            return Err(format!(
                "`{}` was tried but is not in the list of mutants; make the list from the sources that were tried",
                foreign.name
            )
            .into());
        }
        let (mut total, mut folder) = (Counts::default(), IndexMap::<String, Counts>::new());
        for mutant in known {
            let part = folder.entry(mutant.folder()).or_default();
            for counts in [part, &mut total] {
                counts.exist += 1;
                if let Some(summary) = tried.get(mutant) {
                    counts.add(*summary);
                }
            }
        }
        folder.sort_unstable_keys();
        // The list is in the order of the sources; outcomes are in that of the parts.
        let missed: Vec<&str> = known
            .iter()
            .filter(|mutant| tried.get(mutant) == Some(&Summary::MissedMutant))
            .map(|mutant| mutant.name.as_str())
            .collect();
        let date = runs.iter().map(|run| run.start_time.as_str()).max().unwrap_or_default();
        Ok(Self {
            date: date.chars().take(10).collect(),
            commit: String::new(),
            cargo_mutants: versions.join(", "),
            command: String::new(),
            total,
            folder,
            survivor: explain(&missed, reasons),
        })
    }
}

/// What is used of `outcomes.json`.
#[derive(Deserialize)]
struct Outcomes {
    outcomes: Vec<Outcome>,
    start_time: String,
    /// None as long as it runs.
    end_time: Option<String>,
    cargo_mutants_version: String,
}

#[derive(Deserialize)]
struct Outcome {
    scenario: Scenario,
    summary: String,
}

#[derive(Deserialize)]
enum Scenario {
    Baseline,
    Mutant(Mutant),
}

/// A mutant in the tool's words; the name has file, line, column and change.
#[derive(Deserialize, PartialEq, Eq, Hash)]
struct Mutant {
    name: String,
    file: String,
}

impl Mutant {
    /// The first two levels of the folder that the file is in.
    fn folder(&self) -> String {
        let parts: Vec<&str> = self.file.split('/').collect();
        let folders = parts.len().saturating_sub(1).min(2);
        parts.iter().take(folders).copied().collect::<Vec<_>>().join("/")
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Summary {
    CaughtMutant,
    MissedMutant,
    Timeout,
    Unviable,
}

impl Summary {
    fn read(word: &str) -> Option<Self> {
        match word {
            "CaughtMutant" => Some(Self::CaughtMutant),
            "MissedMutant" => Some(Self::MissedMutant),
            "Timeout" => Some(Self::Timeout),
            "Unviable" => Some(Self::Unviable),
            _ => None,
        }
    }
}

/// Writes the record of some runs. `list` is what `cargo mutants --list --json` says, `outcomes` are folders `mutants.out`
/// or their files `outcomes.json`.
pub fn record(
    suite: &Suite,
    list: &Path,
    outcomes: &[PathBuf],
    command: &str,
    commit: Option<String>,
) -> Result<bool, Failure> {
    let path = Record::path(suite);
    let before = Record::read(&path)?.map_or_else(Vec::new, |record| record.survivor);
    let known: Vec<Mutant> = json(list)?;
    let runs = outcomes
        .iter()
        .map(|path| json(&if path.is_dir() { path.join("outcomes.json") } else { path.clone() }))
        .collect::<Result<Vec<Outcomes>, _>>()?;
    for (path, _) in outcomes.iter().zip(&runs).filter(|(_, run)| run.end_time.is_none()) {
        eprintln!("{} has not come to its end: what it tried so far is no even sample", path.display());
    }
    let mut record = Record::join(&known, &runs, &before)?;
    record.commit = commit.map_or_else(|| head(suite), Ok)?;
    command.clone_into(&mut record.command);
    let header = "# Written by `verify mutants`; only the reasons are to be edited.\n";
    store(&path, &(header.to_owned() + &toml::to_string(&record)?))?;

    let now: Vec<String> = record.survivor.iter().map(|s| without_place(&s.mutant)).collect();
    for gone in before.iter().filter(|s| s.explained() && !now.contains(&without_place(&s.mutant))) {
        eprintln!("no longer missed, or not tried: {} ({})", gone.mutant, gone.reason);
    }
    for new in record.survivor.iter().filter(|s| !s.explained()) {
        eprintln!("{UNEXPLAINED}: {}", new.mutant);
    }
    let Counts { tried, exist, missed, .. } = record.total;
    eprintln!("{tried} of {exist} mutants tried, {missed} missed · {}", path.display());
    Ok(true)
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?)
}

/// The commit of the sources, and whether they are as committed.
fn head(suite: &Suite) -> Result<String, Failure> {
    let git = |arguments: &[&str]| -> Result<String, Failure> {
        let output = Command::new("git").arg("-C").arg(&suite.root).args(arguments).output();
        let output =
            output.map_err(|e| format!("git cannot be started: {e}; name the sources by --commit"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{}; name the sources by --commit", said.trim()).into());
        }
        Ok(String::from_utf8(output.stdout)?.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short", "HEAD"])?;
    let changed = git(&["status", "--porcelain", "--", "src", "tests"])?;
    Ok(if changed.is_empty() { commit } else { format!("{commit} with changes") })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mutant(name: &str) -> Mutant {
        let file = name.split(':').next().unwrap_or_default().to_owned();
        Mutant { name: name.to_owned(), file }
    }

    fn run(start: &str, outcomes: &[(&str, &str)]) -> Outcomes {
        let text = |(name, summary): &(&str, &str)| {
            let file = name.split(':').next().unwrap_or_default();
            format!(
                r#"{{"scenario": {{"Mutant": {{"name": "{name}", "file": "{file}"}}}}, "summary": "{summary}"}}"#
            )
        };
        let outcomes: Vec<String> = outcomes.iter().map(text).collect();
        let json = format!(
            r#"{{"outcomes": [{{"scenario": "Baseline", "summary": "Success"}}, {}], "start_time": "{start}",
                "cargo_mutants_version": "27.1.0"}}"#,
            outcomes.join(", ")
        );
        serde_json::from_str(&json).expect("the format of outcomes.json")
    }

    const A: &str = "src/solve/step/size.rs:3:5: replace < with <= in grow";
    const B: &str = "src/basis/ancf.rs:9:1: replace - with + in row";
    const C: &str = "src/basis/ancf.rs:9:9: replace - with / in row";
    const D: &str = "src/basis/ancf.rs:20:1: replace row with ()";

    #[test]
    fn runs_are_joined_and_counted_by_folder() {
        let known = [A, B, C, D, "src/basis/mod.rs:1:1: replace new with ()"].map(mutant);
        let runs = [
            run("2026-01-01T10:00:00Z", &[(B, "MissedMutant"), (A, "Timeout"), (D, "Unviable")]),
            run("2026-01-02T10:00:00Z", &[(B, "CaughtMutant"), (C, "MissedMutant")]),
        ];
        let record = Record::join(&known, &runs, &[]).expect("all are known");
        let total = Counts { exist: 5, tried: 4, caught: 1, timed_out: 1, unviable: 1, missed: 1 };
        assert_eq!((record.date.as_str(), record.total), ("2026-01-02", total));
        assert_eq!(record.total.score(), Some(2.0 / 3.0));
        assert_eq!(record.folder.keys().collect::<Vec<_>>(), ["src/basis", "src/solve"]);
        assert_eq!((record.folder["src/basis"].exist, record.folder["src/solve"].timed_out), (4, 1));
        assert_eq!(record.survivor, [Survivor { mutant: C.to_owned(), reason: UNEXPLAINED.to_owned() }]);
        // What is written reads back.
        let text = toml::to_string(&record).expect("serialisable");
        assert_eq!(toml::from_str::<Record>(&text).expect("the same format"), record);
    }

    #[test]
    fn outcomes_of_other_sources_are_refused() {
        let told = |outcomes: &[(&str, &str)]| {
            let joined = Record::join(&[mutant(A)], &[run("2026-01-01", outcomes)], &[]);
            joined.map_err(|e| e.to_string()).expect_err("not of these sources")
        };
        assert!(told(&[(B, "CaughtMutant")]).contains(B));
        assert!(told(&[(A, "Failure")]).contains("Failure"));
    }
}
