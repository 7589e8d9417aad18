//! Why the cost of a scene cannot be measured.

use crate::output::OutputError;
use crate::run::RunError;
use crate::scene::SceneError;

/// Why the cost of a scene cannot be measured.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CostError {
    /// The target is not a legal error.
    #[error("the target error {target:e} is not between 1e-12 and 1")]
    #[diagnostic(help(
        "it is the position error in beam lengths, or the relative error of frequencies or load factors; 1e-4 is a usual choice"
    ))]
    Target {
        /// The target that was given.
        target: f64,
    },
    /// The budget is not a legal time.
    #[error("the budget of {budget} s is not between 0.01 s and a week")]
    #[diagnostic(help("give a time with its unit, such as --budget 60s or --budget \"2 min\""))]
    Budget {
        /// The budget that was given \[s\].
        budget: f64,
    },
    /// Runs of different settings would end at different points.
    #[error("the path ends after a number of points, which lie elsewhere for every setting")]
    #[diagnostic(help(
        "give `until_load` or `until_probe` in `arc_length`, so that all runs end at the same state"
    ))]
    Path,
    /// The scene itself cannot be built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Run(#[from] RunError),
    /// There is no reference for the errors.
    #[error("no reference could be made: {reason}")]
    #[diagnostic(help(
        "give more time with --budget, or a larger --target; `ancf run` says more about a run that fails"
    ))]
    NoReference {
        /// What prevented it.
        reason: String,
    },
    /// Stopped before anything was measured.
    #[error("interrupted before anything was measured")]
    Interrupted,
    /// The lines that ask for a setting are not accepted: a fault of this library.
    #[error("internal: the lines for the best setting are not a legal part of the scene")]
    Lines(#[source] SceneError),
    /// The threads cannot be started.
    #[error("cannot start the threads of the reference")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Results cannot be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
}

impl CostError {
    /// 2 where the input is at fault, 1 where the computation or its environment is.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Target { .. } | Self::Budget { .. } | Self::Path => 2,
            Self::Run(error) => error.exit_status(),
            Self::NoReference { .. }
            | Self::Interrupted
            | Self::Lines(_)
            | Self::Threads(_)
            | Self::Output(_) => 1,
        }
    }
}
