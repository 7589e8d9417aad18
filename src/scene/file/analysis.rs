//! Keys of the `analysis` table.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::{
    Angle, Curvature, Force, Length, Moment, Positive, Quantity, Ratio, Stress, Time, Velocity,
};
use super::super::value::{AccuracyValue, Count, Located};

/// What to compute.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct AnalysisTable {
    /// Equilibrium under the full loads.
    #[serde(rename = "static")]
    pub statics: Option<StaticTable>,
    /// Motion in time.
    pub dynamic: Option<Located<DynamicTable>>,
    /// Critical load factors.
    pub buckling: Option<ModesTable>,
    /// Natural frequencies.
    pub modal: Option<ModalTable>,
}

/// Settings of a static analysis; every one may be left out.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StaticTable {
    /// Record the state at this many equal parts of the load.
    pub steps: Option<Located<Count<1>>>,
    /// Largest step of the load factor; 0.02 with friction, whose forces depend on the path, and else as large as possible
    /// when left out.
    pub max_step: Option<Located<Quantity<Ratio, Positive>>>,
    /// Relative accuracy of every equilibrium.
    pub tolerance: Option<Located<Quantity<Ratio, Positive>>>,
    /// Follow the path by arc length, through limit points.
    pub arc_length: Option<Located<ArcLengthTable>>,
    /// Largest error of the results, for which everything is chosen that the scene does not name.
    pub accuracy: Option<Located<AccuracyValue>>,
}

/// Arc-length continuation; at least one of the `until` keys or `max_points` ends it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcLengthTable {
    /// Stop where the load factor first reaches this value; the path to one below zero begins with loads that are turned round.
    pub until_load: Option<Quantity<Ratio>>,
    /// Stop after this many points on the path; 1000 when left out. A path that has not reached its
    /// `until` by then is incomplete.
    pub max_points: Option<Located<Count<1>>>,
    /// Longest step, as a fraction of the beam's length; a change of the load factor by 1, or by `until_load` where that is larger, counts as a length.
    pub max_step: Option<Quantity<Ratio, Positive>>,
    /// Stop where a probe's coordinate first reaches a value.
    pub until_probe: Option<Located<UntilProbeTable>>,
}

/// A value of a probe's coordinate: `x` or `y`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["x"] }, { "required": ["y"] }]))]
pub struct UntilProbeTable {
    /// Name of the probe.
    pub probe: Located<String>,
    /// Value of its x.
    pub x: Option<Quantity<Length>>,
    /// Value of its y.
    pub y: Option<Quantity<Length>>,
}

/// Motion in time; at most one integrator, `radau` with three stages and a tolerance of 1e-6 when
/// left out.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DynamicTable {
    /// Simulated time, from time zero or from that of a saved state on.
    pub duration: Quantity<Time, Positive>,
    /// Time between records; a two-hundredth of the duration when left out.
    pub output_every: Option<Located<Quantity<Time, Positive>>>,
    /// Chung and Hulbert's generalised-α method.
    pub generalized_alpha: Option<Located<GeneralizedAlphaTable>>,
    /// Gauss collocation, of order 2, 4 or 6: symplectic with a fixed `step`; with a `tolerance` it
    /// damps what is too fast to be followed.
    pub gauss: Option<Located<GaussTable>>,
    /// Radau IIA collocation, of order 3 or 5: damps what is too fast to be followed; the one that
    /// is taken when none is named.
    pub radau: Option<Located<RadauTable>>,
    /// Quantities at probes that reach a value or turn back.
    #[serde(default)]
    pub event: Vec<EventTable>,
    /// Largest error of the results, for which everything is chosen that the scene does not name.
    pub accuracy: Option<Located<AccuracyValue>>,
}

/// A quantity at a probe reaches a value from one side, also where it turns back there; or it has a
/// `maximum` or a `minimum`. As often as it does within a step.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [
    { "required": ["x"] }, { "required": ["y"] }, { "required": ["angle"] }, { "required": ["vx"] }, { "required": ["vy"] },
    { "required": ["speed"] }, { "required": ["strain"] }, { "required": ["curvature"] }, { "required": ["axial_force"] },
    { "required": ["shear_force"] }, { "required": ["bending_moment"] }, { "required": ["stress_bottom"] },
    { "required": ["stress_top"] }, { "required": ["maximum"] }, { "required": ["minimum"] },
]))]
pub struct EventTable {
    /// Name of the probe.
    pub probe: Located<String>,
    /// Value of its x.
    pub x: Option<Quantity<Length>>,
    /// Value of its y.
    pub y: Option<Quantity<Length>>,
    /// Value of its direction, with full turns.
    pub angle: Option<Quantity<Angle>>,
    /// Value of its velocity along x.
    pub vx: Option<Quantity<Velocity>>,
    /// Value of its velocity along y.
    pub vy: Option<Quantity<Velocity>>,
    /// Value of the magnitude of its velocity.
    pub speed: Option<Quantity<Velocity>>,
    /// Value of the axial strain there.
    pub strain: Option<Quantity<Ratio>>,
    /// Value of the curvature there.
    pub curvature: Option<Quantity<Curvature>>,
    /// Value of the axial force there.
    pub axial_force: Option<Quantity<Force>>,
    /// Value of the shear force there.
    pub shear_force: Option<Quantity<Force>>,
    /// Value of the bending moment there.
    pub bending_moment: Option<Quantity<Moment>>,
    /// Value of the stress on the right face of the section there.
    pub stress_bottom: Option<Located<Quantity<Stress>>>,
    /// Value of the stress on the left face.
    pub stress_top: Option<Located<Quantity<Stress>>>,
    /// The quantity that begins to fall.
    pub maximum: Option<Located<ProbeQuantityName>>,
    /// The quantity that begins to rise.
    pub minimum: Option<Located<ProbeQuantityName>>,
    /// From which side a value is reached; from either when left out.
    pub crossing: Option<Located<CrossingName>>,
    /// Whether the motion ends there.
    #[serde(default)]
    pub stop: bool,
}

/// A quantity at a probe.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProbeQuantityName {
    /// Position along x.
    X,
    /// Position along y.
    Y,
    /// Direction of r'.
    Angle,
    /// Velocity along x.
    Vx,
    /// Velocity along y.
    Vy,
    /// Magnitude of the velocity.
    Speed,
    /// Axial strain.
    Strain,
    /// Curvature.
    Curvature,
    /// Axial force.
    AxialForce,
    /// Shear force.
    ShearForce,
    /// Bending moment.
    BendingMoment,
    /// Stress on the right face.
    StressBottom,
    /// Stress on the left face.
    StressTop,
}

/// The way in which a value is crossed.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CrossingName {
    /// Either way.
    Any,
    /// From below.
    Rising,
    /// From above.
    Falling,
}

/// Generalised-α; `step` or `tolerance`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["step"] }, { "required": ["tolerance"] }]))]
pub struct GeneralizedAlphaTable {
    /// Fixed step.
    pub step: Option<Located<Quantity<Time, Positive>>>,
    /// Relative accuracy that chooses the steps.
    pub tolerance: Option<Located<Quantity<Ratio, Positive>>>,
    /// Spectral radius at infinite frequency, from 0 to 1; 0.9 when left out.
    #[schemars(range(min = 0, max = 1))]
    pub spectral_radius: Option<Located<Quantity<Ratio>>>,
    /// With `step`: error of positions, in beam lengths, that the iteration of a step may leave;
    /// 1e-11 when left out.
    pub newton_tolerance: Option<Located<Quantity<Ratio, Positive>>>,
}

/// Gauss collocation; `step` or `tolerance`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["step"] }, { "required": ["tolerance"] }]))]
pub struct GaussTable {
    /// 1, 2 or 3; 3 when left out.
    #[schemars(range(max = 3))]
    pub stages: Option<Located<Count<1>>>,
    /// Fixed step.
    pub step: Option<Located<Quantity<Time, Positive>>>,
    /// Relative accuracy that chooses the steps.
    pub tolerance: Option<Located<Quantity<Ratio, Positive>>>,
}

/// Radau IIA collocation; `step` or `tolerance`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["step"] }, { "required": ["tolerance"] }]))]
pub struct RadauTable {
    /// 2 or 3; 3 when left out.
    #[schemars(range(max = 3))]
    pub stages: Option<Located<Count<2>>>,
    /// Fixed step.
    pub step: Option<Located<Quantity<Time, Positive>>>,
    /// Relative accuracy that chooses the steps.
    pub tolerance: Option<Located<Quantity<Ratio, Positive>>>,
}

/// Critical loads, the lowest first.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModesTable {
    /// How many.
    pub count: Located<Count<1>>,
    /// Largest relative error of the load factors, for which the mesh is chosen where the scene
    /// names none.
    pub accuracy: Option<Located<Quantity<Ratio, Positive>>>,
}

/// Natural frequencies, the lowest first.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModalTable {
    /// How many; motions that nothing resists count too, with 0 Hz.
    pub count: Located<Count<1>>,
    /// The state about which the beams vibrate; the reference when left out, and the equilibrium in a
    /// stage after others.
    pub about: Option<Located<AboutName>>,
    /// Largest relative error of the frequencies, for which the mesh is chosen where the scene names
    /// none.
    pub accuracy: Option<Located<Quantity<Ratio, Positive>>>,
}

/// The state about which vibrations are small.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AboutName {
    /// The stress-free one, without loads.
    Reference,
    /// The equilibrium under all loads and prescribed displacements, found first.
    Equilibrium,
}
