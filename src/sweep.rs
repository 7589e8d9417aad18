//! Many runs of one scene: over a grid or a list of values, on several threads and in several
//! processes.
//!
//! ```text
//! directory ─┬─ sweep.json            which sweep this is: scene's hash, overrides, axes, version
//!            ├─ journal-1-of-3.jsonl  finished runs of the first of three parts, one line each
//!            ├─ journal-2-of-3.jsonl  …
//!            └─ sweep.csv             all runs, one row each, when none is missing
//! ```
//!
//! The unit of work is a run: it is computed by one thread from start to end, its row is appended
//! to the journal, and its states are let go. So a sweep may be killed at any moment and called
//! again, on as many threads as there are, in as many processes as there are shards: no finished
//! run is repeated, and every column of the table but `seconds` is the same to the last bit.
//!
//! # The table
//! | column | holds |
//! |---|---|
//! | `run` | its number, from 1; the last axis changes fastest |
//! | the paths varied | what they were set to, as it was written |
//! | `outcome` | `solved`; `failed`: the computation found no way on; `refused`: its equations cannot be built |
//! | `message` | why it was not solved |
//! | `probes.tip.x`, `energy.bend`, `statistics.steps`, `frequencies.1`, … | what [`Summary`] says, by its names; entries of lists from 1; empty where a run has no such value. Of a run that failed, as far as it came |
//! | `seconds` | wall time |

mod axis;
mod error;
mod grid;
mod journal;
mod leaves;
mod manifest;
mod shard;
mod table;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::ThreadPool;
use rayon::prelude::*;

pub use axis::{Axis, Lines, MAX_VALUES};
pub use error::SweepError;
pub use grid::{Grid, MAX_RUNS};
pub use journal::Outcome;
pub use manifest::MANIFEST;
pub use shard::Shard;

use crate::accuracy;
use crate::basis::BasisCache;
use crate::output::{StagedFiles, Summary};
use crate::run::{self, Control};
use crate::scene::Scene;
use journal::{Finished, Journal, Record};
use manifest::Manifest;
use table::{Columns, SweepTable};

/// Name of the table in the directory of the sweep.
pub const TABLE: &str = "sweep.csv";

/// How far a part of a sweep is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepProgress {
    /// Runs finished, now or before.
    pub finished: usize,
    /// Runs of this part.
    pub runs: usize,
    /// Runs that this call has finished without solving them.
    pub unsolved: usize,
}

/// Called at the start and after every run, by one thread at a time.
pub type Observer<'o> = &'o mut (dyn FnMut(&SweepProgress) -> Control + Send);

/// A scene and the grid of its runs, of which any process may compute any.
#[derive(Debug)]
pub struct Runs {
    scene: Scene,
    grid: Grid,
    /// Shape functions that runs have in common.
    cache: BasisCache,
}

impl Runs {
    /// The runs of `scene` over `grid`.
    pub fn new(scene: Scene, grid: Grid) -> Self {
        Self { scene, grid, cache: BasisCache::default() }
    }

    /// The grid of the runs.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Reads the scene of every run.
    ///
    /// # Errors
    /// [`SweepError`] of the first run whose scene is not legal.
    pub fn check(&self) -> Result<(), SweepError> {
        let illegal = |run: usize| Some((run, self.scene.with(&self.grid.overrides(run)).err()?));
        match (1..=self.grid.runs()).into_par_iter().find_map_first(illegal) {
            Some((run, source)) => match self.grid.lines(run).as_slice() {
                [] => Err(source.into()),
                lines => Err(SweepError::Row { lines: lines.join(", "), source }),
            },
            None => Ok(()),
        }
    }

    /// Computes a run (from 1); its line of a journal.
    pub fn line(&self, run: usize) -> String {
        self.record(run).line()
    }

    /// Options without centrelines, which a table does not need.
    fn numbers_alone(&self) -> run::Options<'_> {
        run::Options { frames: 0, cache: Some(&self.cache), ..run::Options::default() }
    }

    fn record(&self, run: usize) -> Record {
        let start = Instant::now();
        let (outcome, message, results) = match self.scene.with(&self.grid.overrides(run)) {
            Ok(scene) => match accuracy::run(&scene, self.numbers_alone()) {
                Ok(results) => {
                    match results.run().error.as_ref().and_then(|e| e.missed(results.run().analysis)) {
                        None => (Outcome::Solved, None, Some(results)),
                        missed => (Outcome::Failed, missed, Some(results)),
                    }
                }
                Err(mut error) => {
                    let refused = error.exit_status() == 2;
                    let outcome = if refused { Outcome::Refused } else { Outcome::Failed };
                    (outcome, Some(error.to_string()), error.take_partial())
                }
            },
            Err(error) => (Outcome::Refused, Some(error.to_string()), None),
        };
        // A summary always has a JSON form.
        let summary = results.and_then(|results| serde_json::to_value(Summary::of(&results)).ok());
        Record { run, outcome, message, seconds: start.elapsed().as_secs_f64(), summary }
    }
}

/// The journal of one part of a sweep, open for one process.
#[derive(Debug)]
pub struct Recorder {
    journal: Journal,
    /// Per run of the sweep, whether it is finished.
    finished: Vec<bool>,
    shard: Shard,
}

impl Recorder {
    /// Makes `directory`, which must exist, that of the sweep of these runs, or goes on with it.
    ///
    /// # Errors
    /// [`SweepError`] where it holds another sweep, or another process records the same part.
    pub fn open(runs: &Runs, directory: &Path, shard: Shard) -> Result<Self, SweepError> {
        Self::of(&Manifest::new(&runs.scene, &[], &runs.grid), runs.grid.runs(), directory, shard)
    }

    fn of(manifest: &Manifest, runs: usize, directory: &Path, shard: Shard) -> Result<Self, SweepError> {
        manifest.claim(directory)?;
        // Opened before the journals are read: what another process of this part finished until now
        // is among them.
        let journal = Journal::open(directory, shard)?;
        let finished = Finished::read(directory, runs)?;
        Ok(Self { journal, finished: (1..=runs).map(|run| finished.has(run)).collect(), shard })
    }

    /// The numbers of the runs of this part that are not finished, ascending.
    pub fn missing(&self) -> Vec<usize> {
        self.shard.runs(self.finished.len()).filter(|run| !self.finished[run - 1]).collect()
    }

    /// Records a [line](Runs::line); returns whether it was new, not of a run that is recorded.
    ///
    /// # Errors
    /// [`SweepError::Journal`] where it is no such line, or cannot be written.
    pub fn enter(&mut self, line: &str) -> Result<bool, SweepError> {
        let wrong = |reason: String| SweepError::Journal {
            path: self.journal.path().to_owned(),
            source: std::io::Error::other(reason),
        };
        let run = Record::run_of(line.as_bytes()).map_err(|error| wrong(error.to_string()))?;
        let Some(finished) = run.checked_sub(1).and_then(|at| self.finished.get_mut(at)) else {
            return Err(wrong(format!("there is no run {run}")));
        };
        if line.contains('\n') {
            return Err(wrong("expected one line, found several".to_owned()));
        }
        if *finished {
            return Ok(false);
        }
        self.journal.append(line.to_owned())?;
        *finished = true;
        Ok(true)
    }
}

/// A sweep all of whose scenes are legal.
#[derive(Debug)]
pub struct Sweep {
    runs: Runs,
    manifest: Manifest,
    pool: ThreadPool,
}

impl Sweep {
    /// A sweep of the scene file at `scene`, with the overrides `set` in all runs and the product
    /// of `axes` over them, on `threads` threads (0: one per core). Reads the scene of every run.
    ///
    /// # Errors
    /// [`SweepError`] where the axes make no grid, or the scene of a run is not legal (that of the
    /// first such run).
    pub fn new(scene: &Path, set: &[String], axes: Vec<Axis>, threads: usize) -> Result<Self, SweepError> {
        let grid = Grid::new(axes)?;
        let scene = Scene::load(scene, set)?;
        let manifest = Manifest::new(&scene, set, &grid);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let runs = Runs::new(scene, grid);
        pool.install(|| runs.check())?;
        Ok(Self { runs, manifest, pool })
    }

    /// The grid of the runs.
    pub fn grid(&self) -> &Grid {
        &self.runs.grid
    }

    /// Computes the runs of `shard` that no journal in `directory`, which must exist, has yet.
    ///
    /// # Errors
    /// [`SweepError`] where the directory holds another sweep, a journal cannot be written, or
    /// `observer` stopped it: then the runs in progress are finished and recorded first.
    pub fn run(&self, directory: &Path, shard: Shard, observer: Observer<'_>) -> Result<(), SweepError> {
        let all = self.runs.grid.runs();
        let recorder = Recorder::of(&self.manifest, all, directory, shard)?;
        let (left, runs) = (recorder.missing(), shard.runs(all).count());
        let progress = SweepProgress { finished: runs - left.len(), runs, unsolved: 0 };
        let stopped = observer(&progress) == Control::Stop;
        let collector = Mutex::new(Collector { recorder, progress, observer, stopped });
        let lock = || collector.lock().unwrap_or_else(PoisonError::into_inner);
        // A queue: runs differ in length, and a thread that is free takes the next one.
        self.pool.install(|| {
            left.into_iter().par_bridge().try_for_each(|run| {
                if lock().stopped {
                    return Ok(());
                }
                let record = self.runs.record(run);
                lock().enter(&record)
            })
        })?;
        let SweepProgress { finished, runs, .. } = lock().progress;
        if finished < runs {
            return Err(SweepError::Interrupted { directory: directory.to_owned(), finished, runs });
        }
        Ok(())
    }
}

/// Collects the finished runs of all threads.
struct Collector<'o> {
    recorder: Recorder,
    progress: SweepProgress,
    observer: Observer<'o>,
    /// Whether no further run is to begin.
    stopped: bool,
}

impl Collector<'_> {
    fn enter(&mut self, record: &Record) -> Result<(), SweepError> {
        if let Err(error) = self.recorder.enter(&record.line()) {
            self.stopped = true;
            return Err(error);
        }
        self.progress.finished += 1;
        self.progress.unsolved += usize::from(record.outcome != Outcome::Solved);
        self.stopped |= (self.observer)(&self.progress) == Control::Stop;
        Ok(())
    }
}

/// A complete sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// The table.
    pub table: PathBuf,
    /// Number of runs.
    pub runs: usize,
    /// The numbers of those that failed or were refused.
    pub unsolved: Vec<usize>,
    /// The numbers of those that were solved with warnings.
    pub warned: Vec<usize>,
}

/// Joins the journals in `directory` to one table, `sweep.csv` there.
///
/// # Errors
/// [`SweepError::Missing`] where a run is not finished, and where a file cannot be read or written;
/// then a table that was there before stays as it is.
pub fn merge(directory: &Path) -> Result<Merged, SweepError> {
    let manifest = Manifest::read(directory)?.ok_or_else(|| SweepError::Manifest {
        path: directory.join(MANIFEST),
        reason: "there is none".into(),
    })?;
    let grid = manifest.grid()?;
    let finished = Finished::read(directory, grid.runs())?;
    let missing = finished.missing();
    if !missing.is_empty() {
        return Err(SweepError::Missing {
            directory: directory.to_owned(),
            count: missing.len(),
            runs: grid.runs(),
            missing: numbers(&missing),
        });
    }
    let (mut columns, mut unsolved, mut warned) = (Columns::default(), Vec::new(), Vec::new());
    finished.each(
        |record| (table::names(&record), record.outcome, record.run),
        |(names, outcome, run)| {
            columns.add(&names);
            let warns = names.iter().any(|name| name.split('.').any(|key| key == "warnings"));
            match outcome {
                Outcome::Solved if warns => warned.push(run),
                Outcome::Solved => {}
                _ => unsolved.push(run),
            }
            Ok(())
        },
    )?;
    let table = directory.join(TABLE);
    let mut stage = StagedFiles::new(directory)?;
    stage.add(TABLE, |out| {
        let (rows, mut writer) = (SweepTable::new(&grid, &columns), csv::Writer::from_writer(out));
        writer.write_record(rows.header())?;
        let write = |row: Vec<String>| Ok(writer.write_record(row)?);
        finished.each(|record| rows.row(&record), write).map_err(std::io::Error::other)?;
        writer.flush()
    })?;
    stage.commit()?;
    Ok(Merged { table, runs: grid.runs(), unsolved, warned })
}

/// Ascending numbers as people write them: `1–4, 7, 9`; only the first of very many.
pub fn numbers(ascending: &[usize]) -> String {
    const SHOWN: usize = 20;
    let parts: Vec<String> = ascending
        .chunk_by(|a, b| a + 1 == *b)
        .take(SHOWN + 1)
        .map(|part| match part {
            [first, .., last] => format!("{first}–{last}"),
            [only] => only.to_string(),
            [] => String::new(),
        })
        .collect();
    match parts.get(..SHOWN) {
        Some(shown) if parts.len() > SHOWN => format!("{}, …", shown.join(", ")),
        _ => parts.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(numbers(&[]), "");
        assert_eq!(numbers(&[1, 2, 3, 5, 8, 9]), "1–3, 5, 8–9");
        let odd: Vec<usize> = (0..100).map(|i| 2 * i + 1).collect();
        assert!(numbers(&odd).ends_with("37, 39, …"), "{}", numbers(&odd));
        // Just as many as are shown.
        assert!(numbers(&odd[..20]).ends_with("37, 39"), "{}", numbers(&odd[..20]));
    }

    /// Three runs, the second of which cannot be started.
    fn sweep(folder: &Path) -> Sweep {
        let scene = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, \
                     mass_per_length = 1, basis.ancf.elements = 1 }\n\
                     support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                     analysis.dynamic = { duration = 1e-3, output_every = 1e-3 }\n";
        let path = folder.join("scene.toml");
        std::fs::write(&path, scene).unwrap();
        let axis = Axis::parse("support.0.move={},{ x = 0.001 },{}").unwrap();
        Sweep::new(&path, &[], vec![axis], 1).unwrap()
    }

    /// What the observer is told; it ends the sweep after so many calls.
    fn told(folder: &Path, shard: Shard, calls: usize) -> (Vec<[usize; 3]>, Result<(), SweepError>) {
        let mut told = Vec::new();
        let done = sweep(folder).run(folder, shard, &mut |now: &SweepProgress| {
            told.push([now.finished, now.runs, now.unsolved]);
            if told.len() == calls { Control::Stop } else { Control::Continue }
        });
        (told, done)
    }

    #[test]
    fn the_observer_is_told_of_every_run() {
        let folder = tempfile::tempdir().unwrap();
        let (calls, done) = told(folder.path(), "2/2".parse().unwrap(), 0);
        assert_eq!(calls, [[0, 1, 0], [1, 1, 1]]);
        assert!(done.is_ok(), "{done:?}");
        // A run of before counts as finished, and no longer as unsolved.
        let (calls, done) = told(folder.path(), Shard::WHOLE, 0);
        assert_eq!(calls, [[1, 3, 0], [2, 3, 0], [3, 3, 0]]);
        assert!(done.is_ok(), "{done:?}");
        let (calls, _) = told(folder.path(), Shard::WHOLE, 0);
        assert_eq!(calls, [[3, 3, 0]]);
        let merged = merge(folder.path()).unwrap();
        assert_eq!((merged.runs, merged.unsolved), (3, vec![2]));
    }

    #[test]
    fn the_observer_ends_the_sweep() {
        let folder = tempfile::tempdir().unwrap();
        for (calls, expected) in [(1, 0), (2, 1), (3, 3)] {
            let (made, done) = told(folder.path(), Shard::WHOLE, calls);
            assert_eq!(made.len(), calls);
            match done {
                Err(SweepError::Interrupted { finished, runs: 3, .. }) => assert_eq!(finished, expected),
                other => assert!(expected == 3 && other.is_ok(), "{other:?}"),
            }
        }
    }
}
