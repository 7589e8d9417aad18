//! Runs one setting: with a time limit, under observation, and often enough for its time to mean
//! something.

use std::time::Instant;

use super::{Control, Deviation, Measured, Reference, Setting, StudyProgress, Watcher};
use crate::model::{Analysis, Model};
use crate::results::Results;
use crate::run;

/// Runs shorter than this in all \[s\] are repeated …
const LONG_ENOUGH: f64 = 0.05;
/// … up to so many runs.
const MOST_RUNS: usize = 5;

/// The word that is reported, with the number of the setting, while one is measured.
pub(super) const MEASURING: &str = "setting";

/// Why a setting was not measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unmeasured {
    /// The computation failed, or its result cannot be compared.
    Failed(String),
    /// It took longer than it may.
    TooSlow,
    /// The watcher stopped it.
    Interrupted,
}

/// Measures settings, by its own clock.
pub(super) trait Bench {
    /// Time since the start \[s\].
    fn now(&self) -> f64;
    /// Measures a setting, to be abandoned at the time `deadline` \[s\].
    fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured>;
}

/// The problem, with the clock and the watcher of the study.
#[derive(Clone, Copy)]
pub(super) struct Runner<'a> {
    pub model: &'a Model,
    pub analysis: &'a Analysis,
    pub start: Instant,
    pub budget: f64,
    pub watcher: Watcher<'a>,
}

impl Runner<'_> {
    pub fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Tells the watcher what is being done.
    pub fn tell(&self, doing: &str) -> Control {
        (self.watcher)(&StudyProgress { doing, spent: self.now(), budget: self.budget })
    }

    /// Runs a setting once, called `doing`, until `deadline` \[s\] at most.
    pub fn run(&self, setting: &Setting, doing: &str, deadline: f64) -> Result<Results, Unmeasured> {
        let (model, analysis) = setting.apply(self.model, self.analysis);
        // Some analyses end before their observer is called.
        let mut miss = (self.tell(doing) == Control::Stop).then_some(Unmeasured::Interrupted);
        if let Some(miss) = miss {
            return Err(miss);
        }
        let observer = &mut |_: &run::Progress| {
            if self.tell(doing) == Control::Stop {
                miss = Some(Unmeasured::Interrupted);
            } else if self.now() > deadline {
                miss = Some(Unmeasured::TooSlow);
            }
            if miss.is_some() { Control::Stop } else { Control::Continue }
        };
        let options =
            run::Options { observer: Some(observer), frames: 0, compared: true, ..run::Options::default() };
        let outcome = model.solve_with(&analysis, options);
        match (outcome, miss) {
            (Ok(results), _) if results.run().complete => Ok(results),
            (_, Some(miss)) => Err(miss),
            (Ok(_), None) => Err(Unmeasured::Failed("it did not come to its end".into())),
            (Err(error), None) => Err(Unmeasured::Failed(error.to_string())),
        }
    }
}

/// Measures against a reference.
pub(super) struct Measuring<'a> {
    pub runner: Runner<'a>,
    pub reference: &'a Reference,
    /// Settings begun so far.
    pub begun: usize,
}

impl Bench for Measuring<'_> {
    fn now(&self) -> f64 {
        self.runner.now()
    }

    fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured> {
        self.begun += 1;
        let (runner, mut seconds) = (&self.runner, Vec::with_capacity(MOST_RUNS));
        let doing = format!("{MEASURING} {}", self.begun);
        loop {
            let results = runner.run(setting, &doing, deadline)?;
            let run = results.run();
            seconds.push(run.seconds.build + run.seconds.solve);
            if seconds.len() < MOST_RUNS && seconds.iter().sum::<f64>() < LONG_ENOUGH {
                continue;
            }
            let (model, analysis, reference) = (runner.model, runner.analysis, &self.reference.results);
            let deviation =
                Deviation::between(model, analysis, &results, reference).map_err(Unmeasured::Failed)?;
            return Ok(Measured {
                degrees_of_freedom: run.degrees_of_freedom,
                seconds: median(&mut seconds),
                runs: seconds.len(),
                statistics: run.statistics,
                deviation,
                warnings: run.warnings.clone(),
            });
        }
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() % 2 {
        0 => 0.5 * (values[middle - 1] + values[middle]),
        _ => values[middle],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Family, Solver};
    use crate::model::{Integrator, STEP_CONTROL};
    use crate::results::Trajectory;
    use crate::scene::{Scene, parse};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread::sleep;
    use std::time::Duration;

    /// A cantilever of one element with this stiffness.
    fn scene(stiffness: &str, analysis: &str) -> Scene {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], bending_stiffness = 1, mass_per_length = 1, \
             basis.ancf.elements = 1 {stiffness} }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.force = [{{ beam = 'arm', at = 'end', value = [0, 1] }}]\n\
             probe = [{{ name = 'end', beam = 'arm', at = 'end' }}]\n\
             analysis.{analysis}\n"
        );
        parse("arm.toml", &text).unwrap()
    }

    /// An equilibrium in four steps at least.
    fn steps() -> Scene {
        scene(", axial_stiffness = 1e4", "static = { steps = 4 }")
    }

    fn as_it_is(scene: &Scene) -> Setting {
        Setting { beams: Family::Scene.beams(scene.model(), 1), solver: Solver::Scene }
    }

    fn runner<'a>(scene: &'a Scene, watcher: Watcher<'a>) -> Runner<'a> {
        Runner {
            model: scene.model(),
            analysis: scene.analysis(),
            start: Instant::now(),
            budget: 60.0,
            watcher,
        }
    }

    fn reference(results: Results) -> Reference {
        let pair = [String::new(), String::new()];
        Reference { results, uncertainty: Deviation::default(), warnings: vec![], pair, seconds: 0.0 }
    }

    #[test]
    fn a_run_goes_on_until_it_is_over_or_told_to_end() {
        let scene = steps();
        let setting = as_it_is(&scene);
        // Stopped by the call of this number, counted from 1.
        let run = |last: usize, deadline: f64| {
            let calls = AtomicUsize::new(0);
            let watcher = |now: &StudyProgress<'_>| {
                assert_eq!((now.doing, now.budget), ("this", 60.0));
                assert!((0.0..60.0).contains(&now.spent), "{}", now.spent);
                let call = calls.fetch_add(1, Ordering::Relaxed) + 1;
                if call == last { Control::Stop } else { Control::Continue }
            };
            let found = runner(&scene, &watcher).run(&setting, "this", deadline);
            (found.map(|trajectory| trajectory.run().complete), calls.load(Ordering::Relaxed))
        };
        let (found, calls) = run(0, f64::INFINITY);
        assert_eq!(found, Ok(true));
        assert!(calls > 4, "{calls}: before the first step, and after each");
        assert_eq!(run(1, f64::INFINITY), (Err(Unmeasured::Interrupted), 1));
        assert_eq!(run(2, f64::INFINITY), (Err(Unmeasured::Interrupted), 2));
        assert_eq!(run(0, -1.0), (Err(Unmeasured::TooSlow), 2));
        // A run that is over cannot be interrupted.
        assert_eq!(run(calls, f64::INFINITY), (Ok(true), calls));
    }

    #[test]
    fn a_run_that_fails_says_why() {
        let scene = scene("", "dynamic = { duration = 1e-3, output_every = 1e-3 }");
        let integrator = Integrator::Gauss { stages: 3, step: STEP_CONTROL };
        let setting = Setting { solver: Solver::Integrator(integrator), ..as_it_is(&scene) };
        let watcher = |_: &StudyProgress<'_>| Control::Continue;
        match runner(&scene, &watcher).run(&setting, "this", f64::INFINITY) {
            Err(Unmeasured::Failed(why)) => assert!(why.contains("of an inextensible beam"), "{why}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_clock_runs_from_the_start() {
        let scene = steps();
        let watcher = |_: &StudyProgress<'_>| Control::Continue;
        let start = Instant::now().checked_sub(Duration::from_secs(2)).expect("two seconds ago");
        let runner = Runner { start, ..runner(&scene, &watcher) };
        assert!((2.0..1000.0).contains(&runner.now()), "{}", runner.now());
        let bench = Measuring { runner, reference: &reference(Trajectory::default().into()), begun: 0 };
        assert!((2.0..1000.0).contains(&bench.now()), "{}", bench.now());
    }

    /// One element has eight coordinates, of which the clamp holds three.
    #[test]
    fn short_runs_are_repeated_and_long_ones_are_not() {
        let scene = steps();
        let setting = as_it_is(&scene);
        let reference = reference(scene.model().solve(scene.analysis()).unwrap());
        let measure = |pause: Duration| {
            let watcher = |now: &StudyProgress<'_>| {
                assert_eq!(now.doing, "setting 1");
                sleep(pause);
                Control::Continue
            };
            let start = Instant::now();
            let mut bench = Measuring { runner: runner(&scene, &watcher), reference: &reference, begun: 0 };
            let measured = bench.measure(&setting, f64::INFINITY).unwrap();
            assert_eq!((measured.degrees_of_freedom, measured.deviation.error), (5, 0.0));
            assert!(measured.statistics.load_steps >= 4 && measured.warnings.is_empty(), "{measured:?}");
            (measured, start.elapsed().as_secs_f64())
        };
        let (long, _) = measure(Duration::from_millis(20));
        assert_eq!(long.runs, 1);
        assert!((0.08..60.0).contains(&long.seconds), "{}", long.seconds);
        // On a machine that stands still meanwhile no run is short.
        let (short, elapsed) = measure(Duration::ZERO);
        assert!(short.runs == 5 || elapsed > 0.05, "{} runs in {elapsed} s", short.runs);
        assert!(short.seconds > 0.0 && short.seconds < elapsed, "{}", short.seconds);
    }

    #[test]
    fn a_run_that_compares_with_nothing_is_not_measured() {
        let scene = steps();
        let reference = reference(Trajectory { parameter: vec![0.3], ..Trajectory::default() }.into());
        let watcher = |_: &StudyProgress<'_>| Control::Continue;
        let mut bench = Measuring { runner: runner(&scene, &watcher), reference: &reference, begun: 0 };
        let found = bench.measure(&as_it_is(&scene), f64::INFINITY);
        let expected = "no record at the times or loads of the reference".to_owned();
        assert_eq!(found, Err(Unmeasured::Failed(expected)));
    }

    #[test]
    fn a_median_ignores_outliers() {
        assert_eq!(median(&mut [2.0, 90.0, 1.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 90.0]), 3.0);
    }
}
