//! The shape of a beam's section.

use schemars::JsonSchema;
use serde::Deserialize;

use super::AlongBeam;
use crate::scene::quantity::{Curvature, Density, Force, Length, Moment, Positive, Quantity, Ratio, Stress};
use crate::scene::value::Located;

/// The shape of a beam's sections: exactly one of the kinds. Stiffnesses follow with the beam's
/// `youngs_modulus`, masses with its `density`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct SectionTable {
    /// A rectangle.
    pub rectangle: Option<Located<RectangleTable>>,
    /// A solid circle.
    pub circle: Option<Located<CircleSectionTable>>,
    /// A circular tube.
    pub tube: Option<Located<TubeTable>>,
    /// Rectangles of several materials, from the right face to the left one, seen along the beam.
    #[schemars(length(min = 1))]
    pub layers: Option<Located<Vec<Located<LayerTable>>>>,
}

/// A rectangle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleTable {
    /// Width across the plane of motion.
    pub width: Located<AlongBeam<Length, Positive>>,
    /// Height in the plane of motion.
    pub height: Located<AlongBeam<Length, Positive>>,
}

/// A solid circle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleSectionTable {
    /// Its diameter.
    pub diameter: Located<AlongBeam<Length, Positive>>,
}

/// A circular tube.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TubeTable {
    /// Outer diameter.
    pub diameter: Located<AlongBeam<Length, Positive>>,
    /// Thickness of the wall.
    pub wall: Located<AlongBeam<Length, Positive>>,
}

/// A rectangle of one material in a section of several.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerTable {
    /// Young's modulus E.
    pub youngs_modulus: Located<AlongBeam<Stress, Positive>>,
    /// Density ρ.
    pub density: Option<Located<AlongBeam<Density, Positive>>>,
    /// Width across the plane of motion.
    pub width: Located<AlongBeam<Length, Positive>>,
    /// Height in the plane of motion.
    pub height: Located<AlongBeam<Length, Positive>>,
    /// Distance of its middle from the centreline, to the left seen along the beam. Where no layer
    /// has one, layers lie on each other, and the centreline is in the middle of all.
    pub offset: Option<Located<AlongBeam<Length>>>,
}

/// Axial force as a piecewise linear function of the axial strain; straight on beyond its ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxialLawTable {
    /// Rising.
    #[schemars(length(min = 2))]
    pub strain: Vec<Located<Quantity<Ratio>>>,
    /// As many, none smaller than the one before.
    #[schemars(length(min = 2))]
    pub force: Vec<Located<Quantity<Force>>>,
}

/// Bending moment as a piecewise linear function of the curvature; straight on beyond its ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BendingLawTable {
    /// Rising.
    #[schemars(length(min = 2))]
    pub curvature: Vec<Located<Quantity<Curvature>>>,
    /// As many, none smaller than the one before.
    #[schemars(length(min = 2))]
    pub moment: Vec<Located<Quantity<Moment>>>,
}
