//! Pages, and the one file that holds them all.
//!
//! A page is addressed by its id, `index.html#roll-up`. The style shows the page that the address
//! names, or the first one; printing shows all. No script takes part.

use std::collections::HashSet;

use askama::Template;

use crate::Failure;

/// A page of the report, of whatever kind. The order of pages is that of reading.
pub struct Page {
    /// Its address in the file: lower-case words with hyphens.
    pub id: String,
    /// Heading, and text of links to it.
    pub title: String,
    /// Whether what it claims holds; none where it claims nothing.
    pub pass: Option<bool>,
    /// Whether the line at the top of the file leads to it. Cases are found by the overview.
    pub listed: bool,
    /// What follows the heading, as HTML.
    pub body: String,
}

#[derive(Template)]
#[template(path = "report.html")]
struct Document<'a> {
    style: &'static str,
    pages: &'a [Page],
}

impl Document<'_> {
    /// The pages before and after one.
    fn beside(&self, index: usize) -> [Option<&Page>; 2] {
        [index.checked_sub(1), Some(index + 1)].map(|k| self.pages.get(k?))
    }
}

/// The whole file.
///
/// # Errors
/// Where two pages have the same id, or there is no page.
pub fn document(pages: &[Page]) -> Result<String, Failure> {
    let mut ids = HashSet::new();
    if let Some(twice) = pages.iter().find(|page| !ids.insert(page.id.as_str())) {
        return Err(format!(
            "two pages of the report are called `{}`; rename one, a case by its folder",
            twice.id
        )
        .into());
    }
    if pages.is_empty() {
        return Err("a report needs a page".into());
    }
    let style = include_str!("../../templates/report.css");
    Ok(Document { style, pages }.render()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(id: &str, listed: bool) -> Page {
        let title = id.to_uppercase();
        Page {
            id: id.into(),
            title,
            pass: (id == "case").then_some(false),
            listed,
            body: "<p>text</p>".into(),
        }
    }

    #[test]
    fn pages_lead_to_their_neighbours_and_the_top_to_those_listed() {
        let file = document(&[page("first", true), page("case", false), page("last", true)]).expect("a file");
        let (top, sections) = file.split_once("<section").expect("pages");
        assert!(
            top.contains("href=\"#first\"")
                && top.contains("href=\"#last\"")
                && !top.contains("href=\"#case\"")
        );
        let section = |k: usize| sections.split("<section").nth(k).expect("as many sections as pages");
        assert!(
            section(1).contains("id=\"case\"")
                && section(1).contains("<p>text</p>")
                && section(1).contains("fail")
        );
        assert!(
            section(1).contains("<a href=\"#first\">← FIRST</a>")
                && section(1).contains("<a href=\"#last\">LAST →</a>")
        );
        assert!(!section(0).contains('←') && !section(2).contains('→'));
    }

    #[test]
    fn two_pages_of_one_name_are_refused() {
        let told =
            document(&[page("overview", true), page("overview", false)]).expect_err("ambiguous").to_string();
        assert!(told.contains("`overview`"));
        assert!(document(&[]).is_err());
    }
}
