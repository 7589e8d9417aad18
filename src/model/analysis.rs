//! Analyses and their settings.

use super::EventCondition;
use std::fmt;

/// An analysis of a model.
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
    /// Analyses one after the other, each with a model of its own ([`Stage`](super::Stage)).
    Stages,
}

impl Analysis {
    /// Its name in a scene.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Static(_) => "static",
            Self::Dynamic(_) => "dynamic",
            Self::Buckling(_) => "buckling",
            Self::Modal(_) => "modal",
            Self::Stages => "stages",
        }
    }
}

/// Settings of a buckling analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Buckling {
    /// Number of critical loads wanted.
    pub count: usize,
}

/// Settings of a modal analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modal {
    /// Number of vibrations wanted, including motions without resistance (0 Hz).
    pub count: usize,
    /// The state about which the vibrations are small.
    pub about: About,
}

/// The state about which vibrations are small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum About {
    /// The stress-free state, without loads.
    #[default]
    Reference,
    /// The equilibrium under all loads and prescribed displacements.
    Equilibrium,
}

/// Settings of a static analysis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Static {
    /// Number of equal steps of the load factor after each of which a state is recorded. `None`:
    /// chosen by the solver.
    pub steps: Option<usize>,
    /// Relative accuracy of every equilibrium, as the size of the last increment per beam length.
    /// `None`: the solver's default.
    pub tolerance: Option<f64>,
    /// Largest step of the load factor. `None`: as large as the solver can take, and
    /// [`FRICTION_STEP`](Self::FRICTION_STEP) where there is friction, whose forces depend on the path.
    pub max_step: Option<f64>,
    /// Whether, and how, to follow the path by arc length, through limit points. `None`: by load
    /// steps.
    pub arc_length: Option<ArcLength>,
}

impl Static {
    /// Largest step of the load factor with friction, where none is given, and largest step along a path in beam lengths.
    pub const FRICTION_STEP: f64 = 0.02;

    /// The largest step, of the load factor or in beam lengths along a path, of a model with friction or without; infinite
    /// where there is none.
    pub fn largest_step(&self, friction: bool) -> f64 {
        let given = match &self.arc_length {
            Some(arc) => arc.max_step,
            None => self.max_step,
        };
        given.unwrap_or(if friction { Self::FRICTION_STEP } else { f64::INFINITY })
    }
}

/// Settings of arc-length continuation.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcLength {
    /// Stop where the load factor first reaches this value; the path to one below zero begins with loads that are turned round.
    pub until_load: Option<f64>,
    /// Stop after this many points on the path.
    pub max_points: usize,
    /// Longest step along the path, as a fraction of the beam's length; a change of the load factor by 1, or by `until_load` where that
    /// is larger, counts as a length.
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
    /// The value \[m\].
    pub value: f64,
}

/// Settings of a dynamic analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamic {
    /// Simulated time \[s\], counted from time zero or from the time of a saved state.
    pub duration: f64,
    /// Time between records \[s\].
    pub output_every: f64,
    /// The method of time integration.
    pub integrator: Integrator,
    /// Events to detect.
    pub events: Vec<EventCondition>,
}

/// A method of time integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Integrator {
    /// Chung and Hulbert's generalised-α method.
    GeneralizedAlpha {
        /// Choice of the steps.
        step: StepControl,
        /// Spectral radius at infinite frequency, from 0 to 1.
        spectral_radius: f64,
        /// Error of positions, in beam lengths, that the iterations may leave in a step of fixed
        /// length.
        newton_tolerance: f64,
    },
    /// Gauss collocation, of order 2 `stages`.
    Gauss {
        /// Number of stages: 1, 2 or 3.
        stages: usize,
        /// Choice of the steps.
        step: StepControl,
    },
    /// Radau IIA collocation, of order 2 `stages` − 1.
    Radau {
        /// Number of stages: 2 or 3.
        stages: usize,
        /// Choice of the steps.
        step: StepControl,
    },
}

impl Integrator {
    /// Default Newton tolerance of generalised-α: the errors of a thousand steps add up to 1e-8 at
    /// most.
    pub const NEWTON_TOLERANCE: f64 = 1e-11;

    /// The default method: Radau IIA collocation with three stages. It damps vibrations that are
    /// too fast to be resolved, suits every model, and needed fewer iterations than Gauss methods
    /// for the same error in the motions of the test suite.
    pub fn usual(step: StepControl) -> Self {
        Self::Radau { stages: 3, step }
    }

    /// Checks that the method can integrate the model.
    ///
    /// # Errors
    /// [`Undamped`] if it cannot.
    pub fn suits(&self, model: &super::Model) -> Result<(), Undamped> {
        let damps = match self {
            Self::GeneralizedAlpha { spectral_radius, .. } => *spectral_radius < 1.0,
            Self::Gauss { .. } => false,
            Self::Radau { .. } => true,
        };
        if damps || !model.is_inextensible() { Ok(()) } else { Err(Undamped { integrator: *self }) }
    }

    /// The same method with another choice of steps.
    #[must_use]
    pub fn with_step(mut self, control: StepControl) -> Self {
        match &mut self {
            Self::GeneralizedAlpha { step, .. } | Self::Gauss { step, .. } | Self::Radau { step, .. } => {
                *step = control;
            }
        }
        self
    }

    /// The choice of steps.
    pub fn step_control(&self) -> StepControl {
        match *self {
            Self::GeneralizedAlpha { step, .. } | Self::Gauss { step, .. } | Self::Radau { step, .. } => step,
        }
    }
}

/// The method has no damping at infinite frequency, which an inextensible beam needs: an error of
/// the axial force would be carried from step to step, and grow.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{integrator}: the error that it makes in the axial force of an inextensible beam would grow")]
pub struct Undamped {
    /// The method.
    pub integrator: Integrator,
}

impl Undamped {
    /// Alternatives, for messages.
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

/// The choice of an integrator's steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// Equal steps of this length \[s\].
    Fixed(f64),
    /// Steps as long as this relative accuracy allows.
    Tolerance(f64),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Beam, Discretization, Model, Section};

    #[test]
    fn integrators_say_what_they_are_and_keep_it_with_another_step() {
        let step = StepControl::Fixed(0.25);
        let alpha = |spectral_radius: f64| Integrator::GeneralizedAlpha {
            step,
            spectral_radius,
            newton_tolerance: Integrator::NEWTON_TOLERANCE,
        };
        let tolerance = StepControl::Tolerance(1e-5);
        for (integrator, said) in [
            (alpha(0.9), "generalised-α (ρ∞ = 0.9), step 0.25 s"),
            (Integrator::Gauss { stages: 2, step }, "Gauss collocation (2 stages), step 0.25 s"),
            (Integrator::usual(step), "Radau IIA collocation (3 stages), step 0.25 s"),
        ] {
            assert_eq!((integrator.to_string().as_str(), integrator.step_control()), (said, step));
            let other = integrator.with_step(tolerance);
            assert_eq!(other.to_string(), said.replace("step 0.25 s", "tolerance 1e-5"));
            assert_eq!(other.with_step(step), integrator);
        }
        // Where one beam of several keeps its length, only methods that damp suit.
        let soft = Section::new(1.0, 1.0);
        let rod = Section { axial_stiffness: None, ..soft.clone() };
        let beam = |section| Beam::line("rod", [0.0, 0.0], [1.0, 0.0], section, Discretization::ancf(1));
        let extensible = Model { beams: vec![beam(soft.clone())], ..Model::default() };
        let one = Model { beams: vec![beam(soft), beam(rod)], ..Model::default() };
        assert!(one.is_inextensible() && !extensible.is_inextensible());
        let gauss = Integrator::Gauss { stages: 3, step };
        assert!([alpha(1.0), gauss, alpha(0.99)].iter().all(|method| method.suits(&extensible).is_ok()));
        assert!([Integrator::usual(step), alpha(0.99)].iter().all(|method| method.suits(&one).is_ok()));
        assert_eq!(gauss.suits(&one), Err(Undamped { integrator: gauss }));
        assert_eq!(alpha(1.0).suits(&one), Err(Undamped { integrator: alpha(1.0) }));
    }

    #[test]
    fn analyses_have_the_names_of_their_keys() {
        let analyses = [
            Analysis::Static(Static::default()),
            Analysis::Buckling(Buckling { count: 1 }),
            Analysis::Modal(Modal { count: 1, about: About::Reference }),
            Analysis::Stages,
        ];
        assert_eq!(analyses.map(|analysis| analysis.kind()), ["static", "buckling", "modal", "stages"]);
    }
}
