//! Vibrations and critical loads with their shapes.

use super::Trajectory;
use serde::Serialize;

/// The lowest small vibrations about a state.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Vibrations {
    /// The state about which they are small: the equilibrium as the one record, or no record where
    /// that is the stress-free state.
    pub equilibrium: Trajectory,
    /// By ascending frequency; none where the run was stopped on the way to the equilibrium.
    pub modes: Vec<Vibration>,
}

impl Vibrations {
    /// Natural frequencies \[Hz\], ascending.
    pub fn frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(|mode| mode.frequency).collect()
    }
}

/// One small vibration.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Vibration {
    /// Natural frequency \[Hz\]; 0 where nothing resists the motion.
    pub frequency: f64,
    /// What round-off may change it by at most, relative to it.
    #[serde(skip)]
    pub round_off: f64,
    /// The mode shape φ of each beam, scaled so that φᵀ M φ = 1 kg m²; its sign is arbitrary.
    pub shape: Vec<ModeShape>,
}

/// The lowest critical loads of the unloaded structure.
#[derive(Clone, Debug, Default, Serialize)]
pub struct CriticalLoads {
    /// The stress-free state, without records.
    pub unloaded: Trajectory,
    /// By ascending load factor.
    pub modes: Vec<BucklingMode>,
}

impl CriticalLoads {
    /// Critical load factors, ascending.
    pub fn load_factors(&self) -> Vec<f64> {
        self.modes.iter().map(|mode| mode.load_factor).collect()
    }
}

/// One critical load with its buckling shape.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BucklingMode {
    /// Factor of all loads at which the structure buckles.
    pub load_factor: f64,
    /// What round-off may change it by at most, relative to it.
    #[serde(skip)]
    pub round_off: f64,
    /// The buckling shape of each beam, its largest displacement 1 m; its sign is arbitrary.
    pub shape: Vec<ModeShape>,
}

/// What a mode shape changes along one beam, to first order, at the arc lengths of the state's
/// [`Shape`](super::Shape)s.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ModeShape {
    /// Name of the beam.
    pub beam: String,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// Displacements along x \[m\].
    pub x: Vec<f64>,
    /// Displacements along y \[m\].
    pub y: Vec<f64>,
    /// Turns of r' \[rad\].
    pub angle: Vec<f64>,
    /// Changes of ε.
    pub strain: Vec<f64>,
    /// Changes of κ \[1/m\].
    pub curvature: Vec<f64>,
    /// Displacements of the nodes \[m\].
    pub nodes: Vec<[f64; 2]>,
}
