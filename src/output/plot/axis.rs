//! Axes: which range to show, where to put ticks, how to write them.

use super::number::{fixed, superscript};

/// How an axis maps values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By the decimal logarithm; what is not positive is not shown.
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
                let step = nice((high - low) / count.max(1.0));
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
        let count = (last - first).clamp(0.0, 100.0) as usize;
        let ticks = (0..=count).map(|i| (first + i as f64) * step).collect();
        Self { low, high, ticks, minor: Vec::new(), decimals, exponent, scale: Scale::Linear }
    }

    fn log([low, high]: [f64; 2], count: f64) -> Self {
        let stride = ((high - low) / count.max(1.0)).ceil().max(1.0);
        let first = (low / stride - 1e-9).ceil() * stride;
        let number = ((high - first) / stride + 1e-9).floor().clamp(0.0, 400.0) as usize;
        let ticks = (0..=number).map(|i| first + stride * i as f64).collect();
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

    /// What the labels are to be multiplied by, where that is not 1.
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
