//! What a computation leaves: states at the recorded times or load factors, seen through probes,
//! energies and shapes. Output and verification read nothing else.

pub use crate::solve::{ContactImpulse, Statistics, StepRecord};
pub use crate::system::Energy;

use crate::restart::SavedState;
use crate::system::Reaction;
use serde::Serialize;

/// The result of one run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Trajectory {
    /// The scene's title.
    pub title: String,
    /// Kind of analysis.
    pub analysis: AnalysisKind,
    /// Whether it reaches as far as was asked for: not where the run was stopped, or found no way
    /// on.
    pub complete: bool,
    /// Unknowns after supports are eliminated, plus multipliers.
    pub degrees_of_freedom: usize,
    /// Lines for the reader: what was simulated and how (name, value).
    pub settings: Vec<(String, String)>,
    /// Load factors (statics; also the one equilibrium about which vibrations are small) or times
    /// \[s\] (dynamics) of the records, in order.
    pub parameter: Vec<f64>,
    /// Per probe, one sample per entry of `parameter`.
    pub probes: Vec<ProbeSeries>,
    /// One entry per entry of `parameter`.
    pub energy: Vec<Energy>,
    /// Forces of supports and joints, where they were asked for.
    pub reactions: Vec<ReactionSeries>,
    /// Energies and forces of effects, where they were asked for.
    pub effects: Vec<EffectSeries>,
    /// Centrelines, one frame per entry of `parameter` (thinned where there are very many).
    pub frames: Vec<Frame>,
    /// The stress-free shape of each beam.
    pub undeformed: Vec<Shape>,
    /// The last state of each beam.
    pub last: Vec<Shape>,
    /// Lines of the ground that belong in a picture: borders of obstacles.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// One entry per attempted step.
    pub history: Vec<StepRecord>,
    /// Natural frequencies \[Hz\], ascending, 0 where nothing resists the motion; modal analysis
    /// only.
    pub frequencies: Vec<f64>,
    /// Critical load factors, ascending; buckling only.
    pub load_factors: Vec<f64>,
    /// Mode shapes (modal, buckling): per mode one shape per beam, largest displacement scaled for
    /// drawing.
    pub modes: Vec<Vec<Shape>>,
    /// What the user should know: instabilities met, with the load factor.
    pub warnings: Vec<String>,
    /// Events of a motion, in order.
    pub events: Vec<Event>,
    /// From which a motion can be continued.
    #[serde(skip)]
    pub saved: Option<SavedState>,
    /// Counts.
    pub statistics: Statistics,
    /// Where the time went.
    pub seconds: Seconds,
}

/// The kind of analysis that made a trajectory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AnalysisKind {
    /// Equilibria; `parameter` is the load factor.
    #[default]
    Static,
    /// Motion; `parameter` is the time \[s\].
    Dynamic,
    /// Small vibrations; `parameter` is the load factor of the equilibrium, empty for the
    /// stress-free state.
    Modal,
    /// Critical loads; without records.
    Buckling,
}

/// What one probe saw.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ProbeSeries {
    /// The probe's name.
    pub name: String,
    /// One sample per record.
    pub samples: Vec<ProbeSample>,
}

/// The state of one point of a beam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ProbeSample {
    /// Position \[m\].
    pub x: f64,
    /// Position \[m\].
    pub y: f64,
    /// Direction of r' \[rad\], continuous along a run (not folded into ±π).
    pub angle: f64,
    /// Curvature κ \[1/m\].
    pub curvature: f64,
    /// Axial strain ε by the beam's measure, zero in the stress-free state.
    pub strain: f64,
    /// Velocity \[m/s\]; dynamics only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vx: Option<f64>,
    /// Velocity \[m/s\]; dynamics only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vy: Option<f64>,
}

/// Forces of a support or joint on its beam; of a joint on its second point.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReactionSeries {
    /// `support1`, `support2`, … and `joint1`, … in the order of the scene.
    pub name: String,
    /// One sample per record.
    pub samples: Vec<Reaction>,
}

/// Energy of an effect and the resultant of its forces on the beam.
#[derive(Clone, Debug, Default, Serialize)]
pub struct EffectSeries {
    /// Kind and beam, such as `contact.arm`.
    pub name: String,
    /// Whether it has an energy.
    pub has_energy: bool,
    /// Per record energy \[J\] and force along x and y \[N\].
    pub samples: Vec<[f64; 3]>,
}

/// Something that happened in a motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Event {
    /// A probe's coordinate crossed a value.
    Crossing {
        /// When \[s\].
        time: f64,
        /// Name of the probe.
        probe: String,
        /// `x` or `y`.
        axis: String,
        /// The value \[m\].
        value: f64,
    },
    /// A beam touched an obstacle, or came free of it.
    Contact {
        /// When \[s\].
        time: f64,
        /// The beam and the number of its contact, such as `arm.1`.
        contact: String,
        /// Whether it touches from then on.
        touches: bool,
        /// What it did while it touched; where it ends.
        #[serde(flatten)]
        impulse: Option<ContactImpulse>,
    },
}

impl Event {
    /// When it happened \[s\].
    pub fn time(&self) -> f64 {
        match self {
            Self::Crossing { time, .. } | Self::Contact { time, .. } => *time,
        }
    }
}

/// The centrelines of all beams at one record.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Frame {
    /// Load factor or time.
    pub parameter: f64,
    /// Per beam: positions \[m\] at evenly spaced arc lengths.
    pub beams: Vec<Vec<[f64; 2]>>,
}

/// One beam sampled at 201 arc lengths or more. Of the last state a place where a force or a couple
/// acts in a point is there twice: before and behind it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Shape {
    /// Name of the beam.
    pub beam: String,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// Positions \[m\].
    pub x: Vec<f64>,
    /// Positions \[m\].
    pub y: Vec<f64>,
    /// Direction of r' \[rad\], continuous along s.
    pub angle: Vec<f64>,
    /// ε, zero in the stress-free state.
    pub strain: Vec<f64>,
    /// κ \[1/m\].
    pub curvature: Vec<f64>,
    /// N \[N\], positive in tension; of the last state alone, as are Q and M. All three balance
    /// what acts on the beam before the cut.
    pub axial_force: Vec<f64>,
    /// Q \[N\], along the normal J r' on the side of the cut that looks to the beam's end.
    pub shear_force: Vec<f64>,
    /// M \[N m\], of the sign of EI κ.
    pub bending_moment: Vec<f64>,
    /// Positions of the nodes \[m\].
    pub nodes: Vec<[f64; 2]>,
}

/// Wall time \[s\].
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Shape functions, tables, patterns.
    pub build: f64,
    /// The solution itself.
    pub solve: f64,
    /// Looking at the states (probes, shapes, frames), and files so far as written when the summary
    /// is.
    pub write: f64,
}
