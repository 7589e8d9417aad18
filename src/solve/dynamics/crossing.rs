//! Where a polynomial of time reaches zero, and where it turns back.
//!
//! Between the zeros of its derivative a polynomial is monotonic and has
//! at most one zero, and the zeros of the derivative are found in the same way. So no zero is
//! missed, and no sampling is needed.
//!
//! A value is reached from below (rising) or from above (falling). A coordinate that turns back at
//! the value has reached it too, once; round-off cannot tell it from one that turns just before or
//! just beyond. So a coordinate is *at* the value if it is within [`NEAR`] beam lengths of it at a
//! turning point or at the end of a step, and must leave this range before it can reach the value
//! again.

/// Distance from a value that counts as zero, in beam lengths: the round-off of positions.
pub(super) const NEAR: f64 = 1e-9;
/// Bisections of a step: down to its last bits.
const BISECTIONS: u32 = 55;
/// Largest degree of an interpolation.
const DEGREE: usize = 5;

/// Σ c_k xᵏ, x from 0 at the start of a step to 1 at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Polynomial([f64; DEGREE + 1]);

/// A value that is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reached {
    /// Where in the step, from 0 to 1.
    pub at: f64,
    /// Whether from below.
    pub rising: bool,
}

impl Polynomial {
    /// The polynomial with these values, h times these velocities and, if given, h²/2 times these
    /// accelerations at both ends of a step of length h.
    pub(super) fn hermite([q0, q1]: [f64; 2], [v0, v1]: [f64; 2], halves: Option<[f64; 2]>) -> Self {
        let rise = q1 - q0;
        let Some([a0, a1]) = halves else {
            return Self([q0, v0, 3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise, 0.0, 0.0]);
        };
        // The higher coefficients follow from the data at the end, less the lower terms.
        let (d, s, c) = (rise - v0 - a0, v1 - v0 - 2.0 * a0, a1 - a0);
        let [third, fourth, fifth] =
            [10.0 * d - 4.0 * s + c, -15.0 * d + 7.0 * s - 2.0 * c, 6.0 * d - 3.0 * s + c];
        Self([q0, v0, a0, third, fourth, fifth])
    }

    /// The polynomial with these values at [`Self::PLACES`].
    pub(super) fn through(values: [f64; DEGREE + 1]) -> Self {
        // Newton's divided differences, and then Horner's scheme outwards.
        let mut c = values;
        for order in 1..=DEGREE {
            for k in (order..=DEGREE).rev() {
                c[k] = (c[k] - c[k - 1]) / (Self::PLACES[k] - Self::PLACES[k - order]);
            }
        }
        for order in (0..DEGREE).rev() {
            for k in order..DEGREE {
                c[k] -= Self::PLACES[order] * c[k + 1];
            }
        }
        Self(c)
    }

    /// The extrema of Chebyshev's polynomial of the same degree, on [0, 1].
    pub(super) const PLACES: [f64; DEGREE + 1] = [
        0.0,
        0.095_491_502_812_526_27,
        0.345_491_502_812_526_3,
        0.654_508_497_187_473_7,
        0.904_508_497_187_473_7,
        1.0,
    ];

    /// Where it turns back after `last`, the sign of its slope before: rising to falling or falling
    /// to rising, in order. `last` becomes the sign of its slope at the end.
    pub(super) fn turns_back(&self, last: &mut f64) -> Vec<f64> {
        let slope = self.derivative();
        let sign = |x: f64| {
            let slope = slope.at(x)[0];
            if slope == 0.0 { 0.0 } else { slope.signum() }
        };
        let mut found = Vec::new();
        let mut from = 0.0;
        // Between these places the slope is monotonic.
        for to in slope.turns().into_iter().chain([1.0]) {
            let start = std::mem::replace(&mut from, to);
            let (first, end) = (sign(start), sign(to));
            // At the start of the step, where the slope may jump.
            if *last * first < 0.0 {
                found.push(start);
            }
            if first != 0.0 {
                *last = first;
            }
            if end == 0.0 {
                continue;
            }
            if *last * end < 0.0 {
                found.push(bisect([start, to], |x| sign(x) == end));
            }
            *last = end;
        }
        found
    }

    /// Value and derivative at `x`.
    pub(super) fn at(&self, x: f64) -> [f64; 2] {
        let [start, rest @ ..] = &self.0;
        let (p, dp) = rest.iter().rev().fold((0.0, 0.0), |(p, dp), c| (x * p + c, x * dp + p));
        [start + x * p, p + x * dp]
    }

    /// It less a number.
    pub(super) fn less(&self, value: f64) -> Self {
        let mut less = *self;
        less.0[0] -= value;
        less
    }

    /// Its derivative.
    pub(super) fn derivative(&self) -> Self {
        let mut derivative = [0.0; DEGREE + 1];
        for (k, c) in self.0.iter().enumerate().skip(1) {
            derivative[k - 1] = k as f64 * c;
        }
        Self(derivative)
    }

    fn is_constant(&self) -> bool {
        self.0[1..].iter().all(|c| *c == 0.0)
    }

    /// The turning points in (0, 1), in ascending order; flat points without a turn may be left
    /// out.
    fn turns(&self) -> Vec<f64> {
        let slope = self.derivative();
        if slope.is_constant() {
            return Vec::new();
        }
        let ends = slope.turns().into_iter().chain([1.0]);
        let mut from = 0.0;
        let turns = ends.filter_map(|to| {
            let start = std::mem::replace(&mut from, to);
            let side = slope.at(start)[0].signum();
            let beyond = |x: f64| slope.at(x)[0] * side <= 0.0;
            (!beyond(start) && beyond(to)).then(|| bisect([start, to], beyond))
        });
        turns.filter(|x| *x < 1.0).collect()
    }

    /// The points of the step at which zero is reached, in order of time. A value nearer to zero
    /// than `near` counts as zero.
    pub(super) fn reaches_zero(&self, near: f64) -> Vec<Reached> {
        let mut found = Vec::new();
        // The side of zero, or 0 within `near`.
        let side = |value: f64| if value.abs() > near { value.signum() } else { 0.0 };
        let (mut from, mut on) = (0.0, side(self.at(0.0)[0]));
        for to in self.turns().into_iter().chain([1.0]) {
            let there = side(self.at(to)[0]);
            if on * there <= 0.0 && on != 0.0 {
                let at = bisect([from, to], |x| self.at(x)[0] * on <= 0.0);
                found.push(Reached { at, rising: on < 0.0 });
            }
            (from, on) = (to, there);
        }
        found
    }
}

/// Where `beyond` becomes true between the ends, to the last bits; the later end if it never does.
fn bisect([mut before, mut after]: [f64; 2], beyond: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (before + after);
        if beyond(middle) { after = middle } else { before = middle }
    }
    after
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The polynomial c Π (x − root), made from its values, slopes and half second derivatives at
    /// both ends.
    fn with_roots(scale: f64, roots: &[f64]) -> Polynomial {
        let mut c = [0.0; DEGREE + 1];
        c[0] = scale;
        for root in roots {
            for k in (0..=DEGREE).rev() {
                c[k] = if k > 0 { c[k - 1] } else { 0.0 } - root * c[k];
            }
        }
        let exact = Polynomial(c);
        let slope = exact.derivative();
        let ends = |p: &Polynomial| [p.at(0.0)[0], p.at(1.0)[0]];
        let halves = ends(&slope.derivative()).map(|a| 0.5 * a);
        Polynomial::hermite(ends(&exact), ends(&slope), Some(halves))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        /// Every zero is found, in order, with its direction.
        #[test]
        fn all_zeros_are_found(roots in prop::collection::vec(-0.5..1.5_f64, 1..=5), scale in prop_oneof![-3.0..-0.1, 0.1..3.0_f64]) {
            let mut roots = roots;
            roots.sort_by(f64::total_cmp);
            let apart = roots.windows(2).all(|r| r[1] - r[0] > 0.02);
            let clear = roots.iter().all(|r| r.abs() > 0.01 && (r - 1.0).abs() > 0.01);
            prop_assume!(apart && clear);
            let polynomial = with_roots(scale, &roots);
            let inside: Vec<f64> = roots.iter().copied().filter(|r| (0.0..1.0).contains(r)).collect();
            let found = polynomial.reaches_zero(1e-12);
            prop_assert_eq!(found.len(), inside.len(), "{:?} of {:?}", found, roots);
            for (found, root) in found.iter().zip(inside) {
                prop_assert!((found.at - root).abs() < 1e-6, "{:?} of {:?}", found, roots);
                prop_assert_eq!(found.rising, polynomial.at(found.at)[1] > 0.0);
            }
        }

        /// A polynomial that turns back at the value reaches it once, and so does one that passes
        /// with slope 0.
        #[test]
        fn touches_count_once(root in 0.05..0.95_f64, outside in 1.5..3.0_f64, scale in prop_oneof![-3.0..-0.1, 0.1..3.0_f64]) {
            let touching = with_roots(scale, &[root, root, outside]).reaches_zero(1e-9);
            prop_assert_eq!(touching.len(), 1);
            prop_assert!((touching[0].at - root).abs() < 1e-4);
            // (x − outside) is negative.
            prop_assert_eq!(touching[0].rising, scale > 0.0);
            let flat = with_roots(scale, &[root, root, root]).reaches_zero(1e-9);
            prop_assert_eq!(flat.len(), 1);
            prop_assert_eq!(flat[0].rising, scale > 0.0);
        }
    }

    #[test]
    fn a_polynomial_goes_through_its_values() {
        let exact = with_roots(0.7, &[-0.3, 0.2, 0.4, 0.9, 1.4]);
        let found = Polynomial::through(Polynomial::PLACES.map(|x| exact.at(x)[0]));
        for (a, b) in found.0.iter().zip(exact.0) {
            assert!((a - b).abs() < 1e-12, "{found:?}, {exact:?}");
        }
    }

    /// (x − 0.3)² falls and then rises; what has turned at the border between two steps is found in the
    /// second one.
    #[test]
    fn turning_back_is_remembered() {
        let parabola = with_roots(1.0, &[0.3, 0.3]);
        let mut last = 0.0;
        let turns = parabola.turns_back(&mut last);
        assert!(turns.len() == 1 && (turns[0] - 0.3).abs() < 1e-9 && last == 1.0, "{turns:?}");
        let falling = Polynomial([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((falling.turns_back(&mut last), last), (vec![0.0], -1.0));
        // After a slope that jumps from falling to rising, x − 2x² turns twice.
        let kinked = Polynomial([0.0, 1.0, -2.0, 0.0, 0.0, 0.0]);
        let turns = kinked.turns_back(&mut last);
        assert!(turns.len() == 2 && turns[0] == 0.0 && (turns[1] - 0.25).abs() < 1e-9, "{turns:?}");
        assert_eq!(last, -1.0);
        let flat = Polynomial([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((flat.turns_back(&mut last), last), (vec![], -1.0));
        // A flat place without a turn.
        let cubic = with_roots(1.0, &[0.5, 0.5, 0.5]);
        let mut last = 0.0;
        assert_eq!((cubic.turns_back(&mut last), last), (vec![], 1.0));
    }

    #[test]
    fn what_is_at_the_value_must_leave_it_first() {
        let cubic = |q, v| Polynomial::hermite(q, v, None);
        assert_eq!(cubic([0.0, 1.0], [1.0, 1.0]).reaches_zero(1e-9), []);
        assert_eq!(cubic([1e-12, -1.0], [0.0, -1.0]).reaches_zero(1e-9), []);
        let end = cubic([-1.0, -1e-12], [1.0, 1.0]).reaches_zero(1e-9);
        assert_eq!(end, [Reached { at: 1.0, rising: true }]);
        assert_eq!(cubic([0.0, 0.0], [0.0, 0.0]).reaches_zero(1e-9), []);
        // It leaves the value and comes back within the step.
        let back = cubic([0.0, 0.0], [1.0, -1.0]).reaches_zero(1e-9);
        assert_eq!(back, [Reached { at: 1.0, rising: false }]);
    }
}
