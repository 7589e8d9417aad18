//! The format of `case.toml`.
//!
//! ```toml
//! title = "Cantilever under a dead tip load"
//! claim = "One sentence that is true or false."
//! source = "Where the problem comes from."
//! nightly = true                        # left out of `cargo test`; default false
//!
//! [hard]                                # only for hard cases: a line in the report's page of them
//! difficulty = "What makes it hard."
//! plain = "What the plain method does."
//! ours = "What ours does."
//!
//! [oracle.shooting]                     # → reference_data/<case>/shooting.csv
//! class = "closed-form"                 # closed-form | published | code | integrator | refinement
//! title = "Elastica by shooting, 30 digits"
//! citation = "Bisshopp & Drucker 1945"
//! script = "static_beam.py"             # in verification/oracles/; or transcribed = "file.csv"
//!                                       # there; or peer = "exudyn"; or shared = "case/oracle"
//! arguments = ["tip-load"]
//! note = "What a reader of the numbers must know."
//!
//! [run.loads]                           # a family of runs: the product of its axes
//! scene = "scene.toml"                  # the default
//! set = ["effect.force.0.value=[0.0, -{load}]"]
//! [run.loads.over.load]                 # an axis: lists of equal length, one value per point
//! load = [1, 5, 10]                     # and variable
//!
//! [[check]]
//! run = "loads"
//! quantity = ["probe.tip.x", "probe.tip.y"]
//! oracle = "shooting"
//! column = ["x", "y"]                   # the default: the last part of each quantity
//! where = { load = "{load}", s = 1 }    # picks the rows
//! allowed = 1e-8
//! why = "What limits the agreement."
//! ```
//!
//! An oracle `peer = "exudyn"` is what Exudyn makes of a family, `run = "loads"`; its columns are
//! the family's variables, then `probe`, `parameter` (load factor or time), `x`, `y`, or in a modal
//! analysis `mode`, `frequency`. `{name}` stands for the value that the member of the family has
//! for this variable; values may contain further ones. With `along = "s"` the rows that `where`
//! leaves form a curve over that column. With
//! `order = { against = "elements", expected = 4, within = 0.3 }` the observed order of the error
//! is a further number that must hold.

use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

pub use crate::figure::{Curve, Figure, Line};

/// One case, as its file says, with the place of the file.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the folder.
    pub name: String,
    /// The folder.
    pub folder: PathBuf,
    /// The contents of `case.toml`.
    pub text: CaseText,
}

/// The contents of `case.toml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CaseText {
    /// A title of a few words.
    pub title: String,
    /// One sentence that is true or false.
    pub claim: String,
    /// Where the problem comes from.
    pub source: String,
    /// Takes longer than some seconds: compared by the report and by `cargo test -- --ignored`
    /// alone.
    #[serde(default)]
    pub nightly: bool,
    /// Why this is difficult; the report has a page of such cases.
    pub hard: Option<Hard>,
    /// References, by the name of their file.
    #[serde(default)]
    pub oracle: IndexMap<String, Oracle>,
    /// Families of runs, by name. None given: one family `run` of one member, `scene.toml` as it
    /// stands.
    #[serde(default)]
    pub run: IndexMap<String, Family>,
    /// The checks that must hold.
    pub check: Vec<Check>,
    /// The figures of the report.
    #[serde(default)]
    pub figure: Vec<Figure>,
}

/// Why a case is hard, in a sentence or two each.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Hard {
    /// What makes it hard.
    pub difficulty: String,
    /// What the plain method does.
    pub plain: String,
    /// What ours does.
    pub ours: String,
}

/// How much a reference can be trusted, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// The exact solution of the continuous problem, evaluated to at least 12 digits.
    ClosedForm,
    /// A number printed in the literature.
    Published,
    /// Another code.
    Code,
    /// Another integrator on the same semi-discrete system.
    Integrator,
    /// Our own refinement; never called validation.
    Refinement,
}

impl Class {
    /// The word for it in files and reports.
    pub fn word(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form",
            Self::Published => "published",
            Self::Code => "code",
            Self::Integrator => "integrator",
            Self::Refinement => "refinement",
        }
    }
}

/// Where reference numbers come from.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Oracle {
    /// How much it can be trusted.
    pub class: Class,
    /// A title of a few words.
    pub title: String,
    /// Literature, or the formula's name.
    pub citation: String,
    /// A script in `verification/oracles/` that prints the table.
    pub script: Option<String>,
    /// Arguments of the script.
    #[serde(default)]
    pub arguments: Vec<String>,
    /// Scenes of the case that the script reads, appended to its arguments.
    #[serde(default)]
    pub scenes: Vec<String>,
    /// A table in `verification/oracles/` typed from the literature.
    pub transcribed: Option<String>,
    /// A reference of another case, `<case>/<oracle>`, that is this one's too.
    pub shared: Option<String>,
    /// Another code that solves the same scenes.
    pub peer: Option<Peer>,
    /// The family that the peer solves; may be left out where there is only one.
    pub run: Option<String>,
    /// Takes the other code longer than some seconds: asked anew by `verify freeze --check` alone, not
    /// by `cargo test`.
    #[serde(default)]
    pub nightly: bool,
    /// What a reader of the numbers must know.
    pub note: Option<String>,
}

/// Another code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Peer {
    /// Exudyn, whose ANCFCable2D is the element of our ANCF with engineering strain.
    Exudyn,
    /// scikit-fem's Hermite elements: the linear beam that ours becomes as deflections become
    /// small.
    ScikitFem,
}

/// A family of runs: one scene under the product of some axes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Family {
    /// File in the case's folder.
    #[serde(default = "scene_toml")]
    pub scene: String,
    /// Overrides `PATH=VALUE`.
    #[serde(default)]
    pub set: Vec<String>,
    /// Do not solve: give every node the exact position and gradient of the beam's stress-free
    /// centreline and look at what the discretisation makes of it.
    #[serde(default)]
    pub interpolate: bool,
    /// Axes: variable → values.
    #[serde(default)]
    pub over: IndexMap<String, IndexMap<String, Vec<Scalar>>>,
}

fn scene_toml() -> String {
    "scene.toml".to_owned()
}

impl Default for Family {
    fn default() -> Self {
        Self { scene: scene_toml(), set: Vec::new(), interpolate: false, over: IndexMap::new() }
    }
}

/// A number or a word.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Scalar {
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// A word, perhaps with `{variables}`.
    Text(String),
}

impl std::fmt::Display for Scalar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integer(v) => write!(f, "{v}"),
            Self::Number(v) => write!(f, "{v:?}"),
            Self::Text(v) => f.write_str(v),
        }
    }
}

/// One name or several.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum OneOrMore {
    /// The name of a number.
    One(String),
    /// The names of the components of a point.
    More(Vec<String>),
}

impl OneOrMore {
    /// All of them.
    pub fn all(&self) -> &[String] {
        match self {
            Self::One(v) => std::slice::from_ref(v),
            Self::More(v) => v,
        }
    }
}

/// Something that must hold for every member of a family.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Check {
    /// Heading in the report.
    pub title: Option<String>,
    /// Name of the family; may be left out where there is only one.
    pub run: Option<String>,
    /// Members of the family that it concerns, by the values of their variables. Default: all.
    #[serde(default)]
    pub only: IndexMap<String, Scalar>,
    /// See [`crate::quantity`]. Several are the components of a point, compared by Euclidean
    /// distance.
    pub quantity: OneOrMore,
    /// Which number of a series over time or load is compared, if not a curve.
    #[serde(default)]
    pub pick: Pick,
    /// A quantity that replaces time, load factor or s as our abscissa.
    pub abscissa: Option<String>,
    /// The reference. None: the quantity itself is the error, with 0 as reference.
    pub oracle: Option<String>,
    /// Columns of the reference. Default: the last part of each quantity.
    pub column: Option<OneOrMore>,
    /// Rows of the reference: column → value.
    #[serde(default, rename = "where")]
    pub rows: IndexMap<String, Scalar>,
    /// Column of the reference that is the abscissa of a curve.
    pub along: Option<String>,
    /// How the distances at the points of a curve are combined into one number.
    #[serde(default)]
    pub norm: Norm,
    /// The number by which the error is divided.
    pub per: Option<Per>,
    /// Largest error, a number or a template. May be left out where an order is asked for.
    pub allowed: Option<Scalar>,
    /// Smallest error: for claims that a method is *not* good at something.
    pub at_least: Option<f64>,
    /// Unit of the last digit that a publication prints; an error beyond it is pointed out in the
    /// report even where more is allowed.
    pub last_digit: Option<f64>,
    /// Observed order of the error.
    pub order: Option<Order>,
    /// Why this tolerance.
    pub why: String,
}

/// Which number of a series over time or load factor is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pick {
    /// The last record.
    #[default]
    Last,
    /// The first local maximum, by the parabola through its three records.
    FirstMaximum,
    /// The largest absolute value of all records.
    Largest,
}

/// How the distances at the points of a curve are combined into one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Norm {
    /// The largest. Of a single number or point: its distance.
    #[default]
    Max,
    /// The root of the mean square over the reference's points.
    Rms,
}

/// The number by which an error is divided.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Per {
    /// A number, such as the beam's length.
    Number(f64),
    /// `"reference"`: the same norm of the reference.
    Word(PerWord),
}

/// See [`Per`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PerWord {
    /// The same norm of the reference.
    Reference,
}

/// The order p of error ~ n^(−p), by least squares of the logarithms.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Order {
    /// The variable n.
    pub against: String,
    /// p.
    pub expected: f64,
    /// Largest difference from `expected`.
    pub within: f64,
}

impl Case {
    /// Reads `folder/case.toml`.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join("case.toml");
        let text =
            std::fs::read_to_string(&path).map_err(|source| Error::Read { path: path.clone(), source })?;
        let text: CaseText = toml::from_str(&text)
            .map_err(|error| Error::Format { path: path.clone(), message: error.to_string() })?;
        let name = folder.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let case = Self { name, folder: folder.to_owned(), text };
        case.validate().map_err(|message| Error::Format { path, message })?;
        Ok(case)
    }

    /// The family of a check or curve: by name, or the only one.
    pub fn family(&self, name: Option<&str>) -> std::result::Result<(&str, Family), String> {
        match name {
            Some(name) => match self.text.run.get_key_value(name) {
                Some((name, family)) => Ok((name, family.clone())),
                None => Err(format!("no family [run.{name}]; there are: {}", list(self.text.run.keys()))),
            },
            None => match (self.text.run.len(), self.text.run.first()) {
                (0, _) => Ok(("run", Family::default())),
                (1, Some((name, family))) => Ok((name, family.clone())),
                _ => Err(format!("`run` must name one of the families {}", list(self.text.run.keys()))),
            },
        }
    }

    fn validate(&self) -> std::result::Result<(), String> {
        if self.text.check.is_empty() {
            return Err("a case needs at least one [[check]]".to_owned());
        }
        for (name, oracle) in &self.text.oracle {
            let sources = [
                oracle.script.is_some(),
                oracle.transcribed.is_some(),
                oracle.peer.is_some(),
                oracle.shared.is_some(),
            ];
            if sources.iter().filter(|given| **given).count() != 1 {
                return Err(format!(
                    "[oracle.{name}] needs `script`, `transcribed`, `peer` or `shared`, one of them"
                ));
            }
            if oracle.peer.is_some() {
                self.family(oracle.run.as_deref())
                    .map_err(|message| format!("[oracle.{name}]: {message}"))?;
            }
        }
        for (k, check) in self.text.check.iter().enumerate() {
            let at = |message: String| format!("[[check]] {}: {message}", k + 1);
            self.family(check.run.as_deref()).map_err(at)?;
            if check.allowed.is_none() && check.order.is_none() && check.at_least.is_none() {
                return Err(at("one of `allowed`, `at-least` and `order` is needed".to_owned()));
            }
            if let Some(columns) = &check.column
                && columns.all().len() != check.quantity.all().len()
            {
                return Err(at("as many columns as quantities are needed".to_owned()));
            }
            if let Some(oracle) = &check.oracle
                && !self.text.oracle.contains_key(oracle)
            {
                return Err(at(format!(
                    "no [oracle.{oracle}]; there are: {}",
                    list(self.text.oracle.keys())
                )));
            }
            if check.why.trim().is_empty() {
                return Err(at("`why` must say why this tolerance".to_owned()));
            }
        }
        Ok(())
    }
}

/// Names for a message.
pub(crate) fn list<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let names: Vec<_> = names.map(|n| format!("`{n}`")).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
