//! Geometry of stress-free centrelines: r₀(s), its unit tangent and its curvature as functions of
//! the arc length s ∈ [0, L] \[m\].
//!
//! Lines and arcs are exact. Given points are interpolated by a cubic spline in the accumulated
//! chord length u with not-a-knot ends (fourth-order accurate up to the ends). Its arc length
//!
//! ```text
//! s(u) = ∫₀ᵘ |P'(v)| dv
//! ```
//!
//! is integrated by Gauss quadrature on panels, which are halved until it is exact to round-off,
//! and inverted by Newton's method, so that |r₀'(s)| = 1 for every kind of centreline. Spline ends:
//! de Boor, *A Practical Guide to Splines*, ch. IV.

use crate::numeric::{End, GAUSS_10, rates};

/// The stress-free centreline r₀(s), parametrised by arc length s ∈ [0, L].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Centreline {
    /// Straight from `start` to `end` \[m\].
    Line {
        /// First end \[m\].
        start: [f64; 2],
        /// Second end \[m\].
        end: [f64; 2],
    },
    /// Part of a circle; the polar angle runs from `from` to `to` \[rad\], in either direction.
    Arc {
        /// Centre of the circle \[m\].
        center: [f64; 2],
        /// Radius \[m\], positive.
        radius: f64,
        /// Polar angle of the beam's start \[rad\].
        from: f64,
        /// Polar angle of the beam's end \[rad\].
        to: f64,
    },
    /// A smooth curve through the given points \[m\], in order.
    Points(Vec<[f64; 2]>),
}

/// A centreline ready for evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(Geometry);

#[derive(Clone, Debug, PartialEq)]
enum Geometry {
    Line { start: [f64; 2], direction: [f64; 2], length: f64 },
    Arc { center: [f64; 2], radius: f64, from: f64, turn: f64, length: f64 },
    Spline(Spline),
}

/// Reasons why a centreline is not a usable curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// A coordinate, radius or angle is NaN or infinite, or so large that the length is infinite.
    #[error("its coordinates or its length are not finite numbers")]
    NotFinite,
    /// Start and end coincide, or the radius or the angle of an arc is zero.
    #[error("its length is zero (or too small to be a number)")]
    NoLength,
    /// The curve has fewer than two points.
    #[error("a curve needs two points or more, found {0}")]
    TooFewPoints(usize),
    /// Neighbouring points coincide.
    #[error("points {first} and {second} (counted from 0) coincide", second = first + 1)]
    Coincident {
        /// Index of the first of the two points.
        first: usize,
    },
    /// The points turn back on themselves, so that the curve through them has a cusp.
    #[error("the curve through the points has a cusp between points {first} and {second} (counted from 0)", second = first + 1)]
    Cusp {
        /// Index of the point before the cusp.
        first: usize,
    },
}

impl Curve {
    /// Prepares a centreline for evaluation.
    ///
    /// # Errors
    /// See [`CurveError`].
    pub fn new(centreline: &Centreline) -> Result<Self, CurveError> {
        let shape = match centreline {
            Centreline::Line { start, end } => line(*start, *end)?,
            Centreline::Arc { center, radius, from, to } => {
                let turn = to - from;
                let length = positive_length(radius * turn.abs())?;
                if !(center.iter().all(|c| c.is_finite()) && from.is_finite() && turn.is_finite()) {
                    return Err(CurveError::NotFinite);
                }
                Geometry::Arc { center: *center, radius: *radius, from: *from, turn, length }
            }
            Centreline::Points(points) => match points.as_slice() {
                [start, end] => line(*start, *end)?,
                points => Geometry::Spline(Spline::through(points)?),
            },
        };
        Ok(Self(shape))
    }

    /// Length L \[m\].
    pub fn length(&self) -> f64 {
        match &self.0 {
            Geometry::Line { length, .. } | Geometry::Arc { length, .. } => *length,
            Geometry::Spline(spline) => spline.length(),
        }
    }

    /// Position r₀(s) \[m\]. Beyond the ends, a line or an arc is continued, and a spline stays at
    /// its end point.
    pub fn position(&self, s: f64) -> [f64; 2] {
        match &self.0 {
            Geometry::Line { start, direction, .. } => add(*start, *direction, s),
            Geometry::Arc { center, radius, from, turn, length } => {
                let (sin, cos) = (from + turn * (s / length)).sin_cos();
                add(*center, [cos, sin], *radius)
            }
            Geometry::Spline(spline) => spline.at(s)[0],
        }
    }

    /// Unit tangent r₀'(s).
    pub fn tangent(&self, s: f64) -> [f64; 2] {
        match &self.0 {
            Geometry::Line { direction, .. } => *direction,
            Geometry::Arc { from, turn, length, .. } => {
                let (sin, cos) = (from + turn * (s / length)).sin_cos();
                let way = turn.signum();
                [-way * sin, way * cos]
            }
            Geometry::Spline(spline) => {
                let [_, d, _] = spline.at(s);
                let speed = d[0].hypot(d[1]);
                [d[0] / speed, d[1] / speed]
            }
        }
    }

    /// Arc lengths \[m\] at which the slope of its curvature jumps, rising: those of the inner points of a curve through points.
    pub fn kinks(&self) -> Vec<f64> {
        match &self.0 {
            Geometry::Line { .. } | Geometry::Arc { .. } => Vec::new(),
            Geometry::Spline(Spline { panels, .. }) => {
                let first = panels.windows(2).filter(|pair| pair[0].piece != pair[1].piece);
                first.map(|pair| pair[1].start).collect()
            }
        }
    }

    /// Curvature κ₀(s) \[1/m\], positive where the curve turns counter-clockwise.
    pub fn curvature(&self, s: f64) -> f64 {
        match &self.0 {
            Geometry::Line { .. } => 0.0,
            Geometry::Arc { radius, turn, .. } => turn.signum() / radius,
            Geometry::Spline(spline) => {
                let [_, d, dd] = spline.at(s);
                (d[0] * dd[1] - d[1] * dd[0]) / d[0].hypot(d[1]).powi(3)
            }
        }
    }
}

fn add(point: [f64; 2], direction: [f64; 2], distance: f64) -> [f64; 2] {
    [point[0] + distance * direction[0], point[1] + distance * direction[1]]
}

fn positive_length(length: f64) -> Result<f64, CurveError> {
    if !length.is_finite() {
        Err(CurveError::NotFinite)
    } else if length < f64::MIN_POSITIVE {
        Err(CurveError::NoLength)
    } else {
        Ok(length)
    }
}

fn line(start: [f64; 2], end: [f64; 2]) -> Result<Geometry, CurveError> {
    let difference = [end[0] - start[0], end[1] - start[1]];
    let length = positive_length(difference[0].hypot(difference[1]))?;
    Ok(Geometry::Line { start, direction: difference.map(|d| d / length), length })
}

/// A piecewise cubic curve with a continuous second derivative.
#[derive(Clone, Debug, PartialEq)]
struct Spline {
    pieces: Vec<Piece>,
    /// Panels of the arc-length integral, in order.
    panels: Vec<Panel>,
}

/// One piece of a spline: P(v) = c₀ + c₁ v + c₂ v² + c₃ v³, v ∈ [0, h].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    c: [[f64; 2]; 4],
    h: f64,
}

/// A part of a piece, short enough for one quadrature.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Panel {
    piece: usize,
    from: f64,
    to: f64,
    /// Arc length at `from` \[m\].
    start: f64,
    /// Arc length of the panel \[m\].
    length: f64,
}

/// Smallest speed |P'| accepted. The speed in u is near one; where it falls below this value, the
/// points double back.
const SLOWEST: f64 = 0.02;

impl Piece {
    fn derivatives(&self, v: f64) -> [[f64; 2]; 3] {
        let [c0, c1, c2, c3] = self.c;
        let each = |f: fn([f64; 4], f64) -> f64| {
            [f([c0[0], c1[0], c2[0], c3[0]], v), f([c0[1], c1[1], c2[1], c3[1]], v)]
        };
        [
            each(|c, v| c[0] + v * (c[1] + v * (c[2] + v * c[3]))),
            each(|c, v| c[1] + v * (2.0 * c[2] + v * 3.0 * c[3])),
            each(|c, v| 2.0 * c[2] + v * 6.0 * c[3]),
        ]
    }

    fn speed(&self, v: f64) -> f64 {
        let [_, d, _] = self.derivatives(v);
        d[0].hypot(d[1])
    }

    /// ∫ |P'| dv by ten Gauss points.
    fn arc_length(&self, from: f64, to: f64) -> f64 {
        let speed = |(x, weight): &(f64, f64)| weight * self.speed((1.0 - x) * from + x * to);
        (to - from) * GAUSS_10.iter().map(speed).sum::<f64>()
    }

    /// Appends the panels that cover [from, to].
    fn panels(&self, piece: usize, from: f64, to: f64, depth: usize, panels: &mut Vec<Panel>) {
        let middle = 0.5 * (from + to);
        let whole = self.arc_length(from, to);
        let halves = self.arc_length(from, middle) + self.arc_length(middle, to);
        if (whole - halves).abs() <= 1e-15 * self.h || depth == 0 {
            panels.push(Panel { piece, from, to, start: 0.0, length: halves });
        } else {
            self.panels(piece, from, middle, depth - 1, panels);
            self.panels(piece, middle, to, depth - 1, panels);
        }
    }
}

impl Spline {
    fn through(points: &[[f64; 2]]) -> Result<Self, CurveError> {
        if points.len() < 2 {
            return Err(CurveError::TooFewPoints(points.len()));
        }
        let mut h = Vec::with_capacity(points.len() - 1);
        let mut slope = Vec::with_capacity(points.len() - 1);
        for (first, pair) in points.windows(2).enumerate() {
            let difference = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            let chord = difference[0].hypot(difference[1]);
            match positive_length(chord) {
                Ok(chord) => {
                    h.push(chord);
                    slope.push(difference.map(|d| d / chord));
                }
                Err(CurveError::NoLength) => return Err(CurveError::Coincident { first }),
                Err(other) => return Err(other),
            }
        }
        let tangents = rates(&h, &slope, [End::Smooth; 2]);
        let pieces: Vec<Piece> = (0..h.len())
            .map(|i| {
                let (h, d0, d1, m) = (h[i], tangents[i], tangents[i + 1], slope[i]);
                let component = |k: usize| {
                    [
                        points[i][k],
                        d0[k],
                        (3.0 * m[k] - 2.0 * d0[k] - d1[k]) / h,
                        ((d0[k] + d1[k] - 2.0 * m[k]) / h) / h,
                    ]
                };
                let (x, y) = (component(0), component(1));
                Piece { c: std::array::from_fn(|j| [x[j], y[j]]), h }
            })
            .collect();

        let mut panels = Vec::with_capacity(pieces.len());
        let mut start = 0.0;
        for (index, piece) in pieces.iter().enumerate() {
            let first = panels.len();
            piece.panels(index, 0.0, piece.h, 12, &mut panels);
            for panel in panels.iter_mut().skip(first) {
                // Panels are halved most where the speed has a kink, so that checking their ends
                // finds every cusp.
                let slowest = piece.speed(panel.from).min(piece.speed(panel.to));
                if !panel.length.is_finite() || !slowest.is_finite() {
                    return Err(CurveError::NotFinite);
                }
                if slowest < SLOWEST {
                    return Err(CurveError::Cusp { first: index });
                }
                panel.start = start;
                start += panel.length;
            }
        }
        positive_length(start)?;
        Ok(Self { pieces, panels })
    }

    fn length(&self) -> f64 {
        self.panels.last().map_or(0.0, |panel| panel.start + panel.length)
    }

    /// P, P', P'' with respect to the chord parameter, at arc length `s`.
    fn at(&self, s: f64) -> [[f64; 2]; 3] {
        let s = s.clamp(0.0, self.length());
        let index = self.panels.partition_point(|panel| panel.start <= s).saturating_sub(1);
        let panel = &self.panels[index];
        let piece = &self.pieces[panel.piece];
        let target = (s - panel.start).min(panel.length);
        let mut v = panel.from + (panel.to - panel.from) * (target / panel.length);
        // The speed varies little within a panel: Newton's method converges quadratically from
        // here.
        for _ in 0..20 {
            let step = (target - piece.arc_length(panel.from, v)) / piece.speed(v);
            v = (v + step).clamp(panel.from, panel.to);
            if step.abs() <= 4.0 * f64::EPSILON * piece.h {
                break;
            }
        }
        piece.derivatives(v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    #[test]
    fn a_line() {
        let curve = Curve::new(&Centreline::Line { start: [1.0, 1.0], end: [4.0, 5.0] }).unwrap();
        assert_eq!(curve.length(), 5.0);
        assert_eq!(curve.tangent(2.0), [0.6, 0.8]);
        let [x, y] = curve.position(5.0);
        assert!((x - 4.0).abs() < 1e-15 && (y - 5.0).abs() < 1e-15);
    }

    #[test]
    fn an_arc_either_way_round() {
        for way in [1.0, -1.0] {
            let arc = Centreline::Arc { center: [0.0, 0.0], radius: 2.0, from: 0.0, to: way * FRAC_PI_2 };
            let curve = Curve::new(&arc).unwrap();
            assert!((curve.length() - PI).abs() < 1e-15);
            let [x, y] = curve.position(PI);
            assert!(x.abs() < 1e-15 && (y - way * 2.0).abs() < 1e-15);
            assert_eq!(curve.tangent(0.0), [0.0, way]);
            assert_eq!(curve.curvature(1.0), way * 0.5);
        }
    }

    /// A curve through points may have kinks of its curvature at those within, and has one at the middle of five; a line has none.
    #[test]
    fn kinks_are_at_the_inner_points() {
        let points = vec![[0.0, 0.0], [0.3, 0.5], [1.0, 0.4], [1.2, -0.6], [2.0, -0.5]];
        let curve = Curve::new(&Centreline::Points(points.clone())).unwrap();
        let kinks = curve.kinks();
        assert_eq!(kinks.len(), 3);
        for (s, point) in kinks.into_iter().zip(&points[1..]) {
            let [x, y] = curve.position(s);
            assert!((x - point[0]).hypot(y - point[1]) < 1e-14);
            let slope = |by: f64| (curve.curvature(s + by) - curve.curvature(s)) / by;
            let is_middle = point == &points[2];
            assert!(!is_middle || (slope(1e-6) - slope(-1e-6)).abs() > 1.0);
        }
        let line = Centreline::Points(vec![[0.0, 0.0], [0.3, 0.5]]);
        assert!(Curve::new(&line).unwrap().kinks().is_empty());
    }

    /// The spline is parametrised by arc length: |dr/ds| = 1 by central differences.
    #[test]
    fn splines_run_at_unit_speed() {
        let points = vec![[0.0, 0.0], [0.3, 0.5], [1.0, 0.4], [1.2, -0.6], [2.0, -0.5], [2.1, 0.3]];
        let curve = Curve::new(&Centreline::Points(points.clone())).unwrap();
        let length = curve.length();
        assert_eq!(curve.position(0.0), [0.0, 0.0]);
        let [x, y] = curve.position(length);
        assert!((x - 2.1).hypot(y - 0.3) < 1e-14);
        let delta = 1e-4;
        for k in 1..200 {
            let s = length * f64::from(k) / 200.0;
            let (a, b, t) = (curve.position(s - delta), curve.position(s + delta), curve.tangent(s));
            let difference = [(b[0] - a[0]) / (2.0 * delta), (b[1] - a[1]) / (2.0 * delta)];
            assert!((difference[0] - t[0]).hypot(difference[1] - t[1]) < 2e-5, "{s}");
            let (a, b) = (curve.tangent(s - delta), curve.tangent(s + delta));
            let turn = (a[0] * b[1] - a[1] * b[0]) / (2.0 * delta);
            assert!((turn - curve.curvature(s)).abs() < 2e-2 * (1.0 + turn.abs()), "{s}");
        }
    }

    /// The arc length is additive to round-off, however the interval is divided.
    #[test]
    fn arc_length_is_exact_to_round_off() {
        let points = (0..9).map(|k| [f64::from(k), (f64::from(k) * 0.9).sin()]).collect();
        let Curve(Geometry::Spline(spline)) = Curve::new(&Centreline::Points(points)).unwrap() else {
            panic!()
        };
        let fine: f64 = spline
            .pieces
            .iter()
            .map(|piece| {
                (0..64)
                    .map(|k| {
                        piece.arc_length(piece.h * f64::from(k) / 64.0, piece.h * f64::from(k + 1) / 64.0)
                    })
                    .sum::<f64>()
            })
            .sum();
        assert!((spline.length() - fine).abs() < 1e-14 * fine);
    }

    /// For n points of a circle, the length converges with at least order 4 and the curvature with
    /// at least order 2, ends included.
    #[test]
    fn circle_points_converge() {
        let error = |n: u32| {
            let points = (0..=n).map(|k| {
                let (sin, cos) = (1.5 * PI * f64::from(k) / f64::from(n)).sin_cos();
                [2.0 * cos, 2.0 * sin]
            });
            let curve = Curve::new(&Centreline::Points(points.collect())).unwrap();
            let length = (curve.length() / (1.5 * TAU) - 1.0).abs();
            let curvature = (0..=100)
                .map(|k| (curve.curvature(curve.length() * f64::from(k) / 100.0) * 2.0 - 1.0).abs())
                .fold(0.0, f64::max);
            (length, curvature)
        };
        let (coarse, fine) = (error(16), error(32));
        assert!(fine.0 < 1e-5 && fine.1 < 2e-2, "{fine:?}");
        assert!((coarse.0 / fine.0).log2() > 3.7, "{coarse:?} {fine:?}");
        assert!((coarse.1 / fine.1).log2() > 1.7, "{coarse:?} {fine:?}");
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let points = |list: &[[f64; 2]]| Curve::new(&Centreline::Points(list.to_vec())).unwrap_err();
        assert_eq!(points(&[[0.0, 0.0]]), CurveError::TooFewPoints(1));
        assert_eq!(points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]), CurveError::Coincident { first: 1 });
        assert!(matches!(
            points(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1e-9], [1.0, 0.0]]),
            CurveError::Cusp { .. }
        ));
        assert_eq!(points(&[[0.0, 0.0], [f64::NAN, 0.0], [2.0, 0.0]]), CurveError::NotFinite);
        let line = Centreline::Line { start: [1.0, 2.0], end: [1.0, 2.0] };
        assert_eq!(Curve::new(&line).unwrap_err(), CurveError::NoLength);
        let arc = Centreline::Arc { center: [0.0; 2], radius: 1.0, from: 1.0, to: 1.0 };
        assert_eq!(Curve::new(&arc).unwrap_err(), CurveError::NoLength);
    }
}
