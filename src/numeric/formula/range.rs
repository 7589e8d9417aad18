//! Bounds of a formula where its variables lie in intervals, by interval arithmetic (R. E. Moore, R. B. Kearfott,
//! M. J. Cloud, *Introduction to Interval Analysis*, SIAM 2009, chapters 2 and 5).
//!
//! They hold but for round-off, which is enough to say where a formula may do something that its values at a few places do not
//! show. Where a variable occurs more than once they may be wider than the range itself; with the length of an interval the excess
//! vanishes.

use super::{Formula, Step};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What is known of a number that nothing bounds.
const ANYTHING: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// How a function runs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Course {
    /// It rises between these ends of its domain.
    Rising(f64, f64),
    /// It falls between these.
    Falling(f64, f64),
    /// It falls until 0 and rises from there.
    Valley,
    /// It goes from −1 to 1 and back in 2π, and is 1 here.
    Wave(f64),
    /// It rises between poles at π/2 + kπ.
    Tangent,
}

impl Formula {
    /// Smallest and largest value, or less and more, where each variable lies between its two `limits`; of the formula itself, not
    /// of a derivative.
    pub fn range(&self, limits: &[[f64; 2]]) -> [f64; 2] {
        let mut stack: Vec<[f64; 2]> = Vec::with_capacity(self.room);
        for step in &*self.steps {
            let range = match *step {
                Step::Number(value) => [value; 2],
                Step::Variable(variable) => limits[variable],
                Step::Call(function) => {
                    function.course.range(|x| (function.at)(x)[0], stack.pop().unwrap_or(ANYTHING))
                }
                Step::Operator(operator) => {
                    let [b, a] = [stack.pop(), stack.pop()].map(|range| range.unwrap_or(ANYTHING));
                    match operator {
                        '+' => [a[0] + b[0], a[1] + b[1]],
                        '-' => [a[0] - b[1], a[1] - b[0]],
                        '*' => product(a, b),
                        '/' => quotient(a, b),
                        _ => power(a, b),
                    }
                }
            };
            stack.push(if range[0] <= range[1] { range } else { ANYTHING });
        }
        stack.first().copied().unwrap_or(ANYTHING)
    }
}

impl Course {
    fn range(self, f: impl Fn(f64) -> f64, [a, b]: [f64; 2]) -> [f64; 2] {
        match self {
            // Where it has no value there is none to bound.
            Self::Rising(from, to) => [f(a.clamp(from, to)), f(b.clamp(from, to))],
            Self::Falling(from, to) => [f(b.clamp(from, to)), f(a.clamp(from, to))],
            Self::Valley => {
                let [left, right] = [f(a), f(b)];
                [if a <= 0.0 && b >= 0.0 { f(0.0) } else { left.min(right) }, left.max(right)]
            }
            Self::Wave(_) if !(a.is_finite() && b.is_finite()) => [-1.0, 1.0],
            Self::Wave(top) => {
                let passes = |place: f64| ((a - place) / TAU).ceil() <= ((b - place) / TAU).floor();
                let [left, right] = [f(a), f(b)];
                let low = if passes(top + PI) { -1.0 } else { left.min(right) };
                [low, if passes(top) { 1.0 } else { left.max(right) }]
            }
            Self::Tangent if ((a - FRAC_PI_2) / PI).ceil() <= ((b - FRAC_PI_2) / PI).floor() => ANYTHING,
            Self::Tangent => [f(a), f(b)],
        }
    }
}

fn around(values: [f64; 4]) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        // Zero times what is not bounded is zero.
        let value = if value.is_nan() { 0.0 } else { value };
        [low.min(value), high.max(value)]
    })
}

fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    around([a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]])
}

fn quotient(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    if b[0] <= 0.0 && b[1] >= 0.0 { ANYTHING } else { product(a, [b[1].recip(), b[0].recip()]) }
}

fn power(a: [f64; 2], n: [f64; 2]) -> [f64; 2] {
    let whole = n[0] == n[1] && n[0].fract() == 0.0;
    match n[0] {
        _ if !whole => {
            // x^n = exp(n ln x), of no negative number.
            let logarithm = a.map(|x| x.max(0.0).ln());
            product(n, logarithm).map(f64::exp)
        }
        exponent if exponent < 0.0 => quotient([1.0; 2], power(a, [-exponent; 2])),
        exponent => {
            let [left, right] = a.map(|x| x.powf(exponent));
            let even = exponent % 2.0 == 0.0;
            let low = if even && a[0] <= 0.0 && a[1] >= 0.0 { 0.0 } else { left.min(right) };
            [if exponent == 0.0 { 1.0 } else { low }, left.max(right)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a bound that a value passes, and one that does not close in on the values as the interval gets shorter.
    #[test]
    fn no_value_is_beyond_the_bounds_and_they_close_in() {
        for text in [
            "sin(2*pi*t)*(1-exp(-t/0.5))",
            "exp(-((t-1)/0.1)^2)",
            "t^3 - 2*t^2 + 1/(1+t^2)",
            "(t-1.5)^(0-3) * (t-1.5)^4",
            "cos(3*t)^2 - tan(t/9)",
            "sqrt(t) + ln(t+1)/log2(t+2) - log10(t+1)",
            "sinh(t-1) - cosh(t-1)*tanh(t-1)",
            "asin(t/9) + acos(t/9)*atan(t-1)",
            "asinh(t-1) + acosh(t+2) + atanh(t/9)",
            "t^t + (t+1)^(0-0.5) + 2^(t-1)",
            "(0-t)^0 + (t-1)^2",
        ] {
            let formula = Formula::new(text, &["t"]).unwrap_or_else(|error| panic!("{text}: {error}"));
            for (from, length) in [(0.0, 3.0), (0.9, 0.3), (1.4, 0.2), (0.55, 1e-2), (2.0, 1e-6)] {
                let [low, high] = formula.range(&[[from, from + length]]);
                let values: Vec<f64> =
                    (0..=500).map(|k| formula.at(&[length.mul_add(f64::from(k) / 500.0, from)])).collect();
                let [least, most] = values
                    .iter()
                    .filter(|value| value.is_finite())
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
                        [least.min(*value), most.max(*value)]
                    });
                let round_off = 1e-12 * (1.0 + least.abs().max(most.abs()));
                assert!(
                    low <= least + round_off && most <= high + round_off,
                    "{text} from {from}: {low}, {high}"
                );
                if length == 1e-6 {
                    assert!(high - low <= 20.0 * (most - least) + 1e-5, "{text}: {low}, {high}");
                }
            }
        }
    }

    #[test]
    fn ranges_of_what_occurs_once_are_exact() {
        let of = |text: &str, from: f64, to: f64| {
            Formula::new(text, &["t"]).map(|formula| formula.range(&[[from, to]])).unwrap_or_default()
        };
        assert_eq!(of("t^2", -1.0, 2.0), [0.0, 4.0]);
        assert_eq!(of("(t-50)^(0-2)", 49.0, 52.0), ANYTHING);
        assert_eq!(of("(t-50)^(0-2)", 51.0, 52.0), [0.25, 1.0]);
        assert_eq!(of("sin(t)", 1.0, 2.0), [1.0_f64.sin(), 1.0]);
        assert_eq!(of("cos(t)", 1.0, 4.0), [-1.0, 1.0_f64.cos()]);
        assert_eq!(of("sin(1e9*t)", 1.0, 2.0), [-1.0, 1.0]);
        assert_eq!(of("cosh(t)", -1.0, 0.5), [1.0, 1.0_f64.cosh()]);
        assert_eq!(of("tan(t)", 1.0, 2.0), ANYTHING);
        assert_eq!(of("exp(-((t-50.1234)/1e-9)^2)", 0.0, 100.0), [0.0, 1.0]);
        assert_eq!(of("exp(-((t-50.1234)/1e-9)^2)", 0.0, 50.0), [0.0, 0.0]);
    }
}
