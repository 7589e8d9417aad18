//! The page: what the template shows, made from what was found.

use ancf_check::case::{Check, Class, Curve, Figure, Norm};
use ancf_check::compare::filled;
use ancf_check::quantity::values;
use ancf_check::{Examined, Outcome, Suite};
use askama::Template;

use super::Entry;
use super::before::Before;
use super::figure::{Drawing, Frame, Trace, draw};
use crate::Failure;

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    version: &'static str,
    date: &'a str,
    machine: &'a str,
    problems: &'a [String],
    passed: usize,
    failed: usize,
    beyond: usize,
    /// Day of the report that this one is compared with.
    before: Option<&'a str>,
    cases: Vec<CaseView>,
}

struct CaseView {
    name: String,
    title: String,
    claim: String,
    source: String,
    readme: Vec<Paragraph>,
    pass: bool,
    error: Option<String>,
    oracles: Vec<OracleView>,
    worst: Vec<WorstView>,
    checks: Vec<CheckView>,
    figures: Vec<FigureView>,
    seconds: String,
    runs: usize,
}

/// A line of the overview: the outcome of a case with the least margin, one for each class of oracle.
struct WorstView {
    class: &'static str,
    oracle: String,
    quantity: String,
    error: String,
    allowed: String,
    margin: String,
    order: String,
    trend: String,
    lost: bool,
    pass: bool,
}

/// A part of a README.
struct Paragraph {
    sketch: bool,
    text: String,
}

struct OracleView {
    name: String,
    title: String,
    class: &'static str,
    citation: String,
    note: Option<String>,
    tool: String,
    command: String,
    date: String,
    platform: String,
    hash: String,
    inputs: Vec<(String, String)>,
}

struct CheckView {
    title: String,
    why: String,
    norm: String,
    oracle: String,
    pass: bool,
    grid: Option<Grid>,
    lines: Vec<LineView>,
    drawing: Option<Drawing>,
    caption: String,
    note: String,
}

struct Grid {
    corner: String,
    columns: Vec<String>,
    rows: Vec<(String, Vec<Cell>)>,
}

struct Cell {
    ours: String,
    reference: String,
    difference: String,
    pass: bool,
    beyond: bool,
}

struct LineView {
    label: String,
    ours: String,
    reference: String,
    error: String,
    allowed: String,
    margin: String,
    pass: bool,
    beyond: bool,
    rate: bool,
}

struct FigureView {
    title: String,
    caption: String,
    drawing: Result<Drawing, String>,
}

/// The whole page.
pub fn render(
    suite: &Suite,
    entries: &[Entry],
    problems: &[String],
    before: Option<&Before>,
    date: &str,
    machine: &str,
) -> Result<String, Failure> {
    let cases: Vec<CaseView> = entries.iter().map(|entry| case_view(suite, entry, before)).collect();
    let outcomes = || entries.iter().filter_map(|e| e.examined.as_ref().ok()).flat_map(|e| &e.outcomes);
    let page = Page {
        version: env!("CARGO_PKG_VERSION"),
        date,
        machine,
        problems,
        before: before.map(|b| b.date.as_str()),
        passed: outcomes().filter(|o| o.verdict.passed()).count(),
        failed: outcomes().filter(|o| !o.verdict.passed()).count()
            + entries.iter().filter(|e| e.examined.is_err()).count(),
        beyond: outcomes().filter(|o| o.verdict.beyond_last_digit).count(),
        cases,
    };
    Ok(page.render()?)
}

fn case_view(suite: &Suite, entry: &Entry, before: Option<&Before>) -> CaseView {
    let readme = std::fs::read_to_string(suite.cases_folder().join(&entry.name).join("README.md"));
    let readme = paragraphs(&readme.unwrap_or_default());
    let seconds = format!("{:.2} s", entry.took.as_secs_f64());
    match &entry.examined {
        Err(error) => CaseView {
            name: entry.name.clone(),
            title: entry.name.clone(),
            claim: String::new(),
            source: String::new(),
            readme,
            pass: false,
            error: Some(error.to_string()),
            oracles: Vec::new(),
            worst: Vec::new(),
            checks: Vec::new(),
            figures: Vec::new(),
            seconds,
            runs: 0,
        },
        Ok(examined) => {
            let text = &examined.case.text;
            CaseView {
                name: entry.name.clone(),
                title: text.title.clone(),
                claim: text.claim.clone(),
                source: text.source.clone(),
                readme,
                pass: examined.passed(),
                error: None,
                oracles: oracles(examined),
                worst: worst(examined, before),
                checks: text.check.iter().enumerate().map(|(k, c)| check_view(examined, k, c)).collect(),
                figures: text.figure.iter().map(|f| figure_view(examined, f)).collect(),
                seconds,
                runs: examined.families.values().map(|(_, runs)| runs.len()).sum(),
            }
        }
    }
}

/// The README without its heading and source, which the page shows elsewhere: paragraphs, and sketches between fences.
fn paragraphs(readme: &str) -> Vec<Paragraph> {
    let mut parts = Vec::new();
    for (k, block) in readme.split("```").enumerate() {
        if k % 2 == 1 {
            parts.push(Paragraph { sketch: true, text: block.trim_matches('\n').to_owned() });
            continue;
        }
        let kept = block
            .split("\n\n")
            .map(str::trim)
            .filter(|p| !p.is_empty() && !p.starts_with("# ") && !p.starts_with("**Source.**"));
        parts.extend(kept.map(|p| Paragraph {
            sketch: false,
            text: p.replace("**Goal.** ", "").replace(['`', '*'], "").replace('\n', " "),
        }));
    }
    parts
}

fn oracles(examined: &Examined) -> Vec<OracleView> {
    let short = |hash: &str| hash.chars().take(16).collect::<String>();
    examined
        .tables
        .iter()
        .map(|(name, table)| {
            let p = &table.provenance;
            OracleView {
                name: name.clone(),
                title: p.title.clone(),
                class: p.class.word(),
                citation: p.citation.clone(),
                note: p.note.clone(),
                tool: p.tool.clone(),
                command: p.command.clone(),
                date: p.date.clone(),
                platform: p.platform.clone(),
                hash: short(&p.csv_sha256),
                inputs: p.inputs.iter().map(|(file, hash)| (file.clone(), short(hash))).collect(),
            }
        })
        .collect()
}

fn worst(examined: &Examined, before: Option<&Before>) -> Vec<WorstView> {
    let mut classes: Vec<Option<Class>> = examined.outcomes.iter().map(|o| o.class).collect();
    classes.sort();
    classes.dedup();
    classes
        .into_iter()
        .filter_map(|class| {
            let of_class = || examined.outcomes.iter().filter(move |o| o.class == class);
            let orders: Vec<String> = of_class()
                .filter(|o| o.is_rate())
                .filter_map(|o| Some(format!("{:.2}", o.numbers()?.0)))
                .collect();
            let urgency = |o: &&Outcome| if o.verdict.passed() { o.margin().unwrap_or(99.0) } else { -99.0 };
            let rates_last = |o: &&Outcome| !o.is_rate() && o.verdict.allowed.is_some();
            let pick = of_class()
                .filter(rates_last)
                .min_by(|a, b| urgency(a).total_cmp(&urgency(b)))
                .or_else(|| of_class().min_by(|a, b| urgency(a).total_cmp(&urgency(b))))?;
            let oracle = pick.oracle.as_ref().and_then(|o| examined.tables.get(o));
            let change = before.and_then(|b| b.gained(&examined.case.name, of_class()));
            Some(WorstView {
                trend: change.map_or_else(String::new, |digits| {
                    if digits.abs() < 0.05 {
                        "=".to_owned()
                    } else {
                        format!("{digits:+.1}").replace('-', "−")
                    }
                }),
                lost: change.is_some_and(|digits| digits <= -1.0),
                class: class.map_or("bound", Class::word),
                oracle: oracle.map_or_else(String::new, |t| t.provenance.title.clone()),
                quantity: pick.quantity.clone(),
                error: short(pick.error),
                allowed: limits(pick),
                margin: margin(pick),
                order: orders.join(", "),
                pass: of_class().all(|o| o.verdict.passed()),
            })
        })
        .collect()
}

fn check_view(examined: &Examined, number: usize, check: &Check) -> CheckView {
    let outcomes: Vec<&Outcome> = examined.outcomes.iter().filter(|o| o.check == number).collect();
    let grid = grid(examined, check, &outcomes);
    let curves = outcomes.iter().any(|o| !o.abscissa.is_empty());
    let mut norm = match (curves, check.norm) {
        (false, _) if check.quantity.all().len() > 1 => "distance",
        (false, _) => "absolute difference",
        (true, Norm::Max) => "largest difference along the curve",
        (true, Norm::Rms) => "root mean square along the curve",
    }
    .to_owned();
    match &check.per {
        None => {}
        Some(ancf_check::case::Per::Number(scale)) => norm.push_str(&format!(", divided by {scale}")),
        Some(ancf_check::case::Per::Word(_)) => norm.push_str(", relative to the reference"),
    }
    let (drawing, caption) = error_drawing(examined, check, &outcomes);
    let oracle = check.oracle.as_ref().and_then(|o| examined.tables.get(o));
    let beyond = outcomes.iter().filter(|o| o.verdict.beyond_last_digit).count();
    CheckView {
        title: check.title.clone().unwrap_or_else(|| check.quantity.all().join(", ")),
        why: check.why.trim().to_owned(),
        norm,
        oracle: oracle.map_or_else(|| "a bound".to_owned(), |t| t.provenance.title.clone()),
        pass: outcomes.iter().all(|o| o.verdict.passed()),
        lines: if grid.is_some() {
            outcomes.iter().filter(|o| o.is_rate()).map(|o| line_view(o, check)).collect()
        } else {
            outcomes.iter().map(|o| line_view(o, check)).collect()
        },
        grid,
        drawing,
        caption,
        note: match (beyond, check.last_digit) {
            (0, _) | (_, None) => String::new(),
            (n, Some(digit)) => format!(
                "The printed number is not met to one unit of its last digit ({digit:e}) in {n} {}.",
                if n == 1 { "place" } else { "places" }
            ),
        },
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
    let rows = (0..row_values.len())
        .map(|r| {
            let cells = (0..column_values.len())
                .map(|c| {
                    let outcome = numbers.iter().find(|o| {
                        o.run.and_then(|k| runs.get(k)).is_some_and(|run| run.member.point == [r, c])
                    })?;
                    let (ours, reference) = outcome.numbers()?;
                    let fine = resolution.or(outcome.verdict.allowed.map(|a| a / 10.0)).unwrap_or(1e-6);
                    Some(Cell {
                        ours: at_resolution(ours, fine),
                        reference: at_resolution(reference, check.last_digit.unwrap_or(fine)),
                        difference: format!("{:+.1e}", ours - reference),
                        pass: outcome.verdict.passed(),
                        beyond: outcome.verdict.beyond_last_digit,
                    })
                })
                .collect::<Option<Vec<_>>>()?;
            Some((row_values.get(r)?.to_string(), cells))
        })
        .collect::<Option<Vec<_>>>()?;
    Some(Grid {
        corner: format!("{row_name} \\ {column_name}"),
        columns: column_values.iter().map(ToString::to_string).collect(),
        rows,
    })
}

fn line_view(outcome: &Outcome, check: &Check) -> LineView {
    let fine = check.last_digit.or(outcome.verdict.allowed).unwrap_or(outcome.error).max(1e-15) / 10.0;
    let scaled = if check.per.is_some() { fine * largest(&outcome.reference).max(1e-300) } else { fine };
    let text = |points: &[Vec<f64>], fine: f64| match points {
        [point] if outcome.abscissa.is_empty() => {
            point.iter().map(|v| at_resolution(*v, fine)).collect::<Vec<_>>().join(", ")
        }
        points => format!("{} points", points.len()),
    };
    LineView {
        label: if outcome.label.is_empty() { "–".to_owned() } else { outcome.label.clone() },
        ours: text(&outcome.ours, if outcome.is_rate() { 1e-3 } else { scaled }),
        reference: text(&outcome.reference, if outcome.is_rate() { 1e-3 } else { scaled }),
        error: short(outcome.error),
        allowed: limits(outcome),
        margin: margin(outcome),
        pass: outcome.verdict.passed(),
        beyond: outcome.verdict.beyond_last_digit,
        rate: outcome.is_rate(),
    }
}

/// Error along a curve, or error against the variable of an order.
fn error_drawing(examined: &Examined, check: &Check, outcomes: &[&Outcome]) -> (Option<Drawing>, String) {
    let mut traces = Vec::new();
    let (frame, caption) = if let Some(order) = &check.order {
        let Ok((_, runs)) = examined.runs(check.run.as_deref()) else { return (None, String::new()) };
        for outcome in outcomes.iter().filter(|o| !o.is_rate()) {
            let Some(run) = outcome.run.and_then(|k| runs.get(k)) else { continue };
            let Some(n) = run.member.variables.get(&order.against).and_then(|n| n.parse::<f64>().ok()) else {
                continue;
            };
            let label = run.member.label_without(&order.against);
            let label = if label.is_empty() { "error".to_owned() } else { label };
            add(&mut traces, label, (n, outcome.error));
        }
        let marks: Vec<Trace> = traces
            .iter()
            .map(|t: &Trace| Trace {
                line: ancf_check::case::Line::Points,
                points: t.points.clone(),
                label: t.label.clone(),
                color: t.color,
            })
            .collect();
        traces.extend(marks);
        let frame = Frame { x: order.against.as_str(), y: "error", equal: false, logarithmic: (true, true) };
        (frame, format!("Error against {}, both axes logarithmic.", order.against))
    } else {
        for outcome in outcomes.iter().filter(|o| !o.abscissa.is_empty()) {
            for (k, &at) in outcome.abscissa.iter().enumerate() {
                let (Some(a), Some(b)) = (outcome.ours.get(k), outcome.reference.get(k)) else { continue };
                let distance = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
                add(&mut traces, outcome.label.clone(), (at, distance));
            }
        }
        let along = check.along.as_deref().unwrap_or("s");
        (
            Frame { x: along, y: "difference", equal: false, logarithmic: (false, true) },
            format!("Difference along {along}."),
        )
    };
    // a drawing of round-off shows nothing
    let largest = traces.iter().flat_map(|t| &t.points).map(|p| p.1).fold(0.0, f64::max);
    if largest < 1e-13 {
        return (None, String::new());
    }
    match draw(&frame, &traces) {
        Ok(drawing) => (Some(drawing), caption),
        Err(_) => (None, String::new()),
    }
}

fn add(traces: &mut Vec<Trace>, label: String, point: (f64, f64)) {
    match traces.iter_mut().find(|t| t.label == label) {
        Some(trace) => trace.points.push(point),
        None => {
            let color = traces.len() % 7;
            traces.push(Trace { label, points: vec![point], line: ancf_check::case::Line::Solid, color });
        }
    }
}

fn figure_view(examined: &Examined, figure: &Figure) -> FigureView {
    let drawing = traces(examined, &figure.curve).and_then(|traces| {
        let frame = Frame {
            x: &figure.x,
            y: &figure.y,
            equal: figure.equal,
            logarithmic: (figure.logarithmic, figure.logarithmic),
        };
        draw(&frame, &traces).map_err(|e| e.to_string())
    });
    FigureView { title: figure.title.clone(), caption: figure.caption.clone(), drawing }
}

fn traces(examined: &Examined, curves: &[Curve]) -> Result<Vec<Trace>, String> {
    let mut traces: Vec<Trace> = Vec::new();
    for curve in curves {
        let color_of = |traces: &[Trace], label: &str| {
            curve.color.unwrap_or_else(|| {
                let same = traces.iter().find(|t| t.label == label);
                same.map_or_else(|| traces.iter().map(|t| t.color + 1).max().unwrap_or(0) % 7, |t| t.color)
            })
        };
        let reference =
            |rows: &[(String, ancf_check::case::Scalar)]| -> Result<Option<Vec<(f64, f64)>>, String> {
                let Some(oracle) = &curve.oracle else { return Ok(None) };
                let table = examined.tables.get(oracle).ok_or_else(|| format!("no table of `{oracle}`"))?;
                let rows = table.matching(rows)?;
                let (x, y) = (table.numbers(&curve.x, &rows)?, table.numbers(&curve.y, &rows)?);
                Ok(Some(x.into_iter().zip(y).collect()))
            };
        if curve.oracle.is_some() && curve.run.is_none() {
            let rows: Vec<_> = curve.rows.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
            let label = curve.label.clone().unwrap_or_else(|| "reference".to_owned());
            let color = color_of(&traces, &label);
            let points = reference(&rows)?.unwrap_or_default();
            traces.push(Trace { label, points, line: curve.line, color });
            continue;
        }
        let (_, runs) = examined.runs(curve.run.as_deref())?;
        for run in runs.iter().filter(|run| run.member.is(&curve.only)) {
            let label = match &curve.label {
                Some(label) => run.member.fill(label)?,
                None => run.label.clone(),
            };
            let points = match reference(&filled(&curve.rows, run)?)? {
                Some(points) => points,
                None => {
                    let of = |quantity: &str| -> Result<Vec<f64>, String> {
                        let found = values(quantity, &run.result)?;
                        let (_, list) =
                            found.curve().ok_or_else(|| format!("`{quantity}` is one number, no curve"))?;
                        Ok(list.to_vec())
                    };
                    of(&curve.x)?.into_iter().zip(of(&curve.y)?).collect()
                }
            };
            let color = color_of(&traces, &label);
            traces.push(Trace { label, points, line: curve.line, color });
        }
    }
    Ok(traces)
}

fn largest(points: &[Vec<f64>]) -> f64 {
    points.iter().flatten().fold(0.0, |a, v| a.max(v.abs()))
}

/// A number with as many decimals as `resolution` asks for.
fn at_resolution(value: f64, resolution: f64) -> String {
    let decimals = (-resolution.log10()).ceil();
    if value.abs() >= 1e7 || !(0.0..=16.0).contains(&decimals) {
        return format!("{value:.12e}");
    }
    let text = format!("{value:.*}", decimals as usize);
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}

fn short(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}").replace('-', "−") }
}

fn limits(outcome: &Outcome) -> String {
    let mut parts = Vec::new();
    parts.extend(outcome.verdict.allowed.map(|a| format!("≤ {}", short(a))));
    parts.extend(outcome.verdict.at_least.map(|a| format!("≥ {}", short(a))));
    if parts.is_empty() { "rate only".to_owned() } else { parts.join(", ") }
}

fn margin(outcome: &Outcome) -> String {
    match outcome.margin() {
        Some(digits) => format!("{digits:+.1}").replace('-', "−"),
        None if outcome.error == 0.0 => "∞".to_owned(),
        None => "–".to_owned(),
    }
}
