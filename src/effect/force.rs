//! Forces and moments, concentrated (a table of one point with weight 1) or distributed (a table of
//! the whole beam).

use super::{Density, Gradient, Hessian};
use nalgebra::{Matrix2, Vector2};

/// A force of fixed direction, F \[N\] or \[N/m\]: W = −F·(r − r₀). Weight is such a force with F =
/// ρA g.
#[derive(Clone, Debug)]
pub struct DeadForce {
    force: Vector2<f64>,
    reference: Vec<Vector2<f64>>,
}

impl DeadForce {
    /// The force, and the positions r₀ from which its potential counts.
    pub fn new(force: [f64; 2], reference: Vec<Vector2<f64>>) -> Self {
        Self { force: force.into(), reference }
    }
}

impl Density<1> for DeadForce {
    const ORDERS: [usize; 1] = [0];
    const HAS_TANGENT: bool = false;

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        -self.force.dot(&(z[0] - self.reference.get(point).copied().unwrap_or_default()))
    }

    #[inline(always)]
    fn gradient(&self, _: usize, _: &Gradient<1>) -> Gradient<1> {
        [-self.force]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        _: usize,
        _: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        ([-self.force], [[Matrix2::zeros()]])
    }
}

/// A force that turns with the section: F = R(θ − θ₀) F₀ with θ = atan2(y', x'). It has no energy.
///
/// Along and across the tangent t = r'/|r'| it has constant components (f_t, f_n): F = f_t t + f_n
/// J t, and ∂F/∂r' = (f_t 1 + f_n J)(1 − t tᵀ)/|r'|.
#[derive(Clone, Debug)]
pub struct FollowerForce {
    /// (f_t, f_n) per point.
    components: Vec<Vector2<f64>>,
}

impl FollowerForce {
    /// The force F₀ in the undeformed state, and the gradients r'₀ there at each point.
    pub fn new(force: [f64; 2], reference: &[Vector2<f64>]) -> Self {
        let force = Vector2::from(force);
        let components = reference
            .iter()
            .map(|r| {
                let t = r / r.norm();
                Vector2::new(force.dot(&t), t.x * force.y - t.y * force.x)
            })
            .collect();
        Self { components }
    }

    #[inline(always)]
    fn turned(&self, point: usize) -> Matrix2<f64> {
        let c = self.components.get(point).copied().unwrap_or_default();
        Matrix2::new(c.x, -c.y, c.y, c.x)
    }
}

impl Density<2> for FollowerForce {
    const ORDERS: [usize; 2] = [0, 1];
    const SYMMETRIC: bool = false;
    const CONSERVATIVE: bool = false;

    fn energy(&self, _: usize, _: &Gradient<2>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        let t = z[1] / z[1].norm_squared().sqrt();
        [-(self.turned(point) * t), Vector2::zeros()]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let inverse = 1.0 / z[1].norm_squared().sqrt();
        let t = z[1] * inverse;
        let turned = self.turned(point);
        let by_gradient = turned * (Matrix2::identity() - t * t.transpose()) * -inverse;
        let zero = Matrix2::zeros();
        ([-(turned * t), Vector2::zeros()], [[zero, by_gradient], [zero, zero]])
    }
}

/// A moment M \[N m\], counter-clockwise: δW = −M δθ with θ = atan2(y', x').
///
/// ∂θ/∂r' = J r'/|r'|², symmetric second derivative. Its work M θ is a potential only as long as θ
/// is counted on through full turns, which no single state can tell; its work is therefore summed
/// up along the motion.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Counter-clockwise \[N m\].
    pub moment: f64,
}

impl Density<1> for Moment {
    const ORDERS: [usize; 1] = [1];
    const CONSERVATIVE: bool = false;

    fn energy(&self, _: usize, _: &Gradient<1>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let factor = -self.moment / z[0].norm_squared();
        [Vector2::new(-z[0].y * factor, z[0].x * factor)]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let (x, y) = (z[0].x, z[0].y);
        let inverse = 1.0 / z[0].norm_squared();
        let factor = -self.moment * inverse * inverse;
        let (diagonal, mixed) = (2.0 * x * y * factor, (y * y - x * x) * factor);
        (self.gradient(point, z), [[Matrix2::new(diagonal, mixed, mixed, -diagonal)]])
    }
}
