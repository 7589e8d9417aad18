//! The tables of a scene file, as serde reads them and as the JSON schema describes them.
//!
//! Each struct is one table; a key that no struct has is an error. Alternatives ("one of these
//! keys") are optional fields here and are checked in `to_model`, because only there can a message
//! point at both.

use std::collections::BTreeMap;

mod along;
mod analysis;
mod law;
mod part;
mod section;
mod stage;

pub use along::*;
pub use analysis::*;
pub use law::*;
pub use part::*;
pub use section::*;
pub use stage::*;

use schemars::JsonSchema;
use serde::Deserialize;

use super::quantity::{
    Acceleration, Angle, AngularVelocity, Area, BendingStiffness, Density, Force, ForcePerLength, Length,
    MassPerLength, Moment, Positive, Quantity, Ratio, SecondMoment, Stress, Velocity,
};
use super::value::{At, Count, Located, NodeList, Vector};

/// A planar flexible-beam problem: beams, supports, loads, probes and one analysis. Numbers are SI;
/// text carries a unit, such as "1.8 m". What is not named is not simulated.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Scene of ancf", extend("oneOf" = [{ "required": ["analysis"] }, { "required": ["stage"] }]))]
pub struct SceneTable {
    /// One line that says what this is.
    #[serde(default)]
    pub title: String,
    /// The beams, by name.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, BeamTable>", extend("minProperties" = 1), required)]
    pub beam: BTreeMap<Located<String>, BeamTable>,
    /// What is held, and what is moved by prescription.
    #[serde(default)]
    pub support: Vec<Located<SupportTable>>,
    /// How beams are joined to each other, or to lines of the ground.
    #[serde(default)]
    pub joint: Vec<Located<JointTable>>,
    /// What acts on the beams.
    #[serde(default)]
    pub effect: EffectTable,
    /// How beams move at the start; at rest where nothing is said.
    #[serde(default)]
    pub initial_velocity: Vec<InitialVelocityTable>,
    /// Points to watch.
    #[serde(default)]
    pub probe: Vec<ProbeTable>,
    /// What to compute: exactly one kind; or else stages.
    pub analysis: Option<Located<AnalysisTable>>,
    /// Analyses in their order, each of which starts where the one before it ended.
    #[serde(default)]
    pub stage: Vec<StageTable>,
    /// Files beyond those that are always written.
    #[serde(default)]
    pub output: OutputTable,
}

/// A slender planar beam. Its geometry is one of `start` and `end`, `arc`, or `points`, all
/// stress-free as given.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["start", "end"] }, { "required": ["arc"] }, { "required": ["points"] }]))]
pub struct BeamTable {
    /// First end of a straight beam.
    pub start: Option<Located<Vector<Length>>>,
    /// Second end of a straight beam.
    pub end: Option<Located<Vector<Length>>>,
    /// Part of a circle.
    pub arc: Option<Located<ArcTable>>,
    /// A smooth curve through these points, in order: the cubic spline whose third derivative does not jump at
    /// the second point and the last but one, through three points a parabola.
    #[schemars(length(min = 2))]
    pub points: Option<Located<Vec<Located<Vector<Length>>>>>,
    /// Where the beam is at the start of the analysis, if not in its stress-free shape.
    pub initial_shape: Option<Located<InitialShapeTable>>,
    /// The shape of the sections; in place of `area` and `second_moment`.
    pub section: Option<Located<SectionTable>>,
    /// Young's modulus E.
    pub youngs_modulus: Option<Located<AlongBeam<Stress, Positive>>>,
    /// Area A of the section.
    pub area: Option<Located<AlongBeam<Area, Positive>>>,
    /// Second moment of area I of the section.
    pub second_moment: Option<Located<AlongBeam<SecondMoment, Positive>>>,
    /// Density ρ.
    pub density: Option<Located<AlongBeam<Density, Positive>>>,
    /// Axial stiffness EA, in place of `youngs_modulus` and `area`. A beam without any keeps its
    /// length.
    pub axial_stiffness: Option<Located<AlongBeam<Force, Positive>>>,
    /// Bending stiffness EI, in place of `youngs_modulus` and `second_moment`. A beam without any
    /// is a string.
    pub bending_stiffness: Option<Located<AlongBeam<BendingStiffness, Positive>>>,
    /// Axial force against axial strain, in place of an axial stiffness; no force falls, and that at
    /// no strain is zero. Damping by stiffness takes the largest slope.
    pub axial_law: Option<Located<AxialLawTable>>,
    /// Bending moment against curvature, in place of a bending stiffness, likewise.
    pub bending_law: Option<Located<BendingLawTable>>,
    /// Mass per length ρA, in place of `density` and `area`.
    pub mass_per_length: Option<Located<AlongBeam<MassPerLength, Positive>>>,
    /// How the axial strain is measured.
    #[serde(default)]
    pub strain: StrainName,
    /// How the beam is discretised: exactly one of the kinds; chosen for the accuracy of the
    /// analysis when left out.
    pub basis: Option<Located<BasisTable>>,
}

/// A shape in which a beam begins: exactly one of the kinds. The beam's points are spread over it in
/// proportion to their arc lengths.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct InitialShapeTable {
    /// From one point to another, straight.
    pub line: Option<Located<LineTable>>,
    /// Part of a circle.
    pub arc: Option<Located<ArcTable>>,
    /// A smooth curve through these points, in order: the cubic spline whose third derivative does not jump at
    /// the second point and the last but one, through three points a parabola.
    #[schemars(length(min = 2))]
    pub points: Option<Located<Vec<Located<Vector<Length>>>>>,
}

/// A straight line.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineTable {
    /// Where the beam's start is.
    pub start: Vector<Length>,
    /// Where its end is.
    pub end: Vector<Length>,
}

/// Axial strain as a function of the gradient r'.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StrainName {
    /// ½ (r'·r' − 1).
    Green,
    /// |r'| − 1.
    #[default]
    Engineering,
}

/// Part of a circle, from one polar angle to another, either way round.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcTable {
    /// Centre of the circle.
    pub center: Vector<Length>,
    /// Radius of the circle.
    pub radius: Quantity<Length, Positive>,
    /// Polar angle of the beam's start.
    pub from: Quantity<Angle>,
    /// Polar angle of the beam's end.
    pub to: Quantity<Angle>,
}

/// A beam's discretisation.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct BasisTable {
    /// Gradient-deficient cable elements, cubic between neighbouring nodes.
    pub ancf: Option<Located<AncfTable>>,
    /// Hermite radial point interpolation.
    pub rpim: Option<Located<RpimTable>>,
}

/// Gradient-deficient cable elements; `elements` or `nodes` is needed.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AncfTable {
    /// Number of elements, one less than nodes.
    pub elements: Option<Located<Count<1>>>,
    /// Number of nodes, or the arc length of each.
    pub nodes: Option<Located<NodeList>>,
    /// How counted nodes are spaced.
    pub spacing: Option<Located<SpacingName>>,
    /// Points in every element; Lobatto's three (stretch) and Gauss' two (bend) when left out,
    /// Gauss' 5/3 where nothing can lock.
    pub gauss_points: Option<GaussPointsTable>,
}

/// Hermite radial point interpolation. What is left out was chosen by measurement.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RpimTable {
    /// Number of nodes, or the arc length of each.
    pub nodes: Located<NodeList>,
    /// How counted nodes are spaced.
    pub spacing: Option<Located<SpacingName>>,
    /// Radial function: exactly one kind; the multiquadric with q = 1.03 and `shape` 5 when left out.
    pub kernel: Option<Located<KernelTable>>,
    /// Polynomial terms 1, s, s², … of the interpolation; two when left out.
    pub polynomial_terms: Option<Located<Count<1>>>,
    /// Sign of the slope terms in the side conditions; `plus` when left out.
    pub side_condition: Option<SideConditionName>,
    /// Nodes beyond the cell's own two, on each side; two when left out.
    pub neighbours: Option<Located<Count<0>>>,
    /// Gauss points in every cell between neighbouring nodes; 4/4 when left out.
    pub gauss_points: Option<GaussPointsTable>,
}

/// How nodes are spaced along the beam.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SpacingName {
    /// At equal distances.
    #[default]
    Uniform,
    /// s_i = L/2 − L/2 cos((i−1)π/(n−1)).
    Chebyshev,
}

/// Sign in Σ [p_j(s_i) a_i ± p_j'(s_i) b_i] = 0.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SideConditionName {
    /// As published.
    Plus,
    /// The choice that makes the moment matrix symmetric.
    Minus,
}

/// Gauss points in a cell, by energy.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GaussPointsTable {
    /// For the stretching energy.
    pub stretch: Located<Count<1>>,
    /// For the bending energy.
    pub bend: Located<Count<1>>,
    /// Rule of the points for stretching; Gauss' when left out.
    pub stretch_rule: Option<Located<RuleName>>,
}

/// A family of quadrature rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RuleName {
    /// Interior points, exact up to degree 2n − 1.
    #[default]
    Gauss,
    /// Both ends of a cell are among the points, exact up to degree 2n − 3.
    Lobatto,
}

/// Radial function of the distance d, in units of the average spacing.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct KernelTable {
    /// (d² + shape²)^q.
    pub multiquadric: Option<MultiquadricTable>,
    /// exp(−shape d²).
    pub exponential: Option<ExponentialTable>,
    /// d^exponent, times ln d where the exponent is even.
    pub thin_plate_spline: Option<ThinPlateSplineTable>,
    /// Wendland's C⁶ function, zero beyond `radius`.
    pub wendland: Option<WendlandTable>,
}

/// (d² + shape²)^q.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MultiquadricTable {
    /// Exponent, not one of 0, 1, 2, …
    pub q: Located<Quantity<Ratio>>,
    /// Shape parameter.
    pub shape: Quantity<Ratio, Positive>,
}

/// exp(−shape d²).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExponentialTable {
    /// Shape parameter.
    pub shape: Quantity<Ratio, Positive>,
}

/// d^exponent, times ln d where the exponent is even.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThinPlateSplineTable {
    /// Larger than 3: three derivatives must exist at d = 0.
    pub exponent: Located<Quantity<Ratio, Positive>>,
}

/// Wendland's C⁶ function of compact support.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WendlandTable {
    /// Where it becomes zero, in units of the average spacing.
    pub radius: Quantity<Ratio, Positive>,
}

/// Holds a point of a beam, or moves it by prescription.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SupportTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// What is held.
    #[schemars(length(min = 1))]
    pub fix: Located<Vec<Located<FixName>>>,
    /// By how much held quantities move: until the load is full, or by a law of time.
    #[serde(rename = "move")]
    pub displacement: Option<Located<MoveTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// What a support can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FixName {
    /// Position along x.
    X,
    /// Position along y.
    Y,
    /// Direction of r' alone.
    Angle,
    /// Both components of r'.
    Gradient,
}

/// Prescribed motion of a support, for quantities that it fixes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveTable {
    /// Along x.
    pub x: Option<Located<Quantity<Length>>>,
    /// Along y.
    pub y: Option<Located<Quantity<Length>>>,
    /// Rotation, counter-clockwise.
    pub angle: Option<Located<Quantity<Angle>>>,
    /// In a motion: the law of time by which all three are multiplied.
    pub in_time: Option<Located<LawTable>>,
    /// In a motion, in place of `angle` and `in_time`: the hub is brought to a speed.
    pub spin_up: Option<Located<SpinUpTable>>,
}

/// What acts on the beams.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EffectTable {
    /// Concentrated forces.
    pub force: Vec<ForceTable>,
    /// Concentrated moments.
    pub moment: Vec<MomentTable>,
    /// Forces per length along beams.
    pub distributed_force: Vec<DistributedForceTable>,
    /// Weight of every beam and mass.
    pub gravity: Option<Located<GravityTable>>,
    /// Damping of beams.
    pub damping: Vec<DampingTable>,
    /// Springs and dashpots to the ground.
    pub spring: Vec<SpringTable>,
    /// Torsional springs and dashpots to the ground.
    pub torsion_spring: Vec<TorsionSpringTable>,
    /// Masses at points.
    pub point_mass: Vec<PointMassTable>,
    /// Rotary inertia of sections.
    pub rotary_inertia: Vec<SectionInertiaTable>,
    /// Elastic foundations.
    pub foundation: Vec<FoundationTable>,
    /// Strains and curvatures that beams would take by themselves.
    pub actuation: Vec<ActuationTable>,
    /// Tendons along beams.
    pub tendon: Vec<TendonTable>,
    /// Resistance of a fluid.
    pub drag: Vec<DragTable>,
    /// Lift by a displaced fluid.
    pub buoyancy: Vec<BuoyancyTable>,
    /// Attractions by electrodes.
    pub electrostatic: Vec<ElectrostaticTable>,
    /// Forces that depend on the place.
    pub force_field: Vec<ForceFieldTable>,
    /// Forces that travel along beams.
    pub moving_force: Vec<MovingForceTable>,
    /// Contacts with obstacles.
    pub contact: Vec<ContactTable>,
}

/// A concentrated force.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// Components in the fixed frame; of a follower, those while the beam is undeformed.
    pub value: Vector<Force>,
    /// Turns with the section.
    #[serde(default)]
    pub follower: bool,
    /// In a motion: the law of time that multiplies it.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A concentrated moment.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MomentTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// Counter-clockwise.
    pub value: Quantity<Moment>,
    /// Accepted for symmetry with forces; in the plane a moment has no direction that could follow.
    #[serde(default)]
    #[expect(dead_code, reason = "legal, and without effect")]
    pub follower: bool,
    /// In a motion: the law of time that multiplies it.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A force per reference length along a beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DistributedForceTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Components, as for a concentrated force.
    pub value: AlongVector<ForcePerLength>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// Turns with the section.
    #[serde(default)]
    pub follower: bool,
    /// In a motion: the law of time that multiplies it.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// Weight of every beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityTable {
    /// Such as [0.0, −9.81].
    pub acceleration: Vector<Acceleration>,
    /// In a motion: the law of time that multiplies it.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A point that is watched.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeTable {
    /// Name of its columns in the output.
    pub name: Located<String>,
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
}

/// The velocity of a beam: as a rigid body, along the arc length, or both; several of one beam add
/// up.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialVelocityTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Velocity of the point `about`.
    pub value: Option<Vector<Velocity>>,
    /// Angular velocity, counter-clockwise.
    pub rotation: Option<Quantity<AngularVelocity>>,
    /// The point about which the beam turns; the origin when left out.
    pub about: Option<Vector<Length>>,
    /// A velocity that is a polynomial in the arc length.
    pub polynomial: Option<Located<VelocityPolynomialTable>>,
    /// A velocity through given points of the arc length.
    pub table: Option<Located<VelocityPointsTable>>,
}

/// Components in the fixed frame, as coefficients of 1, s, s², … with s in metres and velocities in
/// metres per second; `vx`, `vy` or both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VelocityPolynomialTable {
    /// Along x.
    #[schemars(length(min = 1))]
    pub vx: Option<Vec<Quantity<Ratio>>>,
    /// Along y.
    #[schemars(length(min = 1))]
    pub vy: Option<Vec<Quantity<Ratio>>>,
}

/// Components in the fixed frame at places from one end of the beam to the other, by a cubic spline
/// between them, which is flat at an end whose direction a support holds; `vx`, `vy` or both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VelocityPointsTable {
    /// Arc lengths, from 0 to the beam's length.
    #[schemars(length(min = 2))]
    pub s: Vec<Quantity<Length>>,
    /// Along x, as many as arc lengths.
    #[schemars(length(min = 2))]
    pub vx: Option<Vec<Quantity<Velocity>>>,
    /// Along y, as many as arc lengths.
    #[schemars(length(min = 2))]
    pub vy: Option<Vec<Quantity<Velocity>>>,
}

/// Files beyond those that are always written.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputTable {
    /// `states.csv`: every beam at every record.
    pub states: bool,
    /// A VTU series for ParaView: of the states at every record, and of the modes of a modal analysis or of buckling.
    pub vtu: bool,
    /// `reactions.csv`: forces of supports and joints at every record.
    pub reactions: bool,
    /// `effects.csv`: energy and resultant force of every effect at every record; of inertia the energy alone, its force is zero there.
    pub effects: bool,
    /// Section forces and stresses at every record: of the probes in `probes.csv`, and along the
    /// beams in `states.csv` and the VTU series.
    pub section_forces: bool,
}
