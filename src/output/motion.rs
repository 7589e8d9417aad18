//! The data of the moving picture in the report: positions as whole numbers on a grid much finer
//! than a screen, so that a page with hundreds of frames stays small.

use serde::Serialize;

use super::mode::{Displaced, displaced};
use super::plot::human;
use super::tables::parameter_name;
use crate::results::{AnalysisKind, Results, Shape};

/// Cells of the grid along the longer side of the picture.
const CELLS: f64 = 8000.0;
/// Coordinates in all; each takes about five characters.
const COORDINATES: usize = 200_000;
/// Part of the beams' extent by which the picture may grow to show obstacles.
const GROUND: f64 = 0.25;
/// Points of a beam in a mode shape.
const MODE_POINTS: usize = 101;

/// Polylines as x₀, y₀, x₁, y₁ … in grid cells, one a beam.
type Lines = Vec<Vec<i32>>;

#[derive(Serialize)]
pub(super) struct Motion {
    /// Whether the frames are vibrations about rest; otherwise they follow each other.
    vibration: bool,
    /// Name of the parameter.
    name: &'static str,
    unit: &'static str,
    /// Position \[m\] of cell (0, 0).
    origin: [f64; 2],
    /// Side of a cell \[m\].
    cell: f64,
    /// Size of the picture in cells.
    size: [i32; 2],
    /// Load factor, time, frequency of each frame.
    parameter: Vec<f64>,
    /// What to write below each frame, where the frames are those of several analyses; else empty.
    labels: Vec<String>,
    /// Borders of obstacles.
    ground: Lines,
    rest: Lines,
    frames: Vec<Lines>,
}

type Polyline = Vec<[f64; 2]>;

/// Name and unit of the parameter of frames.
fn parameter_words(analysis: AnalysisKind) -> (&'static str, &'static str) {
    match analysis {
        AnalysisKind::Static => ("load factor", ""),
        AnalysisKind::Buckling => ("load factor of mode", ""),
        AnalysisKind::Modal => ("frequency of mode", "Hz"),
        AnalysisKind::Dynamic => (parameter_name(analysis), "s"),
    }
}

fn polyline(shape: &Shape) -> Polyline {
    thinned(&shape.x.iter().zip(&shape.y).map(|(&x, &y)| [x, y]).collect::<Vec<_>>())
}

fn thinned(points: &[[f64; 2]]) -> Polyline {
    every(points, points.len().div_ceil(MODE_POINTS).max(1))
}

/// Every `stride`th entry, and the last one.
fn every<T: Clone>(all: &[T], stride: usize) -> Vec<T> {
    let last = all.len().saturating_sub(1);
    all.iter().enumerate().filter(|(i, _)| i % stride == 0 || *i == last).map(|(_, v)| v.clone()).collect()
}

impl Motion {
    /// The frames of a trajectory, or the mode shapes; of several stages, by name, all frames but
    /// those of vibrations, one after the other. `None` where nothing moves.
    pub(super) fn of(stages: &[(&str, &Results)]) -> Option<Self> {
        let (_, first) = stages.first()?;
        let t = first.states();
        let vibrates = |results: &Results| {
            matches!(results.run().analysis, AnalysisKind::Modal | AnalysisKind::Buckling)
        };
        let vibration = stages.len() == 1 && vibrates(first);
        let rest = if vibration { &t.last } else { &t.run.undeformed };
        let rest: Vec<Polyline> = rest.iter().map(polyline).collect();
        let (mut parameter, mut frames, mut labels) = (Vec::new(), Vec::<Vec<Polyline>>::new(), Vec::new());
        if vibration {
            let line = |beam: &Displaced| thinned(&beam.line);
            let frame = |mode| displaced(&t.last, mode).iter().map(line).collect();
            parameter = first.eigenvalues();
            frames.extend(first.mode_shapes().into_iter().map(frame));
        } else {
            let moving: Vec<_> = stages.iter().filter(|(_, results)| !vibrates(results)).collect();
            let all = moving.iter().flat_map(|(_, results)| &results.states().frames);
            let coordinates: usize = all.clone().flat_map(|f| &f.beams).map(|b| 2 * b.len()).sum();
            // First fewer frames, as long as a hundred stay; then fewer points.
            let fewer = coordinates.div_ceil(COORDINATES).max(1);
            let frame_stride = fewer.min((all.count() / 100).max(1));
            let point_stride = fewer.div_ceil(frame_stride);
            for (stage, results) in moving {
                let t = results.states();
                let (name, unit) = parameter_words(t.run.analysis);
                for frame in every(&t.frames, frame_stride) {
                    parameter.push(frame.parameter);
                    frames.push(frame.beams.iter().map(|b| every(b, point_stride)).collect());
                    if stages.len() > 1 {
                        labels.push(format!("{stage}: {name} {} {unit}", human(frame.parameter, 5)));
                    }
                }
            }
        }
        if frames.is_empty() {
            return None;
        }
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in
            rest.iter().chain(frames.iter().flatten()).flatten().filter(|p| p.iter().all(|c| c.is_finite()))
        {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let extent = |low: [f64; 2], high: [f64; 2]| [high[0] - low[0], high[1] - low[1]];
        let longest = |[width, height]: [f64; 2]| width.max(height);
        // Only obstacles near the beams enlarge the picture: a plane has no end.
        let margin = GROUND * longest(extent(low, high));
        let (nearest, farthest) = (low.map(|c| c - margin), high.map(|c| c + margin));
        let near = |p: &&[f64; 2]| (0..2).all(|axis| (nearest[axis]..=farthest[axis]).contains(&p[axis]));
        let mut outlines: Vec<Polyline> = Vec::new();
        for line in stages.iter().flat_map(|(_, results)| &results.run().outlines) {
            if !outlines.contains(line) {
                outlines.push(line.clone());
            }
        }
        for point in outlines.iter().flatten().filter(near) {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let sides = extent(low, high);
        let longer = longest(sides);
        if !(longer.is_finite() && longer > 0.0) {
            return None;
        }
        let cell = longer / CELLS;
        // A vibration swings to both sides, a mode shape shows one.
        let swing = if vibration { 0.22 * longer } else { 0.0 };
        let origin = [low[0] - swing.min(0.1 * longer), low[1] - swing];
        let size = [sides[0] + 2.0 * (low[0] - origin[0]), sides[1] + 2.0 * swing]
            .map(|side| (side / cell).round() as i32);
        let cells = |lines: &Vec<Polyline>| -> Lines {
            let number = |(axis, c): (usize, &f64)| ((c - origin[axis]) / cell).round() as i32;
            lines
                .iter()
                .map(|line| line.iter().flat_map(|p| p.iter().enumerate().map(number)).collect())
                .collect()
        };
        let (name, unit) = parameter_words(t.run.analysis);
        Some(Self {
            vibration,
            name,
            unit,
            origin,
            cell,
            size,
            parameter,
            labels,
            ground: cells(&outlines),
            rest: cells(&rest),
            frames: frames.iter().map(cells).collect(),
        })
    }

    /// JSON that may stand inside a `script` element.
    pub(super) fn to_json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string(self)?.replace('<', "\\u003c"))
    }
}
