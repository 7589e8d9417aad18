//! `verification/mutants.toml`: what was tried, and a reason for every survivor.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::find::{Mutant, folder_of};
use crate::reasons::{Survivor, UNEXPLAINED, explain, without_place};
use crate::trial::Outcome;

/// The contents of the file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Record {
    /// Day of the run.
    pub date: String,
    /// The commit of the sources.
    pub commit: String,
    /// The command that repeats the run.
    pub command: String,
    /// When its survivors were tried last, with tests that were written since.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub again: Option<Again>,
    /// Over all folders.
    pub total: Counts,
    /// By source folder.
    pub folder: IndexMap<String, Counts>,
    /// Missed mutants in the order of the sources.
    #[serde(default)]
    pub survivor: Vec<Survivor>,
}

/// A run with the survivors of a record.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Again {
    /// Day of the run.
    pub date: String,
    /// The commit of the sources and the tests.
    pub commit: String,
}

/// Numbers of mutants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Counts {
    /// Mutants that exist.
    pub exist: usize,
    /// Mutants that were tried: the sum of all that follow.
    pub tried: usize,
    /// Mutants with which a test failed.
    pub caught: usize,
    /// Mutants with which the tests did not come to their end.
    pub timed_out: usize,
    /// Mutants that did not compile.
    pub unviable: usize,
    /// Mutants with which all tests passed.
    pub missed: usize,
}

impl Counts {
    /// Tried and compiled.
    pub fn viable(&self) -> usize {
        self.tried - self.unviable.min(self.tried)
    }

    /// Part of the mutants that was caught, those timed out among them, of those that could be: the
    /// viable ones without `equivalent` survivors. None where there were none.
    pub fn score(&self, equivalent: usize) -> Option<f64> {
        let could = self.viable() - equivalent.min(self.viable());
        (could > 0).then(|| (self.caught + self.timed_out) as f64 / could as f64)
    }
}

impl Record {
    /// Where the record of a repository lies.
    pub fn path(root: &Path) -> PathBuf {
        root.join("verification").join("mutants.toml")
    }

    /// Reads it; none where there is no such file.
    pub fn read(path: &Path) -> Result<Option<Self>, Failure> {
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Some(toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{}: {error}", path.display()).into()),
        }
    }

    /// Survivors of a folder, or of all, with which nothing is different.
    pub fn equivalent(&self, folder: Option<&str>) -> usize {
        let inside = |s: &&Survivor| folder.is_none_or(|name| folder_of(&s.mutant) == name);
        self.survivor.iter().filter(|s| s.equivalent).filter(inside).count()
    }

    /// Folders with their numbers and scores, then all.
    pub fn scores(&self) -> impl Iterator<Item = (&str, &Counts, Option<f64>)> {
        let of = |name, counts: &Counts| counts.score(self.equivalent(name));
        let folders = self
            .folder
            .iter()
            .map(move |(name, counts)| (name.as_str(), counts, of(Some(name.as_str()), counts)));
        folders.chain([("all", &self.total, of(None, &self.total))])
    }

    /// Counts the outcomes of the mutants that were tried, and keeps the reasons of an earlier
    /// record.
    pub fn of(
        all: &[Mutant],
        unviable: &BTreeSet<usize>,
        outcomes: &BTreeMap<usize, Outcome>,
        reasons: &[Survivor],
    ) -> Self {
        let (mut total, mut folder) = (Counts::default(), IndexMap::<String, Counts>::new());
        let mut missed = Vec::new();
        for (number, mutant) in all.iter().enumerate() {
            let outcome = outcomes.get(&number);
            for counts in [folder.entry(mutant.folder()).or_default(), &mut total] {
                counts.exist += 1;
                counts.tried += usize::from(outcome.is_some() || unviable.contains(&number));
                counts.unviable += usize::from(unviable.contains(&number));
                match outcome {
                    Some(Outcome::Caught(_)) => counts.caught += 1,
                    Some(Outcome::TimedOut(_)) => counts.timed_out += 1,
                    Some(Outcome::Missed(_)) => counts.missed += 1,
                    None => {}
                }
            }
            if let Some(Outcome::Missed(_)) = outcome {
                missed.push(mutant.name());
            }
        }
        folder.sort_unstable_keys();
        let missed: Vec<&str> = missed.iter().map(String::as_str).collect();
        let (date, commit, command) = Default::default();
        let survivor = explain(&missed, reasons);
        Self { date, commit, command, again: None, total, folder, survivor }
    }

    /// Which of `all` mutants each survivor is: of those that read alike the one of the same rank, where there were as many in the sources of
    /// the record, `then`; else it may be any of them.
    pub fn survivors_among(&self, then: &[Mutant], all: &[Mutant]) -> Vec<Vec<usize>> {
        let meant = |survivor: &Survivor| {
            let text = without_place(&survivor.mutant);
            let reads_alike = |mutant: &&Mutant| without_place(&mutant.name()) == text;
            let now: Vec<usize> = (0..all.len()).filter(|i| reads_alike(&&all[*i])).collect();
            let then: Vec<String> = then.iter().filter(reads_alike).map(Mutant::name).collect();
            let rank = then.iter().position(|name| *name == survivor.mutant);
            match rank {
                Some(rank) if then.len() == now.len() => vec![now[rank]],
                _ => now,
            }
        };
        self.survivor.iter().map(meant).collect()
    }

    /// Counts survivors that were tried again, as the mutants that they are `among` all, and are no longer missed as caught or timed out. One
    /// that was not tried, because its line is gone or does not compile, stays a survivor, and so does one that may be another that is missed.
    pub fn try_again(&mut self, among: &[Vec<usize>], outcomes: &BTreeMap<usize, Outcome>, again: Again) {
        let is_late = |numbers: &Vec<usize>| {
            let outcomes: Vec<&Outcome> = numbers.iter().filter_map(|number| outcomes.get(number)).collect();
            let missed = outcomes.iter().any(|outcome| matches!(outcome, Outcome::Missed(_)));
            let late = outcomes.iter().all(|outcome| matches!(outcome, Outcome::TimedOut(_)));
            (!outcomes.is_empty() && !missed).then_some(late)
        };
        let found: Vec<Option<bool>> = among.iter().map(is_late).collect();
        for (survivor, late) in self.survivor.iter().zip(&found) {
            let Some(late) = *late else { continue };
            let folder = self.folder.get_mut(&folder_of(&survivor.mutant));
            for counts in folder.into_iter().chain([&mut self.total]) {
                counts.missed = counts.missed.saturating_sub(1);
                *(if late { &mut counts.timed_out } else { &mut counts.caught }) += 1;
            }
        }
        let mut found = found.iter();
        self.survivor.retain(|_| found.next().is_none_or(Option::is_none));
        self.again = Some(again);
    }

    /// Writes it, and says what is new of the survivors.
    pub fn store(&self, path: &Path, before: &[Survivor]) -> Result<(), Failure> {
        let header =
            "# Written by `ancf-mutants`; only `reason` and `equivalent` of survivors are to be edited.\n";
        std::fs::write(path, header.to_owned() + &toml::to_string(self)?)
            .map_err(|e| format!("{}: {e}", path.display()))?;
        let now: Vec<String> = self.survivor.iter().map(|s| without_place(&s.mutant)).collect();
        for gone in before.iter().filter(|s| s.explained() && !now.contains(&without_place(&s.mutant))) {
            eprintln!("no longer missed, or not tried: {} ({})", gone.mutant, gone.reason);
        }
        for new in self.survivor.iter().filter(|s| !s.explained()) {
            eprintln!("{UNEXPLAINED}: {}", new.mutant);
        }
        Ok(())
    }

    /// Says what part was caught.
    pub fn tell(&self) {
        for (name, counts, score) in self.scores().filter(|(_, counts, _)| counts.tried > 0) {
            let part = score.map_or("–".to_owned(), |s| format!("{:.0} %", 100.0 * s));
            eprintln!("{name}: {part} of {} caught", counts.viable());
        }
        let Counts { exist, missed, .. } = self.total;
        let (viable, equivalent) = (self.total.viable(), self.equivalent(None));
        eprintln!(
            "{viable} viable of {exist} mutants tried, {missed} missed, {equivalent} of them equivalent"
        );
    }
}

/// The text of a file at a commit; `None` where git does not have it.
pub fn text_at(root: &Path, commit: &str, file: &str) -> Option<String> {
    let of = format!("{commit}:{file}");
    let output = Command::new("git").arg("-C").arg(root).args(["show", &of]).output().ok()?;
    output.status.success().then(|| String::from_utf8(output.stdout).ok()).flatten()
}

/// The commit of the sources, and whether they are as committed.
pub fn head(root: &Path) -> Result<String, Failure> {
    let git = |arguments: &[&str]| -> Result<String, Failure> {
        let output = Command::new("git").arg("-C").arg(root).args(arguments).output();
        let output = output.map_err(|e| format!("git cannot be started: {e}"))?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned().into());
        }
        Ok(String::from_utf8(output.stdout)?.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short", "HEAD"])?;
    let changed = git(&["status", "--porcelain", "--", "src", "tests", "verification/check"])?;
    Ok(if changed.is_empty() { commit } else { format!("{commit} with changes") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find::Edit;

    /// Would catch a mutant counted twice, in another folder, or as what it was not.
    #[test]
    fn outcomes_are_counted_by_folder_and_reasons_kept() {
        let edit = Edit::Body { at: 0, value: None };
        let mutant = |file: &str, line: usize| Mutant {
            file: file.to_owned(),
            line,
            column: 1,
            change: "leave the body out in f".to_owned(),
            edit: edit.clone(),
        };
        let all = [
            mutant("src/solve/a.rs", 1),
            mutant("src/basis/a.rs", 1),
            mutant("src/basis/a.rs", 2),
            mutant("src/basis.rs", 1),
            mutant("src/basis.rs", 9),
        ];
        let outcomes = BTreeMap::from([
            (0, Outcome::TimedOut("t".to_owned())),
            (1, Outcome::Caught("t".to_owned())),
            (3, Outcome::Missed(2)),
        ]);
        let reason = Survivor {
            mutant: "src/basis.rs:70:4: leave the body out in f".to_owned(),
            reason: "Equal either way.".to_owned(),
            equivalent: true,
        };
        let record = Record::of(&all, &BTreeSet::from([2]), &outcomes, std::slice::from_ref(&reason));
        let total = Counts { exist: 5, tried: 4, caught: 1, timed_out: 1, unviable: 1, missed: 1 };
        assert_eq!((record.total, record.total.score(0)), (total, Some(2.0 / 3.0)));
        // What nobody could catch does not count.
        let scores: Vec<_> = record.scores().map(|(name, _, score)| (name, score)).collect();
        assert_eq!(scores, [("src/basis", Some(1.0)), ("src/solve", Some(1.0)), ("all", Some(1.0))]);
        assert_eq!(record.folder.keys().collect::<Vec<_>>(), ["src/basis", "src/solve"]);
        let basis = Counts { exist: 4, tried: 3, caught: 1, timed_out: 0, unviable: 1, missed: 1 };
        assert_eq!(record.folder["src/basis"], basis);
        let moved = "src/basis.rs:1:1: leave the body out in f".to_owned();
        assert_eq!(record.survivor, [Survivor { mutant: moved, ..reason }]);
        // Caught by a test that was written since.
        let mut later = record.clone();
        let again = Again { date: "2026-01-03".to_owned(), commit: "abc".to_owned() };
        let among = record.survivors_among(&[], &all);
        assert_eq!(among, [[3, 4]], "either of the two that read alike");
        later.try_again(&among, &BTreeMap::from([(3, Outcome::Caught("t".to_owned()))]), again.clone());
        assert_eq!((later.total, later.survivor.len()), (Counts { caught: 2, missed: 0, ..total }, 0));
        assert_eq!((later.folder["src/basis"].caught, later.again.as_ref()), (2, Some(&again)));
        later = record.clone();
        let one_of_both = [(3, Outcome::Missed(2)), (4, Outcome::Caught("t".to_owned()))];
        later.try_again(&among, &BTreeMap::from(one_of_both), again);
        assert_eq!((later.total, &later.survivor), (record.total, &record.survivor));
        // The first of two in its file then, and now.
        let then = [mutant("src/basis.rs", 1), mutant("src/basis.rs", 5)];
        assert_eq!(record.survivors_among(&then, &all), [[3]]);
        assert_eq!(record.survivors_among(&then[..1], &all), [[3, 4]]);
        // The file reads back as it was written.
        let text = toml::to_string(&record).expect("serialisable");
        assert_eq!(toml::from_str::<Record>(&text).expect("the same format"), record);
    }
}
