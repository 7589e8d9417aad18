//! `verify accuracy`: what estimated errors are worth.
//!
//! ```text
//! scene of a case ─► basis, integrator, tolerance taken out ─┬─► accuracy 1e-2 … 1e-7 ─► results, estimated error ─┐
//!                                                            └─► accuracy 1e-9 ─────────► truth ────────────────────┴─► true error
//!                                                                                           └─► the case's own references
//! ```
//!
//! The truth is the solver's own, on a mesh and with steps far finer than those that are judged. It
//! is held against the references of the case in its turn, with the case's tolerances.

use std::collections::HashSet;
use std::path::Path;
use std::time::{Duration, Instant};

use ancf::accuracy;
use ancf::cost::Deviation;
use ancf::model::{Accuracy, Analysis, Model, Place, Probe};
use ancf::results::Results;
use ancf::run::{Control, Options, Progress};
use ancf::scene::Scene;
use ancf_check::case::{Family, Order};
use ancf_check::compare::member as compare;
use ancf_check::execute::Run;
use ancf_check::family::{Member, members};
use ancf_check::reference::Table;
use ancf_check::{Case, Suite, quantity};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::report::{machine, now};
use crate::{Failure, chosen, parallel};

/// Where the results are written, and where the report looks for them, from the root of the
/// repository.
pub const FILE: &str = "target/verification/accuracy.json";
/// The accuracies that are asked for.
pub const WANTED: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// That of the truth …
const TRUTH: f64 = 1e-9;
/// … and of motions, which are dearer: the first that can be had.
const TRUTHS_OF_MOTIONS: [f64; 2] = [1e-8, 1e-6];
/// A truth that may err by more than this part of an error tells nothing about that.
const GOOD_ENOUGH: f64 = 0.2;
/// Places of every beam whose positions are compared.
const PLACES: usize = 33;
/// Most time for one accuracy of a scene.
const LONGEST: Duration = Duration::from_secs(25);
/// Part of the runs whose true error may be larger than what was wanted.
const MISSED: f64 = 0.005;
/// Part of the runs whose true error is to be within [`RANGE`].
const WITHIN: f64 = 0.95;
/// True errors in their estimates.
pub const RANGE: [f64; 2] = [0.2, 3.0];

/// One day's measurement.
#[derive(Deserialize, Serialize)]
pub struct Worth {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
    /// Scenes that differ in more than what an accuracy chooses.
    pub scenes: Vec<SceneWorth>,
}

/// A scene.
#[derive(Deserialize, Serialize)]
pub struct SceneWorth {
    /// Its case.
    pub case: String,
    /// Which of the case's scenes.
    pub label: String,
    /// `static`, `dynamic`, `modal` or `buckling`.
    pub analysis: String,
    /// The truth, or why there is none.
    pub truth: Result<Truth, String>,
    /// By accuracy, in the order of [`WANTED`].
    pub runs: Vec<Result<Judged, String>>,
}

/// What errors are held against.
#[derive(Deserialize, Serialize)]
pub struct Truth {
    /// Its own estimated error.
    pub estimated: f64,
    /// How many of the case's checks it keeps, …
    pub kept: usize,
    /// … and those that it does not, with error and tolerance.
    pub missed: Vec<String>,
}

/// A run.
#[derive(Clone, Copy, Deserialize, Serialize)]
pub struct Judged {
    /// Largest error that was wanted.
    pub wanted: f64,
    /// Whether the run says that it is as accurate as that.
    pub met: bool,
    /// Its estimate.
    pub estimated: f64,
    /// Its true error.
    pub error: f64,
    /// Whether the truth is good enough to tell that error.
    pub told: bool,
    /// Unknowns of what was chosen.
    pub degrees_of_freedom: usize,
}

impl Judged {
    /// True error in the estimate.
    pub fn ratio(&self) -> f64 {
        self.error / self.estimated
    }
}

/// Measures, prints and writes.
pub fn print(suite: &Suite, cases: &[String]) -> Result<bool, Failure> {
    let mut tasks = Vec::new();
    for name in chosen(suite, cases)? {
        tasks.extend(tasks_of(suite, &name)?);
    }
    let name = |task: &Task| format!("{} {}", task.case.name, task.member.label());
    let scenes = parallel::map(&tasks, name, Task::measure);
    let worth = Worth { date: now(), machine: machine(), scenes };
    for scene in &worth.scenes {
        let told: Vec<String> = scene.runs.iter().map(line).collect();
        println!("{:<28} {:<30} {}", scene.case, scene.label, told.join("  "));
        match &scene.truth {
            Ok(truth) => truth.missed.iter().for_each(|missed| println!("    {missed}")),
            Err(why) => println!("    no truth: {why}"),
        }
    }
    let score = worth.score();
    eprintln!(
        "{} runs: the true error is larger than wanted in {} of {}; between {} and {} of the estimate in {:.1} % of {}",
        score.runs,
        score.missed,
        score.judged,
        RANGE[0],
        RANGE[1],
        100.0 * score.within(),
        score.compared
    );
    let file = suite.root.join(FILE);
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    std::fs::write(&file, serde_json::to_string_pretty(&worth)?)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(score.passes())
}

fn line(run: &Result<Judged, String>) -> String {
    match run {
        Ok(run) => format!(
            "{:e}{} {:.0e}/{:.0e}",
            run.wanted,
            if run.met { "" } else { "!" },
            run.error,
            run.estimated
        ),
        Err(why) => why.clone(),
    }
}

/// The last measurement, if there is one.
pub fn read(file: &Path) -> Result<Option<Worth>, Failure> {
    if !file.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let worth = serde_json::from_str(&text)
        .map_err(|e| format!("{}: {e}; measure again by `verify accuracy`", file.display()))?;
    Ok(Some(worth))
}

/// How often estimates are right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// All runs that came to an end.
    pub runs: usize,
    /// Those of which one can tell whether they are as accurate as they say that they are.
    pub judged: usize,
    /// Those of them that are not.
    pub missed: usize,
    /// Runs of which one can tell the true error.
    pub compared: usize,
    /// Those of them where it is within [`RANGE`] of the estimate.
    pub right: usize,
}

impl Score {
    /// Of runs.
    pub fn of<'r>(runs: impl Iterator<Item = &'r Judged>) -> Self {
        let mut score = Self::default();
        for run in runs {
            score.runs += 1;
            if run.met && (run.told || run.error <= run.wanted) {
                score.judged += 1;
                score.missed += usize::from(run.error > run.wanted);
            }
            if run.told && run.estimated.is_finite() {
                score.compared += 1;
                score.right += usize::from((RANGE[0]..=RANGE[1]).contains(&run.ratio()));
            }
        }
        score
    }

    /// Part of the runs whose estimates are right.
    pub fn within(&self) -> f64 {
        self.right as f64 / self.compared.max(1) as f64
    }

    /// Whether estimates can be relied on.
    pub fn passes(&self) -> bool {
        self.judged > 0 && self.missed as f64 <= MISSED * self.judged as f64 && self.within() >= WITHIN
    }
}

impl Worth {
    /// Of all runs.
    pub fn score(&self) -> Score {
        Score::of(self.scenes.iter().flat_map(|scene| scene.runs.iter().flatten()))
    }
}

/// A scene to measure.
struct Task {
    case: Case,
    tables: IndexMap<String, Table>,
    /// Name of the family, none for the case's only scene.
    family: Option<String>,
    member: Member,
    scene: Scene,
}

/// The scenes of a case that differ in more than what an accuracy chooses.
fn tasks_of(suite: &Suite, name: &str) -> Result<Vec<Task>, Failure> {
    let case = suite.case(name)?;
    let families: Vec<(Option<String>, Family)> = match case.text.run.is_empty() {
        true => vec![(None, Family::default())],
        false => case.text.run.iter().map(|(name, family)| (Some(name.clone()), family.clone())).collect(),
    };
    let mut tasks = Vec::new();
    let mut seen = HashSet::new();
    for (family, declared) in families {
        for member in members(&declared)?.into_iter().filter(|member| !member.interpolate) {
            let path = case.folder.join(&member.scene);
            let scene = Scene::load(&path, &member.set)?;
            if !scene.stages().is_empty() {
                continue; // Meshes are chosen for one analysis only.
            }
            let scene = scene.opened(TRUTH)?;
            if seen.insert(scene.text().to_owned()) {
                let tables = case.text.oracle.keys();
                let tables = tables.map(|oracle| Ok((oracle.clone(), suite.table(name, oracle)?)));
                let tables = tables.collect::<ancf_check::Result<_>>()?;
                tasks.push(Task { case: case.clone(), tables, family: family.clone(), member, scene });
            }
        }
    }
    Ok(tasks)
}

impl Task {
    fn measure(&self) -> SceneWorth {
        let model = watched(self.scene.model());
        let moves = matches!(self.scene.analysis(), Analysis::Dynamic(_));
        let truths = if moves { &TRUTHS_OF_MOTIONS[..] } else { &[TRUTH] };
        let mut truth = Err(String::new());
        for wanted in truths {
            truth = truth.or_else(|_| self.solve(&model, *wanted));
        }
        let runs = WANTED.iter().map(|&wanted| {
            let truth = truth.as_ref().map_err(|_| "no truth".to_owned())?;
            let run = claimed(self.solve(&model, wanted)?);
            let deviation = Deviation::between(&model, self.scene.analysis(), &run, truth)?;
            let unknown = "it has no estimate".to_owned();
            let error = run.run().error.as_ref().ok_or(unknown)?;
            Ok(Judged {
                wanted,
                met: error.met,
                estimated: error.estimated.result,
                error: deviation.error,
                told: estimated(truth) <= GOOD_ENOUGH * deviation.error,
                degrees_of_freedom: run.run().degrees_of_freedom,
            })
        });
        let runs = runs.collect();
        SceneWorth {
            case: self.case.name.clone(),
            label: self.member.label(),
            analysis: self.scene.analysis().kind().to_owned(),
            truth: truth.map(|results| self.truth(results)),
            runs,
        }
    }

    /// Results of an accuracy, with everything chosen for it.
    fn solve(&self, model: &Model, wanted: f64) -> Result<Results, String> {
        let clock = Instant::now();
        let observer = &mut |_: &Progress| match clock.elapsed() > LONGEST {
            true => Control::Stop,
            false => Control::Continue,
        };
        let options = Options { observer: Some(observer), ..Options::default() };
        let (analysis, open) = (self.scene.analysis(), self.scene.open());
        let found = accuracy::solve(model, analysis, open, Accuracy::new(wanted), options);
        let results = found.map_err(|e| e.to_string())?.results;
        if results.run().complete {
            Ok(results)
        } else {
            Err(format!("given up after {} s", LONGEST.as_secs()))
        }
    }

    /// The truth beside the case's references.
    fn truth(&self, results: Results) -> Truth {
        let estimated = estimated(&results);
        let run = Run {
            label: self.member.label(),
            member: self.member.clone(),
            result: quantity::Result::Solved(Box::new(results)),
            took: Duration::ZERO,
        };
        let (mut kept, mut missed) = (0, Vec::new());
        let of_family = |run: &Option<String>| match (run, &self.family) {
            (Some(run), Some(family)) => run == family,
            (None, _) => true,
            (Some(_), None) => false,
        };
        for (number, check) in self.case.text.check.iter().enumerate() {
            let rate = matches!(check.order, Some(Order { .. })) && check.allowed.is_none();
            if rate || check.oracle.is_none() || !of_family(&check.run) || !self.member.is(&check.only) {
                continue;
            }
            match compare(&self.tables, number, check, 0, &run) {
                Ok(outcome) if outcome.verdict.passed() => kept += 1,
                Ok(outcome) => missed.push(outcome.line(&self.case.name)),
                Err(why) => missed.push(format!("check {}: {why}", number + 1)),
            }
        }
        Truth { estimated, kept, missed }
    }
}

/// Results without the records of which no error is known: load factors that each run chooses for
/// itself.
fn claimed(mut results: Results) -> Results {
    let errors = results.run().error.as_ref().map(|error| error.records.clone()).unwrap_or_default();
    let known = |index: usize| errors.get(index).is_none_or(|error| !error.is_nan());
    fn keep<T>(list: &mut Vec<T>, known: impl Fn(usize) -> bool) {
        let mut index = 0..;
        list.retain(|_| index.next().is_none_or(&known));
    }
    let states = results.states_mut();
    keep(&mut states.parameter, known);
    states.probes.iter_mut().for_each(|probe| keep(&mut probe.samples, known));
    results
}

/// The error that results are estimated to have.
fn estimated(results: &Results) -> f64 {
    results.run().error.as_ref().map_or(f64::INFINITY, |error| error.estimated.result)
}

/// A model of which positions are seen everywhere.
fn watched(model: &Model) -> Model {
    let mut model = model.clone();
    for index in 0..model.beams.len() {
        let Ok(curve) = ancf::centreline::Curve::new(&model.beams[index].centreline) else { continue };
        let place = |i: usize| curve.length() * i as f64 / (PLACES - 1) as f64;
        let probe = |i: usize| Probe::new("watched", Place::new(index, place(i)));
        model.probes.extend((0..PLACES).map(probe));
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(met: bool, estimated: f64, error: f64, told: bool) -> Judged {
        Judged { wanted: 1e-3, met, estimated, error, told, degrees_of_freedom: 8 }
    }

    #[test]
    fn a_score_counts_what_can_be_told() {
        let runs = [
            run(true, 1e-4, 5e-5, true),
            run(true, 1e-4, 2e-3, true),
            // Perhaps missed, but the truth cannot tell.
            run(true, 1e-4, 2e-3, false),
            // As accurate as wanted, however small the error is.
            run(true, 1e-4, 1e-9, false),
            // A run that says that it failed has not claimed anything.
            run(false, 1e-2, 2e-2, true),
            run(false, f64::INFINITY, 2e-2, true),
        ];
        let score = Score::of(runs.iter());
        assert_eq!(score, Score { runs: 6, judged: 3, missed: 1, compared: 3, right: 2 });
        assert!(!score.passes() && Score::of(runs[..1].iter()).passes());
        assert!(!Score::default().passes(), "nothing measured is nothing shown");
    }

    /// Meshes, integrators and tolerances are what an accuracy chooses: scenes that differ in
    /// nothing else are one.
    #[test]
    fn scenes_that_differ_by_their_mesh_are_one() {
        let suite = Suite::here();
        let tasks = tasks_of(&suite, "soft-pendulum").expect("a case");
        let strains: HashSet<_> = tasks.iter().map(|task| task.scene.model().beams[0].strain as u8).collect();
        assert!(tasks.len() <= 4 && strains.len() == 2, "{} scenes", tasks.len());
        assert!(tasks.iter().all(|task| task.scene.open().beams == [true] && task.scene.open().integrator));
    }
}
