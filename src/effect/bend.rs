//! Bending strain energy ½ EI κ².

use super::{Density, Gradient, Hessian};
use crate::lanes::{Lanes, Pair, Points, Real, cross, dot};
use nalgebra::{Matrix2, Vector2};

/// W = ½ EI (κ − κ₀)² with the material curvature κ = (r' × r'')/|r'|², κ₀ that of the stress-free shape as the
/// discretisation sees it (no table of it for a straight beam).
///
/// With g = r'·r', n = r' × r'' and the quarter turn J v = (−v_y, v_x), so that a × b = −(J b)·a = (J a)·b:
///
/// ```text
/// ∂κ/∂r'  = −J r''/g − 2 κ r'/g            ∂κ/∂r'' = J r'/g
/// ∂²κ/∂r'∂r'   = −(∂κ/∂r' (2 r')ᵀ + 2 r' (∂κ/∂r')ᵀ + 2 κ 1)/g
/// ∂²κ/∂r'∂r''  = (J − 2 r' (∂κ/∂r'')ᵀ)/g   with J as the matrix [0 1; −1 0]
/// ∂²κ/∂r''∂r'' = 0
/// ```
#[derive(Clone, Debug)]
pub struct Bend {
    bending_stiffness: f64,
    reference: Vec<f64>,
}

/// κ = (r' × r'')/|r'|² \[1/m\].
#[inline(always)]
pub fn curvature(first: &Vector2<f64>, second: &Vector2<f64>) -> f64 {
    (first.x * second.y - first.y * second.x) / first.norm_squared()
}

#[inline(always)]
fn quarter_turn(v: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

impl Bend {
    /// EI \[N m²\], and (r', r'') of the stress-free shape at the quadrature points (none: straight).
    pub fn new(bending_stiffness: f64, reference: &[[Vector2<f64>; 2]]) -> Self {
        let reference = reference.iter().map(|[first, second]| curvature(first, second)).collect();
        Self { bending_stiffness, reference }
    }

    #[inline(always)]
    fn reference(&self, point: usize) -> f64 {
        self.reference.get(point).copied().unwrap_or(0.0)
    }

    /// `factor` times M ∂κ/∂r' and M ∂κ/∂r''.
    #[inline(always)]
    fn force<T: Real>(&self, factor: f64, reference: T, [first, second]: [Pair<T>; 2]) -> [Pair<T>; 2] {
        let inverse = dot(first, first).inverse();
        let kappa = cross(first, second) * inverse;
        let moment = T::of(factor * self.bending_stiffness) * (kappa - reference) * inverse;
        let (twice, opposite) = (kappa + kappa, -moment);
        let by_first = [twice.fma(-first[0], second[1]) * moment, twice.fma(first[1], second[0]) * opposite];
        [by_first, [first[1] * opposite, first[0] * moment]]
    }
}

/// κ, ∂κ/∂r', ∂κ/∂r'' and 1/|r'|².
#[inline(always)]
pub(super) fn first_derivatives(z: &Gradient<2>) -> (f64, Gradient<2>, f64) {
    let inverse = 1.0 / z[0].norm_squared();
    let kappa = (z[0].x * z[1].y - z[0].y * z[1].x) * inverse;
    let by_first = (quarter_turn(&z[1]) + z[0] * (2.0 * kappa)) * -inverse;
    let by_second = quarter_turn(&z[0]) * inverse;
    (kappa, [by_first, by_second], inverse)
}

/// ∂²κ/∂r'∂r' and ∂²κ/∂r'∂r''.
#[inline(always)]
pub(super) fn second_derivatives(z: &Gradient<2>) -> (Matrix2<f64>, Matrix2<f64>) {
    let (kappa, [a, b], inverse) = first_derivatives(z);
    second_from(&z[0], kappa, &a, &b, inverse)
}

#[inline(always)]
fn second_from(
    r: &Vector2<f64>,
    kappa: f64,
    a: &Vector2<f64>,
    b: &Vector2<f64>,
    inverse: f64,
) -> (Matrix2<f64>, Matrix2<f64>) {
    let curl = Matrix2::new(0.0, 1.0, -1.0, 0.0);
    let aa = (a * r.transpose() + r * a.transpose() + Matrix2::identity() * kappa) * (-2.0 * inverse);
    let ab = (curl - r * b.transpose() * 2.0) * inverse;
    (aa, ab)
}

impl Density<2> for Bend {
    const ORDERS: [usize; 2] = [1, 2];

    #[inline(always)]
    fn energy(&self, point: usize, z: &Gradient<2>) -> f64 {
        let kappa = curvature(&z[0], &z[1]) - self.reference(point);
        0.5 * self.bending_stiffness * kappa * kappa
    }

    #[inline(always)]
    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        self.force(1.0, self.reference(point), [z[0].into(), z[1].into()]).map(Vector2::from)
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; 2]) -> [Pair<Lanes>; 2] {
        self.force(factor, points.of(&self.reference), *z)
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        before: &Gradient<2>,
        change: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let reference = self.reference(point);
        let (kappa, [a, b], inverse) = first_derivatives(z);
        let moment = self.bending_stiffness * (kappa - reference);
        let (kappa_before, [a_before, b_before], _) = first_derivatives(before);
        let extrapolated = self.bending_stiffness
            * (kappa_before - reference + a_before.dot(&change[0]) + b_before.dot(&change[1]));
        let (aa, ab) = second_from(&z[0], kappa, &a, &b, inverse);
        let ei = self.bending_stiffness;
        let mixed = a * b.transpose() * ei + ab * extrapolated;
        (
            [a * moment, b * moment],
            [
                [a * a.transpose() * ei + aa * extrapolated, mixed],
                [mixed.transpose(), b * b.transpose() * ei],
            ],
        )
    }
}
