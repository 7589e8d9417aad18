//! Vibrations and critical loads, as a trajectory shows them.

use super::sampler::Sampler;
use super::{Control, Observer, Progress, RunError};
use crate::assembly::InternalVariables;
use crate::model::{About, Static};
use crate::solve::eigen::EigenError;
use crate::solve::{buckling, modal, statics};
use crate::trajectory::{AnalysisKind, Shape, Statistics, Trajectory};

/// Accuracy of the equilibrium: as far as round-off lets Newton's method come, because stress, and
/// with it the stiffness, is a small difference of large numbers.
const TO_THE_END: f64 = 1e-14;
/// A long step past the critical load of a nearly perfect structure may end on the unstable branch
/// of a perfect one. Before a state is refused as unstable, its path is followed again in so many
/// parts of the load.
const FINER: [usize; 2] = [20, 200];
/// Turn of a node before buckling to which the linear solution is trusted \[rad\].
const STRAIGHT: f64 = 0.1;
/// Axial strain before buckling to which it is trusted; critical loads err by as much.
const STRAINED: f64 = 0.05;
/// Largest displacement of a drawn mode, in beam lengths.
const DRAWN: f64 = 0.1;

impl Sampler<'_> {
    /// The `count` lowest vibrations about a state, which is found first.
    pub(super) fn vibrations(
        &self,
        count: usize,
        about: About,
        observer: Observer<'_>,
    ) -> Result<Trajectory, RunError> {
        if about == About::Reference {
            let mut trajectory = self.empty(AnalysisKind::Modal);
            trajectory.last = self.unloaded();
            let mut x = self.system.reference().to_vec();
            x.resize(x.len() + self.system.multipliers(), 0.0);
            return self.modal(trajectory, (0.0, &x, &InternalVariables::default()), count);
        }
        let report = &mut |load: f64, step: f64, statistics: &Statistics| {
            let newton_iterations = statistics.newton_iterations;
            observer(&Progress { parameter: load, target: 1.0, step, newton_iterations }) == Control::Continue
        };
        let (mut parts, mut finer) = (1, FINER.into_iter());
        loop {
            let settings = Static { tolerance: Some(TO_THE_END), steps: Some(parts), ..Static::default() };
            let mut solution = statics::solve(self.system, &settings, None, &mut *report);
            if let Some(stuck) = &solution.stuck {
                return Err(self.stuck(stuck, &solution));
            }
            // The way there is of no interest, only that it led there.
            solution.keep_last();
            let trajectory = self.equilibria(AnalysisKind::Modal, &solution);
            let variables = solution.variables.last().cloned().unwrap_or_default();
            let vibrations = match solution.states.last() {
                Some((load, x)) if *load == 1.0 => self.modal(trajectory, (*load, x, &variables), count),
                // Stopped on the way.
                _ => Ok(trajectory),
            };
            match (vibrations, finer.next()) {
                (Err(RunError::Eigen(EigenError::Unstable { .. })), Some(next)) => parts = next,
                (found, _) => return found,
            }
        }
    }

    fn modal(
        &self,
        mut trajectory: Trajectory,
        (load, x, variables): (f64, &[f64], &InternalVariables),
        count: usize,
    ) -> Result<Trajectory, RunError> {
        if load == 0.0 && self.system.has_loads() {
            trajectory.warnings.push(
                "loads take no part in vibrations about the stress-free state: `about = \"equilibrium\"` in [analysis.modal] finds those about the \
                 equilibrium under them"
                    .into(),
            );
        }
        let about = if load == 0.0 { "the stress-free state" } else { "the equilibrium under all loads" };
        trajectory.settings.push(("vibrations about".into(), about.into()));
        let modes = modal::solve(self.system, load, x, variables, count)?;
        let q = self.coordinates_of(x);
        trajectory.modes = modes.shapes.iter().map(|mode| self.mode_shape(q, mode)).collect();
        trajectory.statistics.factorizations += modes.factorizations;
        trajectory.frequencies = modes.frequencies;
        Ok(trajectory)
    }

    pub(super) fn buckling(&self, modes: &buckling::Modes) -> Trajectory {
        let mut trajectory = self.empty(AnalysisKind::Buckling);
        trajectory.last = self.unloaded();
        trajectory.load_factors = modes.load_factors.clone();
        let reference = self.system.reference();
        trajectory.modes = modes.shapes.iter().map(|mode| self.mode_shape(reference, mode)).collect();
        trajectory.statistics.factorizations = modes.factorizations;
        trajectory.warnings.extend(beyond_the_linear(modes));
        trajectory
    }

    /// The stress-free state.
    fn unloaded(&self) -> Vec<Shape> {
        let reference = self.system.reference();
        self.loaded(reference, &self.system.static_actions(0.0, reference, &InternalVariables::default()))
    }

    /// The state `q` with a mode added, its largest displacement a tenth of a beam length.
    fn mode_shape(&self, q: &[f64], mode: &[f64]) -> Vec<Shape> {
        let largest = mode.chunks_exact(4).fold(0.0_f64, |m, d| m.max(d[0].hypot(d[1])));
        let factor = if largest > 0.0 { DRAWN * self.system.length() / largest } else { 0.0 };
        let q: Vec<f64> = q.iter().zip(mode).map(|(q, m)| factor.mul_add(*m, *q)).collect();
        self.shape(&q)
    }
}

/// What there is to say about critical loads before which the linear solution turns or strains the
/// beams by more than it may.
fn beyond_the_linear(modes: &buckling::Modes) -> Option<String> {
    let numbered = || modes.load_factors.iter().zip(1..);
    let (turned, number) = numbered().find(|(load, _)| *load * modes.turn > STRAIGHT).unzip();
    let (strained, second) = numbered().find(|(load, _)| *load * modes.strain > STRAINED).unzip();
    let which = |number: Option<usize>| match number {
        Some(1) | None => String::new(),
        Some(number) => format!("critical loads from number {number} on are beyond the linear solution: "),
    };
    match (turned, strained) {
        (Some(load), _) => Some(format!(
            "{}the loads turn the beam by {:.2} rad before it buckles at load factor {load:.6}, by the linear solution, which holds for small turns only: \
             follow the path with `arc_length` in [analysis.static], which finds limit points and bifurcations of the bent structure",
            which(number),
            load * modes.turn,
        )),
        (None, Some(load)) => Some(format!(
            "{}the loads strain the beam by {:.2} before it buckles at load factor {load:.6}, by the linear solution, which holds for small strains only, as \
             does the beam itself: give a larger `axial_stiffness`, or ask for fewer critical loads",
            which(second),
            load * modes.strain,
        )),
        (None, None) => None,
    }
}
