//! Why a command did not do its work.

use std::fmt;
use std::io;
use std::path::PathBuf;

use ancf::cost::CostError;
use ancf::output::OutputError;
use ancf::run::RunError;
use ancf::scene::SceneError;
use ancf::sweep::SweepError;
use miette::Diagnostic;

/// Why a command did not do its work.
#[derive(Debug)]
pub enum Failure {
    /// The scene is wrong.
    Scene(SceneError),
    /// It could not be built or solved.
    Run {
        /// The scene file.
        scene: String,
        /// Why.
        error: Box<RunError>,
    },
    /// A sweep could not be done.
    Sweep(SweepError),
    /// The cost of a scene could not be found out.
    Cost {
        /// The scene file.
        scene: String,
        /// Why.
        error: Box<CostError>,
    },
    /// It was interrupted.
    Interrupted {
        /// The scene file.
        scene: String,
        /// Where the results until then are.
        results: PathBuf,
    },
    /// Nothing can be written where the results should go.
    Directory {
        /// Where.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The results could not be written.
    Output(OutputError),
    /// Standard output failed.
    Print(io::Error),
}

impl Failure {
    /// A failure of the scene called `name`.
    pub fn run(name: &str, error: RunError) -> Self {
        Self::Run { scene: name.to_owned(), error: Box::new(error) }
    }

    /// A failure to find out what the scene called `name` costs.
    pub fn cost(name: &str, error: CostError) -> Self {
        Self::Cost { scene: name.to_owned(), error: Box::new(error) }
    }

    /// 2 where the input is at fault, 1 where the computation or its environment is.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Scene(_) | Self::Directory { .. } => 2,
            Self::Run { error, .. } => error.exit_status(),
            Self::Sweep(error) => error.exit_status(),
            Self::Cost { error, .. } => error.exit_status(),
            Self::Interrupted { .. } | Self::Output(_) | Self::Print(_) => 1,
        }
    }

    fn inner(&self) -> Option<&dyn Diagnostic> {
        match self {
            Self::Scene(error) => Some(error),
            Self::Run { error, .. } => Some(error.as_ref()),
            Self::Sweep(error) => Some(error),
            Self::Cost { error, .. } => Some(error.as_ref()),
            Self::Output(error) => Some(error),
            Self::Interrupted { .. } | Self::Directory { .. } | Self::Print(_) => None,
        }
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Scene(error) => Self::Scene(error),
            SweepError::Output(error) => Self::Output(error),
            error => Self::Sweep(error),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(error) => error.brief().fmt(f),
            Self::Run { scene, error } => write!(f, "{scene}: {error}"),
            Self::Sweep(error) => error.fmt(f),
            Self::Cost { scene, error } => write!(f, "{scene}: {error}"),
            Self::Interrupted { scene, results } => {
                write!(f, "{scene}: interrupted; what was computed until then is in {}", results.display())
            }
            Self::Directory { path, error } => {
                write!(f, "cannot write results into {}: {error}", path.display())
            }
            Self::Output(error) => error.fmt(f),
            Self::Print(error) => write!(f, "cannot write to standard output: {error}"),
        }
    }
}

impl std::error::Error for Failure {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Output(error) => error.source(),
            Self::Run { error, .. } => error.source(),
            Self::Sweep(error) => error.source(),
            Self::Cost { error, .. } => error.source(),
            _ => None,
        }
    }
}

impl Diagnostic for Failure {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        match self {
            Self::Directory { .. } => Some(Box::new("give a directory that can be written with `-o DIR`")),
            _ => self.inner()?.help(),
        }
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.inner()?.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        self.inner()?.labels()
    }
}
