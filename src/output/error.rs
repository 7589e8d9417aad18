//! Why results could not be written.

use std::io;
use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

#[cfg(feature = "report")]
use super::plot::PlotError;

/// Why results could not be written. Nothing half-written stays under a final name.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum OutputError {
    /// The directory of the results cannot be made.
    #[error("cannot create the directory `{}` for the results", path.display())]
    #[diagnostic(
        code(ancf::output::directory),
        help("name another directory with `-o DIR`, or make its parent writable")
    )]
    Directory {
        /// The directory asked for.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A file cannot be written or moved to its final name.
    #[error("cannot write `{}`", path.display())]
    #[diagnostic(
        code(ancf::output::write),
        help("make the directory writable and free space on its disk, or name another one with `-o DIR`")
    )]
    Write {
        /// The final name of the file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A directory stands where a file should go.
    #[error("`{}` is a directory; a file of that name is to be written there", path.display())]
    #[diagnostic(code(ancf::output::occupied), help("move it away, or name another directory with `-o DIR`"))]
    Occupied {
        /// The final name of the file.
        path: PathBuf,
    },
    /// The trajectory contradicts itself.
    #[error("{quantity}: expected {expected} entries, found {found}")]
    #[diagnostic(
        code(ancf::output::inconsistent),
        help(
            "a trajectory holds one probe sample and one energy per entry of `parameter`, and one value per arc length of a shape"
        )
    )]
    Inconsistent {
        /// Which list has the wrong length.
        quantity: String,
        /// The length that it should have, by the list to which it belongs.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// A plot cannot be drawn.
    #[cfg(feature = "report")]
    #[error("cannot draw `{name}`")]
    #[diagnostic(
        code(ancf::output::plot),
        help("the numbers are unaffected: report this with the scene file")
    )]
    Plot {
        /// The file of the plot.
        name: String,
        /// What went wrong.
        source: PlotError,
    },
    /// The report page cannot be made.
    #[cfg(feature = "report")]
    #[error("cannot make the report page")]
    #[diagnostic(
        code(ancf::output::page),
        help("the numbers are unaffected: report this with the scene file")
    )]
    Report {
        /// What went wrong.
        source: askama::Error,
    },
}
