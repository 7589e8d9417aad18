//! Faults of a scene, and their places.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceSpan};

/// A scene that cannot be used. `Display` says all of it in one message, with `file:line:column`;
/// as a [`Diagnostic`] it also carries the text and the place for a report with the lines
/// themselves.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub enum SceneError {
    /// The file could not be read at all.
    #[error("{}: cannot read the scene: {reason}", path.display())]
    #[diagnostic(help("give the path of a scene file, a text file in the TOML format"))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why, in the system's words.
        reason: String,
    },
    /// The text is not a legal scene.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(Box<Invalid>),
}

impl SceneError {
    /// File, line and column (from 1), where the text is at fault.
    pub fn place(&self) -> Option<(&str, usize, usize)> {
        match self {
            Self::Unreadable { .. } => None,
            Self::Invalid(e) => Some((e.text.name(), e.line, e.column)),
        }
    }

    /// The same error under a short heading, for reports that print place and help by themselves.
    pub fn brief(&self) -> Brief<'_> {
        Brief(self)
    }
}

/// One fault of a scene's text.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{}:{line}:{column}: {message}{}", text.name(), Indented(help.as_deref()))]
pub struct Invalid {
    message: String,
    #[help]
    help: Option<String>,
    #[source_code]
    text: NamedSource<String>,
    #[label("here")]
    span: SourceSpan,
    line: usize,
    column: usize,
}

struct Indented<'a>(Option<&'a str>);

impl fmt::Display for Indented<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().flat_map(|text| text.lines()).try_for_each(|line| write!(f, "\n    {line}"))
    }
}

/// See [`SceneError::brief`].
#[derive(Debug)]
pub struct Brief<'a>(&'a SceneError);

impl fmt::Display for Brief<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            SceneError::Invalid(e) => f.write_str(&e.message),
            other => other.fmt(f),
        }
    }
}

impl std::error::Error for Brief<'_> {}

impl Diagnostic for Brief<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.0.help()
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.0.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.0.labels()
    }
}

/// A fault found while reading; becomes a [`SceneError`] once name and text are at hand.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    /// Bytes of the text.
    pub span: Range<usize>,
    /// What was found and what was expected.
    pub message: String,
    /// What is legal, what to try.
    pub help: Option<String>,
}

impl Fault {
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, message: message.into(), help: None }
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Locates the fault in `text`, called `name`.
    pub fn at(self, name: &str, text: &str) -> SceneError {
        let start = floor(text, self.span.start);
        let end = floor(text, self.span.end).max(start);
        let before = text.get(..start).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        SceneError::Invalid(Box::new(Invalid {
            message: self.message,
            help: self.help,
            text: NamedSource::new(name, text.to_owned()).with_language("toml"),
            span: (start..end).into(),
            line,
            column,
        }))
    }
}

/// The character boundary at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines and columns count characters, also of places within one, and of places behind the text.
    #[test]
    fn places_are_those_of_characters() {
        let text = "aü\n€b";
        for (at, place) in [
            (0, (1, 1)),
            (1, (1, 2)),
            (2, (1, 2)),
            (3, (1, 3)),
            (4, (2, 1)),
            (5, (2, 1)),
            (7, (2, 2)),
            (99, (2, 3)),
        ] {
            let error = Fault::new(at..at + 1, "wrong").at("a.toml", text);
            assert_eq!(error.place().map(|(_, line, column)| (line, column)), Some(place), "{at}");
        }
    }
}
