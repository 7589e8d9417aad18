//! The energies of a state.

use crate::assembly::InternalVariables;
use serde::Serialize;

/// Energies \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energy {
    /// ½∫ EA (ε − ε₀)² ds, where ε₀ is the strain imposed by actuation.
    pub stretch: f64,
    /// ½∫ EI (κ − κ₀)² ds, where κ₀ is the curvature imposed by actuation.
    pub bend: f64,
    /// Energy stored in springs, foundations, contacts and friction.
    pub stored: f64,
    /// ½∫ ρA ṙ·ṙ ds, with point masses and rotary inertias.
    pub kinetic: f64,
    /// Potential of the weight, −∫ ρA g·(r − r₀) ds, which is zero in the stress-free shape, and of
    /// other conservative loads.
    pub potential: f64,
    /// Work done since the start of a motion by loads without a potential (moments, follower
    /// forces), by moving supports and by actuators that follow a law; in statics the work of
    /// actuators along the path.
    pub work: f64,
    /// Energy dissipated since the start of a motion.
    pub lost: f64,
}

impl Energy {
    /// Adds the energies that cannot be computed from the coordinates alone.
    #[must_use]
    pub fn with(mut self, variables: &InternalVariables) -> Self {
        self.stored += variables.energy();
        self
    }

    /// The sum of all energies, less the work done and plus the energy dissipated; it is constant.
    pub fn total(&self) -> f64 {
        self.stretch + self.bend + self.stored + self.kinetic + self.potential - self.work + self.lost
    }

    /// The largest kinetic energy of a motion \[J\]; `None` where it is no more than the round-off of the other energies, as of what rests.
    pub fn kinetic_of(motion: &[Self]) -> Option<f64> {
        let most = |of: &dyn Fn(&Self) -> f64| motion.iter().map(of).fold(0.0_f64, f64::max);
        let parts = |e: &Self| [e.stretch, e.bend, e.stored, e.potential, e.work, e.lost];
        let others = most(&|e| parts(e).into_iter().fold(0.0_f64, |m, part| m.max(part.abs())));
        let kinetic = most(&|e| e.kinetic);
        (kinetic > f64::EPSILON * others).then_some(kinetic)
    }
}
