//! Why an analysis ended before its end, and what to try.

use super::Sampler;
use crate::assembly::{Kind, nodes};
use crate::linear::Singular;
use crate::model::{ArcLength, Dynamic, ProbeTarget, StepControl};
use crate::results::Trajectory;
use crate::run::RunError;
use crate::run::electrodes::pulled_in;
use crate::solve::dynamics;
use crate::solve::newton::Failure;
use crate::solve::path::NoStep;
use crate::solve::statics::{Solution, Unreached};

/// A load factor of next to nothing.
const NEXT_TO_NOTHING: f64 = 1e-3;
/// Part of the loads beyond which the round-off of internal forces prevents convergence.
const DROWNED: f64 = 1e-2;
/// Increments below this that do not vanish are round-off \[beam lengths\].
const STALLED: f64 = 1e-6;
/// What to try where a beam has no stiffness along its axis against what loads it.
const WITHOUT_BOUNDS: &str = "an `axial_law` resists tension only, or pressure only, and what loads the other way shortens or lengthens its beam \
                              without bounds: let loads strain it where the law has a stiffness, or give the law a small one on both sides";
/// What to try where a beam is crushed for another reason.
const TOO_SOFT: &str = "a beam is a model for small strains: use smaller loads, or a larger axial stiffness";
/// What to try where a beam is pushed through an obstacle.
const PUSHED_THROUGH: &str = "the obstacle gives way by more than half its thickness: give the contact a larger `stiffness`, or the obstacle a larger size";

fn incomplete(mut trajectory: Trajectory) -> Trajectory {
    trajectory.run.complete = false;
    trajectory
}

impl Sampler<'_> {
    /// Why there is no way on; `along_arc`, where a path was followed by arc length already.
    pub(in crate::run) fn stuck(&self, stuck: &NoStep, solution: &Solution, along_arc: bool) -> RunError {
        let (beam, s) = stuck.at;
        let pulled_in = self.pulled_in(solution.states.last().map(|(_, q)| &q[..]));
        let advice = match stuck.failure {
            _ if self.limited_by_round_off(&stuck.failure)
                && self.system.has_friction()
                && stuck.load < NEXT_TO_NOTHING =>
            {
                "a contact that sticks as it begins finds no first step, and shorter ones press it by round-off only: give a `max_step` of some thousandths, \
                 or friction a smaller `stiffness`"
            }
            _ if stuck.load == 0.0 && self.system.force_at_start(&[Kind::Contact]) > 0.0 => {
                "the structure begins inside an obstacle, which presses it before any load does: begin beside it, or let the obstacle \
                 be softer, or a beam come to it by a support that moves"
            }
            _ if self.limited_by_round_off(&stuck.failure) => {
                "double precision cannot resolve these loads: the stiffness is so large, or nodes are so close, that the \
                 round-off of positions alone makes forces of their size; use fewer nodes, even spacing, or an axial \
                 stiffness that is not far beyond EI/h² with the spacing h"
            }
            Failure::Singular(Singular { row }) if row >= self.system.coordinates() => {
                "supports between nodes hold the same motion more than once: leave some out, or use more nodes"
            }
            Failure::Crossed { .. } => PUSHED_THROUGH,
            Failure::Crushed { .. } if self.system.goes_slack() => WITHOUT_BOUNDS,
            _ if self.system.goes_slack() && stuck.load < NEXT_TO_NOTHING => WITHOUT_BOUNDS,
            Failure::Crushed { .. } => TOO_SOFT,
            _ if self.system.is_fading() => {
                "what held the state with which this analysis starts and has gone fades on the way, inertia of a motion, supports, joints, springs, \
                 tendons and everything of another file as forces of fixed directions and couples: let it go in a `[[stage]]` of one file, \
                 where loads and tendons fade as they are; or in a damped motion, which passes states that are unstable and stops by itself"
            }
            _ if self.system.is_floppy() => {
                "strings and beams on hinges come to rest where loads of fixed direction hold them: let such a load act on all \
                 that can move, add a support, or begin nearer to the equilibrium"
            }
            Failure::NotFinite if stuck.step == 0.0 => {
                "a load or a stiffness is no number, or beyond what its products leave room for: use other units"
            }
            _ if stuck.step == 0.0 => {
                "the undeformed structure can move without resistance: add a support, or give the beam a bending stiffness"
            }
            _ if along_arc => {
                "no step along the path converges from here: where the load is far beyond what the structure carries, give less of it, or a \
                 smaller `max_step`; if the shape is folded there, use more nodes"
            }
            _ => {
                "near a limit point the load cannot grow: follow the path with `arc_length` in [analysis.static]; \
                 if the shape is folded there, use more nodes or smaller loads"
            }
        };
        RunError::NoEquilibrium {
            load: stuck.load,
            step: stuck.step,
            cause: stuck.failure.to_string(),
            beam: self.model.beams.get(beam).map(|b| b.name.clone()).unwrap_or_default(),
            s,
            advice: pulled_in.unwrap_or_else(|| advice.into()),
            partial: Box::new(incomplete(self.statics(solution))),
        }
    }

    /// The error of a path that has not reached its target.
    pub(in crate::run) fn unreached(&self, why: Unreached, arc: &ArcLength, solution: &Solution) -> RunError {
        let load = arc.until_load.map(|load| format!("load factor {load}"));
        let probe = arc.until_probe.as_ref().map(|ProbeTarget { probe, axis, value }| {
            format!("{} = {value} m of probe `{probe}`", if *axis == 0 { "x" } else { "y" })
        });
        let target = load.into_iter().chain(probe).collect::<Vec<_>>().join(" or ");
        let target = if target.is_empty() { format!("its {} points", arc.max_points) } else { target };
        let load = solution.states.last().map_or(0.0, |(load, _)| *load);
        let partial = Box::new(incomplete(self.statics(solution)));
        match why {
            Unreached::OutOfPoints => RunError::OutOfPoints { points: arc.max_points, load, target, partial },
            Unreached::NothingGrows => RunError::NothingGrows { target, partial },
            Unreached::NothingMoves => RunError::NothingMoves { load, target, partial },
        }
    }

    pub(in crate::run) fn lost(
        &self,
        settings: &Dynamic,
        stuck: &dynamics::NoStep,
        solution: dynamics::Solution,
    ) -> RunError {
        let (beam, s) = stuck.at;
        let pulled_in = self.pulled_in(solution.states.last().map(|state| &state.q[..]));
        let advice = match settings.integrator.step_control() {
            _ if matches!(stuck.failure, Failure::Crushed { .. }) => TOO_SOFT,
            _ if matches!(stuck.failure, Failure::Crossed { .. }) => PUSHED_THROUGH,
            _ if stuck.failure == Failure::NotFinite && stuck.step == 0.0 => {
                "a velocity, a load or a stiffness is beyond what its products leave room for: start from another state, or use other units"
            }
            _ if stuck.failure == Failure::StepsErr => {
                "the tolerance is below the round-off of these positions, or the motion jumps here: give a larger `tolerance`"
            }
            StepControl::Fixed(_) => {
                "give `tolerance` instead of `step`, so that steps are as short as the motion needs them; a smaller `step`; \
                 or more nodes where the beam bends most"
            }
            StepControl::Tolerance(_) => {
                "the motion has no continuation that the beam model can follow: look at the states until here, and use more \
                 nodes or softer loads if the beam folds"
            }
        };
        RunError::NoStep {
            time: stuck.time,
            step: stuck.step,
            cause: stuck.failure.to_string(),
            beam: self.model.beams.get(beam).map(|b| b.name.clone()).unwrap_or_default(),
            s,
            advice: pulled_in.unwrap_or_else(|| advice.into()),
            partial: Box::new(incomplete(self.dynamics(settings, solution))),
        }
    }

    /// Whether increments are small but do not vanish, or the round-off of internal forces compares
    /// with the loads, so that there is nothing to converge to.
    fn limited_by_round_off(&self, failure: &Failure) -> bool {
        let mut loads = vec![0.0; self.system.coordinates()];
        self.system.add_load_rate(1.0, 0.0, self.system.reference(), &mut loads);
        let length = self.system.length();
        let total: f64 = nodes(&loads).map(|f| f.shift().max(f.slope() / length)).sum();
        matches!(failure, Failure::TooSlow { last, .. } if *last < STALLED)
            || total > 0.0 && self.system.round_off() > DROWNED * total
    }

    /// What to try after the last state `q` that was found, if an electrode has closed its gap there.
    fn pulled_in(&self, q: Option<&[f64]>) -> Option<String> {
        pulled_in(self.model, &self.shape(q?), &self.shape(self.system.reference()))
    }
}
