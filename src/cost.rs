//! What accuracy costs in time: a scene with settings of all kinds, against a reference made for
//! it.
//!
//! ```text
//! scene ─┬─► reference: two discretisations, refined until they agree ─┐
//!        └─► search: discretisations × meshes, then solvers ───────────┴─► errors, work ─► front
//! ```
//!
//! # What is measured
//! | quantity | how |
//! |---|---|
//! | error, which the target refers to | [`Deviation::error`]: positions of the probes in beam lengths (without probes: of both ends and the middle of every beam); frequencies or load factors, relative |
//! | curvature, energy | [`Deviation`] |
//! | seconds | to build and to solve, nothing else running; the median of up to five runs where they are short |
//! | work | tangent evaluations and factorisations, for the plot times the unknowns |
//!
//! # The reference
//! A meshfree run and one of cable elements (in motion by another integrator, too) are refined
//! together until they differ by a tenth of the target, further where that is cheap. Their
//! difference is the uncertainty of the reference. A setting meets the target where its error *plus
//! that uncertainty* does: the exact solution, if it lies between the two, is then no further away
//! than asked for. Errors below the uncertainty are known to be no more than that.
//!
//! The runs of the reference go in parallel; those of the search are alone.

mod bench;
mod deviation;
mod error;
#[cfg(feature = "report")]
mod output;
mod reference;
mod search;
mod trial;

use std::fmt;
use std::time::{Duration, Instant};

pub use crate::accuracy::setting::{Family, Setting, Solver};
pub use deviation::Deviation;
pub use error::CostError;
#[cfg(feature = "report")]
pub use output::{Report, ReportedTrial, write};
pub use reference::Reference;
pub use search::LeftOut;
pub use trial::{Measured, Trial};

pub use crate::run::Control;

use crate::accuracy;
use crate::centreline::Curve;
use crate::model::{Accuracy, Analysis, Beam, Model, Open, Place, Probe};
use crate::run;
use crate::scene::{self, Scene};
use bench::{Measuring, Runner};
use search::{Found, Task};
use serde::Serialize;

/// The target and the budget of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Wanted error, see [`Deviation::error`].
    pub target: f64,
    /// Time for everything.
    pub budget: Duration,
}

impl Default for Options {
    fn default() -> Self {
        Self { target: 1e-4, budget: Duration::from_secs(60) }
    }
}

/// Part of the budget that the reference may take.
const FOR_REFERENCE: f64 = 0.5;
/// Errors below this part of the target are not told apart.
const LEAST: f64 = 1e-3;

/// How far a study has got.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudyProgress<'a> {
    /// What is being done.
    pub doing: &'a str,
    /// Time taken so far \[s\].
    pub spent: f64,
    /// Time for everything \[s\].
    pub budget: f64,
}

/// Called after every step of every run, by two threads while the reference is made.
pub type Watcher<'w> = &'w (dyn Fn(&StudyProgress<'_>) -> Control + Sync);

/// The results of a study.
#[derive(Clone, Debug)]
pub struct Study {
    /// The target and the budget.
    pub options: Options,
    /// The reference for all errors.
    pub reference: Reference,
    /// All settings measured, in the order in which they were.
    pub trials: Vec<Trial>,
    /// Indices of the trials that no other one beats in time and error, by ascending time.
    pub front: Vec<usize>,
    /// The cheapest trial that meets the target.
    pub best: Option<Best>,
    /// What accuracy alone chooses.
    pub alone: Option<Alone>,
    /// Settings that were not tried, and why.
    pub left_out: Vec<LeftOut>,
    /// Whether it came to its end: not where it was interrupted.
    pub complete: bool,
    /// Wall time of everything \[s\].
    pub seconds: f64,
}

/// What is chosen, and what it costs, where the target is the scene's accuracy and the scene names
/// neither mesh nor steps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alone {
    /// The setting in words.
    pub setting: String,
    /// Its tables of a scene file.
    pub lines: String,
    /// Its unknowns.
    pub degrees_of_freedom: usize,
    /// Time of all runs, those for the choice and the estimate included \[s\].
    pub seconds: f64,
    /// Its error against the reference.
    pub error: f64,
    /// The error that it was estimated to have.
    pub estimated: f64,
}

impl fmt::Display for Alone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { setting, degrees_of_freedom, seconds, error, estimated, .. } = self;
        write!(
            f,
            "{setting}, {degrees_of_freedom} unknowns; errs by {error:.1e} ({estimated:.0e} estimated), in {:.3} ms for choice, solution \
             and estimate",
            1e3 * seconds
        )
    }
}

/// The cheapest setting that meets the target.
#[derive(Clone, Debug)]
pub struct Best {
    /// Index of its trial.
    pub trial: usize,
    /// Tables of a scene file that ask for it, to stand in place of those of the same names.
    pub lines: String,
    /// The scene with these lines in it.
    pub scene: Scene,
}

impl Study {
    /// Whether the reference is good enough for the target: its uncertainty a tenth of it at most.
    pub fn reference_is_good(&self) -> bool {
        self.reference.uncertainty.error <= 0.1 * self.options.target * (1.0 + 1e-12)
    }

    /// Warnings for the reader.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let (target, uncertainty) = (self.options.target, self.reference.uncertainty.error);
        if !self.complete {
            warnings.push("interrupted: what follows was measured until then".to_owned());
        }
        if uncertainty >= target {
            warnings.push(format!(
                "the reference is not good enough for the target: its uncertainty is {uncertainty:.1e}, more than the target \
                 {target:e}, so that no setting can be shown to meet it; give more time with --budget, or a larger --target"
            ));
        } else if !self.reference_is_good() {
            warnings.push(format!(
                "the reference is uncertain by {uncertainty:.1e}, more than a tenth of the target {target:e}: settings close to \
                 the target may be judged too strictly; more time (--budget) would make it better"
            ));
        }
        if self.best.is_none() && uncertainty < target {
            warnings.push(format!("no setting that was tried meets the target {target:e} without a warning"));
        }
        warnings.extend(self.reference.warnings.iter().map(|warning| format!("the reference: {warning}")));
        for Trial { family, cells, setting, measured } in &self.trials {
            let name = format!("{family}, {cells} cells, {}", setting.solver);
            warnings.extend(measured.warnings.iter().map(|warning| format!("{name}: {warning}")));
        }
        warnings
    }
}

/// Measures what accuracy costs for `scene`.
///
/// # Errors
/// [`CostError`] where the options are not legal, the scene cannot be built, no reference could be
/// made, or nothing was measured before `watcher` stopped it.
pub fn study(scene: &Scene, options: Options, watcher: Watcher<'_>) -> Result<Study, CostError> {
    let (target, budget) = (options.target, options.budget.as_secs_f64());
    if !(1e-12..1.0).contains(&target) {
        return Err(CostError::Target { target });
    }
    if !(0.01..=604_800.0).contains(&budget) {
        return Err(CostError::Budget { budget });
    }
    let (model, analysis) = &accuracy::first(scene);
    if let Analysis::Static(settings) = analysis
        && let Some(arc) = &settings.arc_length
        && arc.until_load.is_none()
        && arc.until_probe.is_none()
    {
        return Err(CostError::Path);
    }
    run::inspect(model, analysis)?;
    let model = &watched(model);
    let runner = Runner { model, analysis, start: Instant::now(), budget, watcher };
    let reference = reference::make(&runner, target, FOR_REFERENCE * budget)?;
    let uncertainty = reference.uncertainty.error;
    let least = least(target, &reference);
    let mut bench = Measuring { runner, reference: &reference, begun: 0 };
    let task = Task { model, analysis, target, least, deadline: budget };
    let Found { trials, left_out, interrupted } = search::search(&task, &mut bench);
    let points = trial::points(&trials, least);
    let sound = trial::points(&trials, 0.0).into_iter().zip(&trials).map(|([seconds, error], trial)| {
        [seconds, if trial.measured.warnings.is_empty() { error } else { f64::INFINITY }]
    });
    let best = match trial::cheapest(&sound.collect::<Vec<_>>(), target - uncertainty) {
        None => None,
        Some(trial) => {
            let lines = trials[trial].setting.toml(model);
            let text = scene.chosen(&lines).map_err(CostError::Lines)?;
            let scene = scene::parse(scene.name(), &text).map_err(CostError::Lines)?;
            Some(Best { trial, lines, scene })
        }
    };
    let front = trial::front(&points);
    let alone = if interrupted { None } else { alone(&runner, &reference, target) };
    let seconds = runner.now();
    Ok(Study { options, reference, trials, front, best, alone, left_out, complete: !interrupted, seconds })
}

/// Solves the scene for the target alone; `None` where it takes more than half the budget, or does
/// not come to its end.
fn alone(runner: &Runner<'_>, reference: &Reference, target: f64) -> Option<Alone> {
    let deadline = runner.now() + 0.5 * runner.budget;
    let observer = &mut |_: &run::Progress| {
        let stopped = runner.tell("accuracy alone") == Control::Stop || runner.now() > deadline;
        if stopped { Control::Stop } else { Control::Continue }
    };
    let options = run::Options { observer: Some(observer), frames: 0, ..run::Options::default() };
    let (model, analysis) = (runner.model, runner.analysis);
    let open = Open::all(model, analysis);
    let found = accuracy::solve(model, analysis, &open, Accuracy::new(target), options).ok()?;
    let run = found.results.run();
    let error = run.error.as_ref().filter(|error| error.met && run.complete)?;
    Some(Alone {
        setting: error.runs.last()?.setting.clone(),
        lines: found.chosen.clone(),
        degrees_of_freedom: run.degrees_of_freedom,
        seconds: error.runs.iter().map(|run| run.seconds).sum(),
        error: Deviation::between(model, analysis, &found.results, &reference.results).ok()?.error,
        estimated: error.estimated.result,
    })
}

fn least(target: f64, reference: &Reference) -> f64 {
    reference.uncertainty.error.max(LEAST * target)
}

/// The model with probes: if it has none, at both ends and the middle of every beam.
fn watched(model: &Model) -> Model {
    let mut model = model.clone();
    if model.probes.is_empty() {
        for (beam, Beam { name, centreline, .. }) in model.beams.iter().enumerate() {
            // A beam without a length has been refused before.
            let length = Curve::new(centreline).map_or(0.0, |curve| curve.length());
            for (place, part) in [("start", 0.0), ("middle", 0.5), ("end", 1.0)] {
                let at = Place { beam, s: part * length };
                model.probes.push(Probe { name: format!("{name}, {place}"), at });
            }
        }
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Integrator, SPECTRAL_RADIUS, StepControl};
    use crate::results::{AnalysisKind, Run, Statistics, Trajectory};
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicUsize, Ordering};

    const ROLL_UP: &str = include_str!("../tests/scenes/roll-up-ancf.toml");

    fn scene() -> Scene {
        crate::scene::parse("roll-up", ROLL_UP).unwrap()
    }

    /// The scene with this analysis instead of its own.
    fn scene_with(analysis: &str) -> Scene {
        let (before, _) = ROLL_UP.split_once("[analysis.static]").unwrap();
        crate::scene::parse("roll-up", &format!("{before}{analysis}\n")).unwrap()
    }

    /// A cantilever of four elements.
    fn arm(rest: &str) -> Scene {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, \
             mass_per_length = 1, basis.ancf.elements = 4 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n{rest}\n"
        );
        crate::scene::parse("arm.toml", &text).unwrap()
    }

    /// Powers of two, of which sums are exact: the target, and the uncertainty of the reference.
    pub(super) const TARGET: f64 = 1.0 / 1024.0;
    pub(super) const UNCERTAINTY: f64 = TARGET / 16.0;

    /// A study whose numbers are made up: of every kind of discretisation, one of them with other
    /// solvers. The second setting just meets the target, the third one just does not; the fourth
    /// one errs by the uncertainty, the fifth one by half of that, with a warning.
    pub(super) fn made_up() -> Study {
        let alpha = Integrator::GeneralizedAlpha {
            step: StepControl::Fixed(0.5),
            spectral_radius: SPECTRAL_RADIUS,
            newton_tolerance: Integrator::NEWTON_TOLERANCE,
        };
        let rpim = |neighbours: usize, shape: f64| Family::Rpim { neighbours, shape, points: 4 };
        let (scene, other) = (Solver::Scene, Solver::Tolerance(1e-5));
        let settings = [
            (Family::Scene, 3, scene, 0.5, 1.0 / 32.0),
            (Family::FULL, 4, scene, 1.0 / 64.0, TARGET - UNCERTAINTY),
            (Family::FULL, 8, scene, 0.125, TARGET),
            (Family::REDUCED, 8, scene, 1.0 / 32.0, UNCERTAINTY),
            (rpim(2, 5.0), 4, scene, 0.25, UNCERTAINTY / 2.0),
            (rpim(2, 5.0), 4, other, 1.0, 1.0 / 512.0),
            (rpim(2, 5.0), 4, Solver::Integrator(alpha), 2.0, 1.0 / 256.0),
            (rpim(1, 5.0), 4, scene, 4.0, 1.0 / 128.0),
            (rpim(3, 5.0), 4, scene, 8.0, 1.0 / 64.0),
            (rpim(2, 6.0), 4, scene, 3.0, 1.0 / 2048.0),
        ];
        let trial = |(family, cells, solver, seconds, error): (Family, usize, Solver, f64, f64)| Trial {
            family,
            cells,
            setting: Setting { beams: vec![], solver },
            measured: Measured {
                // What the scene itself costs has not been counted.
                degrees_of_freedom: if family == Family::Scene { 0 } else { 4 * cells },
                seconds,
                statistics: Statistics { tangent_evaluations: 1, factorizations: 1, ..Statistics::default() },
                deviation: Deviation { error, ..Deviation::default() },
                warnings: if seconds == 0.25 { vec!["it locks".to_owned()] } else { vec![] },
                ..Measured::default()
            },
        };
        let lines = "[beam.cantilever.basis.ancf]\nelements = 4\n".to_owned();
        Study {
            options: Options { target: TARGET, budget: Duration::from_secs(20) },
            reference: Reference {
                results: Trajectory {
                    run: Run {
                        title: "Made up".to_owned(),
                        analysis: AnalysisKind::Static,
                        ..Run::default()
                    },
                    ..Trajectory::default()
                }
                .into(),
                uncertainty: Deviation { error: UNCERTAINTY, curvature: None, energy: None },
                warnings: vec!["it turns".to_owned()],
                pair: ["one".to_owned(), "other".to_owned()],
                seconds: 1.25,
            },
            trials: settings.map(trial).into(),
            front: vec![1, 3],
            best: Some(Best { trial: 1, lines, scene: self::scene() }),
            alone: None,
            left_out: vec![],
            complete: true,
            seconds: 17.5,
        }
    }

    #[test]
    fn what_the_reader_should_know() {
        let warned = |change: fn(&mut Study)| {
            let mut study = made_up();
            change(&mut study);
            study.warnings()
        };
        let usual =
            ["the reference: it turns", "RPIM, 2 neighbours, shape 5, 4 cells, as the scene is: it locks"];
        assert_eq!(warned(|_| {}), usual);
        let with = |first: &[&str]| -> Vec<String> {
            first.iter().chain(&usual).map(|warning| (*warning).to_owned()).collect()
        };
        let interrupted = "interrupted: what follows was measured until then";
        assert_eq!(warned(|study| study.complete = false), with(&[interrupted]));
        let none = "no setting that was tried meets the target 9.765625e-4 without a warning";
        assert_eq!(warned(|study| study.best = None), with(&[none]));
        // A tenth of the target is good, an eighth of it is not, and the whole is useless.
        assert_eq!(warned(|study| study.reference.uncertainty.error = TARGET / 10.0), usual);
        let uncertain = "the reference is uncertain by 1.2e-4, more than a tenth of the target 9.765625e-4: settings close \
                         to the target may be judged too strictly; more time (--budget) would make it better";
        assert_eq!(warned(|study| study.reference.uncertainty.error = TARGET / 8.0), with(&[uncertain]));
        let useless = "the reference is not good enough for the target: its uncertainty is 9.8e-4, more than the target \
                       9.765625e-4, so that no setting can be shown to meet it; give more time with --budget, or a larger \
                       --target";
        let none_meets = warned(|study| {
            study.reference.uncertainty.error = TARGET;
            study.best = None;
        });
        assert_eq!(none_meets, with(&[useless]));
        let nearly = warned(|study| {
            study.reference.uncertainty.error = TARGET / 8.0;
            study.best = None;
        });
        assert_eq!(nearly, with(&[uncertain, none]));
    }

    /// Legal options come as far as the watcher, which stops the study at once.
    #[test]
    fn what_may_be_asked_for() {
        let asked = |scene: &Scene, target: f64, seconds: f64| {
            let budget = Duration::from_secs_f64(seconds);
            study(scene, Options { target, budget }, &|_| Control::Stop).err()
        };
        let scene = scene();
        for target in [1e-12, 0.5, 0.999] {
            assert!(matches!(asked(&scene, target, 60.0), Some(CostError::Interrupted)), "{target}");
        }
        for target in [9e-13, 1.0, -1.0, f64::NAN] {
            assert!(matches!(asked(&scene, target, 60.0), Some(CostError::Target { .. })), "{target}");
        }
        for budget in [0.01, 604_800.0] {
            assert!(matches!(asked(&scene, 1e-3, budget), Some(CostError::Interrupted)), "{budget}");
        }
        for budget in [0.009, 604_800.5] {
            assert!(matches!(asked(&scene, 1e-3, budget), Some(CostError::Budget { .. })), "{budget}");
        }
        for (arc, ends) in [
            ("until_load = 0.5", true),
            ("until_probe = { probe = \"tip\", y = 0.1 }", true),
            ("until_load = 0.5, until_probe = { probe = \"tip\", y = 0.1 }", true),
            ("max_points = 5", false),
        ] {
            let scene = scene_with(&format!("[analysis.static]\narc_length = {{ {arc} }}"));
            match asked(&scene, 1e-3, 60.0) {
                Some(CostError::Interrupted) => assert!(ends, "{arc}"),
                Some(CostError::Path) => assert!(!ends, "{arc}"),
                other => panic!("{arc}: {other:?}"),
            }
        }
    }

    /// Four cubic elements miss the second frequency of a clamped beam by 1.1652e-3, and the
    /// reference is uncertain by 1.4e-8: by so much the target has to be larger.
    #[test]
    fn the_uncertainty_of_the_reference_is_in_the_target() {
        let scene = arm("analysis.modal.count = 2");
        for (target, meets) in [(1.1652e-3, false), (1.17e-3, true)] {
            let told = Mutex::new(Vec::<String>::new());
            let watcher = |now: &StudyProgress<'_>| {
                assert_eq!(now.budget, 60.0);
                let mut told = told.lock().unwrap();
                if told.last().is_none_or(|last| *last != now.doing) {
                    told.push(now.doing.to_owned());
                }
                if now.doing == "setting 3" { Control::Stop } else { Control::Continue }
            };
            let study = study(&scene, Options { target, ..Options::default() }, &watcher).unwrap();
            assert_eq!(
                told.into_inner().unwrap(),
                ["reference with 16 cells", "setting 1", "setting 2", "setting 3"]
            );
            let measured: Vec<(Family, usize)> =
                study.trials.iter().map(|trial| (trial.family, trial.cells)).collect();
            assert_eq!(measured, [(Family::Scene, 4), (Family::FULL, 4)]);
            for trial in &study.trials {
                let error = trial.measured.deviation.error;
                assert!((error / 1.1652e-3 - 1.0).abs() < 1e-5, "{error}");
            }
            assert!(!study.complete);
            assert_eq!(study.best.is_some(), meets, "{target}: {:?}", study.warnings());
            if let Some(best) = &study.best {
                assert_eq!(best.scene.model().beams[0].discretization, scene.model().beams[0].discretization);
                let fastest = &study.trials[best.trial].measured.seconds;
                assert!(study.trials.iter().all(|trial| trial.measured.seconds >= *fastest));
            }
        }
    }

    #[test]
    fn a_study_says_what_an_accuracy_alone_gives() {
        let options = Options { target: 1e-2, ..Options::default() };
        let study = study(&arm("analysis.modal.count = 1"), options, &|_| Control::Continue).unwrap();
        let alone = study.alone.expect("a run for the accuracy alone");
        assert!(alone.error <= 1e-2 && alone.estimated <= 1e-2, "{} and {}", alone.error, alone.estimated);
    }

    /// The watcher alone takes longer than the half of the budget that the reference may take.
    #[test]
    fn a_reference_that_takes_too_long_is_given_up() {
        let scene = arm("effect.force = [{ beam = 'arm', at = 'end', value = [0, 1] }]\n\
                         analysis.static = { steps = 4 }");
        let watcher = |_: &StudyProgress<'_>| {
            std::thread::sleep(Duration::from_millis(30));
            Control::Continue
        };
        let options = Options { target: 1e-3, budget: Duration::from_millis(20) };
        match study(&scene, options, &watcher) {
            Err(CostError::NoReference { reason }) => {
                assert_eq!(reason, "the time is over; the pair with 16 cells took more than was left");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn errors_are_told_apart_down_to_the_reference() {
        let Study { reference, .. } = made_up();
        assert_eq!(least(TARGET, &reference), UNCERTAINTY);
        assert_eq!(least(0.5, &reference), 5e-4);
    }

    #[test]
    fn what_was_measured_before_an_interruption_is_kept() {
        let asked = AtomicUsize::new(0);
        let watcher = |progress: &StudyProgress<'_>| {
            let measuring = progress.doing.starts_with(bench::MEASURING);
            if measuring && asked.fetch_add(1, Ordering::Relaxed) > 500 {
                Control::Stop
            } else {
                Control::Continue
            }
        };
        let study = study(&scene(), Options { target: 1e-3, ..Options::default() }, &watcher).unwrap();
        assert!(!study.complete && !study.trials.is_empty());
        assert!(study.warnings()[0].contains("interrupted"), "{:?}", study.warnings());
        let at_once = super::study(&scene(), Options::default(), &|_| Control::Stop);
        assert!(matches!(at_once, Err(CostError::Interrupted)), "{at_once:?}");
    }

    #[test]
    fn without_probes_ends_and_middles_are_watched() {
        let scene = scene();
        let bare = Model { probes: vec![], ..scene.model().clone() };
        let places: Vec<f64> = watched(&bare).probes.iter().map(|probe| probe.at.s).collect();
        assert_eq!(places, [0.0, 0.9, 1.8]);
        assert_eq!(watched(&bare).probes[1].name, "cantilever, middle");
        assert_eq!(&watched(scene.model()), scene.model());
    }
}
