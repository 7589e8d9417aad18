//! Axial strain energy ½ EA ε².

use super::StretchByLaw;
use crate::assembly::{Assembly, BuildError, Density, Extent, Gradient, Hessian, Kind, Part};
use crate::beam::StrainMeasure;
use crate::lanes::{self, Lanes, Pair, Points, Real, Square, dot, outer};
use nalgebra::Vector2;
use std::sync::Arc;

/// The resistance of a beam to stretch; a section without axial stiffness has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamStretch {
    /// Index of the beam.
    pub beam: usize,
}

impl Part for BeamStretch {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("stretch", self.beam)?;
        if let Some(law) = &beam.section.axial_law {
            let extent =
                Extent::divided(self.beam, beam.gauss_points.stretch_rule(), &beam.section.law_jumps[0]);
            let fields = |z: Vec<[Vector2<f64>; 1]>| z.into_iter().map(|[r]| r);
            let law = Arc::clone(law);
            return match beam.strain {
                StrainMeasure::Green => {
                    assembly.elastic(Kind::Stretch, extent, |z| StretchByLaw::<Green>::new(law, fields(z)))
                }
                StrainMeasure::Engineering => assembly
                    .elastic(Kind::Stretch, extent, |z| StretchByLaw::<Engineering>::new(law, fields(z))),
            };
        }
        let Some(stiffness) = beam.section.summed_axial_stiffness() else { return Ok(()) };
        // Only a curved beam needs to store its reference strains.
        let straight = assembly.discretized(self.beam).straight;
        let gradients = |z: Vec<[Vector2<f64>; 1]>| -> Vec<_> {
            if straight { Vec::new() } else { z.into_iter().map(|[r]| r).collect() }
        };
        let (stiffness, extent) =
            Extent::along_whole_cells(self.beam, beam.gauss_points.stretch_rule(), &stiffness);
        match beam.strain {
            StrainMeasure::Green => {
                assembly.elastic(Kind::Stretch, extent, |z| Stretch::<Green>::new(stiffness, &gradients(z)))
            }
            StrainMeasure::Engineering => assembly
                .elastic(Kind::Stretch, extent, |z| Stretch::<Engineering>::new(stiffness, &gradients(z))),
        }
    }
}

/// An axial strain as a function of the gradient r'.
pub trait Strain: Copy + Send + Sync {
    /// The strain of the gradient r' = `r`, relative to a reference with |r'| = 1.
    fn strain(r: &Vector2<f64>) -> f64;

    /// ε and ∂ε/∂r'.
    fn first<T: Real>(r: Pair<T>) -> (T, Pair<T>);

    /// ε, ∂ε/∂r' and ∂²ε/∂r'∂r'.
    fn second<T: Real>(r: Pair<T>) -> (T, Pair<T>, Square<T>);
}

/// ε = ½ (r'·r' − 1): ∂ε/∂r' = r', ∂²ε/∂r'² = 1.
#[derive(Clone, Copy, Debug)]
pub struct Green;

impl Strain for Green {
    // Written as ½ (x'−1)(x'+1) + ½ y'², the subtraction would lose fewer digits, but only for a
    // beam along x; the plain form treats all directions alike.
    #[inline(always)]
    fn strain(r: &Vector2<f64>) -> f64 {
        0.5 * (r.norm_squared() - 1.0)
    }

    #[inline(always)]
    fn first<T: Real>(r: Pair<T>) -> (T, Pair<T>) {
        (T::of(0.5) * (dot(r, r) - T::of(1.0)), r)
    }

    #[inline(always)]
    fn second<T: Real>(r: Pair<T>) -> (T, Pair<T>, Square<T>) {
        let (strain, first) = Self::first(r);
        let (zero, one) = (T::of(0.0), T::of(1.0));
        (strain, first, [[one, zero], [zero, one]])
    }
}

/// ε = |r'| − 1: ∂ε/∂r' = t, ∂²ε/∂r'² = (1 − t tᵀ)/|r'|, with t = r'/|r'|.
#[derive(Clone, Copy, Debug)]
pub struct Engineering;

impl Strain for Engineering {
    #[inline(always)]
    fn strain(r: &Vector2<f64>) -> f64 {
        r.norm_squared().sqrt() - 1.0
    }

    #[inline(always)]
    fn first<T: Real>(r: Pair<T>) -> (T, Pair<T>) {
        let length = dot(r, r).sqrt();
        let inverse = length.inverse();
        (length - T::of(1.0), [r[0] * inverse, r[1] * inverse])
    }

    #[inline(always)]
    fn second<T: Real>(r: Pair<T>) -> (T, Pair<T>, Square<T>) {
        let length = dot(r, r).sqrt();
        let inverse = length.inverse();
        let [x, y] = [r[0] * inverse, r[1] * inverse];
        let across = [-y, x];
        // 1 − t tᵀ projects onto the normal.
        (length - T::of(1.0), [x, y], outer(across.map(|n| n * inverse), across))
    }
}

/// W = ½ EA (ε(r') − ε₀)², where ε₀ is the strain of the stress-free shape as the discretisation
/// interpolates it.
///
/// For a straight beam ε₀ = 0, and no table of it is stored.
#[derive(Clone, Debug)]
pub struct Stretch<S> {
    axial_stiffness: f64,
    /// ε₀ per quadrature point; empty for a straight beam.
    reference: Vec<f64>,
    strain: std::marker::PhantomData<S>,
}

impl<S: Strain> Stretch<S> {
    /// `axial_stiffness` is EA \[N\]; `reference` holds the gradients r' of the stress-free shape
    /// at the quadrature points, or nothing for a straight beam.
    pub fn new(axial_stiffness: f64, reference: &[Vector2<f64>]) -> Self {
        let reference = reference.iter().map(S::strain).collect();
        Self { axial_stiffness, reference, strain: std::marker::PhantomData }
    }

    #[inline(always)]
    fn reference(&self, point: usize) -> f64 {
        if self.reference.is_empty() { 0.0 } else { self.reference[point] }
    }

    /// `factor` times N ∂ε/∂r', with the axial force N.
    #[inline(always)]
    fn force<T: Real>(&self, factor: f64, reference: T, r: Pair<T>) -> Pair<T> {
        let (strain, [x, y]) = S::first(r);
        let force = T::of(factor * self.axial_stiffness) * (strain - reference);
        [x * force, y * force]
    }

    /// The force as [`Self::force`] gives it, and `factor` times its derivative.
    #[inline(always)]
    fn force_and_tangent<T: Real>(
        &self,
        factor: f64,
        reference: T,
        [r, before, change]: [Pair<T>; 3],
    ) -> (Pair<T>, Square<T>) {
        let stiffness = T::of(factor * self.axial_stiffness);
        let (strain, first, second) = S::second(r);
        let (strain_before, first_before) = S::first(before);
        let force = stiffness * (strain - reference);
        let extrapolated = stiffness * (dot(first_before, change) + (strain_before - reference));
        let tangent = lanes::add(extrapolated, second, outer(first.map(|t| t * stiffness), first));
        (first.map(|t| t * force), tangent)
    }
}

impl<S: Strain> Density<1> for Stretch<S> {
    const ORDERS: [usize; 1] = [1];

    #[inline(always)]
    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        let strain = S::strain(&z[0]) - self.reference(point);
        0.5 * self.axial_stiffness * strain * strain
    }

    #[inline(always)]
    fn gradient(&self, point: usize, z: &Gradient<1>) -> Gradient<1> {
        [self.force(1.0, self.reference(point), z[0].into()).into()]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; 1]) -> [Pair<Lanes>; 1] {
        [self.force(factor, points.of(&self.reference), z[0])]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        before: &Gradient<1>,
        change: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let states = [z, before, change].map(|[r]| (*r).into());
        let (force, tangent) = self.force_and_tangent(1.0, self.reference(point), states);
        ([force.into()], [[lanes::matrix(tangent)]])
    }

    #[inline(always)]
    fn gradients_and_hessians(
        &self,
        factor: f64,
        points: Points,
        states: [&[Pair<Lanes>; 1]; 3],
    ) -> ([Pair<Lanes>; 1], [[Square<Lanes>; 1]; 1]) {
        let reference = points.of(&self.reference);
        let (force, tangent) = self.force_and_tangent(factor, reference, states.map(|[r]| *r));
        ([force], [[tangent]])
    }
}
