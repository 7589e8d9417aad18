//! A beam: its stress-free shape, its section, its discretisation, and points along it.

mod along;
mod elastic;
mod product_rule;
mod section;

pub use along::Along;
pub use elastic::{Elastic, NotElastic};
pub(crate) use product_rule::ProductRule;
pub use section::{Layer, Section};

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

/// The axial strain ε as a function of the gradient r'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrainMeasure {
    /// ε = ½ (r'·r' − 1), as in the paper by Chen, Zhang and Li.
    Green,
    /// ε = |r'| − 1.
    #[default]
    Engineering,
}

impl StrainMeasure {
    /// |r'| of the strain ε.
    pub fn stretch(self, strain: f64) -> f64 {
        match self {
            Self::Green => 2.0_f64.mul_add(strain, 1.0).max(0.0).sqrt(),
            Self::Engineering => 1.0 + strain,
        }
    }
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

impl GaussPoints {
    /// The rule of masses and of what acts along a beam.
    pub fn of_loads(self) -> Quadrature {
        Quadrature::Gauss(self.stretch.max(self.bend).max(4))
    }
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
