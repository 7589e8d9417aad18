//! Bending strain energy ½ EI κ².

use super::BendByLaw;
use crate::assembly::{Assembly, BuildError, Density, Extent, Gradient, Hessian, Kind, Part};
use crate::lanes::{self, Lanes, Pair, Points, Real, Square, cross, dot, outer};
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

/// The resistance of a beam to bending; a section without bending stiffness has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamBend {
    /// Index of the beam.
    pub beam: usize,
}

impl Part for BeamBend {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("bending", self.beam)?;
        if let Some(law) = &beam.section.bending_law {
            let extent =
                Extent::divided(self.beam, beam.gauss_points.bend_rule(), &beam.section.law_jumps[1]);
            let law = Arc::clone(law);
            return assembly.elastic(Kind::Bend, extent, |z: Vec<[Vector2<f64>; 2]>| BendByLaw::new(law, &z));
        }
        let Some(stiffness) = beam.section.uncoupled_bending_stiffness() else { return Ok(()) };
        // Only a curved beam needs to store its reference curvatures.
        let straight = assembly.discretized(self.beam).straight;
        let (stiffness, extent) = Extent::along(self.beam, beam.gauss_points.bend_rule(), &stiffness);
        assembly.elastic(Kind::Bend, extent, |z| Bend::new(stiffness, if straight { &[] } else { &z }))
    }
}

/// W = ½ EI (κ − κ₀)² with the material curvature κ = (r' × r'')/|r'|², and κ₀ the curvature of the
/// stress-free shape as the discretisation interpolates it (a straight beam stores no κ₀).
///
/// With g = r'·r', n = r' × r'' and the quarter turn J v = (−v_y, v_x), so that
/// a × b = −(J b)·a = (J a)·b:
///
/// ```text
/// ∂κ/∂r'  = −J r''/g − 2 κ r'/g            ∂κ/∂r'' = J r'/g
/// ∂²κ/∂r'∂r'   = −(∂κ/∂r' (2 r')ᵀ + 2 r' (∂κ/∂r')ᵀ + 2 κ 1)/g
/// ∂²κ/∂r'∂r''  = (Jᵀ − 2 r' (∂κ/∂r'')ᵀ)/g
/// ∂²κ/∂r''∂r'' = 0
/// ```
#[derive(Clone, Debug)]
pub struct Bend {
    bending_stiffness: f64,
    /// κ₀ per quadrature point; empty for a straight beam.
    reference: Vec<f64>,
}

/// κ = (r' × r'')/|r'|² \[1/m\].
#[inline(always)]
pub fn curvature(first: &Vector2<f64>, second: &Vector2<f64>) -> f64 {
    (first.x * second.y - first.y * second.x) / first.norm_squared()
}

impl Bend {
    /// `bending_stiffness` is EI \[N m²\]; `reference` holds (r', r'') of the stress-free shape at
    /// the quadrature points, or nothing for a straight beam.
    pub fn new(bending_stiffness: f64, reference: &[[Vector2<f64>; 2]]) -> Self {
        let reference = reference.iter().map(|[first, second]| curvature(first, second)).collect();
        Self { bending_stiffness, reference }
    }

    #[inline(always)]
    fn reference(&self, point: usize) -> f64 {
        if self.reference.is_empty() { 0.0 } else { self.reference[point] }
    }

    /// `factor` times M ∂κ/∂r' and M ∂κ/∂r'', with the bending moment M.
    #[inline(always)]
    fn force<T: Real>(&self, factor: f64, reference: T, [first, second]: [Pair<T>; 2]) -> [Pair<T>; 2] {
        let inverse = dot(first, first).inverse();
        let kappa = cross(first, second) * inverse;
        let moment = T::of(factor * self.bending_stiffness) * (kappa - reference) * inverse;
        let (twice, opposite) = (kappa + kappa, -moment);
        let by_first = [twice.fma(-first[0], second[1]) * moment, twice.fma(first[1], second[0]) * opposite];
        [by_first, [first[1] * opposite, first[0] * moment]]
    }

    /// The force as [`Self::force`] gives it, and `factor` times its derivatives.
    #[inline(always)]
    fn force_and_tangent<T: Real>(
        &self,
        factor: f64,
        reference: T,
        [z, before, change]: [&[Pair<T>; 2]; 3],
    ) -> ([Pair<T>; 2], [[Square<T>; 2]; 2]) {
        let stiffness = T::of(factor * self.bending_stiffness);
        let (kappa, [a, b], inverse) = first_derivatives(z);
        let moment = stiffness * (kappa - reference);
        let (kappa_before, [a_before, b_before], _) = first_derivatives(before);
        let change = dot(a_before, change[0]) + dot(b_before, change[1]);
        let extrapolated = stiffness * (change + (kappa_before - reference));
        let [aa, ab] = second_derivatives(z[0], kappa, [a, b], inverse);
        let stiff = |a: Pair<T>, b| outer(a.map(|a| a * stiffness), b);
        let mixed = lanes::add(extrapolated, ab, stiff(a, b));
        let tangent =
            [[lanes::add(extrapolated, aa, stiff(a, a)), mixed], [lanes::turned(mixed), stiff(b, b)]];
        ([a.map(|a| a * moment), b.map(|b| b * moment)], tangent)
    }
}

/// The fields (r', r'') as pairs of numbers.
#[inline(always)]
pub(super) fn pairs(z: &Gradient<2>) -> [Pair<f64>; 2] {
    z.map(Into::into)
}

/// κ, ∂κ/∂r', ∂κ/∂r'' and 1/|r'|².
#[inline(always)]
pub(super) fn first_derivatives<T: Real>([first, second]: &[Pair<T>; 2]) -> (T, [Pair<T>; 2], T) {
    let inverse = dot(*first, *first).inverse();
    let kappa = cross(*first, *second) * inverse;
    let (twice, opposite) = (kappa + kappa, -inverse);
    let by_first = [twice.fma(-first[0], second[1]) * inverse, twice.fma(first[1], second[0]) * opposite];
    (kappa, [by_first, [first[1] * opposite, first[0] * inverse]], inverse)
}

/// ∂κ/∂r' and ∂κ/∂r''.
#[inline(always)]
pub(super) fn gradient(z: &Gradient<2>) -> Gradient<2> {
    first_derivatives(&pairs(z)).1.map(Vector2::from)
}

/// ∂²κ/∂r'∂r' and ∂²κ/∂r'∂r''.
#[inline(always)]
pub(super) fn hessian(z: &Gradient<2>) -> [Matrix2<f64>; 2] {
    let z = pairs(z);
    let (kappa, derivatives, inverse) = first_derivatives(&z);
    second_derivatives(z[0], kappa, derivatives, inverse).map(lanes::matrix)
}

#[inline(always)]
fn second_derivatives<T: Real>(r: Pair<T>, kappa: T, [a, b]: [Pair<T>; 2], inverse: T) -> [Square<T>; 2] {
    let twice = r.map(|r| r * (-(inverse + inverse)));
    let corner = a[0].fma(twice[1], twice[0] * a[1]);
    let on_diagonal = kappa * (-(inverse + inverse));
    let entry = |i: usize| (a[i] + a[i]).fma(twice[i], on_diagonal);
    let aa = [[entry(0), corner], [corner, entry(1)]];
    let [x, y] = twice;
    let ab = [[x * b[0], x.fma(b[1], inverse)], [y.fma(b[0], -inverse), y * b[1]]];
    [aa, ab]
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
        self.force(1.0, self.reference(point), pairs(z)).map(Vector2::from)
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
        let [z, before, change] = [z, before, change].map(pairs);
        let (force, tangent) = self.force_and_tangent(1.0, self.reference(point), [&z, &before, &change]);
        (force.map(Vector2::from), tangent.map(|row| row.map(lanes::matrix)))
    }

    #[inline(always)]
    fn gradients_and_hessians(
        &self,
        factor: f64,
        points: Points,
        states: [&[Pair<Lanes>; 2]; 3],
    ) -> ([Pair<Lanes>; 2], [[Square<Lanes>; 2]; 2]) {
        self.force_and_tangent(factor, points.of(&self.reference), states)
    }
}
