//! Masses on a beam, and the rotary inertia of points and sections.

use super::{Density, Gradient, Hessian, Inertia, Kind};
use crate::model::Place;
use crate::system::SystemError;
use crate::system::assembly::{Assembly, Extent, Part};
use nalgebra::Matrix2;

/// A mass at a point: T = ½ m ṙ·ṙ + ½ J ṙ'·ṙ'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// The point.
    pub at: Place,
    /// m \[kg\]; gravity acts on it too.
    pub mass: Option<f64>,
    /// J \[kg m²\].
    pub rotary_inertia: Option<f64>,
}

impl Part for PointMass {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        let extent = Extent::Point(self.at);
        if let Some(mass) = self.mass {
            assembly.inertia(Kind::PointMass, extent, Inertia { mass_per_length: mass })?;
        }
        if let Some(inertia) = self.rotary_inertia {
            assembly.inertia(Kind::RotaryInertia, extent, RotaryInertia { inertia })?;
        }
        Ok(())
    }

    fn mass(&self) -> Option<(Place, f64)> {
        Some((self.at, self.mass?))
    }
}

/// The rotary inertia of a beam's sections, T = ½ ρI ∫ ṙ'·ṙ' ds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionInertia {
    /// Index of the beam.
    pub beam: usize,
    /// ρI \[kg m\].
    pub per_length: f64,
}

impl Part for SectionInertia {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        assembly.beam("rotary inertia", self.beam)?;
        let extent = Extent::Beam(self.beam, assembly.mass_rule(self.beam));
        assembly.inertia(Kind::RotaryInertia, extent, RotaryInertia { inertia: self.per_length })
    }
}

/// W = ½ J ṙ'·ṙ', a density of the velocity.
///
/// With ṙ' = |r'|˙ t + |r'| θ̇ n this is ½ J θ̇² |r'|² + ½ J (|r'|˙)²: the rotary inertia of a section up to the axial strain, which is small where rotary inertia is
/// of any interest, and with a constant matrix.
#[derive(Clone, Debug)]
pub struct RotaryInertia {
    /// J \[kg m²\], or per length ρI \[kg m\].
    pub inertia: f64,
}

impl Density<1> for RotaryInertia {
    const ORDERS: [usize; 1] = [1];

    fn energy(&self, _: usize, v: &Gradient<1>) -> f64 {
        0.5 * self.inertia * v[0].norm_squared()
    }

    fn gradient(&self, _: usize, v: &Gradient<1>) -> Gradient<1> {
        [v[0] * self.inertia]
    }

    fn gradient_and_hessian(
        &self,
        _: usize,
        v: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        ([v[0] * self.inertia], [[Matrix2::identity() * self.inertia]])
    }
}
