//! Kinetic energy of the centreline.

use crate::assembly::{Assembly, BuildError, Density, Extent, Gradient, Hessian, Kind, Part};
use nalgebra::Matrix2;

/// The inertia of a beam's mass; it adds nothing in an analysis without inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamInertia {
    /// Index of the beam.
    pub beam: usize,
}

impl Part for BeamInertia {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        if !assembly.needs().inertia {
            return Ok(());
        }
        let beam = assembly.beam("inertia", self.beam)?;
        let lacks = || BuildError::missing(beam, "mass per length", "inertia");
        let mass = beam.section.mass_per_length.as_ref().ok_or_else(lacks)?;
        let (mass_per_length, extent) = Extent::along(self.beam, assembly.mass_rule(self.beam), mass);
        assembly.inertia(Kind::Inertia, extent, Inertia { mass_per_length })
    }
}

/// W = ½ ρA v·v, a density of the velocity field v = ṙ. Its second derivative is the constant mass
/// matrix.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// ρA \[kg/m\].
    pub mass_per_length: f64,
}

impl Density<1> for Inertia {
    const ORDERS: [usize; 1] = [0];

    fn energy(&self, _: usize, v: &Gradient<1>) -> f64 {
        0.5 * self.mass_per_length * v[0].norm_squared()
    }

    fn gradient(&self, _: usize, v: &Gradient<1>) -> Gradient<1> {
        [v[0] * self.mass_per_length]
    }

    fn gradient_and_hessian(
        &self,
        _: usize,
        v: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        ([v[0] * self.mass_per_length], [[Matrix2::identity() * self.mass_per_length]])
    }
}
