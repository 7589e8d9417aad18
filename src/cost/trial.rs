//! Measured settings, and the best of them.

use serde::Serialize;

use super::deviation::Deviation;
use crate::accuracy::setting::{Family, Setting};
use crate::results::Statistics;

/// A setting with its cost and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The kind of discretisation.
    pub family: Family,
    /// Cells of the beam that has most of them.
    pub cells: usize,
    /// Everything that was varied.
    pub setting: Setting,
    /// Its cost and its errors.
    pub measured: Measured,
}

/// Cost and error of a setting.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Unknowns after supports are eliminated, plus multipliers.
    pub degrees_of_freedom: usize,
    /// Wall time to build and to solve, median of the runs \[s\].
    pub seconds: f64,
    /// How often it was run.
    pub runs: usize,
    /// Counts.
    pub statistics: Statistics,
    /// Its errors.
    pub deviation: Deviation,
    /// Warnings of its runs; a setting with any is not recommended.
    pub warnings: Vec<String>,
}

impl Measured {
    /// Tangent evaluations and factorisations.
    pub fn work(&self) -> usize {
        self.statistics.tangent_evaluations + self.statistics.factorizations
    }

    /// [`Self::work`] times the unknowns, to which the cost of either is proportional: a cost
    /// without a clock.
    pub fn sized_work(&self) -> f64 {
        self.work() as f64 * self.degrees_of_freedom as f64
    }
}

/// Indices of the points (cost, error) that no other one beats in both, by ascending cost. Of equal
/// ones the first.
pub(super) fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])));
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i][1] < least;
        least = least.min(points[i][1]);
        better
    });
    order
}

/// Index of the cheapest of the points (cost, error) whose error is at most `target`.
pub(super) fn cheapest(points: &[[f64; 2]], target: f64) -> Option<usize> {
    let meets = (0..points.len()).filter(|&i| points[i][1] <= target);
    meets.min_by(|&a, &b| points[a][0].total_cmp(&points[b][0]))
}

/// (seconds, error) of every trial. An error below `least` counts as `least`, because such errors
/// cannot be distinguished.
pub(super) fn points(trials: &[Trial], least: f64) -> Vec<[f64; 2]> {
    trials.iter().map(|trial| [trial.measured.seconds, trial.measured.deviation.error.max(least)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::Solver;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [[3.0, 1e-4], [1.0, 1e-2], [2.0, 2e-2], [4.0, 1e-4], [5.0, 1e-6], [1.0, 1e-1]];
        assert_eq!(front(&points), [1, 0, 4]);
        assert_eq!(front(&[]), [0_usize; 0]);
    }

    #[test]
    fn work_counts_tangents_and_factorisations_by_unknown() {
        let statistics = Statistics { tangent_evaluations: 3, factorizations: 4, ..Statistics::default() };
        let measured = Measured { degrees_of_freedom: 10, statistics, ..Measured::default() };
        assert_eq!((measured.work(), measured.sized_work()), (7, 70.0));
    }

    #[test]
    fn errors_that_nobody_can_tell_apart_are_equal() {
        let trial = |seconds: f64, error: f64| Trial {
            family: Family::FULL,
            cells: 4,
            setting: Setting { beams: vec![], solver: Solver::Scene },
            measured: Measured {
                seconds,
                deviation: Deviation { error, ..Deviation::default() },
                ..Measured::default()
            },
        };
        let trials = [trial(3.0, 1e-2), trial(1.0, 1e-7), trial(2.0, 1e-5)];
        assert_eq!(points(&trials, 1e-5), [[3.0, 1e-2], [1.0, 1e-5], [2.0, 1e-5]]);
    }

    #[test]
    fn the_cheapest_meets_the_target() {
        let points = [[3.0, 1e-4], [1.0, 1e-2], [2.0, 9e-5], [9.0, 1e-9]];
        assert_eq!(cheapest(&points, 1e-4), Some(2));
        assert_eq!(cheapest(&points, 1e-2), Some(1));
        assert_eq!(cheapest(&points, 1e-10), None);
    }
}
