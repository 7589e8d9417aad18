//! The kinds of effects, for energies and inventories.

/// Makes the enumeration, the list of its variants and their names from one list.
macro_rules! kinds {
    ($($(#[$doc:meta])* $variant:ident = $name:literal,)*) => {
        /// The kind of an effect, for energies and inventories.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Kind {
            $($(#[$doc])* $variant,)*
            /// An effect that no scene has a word for, such as one of another crate.
            Other(&'static str),
        }

        impl Kind {
            /// All kinds defined in this crate.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The name used in scenes and inventories.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                    Self::Other(name) => name,
                }
            }
        }
    };
}

kinds! {
    /// Axial strain energy.
    Stretch = "stretch",
    /// Constraint by which a beam keeps its length.
    Inextensibility = "inextensibility",
    /// Bending strain energy.
    Bend = "bend",
    /// Energy by which stretch and bending of a section are coupled.
    Coupling = "coupling",
    /// Kinetic energy of the centreline.
    Inertia = "inertia",
    /// Weight.
    Gravity = "gravity",
    /// Concentrated force.
    Force = "force",
    /// Concentrated moment.
    Moment = "moment",
    /// Force per length.
    DistributedForce = "distributed_force",
    /// Damping of a beam's motion and deformation.
    Damping = "damping",
    /// Spring to the ground.
    Spring = "spring",
    /// Dashpot to the ground.
    Dashpot = "dashpot",
    /// Torsional spring to the ground.
    TorsionSpring = "torsion_spring",
    /// Torsional dashpot to the ground.
    TorsionDashpot = "torsion_dashpot",
    /// Mass at a point.
    PointMass = "point_mass",
    /// Rotary inertia of a point or of sections.
    RotaryInertia = "rotary_inertia",
    /// Elastic foundation.
    Foundation = "foundation",
    /// Strain imposed on a beam by actuation.
    PreStrain = "pre_strain",
    /// Curvature imposed on a beam by actuation.
    PreCurvature = "pre_curvature",
    /// Pull of a tendon.
    Tendon = "tendon",
    /// Resistance of a fluid.
    Drag = "drag",
    /// Lift by a displaced fluid.
    Buoyancy = "buoyancy",
    /// Attraction by an electrode.
    Electrostatic = "electrostatic",
    /// Force that depends on the place.
    ForceField = "force_field",
    /// Contact with an obstacle.
    Contact = "contact",
    /// Friction in a contact.
    Friction = "friction",
    /// Force that travels along a beam.
    MovingForce = "moving_force",
}

impl Kind {
    /// Whether its energy is the same wherever a beam is moved as a rigid body, so that it acts on
    /// no piece of it as a whole.
    pub(crate) fn is_of_shape_alone(self) -> bool {
        matches!(self, Self::Stretch | Self::Bend | Self::Coupling | Self::PreStrain | Self::PreCurvature)
    }
}

impl serde::Serialize for Kind {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
