//! A beam: its stress-free shape, its section, how it is discretised, and the points along it.

use crate::basis::{Discretization, Quadrature};
use crate::centreline::Centreline;
use std::fmt;

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
