//! Obstacles by themselves: signed distances with their derivatives, ways along a surface, and what
//! is known of a whole hull of points.

use ancf::effect::Obstacle;
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const CENTER: [f64; 2] = [1.0, -2.0];
const HALF: [f64; 2] = [0.5, 0.3];
const ANGLE: f64 = 0.4;

fn rectangle() -> Obstacle {
    Obstacle::Box { center: CENTER, half: HALF, angle: ANGLE }
}

fn circle(inside: bool) -> Obstacle {
    Obstacle::Circle { center: CENTER, radius: 0.7, inside }
}

/// Through (0.2, 0.1), towards (−0.6, 0.8).
fn plane() -> Obstacle {
    Obstacle::HalfPlane { point: [0.2, 0.1], normal: [-0.6, 0.8] }
}

/// A point of the box's own axes.
fn of_box(x: f64, y: f64) -> Vector2<f64> {
    let (sine, cosine) = ANGLE.sin_cos();
    Vector2::new(CENTER[0] + cosine * x - sine * y, CENTER[1] + sine * x + cosine * y)
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, not {expected}");
}

/// Gradient and second derivative of a function at a point against those that come with it.
fn derivatives_agree(
    f: impl Fn(&Vector2<f64>) -> (f64, Vector2<f64>, Matrix2<f64>),
    r: Vector2<f64>,
    what: &str,
) {
    let (h, (_, gradient, second)) = (1e-6, f(&r));
    for axis in 0..2 {
        let mut step = Vector2::zeros();
        step[axis] = h;
        let (after, before) = (f(&(r + step)), f(&(r - step)));
        near(gradient[axis], (after.0 - before.0) / (2.0 * h), 1e-8, &format!("{what}, gradient"));
        for other in 0..2 {
            let slope = (after.1[other] - before.1[other]) / (2.0 * h);
            near(second[(axis, other)], slope, 1e-7, &format!("{what}, second derivative"));
        }
    }
}

/// Points beyond each side, beyond each corner and within, with the distances by hand.
const AROUND_A_BOX: [([f64; 2], f64); 12] = [
    ([0.9, 0.1], 0.4),
    ([-0.8, -0.2], 0.3),
    ([0.3, 0.5], 0.2),
    ([-0.1, -1.3], 1.0),
    ([0.8, 0.7], 0.5),
    ([-0.8, 0.7], 0.5),
    ([0.8, -0.7], 0.5),
    ([-1.1, -1.1], 1.0),
    ([0.45, 0.1], -0.05),
    ([-0.4, 0.1], -0.1),
    ([0.2, 0.28], -0.02),
    ([-0.1, -0.2], -0.1),
];

#[test]
fn distances_are_those_of_the_nearest_point() {
    for ([x, y], distance) in AROUND_A_BOX {
        let point = of_box(x, y);
        near(rectangle().distance(&point).0, distance, 1e-14, &format!("at ({x}, {y}) of the box"));
        derivatives_agree(|r| rectangle().distance(r), point, &format!("at ({x}, {y}) of the box"));
    }
    for polar in [0.1, 1.9, -2.5] {
        for length in [0.3, 0.7, 1.2] {
            let point = Vector2::from(CENTER) + length * Vector2::new(f64::cos(polar), f64::sin(polar));
            near(circle(false).distance(&point).0, length - 0.7, 1e-14, "from a disc");
            near(circle(true).distance(&point).0, 0.7 - length, 1e-14, "from a rim");
            for inside in [false, true] {
                derivatives_agree(|r| circle(inside).distance(r), point, "from a circle");
            }
        }
    }
    let middle = circle(false).distance(&CENTER.into());
    assert_eq!((middle.0, middle.1.norm(), middle.2), (-0.7, 1.0, Matrix2::zeros()));
    for (point, distance) in [([0.2, 0.1], 0.0), ([1.0, 0.1], -0.48), ([0.2, -0.9], -0.8), ([-0.4, 0.9], 1.0)]
    {
        let point = Vector2::from(point);
        near(plane().distance(&point).0, distance, 1e-14, "from a half-plane");
        derivatives_agree(|r| plane().distance(r), point, "from a half-plane");
    }
}

/// Distances are measured from a corner beyond both sides, from the centre of a circle, and
/// otherwise from a line; nothing is deeper than the middle.
#[test]
fn middles_and_depths_are_those_of_the_shape() {
    for ([x, y], distance) in AROUND_A_BOX {
        let corner = (x.abs() > 0.5 && y.abs() > 0.3).then(|| of_box(0.5 * x.signum(), 0.3 * y.signum()));
        let found = rectangle().middle(&of_box(x, y));
        assert_eq!(found.is_some(), corner.is_some(), "at ({x}, {y})");
        if let (Some(found), Some(corner)) = (found, corner) {
            near((found - corner).norm(), 0.0, 1e-14, "a corner");
            near((of_box(x, y) - found).norm(), distance, 1e-14, "from the corner");
        }
    }
    let straight = Obstacle::Box { center: [0.0; 2], half: HALF, angle: 0.0 };
    assert_eq!(straight.middle(&Vector2::new(0.5, 0.9)), None, "beyond one side");
    assert_eq!(straight.middle(&Vector2::new(-0.7, -0.3)), None, "beyond one side");
    assert_eq!(straight.middle(&Vector2::new(-0.7, -0.31)), Some(Vector2::new(-0.5, -0.3)));
    assert_eq!(circle(true).middle(&Vector2::new(3.0, 4.0)), Some(CENTER.into()));
    assert_eq!(plane().middle(&Vector2::new(3.0, 4.0)), None);
    near(rectangle().deepest(0.05), 0.35, 1e-15, "half the shorter side");
    let upright = Obstacle::Box { center: CENTER, half: [0.2, 0.3], angle: ANGLE };
    near(upright.deepest(0.05), 0.25, 1e-15, "half the shorter side");
    near(circle(false).deepest(0.05), 0.75, 1e-15, "the radius");
    assert_eq!([circle(true), plane()].map(|hole| hole.deepest(0.05)), [f64::INFINITY; 2]);
}

/// Ways along a line, a circle at its distance, and the rounded border of a box, which is walked
/// around in either direction.
#[test]
fn ways_along_a_surface_are_its_lengths() {
    let from = Vector2::new(0.2, 0.1);
    for (to, way) in [([-0.6, -0.5], 1.0), ([1.0, 0.7], -1.0), ([-0.4, 0.9], 0.0)] {
        near(plane().travel(0.1, &from, &to.into()).0, way, 1e-14, "along a line");
        derivatives_agree(|r| plane().travel(0.1, &from, r), to.into(), "along a line");
    }
    let at = |polar: f64| Vector2::from(CENTER) + 0.9 * Vector2::new(polar.cos(), polar.sin());
    for (turn, inside, reach) in [(0.5, false, 0.8), (-2.0, false, 0.8), (3.0, true, 0.6), (-3.0, true, 0.6)]
    {
        let (start, end) = (at(2.5), at(2.5 + turn));
        near(circle(inside).travel(0.1, &start, &end).0, reach * turn, 1e-14, "along a circle");
        derivatives_agree(|r| circle(inside).travel(0.1, &start, r), end, "along a circle");
    }
    assert_eq!(circle(true).travel(0.8, &at(0.0), &at(1.0)).0, 0.0, "a hole too narrow to go around");
    // Anticlockwise from the middle of the side at x > 0: 0.3 along it, a quarter of a circle of
    // the radius 0.1, 1 along the next side, and so on.
    let gap = 0.1;
    let quarter = gap * FRAC_PI_2;
    let whole = 4.0 * (0.5 + 0.3) + TAU * gap;
    let round =
        |corner: [f64; 2], polar: f64| of_box(corner[0] + gap * polar.cos(), corner[1] + gap * polar.sin());
    let places = [
        (of_box(0.6, 0.0), 0.0),
        (of_box(0.6, 0.2), 0.2),
        (round([0.5, 0.3], 0.3 * FRAC_PI_2), 0.3 + 0.3 * quarter),
        (of_box(0.4, 0.4), 0.3 + quarter + 0.1),
        (of_box(-0.45, 0.4), 0.3 + quarter + 0.95),
        (round([-0.5, 0.3], 1.4 * FRAC_PI_2), 1.3 + 1.4 * quarter),
        (of_box(-0.6, -0.1), 1.3 + 2.0 * quarter + 0.4),
        (round([-0.5, -0.3], PI + 0.8 * FRAC_PI_2), 1.9 + 2.8 * quarter),
        (of_box(0.3, -0.4), 1.9 + 3.0 * quarter + 0.8),
        (round([0.5, -0.3], PI + 1.5 * FRAC_PI_2), 2.9 + 3.5 * quarter),
        (of_box(0.6, -0.25), 2.9 + 4.0 * quarter + 0.05),
    ];
    for (start, from) in &places {
        for (end, to) in &places {
            let way = to - from;
            let shortest = way - whole * (way / whole).round();
            let found = rectangle().travel(gap, start, end).0;
            // Half way around it may be either way.
            if (shortest.abs() - 0.5 * whole).abs() > 1e-9 {
                near(found, shortest, 1e-13, &format!("from {from} to {to} along a box"));
            }
        }
    }
    let start = of_box(0.6, 0.05);
    for ([x, y], distance) in AROUND_A_BOX {
        if distance > 0.0 {
            derivatives_agree(|r| rectangle().travel(gap, &start, r), of_box(x, y), "along a box");
        }
    }
}

/// Of one point the clearance is its distance; of several none of their hull is nearer.
#[test]
fn clearances_bound_the_distances_of_a_hull() {
    let points: Vec<Vector2<f64>> = AROUND_A_BOX.iter().map(|([x, y], _)| of_box(*x, *y)).collect();
    for obstacle in [rectangle(), circle(false), circle(true), plane()] {
        for point in &points {
            let clearance = obstacle.clearance([point].into_iter());
            near(clearance, obstacle.distance(point).0, 1e-14, &format!("{obstacle:?} at {point}"));
        }
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                let c = &points[(i + 5 * j) % points.len()];
                let clearance = obstacle.clearance([a, b, c].into_iter());
                let mut least = f64::INFINITY;
                for k in 0..=20 {
                    for l in 0..=20 - k {
                        let (s, t) = (f64::from(k) / 20.0, f64::from(l) / 20.0);
                        let point = a * s + b * t + c * (1.0 - s - t);
                        least = least.min(obstacle.distance(&point).0);
                    }
                }
                assert!(clearance <= least + 1e-12, "{obstacle:?}: {clearance} of {least} from {a} {b} {c}");
            }
        }
    }
    let center = Vector2::from(CENTER);
    assert_eq!(circle(false).clearance([&center].into_iter()), -0.7);
    // Two points beyond one side are as far from the box as the nearer of them.
    let pair = [of_box(0.9, -0.2), of_box(0.7, 0.2)];
    near(rectangle().clearance(pair.iter()), 0.2, 1e-14, "beyond one side");
    let pair = [of_box(-0.2, 0.9), of_box(0.3, 0.6)];
    near(rectangle().clearance(pair.iter()), 0.3, 1e-14, "above");
}
