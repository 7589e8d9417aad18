//! Why a sweep cannot be done.

use std::io;
use std::path::PathBuf;

use crate::output::OutputError;
use crate::scene::SceneError;

/// Why a sweep cannot be done, or its runs not be joined. A run that fails is no reason: it is
/// recorded.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum SweepError {
    /// An axis is not written as it should be.
    #[error("--vary {option}: {reason}")]
    #[diagnostic(help(
        "write PATH=START:STOP:COUNT, PATH=START:STOP:COUNT:log or PATH=a,b,c, such as \
         effect.moment.0.value=\"0 N m:300 N m:7\", beam.arm.area=1e-6:1e-4:5:log or \
         beam.arm.basis.ancf.elements=4,8,16"
    ))]
    Vary {
        /// What was written.
        option: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A list of values cannot be read.
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help(
        "give a CSV file whose header names paths of the scene, such as effect.moment.0.value, and whose lines hold \
         one value for each"
    ))]
    List {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A line of a list makes no legal scene.
    #[error("{lines}: no legal scene")]
    #[diagnostic(help(
        "every line of a list gives each path of the header a value that is legal in the scene"
    ))]
    Row {
        /// The file and the line of every list that takes part.
        lines: String,
        /// What is wrong with the scene.
        source: SceneError,
    },
    /// The axes do not make a grid.
    #[error("these runs are no sweep: {reason}")]
    #[diagnostic(help(
        "vary at least one path, each once, with --vary PATH=START:STOP:COUNT or --list FILE.csv"
    ))]
    Grid {
        /// What is wrong.
        reason: String,
    },
    /// The scene is wrong, or one of the combinations.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The directory holds another sweep.
    #[error("{} holds another sweep: {difference}", directory.display())]
    #[diagnostic(help("name another directory with `-o DIR`, or remove that sweep's files"))]
    Another {
        /// Directory of the sweep.
        directory: PathBuf,
        /// What differs.
        difference: String,
    },
    /// The directory holds journals, but no manifest that says of which sweep.
    #[error("{} holds journals of a sweep whose manifest {} is missing", directory.display(), super::MANIFEST)]
    #[diagnostic(help("name another directory with `-o DIR`, or remove the journals"))]
    Stray {
        /// Directory of the sweep.
        directory: PathBuf,
    },
    /// The manifest cannot be read or written.
    #[error("{}: cannot use the manifest of the sweep: {reason}", path.display())]
    #[diagnostic(help("name a directory in which a sweep of this version has started"))]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Cause of the failure.
        reason: String,
    },
    /// Another process computes the same part.
    #[error("{}: another process is computing this part of the sweep", path.display())]
    #[diagnostic(help("wait for it, or share the runs out with --shard I/N"))]
    Busy {
        /// The journal that it writes.
        path: PathBuf,
    },
    /// A journal cannot be read or written.
    #[error("{}: the journal of the sweep cannot be read or written", path.display())]
    #[diagnostic(help(
        "runs recorded until now are kept: call the same command again once the cause is mended"
    ))]
    Journal {
        /// The file or directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The threads cannot be started.
    #[error("cannot start the threads of the sweep")]
    #[diagnostic(help("ask for fewer with --threads"))]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The observer stopped the sweep.
    #[error("interrupted; {finished} of {runs} runs are finished and recorded in {}", directory.display())]
    #[diagnostic(help("call the same command again to go on: it repeats no finished run"))]
    Interrupted {
        /// Directory of the sweep.
        directory: PathBuf,
        /// Runs of this part that are finished.
        finished: usize,
        /// Runs of this part.
        runs: usize,
    },
    /// Not all runs are there.
    #[error("{}: {count} of {runs} runs are missing: {missing}", directory.display())]
    #[diagnostic(help(
        "call the command that started the sweep again, with the same arguments (they are in its manifest {}): it \
         repeats no finished run; a part that did not come to its end goes on with its own --shard I/N, and without \
         --shard all that is missing is computed",
        super::MANIFEST
    ))]
    Missing {
        /// Directory of the sweep.
        directory: PathBuf,
        /// Number of missing runs.
        count: usize,
        /// Number of all runs.
        runs: usize,
        /// Numbers of the missing runs.
        missing: String,
    },
    /// The table cannot be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
}

impl SweepError {
    /// 2 where the input is at fault, 1 where the computation or its environment is.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Vary { .. }
            | Self::List { .. }
            | Self::Row { .. }
            | Self::Grid { .. }
            | Self::Scene(_)
            | Self::Another { .. }
            | Self::Stray { .. }
            | Self::Manifest { .. } => 2,
            Self::Busy { .. }
            | Self::Journal { .. }
            | Self::Threads(_)
            | Self::Interrupted { .. }
            | Self::Missing { .. }
            | Self::Output(_) => 1,
        }
    }
}
