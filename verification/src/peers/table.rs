//! The results of a peer for a family of runs, as a table of reference data.

use std::path::PathBuf;

use ancf::scene::Scene;
use ancf_check::Case;
use ancf_check::case::{Oracle, Peer};
use ancf_check::family::{Member, members};

use crate::Failure;

/// The runs that the oracle is about.
fn runs(case: &Case, oracle: &Oracle) -> Result<Vec<Member>, Failure> {
    let (_, family) = case.family(oracle.run.as_deref())?;
    Ok(members(&family)?)
}

/// The scene file of each of the oracle's runs.
///
/// # Errors
/// Where there is no such family.
pub fn scenes(case: &Case, oracle: &Oracle) -> Result<Vec<PathBuf>, Failure> {
    Ok(runs(case, oracle)?.into_iter().map(|member| case.folder.join(member.scene)).collect())
}

/// The table: the variables of each run, then probes over load factors or times, or frequencies.
///
/// # Errors
/// Scenes that are not legal or have no counterpart, and what the peer raises.
pub fn table(case: &Case, oracle: &Oracle, peer: Peer) -> Result<String, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for (k, member) in runs(case, oracle)?.iter().enumerate() {
        let scene = Scene::load(&case.folder.join(&member.scene), &member.set)?;
        let answer = super::ask(peer, &scene)?;
        let modal = !answer.frequencies.is_empty();
        if k == 0 {
            let columns: &[_] =
                if modal { &["mode", "frequency"] } else { &["probe", "parameter", "x", "y"] };
            table.write_record(member.variables.keys().map(String::as_str).chain(columns.iter().copied()))?;
        }
        let mut row = |cells: &[String]| table.write_record(member.variables.values().chain(cells));
        for (mode, frequency) in answer.frequencies.iter().enumerate() {
            row(&[(mode + 1).to_string(), number(*frequency)])?;
        }
        for track in &answer.probes {
            for ((t, x), y) in answer.parameter.iter().zip(&track.x).zip(&track.y) {
                row(&[track.name.clone(), t.to_string(), number(*x), number(*y)])?;
            }
        }
    }
    Ok(String::from_utf8(table.into_inner()?)?)
}

/// Twelve decimals: more than Newton's method leaves.
fn number(value: f64) -> String {
    format!("{value:.12}")
}
