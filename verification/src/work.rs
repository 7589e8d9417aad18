//! What accuracy costs: error against time of ours and of other codes, in the same process and
//! minute.
//!
//! ```text
//! work-precision/<name>.toml ──► Problem ──► Task per setting ──► times, errors ──► Point
//!                                            Point ──► claims, diagram, csv, json
//! ```
//!
//! All settings of a problem, ours and theirs in turn, run once before any runs again, so that a
//! machine that becomes slower becomes so for all. Timed is the solution alone, on one thread, with
//! no other output than the error needs. One function, that of the verification cases, takes every
//! error.

mod claim;
mod decade;
mod diagram;
pub mod peer;
mod price;
mod problem;
mod results;

pub use claim::{Cheapest, Verdict, cheapest, on_front};
pub use decade::{DECADES, Decade, decades, others};
pub use diagram::diagram;
pub use price::Paid;
pub use problem::{Claim, Code, Faster, LeftOut, Method, Price, Problem, names, problem};
pub use results::{LEAD, Norm, Point, Results, Spread};

use std::time::{Duration, Instant};

use ancf::accuracy;
use ancf::results::Results as Found;
use ancf::run::Options;
use ancf::scene::Scene;
use ancf_check::compare::member as compare;
use ancf_check::execute::Run;
use ancf_check::family::{Member, members};
use ancf_check::quantity;
use ancf_check::reference::Table;
use ancf_check::{Suite, case::Check};
use indexmap::IndexMap;

use crate::Failure;

/// Times that every setting takes its turn, unless it is slow.
const ROUNDS: usize = 3;
/// In one turn a setting runs until this time is over \[s\] …
const TURN: f64 = 0.02;
/// … but not more often than this.
const OFTEN: f64 = 7.0;

/// One setting, and the results of its runs so far.
struct Task<'a> {
    key: &'a str,
    method: &'a Method,
    member: Member,
    scene: Scene,
    settings: IndexMap<String, String>,
    /// Of the solution, its preparation and both with all that is recorded \[s\].
    seconds: Vec<f64>,
    build: Vec<f64>,
    whole: Vec<f64>,
    outcome: Option<Result<Found, String>>,
}

/// When, where and with which programs something is measured.
pub struct Made {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
    /// Programs with versions.
    pub tools: String,
}

/// Measures a problem. `tell` is called before each run of a setting, with the part that is done
/// and the setting's name.
///
/// # Errors
/// Where the problem cannot be set up: illegal scenes, missing references. A setting that fails is
/// left out with its reason.
pub fn measure(
    suite: &Suite,
    name: &str,
    problem: &Problem,
    quick: bool,
    made: Made,
    tell: &mut dyn FnMut(f64, &str),
) -> Result<Results, Failure> {
    let tables = tables(suite, problem)?;
    let mut left_out = problem.left_out.clone();
    let mut tasks = Vec::new();
    let alone = problem.price.as_ref().map(|price| ("accuracy".to_owned(), price.method()));
    for (key, method) in problem.method.iter().chain(alone.iter().map(|(key, method)| (key, method))) {
        if quick && method.slow {
            left_out.push(LeftOut { what: method.label.clone(), why: "slow; left out by --quick".into() });
            continue;
        }
        for member in members(&method.family(&problem.set)).map_err(|e| format!("[method.{key}]: {e}"))? {
            let path = suite.cases_folder().join(&problem.case).join(&member.scene);
            let mut scene = Scene::load(&path, &member.set)?;
            if method.code == Code::Accuracy {
                scene = scene.opened(member.fill("{accuracy}")?.parse()?)?;
            }
            let settings = method
                .settings
                .iter()
                .map(|(name, value)| Ok((name.clone(), member.fill(&value.to_string())?)))
                .collect::<Result<_, String>>()?;
            let [seconds, build, whole] = [const { Vec::new() }; 3];
            tasks.push(Task { key, method, member, scene, settings, seconds, build, whole, outcome: None });
        }
    }
    let order = alternating(&tasks.iter().map(|task| task.method.code).collect::<Vec<_>>());
    for round in 0..ROUNDS {
        for (done, &index) in order.iter().enumerate() {
            let task = &mut tasks[index];
            let part = (round as f64 + done as f64 / order.len() as f64) / ROUNDS as f64;
            tell(part, &format!("{name}: {}, {}", task.method.label, task.member.label()));
            let failed = task.outcome.as_ref().is_some_and(Result::is_err);
            if !failed && (round == 0 || !task.method.slow) {
                task.turn();
            }
        }
    }
    let mut points = Vec::new();
    for task in tasks {
        let (line, setting) = (task.method.label.as_str(), task.member.label());
        match task.point(&problem.norm, &tables) {
            Ok(point) => points.push(point),
            Err(why) => leave_out(&mut left_out, line, &setting, why),
        }
    }
    let norm = problem.norm.iter().map(|(key, check)| {
        let provenance = check.oracle.as_ref().and_then(|o| tables.get(o)).map(|table| &table.provenance);
        let norm = Norm {
            title: check.title.clone().unwrap_or_default(),
            reference: provenance.map(|p| p.title.clone()).unwrap_or_default(),
            class: provenance.map(|p| p.class.word().to_owned()).unwrap_or_default(),
            why: check.why.trim().to_owned(),
        };
        (key.clone(), norm)
    });
    Ok(Results {
        name: name.to_owned(),
        title: problem.title.clone(),
        about: problem.about.trim().to_owned(),
        date: made.date,
        machine: made.machine,
        tools: made.tools,
        quick,
        norm: norm.collect(),
        prices: problem.price.iter().flat_map(|price| price::paid(price, &points)).collect(),
        narrow: problem.narrow.trim().to_owned(),
        claims: problem.claim.iter().map(|claim| claim::judge(claim, &points)).collect(),
        points,
        left_out,
    })
}

/// The references of all norms, by the names that the norms give them.
fn tables(suite: &Suite, problem: &Problem) -> Result<IndexMap<String, Table>, Failure> {
    let names = problem.norm.values().filter_map(|check| check.oracle.as_ref());
    names
        .map(|name| {
            let (case, oracle) = name.split_once('/').unwrap_or(("", name));
            Ok((name.clone(), suite.table(case, oracle)?))
        })
        .collect()
}

/// Notes a setting that failed, in one entry with those of its line that failed alike.
fn leave_out(list: &mut Vec<LeftOut>, line: &str, setting: &str, why: String) {
    let first = format!("{line}: ");
    match list.iter_mut().find(|entry| entry.why == why && entry.what.starts_with(&first)) {
        Some(entry) => entry.what.push_str(&format!("; {setting}")),
        None => list.push(LeftOut { what: format!("{first}{setting}"), why }),
    }
}

/// Numbers of the settings in the order in which they run: ours and theirs in turn as long as there
/// are both.
fn alternating(codes: &[Code]) -> Vec<usize> {
    let of = |ours: bool| (0..codes.len()).filter(move |&k| codes[k].is_ours() == ours);
    let (mut ours, mut theirs) = (of(true), of(false));
    let pairs = (0..codes.len()).flat_map(|_| [ours.next(), theirs.next()]);
    pairs.flatten().collect()
}

impl Task<'_> {
    /// Runs the setting as often as one turn allows.
    fn turn(&mut self) {
        let mut outcome = self.run(1);
        let often = self.seconds.last().map_or(0.0, |took| (TURN / took).clamp(0.0, OFTEN)) as usize;
        if outcome.is_ok() && often > 0 {
            // The first run of a turn finds nothing in the processor's caches: of short runs it is
            // no measurement.
            self.seconds.pop();
            self.build.pop();
            self.whole.pop();
            outcome = self.run(often);
        }
        self.outcome = Some(outcome);
    }

    fn run(&mut self, repeat: usize) -> Result<Found, String> {
        match self.method.code {
            Code::Ours => {
                let mut last = Err("it was not run".to_owned());
                for _ in 0..repeat {
                    let clock = Instant::now();
                    let run = self.scene.model().solve(self.scene.analysis());
                    let results = run.map_err(|e| e.to_string())?;
                    self.whole.push(clock.elapsed().as_secs_f64());
                    self.seconds.push(results.run().seconds.solve);
                    self.build.push(results.run().seconds.build);
                    last = Ok(results);
                }
                last
            }
            Code::Accuracy => {
                let mut last = Err("it was not run".to_owned());
                for _ in 0..repeat {
                    let clock = Instant::now();
                    let results =
                        accuracy::run(&self.scene, Options::default()).map_err(|e| e.to_string())?;
                    self.seconds.push(clock.elapsed().as_secs_f64());
                    last = Ok(results);
                }
                last
            }
            other => {
                let timed =
                    peer::solve(other, (self.scene.model(), self.scene.analysis()), &self.settings, repeat)
                        .map_err(|e| e.to_string())?;
                self.seconds.extend(timed.seconds);
                self.build.extend(timed.build);
                Ok(timed.results)
            }
        }
    }

    /// The times, errors and counts of the setting.
    fn point(
        self,
        norms: &IndexMap<String, Check>,
        tables: &IndexMap<String, Table>,
    ) -> Result<Point, String> {
        let results = self.outcome.unwrap_or_else(|| Err("it was not run".into()))?;
        let (statistics, unknowns) = (results.run().statistics, results.run().degrees_of_freedom);
        let wanted = results.run().error.as_ref().and_then(|error| Some(error.wanted?.result));
        let run = Run {
            label: self.member.label(),
            member: self.member,
            result: quantity::Result::Solved(Box::new(results)),
            took: Duration::ZERO,
        };
        let error = norms
            .iter()
            .map(|(name, check)| {
                let error = compare(tables, 0, check, 0, &run)?.error;
                if error.is_finite() { Ok((name.clone(), error)) } else { Err(format!("{name}: no number")) }
            })
            .collect::<Result<_, String>>()?;
        let ours = self.method.code.is_ours();
        Ok(Point {
            code: self.method.code,
            method: self.key.to_owned(),
            line: self.method.label.clone(),
            setting: run.label,
            wanted,
            error,
            seconds: Spread::of(&self.seconds),
            build: (!self.build.is_empty()).then(|| Spread::of(&self.build)),
            whole: (!self.whole.is_empty()).then(|| Spread::of(&self.whole)),
            degrees_of_freedom: ours.then_some(unknowns),
            steps: statistics.steps.max(statistics.load_steps),
            newton_iterations: statistics.newton_iterations,
            tangent_evaluations: statistics.tangent_evaluations,
            factorizations: statistics.factorizations,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_failed_alike_is_one_entry() {
        let mut list = Vec::new();
        for (line, setting, why) in [("A", "1", "x"), ("A", "2", "x"), ("A", "3", "y"), ("B", "1", "x")] {
            leave_out(&mut list, line, setting, why.to_owned());
        }
        let what: Vec<_> = list.iter().map(|entry| entry.what.as_str()).collect();
        assert_eq!(what, ["A: 1; 2", "A: 3", "B: 1"]);
    }

    #[test]
    fn ours_and_theirs_take_turns() {
        use Code::{Exudyn, Ours};
        assert_eq!(alternating(&[Ours, Ours, Ours, Exudyn, Exudyn]), [0, 3, 1, 4, 2]);
        assert_eq!(alternating(&[Exudyn, Exudyn]), [0, 1]);
        assert!(alternating(&[]).is_empty());
    }
}
