//! Which plots show a trajectory.

use super::error::OutputError;
use super::mode::displaced;
use super::plot::{Axis, Chart, Colour, GREY, Mark, PALETTE, PlotError, Series, colour, grid, human};
use crate::results::{AnalysisKind, BeamErrors, ProbeSample, Results, SectionForces, Shape, Trajectory};

/// A drawn plot with the words below it.
#[derive(Clone)]
pub(super) struct Figure {
    /// File name without extension.
    pub(super) name: &'static str,
    pub(super) caption: String,
    pub(super) svg: String,
}

/// A quantity along a beam.
type Along = fn(&Shape) -> &Vec<f64>;

/// The estimated error of a quantity along a beam.
type ErrorAlong = fn(&BeamErrors) -> &Vec<f64>;

/// Two quantities of a probe with their names.
type Pair = [(&'static str, fn(&ProbeSample) -> f64); 2];

/// A plot that is not yet drawn.
struct Sketch {
    name: &'static str,
    caption: String,
    charts: Vec<Chart>,
}

impl Sketch {
    fn one(name: &'static str, caption: impl Into<String>, chart: Chart) -> Self {
        Self { name, caption: caption.into(), charts: vec![chart] }
    }

    fn draw(self) -> Result<Figure, OutputError> {
        let drawn: Result<String, PlotError> = match self.charts.as_slice() {
            [chart] => chart.svg(),
            charts => grid(charts, 2),
        };
        let svg = drawn.map_err(|source| OutputError::Plot { name: format!("{}.svg", self.name), source })?;
        Ok(Figure { name: self.name, caption: self.caption, svg })
    }
}

/// Size of a plot that stands beside another one \[px\].
const SMALL: (u32, u32) = (540, 300);

/// All plots of the results, the most telling first.
pub(super) fn figures(results: &Results) -> Result<Vec<Figure>, OutputError> {
    let t = results.states();
    let mut sketches = vec![modes(results), shape(t)];
    sketches.extend(along(t));
    sketches.push(stress(t));
    sketches.push(error(t));
    sketches.push(position(t));
    sketches.push(angle(t));
    sketches.push(velocity(t));
    sketches.extend(section_forces(t));
    sketches.push(energy(t));
    sketches.push(convergence(t));
    sketches.push(steps(t));
    sketches.push(newton(t));
    sketches.into_iter().flatten().map(Sketch::draw).collect()
}

/// The axis of the parameter by which records are ordered.
fn parameter_axis(t: &Trajectory) -> Axis {
    match t.run.analysis {
        AnalysisKind::Static | AnalysisKind::Modal => Axis::linear("load factor"),
        AnalysisKind::Dynamic => Axis::linear("time [s]"),
        AnalysisKind::Buckling => Axis::linear("mode").whole(),
    }
}

/// Load factor or time of the last record, in words.
fn moment(t: &Trajectory) -> String {
    match (t.run.analysis, t.parameter.last()) {
        (AnalysisKind::Static | AnalysisKind::Modal, Some(&load)) => {
            format!("at load factor {}", human(load, 6))
        }
        (AnalysisKind::Dynamic, Some(&time)) => format!("at {} s", human(time, 6)),
        _ => "in the reference state".into(),
    }
}

fn centreline(shape: &Shape) -> Vec<[f64; 2]> {
    shape.x.iter().zip(&shape.y).map(|(&x, &y)| [x, y]).collect()
}

/// Length of the longest beam \[m\].
fn length(t: &Trajectory) -> f64 {
    let lengths = t.run.undeformed.iter().chain(&t.last).filter_map(|b| Some(b.s.last()? - b.s.first()?));
    lengths.filter(|l| l.is_finite()).fold(0.0, f64::max)
}

/// Positions below this are drawn as zero \[m\].
fn negligible(t: &Trajectory) -> f64 {
    1e-9 * length(t)
}

fn undeformed(t: &Trajectory) -> impl Iterator<Item = Series> + '_ {
    t.run.undeformed.iter().enumerate().map(|(i, beam)| {
        let label = if i == 0 { "undeformed" } else { "" };
        Series::dashed(label, centreline(beam), GREY)
    })
}

/// `count` or fewer of `0..length`, evenly, without the last.
fn selection(length: usize, count: usize) -> impl Iterator<Item = usize> {
    let stride = length.div_ceil(count).max(1);
    (0..length.saturating_sub(1)).step_by(stride)
}

/// The last state in front of the undeformed beams, with states on the way.
fn shape(t: &Trajectory) -> Option<Sketch> {
    if t.last.is_empty() || t.parameter.is_empty() {
        return None;
    }
    let mut chart = Chart::new("", Axis::linear("x [m]"), Axis::linear("y [m]")).equal_aspect(620);
    for (i, outline) in t.run.outlines.iter().enumerate() {
        let label = if i == 0 { "obstacle" } else { "" };
        chart = chart.with(Series::line(label, outline.clone(), GREY).size(1.6));
    }
    let mut label = "on the way";
    for i in selection(t.frames.len(), 24) {
        for points in &t.frames[i].beams {
            chart = chart.with(Series::line(label, points.clone(), PALETTE[5]).size(1.0).opacity(0.5));
            label = "";
        }
    }
    for series in undeformed(t) {
        chart = chart.with(series);
    }
    if t.run.analysis == AnalysisKind::Dynamic {
        for probe in &t.probes {
            let path = probe.samples.iter().map(|s| [s.x, s.y]).collect();
            let label = format!("path of {}", probe.name);
            chart = chart.with(Series::line(label, path, PALETTE[1]).size(0.9).opacity(0.8));
        }
    }
    let several = t.last.len() > 1;
    for (i, beam) in t.last.iter().enumerate() {
        let label = if several { beam.beam.clone() } else { "deformed".into() };
        chart = chart.with(Series::line(label, centreline(beam), colour_of_beam(i)).size(2.2));
    }
    for (i, beam) in t.last.iter().enumerate() {
        for face in surfaces(beam) {
            chart = chart.with(Series::line("", face, colour_of_beam(i)).size(0.9));
        }
    }
    let tendons = t.last.iter().flat_map(|beam| &beam.tendons);
    for (line, label) in tendons.zip(std::iter::once("tendon").chain(std::iter::repeat(""))) {
        chart = chart.with(Series::line(label, line.clone(), GREY).size(1.4));
    }
    for (i, beam) in t.last.iter().enumerate() {
        let label = if i == 0 { "nodes" } else { "" };
        let radius = if beam.nodes.len() > 60 { 1.8 } else { 3.2 };
        chart = chart.with(Series::points(label, beam.nodes.clone(), colour_of_beam(i)).size(radius));
    }
    Some(Sketch::one("shape", format!("Shape {}, in true proportion.", moment(t)), chart))
}

/// The outer faces of a beam whose section tells its shape.
fn surfaces(beam: &Shape) -> Vec<Vec<[f64; 2]>> {
    let face = |side: usize| (0..beam.faces.len()).map(|i| beam.beside(i, beam.faces[i][side])).collect();
    if beam.faces.is_empty() { Vec::new() } else { vec![face(0), face(1)] }
}

/// The colour of a beam; it is never that of the states on the way.
fn colour_of_beam(index: usize) -> Colour {
    [PALETTE[0], PALETTE[1], PALETTE[2], PALETTE[3], PALETTE[4], PALETTE[6]][index % 6]
}

/// Curvature and strain along the arc length.
fn along(t: &Trajectory) -> [Option<Sketch>; 2] {
    let sketch = |name, title: &str, axis: Axis, unit: &str, values: Along, errors: Option<ErrorAlong>| {
        if t.last.is_empty() || t.parameter.is_empty() {
            return None;
        }
        let mut chart = Chart::new("", Axis::linear("arc length s [m]"), axis).sized(SMALL.0, SMALL.1);
        let mut largest = 0.0_f64;
        for (i, beam) in t.last.iter().enumerate() {
            let points: Vec<[f64; 2]> = beam.s.iter().zip(values(beam)).map(|(&s, &v)| [s, v]).collect();
            largest = points.iter().fold(largest, |m, p| m.max(p[1].abs()));
            let label = if t.last.len() > 1 { beam.beam.as_str() } else { "" };
            let error = t.run.error.as_ref().and_then(|error| error.beams.get(i));
            if let (Some(error), Some(of)) = (error, errors) {
                let known = |s: f64| nearest(&error.s, of(error), s);
                let side = |sign: f64| points.iter().map(|&[s, v]| [s, v + sign * known(s)]).collect();
                chart = chart.with(Series::band("", side(-1.0), side(1.0), colour_of_beam(i)));
            }
            chart = chart.with(Series::line(label, points, colour_of_beam(i)));
        }
        let caption = format!("{title} {}; largest magnitude {}{unit}.", moment(t), human(largest, 5));
        Some(Sketch::one(name, caption, chart))
    };
    // A strain of 1e-9, or a bending radius of 1e9 lengths, is no deformation.
    let straight = if length(t) > 0.0 { 1e-9 / length(t) } else { 0.0 };
    let curvature = Axis::linear("curvature κ [1/m]").negligible(straight);
    let strain = Axis::linear("axial strain ε [–]").negligible(1e-9);
    [
        sketch("curvature", "Curvature", curvature, " 1/m", |b| &b.curvature, Some(|e| &e.curvature)),
        sketch("strain", "Axial strain", strain, "", |b| &b.strain, None),
    ]
}

/// What the sections at the probes carry, over the parameter.
fn section_forces(t: &Trajectory) -> [Option<Sketch>; 3] {
    type Quantity = fn(&SectionForces) -> Option<f64>;
    let sketch = |name, caption: &str, axis: &str, quantities: &[(&str, Quantity)]| {
        if t.parameter.len() < 2 || t.sections.is_empty() {
            return None;
        }
        let mut chart = Chart::new("", parameter_axis(t), Axis::linear(axis)).sized(SMALL.0, SMALL.1);
        let mut known = false;
        for (i, series) in t.sections.iter().enumerate() {
            for (dashed, (name, value)) in [false, true].into_iter().zip(quantities) {
                let values: Option<Vec<f64>> = series.samples.iter().map(value).collect();
                let Some(values) = values else { continue };
                let label = format!("{} {name}", series.name);
                let points = over_parameter(t, values.into_iter());
                chart = chart.with(match dashed {
                    true => Series::dashed(label, points, colour(i)),
                    false => Series::line(label, points, colour(i)),
                });
                known = true;
            }
        }
        known.then(|| Sketch::one(name, caption, chart))
    };
    [
        sketch(
            "forces",
            "Axial force N and shear force Q of the sections at the probes.",
            "force [N]",
            &[("N", |f| Some(f.axial_force)), ("Q", |f| Some(f.shear_force))],
        ),
        sketch(
            "moments",
            "Bending moment of the sections at the probes.",
            "bending moment [N m]",
            &[("M", |f| Some(f.bending_moment))],
        ),
        sketch(
            "stresses",
            "Stresses on the faces of the sections at the probes.",
            "stress [Pa]",
            &[("top", |f| f.stress_top), ("bottom", |f| f.stress_bottom)],
        ),
    ]
}

/// Stresses on the outer faces along the arc length.
fn stress(t: &Trajectory) -> Option<Sketch> {
    let largest = t.last.iter().filter_map(Shape::largest_stress);
    let largest = largest.max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))?;
    let axis = Axis::linear("stress σ [Pa]");
    let mut chart = Chart::new("", Axis::linear("arc length s [m]"), axis).sized(SMALL.0, SMALL.1);
    for (i, beam) in t.last.iter().enumerate() {
        let Some([bottom, top]) = beam.face_stresses() else { continue };
        let name = |face: &str| {
            if t.last.len() > 1 { format!("{}, {face}", beam.beam) } else { face.to_owned() }
        };
        let line = |values: &[f64]| beam.s.iter().zip(values).map(|(&s, &v)| [s, v]).collect();
        chart = chart.with(Series::line(name("top"), line(top), colour_of_beam(i))).with(Series::dashed(
            name("bottom"),
            line(bottom),
            colour_of_beam(i),
        ));
    }
    let layer = if t.last.iter().any(|shape| shape.stress.len() > 1) {
        format!(", layer {}", largest.layer)
    } else {
        String::new()
    };
    let caption = format!(
        "Stress {} on the faces to the left (top) and to the right (bottom) of the centreline; the largest is {} Pa, at s = {} m of {}{layer}, {}.",
        moment(t),
        human(largest.value, 5),
        human(largest.s, 4),
        largest.beam,
        largest.face
    );
    Some(Sketch::one("stress", caption, chart))
}

/// The larger of the values at the places before and behind `s`.
fn nearest(places: &[f64], values: &[f64], s: f64) -> f64 {
    let behind = places.partition_point(|place| *place < s);
    let at = |i: usize| values.get(i).copied().unwrap_or(0.0);
    at(behind).max(behind.checked_sub(1).map_or(0.0, at))
}

/// Where along the beams and when the estimated error of positions is.
fn error(t: &Trajectory) -> Option<Sketch> {
    let error = t.run.error.as_ref().filter(|error| !error.beams.is_empty())?;
    let axis = || Axis::log("error of positions [beam lengths]");
    let mut along = Chart::new("", Axis::linear("arc length s [m]"), axis()).sized(SMALL.0, SMALL.1);
    for (i, beam) in error.beams.iter().enumerate() {
        let points = beam.s.iter().zip(&beam.position).map(|(&s, &v)| [s, v]).collect();
        let label = if error.beams.len() > 1 { beam.beam.as_str() } else { "" };
        along = along.with(Series::line(label, points, colour_of_beam(i)));
    }
    let mut charts = vec![along];
    let records = over_parameter(t, error.records.iter().copied());
    if records.len() > 1 {
        let chart = Chart::new("", parameter_axis(t), axis()).sized(SMALL.0, SMALL.1);
        let mut chart =
            with_dots(chart, &records, PALETTE[0]).with(Series::line("largest", records, PALETTE[0]));
        if let (Some(wanted), [first, .., last]) = (error.wanted, &t.parameter[..]) {
            let level = vec![[*first, wanted.result], [*last, wanted.result]];
            chart = chart.with(Series::dashed("wanted", level, GREY));
        }
        charts.push(chart);
    }
    let caption = match charts.len() {
        1 => "Estimated error of positions along the beams, the largest of all records.",
        _ => {
            "Estimated error of positions: along the beams, the largest of all records; and at each record, the largest of all beams."
        }
    };
    let drawn = error.estimated.result > 0.0;
    drawn.then(|| Sketch { name: "error", caption: caption.into(), charts })
}

fn over_parameter(t: &Trajectory, values: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    t.parameter.iter().zip(values).map(|(&p, v)| [p, v]).collect()
}

/// Up to this many records each has a dot: the line between few records is only a guide.
const DOTS: usize = 60;

/// The chart with dots at the records, where these are few, or some are unknown: no line leads to one between unknown ones.
fn with_dots(chart: Chart, points: &[[f64; 2]], colour: Colour) -> Chart {
    if points.len() > DOTS && points.iter().all(|point| point[1].is_finite()) {
        return chart;
    }
    chart.with(Series::points("", points.to_vec(), colour).size(1.8))
}

/// Two quantities of each probe over the parameter, drawn as a line and dashed.
fn probes(t: &Trajectory, axis: Axis, pair: Pair) -> Option<Chart> {
    if t.parameter.len() < 2 || t.probes.is_empty() {
        return None;
    }
    let mut chart = Chart::new("", parameter_axis(t), axis).sized(SMALL.0, SMALL.1);
    for (i, probe) in t.probes.iter().enumerate() {
        for (mark, (name, value)) in [Mark::Line, Mark::Dashed].into_iter().zip(pair) {
            let points = over_parameter(t, probe.samples.iter().map(value));
            if let Some(error) = t.run.error.as_ref().and_then(|error| error.probes.get(i)) {
                let side = |sign: f64| {
                    let of = |(p, e): (&[f64; 2], &ProbeSample)| [p[0], p[1] + sign * value(e)];
                    points.iter().zip(&error.samples).map(of).collect()
                };
                chart = chart.with(Series::band("", side(-1.0), side(1.0), colour(i)));
            }
            chart = with_dots(chart, &points, colour(i));
            chart = chart.with(Series::new(format!("{}.{name}", probe.name), points, mark, colour(i)));
        }
    }
    Some(chart)
}

fn position(t: &Trajectory) -> Option<Sketch> {
    let axis = Axis::linear("position [m]").negligible(negligible(t));
    Some(Sketch::one(
        "position",
        "Position of the probes.",
        probes(t, axis, [("x", |s| s.x), ("y", |s| s.y)])?,
    ))
}

fn velocity(t: &Trajectory) -> Option<Sketch> {
    if t.run.analysis != AnalysisKind::Dynamic {
        return None;
    }
    let pair: Pair = [("vx", |s| s.vx.unwrap_or(f64::NAN)), ("vy", |s| s.vy.unwrap_or(f64::NAN))];
    let chart = probes(t, Axis::linear("velocity [m/s]"), pair)?;
    Some(Sketch::one("velocity", "Velocity of the probes.", chart))
}

fn angle(t: &Trajectory) -> Option<Sketch> {
    if t.parameter.len() < 2 || t.probes.is_empty() {
        return None;
    }
    let axis = Axis::linear("direction of r′ [°]").negligible(1e-7);
    let mut chart = Chart::new("", parameter_axis(t), axis).sized(SMALL.0, SMALL.1);
    for (i, probe) in t.probes.iter().enumerate() {
        let points = over_parameter(t, probe.samples.iter().map(|s| s.angle.to_degrees()));
        chart = with_dots(chart, &points, colour(i));
        chart = chart.with(Series::line(probe.name.clone(), points, colour(i)));
    }
    Some(Sketch::one(
        "angle",
        "Direction of the centreline at the probes, continuous over full turns.",
        chart,
    ))
}

fn energy(t: &Trajectory) -> Option<Sketch> {
    if t.parameter.len() < 2 || t.energy.is_empty() {
        return None;
    }
    let part = |f: fn(&crate::results::Energy) -> f64| over_parameter(t, t.energy.iter().map(f));
    let parts = [
        ("stretch", part(|e| e.stretch), PALETTE[2]),
        ("bend", part(|e| e.bend), PALETTE[0]),
        ("kinetic", part(|e| e.kinetic), PALETTE[1]),
        ("potential", part(|e| e.potential), PALETTE[3]),
        ("work of loads", part(|e| e.work), PALETTE[4]),
        ("springs and contacts", part(|e| e.stored), PALETTE[5]),
        ("lost", part(|e| e.lost), PALETTE[7]),
    ];
    let size = |points: &[[f64; 2]]| points.iter().fold(0.0_f64, |m, p| m.max(p[1].abs()));
    let largest = parts.iter().fold(0.0_f64, |m, (_, points, _)| m.max(size(points)));
    let axis = Axis::linear("energy [J]").negligible(1e-12 * largest);
    let mut chart = Chart::new("", parameter_axis(t), axis).sized(SMALL.0, SMALL.1);
    for (name, points, colour) in parts {
        // An energy that is not simulated is zero throughout and would only hide the others.
        if size(&points) > 0.0 {
            chart = with_dots(chart, &points, colour);
            chart = chart.with(Series::line(name, points, colour));
        }
    }
    chart = chart.with(Series::dashed("total", part(crate::results::Energy::total), PALETTE[6]));
    let caption = match super::summary::drift(&t.energy) {
        Some(drift) => {
            format!(
                "Energies; the total departs from its first value by {} of the largest kinetic energy.",
                human(drift, 3)
            )
        }
        None => "Energies of the equilibria.".into(),
    };
    Some(Sketch::one("energy", caption, chart))
}

/// Up to this many iterations each is shown.
const ITERATIONS: usize = 400;

fn convergence(t: &Trajectory) -> Option<Sketch> {
    let total: usize = t.history.iter().map(|s| s.increments.len().max(s.residuals.len())).sum();
    match total {
        0 => None,
        1..=ITERATIONS => Some(iterations(t)),
        _ => Some(last_iterations(t)),
    }
}

/// Every Newton iteration of every step, side by side.
fn iterations(t: &Trajectory) -> Sketch {
    let gap = [f64::NAN; 2];
    let [mut increments, mut residuals, mut rejected] = [const { Vec::new() }; 3];
    let (mut first, mut separators) = (1.0, Vec::new());
    for step in &t.history {
        let count = step.increments.len().max(step.residuals.len());
        if count == 0 {
            continue;
        }
        let numbered = |values: &[f64]| {
            values.iter().enumerate().map(|(i, &v)| [first + i as f64, v]).collect::<Vec<_>>()
        };
        if step.accepted {
            increments.extend(numbered(&step.increments));
            residuals.extend(numbered(&step.residuals));
        } else {
            rejected.extend(numbered(&step.increments));
            rejected.push(gap);
            rejected.extend(numbered(&step.residuals));
        }
        for series in [&mut increments, &mut residuals, &mut rejected] {
            series.push(gap);
        }
        first += count as f64;
        separators.push(first - 0.5);
    }
    separators.pop();
    let steps = separators.len() + 1;
    let axis = Axis::linear("Newton iteration, counted through").whole();
    let mut chart = Chart::new("", axis, Axis::log("scaled size [–]")).sized(SMALL.0, SMALL.1);
    let radius = if first > 120.0 { 1.8 } else { 2.6 };
    for (label, points, colour) in [
        ("increment", increments, PALETTE[0]),
        ("residual", residuals, PALETTE[4]),
        ("rejected steps", rejected, PALETTE[1]),
    ] {
        if points.iter().any(|p| p[1].is_finite()) {
            chart = chart.with(Series::line("", points.clone(), colour).size(1.2).opacity(0.8));
            chart = chart.with(Series::points(label, points, colour).size(radius));
        }
    }
    if separators.len() <= 150 {
        chart.separators = separators;
    }
    let caption = format!(
        "Convergence: scaled increment and residual at every Newton iteration; {steps} step{} between the vertical lines.",
        if steps == 1 { "" } else { "s" }
    );
    Sketch::one("convergence", caption, chart)
}

/// First and last iteration of every step, where there are too many to show each.
fn last_iterations(t: &Trajectory) -> Sketch {
    let pick = |values: fn(&crate::results::StepRecord) -> Option<&f64>| -> Vec<[f64; 2]> {
        let kept: Vec<_> = t.history.iter().filter(|s| s.accepted).collect();
        // More marks than this would overlap.
        let stride = kept.len().div_ceil(1200).max(1);
        kept.iter().step_by(stride).filter_map(|s| Some([s.parameter, *values(s)?])).collect()
    };
    let chart = Chart::new("", parameter_axis(t), Axis::log("scaled size [–]"))
        .sized(SMALL.0, SMALL.1)
        .with(Series::points("first increment", pick(|s| s.increments.first()), PALETTE[5]).size(1.6))
        .with(Series::points("last increment", pick(|s| s.increments.last()), PALETTE[0]).size(1.6))
        .with(Series::points("last residual", pick(|s| s.residuals.last()), PALETTE[4]).size(1.6));
    let caption = "Convergence: scaled increment at the first Newton iteration of every step, increment and residual at the last.";
    Sketch::one("convergence", caption, chart)
}

fn steps(t: &Trajectory) -> Option<Sketch> {
    let points = |accepted: bool| -> Vec<[f64; 2]> {
        t.history.iter().filter(|s| s.accepted == accepted).map(|s| [s.parameter, s.step.abs()]).collect()
    };
    let (kept, rejected) = (points(true), points(false));
    if kept.len() < 2 {
        return None;
    }
    let sizes = || kept.iter().chain(&rejected).map(|p| p[1]).filter(|s| *s > 0.0);
    let (least, largest) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let label = if t.run.analysis == AnalysisKind::Dynamic { "step [s]" } else { "step" };
    let axis = if largest > 5.0 * least { Axis::log(label) } else { Axis::linear(label) };
    let mut chart = Chart::new("", parameter_axis(t), axis).sized(SMALL.0, SMALL.1);
    if kept.len() <= 300 {
        chart = chart.with(Series::points("", kept.clone(), PALETTE[0]));
    }
    chart = chart.with(Series::line("accepted", kept, PALETTE[0]).size(1.3));
    if !rejected.is_empty() {
        chart = chart.with(Series::new("rejected", rejected, Mark::Crosses, PALETTE[1]));
    }
    Some(Sketch::one("steps", "Size of the steps that the solver took.", chart))
}

/// Newton iterations of every time step: where they grow, the steps are as long as the motion
/// allows.
fn newton(t: &Trajectory) -> Option<Sketch> {
    if t.run.analysis != AnalysisKind::Dynamic {
        return None;
    }
    let points = |accepted: bool| -> Vec<[f64; 2]> {
        let steps = t.history.iter().filter(|s| s.accepted == accepted && !s.increments.is_empty());
        steps.map(|s| [s.parameter, s.increments.len() as f64]).collect()
    };
    let (kept, rejected) = (points(true), points(false));
    if kept.len() < 2 {
        return None;
    }
    let total: f64 = kept.iter().map(|p| p[1]).sum();
    let mean = human(total / kept.len() as f64, 3);
    let caption = format!("Newton iterations of every step; {mean} a step on average.");
    let axis = Axis::linear("Newton iterations").whole();
    let mut chart = Chart::new("", parameter_axis(t), axis).sized(SMALL.0, SMALL.1);
    chart = chart.with(Series::points("accepted", kept, PALETTE[0]).size(1.6));
    if !rejected.is_empty() {
        chart = chart.with(Series::new("rejected", rejected, Mark::Crosses, PALETTE[1]));
    }
    Some(Sketch::one("newton", caption, chart))
}

/// Mode shapes, one small plot each.
fn modes(results: &Results) -> Option<Sketch> {
    let (t, modes) = (results.states(), results.mode_shapes());
    if modes.is_empty() {
        return None;
    }
    let charts = modes.into_iter().zip(results.eigenvalues()).enumerate().map(|(i, (mode, value))| {
        let value = match t.run.analysis {
            AnalysisKind::Buckling => format!("load factor {}", human(value, 6)),
            _ => format!("{} Hz", human(value, 6)),
        };
        let mut chart =
            Chart::new(format!("mode {}: {value}", i + 1), Axis::linear("x [m]"), Axis::linear("y [m]"));
        for beam in &t.last {
            chart = chart.with(Series::dashed("", centreline(beam), GREY));
        }
        for (j, beam) in displaced(&t.last, mode).iter().enumerate() {
            chart = chart.with(Series::line("", beam.line.clone(), colour_of_beam(j)));
            if beam.nodes.len() <= 60 {
                chart = chart.with(Series::points("", beam.nodes.clone(), colour_of_beam(j)).size(2.0));
            }
        }
        chart.sized(460, 300).equal_aspect(300)
    });
    let rest = if t.parameter.is_empty() { "undeformed" } else { "the equilibrium" };
    let caption =
        format!("Mode shapes in true proportion; their size is chosen for drawing. Dashed: {rest}.");
    Some(Sketch { name: "modes", caption, charts: charts.collect() })
}
