//! The settings that are tried, coarse ones first, and when a family of them is given up.
//!
//! First all discretisations go through their meshes together, from coarse to fine, with one
//! accurate solver. Then the best of them, from the cheapest to the most accurate, are tried with
//! other solvers: tolerances in statics; integrators, tolerances and steps in motion. A setting
//! whose predicted time exceeds the time that is left is not tried.

use serde::Serialize;

use super::bench::{Bench, Unmeasured};
use super::trial::{Trial, front, points};
use crate::accuracy::setting::{Family, Setting, Solver, cells};
use crate::model::SPECTRAL_RADIUS;
use crate::model::{Analysis, Integrator, Model, StepControl};

/// Cells of the meshes.
const MESHES: [usize; 15] = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512];
/// A family is given up if another setting has so many times less error in as much less time …
const FAR: f64 = 4.0;
/// … on so many meshes in succession, or after so many failures in succession.
const PATIENCE: usize = 2;
/// Part of the search's time that is kept for other solvers in the analysis of a motion.
const KEPT_FOR_SOLVERS: f64 = 0.4;
/// Most discretisations that are tried with other solvers.
const PICKS: usize = 4;
/// Factor by which a run may take longer than predicted, because of repetitions and noise.
const RESERVE: f64 = 1.3;

/// Settings that were not tried, or not to the end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// The settings.
    pub what: String,
    /// Reason for leaving them out.
    pub why: String,
}

/// The results of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Found {
    pub trials: Vec<Trial>,
    pub left_out: Vec<LeftOut>,
    /// Whether somebody stopped it.
    pub interrupted: bool,
}

impl Found {
    fn leave(&mut self, what: String, why: impl Into<String>) {
        self.left_out.push(LeftOut { what, why: why.into() });
    }
}

/// The task of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    pub model: &'a Model,
    pub analysis: &'a Analysis,
    /// Error that the user wants.
    pub target: f64,
    /// Error below which settings cannot be told apart, or need not be.
    pub least: f64,
    /// When to end \[s\].
    pub deadline: f64,
}

/// Tries settings on `bench` until all are tried or left out, or the time is over.
pub(super) fn search(task: &Task<'_>, bench: &mut impl Bench) -> Found {
    let mut found = Found::default();
    if meshes(task, bench, &mut found).and_then(|()| solvers(task, bench, &mut found)).is_none() {
        found.interrupted = true;
    }
    found
}

/// The solver with which discretisations are compared.
fn accurate(task: &Task<'_>) -> Solver {
    match task.analysis {
        Analysis::Dynamic(_) => {
            let step = StepControl::Tolerance(tolerance(0.1 * task.target));
            Solver::Integrator(Integrator::usual(step))
        }
        _ => Solver::Scene,
    }
}

/// The value as a legal tolerance of two digits.
fn tolerance(value: f64) -> f64 {
    short(value).clamp(1e-13, 0.1)
}

/// The number rounded to two significant digits, as people would write it.
fn short(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// The search through the meshes of one family.
struct FamilySearch {
    family: Family,
    /// Seconds and cells of the last two measured meshes, the later one last.
    times: Vec<[f64; 2]>,
    dominated: usize,
    failed: usize,
}

impl FamilySearch {
    /// Time that `cells` cells will take \[s\]; 0 where nothing is known.
    fn predict(&self, cells: usize) -> f64 {
        let exponent = match self.times.as_slice() {
            [.., [before, fewer], [now, more]] => ((now / before).ln() / (more / fewer).ln()).clamp(1.0, 3.0),
            _ => 1.0,
        };
        self.times.last().map_or(0.0, |[seconds, at]| seconds * (cells as f64 / at).powf(exponent))
    }
}

/// Measures a setting. Returns the index of its trial, or why there is none; `None` if interrupted.
fn attempt(
    bench: &mut impl Bench,
    found: &mut Found,
    (family, cells): (Family, usize),
    setting: Setting,
    deadline: f64,
) -> Option<Result<usize, Unmeasured>> {
    match bench.measure(&setting, deadline) {
        Ok(measured) => {
            found.trials.push(Trial { family, cells, setting, measured });
            Some(Ok(found.trials.len() - 1))
        }
        Err(Unmeasured::Interrupted) => None,
        Err(miss) => Some(Err(miss)),
    }
}

/// All discretisations on ever finer meshes.
fn meshes(task: &Task<'_>, bench: &mut impl Bench, found: &mut Found) -> Option<()> {
    let begun = bench.now();
    let kept = if matches!(task.analysis, Analysis::Dynamic(_)) { KEPT_FOR_SOLVERS } else { 0.0 };
    let deadline = task.deadline - kept * (task.deadline - begun);
    let as_it_is = Setting { beams: Family::Scene.beams(task.model, 1), solver: scene_solver(task.analysis) };
    let place = (Family::Scene, cells(task.model));
    if let Err(miss) = attempt(bench, found, place, as_it_is, deadline)? {
        found.leave(Family::Scene.to_string(), reason(miss));
    }
    let solver = accurate(task);
    let search = |family| FamilySearch { family, times: Vec::new(), dominated: 0, failed: 0 };
    let mut searches: Vec<FamilySearch> = Family::all().into_iter().map(search).collect();
    for cells in MESHES {
        let mut on = Vec::with_capacity(searches.len());
        for mut search in searches {
            let from = format!("{}, {cells} cells and more", search.family);
            if bench.now() + RESERVE * search.predict(cells) >= deadline {
                found.leave(from, "no time is left in the budget");
                continue;
            }
            let setting = Setting { beams: search.family.beams(task.model, cells), solver };
            match attempt(bench, found, (search.family, cells), setting, deadline)? {
                Ok(index) => {
                    search.failed = 0;
                    let trial = &found.trials[index];
                    search.times.push([trial.measured.seconds, cells as f64]);
                    if trial.measured.deviation.error <= task.least {
                        continue;
                    }
                    let dominated = dominated_by(&found.trials, index, task.least);
                    search.dominated = if dominated.is_some() { search.dominated + 1 } else { 0 };
                    if let Some(better) = dominated.filter(|_| search.dominated >= PATIENCE) {
                        let better = &found.trials[better];
                        let why = format!(
                            "{}, {} cells err {FAR} times less in {FAR} times less time",
                            better.family, better.cells
                        );
                        found.leave(format!("{}, more than {cells} cells", search.family), why);
                        continue;
                    }
                }
                Err(miss) => {
                    search.failed += 1;
                    if miss == Unmeasured::TooSlow || search.failed >= PATIENCE {
                        found.leave(from, reason(miss));
                        continue;
                    }
                    found.leave(format!("{}, {cells} cells", search.family), reason(miss));
                }
            }
            on.push(search);
        }
        searches = on;
    }
    Some(())
}

/// How the scene itself solves.
fn scene_solver(analysis: &Analysis) -> Solver {
    match analysis {
        Analysis::Dynamic(settings) => Solver::Integrator(settings.integrator),
        _ => Solver::Scene,
    }
}

fn reason(miss: Unmeasured) -> String {
    match miss {
        Unmeasured::Failed(why) => format!("it failed: {why}"),
        Unmeasured::TooSlow => "it took longer than the budget allows".into(),
        Unmeasured::Interrupted => "interrupted".into(),
    }
}

/// The index of a trial that is far better than the one at `index` in both time and error.
fn dominated_by(trials: &[Trial], index: usize, least: f64) -> Option<usize> {
    let points = points(trials, least);
    let [seconds, error] = points[index];
    points.iter().position(|p| FAR * p[0] <= seconds && FAR * p[1] <= error)
}

/// Solvers that are tried, each list from the cheapest to the most accurate.
fn other_solvers(task: &Task<'_>, mean_step: f64) -> Vec<Vec<Solver>> {
    match task.analysis {
        Analysis::Static(_) => {
            let steps = [5e-3, 1.25e-3].map(|largest| Solver::LoadSteps { largest, tolerance: None });
            let friction = task.model.has_friction().then(|| steps.to_vec());
            let tolerance = vec![Solver::Tolerance(tolerance(0.1 * task.target))];
            std::iter::once(tolerance).chain(friction).collect()
        }
        Analysis::Buckling(_) | Analysis::Modal(_) | Analysis::Stages => vec![],
        Analysis::Dynamic(settings) => {
            let by_tolerance = |method: &dyn Fn(StepControl) -> Integrator, parts: &[f64]| {
                let solver = |part: &f64| {
                    Solver::Integrator(method(StepControl::Tolerance(tolerance(part * task.target))))
                };
                parts.iter().map(solver).collect::<Vec<_>>()
            };
            let alpha = |step| {
                let newton_tolerance = match step {
                    StepControl::Fixed(_) => {
                        tolerance(1e-3 * task.target).clamp(Integrator::NEWTON_TOLERANCE, 1e-8)
                    }
                    StepControl::Tolerance(_) => Integrator::NEWTON_TOLERANCE,
                };
                Integrator::GeneralizedAlpha { step, spectral_radius: SPECTRAL_RADIUS, newton_tolerance }
            };
            let fixed = |division: f64| {
                Solver::Integrator(alpha(StepControl::Fixed(
                    short(mean_step / division).min(settings.duration),
                )))
            };
            vec![
                by_tolerance(&|step| Integrator::Gauss { stages: 3, step }, &[10.0, 1.0, 0.1]),
                by_tolerance(&|step| Integrator::Radau { stages: 3, step }, &[10.0, 1.0, 0.01]),
                by_tolerance(&alpha, &[10.0, 1.0, 0.1]),
                [1.0, 4.0, 16.0].map(fixed).into(),
            ]
        }
    }
}

/// The discretisations of the front with other solvers.
fn solvers(task: &Task<'_>, bench: &mut impl Bench, found: &mut Found) -> Option<()> {
    for pick in picks(&found.trials, task) {
        let Trial { family, cells, setting, measured } = found.trials[pick].clone();
        let mean_step = match task.analysis {
            Analysis::Dynamic(settings) => settings.duration / measured.statistics.steps.max(1) as f64,
            _ => 0.0,
        };
        for list in other_solvers(task, mean_step) {
            // Seconds and error of the solver before in the list.
            let mut before: Option<[f64; 2]> = None;
            for solver in list {
                let what = format!("{family}, {cells} cells, {solver}");
                // The next solver is ten times as accurate, or has a quarter of the step. With a
                // method of second order it takes up to four times as long.
                let predicted = before.map_or(measured.seconds, |[seconds, _]| 4.0 * seconds);
                if bench.now() + RESERVE * predicted >= task.deadline {
                    found.leave(what, "no time is left in the budget");
                    break;
                }
                let setting = Setting { beams: setting.beams.clone(), solver };
                match attempt(bench, found, (family, cells), setting, task.deadline)? {
                    Ok(index) => {
                        let there = found.trials[index].measured.clone();
                        let (seconds, error) = (there.seconds, there.deviation.error);
                        if there.work() == measured.work() && same(error, measured.deviation.error) {
                            // Otherwise the noise of the clock would choose between two names for
                            // the same setting.
                            found.trials.truncate(index);
                            found.leave(what, "it comes to the same by the same work as without it");
                            break;
                        }
                        // The mesh decides on the error, no longer the solver: further solvers only
                        // cost more.
                        let settled = before.is_some_and(|[_, last]| error > 0.9 * last);
                        if settled || error <= task.least {
                            break;
                        }
                        before = Some([seconds, error]);
                    }
                    Err(miss) => {
                        let too_slow = miss == Unmeasured::TooSlow;
                        found.leave(what, reason(miss));
                        if too_slow {
                            break;
                        }
                    }
                }
            }
        }
    }
    Some(())
}

/// Whether two errors are equal for all practical purposes.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-3 * a.max(b)
}

/// Trials of the front whose discretisation is worth another solver: the cheapest that meets the
/// target, and others evenly along the front, the best first.
fn picks(trials: &[Trial], task: &Task<'_>) -> Vec<usize> {
    let front: Vec<usize> = front(&points(trials, task.least))
        .into_iter()
        .filter(|&i| trials[i].family != Family::Scene)
        .collect();
    let meets = front.iter().position(|&i| trials[i].measured.deviation.error <= task.target);
    let middle = meets.unwrap_or(front.len().saturating_sub(1));
    // The settings around the target matter most; a cheaper one and the most accurate one show the
    // trend.
    let near = [
        middle,
        middle.saturating_sub(1),
        middle + 1,
        middle.saturating_sub(3),
        front.len().saturating_sub(1),
    ];
    let mut picks: Vec<usize> = Vec::with_capacity(PICKS);
    for at in near {
        if let Some(&trial) = front.get(at)
            && !picks.contains(&trial)
            && picks.len() < PICKS
        {
            picks.push(trial);
        }
    }
    picks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Deviation, Measured};
    use crate::model::STEP_CONTROL;
    use crate::model::{About, Buckling, Discretization, Dynamic, Modal, Static};
    use crate::results::Statistics;
    use crate::scene::parse;

    /// A bench with a clock of its own, on which `time` and `error` follow from family and cells.
    struct Fake {
        clock: f64,
        time: fn(bool, f64) -> f64,
        error: fn(bool, f64) -> f64,
        interrupt_after: usize,
    }

    impl Bench for Fake {
        fn now(&self) -> f64 {
            self.clock
        }

        fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured> {
            if self.interrupt_after == 0 {
                return Err(Unmeasured::Interrupted);
            }
            self.interrupt_after -= 1;
            let (meshfree, nodes) = match &setting.beams[0].0 {
                Discretization::Open => unreachable!("a setting names its meshes"),
                Discretization::Ancf { nodes } => (false, nodes),
                Discretization::Rpim { nodes, .. } => (true, nodes),
            };
            let cells = (nodes.count() - 1) as f64;
            let seconds = (self.time)(meshfree, cells);
            if self.clock + seconds > deadline {
                self.clock = deadline;
                return Err(Unmeasured::TooSlow);
            }
            self.clock += seconds;
            let deviation = Deviation { error: (self.error)(meshfree, cells), ..Deviation::default() };
            Ok(Measured { seconds, runs: 1, deviation, ..Measured::default() })
        }
    }

    fn model() -> Model {
        let text = "[beam.arm]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1\nbending_stiffness = 1\n\
                    basis.ancf.elements = 5\n[[support]]\nbeam = \"arm\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n\
                    [analysis.static]";
        parse("arm", text).unwrap().model().clone()
    }

    fn fake() -> Fake {
        let error = |_, cells: f64| cells.powi(-4);
        Fake { clock: 0.0, time: |_, cells| 0.01 * cells, error, interrupt_after: usize::MAX }
    }

    fn found(bench: &mut Fake, analysis: &Analysis, deadline: f64) -> Found {
        let task = Task { model: &model(), analysis, target: 1e-4, least: 1e-9, deadline };
        search(&task, bench)
    }

    fn motion(duration: f64) -> Analysis {
        let integrator = Integrator::Gauss { stages: 3, step: STEP_CONTROL };
        Analysis::Dynamic(Dynamic { duration, output_every: 0.1, integrator, events: vec![] })
    }

    /// An analysis that has one solver.
    fn vibrations() -> Analysis {
        Analysis::Modal(Modal { count: 1, about: About::Reference })
    }

    fn cells_in(setting: &Setting) -> usize {
        setting.beams[0].0.nodes().count() - 1
    }

    fn is_meshfree(setting: &Setting) -> bool {
        matches!(setting.beams[0].0, Discretization::Rpim { .. })
    }

    fn measured(seconds: f64, error: f64) -> Measured {
        Measured { seconds, deviation: Deviation { error, ..Deviation::default() }, ..Measured::default() }
    }

    fn trial(family: Family, seconds: f64, error: f64) -> Trial {
        let setting = Setting { beams: family.beams(&model(), 8), solver: Solver::Scene };
        Trial { family, cells: 8, setting, measured: measured(seconds, error) }
    }

    /// A bench with given answers, which records the settings and the deadlines it was asked for.
    struct Told<F> {
        clock: f64,
        answer: F,
        asked: Vec<(Setting, f64)>,
    }

    impl<F: FnMut(&Setting) -> Result<Measured, Unmeasured>> Told<F> {
        fn new(answer: F) -> Self {
            Self { clock: 0.0, answer, asked: Vec::new() }
        }

        fn solvers(&self) -> Vec<Solver> {
            self.asked.iter().map(|(setting, _)| setting.solver).collect()
        }
    }

    impl<F: FnMut(&Setting) -> Result<Measured, Unmeasured>> Bench for Told<F> {
        fn now(&self) -> f64 {
            self.clock
        }

        fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured> {
            self.asked.push((setting.clone(), deadline));
            let found = (self.answer)(setting);
            self.clock += found.as_ref().map_or(0.0, |found| found.seconds);
            found
        }
    }

    /// Numbers of cells at which a family was measured.
    fn cells_of(found: &Found, family: Family) -> Vec<usize> {
        found.trials.iter().filter(|trial| trial.family == family).map(|trial| trial.cells).collect()
    }

    fn left(found: &Found) -> Vec<String> {
        found.left_out.iter().map(|left| format!("{}: {}", left.what, left.why)).collect()
    }

    /// A power of the number of cells through the last two meshes, from the first to the third.
    #[test]
    fn times_are_predicted_by_a_power_of_the_cells() {
        let predict = |times: &[[f64; 2]]| {
            let search = FamilySearch { family: Family::FULL, times: times.into(), dominated: 0, failed: 0 };
            search.predict(16)
        };
        for (times, expected) in [
            (&[][..], 0.0),
            (&[[3.0, 4.0]][..], 12.0),
            (&[[2.0, 4.0], [8.0, 8.0]], 32.0),
            (&[[7.0, 2.0], [2.0, 4.0], [8.0, 8.0]], 32.0),
            (&[[2.0, 4.0], [2.5, 8.0]], 5.0),
            (&[[2.0, 4.0], [64.0, 8.0]], 512.0),
        ] {
            assert!((predict(times) - expected).abs() < 1e-9, "{times:?}: {}", predict(times));
        }
    }

    /// Of the ten seconds that are left at 100 s, four are kept for other solvers in a motion.
    #[test]
    fn meshes_leave_time_for_other_solvers() {
        for (analysis, expected) in
            [(motion(1.0), 106.0), (Analysis::Static(Static::default()), 110.0), (vibrations(), 110.0)]
        {
            let mut bench = Told::new(|_: &Setting| Err(Unmeasured::Interrupted));
            bench.clock = 100.0;
            let task =
                Task { model: &model(), analysis: &analysis, target: 1e-4, least: 1e-9, deadline: 110.0 };
            let found = search(&task, &mut bench);
            assert!(found.interrupted && found.trials.is_empty());
            let deadlines: Vec<f64> = bench.asked.iter().map(|(_, deadline)| *deadline).collect();
            assert_eq!(deadlines, [expected]);
        }
    }

    /// One family fails on two meshes in succession, one on two that are not, and the meshfree ones
    /// on every mesh.
    #[test]
    fn a_family_that_fails_twice_in_succession_is_left() {
        let failed = || Err(Unmeasured::Failed("no".into()));
        let mut bench =
            Told::new(|setting: &Setting| match (cells_in(setting), setting.beams[0].1.lobatto) {
                _ if is_meshfree(setting) => failed(),
                (8 | 16, false) | (12 | 16, true) => failed(),
                (24, _) => Ok(measured(0.0, 1e-9)),
                _ => Ok(measured(0.0, 1.0)),
            });
        let analysis = vibrations();
        let task = Task { model: &model(), analysis: &analysis, target: 1e-4, least: 1e-9, deadline: 1.0 };
        let found = search(&task, &mut bench);
        assert_eq!(cells_of(&found, Family::Scene), [5]);
        assert_eq!(cells_of(&found, Family::FULL), [4, 6, 12, 24]);
        assert_eq!(cells_of(&found, Family::REDUCED), [4, 6, 8]);
        let (meshfree, elements): (Vec<String>, Vec<String>) =
            left(&found).into_iter().partition(|left| left.starts_with("RPIM"));
        assert_eq!(
            elements,
            [
                "ANCF, 5/3 points, 8 cells: it failed: no",
                "ANCF, 3L/2 points, 12 cells: it failed: no",
                "ANCF, 5/3 points, 16 cells: it failed: no",
                "ANCF, 3L/2 points, 16 cells and more: it failed: no",
            ]
        );
        assert_eq!(meshfree.len(), 22);
        assert!(meshfree[..11].iter().all(|left| left.ends_with(", 4 cells: it failed: no")), "{meshfree:?}");
        assert!(
            meshfree[11..].iter().all(|left| left.ends_with(", 6 cells and more: it failed: no")),
            "{meshfree:?}"
        );
    }

    /// The search goes on, too, where the scene's own setting fails.
    #[test]
    fn a_family_that_is_too_slow_is_left_at_once() {
        let mut first = true;
        let mut bench = Told::new(|setting: &Setting| {
            if std::mem::take(&mut first) {
                Err(Unmeasured::Failed("it is wrong".into()))
            } else if is_meshfree(setting) {
                Err(Unmeasured::TooSlow)
            } else {
                Ok(measured(0.0, 1e-9))
            }
        });
        let analysis = vibrations();
        let task = Task { model: &model(), analysis: &analysis, target: 1e-4, least: 1e-9, deadline: 1.0 };
        let found = search(&task, &mut bench);
        assert_eq!(found.trials.iter().map(|trial| trial.cells).collect::<Vec<_>>(), [4, 4]);
        let left = left(&found);
        assert_eq!(left[0], "as the scene is: it failed: it is wrong");
        assert_eq!(
            left[1],
            "RPIM, 2 neighbours, shape 5, 4 cells and more: it took longer than the budget allows"
        );
        assert_eq!(left.len(), 12);
    }

    #[test]
    fn a_mesh_that_errs_by_the_least_is_the_last() {
        // (1/16)⁴ is the least.
        let mut bench = Told::new(|setting: &Setting| Ok(measured(0.0, (cells_in(setting) as f64).powi(-4))));
        let analysis = vibrations();
        let least = 1.0 / 65536.0;
        let task = Task { model: &model(), analysis: &analysis, target: 1e-3, least, deadline: 1.0 };
        assert_eq!(cells_of(&search(&task, &mut bench), Family::FULL), [4, 6, 8, 12, 16]);
    }

    /// One family takes a second a cell, the others are done after a mesh that takes no time: 12
    /// cells would be over at 18 s + 1.3 × 12 s.
    #[test]
    fn a_mesh_is_begun_where_it_can_be_ended() {
        let analysis = vibrations();
        let found = |deadline: f64| {
            let mut bench = Told::new(|setting: &Setting| {
                let cells = cells_in(setting);
                let full = !is_meshfree(setting) && !setting.beams[0].1.lobatto;
                Ok(if full { measured(cells as f64, 3.9) } else { measured(0.0, 1.0) })
            });
            let task = Task { model: &model(), analysis: &analysis, target: 1e-4, least: 1.0, deadline };
            search(&task, &mut bench)
        };
        for (deadline, cells, next) in
            [(33.0, &[4, 6, 8][..], 12), (18.0 + RESERVE * 12.0, &[4, 6, 8], 12), (34.0, &[4, 6, 8, 12], 16)]
        {
            let found = found(deadline);
            assert_eq!(cells_of(&found, Family::FULL), cells);
            let expected = format!("ANCF, 5/3 points, {next} cells and more: no time is left in the budget");
            assert_eq!(left(&found), [expected]);
        }
    }

    /// Four times the error and four times the time, both at once.
    #[test]
    fn what_is_far_better_dominates() {
        let better = trial(Family::FULL, 2.0, 1.0 / 1024.0);
        let dominated = |seconds: f64, error: f64| {
            let trials =
                [trial(Family::FULL, 9.0, 9.0), better.clone(), trial(Family::REDUCED, seconds, error)];
            dominated_by(&trials, 2, 1e-9)
        };
        assert_eq!(dominated(8.0, 1.0 / 256.0), Some(1));
        assert_eq!(dominated(7.9, 1.0), None);
        assert_eq!(dominated(100.0, 1.0 / 257.0), None);
        // Errors below `least` do not count as better.
        let exact = [trial(Family::FULL, 1.0, 1e-12), trial(Family::FULL, 9.0, 1e-9)];
        assert_eq!(dominated_by(&exact, 1, 1e-9), None);
    }

    #[test]
    fn errors_that_differ_by_a_thousandth_are_the_same() {
        assert!(same(0.0, 0.0) && same(2.0, 2.0));
        for (other, alike) in [(1.001_000_5, true), (1.001_1, false), (2.0, false)] {
            assert_eq!((same(1.0, other), same(other, 1.0)), (alike, alike), "{other}");
        }
    }

    /// The mean step is 32 ms, the target 1e-4.
    #[test]
    fn motions_are_tried_by_these_solvers() {
        let (analysis, model) = (motion(3.2), model());
        let task =
            |target: f64| Task { model: &model, analysis: &analysis, target, least: 0.0, deadline: 1.0 };
        let integrators = |tolerances: [f64; 3], method: &dyn Fn(StepControl) -> Integrator| {
            tolerances.map(|tolerance| Solver::Integrator(method(StepControl::Tolerance(tolerance)))).to_vec()
        };
        let alpha = |newton_tolerance: f64| {
            move |step: StepControl| Integrator::GeneralizedAlpha {
                step,
                spectral_radius: 0.9,
                newton_tolerance,
            }
        };
        let fixed = |steps: [f64; 3], newton_tolerance: f64| {
            let method = alpha(newton_tolerance);
            steps.map(|step| Solver::Integrator(method(StepControl::Fixed(step)))).to_vec()
        };
        let gauss = |step| Integrator::Gauss { stages: 3, step };
        let radau = |step| Integrator::Radau { stages: 3, step };
        let expected = [
            integrators([1e-3, 1e-4, 1e-5], &gauss),
            integrators([1e-3, 1e-4, 1e-6], &radau),
            integrators([1e-3, 1e-4, 1e-5], &alpha(1e-11)),
            fixed([0.032, 0.008, 0.002], 1e-8),
        ];
        assert_eq!(other_solvers(&task(1e-4), 0.032), expected);
        // The iteration of a step errs by a thousandth of the target, within bounds; no step is
        // longer than the motion.
        assert_eq!(other_solvers(&task(1e-6), 0.032)[3], fixed([0.032, 0.008, 0.002], 1e-9));
        assert_eq!(other_solvers(&task(1e-12), 0.032)[3], fixed([0.032, 0.008, 0.002], 1e-11));
        assert_eq!(other_solvers(&task(1e-4), 6.4)[3], fixed([3.2, 1.6, 0.4], 1e-8));
        let still = Analysis::Static(Static::default());
        let tolerance = other_solvers(&Task { analysis: &still, ..task(1e-4) }, 0.0);
        assert_eq!(tolerance, [[Solver::Tolerance(1e-5)]]);
        for other in [vibrations(), Analysis::Buckling(Buckling { count: 1 })] {
            assert_eq!(
                other_solvers(&Task { analysis: &other, ..task(1e-4) }, 0.0),
                Vec::<Vec<Solver>>::new()
            );
        }
    }

    /// A search of one trial with this cost and error, of a hundred steps in 3.2 s.
    fn one_trial(seconds: f64, error: f64) -> Found {
        let mut only = trial(Family::FULL, seconds, error);
        only.measured.statistics =
            Statistics { steps: 100, tangent_evaluations: 10, factorizations: 10, ..Statistics::default() };
        Found { trials: vec![only], ..Found::default() }
    }

    /// A list ends where the mesh decides on the error, where nothing is left to gain, and where it
    /// is too slow; a failure does not end it.
    #[test]
    fn a_list_of_solvers_ends_where_nothing_is_gained() {
        let (analysis, model) = (motion(3.2), model());
        let task = Task { model: &model, analysis: &analysis, target: 1e-4, least: 1e-7, deadline: 1e9 };
        let lists = other_solvers(&task, 0.032);
        let answers = [
            // Each error is less than 0.9 times the one before, or just that.
            (lists[0][0], Ok(5e-4)),
            (lists[0][1], Ok(0.9 * 5e-4)),
            (lists[0][2], Ok(1e-4)),
            (lists[1][0], Ok(5e-4)),
            (lists[1][1], Ok(4.6e-4)),
            (lists[2][0], Ok(1e-7)),
            (lists[3][0], Err(Unmeasured::Failed("no".into()))),
            (lists[3][1], Err(Unmeasured::TooSlow)),
        ];
        let mut bench = Told::new(|setting: &Setting| {
            let answer = answers.iter().find(|(solver, _)| *solver == setting.solver);
            let (_, answer) = answer.expect("a solver that is not in vain");
            answer.clone().map(|error: f64| measured(1.0, error))
        });
        let mut found = one_trial(1.0, 1e-3);
        assert_eq!(solvers(&task, &mut bench, &mut found), Some(()));
        assert_eq!(bench.solvers(), answers.each_ref().map(|(solver, _)| *solver));
        assert!(bench.asked.iter().all(|(setting, deadline)| {
            setting.beams == found.trials[0].setting.beams && *deadline == 1e9
        }));
        assert_eq!(found.trials.len(), 7);
        let alpha = "ANCF, 5/3 points, 8 cells, generalised-α (ρ∞ = 0.9)";
        assert_eq!(
            left(&found),
            [
                format!("{alpha}, step 0.032 s: it failed: no"),
                format!("{alpha}, step 0.008 s: it took longer than the budget allows"),
            ]
        );
        // Without a count of steps the mean one is the motion.
        let mut steps = Vec::new();
        let mut bench = Told::new(|setting: &Setting| match setting.solver {
            Solver::Integrator(Integrator::GeneralizedAlpha { step: StepControl::Fixed(step), .. }) => {
                steps.push(step);
                Ok(measured(1.0, 1e-3 * step))
            }
            _ => Ok(measured(1.0, 1e-7)),
        });
        let mut found = one_trial(1.0, 1e-3);
        found.trials[0].measured.statistics.steps = 0;
        assert_eq!(solvers(&task, &mut bench, &mut found), Some(()));
        assert_eq!(steps, [3.2, 0.8, 0.2]);
        let mut bench = Told::new(|_: &Setting| Err(Unmeasured::Interrupted));
        assert_eq!(solvers(&task, &mut bench, &mut one_trial(1.0, 1e-3)), None);
    }

    /// A solver may take as long as the one that is known; each further one four times as long as
    /// the one before. Both with a reserve of 0.3 times that.
    #[test]
    fn a_solver_is_begun_where_it_can_be_ended() {
        let (analysis, model) = (motion(3.2), model());
        // The first solver would be over at 13 s, the second one at 2 s + 10.4 s, the third one at
        // 4.2 s + 11.44 s.
        for (deadline, expected) in [(13.0, 0), (13.5, 2), (15.7, 3)] {
            let task = Task { model: &model, analysis: &analysis, target: 1e-4, least: 1e-9, deadline };
            let mut calls = 0;
            let mut bench = Told::new(|_: &Setting| {
                calls += 1;
                match calls {
                    1 => Ok(measured(2.0, 1e-3)),
                    2 => Ok(measured(2.2, 1e-4)),
                    3 => Ok(measured(0.1, 1e-5)),
                    _ => Err(Unmeasured::Interrupted),
                }
            });
            let mut found = one_trial(10.0, 1e-2);
            let _ = solvers(&task, &mut bench, &mut found);
            let is_gauss = |solver: &&Solver| matches!(solver, Solver::Integrator(Integrator::Gauss { .. }));
            assert_eq!(bench.solvers().iter().filter(is_gauss).count(), expected);
            let left = left(&found);
            assert_eq!(left.first().is_some_and(|left| left.contains("Gauss")), expected < 3, "{left:?}");
            assert!(left.iter().all(|left| left.ends_with(": no time is left in the budget")), "{left:?}");
        }
    }

    /// A solver that does the same is not kept: the same error by the same work.
    #[test]
    fn two_names_of_one_thing_are_one_trial() {
        let (analysis, model) = (Analysis::Static(Static::default()), model());
        let task = Task { model: &model, analysis: &analysis, target: 1e-4, least: 1e-9, deadline: 1e9 };
        for (tangents, error, kept) in
            [(10, 1e-3, false), (10, 1.0005e-3, false), (10, 2e-3, true), (9, 1e-3, true)]
        {
            let mut bench = Told::new(|_: &Setting| {
                let mut found = measured(1.0, error);
                found.statistics.tangent_evaluations = tangents;
                found.statistics.factorizations = 10;
                Ok(found)
            });
            let mut found = one_trial(1.0, 1e-3);
            assert_eq!(solvers(&task, &mut bench, &mut found), Some(()));
            assert_eq!(bench.solvers(), [Solver::Tolerance(1e-5)]);
            assert_eq!(found.trials.len(), if kept { 2 } else { 1 }, "{tangents} {error}");
            let what = "ANCF, 5/3 points, 8 cells, tolerance 1e-5: \
                        it comes to the same by the same work as without it";
            assert_eq!(left(&found), if kept { vec![] } else { vec![what.to_owned()] });
        }
    }

    /// On the front each setting takes twice the time of the one before for half of its error.
    #[test]
    fn discretisations_around_the_target_are_picked() {
        let analysis = vibrations();
        let picked = |count: i32, target: f64| {
            let mut trials = vec![trial(Family::Scene, 0.5, 1.0)];
            trials.extend((0..count).map(|i| trial(Family::FULL, 2.0_f64.powi(i), 0.5_f64.powi(i + 1))));
            // One that is beaten.
            trials.push(trial(Family::REDUCED, 1000.0, 1.5));
            picks(&trials, &Task { model: &model(), analysis: &analysis, target, least: 1e-9, deadline: 1.0 })
        };
        // By their places on the front, from 1: the scene as it is comes before.
        assert_eq!(picked(8, 0.5_f64.powi(6)), [6, 5, 7, 3]);
        assert_eq!(picked(8, 0.5_f64.powi(4)), [4, 3, 5, 1]);
        assert_eq!(picked(8, 1e-6), [8, 7, 5]);
        assert_eq!(picked(5, 0.5), [1, 2, 5]);
        assert_eq!(picked(1, 1e-6), [1]);
        assert_eq!(picked(0, 0.5), [0_usize; 0]);
    }

    #[test]
    fn the_budget_is_kept_and_what_it_forbids_is_named() {
        let motion = motion(1.0);
        for analysis in [&Analysis::Static(Static::default()), &motion] {
            let mut bench = fake();
            let found = found(&mut bench, analysis, 10.0);
            assert!(bench.clock <= 10.0, "{}", bench.clock);
            assert!(found.trials.len() > 20);
            assert!(found.left_out.iter().any(|left| left.why.contains("budget")));
            // Predictions kept the search from starting runs that it could not end.
            assert!(found.left_out.iter().all(|left| !left.why.contains("longer")), "{:?}", found.left_out);
            assert!(!found.interrupted);
        }
    }

    #[test]
    fn meshes_grow_until_the_error_is_least() {
        let mut bench = Fake { time: |_, _| 1e-6, ..fake() };
        let found = found(&mut bench, &Analysis::Modal(Modal { count: 1, about: Default::default() }), 10.0);
        let cells: Vec<usize> =
            found.trials.iter().filter(|r| r.family == Family::FULL).map(|r| r.cells).collect();
        // 192⁻⁴ < 1e-9 < 128⁻⁴.
        assert_eq!(cells, MESHES[..12]);
        assert_eq!(found.left_out, []);
    }

    #[test]
    fn what_is_dominated_by_far_is_left() {
        let time = |meshfree, cells: f64| if meshfree { 1e-3 * cells } else { 1e-1 * cells };
        let error = |meshfree, cells: f64| if meshfree { cells.powi(-4) } else { cells.powi(-1) };
        let found = found(&mut Fake { time, error, ..fake() }, &Analysis::Static(Static::default()), 1e6);
        let most = |meshfree: bool| {
            let same = found.trials.iter().filter(|r| matches!(r.family, Family::Rpim { .. }) == meshfree);
            same.map(|r| r.cells).max().unwrap()
        };
        assert_eq!((most(false), most(true)), (8, 192));
        assert!(found.left_out[0].why.contains("4 times less"), "{:?}", found.left_out[0]);
    }

    #[test]
    fn an_interruption_keeps_what_was_measured() {
        let mut bench = Fake { interrupt_after: 7, ..fake() };
        let found = found(&mut bench, &Analysis::Static(Static::default()), 1e6);
        assert_eq!((found.trials.len(), found.interrupted), (7, true));
    }

    #[test]
    fn tolerances_are_short_numbers() {
        assert_eq!(tolerance(0.1 * 1e-4), 1e-5);
        assert_eq!(tolerance(0.1 * 3e-6), 3e-7);
        assert_eq!(tolerance(4.0), 0.1);
    }

    /// A bench where steps cost time and leave errors of the method's order, and where the mesh
    /// leaves one, too.
    struct Steps {
        clock: f64,
    }

    impl Bench for Steps {
        fn now(&self) -> f64 {
            self.clock
        }

        fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured> {
            let (meshfree, nodes) = match &setting.beams[0].0 {
                Discretization::Open => unreachable!("a setting names its meshes"),
                Discretization::Ancf { nodes } => (false, nodes),
                Discretization::Rpim { nodes, .. } => (true, nodes),
            };
            let cells = (nodes.count() - 1) as f64;
            let (steps, by_steps) = match setting.solver {
                Solver::Scene | Solver::Tolerance(_) | Solver::LoadSteps { .. } => (1.0, 0.0),
                Solver::Integrator(integrator) => {
                    let order = match integrator {
                        Integrator::Gauss { .. } => 6.0,
                        Integrator::Radau { .. } => 5.0,
                        Integrator::GeneralizedAlpha { .. } => 2.0,
                    };
                    match integrator.step_control() {
                        StepControl::Fixed(step) => (1.0 / step, step.powf(order)),
                        StepControl::Tolerance(tolerance) => (2.0 * tolerance.powf(-1.0 / order), tolerance),
                    }
                }
            };
            let seconds = 1e-6 * steps * cells * if meshfree { 3.0 } else { 1.0 };
            let error = by_steps + cells.powi(if meshfree { -5 } else { -4 });
            if self.clock + seconds > deadline {
                self.clock = deadline;
                return Err(Unmeasured::TooSlow);
            }
            self.clock += seconds;
            let statistics =
                Statistics { steps: steps as usize, factorizations: steps as usize, ..Default::default() };
            let deviation = Deviation { error, ..Deviation::default() };
            Ok(Measured { seconds, runs: 1, statistics, deviation, ..Measured::default() })
        }
    }

    /// The order in which settings are tried, and the reasons for which others are left out: a
    /// change of the search shows here.
    #[test]
    fn the_order_of_what_is_tried_is_as_reviewed() {
        let motion = motion(1.0);
        let mut text = String::new();
        for (analysis, name) in [(&motion, "motion"), (&Analysis::Static(Static::default()), "statics")] {
            let mut bench = Steps { clock: 0.0 };
            let task = Task { model: &model(), analysis, target: 1e-5, least: 1e-9, deadline: 0.3 };
            let found = search(&task, &mut bench);
            text += &format!("{name}\n");
            for Trial { family, cells, setting, measured } in &found.trials {
                let error = measured.deviation.error;
                text += &format!("{family}, {cells} cells, {}: {error:.2e}\n", setting.solver);
            }
            text += "left out:\n";
            for LeftOut { what, why } in &found.left_out {
                text += &format!("{what}: {why}\n");
            }
        }
        insta::with_settings!({ snapshot_path => "../../tests/snapshots", prepend_module_to_snapshot => false }, {
            insta::assert_snapshot!("cost_search", text);
        });
    }
}
