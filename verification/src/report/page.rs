//! Pages, and the one file that holds them all.
//!
//! A page is addressed by its id, `index.html#roll-up`. The style shows the page that the address names, or the first one; printing
//! shows all. No script takes part.

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

/// When and where the report was made.
pub struct Made {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
}

#[derive(Template)]
#[template(path = "report.html")]
struct Document<'a> {
    version: &'static str,
    style: &'static str,
    made: &'a Made,
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
pub fn document(made: &Made, pages: &[Page]) -> Result<String, Failure> {
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
    Ok(Document { version: env!("CARGO_PKG_VERSION"), style, made, pages }.render()?)
}
