//! A check on the page of its case: what was compared, how and why so exactly, as a table and as
//! drawings.

use ancf_check::case::{Check, Norm, Per};
use ancf_check::{Examined, Outcome};

use super::figure::{self, FigureView};
use super::number::{at_resolution, limits, margin, short};

/// A check as the page shows it.
pub struct CheckView {
    pub title: String,
    pub why: String,
    pub norm: String,
    pub oracle: String,
    pub pass: bool,
    pub grid: Option<Grid>,
    pub lines: Vec<LineView>,
    pub figures: Vec<FigureView>,
    pub note: String,
}

/// A table over two axes of a family.
pub struct Grid {
    pub corner: String,
    pub columns: Vec<String>,
    pub rows: Vec<(String, Vec<Cell>)>,
}

/// One number of a [`Grid`].
pub struct Cell {
    pub ours: String,
    pub reference: String,
    pub difference: String,
    pub pass: bool,
    pub beyond: bool,
}

/// An outcome in one line.
pub struct LineView {
    pub label: String,
    pub ours: String,
    pub reference: String,
    pub error: String,
    pub allowed: String,
    pub margin: String,
    pub pass: bool,
    pub beyond: bool,
    pub rate: bool,
}

/// The check with this number in its case.
pub fn view(examined: &Examined, number: usize, check: &Check) -> CheckView {
    let outcomes: Vec<&Outcome> = examined.outcomes.iter().filter(|o| o.check == number).collect();
    let grid = grid(examined, check, &outcomes);
    let oracle = check.oracle.as_ref().and_then(|o| examined.tables.get(o));
    let beyond = outcomes.iter().filter(|o| o.verdict.beyond_last_digit).count();
    let in_lines = |o: &&&Outcome| grid.is_none() || o.is_rate();
    CheckView {
        title: check.title.clone().unwrap_or_else(|| check.quantity.all().join(", ")),
        why: check.why.trim().to_owned(),
        norm: norm(check, &outcomes),
        oracle: oracle.map_or_else(|| "a bound".to_owned(), |t| t.provenance.title.clone()),
        pass: outcomes.iter().all(|o| o.verdict.passed()),
        lines: outcomes.iter().filter(in_lines).map(|o| line(o, check)).collect(),
        grid,
        figures: figure::of_check(examined, check, &outcomes),
        note: match (beyond, check.last_digit) {
            (0, _) | (_, None) => String::new(),
            (n, Some(digit)) => format!(
                "The printed number is not met to one unit of its last digit ({digit:e}) in {n} {}.",
                if n == 1 { "place" } else { "places" }
            ),
        },
    }
}

/// The norm in words.
fn norm(check: &Check, outcomes: &[&Outcome]) -> String {
    let curves = outcomes.iter().any(|o| !o.abscissa.is_empty());
    let norm = match (curves, check.norm) {
        (false, _) if check.quantity.all().len() > 1 => "distance",
        (false, _) => "absolute difference",
        (true, Norm::Max) => "largest difference along the curve",
        (true, Norm::Rms) => "root mean square along the curve",
    };
    match &check.per {
        None => norm.to_owned(),
        Some(Per::Number(scale)) => format!("{norm}, divided by {scale}"),
        Some(Per::Word(_)) => format!("{norm}, relative to the reference"),
    }
}

/// A table of rows and columns, where the family has two axes and every outcome is one number.
fn grid(examined: &Examined, check: &Check, outcomes: &[&Outcome]) -> Option<Grid> {
    let (family, runs) = examined.runs(check.run.as_deref()).ok()?;
    let [rows, columns] = family.over.values().collect::<Vec<_>>().try_into().ok()?;
    let numbers: Vec<&&Outcome> = outcomes.iter().filter(|o| !o.is_rate()).collect();
    if !check.only.is_empty() || numbers.iter().any(|o| o.numbers().is_none()) {
        return None;
    }
    let (row_name, row_values) = rows.first()?;
    let (column_name, column_values) = columns.first()?;
    let resolution = check.last_digit.map(|d| d / 10.0);
    let cell = |r: usize, c: usize| {
        let outcome = numbers
            .iter()
            .find(|o| o.run.and_then(|k| runs.get(k)).is_some_and(|run| run.member.point == [r, c]))?;
        let (ours, reference) = outcome.numbers()?;
        let fine = resolution.or(outcome.verdict.allowed.map(|a| a / 10.0)).unwrap_or(1e-6);
        Some(Cell {
            ours: at_resolution(ours, fine),
            reference: at_resolution(reference, check.last_digit.unwrap_or(fine)),
            difference: format!("{:+.1e}", ours - reference).replace('-', "−"),
            pass: outcome.verdict.passed(),
            beyond: outcome.verdict.beyond_last_digit,
        })
    };
    let row = |(r, value): (usize, &ancf_check::case::Scalar)| {
        let cells = (0..column_values.len()).map(|c| cell(r, c)).collect::<Option<Vec<_>>>()?;
        Some((value.to_string(), cells))
    };
    Some(Grid {
        corner: format!("{row_name} \\ {column_name}"),
        columns: column_values.iter().map(ToString::to_string).collect(),
        rows: row_values.iter().enumerate().map(row).collect::<Option<Vec<_>>>()?,
    })
}

fn line(outcome: &Outcome, check: &Check) -> LineView {
    let fine = check.last_digit.or(outcome.verdict.allowed).unwrap_or(outcome.error).max(1e-15) / 10.0;
    let scale = match check.per {
        None => 1.0,
        Some(Per::Number(scale)) => scale,
        Some(Per::Word(_)) => largest(&outcome.reference).max(1e-300),
    };
    let resolution = if outcome.is_rate() { 1e-3 } else { fine * scale };
    let text = |points: &[Vec<f64>]| match points {
        [point] if outcome.abscissa.is_empty() => {
            point.iter().map(|v| at_resolution(*v, resolution)).collect::<Vec<_>>().join(", ")
        }
        points => format!("{} points", points.len()),
    };
    LineView {
        label: if outcome.label.is_empty() { "–".to_owned() } else { outcome.label.clone() },
        ours: text(&outcome.ours),
        reference: text(&outcome.reference),
        error: short(outcome.error),
        allowed: limits(outcome),
        margin: margin(outcome),
        pass: outcome.verdict.passed(),
        beyond: outcome.verdict.beyond_last_digit,
        rate: outcome.is_rate(),
    }
}

fn largest(points: &[Vec<f64>]) -> f64 {
    points.iter().flatten().fold(0.0, |a, v| a.max(v.abs()))
}
