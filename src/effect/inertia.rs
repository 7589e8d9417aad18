//! Kinetic energy of the centreline.

use super::{Density, Gradient, Hessian};
use nalgebra::Matrix2;

/// W = ½ ρA v·v, a density of the velocity field v = ṙ: its second derivative is the constant mass
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
