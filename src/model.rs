//! The continuous problem: beams, sections, supports, loads and probes, all in SI units.
//!
//! Nothing here knows of nodes, elements or steps. A scene file is one way to make a [`Model`];
//! a program that uses the library can fill one directly.

mod analysis;
mod defaults;
pub mod freedom;
mod joint;
mod law;
mod velocity;

pub use analysis::*;
pub use defaults::*;
pub use joint::Joint;
pub use law::{Law, Table};
pub use velocity::{InitialVelocity, Profile};

pub use crate::basis::{Discretization, Kernel, Nodes, SideCondition};
pub use crate::centreline::Centreline;

use crate::basis::Quadrature;
use crate::system::assembly::Part;
use std::fmt;
use std::sync::Arc;

/// A complete mechanical model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// One line that says what this is.
    pub title: String,
    /// The beams; everything else refers to them by index.
    pub beams: Vec<Beam>,
    /// What is held, and what is moved by prescription.
    pub supports: Vec<Support>,
    /// How beams are joined.
    pub joints: Vec<Joint>,
    /// What acts on the beams besides their own elasticity and inertia.
    pub loads: Vec<Load>,
    /// What else takes part: damping, springs, masses, ….
    pub parts: Vec<Arc<dyn Part>>,
    /// How the beams move at the start of a motion; at rest where nothing is said.
    pub initial_velocities: Vec<InitialVelocity>,
    /// Where to watch.
    pub probes: Vec<Probe>,
    /// What else to compute at every record.
    pub outputs: Outputs,
}

impl Model {
    /// Whether a beam names no axial stiffness, and so keeps its length.
    pub fn is_inextensible(&self) -> bool {
        self.beams.iter().any(|beam| beam.section.axial_stiffness.is_none())
    }

    /// Where along a beam there must be a node, over which no shape function reaches \[m\]: at
    /// joints, and where something takes or gives a couple, for there the curvature jumps. A force
    /// only bends its course; nine nodes that do not meet it err by 3e-6 of the length.
    pub fn breaks(&self, beam: usize) -> Vec<f64> {
        let supports = self.supports.iter().filter(|support| support.fix.rotation != FixedRotation::Free);
        let supports = supports.map(|support| support.at);
        let joints = self.joints.iter().flat_map(Joint::places);
        let loads = self.loads.iter().filter_map(Load::couple);
        let parts = self.parts.iter().filter_map(|part| part.couple());
        let places = supports.chain(joints).chain(loads).chain(parts);
        places.filter(|at| at.beam == beam).map(|at| at.s).collect()
    }
}

impl Load {
    /// Where it gives a couple.
    pub fn couple(&self) -> Option<Place> {
        match self {
            Self::Moment { at, .. } => Some(*at),
            Self::InTime { load, .. } => load.couple(),
            Self::Force { .. } | Self::DistributedForce { .. } | Self::Gravity { .. } => None,
        }
    }
}

/// What is computed at every record beside probes and energies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Forces of supports and joints.
    pub reactions: bool,
    /// Energy and resultant force of every effect.
    pub effects: bool,
}

/// A slender planar beam: a centreline with a section and a way to discretise it.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// The name under which a scene refers to this beam.
    pub name: String,
    /// The stress-free shape.
    pub centreline: Centreline,
    /// Stiffness and mass.
    pub section: Section,
    /// How the axial strain is measured.
    pub strain: StrainMeasure,
    /// How the centreline is approximated.
    pub discretization: Discretization,
    /// Gauss points in every cell between neighbouring nodes, for each energy.
    pub gauss_points: GaussPoints,
}

/// What the section resists and weighs. `None`: the scene does not name it, so it is not simulated;
/// what names no axial stiffness keeps its length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Section {
    /// EA \[N\].
    pub axial_stiffness: Option<f64>,
    /// EI \[N m²\].
    pub bending_stiffness: Option<f64>,
    /// ρA \[kg/m\].
    pub mass_per_length: Option<f64>,
}

impl Section {
    /// A beam that resists stretch by EA \[N\] and bending by EI \[N m²\].
    pub fn new(axial_stiffness: f64, bending_stiffness: f64) -> Self {
        let (axial_stiffness, bending_stiffness) = (Some(axial_stiffness), Some(bending_stiffness));
        Self { axial_stiffness, bending_stiffness, mass_per_length: None }
    }

    /// The same with ρA \[kg/m\].
    #[must_use]
    pub fn weighing(self, mass_per_length: f64) -> Self {
        Self { mass_per_length: Some(mass_per_length), ..self }
    }
}

/// The axial strain ε as a function of the gradient r'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrainMeasure {
    /// ε = ½ (r'·r' − 1), the paper's.
    Green,
    /// ε = |r'| − 1.
    #[default]
    Engineering,
}

/// Quadrature points in a cell, by energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaussPoints {
    /// For ½ EA ε².
    pub stretch: usize,
    /// For ½ EI κ².
    pub bend: usize,
    /// Whether those for ½ EA ε² are Lobatto's, which share the cell's ends, and not Gauss'.
    pub lobatto: bool,
}

/// A point of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index of the beam.
    pub beam: usize,
    /// Arc length \[m\].
    pub s: f64,
}

/// Holds a point of a beam, or moves it by prescription.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// Where.
    pub at: Place,
    /// What is held.
    pub fix: Fixed,
    /// By how much the held quantities move until the load factor is 1: x \[m\], y \[m\], angle
    /// \[rad\]; in a motion, what `law` is multiplied by.
    pub displacement: Displacement,
    /// How the displacement follows time; needed in a motion, and only there.
    pub law: Option<Law>,
}

impl Place {
    /// The point of beam number `beam` at the arc length `s` \[m\].
    pub fn new(beam: usize, s: f64) -> Self {
        Self { beam, s }
    }
}

impl Support {
    /// Holds a point and the direction there.
    pub fn clamp(at: Place) -> Self {
        Self { at, fix: Fixed { x: true, y: true, rotation: FixedRotation::Angle }, ..Self::default() }
    }

    /// Holds a point.
    pub fn pin(at: Place) -> Self {
        Self { at, fix: Fixed { x: true, y: true, rotation: FixedRotation::Free }, ..Self::default() }
    }
}

impl Default for Place {
    fn default() -> Self {
        Self { beam: 0, s: 0.0 }
    }
}

/// The quantities that a support holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fixed {
    /// Position along x.
    pub x: bool,
    /// Position along y.
    pub y: bool,
    /// Direction of r'.
    pub rotation: FixedRotation,
}

/// What a support holds of the gradient r'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FixedRotation {
    /// Nothing.
    #[default]
    Free,
    /// Its direction; the stretch at this point stays free.
    Angle,
    /// Both components (the clamp of the paper).
    Gradient,
}

/// Prescribed motion of a support.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Along x \[m\].
    pub x: f64,
    /// Along y \[m\].
    pub y: f64,
    /// Rotation \[rad\]; more than a full turn is meant as such.
    pub angle: f64,
}

/// What acts on the beams.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Load {
    /// Concentrated force \[N\]; a follower turns with the section.
    Force {
        /// Where it acts.
        at: Place,
        /// Components in the fixed frame; of a follower, those while the beam is undeformed.
        value: [f64; 2],
        /// Turns with the section.
        follower: bool,
    },
    /// Concentrated moment \[N m\], counter-clockwise. In the plane a moment about z has no
    /// direction that could follow, so there is no follower moment.
    Moment {
        /// Where it acts.
        at: Place,
        /// Counter-clockwise.
        value: f64,
    },
    /// Force per reference length \[N/m\] along a whole beam.
    DistributedForce {
        /// Index of the beam.
        beam: usize,
        /// Components, as for [`Load::Force`].
        value: [f64; 2],
        /// Turns with the section.
        follower: bool,
    },
    /// Weight of every beam that has mass.
    Gravity {
        /// \[m/s²\].
        acceleration: [f64; 2],
    },
    /// A load that a law of time multiplies; in a motion only. Other loads act in full from the
    /// start.
    InTime {
        /// What acts.
        load: Box<Load>,
        /// By what factor.
        law: Law,
    },
}

/// A point that is watched.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name of its columns in the output.
    pub name: String,
    /// Where.
    pub at: Place,
}

impl Probe {
    /// A probe of that name.
    pub fn new(name: &str, at: Place) -> Self {
        Self { name: name.to_owned(), at }
    }
}

impl GaussPoints {
    /// The rule for ½ EA ε².
    pub fn stretch_rule(self) -> Quadrature {
        if self.lobatto { Quadrature::Lobatto(self.stretch) } else { Quadrature::Gauss(self.stretch) }
    }

    /// The rule for ½ EI κ².
    pub fn bend_rule(self) -> Quadrature {
        Quadrature::Gauss(self.bend)
    }
}

impl fmt::Display for StrainMeasure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Green => "green",
            Self::Engineering => "engineering",
        })
    }
}
