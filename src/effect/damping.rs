//! Damping of a beam: proportional to its mass, or of Kelvin–Voigt type on strain and curvature.
//!
//! For small vibrations the force of mass damping is α M q̇, and that of Kelvin–Voigt damping, with
//! the same η for strain and curvature, is η K q̇. Together they are Rayleigh damping, by which a
//! mode of frequency ω has the damping ratio ζ = ½ (α/ω + η ω).

use super::{CouplingDamping, Engineering, Green, Strain, bend};
use crate::assembly::{
    Assembly, BuildError, Dissipation, Extent, Gradient, Hessian, Kind, Part, edges_along,
};
use crate::beam::{Along, Place, StrainMeasure};
use crate::lanes::{Lanes, Pair, Real, dot};
use nalgebra::{Matrix2, Vector2};

/// Damping proportional to mass: R = ½ c ṙ·ṙ with c = α ρA \[N s/m²\].
#[derive(Clone, Debug)]
pub struct MassDamping {
    /// c \[N s/m²\].
    pub coefficient: f64,
}

impl Dissipation<1> for MassDamping {
    const ORDERS: [usize; 1] = [0];

    #[inline(always)]
    fn force(&self, _: usize, _: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        [rate[0] * self.coefficient]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, _: &[Pair<Lanes>; 1], rate: &[Pair<Lanes>; 1]) -> [Pair<Lanes>; 1] {
        [rate[0].map(|rate| rate * Lanes::splat(self.coefficient))]
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, _: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        ([rate[0] * self.coefficient], [[Matrix2::identity() * self.coefficient]])
    }
}

/// Kelvin–Voigt damping of strain: R = ½ η EA ε̇² with ε̇ = ∂ε/∂r'·ṙ'. The axial force is
/// EA (ε + η ε̇).
#[derive(Clone, Debug)]
pub struct StretchDamping<S> {
    coefficient: f64,
    strain: std::marker::PhantomData<S>,
}

impl<S: Strain> StretchDamping<S> {
    /// `coefficient` is η EA \[N s\].
    pub fn new(coefficient: f64) -> Self {
        Self { coefficient, strain: std::marker::PhantomData }
    }

    #[inline(always)]
    fn force_at<T: Real>(&self, gradient: Pair<T>, rate: Pair<T>) -> Pair<T> {
        let (_, first) = S::first(gradient);
        let force = T::of(self.coefficient) * dot(first, rate);
        first.map(|first| first * force)
    }
}

impl<S: Strain> Dissipation<1> for StretchDamping<S> {
    const ORDERS: [usize; 1] = [1];

    #[inline(always)]
    fn force(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        [self.force_at(z[0].into(), rate[0].into()).into()]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; 1], rate: &[Pair<Lanes>; 1]) -> [Pair<Lanes>; 1] {
        [self.force_at(z[0], rate[0])]
    }

    #[inline(always)]
    fn force_and_matrix(
        &self,
        point: usize,
        z: &Gradient<1>,
        rate: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let first = Vector2::from(S::first(z[0].into()).1);
        (self.force(point, z, rate), [[first * first.transpose() * self.coefficient]])
    }
}

/// Kelvin–Voigt damping of curvature: R = ½ η EI κ̇² with κ̇ = ∂κ/∂r'·ṙ' + ∂κ/∂r''·ṙ''. The bending
/// moment is EI (κ + η κ̇).
#[derive(Clone, Debug)]
pub struct BendDamping {
    /// η EI \[N m² s\].
    pub coefficient: f64,
}

impl BendDamping {
    #[inline(always)]
    fn force_at<T: Real>(&self, z: &[Pair<T>; 2], rate: [Pair<T>; 2]) -> [Pair<T>; 2] {
        let (_, [a, b], _) = bend::first_derivatives(z);
        let moment = T::of(self.coefficient) * (dot(a, rate[0]) + dot(b, rate[1]));
        [a, b].map(|a| a.map(|a| a * moment))
    }
}

impl Dissipation<2> for BendDamping {
    const ORDERS: [usize; 2] = [1, 2];

    #[inline(always)]
    fn force(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> Gradient<2> {
        self.force_at(&bend::pairs(z), bend::pairs(rate)).map(Vector2::from)
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; 2], rate: &[Pair<Lanes>; 2]) -> [Pair<Lanes>; 2] {
        self.force_at(z, *rate)
    }

    #[inline(always)]
    fn force_and_matrix(
        &self,
        point: usize,
        z: &Gradient<2>,
        rate: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let [a, b] = bend::gradient(z);
        let c = self.coefficient;
        let mixed = a * b.transpose() * c;
        let matrix = [[a * a.transpose() * c, mixed], [mixed.transpose(), b * b.transpose() * c]];
        (self.force(point, z, rate), matrix)
    }
}

/// Damping of one beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BeamDamping {
    /// Index of the beam.
    pub beam: usize,
    /// α \[1/s\] of the force per length −α ρA ṙ.
    pub mass_proportional: Option<Along>,
    /// η \[s\] of the axial force EA (ε + η ε̇).
    pub strain: Option<Along>,
    /// η \[s\] of the bending moment EI (κ + η κ̇).
    pub curvature: Option<Along>,
}

impl Part for BeamDamping {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("damping", self.beam)?;
        let lacks =
            |quantity| BuildError::Missing { beam: beam.name.clone(), quantity, needed_by: "damping" };
        let points = beam.gauss_points;
        if let Some(alpha) = &self.mass_proportional {
            let mass = beam.section.mass_per_length.as_ref().ok_or_else(|| lacks("mass per length"))?;
            let rule = assembly.mass_rule(self.beam);
            let (coefficient, extent) = Extent::along(self.beam, rule, &mass.product(alpha));
            assembly.damping(Kind::Damping, extent, |_| MassDamping { coefficient })?;
        }
        if let Some(eta) = &self.strain {
            let stiffness = beam.section.summed_axial_stiffness().ok_or_else(|| lacks("axial stiffness"))?;
            let viscosity = stiffness.product(eta);
            let (viscosity, extent) = Extent::along_whole_cells(self.beam, points.stretch_rule(), &viscosity);
            match beam.strain {
                StrainMeasure::Green => {
                    assembly.damping(Kind::Damping, extent, |_| StretchDamping::<Green>::new(viscosity))
                }
                StrainMeasure::Engineering => {
                    assembly.damping(Kind::Damping, extent, |_| StretchDamping::<Engineering>::new(viscosity))
                }
            }?;
        }
        if let Some([_, coupling, moved]) = beam.section.coupled_stiffnesses() {
            if self.strain != self.curvature {
                return Err(BuildError::CoupledDamping { beam: beam.name.clone() });
            }
            if let Some(eta) = &self.strain {
                let rule = points.stretch_rule();
                let (coefficient, extent) = Extent::along_whole_cells(self.beam, rule, &moved.product(eta));
                assembly.damping(Kind::Damping, extent, |_| BendDamping { coefficient })?;
                let (viscosity, extent) = Extent::along_whole_cells(self.beam, rule, &coupling.product(eta));
                match beam.strain {
                    StrainMeasure::Green => {
                        assembly.damping(Kind::Damping, extent, |_| CouplingDamping::<Green>::new(viscosity))
                    }
                    StrainMeasure::Engineering => {
                        let coupled = |_| CouplingDamping::<Engineering>::new(viscosity);
                        assembly.damping(Kind::Damping, extent, coupled)
                    }
                }?;
            }
        }
        if let Some(eta) = &self.curvature {
            let stiffness =
                beam.section.uncoupled_bending_stiffness().ok_or_else(|| lacks("bending stiffness"))?;
            let viscosity = stiffness.product(eta);
            let (coefficient, extent) = Extent::along(self.beam, points.bend_rule(), &viscosity);
            assembly.damping(Kind::Damping, extent, |_| BendDamping { coefficient })?;
        }
        Ok(())
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, [&self.mass_proportional, &self.strain, &self.curvature].into_iter().flatten())
    }
}
