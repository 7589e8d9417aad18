//! Writes `reference_data`: the only code that does.

use std::path::Path;

use ancf_check::case::Oracle;
use ancf_check::reference::{Provenance, Table, difference, provenance_path, sha256};
use ancf_check::{Case, Suite};
use indexmap::IndexMap;

use ancf_verification::python::Python;
use ancf_verification::{Failure, bridge, peers};

use crate::chosen;

/// Makes the tables of all oracles of some cases. With `check` nothing is written, and the answer
/// is whether the tables agree with those that are there, but for the round-off of another
/// processor. Transcriptions are only copied: of these it says that nothing was computed.
pub fn freeze(suite: &Suite, cases: &[String], check: bool) -> Result<bool, Failure> {
    let names = chosen(suite, cases)?;
    let python = bridge::environment()?;
    let mut same = true;
    for name in names {
        let case = suite.case(&name)?;
        for (key, oracle) in &case.text.oracle {
            eprint!("{name}/{key} … ");
            let (table, provenance) =
                make(suite, &case, key, oracle, python).map_err(|e| format!("{name}/{key}: {e}"))?;
            let path = suite.table_path(&name, key);
            let known = Table::read(&path).ok();
            let frozen = std::fs::read_to_string(&path).ok();
            let agrees = frozen.as_ref().is_some_and(|frozen| *frozen == table);
            let provenance_holds = known.is_some_and(|known| says_the_same(&known.provenance, &provenance));
            if agrees && provenance_holds {
                let computed = oracle.transcribed.is_none() && oracle.shared.is_none();
                eprintln!("{}", if computed { "unchanged" } else { "copied, not computed" });
            } else if check {
                let other = frozen.map_or(Some("there is none".into()), |old| difference(&table, &old));
                same &= other.is_none();
                match other {
                    None if agrees => eprintln!("same numbers"),
                    None => eprintln!("same numbers but for round-off"),
                    Some(how) => eprintln!("DIFFERS from reference_data: {how}"),
                }
            } else {
                store(&path, &table)?;
                let header = "# Written by `verify freeze`; not to be edited.\n";
                store(&provenance_path(&path), &(header.to_owned() + &toml::to_string(&provenance)?))?;
                eprintln!("{}", if agrees { "provenance renewed" } else { "written" });
            }
        }
    }
    Ok(same)
}

fn make(
    suite: &Suite,
    case: &Case,
    key: &str,
    oracle: &Oracle,
    python: &Python,
) -> Result<(String, Provenance), Failure> {
    let mut inputs = IndexMap::new();
    let mut note = |path: &Path| -> Result<(), Failure> {
        let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
        inputs.insert(suite.short(path), sha256(&bytes));
        Ok(())
    };
    if let Some(other) = &oracle.shared {
        return shared(suite, other, key, oracle);
    }
    let (table, tool, command) = match (&oracle.script, &oracle.transcribed, oracle.peer) {
        (Some(script), ..) => {
            let path = suite.oracles_folder().join(script);
            note(&path)?;
            let mut arguments = oracle.arguments.clone();
            for scene in &oracle.scenes {
                let scene = case.folder.join(scene);
                note(&scene)?;
                arguments.push(scene.to_string_lossy().into_owned());
            }
            let table = python.run(&path, &arguments)?;
            let shown: Vec<_> = oracle
                .arguments
                .iter()
                .cloned()
                .chain(oracle.scenes.iter().map(|s| format!("verification/cases/{}/{s}", case.name)))
                .collect();
            let command = format!("python3 verification/oracles/{script} {}", shown.join(" "));
            let peers = std::fs::read_to_string(suite.peers_folder().join("requirements.txt"))?;
            let own = |package: &str| !peers.lines().any(|line| line.starts_with(&format!("{package}==")));
            (table, python.facts.tool(own), command.trim_end().to_owned())
        }
        (None, Some(file), _) => {
            let path = suite.oracles_folder().join(file);
            note(&path)?;
            let table = std::fs::read_to_string(&path)?;
            (table, "typed from the publication".to_owned(), format!("cp verification/oracles/{file} …"))
        }
        (None, None, Some(peer)) => {
            note(&peers::script(suite, peer))?;
            for scene in peers::scenes(case, oracle)? {
                note(&scene)?;
            }
            let command = format!("verify freeze {}", case.name);
            (peers::table(case, oracle, peer)?, python.facts.tool(|p| p == peers::package(peer)), command)
        }
        (None, None, None) => return Err("it has none of `script`, `transcribed`, `peer`, `shared`".into()),
    };
    let provenance = Provenance {
        oracle: key.to_owned(),
        title: oracle.title.clone(),
        class: oracle.class,
        citation: oracle.citation.trim().to_owned(),
        note: oracle.note.as_deref().map(|n| n.trim().to_owned()),
        tool,
        command,
        date: python.facts.date.clone(),
        platform: python.facts.platform.clone(),
        csv_sha256: sha256(table.as_bytes()),
        inputs,
    };
    Ok((table, provenance))
}

/// The reference of another case with its own provenance: how, when and where it was made there. It
/// is computed anew for that case only.
fn shared(suite: &Suite, other: &str, key: &str, oracle: &Oracle) -> Result<(String, Provenance), Failure> {
    let (case, of) = other.split_once('/').ok_or_else(|| format!("`{other}` is not `<case>/<oracle>`"))?;
    let path = suite.table_path(case, of);
    let provenance = Table::read(&path)?.provenance;
    if provenance.class != oracle.class {
        return Err(format!("{other} is of the class `{}`", provenance.class.word()).into());
    }
    let text = std::fs::read_to_string(&path)?;
    let mut inputs = IndexMap::from([(suite.short(&path), sha256(text.as_bytes()))]);
    inputs.extend(provenance.inputs);
    let made = Provenance {
        oracle: key.to_owned(),
        title: oracle.title.clone(),
        citation: oracle.citation.trim().to_owned(),
        note: oracle.note.as_deref().map(|note| note.trim().to_owned()),
        csv_sha256: sha256(text.as_bytes()),
        inputs,
        ..provenance
    };
    Ok((text, made))
}

/// Whether all is the same but the day, the machine and the tools, which alone are no reason to
/// write.
fn says_the_same(old: &Provenance, new: &Provenance) -> bool {
    let without = |p: &Provenance| {
        let mut p = p.clone();
        (p.date, p.platform, p.tool) = Default::default();
        toml::to_string(&p).ok()
    };
    without(old) == without(new)
}

/// Writes a file so that it is there whole or not at all.
pub fn store(path: &Path, text: &str) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let beside = path.with_extension("new");
    std::fs::write(&beside, text)
        .and_then(|()| std::fs::rename(&beside, path))
        .map_err(|e| format!("{}: {e}", path.display()).into())
}
