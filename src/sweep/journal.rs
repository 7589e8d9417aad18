//! The journal of finished runs: one line each, only ever appended to.
//!
//! A record counts when its line is complete and legal; whatever else a process that was killed has
//! left is passed over.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::{Shard, SweepError};

const PREFIX: &str = "journal-";
const SUFFIX: &str = ".jsonl";

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Outcome {
    /// It came to its end.
    Solved,
    /// The computation failed.
    Failed,
    /// The equations could not be built or started: the input is at fault.
    Refused,
}

impl Outcome {
    /// The word for it in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Failed => "failed",
            Self::Refused => "refused",
        }
    }
}

/// A finished run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Its number, from 1.
    pub run: usize,
    /// How it ended.
    pub outcome: Outcome,
    /// Why it did not come to its end.
    pub message: Option<String>,
    /// Wall time \[s\].
    pub seconds: f64,
    /// Its summary, as far as it came.
    pub summary: Option<serde_json::Value>,
}

impl Record {
    /// Its line, without a line end.
    pub fn line(&self) -> String {
        // A record always has a JSON form.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The number of the run of a line, if it is a legal one; its summary is not built.
    pub fn run_of(line: &[u8]) -> serde_json::Result<usize> {
        #[derive(Deserialize)]
        #[expect(dead_code, reason = "all of them must be there")]
        struct Line {
            run: usize,
            outcome: Outcome,
            message: Option<IgnoredAny>,
            seconds: f64,
            summary: Option<IgnoredAny>,
        }
        serde_json::from_slice::<Line>(line).map(|line| line.run)
    }
}

/// The journals in `directory`, in the order of their names.
pub(super) fn paths(directory: &Path) -> Result<Vec<PathBuf>, SweepError> {
    let wrong = |source: io::Error| SweepError::Journal { path: directory.to_owned(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(directory).map_err(wrong)? {
        let entry = entry.map_err(wrong)?;
        let name = entry.file_name();
        if name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX)) {
            paths.push(entry.path());
        }
    }
    paths.sort_unstable();
    Ok(paths)
}

/// The journal of one part, open for one process.
#[derive(Debug)]
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    /// Bytes of complete lines.
    length: u64,
}

impl Journal {
    /// Opens the journal of `shard`, and removes a torn line at its end.
    ///
    /// # Errors
    /// [`SweepError::Busy`] while another process has it open.
    pub fn open(directory: &Path, shard: Shard) -> Result<Self, SweepError> {
        let path = directory.join(format!("{PREFIX}{}-of-{}{SUFFIX}", shard.index(), shard.count()));
        let wrong = |source: io::Error| SweepError::Journal { path: path.clone(), source };
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(wrong)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(SweepError::Busy { path }),
            // Some network file systems have no locks; two processes of one part then only waste
            // time.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(wrong(error)),
        }
        let length = complete(&mut file).map_err(wrong)?;
        file.set_len(length).map_err(wrong)?;
        Ok(Self { path, file, length })
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends the line of a record, which has no line end yet. The remains of a failed write are
    /// removed, so that the next record begins a line.
    pub fn append(&mut self, mut line: String) -> Result<(), SweepError> {
        line.push('\n');
        match self.file.write_all(line.as_bytes()) {
            Ok(()) => {
                self.length += line.len() as u64;
                Ok(())
            }
            Err(source) => {
                // If this fails too, the next process that opens the journal removes them.
                let _ = self.file.set_len(self.length);
                Err(SweepError::Journal { path: self.path.clone(), source })
            }
        }
    }
}

/// Bytes up to the last line end.
fn complete(file: &mut File) -> io::Result<u64> {
    const BLOCK: u64 = 1 << 16;
    let mut end = file.seek(SeekFrom::End(0))?;
    let mut block = Vec::new();
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        file.seek(SeekFrom::Start(start))?;
        block.clear();
        file.take(end - start).read_to_end(&mut block)?;
        if let Some(at) = block.iter().rposition(|byte| *byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

/// All journals of a directory: where the record of each run is.
pub(super) struct Finished {
    directory: PathBuf,
    files: Vec<File>,
    /// Per run: file, first byte, bytes.
    places: Vec<Option<(usize, u64, usize)>>,
}

impl Finished {
    /// Looks through the journals of a sweep of so many `runs`.
    pub fn read(directory: &Path, runs: usize) -> Result<Self, SweepError> {
        let (mut files, mut places) = (Vec::new(), vec![None; runs]);
        for (index, path) in paths(directory)?.into_iter().enumerate() {
            let mut scan = || -> io::Result<File> {
                let mut reader = BufReader::new(File::open(&path)?);
                let (mut line, mut start) = (Vec::new(), 0);
                while reader.read_until(b'\n', &mut line)? > 0 {
                    let run = Record::run_of(&line).ok();
                    let place = run.and_then(|run| places.get_mut(run.checked_sub(1)?));
                    if let (Some(place), true) = (place, line.ends_with(b"\n")) {
                        // A run that two processes computed has the same results in both.
                        place.get_or_insert((index, start, line.len()));
                    }
                    start += line.len() as u64;
                    line.clear();
                }
                Ok(reader.into_inner())
            };
            files.push(scan().map_err(|source| SweepError::Journal { path: path.clone(), source })?);
        }
        Ok(Self { directory: directory.to_owned(), files, places })
    }

    /// Whether `run` (from 1) is finished.
    pub fn has(&self, run: usize) -> bool {
        self.places.get(run - 1).is_some_and(Option::is_some)
    }

    /// The numbers of the runs that are not finished, ascending.
    pub fn missing(&self) -> Vec<usize> {
        (1..=self.places.len()).filter(|run| !self.has(*run)).collect()
    }

    /// What `of` makes of the records of the finished runs, on all threads, and given to `take` in
    /// the order of their numbers; few of them are in memory at a time.
    pub fn each<T: Send>(
        &self,
        of: impl Fn(Record) -> T + Sync,
        mut take: impl FnMut(T) -> io::Result<()>,
    ) -> Result<(), SweepError> {
        const AT_A_TIME: usize = 4096;
        let read = |(file, start, length): &(usize, u64, usize)| -> io::Result<Vec<u8>> {
            let mut file = &self.files[*file];
            let mut line = vec![0; *length];
            file.seek(SeekFrom::Start(*start))?;
            file.read_exact(&mut line)?;
            Ok(line)
        };
        let mut all = || -> io::Result<()> {
            for places in self.places.chunks(AT_A_TIME) {
                let lines: Vec<Vec<u8>> = places.iter().flatten().map(read).collect::<io::Result<_>>()?;
                let made: Vec<T> = lines
                    .into_par_iter()
                    .map(|line| Ok(of(serde_json::from_slice(&line)?)))
                    .collect::<io::Result<_>>()?;
                made.into_iter().try_for_each(&mut take)?;
            }
            Ok(())
        };
        all().map_err(|source| SweepError::Journal { path: self.directory.clone(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(run: usize) -> Record {
        let summary = serde_json::to_value([0.1, f64::MIN_POSITIVE, run as f64]).unwrap();
        Record { run, outcome: Outcome::Solved, message: None, seconds: 1e-3, summary: Some(summary) }
    }

    fn records(folder: &Path, runs: usize) -> Vec<Record> {
        let mut all = Vec::new();
        let take = |record| {
            all.push(record);
            Ok(())
        };
        Finished::read(folder, runs).unwrap().each(|record| record, take).unwrap();
        all
    }

    fn line(run: usize) -> String {
        record(run).line()
    }

    #[test]
    fn a_journal_cut_anywhere_keeps_its_complete_records() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::open(folder.path(), Shard::WHOLE).unwrap();
        [2, 1, 3].into_iter().try_for_each(|run| journal.append(line(run))).unwrap();
        drop(journal);
        let path = folder.path().join("journal-1-of-1.jsonl");
        let whole = fs::read(&path).unwrap();
        for length in 0..=whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            let complete = whole[..length].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(records(folder.path(), 3).len(), complete);
            let mut journal = Journal::open(folder.path(), Shard::WHOLE).unwrap();
            journal.append(line(4)).unwrap();
            let found = records(folder.path(), 4);
            assert_eq!(found.len(), complete + 1);
            assert!(found.iter().all(|found| *found == record(found.run)));
        }
    }

    #[test]
    fn what_is_no_record_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let text = format!("{}\nnonsense\n\0\0\0\n{}\n{}\n{}\n", line(1), line(0), line(9), line(2));
        fs::write(folder.path().join("journal-1-of-2.jsonl"), text).unwrap();
        assert_eq!(records(folder.path(), 3), [record(1), record(2)]);
        assert_eq!(Finished::read(folder.path(), 3).unwrap().missing(), [3]);
    }

    #[test]
    fn other_files_are_no_journals() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["journal-1-of-2.txt", "notes.jsonl", "journal-2-of-2.jsonl", "journal-1-of-2.jsonl"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let expected = ["journal-1-of-2.jsonl", "journal-2-of-2.jsonl"].map(|name| folder.path().join(name));
        assert_eq!(paths(folder.path()).unwrap(), expected);
    }

    /// The torn line is longer than the blocks in which its beginning is searched.
    #[test]
    fn a_long_torn_line_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal-1-of-1.jsonl");
        let size = || fs::metadata(&path).unwrap().len();
        let mut journal = Journal::open(folder.path(), Shard::WHOLE).unwrap();
        for run in [1, 2] {
            journal.append(line(run)).unwrap();
            assert_eq!(journal.length, size());
        }
        let whole = journal.length;
        drop(journal);
        let mut text = fs::read(&path).unwrap();
        text.resize(text.len() + 200_000, b'x');
        fs::write(&path, text).unwrap();
        let mut journal = Journal::open(folder.path(), Shard::WHOLE).unwrap();
        assert_eq!((journal.length, size()), (whole, whole));
        journal.append(line(3)).unwrap();
        assert_eq!(records(folder.path(), 3), [record(1), record(2), record(3)]);
    }

    #[test]
    fn one_process_has_a_part() {
        let folder = tempfile::tempdir().unwrap();
        let _first = Journal::open(folder.path(), Shard::WHOLE).unwrap();
        assert!(matches!(Journal::open(folder.path(), Shard::WHOLE), Err(SweepError::Busy { .. })));
        assert!(Journal::open(folder.path(), "1/2".parse().unwrap()).is_ok());
    }
}
