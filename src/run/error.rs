//! Why there is no result.

use crate::assembly::BuildError;
use crate::model::Undamped;
use crate::numeric::plain;
use crate::restart::RestartError;
use crate::results::{Results, Trajectory};
use crate::solve::dynamics::start::StartError;

/// Why there is no result.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum RunError {
    /// The model cannot be turned into equations.
    #[error(transparent)]
    #[diagnostic(transparent)]
    System(#[from] BuildError),
    /// No equilibrium was found beyond some load factor.
    #[error(
        "no equilibrium beyond load factor {}: {cause}; smallest step tried {step:.1e}, worst at s = {} m of beam `{beam}`",
        plain(*.load, 6),
        plain(*.s, 4)
    )]
    #[diagnostic(help("{advice}"))]
    NoEquilibrium {
        /// Load factor of the last equilibrium.
        load: f64,
        /// Smallest step tried.
        step: f64,
        /// What went wrong.
        cause: String,
        /// The beam on which the iteration went worst.
        beam: String,
        /// Arc length on it \[m\].
        s: f64,
        /// What to try.
        advice: String,
        /// The results until then.
        partial: Box<Trajectory>,
    },
    /// A path has reached its largest number of points before its target.
    #[error(
        "the path ends after `max_points = {points}` at load factor {}, before {target}",
        plain(*.load, 6)
    )]
    #[diagnostic(help(
        "raise `max_points`, or `max_step` if there is one; a path that turns back may never get there: look at its states until here"
    ))]
    OutOfPoints {
        /// Points on the path.
        points: usize,
        /// Load factor of the last equilibrium.
        load: f64,
        /// Which load factor or place of a probe was to be reached.
        target: String,
        /// The results until then.
        partial: Box<Trajectory>,
    },
    /// A path along which things come and go, as they do until load factor 1, and nothing else changes.
    #[error(
        "the path leads nowhere beyond load factor 1, before {target}: what comes and goes in this stage has done so, and nothing else \
         grows"
    )]
    #[diagnostic(help(
        "let a load, a support that moves or an actuation be new in this stage, or end it where all has come and gone, without \
         `arc_length`"
    ))]
    NothingGrows {
        /// Which place of a probe was to be reached.
        target: String,
        /// The results until then.
        partial: Box<Trajectory>,
    },
    /// A path along which loads grow and nothing moves.
    #[error(
        "the path leads nowhere up to load factor {load:.1e}, before {target}: the loads grow, and nothing moves"
    )]
    #[diagnostic(help("look whether a support holds what is to move, and whether the loads act there only"))]
    NothingMoves {
        /// Load factor of the last equilibrium.
        load: f64,
        /// Which load factor, place of a probe or number of points was to be reached.
        target: String,
        /// The results until then.
        partial: Box<Trajectory>,
    },
    /// A setting refers to a probe that does not exist.
    #[error("there is no probe `{probe}`; the probes are: {known}")]
    NoSuchProbe {
        /// The name given.
        probe: String,
        /// The names that exist.
        known: String,
    },
    /// Critical loads are asked for in a state that is no equilibrium.
    #[error(
        "critical loads are those that are added to an equilibrium, and the state with which this analysis starts is none without its own loads"
    )]
    #[diagnostic(help(
        "let springs that pull, obstacles that press, and what comes and goes besides loads, do so in a static stage of its own before \
         this one, and let a motion come to rest"
    ))]
    Unbalanced,
    /// A path along which nothing changes but the load factor.
    #[error(
        "nothing in the scene grows with the load factor, so that its path by `arc_length` leads nowhere"
    )]
    #[diagnostic(help(
        "a path needs a load, a support that moves or an actuation, and in a stage one that is new or has changed; without \
         `arc_length` the state is found as it is"
    ))]
    NoPath,
    /// An eigenvalue problem could not be solved.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Eigen(#[from] crate::solve::eigen::EigenError),
    /// An integrator cannot handle inextensible beams.
    #[error(transparent)]
    #[diagnostic(help("{}", Undamped::HELP))]
    Undamped(#[from] Undamped),
    /// A time step could not be taken.
    #[error(
        "no step of {step:.1e} s beyond t = {} s: {cause}; the last iterate changed most at s = {} m of beam `{beam}`",
        plain(*.time, 6),
        plain(*.s, 4)
    )]
    #[diagnostic(help("{advice}"))]
    NoStep {
        /// Time of the last state \[s\].
        time: f64,
        /// Length of the step \[s\].
        step: f64,
        /// What went wrong.
        cause: String,
        /// The beam on which the last iterate changed most.
        beam: String,
        /// Arc length on it \[m\].
        s: f64,
        /// What to try.
        advice: String,
        /// The results until then.
        partial: Box<Trajectory>,
    },
    /// The motion cannot start as the scene says.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Start(#[from] StartError),
    /// A saved state cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Restart(#[from] RestartError),
    /// The memory that a model needs is not free.
    #[error("this needs about {:.3} GiB of memory, and {:.3} GiB are free", gib(*.needed), gib(*.free))]
    #[diagnostic(help("ask for fewer nodes, records or modes, or end other programs"))]
    Memory {
        /// Memory needed \[bytes\].
        needed: f64,
        /// Free memory \[bytes\].
        free: f64,
    },
    /// Something that is done with one analysis was asked of several.
    #[error("this scene has stages, and this takes one analysis")]
    #[diagnostic(help(
        "`ancf run` and `run::solve_stages` do its analyses one after the other, `ancf run --error` with their errors"
    ))]
    Stages,
    /// A stage failed.
    #[error("stage `{stage}`: {cause}")]
    #[diagnostic(forward(cause))]
    InStage {
        /// Its name.
        stage: String,
        /// Why.
        cause: Box<RunError>,
    },
    /// A static stage ended at another load factor than 1, and another one comes after it.
    #[error("stage `{stage}` ends at a load factor other than 1, from which no further stage can start")]
    #[diagnostic(help(
        "give it the loads with which it is to end, and let its path by arc length end with `until_load = 1`, or let it be the last stage"
    ))]
    OpenEnd {
        /// Its name.
        stage: String,
    },
    /// A shape was asked for where nothing is known.
    #[error("{}", .reason)]
    #[diagnostic(help("{advice}"))]
    NoShape {
        /// What was asked for, and what there is.
        reason: String,
        /// What to try.
        advice: &'static str,
    },
    /// The scene is legal, but this version cannot compute it.
    #[error("{what} is not available in this version")]
    #[diagnostic(help("{instead}"))]
    Unavailable {
        /// The feature that the scene asks for.
        what: &'static str,
        /// What to use instead.
        instead: &'static str,
    },
}

impl RunError {
    /// 2 where the input is at fault, 1 where the computation failed.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::InStage { cause, .. } => cause.exit_status(),
            Self::System(_)
            | Self::Stages
            | Self::OpenEnd { .. }
            | Self::NoSuchProbe { .. }
            | Self::Start(_)
            | Self::Restart(_)
            | Self::Undamped(_)
            | Self::Unbalanced
            | Self::NoPath
            | Self::NoShape { .. }
            | Self::Unavailable { .. } => 2,
            Self::NoEquilibrium { .. }
            | Self::OutOfPoints { .. }
            | Self::NothingGrows { .. }
            | Self::NothingMoves { .. }
            | Self::NoStep { .. }
            | Self::Eigen(_)
            | Self::Memory { .. } => 1,
        }
    }

    /// The results before the failure, if they are more than the state at the start.
    pub fn take_partial(&mut self) -> Option<Results> {
        let partial = self.partial().filter(|partial| partial.parameter.len() > 1);
        partial.map(std::mem::take).map(Results::Trajectory)
    }

    /// The results before the failure.
    pub fn partial(&mut self) -> Option<&mut Trajectory> {
        match self {
            Self::NoEquilibrium { partial, .. }
            | Self::OutOfPoints { partial, .. }
            | Self::NothingGrows { partial, .. }
            | Self::NothingMoves { partial, .. }
            | Self::NoStep { partial, .. } => Some(partial),
            Self::InStage { cause, .. } => cause.partial(),
            _ => None,
        }
    }
}

fn gib(bytes: f64) -> f64 {
    bytes / 1024f64.powi(3)
}
