//! What errors are measured against: two runs that share neither the discretisation nor, in motion,
//! the integrator, made finer until they agree.

use super::bench::{Runner, Unmeasured};
use super::{CostError, Deviation, Family, Setting, Solver};
use crate::model::RPIM_GAUSS_POINTS;
use crate::model::{Analysis, Integrator, StepControl};
use crate::results::Results;

/// Cells of the meshfree run of the first pair.
const CELLS: usize = 16;
/// Elements of the other run for each of them: about as expensive, and about as accurate where
/// bending dominates.
const ELEMENTS_PER_CELL: usize = 4;
/// Most pairs.
const PAIRS: u32 = 7;
/// A pair costs about so many times the one before.
const GROWTH: f64 = 2.5;
/// Agreement that is enough, and agreement beyond which nothing is gained, as parts of the target.
const ENOUGH: f64 = 0.1;
const AMPLE: f64 = 1e-3;

/// The reference for all errors.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The meshfree run of the pair that agrees best.
    pub results: Results,
    /// By how much the other run of the pair differs: the uncertainty of the reference.
    pub uncertainty: Deviation,
    /// Warnings of either run.
    pub warnings: Vec<String>,
    /// The pair in words.
    pub pair: [String; 2],
    /// Wall time that it took to make \[s\].
    pub seconds: f64,
}

/// Largest load step of the first pair with friction.
const LOAD_STEP: f64 = 2.5e-3;

/// The settings of a pair.
fn pair(runner: &Runner<'_>, level: u32, target: f64) -> [(Family, usize, Setting); 2] {
    let meshfree = Family::usual(RPIM_GAUSS_POINTS.bend);
    let cells = CELLS << level;
    let step = StepControl::Tolerance(0.05 * target * 0.25_f64.powi(level as i32));
    let solvers = match runner.analysis {
        Analysis::Dynamic(_) => [
            Solver::Integrator(Integrator::Gauss { stages: 3, step }),
            Solver::Integrator(Integrator::Radau { stages: 3, step }),
        ],
        Analysis::Static(_) if runner.model.has_friction() => {
            let largest = LOAD_STEP * 0.5_f64.powi(level as i32);
            [largest, 0.5 * largest].map(|largest| Solver::LoadSteps { largest, tolerance: None })
        }
        _ => [Solver::Scene; 2],
    };
    let [first, second] = solvers;
    [(meshfree, cells, first), (Family::REDUCED, ELEMENTS_PER_CELL * cells, second)].map(
        |(family, cells, solver)| {
            (family, cells, Setting { beams: family.beams(runner.model, cells), solver })
        },
    )
}

/// Times after a pair of runs \[s\].
struct Clock {
    /// Time taken so far.
    spent: f64,
    /// Time that the next pair may take.
    next: f64,
    /// Time left to refine.
    left: f64,
    /// Time for everything.
    budget: f64,
}

/// Whether to refine no further, where the best pair agrees to `error`, and to `before` without the
/// last.
fn is_final(error: f64, before: Option<f64>, target: f64, clock: &Clock) -> bool {
    let stalled = before.is_some_and(|before| error > 0.5 * before);
    // Beyond what is needed, refinement must be cheap and still gain something.
    let content = error <= ENOUGH * target && (stalled || clock.spent + clock.next > 0.05 * clock.budget);
    error <= AMPLE * target || content || clock.next > clock.left
}

/// Refines until two runs agree well below `target`, or the time `deadline` \[s\] is near.
pub(super) fn make(runner: &Runner<'_>, target: f64, deadline: f64) -> Result<Reference, CostError> {
    // These threads end before the search, whose runs must be alone.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
    let start = runner.now();
    let mut best: Option<Reference> = None;
    let mut reason = String::new();
    for level in 0..PAIRS {
        let settings = pair(runner, level, target);
        let names = settings.each_ref().map(|(family, cells, setting)| match setting.solver {
            Solver::Scene => format!("{family}, {cells} cells"),
            solver => format!("{family}, {cells} cells, {solver}"),
        });
        let agreement = best.as_ref().map(|best| best.uncertainty.error);
        let doing = match agreement {
            None => format!("reference with {} cells", settings[0].1),
            Some(error) => format!("reference with {} cells (agreement so far {error:.1e})", settings[0].1),
        };
        let began = runner.now();
        let run = |i: usize| runner.run(&settings[i].2, &doing, deadline);
        let found = match pool.join(|| run(0), || run(1)) {
            (Err(Unmeasured::Interrupted), _) | (_, Err(Unmeasured::Interrupted)) => {
                return Err(CostError::Interrupted);
            }
            (Ok(a), Ok(b)) => {
                let warnings = [&a.run().warnings[..], &b.run().warnings].concat();
                let deviation = Deviation::between(runner.model, runner.analysis, &b, &a);
                deviation.map(|deviation| (a, deviation, warnings)).map_err(Unmeasured::Failed)
            }
            (Err(miss), _) | (_, Err(miss)) => Err(miss),
        };
        match found {
            Ok((results, mut uncertainty, warnings)) => {
                if matches!(runner.analysis, Analysis::Dynamic(_)) {
                    // The energy error of a motion is its drift, which has no reference.
                    uncertainty.energy = None;
                }
                if agreement.is_none_or(|error| uncertainty.error < error) {
                    best = Some(Reference { results, uncertainty, warnings, pair: names, seconds: 0.0 });
                }
            }
            Err(Unmeasured::Failed(why)) => reason = why,
            Err(_) => {
                reason = format!(
                    "the time is over; the pair with {} cells took more than was left",
                    settings[0].1
                );
                break;
            }
        }
        let now = runner.now();
        let clock = Clock {
            spent: now - start,
            next: GROWTH * (now - began),
            left: deadline - now,
            budget: runner.budget,
        };
        let error = best.as_ref().map_or(f64::INFINITY, |best| best.uncertainty.error);
        if is_final(error, agreement, target, &clock) {
            break;
        }
    }
    match best {
        Some(best) => Ok(Reference { seconds: runner.now() - start, ..best }),
        None => Err(CostError::NoReference { reason }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Control, StudyProgress};
    use crate::scene::{Scene, parse};
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    /// Twice the cells and a quarter of the tolerance from pair to pair; meshfree by Gauss against
    /// elements by Radau.
    #[test]
    fn pairs_share_neither_mesh_nor_method() {
        let scene = parse(
            "arm",
            "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 5 }\n\
             analysis.dynamic = { duration = 1, output_every = 0.1 }",
        )
        .unwrap();
        let watcher = |_: &StudyProgress<'_>| Control::Continue;
        let runner = Runner {
            model: scene.model(),
            analysis: scene.analysis(),
            start: Instant::now(),
            budget: 1.0,
            watcher: &watcher,
        };
        for (level, cells, tolerance) in [(0, 16, 5e-6), (1, 32, 1.25e-6), (3, 128, 7.8125e-8)] {
            let [(meshfree, first, gauss), (elements, second, radau)] = pair(&runner, level, 1e-4);
            assert_eq!((first, second), (cells, 4 * cells));
            assert!(matches!(meshfree, Family::Rpim { .. }) && matches!(elements, Family::Ancf(_)));
            let nodes = |setting: &Setting| setting.beams[0].0.nodes().count();
            assert_eq!((nodes(&gauss), nodes(&radau)), (cells + 1, 4 * cells + 1));
            let close = |step: StepControl| match step {
                StepControl::Tolerance(found) => (found / tolerance - 1.0).abs() < 1e-12,
                StepControl::Fixed(_) => false,
            };
            assert!(
                matches!(gauss.solver, Solver::Integrator(Integrator::Gauss { stages: 3, step }) if close(step))
            );
            assert!(
                matches!(radau.solver, Solver::Integrator(Integrator::Radau { stages: 3, step }) if close(step))
            );
        }
    }

    /// A target of 1024: 0.1 of it is enough, 0.001 of it is ample, and where more than half of the
    /// error is left nothing is gained. Of a budget of 1000 s, 50 s are cheap.
    #[test]
    fn refinement_ends_where_it_gains_too_little_for_its_price() {
        let ends = |error: f64, before: Option<f64>, [spent, next, left]: [f64; 3]| {
            is_final(error, before, 1024.0, &Clock { spent, next, left, budget: 1000.0 })
        };
        let (cheap, dear) = ([20.0, 30.0, 100.0], [20.0, 30.1, 100.0]);
        let halved = Some(200.0);
        for (error, before, clock, expected) in [
            // Far from what is needed: on at any price within the time that is left.
            (103.0, None, dear, false),
            (103.0, Some(103.0), dear, false),
            (103.0, None, [20.0, 100.0, 100.0], false),
            (103.0, None, [20.0, 100.1, 100.0], true),
            (f64::INFINITY, None, cheap, false),
            // Enough: on where it is cheap and gains something.
            (102.0, None, cheap, false),
            (102.0, None, dear, true),
            (100.0, halved, cheap, false),
            (101.0, halved, cheap, true),
            (0.1 * 1024.0, None, dear, true),
            // Ample.
            (1.1, None, cheap, false),
            (1.0, None, cheap, true),
            (1e-3 * 1024.0, None, cheap, true),
        ] {
            assert_eq!(ends(error, before, clock), expected, "{error} after {before:?} at {clock:?}");
        }
    }

    /// Two frequencies of a clamped beam.
    fn vibrations() -> Scene {
        let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, \
                    mass_per_length = 1, basis.ancf.elements = 4 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                    analysis.modal.count = 2\n";
        parse("arm.toml", text).unwrap()
    }

    /// The reference by a clock that has run for 100 s of 1000 s, and what was being done on the
    /// way.
    fn made(target: f64, deadline: f64) -> (Reference, Vec<String>) {
        let (scene, told) = (vibrations(), Mutex::new(Vec::<String>::new()));
        let watcher = |now: &StudyProgress<'_>| {
            let mut told = told.lock().unwrap();
            if told.last().is_none_or(|last| *last != now.doing) {
                told.push(now.doing.to_owned());
            }
            Control::Continue
        };
        let runner = Runner {
            model: scene.model(),
            analysis: scene.analysis(),
            start: Instant::now().checked_sub(Duration::from_secs(100)).expect("100 s ago"),
            budget: 1000.0,
            watcher: &watcher,
        };
        let start = Instant::now();
        let reference = make(&runner, target, deadline).unwrap();
        assert!((0.0..=start.elapsed().as_secs_f64()).contains(&reference.seconds), "{}", reference.seconds);
        (reference, told.into_inner().unwrap())
    }

    /// Sixty-four cubic elements miss the second frequency by 1.4e-8, twice as many by a sixteenth
    /// of that and round-off.
    #[test]
    fn pairs_are_refined_until_they_agree() {
        let (reference, told) = made(8e-6, 1e6);
        assert_eq!(told.len(), 2, "{told:?}");
        assert_eq!(told[0], "reference with 16 cells");
        assert!(told[1].starts_with("reference with 32 cells (agreement so far 1.4e-8)"), "{told:?}");
        assert_eq!(reference.pair, ["RPIM, 2 neighbours, shape 5, 32 cells", "ANCF, 3L/2 points, 128 cells"]);
        let error = reference.uncertainty.error;
        assert!(error > 0.0 && error < 8e-9, "{error}");
        assert!((reference.results.eigenvalues()[0] * std::f64::consts::TAU - 3.516_015).abs() < 1e-4);
    }

    /// An analysis of vibrations ends before the clock is read.
    #[test]
    fn no_pair_is_begun_after_the_time() {
        let (reference, told) = made(8e-6, 50.0);
        assert_eq!(told, ["reference with 16 cells"]);
        assert_eq!(reference.pair[1], "ANCF, 3L/2 points, 64 cells");
    }

    /// Either run waits for the other one to begin.
    #[test]
    fn the_runs_of_a_pair_go_side_by_side() {
        let (scene, begun) = (vibrations(), AtomicUsize::new(0));
        let watcher = |_: &StudyProgress<'_>| {
            begun.fetch_add(1, Ordering::SeqCst);
            let start = Instant::now();
            while begun.load(Ordering::SeqCst) < 2 {
                if start.elapsed() > Duration::from_secs(10) {
                    return Control::Stop;
                }
                sleep(Duration::from_millis(1));
            }
            Control::Continue
        };
        let runner = Runner {
            model: scene.model(),
            analysis: scene.analysis(),
            start: Instant::now(),
            budget: 1000.0,
            watcher: &watcher,
        };
        let reference = make(&runner, 1e-2, 1000.0);
        assert!(reference.is_ok(), "{reference:?}");
    }
}
