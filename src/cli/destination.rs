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
        // The process number keeps two runs into one directory apart.
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

    /// Keeps the directories, because the results are there.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Destination {
    fn drop(&mut self) {
        for directory in &self.made {
            // Only empty directories are removed; files of others stay.
            if fs::remove_dir(directory).is_err() {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directories_that_were_made_go_unless_they_are_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let results = folder.path().join("a/b/c");
        let destination = Destination::prepare(&results).expect("a directory");
        assert!(destination.path() == results && results.is_dir());
        drop(destination);
        assert!(folder.path().is_dir() && !folder.path().join("a").exists());
        Destination::prepare(&results).expect("a directory").keep();
        assert!(results.is_dir());
        assert_eq!(fs::read_dir(&results).expect("a directory").count(), 0, "the trial is over");
        // A directory that was there before counts as not made, and stays.
        drop(Destination::prepare(&results).expect("a directory"));
        assert!(results.is_dir());
    }

    #[test]
    fn what_somebody_else_put_there_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let destination = Destination::prepare(&folder.path().join("a/b")).expect("a directory");
        fs::write(folder.path().join("a/notes.txt"), "mine").expect("a file");
        drop(destination);
        assert!(folder.path().join("a/notes.txt").is_file() && !folder.path().join("a/b").exists());
    }

    #[test]
    fn a_directory_that_cannot_be_made_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("file"), "").expect("a file");
        let results = folder.path().join("file/results");
        let failure = Destination::prepare(&results).expect_err("a file is no directory");
        assert!(matches!(&failure, Failure::Directory { path, .. } if *path == results), "{failure:?}");
    }
}
