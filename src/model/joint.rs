//! How beams are joined to each other, and to lines of the ground.

use super::Place;

/// A joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// The two points coincide; their directions are free.
    Hinge {
        /// A point of a beam.
        first: Place,
        /// A point of another beam, or of the same.
        second: Place,
    },
    /// The two points coincide, and the gradients keep the angle at which they meet: r'_second = R(φ) r'_first with φ the angle in the stress-free
    /// shape. Both beams have the same stretch at that point; see [`crate::system::joint`].
    Weld {
        /// A point of a beam.
        first: Place,
        /// A point of another beam, or of the same.
        second: Place,
    },
    /// The point moves along a straight line of the ground, through where it is in the stress-free shape.
    Slider {
        /// A point of a beam.
        at: Place,
        /// Direction of the line.
        along: [f64; 2],
    },
}
