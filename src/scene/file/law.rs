//! Laws of time, as a scene writes them.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::quantity::{Angle, AngularVelocity, Frequency, Positive, Quantity, Ratio, Time};
use crate::scene::value::Located;

/// A factor as a function of time: exactly one of the kinds.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct LawTable {
    /// From 0 evenly to 1.
    pub ramp: Option<RampTable>,
    /// From 0 to 1 with continuous acceleration: 10 x³ − 15 x⁴ + 6 x⁵ of the part x of its time.
    pub smooth_ramp: Option<RampTable>,
    /// 0 before, 1 from then on.
    pub step: Option<StepTable>,
    /// A sine.
    pub harmonic: Option<HarmonicTable>,
    /// Coefficients of 1, t, t², …, t in seconds.
    #[schemars(length(min = 1))]
    pub polynomial: Option<Vec<Quantity<Ratio>>>,
    /// Through given points.
    pub table: Option<Located<PointsTable>>,
    /// The sum of laws.
    #[schemars(length(min = 1))]
    pub sum: Option<Vec<Located<LawTable>>>,
    /// The product of laws.
    #[schemars(length(min = 1))]
    pub product: Option<Vec<Located<LawTable>>>,
    /// An expression in the time t, such as "sin(2*pi*t)*(1-exp(-t/0.5))".
    pub expression: Option<Located<ExpressionTable>>,
}

/// An expression in the time t in seconds, with pi, tau, e, + − * / ^ and smooth functions. Changes
/// within less than 1/16384 of the duration may be missed.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ExpressionTable {
    /// The expression, smooth at all times.
    Smooth(String),
    /// The expression, and where it is not smooth.
    Kinked(KinkedTable),
}

/// An expression that is not smooth at some times.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KinkedTable {
    /// The expression.
    pub of: String,
    /// Times at which its value or its slope jumps.
    pub kinks: Vec<Quantity<Time>>,
}

/// When a ramp begins and how long it takes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RampTable {
    /// When it begins; time zero when left out.
    pub start: Option<Quantity<Time>>,
    /// How long it takes.
    pub duration: Quantity<Time, Positive>,
}

/// When a step happens.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepTable {
    /// When.
    pub start: Quantity<Time>,
}

/// sin(2π frequency t + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicTable {
    /// Cycles per second.
    pub frequency: Quantity<Frequency, Positive>,
    /// Phase; a quarter turn makes it a cosine.
    pub phase: Option<Quantity<Angle>>,
}

/// Points of a law, constant before the first and after the last.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsTable {
    /// Times, increasing.
    #[schemars(length(min = 2))]
    pub times: Vec<Quantity<Time>>,
    /// Values, as many as times.
    #[schemars(length(min = 2))]
    pub values: Vec<Quantity<Ratio>>,
    /// The natural cubic spline through the points, without curvature at its ends, in place of straight lines.
    #[serde(default)]
    pub smooth: bool,
}

/// A hub that is brought to speed: Ω/T (t²/2 + (T/2π)² (cos(2πt/T) − 1)) until T, then Ω (t − T/2), with t from when it
/// begins.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinUpTable {
    /// When it begins; time zero when left out.
    pub start: Option<Quantity<Time>>,
    /// Ω.
    pub speed: Quantity<AngularVelocity>,
    /// T.
    pub duration: Quantity<Time, Positive>,
}
