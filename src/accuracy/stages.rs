//! Errors of analyses one after the other.
//!
//! Each stage begins where the one before it ended. So do the runs that tell its errors: those on fewer cells begin where a run on as
//! few cells has ended the stage before, and what a stage errs by is part of what the next ones err by.

use super::setting::{Setting, Solver};
use crate::model::{Discretization, GaussPoints, Stage};
use crate::restart::SavedState;
use crate::run::{Options, RunError, solve_stages};

/// The discretisations of all beams.
type Beams = Vec<(Discretization, GaussPoints)>;

/// Where runs with other discretisations than those of the scene begin.
pub(super) struct Starts {
    /// The stages that have ended.
    before: Vec<Stage>,
    /// The start of the first stage.
    given: Option<SavedState>,
    /// The ends of the stage before …
    ends: Vec<(Beams, SavedState)>,
    /// … and of this one.
    next: Vec<(Beams, SavedState)>,
}

impl Starts {
    /// Those of a first stage.
    pub fn new(given: Option<SavedState>) -> Self {
        Self { before: Vec::new(), given, ends: Vec::new(), next: Vec::new() }
    }

    /// Where a run of this stage begins; with discretisations that the stage before did not have, it goes through all of them.
    ///
    /// # Errors
    /// [`RunError`] where one of these has no result.
    pub fn of(&mut self, beams: &Beams) -> Result<Option<SavedState>, RunError> {
        if let Some((_, end)) = self.ends.iter().find(|(of, _)| of == beams) {
            return Ok(Some(end.clone()));
        }
        let setting = Setting { beams: beams.clone(), solver: Solver::Scene };
        let with = |stage: &Stage| {
            let (model, analysis) = setting.apply(&stage.model, &stage.analysis);
            Stage { name: stage.name.clone(), model, analysis }
        };
        let stages: Vec<Stage> = self.before.iter().map(with).collect();
        let run = solve_stages(&stages, Options { start: self.given.as_ref(), ..Options::default() });
        if let Some(failure) = run.failure {
            return Err(failure);
        }
        let end = run.results.into_iter().rev().find_map(|results| results.states().saved.clone());
        if let Some(end) = &end {
            self.ends.push((beams.clone(), end.clone()));
        }
        Ok(end.or_else(|| self.given.clone()))
    }

    /// Keeps the end of a run of this stage.
    pub fn keep(&mut self, beams: &Beams, end: Option<&SavedState>) {
        if let Some(end) = end
            && self.next.iter().all(|(of, _)| of != beams)
        {
            self.next.push((beams.clone(), end.clone()));
        }
    }

    /// Goes on behind a stage; vibrations leave the state as it was.
    pub fn go_on(&mut self, behind: &Stage) {
        self.before.push(behind.clone());
        if !self.next.is_empty() {
            self.ends = std::mem::take(&mut self.next);
        }
    }
}
