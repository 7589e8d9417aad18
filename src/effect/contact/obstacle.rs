//! Obstacles: signed distances, and bounds by which it is decided whether a curve can touch them.

use super::curve::Border;
use nalgebra::{Matrix2, Vector2};

/// An obstacle that a beam can touch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Obstacle {
    /// A disc, or, with `inside`, the rim of a round hole.
    Circle {
        /// Its centre \[m\].
        center: [f64; 2],
        /// Its radius \[m\].
        radius: f64,
        /// Whether the beam is inside the circle.
        inside: bool,
    },
    /// All points behind a straight line.
    HalfPlane {
        /// A point of the line \[m\].
        point: [f64; 2],
        /// Unit normal of the line, pointing to the side of the beam.
        normal: [f64; 2],
    },
    /// A rectangle.
    Box {
        /// Its centre \[m\].
        center: [f64; 2],
        /// Half its sides \[m\].
        half: [f64; 2],
        /// Angle by which the rectangle is rotated \[rad\].
        angle: f64,
    },
}

impl Obstacle {
    /// The border as a line for pictures; for a half-plane, its part within `size` \[m\] of its
    /// point.
    pub fn outline(&self, size: f64) -> Vec<[f64; 2]> {
        match *self {
            Self::Circle { center: [x, y], radius, .. } => {
                let at = |i: u32| {
                    let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 72.0).sin_cos();
                    [x + radius * cosine, y + radius * sine]
                };
                (0..=72).map(at).collect()
            }
            Self::HalfPlane { point: [x, y], normal: [nx, ny] } => {
                [-size, size].map(|along| [x - along * ny, y + along * nx]).into()
            }
            Self::Box { center: [x, y], half: [a, b], angle } => {
                let (sine, cosine) = angle.sin_cos();
                let corner = |(a, b): (f64, f64)| [x + cosine * a - sine * b, y + sine * a + cosine * b];
                [(a, b), (-a, b), (-a, -b), (a, -b), (a, b)].map(corner).into()
            }
        }
    }

    /// Signed distance of the point `r`, with its gradient and second derivative. Inlined, so that
    /// nothing is computed that is not used.
    #[inline(always)]
    pub fn distance(&self, r: &Vector2<f64>) -> (f64, Vector2<f64>, Matrix2<f64>) {
        // Distance from a fixed point and its derivatives; d is the position relative to that
        // point.
        let from = |d: Vector2<f64>| {
            let length = d.norm();
            if length == 0.0 {
                return (0.0, Vector2::x(), Matrix2::zeros());
            }
            let e = d / length;
            (length, e, (Matrix2::identity() - e * e.transpose()) / length)
        };
        match *self {
            Self::Circle { center, radius, inside } => {
                let (length, e, second) = from(r - Vector2::from(center));
                if inside { (radius - length, -e, -second) } else { (length - radius, e, second) }
            }
            Self::HalfPlane { point, normal } => {
                let normal = Vector2::from(normal);
                (normal.dot(&(r - Vector2::from(point))), normal, Matrix2::zeros())
            }
            Self::Box { center, half, angle } => {
                let (sine, cosine) = angle.sin_cos();
                let turn = Matrix2::new(cosine, -sine, sine, cosine);
                let local = turn.transpose() * (r - Vector2::from(center));
                let beyond = Vector2::new(local.x.abs() - half[0], local.y.abs() - half[1]);
                let sign = local.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
                let (distance, e, second) = if beyond.x > 0.0 && beyond.y > 0.0 {
                    // Here a corner of the box is nearest.
                    from(beyond)
                } else if beyond.x > beyond.y {
                    (beyond.x, Vector2::x(), Matrix2::zeros())
                } else {
                    (beyond.y, Vector2::y(), Matrix2::zeros())
                };
                let frame = turn * Matrix2::from_diagonal(&sign);
                (distance, frame * e, frame * second * frame.transpose())
            }
        }
    }

    /// The axes of a box that is rotated by `angle`.
    fn axes(angle: f64) -> [Vector2<f64>; 2] {
        let (sine, cosine) = angle.sin_cos();
        [Vector2::new(cosine, sine), Vector2::new(-sine, cosine)]
    }

    /// The point from which the distance of `r` is measured: a circle's centre or a box's corner.
    /// `None` if it is measured from a line.
    pub fn middle(&self, r: &Vector2<f64>) -> Option<Vector2<f64>> {
        match *self {
            Self::Circle { center, .. } => Some(center.into()),
            Self::HalfPlane { .. } => None,
            Self::Box { center, half, angle } => {
                let center = Vector2::from(center);
                let mut corner = center;
                for (axis, half) in Self::axes(angle).into_iter().zip(half) {
                    let place = axis.dot(&(r - center));
                    if place.abs() <= half {
                        return None;
                    }
                    corner += axis * half.copysign(place);
                }
                Some(corner)
            }
        }
    }

    /// The largest depth of a point inside the obstacle enlarged by `gap`, measured from its
    /// enlarged border; infinite for an obstacle without another side.
    pub fn deepest(&self, gap: f64) -> f64 {
        match *self {
            Self::Circle { radius, inside: false, .. } => radius + gap,
            Self::Circle { .. } | Self::HalfPlane { .. } => f64::INFINITY,
            Self::Box { half: [a, b], .. } => a.min(b) + gap,
        }
    }

    /// Lines and circles such that, on the pieces of a curve between them, the distance is smooth
    /// and its difference from `gap` keeps its sign.
    pub fn borders(&self, gap: f64) -> Vec<Border> {
        match *self {
            Self::Circle { center, radius, inside } => {
                vec![Border::Circle(center.into(), if inside { radius - gap } else { radius + gap })]
            }
            Self::HalfPlane { point, normal } => {
                let normal = Vector2::from(normal);
                vec![Border::Line(normal, normal.dot(&Vector2::from(point)) + gap)]
            }
            Self::Box { center, half: [a, b], angle } => {
                let center = Vector2::from(center);
                let [x, y] = Self::axes(angle);
                let line = |normal: Vector2<f64>, offset: f64| {
                    let length = normal.norm();
                    Border::Line(normal / length, (normal.dot(&center) + offset) / length)
                };
                let mut borders = Vec::new();
                for sign in [-1.0, 1.0] {
                    borders.extend([line(x, sign * a), line(y, sign * b)]);
                    // Lines on which two sides of the box are equally near.
                    borders.extend([line(x - y, sign * (a - b)), line(x + y, sign * (a - b))]);
                    if gap > 0.0 {
                        borders.extend([line(x, sign * (a + gap)), line(y, sign * (b + gap))]);
                        for other in [-1.0, 1.0] {
                            borders.push(Border::Circle(center + x * (sign * a) + y * (other * b), gap));
                        }
                    }
                }
                borders.push(if a < b { line(x, 0.0) } else { line(y, 0.0) });
                borders
            }
        }
    }

    /// The way along the surface at the distance `gap`, counter-clockwise \[m\], of a point that
    /// moves from `start` to `r`; with its gradient and second derivative by `r`.
    pub fn travel(
        &self,
        gap: f64,
        start: &Vector2<f64>,
        r: &Vector2<f64>,
    ) -> (f64, Vector2<f64>, Matrix2<f64>) {
        match *self {
            Self::HalfPlane { normal: [x, y], .. } => {
                let along = Vector2::new(-y, x);
                (along.dot(&(r - start)), along, Matrix2::zeros())
            }
            Self::Circle { center, radius, inside } => {
                let center = Vector2::from(center);
                let reach = if inside { (radius - gap).max(0.0) } else { radius + gap };
                let (a, b) = (start - center, r - center);
                let (along, bend) = around(&b, reach);
                (reach * a.perp(&b).atan2(a.dot(&b)), along, bend)
            }
            Self::Box { center, half: [a, b], angle } => {
                let center = Vector2::from(center);
                let [x, y] = Self::axes(angle);
                let local = |r: &Vector2<f64>| Vector2::new(x.dot(&(r - center)), y.dot(&(r - center)));
                let (from, ..) = along_box([a, b], gap, &local(start));
                let (to, along, bend) = along_box([a, b], gap, &local(r));
                let turn = Matrix2::from_columns(&[x, y]);
                let way = 4.0 * (a + b) + std::f64::consts::TAU * gap;
                let travel = to - from;
                (travel - way * (travel / way).round(), turn * along, turn * bend * turn.transpose())
            }
        }
    }

    /// A lower bound of the distances of all points in the convex hull of `points`.
    pub fn clearance<'p>(&self, points: impl Iterator<Item = &'p Vector2<f64>> + Clone) -> f64 {
        let least = |f: &dyn Fn(&Vector2<f64>) -> f64| points.clone().map(f).fold(f64::INFINITY, f64::min);
        match *self {
            Self::HalfPlane { point, normal } => {
                let (point, normal) = (Vector2::from(point), Vector2::from(normal));
                least(&|p| normal.dot(&(p - point)))
            }
            Self::Circle { center, radius, inside: true } => {
                least(&|p| radius - (p - Vector2::from(center)).norm())
            }
            Self::Circle { center, radius, inside: false } => {
                let center = Vector2::from(center);
                match mean(points.clone(), &center).try_normalize(0.0) {
                    Some(direction) => least(&|p| direction.dot(&(p - center))) - radius,
                    None => -radius,
                }
            }
            Self::Box { center, half: [a, b], angle } => {
                let center = Vector2::from(center);
                let [x, y] = Self::axes(angle);
                let beyond = |direction: Vector2<f64>| {
                    let reach = a * direction.dot(&x).abs() + b * direction.dot(&y).abs();
                    least(&|p| direction.dot(&(p - center))) - reach
                };
                let mean = mean(points.clone(), &center);
                let nearest = x * mean.dot(&x).clamp(-a, a) + y * mean.dot(&y).clamp(-b, b);
                let oblique = (mean - nearest).try_normalize(0.0).map_or(f64::NEG_INFINITY, beyond);
                [x, -x, y, -y].into_iter().map(beyond).fold(oblique, f64::max)
            }
        }
    }
}

/// Gradient and second derivative of the way along a circle of radius `reach`, by the position `d`
/// of a point relative to the centre.
fn around(d: &Vector2<f64>, reach: f64) -> (Vector2<f64>, Matrix2<f64>) {
    let square = d.norm_squared();
    if square == 0.0 {
        return (Vector2::zeros(), Matrix2::zeros());
    }
    let across = Vector2::new(-d.y, d.x);
    let bend = (across * d.transpose() + d * across.transpose()) * (-reach / (square * square));
    (across * (reach / square), bend)
}

/// The arc length, along the border of a box with half sides `half` rounded by `gap`, of the point
/// nearest to `r`, with its gradient and second derivative; it counts counter-clockwise from the
/// start of the side at x > 0.
fn along_box(half: [f64; 2], gap: f64, r: &Vector2<f64>) -> (f64, Vector2<f64>, Matrix2<f64>) {
    let mut offset = 0.0;
    let mut nearest = (f64::NEG_INFINITY, 0.0, Vector2::zeros());
    // For each side: the axis towards it, and the axis along it.
    for side in 0..4 {
        let (out, along) = [
            (Vector2::x(), Vector2::y()),
            (Vector2::y(), -Vector2::x()),
            (-Vector2::x(), -Vector2::y()),
            (-Vector2::y(), Vector2::x()),
        ][side];
        let (reach, length) = (half[side % 2], half[1 - side % 2]);
        let (beyond, place) = (out.dot(r) - reach, along.dot(r));
        let corner = r - out * reach - along * length;
        if beyond > 0.0 && place > length {
            let (gradient, bend) = around(&corner, gap);
            let turned = gap * out.perp(&corner).atan2(out.dot(&corner));
            return (offset + 2.0 * length + turned, gradient, bend);
        }
        if beyond > nearest.0 {
            nearest = (beyond, offset + length + place, along);
        }
        offset += 2.0 * length + gap * std::f64::consts::FRAC_PI_2;
    }
    (nearest.1, nearest.2, Matrix2::zeros())
}

/// The mean of `points`, relative to `origin`.
fn mean<'p>(points: impl Iterator<Item = &'p Vector2<f64>>, origin: &Vector2<f64>) -> Vector2<f64> {
    let (sum, count) =
        points.fold((Vector2::zeros(), 0.0), |(sum, count), p| (sum + p - origin, count + 1.0));
    sum / count
}
