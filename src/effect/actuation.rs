//! Pre-strain and pre-curvature: a stress-free shape that grows with the load factor or follows a
//! law of time.
//!
//! Heat, a tendon, pressure or a piezoelectric layer impose a strain ε₀ and a curvature κ₀. In the
//! energy ½ EA (ε − ε₀)², only the term −EA ε₀ ε couples the actuation to the motion. It is treated
//! as a load with a potential, beside the elastic energy ½ EA ε², so that it can be switched on
//! like any other load.
//!
//! A strain on one layer alone, as heat imposes it on a bimetal, has the force N₀ = EA_l ε₀ and the
//! moment M₀ = EB_l ε₀ with that layer's parts of EA and EB.
//!
//! Where the section couples stretch and bending, the elastic energy is that of the stretch ε + EB/EA κ of the neutral line, summed at the
//! points for stretch, and that of bending about it, at those for bending ([`super::coupling`]). What is imposed is summed alike,
//!
//! ```text
//! −N₀ (ε + EB/EA κ)   and   −(M₀ − EB/EA N₀) κ
//! ```
//!
//! since N₀ and M₀ may each be far larger than what they do together, and would bend cells by what the points differ.

use super::{Engineering, Green, Strain, bend};
use crate::assembly::{
    Assembly, BuildError, Density, Extent, Gradient, Hessian, Imposed, Kind, Part, edges_along,
};
use crate::basis::Quadrature;
use crate::beam::{Along, Beam, Place, Section, StrainMeasure};
use crate::lanes;
use crate::law::Law;
use nalgebra::{Matrix2, Vector2};

/// The strain and curvature that actuation imposes on a beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuation {
    /// Index of the beam.
    pub beam: usize,
    /// ε₀, without unit.
    pub strain: Option<Along>,
    /// κ₀ \[1/m\].
    pub curvature: Option<Along>,
    /// Index of the layer of the section on which alone the strain is imposed, such as the warmer one of
    /// a bimetal; `None` for the whole section.
    pub layer: Option<usize>,
    /// In a motion, the law of time that both follow; without one they act in full from the start.
    pub law: Option<Law>,
}

impl Part for Actuation {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("an `actuation`", self.beam)?;
        let lacks = |quantity| BuildError::missing(beam, quantity, "an `actuation`");
        if !beam.section.is_linear() {
            return Err(lacks("stiffness that is a number"));
        }
        let Section { axial_stiffness, bending_stiffness, coupling, .. } = &beam.section;
        let product = |value: &Option<Along>, stiffness: &Option<Along>, name: &'static str| match value {
            None => Ok(None),
            Some(value) => {
                stiffness.as_ref().map(|along| Some(along.product(value))).ok_or_else(|| lacks(name))
            }
        };
        if let Some(layer) = self.layer {
            let stiffness = beam.section.layers.get(layer).and_then(|layer| layer.stiffness.as_ref());
            let [axial, coupling] = stiffness.ok_or_else(|| lacks("layer of known stiffness"))?;
            let Some(strain) = &self.strain else { return Ok(()) };
            let [force, moment] = [axial, coupling].map(|stiffness| Some(stiffness.product(strain)));
            return self.add_imposed(assembly, Kind::PreStrain, beam, [force, moment]);
        }
        let coupled =
            |value: &Option<Along>| coupling.as_ref().zip(value.as_ref()).map(|(b, v)| b.product(v));
        let force = product(&self.strain, axial_stiffness, "axial stiffness")?;
        let moment = product(&self.curvature, bending_stiffness, "bending stiffness")?;
        self.add_imposed(assembly, Kind::PreStrain, beam, [force, coupled(&self.strain)])?;
        // What the section couples belongs to bending: −EB κ₀ ε.
        self.add_imposed(assembly, Kind::PreCurvature, beam, [coupled(&self.curvature), moment])
    }

    fn fades(&self) -> bool {
        true
    }

    fn actuation(&self, beam: usize) -> Option<Imposed<'_>> {
        let [strain, curvature] =
            [&self.strain, &self.curvature].map(|value| value.as_ref().unwrap_or(&NOTHING));
        let imposed = Imposed { strain, curvature, layer: self.layer, law: self.law.as_ref() };
        (beam == self.beam).then_some(imposed)
    }

    fn jumps(&self) -> Vec<Place> {
        edges_along(self.beam, self.strain.iter().chain(&self.curvature))
    }
}

impl Actuation {
    /// Adds −∫ (N₀ ε + M₀ κ) ds, the first as energy of this kind.
    fn add_imposed(
        &self,
        assembly: &mut Assembly<'_>,
        kind: Kind,
        beam: &Beam,
        [force, moment]: [Option<Along>; 2],
    ) -> Result<(), BuildError> {
        let (stretch, bend) = (beam.gauss_points.stretch_rule(), beam.gauss_points.bend_rule());
        if let Some(force) = &force {
            self.add_pre_strain(assembly, kind, (beam.strain, stretch), force)?;
        }
        let lever = beam.section.coupling.as_ref().zip(beam.section.axial_stiffness.as_ref());
        let of_stretch =
            force.zip(lever).map(|(force, (coupling, axial))| force.product(&coupling.over(axial)));
        let Some(of_stretch) = of_stretch else {
            let bending = moment.map(|moment| Extent::along(self.beam, bend, &moment));
            return bending.map_or(Ok(()), |bending| self.add_pre_curvature(assembly, bending));
        };
        self.add_pre_curvature(assembly, Extent::along_whole_cells(self.beam, stretch, &of_stretch))?;
        let back = of_stretch.times(-1.0);
        let of_bending = moment.map_or_else(|| back.clone(), |moment| moment.plus(&back));
        self.add_pre_curvature(assembly, Extent::along(self.beam, bend, &of_bending))
    }

    /// Adds −∫ M₀ κ ds, with M₀ as a coefficient and an extent.
    fn add_pre_curvature(
        &self,
        assembly: &mut Assembly<'_>,
        (moment, extent): (f64, Extent),
    ) -> Result<(), BuildError> {
        assembly.load(Kind::PreCurvature, extent, self.law.as_ref(), |_| PreCurvature { moment })
    }

    /// Adds −∫ N₀ ε ds.
    fn add_pre_strain(
        &self,
        assembly: &mut Assembly<'_>,
        kind: Kind,
        (measure, rule): (StrainMeasure, Quadrature),
        force: &Along,
    ) -> Result<(), BuildError> {
        let ((force, extent), law) = (Extent::along_whole_cells(self.beam, rule, force), self.law.as_ref());
        match measure {
            StrainMeasure::Green => assembly.load(kind, extent, law, |_| PreStrain::<Green>::new(force)),
            StrainMeasure::Engineering => {
                assembly.load(kind, extent, law, |_| PreStrain::<Engineering>::new(force))
            }
        }
    }
}

/// What an actuation imposes that does not name it.
static NOTHING: Along = Along::Constant(0.0);

/// The load of a pre-strain: W = −N₀ ε with N₀ = EA ε₀ \[N\].
#[derive(Clone, Debug)]
pub struct PreStrain<S> {
    force: f64,
    strain: std::marker::PhantomData<S>,
}

impl<S: Strain> PreStrain<S> {
    /// `force` is N₀ \[N\].
    pub fn new(force: f64) -> Self {
        Self { force, strain: std::marker::PhantomData }
    }
}

impl<S: Strain> Density<1> for PreStrain<S> {
    const ORDERS: [usize; 1] = [1];

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        -self.force * S::strain(&z[0])
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        [Vector2::from(S::first(z[0].into()).1) * -self.force]
    }

    fn gradient_and_hessian(
        &self,
        _: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let (_, first, second) = S::second(z[0].into());
        ([Vector2::from(first) * -self.force], [[lanes::matrix(second) * -self.force]])
    }
}

/// The load of a pre-curvature: W = −M₀ κ with M₀ = EI κ₀ \[N m\].
#[derive(Clone, Debug)]
pub struct PreCurvature {
    /// M₀ \[N m\].
    pub moment: f64,
}

impl Density<2> for PreCurvature {
    const ORDERS: [usize; 2] = [1, 2];

    fn energy(&self, _: usize, z: &Gradient<2>) -> f64 {
        -self.moment * bend::curvature(&z[0], &z[1])
    }

    fn gradient(&self, _: usize, z: &Gradient<2>) -> Gradient<2> {
        let [a, b] = bend::gradient(z);
        [a * -self.moment, b * -self.moment]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let [aa, ab] = bend::hessian(z);
        let m = -self.moment;
        (self.gradient(point, z), [[aa * m, ab * m], [ab.transpose() * m, Matrix2::zeros()]])
    }
}
