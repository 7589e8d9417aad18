//! Rows of shape functions anywhere in a cell, from those at few points of it.
//!
//! Multiquadrics and exponentials are analytic, and with them the shape functions within a cell. The
//! polynomial through their values at n Chebyshev points therefore converges like ρ⁻ⁿ, where ρ grows
//! with the distance of the nearest singularity (Trefethen, *Approximation Theory and Approximation
//! Practice*, SIAM 2013, ch. 8); for a multiquadric of α node spacings ρ is about 4 α. A row from the
//! polynomial takes a tenth of the work that a solution in extended precision takes. It is
//! compared with such solutions between the points, and of functions with kinks there is none.

use std::f64::consts::PI;

use super::rpim::TOLERANCE;

/// Numbers of Chebyshev points, tried one after the other.
const POINTS: [usize; 2] = [16, 32];

/// The polynomials through the rows at Chebyshev points of a cell.
#[derive(Debug)]
pub struct Profile {
    /// ξ ∈ [0, 1].
    points: Vec<f64>,
    /// All rows at each point.
    rows: Vec<Vec<f64>>,
}

impl Profile {
    /// The polynomials of rows that `rows_at` gives for a ξ, each of `width` numbers; `None` where
    /// they are not as accurate as the rows themselves.
    pub fn new(width: usize, mut rows_at: impl FnMut(f64) -> Vec<f64>) -> Option<Self> {
        POINTS.into_iter().find_map(|count| {
            let last = (count - 1) as f64;
            let points: Vec<f64> = (0..count).map(|j| 0.5 - 0.5 * (j as f64 * PI / last).cos()).collect();
            let rows = points.iter().map(|xi| rows_at(*xi)).collect();
            let profile = Self { points, rows };
            // Errors are large halfway between two points: near an end, in the middle, and between.
            let between = |j: usize| 0.5 * (profile.points[j] + profile.points[j + 1]);
            let good = [0, count / 4, count / 2 - 1].into_iter().all(|j| {
                let xi = between(j);
                let (found, expected) = (profile.at(xi), rows_at(xi));
                found.chunks(width).zip(expected.chunks(width)).all(|(found, expected)| {
                    let size = expected.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
                    found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= TOLERANCE * size)
                })
            });
            good.then_some(profile)
        })
    }

    /// The rows at ξ, by the barycentric formula (Berrut & Trefethen, *SIAM Review* 46, 2004).
    pub fn at(&self, xi: f64) -> Vec<f64> {
        if let Some(hit) = self.points.iter().position(|point| *point == xi) {
            return self.rows[hit].clone();
        }
        let last = self.points.len() - 1;
        let mut sum = vec![0.0; self.rows[0].len()];
        let mut of_one = 0.0;
        for (j, (point, rows)) in self.points.iter().zip(&self.rows).enumerate() {
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            let end = if j == 0 || j == last { 0.5 } else { 1.0 };
            let weight = sign * end / (xi - point);
            of_one += weight;
            sum.iter_mut().zip(rows).for_each(|(sum, value)| *sum += weight * value);
        }
        sum.iter_mut().for_each(|sum| *sum /= of_one);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_functions_are_found_to_all_digits() {
        let runge = |a: f64| move |xi: f64| vec![1.0 / (1.0 + (a * (xi - 0.3)).powi(2)), xi.powi(5) - 2.0];
        for (a, count) in [(0.25, 16), (1.2, 32)] {
            let profile = Profile::new(1, runge(a)).expect("a polynomial");
            assert_eq!(profile.points.len(), count, "{a}");
            for xi in [0.0, 1e-9, 0.123, 0.5, 0.777, 1.0] {
                for (found, expected) in profile.at(xi).iter().zip(runge(a)(xi)) {
                    assert!((found - expected).abs() < 1e-13 * expected.abs().max(1.0), "{a}, {xi}: {found}");
                }
            }
        }
    }

    /// A kink, and a singularity near the cell.
    #[test]
    fn functions_that_are_not_smooth_enough_have_none() {
        assert!(Profile::new(1, |xi| vec![(xi - 0.4).abs().powi(7)]).is_none());
        assert!(Profile::new(1, |xi| vec![1.0 / (1.0 + (9.0 * xi).powi(2))]).is_none());
        // Large values of one row do not hide what is wrong with another.
        assert!(Profile::new(1, |xi| vec![1e20, (xi - 0.4).abs().powi(7)]).is_none());
    }
}
