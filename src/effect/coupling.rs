//! The coupling of stretch and bending in a section whose neutral line is not the centreline.
//!
//! The energy of such a section is ½ EA ε² + EB ε κ + ½ EI κ². It is summed as
//!
//! ```text
//! ½ EA (ε + EB/EA κ)²    at the points for stretch,
//! ½ (EI − EB²/EA) κ²     at those for bending
//! ```
//!
//! so that it is positive at any points. The first is the stretch of the neutral line; it consists of
//! ½ EA ε² of [`super::Stretch`] and of the terms of this file.
//!
//! The other square, ½ EI (κ + EB/EI ε)², would serve as well in theory. But interpolated curved beams
//! cannot bend without some strain between the points for stretch. There it would count as a curvature,
//! divided by the distance of the neutral line, and cells would have to be as short as the beam is thick.

use super::{Bend, Engineering, Green, Strain, bend};
use crate::assembly::{Assembly, BuildError, Density, Dissipation, Extent, Gradient, Hessian, Kind, Part};
use crate::beam::StrainMeasure;
use crate::lanes;
use nalgebra::{Matrix2, Vector2};
use std::marker::PhantomData;

/// The coupling of a beam's stretch and bending; most sections have none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamCoupling {
    /// Index of the beam.
    pub beam: usize,
}

impl Part for BeamCoupling {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        match assembly.beam("coupling", self.beam)?.strain {
            StrainMeasure::Green => self.add::<Green>(assembly),
            StrainMeasure::Engineering => self.add::<Engineering>(assembly),
        }
    }
}

impl BeamCoupling {
    fn add<S: Strain + 'static>(self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("coupling", self.beam)?;
        if beam.section.coupling.is_none() {
            return Ok(());
        }
        let lacks = || BuildError::missing(beam, "axial stiffness", "coupling");
        let [_, coupling, moved] = beam.section.coupled_stiffnesses().ok_or_else(lacks)?;
        let rule = beam.gauss_points.stretch_rule();
        let (stiffness, extent) = Extent::along_whole_cells(self.beam, rule, &coupling);
        assembly.elastic(Kind::Coupling, extent, |z| Coupling::<S>::new(stiffness, &z))?;
        let (stiffness, extent) = Extent::along_whole_cells(self.beam, rule, &moved);
        assembly.elastic(Kind::Bend, extent, |z: Vec<[Vector2<f64>; 2]>| Bend::new(stiffness, &z))
    }
}

/// W = EB (ε − ε₀)(κ − κ₀), with ε₀ and κ₀ of the stress-free shape.
#[derive(Clone, Debug)]
pub struct Coupling<S> {
    stiffness: f64,
    /// ε₀ and κ₀ per quadrature point.
    reference: Vec<[f64; 2]>,
    strain: PhantomData<S>,
}

impl<S: Strain> Coupling<S> {
    /// `stiffness` is EB \[N m\]; `reference` holds (r', r'') of the stress-free shape at the
    /// quadrature points.
    pub fn new(stiffness: f64, reference: &[[Vector2<f64>; 2]]) -> Self {
        let strains =
            |[first, second]: &[Vector2<f64>; 2]| [S::strain(first), bend::curvature(first, second)];
        Self { stiffness, reference: reference.iter().map(strains).collect(), strain: PhantomData }
    }

    /// ε − ε₀ and κ − κ₀.
    fn strains(&self, point: usize, [first, second]: &Gradient<2>) -> [f64; 2] {
        let [strain, curvature] = self.reference[point];
        [S::strain(first) - strain, bend::curvature(first, second) - curvature]
    }
}

impl<S: Strain> Density<2> for Coupling<S> {
    const ORDERS: [usize; 2] = [1, 2];

    fn energy(&self, point: usize, z: &Gradient<2>) -> f64 {
        let [strain, curvature] = self.strains(point, z);
        self.stiffness * strain * curvature
    }

    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        let [strain, curvature] = self.strains(point, z).map(|value| self.stiffness * value);
        let along = Vector2::from(S::first(z[0].into()).1);
        let [a, b] = bend::gradient(z);
        [along * curvature + a * strain, b * strain]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        before: &Gradient<2>,
        change: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let (_, along, second) = S::second(z[0].into());
        let (along, second) = (Vector2::from(along), lanes::matrix(second));
        let ([a, b], [aa, ab]) = (bend::gradient(z), bend::hessian(z));
        // N = EB (κ − κ₀) and M = EB (ε − ε₀), extrapolated.
        let [strain, curvature] = self.strains(point, before);
        let along_before = Vector2::from(S::first(before[0].into()).1);
        let [a_before, b_before] = bend::gradient(before);
        let force = self.stiffness * (curvature + a_before.dot(&change[0]) + b_before.dot(&change[1]));
        let moment = self.stiffness * (strain + along_before.dot(&change[0]));
        let cross = along * a.transpose() * self.stiffness;
        let mixed = along * b.transpose() * self.stiffness + ab * moment;
        let first = second * force + aa * moment + cross + cross.transpose();
        (self.gradient(point, z), [[first, mixed], [mixed.transpose(), Matrix2::zeros()]])
    }
}

/// The part of Kelvin–Voigt damping that couples stretch and bending: R = η EB ε̇ κ̇.
#[derive(Clone, Debug)]
pub struct CouplingDamping<S> {
    coefficient: f64,
    strain: PhantomData<S>,
}

impl<S: Strain> CouplingDamping<S> {
    /// `coefficient` is η EB \[N m s\].
    pub fn new(coefficient: f64) -> Self {
        Self { coefficient, strain: PhantomData }
    }
}

impl<S: Strain> Dissipation<2> for CouplingDamping<S> {
    const ORDERS: [usize; 2] = [1, 2];

    fn force(&self, point: usize, z: &Gradient<2>, rate: &Gradient<2>) -> Gradient<2> {
        let (_, [[aa, ab], [ba, _]]) = self.force_and_matrix(point, z, rate);
        [aa * rate[0] + ab * rate[1], ba * rate[0]]
    }

    fn force_and_matrix(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> (Gradient<2>, Hessian<2>) {
        let along = Vector2::from(S::first(z[0].into()).1);
        let [a, b] = bend::gradient(z);
        let cross = along * a.transpose() * self.coefficient;
        let (first, mixed) = (cross + cross.transpose(), along * b.transpose() * self.coefficient);
        let matrix = [[first, mixed], [mixed.transpose(), Matrix2::zeros()]];
        ([first * rate[0] + mixed * rate[1], mixed.transpose() * rate[0]], matrix)
    }
}
