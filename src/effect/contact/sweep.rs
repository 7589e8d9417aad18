//! Obstacles that a beam meets on the path from one state to another.
//!
//! Between two states the coordinates are taken to follow a cubic of a parameter θ ∈ [0, 1]. A cell
//! then sweeps a patch r(ξ, θ), a polynomial in both parameters, which lies in the convex hull of
//! its control points. Patches whose hull is clear of the obstacle are discarded; others are
//! divided in half, in θ or in ξ, and the earlier half is examined first. This yields the first θ
//! at which any point of the curve is deeper than a given level, however thin the obstacle and
//! however long the path.

use super::ContactIntegral;
use super::curve::Curve;
use crate::assembly::{ContactEffect, CubicStates, Density};
use nalgebra::Vector2;

/// Largest number of patches that are examined; a patch that is not clear by then counts as a hit.
const PATCHES: usize = 20_000;
/// Length of an interval of θ that is not divided further.
const SHORTEST: f64 = 1e-9;

/// The part of a patch for θ from `from` to `to`.
struct Patch {
    rows: [Curve; 4],
    from: f64,
    to: f64,
}

impl Patch {
    /// The two halves in θ.
    fn halves(&self) -> [Self; 2] {
        let [a, b, c, d] = &self.rows;
        let half = |a: &Curve, b: &Curve| Curve::combine([a, b], |[a, b]| 0.5 * (a + b));
        let (ab, bc, cd) = (half(a, b), half(b, c), half(c, d));
        let (abc, bcd) = (half(&ab, &bc), half(&bc, &cd));
        let middle = half(&abc, &bcd);
        let time = 0.5 * (self.from + self.to);
        [
            Self { rows: [*a, ab, abc, middle], from: self.from, to: time },
            Self { rows: [middle, bcd, cd, *d], from: time, to: self.to },
        ]
    }

    /// The two halves in ξ, along the cell.
    fn parts(&self) -> [Self; 2] {
        let halves = self.rows.each_ref().map(Curve::halves);
        [0, 1].map(|i| Self { rows: halves.each_ref().map(|half| half[i]), from: self.from, to: self.to })
    }

    /// Extents of its control points along the path, and along the cell \[m\].
    fn extents(&self) -> (f64, f64) {
        let apart = |a: &Curve, b: &Curve| {
            let pairs = a.points().iter().zip(b.points());
            pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).norm()))
        };
        let length = |curve: &Curve| curve.points().windows(2).map(|p| (p[1] - p[0]).norm()).sum::<f64>();
        (
            self.rows.windows(2).map(|pair| apart(&pair[0], &pair[1])).sum(),
            self.rows.iter().map(length).fold(0.0, f64::max),
        )
    }
}

impl ContactIntegral {
    /// A lower bound of the distances \[m\] by which the points of a patch are less deep than `level`.
    fn clear(&self, rows: &[Curve; 4], level: f64) -> f64 {
        let points = rows.iter().flat_map(|curve| curve.points());
        self.penalty.obstacle.clearance(points) - self.penalty.gap + level
    }

    /// The first θ on the path `way` at which a point of the beam is deeper than `level` \[m\], if
    /// there is one. Depths are resolved to `fine` \[m\].
    pub fn first_deeper(&self, way: CubicStates<'_>, level: f64, fine: f64) -> Option<f64> {
        let mut first = f64::INFINITY;
        let (mut patches, mut left) = (0, Vec::new());
        for cell in 0..self.cells.count() {
            let rows = way.map(|q| self.cells.curve(cell, q));
            patches += 1;
            if self.clear(&rows, level) > 0.0 {
                // Most cells are: no patch is stored for them.
                continue;
            }
            left.push(Patch { rows, from: 0.0, to: 1.0 });
            while let Some(patch) = left.pop() {
                if patch.from >= first {
                    continue;
                }
                patches += 1;
                let clear = self.clear(&patch.rows, level);
                if clear > 0.0 {
                    continue;
                }
                let here = patch.rows[0].middle();
                let gap = self.penalty.gap_at(&here) + level;
                if gap < 0.0 {
                    first = patch.from;
                    continue;
                }
                if patches > PATCHES {
                    first = patch.from;
                } else if gap - clear > fine && patch.to - patch.from > SHORTEST {
                    let (along_way, along_cell) = patch.extents();
                    let [early, late] = if along_way > along_cell { patch.halves() } else { patch.parts() };
                    left.extend([late, early]);
                }
            }
        }
        first.is_finite().then_some(first)
    }
}

impl ContactEffect for ContactIntegral {
    fn intervals(&self, q: &[f64]) -> usize {
        let (mut count, mut last) = (0, f64::NEG_INFINITY);
        self.for_near(q, |cell, curve| {
            self.for_pieces(curve, |from, to| {
                let start = cell as f64 + from;
                count += usize::from(start - last > SHORTEST * self.cells.count() as f64);
                last = cell as f64 + to;
            });
        });
        count
    }

    fn resultant(&self, q: &[f64]) -> Option<[f64; 2]> {
        let (mut sum, mut touches) = (Vector2::zeros(), false);
        self.for_near(q, |cell, curve| {
            self.for_spots(cell, curve, |spot| {
                let [force] = self.penalty.gradient(0, &[spot.r]);
                sum -= force * spot.weight;
                touches = true;
            });
        });
        touches.then(|| sum.into())
    }

    fn first_touch(&self, way: CubicStates<'_>) -> Option<f64> {
        let shortest =
            (0..self.cells.count()).map(|cell| self.cells.length(cell)).fold(f64::INFINITY, f64::min);
        self.first_deeper(way, GRAZE * shortest, GRAZE * shortest)
    }

    fn lies_along(&self, q: &[f64], near: f64) -> bool {
        let at_border = |r: &Vector2<f64>| self.penalty.gap_at(r).abs() <= near;
        (0..self.cells.count()).any(|cell| {
            let curve = self.cells.curve(cell, q);
            let ends = [curve.points().first(), curve.points().last()];
            at_border(&curve.middle()) && ends.into_iter().flatten().any(at_border)
        })
    }

    fn is_deep(&self, way: CubicStates<'_>) -> bool {
        let deepest = self.penalty.obstacle.deepest(self.penalty.gap);
        deepest.is_finite() && self.first_deeper(way, DEEPER * deepest, FINE * deepest).is_some()
    }

    fn conflict(&self, way: CubicStates<'_>, may_cross: bool) -> Option<f64> {
        let deepest = self.penalty.obstacle.deepest(self.penalty.gap);
        let largest = if may_cross { f64::INFINITY } else { MIDDLE * deepest };
        let level = (self.depth(way[0]) + DEEPER * deepest).min(largest);
        self.first_deeper(way, level, FINE * deepest)
    }

    fn crosses(&self, way: CubicStates<'_>) -> bool {
        let deepest = self.penalty.obstacle.deepest(self.penalty.gap);
        self.first_deeper(way, MIDDLE * deepest, FINE * deepest).is_some()
    }
}

/// Fraction of a cell's length to which the beginning of a contact on the path is resolved.
const GRAZE: f64 = 1e-6;
/// Fraction of half an obstacle's thickness by which a step may carry a beam deeper into it.
const DEEPER: f64 = 0.25;
/// Fraction of half an obstacle's thickness at which the beam counts as crossing it.
const MIDDLE: f64 = 0.95;
/// Fraction of half an obstacle's thickness to which the depth on the path is resolved.
const FINE: f64 = 1e-2;
