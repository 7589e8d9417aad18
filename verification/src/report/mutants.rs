//! The page of the mutation test.

use std::path::Path;

use ancf_mutants::record::{Counts, Record};
use askama::Template;

use super::page::Page;
use crate::Failure;

/// Part of the viable mutants that shall be caught, in every folder.
const WANTED: f64 = 0.9;

#[derive(Template)]
#[template(path = "mutants.html")]
struct Body<'a> {
    record: Option<&'a Record>,
    path: String,
    wanted: String,
    score: String,
    /// Where the score of all mutants lies, if those tried are a sample.
    interval: Option<[String; 2]>,
    rows: Vec<Row<'a>>,
    unexplained: usize,
    /// Survivors with which nothing is different.
    equivalent: usize,
}

/// A folder, or all.
struct Row<'a> {
    name: &'a str,
    counts: &'a Counts,
    score: String,
}

/// Whether faults put into the sources are caught.
pub fn page(record: Option<&Record>, path: &Path) -> Result<Page, Failure> {
    let total = record.map(|r| r.total).unwrap_or_default();
    let unexplained = record.map_or(0, |r| r.survivor.iter().filter(|s| !s.explained()).count());
    let equivalent = record.map_or(0, |r| r.equivalent(None));
    let rows = record.iter().flat_map(|record| record.scores());
    let body = Body {
        record,
        path: path.display().to_string(),
        wanted: percent(WANTED),
        score: written(total.score(equivalent)),
        interval: (total.tried < total.exist).then(|| interval(&total, equivalent).map(percent)),
        rows: rows.map(|(name, counts, score)| Row { name, counts, score: written(score) }).collect(),
        unexplained,
        equivalent,
    };
    Ok(Page {
        id: "can-the-checks-fail".into(),
        title: "Can the checks fail?".into(),
        pass: record.filter(|_| total.viable() > 0).map(|record| {
            record.scores().filter_map(|(_, _, score)| score).all(|score| score >= WANTED) && unexplained == 0
        }),
        listed: true,
        body: body.render()?,
    })
}

fn written(score: Option<f64>) -> String {
    score.map_or_else(|| "–".to_owned(), percent)
}

/// Whole percent, but 100 only for all.
fn percent(part: f64) -> String {
    format!("{:.0} %", if part < 1.0 { (100.0 * part).round().min(99.0) } else { 100.0 })
}

/// The interval that covers the score of all mutants with 95 %, from a sample of them (E. B.
/// Wilson, J. Am. Stat. Assoc. 22, 1927, 209–212).
fn interval(sample: &Counts, equivalent: usize) -> [f64; 2] {
    const QUANTILE: f64 = 1.96;
    let Some(p) = sample.score(equivalent) else { return [0.0, 1.0] };
    let n = (sample.viable() - equivalent) as f64;
    let z2 = QUANTILE * QUANTILE / n;
    let middle = (p + z2 / 2.0) / (1.0 + z2);
    let half = QUANTILE / (1.0 + z2) * (p * (1.0 - p) / n + z2 / (4.0 * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use ancf_mutants::reasons::Survivor;
    use ancf_mutants::record::Again;

    use super::*;

    fn record() -> Record {
        let total = Counts { exist: 900, tried: 105, caught: 90, timed_out: 5, unviable: 5, missed: 5 };
        Record {
            date: "2026-01-02".into(),
            commit: "abc1234".into(),
            command: ".ci/mutants --seed 9".into(),
            again: None,
            total,
            folder: [("src/basis".to_owned(), total)].into(),
            survivor: vec![Survivor {
                mutant: "src/basis/a.rs:1:2: replace < with <=".into(),
                reason: "Equal either way.".into(),
                equivalent: false,
            }],
        }
    }

    #[test]
    fn the_page_shows_score_date_folders_and_survivors_with_reasons() {
        let mut record = record();
        let again = Again { date: "2026-02-03".into(), commit: "def5678".into() };
        record.again = Some(again);
        let page = page(Some(&record), Path::new("mutants.toml")).expect("a page");
        assert_eq!(page.pass, Some(true));
        for text in [
            "95 %",
            "2026-01-02",
            "abc1234",
            "2026-02-03",
            "def5678",
            ".ci/mutants --seed 9",
            "src/basis",
            "Equal either way.",
            "replace &#60; with",
        ] {
            assert!(page.body.contains(text), "`{text}` is missing in {}", page.body);
        }
    }

    #[test]
    fn survivors_without_reason_and_a_low_score_do_not_pass() {
        let mut unexplained = record();
        unexplained.survivor[0].reason = "to be explained".into();
        let mut low = record();
        (low.total.caught, low.total.missed) = (80, 15);
        // Enough of all, and too few in one folder.
        let mut uneven = record();
        let weak = Counts { exist: 9, tried: 5, caught: 4, missed: 1, ..Counts::default() };
        uneven.folder.insert("src/linear".into(), weak);
        for record in [unexplained, low, uneven] {
            assert_eq!(page(Some(&record), Path::new("")).expect("a page").pass, Some(false));
        }
    }

    /// A survivor that no test could catch counts neither as caught nor as missed.
    #[test]
    fn equivalent_survivors_do_not_count() {
        let mut record = record();
        let counts = Counts { exist: 900, tried: 11, caught: 9, missed: 2, ..Counts::default() };
        (record.total, record.folder["src/basis"]) = (counts, counts);
        assert_eq!(page(Some(&record), Path::new("")).expect("a page").pass, Some(false));
        record.survivor[0].equivalent = true;
        let page = page(Some(&record), Path::new("")).expect("a page");
        assert_eq!(page.pass, Some(true));
        assert!(page.body.contains("90 %") && page.body.contains("<td>equivalent</td>"), "{}", page.body);
    }

    #[test]
    fn without_a_record_the_page_says_how_to_make_one() {
        let page = page(None, Path::new("mutants.toml")).expect("a page");
        assert!(page.pass.is_none() && page.body.contains(".ci/mutants"));
    }

    #[test]
    fn wilsons_interval() {
        // 81 of 100, from the formula by hand: 0.722 … 0.875
        let [low, high] =
            interval(&Counts { exist: 900, tried: 105, caught: 81, missed: 24, ..Counts::default() }, 5);
        assert!((low - 0.7222).abs() < 1e-3 && (high - 0.8749).abs() < 1e-3, "{low} {high}");
    }
}
