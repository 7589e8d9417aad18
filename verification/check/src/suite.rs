//! Where cases and references lie.

use std::path::{Path, PathBuf};

use crate::{Case, Error, Result, reference::Table};

/// The folders of a repository that verification reads.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The root of the repository.
    pub root: PathBuf,
}

impl Suite {
    /// The suite of the repository that this crate was built in.
    pub fn here() -> Self {
        let check = Path::new(env!("CARGO_MANIFEST_DIR"));
        Self { root: check.ancestors().nth(2).unwrap_or(check).to_owned() }
    }

    /// `verification/cases`.
    pub fn cases_folder(&self) -> PathBuf {
        self.root.join("verification").join("cases")
    }

    /// `verification/oracles`: the scripts and transcriptions that references are made from.
    pub fn oracles_folder(&self) -> PathBuf {
        self.root.join("verification").join("oracles")
    }

    /// `verification/peers`: the scripts that tell another code about a scene.
    pub fn peers_folder(&self) -> PathBuf {
        self.root.join("verification").join("peers")
    }

    /// `reference_data`.
    pub fn reference_folder(&self) -> PathBuf {
        self.root.join("reference_data")
    }

    /// A path as seen from the root of the repository.
    pub fn short(&self, path: &Path) -> String {
        path.strip_prefix(&self.root).unwrap_or(path).to_string_lossy().replace('\\', "/")
    }

    /// Names of the case folders, in alphabetical order.
    pub fn names(&self) -> Result<Vec<String>> {
        folders(&self.cases_folder())
    }

    /// Reads one case.
    pub fn case(&self, name: &str) -> Result<Case> {
        Case::read(&self.cases_folder().join(name))
    }

    /// The table of an oracle.
    pub fn table_path(&self, case: &str, oracle: &str) -> PathBuf {
        self.reference_folder().join(case).join(format!("{oracle}.csv"))
    }

    /// Reads the table of an oracle.
    pub fn table(&self, case: &str, oracle: &str) -> Result<Table> {
        Table::read(&self.table_path(case, oracle))
    }
}

/// Names of the folders in a folder, in alphabetical order.
pub(crate) fn folders(path: &Path) -> Result<Vec<String>> {
    entries(path, |kind| kind.is_dir())
}

/// Names of the files in a folder, in alphabetical order.
pub(crate) fn files(path: &Path) -> Result<Vec<String>> {
    entries(path, |kind| kind.is_file())
}

fn entries(path: &Path, wanted: impl Fn(&std::fs::FileType) -> bool) -> Result<Vec<String>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if wanted(&entry.file_type().map_err(failed)?) {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort();
    Ok(names)
}
