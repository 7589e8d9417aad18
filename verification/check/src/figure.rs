//! The format of drawings in `case.toml`.

use indexmap::IndexMap;
use serde::Deserialize;

use crate::case::Scalar;

/// A drawing in the report.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Figure {
    /// Heading.
    pub title: String,
    /// A caption: what to see in the drawing.
    #[serde(default)]
    pub caption: String,
    /// Label of the horizontal axis.
    pub x: String,
    /// Label of the vertical axis.
    pub y: String,
    /// True aspect ratio.
    #[serde(default)]
    pub equal: bool,
    /// Logarithmic axes.
    #[serde(default)]
    pub logarithmic: bool,
    /// The curves that are drawn.
    pub curve: Vec<Curve>,
}

/// One curve for each member of a family that `only` leaves, from the run or, with `oracle`, from
/// the reference. With `check`, one for each set of runs that differ in nothing but the variable
/// `x`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Curve {
    /// Name in the legend; none for the 2nd and further curves of one kind.
    pub label: Option<String>,
    /// Name of the family.
    pub run: Option<String>,
    /// Members of the family.
    #[serde(default)]
    pub only: IndexMap<String, Scalar>,
    /// Draw the reference in place of the run.
    pub oracle: Option<String>,
    /// Rows of the reference.
    #[serde(default, rename = "where")]
    pub rows: IndexMap<String, Scalar>,
    /// Draw the errors of this check, from 1.
    pub check: Option<usize>,
    /// Quantity, column or variable on the horizontal axis.
    pub x: String,
    /// Quantity or column on the vertical axis; not with `check`.
    #[serde(default)]
    pub y: String,
    /// Appearance.
    #[serde(default)]
    pub line: Line,
    /// Number of the colour; default: one after the other.
    pub color: Option<usize>,
}

/// Appearance of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Line {
    /// A line.
    #[default]
    Solid,
    /// A dashed line, as references have it.
    Dashed,
    /// Marks only.
    Points,
}
