//! The cheapest setting that is good enough, the Pareto front, and what becomes of a claim.

use serde::{Deserialize, Serialize};

use super::problem::{Claim, Code};
use super::results::Point;

/// A claim with its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Its meaning, for the reader.
    pub says: String,
    /// The name of the norm, and the largest error; none: any error.
    pub limit: Option<(String, f64)>,
    /// How many times faster ours is to be.
    pub times: f64,
    /// Our cheapest setting that keeps the limit.
    pub ours: Option<Cheapest>,
    /// The cheapest setting of the other code, or of those of our methods that it is compared with.
    pub theirs: Option<Cheapest>,
    /// Their time divided by ours.
    pub ratio: Option<f64>,
    /// Whether the claim holds; none where no setting that ours is compared with was run and is
    /// good enough.
    pub met: Option<bool>,
}

/// A setting that was chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cheapest {
    /// Method and setting.
    pub setting: String,
    /// Its error in the claim's norm.
    pub error: Option<f64>,
    /// Median of the solve times \[s\].
    pub seconds: f64,
}

/// The point with the least median time among those whose error in `limit`'s norm is at most the
/// limit's.
pub fn cheapest<'a>(
    points: impl Iterator<Item = &'a Point>,
    limit: Option<(&str, f64)>,
) -> Option<&'a Point> {
    let good = |point: &&Point| {
        limit.is_none_or(|(norm, largest)| point.error.get(norm).is_some_and(|&error| error <= largest))
    };
    points.filter(good).min_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median))
}

/// Per point, whether no other one is at least as exact and as fast, and better in one of the two.
pub fn on_front(points: &[&Point], norm: &str) -> Vec<bool> {
    let place = |point: &Point| Some((*point.error.get(norm)?, point.seconds.median));
    let beaten = |(error, seconds): (f64, f64)| {
        points
            .iter()
            .filter_map(|other| place(other))
            .any(|(e, s)| e <= error && s <= seconds && (e < error || s < seconds))
    };
    points.iter().map(|point| place(point).is_some_and(|at| !beaten(at))).collect()
}

/// Judges a claim.
pub fn judge(claim: &Claim, points: &[Point]) -> Verdict {
    let limit = claim.norm.clone().zip(claim.error);
    let borrowed = limit.as_ref().map(|(norm, error)| (norm.as_str(), *error));
    let of = |ours: bool, names: &[String]| {
        let takes_part = |point: &&Point| match ours {
            _ if !names.is_empty() => names.contains(&point.method),
            true => point.code == Code::Ours,
            false => !point.code.is_ours(),
        };
        let found = cheapest(points.iter().filter(takes_part), borrowed)?;
        Some(Cheapest {
            setting: found.name(),
            error: borrowed.and_then(|(norm, _)| found.error.get(norm).copied()),
            seconds: found.seconds.median,
        })
    };
    let (ours, theirs) = (of(true, &claim.ours), of(false, &claim.than));
    let ratio = ours.as_ref().zip(theirs.as_ref()).map(|(a, b)| b.seconds / a.seconds);
    let met = match (&ours, ratio) {
        (None, _) => Some(false),
        (_, Some(ratio)) => Some(ratio >= claim.times),
        (_, None) => None,
    };
    Verdict { says: claim.says.trim().to_owned(), limit, times: claim.times, ours, theirs, ratio, met }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(code: Code, method: &str, error: f64, seconds: f64) -> Point {
        Point {
            method: method.into(),
            line: method.into(),
            setting: format!("{seconds} s"),
            ..Point::example(code, error, seconds)
        }
    }

    fn points() -> Vec<Point> {
        vec![
            point(Code::Ours, "a", 1e-2, 1.0),
            point(Code::Ours, "a", 1e-3, 2.0),
            point(Code::Ours, "b", 5e-4, 2.0),
            point(Code::Ours, "b", 1e-3, 3.0),
            point(Code::Exudyn, "x", 1e-3, 40.0),
            point(Code::Exudyn, "y", 1e-3, 30.0),
        ]
    }

    fn claim(error: f64, times: f64) -> Claim {
        let norm = Some("tip".to_owned());
        Claim { says: String::new(), norm, error: Some(error), ours: vec![], than: vec![], times }
    }

    #[test]
    fn the_cheapest_is_the_fastest_of_those_that_are_good_enough() {
        let points = points();
        let at = |limit| cheapest(points.iter(), limit).map(|p| (p.seconds.median, p.error["tip"]));
        assert_eq!(at(Some(("tip", 1e-2))), Some((1.0, 1e-2)));
        assert_eq!(at(Some(("tip", 9e-4))), Some((2.0, 5e-4)));
        assert_eq!(at(Some(("tip", 1e-5))), None);
        assert_eq!(at(Some(("energy", 1.0))), None);
        assert_eq!(at(None), Some((1.0, 1e-2)));
    }

    #[test]
    fn the_front_holds_what_nothing_beats_in_both() {
        let points = points();
        let points: Vec<&Point> = points.iter().collect();
        assert_eq!(on_front(&points, "tip"), [true, false, true, false, false, false]);
        assert_eq!(on_front(&points, "energy"), [false; 6]);
    }

    #[test]
    fn a_claim_is_met_missed_or_undecided() {
        let points = points();
        let verdict = judge(&claim(1e-3, 10.0), &points);
        assert_eq!((verdict.ratio, verdict.met), (Some(15.0), Some(true)));
        assert_eq!(judge(&claim(1e-3, 20.0), &points).met, Some(false));
        let only = Claim { than: vec!["x".into()], ..claim(1e-3, 20.0) };
        assert_eq!(judge(&only, &points).ratio, Some(20.0));
        let own = Claim { ours: vec!["a".into()], than: vec!["b".into()], ..claim(1e-3, 1.0) };
        assert_eq!(judge(&own, &points).ratio, Some(1.0), "two methods of ours");
        assert_eq!(judge(&claim(5e-4, 1.0), &points).met, None, "nothing to compare with");
        assert_eq!(judge(&claim(1e-9, 1.0), &points).met, Some(false), "ours is not good enough");
    }
}
