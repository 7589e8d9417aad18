//! Physics: one file per effect, with its densities at a point of the beam and the [`Part`] by
//! which a model contains it.
//!
//! A part says where on the beams its densities are summed; [`assembly`](crate::assembly) sums
//! them. An effect does not know nodes, steps or other effects.

mod actuation;
mod bend;
mod contact;
mod coupling;
mod damping;
mod direction;
mod drag;
mod elastic;
mod electrostatic;
mod field;
mod force;
mod foundation;
mod gravity;
mod inertia;
mod mass;
mod moment;
mod moving;
mod spring;
mod stretch;
mod tendon;

pub use actuation::{Actuation, PreCurvature, PreStrain};
pub use bend::{BeamBend, Bend, curvature};
pub use contact::{Contact, ContactIntegral, Friction, FrictionIntegral, Obstacle, Penalty};
pub use coupling::{BeamCoupling, Coupling, CouplingDamping};
pub use damping::{BeamDamping, BendDamping, MassDamping, StretchDamping};
pub use direction::Direction;
pub use drag::{Buoyancy, Drag, DragForce, SteadyDrag};
pub use elastic::{BendByLaw, StretchByLaw};
pub use electrostatic::{Electrostatic, Plate};
pub use field::{Components, Field, ForceField, Potential};
pub use force::{DeadForce, DistributedForce, FollowerForce, Force};
pub use foundation::Foundation;
pub use gravity::Gravity;
pub use inertia::{BeamInertia, Inertia};
pub use mass::{Gyration, PointMass, RotaryInertia, SectionInertia};
pub use moment::{Couple, Moment};
pub use moving::{MovingForce, Travelling};
pub use spring::{Dashpot, GroundSpring, Spring, Strut, Torsion, TorsionDashpot, TorsionSpring};
pub use stretch::{BeamStretch, Engineering, Green, Strain, Stretch};
pub use tendon::{Detour, Tendon};

use crate::assembly::Part;

/// The parts that follow from the section of beam number `beam` alone.
pub(crate) fn of_section(beam: usize) -> [Box<dyn Part>; 4] {
    [
        Box::new(BeamStretch { beam }),
        Box::new(BeamBend { beam }),
        Box::new(BeamCoupling { beam }),
        Box::new(BeamInertia { beam }),
    ]
}
