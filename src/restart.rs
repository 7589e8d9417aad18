//! A state saved by one run, from which another may start.
//!
//! A run of the same scene goes on bit for bit as if it had not been interrupted: the file holds what the integrator carries from
//! step to step, in decimal digits that give back the same numbers. Another scene may start from it too, with other loads,
//! supports or another integrator, as long as its beams have the same names and nodes; what does not fit the new integrator is
//! left out.

use crate::solve::dynamics::Checkpoint;
use crate::system::System;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Version of the format.
const FORMAT: u32 = 1;

/// A state of motion with the beams to which it belongs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    /// Version of the format.
    format: u32,
    /// Per beam its name and the arc lengths of its nodes \[m\].
    beams: Vec<(String, Vec<f64>)>,
    /// The state.
    checkpoint: Checkpoint,
}

/// Why a saved state cannot be used.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RestartError {
    /// The file cannot be read.
    #[error("{path}: {cause}")]
    #[diagnostic(help("give the `state.json` that a run has written into its output directory"))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The file is not a saved state.
    #[error("{path} is not a saved state: {cause}")]
    #[diagnostic(help(
        "give the `state.json` that a run of this version has written into its output directory"
    ))]
    Parse {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: serde_json::Error,
    },
    /// The format is another.
    #[error("the saved state has format {found}, and this version reads format {FORMAT}")]
    #[diagnostic(help("run the scene that made it again"))]
    Format {
        /// What was found.
        found: u32,
    },
    /// The beams are others.
    #[error("the saved state does not fit this scene: {what}")]
    #[diagnostic(help(
        "the beams must have the same names, lengths, discretisations and nodes in both scenes"
    ))]
    Mismatch {
        /// What differs.
        what: String,
    },
    /// The analysis is not a motion.
    #[error("a {analysis} analysis does not start from a saved state")]
    #[diagnostic(help("only [analysis.dynamic] does"))]
    Analysis {
        /// The analysis.
        analysis: &'static str,
    },
    /// There is nothing left to do.
    #[error("the saved state is at t = {time} s, and the motion ends at {duration} s")]
    #[diagnostic(help("give a longer `duration`: it counts from time zero, not from the saved state"))]
    Over {
        /// Its time \[s\].
        time: f64,
        /// Where the motion is to end \[s\].
        duration: f64,
    },
}

fn layout(system: &System) -> Vec<(String, Vec<f64>)> {
    system.beams().iter().map(|part| (part.name.clone(), part.basis.nodes().to_vec())).collect()
}

impl SavedState {
    pub(crate) fn new(system: &System, checkpoint: Checkpoint) -> Self {
        Self { format: FORMAT, beams: layout(system), checkpoint }
    }

    /// Its time \[s\].
    pub fn time(&self) -> f64 {
        self.checkpoint.state.time
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`RestartError`] where there is no such file or it is something else.
    pub fn load(path: &Path) -> Result<Self, RestartError> {
        let text = std::fs::read_to_string(path)
            .map_err(|cause| RestartError::Read { path: path.to_path_buf(), cause })?;
        let saved: Self = serde_json::from_str(&text)
            .map_err(|cause| RestartError::Parse { path: path.to_path_buf(), cause })?;
        if saved.format != FORMAT {
            return Err(RestartError::Format { found: saved.format });
        }
        Ok(saved)
    }

    /// The state, if it belongs to the beams of `system`.
    ///
    /// # Errors
    /// [`RestartError::Mismatch`] naming the first difference.
    pub(crate) fn checkpoint(&self, system: &System) -> Result<Checkpoint, RestartError> {
        let mismatch = |what: String| Err(RestartError::Mismatch { what });
        let (here, there) = (layout(system), &self.beams);
        if here.len() != there.len() {
            return mismatch(format!("it has {} beams, the scene {}", there.len(), here.len()));
        }
        for ((name, nodes), (saved_name, saved_nodes)) in here.iter().zip(there) {
            if name != saved_name {
                return mismatch(format!("its beam `{saved_name}` is called `{name}` in the scene"));
            }
            if nodes != saved_nodes {
                let (n, m) = (nodes.len(), saved_nodes.len());
                return mismatch(format!(
                    "beam `{name}` had {m} nodes when it was saved and has {n} now, or they lie elsewhere"
                ));
            }
        }
        let state = &self.checkpoint.state;
        let finite = state.q.iter().chain(&state.v).chain([&state.time, &state.work]).all(|v| v.is_finite());
        if state.q.len() != system.coordinates() || state.v.len() != system.coordinates() || !finite {
            return mismatch("its coordinates or velocities are incomplete".into());
        }
        let Checkpoint { method, memory, step, last_ratio, origin: (origin, _), .. } = &self.checkpoint;
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let sound = positive(*step) && positive(*last_ratio) && origin.is_finite();
        // Where no method is named none has left anything.
        if !(method.is_empty() || sound && memory.iter().flatten().all(|v| v.is_finite())) {
            return mismatch("what its integrator carries from step to step is no sound number".into());
        }
        Ok(self.checkpoint.clone())
    }
}
