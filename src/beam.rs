//! A beam: its stress-free shape, its section, its discretisation, and points along it.

use crate::basis::{Discretization, Quadrature};
use crate::centreline::Centreline;
use std::fmt;

/// A slender planar beam: a centreline with a section and a discretisation.
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

/// Stiffnesses and mass of a section. A quantity that is `None` is not named in the scene and not
/// simulated; a beam without an axial stiffness keeps its length.
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
    /// A section without mass, with the axial stiffness EA \[N\] and the bending stiffness EI
    /// \[N m²\].
    pub fn new(axial_stiffness: f64, bending_stiffness: f64) -> Self {
        let (axial_stiffness, bending_stiffness) = (Some(axial_stiffness), Some(bending_stiffness));
        Self { axial_stiffness, bending_stiffness, mass_per_length: None }
    }

    /// The same section with the mass per length ρA \[kg/m\].
    #[must_use]
    pub fn weighing(self, mass_per_length: f64) -> Self {
        Self { mass_per_length: Some(mass_per_length), ..self }
    }
}

/// The axial strain ε as a function of the gradient r'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrainMeasure {
    /// ε = ½ (r'·r' − 1), as in the paper by Chen, Zhang and Li.
    Green,
    /// ε = |r'| − 1.
    #[default]
    Engineering,
}

/// Number of quadrature points in a cell, per elastic energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaussPoints {
    /// For ½ EA ε².
    pub stretch: usize,
    /// For ½ EI κ².
    pub bend: usize,
    /// Whether the points for ½ EA ε² follow Lobatto's rule, whose end points neighbouring cells
    /// share, instead of Gauss' rule.
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

impl Place {
    /// The point of beam number `beam` at the arc length `s` \[m\].
    pub fn new(beam: usize, s: f64) -> Self {
        Self { beam, s }
    }
}

impl Default for Place {
    fn default() -> Self {
        Self { beam: 0, s: 0.0 }
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
