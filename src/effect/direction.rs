//! The direction θ = atan2(y', x') of r' and its derivatives.

use nalgebra::{Matrix2, Vector2};

/// ∂θ/∂r' = J r'/|r'|².
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
