//! Contact of a beam with circles, half-planes and boxes of the ground, by penalty.
//!
//! With g(r) the distance of the centreline from the obstacle less half the beam's thickness, the
//! contact has the energy W = ½ k ⟨−g⟩² per length, where ⟨x⟩ = max(x, 0). The pressure per length
//! is k ⟨−g⟩, so that a pressure p causes the penetration p/k. Energy stored in the contact is
//! given back completely.
//!
//! The gap is that of the curve, not that of selected points on it. Each cell is a polynomial
//! ([`curve`]), its crossings of the obstacle's border are roots of a polynomial, and W is
//! integrated over the pieces between them ([`integral`]). An obstacle of any size is therefore
//! found wherever along a cell it is, and the force changes smoothly as the edge of a contact
//! moves. The path between two states is examined by [`sweep`].
//!
//! Friction sticks and slides ([`friction`]).

mod curve;
mod friction;
mod integral;
mod obstacle;
mod sweep;

pub use friction::{Friction, FrictionIntegral};
pub use integral::ContactIntegral;
pub use obstacle::Obstacle;

use crate::assembly::{Assembly, BuildError, Density, Gradient, Hessian, Part, Resistance};
use crate::beam::Place;
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

/// Contact of one beam with one obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the beam.
    pub beam: usize,
    /// The obstacle that it may touch.
    pub obstacle: Obstacle,
    /// k \[N/m²\]: pressure per length, divided by the penetration.
    pub stiffness: f64,
    /// Distance of the beam's surface from its centreline \[m\].
    pub half_thickness: f64,
    /// Friction; `None` for a contact without friction.
    pub friction: Option<Friction>,
    /// Arc lengths \[m\] between which the beam can touch; `None` for all of it.
    pub between: Option<[f64; 2]>,
}

impl Part for Contact {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("contact", self.beam)?;
        let normal = Penalty { obstacle: self.obstacle, stiffness: self.stiffness, gap: self.half_thickness };
        let part = assembly.discretized(self.beam);
        let pressing = ContactIntegral::new(normal, self.beam, self.between, &part.basis, part.offset());
        let pressing = Arc::new(pressing.map_err(|e| BuildError::basis(&beam.name, e))?);
        if let Some(friction) = self.friction {
            let pressing = Arc::clone(&pressing);
            assembly.friction(|number| Box::new(FrictionIntegral::new(pressing, friction, number)));
        }
        assembly.contact(pressing);
        Ok(())
    }

    fn resists(&self) -> Vec<Resistance> {
        vec![Resistance::Contact(self.beam)]
    }

    fn has_memory(&self) -> bool {
        self.friction.is_some()
    }

    fn remembers(&self) -> Option<String> {
        let Self { beam, obstacle, half_thickness, between, .. } = self;
        self.friction.map(|_| format!("contact {beam} {obstacle:?} {half_thickness:?} {between:?}"))
    }

    fn jumps(&self) -> Vec<Place> {
        self.between.into_iter().flatten().map(|s| Place::new(self.beam, s)).collect()
    }

    fn outline(&self, size: f64) -> Vec<[f64; 2]> {
        self.obstacle.outline(size)
    }
}

/// The density of a contact: W = ½ k ⟨−g⟩².
#[derive(Clone, Copy, Debug)]
pub struct Penalty {
    /// The obstacle that may be touched.
    pub obstacle: Obstacle,
    /// k \[N/m²\].
    pub stiffness: f64,
    /// Distance from the obstacle at which the centreline begins to touch it \[m\].
    pub gap: f64,
}

impl Penalty {
    /// g: the distance of the beam's surface from the obstacle \[m\].
    #[inline(always)]
    fn gap_at(&self, r: &Vector2<f64>) -> f64 {
        self.obstacle.distance(r).0 - self.gap
    }

    /// ⟨−g⟩, ∂g/∂r and ∂²g/∂r²; `None` without contact.
    #[inline(always)]
    fn penetration(&self, r: &Vector2<f64>) -> Option<(f64, Vector2<f64>, Matrix2<f64>)> {
        let (distance, normal, second) = self.obstacle.distance(r);
        (distance < self.gap).then_some((self.gap - distance, normal, second))
    }
}

impl Density<1> for Penalty {
    const ORDERS: [usize; 1] = [0];

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        self.penetration(&z[0]).map_or(0.0, |(depth, ..)| 0.5 * self.stiffness * depth * depth)
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let force = |(depth, normal, _): (f64, Vector2<f64>, _)| normal * (-self.stiffness * depth);
        [self.penetration(&z[0]).map_or_else(Vector2::zeros, force)]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let hessian = self.penetration(&z[0]).map_or_else(Matrix2::zeros, |(depth, normal, second)| {
            (normal * normal.transpose() - second * depth) * self.stiffness
        });
        (self.gradient(point, z), [[hessian]])
    }
}
