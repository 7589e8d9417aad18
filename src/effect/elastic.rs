//! Stretch and bending by elastic laws that are no straight lines.

use super::Strain;
use super::bend::{self, curvature};
use crate::assembly::{CompiledFor, Density, Gradient, Hessian};
use crate::beam::Elastic;
use crate::lanes::{Pair, dot};
use nalgebra::{Matrix2, Vector2};
use std::marker::PhantomData;
use std::sync::Arc;

/// W(ε(r') − ε₀) with N = W', as [`Stretch`](super::Stretch) is for W = ½ EA ε². The tangent takes
/// N where it multiplies ∂²ε from the iterate before, extrapolated along the law's slope there.
#[derive(Clone, Debug)]
pub struct StretchByLaw<S> {
    law: Arc<Elastic>,
    /// ε₀ per quadrature point.
    reference: Vec<f64>,
    strain: PhantomData<S>,
}

impl<S: Strain> StretchByLaw<S> {
    /// `reference` holds the gradients r' of the stress-free shape at the quadrature points.
    pub fn new(law: Arc<Elastic>, reference: impl Iterator<Item = Vector2<f64>>) -> Self {
        Self { law, reference: reference.map(|r| S::strain(&r)).collect(), strain: PhantomData }
    }
}

impl<S: Strain> Density<1> for StretchByLaw<S> {
    const ORDERS: [usize; 1] = [1];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        self.law.energy(S::strain(&z[0]) - self.reference[point])
    }

    fn gradient(&self, point: usize, z: &Gradient<1>) -> Gradient<1> {
        let (strain, first) = S::first::<f64>(z[0].into());
        let (force, _) = self.law.force_and_stiffness(strain - self.reference[point]);
        [Vector2::from(first) * force]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        before: &Gradient<1>,
        change: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let (strain, first, second) = S::second::<f64>(z[0].into());
        let (force, stiffness) = self.law.force_and_stiffness(strain - self.reference[point]);
        let (strain_before, first_before) = S::first::<f64>(before[0].into());
        let (force_before, slope) = self.law.force_and_stiffness(strain_before - self.reference[point]);
        let change: Pair<f64> = change[0].into();
        let extrapolated = force_before + slope * dot(first_before, change);
        let first = Vector2::from(first);
        let tangent = first * first.transpose() * stiffness + crate::lanes::matrix(second) * extrapolated;
        ([first * force], [[tangent]])
    }
}

/// W(κ − κ₀) with M = W', as [`Bend`](super::Bend) is for W = ½ EI κ².
#[derive(Clone, Debug)]
pub struct BendByLaw {
    law: Arc<Elastic>,
    /// κ₀ per quadrature point.
    reference: Vec<f64>,
}

impl BendByLaw {
    /// `reference` holds (r', r'') of the stress-free shape at the quadrature points.
    pub fn new(law: Arc<Elastic>, reference: &[[Vector2<f64>; 2]]) -> Self {
        let reference = reference.iter().map(|[first, second]| curvature(first, second)).collect();
        Self { law, reference }
    }

    fn curvature(&self, point: usize, z: &Gradient<2>) -> f64 {
        curvature(&z[0], &z[1]) - self.reference[point]
    }
}

impl Density<2> for BendByLaw {
    const ORDERS: [usize; 2] = [1, 2];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, point: usize, z: &Gradient<2>) -> f64 {
        self.law.energy(self.curvature(point, z))
    }

    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        let (moment, _) = self.law.force_and_stiffness(self.curvature(point, z));
        bend::gradient(z).map(|derivative| derivative * moment)
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        before: &Gradient<2>,
        change: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let (moment, stiffness) = self.law.force_and_stiffness(self.curvature(point, z));
        let (moment_before, slope) = self.law.force_and_stiffness(self.curvature(point, before));
        let [a, b] = bend::gradient(before);
        let extrapolated = moment_before + slope * (a.dot(&change[0]) + b.dot(&change[1]));
        let [a, b] = bend::gradient(z);
        let [aa, ab] = bend::hessian(z);
        let stiff = |a: &Vector2<f64>, b: &Vector2<f64>| -> Matrix2<f64> { a * b.transpose() * stiffness };
        let mixed = stiff(&a, &b) + ab * extrapolated;
        let hessian = [[stiff(&a, &a) + aa * extrapolated, mixed], [mixed.transpose(), stiff(&b, &b)]];
        ([a * moment, b * moment], hessian)
    }
}
