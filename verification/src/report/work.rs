//! Pages of what accuracy costs, from the newest measurement.

use std::path::Path;

use ancf_check::Suite;
use ancf_verification::work::{self, Code, Norm, Point, Results, Verdict, diagram, on_front};
use askama::Template;

use super::number::short;
use super::page::Page;
use crate::Failure;
use crate::cost::{found, time, wanted};

#[derive(Template)]
#[template(path = "work.html")]
struct Body<'a> {
    results: &'a Results,
    diagrams: Vec<(&'a Norm, String)>,
    claims: Vec<ClaimView<'a>>,
    norms: Vec<&'a str>,
    lines: Vec<Line<'a>>,
    /// Settings that are not in the table, as others are better in every respect.
    beaten: usize,
}

struct ClaimView<'a> {
    wanted: String,
    found: String,
    verdict: &'static str,
    badge: &'static str,
    /// Per code its name, setting, error, time.
    sides: Vec<[String; 4]>,
    claim: &'a Verdict,
}

struct Line<'a> {
    point: &'a Point,
    code: &'static str,
    errors: Vec<String>,
    seconds: String,
    spread: String,
    build: String,
}

#[derive(Template)]
#[template(path = "work_missing.html")]
struct Missing<'a> {
    names: &'a [String],
}

/// One page per problem that was measured; where none was, one that says how to.
pub fn pages(suite: &Suite, folder: &Path) -> Result<Vec<Page>, Failure> {
    let names = work::names(suite)?;
    let (mut pages, mut missing) = (Vec::new(), Vec::new());
    for name in names {
        match Results::read(folder, &name)? {
            Some(results) => pages.push(page(&results, pages.is_empty())?),
            None => missing.push(name),
        }
    }
    if !missing.is_empty() {
        pages.push(Page {
            id: "cost-not-measured".into(),
            title: "What accuracy costs: not measured".into(),
            pass: None,
            listed: pages.is_empty(),
            body: Missing { names: &missing }.render()?,
        });
    }
    Ok(pages)
}

fn page(results: &Results, first: bool) -> Result<Page, Failure> {
    let norms: Vec<&str> = results.norm.keys().map(String::as_str).collect();
    let kept = kept(results);
    let body = Body {
        results,
        diagrams: results
            .norm
            .iter()
            .map(|(key, norm)| Ok((norm, diagram(results, key)?)))
            .collect::<Result<_, Failure>>()?,
        claims: results.claims.iter().map(claim).collect(),
        lines: results
            .points
            .iter()
            .zip(&kept)
            .filter(|(_, kept)| **kept)
            .map(|(p, _)| line(p, &norms))
            .collect(),
        beaten: kept.iter().filter(|kept| !**kept).count(),
        norms,
    };
    Ok(Page {
        id: format!("cost-{}", results.name),
        title: if first { format!("What accuracy costs: {}", results.title) } else { results.title.clone() },
        pass: (!results.claims.is_empty())
            .then(|| results.claims.iter().all(|claim| claim.met == Some(true))),
        listed: first,
        body: body.render()?,
    })
}

/// Whether a point is on the front of its line for some norm. A table of all would hide them.
fn kept(results: &Results) -> Vec<bool> {
    results
        .points
        .iter()
        .map(|point| {
            let line: Vec<&Point> = results.points.iter().filter(|other| other.line == point.line).collect();
            results.norm.keys().any(|norm| {
                on_front(&line, norm).iter().zip(&line).any(|(on, other)| *on && std::ptr::eq(*other, point))
            })
        })
        .collect()
}

fn claim(claim: &Verdict) -> ClaimView<'_> {
    let (verdict, badge) = match claim.met {
        Some(true) => ("met", ""),
        Some(false) => ("missed", " bad"),
        None => ("undecided", " mark"),
    };
    let sides = [("ours", &claim.ours), ("theirs", &claim.theirs)].map(|(code, cheapest)| {
        let (setting, error, seconds) = match cheapest {
            Some(c) => (c.setting.clone(), c.error.map(short).unwrap_or_else(|| "–".into()), time(c.seconds)),
            None => ("no setting that was run is good enough".to_owned(), "–".into(), "–".into()),
        };
        [code.to_owned(), setting, error, seconds]
    });
    ClaimView { wanted: wanted(claim), found: found(claim), verdict, badge, sides: sides.into(), claim }
}

fn line<'a>(point: &'a Point, norms: &[&str]) -> Line<'a> {
    let error = |norm: &&str| point.error.get(*norm).map_or_else(|| "–".to_owned(), |&e| short(e));
    let seconds = point.seconds;
    Line {
        point,
        code: if point.code == Code::Ours { "ours" } else { "other" },
        errors: norms.iter().map(error).collect(),
        seconds: time(seconds.median),
        spread: if seconds.runs > 1 {
            format!("{} … {}", time(seconds.least), time(seconds.largest))
        } else {
            "once".into()
        },
        build: point.build.map_or_else(|| "–".to_owned(), |b| time(b.median)),
    }
}
