//! Analyses one after the other.

use super::{Analysis, Model};

/// An analysis that starts where another one ended, with what takes part in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// The beams, which are the same in all stages, with the supports, joints and parts of this one.
    pub model: Model,
    /// What is computed.
    pub analysis: Analysis,
}
