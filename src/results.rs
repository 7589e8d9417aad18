//! The results of an analysis: a [`Trajectory`] of statics and of motions, [`Vibrations`] or
//! [`CriticalLoads`]. Output and verification read nothing else.

mod estimate;
mod modes;
pub(crate) mod places;
mod shape;
mod trajectory;

pub use estimate::{BeamErrors, ErrorEstimate, Errors, EventErrors, LazyText, ProbeErrors, RunForError};
pub use modes::{BucklingMode, CriticalLoads, ModeShape, Vibration, Vibrations};
pub use shape::{Frame, LargestStress, LayerStress, Shape};
pub use trajectory::{
    BeamSections, EffectSeries, Event, ProbeSample, ProbeSeries, ReactionSeries, SectionForces,
    SectionSeries, Trajectory,
};

pub use crate::solve::{ContactImpulse, RecordedState, RecordedStates, Statistics, StepRecord, TakenUp};
pub use crate::system::{Energy, Reaction};

use serde::Serialize;

/// Number of centrelines that is enough for an animation.
pub const PICTURES: usize = 400;

/// The results of any analysis.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Results {
    /// Of statics and dynamics.
    Trajectory(Trajectory),
    /// Of a modal analysis.
    Vibrations(Vibrations),
    /// Of a buckling analysis.
    CriticalLoads(CriticalLoads),
}

impl Results {
    /// Information on the run as a whole.
    pub fn run(&self) -> &Run {
        &self.states().run
    }

    /// The computed states. Statics and dynamics: all records. Modal analysis: the equilibrium
    /// about which vibrations are small, without records if it is the stress-free state. Buckling:
    /// the state to which the critical loads belong, without records.
    pub fn states(&self) -> &Trajectory {
        match self {
            Self::Trajectory(trajectory) => trajectory,
            Self::Vibrations(vibrations) => &vibrations.equilibrium,
            Self::CriticalLoads(loads) => &loads.unloaded,
        }
    }

    /// As [`Self::states`].
    pub fn states_mut(&mut self) -> &mut Trajectory {
        match self {
            Self::Trajectory(trajectory) => trajectory,
            Self::Vibrations(vibrations) => &mut vibrations.equilibrium,
            Self::CriticalLoads(loads) => &mut loads.unloaded,
        }
    }

    /// As [`Self::run`].
    pub fn run_mut(&mut self) -> &mut Run {
        &mut self.states_mut().run
    }

    /// As [`Self::states`].
    pub fn into_states(self) -> Trajectory {
        match self {
            Self::Trajectory(trajectory) => trajectory,
            Self::Vibrations(vibrations) => vibrations.equilibrium,
            Self::CriticalLoads(loads) => loads.unloaded,
        }
    }

    /// Natural frequencies \[Hz\] or critical load factors, ascending; none of a trajectory.
    pub fn eigenvalues(&self) -> Vec<f64> {
        match self {
            Self::Trajectory(_) => Vec::new(),
            Self::Vibrations(vibrations) => vibrations.frequencies(),
            Self::CriticalLoads(loads) => loads.load_factors(),
        }
    }

    /// What round-off may change each of [`Self::eigenvalues`] by at most, relative to it.
    pub fn round_off(&self) -> Vec<f64> {
        match self {
            Self::Trajectory(_) => Vec::new(),
            Self::Vibrations(vibrations) => vibrations.modes.iter().map(|mode| mode.round_off).collect(),
            Self::CriticalLoads(loads) => loads.modes.iter().map(|mode| mode.round_off).collect(),
        }
    }

    /// The shapes that belong to [`Self::eigenvalues`], each of all beams.
    pub fn mode_shapes(&self) -> Vec<&[ModeShape]> {
        match self {
            Self::Trajectory(_) => Vec::new(),
            Self::Vibrations(vibrations) => vibrations.modes.iter().map(|mode| &mode.shape[..]).collect(),
            Self::CriticalLoads(loads) => loads.modes.iter().map(|mode| &mode.shape[..]).collect(),
        }
    }
}

impl From<Trajectory> for Results {
    fn from(trajectory: Trajectory) -> Self {
        Self::Trajectory(trajectory)
    }
}

impl From<Vibrations> for Results {
    fn from(vibrations: Vibrations) -> Self {
        Self::Vibrations(vibrations)
    }
}

impl From<CriticalLoads> for Results {
    fn from(loads: CriticalLoads) -> Self {
        Self::CriticalLoads(loads)
    }
}

/// Information that every analysis gives on itself.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Run {
    /// The scene's title.
    pub title: String,
    /// Kind of analysis.
    pub analysis: AnalysisKind,
    /// Whether it reached its end: not if the run was stopped or the computation failed.
    pub complete: bool,
    /// Unknowns after supports are eliminated, plus multipliers.
    pub degrees_of_freedom: usize,
    /// Lines for the reader: the simulated model and its settings (name, value).
    pub settings: Vec<(String, String)>,
    /// The stress-free shape of each beam.
    pub undeformed: Vec<Shape>,
    /// Lines of the ground that belong in a picture: borders of obstacles.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// Warnings for the user: instabilities met, with the load factor.
    pub warnings: Vec<String>,
    /// Whether a force field changes within cells by more than their points see, or a velocity at the start by more than they follow.
    #[serde(skip)]
    pub misses_fields: bool,
    /// The tensions at the end of the tendons whose lengths are given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tensions: Vec<Tension>,
    /// Counts of steps, iterations and factorisations.
    pub statistics: Statistics,
    /// Wall times of the parts of the run.
    pub seconds: Seconds,
    /// How wrong the results are, where that was asked for.
    #[serde(skip)]
    pub error: Option<Box<ErrorEstimate>>,
}

/// The tension of a tendon whose length is given.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tension {
    /// Name of its beam.
    pub beam: String,
    /// Its tension \[N\]; negative where it pushes, which no real tendon can.
    pub tension: f64,
}

/// The kind of an analysis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AnalysisKind {
    /// Equilibria; the parameter of the records is the load factor.
    #[default]
    Static,
    /// Motion; the parameter of the records is the time \[s\].
    Dynamic,
    /// Small vibrations; the parameter of the record is the load factor of the equilibrium.
    Modal,
    /// Critical loads; without records.
    Buckling,
}

/// Wall time \[s\].
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Shape functions, tables, patterns.
    pub build: f64,
    /// The solution itself.
    pub solve: f64,
    /// Evaluating the states (probes, shapes, frames), and writing the files up to the summary.
    pub write: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_results_has_states_and_only_modes_have_eigenvalues() {
        let states = || Trajectory { parameter: vec![0.25], ..Trajectory::default() };
        let shape = |beam: &str| vec![ModeShape { beam: beam.into(), ..ModeShape::default() }];
        let vibration =
            |frequency: f64, beam: &str| Vibration { frequency, round_off: 0.0, shape: shape(beam) };
        let load =
            |load_factor: f64, beam: &str| BucklingMode { load_factor, round_off: 0.0, shape: shape(beam) };
        let modes = vec![vibration(2.0, "a"), vibration(3.0, "b")];
        let loads = vec![load(4.0, "c"), load(5.0, "d")];
        for (results, values, beams) in [
            (Results::from(states()), vec![], vec![]),
            (Vibrations { equilibrium: states(), modes }.into(), vec![2.0, 3.0], vec!["a", "b"]),
            (CriticalLoads { unloaded: states(), modes: loads }.into(), vec![4.0, 5.0], vec!["c", "d"]),
        ] {
            let found: Vec<&str> = results.mode_shapes().iter().map(|shape| shape[0].beam.as_str()).collect();
            assert_eq!((results.eigenvalues(), found), (values, beams));
            assert_eq!(results.states().parameter, [0.25]);
            assert_eq!(results.into_states().parameter, [0.25]);
        }
    }

    #[test]
    fn events_of_every_kind_have_a_time_or_a_load_factor() {
        let probe = Event::Probe {
            time: 0.5,
            probe: "tip".into(),
            quantity: "x",
            value: 3.0,
            turns: None,
            rates: [0.0; 2],
        };
        let contact = Event::Contact { time: 0.75, contact: "arm.1".into(), touches: true, impulse: None };
        let lost = Event::Stability {
            load_factor: -0.25,
            stability: "lost",
            unstable_directions: None,
            resolution: 0.0,
        };
        assert_eq!([probe, contact, lost].map(|event| event.parameter()), [0.5, 0.75, -0.25]);
    }
}
