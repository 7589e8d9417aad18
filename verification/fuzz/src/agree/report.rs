//! The counts of a campaign.

use std::collections::BTreeMap;
use std::fmt;

use super::judge::{Estimated, Verdict};
use super::vocabulary;
use super::ways::{WAYS, Way};

/// Share of the scenes in which a key should take part.
const LEAST: f64 = 0.005;

/// Counts of one way.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    agree: usize,
    unstable: usize,
    warned: usize,
    refused: usize,
    too_long: usize,
    findings: usize,
    /// The largest disagreement that is no finding, relative to the allowed one.
    nearest: f64,
}

/// Counts of all.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub scenes: usize,
    /// Draws that the reader refused, by reason.
    pub illegal: BTreeMap<String, usize>,
    /// Outcomes of the scenes as they were drawn.
    pub outcomes: BTreeMap<&'static str, usize>,
    /// Reasons of status 1 and 2.
    pub reasons: BTreeMap<String, usize>,
    /// The scene that took longest, with its seconds; only shown.
    pub slowest: (f64, usize),
    keys: BTreeMap<String, usize>,
    ways: [Counts; WAYS.len()],
    estimates: Estimates,
}

/// How good the estimates of errors are.
#[derive(Clone, Copy, Debug, Default)]
struct Estimates {
    /// Runs for an accuracy.
    runs: usize,
    /// Those that are as accurate as that.
    kept: usize,
    /// Those of which the error of the last state is known.
    told: usize,
    /// Those of them whose error is between a fifth and three times the estimate.
    right: usize,
}

impl Estimates {
    fn count(&mut self, found: &Estimated) {
        self.runs += 1;
        self.kept += usize::from(found.error <= found.wanted);
        if let Some([error, estimated]) = found.last {
            self.told += 1;
            self.right += usize::from((0.2..=3.0).contains(&(error / estimated)));
        }
    }
}

impl Report {
    /// Counts a verdict.
    pub fn verdict(&mut self, way: Way, verdict: &Verdict) {
        let counts = &mut self.ways[way as usize];
        match verdict {
            Verdict::NotApplicable => {}
            Verdict::Agrees(share) => {
                counts.agree += 1;
                counts.nearest = counts.nearest.max(*share);
            }
            Verdict::Estimated(found) => {
                counts.agree += 1;
                self.estimates.count(found);
            }
            Verdict::Unstable => counts.unstable += 1,
            Verdict::Warned => counts.warned += 1,
            Verdict::Refused => counts.refused += 1,
            Verdict::TooLong => counts.too_long += 1,
            Verdict::Finding(_) => counts.findings += 1,
        }
    }

    /// Counts the keys of a scene.
    pub fn scene(&mut self, scene: &toml::Table) {
        self.scenes += 1;
        vocabulary::count(scene, &mut self.keys);
    }

    /// Keys of the schema that take part in fewer scenes than they should, with their shares.
    pub fn rare(&self) -> Vec<(String, f64)> {
        let share =
            |key: &String| self.keys.get(key).copied().unwrap_or(0) as f64 / self.scenes.max(1) as f64;
        let all = vocabulary::keys().into_iter().map(|key| (share(&key), key));
        all.filter(|(share, _)| *share < LEAST).map(|(share, key)| (key, share)).collect()
    }

    /// Adds the counts of another.
    pub fn add(&mut self, other: Self) {
        self.scenes += other.scenes;
        if other.slowest.0 > self.slowest.0 {
            self.slowest = other.slowest;
        }
        for (into, from) in [
            (&mut self.illegal, other.illegal),
            (&mut self.reasons, other.reasons),
            (&mut self.keys, other.keys),
        ] {
            for (key, n) in from {
                *into.entry(key).or_default() += n;
            }
        }
        for (key, n) in other.outcomes {
            *self.outcomes.entry(key).or_default() += n;
        }
        let (into, from) = (&mut self.estimates, other.estimates);
        into.runs += from.runs;
        into.kept += from.kept;
        into.told += from.told;
        into.right += from.right;
        for (into, from) in self.ways.iter_mut().zip(other.ways) {
            into.agree += from.agree;
            into.unstable += from.unstable;
            into.warned += from.warned;
            into.refused += from.refused;
            into.too_long += from.too_long;
            into.findings += from.findings;
            into.nearest = into.nearest.max(from.nearest);
        }
    }

    /// How often each key took part.
    pub fn keys(&self) -> String {
        let lines = vocabulary::keys().into_iter().map(|key| {
            let n = self.keys.get(&key).copied().unwrap_or(0);
            format!("{:7.2} %  {key}\n", 100.0 * n as f64 / self.scenes.max(1) as f64)
        });
        lines.collect()
    }
}

/// A message without its numbers, so that alike ones are counted together.
pub fn alike(message: &str) -> String {
    let kept: String = message.chars().filter(|c| !c.is_ascii_digit()).collect();
    kept.chars().take(110).collect()
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let outcomes: Vec<String> = self.outcomes.iter().map(|(name, n)| format!("{n} {name}")).collect();
        writeln!(f, "{} scenes: {}", self.scenes, outcomes.join(", "))?;
        writeln!(f, "slowest: scene {}, {:.1} s", self.slowest.1, self.slowest.0)?;
        let drawn: usize = self.illegal.values().sum();
        writeln!(f, "{drawn} draws were not legal:")?;
        for (title, counts) in [("", &self.illegal), ("without a result:", &self.reasons)] {
            if !title.is_empty() {
                writeln!(f, "{title}")?;
            }
            let mut sorted: Vec<_> = counts.iter().collect();
            sorted.sort_by_key(|(_, n)| std::cmp::Reverse(**n));
            for (reason, n) in sorted.iter().take(8) {
                writeln!(f, "{n:7}  {reason}")?;
            }
        }
        writeln!(
            f,
            "{:12}{:>8}{:>8}{:>10}{:>8}{:>9}{:>9}{:>10}{:>12}",
            "way", "runs", "agree", "unstable", "warned", "refused", "too long", "findings", "of allowed"
        )?;
        for (way, c) in WAYS.iter().zip(&self.ways) {
            let runs = c.agree + c.unstable + c.warned + c.refused + c.too_long + c.findings;
            writeln!(
                f,
                "{:12}{runs:8}{:8}{:10}{:8}{:9}{:9}{:10}{:12.3}",
                way.name(),
                c.agree,
                c.unstable,
                c.warned,
                c.refused,
                c.too_long,
                c.findings,
                c.nearest
            )?;
        }
        let Estimates { runs, kept, told, right } = self.estimates;
        writeln!(
            f,
            "accuracy: {kept} of {runs} as accurate as wanted; {right} of {told} errors between a fifth and three times the estimate"
        )?;
        let rare = self.rare();
        writeln!(f, "{} keys of the schema in less than {} % of the scenes", rare.len(), 100.0 * LEAST)?;
        for (key, share) in rare {
            writeln!(f, "{:7.2} %  {key}", 100.0 * share)?;
        }
        Ok(())
    }
}
