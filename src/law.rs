//! Laws of time: the factor of a load, or the motion of a support, as a function of time.

mod changes;

use crate::numeric::{End, Formula, GAUSS_6, rates};
use std::f64::consts::PI;

/// A number as a function of time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Law {
    /// 0 until `start`, then growing linearly to 1 within `duration`.
    Ramp {
        /// Time at which the value begins to grow \[s\].
        start: f64,
        /// Time that it takes to reach 1 \[s\].
        duration: f64,
    },
    /// A ramp with continuous acceleration: 10 x³ − 15 x⁴ + 6 x⁵, where x is the elapsed fraction
    /// of the duration.
    SmoothRamp {
        /// Time at which the value begins to grow \[s\].
        start: f64,
        /// Time that it takes to reach 1 \[s\].
        duration: f64,
    },
    /// 0 until `start`, then 1.
    Step {
        /// Time of the step \[s\].
        start: f64,
    },
    /// sin(ω t + φ).
    Harmonic {
        /// ω \[rad/s\].
        frequency: f64,
        /// φ \[rad\].
        phase: f64,
    },
    /// Σ c_k t^k, t in seconds.
    Polynomial(Vec<f64>),
    /// Interpolates given points; constant before the first and after the last.
    Table(Tabulated),
    /// The angle of a hub that reaches the speed Ω within the time T (Simo & Vu-Quoc, *J. Appl.
    /// Mech.* 53, 1986, 855–863): Ω/T (t²/2 + (T/2π)² (cos(2πt/T) − 1)) until T, then Ω (t − T/2), with t
    /// from when it begins.
    SpinUp {
        /// When it begins \[s\].
        start: f64,
        /// Ω \[rad/s\].
        speed: f64,
        /// T \[s\].
        duration: f64,
    },
    /// The sum of laws.
    Sum(Vec<Law>),
    /// The product of laws.
    Product(Vec<Law>),
    /// An expression in t.
    Expression(Box<Expression>),
}

/// An expression in the time t \[s\], with its first two derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    terms: [Formula; 3],
    /// Times at which it is not smooth, rising \[s\].
    kinks: Vec<f64>,
}

impl Expression {
    /// Reads `text`, a formula of t; `kinks` are the times at which it is not smooth \[s\].
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn new(text: &str, mut kinks: Vec<f64>) -> Result<Self, String> {
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        let value = Formula::new(text, &["t"])?;
        let first = value.derivative(0)?;
        let second = first.derivative(0)?;
        Ok(Self { terms: [value, first, second], kinks })
    }

    fn value(&self, t: f64) -> f64 {
        if self.kinks.is_empty() { self.terms[0].at(&[t]) } else { self.at(t)[0] }
    }

    /// The value and its first two derivatives at `t`. At a kink a formula may have none, so that
    /// within [`BESIDE`] of one they follow from those at that distance, on the side of `t`.
    fn at(&self, t: f64) -> [f64; 3] {
        let near = |kink: &&f64| (t - **kink).abs() < BESIDE * kink.abs().max(EARLIEST);
        let Some(kink) = self.kinks.iter().find(near) else {
            return self.terms.each_ref().map(|term| term.at(&[t]));
        };
        let far = (BESIDE * kink.abs().max(EARLIEST)).copysign(t - kink);
        let [value, rate, second] = self.terms.each_ref().map(|term| term.at(&[kink + far]));
        let back = t - (kink + far);
        [back.mul_add(0.5 * second * back + rate, value), back.mul_add(second, rate), second]
    }
}

/// The points of a law, and how it is interpolated between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    times: Vec<f64>,
    values: Vec<f64>,
    /// First derivatives of a cubic spline at the points; `None` for linear interpolation.
    rates: Option<Vec<[f64; 1]>>,
}

impl Tabulated {
    /// Interpolates `values` at increasing `times` \[s\], linearly or by the natural cubic spline.
    /// `None` where there are fewer than two points, the numbers of times and values differ, or the
    /// times do not increase.
    pub fn new(times: Vec<f64>, values: Vec<f64>, smooth: bool) -> Option<Self> {
        let rising = times.windows(2).all(|t| t[1] > t[0]);
        if times.len() < 2 || times.len() != values.len() || !rising {
            return None;
        }
        let table = Self { times, values, rates: None };
        Some(if smooth { table.smoothed([End::Straight; 2]) } else { table })
    }

    /// Interpolates by the cubic spline whose first derivative is zero at the ends marked in
    /// `flat`, and whose second derivative is zero at the others.
    pub fn with_flat_ends(times: Vec<f64>, values: Vec<f64>, flat: [bool; 2]) -> Option<Self> {
        let ends = flat.map(|flat| if flat { End::Flat } else { End::Straight });
        Some(Self::new(times, values, false)?.smoothed(ends))
    }

    /// Where its points are \[s\], or \[m\] along a beam.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    fn smoothed(self, ends: [End; 2]) -> Self {
        let h: Vec<f64> = self.times.windows(2).map(|t| t[1] - t[0]).collect();
        let slope: Vec<[f64; 1]> =
            self.values.windows(2).zip(&h).map(|(values, h)| [(values[1] - values[0]) / h]).collect();
        Self { rates: Some(rates(&h, &slope, ends)), ..self }
    }

    fn at(&self, t: f64) -> [f64; 3] {
        let last = self.times.len() - 1;
        if t < self.times[0] {
            return [self.values[0], 0.0, 0.0];
        }
        if t >= self.times[last] {
            return [self.values[last], 0.0, 0.0];
        }
        self.between(t)
    }

    /// As `at`, except that the first and the last piece are continued beyond the points.
    pub(super) fn between(&self, t: f64) -> [f64; 3] {
        let i = self.times.partition_point(|&time| time <= t).clamp(1, self.times.len() - 1) - 1;
        let h = self.times[i + 1] - self.times[i];
        let (x, rise) = ((t - self.times[i]) / h, self.values[i + 1] - self.values[i]);
        let (value, rate) = (self.values[i] + x * rise, rise / h);
        let Some(rates) = &self.rates else { return [value, rate, 0.0] };
        // Difference between the spline's slope and that of the chord, at both ends of the piece.
        let (a, b, y) = (rates[i][0] - rate, rates[i + 1][0] - rate, 1.0 - x);
        [
            value + h * x * y * (a * y - b * x),
            rate + a * y * (1.0 - 3.0 * x) + b * x * (1.0 - 3.0 * y),
            (a * (6.0 * x - 4.0) + b * (6.0 * x - 2.0)) / h,
        ]
    }
}

/// Largest phase angle \[rad\] of a harmonic within a step for which Gauss' rule integrates it to
/// round-off.
const SLOW: f64 = 1.5;
/// Change of the moments of an expression by twice as many parts that counts as none, in its largest value.
const SETTLED: f64 = 1e-11;
/// Change of the moments that counts as none whatever the value: smaller numbers have fewer digits than others, so that the tail of a
/// pulse would never settle.
pub const VANISHED: f64 = f64::MIN_POSITIVE / f64::EPSILON;
/// Change of a value at a kink that counts as a jump, in the largest of the value v, v' t and v'' t².
const JUMP: f64 = 1e-12;
/// Most parts in which a product of fast laws is integrated.
const MOST_PARTS: f64 = 1e6;
/// Distance from a kink at which derivatives of an expression are taken, relative to its time.
const BESIDE: f64 = 1e-9;
/// Time \[s\] of the earliest kinks whose distance is relative to it.
const EARLIEST: f64 = 1e-6;
/// Smooth changes that take less than so many steps are divided …
const SHORT_CHANGE: f64 = 4.0;
/// … into so many.
const PARTS_OF_CHANGE: u32 = 8;

/// `times`, rising, each once.
fn merged(times: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Those of `times`, rising, that have another one no farther than `near`; all where that is infinite.
fn with_neighbours(times: &[f64], near: f64) -> Vec<f64> {
    let after = |i: usize| times.get(i + 1).map_or(f64::INFINITY, |next| next - times[i]);
    let before = |i: usize| i.checked_sub(1).map_or(f64::INFINITY, after);
    (0..times.len()).filter(|&i| before(i).min(after(i)) <= near).map(|i| times[i]).collect()
}

/// ∫₀¹ f dx and ∫₀¹ (1 − x) f dx; exact for polynomials up to degree 10.
fn quadrature(time: impl Fn(f64) -> f64, mut f: impl FnMut(f64) -> f64) -> [f64; 2] {
    GAUSS_6.iter().fold([0.0; 2], |[mean, moment], (x, weight)| {
        let term = weight * f(time(*x));
        [mean + term, moment + (1.0 - x) * term]
    })
}

impl Law {
    /// Value, rate \[1/s\] and second rate \[1/s²\] at time `t`; at a kink, those just after it.
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Ramp { start, .. } | Self::SmoothRamp { start, .. } if t < *start => [0.0; 3],
            Self::Ramp { start, duration } if t < start + duration => {
                [(t - start) / duration, 1.0 / duration, 0.0]
            }
            Self::SmoothRamp { start, duration } if t < start + duration => {
                let x = (t - start) / duration;
                [
                    x * x * x * (10.0 + x * (6.0 * x - 15.0)),
                    30.0 * (x * (1.0 - x)).powi(2) / duration,
                    60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (duration * duration),
                ]
            }
            Self::Ramp { .. } | Self::SmoothRamp { .. } => [1.0, 0.0, 0.0],
            Self::Step { start } => [f64::from(t >= *start), 0.0, 0.0],
            Self::Harmonic { frequency: w, phase } => {
                let (sine, cosine) = (w * t + phase).sin_cos();
                [sine, w * cosine, -w * w * sine]
            }
            Self::Polynomial(coefficients) => {
                let step =
                    |[v, d, s]: [f64; 3], c: &f64| [v.mul_add(t, *c), d.mul_add(t, v), s.mul_add(t, 2.0 * d)];
                coefficients.iter().rev().fold([0.0; 3], step)
            }
            Self::Table(table) => table.at(t),
            Self::SpinUp { start, .. } if t < *start => [0.0; 3],
            Self::SpinUp { start, speed, duration } if t - start < *duration => {
                let (t, w) = (t - start, 2.0 * PI / duration);
                let (sine, cosine) = (w * t).sin_cos();
                let slope = speed / duration;
                [
                    slope * (0.5 * t * t + (cosine - 1.0) / (w * w)),
                    slope * (t - sine / w),
                    slope * (1.0 - cosine),
                ]
            }
            Self::SpinUp { start, speed, duration } => [speed * (t - start - 0.5 * duration), *speed, 0.0],
            Self::Expression(expression) => expression.at(t),
            Self::Sum(laws) => laws.iter().fold([0.0; 3], |[v, d, s], law| {
                let [value, rate, second] = law.at(t);
                [v + value, d + rate, s + second]
            }),
            Self::Product(laws) => laws.iter().fold([1.0, 0.0, 0.0], |[v, d, s], law| {
                let [value, rate, second] = law.at(t);
                [v * value, d * value + v * rate, s * value + 2.0 * d * rate + v * second]
            }),
        }
    }

    /// The times at which the value itself jumps, and the heights of the jumps.
    pub fn jumps(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Step { start } => vec![(*start, 1.0)],
            Self::Expression(expression) => self.jumps_at(&expression.kinks),
            Self::Sum(laws) | Self::Product(laws) => {
                self.jumps_at(&merged(laws.iter().flat_map(Self::jumps).map(|(time, _)| time)))
            }
            Self::Ramp { .. }
            | Self::SmoothRamp { .. }
            | Self::Harmonic { .. }
            | Self::Polynomial(_)
            | Self::Table(_)
            | Self::SpinUp { .. } => Vec::new(),
        }
    }

    /// Those of `times` at which the value jumps, and the heights of the jumps.
    fn jumps_at(&self, times: &[f64]) -> Vec<(f64, f64)> {
        let jump = |time: &f64| {
            let sides = [time.next_down(), *time].map(|time| self.at(time));
            let terms = |[value, rate, second]: &[f64; 3]| [*value, rate * time, second * time * time];
            let size = sides.iter().flat_map(terms).fold(0.0_f64, |size, term| size.max(term.abs()));
            let height = sides[1][0] - sides[0][0];
            (height.abs() > JUMP * size).then_some((*time, height))
        };
        times.iter().filter_map(jump).collect()
    }

    /// Whether an expression is part of it.
    fn has_expression(&self) -> bool {
        match self {
            Self::Expression(_) => true,
            Self::Sum(laws) | Self::Product(laws) => laws.iter().any(Self::has_expression),
            _ => false,
        }
    }

    /// Times between `start` and `end`, rising, that divide the changes of an expression evenly: those
    /// that are no farther than `near` from another one of the same expression. Other laws have none:
    /// their kinks say enough.
    pub fn turns(&self, span: [f64; 2], near: f64) -> Vec<f64> {
        match self {
            Self::Expression(expression) => with_neighbours(&expression.turns(span), near),
            Self::Sum(laws) | Self::Product(laws) => {
                merged(laws.iter().flat_map(|law| law.turns(span, near)))
            }
            _ => Vec::new(),
        }
    }

    /// An upper bound of the rate of its phase \[rad/s\]: the frequencies of the factors of a product
    /// add up.
    pub fn fastest(&self) -> f64 {
        match self {
            Self::Harmonic { frequency, .. } => frequency.abs(),
            Self::Sum(laws) => laws.iter().map(Self::fastest).fold(0.0, f64::max),
            Self::Product(laws) => laws.iter().map(Self::fastest).sum(),
            _ => 0.0,
        }
    }

    /// Mean and first moment of the value f over the time from `start` to `end`, between which
    /// there is no kink:
    ///
    /// ```text
    /// ∫₀¹ f(t₀ + x h) dx,   ∫₀¹ (1 − x) f(t₀ + x h) dx,   t₀ the start, h the time between
    /// ```
    ///
    /// The sums are accurate however fast a harmonic oscillates. If the law is the acceleration of
    /// a mass, the mass changes its velocity by h times the first, and its position by h² times the
    /// second, in addition to the way that its initial velocity carries it.
    pub fn moments(&self, start: f64, end: f64) -> [f64; 2] {
        let h = end - start;
        match self {
            Self::Harmonic { frequency, phase } if (frequency * h).abs() > SLOW => {
                let (from, turn) = (frequency * start + phase, frequency * h);
                let ((s0, c0), (s1, c1)) = (from.sin_cos(), (from + turn).sin_cos());
                [(c0 - c1) / turn, (c0 - (s1 - s0) / turn) / turn]
            }
            Self::Polynomial(coefficients) => {
                // Σ d_k τ^k with τ = t − t₀ has the moments Σ d_k h^k/(k + 1) and
                // Σ d_k h^k/((k + 1) (k + 2)).
                let mut shifted = coefficients.clone();
                for first in 0..shifted.len() {
                    for k in (first..shifted.len() - 1).rev() {
                        shifted[k] = shifted[k + 1].mul_add(start, shifted[k]);
                    }
                }
                let mut power = 1.0;
                shifted.iter().zip(1..).fold([0.0; 2], |[mean, moment], (d, k)| {
                    let term = d * power / f64::from(k);
                    power *= h;
                    [mean + term, moment + term / f64::from(k + 1)]
                })
            }
            Self::Sum(laws) => laws.iter().fold([0.0; 2], |[mean, moment], law| {
                let [a, b] = law.moments(start, end);
                [mean + a, moment + b]
            }),
            Self::Product(_) => {
                // In parts in which no harmonic is fast.
                if self.has_expression() {
                    return self.in_parts(start, h).0;
                }
                let parts = (self.fastest() * h.abs() / SLOW).ceil().clamp(1.0, MOST_PARTS);
                self.in_equal_parts(start, h, parts as usize).0
            }
            Self::Expression(_) => self.in_parts(start, h).0,
            _ => quadrature(|x| h.mul_add(x, start), |t| self.at(t)[0]),
        }
    }

    /// [`Self::moments`] of a law of which nobody knows how fast it is: in parts, twice as many until
    /// that changes nothing but round-off; and how many parts those are.
    fn in_parts(&self, start: f64, h: f64) -> ([f64; 2], usize) {
        let (mut before, _) = self.in_equal_parts(start, h, 1);
        let mut round_off = None;
        let mut parts = 2;
        loop {
            let (sums, largest) = self.in_equal_parts(start, h, parts);
            let change = (sums[0] - before[0]).abs().max((sums[1] - before[1]).abs());
            // A law that is not a number anywhere is none in its sums either.
            if change.is_nan() || change <= VANISHED.max(SETTLED * largest) || parts as f64 >= MOST_PARTS {
                return (sums, parts);
            }
            // A difference of nearly equal numbers, as 1 - cos(t) is at first, never settles so far.
            let times = || GAUSS_6.iter().map(|(x, _)| h.mul_add(*x, start));
            let noise =
                round_off.get_or_insert_with(|| times().map(|t| self.round_off(t)).fold(0.0, f64::max));
            if noise.is_finite() && change <= *noise {
                return (sums, parts);
            }
            (before, parts) = (sums, 2 * parts);
        }
    }

    /// An upper bound of the round-off of its value, to first order.
    fn round_off(&self, t: f64) -> f64 {
        match self {
            Self::Expression(expression) => expression.terms[0].round_off(&[t]),
            Self::Sum(laws) => laws.iter().map(|law| law.round_off(t)).sum(),
            Self::Product(laws) => {
                let [product, error] = laws.iter().fold([1.0_f64, 0.0_f64], |[product, error], law| {
                    let [value, ..] = law.at(t);
                    [product * value, product.abs().mul_add(law.round_off(t), error * value.abs())]
                });
                f64::EPSILON.mul_add(product.abs(), error)
            }
            _ => {
                let [value, rate, _] = self.at(t);
                f64::EPSILON * (value.abs() + (rate * t).abs())
            }
        }
    }

    /// The moments, and the largest value that was seen.
    fn in_equal_parts(&self, start: f64, h: f64, parts: usize) -> ([f64; 2], f64) {
        let share = 1.0 / parts as f64;
        let mut largest = 0.0_f64;
        let mut value = |t: f64| {
            let [value, ..] = self.at(t);
            largest = largest.max(value.abs());
            value
        };
        let sums = (0..parts).fold([0.0; 2], |[mean, moment], part| {
            let from = part as f64 * share;
            let [a, b] = quadrature(|x| h.mul_add(share.mul_add(x, from), start), &mut value);
            // ∫ (1 − x) f over the part, with 1 − x = (1 − from − share) + share (1 − ξ).
            [mean + share * a, moment + share * ((1.0 - from - share) * a + share * b)]
        });
        (sums, largest)
    }

    /// Times at which steps of this length should also end: those that divide a smooth change which is over within few of them, of
    /// which a step from its beginning to its end sees no velocity and no acceleration.
    pub fn short_changes(&self, step: f64) -> Vec<f64> {
        match self {
            Self::SmoothRamp { start, duration } | Self::SpinUp { start, duration, .. }
                if *duration < SHORT_CHANGE * step =>
            {
                let part = duration / f64::from(PARTS_OF_CHANGE);
                (1..PARTS_OF_CHANGE).map(|k| part.mul_add(f64::from(k), *start)).collect()
            }
            Self::Sum(laws) | Self::Product(laws) => {
                laws.iter().flat_map(|law| law.short_changes(step)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Times at which the value or a low derivative of it jumps: steps of an integrator should end
    /// there.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Ramp { start, duration }
            | Self::SmoothRamp { start, duration }
            | Self::SpinUp { start, duration, .. } => vec![*start, start + duration],
            Self::Step { start } => vec![*start],
            Self::Harmonic { .. } | Self::Polynomial(_) => Vec::new(),
            Self::Table(table) => table.times.clone(),
            Self::Expression(expression) => expression.kinks.clone(),
            Self::Sum(laws) | Self::Product(laws) => merged(laws.iter().flat_map(Self::kinks)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<Law> {
        let table = |smooth| {
            Law::Table(Tabulated::new(vec![0.1, 0.5, 0.7, 2.0], vec![0.0, 1.0, -1.0, 0.5], smooth).unwrap())
        };
        vec![
            Law::Ramp { start: 0.3, duration: 1.2 },
            Law::SmoothRamp { start: 0.3, duration: 1.2 },
            Law::Step { start: 0.4 },
            Law::Harmonic { frequency: 3.0, phase: 0.3 },
            Law::Polynomial(vec![1.0, -2.0, 0.5, 3.0]),
            table(false),
            table(true),
            Law::SpinUp { start: 0.2, speed: 6.0, duration: 1.5 },
            Law::Sum(vec![Law::Step { start: 0.4 }, Law::Polynomial(vec![0.5, -1.0]), table(true)]),
            Law::Product(vec![
                Law::Step { start: 0.4 },
                Law::Ramp { start: 0.3, duration: 1.2 },
                Law::Harmonic { frequency: 3.0, phase: 0.3 },
            ]),
            written("sqrt((t-0.4)^2)*sin(3*t)", vec![0.4]),
        ]
    }

    fn written(text: &str, kinks: Vec<f64>) -> Law {
        Law::Expression(Box::new(Expression::new(text, kinks).expect("an expression")))
    }

    /// In whatever unit: what differs from one side of a kink to the other by the round-off of the time is no jump.
    #[test]
    fn a_kink_is_no_jump_in_any_unit() {
        for unit in ["1e-9", "1", "1e9"] {
            let smooth = ["t", "(t-0.3)", "sqrt((t-0.3)^2)", "(sin(3*t)+sqrt((t-0.3)^2)-0.3)"];
            for of in smooth {
                assert_eq!(written(&format!("{unit}*{of}"), vec![0.3]).jumps(), [], "{unit} {of}");
            }
            // Far from t = 0 that round-off is larger.
            assert_eq!(written(&format!("{unit}*sqrt((t-1e9)^2)"), vec![1e9]).jumps(), [], "{unit}");
            let height = PI * unit.parse::<f64>().expect("a number");
            let jumps = written(&format!("{unit}*atan(1/(t-0.3))"), vec![0.3]).jumps();
            assert!(
                matches!(jumps[..], [(0.3, up)] if (up / height - 1.0).abs() < 1e-12),
                "{unit}: {jumps:?}"
            );
        }
    }

    /// What the last digit of a time changes is no more than what a law says that its value may be off by, and not much less where that is all there is.
    #[test]
    fn the_last_digit_of_a_time_is_within_the_round_off() {
        for law in laws().into_iter().chain([Law::Polynomial(vec![-100.3, 1.0])]) {
            for time in [0.35, 0.9, 3.37, 100.3] {
                let [now, next] = [time, f64::next_up(time)].map(|time| law.at(time)[0]);
                assert!((next - now).abs() <= 4.0 * law.round_off(time), "{law:?} at {time}");
            }
        }
        let late = Law::Polynomial(vec![-100.3, 1.0]).round_off(100.3);
        assert!((late / (100.3 * f64::EPSILON) - 1.0).abs() < 1e-9, "{late}");
    }

    /// ∫₀¹ 10 exp(−(50 (t − ½))²) dt = √π/5, in whatever unit.
    #[test]
    fn fast_laws_are_integrated_in_any_unit() {
        for unit in [1e-15, 1.0, 1e15] {
            let law = written(&format!("{unit:e}*10*exp(-(50*(t-0.5))^2)"), vec![]);
            let [mean, _] = law.moments(0.0, 1.0);
            assert!((mean / (unit * PI.sqrt() / 5.0) - 1.0).abs() < 1e-9, "{unit}: {mean}");
        }
    }

    #[test]
    fn an_expression_turns_where_its_value_changes() {
        let pulse = written("exp(-((t-3.37)/1e-3)^2)", vec![]);
        let turns = pulse.turns([0.0, 10.0], f64::INFINITY);
        let near = turns.iter().filter(|t| (**t - 3.37).abs() < 1e-2).count();
        assert!(near >= 32 && turns.len() < near + 16, "{turns:?}");
        let even = written("3 - 2*t", vec![]).turns([1.0, 2.0], f64::INFINITY);
        let expected = (1..=64).map(|k| 1.0 + f64::from(k) / 64.0);
        assert!(even.len() == 64 && even.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{even:?}");
        for constant in ["2", "1e-320*t", "ln(-t)"] {
            assert_eq!(written(constant, vec![]).turns([0.0, 1.0], f64::INFINITY), [0.0; 0]);
        }
        let both = Law::Sum(vec![pulse, Law::Step { start: 1.0 }, written("t", vec![])]);
        assert_eq!(both.turns([0.0, 10.0], f64::INFINITY).len(), turns.len() + 64);
        // Steps of 0.1 s end at the pulse alone, wherever the turns of the other law lie.
        let sharp = both.turns([0.0, 10.0], 0.1);
        assert!(sharp.len() >= near && sharp.iter().all(|t| (t - 3.37).abs() < 0.3), "{sharp:?}");
    }

    #[test]
    fn rates_are_derivatives() {
        let h = 1e-4;
        for law in laws() {
            for t in [0.05, 0.32, 0.61, 0.93, 1.44, 1.7, 2.3] {
                let ([a, ra, _], [b, rb, _], [v, rate, second]) = (law.at(t - h), law.at(t + h), law.at(t));
                assert!(((b - a) / (2.0 * h) - rate).abs() < 1e-6, "{law:?} at {t}");
                assert!(((rb - ra) / (2.0 * h) - second).abs() < 1e-5, "{law:?} at {t}");
                assert!(v.is_finite());
            }
        }
    }

    /// Half of Ω T at its end, and nothing before it begins.
    #[test]
    fn a_hub_spins_up_from_when_it_begins() {
        let law = Law::SpinUp { start: 0.5, speed: 6.0, duration: 1.5 };
        assert_eq!(law.at(0.49), [0.0; 3]);
        assert!((law.at(2.0)[0] - 4.5).abs() < 1e-12 && (law.at(3.0)[0] - 10.5).abs() < 1e-12);
        let from_zero = Law::SpinUp { start: 0.0, speed: 6.0, duration: 1.5 };
        assert_eq!(law.at(1.5), from_zero.at(1.0));
    }

    #[test]
    fn nothing_jumps_but_at_kinks() {
        for law in laws() {
            let kinks = law.kinks();
            for i in 0..2500 {
                let t = 1e-3 * (f64::from(i) + 0.5);
                if kinks.iter().all(|kink| (kink - t).abs() > 1e-3) {
                    let ([a, ra, sa], [b, rb, sb]) = (law.at(t - 1e-9), law.at(t + 1e-9));
                    let jumps = (b - a).abs() + (rb - ra).abs() + (sb - sa).abs();
                    assert!(jumps < 1e-5, "{law:?} jumps by {jumps} at {t}");
                }
            }
        }
    }

    /// A difference of nearly equal numbers, and a harmonic long after its start, which round-off keeps from settling.
    #[test]
    fn round_off_is_not_integrated_any_finer() {
        for (text, start, h) in
            [("1 - cos(t)", 1e-7, 1e-6), ("sin(1e6*t)", 20.0, 1e-6), ("t - t^3", 1.0, 1e-12)]
        {
            let law = written(text, Vec::new());
            let (sums, parts) = law.in_parts(start, h);
            assert!(parts <= 8, "{text}: {parts} parts");
            let (finer, _) = law.in_equal_parts(start, h, 64);
            let error = (sums[0] - finer[0]).abs().max((sums[1] - finer[1]).abs());
            assert!(error <= law.round_off(start + h), "{text}: {error:.1e}");
        }
        // What is not round-off is integrated as finely as ever.
        let law = written("cos(1e3*t)", Vec::new());
        let [mean, _] = law.in_parts(0.0, 1.0).0;
        assert!((mean - 1e-3 * 1e3_f64.sin()).abs() < 1e-12);
    }

    /// Far from its middle a pulse is so small that its values have hardly a digit left.
    #[test]
    fn the_tail_of_a_pulse_is_not_integrated_any_finer() {
        let law = written("10*exp(-((t-0.2)/0.003)^2)", Vec::new());
        for i in 0..100 {
            let (_, parts) = law.in_parts(0.2 + 2e-3 * f64::from(i), 2e-3);
            assert!(parts <= 1 << 10, "{parts} parts from {} s", 0.2 + 2e-3 * f64::from(i));
        }
    }

    #[test]
    fn values_jump_only_where_the_law_says_so() {
        for law in laws() {
            for kink in law.kinks() {
                let jump = law.at(kink)[0] - law.at(kink - 1e-12)[0];
                let jumps = law.jumps();
                let said = jumps.iter().find(|(time, _)| *time == kink).map_or(0.0, |(_, height)| *height);
                assert!((jump - said).abs() < 1e-9, "{law:?} jumps by {jump} at {kink}");
            }
        }
    }

    #[test]
    fn moments_are_integrals_however_fast_the_law() {
        let fast = [1e-3, 1.0, 30.0, 4e3].map(|frequency| Law::Harmonic { frequency, phase: 0.7 });
        let beat = Law::Product(vec![
            Law::Harmonic { frequency: 300.0, phase: 0.7 },
            Law::Harmonic { frequency: 280.0, phase: 0.1 },
        ]);
        // A pulse that six points do not see, within a sum within a product.
        let pulse = written("exp(-((t - 0.345)/0.01)^2)", Vec::new());
        let hidden = Law::Product(vec![Law::Sum(vec![pulse, Law::Polynomial(vec![0.5])]), fast[1].clone()]);
        for law in laws().into_iter().chain(fast).chain([beat, hidden]) {
            for (start, end) in [(0.1, 0.3), (0.31, 0.38), (0.71, 1.4), (2.1, 2.9)] {
                let n = 400_000;
                let sums = (0..n).fold([0.0; 2], |[mean, moment], i| {
                    let x = (f64::from(i) + 0.5) / f64::from(n);
                    let f = law.at(start + x * (end - start))[0] / f64::from(n);
                    [mean + f, moment + (1.0 - x) * f]
                });
                for (ours, sum) in law.moments(start, end).iter().zip(sums) {
                    assert!((ours - sum).abs() < 1e-8, "{law:?} from {start} to {end}: {ours}, not {sum}");
                }
            }
        }
    }

    #[test]
    fn at_a_kink_a_law_is_what_follows_and_just_before_what_was() {
        for law in laws() {
            for kink in law.kinks() {
                let near = 1e-9;
                let pairs = [(kink, kink + near), (kink.next_down(), kink - near)];
                for (at, beside) in pairs {
                    let ([a, ra, sa], [b, rb, sb]) = (law.at(at), law.at(beside));
                    let apart = (a - b).abs() + (ra - rb).abs() + (sa - sb).abs();
                    assert!(apart < 1e-5, "{law:?} at {at:?}: {apart} from {beside:?}");
                }
            }
        }
    }

    #[test]
    fn a_spline_is_as_smooth_as_it_says_and_meets_its_points() {
        let times = [0.0, 1.0, 1.5, 4.0];
        let values = [2.0, -1.0, 0.5, 0.25];
        let law = Law::Table(Tabulated::new(times.to_vec(), values.to_vec(), true).unwrap());
        for (t, v) in times.iter().zip(values) {
            assert!((law.at(*t)[0] - v).abs() < 1e-14);
        }
        for t in [1.0, 1.5] {
            let (a, b) = (law.at(t - 1e-9), law.at(t + 1e-9));
            assert!((a[1] - b[1]).abs() < 1e-7 && (a[2] - b[2]).abs() < 1e-7);
        }
        assert!(law.at(1e-12)[2].abs() < 1e-10 && law.at(4.0 - 1e-12)[2].abs() < 1e-10);
    }

    #[test]
    fn a_spline_is_flat_where_it_is_to_be() {
        // Between two points with both ends flat, the spline is 3x² − 2x³.
        let table = Tabulated::with_flat_ends(vec![0.0, 2.0], vec![1.0, 3.0], [true; 2]).unwrap();
        for x in [0.0, 0.3, 0.5, 1.0] {
            assert!((table.between(2.0 * x)[0] - 1.0 - 2.0 * x * x * (3.0 - 2.0 * x)).abs() < 1e-14);
        }
        for flat in [[true, false], [false, true], [true, true]] {
            let (s, v) = (vec![0.0, 1.0, 1.5, 4.0], vec![2.0, -1.0, 0.5, 0.25]);
            let table = Tabulated::with_flat_ends(s.clone(), v.clone(), flat).unwrap();
            let ends = [table.between(0.0), table.between(4.0)];
            for (end, flat) in ends.iter().zip(flat) {
                assert!(end[if flat { 1 } else { 2 }].abs() < 1e-12, "{end:?}");
            }
            for (s, v) in s.iter().zip(v) {
                assert!((table.between(*s)[0] - v).abs() < 1e-14);
                let (a, b) = (table.between(s - 1e-9), table.between(s + 1e-9));
                assert!((a[1] - b[1]).abs() < 1e-6, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn a_table_needs_rising_times() {
        assert_eq!(Tabulated::new(vec![0.0, 0.0], vec![1.0, 2.0], false), None);
        assert_eq!(Tabulated::new(vec![0.0], vec![1.0], false), None);
    }
}
