//! What an accuracy alone costs, beside the cheapest setting that somebody could have named who had
//! tried them all.
//!
//! All runs that the choice and the estimate took count, from the tables of shape functions to the
//! results along the beams, and so does the whole run of a named setting; of other codes the
//! solution, and the preparation where it is known.

use serde::{Deserialize, Serialize};

use super::claim::Cheapest;
use super::problem::{Code, Price};
use super::results::Point;

/// The price of one accuracy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Paid {
    /// The accuracy.
    pub wanted: f64,
    /// The same as an error in the norm.
    pub limit: f64,
    /// What was chosen.
    pub alone: Cheapest,
    /// Our cheapest setting that errs by no more than `limit`.
    pub ours: Option<Cheapest>,
    /// The other codes' one.
    pub theirs: Option<Cheapest>,
    /// How many times dearer than `ours`.
    pub dearer: Option<f64>,
    /// How many times faster than `theirs`.
    pub faster: Option<f64>,
    /// Whether it is as accurate as was wanted, no dearer than it may be, and as much faster.
    pub met: bool,
}

/// Prices of all accuracies that were run.
pub fn paid(price: &Price, points: &[Point]) -> Vec<Paid> {
    let solved = |point: &Point| point.seconds.median + point.build.map_or(0.0, |build| build.median);
    let total = |point: &Point| point.whole.map_or_else(|| solved(point), |whole| whole.median);
    let taken = |point: &Point| Cheapest {
        setting: point.name(),
        error: point.error.get(&price.norm).copied(),
        seconds: total(point),
    };
    let cheapest = |limit: f64, code: &dyn Fn(Code) -> bool| {
        let good = points.iter().filter(|point| code(point.code));
        let good = good.filter(|point| point.error.get(&price.norm).is_some_and(|error| *error <= limit));
        good.min_by(|a, b| total(a).total_cmp(&total(b))).map(taken)
    };
    let of = |point: &Point| {
        let wanted = point.wanted?;
        let limit = wanted * price.unit;
        let alone = taken(point);
        let ours = cheapest(limit, &|code| code == Code::Ours);
        let theirs = cheapest(limit, &|code| !code.is_ours());
        let dearer = ours.as_ref().map(|ours| alone.seconds / ours.seconds);
        let faster = theirs.as_ref().map(|theirs| theirs.seconds / alone.seconds);
        let accurate = alone.error.is_some_and(|error| error <= limit);
        let cheap = dearer.is_none_or(|dearer| dearer <= price.dearer);
        let asked = price.faster.as_ref().filter(|asked| asked.at == wanted);
        let fast = asked.is_none_or(|asked| faster.is_none_or(|faster| faster >= asked.times));
        let met = accurate && cheap && fast;
        Some(Paid { wanted, limit, alone, ours, theirs, dearer, faster, met })
    };
    points.iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::problem::Faster;
    use crate::work::results::Spread;

    fn point(code: Code, wanted: Option<f64>, error: f64, seconds: f64, whole: Option<f64>) -> Point {
        let whole = whole.map(|whole| Spread::of(&[whole]));
        Point { wanted, whole, ..Point::example(code, error, seconds) }
    }

    #[test]
    fn everything_counts_that_somebody_waits_for() {
        let faster = Some(Faster { at: 1e-4, times: 5.0 });
        let price = |dearer| Price {
            norm: "tip".into(),
            unit: 2.0,
            set: vec![],
            accuracies: vec![1e-4],
            dearer,
            faster: faster.clone(),
        };
        let points = |error: f64, theirs: f64| {
            vec![
                point(Code::Accuracy, Some(1e-4), error, 6.0, None),
                point(Code::Ours, None, 2e-4, 1.0, Some(2.5)),
                point(Code::Ours, None, 1e-4, 1.0, Some(3.0)),
                point(Code::Ours, None, 3e-4, 0.1, None),
                point(Code::Exudyn, None, 2e-4, theirs, None),
            ]
        };
        let of =
            |dearer: f64, error: f64, theirs: f64| paid(&price(dearer), &points(error, theirs)).remove(0);
        let found = of(3.0, 1.5e-4, 36.0);
        assert_eq!((found.dearer, found.faster, found.met), (Some(2.4), Some(6.0), true));
        assert!(!of(2.0, 1.5e-4, 36.0).met, "too dear");
        assert!(!of(3.0, 2.5e-4, 36.0).met, "not accurate");
        assert!(!of(3.0, 1.5e-4, 24.0).met, "not faster than others");
        let alone = paid(&price(3.0), &points(1.5e-4, 36.0)[..1]).remove(0);
        assert_eq!((alone.ours, alone.theirs, alone.met), (None, None, true));
    }
}
