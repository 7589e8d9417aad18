//! Whether more rounds can bring what is wanted.

use super::judgement::Judged;
use super::runner::{FINEST, Runner};
use crate::model::{Accuracy, Analysis};

/// Errors of motions go with this power of the tolerance.
pub(super) const POWER: f64 = 0.75;
/// Errors of positions, in beam lengths, beyond which two motions have nothing in common.
const LOST: f64 = 0.2;
/// Most unknowns in all iterations of a run that a search is worth, a quarter of an hour of them.
const MOST_WORK: f64 = 1e10;
/// Rounds of fewer, a tenth of a second, cost so little that the next may as well be tried.
const LITTLE_WORK: f64 = 1e6;

/// What the finer run of a round cost, and what it brought.
pub(super) struct Paid {
    /// Unknowns in all iterations.
    work: f64,
    /// The largest error in units of what was wanted.
    excess: f64,
}

impl Paid {
    pub fn of(judged: &Judged) -> Self {
        let run = judged.round.results.run();
        let work = (run.statistics.newton_iterations * run.degrees_of_freedom) as f64;
        Self { work, excess: judged.excess }
    }
}

/// Why no search is worth its price: by the power of the work with which errors have fallen, in the better one of the last two rounds, one run
/// good enough would take more than anybody waits for. `None` as long as there are no three rounds, or errors rise, which is another
/// matter.
pub(super) fn beyond_price(paid: &[Paid]) -> Option<String> {
    let [.., first, second, last] = paid else { return None };
    let rate = |before: &Paid, after: &Paid| {
        let rate = (before.excess / after.excess).ln() / (after.work / before.work).ln();
        if after.work > before.work { rate } else { f64::INFINITY }
    };
    let rate = rate(first, second).max(rate(second, last));
    let times = last.excess.powf(rate.recip());
    (rate > 0.0 && last.work > LITTLE_WORK && last.work * times > MOST_WORK).then(|| {
        format!(
            "errors fall slowly, with the power {rate:.2} of the work, so that a run which is good enough would take {times:.0e} times as long as this \
             one: ask for less, or, of a motion, for a shorter one"
        )
    })
}

/// Why no steps are small enough for a motion whose errors grow with time: as fast as they grew
/// from what is wanted to what tells nothing any more, they would have to begin below all
/// tolerances.
pub(super) fn outgrown(runner: &Runner<'_, '_>, judged: &Judged, wanted: Accuracy) -> Option<String> {
    let Analysis::Dynamic(_) = runner.analysis else { return None };
    let records = &judged.estimate.as_ref()?.whole.records;
    let times = &judged.round.results.states().parameter;
    let passes = |level: f64| {
        let first = records.iter().position(|error| error * judged.caution > level)?;
        times.get(first).copied()
    };
    let (good, lost, end) = (passes(wanted.result)?, passes(LOST)?, *times.last()?);
    if lost <= good || wanted.result >= LOST {
        return None;
    }
    // Errors grow like exp(λ t).
    let rate = (LOST / wanted.result).ln() / (lost - good);
    let needed = rate * (end - good);
    let left = (runner.tolerance / FINEST).ln();
    (POWER * left < needed).then(|| {
        let twice = std::f64::consts::LN_2 / rate;
        format!(
            "errors of this motion double every {twice:.2} s, so that no steps are small enough for all of it"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::difference::Difference;
    use crate::accuracy::runner::tests::{runner, scene};
    use crate::accuracy::search::tests::{MOTION, STILL, judged};

    /// Errors that were e^{λt}: from 1e-4 to 0.2 within a second, by λ = 7.6/s. A tolerance of 3e-4 may fall
    /// to 1e-13, which makes errors e^{16.4} times smaller, enough for 2.15 s from where they passed 1e-4.
    #[test]
    fn motions_whose_errors_grow_too_fast_are_given_up() {
        let (motion, still) = (scene(MOTION), scene(STILL));
        let said = |scene: &crate::Scene, wanted: f64, times: [f64; 4], records: [f64; 4]| {
            let runner = runner(scene, wanted);
            let difference = Difference { records: records.into(), ..Difference::default() };
            let mut judged = judged(&runner, difference, [3.0, 4.0]);
            judged.round.results.states_mut().parameter = times.into();
            outgrown(&runner, &judged, Accuracy::new(wanted))
        };
        let growing = [1e-5, 2.2e-4, 0.5, 0.9];
        let found = said(&motion, 1e-4, [0.0, 1.0, 2.0, 3.2], growing).expect("too fast");
        assert!(found.contains("double every 0.09 s"), "{found}");
        assert_eq!(said(&motion, 1e-4, [0.0, 1.0, 2.0, 3.1], growing), None);
        assert_eq!(said(&still, 1e-4, [0.0, 1.0, 2.0, 3.2], growing), None);
        assert_eq!(said(&motion, 1e-4, [0.0, 1.0, 2.0, 3.2], [1e-5, 0.5, 0.5, 0.5]), None, "at once");
        assert_eq!(said(&motion, 1e-4, [0.0, 1.0, 2.0, 3.2], [1e-5, 2.2e-4, 0.1, 0.3]), None);
        assert_eq!(said(&motion, 0.3, [0.0, 1.0, 2.0, 30.0], [0.0, 0.5, 0.7, 0.9]), None);
    }

    /// Errors halved for four times the work, twice: a hundred times smaller ones would take ten thousand times the work.
    #[test]
    fn a_search_ends_where_its_price_is_beyond_all() {
        let said = |rounds: &[(f64, f64)]| {
            let paid: Vec<Paid> = rounds.iter().map(|&(work, excess)| Paid { work, excess }).collect();
            beyond_price(&paid)
        };
        let found = said(&[(1e5, 400.0), (4e5, 200.0), (1.6e6, 100.0)]).expect("too dear");
        assert!(found.contains("the power 0.50 of the work") && found.contains("1e4 times"), "{found}");
        assert_eq!(said(&[(4e5, 200.0), (1.6e6, 100.0)]), None, "two rounds tell little");
        assert_eq!(said(&[(1e4, 400.0), (4e4, 200.0), (1.6e5, 100.0)]), None, "some minutes");
        // One round that brought more.
        assert_eq!(said(&[(1e5, 800.0), (4e5, 200.0), (1.6e6, 100.0)]), None);
        assert!(said(&[(1e5, 250.0), (4e5, 200.0), (1.6e6, 100.0)]).is_some());
        assert_eq!(said(&[(1e3, 1e4), (4e3, 9e3), (1.6e4, 8e3)]), None, "hardly any work yet");
        // Errors that rise, and rounds that cost less.
        assert_eq!(said(&[(1e5, 100.0), (4e5, 200.0), (1.6e6, 300.0)]), None);
        assert_eq!(said(&[(1e5, 400.0), (4e5, 200.0), (3e5, 100.0)]), None);
    }
}
