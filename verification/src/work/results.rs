//! The files of a measurement: `<problem>.json` with everything, `<problem>.csv` with a row per
//! setting.

use std::path::Path;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::claim::Verdict;
use super::price::Paid;
use super::problem::{Code, LeftOut};
use crate::Failure;

/// How many times as fast as the next ours should be.
pub const LEAD: f64 = 5.0;

/// A problem with its results.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Results {
    /// Name of the problem's file.
    pub name: String,
    /// A few words.
    pub title: String,
    /// A description of the problem.
    pub about: String,
    /// When it was measured.
    pub date: String,
    /// Processor and system.
    pub machine: String,
    /// The other codes with their versions.
    pub tools: String,
    /// Whether slow settings were left out.
    pub quick: bool,
    /// Errors, by name.
    pub norm: IndexMap<String, Norm>,
    /// One per setting that came to its end, method by method.
    pub points: Vec<Point>,
    /// Why ours is not [`LEAD`] times as fast as any other code everywhere, where it is not.
    #[serde(default)]
    pub narrow: String,
    /// The outcomes of the claims.
    pub claims: Vec<Verdict>,
    /// What an accuracy alone costs, by accuracy.
    pub prices: Vec<Paid>,
    /// The settings that are missing, by decision or because they failed.
    pub left_out: Vec<LeftOut>,
}

/// How an error is taken.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Norm {
    /// Label of the axis.
    pub title: String,
    /// Title of the reference.
    pub reference: String,
    /// How much it can be trusted.
    pub class: String,
    /// How good it is.
    pub why: String,
}

/// One setting of one method.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Point {
    /// The code.
    pub code: Code,
    /// Name of the method.
    pub method: String,
    /// Name of its line in the diagram.
    pub line: String,
    /// The setting in one line; empty where the method has only one.
    pub setting: String,
    /// The accuracy for which the setting was chosen, where it was.
    pub wanted: Option<f64>,
    /// Errors by norm.
    pub error: IndexMap<String, f64>,
    /// Times of the solution alone \[s\].
    pub seconds: Spread,
    /// Times of the preparation: shape functions, tables, patterns \[s\]; none for Exudyn.
    pub build: Option<Spread>,
    /// Times of the whole run, with all that is recorded of it \[s\]; ours only.
    #[serde(default)]
    pub whole: Option<Spread>,
    /// Unknowns; ours only.
    pub degrees_of_freedom: Option<usize>,
    /// Steps in time or load.
    pub steps: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Evaluations of the tangent.
    pub tangent_evaluations: usize,
    /// Factorisations.
    pub factorizations: usize,
}

impl Point {
    /// Method and setting in one line.
    pub fn name(&self) -> String {
        if self.setting.is_empty() { self.line.clone() } else { format!("{}: {}", self.line, self.setting) }
    }

    /// A run of a code with this error in the norm `tip` and this time, of which nothing else is
    /// known.
    #[cfg(test)]
    pub(super) fn example(code: Code, error: f64, seconds: f64) -> Self {
        Self {
            code,
            method: "m".into(),
            line: "m".into(),
            setting: String::new(),
            wanted: None,
            error: [("tip".to_owned(), error)].into(),
            seconds: Spread::of(&[seconds]),
            build: None,
            whole: None,
            degrees_of_freedom: None,
            steps: 0,
            newton_iterations: 0,
            tangent_evaluations: 0,
            factorizations: 0,
        }
    }
}

/// Times of several runs \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The middle one, or the mean of the middle two.
    pub median: f64,
    /// The shortest.
    pub least: f64,
    /// The longest.
    pub largest: f64,
    /// How many there were.
    pub runs: usize,
}

impl Spread {
    /// The spread of one number or more; NaN for none.
    pub fn of(seconds: &[f64]) -> Self {
        let mut sorted = seconds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let runs = sorted.len();
        let at = |k: usize| sorted.get(k).copied().unwrap_or(f64::NAN);
        let median = f64::midpoint(at(runs.saturating_sub(1) / 2), at(runs / 2));
        Self { median, least: at(0), largest: at(runs.saturating_sub(1)), runs }
    }
}

impl Results {
    /// Writes the files into a folder.
    ///
    /// # Errors
    /// Where they cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        let put = |name: String, text: String| {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
        };
        put(format!("{}.json", self.name), serde_json::to_string_pretty(self)?)?;
        put(format!("{}.csv", self.name), self.csv()?)?;
        for norm in self.norm.keys() {
            put(format!("{}.{norm}.svg", self.name), super::diagram::diagram(self, norm)?)?;
        }
        Ok(())
    }

    /// Reads what [`Results::write`] wrote; none where there is no such file.
    ///
    /// # Errors
    /// Where there is one, but not of this version.
    pub fn read(folder: &Path, name: &str) -> Result<Option<Self>, Failure> {
        let path = folder.join(format!("{name}.json"));
        match std::fs::read_to_string(&path) {
            Ok(text) => Ok(Some(serde_json::from_str(&text).map_err(|e| {
                format!("{}: {e}; measure it again by `verify work-precision {name}`", path.display())
            })?)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{}: {error}", path.display()).into()),
        }
    }

    /// A row per setting.
    fn csv(&self) -> Result<String, Failure> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let errors = self.norm.keys().map(|norm| format!("error_{norm}"));
        let first = ["code", "method", "setting"].map(str::to_owned);
        let rest = [
            "seconds_median",
            "seconds_min",
            "seconds_max",
            "runs",
            "build_seconds",
            "degrees_of_freedom",
            "steps",
            "newton_iterations",
            "tangents",
            "factorisations",
        ]
        .map(str::to_owned);
        table.write_record(first.into_iter().chain(errors).chain(rest))?;
        for point in &self.points {
            let optional = |value: Option<f64>| value.map(|v| format!("{v:e}")).unwrap_or_default();
            let first = [point.code.name().to_owned(), point.line.clone(), point.setting.clone()];
            let errors = self.norm.keys().map(|norm| optional(point.error.get(norm).copied()));
            let seconds = point.seconds;
            let times = [seconds.median, seconds.least, seconds.largest].map(|s| format!("{s:e}"));
            let rest = [
                seconds.runs.to_string(),
                optional(point.build.map(|b| b.median)),
                point.degrees_of_freedom.map(|n| n.to_string()).unwrap_or_default(),
                point.steps.to_string(),
                point.newton_iterations.to_string(),
                point.tangent_evaluations.to_string(),
                point.factorizations.to_string(),
            ];
            table.write_record(first.into_iter().chain(errors).chain(times).chain(rest))?;
        }
        Ok(String::from_utf8(table.into_inner()?)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_or_between_the_middle_two() {
        assert_eq!(Spread::of(&[3.0, 1.0, 9.0]), Spread { median: 3.0, least: 1.0, largest: 9.0, runs: 3 });
        assert_eq!(Spread::of(&[4.0, 1.0, 2.0, 9.0]).median, 3.0);
        assert!(Spread::of(&[]).median.is_nan());
    }
}
