//! Drawings of a case page: the figures that `case.toml` asks for, and for every check along a
//! curve our curve upon the reference and their difference.

use ancf::output::plot::{Axis, Chart, Colour, Mark, PALETTE, Series};
use ancf_check::case::{Check, Curve, Figure, Line, Scalar};
use ancf_check::compare::filled;
use ancf_check::execute::Run;
use ancf_check::quantity::values;
use ancf_check::{Examined, Outcome};

/// A drawing and the words below it.
pub struct FigureView {
    pub title: String,
    pub caption: String,
    /// `<svg>…</svg>`, or why there is none.
    pub drawing: Result<String, String>,
}

type Points = Vec<[f64; 2]>;

/// The last colour, for references.
const INK: usize = PALETTE.len() - 1;
/// Size of a drawing without its legend, and the largest height of one in true proportion \[px\].
const WIDTH: u32 = 540;
const HEIGHT: u32 = 310;
const HIGHEST: u32 = 460;
/// More marks than this hide each other.
const MARKS: usize = 30;
/// Below this a difference is round-off, of which a drawing shows nothing.
const ROUND_OFF: f64 = 1e-13;

/// A figure that `case.toml` asks for.
pub fn of_case(examined: &Examined, figure: &Figure) -> FigureView {
    let axis = |label: &str| if figure.logarithmic { Axis::log(label) } else { Axis::linear(label) };
    let drawing = curves(examined, &figure.curve)
        .and_then(|series| draw(axis(&figure.x), axis(&figure.y), figure.equal, series));
    FigureView { title: figure.title.clone(), caption: figure.caption.clone(), drawing }
}

/// The drawings of a check: errors over the variable of an order; or along a curve, ours upon the
/// reference, and the error.
pub fn of_check(examined: &Examined, check: &Check, outcomes: &[&Outcome]) -> Vec<FigureView> {
    if check.order.is_some() {
        return convergence(examined, check, outcomes).into_iter().collect();
    }
    let (mut overlay, difference) = (overlay(examined, check, outcomes), difference(check, outcomes));
    if let (Some(overlay), None) = (&mut overlay, &difference) {
        overlay.caption.push_str(" They differ by round-off.");
    }
    overlay.into_iter().chain(difference).collect()
}

/// Axes, and room for the legend above them.
fn draw(x: Axis, y: Axis, equal: bool, series: Vec<Series>) -> Result<String, String> {
    if series.iter().flat_map(|s| &s.points).all(|p| p.iter().any(|v| !v.is_finite())) {
        return Err("there is nothing to draw".into());
    }
    /// Sample, gaps and width of a letter in a legend, and height of its lines \[px\].
    const LEGEND: [usize; 3] = [44, 7, 20];
    let named = series.iter().filter(|s| !s.label.is_empty());
    let long: usize = named.map(|s| LEGEND[0] + LEGEND[1] * s.label.chars().count()).sum();
    let legend = u32::try_from(long / (WIDTH as usize - 120) * LEGEND[2]).map_err(|e| e.to_string())?;
    let chart = Chart::new("", x, y).sized(WIDTH, HEIGHT + legend);
    let chart = if equal { chart.equal_aspect(HIGHEST + legend) } else { chart };
    series.into_iter().fold(chart, Chart::with).svg().map_err(|e| e.to_string())
}

fn colour(number: usize) -> Colour {
    PALETTE[number.min(INK)]
}

/// The colour of the series with this number, and its opacity: paler once all colours are in use.
fn appearance(number: usize) -> (Colour, f64) {
    (colour(number % INK), if number < INK { 1.0 } else { 0.45 })
}

/// Series of a figure with their names: curves of one name have one colour and are in the legend
/// once.
#[derive(Default)]
struct Traces {
    named: Vec<(String, Series)>,
    /// Colours given one after the other.
    given: usize,
}

impl Traces {
    /// `color`: the one that the case asks for.
    fn add(&mut self, label: String, points: Points, line: Line, color: Option<usize>) {
        let same = self.named.iter().find(|(name, _)| *name == label);
        let (colour, opacity) = match (color, same) {
            (Some(number), _) => (colour(number), 1.0),
            (None, Some((_, series))) => (series.colour, series.opacity),
            (None, None) => {
                self.given += 1;
                appearance(self.given - 1)
            }
        };
        let mark = match line {
            Line::Solid => Mark::Line,
            Line::Dashed => Mark::Dashed,
            Line::Points => Mark::Circles,
        };
        let shown = self.named.iter().any(|(name, _)| *name == label);
        let series = Series::new(if shown { "" } else { &label }, points, mark, colour).opacity(opacity);
        self.named.push((label, series));
    }

    fn series(self) -> Vec<Series> {
        self.named.into_iter().map(|(_, series)| series).collect()
    }
}

fn curves(examined: &Examined, curves: &[Curve]) -> Result<Vec<Series>, String> {
    let mut traces = Traces::default();
    for curve in curves {
        let reference = |rows: &[(String, Scalar)]| -> Result<Option<Points>, String> {
            let Some(oracle) = &curve.oracle else { return Ok(None) };
            let table = examined.tables.get(oracle).ok_or_else(|| format!("no table of `{oracle}`"))?;
            let rows = table.matching(rows)?;
            Ok(Some(points(&table.numbers(&curve.x, &rows)?, &table.numbers(&curve.y, &rows)?)))
        };
        if curve.oracle.is_some() && curve.run.is_none() {
            let rows: Vec<_> = curve.rows.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
            let label = curve.label.clone().unwrap_or_else(|| "reference".to_owned());
            traces.add(label, reference(&rows)?.unwrap_or_default(), curve.line, curve.color);
            continue;
        }
        let (_, runs) = examined.runs(curve.run.as_deref())?;
        if let Some(check) = curve.check {
            for (label, points) in errors(examined, check, curve, runs)? {
                traces.add(label.clone(), points.clone(), curve.line, curve.color);
                traces.add(label, points, Line::Points, curve.color);
            }
            continue;
        }
        for run in runs.iter().filter(|run| run.member.is(&curve.only)) {
            let label = match (&curve.label, &curve.oracle) {
                (Some(label), _) => run.member.fill(label)?,
                (None, Some(_)) => "reference".to_owned(),
                (None, None) => run.label.clone(),
            };
            let points = match reference(&filled(&curve.rows, run)?)? {
                Some(points) => points,
                None => points(&recorded(&curve.x, run)?.1, &recorded(&curve.y, run)?.1),
            };
            traces.add(label, points, curve.line, curve.color);
        }
    }
    Ok(traces.series())
}

/// Errors of a check over the variable on the horizontal axis; one set for each of the other axes'
/// points.
fn errors(
    examined: &Examined,
    check: usize,
    curve: &Curve,
    runs: &[Run],
) -> Result<Vec<(String, Points)>, String> {
    let mut groups: Vec<(String, Points)> = Vec::new();
    for outcome in examined.outcomes.iter().filter(|o| o.check + 1 == check && !o.is_rate()) {
        let Some(run) = outcome.run.and_then(|k| runs.get(k)).filter(|run| run.member.is(&curve.only)) else {
            continue;
        };
        let x = run.member.fill(&format!("{{{}}}", curve.x))?;
        let x = x.parse().map_err(|_| format!("`{}` is no number: `{x}`", curve.x))?;
        let label = match &curve.label {
            Some(label) => run.member.fill(label)?,
            None => run.member.label_without(&curve.x),
        };
        match groups.iter_mut().find(|(name, _)| *name == label) {
            Some((_, points)) => points.push([x, outcome.error]),
            None => groups.push((label, vec![[x, outcome.error]])),
        }
    }
    if groups.is_empty() { Err(format!("check {check} has no runs to draw")) } else { Ok(groups) }
}

fn points(x: &[f64], y: &[f64]) -> Points {
    x.iter().zip(y).map(|(&x, &y)| [x, y]).collect()
}

/// Abscissae and values of a curve that a run left.
fn recorded(quantity: &str, run: &Run) -> Result<(Vec<f64>, Vec<f64>), String> {
    let found = values(quantity, &run.result)?;
    let (abscissa, list) = found.curve().ok_or_else(|| format!("`{quantity}` is one number, no curve"))?;
    Ok((abscissa.to_vec(), list.to_vec()))
}

/// Of the run with the largest error, ours as a line and the reference as circles.
fn overlay(examined: &Examined, check: &Check, outcomes: &[&Outcome]) -> Option<FigureView> {
    let curves = outcomes.iter().filter(|o| !o.abscissa.is_empty());
    let worst = curves.max_by(|a, b| a.error.total_cmp(&b.error))?;
    let several = outcomes.iter().filter(|o| !o.abscissa.is_empty()).count() > 1;
    let mut names = Vec::new();
    let drawing = || -> Result<String, String> {
        let (_, runs) = examined.runs(check.run.as_deref())?;
        let run = worst.run.and_then(|k| runs.get(k)).ok_or("a curve needs its run")?;
        let over = check.abscissa.as_ref().map(|quantity| recorded(quantity, run)).transpose()?;
        let mut series = Vec::new();
        for (k, quantity) in check.quantity.all().iter().enumerate() {
            let quantity = run.member.fill(quantity)?;
            let (abscissa, ours) = recorded(&quantity, run)?;
            let abscissa = over.as_ref().map_or(abscissa, |(_, values)| values.clone());
            let theirs: Vec<f64> = worst.reference.iter().filter_map(|p| p.get(k).copied()).collect();
            series.push(Series::line(format!("{quantity}, ours"), points(&abscissa, &ours), colour(k)));
            let reference = points(&worst.abscissa, &theirs);
            let stride = reference.len().div_ceil(MARKS);
            let reference = reference.into_iter().step_by(stride).collect();
            let label = if k == 0 { "reference" } else { "" };
            series.push(Series::new(label, reference, Mark::Circles, colour(k)));
            names.push(quantity);
        }
        let y = Axis::linear(names.join(", "));
        draw(Axis::linear(along(check)), y, false, series)
    };
    let drawing = { drawing }();
    let which = if several {
        format!(" Of all runs the one with the largest error: {}.", worst.label)
    } else {
        String::new()
    };
    Some(FigureView {
        title: "Ours upon the reference".into(),
        caption: format!("Lines: ours; circles of their colour: the reference.{which}"),
        drawing,
    })
}

/// Distance of ours from the reference along the curve.
fn difference(check: &Check, outcomes: &[&Outcome]) -> Option<FigureView> {
    let mut series: Vec<Series> = Vec::new();
    for outcome in outcomes.iter().filter(|o| !o.abscissa.is_empty()) {
        let distance = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
        };
        let errors: Vec<f64> = outcome.ours.iter().zip(&outcome.reference).map(distance).collect();
        marked(&mut series, &outcome.label, points(&outcome.abscissa, &errors));
    }
    logarithmic(
        "Difference",
        format!("Distance of ours from the reference along {}.", along(check)),
        Axis::linear(along(check)),
        series,
    )
}

/// Errors of a family of runs over what its order is measured against.
fn convergence(examined: &Examined, check: &Check, outcomes: &[&Outcome]) -> Option<FigureView> {
    let order = check.order.as_ref()?;
    let (_, runs) = examined.runs(check.run.as_deref()).ok()?;
    let mut groups: Vec<(String, Points)> = Vec::new();
    for outcome in outcomes.iter().filter(|o| !o.is_rate()) {
        let member = &runs.get(outcome.run?)?.member;
        let Some(n) = member.variables.get(&order.against).and_then(|n| n.parse().ok()) else { continue };
        let label = member.label_without(&order.against);
        match groups.iter_mut().find(|(name, _)| *name == label) {
            Some((_, points)) => points.push([n, outcome.error]),
            None => groups.push((label, vec![[n, outcome.error]])),
        }
    }
    let mut series = Vec::new();
    for (label, points) in groups {
        marked(&mut series, &label, points);
    }
    let caption = format!("Error over {}; the observed order is minus the slope.", order.against);
    logarithmic("Convergence", caption, Axis::log(order.against.as_str()), series)
}

/// A line with a mark at every point, unless there are too many; each further one in the next
/// colour.
fn marked(series: &mut Vec<Series>, label: &str, points: Points) {
    let (colour, opacity) = appearance(series.len() / 2);
    let marks = if points.len() <= MARKS { points.clone() } else { Points::new() };
    series.push(Series::line(label, points, colour).size(1.4).opacity(opacity));
    series.push(Series::points("", marks, colour).opacity(opacity));
}

fn logarithmic(title: &str, caption: String, x: Axis, series: Vec<Series>) -> Option<FigureView> {
    let largest = series.iter().flat_map(|s| &s.points).map(|p| p[1]).fold(0.0, f64::max);
    (largest >= ROUND_OFF).then(|| FigureView {
        title: title.to_owned(),
        caption,
        drawing: draw(x, Axis::log("difference"), false, series),
    })
}

/// The abscissa of a curve, with its unit.
fn along(check: &Check) -> &str {
    match check.along.as_deref() {
        None | Some("s") => "s [m]",
        Some("t") => "t [s]",
        Some(other) => other,
    }
}
