//! The format of `verification/work-precision/<name>.toml`: what is solved, how it is judged, by
//! which methods, and what is claimed.
//!
//! ```toml
//! title = "Half circle by an end moment"
//! about = "What is solved, for a reader who has not seen the scene."
//! case = "roll-up-convergence"            # whose scene is solved
//! set = ["effect.moment.0.value=1.0"]     # overrides for all methods
//! narrow = "Why another code comes near."  # where ours is not five times as fast as any other
//!
//! [norm.tip]                              # an error: a check as in case.toml, by any reference
//! title = "distance of the tip [m]"
//! quantity = ["probe.tip.x", "probe.tip.y"]
//! oracle = "roll-up-convergence/circle"
//! where = { quarters = 2, s = 1.8 }
//! why = "How good the reference is."
//!
//! [method.ancf]                           # a family of runs; one line of the diagram per label
//! code = "ours"                           # or another: see `Code`
//! label = "ANCF"
//! set = ["beam.cantilever.basis.ancf.elements={elements}"]
//! over.mesh.elements = [4, 8, 16]
//!
//! [method.exudyn]
//! code = "exudyn"
//! label = "Exudyn"
//! settings = { newton = "{newton}" }      # see peers/<code>_work.py
//! slow = true                             # left out by --quick, and run once
//! over.newton.newton = ["full", "modified"]
//!
//! [price]                                 # of what is chosen for an accuracy alone
//! norm = "tip"
//! unit = 1.8                              # an accuracy of 1 is this error: the beam's length
//! accuracies = [1e-2, 1e-4, 1e-6]
//! dearer = 3.0                            # than our cheapest setting that is as accurate, at most
//! faster = { at = 1e-4, times = 5.0 }     # than the cheapest of other codes, at least
//!
//! [[claim]]
//! norm = "tip"
//! error = 1e-4                            # of either code the cheapest setting with at most this
//!                                         # error counts; if there is no error, the cheapest
//! times = 30.0                            # so many times faster than the other code, in the same
//!                                         # run: a time alone depends on the machine
//! ours = ["ancf"]                         # the methods that are meant; `than` names those they
//!                                         # are compared with, perhaps ours too
//!
//! [[left-out]]
//! what = "Explicit solvers"
//! why = "…"
//! ```

use std::path::Path;

use ancf_check::Suite;
use ancf_check::case::{Check, Family, Scalar};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::Failure;

/// One problem, as its file says.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Problem {
    /// A few words.
    pub title: String,
    /// A description of the problem.
    pub about: String,
    /// The case whose scenes are solved.
    pub case: String,
    /// Overrides for all methods.
    #[serde(default)]
    pub set: Vec<String>,
    /// Errors, by name. Their oracles are `<case>/<oracle>`.
    pub norm: IndexMap<String, Check>,
    /// Methods, by name.
    pub method: IndexMap<String, Method>,
    /// The claims that must hold.
    #[serde(default)]
    pub claim: Vec<Claim>,
    /// Why ours is not five times as fast as any other code everywhere, where it is not.
    #[serde(default)]
    pub narrow: String,
    /// What is chosen for an accuracy alone.
    pub price: Option<Price>,
    /// Methods that are not in the diagram though a reader may look for them.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
}

/// A program that solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// This one.
    Ours,
    /// This one, with nothing named but an accuracy.
    Accuracy,
    /// Exudyn's ANCFCable2D.
    Exudyn,
    /// scikit-fem's Hermite elements, for small deflections.
    ScikitFem,
    /// OpenSees' beams with the corotational transformation.
    #[serde(rename = "opensees")]
    OpenSees,
    /// PyElastica's Cosserat rods, which move explicitly.
    #[serde(rename = "pyelastica")]
    PyElastica,
    /// A chain of rigid links and springs in MuJoCo.
    #[serde(rename = "mujoco")]
    MuJoCo,
}

impl Code {
    /// Whether it is this one.
    pub fn is_ours(self) -> bool {
        matches!(self, Self::Ours | Self::Accuracy)
    }

    /// Its name for the reader.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Accuracy => "ours, an accuracy alone",
            Self::Exudyn => "Exudyn",
            Self::ScikitFem => "scikit-fem",
            Self::OpenSees => "OpenSees",
            Self::PyElastica => "PyElastica",
            Self::MuJoCo => "MuJoCo",
        }
    }
}

/// Runs for one accuracy after another, of which nothing else is named, and what they may cost.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Price {
    /// The norm that an accuracy is about.
    pub norm: String,
    /// The error in that norm of an accuracy of one.
    pub unit: f64,
    /// Overrides, after those of the problem.
    #[serde(default)]
    pub set: Vec<String>,
    /// The accuracies.
    pub accuracies: Vec<f64>,
    /// How many times dearer at most than our cheapest setting that is as accurate.
    pub dearer: f64,
    /// How many times faster at least than the cheapest setting of other codes.
    pub faster: Option<Faster>,
}

/// A bound on time for one of the accuracies.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Faster {
    /// The accuracy.
    pub at: f64,
    /// How many times faster.
    pub times: f64,
}

impl Price {
    /// As a method, of which the accuracy is the only variable.
    pub fn method(&self) -> Method {
        let values = self.accuracies.iter().map(|accuracy| Scalar::Number(*accuracy)).collect();
        let axis = [("accuracy".to_owned(), values)].into();
        Method {
            code: Code::Accuracy,
            label: "an accuracy alone".to_owned(),
            scene: scene_toml(),
            set: self.set.clone(),
            settings: IndexMap::new(),
            slow: false,
            over: [("accuracy".to_owned(), axis)].into(),
        }
    }
}

/// A family of runs by one code.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Method {
    /// The code.
    pub code: Code,
    /// Name of its line in the diagram.
    pub label: String,
    /// File in the case's folder.
    #[serde(default = "scene_toml")]
    pub scene: String,
    /// Overrides, after those of the problem.
    #[serde(default)]
    pub set: Vec<String>,
    /// Settings of another code besides the scene; `{variables}` are filled in.
    #[serde(default)]
    pub settings: IndexMap<String, Scalar>,
    /// Left out of quick measurements, and run once.
    #[serde(default)]
    pub slow: bool,
    /// Axes: variable → values.
    #[serde(default)]
    pub over: IndexMap<String, IndexMap<String, Vec<Scalar>>>,
}

fn scene_toml() -> String {
    "scene.toml".to_owned()
}

/// A bound on time.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Claim {
    /// Its meaning, for the reader.
    #[serde(default)]
    pub says: String,
    /// Name of the norm; none: any error will do.
    pub norm: Option<String>,
    /// Largest error in that norm.
    pub error: Option<f64>,
    /// Our methods that take part; none named: all.
    #[serde(default)]
    pub ours: Vec<String>,
    /// Methods that these are compared with, perhaps ours; none named: all of other codes.
    #[serde(default)]
    pub than: Vec<String>,
    /// How many times faster than the cheapest of `than`.
    pub times: f64,
}

/// Something that is not measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Methods or settings.
    pub what: String,
    /// Reason for leaving them out.
    pub why: String,
}

impl Method {
    /// The method as a family of a case; the overrides `first` go before its own.
    pub fn family(&self, first: &[String]) -> Family {
        Family {
            scene: self.scene.clone(),
            set: first.iter().chain(&self.set).cloned().collect(),
            interpolate: false,
            over: self.over.clone(),
        }
    }
}

impl Problem {
    /// Reads a problem.
    ///
    /// # Errors
    /// Where the file cannot be read, has another format, or contradicts itself.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Self::parse(&text).map_err(|e| format!("{}: {e}", path.display()).into())
    }

    /// A problem from the text of its file.
    ///
    /// # Errors
    /// Where it has another format or contradicts itself.
    pub fn parse(text: &str) -> Result<Self, String> {
        let problem: Self = toml::from_str(text).map_err(|e| e.to_string())?;
        problem.validate()?;
        Ok(problem)
    }

    fn validate(&self) -> Result<(), String> {
        for (name, norm) in &self.norm {
            if norm.title.is_none() {
                return Err(format!("[norm.{name}] needs a `title`: the label of the diagram's axis"));
            }
            if norm.oracle.as_ref().is_none_or(|oracle| !oracle.contains('/')) {
                return Err(format!("[norm.{name}] needs `oracle = \"<case>/<oracle>\"`"));
            }
        }
        if let Some(price) = self.price.as_ref().filter(|price| !self.norm.contains_key(&price.norm)) {
            return Err(format!("[price]: there is no [norm.{}]", price.norm));
        }
        for (k, claim) in self.claim.iter().enumerate() {
            let at = |message: String| Err(format!("[[claim]] {}: {message}", k + 1));
            if claim.norm.is_some() != claim.error.is_some() {
                return at("`norm` and `error` belong together".to_owned());
            }
            if let Some(norm) = claim.norm.as_ref().filter(|norm| !self.norm.contains_key(*norm)) {
                return at(format!("there is no [norm.{norm}]"));
            }
            let is_ours = |name: &String| self.method.get(name).is_some_and(|method| method.code.is_ours());
            if let Some(name) = claim.ours.iter().find(|name| !is_ours(name)) {
                return at(format!("`{name}` is no method of ours"));
            }
            let unknown = |name: &&String| !self.method.contains_key(*name) || claim.ours.contains(name);
            if let Some(name) = claim.than.iter().find(unknown) {
                return at(format!("`{name}` is no method besides those of `ours`"));
            }
        }
        Ok(())
    }
}

/// Names of the problems, in alphabetical order.
///
/// # Errors
/// Where their folder cannot be read.
pub fn names(suite: &Suite) -> Result<Vec<String>, Failure> {
    let folder = suite.root.join("verification").join("work-precision");
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            names.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}

/// Reads the problem of this name.
///
/// # Errors
/// As [`Problem::read`].
pub fn problem(suite: &Suite, name: &str) -> Result<Problem, Failure> {
    Problem::read(&suite.root.join("verification").join("work-precision").join(format!("{name}.toml")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ancf_check::family::members;

    const TEXT: &str = r#"
title = "t"
about = "a"
case = "tip-load"
[norm.tip]
title = "tip"
quantity = "probe.tip.x"
oracle = "tip-load/shooting"
why = "w"
[method.a]
code = "ours"
label = "A"
set = ["n={n}"]
over.mesh.n = [1, 2]
[method.b]
code = "exudyn"
label = "B"
slow = true
[[claim]]
norm = "tip"
error = 1e-3
times = 2.0
"#;

    #[test]
    fn a_method_is_a_family_with_the_overrides_of_the_problem_first() {
        let problem = Problem::parse(TEXT).expect("a problem");
        let members = members(&problem.method["a"].family(&["x=1".to_owned()])).expect("members");
        assert_eq!(members[1].set, ["x=1", "n=2"]);
        assert!(problem.method["b"].slow && !problem.method["a"].slow);
    }

    #[test]
    fn contradictions_are_named() {
        let cases = [
            ("error = 1e-3", "", "`norm` and `error` belong together"),
            ("norm = \"tip\"", "norm = \"top\"", "there is no [norm.top]"),
            ("times = 2.0", "", "missing field `times`"),
            (
                "times = 2.0",
                "times = 2.0\nours = [\"a\"]\nthan = [\"a\"]",
                "`a` is no method besides those of `ours`",
            ),
            ("times = 2.0", "times = 2.0\nours = [\"c\"]", "`c` is no method of ours"),
            ("tip-load/shooting", "shooting", "<case>/<oracle>"),
            ("title = \"tip\"", "", "needs a `title`"),
            ("slow = true", "fast = true", "unknown field `fast`"),
        ];
        for (old, new, message) in cases {
            assert!(TEXT.contains(old), "{old}");
            let error = Problem::parse(&TEXT.replace(old, new)).expect_err(message);
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn all_problems_can_be_read_and_their_scenes_are_legal() {
        let suite = Suite::here();
        let names = names(&suite).expect("problems");
        assert!(!names.is_empty());
        for name in names {
            let problem = problem(&suite, &name).expect("a problem");
            for norm in problem.norm.values() {
                let (case, oracle) = norm.oracle.as_ref().and_then(|o| o.split_once('/')).expect("checked");
                suite.table(case, oracle).expect("a reference");
            }
            for (key, method) in &problem.method {
                for member in members(&method.family(&problem.set)).expect("members") {
                    let path = suite.cases_folder().join(&problem.case).join(&member.scene);
                    let scene = ancf::scene::Scene::load(&path, &member.set)
                        .unwrap_or_else(|e| panic!("{name}, {key}, {}: {e}", member.label()));
                    if !method.code.is_ours() {
                        crate::peers::describe::describe(scene.model(), scene.analysis())
                            .unwrap_or_else(|e| panic!("{name}, {key}, {}: {e}", member.label()));
                    }
                }
            }
        }
    }
}
