//! The directory of the results: made and tried before anything is solved.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

use super::failure::Failure;

/// A directory that can be written. Unless [`keep`](Self::keep) is called, the directories that
/// were made for it are removed again when it goes out of scope, so that a run that fails leaves
/// nothing behind.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    /// Directories that did not exist before, innermost first.
    made: Vec<PathBuf>,
}

impl Destination {
    /// Makes `path` with its parents where they are missing, and tries to write into it.
    pub fn prepare(path: &Path) -> Result<Self, Failure> {
        let made = path
            .ancestors()
            .filter(|p| !p.as_os_str().is_empty())
            .take_while(|p| !p.exists())
            .map(Path::to_owned)
            .collect();
        let this = Self { path: path.to_owned(), made };
        // The number keeps two runs into one directory from meeting here.
        let trial = path.join(format!(".ancf-{}", std::process::id()));
        fs::create_dir_all(path)
            .and_then(|()| OpenOptions::new().write(true).create_new(true).open(&trial))
            .and_then(|file| {
                drop(file);
                fs::remove_file(&trial)
            })
            .map_err(|error| Failure::Directory { path: path.to_owned(), error })?;
        Ok(this)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The results are there.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Destination {
    fn drop(&mut self) {
        for directory in &self.made {
            // Only empty directories go; what somebody else put there stays.
            if fs::remove_dir(directory).is_err() {
                break;
            }
        }
    }
}
