//! What takes part in the mechanics, and where.

use super::{Assembly, BuildError};
use crate::basis::Quadrature;
use crate::beam::Place;
use crate::law::Law;
use std::any::Any;
use std::fmt;

/// What takes part in the mechanics besides beams, supports and loads; as [`Any`], so that what
/// reads a model can tell the kinds of parts that it knows.
pub trait Part: Any + fmt::Debug + Send + Sync {
    /// Adds the part's densities to the equations under assembly.
    ///
    /// # Errors
    /// [`BuildError`] where the part does not fit the model.
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError>;

    /// Strain and curvature \[1/m\] that beam `beam` would take by itself, and their law of time.
    fn actuation(&self, _beam: usize) -> Option<(f64, f64, Option<&Law>)> {
        None
    }

    /// What it looks like on the ground, as a line for pictures; `size` is that of the beams \[m\].
    fn outline(&self, _size: f64) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// Where it takes or gives a couple.
    fn couple(&self) -> Option<Place> {
        None
    }

    /// What it may resist by elasticity against the ground, for which motions that nothing resists
    /// are refused.
    fn resists(&self) -> Vec<Resistance> {
        Vec::new()
    }

    /// A mass \[kg\] on which gravity acts.
    fn mass(&self) -> Option<(Place, f64)> {
        None
    }
}

/// A motion of a beam against the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resistance {
    /// Of a point, along an axis.
    Displacement(Place, [f64; 2]),
    /// Of the direction at a point.
    Direction(Place),
    /// Of a whole beam, where something presses it to the ground.
    Contact(usize),
}

/// Two parts are equal if they describe themselves alike.
impl PartialEq for dyn Part {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

/// Where a density is summed.
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
