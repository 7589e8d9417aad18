//! The first page: a line for each case and class of oracle.

use ancf_check::case::Class;
use ancf_check::{Examined, Outcome};
use askama::Template;

use super::Entry;
use super::before::Before;
use super::number::{limits, margin, short, signed};
use super::page::Page;
use crate::Failure;

#[derive(Template)]
#[template(path = "overview.html")]
struct Body<'a> {
    version: &'static str,
    made: &'a Made,
    problems: &'a [String],
    passed: usize,
    failed: usize,
    /// Published numbers that are not met to the last digit.
    beyond: usize,
    /// Day of the report that this one is compared with.
    before: Option<&'a str>,
    cases: Vec<Line<'a>>,
}

/// When and where the report was made.
pub struct Made {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
}

/// A case.
struct Line<'a> {
    name: &'a str,
    title: &'a str,
    claim: &'a str,
    error: Option<String>,
    worst: Vec<Worst>,
}

/// The outcome of a case with the least margin, of one class of oracle.
struct Worst {
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

/// The overview of all cases and of what is wrong with files.
pub fn page(
    made: &Made,
    entries: &[Entry],
    problems: &[String],
    before: Option<&Before>,
) -> Result<Page, Failure> {
    let outcomes = || entries.iter().filter_map(|e| e.examined.as_ref().ok()).flat_map(|e| &e.outcomes);
    let failed = outcomes().filter(|o| !o.verdict.passed()).count()
        + entries.iter().filter(|e| e.examined.is_err()).count();
    let body = Body {
        version: env!("CARGO_PKG_VERSION"),
        made,
        problems,
        passed: outcomes().filter(|o| o.verdict.passed()).count(),
        failed,
        beyond: outcomes().filter(|o| o.verdict.beyond_last_digit).count(),
        before: before.map(|b| b.date.as_str()),
        cases: entries.iter().map(|entry| line(entry, before)).collect(),
    };
    Ok(Page {
        id: "overview".into(),
        title: "Overview".into(),
        pass: Some(failed == 0 && problems.is_empty()),
        listed: true,
        body: body.render()?,
    })
}

fn line<'a>(entry: &'a Entry, before: Option<&Before>) -> Line<'a> {
    match &entry.examined {
        Ok(examined) => Line {
            name: &entry.name,
            title: &examined.case.text.title,
            claim: &examined.case.text.claim,
            error: None,
            worst: worst(examined, before),
        },
        Err(error) => Line {
            name: &entry.name,
            title: &entry.name,
            claim: "",
            error: Some(error.to_string()),
            worst: Vec::new(),
        },
    }
}

fn worst(examined: &Examined, before: Option<&Before>) -> Vec<Worst> {
    let mut classes: Vec<Option<Class>> = examined.outcomes.iter().map(|o| o.class).collect();
    classes.sort();
    classes.dedup();
    classes.into_iter().filter_map(|class| of_class(examined, class, before)).collect()
}

fn of_class(examined: &Examined, class: Option<Class>, before: Option<&Before>) -> Option<Worst> {
    let outcomes = || examined.outcomes.iter().filter(move |o| o.class == class);
    let orders: Vec<String> =
        outcomes().filter(|o| o.is_rate()).filter_map(|o| Some(format!("{:.2}", o.numbers()?.0))).collect();
    let urgency = |o: &&Outcome| if o.verdict.passed() { o.margin().unwrap_or(99.0) } else { -99.0 };
    let least = |a: &&Outcome, b: &&Outcome| urgency(a).total_cmp(&urgency(b));
    // Rates are taken only if there is nothing else: their margin is that of an exponent.
    let pick = outcomes()
        .filter(|o| !o.is_rate() && o.verdict.allowed.is_some())
        .min_by(least)
        .or_else(|| outcomes().min_by(least))?;
    let oracle = pick.oracle.as_ref().and_then(|o| examined.tables.get(o));
    let change = before.and_then(|b| b.gained(&examined.case.name, outcomes()));
    Some(Worst {
        class: class.map_or("bound", Class::word),
        oracle: oracle.map_or_else(String::new, |t| t.provenance.title.clone()),
        quantity: pick.quantity.clone(),
        error: short(pick.error),
        allowed: limits(pick),
        margin: margin(pick),
        order: orders.join(", "),
        trend: match change {
            None => String::new(),
            Some(digits) if digits.abs() < 0.05 => "=".to_owned(),
            Some(digits) => signed(digits),
        },
        lost: change.is_some_and(|digits| digits <= -1.0),
        pass: outcomes().all(|o| o.verdict.passed()),
    })
}
