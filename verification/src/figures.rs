//! `verify figures`: the pictures of the documents, drawn anew by the solver.
//!
//! `verification/figures.toml` says which scene makes which picture. A picture is out of date where
//! its text differs, or one of its numbers by more than [`SLACK`] of the drawing's width: the last
//! digits of a motion depend on the processor, and nobody sees them.

use std::path::Path;

use ancf::output::{self, OutputOptions};
use ancf::run::Options;
use ancf::scene::Scene;
use ancf_check::Suite;
use ancf_verification::Failure;
use serde::Deserialize;

/// Largest difference of a coordinate, per width of the drawing.
const SLACK: f64 = 2e-3;

/// `verification/figures.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Figures {
    figure: Vec<Figure>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Figure {
    /// The picture, from the root of the repository.
    file: String,
    /// From the root of the repository.
    scene: String,
    #[serde(default)]
    set: Vec<String>,
    /// Which of a run's pictures it is.
    drawing: String,
}

/// Draws all pictures; writes them, or with `check` says which of them are out of date. The answer
/// is whether none is.
pub fn print(suite: &Suite, check: bool) -> Result<bool, Failure> {
    let path = suite.root.join("verification/figures.toml");
    let at = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let text = std::fs::read_to_string(&path).map_err(|e| at(&e))?;
    let figures: Figures = toml::from_str(&text).map_err(|e| at(&e))?;
    let mut outdated = 0;
    for figure in &figures.figure {
        let drawn = draw(suite, figure).map_err(|e| format!("{}: {e}", figure.file))?;
        let file = suite.root.join(&figure.file);
        if check {
            let present = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", figure.file))?;
            let difference = difference(&present, &drawn);
            outdated += usize::from(difference.is_some());
            match difference {
                Some(difference) => println!("OUT OF DATE: {}: {difference}", figure.file),
                None => println!("as drawn today: {}", figure.file),
            }
        } else {
            std::fs::write(&file, drawn).map_err(|e| format!("{}: {e}", figure.file))?;
            println!("drawn: {}", figure.file);
        }
    }
    Ok(outdated == 0)
}

fn draw(suite: &Suite, figure: &Figure) -> Result<String, Failure> {
    let scene = Scene::load(&suite.root.join(&figure.scene), &figure.set).map_err(|e| e.to_string())?;
    let output = OutputOptions::default();
    let options = Options { frames: output.frames(), ..Options::default() };
    let mut results = scene.model().solve_with(scene.analysis(), options)?;
    let folder = tempfile::tempdir()?;
    output::write(folder.path(), &mut results, &output)?;
    let drawing = folder.path().join(Path::new(&figure.drawing));
    std::fs::read_to_string(&drawing).map_err(|e| format!("{}: {e}", figure.drawing).into())
}

/// The first thing in which a drawing is not another one.
fn difference(present: &str, drawn: &str) -> Option<String> {
    let (a, b) = (pieces(present), pieces(drawn));
    let width = b.iter().find_map(|piece| piece.parse::<f64>().ok()).unwrap_or(1.0);
    let unit = a.iter().zip(&b).filter_map(|(a, _)| a.parse::<f64>().ok()).fold(width, f64::max);
    let same = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= SLACK * unit,
        _ => a == b,
    };
    if let Some((a, b)) = a.iter().zip(&b).find(|(a, b)| !same(a, b)) {
        return Some(format!("`{a}` is `{b}` today"));
    }
    (a.len() != b.len()).then(|| format!("{} pieces are {} today", a.len(), b.len()))
}

/// Numbers, and what stands between them.
fn pieces(text: &str) -> Vec<&str> {
    let of_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|c| of_number(c) != of_number(first)).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        pieces.push(piece);
        rest = after;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_is_another_one_where_something_can_be_seen_to_differ() {
        let drawing = r#"<svg width="720"><polyline points="100,200 301,-40.5"/></svg>"#;
        let with = |from: &str, to: &str| difference(drawing, &drawing.replace(from, to));
        assert_eq!(difference(drawing, drawing), None);
        assert_eq!(with("301", "302"), None);
        assert!(with("301", "304").is_some_and(|said| said.contains("`304`")));
        assert!(with("-40.5", "40.5").is_some());
        assert!(with("polyline", "polygon").is_some());
        assert!(with("301,-40.5", "301,-40.5 1,1").is_some());
    }
}
