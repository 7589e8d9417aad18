//! A density times a factor that varies along the beam.

use super::{CompiledFor, Density, Dissipation, Gradient, Hessian, TendonPath};
use crate::lanes::{Lanes, Pair, Points, Square};

/// A density, or a dissipation function, and its factor at each quadrature point.
#[derive(Clone, Debug)]
pub struct Weighted<D> {
    pub(super) density: D,
    pub(super) factors: Vec<f64>,
}

impl<D> Weighted<D> {
    /// `factors` holds a number per quadrature point.
    pub fn new(density: D, factors: Vec<f64>) -> Self {
        Self { density, factors }
    }
}

impl<D: Density<M>, const M: usize> Density<M> for Weighted<D> {
    const ORDERS: [usize; M] = D::ORDERS;
    const SYMMETRIC: bool = D::SYMMETRIC;
    const HAS_TANGENT: bool = D::HAS_TANGENT;
    const CONSERVATIVE: bool = D::CONSERVATIVE;
    const BY_FOURS: bool = D::TANGENTS_BY_FOURS;
    // Stretch and bending, in which time is spent, are those that are summed by fours.
    const COMPILED_FOR: CompiledFor =
        if Self::BY_FOURS { CompiledFor::CableElements } else { CompiledFor::None };

    fn tendon(&self) -> Option<&TendonPath> {
        self.density.tendon()
    }

    #[inline(always)]
    fn energy(&self, point: usize, z: &Gradient<M>) -> f64 {
        self.factors[point] * self.density.energy(point, z)
    }

    #[inline(always)]
    fn gradient(&self, point: usize, z: &Gradient<M>) -> Gradient<M> {
        self.density.gradient(point, z).map(|g| g * self.factors[point])
    }

    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; M]) -> [Pair<Lanes>; M] {
        let factors = points.of(&self.factors);
        self.density.gradients(factor, points, z).map(|g| g.map(|g| g * factors))
    }

    #[inline(always)]
    fn gradients_and_hessians(
        &self,
        factor: f64,
        points: Points,
        states: [&[Pair<Lanes>; M]; 3],
    ) -> ([Pair<Lanes>; M], [[Square<Lanes>; M]; M]) {
        let factors = points.of(&self.factors);
        let (gradient, hessian) = self.density.gradients_and_hessians(factor, points, states);
        let gradient = gradient.map(|g| g.map(|g| g * factors));
        (gradient, hessian.map(|row| row.map(|block| block.map(|row| row.map(|h| h * factors)))))
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<M>,
        before: &Gradient<M>,
        change: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>) {
        scaled(self.density.gradient_and_hessian(point, z, before, change), self.factors[point])
    }
}

impl<D: Dissipation<M>, const M: usize> Dissipation<M> for Weighted<D> {
    const ORDERS: [usize; M] = D::ORDERS;
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    #[inline(always)]
    fn force(&self, point: usize, z: &Gradient<M>, rate: &Gradient<M>) -> Gradient<M> {
        self.density.force(point, z, rate).map(|g| g * self.factors[point])
    }

    #[inline(always)]
    fn force_and_matrix(
        &self,
        point: usize,
        z: &Gradient<M>,
        rate: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>) {
        scaled(self.density.force_and_matrix(point, z, rate), self.factors[point])
    }
}

#[inline(always)]
pub(super) fn scaled<const M: usize>(
    (gradient, hessian): (Gradient<M>, Hessian<M>),
    factor: f64,
) -> (Gradient<M>, Hessian<M>) {
    (gradient.map(|g| g * factor), hessian.map(|row| row.map(|block| block * factor)))
}
