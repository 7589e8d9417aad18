//! The report: every case run today, beside its references.

//!
//! | module | subject |
//! |---|---|
//! | `page` | the list of pages, and the one file that holds them |
//! | `overview`, `case`, `hard`, `work`, `accuracy`, `scaling`, `instructions`, `mutants` | a kind of page each: what its template shows, made from what was found |
//! | `check`, `figure`, `number` | parts of a case's page |
//! | `before` | an earlier report, to compare with |
//!
//! A further kind of page is a module with a template that returns a [`Page`], and a line in
//! [`pages`].

mod accuracy;
mod before;
mod case;
mod check;
mod figure;
mod hard;
mod instructions;
mod mutants;
mod number;
mod overview;
mod page;
mod scaling;
mod work;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use ancf_check::{Examined, Outcome, Suite, audit, examine};
use ancf_mutants::record::Record;
use serde::Serialize;

use self::before::Before;
pub use self::number::short;
use self::overview::Made;
use self::page::{Page, document};
use crate::{Failure, chosen, parallel};

/// A case with its results.
pub struct Entry {
    /// Name of the folder.
    pub name: String,
    /// What was found, or why nothing could be.
    pub examined: ancf_check::Result<Examined>,
    /// Wall time.
    pub took: Duration,
}

/// `report.json`.
#[derive(Serialize)]
struct Json<'a> {
    version: &'static str,
    date: &'a str,
    machine: &'a str,
    passed: bool,
    problems: &'a [String],
    cases: Vec<JsonCase<'a>>,
}

#[derive(Serialize)]
struct JsonCase<'a> {
    name: &'a str,
    title: Option<&'a str>,
    claim: Option<&'a str>,
    passed: bool,
    seconds: f64,
    error: Option<String>,
    outcomes: &'a [Outcome],
}

/// Runs the cases and writes `index.html` and `report.json` into `out`. The answer is whether every
/// claim holds, and no error is ten times what it was in the report `against`.
pub fn write(suite: &Suite, out: &Path, against: Option<&Path>, cases: &[String]) -> Result<bool, Failure> {
    let names = chosen(suite, cases)?;
    let before = against.map(Before::read).transpose()?;
    let problems = audit(suite)?;
    let entries = run_all(suite, &names);
    let passed =
        problems.is_empty() && entries.iter().all(|e| e.examined.as_ref().is_ok_and(Examined::passed));

    let made = Made { date: now(), machine: machine() };
    let json = Json {
        version: env!("CARGO_PKG_VERSION"),
        date: &made.date,
        machine: &made.machine,
        passed,
        problems: &problems,
        cases: entries
            .iter()
            .map(|entry| JsonCase {
                name: &entry.name,
                title: entry.examined.as_ref().ok().map(|e| e.case.text.title.as_str()),
                claim: entry.examined.as_ref().ok().map(|e| e.case.text.claim.as_str()),
                passed: entry.examined.as_ref().is_ok_and(Examined::passed),
                seconds: entry.took.as_secs_f64(),
                error: entry.examined.as_ref().err().map(ToString::to_string),
                outcomes: entry.examined.as_ref().map_or(&[], |e| &e.outcomes),
            })
            .collect(),
    };
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let measured = suite.root.join(crate::cost::FOLDER);
    let html = document(&pages(suite, &made, &entries, &problems, before.as_ref(), &measured)?)?;
    for (name, text) in [("report.json", serde_json::to_string_pretty(&json)?), ("index.html", html)] {
        let path = out.join(name);
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
    }

    for problem in &problems {
        eprintln!("files: {problem}");
    }
    let mut count = (0, 0);
    let mut lost = false;
    for entry in &entries {
        match &entry.examined {
            Ok(examined) => {
                let gained = before.as_ref().and_then(|b| b.gained(&entry.name, examined.outcomes.iter()));
                if let Some(digits) = gained.filter(|&digits| digits <= -1.0) {
                    lost = true;
                    eprintln!("LOST {:.1} digits in {} since the report compared with", -digits, entry.name);
                }
                for wide in wide(&examined.outcomes) {
                    eprintln!("WIDE {}: {wide}", entry.name);
                }
                for outcome in &examined.outcomes {
                    if outcome.verdict.passed() {
                        count.0 += 1;
                    } else {
                        count.1 += 1;
                        eprintln!("FAILED {}", outcome.line(&entry.name));
                    }
                }
            }
            Err(error) => {
                count.1 += 1;
                eprintln!("FAILED {error}");
            }
        }
    }
    eprintln!(
        "{} cases: {} passed, {} failed · {}",
        entries.len(),
        count.0,
        count.1,
        out.join("index.html").display()
    );
    Ok(passed && !lost)
}

/// A tolerance may be so many times the largest error that it is for; beyond, it holds nothing,
/// unless its reason says why.
const WIDE: f64 = 30.0;
/// Errors below this are a few roundings, which differ from machine to machine.
const ROUNDINGS: f64 = 1e-15;

/// Tolerances of a check that are far above all errors that they are for.
fn wide(outcomes: &[Outcome]) -> Vec<String> {
    let mut largest: BTreeMap<(usize, u64), &Outcome> = BTreeMap::new();
    for outcome in outcomes {
        if let Some(allowed) = outcome.verdict.allowed {
            let known = largest.entry((outcome.check, allowed.to_bits())).or_insert(outcome);
            if outcome.error > known.error {
                *known = outcome;
            }
        }
    }
    let wide = |outcome: &&Outcome| {
        outcome.verdict.allowed.is_some_and(|allowed| allowed > WIDE * outcome.error.max(ROUNDINGS))
    };
    let line = |outcome: &Outcome| {
        let allowed = short(outcome.verdict.allowed.unwrap_or_default());
        format!(
            "{} ({}) errs by {} where {allowed} is allowed",
            outcome.quantity,
            outcome.label,
            short(outcome.error)
        )
    };
    largest.into_values().filter(wide).map(line).collect()
}

/// All pages in the order of reading; `measured` is the folder of `verify work-precision`.
fn pages(
    suite: &Suite,
    made: &Made,
    entries: &[Entry],
    problems: &[String],
    before: Option<&Before>,
    measured: &Path,
) -> Result<Vec<Page>, Failure> {
    let mut pages = vec![overview::page(made, entries, problems, before)?];
    for entry in entries {
        pages.push(case::page(suite, entry)?);
    }
    pages.push(hard::page(entries)?);
    pages.extend(work::pages(suite, measured)?);
    pages.push(accuracy::page(&suite.root.join(crate::accuracy::FILE))?);
    pages.push(scaling::page(&suite.root.join(crate::scaling::FILE))?);
    pages.push(instructions::page(&suite.root.join(crate::instructions::HISTORY))?);
    let record = Record::path(&suite.root);
    pages.push(mutants::page(Record::read(&record)?.as_ref(), Path::new(&suite.short(&record)))?);
    Ok(pages)
}

/// Runs cases on all cores; cases are independent of each other.
fn run_all(suite: &Suite, names: &[String]) -> Vec<Entry> {
    parallel::map(names, String::clone, |name| {
        let start = Instant::now();
        let examined = examine(suite, name);
        Entry { name: name.clone(), examined, took: start.elapsed() }
    })
}

/// Day and time.
pub fn now() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M UTC").to_string()
}

/// Processor, cores and system.
pub fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|l| l.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "{}, {cores} cores, {} {}",
        cpu.unwrap_or_else(|| "unknown processor".to_owned()),
        std::env::consts::OS,
        std::env::consts::ARCH
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cases run as ever, one that compares curves and one that is hard, and one that cannot be
    /// run.
    fn file() -> String {
        let suite = Suite::here();
        let names = ["distributed-load", "euler-column", "hard-shape-parameter"].map(str::to_owned);
        let mut entries = run_all(&suite, &names);
        let error = ancf_check::Error::Check {
            case: "broken".into(),
            check: "1".into(),
            message: "expected <a>, found <b>".into(),
        };
        entries.push(Entry { name: "broken".into(), examined: Err(error), took: Duration::ZERO });
        let made = Made { date: "2026-01-02 03:04 UTC".into(), machine: "a machine".into() };
        document(&pages(&suite, &made, &entries, &[], None, Path::new("nowhere")).expect("pages"))
            .expect("a file")
    }

    fn between<'a>(text: &'a str, start: &str, end: &str) -> Vec<&'a str> {
        text.split(start).skip(1).filter_map(|rest| rest.split(end).next()).collect()
    }

    #[test]
    fn the_file_needs_no_other_and_its_links_lead_somewhere() {
        let file = file();
        let links = between(&file, "href=\"", "\"");
        assert!(links.contains(&"#euler-column"));
        for link in links {
            let id = link.strip_prefix('#').unwrap_or_else(|| panic!("{link} leads out of the file"));
            assert!(file.contains(&format!("id=\"{id}\"")), "{link} leads nowhere");
        }
        for foreign in ["<script", "<link", "<img", "src=", "url(", "@import"] {
            assert!(!file.contains(foreign), "{foreign}");
        }
    }

    #[test]
    fn a_case_of_curves_shows_ours_upon_the_reference_their_difference_and_where_it_comes_from() {
        let file = file();
        let page = between(&file, "<section class=\"page\" id=\"distributed-load\">", "</section>");
        for text in ["<pre>", "Ours upon the reference.", "Difference.", "tolerance", "citation", "SHA-256"] {
            assert!(page.iter().any(|page| page.contains(text)), "`{text}` is missing");
        }
        assert!(
            page.iter().all(|page| page.matches("<svg").count() >= 3 && !page.contains("nothing to draw"))
        );
    }

    #[test]
    fn the_page_of_hard_cases_shows_those_that_say_why_they_are() {
        let file = file();
        let page = between(&file, "<section class=\"page\" id=\"hard-cases\">", "</section>");
        let [page] = page[..] else { panic!("one page of hard cases") };
        assert!(page.contains("href=\"#hard-shape-parameter\"") && page.contains("double precision"));
        assert!(!page.contains("href=\"#euler-column\"") && page.contains("broken could not be examined"));
        assert!(page.contains("<svg") && !page.contains("nothing to draw"));
    }

    #[test]
    fn a_case_that_cannot_be_examined_says_why_and_fails() {
        let file = file();
        assert!(file.contains("expected &#60;a&#62;, found &#60;b&#62;"));
        let overview = between(&file, "id=\"overview\">", "</h1>");
        assert!(overview.iter().all(|heading| heading.contains("fail")) && overview.len() == 1);
    }
}
