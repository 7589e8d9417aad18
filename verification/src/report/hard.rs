//! The page of hard cases: what makes them hard, what the plain method does, what ours does.

use std::time::Duration;

use ancf_check::Examined;
use ancf_check::case::Hard;
use askama::Template;

use super::Entry;
use super::figure::{self, FigureView};
use super::page::Page;
use crate::Failure;

#[derive(Template)]
#[template(path = "hard.html")]
struct Body<'a> {
    cases: Vec<View<'a>>,
    /// Cases that could not be examined, so that nobody knows whether they are hard.
    unknown: Vec<&'a str>,
}

/// A hard case.
struct View<'a> {
    name: &'a str,
    title: &'a str,
    claim: &'a str,
    hard: &'a Hard,
    pass: bool,
    compared: usize,
    seconds: String,
    /// Left out of `cargo test`.
    nightly: bool,
    figure: Option<FigureView>,
}

/// All cases that say what makes them hard.
pub fn page(entries: &[Entry]) -> Result<Page, Failure> {
    let cases: Vec<_> = entries
        .iter()
        .filter_map(|entry| entry.examined.as_ref().ok().map(|examined| (entry, examined)))
        .filter_map(|(entry, examined)| view(&entry.name, entry.took, examined))
        .collect();
    let unknown: Vec<_> =
        entries.iter().filter(|entry| entry.examined.is_err()).map(|entry| entry.name.as_str()).collect();
    let pass = (!cases.is_empty()).then(|| cases.iter().all(|case| case.pass) && unknown.is_empty());
    Ok(Page {
        id: "hard-cases".into(),
        title: "Hard cases".into(),
        pass,
        listed: true,
        body: Body { cases, unknown }.render()?,
    })
}

fn view<'a>(name: &'a str, took: Duration, examined: &'a Examined) -> Option<View<'a>> {
    let text = &examined.case.text;
    Some(View {
        name,
        title: &text.title,
        claim: &text.claim,
        hard: text.hard.as_ref()?,
        pass: examined.passed(),
        compared: examined.outcomes.len(),
        seconds: format!("{:.1} s", took.as_secs_f64()),
        nightly: text.nightly,
        figure: text.figure.first().map(|figure| figure::of_case(examined, figure)),
    })
}
