//! What is to be computed, and how.

use std::fmt;

/// What is to be computed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Analysis {
    /// Equilibrium under the full loads.
    Static(Static),
    /// Motion in time.
    Dynamic(Dynamic),
    /// Load factors at which the straight path becomes unstable.
    Buckling(Buckling),
    /// Natural frequencies and mode shapes.
    Modal(Modal),
}

/// Settings of a buckling analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Buckling {
    /// How many critical loads are wanted.
    pub count: usize,
}

/// Settings of a modal analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modal {
    /// How many vibrations are wanted, motions without resistance (0 Hz) included.
    pub count: usize,
    /// The state about which they are small.
    pub about: About,
}

/// The state about which vibrations are small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum About {
    /// The stress-free one, without loads.
    #[default]
    Reference,
    /// The equilibrium under all loads and prescribed displacements.
    Equilibrium,
}

/// Settings of a static analysis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Static {
    /// Load factors at which states are recorded: this many equal parts. `None`: chosen by the
    /// solver.
    pub steps: Option<usize>,
    /// Relative accuracy of every equilibrium, in increments per length. `None`: the solver's
    /// default.
    pub tolerance: Option<f64>,
    /// Follow the path by arc length, through limit points.
    pub arc_length: Option<ArcLength>,
}

/// Settings of arc-length continuation.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcLength {
    /// Stop where the load factor first reaches this value.
    pub until_load: Option<f64>,
    /// Stop after this many points on the path.
    pub max_points: usize,
    /// Longest step along the path, as a fraction of the beam's length.
    pub max_step: Option<f64>,
    /// Stop where a probe's coordinate first reaches a value.
    pub until_probe: Option<ProbeTarget>,
}

/// A value of a probe's coordinate that ends a path.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbeTarget {
    /// Name of the probe.
    pub probe: String,
    /// 0 for x, 1 for y.
    pub axis: usize,
    /// \[m\].
    pub value: f64,
}

/// Settings of a dynamic analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamic {
    /// Simulated time \[s\], from time zero or from that of a saved state on.
    pub duration: f64,
    /// Time between records \[s\].
    pub output_every: f64,
    /// How time advances.
    pub integrator: Integrator,
    /// What to watch for.
    pub events: Vec<EventCondition>,
}

/// A probe's coordinate reaches a value from one side, also where it turns back there.
#[derive(Clone, Debug, PartialEq)]
pub struct EventCondition {
    /// Which, and which value.
    pub target: ProbeTarget,
    /// Which way.
    pub crossing: Crossing,
    /// Whether the motion ends there.
    pub stop: bool,
}

/// The way in which a value is crossed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crossing {
    /// Either way.
    #[default]
    Any,
    /// From below.
    Rising,
    /// From above.
    Falling,
}

/// A method of time integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Integrator {
    /// Chung and Hulbert's generalised-α method.
    GeneralizedAlpha {
        /// How steps are chosen.
        step: StepControl,
        /// Spectral radius at infinite frequency, from 0 to 1.
        spectral_radius: f64,
        /// Error of positions, in beam lengths, that the iteration of a step of fixed length may
        /// leave.
        newton_tolerance: f64,
    },
    /// Gauss collocation, of order 2 `stages`.
    Gauss {
        /// 1, 2 or 3.
        stages: usize,
        /// How steps are chosen.
        step: StepControl,
    },
    /// Radau IIA collocation, of order 2 `stages` − 1.
    Radau {
        /// 2 or 3.
        stages: usize,
        /// How steps are chosen.
        step: StepControl,
    },
}

impl Integrator {
    /// Newton tolerance of generalised-α where nothing is said: a thousand steps then add up to
    /// less than 1e-8.
    pub const NEWTON_TOLERANCE: f64 = 1e-11;

    /// The method where nothing is said: Radau IIA collocation with three stages. It damps what is
    /// too fast to be followed, suits every model, and over the motions of the suite with a
    /// tolerance it took fewer iterations than Gauss' methods for the same error.
    pub fn usual(step: StepControl) -> Self {
        Self::Radau { stages: 3, step }
    }

    /// Checks that the method can do with the model.
    ///
    /// # Errors
    /// [`Undamped`].
    pub fn suits(&self, model: &super::Model) -> Result<(), Undamped> {
        let damps = match self {
            Self::GeneralizedAlpha { spectral_radius, .. } => *spectral_radius < 1.0,
            Self::Gauss { .. } => false,
            Self::Radau { .. } => true,
        };
        if damps || !model.is_inextensible() { Ok(()) } else { Err(Undamped { integrator: *self }) }
    }

    /// The same method with other steps.
    #[must_use]
    pub fn with_step(mut self, control: StepControl) -> Self {
        match &mut self {
            Self::GeneralizedAlpha { step, .. } | Self::Gauss { step, .. } | Self::Radau { step, .. } => {
                *step = control;
            }
        }
        self
    }

    /// How steps are chosen.
    pub fn step_control(&self) -> StepControl {
        match *self {
            Self::GeneralizedAlpha { step, .. } | Self::Gauss { step, .. } | Self::Radau { step, .. } => step,
        }
    }
}

/// A method without damping at infinite frequency, and a beam that is inextensible: an error of its
/// axial force would be carried on from step to step, and grow.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{integrator}: the error that it makes in the axial force of an inextensible beam would grow")]
pub struct Undamped {
    /// The method.
    pub integrator: Integrator,
}

impl Undamped {
    /// What to try.
    pub const HELP: &str = "use `radau`, or `generalized_alpha` with a `spectral_radius` below 1; or give the beam an `axial_stiffness`";
}

impl fmt::Display for StepControl {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(step) => write!(f, "step {step} s"),
            Self::Tolerance(tolerance) => write!(f, "tolerance {tolerance:e}"),
        }
    }
}

impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let step = self.step_control();
        match self {
            Self::GeneralizedAlpha { spectral_radius, .. } => {
                write!(f, "generalised-α (ρ∞ = {spectral_radius}), {step}")
            }
            Self::Gauss { stages, .. } => write!(f, "Gauss collocation ({stages} stages), {step}"),
            Self::Radau { stages, .. } => write!(f, "Radau IIA collocation ({stages} stages), {step}"),
        }
    }
}

/// How the steps of an integrator are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// All alike \[s\].
    Fixed(f64),
    /// As long as this relative accuracy allows.
    Tolerance(f64),
}
