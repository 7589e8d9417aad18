//! `verify peers`: the results of a peer for a case's scenes, beside ours.

use ancf::scene::Scene;
use ancf_check::case::{Family, Peer};
use ancf_check::family::{Member, members};
use ancf_check::{Case, Suite};
use ancf_verification::{Failure, peers};

use crate::chosen;

/// Runs the cases by Exudyn and by ours, and prints the last place of every probe, or the
/// frequencies, side by side. If no case is named, these are the cases with a peer among their
/// oracles. Returns whether any scene could be compared.
pub fn print(suite: &Suite, cases: &[String]) -> Result<bool, Failure> {
    let mut compared = 0;
    for name in chosen(suite, cases)? {
        let case = suite.case(&name)?;
        if cases.is_empty() && case.text.oracle.values().all(|oracle| oracle.peer.is_none()) {
            continue;
        }
        let alone = [("run".to_owned(), Family::default())].into();
        for (key, family) in if case.text.run.is_empty() { &alone } else { &case.text.run } {
            for member in members(family)?.iter().filter(|member| !member.interpolate) {
                println!("{name}/{key} {}", member.label());
                match beside(&case, member) {
                    Ok(lines) => {
                        compared += 1;
                        println!("{lines}");
                    }
                    Err(error) => println!("  {error}"),
                }
            }
        }
    }
    Ok(compared > 0)
}

/// One line per probe or frequency.
fn beside(case: &Case, member: &Member) -> Result<String, Failure> {
    let scene = Scene::load(&case.folder.join(&member.scene), &member.set)?;
    // First, as it says at once what has no counterpart.
    let theirs = peers::ask(Peer::Exudyn, &scene)?;
    let ours = scene.model().solve(scene.analysis())?;
    let frequencies =
        ours.eigenvalues().into_iter().zip(&theirs.frequencies).enumerate().map(|(k, (a, b))| {
            format!(
                "  frequency {}   ours {a:.12e} Hz   Exudyn {b:.12e} Hz   apart {:.1e}",
                k + 1,
                (a - b).abs()
            )
        });
    let probes = ours.states().probes.iter().zip(&theirs.probes).filter_map(|(a, b)| {
        let (a, name, x, y) = (a.samples.last()?, &b.name, b.x.last()?, b.y.last()?);
        let apart = (a.x - x).hypot(a.y - y);
        let (ax, ay) = (a.x, a.y);
        Some(format!("  {name}   ours {ax:.12} {ay:.12} m   Exudyn {x:.12} {y:.12} m   apart {apart:.1e} m"))
    });
    Ok(frequencies.chain(probes).collect::<Vec<_>>().join("\n"))
}
