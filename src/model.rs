//! The continuous problem: beams, sections, supports, loads and probes, all in SI units.
//!
//! Nothing here knows of nodes, elements or steps. A scene file is one way to make a [`Model`];
//! a program that uses the library can fill one directly.

mod analysis;
mod defaults;
pub mod freedom;
mod joint;
mod velocity;

pub use analysis::*;
pub use defaults::*;
pub use joint::Joint;
pub use velocity::{InitialVelocity, Profile};

pub use crate::basis::{Discretization, Kernel, Nodes, SideCondition};
pub use crate::beam::{Beam, GaussPoints, Place, Section, StrainMeasure};
pub use crate::centreline::Centreline;
pub use crate::law::{Law, Tabulated};

use crate::assembly::Part;
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
    /// What takes part besides the beams' own elasticity and inertia: loads, damping, springs,
    /// masses, contacts, ….
    pub parts: Vec<Arc<dyn Part>>,
    /// How the beams move at the start of a motion; at rest where nothing is said.
    pub initial_velocities: Vec<InitialVelocity>,
    /// Where to watch.
    pub probes: Vec<Probe>,
    /// What else to compute at every record.
    pub outputs: Outputs,
}

impl Model {
    /// Adds what takes part in the mechanics.
    pub fn add(&mut self, part: impl Part) {
        self.parts.push(Arc::new(part));
    }

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
        let parts = self.parts.iter().filter_map(|part| part.couple());
        let places = supports.chain(joints).chain(parts);
        places.filter(|at| at.beam == beam).map(|at| at.s).collect()
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
