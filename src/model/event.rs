//! Events of motions: what a quantity at a probe has to do.

/// The event that a quantity at a probe reaches a value, or turns back.
#[derive(Clone, Debug, PartialEq)]
pub struct EventCondition {
    /// Name of the probe.
    pub probe: String,
    /// What is watched there.
    pub quantity: ProbeQuantity,
    /// What it has to do.
    pub when: EventKind,
    /// Whether the simulation ends at the event.
    pub stop: bool,
}

/// What has to happen to a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// It reaches a value, even if it turns back there.
    Reaches {
        /// The value, in SI units.
        value: f64,
        /// The direction in which it is reached.
        crossing: Crossing,
    },
    /// It has risen and begins to fall.
    Maximum,
    /// It has fallen and begins to rise.
    Minimum,
}

/// A quantity at a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeQuantity {
    /// Position along x \[m\].
    X,
    /// Position along y \[m\].
    Y,
    /// Direction of r', with full turns \[rad\].
    Angle,
    /// Velocity along x \[m/s\].
    Vx,
    /// Velocity along y \[m/s\].
    Vy,
    /// Magnitude of the velocity \[m/s\].
    Speed,
    /// Axial strain.
    Strain,
    /// Curvature \[1/m\].
    Curvature,
    /// Axial force \[N\].
    AxialForce,
    /// Shear force \[N\].
    ShearForce,
    /// Bending moment \[N m\].
    BendingMoment,
    /// Stress on the right face \[Pa\].
    StressBottom,
    /// Stress on the left face \[Pa\].
    StressTop,
}

impl ProbeQuantity {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::X,
        Self::Y,
        Self::Angle,
        Self::Vx,
        Self::Vy,
        Self::Speed,
        Self::Strain,
        Self::Curvature,
        Self::AxialForce,
        Self::ShearForce,
        Self::BendingMoment,
        Self::StressBottom,
        Self::StressTop,
    ];

    /// Its name in a scene and in results, and its unit.
    pub fn name(self) -> (&'static str, &'static str) {
        match self {
            Self::X => ("x", "m"),
            Self::Y => ("y", "m"),
            Self::Angle => ("angle", "rad"),
            Self::Vx => ("vx", "m/s"),
            Self::Vy => ("vy", "m/s"),
            Self::Speed => ("speed", "m/s"),
            Self::Strain => ("strain", ""),
            Self::Curvature => ("curvature", "1/m"),
            Self::AxialForce => ("axial_force", "N"),
            Self::ShearForce => ("shear_force", "N"),
            Self::BendingMoment => ("bending_moment", "N m"),
            Self::StressBottom => ("stress_bottom", "Pa"),
            Self::StressTop => ("stress_top", "Pa"),
        }
    }
}

/// The direction in which a value is crossed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crossing {
    /// Either direction.
    #[default]
    Any,
    /// From below.
    Rising,
    /// From above.
    Falling,
}
