//! Joints between beams, and between beams and lines of the ground.

use super::Place;

/// A joint between two points of beams, or between a point and the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Joint {
    /// The two points coincide; their directions are free.
    Hinge {
        /// A point of a beam.
        first: Place,
        /// A point of another beam, or of the same.
        second: Place,
    },
    /// The two points coincide, and the directions keep the angle at which they meet in the
    /// stress-free shape; see [`crate::system::joint`].
    Weld {
        /// A point of a beam.
        first: Place,
        /// A point of another beam, or of the same.
        second: Place,
    },
    /// The point moves along a straight line that is fixed to the ground and passes through the
    /// position of the point in the stress-free shape.
    Slider {
        /// A point of a beam.
        at: Place,
        /// Direction of the line.
        along: [f64; 2],
    },
}

impl Joint {
    /// The points that it joins.
    pub fn places(&self) -> impl Iterator<Item = Place> + use<> {
        let (first, second) = match *self {
            Self::Hinge { first, second } | Self::Weld { first, second } => (first, Some(second)),
            Self::Slider { at, .. } => (at, None),
        };
        std::iter::once(first).chain(second)
    }
}
