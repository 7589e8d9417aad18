//! What the numbers of a scene mean: by which units they are measured, and what becomes of them
//! when the scene is turned or mirrored.
//!
//! A key that is missing here would keep its number in every frame, and the exact ways would
//! disagree at once: the table is tested by every scene that is drawn.

/// Powers of length, mass and time.
pub type Dimension = [i32; 3];

/// The nature of a number, or of a list of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nature {
    /// Unchanged where the scene is turned or mirrored.
    Scalar(Dimension),
    /// Changes its sign in a mirror: what turns counter-clockwise.
    Turning(Dimension),
    /// Two components in the fixed frame.
    Vector(Dimension),
    /// A place of the plane, or a list of such.
    Point,
    /// An angle from the x axis.
    Polar,
    /// Coefficients of 1, t, t², …
    Polynomial,
    /// A number whose square has this dimension: voltages, whose unit the permittivity leaves open.
    Root(Dimension),
    /// A formula of the time, without a dimension.
    OfTime,
    /// A formula of the place with this dimension.
    OfPlace(Dimension),
    /// Formulas of the place for both components in the fixed frame.
    VectorOfPlace(Dimension),
}

const NUMBER: Dimension = [0, 0, 0];
const LENGTH: Dimension = [1, 0, 0];
const MASS: Dimension = [0, 1, 0];
const TIME: Dimension = [0, 0, 1];
const RATE: Dimension = [0, 0, -1];
const VELOCITY: Dimension = [1, 0, -1];
const FORCE: Dimension = [1, 1, -2];
const MOMENT: Dimension = [2, 1, -2];
const FORCE_PER_LENGTH: Dimension = [0, 1, -2];
const STRESS: Dimension = [-1, 1, -2];
const MASS_PER_LENGTH: Dimension = [-1, 1, 0];

/// The nature of the key at a path without list indices, with `*` for the names of beams; none if
/// it is not a quantity, or holds tables.
pub fn nature(path: &str) -> Option<Nature> {
    use Nature::{OfPlace, OfTime, Point, Polar, Polynomial, Root, Scalar, Turning, Vector, VectorOfPlace};
    if let Some((_, mut law)) = path.split_once(".in_time.") {
        while let Some(inner) = law.strip_prefix("sum.").or_else(|| law.strip_prefix("product.")) {
            law = inner;
        }
        return Some(match law {
            "expression" | "expression.of" => OfTime,
            "expression.kinks" => Scalar(TIME),
            "ramp.start" | "ramp.duration" | "smooth_ramp.start" | "smooth_ramp.duration" | "step.start" => {
                Scalar(TIME)
            }
            "table.times" => Scalar(TIME),
            "harmonic.frequency" => Scalar(RATE),
            "polynomial" => Polynomial,
            _ => return None,
        });
    }
    Some(match path {
        "beam.*.start" | "beam.*.end" | "beam.*.points" | "beam.*.arc.center" => Point,
        "beam.*.initial_shape.line.start" | "beam.*.initial_shape.line.end" => Point,
        "beam.*.initial_shape.points" | "beam.*.initial_shape.arc.center" => Point,
        "beam.*.initial_shape.arc.radius" => Scalar(LENGTH),
        "beam.*.initial_shape.arc.from" | "beam.*.initial_shape.arc.to" => Polar,
        "beam.*.axial_law.force" => Scalar(FORCE),
        "beam.*.bending_law.curvature" => Turning([-1, 0, 0]),
        "beam.*.bending_law.moment" => Turning(MOMENT),
        "effect.electrostatic.voltage" => Root(FORCE),
        "effect.electrostatic.width" | "effect.electrostatic.half_thickness" => Scalar(LENGTH),
        "effect.electrostatic.electrode.point" => Point,
        "effect.electrostatic.electrode.normal" => Vector(NUMBER),
        "effect.force_field.potential" => OfPlace(FORCE),
        "effect.force_field.value" => VectorOfPlace(FORCE_PER_LENGTH),
        "beam.*.arc.radius" | "beam.*.basis.ancf.nodes" | "beam.*.basis.rpim.nodes" => Scalar(LENGTH),
        "beam.*.arc.from" | "beam.*.arc.to" => Polar,
        "beam.*.youngs_modulus" => Scalar(STRESS),
        "beam.*.area" => Scalar([2, 0, 0]),
        "beam.*.second_moment" => Scalar([4, 0, 0]),
        "beam.*.density" => Scalar([-3, 1, 0]),
        "beam.*.axial_stiffness" => Scalar(FORCE),
        "beam.*.bending_stiffness" => Scalar([3, 1, -2]),
        "beam.*.mass_per_length" => Scalar(MASS_PER_LENGTH),
        "beam.*.section.layers.youngs_modulus" => Scalar(STRESS),
        "beam.*.section.layers.density" => Scalar([-3, 1, 0]),
        "beam.*.section.layers.offset" => Turning(LENGTH),
        _ if path.starts_with("beam.*.section.") && path.split('.').count() == 5 => Scalar(LENGTH),
        "support.move.angle" => Turning(NUMBER),
        "support.move.spin_up.speed" | "initial_velocity.rotation" => Turning(RATE),
        "support.move.spin_up.start" | "support.move.spin_up.duration" => Scalar(TIME),
        "joint.along" | "effect.contact.half_plane.normal" => Vector(NUMBER),
        "effect.force.value" | "effect.moving_force.value" => Vector(FORCE),
        "effect.moment.value" => Turning(MOMENT),
        "effect.distributed_force.value" => Vector(FORCE_PER_LENGTH),
        "effect.gravity.acceleration" => Vector([1, 0, -2]),
        "effect.damping.mass_proportional" => Scalar(RATE),
        "effect.damping.stiffness_proportional" | "effect.damping.strain" | "effect.damping.curvature" => {
            Scalar(TIME)
        }
        "effect.spring.anchor" | "effect.contact.circle.center" | "effect.contact.box.center" => Point,
        "effect.contact.half_plane.point" | "initial_velocity.about" => Point,
        "effect.spring.length" | "effect.moving_force.start" | "effect.contact.half_thickness" => {
            Scalar(LENGTH)
        }
        "effect.contact.circle.radius" | "effect.contact.box.size" | "initial_velocity.table.s" => {
            Scalar(LENGTH)
        }
        "effect.contact.box.angle" => Polar,
        "effect.spring.stiffness" => Scalar(FORCE_PER_LENGTH),
        "effect.spring.damping" => Scalar([0, 1, -1]),
        "effect.torsion_spring.stiffness" => Scalar(MOMENT),
        "effect.torsion_spring.damping" => Scalar([2, 1, -1]),
        "effect.point_mass.mass" => Scalar(MASS),
        "effect.point_mass.rotary_inertia" => Scalar([2, 1, 0]),
        "effect.rotary_inertia.per_length" => Scalar([1, 1, 0]),
        "effect.foundation.stiffness" | "effect.contact.stiffness" | "effect.contact.friction.stiffness" => {
            Scalar(STRESS)
        }
        "effect.tendon.offset" => Turning(LENGTH),
        "effect.tendon.tension" => Scalar(FORCE),
        "effect.tendon.length" | "effect.tendon.shortening" => Scalar(LENGTH),
        "effect.actuation.strain" => Scalar(NUMBER),
        "effect.actuation.curvature" => Turning([-1, 0, 0]),
        "effect.drag.normal" | "effect.drag.tangential" => Scalar([-2, 1, 0]),
        "effect.drag.viscous_normal" | "effect.drag.viscous_tangential" => Scalar([-1, 1, -1]),
        "effect.drag.flow" | "initial_velocity.value" => Vector(VELOCITY),
        "effect.buoyancy.displaced_mass_per_length" => Scalar(MASS_PER_LENGTH),
        "effect.moving_force.speed" => Scalar(VELOCITY),
        "analysis.dynamic.duration" | "analysis.dynamic.output_every" => Scalar(TIME),
        _ if path.starts_with("analysis.dynamic.") && path.ends_with(".step") => Scalar(TIME),
        _ if path.ends_with(".at") => Scalar(LENGTH),
        _ if path.starts_with("effect.") && (path.ends_with(".from") || path.ends_with(".to")) => {
            Scalar(LENGTH)
        }
        _ => return None,
    })
}

/// What becomes of a value that an event watches at a probe: its dimension, and whether a mirror
/// changes its sign.
pub fn watched(quantity: &str) -> Option<(Dimension, bool)> {
    Some(match quantity {
        "speed" => (VELOCITY, false),
        "strain" => (NUMBER, false),
        "axial_force" => (FORCE, false),
        "stress_bottom" | "stress_top" => (STRESS, false),
        "curvature" => ([-1, 0, 0], true),
        "shear_force" => (FORCE, true),
        "bending_moment" => (MOMENT, true),
        "angle" => (NUMBER, true),
        _ => return None,
    })
}

/// Describes tables with one key for each axis: the keys, the dimension, and whether they are
/// places rather than differences.
pub fn axes(path: &str) -> Option<([&'static str; 2], Dimension, bool)> {
    match path {
        "support.move" => Some((["x", "y"], LENGTH, false)),
        "analysis.static.arc_length.until_probe" => Some((["x", "y"], LENGTH, true)),
        "initial_velocity.polynomial" | "initial_velocity.table" => Some((["vx", "vy"], VELOCITY, false)),
        _ => None,
    }
}
