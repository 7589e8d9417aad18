//! What accuracy costs in time: a scene on a ladder of settings, against a reference made for it.
//!
//! ```text
//! scene ─► reference: two discretisations, refined until they agree ─┐
//!      └─► ladder: discretisations × meshes, then solvers ───────────┴─► errors, times, work ─► front, cheapest setting
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
//! The runs of the reference go in parallel; those of the ladder are alone.

mod bench;
mod deviation;
mod error;
mod ladder;
#[cfg(feature = "report")]
mod output;
mod reference;
mod rung;
mod setting;

use std::time::{Duration, Instant};

pub use deviation::Deviation;
pub use error::CostError;
pub use ladder::LeftOut;
#[cfg(feature = "report")]
pub use output::{Report, ReportedRung, write};
pub use reference::Reference;
pub use rung::{Measured, Rung};
pub use setting::{Family, Setting, Solver};

pub use crate::run::Control;

use crate::centreline::Curve;
use crate::model::{Analysis, Beam, Model, Place, Probe};
use crate::run;
use crate::scene::Scene;
use bench::{Desk, Measuring};
use ladder::{Climbed, Task};

/// What is asked for.
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

/// Of the budget, what the reference may take.
const FOR_REFERENCE: f64 = 0.5;
/// Errors below this part of the target are not told apart.
const LEAST: f64 = 1e-3;

/// How far a study is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// What is being done.
    pub doing: &'a str,
    /// Time taken so far \[s\].
    pub spent: f64,
    /// Time for everything \[s\].
    pub budget: f64,
}

/// Called after every step of every run, by two threads while the reference is made.
pub type Watcher<'w> = &'w (dyn Fn(&Progress<'_>) -> Control + Sync);

/// What was found out about a scene.
#[derive(Clone, Debug)]
pub struct Study {
    /// What was asked for.
    pub options: Options,
    /// What errors are measured against.
    pub reference: Reference,
    /// All settings measured, in the order in which they were.
    pub rungs: Vec<Rung>,
    /// Indices of the rungs that no other one beats in time and error, by ascending time.
    pub front: Vec<usize>,
    /// The cheapest rung that meets the target.
    pub best: Option<Best>,
    /// What was not tried, and why.
    pub left_out: Vec<LeftOut>,
    /// Whether it came to its end: not where it was interrupted.
    pub complete: bool,
    /// Wall time of everything \[s\].
    pub seconds: f64,
}

/// The cheapest setting that meets the target.
#[derive(Clone, Debug)]
pub struct Best {
    /// Index of its rung.
    pub rung: usize,
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

    /// What the reader should know.
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
        for Rung { family, cells, setting, measured } in &self.rungs {
            let name = format!("{family}, {cells} cells, {}", setting.solver);
            warnings.extend(measured.warnings.iter().map(|warning| format!("{name}: {warning}")));
        }
        warnings
    }
}

/// Finds out what accuracy costs for `scene`.
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
    let analysis = scene.analysis();
    if let Analysis::Static(settings) = analysis
        && let Some(arc) = &settings.arc_length
        && arc.until_load.is_none()
        && arc.until_probe.is_none()
    {
        return Err(CostError::Path);
    }
    run::inspect(scene.model(), analysis)?;
    let model = &watched(scene.model());
    let desk = Desk { model, analysis, start: Instant::now(), budget, watcher };
    let reference = reference::make(&desk, target, FOR_REFERENCE * budget)?;
    let uncertainty = reference.uncertainty.error;
    let least = least(target, &reference);
    let mut bench = Measuring { desk, reference: &reference, begun: 0 };
    let task = Task { model, analysis, target, least, deadline: budget };
    let Climbed { rungs, left_out, interrupted } = ladder::climb(&task, &mut bench);
    let points = rung::points(&rungs, least);
    let sound = rung::points(&rungs, 0.0).into_iter().zip(&rungs).map(|([seconds, error], rung)| {
        [seconds, if rung.measured.warnings.is_empty() { error } else { f64::INFINITY }]
    });
    let best = match rung::cheapest(&sound.collect::<Vec<_>>(), target - uncertainty) {
        None => None,
        Some(rung) => {
            let lines = rungs[rung].setting.toml(model);
            let scene = scene.merged(&lines).map_err(CostError::Lines)?;
            Some(Best { rung, lines, scene })
        }
    };
    let front = rung::front(&points);
    let seconds = desk.now();
    Ok(Study { options, reference, rungs, front, best, left_out, complete: !interrupted, seconds })
}

fn least(target: f64, reference: &Reference) -> f64 {
    reference.uncertainty.error.max(LEAST * target)
}

/// The model with something to look at: without probes, both ends and the middle of every beam.
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
    use std::sync::atomic::{AtomicUsize, Ordering};

    const ROLL_UP: &str = include_str!("../tests/scenes/roll-up-ancf.toml");

    fn scene() -> Scene {
        crate::scene::parse("roll-up", ROLL_UP).unwrap()
    }

    #[test]
    fn what_was_measured_before_an_interruption_is_kept() {
        let asked = AtomicUsize::new(0);
        let watcher = |progress: &Progress<'_>| {
            let measuring = progress.doing.starts_with(bench::MEASURING);
            if measuring && asked.fetch_add(1, Ordering::Relaxed) > 500 {
                Control::Stop
            } else {
                Control::Continue
            }
        };
        let study = study(&scene(), Options { target: 1e-3, ..Options::default() }, &watcher).unwrap();
        assert!(!study.complete && !study.rungs.is_empty());
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
        assert_eq!(&watched(scene.model()), scene.model());
    }
}
