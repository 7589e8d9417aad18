//! The shape in which an analysis begins.

use super::Centreline;

/// The shape in which a beam is when an analysis begins, where it is not the stress-free one: a
/// straight rod that is bent into a ring, a belt that is laid over pulleys. Points of the beam are
/// spread over it in proportion to their arc lengths. Supports hold, and joints join, where the
/// beams are in this shape.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialShape {
    /// Index of the beam.
    pub beam: usize,
    /// The shape.
    pub centreline: Centreline,
}
