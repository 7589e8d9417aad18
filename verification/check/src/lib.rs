//! Verification cases: what is claimed, against which reference, to which tolerance, and whether it
//! holds.
//!
//! A case is a folder `verification/cases/<name>/`:
//!
//! ```text
//! scene.toml     what `ancf run` solves (more scenes may lie beside it)
//! case.toml      claim, oracles, families of runs, checks, figures: see [`case`]
//! README.md      source, goal, sketch
//! ```
//!
//! and its references are `reference_data/<name>/<oracle>.csv` with `<oracle>.provenance.toml`
//! beside it, written by `verify freeze` alone. The tests of the root package, the report and the
//! documentation all read cases through this crate; there is no second list, and adding a case is
//! adding a folder.
//!
//! ```text
//! case.toml ──► Case ─┬─ families ──► Member ──► Run (trajectory) ──────┐
//!                     ├─ oracles ───► Table (csv, provenance) ──────────┼─► Outcome per number,
//!                     └─ checks ── quantity, norm, tolerance, why ──────┘   curve, rate
//! ```
//!
//! The crate is pure Rust and starts no process, so that `cargo test` of the root package needs
//! nothing else.

#![warn(missing_docs)]

pub mod audit;
pub mod case;
pub mod compare;
pub mod execute;
pub mod family;
mod figure;
pub mod interpolation;
pub mod quantity;
pub mod reference;
pub mod suite;

pub use audit::audit;
pub use case::Case;
pub use compare::{Outcome, Verdict};
pub use execute::{Examined, examine};
pub use suite::Suite;

use std::path::PathBuf;

/// Why a case cannot be examined. A number that misses its tolerance is no error but a failed
/// [`Outcome`].
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file or folder cannot be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file does not have the right format.
    #[error("{path}: {message}")]
    Format {
        /// The file.
        path: PathBuf,
        /// What was expected, what was found, and where.
        message: String,
    },
    /// The solver refused a scene or failed.
    #[error("{case}: run {run}: {message}")]
    Run {
        /// Name of the case.
        case: String,
        /// Label of the run.
        run: String,
        /// The solver's message with its causes.
        message: String,
    },
    /// A check asks for something that is not there.
    #[error("{case}: check {check}: {message}")]
    Check {
        /// Name of the case.
        case: String,
        /// Number of the check, from 1, with its quantity.
        check: String,
        /// What was expected, what was found.
        message: String,
    },
}

/// Short for a result of this crate.
pub type Result<T> = std::result::Result<T, Error>;
