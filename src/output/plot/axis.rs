//! Axes: which range to show, where to put ticks, how to write them.

use super::number::{fixed, superscript};

/// How an axis maps values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Proportional to the value.
    Linear,
    /// By the decimal logarithm; values that are not positive are not shown.
    Log,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// How values are mapped.
    pub scale: Scale,
    /// The range to show; `None`: that of the data, with a margin.
    pub range: Option<[f64; 2]>,
    /// Values whose magnitude stays below this are zero to the reader: the axis then spans ± this
    /// much, so that round-off does not look like a signal.
    pub negligible: f64,
    /// Ticks at whole numbers only.
    pub whole: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, negligible: 0.0, whole: false }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// The axis with a given range.
    #[must_use]
    pub fn range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// The axis with [`Axis::negligible`] set.
    #[must_use]
    pub fn negligible(self, negligible: f64) -> Self {
        Self { negligible, ..self }
    }

    /// The axis with ticks at whole numbers only.
    #[must_use]
    pub fn whole(self) -> Self {
        Self { whole: true, ..self }
    }

    /// Data to drawing coordinate: the value or its logarithm. `None` where it cannot be shown.
    pub(super) fn map(&self, value: f64) -> Option<f64> {
        let mapped = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => return None,
        };
        // Beyond this, spans of axes would overflow.
        (mapped.abs() <= 1e300).then_some(mapped)
    }

    /// The range to show in drawing coordinates; `margin` as a fraction of the data's span.
    pub(super) fn span(&self, values: impl Iterator<Item = f64>, margin: f64) -> [f64; 2] {
        if let Some([low, high]) = self.range
            && let (Some(low), Some(high)) = (self.map(low), self.map(high))
            && low < high
        {
            return [low, high];
        }
        let [low, high] = self.extent(values);
        match self.scale {
            Scale::Linear => self.linear_span(low, high, margin),
            // Whole decades, and no more of them than f64 resolves.
            Scale::Log => {
                let high = (high - 1e-9).ceil();
                let low = (low + 1e-9).floor().max(high - 24.0);
                if low < high { [low, high] } else { [high - 1.0, high] }
            }
        }
    }

    /// Least and largest value in drawing coordinates; [0, 1] where there is none.
    pub(super) fn extent(&self, values: impl Iterator<Item = f64>) -> [f64; 2] {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter_map(|v| self.map(v)) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low <= high { [low, high] } else { [0.0, 1.0] }
    }

    fn linear_span(&self, low: f64, high: f64, margin: f64) -> [f64; 2] {
        /// A relative change below this is round-off or the solver's tolerance.
        const CONSTANT: f64 = 1e-6;
        let size = low.abs().max(high.abs());
        if size <= self.negligible || size == 0.0 {
            let half = if self.negligible > 0.0 { self.negligible } else { 1.0 };
            [-half, half]
        } else if high - low <= (CONSTANT * size).max(self.negligible) {
            // Constant: show it against zero.
            [(1.25 * low).min(0.0), (1.25 * high).max(0.0)]
        } else {
            let margin = margin * (high - low);
            [low - margin, high + margin]
        }
    }
}

/// An axis with its range and ticks decided, in drawing coordinates.
#[derive(Clone)]
pub(super) struct Ruler {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) ticks: Vec<f64>,
    pub(super) minor: Vec<f64>,
    decimals: usize,
    /// Ticks are labelled in units of ten to this power.
    pub(super) exponent: i32,
    scale: Scale,
}

impl Ruler {
    /// About `count` ticks over `[low, high]`.
    pub(super) fn new(axis: &Axis, [low, high]: [f64; 2], count: f64) -> Self {
        match axis.scale {
            Scale::Linear => {
                // A scale can be read only from two numbers or more.
                let tells = |step: &f64| (low / step - 1e-9).ceil() < (high / step + 1e-9).floor();
                let step = nice((high - low) / count.max(1.0));
                let step = if tells(&step) { step } else { nice(0.3 * (high - low)) };
                Self::linear([low, high], if axis.whole { step.max(1.0) } else { step })
            }
            Scale::Log => Self::log([low, high], count),
        }
    }

    /// Ticks at multiples of `step`.
    pub(super) fn linear([low, high]: [f64; 2], step: f64) -> Self {
        let size = low.abs().max(high.abs());
        let exponent = if !(1e-3..1e5).contains(&size) { 3 * (size.log10() / 3.0).floor() as i32 } else { 0 };
        let decimals = (f64::from(exponent) - step.log10() - 1e-9).ceil().clamp(0.0, 15.0) as usize;
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        // A range far from zero that f64 hardly resolves would give ticks without end.
        let count = (last - first + 1.0).clamp(0.0, 101.0) as usize;
        let ticks = (0..count).map(|i| (first + i as f64) * step).collect();
        Self { low, high, ticks, minor: Vec::new(), decimals, exponent, scale: Scale::Linear }
    }

    fn log([low, high]: [f64; 2], count: f64) -> Self {
        let stride = ((high - low) / count.max(1.0)).ceil().max(1.0);
        let first = (low / stride - 1e-9).ceil() * stride;
        let count = (((high - first) / stride + 1e-9).floor() + 1.0).clamp(0.0, 401.0) as usize;
        let ticks = (0..count).map(|i| first + stride * i as f64).collect();
        let mut minor = Vec::new();
        if high - low <= 5.0 {
            for decade in low.floor() as i32..=high.ceil() as i32 {
                minor.extend((2..10).map(|k| f64::from(decade) + f64::from(k).log10()));
            }
        } else if stride > 1.0 {
            minor.extend((low.ceil() as i32..=high.floor() as i32).map(f64::from));
        }
        minor.retain(|m| (low..=high).contains(m));
        Self { low, high, ticks, minor, decimals: 0, exponent: 0, scale: Scale::Log }
    }

    /// The text of a tick.
    pub(super) fn label(&self, tick: f64) -> String {
        match self.scale {
            Scale::Linear => fixed(tick / 10_f64.powi(self.exponent), self.decimals),
            Scale::Log => match tick.round() as i32 {
                0 => "1".into(),
                1 => "10".into(),
                exponent => format!("10{}", superscript(exponent)),
            },
        }
    }

    /// The longest label, in characters.
    pub(super) fn widest(&self) -> usize {
        self.ticks.iter().map(|&t| self.label(t).chars().count()).max().unwrap_or(0)
    }

    /// The factor by which the labels are to be multiplied, if it is not 1.
    pub(super) fn factor(&self) -> Option<String> {
        (self.exponent != 0).then(|| format!("× 10{}", superscript(self.exponent)))
    }
}

/// The smallest of 1, 2, 5 × 10ᵏ that is not below `step`.
pub(super) fn nice(step: f64) -> f64 {
    if !(step.is_finite() && step > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(step.log10().floor());
    let digit = step / power;
    let rounded = [1.0, 2.0, 5.0].into_iter().find(|&d| digit <= d * (1.0 + 1e-9)).unwrap_or(10.0);
    rounded * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(axis: &Axis, values: &[f64]) -> [f64; 2] {
        axis.span(values.iter().copied(), 0.05)
    }

    #[test]
    fn no_tick_lies_beyond_its_range() {
        assert_eq!(Ruler::linear([0.2, 0.8], 1.0).ticks, Vec::<f64>::new());
        assert_eq!(Ruler::new(&Axis::log(""), [0.3, 0.7], 5.0).ticks, Vec::<f64>::new());
        let narrow = Ruler::new(&Axis::linear(""), [0.21, 0.79], 0.5);
        assert!(!narrow.ticks.is_empty() && narrow.ticks.iter().all(|tick| (0.21..0.79).contains(tick)));
    }

    #[test]
    fn noise_is_not_shown_as_signal() {
        let axis = Axis::linear("").negligible(1e-9);
        assert_eq!(span(&axis, &[1e-13, -3e-14]), [-1e-9, 1e-9]);
        assert_eq!(span(&Axis::linear(""), &[0.0, 0.0]), [-1.0, 1.0]);
        let [low, high] = span(&axis, &[3.490_658_503, 3.490_658_504]);
        assert!(low == 0.0 && high > 4.0, "a constant is shown against zero, found {low} … {high}");
    }

    #[test]
    fn ticks_are_round_and_few() {
        let axis = Axis::linear("");
        let ruler = Ruler::new(&axis, [-0.317, 1.83], 6.0);
        let labels: Vec<String> = ruler.ticks.iter().map(|&t| ruler.label(t)).collect();
        assert_eq!(labels, ["0.0", "0.5", "1.0", "1.5"]);
        let small = Ruler::new(&axis, [-1e-9, 1e-9], 4.0);
        assert_eq!((small.exponent, small.label(small.ticks[0])), (-9, "−1.0".into()));
        let log = Ruler::new(&Axis::log(""), [-14.0, 1.0], 5.0);
        assert!(log.ticks.len() <= 6 && log.label(-12.0) == "10⁻¹²");
    }

    #[test]
    fn ranges_hold_the_data_between_margins() {
        let of = |axis: &Axis, values: &[f64]| axis.span(values.iter().copied(), 0.25);
        let axis = Axis::linear("");
        assert_eq!(of(&axis, &[1.0, 3.0, 2.0]), [0.5, 3.5]);
        assert_eq!(of(&axis, &[-3.0, -1.0]), [-3.5, -0.5]);
        assert_eq!(of(&axis, &[0.0, 4.0]), [-1.0, 5.0]);
        assert_eq!(of(&axis, &[]), [-0.25, 1.25], "nothing is shown between 0 and 1");
        // A given range is used, unless it is not valid.
        assert_eq!(of(&axis.clone().range(-2.0, 5.0), &[100.0]), [-2.0, 5.0]);
        assert_eq!(of(&axis.clone().range(0.0, 1e300), &[1.0]), [0.0, 1e300]);
        for (low, high) in [(5.0, -2.0), (1.0, 1.0), (f64::NAN, 1.0), (0.0, 2e300)] {
            assert_eq!(of(&axis.clone().range(low, high), &[1.0, 3.0]), [0.5, 3.5], "{low} to {high}");
        }
        assert_eq!(of(&Axis::log("").range(10.0, 1e5), &[7.0]), [1.0, 5.0]);
        assert_eq!(of(&Axis::log("").range(0.0, 10.0), &[20.0, 300.0]), [1.0, 3.0]);
    }

    #[test]
    fn what_is_negligible_or_constant_is_shown_against_zero() {
        let of = |axis: &Axis, values: &[f64]| axis.span(values.iter().copied(), 0.25);
        let axis = Axis::linear("").negligible(0.5);
        assert_eq!(of(&axis, &[0.5, -0.5]), [-0.5, 0.5]);
        assert_eq!(of(&axis, &[0.25]), [-0.5, 0.5]);
        assert_eq!(of(&axis, &[1.0, 1.5]), [0.0, 1.875]);
        assert_eq!(of(&axis, &[-1.5, -1.0]), [-1.875, 0.0]);
        assert_eq!(of(&axis, &[1.0, 2.0]), [0.75, 2.25]);
        let axis = Axis::linear("");
        assert_eq!(of(&axis, &[0.0]), [-1.0, 1.0]);
        assert_eq!(of(&axis, &[4.0]), [0.0, 5.0]);
        assert_eq!(of(&axis, &[-4.0]), [-5.0, 0.0]);
        assert_eq!(of(&axis, &[4.0 - 3e-6, 4.0]), [0.0, 5.0]);
        let [low, high] = of(&axis, &[4.0 - 5e-6, 4.0]);
        assert!(low > 3.9 && high > 4.0, "{low} to {high}");
    }

    #[test]
    fn logarithmic_ranges_are_whole_decades() {
        let of = |values: &[f64]| span(&Axis::log(""), values);
        assert_eq!(of(&[1.0, 1000.0]), [0.0, 3.0]);
        assert_eq!(of(&[10.0, 1000.0]), [1.0, 3.0]);
        assert_eq!(of(&[2.0, 3.0]), [0.0, 1.0]);
        assert_eq!(of(&[0.9, 1.1]), [-1.0, 1.0]);
        assert_eq!(of(&[10.0]), [0.0, 1.0]);
        assert_eq!(of(&[100.0]), [1.0, 2.0]);
        assert_eq!(of(&[-5.0, 0.0, 100.0, 200.0]), [2.0, 3.0]);
        assert_eq!(of(&[1e-30, 1.0]), [-24.0, 0.0]);
        assert_eq!(of(&[1e-30, 1e-10]), [-30.0, -10.0]);
        assert_eq!(of(&[]), [0.0, 1.0]);
    }

    #[test]
    fn values_are_mapped_where_they_can_be_shown() {
        let (linear, log) = (Axis::linear(""), Axis::log(""));
        for value in [0.0, -3.5, 1e300, -1e300] {
            assert_eq!(linear.map(value), Some(value));
        }
        for value in [2e300, -2e300, f64::INFINITY, f64::NAN] {
            assert_eq!(linear.map(value), None, "{value}");
        }
        for value in [5e-324, 0.5, 7.0, f64::MAX] {
            assert_eq!(log.map(value), Some(value.log10()));
        }
        for value in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert_eq!(log.map(value), None, "{value}");
        }
        let extent = |values: &[f64]| linear.extent(values.iter().copied());
        assert_eq!(extent(&[2.0, f64::NAN, -1.0, f64::INFINITY]), [-1.0, 2.0]);
        assert_eq!(extent(&[3.0]), [3.0, 3.0]);
        assert_eq!(extent(&[f64::NAN]), [0.0, 1.0]);
    }

    #[test]
    fn steps_are_1_2_or_5() {
        for (step, expected) in [
            (0.3, 0.5),
            (1.0, 1.0),
            (1.000_000_000_1, 1.0),
            (1.1, 2.0),
            (2.0, 2.0),
            (2.1, 5.0),
            (5.0, 5.0),
            (5.1, 10.0),
            (30.0, 50.0),
            (1000.0, 1000.0),
            (0.001, 0.001),
            (6e-8, 1e-7),
        ] {
            let found = nice(step);
            assert!((found / expected - 1.0).abs() < 1e-12, "{step}: {found}, not {expected}");
        }
        for none in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert_eq!(nice(none), 1.0, "{none}");
        }
    }

    /// Ticks with their texts, and the factor of these.
    fn texts(ruler: &Ruler) -> (Vec<String>, Option<String>) {
        (ruler.ticks.iter().map(|&tick| ruler.label(tick)).collect(), ruler.factor())
    }

    #[test]
    fn ticks_are_as_many_as_asked_for_or_fewer() {
        let axis = Axis::linear("");
        let ticks = |axis: &Axis, span, count| Ruler::new(axis, span, count).ticks;
        assert_eq!(ticks(&axis, [-10.0, 10.0], 4.0), [-10.0, -5.0, 0.0, 5.0, 10.0]);
        assert_eq!(ticks(&axis, [0.0, 10.0], 0.5), [0.0, 10.0]);
        assert_eq!(ticks(&axis, [1.0, 9.0], 4.0), [2.0, 4.0, 6.0, 8.0]);
        let whole = axis.clone().whole();
        assert_eq!(ticks(&axis, [0.0, 2.0], 4.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(ticks(&whole, [0.0, 2.0], 4.0), [0.0, 1.0, 2.0]);
        assert_eq!(ticks(&whole, [0.0, 100.0], 5.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        // The number of ticks is bounded.
        assert_eq!(Ruler::linear([0.0, 1000.0], 1.0).ticks.len(), 101);
        assert_eq!(Ruler::new(&Axis::log(""), [0.0, 500.0], 1000.0).ticks.len(), 401);
    }

    #[test]
    fn texts_of_ticks_have_the_digits_of_their_step() {
        for ((span, step), expected, factor) in [
            (([0.1, 0.3], 0.1), &["0.1", "0.2", "0.3"][..], None),
            (([0.0, 0.15], 0.05), &["0.00", "0.05", "0.10", "0.15"], None),
            (([-2.0, 1.0], 1.0), &["−2", "−1", "0", "1"], None),
            (([0.0, 500.0], 200.0), &["0", "200", "400"], None),
            (([0.0, 1e-3], 5e-4), &["0.0000", "0.0005", "0.0010"], None),
            (([0.0, 5e-4], 2e-4), &["0", "200", "400"], Some("× 10⁻⁶")),
            (([0.0, 99_999.0], 5e4), &["0", "50000"], None),
            (([0.0, 1e5], 5e4), &["0", "50", "100"], Some("× 10³")),
            (([-2e5, 0.0], 1e5), &["−200", "−100", "0"], Some("× 10³")),
            (([0.0, 2.5e6], 5e5), &["0.0", "0.5", "1.0", "1.5", "2.0", "2.5"], Some("× 10⁶")),
            (([0.0, 2e-9], 1e-9), &["0", "1", "2"], Some("× 10⁻⁹")),
        ] {
            let ruler = Ruler::linear(span, step);
            let (written, found) = texts(&ruler);
            assert_eq!(written, expected);
            assert_eq!(found.as_deref(), factor, "{expected:?}");
            let widest = expected.iter().map(|text| text.chars().count()).max();
            assert_eq!(Some(ruler.widest()), widest, "{expected:?}");
        }
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        let log = Axis::log("");
        let few = Ruler::new(&log, [0.0, 3.0], 5.0);
        let (written, factor) = texts(&few);
        assert_eq!(written, ["1", "10", "10²", "10³"]);
        assert_eq!((few.widest(), factor), (3, None));
        // Between them there are minor ticks at the whole multiples.
        assert_eq!(few.minor.len(), 3 * 8);
        for (i, minor) in few.minor.iter().enumerate() {
            let (decade, digit) = ((i / 8) as f64, (i % 8 + 2) as f64);
            assert!((minor - decade - digit.log10()).abs() < 1e-12, "{minor}");
        }
        assert_eq!(Ruler::new(&log, [-1.0, 4.0], 5.0).minor.len(), 5 * 8);
        // In a part of two decades these are 4 to 9, and 20 and 30.
        assert_eq!(Ruler::new(&log, [0.5, 1.5], 5.0).minor.len(), 6 + 2);
        // With more decades the minor ticks are at the decades, where not each has a tick.
        let many = Ruler::new(&log, [-1.0, 5.0], 5.0);
        assert_eq!(many.ticks, [0.0, 2.0, 4.0]);
        assert_eq!(many.minor, [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let each = Ruler::new(&log, [-1.0, 5.0], 6.0);
        assert_eq!((each.ticks.len(), each.minor.len()), (7, 0));
        let wide = Ruler::new(&log, [-4.0, 4.0], 3.0);
        assert_eq!(wide.ticks, [-3.0, 0.0, 3.0]);
        assert_eq!(wide.minor.len(), 9);
        assert_eq!(Ruler::new(&log, [-6.0, 0.0], 2.0).ticks, [-6.0, -3.0, 0.0]);
        assert_eq!(Ruler::new(&log, [0.0, 3.0], 0.2).ticks, [0.0, 3.0]);
        // A given range may end between decades.
        assert_eq!(Ruler::new(&log, [0.5, 1.2], 5.0).ticks, [1.0]);
        assert_eq!(Ruler::new(&log, [-0.5, 6.5], 3.0).minor, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn extreme_data_give_finite_axes() {
        for values in [[f64::MIN, f64::MAX], [1e300, 1e300], [f64::NAN, f64::INFINITY], [5e-324, 1e-320]] {
            for axis in [Axis::linear(""), Axis::log("")] {
                let [low, high] = span(&axis, &values);
                assert!(low < high, "{low} {high}");
                assert!(Ruler::new(&axis, [low, high], 6.0).ticks.len() < 500);
            }
        }
    }
}
