//! Curves through points: the cubic splines that they are said to be, by polynomials that can be
//! written down, and what is no curve.

use ancf::centreline::{Centreline, Curve, CurveError};

type Point = [f64; 2];

fn through(points: &[Point]) -> Curve {
    Curve::new(&Centreline::Points(points.to_vec())).unwrap_or_else(|error| panic!("{error}: {points:?}"))
}

/// Sums of the chords up to each point, by which the polynomials run.
fn chords(points: &[Point]) -> Vec<f64> {
    let mut sums = vec![0.0];
    for pair in points.windows(2) {
        let chord = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
        sums.push(sums[sums.len() - 1] + chord);
    }
    sums
}

/// Lagrange's polynomial through all of the points with its first two derivatives.
fn lagrange(points: &[Point], knots: &[f64], u: f64) -> [Point; 3] {
    let mut sum = [[0.0; 2]; 3];
    for (i, point) in points.iter().enumerate() {
        // The product over the other knots, differentiated factor by factor.
        let mut product = [1.0, 0.0, 0.0];
        for (j, knot) in knots.iter().enumerate().filter(|(j, _)| *j != i) {
            let (factor, rate) = ((u - knot) / (knots[i] - knots[j]), 1.0 / (knots[i] - knots[j]));
            let [p, d, dd] = product;
            product = [p * factor, d * factor + p * rate, dd * factor + 2.0 * d * rate];
        }
        for (sum, weight) in sum.iter_mut().zip(product) {
            sum[0] += weight * point[0];
            sum[1] += weight * point[1];
        }
    }
    sum
}

/// Three points lie on a parabola and four on a cubic over their chords, whatever the distances:
/// would catch every factor in the equations of the ends, and a piece that is another's.
#[test]
fn three_points_make_a_parabola_and_four_a_cubic() {
    for points in [
        &[[0.0, 0.0], [1.0, 0.4], [1.7, -0.2]][..],
        &[[0.3, -1.0], [0.5, 0.2], [2.5, 0.9]],
        &[[0.0, 0.0], [0.4, 0.3], [1.5, 0.2], [2.2, 0.9]],
        &[[1.0, 2.0], [0.8, 2.9], [0.1, 3.1], [-1.4, 2.6]],
        &[[-3.0, 0.0], [-1.0, 1.1], [-0.7, 1.0], [0.0, 0.1]],
    ] {
        let (curve, knots) = (through(points), chords(points));
        let (last, parts) = (knots[knots.len() - 1], 4000);
        let speed = |u: f64| {
            let [_, d, _] = lagrange(points, &knots, u);
            d[0].hypot(d[1])
        };
        let h = last / f64::from(parts);
        let mut s = 0.0;
        for k in 0..=parts {
            let u = h * f64::from(k);
            if k > 0 {
                s += h / 6.0 * (speed(u - h) + 4.0 * speed(u - 0.5 * h) + speed(u));
            }
            if k % 40 != 0 {
                continue;
            }
            let [p, d, dd] = lagrange(points, &knots, u);
            let (place, tangent) = (curve.position(s), curve.tangent(s));
            let speed = speed(u);
            for c in 0..2 {
                assert!((place[c] - p[c]).abs() < 1e-9, "{points:?}, u = {u}: {place:?}, not {p:?}");
                assert!((tangent[c] - d[c] / speed).abs() < 1e-8, "{points:?}, u = {u}: {tangent:?}");
            }
            let curvature = (d[0] * dd[1] - d[1] * dd[0]) / speed.powi(3);
            assert!(
                (curve.curvature(s) - curvature).abs() < 1e-6 * (1.0 + curvature.abs()),
                "{points:?}, u = {u}"
            );
        }
        assert!((curve.length() - s).abs() < 1e-9, "{} and {s}", curve.length());
    }
}

/// The arc length at which a curve is nearest to a point, between two others.
fn nearest(curve: &Curve, point: Point, mut from: f64, mut to: f64) -> f64 {
    let apart = |s: f64| {
        let [x, y] = curve.position(s);
        (x - point[0]).hypot(y - point[1])
    };
    for _ in 0..200 {
        let (a, b) = (from + 0.382 * (to - from), from + 0.618 * (to - from));
        if apart(a) < apart(b) {
            to = b;
        } else {
            from = a;
        }
    }
    0.5 * (from + to)
}

/// Through more points: the curve goes through all of them, its curvature jumps nowhere, and the
/// rate of its curvature neither at the second point nor at the last but one, where there is no
/// knot. No other cubic pieces do that.
#[test]
fn curves_through_many_points_have_no_knot_next_to_their_ends() {
    for points in [
        &[[0.0, 0.0], [0.5, 0.4], [1.5, 0.3], [1.9, -0.3], [3.0, -0.2]][..],
        &[[0.0, 0.0], [0.3, 0.5], [1.0, 0.4], [1.2, -0.6], [2.0, -0.5], [2.1, 0.3]],
        &[[0.0, 1.0], [1.0, 1.6], [1.4, 1.5], [2.5, 2.3], [3.1, 2.2], [3.4, 1.4], [4.6, 1.0]],
    ] {
        let (curve, knots) = (through(points), chords(points));
        let (length, last) = (curve.length(), points.len() - 1);
        let stretch = length / knots[last];
        let mut places = vec![0.0];
        for (i, point) in points.iter().enumerate().take(last).skip(1) {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            let at = knots[i] * stretch;
            let s = nearest(&curve, *point, at - 0.6 * before, at + 0.6 * after);
            let [x, y] = curve.position(s);
            assert!((x - point[0]).hypot(y - point[1]) < 1e-7, "{point:?} is not on the curve: ({x}, {y})");
            places.push(s);
        }
        let [x, y] = curve.position(length);
        assert!((x - points[last][0]).hypot(y - points[last][1]) < 1e-12);
        // One-sided differences of the second order.
        let rate = |s: f64, h: f64| {
            let kappa = |k: f64| curve.curvature(s + k * h);
            (-1.5 * kappa(0.01) + 2.0 * kappa(1.01) - 0.5 * kappa(2.01)) / h
        };
        let h = 1e-4;
        for (i, s) in places.iter().enumerate().skip(1) {
            let jump = curve.curvature(s + 1e-7) - curve.curvature(s - 1e-7);
            assert!(jump.abs() < 1e-3, "the curvature jumps by {jump} at point {i} of {points:?}");
            let (before, after) = (rate(*s, -h), rate(*s, h));
            let jump = (after - before).abs() / (1.0 + before.abs().max(after.abs()));
            let knot = i != 1 && i + 1 != last;
            assert_eq!(jump > 0.05, knot, "{jump} at point {i} of {points:?}: {before} and {after}");
        }
        // Beyond its ends it stops.
        assert_eq!(
            (curve.position(-1.0), curve.position(length + 1.0)),
            (curve.position(0.0), curve.position(length))
        );
    }
}

/// Lines and arcs go on beyond their ends; an arc turns to its side.
#[test]
fn lines_and_arcs_go_on_beyond_their_ends() {
    let line = Curve::new(&Centreline::Line { start: [1.0, 2.0], end: [4.0, 6.0] }).expect("a line");
    for (s, x, y) in [(-5.0, -2.0, -2.0), (2.5, 2.5, 4.0), (10.0, 7.0, 10.0)] {
        let place = line.position(s);
        assert!((place[0] - x).hypot(place[1] - y) < 1e-14, "{s}: {place:?}");
        assert_eq!((line.tangent(s), line.curvature(s)), ([0.6, 0.8], 0.0));
    }
    for way in [1.0, -1.0] {
        let arc = Centreline::Arc { center: [3.0, -1.0], radius: 0.5, from: 0.25, to: 0.25 + way * 1.5 };
        let curve = Curve::new(&arc).expect("an arc");
        assert!((curve.length() - 0.75).abs() < 1e-15);
        for s in [-0.5, 0.0, 0.3, 0.75, 2.0] {
            let polar = 0.25 + way * 2.0 * s;
            let (place, tangent) = (curve.position(s), curve.tangent(s));
            let expected = [3.0 + 0.5 * polar.cos(), -1.0 + 0.5 * polar.sin()];
            assert!((place[0] - expected[0]).hypot(place[1] - expected[1]) < 1e-14, "{s}: {place:?}");
            let expected = [-way * polar.sin(), way * polar.cos()];
            assert!((tangent[0] - expected[0]).hypot(tangent[1] - expected[1]) < 1e-14, "{s}: {tangent:?}");
            assert_eq!(curve.curvature(s), 2.0 * way);
        }
    }
}

/// Each number that is none is found, wherever it stands; what is as short as a number can be has a
/// length.
#[test]
fn what_is_no_curve_is_told_apart() {
    let fault = |centreline: Centreline| Curve::new(&centreline).expect_err("no curve");
    let arc = |center: Point, radius: f64, from: f64, to: f64| Centreline::Arc { center, radius, from, to };
    for no_number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for centreline in [
            arc([no_number, 0.0], 1.0, 0.0, 1.0),
            arc([0.0, no_number], 1.0, 0.0, 1.0),
            arc([0.0, 0.0], 1.0, no_number, 1.0),
            arc([0.0, 0.0], 1.0, 0.0, no_number),
            Centreline::Line { start: [no_number, 0.0], end: [1.0, 0.0] },
            Centreline::Line { start: [0.0, 0.0], end: [1.0, no_number] },
            Centreline::Points(vec![[0.0, 0.0], [1.0, 0.0], [2.0, no_number]]),
        ] {
            assert_eq!(fault(centreline.clone()), CurveError::NotFinite, "{centreline:?}");
        }
    }
    let short = |x: f64| Curve::new(&Centreline::Line { start: [0.0, 0.0], end: [x, 0.0] });
    assert!(short(f64::MIN_POSITIVE).is_ok());
    assert_eq!(short(0.5 * f64::MIN_POSITIVE).expect_err("too short"), CurveError::NoLength);
    assert_eq!(fault(arc([0.0; 2], -1.0, 0.0, 1.0)), CurveError::NoLength);
    let twice = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [2.0, 1.0]];
    let coincident = fault(Centreline::Points(twice));
    assert_eq!(coincident, CurveError::Coincident { first: 2 });
    assert_eq!(coincident.to_string(), "points 2 and 3 (counted from 0) coincide");
    assert_eq!(fault(Centreline::Points(Vec::new())), CurveError::TooFewPoints(0));
    let back = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [2.0, 1e-9], [1.0, 0.0]];
    let cusp = fault(Centreline::Points(back));
    assert_eq!(cusp, CurveError::Cusp { first: 3 });
    assert!(cusp.to_string().contains("a cusp between points 3 and 4 (counted from 0)"), "{cusp}");
}
