//! Who is fastest to which accuracy: the cheapest setting of every code, decade by decade of a norm.

use super::claim::cheapest;
use super::problem::Code;
use super::results::Point;

/// The errors that are looked at: what is smaller is round-off, or the reference's.
pub const DECADES: [f64; 7] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// The cheapest settings with an error of at most a power of ten.
#[derive(Debug)]
pub struct Decade<'a> {
    /// The largest error.
    pub limit: f64,
    /// Ours.
    pub ours: Option<&'a Point>,
    /// Those of the other codes that have one, the fastest first.
    pub others: Vec<&'a Point>,
}

impl Decade<'_> {
    /// The time of the fastest other code divided by ours.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.others.first()?.seconds.median / self.ours?.seconds.median)
    }
}

/// The other codes that were run, in their order.
pub fn others(points: &[Point]) -> Vec<Code> {
    let mut codes: Vec<Code> = Vec::new();
    for code in points.iter().map(|point| point.code).filter(|code| !code.is_ours()) {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    codes
}

/// The decades of a norm in which some code is exact enough.
pub fn decades<'a>(points: &'a [Point], norm: &str) -> Vec<Decade<'a>> {
    let codes = others(points);
    let at = |limit: f64| {
        let of = |code: Code| cheapest(points.iter().filter(|p| p.code == code), Some((norm, limit)));
        let mut others: Vec<_> = codes.iter().filter_map(|code| of(*code)).collect();
        others.sort_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median));
        Decade { limit, ours: of(Code::Ours), others }
    };
    let reached = |decade: &Decade| decade.ours.is_some() || !decade.others.is_empty();
    DECADES.into_iter().map(at).filter(reached).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn the_fastest_of_every_code_stands_in_every_decade_it_reaches() {
        let points = [
            Point::example(Code::Accuracy, 1e-9, 0.1),
            Point::example(Code::Ours, 2e-3, 1.0),
            Point::example(Code::Ours, 1e-4, 3.0),
            Point::example(Code::Exudyn, 5e-3, 6.0),
            Point::example(Code::OpenSees, 5e-2, 0.5),
            Point::example(Code::OpenSees, 1e-3, 9.0),
        ];
        let found = decades(&points, "tip");
        let limits: Vec<_> = found.iter().map(|decade| decade.limit).collect();
        assert_eq!(limits, [1e-1, 1e-2, 1e-3, 1e-4]);
        let [tenth, hundredth, thousandth, last] = &found[..] else { panic!("four") };
        assert!(last.others.is_empty() && last.ratio().is_none(), "ours alone");
        assert_eq!(tenth.ratio(), Some(0.5));
        assert_eq!(
            hundredth.others.iter().map(|p| p.code).collect::<Vec<_>>(),
            [Code::Exudyn, Code::OpenSees]
        );
        assert_eq!((hundredth.ratio(), thousandth.ratio()), (Some(6.0), Some(3.0)));
    }
}
