//! A copy of the repository.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::Failure;
use crate::find::Mutant;
use crate::splice::{Spliced, splice};

/// The module with the switch, for a number of mutants.
const SWITCH: &str = include_str!("switch.rs.txt");

/// The folder of the sources of the Python module, which are a package of their own.
pub const PYTHON: &str = "src/python/";

/// Where copy, builds and outcomes are kept from run to run.
pub struct Workshop {
    /// The repository.
    pub root: PathBuf,
    /// The copy.
    pub copy: PathBuf,
    /// Builds of the copy.
    pub target: PathBuf,
    /// The interpreter with what the tests of the Python module need.
    pub python: PathBuf,
    /// Temporary files of tests.
    pub temporary: PathBuf,
    /// The outcomes known so far.
    pub outcomes: PathBuf,
}

impl Workshop {
    /// The workshop of a repository. It lies in `target`, so that the copy is built with the
    /// repository's own `.cargo/config.toml`.
    pub fn new(root: &Path) -> Result<Self, Failure> {
        let folder = root.join("target").join("mutants");
        let workshop = Self {
            root: root.to_owned(),
            copy: folder.join("copy"),
            target: folder.join("target"),
            python: root.join("target/python-tests/bin/python"),
            temporary: folder.join("temporary"),
            outcomes: folder.join("outcomes"),
        };
        for folder in [&workshop.copy, &workshop.target, &workshop.temporary, &workshop.outcomes] {
            fs::create_dir_all(folder)?;
        }
        Ok(workshop)
    }

    /// Makes the copy equal to the repository, except for sources with mutants. It has the files
    /// that git tracks or would add. Files that are equal already keep their times, so that they
    /// are not built anew. Returns a fingerprint of all files.
    pub fn fill(&self, spliced: &[(String, Spliced)], number: usize) -> Result<u64, Failure> {
        let listed = Command::new("git")
            .arg("-C")
            .arg(&self.root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .output()?;
        if !listed.status.success() {
            return Err(format!("git ls-files: {}", String::from_utf8_lossy(&listed.stderr).trim()).into());
        }
        let names = String::from_utf8(listed.stdout)?;
        let mut fingerprint = std::hash::DefaultHasher::new();
        let mut kept = HashSet::new();
        let mut put = |name: &str, bytes: &[u8]| -> Result<(), Failure> {
            std::hash::Hash::hash(&(name, bytes), &mut fingerprint);
            let path = self.copy.join(name);
            if fs::read(&path).ok().as_deref() != Some(bytes) {
                path.parent().map_or(Ok(()), fs::create_dir_all)?;
                fs::write(&path, bytes)?;
            }
            kept.insert(path);
            Ok(())
        };
        for name in names.split('\0').filter(|name| !name.is_empty() && !name.starts_with(".cargo/")) {
            let path = self.root.join(name);
            // Deleted, and not yet committed.
            if !path.is_file() {
                continue;
            }
            let new = spliced.iter().find(|(file, _)| file == name).map(|(_, s)| s.text.clone().into_bytes());
            let mut bytes = new.map_or_else(|| fs::read(&path), Ok)?;
            if name == "src/lib.rs" {
                bytes.extend_from_slice(b"\n#[doc(hidden)]\npub mod mutant_switch;\n");
            }
            put(name, &bytes)?;
        }
        put("src/mutant_switch.rs", SWITCH.replace("@NUMBER@", &number.to_string()).as_bytes())?;
        remove_others(&self.copy, &kept)?;
        Ok(std::hash::Hasher::finish(&fingerprint))
    }
}

/// Deletes files of a folder that are not to be kept.
fn remove_others(folder: &Path, kept: &HashSet<PathBuf>) -> Result<(), Failure> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(&path, kept)?;
        } else if !kept.contains(&path) {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}

/// Path and text of all Rust files of `src`, in order.
pub fn sources(root: &Path) -> Result<Vec<(String, String)>, Failure> {
    let mut found = Vec::new();
    let mut folders = vec![root.join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension() == Some(OsStr::new("rs")) {
                let parts: Vec<_> = path.strip_prefix(root)?.iter().map(OsStr::to_string_lossy).collect();
                found.push((parts.join("/"), fs::read_to_string(&path)?));
            }
        }
    }
    found.sort();
    Ok(found)
}

/// The sources in which some of the mutants stand.
pub fn spliced(sources: &[(String, String)], mutants: &[(usize, &Mutant)]) -> Vec<(String, Spliced)> {
    sources
        .iter()
        .filter_map(|(file, text)| {
            let own: Vec<_> = mutants.iter().copied().filter(|(_, m)| m.file == *file).collect();
            // The program and the Python module see the library from outside.
            let outside = file == "src/main.rs" || file.starts_with(PYTHON);
            let on = if outside { "::ancf::mutant_switch::on" } else { "crate::mutant_switch::on" };
            (!own.is_empty()).then(|| (file.clone(), splice(text, &own, on)))
        })
        .collect()
}
