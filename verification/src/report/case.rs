//! The page of a case: claim, sketch, figures, checks, and where the references come from.

use ancf_check::{Examined, Suite};
use askama::Template;

use super::Entry;
use super::check::{self, CheckView};
use super::figure::{self, FigureView};
use super::page::Page;
use crate::Failure;

#[derive(Template)]
#[template(path = "case.html")]
struct Body<'a> {
    name: &'a str,
    readme: Vec<Paragraph>,
    error: Option<String>,
    seconds: String,
    /// The claim of the case and its results; none if it could not be examined.
    found: Option<Found<'a>>,
}

struct Found<'a> {
    claim: &'a str,
    source: &'a str,
    runs: usize,
    figures: Vec<FigureView>,
    checks: Vec<CheckView>,
    oracles: Vec<OracleView<'a>>,
}

/// A part of a README.
struct Paragraph {
    sketch: bool,
    text: String,
}

struct OracleView<'a> {
    name: &'a str,
    title: &'a str,
    class: &'static str,
    citation: &'a str,
    note: Option<String>,
    tool: &'a str,
    command: &'a str,
    date: &'a str,
    platform: &'a str,
    hash: String,
    /// Files that the reference was made from, with their hashes.
    inputs: Vec<(&'a str, String)>,
}

/// The page of one case.
pub fn page(suite: &Suite, entry: &Entry) -> Result<Page, Failure> {
    let readme = std::fs::read_to_string(suite.cases_folder().join(&entry.name).join("README.md"));
    let examined = entry.examined.as_ref();
    let body = Body {
        name: &entry.name,
        readme: paragraphs(&readme.unwrap_or_default()),
        error: examined.err().map(ToString::to_string),
        seconds: format!("{:.2} s", entry.took.as_secs_f64()),
        found: examined.ok().map(found),
    };
    Ok(Page {
        id: entry.name.clone(),
        title: examined.map_or_else(|_| entry.name.clone(), |e| e.case.text.title.clone()),
        pass: Some(examined.is_ok_and(Examined::passed)),
        listed: false,
        body: body.render()?,
    })
}

fn found(examined: &Examined) -> Found<'_> {
    let text = &examined.case.text;
    Found {
        claim: &text.claim,
        source: &text.source,
        runs: examined.families.values().map(|(_, runs)| runs.len()).sum(),
        figures: text.figure.iter().map(|f| figure::of_case(examined, f)).collect(),
        checks: text.check.iter().enumerate().map(|(k, c)| check::view(examined, k, c)).collect(),
        oracles: oracles(examined),
    }
}

/// The README without its heading and source, which the page shows elsewhere: paragraphs, and
/// sketches between fences.
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

fn oracles(examined: &Examined) -> Vec<OracleView<'_>> {
    let short = |hash: &str| hash.chars().take(16).collect::<String>();
    examined
        .tables
        .iter()
        .map(|(name, table)| {
            let p = &table.provenance;
            OracleView {
                name,
                title: &p.title,
                class: p.class.word(),
                citation: &p.citation,
                note: p.note.as_ref().map(|note| note.replace('`', "")),
                tool: &p.tool,
                command: &p.command,
                date: &p.date,
                platform: &p.platform,
                hash: short(&p.csv_sha256),
                inputs: p.inputs.iter().map(|(file, hash)| (file.as_str(), short(hash))).collect(),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::paragraphs;

    #[test]
    fn a_readme_is_prose_and_sketches() {
        let parts =
            paragraphs("# Title\n\n**Source.** A book.\n\n**Goal.** To `see`\nit.\n\n```\n ▲──\n```\n");
        let texts: Vec<_> = parts.iter().map(|p| (p.sketch, p.text.as_str())).collect();
        assert_eq!(texts, [(false, "To see it."), (true, " ▲──")]);
    }
}
