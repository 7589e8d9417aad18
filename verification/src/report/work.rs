//! What accuracy costs, from the newest measurement: a page of all claims, and one per problem.

use std::path::Path;

use ancf_check::Suite;
use ancf_verification::work::{
    self, Code, DECADES, Decade, LEAD, Norm, Paid, Point, Results, Verdict, decades, diagram, on_front,
    others,
};
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
    winners: Vec<Winners<'a>>,
    claims: Vec<ClaimView<'a>>,
    prices: Vec<PriceView>,
    norms: Vec<&'a str>,
    lines: Vec<Line<'a>>,
    /// Settings that are not in the table, as others are better in every respect.
    beaten: usize,
}

struct ClaimView<'a> {
    wanted: Vec<String>,
    found: Vec<String>,
    verdict: &'static str,
    badge: &'static str,
    /// Per code its name, setting, error, time.
    sides: Vec<[String; 4]>,
    claim: &'a Verdict,
}

/// The fastest of every code to every decade of a norm.
struct Winners<'a> {
    title: &'a str,
    codes: Vec<&'static str>,
    rows: Vec<Row>,
}

struct Row {
    limit: String,
    ours: Option<[String; 2]>,
    /// Time and setting of every other code.
    others: Vec<Option<[String; 2]>>,
    ratio: String,
    verdict: &'static str,
    badge: &'static str,
}

struct PriceView {
    met: bool,
    /// Texts, and whether they are numbers.
    cells: Vec<(String, bool)>,
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
#[template(path = "work_overview.html")]
struct Overview<'a> {
    problems: Vec<(&'a Results, Vec<ClaimView<'a>>)>,
    /// Per problem and norm its title and, per decade, the lead of ours.
    leads: Vec<(&'a Results, &'a str, Vec<Option<Lead>>)>,
    decades: Vec<String>,
    /// Names of problems that were not measured, or why their results cannot be read.
    missing: Vec<String>,
}

struct Lead {
    ratio: String,
    against: &'static str,
    badge: &'static str,
}

/// A page of all claims, and one per problem that was measured. Where none was, the first says how
/// to.
pub fn pages(suite: &Suite, folder: &Path) -> Result<Vec<Page>, Failure> {
    let (mut measured, mut missing) = (Vec::new(), Vec::new());
    for name in work::names(suite)? {
        match Results::read(folder, &name) {
            Ok(Some(results)) => measured.push(results),
            Ok(None) => missing.push(name),
            Err(error) => missing.push(error.to_string()),
        }
    }
    let overview = Page {
        id: "what-accuracy-costs".into(),
        title: "What accuracy costs".into(),
        pass: measured.iter().any(|r| !r.claims.is_empty()).then(|| measured.iter().all(holds)),
        listed: true,
        body: Overview {
            problems: measured.iter().map(|r| (r, r.claims.iter().map(claim).collect())).collect(),
            leads: measured.iter().flat_map(leads).collect(),
            decades: DECADES.map(short).to_vec(),
            missing,
        }
        .render()?,
    };
    let pages = measured.iter().map(page).collect::<Result<Vec<_>, _>>()?;
    Ok([overview].into_iter().chain(pages).collect())
}

fn page(results: &Results) -> Result<Page, Failure> {
    let norms: Vec<&str> = results.norm.keys().map(String::as_str).collect();
    let kept = kept(results);
    let body = Body {
        results,
        diagrams: results
            .norm
            .iter()
            .map(|(key, norm)| Ok((norm, diagram(results, key)?)))
            .collect::<Result<_, Failure>>()?,
        winners: results.norm.iter().map(|(key, norm)| winners(results, key, norm)).collect(),
        claims: results.claims.iter().map(claim).collect(),
        prices: results.prices.iter().map(price).collect(),
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
        title: results.title.clone(),
        pass: (!results.claims.is_empty()).then(|| holds(results)),
        listed: false,
        body: body.render()?,
    })
}

/// Per norm of a problem, the lead of ours decade by decade.
fn leads(results: &Results) -> Vec<(&Results, &str, Vec<Option<Lead>>)> {
    let of = |key: &String| {
        let found = decades(&results.points, key);
        let lead = |limit: f64| {
            let at = found.iter().find(|decade| decade.limit == limit)?;
            let (verdict, badge) = place(at);
            let against = at.others.first().map_or(verdict, |point| point.code.name());
            let ratio = at.ratio().map_or_else(|| "–".to_owned(), times);
            Some(Lead { ratio, against, badge })
        };
        DECADES.map(lead).into()
    };
    results.norm.iter().map(|(key, norm)| (results, norm.title.as_str(), of(key))).collect()
}

/// Where ours stands in a decade, and the badge for it.
fn place(decade: &Decade) -> (&'static str, &'static str) {
    match (decade.ours, decade.ratio()) {
        (None, _) => ("ours is not exact enough", " bad"),
        (_, None) => ("ours alone", ""),
        (_, Some(ratio)) if ratio >= LEAD => ("first", ""),
        (_, Some(ratio)) if ratio >= 1.0 => ("first, narrowly", " mark"),
        _ => ("not first", " bad"),
    }
}

fn times(ratio: f64) -> String {
    if ratio < 9.95 { format!("{ratio:.1} ×") } else { format!("{ratio:.0} ×") }
}

fn winners<'a>(results: &'a Results, key: &str, norm: &'a Norm) -> Winners<'a> {
    let codes = others(&results.points);
    let cell = |point: &Point| [time(point.seconds.median), point.name()];
    let row = |decade: &Decade| {
        let of =
            |code: &Code| decade.others.iter().find(|point| point.code == *code).map(|point| cell(point));
        let (verdict, badge) = place(decade);
        Row {
            limit: short(decade.limit),
            ours: decade.ours.map(cell),
            others: codes.iter().map(of).collect(),
            ratio: decade.ratio().map_or_else(|| "–".to_owned(), times),
            verdict,
            badge,
        }
    };
    let rows = decades(&results.points, key).iter().map(row).collect();
    Winners { title: &norm.title, codes: codes.iter().map(|code| code.name()).collect(), rows }
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
    let sides = [("ours", &claim.ours), ("against", &claim.theirs)].map(|(code, cheapest)| {
        let (setting, error, seconds) = match cheapest {
            Some(c) => (c.setting.clone(), c.error.map(short).unwrap_or_else(|| "–".into()), time(c.seconds)),
            None => ("no setting that was run is good enough".to_owned(), "–".into(), "–".into()),
        };
        [code.to_owned(), setting, error, seconds]
    });
    ClaimView { wanted: wanted(claim), found: found(claim), verdict, badge, sides: sides.into(), claim }
}

/// Whether everything that is claimed of a problem was found.
fn holds(results: &Results) -> bool {
    results.claims.iter().all(|claim| claim.met == Some(true)) && results.prices.iter().all(|paid| paid.met)
}

fn price(paid: &Paid) -> PriceView {
    let none = || "–".to_owned();
    let times = |ratio: Option<f64>| ratio.map_or_else(none, |ratio| format!("{ratio:.1} ×"));
    let [ours, theirs] = [&paid.ours, &paid.theirs].map(|cheapest| match cheapest {
        Some(c) => (c.setting.clone(), time(c.seconds)),
        None => (none(), none()),
    });
    let cells = [
        (short(paid.wanted), true),
        (paid.alone.setting.clone(), false),
        (paid.alone.error.map_or_else(none, short), true),
        (time(paid.alone.seconds), true),
        (ours.0, false),
        (ours.1, true),
        (times(paid.dearer), true),
        (theirs.0, false),
        (theirs.1, true),
        (times(paid.faster), true),
    ];
    PriceView { met: paid.met, cells: cells.into() }
}

fn line<'a>(point: &'a Point, norms: &[&str]) -> Line<'a> {
    let error = |norm: &&str| point.error.get(*norm).map_or_else(|| "–".to_owned(), |&e| short(e));
    let seconds = point.seconds;
    Line {
        point,
        code: if point.code.is_ours() { "ours" } else { "other" },
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

#[cfg(test)]
mod tests {
    use super::*;
    use ancf_verification::work::{Cheapest, Code, LeftOut, Spread};

    fn point(code: Code, error: f64, seconds: f64) -> Point {
        Point {
            code,
            method: "m".into(),
            line: if code == Code::Ours { "RPIM" } else { "Exudyn" }.into(),
            setting: format!("nodes = {seconds}"),
            wanted: None,
            error: [("tip".to_owned(), error)].into(),
            seconds: Spread::of(&[seconds]),
            build: None,
            whole: None,
            degrees_of_freedom: None,
            steps: 1,
            newton_iterations: 1,
            tangent_evaluations: 1,
            factorizations: 1,
        }
    }

    fn results() -> Results {
        let found = |seconds| Some(Cheapest { setting: "RPIM".into(), error: Some(1e-4), seconds });
        Results {
            name: "half-circle".into(),
            title: "Half circle".into(),
            about: "Bent.".into(),
            date: "2026-01-02".into(),
            machine: "a machine".into(),
            tools: "Exudyn 1".into(),
            quick: true,
            norm: [(
                "tip".to_owned(),
                Norm {
                    title: "tip [m]".into(),
                    reference: "arc".into(),
                    class: "closed form".into(),
                    why: "Exact.".into(),
                },
            )]
            .into(),
            points: vec![
                point(Code::Ours, 1e-4, 0.25),
                point(Code::Ours, 1e-3, 0.75),
                point(Code::Exudyn, 1e-4, 2.5),
            ],
            narrow: "Because it is.".into(),
            claims: vec![Verdict {
                says: "So it is.".into(),
                limit: Some(("tip".into(), 1e-3)),
                times: 30.0,
                ours: found(0.25),
                theirs: found(2.5),
                ratio: Some(10.0),
                met: Some(false),
            }],
            prices: vec![],
            left_out: vec![LeftOut { what: "explicit".into(), why: "wrong < right".into() }],
        }
    }

    #[test]
    fn a_page_shows_diagram_claims_settings_and_what_is_missing() {
        let page = page(&results()).expect("a page");
        assert_eq!(page.pass, Some(false));
        for text in [
            "<svg",
            "10 ×",
            "Because it is.",
            "So it is.",
            "30 × faster",
            "10.0 × faster",
            "missed",
            "2.50 s",
            "--quick",
            "closed form",
            "wrong &#60; right",
        ] {
            assert!(page.body.contains(text), "`{text}` is missing in {}", page.body);
        }
        assert!(
            page.body.contains("nodes = 0.25") && !page.body.contains("nodes = 0.75"),
            "beaten: csv only"
        );
        assert!(page.body.contains("1 further setting"));
    }

    #[test]
    fn what_is_not_measured_says_how_and_what_is_stands_in_the_overview() {
        let suite = Suite::here();
        let none = pages(&suite, Path::new("nowhere")).expect("pages");
        assert!(none.len() == 1 && none[0].pass.is_none() && none[0].body.contains("work-precision</code>"));
        let folder = tempfile::tempdir().expect("a folder");
        results().write(folder.path()).unwrap_or_else(|e| panic!("{e}"));
        std::fs::write(folder.path().join("roll-up.json"), "{}").expect("a file of another version");
        let some = pages(&suite, folder.path()).expect("pages");
        assert_eq!(
            some.iter().map(|p| p.id.as_str()).collect::<Vec<_>>(),
            ["what-accuracy-costs", "cost-half-circle"]
        );
        assert!(some[0].body.contains("#cost-half-circle") && some[0].body.contains("measure it again"));
        assert_eq!(some[0].pass, Some(false));
    }
}
