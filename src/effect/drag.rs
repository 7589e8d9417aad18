//! Resistance and lift of a fluid around a beam.

use super::{DeadForce, Dissipation, Gradient, Hessian, Kind};
use crate::system::SystemError;
use crate::system::assembly::{Assembly, Extent, Part};
use nalgebra::{Matrix2, Vector2};

/// Drag per length by the velocity u of the section against the fluid, split along and across the beam:
/// f = −Σ_d (c_d + C_d |u_d|) u_d, the first part viscous, the second Morison's with C = ½ ρ C_D D. Its dissipation function is
/// R = Σ_d (½ c_d u_d² + ⅓ C_d |u_d|³).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drag {
    /// Index of the beam.
    pub beam: usize,
    /// Along and across the beam: c \[N s/m²\].
    pub viscous: [f64; 2],
    /// Along and across the beam: C \[N s²/m³\].
    pub quadratic: [f64; 2],
    /// Velocity of the fluid \[m/s\].
    pub flow: [f64; 2],
}

impl Part for Drag {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        assembly.beam("drag", self.beam)?;
        let extent = Extent::Beam(self.beam, assembly.mass_rule(self.beam));
        assembly.damping(Kind::Drag, extent, |_| *self)
    }
}

impl Dissipation<2> for Drag {
    const ORDERS: [usize; 2] = [0, 1];

    #[inline(always)]
    fn force(&self, point: usize, z: &Gradient<2>, rate: &Gradient<2>) -> Gradient<2> {
        self.force_and_matrix(point, z, rate).0
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> (Gradient<2>, Hessian<2>) {
        let along = z[1] / z[1].norm();
        let u = rate[0] - Vector2::from(self.flow);
        let (mut force, mut matrix) = (Vector2::zeros(), Matrix2::zeros());
        for (d, axis) in [along, Vector2::new(-along.y, along.x)].into_iter().enumerate() {
            let speed = u.dot(&axis);
            let (c, quadratic) = (self.viscous[d], self.quadratic[d] * speed.abs());
            force += axis * ((c + quadratic) * speed);
            matrix += axis * axis.transpose() * (c + 2.0 * quadratic);
        }
        let zero = Matrix2::zeros();
        ([force, Vector2::zeros()], [[matrix, zero], [zero, zero]])
    }
}

/// Buoyancy of a beam in a heavy fluid: the dead force −m g per length, m the mass of the fluid that it displaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buoyancy {
    /// Index of the beam.
    pub beam: usize,
    /// m \[kg/m\].
    pub displaced: f64,
    /// g \[m/s²\].
    pub acceleration: [f64; 2],
}

impl Part for Buoyancy {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        assembly.beam("buoyancy", self.beam)?;
        let extent = Extent::Beam(self.beam, assembly.mass_rule(self.beam));
        let force = self.acceleration.map(|g| -self.displaced * g);
        assembly.load(Kind::Buoyancy, extent, None, |z: Vec<[Vector2<f64>; 1]>| {
            DeadForce::new(force, z.into_iter().map(|[r]| r).collect())
        })
    }
}
