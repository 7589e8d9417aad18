//! Tables of what takes part besides beams, supports and loads: damping, springs, masses, fluids,
//! contacts; and of joints.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{AlongBeam, AlongVector, LawTable};
use crate::scene::quantity::{
    Angle, Curvature, DragCoefficient, Force, ForcePerLength, Frequency, Length, Mass, MassPerLength, Moment,
    Permittivity, Positive, Quantity, Ratio, RotaryInertia, RotaryInertiaPerLength, StiffnessPerLength, Time,
    TorsionalDamping, TranslationalDamping, Velocity, ViscousDamping, Voltage,
};
use crate::scene::value::{At, Count, Located, Vector};

/// Damping of a beam; at least one of the coefficients.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// α of the force per length −α ρA ṙ.
    pub mass_proportional: Option<Located<AlongBeam<Frequency, Positive>>>,
    /// η of N = EA (ε + η ε̇) and M = EI (κ + η κ̇), in place of `strain` and `curvature`.
    pub stiffness_proportional: Option<Located<AlongBeam<Time, Positive>>>,
    /// η of N = EA (ε + η ε̇).
    pub strain: Option<Located<AlongBeam<Time, Positive>>>,
    /// η of M = EI (κ + η κ̇).
    pub curvature: Option<Located<AlongBeam<Time, Positive>>>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A spring and dashpot from a point to the ground; `stiffness`, `damping` or both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// The end on the ground; without it the point is tied to where it is in the stress-free shape,
    /// in all directions.
    pub anchor: Option<Vector<Length>>,
    /// Length without force, of a spring with an anchor; that of the stress-free shape when left
    /// out.
    pub length: Option<Located<Quantity<Length>>>,
    /// Force per length.
    pub stiffness: Option<Quantity<ForcePerLength, Positive>>,
    /// Force per velocity.
    pub damping: Option<Quantity<TranslationalDamping, Positive>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A torsional spring and dashpot on the direction of r' at a point; `stiffness`, `damping` or
/// both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorsionSpringTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// Moment per radian.
    pub stiffness: Option<Quantity<Moment, Positive>>,
    /// Moment per radian a second.
    pub damping: Option<Quantity<TorsionalDamping, Positive>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A mass at a point; `mass`, `rotary_inertia` or both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointMassTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
    /// Mass, on which gravity acts too.
    pub mass: Option<Quantity<Mass, Positive>>,
    /// Moment of inertia, which turns with the section.
    pub rotary_inertia: Option<Quantity<RotaryInertia, Positive>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// The rotary inertia of a beam's sections.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionInertiaTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// ρI; that of the beam's `section` and `density` when left out.
    pub per_length: Option<Located<AlongBeam<RotaryInertiaPerLength, Positive>>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// An elastic foundation along a beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FoundationTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Force per length and displacement along x and y.
    pub stiffness: Located<AlongVector<StiffnessPerLength>>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A strain or curvature that the beam would take by itself.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActuationTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// ε₀.
    pub strain: Option<Located<AlongBeam<Ratio>>>,
    /// κ₀.
    pub curvature: Option<Located<AlongBeam<Curvature>>>,
    /// Number of the layer of the section, from 1, on which alone the strain is imposed; the whole
    /// section when left out.
    pub layer: Option<Located<Count<1>>>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// In a motion: the law of time that multiplies both.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A tendon without friction along a beam, pulled with a given tension or to a given length: it presses
/// on the sections at which it ends, and on its sheath where it is bent.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["tension"] }, { "required": ["length"] }, { "required": ["shortening"] }]))]
pub struct TendonTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Distance from the centreline, to the left of the direction from the beam's start to its end;
    /// without jumps.
    pub offset: Located<AlongBeam<Length>>,
    /// Tension.
    pub tension: Option<Located<Quantity<Force, Positive>>>,
    /// Its length, in place of a tension: it does not stretch, and is pulled until it has this length.
    pub length: Option<Located<Quantity<Length, Positive>>>,
    /// The same by how much shorter it is than in the stress-free shape; 0 for one that is just taut.
    pub shortening: Option<Located<Quantity<Length>>>,
    /// Arc length at which it begins; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length at which it ends; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// In a motion: the law of time that multiplies the tension, or what is pulled in.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// Resistance of a fluid, by the velocity along and across the beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DragTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// ½ ρ C_D D across the beam.
    pub normal: Option<Located<AlongBeam<DragCoefficient, Positive>>>,
    /// The same along the beam.
    pub tangential: Option<Located<AlongBeam<DragCoefficient, Positive>>>,
    /// Viscous force per length and velocity across the beam.
    pub viscous_normal: Option<Located<AlongBeam<ViscousDamping, Positive>>>,
    /// The same along the beam.
    pub viscous_tangential: Option<Located<AlongBeam<ViscousDamping, Positive>>>,
    /// Velocity of the fluid. In statics its force is a load, which grows with the load factor.
    pub flow: Option<Vector<Velocity>>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// Lift of a beam in a heavy fluid; needs gravity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BuoyancyTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Mass of the fluid that a length of the beam displaces.
    pub displaced_mass_per_length: Located<AlongBeam<MassPerLength, Positive>>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// Attraction by a flat electrode, as between parallel plates: ½ ε w V²/g² (1 + β g/w) per length.
/// In statics its force, the square of the voltage, grows with the load factor.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElectrostaticTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Voltage V between the beam and the electrode.
    pub voltage: Quantity<Voltage, Positive>,
    /// The electrode's surface, from which the gap g is measured.
    pub electrode: HalfPlaneTable,
    /// Width w of the plates, across the plane.
    pub width: Quantity<Length, Positive>,
    /// β of the field beyond the edges: 0.65 for plates far wider than the gap; none when left out.
    pub fringe: Option<Quantity<Ratio, Positive>>,
    /// Distance of the beam's surface from its centreline; that of its `section` when left out, and
    /// zero without one.
    pub half_thickness: Option<Quantity<Length, Positive>>,
    /// ε of what is in the gap; that of the vacuum when left out.
    pub permittivity: Option<Quantity<Permittivity, Positive>>,
    /// Arc length from which on the electrode faces the beam; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it does; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// In a motion: the law of time that multiplies the voltage.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A force per length that depends on the place, by formulas of x and y in metres, and in motions of
/// the time t in seconds: `potential` or `value`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["potential"] }, { "required": ["value"] }]))]
pub struct ForceFieldTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// U in J/m, such as "50*(y-0.2)^2"; the force is −∇U. With t, what it gives is work.
    pub potential: Option<Located<String>>,
    /// Fx and Fy in N/m, such as ["-3*y", "3*x"] or ["0", "3*sin(2*pi*(x-2*t))"], which need not have a
    /// potential.
    pub value: Option<[Located<String>; 2]>,
    /// Arc length from which on it acts; the beam's start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it acts; the beam's end when left out.
    pub to: Option<Located<At>>,
    /// In a motion: the law of time that multiplies it.
    pub in_time: Option<Located<LawTable>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A dead force that travels along a beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingForceTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Components in the fixed frame.
    pub value: Vector<Force>,
    /// Speed along the beam.
    pub speed: Located<Quantity<Velocity>>,
    /// Arc length at time zero, also off the beam; its start when left out.
    pub start: Option<Quantity<Length>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// Contact of a beam with one obstacle of the ground: `circle`, `half_plane` or `box`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["circle"] }, { "required": ["half_plane"] }, { "required": ["box"] }]))]
pub struct ContactTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// A disc, or a round hole around the beam.
    pub circle: Option<CircleTable>,
    /// All that lies behind a straight line.
    pub half_plane: Option<HalfPlaneTable>,
    /// A rectangle.
    #[serde(rename = "box")]
    pub rectangle: Option<BoxTable>,
    /// Force per length of beam and penetration.
    pub stiffness: Quantity<StiffnessPerLength, Positive>,
    /// Distance of the beam's surface from its centreline; that of its `section` when left out, and
    /// zero without one.
    pub half_thickness: Option<Quantity<Length, Positive>>,
    /// Dry friction.
    pub friction: Option<FrictionTable>,
    /// Arc length from which on the beam can touch; its start when left out.
    pub from: Option<Located<At>>,
    /// Arc length up to which it can; its end when left out.
    pub to: Option<Located<At>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// A circle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleTable {
    /// Its centre.
    pub center: Vector<Length>,
    /// Its radius.
    pub radius: Quantity<Length, Positive>,
    /// Whether the beam is within it.
    #[serde(default)]
    pub inside: bool,
}

/// A half-plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfPlaneTable {
    /// A point of its border.
    pub point: Vector<Length>,
    /// Towards the beam.
    pub normal: Located<Vector<Ratio>>,
}

/// A rectangle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxTable {
    /// Its centre.
    pub center: Vector<Length>,
    /// Its sides.
    pub size: Located<Vector<Length>>,
    /// By which it is turned.
    pub angle: Option<Quantity<Angle>>,
}

/// Dry friction: points that touch stick by elastic springs along the surface, up to Coulomb's
/// limit.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionTable {
    /// Friction force against contact force.
    pub coefficient: Quantity<Ratio, Positive>,
    /// Force per length of beam and elastic slip; that of the contact when left out.
    pub stiffness: Option<Quantity<StiffnessPerLength, Positive>>,
    /// Not in use any more: friction sticks, and needs no velocity.
    #[schemars(skip)]
    pub velocity: Option<Located<Quantity<Velocity>>>,
}

/// How beams are joined: exactly one kind, with the points that it joins.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTable {
    /// What it leaves free.
    #[serde(rename = "type")]
    pub kind: Located<JointName>,
    /// A point.
    pub first: PointTable,
    /// The point to which it is joined; not of a slider.
    pub second: Option<PointTable>,
    /// Direction of a slider's line.
    pub along: Option<Located<Vector<Ratio>>>,
    /// Stage from whose start on it takes part; the first when left out.
    pub stage: Option<Located<String>>,
    /// Stage from whose start on it takes part no more; it stays to the end when left out.
    pub until: Option<Located<String>>,
}

/// The kinds of joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum JointName {
    /// The points coincide.
    Hinge,
    /// The points coincide and the angle between the beams is the one that they have at the start of the scene.
    Weld,
    /// The point moves along a line of the ground.
    Slider,
}

/// A point of a beam.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointTable {
    /// Name of the beam.
    pub beam: Located<String>,
    /// Which point of it.
    pub at: Located<At>,
}
