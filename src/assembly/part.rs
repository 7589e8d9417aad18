//! The parts of a model and their extents.

use super::{Assembly, BuildError};
use crate::basis::Quadrature;
use crate::beam::Place;
use crate::law::Law;
use std::any::Any;
use std::fmt;

/// Anything that takes part in the mechanics besides supports and joints: elasticity, inertia,
/// loads, springs, contacts. It is [`Any`], so that code that reads a model can recognise the kinds
/// of parts that it knows.
pub trait Part: Any + fmt::Debug + Send + Sync {
    /// Adds the part's densities to the equations under assembly.
    ///
    /// # Errors
    /// [`BuildError`] where the part does not fit the model.
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError>;

    /// The strain and the curvature \[1/m\] that an actuation imposes on beam `beam`, and their law
    /// of time.
    fn actuation(&self, _beam: usize) -> Option<(f64, f64, Option<&Law>)> {
        None
    }

    /// The outline of an obstacle on the ground, as a line for pictures; `size` is the size of the
    /// beams \[m\].
    fn outline(&self, _size: f64) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The place at which the part transmits a couple, where the curvature of the beam may jump.
    fn couple(&self) -> Option<Place> {
        None
    }

    /// The point at which it acts, where it acts at a single one: there the shear force jumps.
    fn point(&self) -> Option<Place> {
        None
    }

    /// The motions that the part may resist by elasticity against the ground. They are used to
    /// refuse models with a motion that nothing resists.
    fn resists(&self) -> Vec<Resistance> {
        Vec::new()
    }

    /// A mass \[kg\] on which gravity acts, and its place.
    fn mass(&self) -> Option<(Place, f64)> {
        None
    }
}

/// A motion of a beam against the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resistance {
    /// Displacement of a point along an axis.
    Displacement(Place, [f64; 2]),
    /// Rotation of the direction at a point.
    Direction(Place),
    /// Any motion of a whole beam, if something presses it against an obstacle.
    Contact(usize),
}

/// Two parts are equal if their `Debug` output is the same.
impl PartialEq for dyn Part {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

/// The region over which a density is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Over a whole beam, by a quadrature rule in every cell.
    Beam(usize, Quadrature),
    /// At one point, with weight 1.
    Point(Place),
}

impl Extent {
    /// Index of the beam.
    pub fn beam(self) -> usize {
        match self {
            Self::Beam(beam, _) => beam,
            Self::Point(place) => place.beam,
        }
    }
}
