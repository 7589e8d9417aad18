//! Files that appear all together, each complete, or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::error::OutputError;

/// Files written under temporary names beside their final ones, waiting to be renamed.
///
/// Dropped before [`StagedFiles::commit`], it removes the files and those directories that it made.
pub(crate) struct StagedFiles {
    directory: PathBuf,
    /// Directories that did not exist before, outermost first.
    made: Vec<PathBuf>,
    waiting: Vec<(TempPath, PathBuf)>,
    /// Names relative to `directory`, of everything staged so far.
    names: Vec<String>,
    /// Whether files have received their final names. All files are written before the first one is
    /// renamed, so that a failure leaves no mixture of old and new ones.
    committed: bool,
}

impl StagedFiles {
    /// Makes `directory` where it is missing.
    pub(crate) fn new(directory: &Path) -> Result<Self, OutputError> {
        let mut stage = Self {
            directory: directory.to_owned(),
            made: Vec::new(),
            waiting: Vec::new(),
            names: Vec::new(),
            committed: false,
        };
        stage.make(directory)?;
        Ok(stage)
    }

    fn make(&mut self, directory: &Path) -> Result<(), OutputError> {
        let missing: Vec<PathBuf> = directory
            .ancestors()
            .take_while(|a| !a.as_os_str().is_empty() && !a.exists())
            .map(Path::to_owned)
            .collect();
        self.made.extend(missing.into_iter().rev());
        fs::create_dir_all(directory)
            .map_err(|source| OutputError::Directory { path: directory.to_owned(), source })
    }

    /// Writes one file under a temporary name. `name` is relative to the directory, its parts
    /// separated by `/`.
    pub(crate) fn add(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = self.directory.join(name);
        if path.is_dir() {
            return Err(OutputError::Occupied { path });
        }
        let parent = path.parent().unwrap_or(&self.directory).to_owned();
        if !parent.exists() {
            self.make(&parent)?;
        }
        let write = || -> io::Result<TempPath> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".ancf-").suffix(".part");
            // Results are for others to read too; the user's umask still applies.
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            let mut file = BufWriter::new(builder.tempfile_in(&parent)?);
            fill(&mut file)?;
            Ok(file.into_inner().map_err(io::IntoInnerError::into_error)?.into_temp_path())
        };
        let written = write().map_err(|source| OutputError::Write { path: path.clone(), source })?;
        self.waiting.push((written, path));
        self.names.push(name.to_owned());
        Ok(())
    }

    /// Whether a file of this name is staged.
    pub(super) fn contains(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// Gives every file its final name, in the order in which they were added.
    pub(crate) fn commit(mut self) -> Result<(), OutputError> {
        for (temporary, path) in std::mem::take(&mut self.waiting) {
            temporary
                .persist(&path)
                .map_err(|e| OutputError::Write { path: path.clone(), source: e.error })?;
            self.committed = true;
        }
        self.committed = true;
        Ok(())
    }
}

impl Drop for StagedFiles {
    fn drop(&mut self) {
        self.waiting.clear();
        if !self.committed {
            for directory in self.made.iter().rev() {
                // Not empty or gone already: then it is not ours to remove.
                let _ = fs::remove_dir(directory);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let entries = fs::read_dir(directory).expect("a directory");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Would catch directories that a failure leaves behind, and one that was there before and
    /// goes.
    #[test]
    fn what_fails_removes_the_directories_that_it_made_and_no_other() {
        let own = tempfile::tempdir().expect("a directory");
        let before = own.path().join("before");
        fs::create_dir(&before).expect("made");
        let mut stage = StagedFiles::new(&before.join("new/results")).expect("made");
        stage.add("one.csv", |out| out.write_all(b"1\n")).expect("written");
        stage.add("deep/two.csv", |out| out.write_all(b"2\n")).expect("written");
        let full = stage.add("three.csv", |_| Err(io::Error::other("the disk is full")));
        assert!(
            matches!(full, Err(OutputError::Write { path, .. }) if path.ends_with("new/results/three.csv"))
        );
        drop(stage);
        assert_eq!(names(&before), Vec::<String>::new());
        // Files that others have put there in the meantime stay.
        let stage = StagedFiles::new(&before.join("new")).expect("made");
        fs::write(before.join("new/notes.txt"), "").expect("written");
        drop(stage);
        assert_eq!(names(&before.join("new")), ["notes.txt"]);
    }

    #[test]
    fn files_appear_when_all_are_there_and_are_for_whom_the_user_likes() {
        let own = tempfile::tempdir().expect("a directory");
        let results = own.path().join("results");
        let mut stage = StagedFiles::new(&results).expect("made");
        stage.add("deep/two.csv", |out| out.write_all(b"2\n")).expect("written");
        assert!(stage.contains("deep/two.csv") && !stage.contains("two.csv"));
        assert!(!results.join("deep/two.csv").exists());
        stage.commit().expect("renamed");
        assert_eq!(names(&results), ["deep"]);
        assert_eq!(names(&results.join("deep")), ["two.csv"]);
        assert_eq!(fs::read_to_string(results.join("deep/two.csv")).expect("a file"), "2\n");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = |path: &Path| fs::metadata(path).expect("a file").permissions().mode();
            fs::write(own.path().join("other"), "").expect("written");
            assert_eq!(mode(&results.join("deep/two.csv")), mode(&own.path().join("other")));
        }
    }
}
