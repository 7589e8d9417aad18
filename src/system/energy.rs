//! The energies of a state.

use crate::assembly::InternalVariables;
use serde::Serialize;

/// Energies \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energy {
    /// ½∫ EA (ε − ε₀)² ds, ε₀ that of an actuation.
    pub stretch: f64,
    /// ½∫ EI (κ − κ₀)² ds.
    pub bend: f64,
    /// Of springs, foundations and contacts.
    pub stored: f64,
    /// ½∫ ρA ṙ·ṙ ds, with masses and rotary inertias.
    pub kinetic: f64,
    /// −∫ ρA g·(r − r₀) ds, zero in the stress-free shape, and that of conservative loads.
    pub potential: f64,
    /// Work that loads without a potential (moments, follower forces), moving supports and
    /// actuators that follow a law have done since the start of a motion; in statics that of
    /// actuators along the path.
    pub work: f64,
    /// Energy that damping has taken since the start of a motion.
    pub lost: f64,
}

impl Energy {
    /// With what no function of the coordinates counts.
    #[must_use]
    pub fn with(mut self, variables: &InternalVariables) -> Self {
        self.stored += variables.energy();
        self
    }

    /// Sum of all parts, less the work put in and with what was lost: constant.
    pub fn total(&self) -> f64 {
        self.stretch + self.bend + self.stored + self.kinetic + self.potential - self.work + self.lost
    }
}
