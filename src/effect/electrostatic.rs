//! Attraction by a flat electrode.

use crate::assembly::{
    Assembly, BuildError, CompiledFor, Density, Extent, Gradient, Hessian, Kind, Part, edges_along,
};
use crate::beam::{Along, Place};
use crate::law::Law;
use nalgebra::Vector2;

/// The force per length by which a flat electrode attracts a beam, as between parallel plates with
/// Palmer's correction for the field beyond their edges (H. B. Palmer, *Electrical Engineering* 56,
/// 1937, 363–366):
///
/// ```text
/// f = ½ ε w V²/g² (1 + β g/w),   g = n·(r − p) − h
/// ```
///
/// with the width w, the voltage V, the distance g of the beam's surface from the electrode, and
/// β = 0.65 for a plate far wider than its gap, or 0 without the correction. The field is that of
/// plates which are nearly parallel.
#[derive(Clone, Debug, PartialEq)]
pub struct Electrostatic {
    /// Index of the beam.
    pub beam: usize,
    /// V \[V\].
    pub voltage: f64,
    /// A point p of the electrode's surface \[m\].
    pub point: [f64; 2],
    /// Its unit normal n, towards the beam.
    pub normal: [f64; 2],
    /// w \[m\].
    pub width: f64,
    /// 1 along the beam where the electrode faces it, and 0 elsewhere.
    pub facing: Along,
    /// β.
    pub fringe: f64,
    /// Distance h of the beam's surface from its centreline \[m\].
    pub half_thickness: f64,
    /// Permittivity ε \[F/m\].
    pub permittivity: f64,
    /// In a motion, the law of time that multiplies the voltage.
    pub law: Option<Law>,
}

impl Electrostatic {
    /// The permittivity of the vacuum \[F/m\] (CODATA 2018).
    pub const VACUUM: f64 = 8.854_187_812_8e-12;
}

impl Part for Electrostatic {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("an electrode", self.beam)?;
        let rule = assembly.mass_rule(self.beam);
        // The force follows the square of the voltage.
        let law = self.law.as_ref().map(|law| Law::Product(vec![law.clone(), law.clone()]));
        let strength = 0.5 * self.permittivity * self.voltage * self.voltage;
        let normal = Vector2::from(self.normal);
        let offset = normal.dot(&Vector2::from(self.point)) + self.half_thickness;
        let (facing, extent) = Extent::along(self.beam, rule, &self.facing);
        let (strength, fringe) = (facing * strength * self.width, facing * strength * self.fringe);
        assembly.load(Kind::Electrostatic, extent, law.as_ref(), |z: Vec<[Vector2<f64>; 1]>| {
            // Where the stress-free beam has no gap, its energy counts from a gap as wide as the
            // electrode.
            let gap = |[r]: [Vector2<f64>; 1]| Some(normal.dot(&r) - offset).filter(|gap| *gap > 0.0);
            let start = z.into_iter().map(|z| gap(z).unwrap_or(self.width)).collect();
            Plate { normal, offset, strength, fringe, start }
        })
    }

    fn fades(&self) -> bool {
        true
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, [&self.facing])
    }
}

/// W = −a (1/g − 1/g₀) + b ln(g/g₀), with the gap g₀ of the stress-free state.
#[derive(Clone, Debug)]
pub struct Plate {
    normal: Vector2<f64>,
    /// n·p + h \[m\].
    offset: f64,
    /// a \[N m\].
    strength: f64,
    /// b \[N\].
    fringe: f64,
    /// g₀ \[m\].
    start: Vec<f64>,
}

impl Plate {
    /// The gap; where there is none the force has no meaning, and is no number.
    fn gap(&self, r: &Vector2<f64>) -> f64 {
        let gap = self.normal.dot(r) - self.offset;
        if gap > 0.0 { gap } else { f64::NAN }
    }
}

impl Density<1> for Plate {
    const ORDERS: [usize; 1] = [0];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        let (gap, start) = (self.gap(&z[0]), self.start[point]);
        -self.strength * (1.0 / gap - 1.0 / start) + self.fringe * (gap / start).ln()
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let inverse = 1.0 / self.gap(&z[0]);
        [self.normal * (inverse * (self.strength * inverse + self.fringe))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let inverse = 1.0 / self.gap(&z[0]);
        let slope = -inverse * inverse * (2.0 * self.strength * inverse + self.fringe);
        (self.gradient(point, z), [[self.normal * self.normal.transpose() * slope]])
    }
}
