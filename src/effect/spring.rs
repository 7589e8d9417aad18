//! Springs and dashpots between a point of a beam and the ground.

use super::direction::{self, Direction};
use crate::assembly::{
    Assembly, BuildError, CompiledFor, Density, Dissipation, Extent, Gradient, Hessian, Kind, Part,
    Resistance,
};
use crate::beam::Place;
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::TAU;

/// A spring and a dashpot in parallel. With an anchor they act along the line from it to the point:
/// W = ½ k (ℓ − ℓ₀)², R = ½ c ℓ̇². Without an anchor they resist, in all directions, displacements
/// of the point from its position in the stress-free shape: W = ½ k |r − r₀|², R = ½ c |ṙ|².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The point of the beam.
    pub at: Place,
    /// The other end, on the ground \[m\].
    pub anchor: Option<[f64; 2]>,
    /// Length ℓ₀ without force \[m\]; if not given, the length in the stress-free shape.
    pub length: Option<f64>,
    /// k \[N/m\].
    pub stiffness: Option<f64>,
    /// c \[N s/m\].
    pub damping: Option<f64>,
}

impl Part for Spring {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let extent = Extent::Point(self.at);
        if let Some(stiffness) = self.stiffness {
            match self.anchor {
                None => assembly.elastic(Kind::Spring, extent.clone(), |z: Vec<[Vector2<f64>; 1]>| {
                    GroundSpring::new([stiffness; 2], z.into_iter().map(|[r]| r).collect())
                }),
                Some(anchor) => {
                    assembly.elastic(Kind::Spring, extent.clone(), |z: Vec<[Vector2<f64>; 1]>| {
                        let anchor = Vector2::from(anchor);
                        let there = z.first().map_or(0.0, |[r]| (r - anchor).norm());
                        Strut { stiffness, anchor, length: self.length.unwrap_or(there) }
                    })
                }
            }?;
        }
        if let Some(coefficient) = self.damping {
            let anchor = self.anchor.map(Vector2::from);
            assembly.damping(Kind::Dashpot, extent, |_| Dashpot { coefficient, anchor })?;
        }
        Ok(())
    }

    fn point(&self) -> Option<Place> {
        Some(self.at)
    }

    fn resists(&self) -> Vec<Resistance> {
        let axes = self.stiffness.map_or(&[][..], |_| &[[1.0, 0.0], [0.0, 1.0]]);
        axes.iter().map(|axis| Resistance::Displacement(self.at, *axis)).collect()
    }
}

/// A torsional spring and dashpot on the direction θ of r': W = ½ k (θ − θ₀)², R = ½ c θ̇².
///
/// θ counts full turns; [`crate::assembly::Winding`] adds those beyond half a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorsionSpring {
    /// The point of the beam.
    pub at: Place,
    /// k \[N m/rad\].
    pub stiffness: Option<f64>,
    /// c \[N m s/rad\].
    pub damping: Option<f64>,
}

impl Part for TorsionSpring {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let extent = Extent::Point(self.at);
        if let Some(stiffness) = self.stiffness {
            assembly.elastic(Kind::TorsionSpring, extent.clone(), |z: Vec<[Vector2<f64>; 1]>| {
                let reference = z.first().map_or(Vector2::x(), |[r]| *r);
                Torsion { stiffness, reference }
            })?;
            assembly.winding(Kind::TorsionSpring, self.at, stiffness, |z: Vec<[Vector2<f64>; 1]>| {
                Direction::new(z.first().map_or(Vector2::x(), |[r]| *r))
            })?;
        }
        if let Some(coefficient) = self.damping {
            assembly.damping(Kind::TorsionDashpot, extent, |_| TorsionDashpot { coefficient })?;
        }
        Ok(())
    }

    fn remembers(&self) -> Option<String> {
        self.stiffness.map(|_| format!("torsion spring {:?}", self.at))
    }

    fn couple(&self) -> Option<Place> {
        Some(self.at)
    }

    fn resists(&self) -> Vec<Resistance> {
        self.stiffness.map(|_| Resistance::Direction(self.at)).into_iter().collect()
    }
}

/// W = ½ Σ k_d (r_d − r₀_d)²: a spring to the ground, or an elastic foundation.
#[derive(Clone, Debug)]
pub struct GroundSpring {
    stiffness: Vector2<f64>,
    reference: Vec<Vector2<f64>>,
}

impl GroundSpring {
    /// `stiffness` is (k_x, k_y) \[N/m\] or, per length, \[N/m²\]; `reference` holds r₀ at each
    /// point.
    pub fn new(stiffness: [f64; 2], reference: Vec<Vector2<f64>>) -> Self {
        Self { stiffness: stiffness.into(), reference }
    }

    fn displacement(&self, point: usize, z: &Gradient<1>) -> Vector2<f64> {
        z[0] - self.reference[point]
    }
}

impl Density<1> for GroundSpring {
    const ORDERS: [usize; 1] = [0];

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        let u = self.displacement(point, z);
        0.5 * u.dot(&self.stiffness.component_mul(&u))
    }

    fn gradient(&self, point: usize, z: &Gradient<1>) -> Gradient<1> {
        [self.stiffness.component_mul(&self.displacement(point, z))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        (self.gradient(point, z), [[Matrix2::from_diagonal(&self.stiffness)]])
    }
}

/// A spring between a point and an anchor a: W = ½ k (|r − a| − ℓ₀)².
#[derive(Clone, Debug)]
pub struct Strut {
    stiffness: f64,
    anchor: Vector2<f64>,
    length: f64,
}

impl Strut {
    /// `stiffness` is k \[N/m\], `anchor` is a \[m\], and `length` is ℓ₀ \[m\].
    pub fn new(stiffness: f64, anchor: [f64; 2], length: f64) -> Self {
        Self { stiffness, anchor: anchor.into(), length }
    }

    /// d = r − a, its length, and ℓ₀/|d|, taken as zero if ℓ₀ = 0.
    fn ratio(&self, z: &Gradient<1>) -> (Vector2<f64>, f64, f64) {
        let d = z[0] - self.anchor;
        let length = d.norm();
        (d, length, if self.length == 0.0 { 0.0 } else { self.length / length })
    }
}

impl Density<1> for Strut {
    const ORDERS: [usize; 1] = [0];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        let (_, length, _) = self.ratio(z);
        0.5 * self.stiffness * (length - self.length).powi(2)
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let (d, _, ratio) = self.ratio(z);
        [d * (self.stiffness * (1.0 - ratio))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        before: &Gradient<1>,
        change: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let (d, length, ratio) = self.ratio(z);
        if ratio == 0.0 {
            return (self.gradient(point, z), [[Matrix2::identity() * self.stiffness]]);
        }
        let along = d * d.transpose() / (length * length);
        // The force is extrapolated with the length ℓ⁻ + e⁻·Δr instead of ℓ.
        let (d_before, length_before, _) = self.ratio(before);
        let stretch = length_before - self.length + d_before.dot(&change[0]) / length_before;
        let across = stretch / length;
        let hessian = (Matrix2::identity() * across + along * (1.0 - across)) * self.stiffness;
        (self.gradient(point, z), [[hessian]])
    }
}

/// R = ½ c |ṙ|²; with an anchor a, R = ½ c (e·ṙ)², where e is the direction of r − a.
#[derive(Clone, Debug)]
pub struct Dashpot {
    /// c \[N s/m\].
    pub coefficient: f64,
    /// a \[m\].
    pub anchor: Option<Vector2<f64>>,
}

impl Dissipation<1> for Dashpot {
    const ORDERS: [usize; 1] = [0];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    #[inline(always)]
    fn force(&self, point: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        self.force_and_matrix(point, z, rate).0
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let along = self.anchor.map_or_else(Matrix2::identity, |anchor| {
            let d = z[0] - anchor;
            let square = d.norm_squared();
            if square > 0.0 { d * d.transpose() / square } else { Matrix2::identity() }
        });
        let matrix = along * self.coefficient;
        ([matrix * rate[0]], [[matrix]])
    }
}

/// W = ½ k (θ − θ₀)², with θ − θ₀ from −π to π.
#[derive(Clone, Debug)]
pub struct Torsion {
    stiffness: f64,
    reference: Vector2<f64>,
}

impl Torsion {
    /// `stiffness` is k \[N m/rad\], and `reference` is r'₀.
    pub fn new(stiffness: f64, reference: [f64; 2]) -> Self {
        Self { stiffness, reference: reference.into() }
    }

    fn angle(&self, r: &Vector2<f64>) -> f64 {
        direction::angle(&self.reference, r)
    }
}

impl Density<1> for Torsion {
    const ORDERS: [usize; 1] = [1];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        0.5 * self.stiffness * self.angle(&z[0]).powi(2)
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        [direction::gradient(&z[0]) * (self.stiffness * self.angle(&z[0]))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        before: &Gradient<1>,
        change: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let first = direction::gradient(&z[0]);
        // The moment is extrapolated; both angles are counted on the same side of a half turn.
        let (angle, angle_before) = (self.angle(&z[0]), self.angle(&before[0]));
        let turns = TAU * ((angle - angle_before) / TAU).round();
        let ahead = angle_before + turns + direction::gradient(&before[0]).dot(&change[0]);
        let hessian = (first * first.transpose() + direction::hessian(&z[0]) * ahead) * self.stiffness;
        (self.gradient(point, z), [[hessian]])
    }
}

/// A torsional dashpot: R = ½ c θ̇².
#[derive(Clone, Debug)]
pub struct TorsionDashpot {
    /// c \[N m s/rad\].
    pub coefficient: f64,
}

impl Dissipation<1> for TorsionDashpot {
    const ORDERS: [usize; 1] = [1];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    #[inline(always)]
    fn force(&self, point: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        self.force_and_matrix(point, z, rate).0
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let first = direction::gradient(&z[0]);
        let matrix = first * first.transpose() * self.coefficient;
        ([matrix * rate[0]], [[matrix]])
    }
}
