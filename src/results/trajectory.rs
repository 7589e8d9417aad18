//! States at the recorded load factors or times, seen through probes, energies and shapes.

use super::{ContactImpulse, Energy, Frame, RecordedStates, Run, Shape, StepRecord};
use crate::restart::SavedState;
use crate::system::Reaction;
use serde::Serialize;

/// The path of a static analysis, or a motion.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Trajectory {
    /// Information on the run as a whole.
    pub run: Run,
    /// Load factors (statics; also the one equilibrium about which vibrations are small) or times
    /// \[s\] (dynamics) of the records, in order.
    pub parameter: Vec<f64>,
    /// Per probe, one sample per entry of `parameter`.
    pub probes: Vec<ProbeSeries>,
    /// One entry per entry of `parameter`.
    pub energy: Vec<Energy>,
    /// Per probe, what its section carries, where it was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sections: Vec<SectionSeries>,
    /// Forces of supports and joints, where they were asked for.
    pub reactions: Vec<ReactionSeries>,
    /// Energies and forces of effects, where they were asked for.
    pub effects: Vec<EffectSeries>,
    /// Centrelines at the records, or, where these are more than [`crate::Options::frames`], at
    /// about so many of them, evenly spread.
    pub frames: Vec<Frame>,
    /// Per frame and beam what the sections carry, where it was asked for.
    #[serde(skip)]
    pub along: Vec<Vec<BeamSections>>,
    /// Per record all beams at the places of [`crate::Options::stations`], without section forces.
    #[serde(skip)]
    pub stations: Vec<Vec<Shape>>,
    /// The last state of each beam, with section forces.
    pub last: Vec<Shape>,
    /// All recorded states, where they were asked for ([`crate::Options::states`]): shapes at any
    /// load factor or time follow from them ([`crate::run::shapes_at`]).
    #[serde(skip)]
    pub states: Option<RecordedStates>,
    /// One entry per attempted step.
    pub history: Vec<StepRecord>,
    /// Events of a motion, in order.
    pub events: Vec<Event>,
    /// A state from which a motion can go on: the end of a motion, or the equilibrium under the
    /// full loads.
    #[serde(skip)]
    pub saved: Option<SavedState>,
}

/// The samples of one probe.
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
    /// Position along x \[m\].
    pub x: f64,
    /// Position along y \[m\].
    pub y: f64,
    /// Direction of r' \[rad\], continuous along a run (not folded into ±π).
    pub angle: f64,
    /// Curvature κ \[1/m\].
    pub curvature: f64,
    /// Axial strain ε by the beam's measure, zero in the stress-free state.
    pub strain: f64,
    /// Velocity along x \[m/s\]; dynamics only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vx: Option<f64>,
    /// Velocity along y \[m/s\]; dynamics only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vy: Option<f64>,
}

/// What the section at a probe carries.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SectionSeries {
    /// The probe's name.
    pub name: String,
    /// One sample per record: behind the probe, and at the beam's end before it.
    pub samples: Vec<SectionForces>,
}

/// What a section carries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SectionForces {
    /// N \[N\], positive in tension.
    pub axial_force: f64,
    /// Q \[N\], along the normal on the side of the cut that looks to the beam's end.
    pub shear_force: f64,
    /// M \[N m\], of the sign of EI κ.
    pub bending_moment: f64,
    /// Stress \[Pa\] on the face to the right of the centreline, where the shape of the section and its
    /// modulus are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress_bottom: Option<f64>,
    /// Stress \[Pa\] on the face to the left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress_top: Option<f64>,
}

impl SectionForces {
    /// Of a state in which it is not known what acts on the beams.
    pub const UNKNOWN: Self = Self {
        axial_force: f64::NAN,
        shear_force: f64::NAN,
        bending_moment: f64::NAN,
        stress_bottom: None,
        stress_top: None,
    };
}

/// A beam with what its sections carry, at the places of a frame.
#[derive(Clone, Debug, Default)]
pub struct BeamSections {
    /// Its shape with section forces and stresses.
    pub shape: Shape,
    /// Velocities \[m/s\]; empty without a motion.
    pub velocity: Vec<[f64; 2]>,
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
    /// A quantity at a probe reached a value, or turned back.
    Probe {
        /// When \[s\].
        time: f64,
        /// Name of the probe.
        probe: String,
        /// The quantity's name, such as `x`.
        quantity: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// Whether it turned back there: `maximum` or `minimum`.
        #[serde(skip_serializing_if = "Option::is_none")]
        turns: Option<&'static str>,
        /// Its first and second derivative there, in its unit per second and per square second; not written.
        #[serde(skip)]
        rates: [f64; 2],
    },
    /// A beam touched an obstacle, or came free of it.
    Contact {
        /// When \[s\].
        time: f64,
        /// The beam and the number of its contact, such as `arm.1`.
        contact: String,
        /// Whether it touches from then on.
        touches: bool,
        /// Its impulse while it touched; only where it ends.
        #[serde(flatten)]
        impulse: Option<ContactImpulse>,
    },
    /// The equilibria of a path lost stability, or regained some of it: at a limit point or a bifurcation.
    Stability {
        /// Load factor.
        load_factor: f64,
        /// `lost` or `regained`.
        stability: &'static str,
        /// Number of directions in which equilibria are unstable before it and behind it, where the tangent tells more than the sign
        /// of its determinant.
        #[serde(skip_serializing_if = "Option::is_none")]
        unstable_directions: Option<[usize; 2]>,
        /// By how much the load factor may be another one, since it was sought no further; not written.
        #[serde(skip)]
        resolution: f64,
    },
}

impl Event {
    /// Time \[s\] or load factor at which it happened.
    pub fn parameter(&self) -> f64 {
        match self {
            Self::Probe { time, .. } | Self::Contact { time, .. } => *time,
            Self::Stability { load_factor, .. } => *load_factor,
        }
    }
}
