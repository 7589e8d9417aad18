//! Runs the families of a case and keeps their results.

use std::time::{Duration, Instant};

use ancf::run::{Options, solve_stages};
use ancf::scene::Scene;
use indexmap::IndexMap;

use crate::case::Family;
use crate::compare::Outcome;
use crate::family::{Member, members};
use crate::interpolation::interpolate;
use crate::quantity;
use crate::reference::Table;
use crate::{Case, Error, Result, Suite};

/// One finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// The member of the family.
    pub member: Member,
    /// The member in one line; empty where the family has no axes.
    pub label: String,
    /// Its results.
    pub result: quantity::Result,
    /// Wall time of reading and solving.
    pub took: Duration,
}

/// A case with everything that was computed for it.
#[derive(Clone, Debug)]
pub struct Examined {
    /// The case.
    pub case: Case,
    /// Per family the runs of its members, in the order of [`members`].
    pub families: IndexMap<String, (Family, Vec<Run>)>,
    /// References by oracle.
    pub tables: IndexMap<String, Table>,
    /// One per compared number, curve or rate, in the order of the checks.
    pub outcomes: Vec<Outcome>,
}

impl Examined {
    /// Whether everything that was claimed holds.
    pub fn passed(&self) -> bool {
        self.outcomes.iter().all(|o| o.verdict.passed())
    }

    /// Runs of a family, by name or the only one.
    pub fn runs(&self, name: Option<&str>) -> std::result::Result<(&Family, &[Run]), String> {
        let (name, _) = self.case.family(name)?;
        match self.families.get(name) {
            Some((family, runs)) => Ok((family, runs)),
            None => Err(format!("the family `{name}` was not run")),
        }
    }
}

/// Reads, runs and compares one case.
///
/// # Errors
/// Unreadable files, scenes that the solver refuses, and checks that ask for what is not there.
/// Numbers that miss their tolerance are failed outcomes.
pub fn examine(suite: &Suite, name: &str) -> Result<Examined> {
    let case = suite.case(name)?;
    let tables = case
        .text
        .oracle
        .keys()
        .map(|oracle| Ok((oracle.clone(), suite.table(name, oracle)?)))
        .collect::<Result<IndexMap<_, _>>>()?;
    let alone = IndexMap::from([("run".to_owned(), Family::default())]);
    let declared = if case.text.run.is_empty() { &alone } else { &case.text.run };
    let families = declared
        .iter()
        .map(|(name, family)| Ok((name.clone(), (family.clone(), run_family(&case, name, family)?))))
        .collect::<Result<IndexMap<_, _>>>()?;
    let mut examined = Examined { case, families, tables, outcomes: Vec::new() };
    examined.outcomes = crate::compare::all(&examined)?;
    Ok(examined)
}

fn run_family(case: &Case, name: &str, family: &Family) -> Result<Vec<Run>> {
    let members = members(family).map_err(|message| Error::Format {
        path: case.folder.join("case.toml"),
        message: format!("[run.{name}]: {message}"),
    })?;
    members
        .into_iter()
        .map(|member| {
            let label = member.label();
            let start = Instant::now();
            let result = run(case, &member).map_err(|message| Error::Run {
                case: case.name.clone(),
                run: if label.is_empty() { name.to_owned() } else { format!("{name} ({label})") },
                message,
            })?;
            Ok(Run { member, label, result, took: start.elapsed() })
        })
        .collect()
}

fn run(case: &Case, member: &Member) -> std::result::Result<quantity::Result, String> {
    let scene = Scene::load(&case.folder.join(&member.scene), &member.set).map_err(|e| chain(&e))?;
    if member.interpolate {
        let [beam] = scene.model().beams.as_slice() else {
            return Err(format!(
                "interpolation looks at one beam; the scene has {}",
                scene.model().beams.len()
            ));
        };
        return Ok(quantity::Result::Interpolated(Box::new(interpolate(beam)?)));
    }
    if !scene.stages().is_empty() {
        let run = solve_stages(scene.stages(), Options::default());
        if let Some(failure) = run.failure {
            return Err(chain(&failure));
        }
        let names = scene.stages().iter().map(|stage| stage.name.clone());
        return Ok(quantity::Result::Staged(names.zip(run.results).collect()));
    }
    let results = scene.model().solve(scene.analysis()).map_err(|error| chain(&error))?;
    Ok(quantity::Result::Solved(Box::new(results)))
}

/// An error with its causes.
fn chain(error: &dyn std::error::Error) -> String {
    let mut message = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        message.push_str(": ");
        message.push_str(&error.to_string());
        cause = error.source();
    }
    message
}
