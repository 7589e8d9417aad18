//! Gauss–Legendre and Gauss–Lobatto rules on [0, 1].
//!
//! The abscissae are the roots of P_n (Gauss) or those of P'_{n−1} and both ends (Lobatto).
//! Newton's method finds them from asymptotic starting values, to the last digit or two of double
//! precision, for any number of points.

use super::error::BasisError;

/// Most points in a rule; an energy density that seems to need more points needs more nodes
/// instead.
pub const MOST_POINTS: usize = 64;

/// A quadrature rule, by family and number of points in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quadrature {
    /// n interior points, exact for polynomials up to degree 2n − 1; n from 1 to 64.
    Gauss(usize),
    /// n points, both ends among them, exact up to degree 2n − 3; n from 2 to 64.
    Lobatto(usize),
}

impl Quadrature {
    /// Number of points in a cell.
    pub fn points(self) -> usize {
        match self {
            Self::Gauss(n) | Self::Lobatto(n) => n,
        }
    }

    /// Abscissae ξ ∈ [0, 1] in ascending order, and weights that sum to one.
    ///
    /// # Errors
    /// [`BasisError::Quadrature`] if the family has no rule with that many points.
    pub fn rule(self) -> Result<(Vec<f64>, Vec<f64>), BasisError> {
        let (name, n, least) = match self {
            Self::Gauss(n) => ("Gauss", n, 1),
            Self::Lobatto(n) => ("Lobatto", n, 2),
        };
        if n < least || n > MOST_POINTS {
            return Err(BasisError::Quadrature { rule: name, points: n, least, most: MOST_POINTS });
        }
        let on_symmetric_interval = match self {
            Self::Gauss(_) => gauss(n),
            Self::Lobatto(_) => lobatto(n),
        };
        Ok(on_symmetric_interval.into_iter().map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w)).unzip())
    }
}

/// P_n(x), P'_n(x) and P''_n(x) for |x| < 1, by the three-term recurrence and Legendre's equation.
fn legendre(n: usize, x: f64) -> (f64, f64, f64) {
    let (mut before, mut p) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0));
    }
    let n = n as f64;
    let q = (1.0 - x) * (1.0 + x);
    let d = n * (before - x * p) / q;
    (p, d, (2.0 * x * d - n * (n + 1.0) * p) / q)
}

/// Finds the roots in the lower half by Newton's method and mirrors them, so the rule is exactly
/// symmetric.
fn symmetric(
    n: usize,
    start: impl Fn(usize) -> f64,
    refine: impl Fn(f64) -> f64,
    weight: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        let x = if 2 * i + 1 == n { 0.0 } else { (0..8).fold(start(i), |x, _| refine(x)) };
        points[i] = (x, weight(x));
        points[n - 1 - i] = (-x, weight(x));
    }
    points
}

fn gauss(n: usize) -> Vec<(f64, f64)> {
    let m = n as f64;
    symmetric(
        n,
        |i| -(std::f64::consts::PI * (i as f64 + 0.75) / (m + 0.5)).cos(),
        |x| {
            let (p, d, _) = legendre(n, x);
            x - p / d
        },
        |x| {
            let d = legendre(n, x).1;
            2.0 / ((1.0 - x) * (1.0 + x) * d * d)
        },
    )
}

fn lobatto(n: usize) -> Vec<(f64, f64)> {
    let m = (n * (n - 1)) as f64;
    let interior = symmetric(
        n - 2,
        |i| -(std::f64::consts::PI * (i as f64 + 1.25) / (n as f64 - 0.5)).cos(),
        |x| {
            let (_, d, dd) = legendre(n - 1, x);
            x - d / dd
        },
        |x| {
            let p = legendre(n - 1, x).0;
            2.0 / (m * p * p)
        },
    );
    let end = 2.0 / m;
    std::iter::once((-1.0, end)).chain(interior).chain(std::iter::once((1.0, end))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_is_exact_for_its_degree() {
        for n in 1..=MOST_POINTS {
            for rule in [Quadrature::Gauss(n), Quadrature::Lobatto(n)] {
                let Ok((x, w)) = rule.rule() else {
                    assert_eq!(rule, Quadrature::Lobatto(1));
                    continue;
                };
                let degree = if let Quadrature::Gauss(_) = rule { 2 * n - 1 } else { 2 * n - 3 };
                assert!(x.windows(2).all(|p| p[0] < p[1]), "{rule:?}: {x:?}");
                for power in 0..=degree {
                    let sum: f64 = x.iter().zip(&w).map(|(x, w)| w * x.powi(power as i32)).sum();
                    let exact = 1.0 / (power as f64 + 1.0);
                    assert!(
                        (sum - exact).abs() < 3e-15,
                        "{rule:?}, degree {power}: {sum} instead of {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn impossible_rules_are_refused() {
        for rule in
            [Quadrature::Gauss(0), Quadrature::Gauss(65), Quadrature::Lobatto(1), Quadrature::Lobatto(65)]
        {
            assert!(matches!(rule.rule(), Err(BasisError::Quadrature { .. })));
        }
    }
}
