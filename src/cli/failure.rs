//! Why a command failed.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::cost::CostError;
use crate::output::OutputError;
use crate::results::Run;
use crate::run::RunError;
use crate::scene::{Scene, SceneError};
use crate::sweep::SweepError;
use miette::Diagnostic;

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The scene is wrong.
    Scene(SceneError),
    /// It could not be built or solved.
    Run {
        /// The scene file.
        scene: String,
        /// Cause of the failure.
        error: Box<RunError>,
    },
    /// A sweep could not be done.
    Sweep(SweepError),
    /// The cost of a scene could not be measured.
    Cost {
        /// The scene file.
        scene: String,
        /// Cause of the failure.
        error: Box<CostError>,
    },
    /// The results are less accurate than was wanted.
    Inaccurate {
        /// The scene file.
        scene: String,
        /// Which accuracy, by how much, and why.
        missed: String,
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
        /// The directory.
        path: PathBuf,
        /// Cause of the failure.
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

    /// The interruption of the scene called `name`, whose results are in `results`.
    pub fn interrupted(scene: &Scene, results: &Path) -> Self {
        Self::Interrupted { scene: scene.name().to_owned(), results: results.to_owned() }
    }

    /// The failure of results that are less accurate than was wanted.
    pub fn inaccurate(name: &str, run: &Run) -> Option<Self> {
        let missed = run.error.as_ref()?.missed(run.analysis)?;
        Some(Self::Inaccurate { scene: name.to_owned(), missed })
    }

    /// A failure to measure the cost of the scene called `name`.
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
            Self::Inaccurate { .. } | Self::Interrupted { .. } | Self::Output(_) | Self::Print(_) => 1,
        }
    }

    fn inner(&self) -> Option<&dyn Diagnostic> {
        match self {
            Self::Scene(error) => Some(error),
            Self::Run { error, .. } => Some(error.as_ref()),
            Self::Sweep(error) => Some(error),
            Self::Cost { error, .. } => Some(error.as_ref()),
            Self::Output(error) => Some(error),
            Self::Inaccurate { .. } | Self::Interrupted { .. } | Self::Directory { .. } | Self::Print(_) => {
                None
            }
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
            Self::Inaccurate { scene, missed } => write!(f, "{scene}: {missed}"),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Singular;
    use crate::scene;
    use crate::solve::eigen::EigenError;
    use std::error::Error as _;

    fn wrong() -> SceneError {
        scene::parse("arm.toml", "title = \"Arm\"\nnonsense = 1\n").expect_err("no such key")
    }

    fn full() -> io::Error {
        io::Error::other("the disk is full")
    }

    fn lost() -> RunError {
        EigenError::Singular(Singular { row: 3 }).into()
    }

    /// One of each, with its exit status, its causes, and whether it has help.
    fn all() -> Vec<(Failure, u8, Option<&'static str>, bool)> {
        let journal = SweepError::Journal { path: "a/journal-1-of-1.jsonl".into(), source: full() };
        let nothing = SweepError::Grid { reason: "nothing varies".into() };
        let singular = "the matrix is singular: no pivot in row 3";
        vec![
            (Failure::Scene(wrong()), 2, None, true),
            (Failure::run("a.toml", lost()), 1, Some(singular), true),
            (Failure::Sweep(journal), 1, Some("the disk is full"), true),
            (Failure::Sweep(nothing), 2, None, true),
            (Failure::cost("a.toml", CostError::Lines(wrong())), 1, Some("unknown key `nonsense`"), false),
            (Failure::cost("a.toml", CostError::Target { target: 2.0 }), 2, None, true),
            (Failure::Interrupted { scene: "a.toml".into(), results: "out/a".into() }, 1, None, false),
            (Failure::Directory { path: "out/a".into(), error: full() }, 2, None, true),
            (
                Failure::Output(OutputError::Write { path: "a.csv".into(), source: full() }),
                1,
                Some("full"),
                true,
            ),
            (Failure::Print(full()), 1, None, false),
        ]
    }

    #[test]
    fn failures_hand_on_status_cause_and_help() {
        for (failure, status, cause, helps) in all() {
            assert_eq!(failure.exit_status(), status, "{failure}");
            let found = failure.source().map(ToString::to_string);
            assert_eq!(found.is_some(), cause.is_some(), "{failure}: {found:?}");
            let said = found.unwrap_or_default();
            assert!(said.contains(cause.unwrap_or_default()), "{failure}: {said}");
            assert_eq!(failure.help().is_some(), helps, "{failure}");
        }
        let blocked = Failure::Directory { path: "out/a".into(), error: full() };
        let help = blocked.help().map(|help| help.to_string());
        assert_eq!(help.as_deref(), Some("give a directory that can be written with `-o DIR`"));
    }

    /// The place is in the second line of the text, eight letters long.
    #[test]
    fn the_place_in_a_scene_is_handed_on() {
        let failure = Failure::Scene(wrong());
        let labels: Vec<_> = failure.labels().into_iter().flatten().collect();
        assert_eq!(labels.len(), 1);
        assert_eq!((labels[0].offset(), labels[0].len()), (14, 8));
        let code = failure.source_code().expect("the text of the scene");
        let read = code.read_span(labels[0].inner(), 0, 0).expect("its lines");
        assert_eq!((read.name(), read.line()), (Some("arm.toml"), 1));
        let interrupted = Failure::Interrupted { scene: "a.toml".into(), results: "out/a".into() };
        assert!(interrupted.labels().is_none() && interrupted.source_code().is_none());
    }

    /// Errors that come from a scene or a table are passed on as such.
    #[test]
    fn a_sweep_fails_as_its_scene_or_its_table_does() {
        assert!(matches!(Failure::from(SweepError::Scene(wrong())), Failure::Scene(_)));
        let table = OutputError::Occupied { path: "a/sweep.csv".into() };
        assert!(matches!(Failure::from(SweepError::Output(table)), Failure::Output(_)));
        let busy = SweepError::Busy { path: "a".into() };
        assert!(matches!(Failure::from(busy), Failure::Sweep(SweepError::Busy { .. })));
    }

    #[test]
    fn failures_name_what_they_are_about() {
        let said: Vec<String> = all().iter().map(|(failure, ..)| failure.to_string()).collect();
        assert_eq!(said[0], "unknown key `nonsense` at the top of the scene");
        assert!(said[1].starts_with("a.toml: the stiffness matrix cannot be factorised"), "{}", said[1]);
        assert_eq!(said[3], "these runs are no sweep: nothing varies");
        assert_eq!(said[5], "a.toml: the target error 2e0 is not between 1e-12 and 1");
        assert_eq!(said[6], "a.toml: interrupted; what was computed until then is in out/a");
        assert_eq!(said[7], "cannot write results into out/a: the disk is full");
        assert_eq!(said[8], "cannot write `a.csv`");
        assert_eq!(said[9], "cannot write to standard output: the disk is full");
    }
}
