//! Cubic splines: piecewise cubics through given values, twice continuously differentiable.

/// The condition at an end of a spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The first derivative is zero.
    Flat,
    /// The second derivative is zero.
    Straight,
    /// The third derivative does not jump at the nearest inner knot, if there is one.
    Smooth,
}

/// First derivatives at the knots of a spline, for D components at once, from the spacings `h` of
/// the knots and the divided differences `slope` of the values between them.
///
/// Every pivot of the elimination is positive, whatever the spacings are.
pub fn rates<const D: usize>(h: &[f64], slope: &[[f64; D]], ends: [End; 2]) -> Vec<[f64; D]> {
    let n = h.len() + 1;
    if n == 3 && ends == [End::Smooth; 2] {
        // The parabola through the three points.
        let total = h[0] + h[1];
        let middle = combine(h[1] / total, slope[0], h[0] / total, slope[1]);
        return vec![combine(2.0, slope[0], -1.0, middle), middle, combine(2.0, slope[1], -1.0, middle)];
    }
    // Rows: lower d[i − 1] + diagonal d[i] + upper d[i + 1] = right. For an end, `row` returns the
    // diagonal entry, the entry of the neighbour, and the right side.
    let row = |end: End, [near, far]: [usize; 2]| match end {
        End::Flat => (1.0, 0.0, [0.0; D]),
        End::Smooth if n > 2 => {
            let (a, b) = (h[near], h[far]);
            let right = combine((a + 2.0 * (a + b)) * b / (a + b), slope[near], a * a / (a + b), slope[far]);
            (b, a + b, right)
        }
        End::Straight | End::Smooth => (2.0, 1.0, slope[near].map(|m| 3.0 * m)),
    };
    let [mut lower, mut diagonal, mut upper] = [const { Vec::new() }; 3].map(|_: Vec<f64>| vec![0.0; n]);
    let mut right = vec![[0.0; D]; n];
    (diagonal[0], upper[0], right[0]) = row(ends[0], [0, 1]);
    (diagonal[n - 1], lower[n - 1], right[n - 1]) = row(ends[1], [n - 2, n.saturating_sub(3)]);
    for i in 1..n - 1 {
        lower[i] = h[i];
        diagonal[i] = 2.0 * (h[i - 1] + h[i]);
        upper[i] = h[i - 1];
        right[i] = combine(3.0 * h[i], slope[i - 1], 3.0 * h[i - 1], slope[i]);
    }
    for i in 1..n {
        let factor = lower[i] / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        right[i] = combine(1.0, right[i], -factor, right[i - 1]);
    }
    let mut d = vec![[0.0; D]; n];
    d[n - 1] = right[n - 1].map(|r| r / diagonal[n - 1]);
    for i in (0..n - 1).rev() {
        d[i] = combine(1.0 / diagonal[i], right[i], -upper[i] / diagonal[i], d[i + 1]);
    }
    d
}

fn combine<const D: usize>(a: f64, p: [f64; D], b: f64, q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| a * p[k] + b * q[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first derivatives of the spline through the values of a function at `knots`.
    fn of(value: impl Fn(f64) -> f64, knots: &[f64], ends: [End; 2]) -> Vec<f64> {
        let h: Vec<f64> = knots.windows(2).map(|t| t[1] - t[0]).collect();
        let slope: Vec<[f64; 1]> =
            knots.windows(2).map(|t| [(value(t[1]) - value(t[0])) / (t[1] - t[0])]).collect();
        rates(&h, &slope, ends).into_iter().map(|[d]| d).collect()
    }

    fn near(found: &[f64], expected: impl Fn(f64) -> f64, knots: &[f64]) {
        assert_eq!(found.len(), knots.len());
        for (d, t) in found.iter().zip(knots) {
            assert!((d - expected(*t)).abs() < 1e-12, "{d}, not {} at {t}", expected(*t));
        }
    }

    /// A cubic that satisfies the end conditions is the spline through its own values.
    #[test]
    fn cubics_are_their_own_splines() {
        let knots = [0.0, 1.0, 3.0, 4.0, 6.0];
        let any = |t: f64| 2.0 - t + 0.5 * t * t - 0.25 * t * t * t;
        near(&of(any, &knots, [End::Smooth; 2]), |t| -1.0 + t - 0.75 * t * t, &knots);
        // The derivative is zero at 0 and at 6.
        let flat = |t: f64| t * t * (9.0 - t);
        near(&of(flat, &knots, [End::Flat; 2]), |t| 18.0 * t - 3.0 * t * t, &knots);
        // The second derivative is zero at 0, the first at 6.
        let mixed = |t: f64| 108.0 * t - t * t * t;
        near(&of(mixed, &knots, [End::Straight, End::Flat]), |t| 108.0 - 3.0 * t * t, &knots);
        let back = |t: f64| mixed(6.0 - t);
        let mirrored = [0.0, 2.0, 3.0, 5.0, 6.0];
        near(
            &of(back, &mirrored, [End::Flat, End::Straight]),
            |t| 3.0 * (6.0 - t).powi(2) - 108.0,
            &mirrored,
        );
    }

    #[test]
    fn few_knots_have_a_line_or_a_parabola() {
        let line = |t: f64| 3.0 - 2.0 * t;
        for end in [End::Smooth, End::Straight] {
            near(&of(line, &[1.0, 4.0], [end; 2]), |_| -2.0, &[1.0, 4.0]);
        }
        near(&of(line, &[1.0, 4.0], [End::Flat; 2]), |_| 0.0, &[1.0, 4.0]);
        let knots = [0.0, 1.0, 4.0];
        near(&of(|t| t * t, &knots, [End::Smooth; 2]), |t| 2.0 * t, &knots);
    }
}
