//! Product integration: quantities with kinks in sums over whole cells.
//!
//! A rule with the points sᵢ and the weights wᵢ is exact for smooth functions only. The integral of a quantity f with kinks, times a smooth
//! function g, is the sum over the same points with
//!
//! ```text
//! ∫ f g ds ≈ Σ wᵢ fᵢ g(sᵢ),   fᵢ = 1/wᵢ ∫ ℓᵢ f ds
//! ```
//!
//! where ℓᵢ are Lagrange's polynomials of the points. It sees every kink, and has no more points than the rule: with
//! those of a cell that is divided at its kinks, a beam would be held against stretch at more points than its shape functions can follow,
//! and slender ones would not bend there.

use super::Along;
use crate::basis::{BasisError, Quadrature};

/// Kinks nearer to an end of a cell than this part of its length are at the end.
const SLIVER: f64 = 1e-9;
/// Points in a piece between two kinks; exact for Lagrange's polynomials of six points times linear quantities.
const POINTS: usize = 4;

/// The points and the weights of a rule in a cell from 0 to 1.
pub struct ProductRule {
    points: Vec<f64>,
    weights: Vec<f64>,
    piece: (Vec<f64>, Vec<f64>),
}

/// A cell: where it begins \[m\], its length \[m\], and the arc lengths of its points \[m\].
struct Cell<'a> {
    start: f64,
    length: f64,
    places: &'a [f64],
}

impl Cell<'_> {
    fn middle(&self) -> f64 {
        self.start + 0.5 * self.length
    }

    /// Kinks inside, as parts of the length, rising.
    fn inside(&self, kinks: Vec<f64>) -> Vec<f64> {
        let parts = kinks.into_iter().map(|s| (s - self.start) / self.length);
        let mut parts: Vec<f64> = parts.filter(|part| (SLIVER..1.0 - SLIVER).contains(part)).collect();
        parts.sort_by(f64::total_cmp);
        parts.dedup();
        parts
    }
}

impl ProductRule {
    /// # Errors
    /// [`BasisError::Quadrature`] if there is no such rule.
    pub fn new(rule: Quadrature) -> Result<Self, BasisError> {
        let (points, weights) = rule.rule()?;
        Ok(Self { points, weights, piece: Quadrature::Gauss(POINTS).rule()? })
    }

    /// fᵢ at the points `places` \[m\] of a cell of the given length \[m\]: in a cell where nothing has a kink its values there. What is composed
    /// of quantities is so of their fᵢ, so that what belongs together stays together, and these keep a sign: a stiffness stays positive.
    pub fn values(&self, of: &Along, places: &[f64], length: f64) -> Vec<f64> {
        let first = places.first().copied().unwrap_or(0.0);
        let cell = Cell { start: first - self.points[0] * length, length, places };
        if cell.inside(of.kinks()).is_empty() {
            return places.iter().map(|s| of.at(*s, cell.middle())).collect();
        }
        (0..places.len()).map(|point| self.value(of, &cell, point)).collect()
    }

    fn value(&self, of: &Along, cell: &Cell<'_>, point: usize) -> f64 {
        let value = |of: &Along| self.value(of, cell, point);
        match of {
            Along::Constant(_) | Along::Polynomial(_) => of.at(cell.places[point], cell.middle()),
            Along::Product(all) => all.iter().map(value).product(),
            Along::Sum(all) => all.iter().map(value).sum(),
            Along::Quotient(pair) => value(&pair[0]) / value(&pair[1]),
            Along::Within { from, to, quantity } => {
                let indicator = Along::Pieces { until: vec![*from, *to], value: vec![0.0, 1.0, 0.0] };
                self.mean(&indicator, cell, point) * value(quantity)
            }
            Along::Table { .. } | Along::Pieces { .. } => self.mean(of, cell, point),
        }
    }

    /// 1/wᵢ ∫ ℓᵢ f ds; of half the smallest size in the cell at least, where f has one sign there.
    fn mean(&self, of: &Along, cell: &Cell<'_>, point: usize) -> f64 {
        let inside = cell.inside(of.kinks());
        let ends = || [0.0].into_iter().chain(inside.iter().copied()).chain([1.0]);
        let (mut integral, mut bounds) = (0.0, [f64::INFINITY, f64::NEG_INFINITY]);
        for (from, to) in ends().zip(ends().skip(1)) {
            let place = |part: f64| cell.start + part * cell.length;
            let at = |part: f64| of.at(place(part), place(0.5 * (from + to)));
            for value in [from, to].map(at) {
                bounds = [bounds[0].min(value), bounds[1].max(value)];
            }
            for (x, weight) in self.piece.0.iter().zip(&self.piece.1) {
                let x = from + x * (to - from);
                integral += weight * (to - from) * at(x) * self.lagrange(point, x);
            }
        }
        let mean = integral / self.weights[point];
        match bounds {
            [low, _] if low >= 0.0 => mean.max(0.5 * low),
            [_, high] if high <= 0.0 => mean.min(0.5 * high),
            _ => mean,
        }
    }

    fn lagrange(&self, point: usize, x: f64) -> f64 {
        let own = self.points[point];
        let others = self.points.iter().enumerate().filter(|(other, _)| *other != point);
        others.map(|(_, other)| (x - other) / (own - other)).product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polygon 2 − s to 1/3 of a cell from 0 to 1, and then level, at the two points ½ ∓ 1/√12 of Gauss: ∫ f ds = 5/3 + 1/18 = 31/18 and
    /// ∫ f s ds = 5/6 + 1/6 (1/3)³ = 68/81, which the sum has, too.
    #[test]
    fn polygons_are_integrated_within_a_cell() {
        let rule = ProductRule::new(Quadrature::Gauss(2)).unwrap();
        let polygon = Along::Table { s: vec![0.0, 1.0 / 3.0, 1.0], value: vec![2.0, 5.0 / 3.0, 5.0 / 3.0] };
        let off = 12.0_f64.sqrt().recip();
        let places = [0.5 - off, 0.5 + off];
        let found = rule.values(&polygon, &places, 1.0);
        assert!((0.5 * (found[0] + found[1]) - 31.0 / 18.0).abs() < 1e-14, "{found:?}");
        let moment = 0.5 * (found[0] * places[0] + found[1] * places[1]);
        assert!((moment - 68.0 / 81.0).abs() < 1e-14, "{moment}");
    }

    /// Without a kink inside a cell the values are those at the points, in every digit; kinks at its ends are none.
    #[test]
    fn smooth_cells_have_the_values_at_their_points() {
        let rule = ProductRule::new(Quadrature::Lobatto(3)).unwrap();
        let table = Along::Table { s: vec![0.0, 1.0, 2.0], value: vec![1.0, 3.0, 2.0] };
        let pieces = Along::Pieces { until: vec![1.0], value: vec![5.0, 7.0] };
        assert_eq!(rule.values(&table, &[1.0, 1.5, 2.0], 1.0), [3.0, 2.5, 2.0]);
        assert_eq!(rule.values(&pieces, &[1.0, 1.5, 2.0], 1.0), [7.0; 3]);
        assert_eq!(rule.values(&pieces.product(&table), &[0.0, 0.5, 1.0], 1.0), [5.0, 10.0, 15.0]);
    }

    /// A range that ends in the middle of a cell holds at the first point, half at the middle one and not at the last; a narrow peak between the points
    /// is seen; and no value has another sign, nor has a product or a quotient than its operands.
    #[test]
    fn what_lies_between_the_points_is_seen() {
        let rule = ProductRule::new(Quadrature::Lobatto(3)).unwrap();
        let places = [0.0, 0.5, 1.0];
        let half = Along::Constant(4.0).within([0.0, 0.5]);
        // ∫ ℓ₁ ds is 5/24 over the first half, for a weight of 1/6, and −1/24 over the second.
        let found = rule.values(&half, &places, 1.0);
        assert!((found[0] - 5.0).abs() < 1e-14 && (found[1] - 2.0).abs() < 1e-14, "{found:?}");
        assert_eq!(found[2], 0.0);
        let peak = Along::Table { s: vec![0.0, 0.2, 0.25, 0.3, 1.0], value: vec![0.0, 0.0, 8.0, 0.0, 0.0] };
        let found = rule.values(&peak, &places, 1.0);
        // ½ · 8 · 0.1 = 0.4, of which the three points have ℓᵢ(1/4) = 3/8, 3/4 and −1/8 nearly: none is negative.
        assert!((found[0] - 0.4 * 0.375 * 6.0).abs() < 0.01, "{found:?}");
        assert!((found[1] - 0.4 * 0.75 * 1.5).abs() < 0.01, "{found:?}");
        assert_eq!(found[2], 0.0);
        let both = peak.product(&half);
        assert!((rule.values(&both, &places, 1.0)[0] - 5.0 * found[0]).abs() < 1e-13);
        let ratio = half.over(&Along::Table { s: vec![0.0, 0.3, 1.0], value: vec![1.0, 2.0, 1.0] });
        assert!(rule.values(&ratio, &places, 1.0).iter().all(|value| (0.0..=5.0).contains(value)));
    }
}
