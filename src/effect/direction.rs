//! The direction θ = atan2(y', x') of r' and its derivatives.

use crate::assembly::{CompiledFor, Density, Gradient, Hessian};
use nalgebra::{Matrix2, Vector2};

/// ∂θ/∂r' = (−y', x')/|r'|².
pub(super) fn gradient(r: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-r.y, r.x) / r.norm_squared()
}

/// The angle from `reference` to `r`, from −π to π.
pub(super) fn angle(reference: &Vector2<f64>, r: &Vector2<f64>) -> f64 {
    (reference.x * r.y - reference.y * r.x).atan2(reference.dot(r))
}

/// ∂²θ/∂r'².
pub(super) fn hessian(r: &Vector2<f64>) -> Matrix2<f64> {
    let (x, y) = (r.x, r.y);
    Matrix2::new(2.0 * x * y, y * y - x * x, y * y - x * x, -2.0 * x * y) / r.norm_squared().powi(2)
}

/// The angle from r'₀ to r' as a density: W = θ − θ₀, from −π to π.
#[derive(Clone, Debug)]
pub struct Direction {
    reference: Vector2<f64>,
}

impl Direction {
    /// `reference` is r'₀.
    pub fn new(reference: Vector2<f64>) -> Self {
        Self { reference }
    }
}

impl Density<1> for Direction {
    const ORDERS: [usize; 1] = [1];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        angle(&self.reference, &z[0])
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        [gradient(&z[0])]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        (self.gradient(point, z), [[hessian(&z[0])]])
    }
}
