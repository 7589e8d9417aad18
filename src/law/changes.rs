//! Where an expression changes.
//!
//! Between the times at which it is evaluated nobody knows how an expression behaves, and a long step would pass over a short
//! pulse. Bounds of its values between them ([`Formula::range`](crate::numeric::Formula::range)) say where there may be one: such
//! stretches are halved, those first of which least is known, until values explain the bounds and change by little from one to the
//! next.

use super::Expression;
use std::collections::BinaryHeap;

/// Points, evenly spread, at which an expression is evaluated first …
const SAMPLES: u32 = 1 << 14;
/// … and most that are added where something may be between them.
const MOST_MORE: usize = 1 << 15;
/// Changes from one point to the next, and what bounds leave open, that are small: in the difference of the largest and
/// the smallest value.
const SMALL: f64 = 1.0 / 64.0;
/// With so many stretches that are not small an expression is fast all the time, which is integrated within steps …
const FAST: usize = 1 << 11;
/// … and only what its values do not foretell is looked for: bounds that leave so many times their difference open.
const UNFORESEEN: f64 = 1.5;
/// Parts of equal change into which an expression is divided.
const TURNS: u32 = 64;
/// A step over sudden changes is no longer than so many times the shortest distance of points in it.
const UNEVEN: f64 = 4.0;

/// A time \[s\], and the value then.
type Sample = [f64; 2];

/// Time between two samples.
struct Stretch {
    ends: [Sample; 2],
    /// By how much it changes from one to the other, or may beyond them.
    unknown: f64,
}

impl PartialEq for Stretch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Stretch {}

impl PartialOrd for Stretch {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Stretch {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // Of equals the earlier one first.
        self.unknown.total_cmp(&other.unknown).then(other.ends[0][0].total_cmp(&self.ends[0][0]))
    }
}

impl Expression {
    /// Times between `start` and `end`, rising, that divide the changes of the value evenly, by the square roots of what it changes
    /// between points of evaluation: so the feet of a pulse count too. Where it changes suddenly they lie as close as the changes are
    /// short.
    pub(super) fn turns(&self, [start, end]: [f64; 2]) -> Vec<f64> {
        let sample = |time: f64| [time, self.value(time)];
        let time = |i: u32| start + f64::from(i) / f64::from(SAMPLES) * (end - start);
        let samples: Vec<Sample> = (0..=SAMPLES).map(|i| sample(time(i))).collect();
        let mut turns = self.sudden_changes(&samples, [start, end]);
        let differences = || samples.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs());
        if differences().sum::<f64>().is_normal() {
            let changes = || differences().map(f64::sqrt);
            let share = changes().sum::<f64>() / f64::from(TURNS);
            let (mut passed, mut next) = (0.0, share);
            for (pair, change) in samples.windows(2).zip(changes()) {
                passed += change;
                if passed >= next {
                    turns.push(pair[0][0]);
                    next = (passed / share).floor().mul_add(share, share);
                }
                if change >= share {
                    turns.push(pair[1][0]);
                }
            }
        }
        turns.retain(|time| *time > start);
        turns.sort_by(f64::total_cmp);
        turns.dedup();
        turns
    }

    /// Times of a `span` at which steps should end because the value changes by much from one of these `samples`, evenly spread, to the
    /// next, or may beyond them.
    fn sudden_changes(&self, samples: &[Sample], span: [f64; 2]) -> Vec<f64> {
        let [mut least, mut most] =
            samples.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], [_, value]| {
                [least.min(*value), most.max(*value)]
            });
        let mut open: BinaryHeap<Stretch> =
            samples.windows(2).map(|pair| self.stretch([pair[0], pair[1]])).collect();
        let spread = most - least;
        let fast = open.iter().filter(|stretch| stretch.unknown > SMALL * spread).count() > FAST;
        let at_least = if fast { UNFORESEEN * spread } else { 0.0 };
        let mut more: Vec<f64> = Vec::new();
        while let Some(Stretch { ends: [a, b], unknown }) = open.pop() {
            if unknown.is_nan() {
                continue;
            }
            if unknown <= at_least.max(SMALL * (most - least)) || more.len() >= MOST_MORE {
                break;
            }
            let time = 0.5 * (a[0] + b[0]);
            let middle = [time, self.value(time)];
            let within = a[0] < time && time < b[0];
            if !within || ![a, b, middle].iter().all(|[_, value]| value.is_finite()) {
                continue;
            }
            [least, most] = [least.min(middle[1]), most.max(middle[1])];
            more.extend([a[0], time, b[0]]);
            open.extend([[a, middle], [middle, b]].map(|ends| self.stretch(ends)));
        }
        more.sort_by(f64::total_cmp);
        more.dedup();
        graded(&thinned(&more), span)
    }

    fn stretch(&self, ends: [Sample; 2]) -> Stretch {
        let [[from, a], [to, b]] = ends;
        let [low, high] = self.terms[0].range(&[[from, to]]);
        let unknown = (b - a).abs().max(high - a.max(b)).max(a.min(b) - low);
        Stretch { ends, unknown }
    }
}

/// Those of `times`, rising, each once, between which there is no distance much shorter than theirs; the first and the last are among them.
fn thinned(times: &[f64]) -> Vec<f64> {
    let Some(first) = times.first().copied() else { return Vec::new() };
    let (mut last, mut shortest) = (first, f64::INFINITY);
    let mut kept = vec![first];
    for pair in times.windows(2) {
        let next = pair[1] - pair[0];
        if pair[0] > last && pair[1] - last > UNEVEN * shortest.min(next) {
            kept.push(pair[0]);
            (last, shortest) = (pair[0], f64::INFINITY);
        }
        shortest = shortest.min(next);
    }
    kept.extend(times.last().filter(|end| **end > last));
    kept
}

/// `times`, rising, with more around those that lie close together, so that no distance is much longer than the next one: beside
/// what changes suddenly there is something of it that is small, and as short.
fn graded(times: &[f64], [start, end]: [f64; 2]) -> Vec<f64> {
    let mut all = times.to_vec();
    for (i, pair) in times.windows(2).enumerate() {
        let length = pair[1] - pair[0];
        let before = i.checked_sub(1).map_or(start, |before| times[before]);
        let after = times.get(i + 2).copied().unwrap_or(end);
        let lengths = || std::iter::successors(Some(UNEVEN * length), |length| Some(UNEVEN * length));
        all.extend(lengths().map(|l| pair[0] - l).take_while(|time| *time > before));
        all.extend(lengths().map(|l| pair[1] + l).take_while(|time| *time < after));
    }
    all.sort_by(f64::total_cmp);
    all
}

#[cfg(test)]
mod tests {
    use super::super::Law;
    use super::*;

    fn turns(text: &str, span: [f64; 2]) -> Vec<f64> {
        let expression = Expression::new(text, Vec::new()).unwrap_or_else(|error| panic!("{text}: {error}"));
        expression.turns(span)
    }

    /// A pulse of any width, at rest or beside something slow, is divided as one is that many points see.
    #[test]
    fn short_pulses_are_found() {
        for width in [1e-2, 1e-4, 1e-6, 1e-9, 1e-12] {
            for text in ["", "1e-3*sin(0.3*t) + ", "0.3*t - ", "2*tanh(t-7) + ", "1e6 - ", "-1e6 + "] {
                let pulse = format!("{text}10*exp(-((t-50.1234)/{width:e})^2)");
                let near = |t: &&f64| (*t - 50.1234).abs() < 3.0 * width;
                let found = turns(&pulse, [0.0, 100.0]).iter().filter(near).count();
                assert!(found >= 16, "{pulse}: {found}");
            }
        }
        for pulse in
            ["1/(1+((t-50.1234)/1e-7)^2)", "1/cosh((t-50.1234)/1e-7)^2", "exp(-((t-50.1234)/1e-7)^4)"]
        {
            let near = |t: &&f64| (*t - 50.1234).abs() < 1e-6;
            let found = turns(pulse, [0.0, 100.0]).iter().filter(near).count();
            assert!(found >= 16, "{pulse}: {found}");
        }
    }

    /// Each of many pulses is divided, and the moments between the turns are their impulses.
    #[test]
    fn many_pulses_are_all_divided() {
        let text = "exp(-(sin(pi*t)/1e-4)^2)";
        let found = turns(text, [0.5, 100.5]);
        for k in 1..=100 {
            let near = found.iter().filter(|t| (**t - f64::from(k)).abs() < 1e-4).count();
            assert!(near >= 8, "pulse {k}: {near}");
        }
        let law = Law::Expression(Box::new(Expression::new(text, Vec::new()).expect("an expression")));
        let ends: Vec<f64> = [0.5].into_iter().chain(found).chain([100.5]).collect();
        let impulse: f64 =
            ends.windows(2).map(|pair| law.moments(pair[0], pair[1])[0] * (pair[1] - pair[0])).sum();
        let expected = 100.0 * 1e-4 / std::f64::consts::PI.sqrt();
        assert!((impulse / expected - 1.0).abs() < 1e-6, "{impulse}");
    }

    #[test]
    fn steps_over_sudden_changes_are_as_even_as_the_points() {
        let halved: Vec<f64> = [0.0, 8.0, 12.0, 14.0, 15.0, 15.5].into();
        assert_eq!(thinned(&halved), [0.0, 12.0, 15.0, 15.5]);
        let even: Vec<f64> = (0..=9).map(f64::from).collect();
        assert_eq!(thinned(&even), [0.0, 4.0, 8.0, 9.0]);
        assert_eq!((thinned(&[]), thinned(&[3.0])), (vec![], vec![3.0]));
        assert_eq!(graded(&[10.0, 11.0], [0.0, 40.0]), [6.0, 10.0, 11.0, 15.0, 27.0]);
        assert_eq!(graded(&[3.0], [0.0, 9.0]), [3.0]);
    }

    /// What is fast all the time is left to the steps, and what has no number anywhere to the run.
    #[test]
    fn what_is_fast_everywhere_is_not_divided_any_finer() {
        let found = turns("sin(1e7*t)", [0.0, 100.0]).len();
        assert!(found <= 80, "{found}");
        for text in ["ln(-t)", "1/(t-t)", "sqrt(t-200)"] {
            assert_eq!(turns(text, [0.0, 100.0]), [0.0; 0], "{text}");
        }
        assert!(turns("sqrt(t)", [0.0, 100.0]).len() >= 60);
        assert!(turns("tan(t)", [0.0, 100.0]).len() >= 4);
    }
}
