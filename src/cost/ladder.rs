//! The settings that are tried, coarse ones first, and when a family of them is left.
//!
//! First all discretisations climb their meshes together, with one accurate solver. Then the best
//! of them, from the cheapest to the most accurate, are tried with other solvers: tolerances in
//! statics; integrators, tolerances and steps in motion. A setting whose predicted time exceeds
//! what is left is not tried.

use serde::Serialize;

use super::bench::{Bench, Unmeasured};
use super::rung::{Rung, front, points};
use super::setting::{Family, Setting, Solver, cells};
use crate::model::SPECTRAL_RADIUS;
use crate::model::{Analysis, Integrator, Model, StepControl};

/// Cells of the meshes.
const MESHES: [usize; 15] = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512];
/// A family is dominated by far where another setting has so many times less error in so many times
/// less time …
const FAR: f64 = 4.0;
/// … on so many meshes in succession; and it is given up after so many failures in succession.
const PATIENCE: usize = 2;
/// Of the time of the ladder, what is kept for other solvers where there are some.
const KEPT_FOR_SOLVERS: f64 = 0.4;
/// Most discretisations that are tried with other solvers.
const PICKS: usize = 4;
/// What a run is expected to cost more than measured, for repetitions and noise.
const RESERVE: f64 = 1.3;

/// What was not tried, or not to the end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Which settings.
    pub what: String,
    /// Why.
    pub why: String,
}

/// What comes of the climb.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Climbed {
    pub rungs: Vec<Rung>,
    pub left_out: Vec<LeftOut>,
    /// Whether somebody stopped it.
    pub interrupted: bool,
}

impl Climbed {
    fn leave(&mut self, what: String, why: impl Into<String>) {
        self.left_out.push(LeftOut { what, why: why.into() });
    }
}

/// What a ladder is to find out.
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
pub(super) fn climb(task: &Task<'_>, bench: &mut impl Bench) -> Climbed {
    let mut climbed = Climbed::default();
    if meshes(task, bench, &mut climbed).and_then(|()| solvers(task, bench, &mut climbed)).is_none() {
        climbed.interrupted = true;
    }
    climbed
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

/// A legal tolerance.
fn tolerance(value: f64) -> f64 {
    short(value).clamp(1e-13, 0.1)
}

/// The number rounded to two significant digits, as people would write it.
fn short(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// A family on its way up.
struct Climber {
    family: Family,
    /// Seconds and cells of the last two measured meshes, the later one last.
    times: Vec<[f64; 2]>,
    dominated: usize,
    failed: usize,
}

impl Climber {
    /// Time that `cells` cells will take \[s\]; 0 where nothing is known.
    fn predict(&self, cells: usize) -> f64 {
        let exponent = match self.times.as_slice() {
            [.., [before, fewer], [now, more]] => ((now / before).ln() / (more / fewer).ln()).clamp(1.0, 3.0),
            _ => 1.0,
        };
        self.times.last().map_or(0.0, |[seconds, at]| seconds * (cells as f64 / at).powf(exponent))
    }
}

/// Measures, and says whether to go on with what the outcome was. `None`: interrupted.
fn attempt(
    bench: &mut impl Bench,
    climbed: &mut Climbed,
    (family, cells): (Family, usize),
    setting: Setting,
    deadline: f64,
) -> Option<Result<usize, Unmeasured>> {
    match bench.measure(&setting, deadline) {
        Ok(measured) => {
            climbed.rungs.push(Rung { family, cells, setting, measured });
            Some(Ok(climbed.rungs.len() - 1))
        }
        Err(Unmeasured::Interrupted) => None,
        Err(miss) => Some(Err(miss)),
    }
}

/// All discretisations on ever finer meshes.
fn meshes(task: &Task<'_>, bench: &mut impl Bench, climbed: &mut Climbed) -> Option<()> {
    let begun = bench.now();
    let kept = if matches!(task.analysis, Analysis::Dynamic(_)) { KEPT_FOR_SOLVERS } else { 0.0 };
    let deadline = task.deadline - kept * (task.deadline - begun);
    let as_it_is = Setting { beams: Family::Scene.beams(task.model, 1), solver: scene_solver(task.analysis) };
    let place = (Family::Scene, cells(task.model));
    if let Err(miss) = attempt(bench, climbed, place, as_it_is, deadline)? {
        climbed.leave(Family::Scene.to_string(), reason(miss));
    }
    let solver = accurate(task);
    let climber = |family| Climber { family, times: Vec::new(), dominated: 0, failed: 0 };
    let mut climbers: Vec<Climber> = Family::all().into_iter().map(climber).collect();
    for cells in MESHES {
        let mut on = Vec::with_capacity(climbers.len());
        for mut climber in climbers {
            let from = format!("{}, {cells} cells and more", climber.family);
            if bench.now() + RESERVE * climber.predict(cells) >= deadline {
                climbed.leave(from, "no time is left in the budget");
                continue;
            }
            let setting = Setting { beams: climber.family.beams(task.model, cells), solver };
            match attempt(bench, climbed, (climber.family, cells), setting, deadline)? {
                Ok(index) => {
                    climber.failed = 0;
                    let rung = &climbed.rungs[index];
                    climber.times.push([rung.measured.seconds, cells as f64]);
                    if rung.measured.deviation.error <= task.least {
                        continue;
                    }
                    let dominated = dominated_by(&climbed.rungs, index, task.least);
                    climber.dominated = if dominated.is_some() { climber.dominated + 1 } else { 0 };
                    if let Some(better) = dominated.filter(|_| climber.dominated >= PATIENCE) {
                        let better = &climbed.rungs[better];
                        let why = format!(
                            "{}, {} cells err {FAR} times less in {FAR} times less time",
                            better.family, better.cells
                        );
                        climbed.leave(format!("{}, more than {cells} cells", climber.family), why);
                        continue;
                    }
                }
                Err(miss) => {
                    climber.failed += 1;
                    if miss == Unmeasured::TooSlow || climber.failed >= PATIENCE {
                        climbed.leave(from, reason(miss));
                        continue;
                    }
                    climbed.leave(format!("{}, {cells} cells", climber.family), reason(miss));
                }
            }
            on.push(climber);
        }
        climbers = on;
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

/// A rung that is far better than the one at `index` in both time and error.
fn dominated_by(rungs: &[Rung], index: usize, least: f64) -> Option<usize> {
    let points = points(rungs, least);
    let [seconds, error] = points[index];
    points.iter().position(|p| FAR * p[0] <= seconds && FAR * p[1] <= error)
}

/// Solvers that are tried, each list from the cheapest to the most accurate.
fn other_solvers(task: &Task<'_>, mean_step: f64) -> Vec<Vec<Solver>> {
    match task.analysis {
        Analysis::Static(_) => vec![vec![Solver::Tolerance(tolerance(0.1 * task.target))]],
        Analysis::Buckling { .. } | Analysis::Modal { .. } => vec![],
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
fn solvers(task: &Task<'_>, bench: &mut impl Bench, climbed: &mut Climbed) -> Option<()> {
    for pick in picks(&climbed.rungs, task) {
        let Rung { family, cells, setting, measured } = climbed.rungs[pick].clone();
        let mean_step = match task.analysis {
            Analysis::Dynamic(settings) => settings.duration / measured.statistics.steps.max(1) as f64,
            _ => 0.0,
        };
        for list in other_solvers(task, mean_step) {
            // Seconds and error of the solver before in the list.
            let mut before: Option<[f64; 2]> = None;
            for solver in list {
                let what = format!("{family}, {cells} cells, {solver}");
                // Second-order methods pay most for a digit: ten times the accuracy, or a quarter
                // of the step.
                let predicted = before.map_or(measured.seconds, |[seconds, _]| 4.0 * seconds);
                if bench.now() + RESERVE * predicted >= task.deadline {
                    climbed.leave(what, "no time is left in the budget");
                    break;
                }
                let setting = Setting { beams: setting.beams.clone(), solver };
                match attempt(bench, climbed, (family, cells), setting, task.deadline)? {
                    Ok(index) => {
                        let found = climbed.rungs[index].measured.clone();
                        let (seconds, error) = (found.seconds, found.deviation.error);
                        if found.work() == measured.work() && same(error, measured.deviation.error) {
                            // Otherwise the noise of the clock would choose between two names of
                            // one thing.
                            climbed.rungs.truncate(index);
                            climbed.leave(what, "it comes to the same by the same work as without it");
                            break;
                        }
                        // The mesh decides, no longer the solver: what follows only costs more.
                        let settled = before.is_some_and(|[_, last]| error > 0.9 * last);
                        if settled || error <= task.least {
                            break;
                        }
                        before = Some([seconds, error]);
                    }
                    Err(miss) => {
                        let too_slow = miss == Unmeasured::TooSlow;
                        climbed.leave(what, reason(miss));
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

/// Whether nobody would tell two errors apart.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-3 * a.max(b)
}

/// Rungs of the front whose discretisation is worth another solver: the cheapest that meets the
/// target, and others evenly along the front, the best first.
fn picks(rungs: &[Rung], task: &Task<'_>) -> Vec<usize> {
    let front: Vec<usize> =
        front(&points(rungs, task.least)).into_iter().filter(|&i| rungs[i].family != Family::Scene).collect();
    let meets = front.iter().position(|&i| rungs[i].measured.deviation.error <= task.target);
    let middle = meets.unwrap_or(front.len().saturating_sub(1));
    // What is far cheaper, and far more accurate, is there to be seen; what decides lies around the
    // target.
    let near = [
        middle,
        middle.saturating_sub(1),
        middle + 1,
        middle.saturating_sub(3),
        front.len().saturating_sub(1),
    ];
    let mut picks: Vec<usize> = Vec::with_capacity(PICKS);
    for at in near {
        if let Some(&rung) = front.get(at)
            && !picks.contains(&rung)
            && picks.len() < PICKS
        {
            picks.push(rung);
        }
    }
    picks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Deviation, Measured};
    use crate::model::STEP_CONTROL;
    use crate::model::{Discretization, Dynamic, Static};
    use crate::scene::parse;
    use crate::trajectory::Statistics;

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

    fn climbed(bench: &mut Fake, analysis: &Analysis, deadline: f64) -> Climbed {
        let task = Task { model: &model(), analysis, target: 1e-4, least: 1e-9, deadline };
        climb(&task, bench)
    }

    #[test]
    fn the_budget_is_kept_and_what_it_forbids_is_named() {
        let motion = Analysis::Dynamic(Dynamic {
            duration: 1.0,
            output_every: 0.1,
            integrator: Integrator::Gauss { stages: 3, step: STEP_CONTROL },
            events: vec![],
        });
        for analysis in [&Analysis::Static(Static::default()), &motion] {
            let mut bench = fake();
            let climbed = climbed(&mut bench, analysis, 10.0);
            assert!(bench.clock <= 10.0, "{}", bench.clock);
            assert!(climbed.rungs.len() > 20);
            assert!(climbed.left_out.iter().any(|left| left.why.contains("budget")));
            // A prediction kept the ladder from starting what it could not end.
            assert!(
                climbed.left_out.iter().all(|left| !left.why.contains("longer")),
                "{:?}",
                climbed.left_out
            );
            assert!(!climbed.interrupted);
        }
    }

    #[test]
    fn meshes_grow_until_the_error_is_least() {
        let mut bench = Fake { time: |_, _| 1e-6, ..fake() };
        let climbed = climbed(&mut bench, &Analysis::Modal { count: 1, about: Default::default() }, 10.0);
        let cells: Vec<usize> =
            climbed.rungs.iter().filter(|r| r.family == Family::FULL).map(|r| r.cells).collect();
        // 192⁻⁴ < 1e-9 < 128⁻⁴.
        assert_eq!(cells, MESHES[..12]);
        assert_eq!(climbed.left_out, []);
    }

    #[test]
    fn what_is_dominated_by_far_is_left() {
        let time = |meshfree, cells: f64| if meshfree { 1e-3 * cells } else { 1e-1 * cells };
        let error = |meshfree, cells: f64| if meshfree { cells.powi(-4) } else { cells.powi(-1) };
        let climbed = climbed(&mut Fake { time, error, ..fake() }, &Analysis::Static(Static::default()), 1e6);
        let most = |meshfree: bool| {
            let same = climbed.rungs.iter().filter(|r| matches!(r.family, Family::Rpim { .. }) == meshfree);
            same.map(|r| r.cells).max().unwrap()
        };
        assert_eq!((most(false), most(true)), (8, 192));
        assert!(climbed.left_out[0].why.contains("4 times less"), "{:?}", climbed.left_out[0]);
    }

    #[test]
    fn an_interruption_keeps_what_was_measured() {
        let mut bench = Fake { interrupt_after: 7, ..fake() };
        let climbed = climbed(&mut bench, &Analysis::Static(Static::default()), 1e6);
        assert_eq!((climbed.rungs.len(), climbed.interrupted), (7, true));
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
                Discretization::Ancf { nodes } => (false, nodes),
                Discretization::Rpim { nodes, .. } => (true, nodes),
            };
            let cells = (nodes.count() - 1) as f64;
            let (steps, by_steps) = match setting.solver {
                Solver::Scene | Solver::Tolerance(_) => (1.0, 0.0),
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

    /// What is tried in which order, and what is left out for which reason: whoever changes the
    /// ladder sees here what becomes of it.
    #[test]
    fn the_order_of_what_is_tried_is_as_reviewed() {
        let motion = Analysis::Dynamic(Dynamic {
            duration: 1.0,
            output_every: 0.1,
            integrator: Integrator::Gauss { stages: 3, step: STEP_CONTROL },
            events: vec![],
        });
        let mut text = String::new();
        for (analysis, name) in [(&motion, "motion"), (&Analysis::Static(Static::default()), "statics")] {
            let mut bench = Steps { clock: 0.0 };
            let task = Task { model: &model(), analysis, target: 1e-5, least: 1e-9, deadline: 0.3 };
            let climbed = climb(&task, &mut bench);
            text += &format!("{name}\n");
            for Rung { family, cells, setting, measured } in &climbed.rungs {
                let error = measured.deviation.error;
                text += &format!("{family}, {cells} cells, {}: {error:.2e}\n", setting.solver);
            }
            text += "left out:\n";
            for LeftOut { what, why } in &climbed.left_out {
                text += &format!("{what}: {why}\n");
            }
        }
        insta::with_settings!({ snapshot_path => "../../tests/snapshots", prepend_module_to_snapshot => false }, {
            insta::assert_snapshot!("cost_ladder", text);
        });
    }
}
