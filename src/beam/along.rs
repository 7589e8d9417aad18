//! Quantities that vary along a beam.

use std::fmt;

/// Depth to which a polynomial is divided in search of its bounds: pieces of 10⁻⁶ of the beam.
const DIVISIONS: usize = 20;
/// Width of the bounds of a polynomial, relative to its largest value, at which the search ends.
const TIGHT: f64 = 1e-9;

/// Places nearer to each other than this part of their arc length are one place.
const ONE_PLACE: f64 = 1e-9;

/// A quantity as a function of the arc length s \[m\].
#[derive(Clone, Debug, PartialEq)]
pub enum Along {
    /// The same everywhere.
    Constant(f64),
    /// Linear between the values at rising arc lengths, and constant beyond the first and the last.
    Table {
        /// Arc lengths \[m\].
        s: Vec<f64>,
        /// The value at each of them.
        value: Vec<f64>,
    },
    /// Σ cᵢ sⁱ.
    Polynomial(Vec<f64>),
    /// Constant by pieces: each value holds up to an arc length of its own, the last one to the end
    /// of the beam.
    Pieces {
        /// Arc lengths \[m\] at which pieces end, rising; the end of the last one is not listed.
        until: Vec<f64>,
        /// The values, one more than ends.
        value: Vec<f64>,
    },
    /// A product of quantities.
    Product(Vec<Along>),
    /// A sum of quantities.
    Sum(Vec<Along>),
    /// A quantity divided by another one, which is nowhere zero.
    Quotient(Box<[Along; 2]>),
    /// A quantity on a stretch of the beam, and zero elsewhere.
    Within {
        /// Arc length \[m\] at which the stretch begins.
        from: f64,
        /// Arc length \[m\] at which it ends.
        to: f64,
        /// The quantity there.
        quantity: Box<Along>,
    },
}

impl Along {
    /// Its value at `s`; where it jumps there, the value on the side of `inside`.
    pub fn at(&self, s: f64, inside: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table { s: places, value } => {
                let right = places.partition_point(|place| *place <= s).clamp(1, places.len() - 1);
                let (from, to) = (places[right - 1], places[right]);
                let part = ((s - from) / (to - from)).clamp(0.0, 1.0);
                value[right - 1] + part * (value[right] - value[right - 1])
            }
            Self::Polynomial(terms) => terms.iter().rev().fold(0.0, |sum, term| sum * s + term),
            Self::Pieces { until, value } => {
                let here = beside(s, inside);
                value[until.partition_point(|end| *end < here)]
            }
            Self::Product(factors) => factors.iter().map(|factor| factor.at(s, inside)).product(),
            Self::Sum(terms) => terms.iter().map(|term| term.at(s, inside)).sum(),
            Self::Quotient(pair) => pair[0].at(s, inside) / pair[1].at(s, inside),
            Self::Within { from, to, quantity } => {
                if (*from..=*to).contains(&beside(s, inside)) {
                    quantity.at(s, inside)
                } else {
                    0.0
                }
            }
        }
    }

    /// Its derivative by the arc length at `s`; where that jumps, on the side of `inside`.
    pub fn slope(&self, s: f64, inside: f64) -> f64 {
        let at = |along: &Self| along.at(s, inside);
        let slope = |along: &Self| along.slope(s, inside);
        match self {
            Self::Constant(_) | Self::Pieces { .. } => 0.0,
            Self::Table { s: places, value } => {
                let here = beside(s, inside);
                let right = places.partition_point(|place| *place <= here);
                if right == 0 || right == places.len() {
                    return 0.0;
                }
                (value[right] - value[right - 1]) / (places[right] - places[right - 1])
            }
            Self::Polynomial(terms) => {
                let terms = terms.iter().enumerate().skip(1).rev();
                terms.fold(0.0, |sum, (power, term)| sum * s + power as f64 * term)
            }
            Self::Product(factors) => {
                let others = |i: usize| {
                    let others = factors.iter().enumerate().filter(|(j, _)| *j != i);
                    others.map(|(_, factor)| at(factor)).product::<f64>()
                };
                factors.iter().enumerate().map(|(i, factor)| slope(factor) * others(i)).sum()
            }
            Self::Sum(terms) => terms.iter().map(slope).sum(),
            Self::Quotient(pair) => {
                let [above, below] = pair.each_ref().map(at);
                (slope(&pair[0]) - above / below * slope(&pair[1])) / below
            }
            Self::Within { from, to, quantity } => {
                if (*from..=*to).contains(&beside(s, inside)) {
                    slope(quantity)
                } else {
                    0.0
                }
            }
        }
    }

    /// The value, where it is the same everywhere.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// It between two arc lengths \[m\], and zero elsewhere.
    #[must_use]
    pub fn within(self, [from, to]: [f64; 2]) -> Self {
        Self::Within { from, to, quantity: Box::new(self) }
    }

    /// Whether it is zero everywhere.
    pub fn is_zero(&self) -> bool {
        self.constant() == Some(0.0)
    }

    /// The product with a number.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        self.product(&Self::Constant(factor))
    }

    /// The product with another quantity.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a * b),
            (a, b) => Self::Product(vec![a.clone(), b.clone()]),
        }
    }

    /// The sum with another quantity.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a + b),
            (a, b) => Self::Sum(vec![a.clone(), b.clone()]),
        }
    }

    /// The same quantity, which is taken not to be smooth where another one is not either, so that both
    /// are summed over the same cells.
    #[must_use]
    pub fn divided_like(&self, other: &Self) -> Self {
        self.plus(&other.times(0.0))
    }

    /// It divided by another quantity, which is nowhere zero.
    #[must_use]
    pub fn over(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a / b),
            (a, b) => Self::Quotient(Box::new([a.clone(), b.clone()])),
        }
    }

    /// The quantities of which it is composed.
    fn operands(&self) -> &[Self] {
        match self {
            Self::Product(all) | Self::Sum(all) => all,
            Self::Quotient(pair) => pair.as_slice(),
            Self::Within { quantity, .. } => std::slice::from_ref(quantity),
            _ => &[],
        }
    }

    /// Arc lengths \[m\] at which it jumps.
    pub fn jumps(&self) -> Vec<f64> {
        match self {
            Self::Pieces { until, .. } => until.clone(),
            Self::Within { from, to, quantity } => {
                let inner = quantity.jumps().into_iter().filter(|s| (*from..=*to).contains(s));
                [*from, *to].into_iter().chain(inner).collect()
            }
            composed => composed.operands().iter().flat_map(Self::jumps).collect(),
        }
    }

    /// Arc lengths \[m\] at which it is not smooth: it jumps, or its slope does.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Table { s, .. } => s.clone(),
            Self::Pieces { until, .. } => until.clone(),
            Self::Within { from, to, quantity } => {
                let inner = quantity.kinks().into_iter().filter(|s| (*from..=*to).contains(s));
                [*from, *to].into_iter().chain(inner).collect()
            }
            composed => composed.operands().iter().flat_map(Self::kinks).collect(),
        }
    }

    /// Arc lengths \[m\], rising, of the kinks between which it is, within a factor of `within`, what
    /// a straight line in its logarithm says: a narrow notch of a table has three. Where it is not
    /// positive there are none.
    pub fn corners(&self, within: f64) -> Vec<f64> {
        self.off_lines(&self.sorted_kinks(), f64::ln, within.ln())
    }

    /// Arc lengths \[m\], rising, at which it jumps, and of the kinks between which it is, within a twentieth of the largest value, what
    /// a straight line says: a narrow peak of a table has three.
    pub fn edges(&self) -> Vec<f64> {
        /// The part of the largest value by which it may depart from a straight line.
        const STRAIGHT: f64 = 0.05;
        let kinks = self.sorted_kinks();
        let values =
            kinks.windows(2).flat_map(|ends| ends.iter().map(|s| self.at(*s, 0.5 * (ends[0] + ends[1]))));
        let largest = values.fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let mut places = self.off_lines(&kinks, |value| value, STRAIGHT * largest);
        places.extend(self.jumps());
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    fn sorted_kinks(&self) -> Vec<f64> {
        let mut kinks = self.kinks();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        kinks
    }

    /// Those of its `kinks`, which rise, between which a measure of its values is within `tolerance` what a straight line says, where
    /// the measure is finite. They are chosen as D. H. Douglas and T. K. Peucker do (*Cartographica* 10, 1973, 112–122).
    fn off_lines(&self, kinks: &[f64], measure: impl Fn(f64) -> f64, tolerance: f64) -> Vec<f64> {
        let jumps = self.jumps();
        let mut corners = Vec::new();
        let mut start = 0;
        for end in 1..kinks.len() {
            if end + 1 < kinks.len() && !jumps.contains(&kinks[end]) {
                continue;
            }
            let smooth = &kinks[start..=end];
            let value = |i: usize| {
                let beside = if i == 0 { smooth[1] } else { smooth[i - 1] };
                self.at(smooth[i], 0.5 * (smooth[i] + beside))
            };
            let points: Vec<[f64; 2]> =
                smooth.iter().enumerate().map(|(i, s)| [*s, measure(value(i))]).collect();
            if points.iter().all(|[_, measure]| measure.is_finite()) {
                off_the_line(&points, tolerance, &mut corners);
            }
            start = end;
        }
        corners
    }

    /// Bounds of its values on a beam of length `length` \[m\]; those of products and sums are the
    /// products, quotients and sums of bounds.
    pub fn bounds(&self, length: f64) -> [f64; 2] {
        let hull = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
        };
        let product = |a: [f64; 2], b: [f64; 2]| hull(&mut a.iter().flat_map(|a| b.map(|b| a * b)));
        match self {
            Self::Constant(value) => [*value; 2],
            Self::Table { value, .. } | Self::Pieces { value, .. } => hull(&mut value.iter().copied()),
            Self::Polynomial(terms) => polynomial_bounds(&bernstein(terms, length), DIVISIONS),
            Self::Product(factors) => {
                factors.iter().fold([1.0; 2], |bounds, factor| product(bounds, factor.bounds(length)))
            }
            Self::Quotient(pair) => product(pair[0].bounds(length), pair[1].bounds(length).map(f64::recip)),
            Self::Sum(terms) => terms.iter().fold([0.0; 2], |[low, high], term| {
                let [a, b] = term.bounds(length);
                [low + a, high + b]
            }),
            Self::Within { quantity, .. } => {
                let [low, high] = quantity.bounds(length);
                [low.min(0.0), high.max(0.0)]
            }
        }
    }

    /// Its mean over a beam of length `length` \[m\], exact for polynomials and products of degree 9
    /// at most.
    pub fn mean(&self, length: f64) -> f64 {
        if let Some(value) = self.constant() {
            return value;
        }
        let mut ends: Vec<f64> = self.kinks().into_iter().filter(|s| *s > 0.0 && *s < length).collect();
        ends.extend([0.0, length]);
        ends.sort_by(f64::total_cmp);
        let pieces = ends.windows(2).map(|ends| {
            let (from, h) = (ends[0], ends[1] - ends[0]);
            let middle = from + 0.5 * h;
            GAUSS.iter().map(|(x, w)| 0.5 * h * w * self.at(middle + 0.5 * h * x, middle)).sum::<f64>()
        });
        pieces.sum::<f64>() / length
    }
}

/// A place beside `s` on the side of `inside`, so near that no jump but one at `s` itself lies between.
fn beside(s: f64, inside: f64) -> f64 {
    let reach = ONE_PLACE * s.abs().max(inside.abs());
    s + (inside - s).clamp(-reach, reach)
}

/// Adds the abscissae of the inner points without which straight lines would miss one by more than
/// `tolerance`.
fn off_the_line(points: &[[f64; 2]], tolerance: f64, found: &mut Vec<f64>) {
    let (Some([a, first]), Some([b, last])) = (points.first(), points.last()) else { return };
    let off = |[s, value]: &[f64; 2]| (value - first - (last - first) * (s - a) / (b - a)).abs();
    let farthest =
        (1..points.len().saturating_sub(1)).max_by(|i, j| off(&points[*i]).total_cmp(&off(&points[*j])));
    let Some(middle) = farthest.filter(|i| off(&points[*i]) > tolerance) else { return };
    off_the_line(&points[..=middle], tolerance, found);
    found.push(points[middle][0]);
    off_the_line(&points[middle..], tolerance, found);
}

/// Gauss' rule of five points on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

impl From<f64> for Along {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl fmt::Display for Along {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value}"),
            Self::Table { s, value } => write!(f, "table(s = {s:?}, value = {value:?})"),
            Self::Polynomial(terms) => write!(f, "polynomial({terms:?})"),
            Self::Pieces { until, value } => write!(f, "pieces(until = {until:?}, value = {value:?})"),
            Self::Product(factors) => write_joined(f, factors, " * "),
            Self::Sum(terms) => write_joined(f, terms, " + "),
            Self::Quotient(pair) => write_joined(f, pair.as_slice(), " / "),
            Self::Within { from, to, quantity } => write!(f, "({quantity}) from {from} to {to}"),
        }
    }
}

fn write_joined(f: &mut fmt::Formatter<'_>, all: &[Along], sign: &str) -> fmt::Result {
    for (index, one) in all.iter().enumerate() {
        write!(f, "{}({one})", if index == 0 { "" } else { sign })?;
    }
    Ok(())
}

/// Bernstein coefficients of Σ cᵢ sⁱ on [0, `length`]: bⱼ = Σ_{i ≤ j} C(j, i)/C(n, i) cᵢ Lⁱ.
fn bernstein(terms: &[f64], length: f64) -> Vec<f64> {
    let degree = terms.len().saturating_sub(1);
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    (0..=degree)
        .map(|j| {
            let scaled = terms.iter().enumerate().take(j + 1);
            scaled.map(|(i, c)| choose(j, i) / choose(degree, i) * c * length.powi(i as i32)).sum()
        })
        .collect()
}

/// Bounds of a polynomial with these Bernstein coefficients, which enclose its values. The piece
/// is halved until they are tight.
fn polynomial_bounds(b: &[f64], divisions: usize) -> [f64; 2] {
    let hull =
        |low: f64, high: f64, b: &[f64]| b.iter().fold([low, high], |[l, h], b| [l.min(*b), h.max(*b)]);
    let [low, high] = hull(f64::INFINITY, f64::NEG_INFINITY, b);
    let (first, last) = (b[0], b[b.len() - 1]);
    let reached = low == first.min(last) && high == first.max(last);
    if divisions == 0 || reached || high - low <= TIGHT * high.abs().max(low.abs()) {
        return [low, high];
    }
    // De Casteljau's construction at the middle.
    let (mut row, mut left, mut right) = (b.to_vec(), vec![first], vec![last]);
    while row.len() > 1 {
        row = row.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        left.push(row[0]);
        right.push(row[row.len() - 1]);
    }
    right.reverse();
    let ([a, b], [c, d]) =
        (polynomial_bounds(&left, divisions - 1), polynomial_bounds(&right, divisions - 1));
    [a.min(c), b.max(d)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Along {
        Along::Table { s: vec![0.0, 1.0, 3.0], value: vec![2.0, 4.0, 1.0] }
    }

    fn pieces() -> Along {
        Along::Pieces { until: vec![1.0], value: vec![5.0, 7.0] }
    }

    #[test]
    fn values_between_places_and_on_either_side_of_a_jump() {
        let values = [0.0, 0.5, 1.0, 2.0, 3.0, 3.5].map(|s| table().at(s, s));
        assert_eq!(values, [2.0, 3.0, 4.0, 2.5, 1.0, 1.0]);
        assert_eq!([0.9, 1.1].map(|inside| pieces().at(1.0, inside)), [5.0, 7.0]);
        assert_eq!(Along::Polynomial(vec![1.0, 0.0, 3.0]).at(2.0, 2.0), 13.0);
        let product = table().product(&pieces());
        assert_eq!([0.9, 1.1].map(|inside| product.at(1.0, inside)), [20.0, 28.0]);
        assert_eq!(table().plus(&Along::Constant(1.0)).at(2.0, 2.0), 3.5);
        assert_eq!(Along::Constant(3.0).times(2.0).constant(), Some(6.0));
        assert_eq!(table().times(2.0).at(0.5, 0.5), 6.0);
    }

    /// However far the place is that names the side: one beyond other jumps does, too.
    #[test]
    fn a_place_beyond_other_jumps_names_a_side() {
        let pieces = Along::Pieces { until: vec![1.0, 2.0], value: vec![5.0, 7.0, 6.0] };
        let values = [(0.5, 9.0), (1.5, 0.0), (1.5, 9.0), (1.0, 0.0), (1.0, 9.0), (2.0, 0.0), (2.0, 9.0)];
        assert_eq!(values.map(|(s, inside)| pieces.at(s, inside)), [5.0, 7.0, 7.0, 5.0, 7.0, 7.0, 6.0]);
        let stretch = Along::Polynomial(vec![0.0, 3.0]).within([1.0, 2.0]);
        let values = [(0.5, 1.5), (1.0, 9.0), (1.5, 9.0), (1.5, 0.0), (2.0, 0.0), (2.0, 9.0)];
        assert_eq!(values.map(|(s, inside)| stretch.slope(s, inside)), [0.0, 3.0, 3.0, 3.0, 3.0, 0.0]);
        assert_eq!([(1.0, 0.0), (1.0, 9.0)].map(|(s, inside)| table().slope(s, inside)), [2.0, -1.5]);
    }

    /// As tables of an inventory show it.
    #[test]
    fn it_is_written_as_it_is_given() {
        for (along, text) in [
            (Along::Constant(2.5), "2.5"),
            (table(), "table(s = [0.0, 1.0, 3.0], value = [2.0, 4.0, 1.0])"),
            (Along::Polynomial(vec![1.0, 2.0]), "polynomial([1.0, 2.0])"),
            (pieces(), "pieces(until = [1.0], value = [5.0, 7.0])"),
            (
                Along::Product(vec![table(), 3.0.into()]),
                "(table(s = [0.0, 1.0, 3.0], value = [2.0, 4.0, 1.0])) * (3)",
            ),
            (Along::Sum(vec![1.0.into(), 2.0.into(), 4.0.into()]), "(1) + (2) + (4)"),
            (Along::Quotient(Box::new([1.0.into(), 2.0.into()])), "(1) / (2)"),
        ] {
            assert_eq!(along.to_string(), text);
        }
    }

    /// Slopes are those of secants a little to either side.
    #[test]
    fn slopes_are_those_of_secants() {
        let polynomial = Along::Polynomial(vec![1.0, -2.0, 0.5, 0.25]);
        let quotient = polynomial.over(&Along::Polynomial(vec![7.0, 1.0]));
        let all = [
            Along::Constant(2.0),
            table(),
            pieces(),
            table().product(&polynomial),
            table().plus(&quotient).within([0.5, 2.5]),
            quotient,
            polynomial,
        ];
        for along in all {
            for s in [0.2, 0.9, 1.6, 2.4, 2.8, 3.4] {
                let h = 1e-5;
                let secant = (along.at(s + h, s) - along.at(s - h, s)) / (2.0 * h);
                assert!((along.slope(s, s) - secant).abs() < 1e-8, "{along} at {s}");
            }
        }
        assert_eq!([0.9, 1.1].map(|inside| table().slope(1.0, inside)), [2.0, -1.5]);
    }

    /// 3 between 1 and 2, on a beam of 4 m.
    #[test]
    fn a_stretch_ends_where_it_is_told_to() {
        let stretch = Along::Constant(3.0).within([1.0, 2.0]);
        let values = [(0.5, 0.5), (1.0, 0.9), (1.0, 1.1), (2.0, 1.9), (2.0, 2.1)];
        assert_eq!(values.map(|(s, inside)| stretch.at(s, inside)), [0.0, 0.0, 3.0, 3.0, 0.0]);
        assert_eq!((stretch.jumps(), stretch.bounds(4.0)), (vec![1.0, 2.0], [0.0, 3.0]));
        assert!((stretch.mean(4.0) - 0.75).abs() < 1e-15);
        assert_eq!(table().within([0.5, 2.0]).kinks(), [0.5, 2.0, 1.0]);
    }

    /// A notch has three corners, however many points its sides have; a taper, linear or exponential,
    /// has none, and a jump is no corner.
    #[test]
    fn corners_are_where_a_line_would_miss() {
        let notched = Along::Table {
            s: vec![0.0, 4.0, 4.5, 5.0, 6.0, 10.0],
            value: vec![1.0, 1.0, 0.325, 0.1, 1.0, 1.1],
        };
        assert_eq!(notched.corners(1.5), [4.0, 5.0, 6.0]);
        assert!(notched.corners(20.0).is_empty());
        assert_eq!(notched.product(&notched).corners(20.0), [4.0, 5.0, 6.0]);
        let many: Vec<f64> = (0..=100).map(f64::from).collect();
        let falling = many.iter().map(|s| (-0.1 * s).exp()).collect();
        assert!(Along::Table { s: many, value: falling }.corners(1.5).is_empty());
        let stepped = notched.product(&Along::Pieces { until: vec![5.0], value: vec![1.0, 30.0] });
        assert_eq!(stepped.corners(1.5), [4.0, 6.0]);
        assert_eq!([Along::Constant(2.0), pieces()].map(|along| along.corners(1.5).len()), [0, 0]);
        let through_zero = Along::Table { s: vec![0.0, 1.0, 2.0], value: vec![1.0, 0.0, 1.0] };
        assert!(through_zero.corners(1.5).is_empty());
    }

    /// A peak of a quantity of any sign has three, however small it is, and a table that is nearly straight none.
    #[test]
    fn edges_are_where_a_line_would_miss_by_a_part_of_the_largest_value() {
        let table = |value: Vec<f64>| Along::Table { s: vec![0.0, 4.0, 4.5, 5.0, 6.0, 10.0], value };
        let peak = table(vec![0.0, 0.0, -0.5e-6, -1e-6, 0.0, 0.0]);
        assert_eq!(peak.edges(), [4.0, 5.0, 6.0]);
        assert!(table(vec![-0.4, -0.01, 0.05, 0.1, 0.2, 0.6]).edges().is_empty());
        let stepped = peak.product(&pieces());
        assert_eq!(stepped.edges(), [1.0, 4.0, 5.0, 6.0]);
        assert_eq!([Along::Constant(2.0), pieces()].map(|along| along.edges().len()), [0, 1]);
    }

    #[test]
    fn jumps_are_kinks_and_kinks_are_not_jumps() {
        assert_eq!((table().jumps(), table().kinks()), (vec![], vec![0.0, 1.0, 3.0]));
        assert_eq!((pieces().jumps(), pieces().kinks()), (vec![1.0], vec![1.0]));
        let product = table().product(&pieces());
        assert_eq!((product.jumps(), product.kinks()), (vec![1.0], vec![0.0, 1.0, 3.0, 1.0]));
    }

    /// (s − 1)² + 0.01 on [0, 3] lies between 0.01 and 4.01; its end values are 1.01 and 4.01.
    #[test]
    fn bounds_enclose_the_inside_of_a_polynomial() {
        let [low, high] = Along::Polynomial(vec![1.01, -2.0, 1.0]).bounds(3.0);
        assert!((low - 0.01).abs() < 1e-8 && (high - 4.01).abs() < 1e-12, "{low} {high}");
        assert_eq!(table().times(-2.0).bounds(3.0), [-8.0, -2.0]);
        assert_eq!(table().plus(&pieces()).bounds(3.0), [6.0, 11.0]);
    }

    /// ∫ of the table is 3 + 5, that of table times pieces 15 + 35; s⁴ times s⁵ has the mean L⁹/10.
    #[test]
    fn means_are_exact() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b, "{a} {b}");
        close(table().mean(3.0), 8.0 / 3.0);
        close(table().product(&pieces()).mean(3.0), 50.0 / 3.0);
        let power = |n: usize| Along::Polynomial([vec![0.0; n], vec![1.0]].concat());
        close(power(4).product(&power(5)).mean(2.0), 51.2);
    }
}
