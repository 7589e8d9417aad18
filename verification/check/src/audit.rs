//! Checks of the files themselves: everything is used, nothing is edited by hand.

use std::path::Path;

use crate::reference::{provenance_path, sha256};
use crate::suite::{files, folders};
use crate::{Case, Error, Result, Suite};

/// Everything that is wrong with the folders of cases and references; empty if nothing is.
///
/// - every case has `scene.toml`, `case.toml` and `README.md`, and every scene beside them is used;
/// - every folder and file of `reference_data` belongs to an oracle of a case, and the other way
///   round;
/// - every oracle is compared with something;
/// - tables are byte by byte what `verify freeze` wrote, and so is what they were made from;
/// - provenance says what the case says.
///
/// # Errors
/// Only where files cannot be read at all.
pub fn audit(suite: &Suite) -> Result<Vec<String>> {
    let mut problems = Vec::new();
    let names = suite.names()?;
    for folder in folders(&suite.reference_folder())? {
        if !names.contains(&folder) {
            problems.push(format!("reference_data/{folder} belongs to no case"));
        }
    }
    for name in &names {
        match suite.case(name) {
            Ok(case) => {
                problems.extend(audit_case(suite, &case)?.into_iter().map(|p| format!("{name}: {p}")))
            }
            Err(error) => problems.push(error.to_string()),
        }
    }
    Ok(problems)
}

fn audit_case(suite: &Suite, case: &Case) -> Result<Vec<String>> {
    let mut problems = Vec::new();
    let present = files(&case.folder)?;
    for needed in ["scene.toml", "case.toml", "README.md"] {
        if !present.iter().any(|f| f == needed) {
            problems.push(format!("{needed} is missing"));
        }
    }
    let mut scenes = vec!["scene.toml".to_owned()];
    for (name, family) in &case.text.run {
        match crate::family::members(family) {
            Ok(members) => scenes.extend(members.into_iter().map(|m| m.scene)),
            Err(message) => problems.push(format!("[run.{name}]: {message}")),
        }
    }
    for file in &present {
        if file.ends_with(".toml") && file != "case.toml" && !scenes.contains(file) {
            problems.push(format!("{file} is used by no [run]"));
        }
    }

    let folder = suite.reference_folder().join(&case.name);
    let references = if folder.is_dir() { files(&folder)? } else { Vec::new() };
    for file in &references {
        let oracle = file.strip_suffix(".csv").or_else(|| file.strip_suffix(".provenance.toml"));
        if !oracle.is_some_and(|name| case.text.oracle.contains_key(name)) {
            problems.push(format!("reference_data/{}/{file} belongs to no [oracle]", case.name));
        }
    }
    for (name, oracle) in &case.text.oracle {
        if !case.text.check.iter().any(|check| check.oracle.as_ref() == Some(name)) {
            problems.push(format!("[oracle.{name}] is compared with nothing"));
        }
        let table = match suite.table(&case.name, name) {
            Ok(table) => table,
            Err(Error::Read { path, .. }) => {
                problems.push(format!(
                    "{} is missing; `verify freeze {}` makes it",
                    suite.short(&path),
                    case.name
                ));
                continue;
            }
            Err(error) => {
                problems.push(error.to_string());
                continue;
            }
        };
        let provenance = &table.provenance;
        let told = (provenance.oracle == *name)
            && provenance.class == oracle.class
            && provenance.citation == oracle.citation.trim()
            && provenance.title == oracle.title
            && provenance.note.as_deref() == oracle.note.as_deref().map(str::trim);
        if !told {
            let path = provenance_path(&table.path);
            problems.push(format!(
                "{} says something else than [oracle.{name}]; `verify freeze {}` mends it",
                suite.short(&path),
                case.name
            ));
        }
        changed(
            suite,
            &table.path,
            &provenance.csv_sha256,
            "`verify freeze` alone writes it",
            &mut problems,
        )?;
        let remedy = format!("`verify freeze {}` makes the table from it anew", case.name);
        for (input, hash) in &provenance.inputs {
            changed(suite, &suite.root.join(input), hash, &remedy, &mut problems)?;
        }
    }
    Ok(problems)
}

/// Notes a file whose contents do not have the hash.
fn changed(suite: &Suite, path: &Path, hash: &str, remedy: &str, problems: &mut Vec<String>) -> Result<()> {
    match std::fs::read(path) {
        Ok(bytes) if sha256(&bytes) == hash => {}
        Ok(_) => problems.push(format!("{} has changed since it was recorded; {remedy}", suite.short(path))),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            problems.push(format!("{} is missing; {remedy}", suite.short(path)));
        }
        Err(source) => return Err(Error::Read { path: path.to_owned(), source }),
    }
    Ok(())
}
