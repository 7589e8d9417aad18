//! Runs one setting: with a limit, watched, and often enough for its time to mean something.

use std::time::Instant;

use super::{Control, Deviation, Measured, Progress, Reference, Setting, Watcher};
use crate::model::{Analysis, Model};
use crate::run;
use crate::trajectory::Trajectory;

/// Runs shorter than this in all \[s\] are repeated …
const LONG_ENOUGH: f64 = 0.05;
/// … up to so many runs.
const MOST_RUNS: usize = 5;

/// What is told while a setting is measured, with its number.
pub(super) const MEASURING: &str = "setting";

/// Why a setting was not measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unmeasured {
    /// The computation failed, or its result compares with nothing.
    Failed(String),
    /// It took longer than it may.
    TooSlow,
    /// Whoever watches wants it to end.
    Interrupted,
}

/// Where settings are measured and time passes.
pub(super) trait Bench {
    /// Time since the start \[s\].
    fn now(&self) -> f64;
    /// Measures a setting, to be abandoned at the time `deadline` \[s\].
    fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured>;
}

/// The problem, with the clock that everything goes by.
#[derive(Clone, Copy)]
pub(super) struct Desk<'a> {
    pub model: &'a Model,
    pub analysis: &'a Analysis,
    pub start: Instant,
    pub budget: f64,
    pub watcher: Watcher<'a>,
}

impl Desk<'_> {
    pub fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Says what is being done.
    pub fn tell(&self, doing: &str) -> Control {
        (self.watcher)(&Progress { doing, spent: self.now(), budget: self.budget })
    }

    /// Runs a setting once, called `doing`, until `deadline` \[s\] at most.
    pub fn run(&self, setting: &Setting, doing: &str, deadline: f64) -> Result<Trajectory, Unmeasured> {
        let (model, analysis) = setting.apply(self.model, self.analysis);
        // Some analyses are over before anybody is asked.
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
        let options = run::Options { observer: Some(observer), ..run::Options::default() };
        let outcome = model.solve_with(&analysis, options);
        match (outcome, miss) {
            (Ok(trajectory), _) if trajectory.complete => Ok(trajectory),
            (_, Some(miss)) => Err(miss),
            (Ok(_), None) => Err(Unmeasured::Failed("it did not come to its end".into())),
            (Err(error), None) => Err(Unmeasured::Failed(error.to_string())),
        }
    }
}

/// Measures against a reference.
pub(super) struct Measuring<'a> {
    pub desk: Desk<'a>,
    pub reference: &'a Reference,
    /// Settings begun so far.
    pub begun: usize,
}

impl Bench for Measuring<'_> {
    fn now(&self) -> f64 {
        self.desk.now()
    }

    fn measure(&mut self, setting: &Setting, deadline: f64) -> Result<Measured, Unmeasured> {
        self.begun += 1;
        let (desk, mut seconds) = (&self.desk, Vec::with_capacity(MOST_RUNS));
        let doing = format!("{MEASURING} {}", self.begun);
        loop {
            let trajectory = desk.run(setting, &doing, deadline)?;
            seconds.push(trajectory.seconds.build + trajectory.seconds.solve);
            if seconds.len() < MOST_RUNS && seconds.iter().sum::<f64>() < LONG_ENOUGH {
                continue;
            }
            let (model, analysis, reference) = (desk.model, desk.analysis, &self.reference.trajectory);
            let deviation =
                Deviation::between(model, analysis, &trajectory, reference).map_err(Unmeasured::Failed)?;
            return Ok(Measured {
                degrees_of_freedom: trajectory.degrees_of_freedom,
                seconds: median(&mut seconds),
                runs: seconds.len(),
                statistics: trajectory.statistics,
                deviation,
                warnings: trajectory.warnings,
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
    use super::median;

    #[test]
    fn a_median_ignores_outliers() {
        assert_eq!(median(&mut [2.0, 90.0, 1.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 90.0]), 3.0);
    }
}
