//! Compares the results of runs with references, check by check.

use indexmap::IndexMap;
use serde::Serialize;

use crate::case::{Check, Class, Norm, Order, Per, Scalar};
use crate::execute::{Examined, Run};
use crate::quantity::values;
use crate::reference::Table;
use crate::{Error, Result};

/// One compared number, curve or rate.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// Number of the check in the case, from 0.
    pub check: usize,
    /// Number of the run in its family; none for a rate over several.
    pub run: Option<usize>,
    /// The member in one line.
    pub label: String,
    /// Quantity, its components joined.
    pub quantity: String,
    /// Name of the oracle; none where the quantity is itself the error.
    pub oracle: Option<String>,
    /// The oracle's class.
    pub class: Option<Class>,
    /// Abscissae of a curve; empty for a number.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub abscissa: Vec<f64>,
    /// Our values, per point their components; for a rate the observed order.
    pub ours: Vec<Vec<f64>>,
    /// The reference's values, likewise; for a rate the expected order.
    pub reference: Vec<Vec<f64>>,
    /// The error in the check's norm.
    pub error: f64,
    /// Whether the claim holds.
    pub verdict: Verdict,
    /// Why this tolerance.
    pub why: String,
}

/// The limits of an error, and whether it keeps them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Largest error.
    pub allowed: Option<f64>,
    /// Smallest error, for claims that a method is not good at something.
    pub at_least: Option<f64>,
    /// Whether the error keeps the limits.
    pub pass: bool,
    /// Whether the error keeps the limits, but is larger than one unit of the last digit that the
    /// publication prints.
    pub beyond_last_digit: bool,
    /// A problem other than the size of the error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

impl Verdict {
    /// Judges an error.
    fn of(error: f64, allowed: Option<f64>, at_least: Option<f64>, last_digit: Option<f64>) -> Self {
        // a bound met to round-off of decimal fractions is met: 0.00354 − 0.00353 is 1e-5
        let under = |limit: f64| error <= limit * (1.0 + 1e-9);
        let pass =
            allowed.is_none_or(under) && at_least.is_none_or(|least| error >= least) && error.is_finite();
        let beyond = last_digit.is_some_and(|digit| !under(digit));
        Self { allowed, at_least, pass, beyond_last_digit: pass && beyond, problem: None }
    }

    /// Whether the claim holds.
    pub fn passed(&self) -> bool {
        self.pass
    }
}

impl Outcome {
    /// Decimal digits between the error and the allowed one; negative where the check fails.
    pub fn margin(&self) -> Option<f64> {
        self.verdict.allowed.filter(|&a| a > 0.0 && self.error > 0.0).map(|a| (a / self.error).log10())
    }

    /// Whether this is an observed order.
    pub fn is_rate(&self) -> bool {
        self.run.is_none()
    }

    /// Ours and the reference, where both are single numbers.
    pub fn numbers(&self) -> Option<(f64, f64)> {
        match (self.ours.as_slice(), self.reference.as_slice()) {
            ([ours], [reference]) if self.abscissa.is_empty() => {
                match (ours.as_slice(), reference.as_slice()) {
                    ([ours], [reference]) => Some((*ours, *reference)),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// One line for a message.
    pub fn line(&self, case: &str) -> String {
        let place = if self.label.is_empty() { String::new() } else { format!(" [{}]", self.label) };
        let numbers = match self.numbers() {
            Some((ours, reference)) => format!("ours {ours:.12e}, reference {reference:.12e}, "),
            None => String::new(),
        };
        let mut limits = Vec::new();
        limits.extend(self.verdict.allowed.map(|a| format!("allowed {a:.3e}")));
        limits.extend(self.verdict.at_least.map(|a| format!("at least {a:.3e}")));
        format!(
            "{case}, check {}: {}{place} against {}: {numbers}error {:.3e}, {}",
            self.check + 1,
            self.quantity,
            self.oracle.as_deref().unwrap_or("zero"),
            self.error,
            limits.join(", ")
        )
    }
}

/// All outcomes of a case.
pub(crate) fn all(examined: &Examined) -> Result<Vec<Outcome>> {
    let mut outcomes = Vec::new();
    for (number, check) in examined.case.text.check.iter().enumerate() {
        outcomes.extend(one(examined, number, check).map_err(|message| Error::Check {
            case: examined.case.name.clone(),
            check: format!("{} ({})", number + 1, check.quantity.all().join(", ")),
            message,
        })?);
    }
    Ok(outcomes)
}

fn one(examined: &Examined, number: usize, check: &Check) -> std::result::Result<Vec<Outcome>, String> {
    let (_, runs) = examined.runs(check.run.as_deref())?;
    let mut outcomes = Vec::new();
    for (index, run) in runs.iter().enumerate().filter(|(_, run)| run.member.is(&check.only)) {
        let outcome = member(&examined.tables, number, check, index, run)
            .map_err(|e| format!("[{}] {e}", run.label))?;
        outcomes.push(outcome);
    }
    if outcomes.is_empty() {
        return Err("`only` leaves no member of the family".to_owned());
    }
    if let Some(order) = &check.order {
        let rates = groups(runs, &outcomes, &order.against)
            .into_iter()
            .map(|(label, group)| rate(examined, number, check, order, runs, label, &group))
            .collect::<std::result::Result<Vec<_>, _>>()?;
        outcomes.extend(rates);
    }
    Ok(outcomes)
}

/// Compares the results of one run with the reference of a check.
///
/// `number` and `index` are those of the check in its case and of the run in its family; `tables`
/// are references by the names under which checks know them.
///
/// # Errors
/// Where the check asks for a quantity or a reference that is not there.
pub fn member(
    tables: &IndexMap<String, Table>,
    number: usize,
    check: &Check,
    index: usize,
    run: &Run,
) -> std::result::Result<Outcome, String> {
    let quantities = check
        .quantity
        .all()
        .iter()
        .map(|q| run.member.fill(q))
        .collect::<std::result::Result<Vec<_>, _>>()?;
    let ours =
        quantities.iter().map(|q| values(q, &run.result)).collect::<std::result::Result<Vec<_>, _>>()?;
    let over = match &check.abscissa {
        None => None,
        Some(quantity) => {
            let curve = values(quantity, &run.result)?;
            let (_, values) = curve.curve().ok_or_else(|| format!("`{quantity}` is no series"))?;
            Some(values.to_vec())
        }
    };

    let mut outcome = Outcome {
        check: number,
        run: Some(index),
        label: run.label.clone(),
        quantity: quantities.join(", "),
        oracle: check.oracle.clone(),
        class: None,
        abscissa: Vec::new(),
        ours: Vec::new(),
        reference: Vec::new(),
        error: f64::NAN,
        verdict: Verdict::of(f64::NAN, None, None, None),
        why: check.why.trim().to_owned(),
    };

    match &check.oracle {
        None => {
            let ours = ours
                .iter()
                .map(|v| v.number(check.pick, over.as_deref()))
                .collect::<std::result::Result<Vec<_>, _>>()?;
            outcome.reference.push(vec![0.0; ours.len()]);
            outcome.ours.push(ours);
        }
        Some(oracle) => {
            let table = tables.get(oracle).ok_or_else(|| format!("no table of `{oracle}`"))?;
            outcome.class = Some(table.provenance.class);
            let wanted = filled(&check.rows, run)?;
            let rows = table.matching(&wanted)?;
            let columns = match &check.column {
                Some(columns) => columns
                    .all()
                    .iter()
                    .map(|c| run.member.fill(c))
                    .collect::<std::result::Result<Vec<_>, _>>()?,
                None => quantities.iter().map(|q| q.rsplit('.').next().unwrap_or(q).to_owned()).collect(),
            };
            let theirs = columns
                .iter()
                .map(|column| table.numbers(column, &rows))
                .collect::<std::result::Result<Vec<_>, _>>()?;
            let at_point = |k: usize| theirs.iter().filter_map(|c| c.get(k).copied()).collect::<Vec<f64>>();
            match &check.along {
                None => {
                    if rows.len() != 1 {
                        return Err(format!(
                            "`where` must leave one row of {}; it leaves {}",
                            table.path.display(),
                            rows.len()
                        ));
                    }
                    outcome.reference.push(at_point(0));
                    outcome.ours.push(
                        ours.iter()
                            .map(|v| v.number(check.pick, over.as_deref()))
                            .collect::<std::result::Result<Vec<_>, _>>()?,
                    );
                }
                Some(along) => {
                    if rows.len() < 2 {
                        return Err(format!(
                            "`where` must leave two rows or more of {} for a curve; it leaves {}",
                            table.path.display(),
                            rows.len()
                        ));
                    }
                    outcome.abscissa = table.numbers(along, &rows)?;
                    outcome.reference = (0..rows.len()).map(at_point).collect();
                    outcome.ours = vec![Vec::with_capacity(ours.len()); rows.len()];
                    for (value, name) in ours.iter().zip(&quantities) {
                        let (abscissa, values) =
                            value.curve().ok_or_else(|| format!("`{name}` is one number, no curve"))?;
                        let abscissa = over.as_deref().unwrap_or(abscissa);
                        for (point, &at) in outcome.ours.iter_mut().zip(&outcome.abscissa) {
                            point.push(
                                interpolated(abscissa, values, at).map_err(|e| format!("`{name}`: {e}"))?,
                            );
                        }
                    }
                }
            }
        }
    }

    outcome.error = error(check, &outcome)?;
    let allowed = match &check.allowed {
        None => None,
        Some(Scalar::Text(text)) => {
            let text = run.member.fill(text)?;
            Some(text.parse::<f64>().map_err(|_| format!("`allowed` is no number: `{text}`"))?)
        }
        Some(number) => number.to_string().parse::<f64>().ok(),
    };
    outcome.verdict = Verdict::of(outcome.error, allowed, check.at_least, check.last_digit);
    Ok(outcome)
}

/// The values by which rows of a reference are picked.
pub fn filled(
    rows: &IndexMap<String, Scalar>,
    run: &Run,
) -> std::result::Result<Vec<(String, Scalar)>, String> {
    rows.iter().map(|(k, v)| Ok((k.clone(), Scalar::Text(run.member.fill(&v.to_string())?)))).collect()
}

fn error(check: &Check, outcome: &Outcome) -> std::result::Result<f64, String> {
    let origin = |point: &Vec<f64>| vec![0.0; point.len()];
    let distances = outcome.ours.iter().zip(&outcome.reference).map(|(a, b)| distance(a, b));
    let error = norm(check.norm, distances);
    let scale = match &check.per {
        None => 1.0,
        Some(Per::Number(scale)) => *scale,
        Some(Per::Word(_)) => norm(check.norm, outcome.reference.iter().map(|p| distance(p, &origin(p)))),
    };
    if !(scale.is_finite() && scale > 0.0) {
        return Err(format!("an error cannot be taken relative to {scale}"));
    }
    Ok(error / scale)
}

fn norm(norm: Norm, distances: impl Iterator<Item = f64>) -> f64 {
    match norm {
        // f64::max would drop a NaN
        Norm::Max => distances.fold(0.0, |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }),
        Norm::Rms => {
            let (sum, count) = distances.fold((0.0, 0), |(sum, n), d| (sum + d * d, n + 1));
            (sum / f64::from(count)).sqrt()
        }
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The value at `at`: a record where there is one, otherwise the cubic through the four nearest
/// records.
fn interpolated(abscissa: &[f64], values: &[f64], at: f64) -> std::result::Result<f64, String> {
    let (Some(first), Some(last)) = (abscissa.first(), abscissa.last()) else {
        return Err("the run recorded nothing".to_owned());
    };
    if abscissa.windows(2).any(|w| matches!(w, [a, b] if a > b)) {
        return Err("the abscissa falls".to_owned());
    }
    let slack = 1e-9 * (last - first).abs();
    if !(first - slack..=last + slack).contains(&at) {
        return Err(format!("the reference at {at} lies outside of what was recorded, {first} to {last}"));
    }
    let right = abscissa.partition_point(|&x| x < at);
    for k in [right.saturating_sub(1), right] {
        if let (Some(x), Some(y)) = (abscissa.get(k), values.get(k))
            && (x - at).abs() <= slack
        {
            return Ok(*y);
        }
    }
    // A place that appears twice, because a force acts there, ends one curve and begins the next.
    let twice = |w: &[f64]| matches!(w, [a, b] if a == b);
    let from = abscissa[..right].windows(2).rposition(twice).map_or(0, |i| i + 1);
    let to = abscissa[right..].windows(2).position(twice).map_or(abscissa.len(), |i| right + i + 1);
    let (abscissa, values, right) = (&abscissa[from..to], &values[from..to], right - from);
    let count = abscissa.len().min(4);
    let start = right.saturating_sub(2).min(abscissa.len() - count);
    let points: Vec<(f64, f64)> =
        abscissa.iter().zip(values).skip(start).take(count).map(|(x, y)| (*x, *y)).collect();
    Ok(points
        .iter()
        .enumerate()
        .map(|(i, (xi, yi))| {
            let others = points.iter().enumerate().filter(|(j, _)| *j != i);
            others.fold(*yi, |term, (_, (xj, _))| term * (at - xj) / (xi - xj))
        })
        .sum())
}

/// Outcomes whose runs differ only in the axis of `against`, with the label of their common values.
fn groups<'a>(runs: &[Run], outcomes: &'a [Outcome], against: &str) -> Vec<(String, Vec<&'a Outcome>)> {
    let mut groups: Vec<(String, Vec<&Outcome>)> = Vec::new();
    for outcome in outcomes {
        let Some(run) = outcome.run.and_then(|k| runs.get(k)) else { continue };
        let common = run.member.label_without(against);
        match groups.iter_mut().find(|(label, _)| *label == common) {
            Some((_, group)) => group.push(outcome),
            None => groups.push((common, vec![outcome])),
        }
    }
    groups
}

/// The observed order over a group of runs: minus the slope of ln error over ln n, by least
/// squares.
fn rate(
    examined: &Examined,
    number: usize,
    check: &Check,
    order: &Order,
    runs: &[Run],
    common: String,
    outcomes: &[&Outcome],
) -> std::result::Result<Outcome, String> {
    let mut points = Vec::new();
    for outcome in outcomes {
        let run = outcome.run.and_then(|k| runs.get(k)).ok_or("a rate needs runs")?;
        let n = run.member.fill(&format!("{{{}}}", order.against))?;
        let n: f64 = n.parse().map_err(|_| format!("`{}` is no number: `{n}`", order.against))?;
        if !(n > 0.0 && outcome.error > 0.0) {
            return Err(format!(
                "a rate needs positive numbers: {} = {n}, error = {}",
                order.against, outcome.error
            ));
        }
        points.push((n.ln(), outcome.error.ln()));
    }
    let count = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / count, b + y / count));
    let (sxx, sxy) =
        points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - mx) * (x - mx), b + (x - mx) * (y - my)));
    if sxx <= 0.0 {
        return Err(format!("a rate needs two different values of `{}` or more", order.against));
    }
    let observed = -sxy / sxx;
    let error = (observed - order.expected).abs();
    let class = check.oracle.as_ref().and_then(|o| examined.tables.get(o)).map(|t| t.provenance.class);
    Ok(Outcome {
        check: number,
        run: None,
        label: if common.is_empty() {
            format!("order in {}", order.against)
        } else {
            format!("order in {}, {common}", order.against)
        },
        quantity: format!("order of {}", check.quantity.all().join(", ")),
        oracle: check.oracle.clone(),
        class,
        abscissa: Vec::new(),
        ours: vec![vec![observed]],
        reference: vec![vec![order.expected]],
        error,
        verdict: Verdict::of(error, Some(order.within), None, None),
        why: check.why.trim().to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_of_one_last_digit_passes_and_nan_never_does() {
        assert!(Verdict::of(0.00354 - 0.00353, Some(1e-5), None, None).passed());
        assert!(!Verdict::of(1.1e-5, Some(1e-5), None, None).passed());
        assert!(!Verdict::of(f64::NAN, Some(1.0), None, None).passed());
        assert!(!Verdict::of(f64::NAN, None, Some(0.0), None).passed());
        assert!(norm(Norm::Max, [f64::NAN, 1.0].into_iter()).is_nan());
    }

    #[test]
    fn interpolation_takes_records_as_they_are_and_cubics_exactly() {
        let x: Vec<f64> = (0..9).map(|i| f64::from(i) * 0.25).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x * x - x).collect();
        assert_eq!(interpolated(&x, &y, 0.5), Ok(y[2]));
        for at in [0.1, 0.9, 1.99] {
            let value = interpolated(&x, &y, at).expect("inside");
            assert!((value - (at * at * at - at)).abs() < 1e-14);
        }
        assert!(interpolated(&x, &y, 2.1).is_err());
    }
}
