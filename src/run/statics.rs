//! Equilibria of a model.

use super::sampler::Sampler;
use super::start::{Start, told};
use super::{Options, RunError, Solve, Stopwatch, Watch, left, memory, timed};
use crate::model::{Analysis, Model, Static};
use crate::results::{RecordedState, RecordedStates, Statistics, Trajectory};
use crate::solve::statics::{self, Target};

impl Solve for Static {
    type Results = Trajectory;

    fn solve(&self, model: &Model, options: Options<'_>) -> Result<Trajectory, RunError> {
        let analysis = Analysis::Static(self.clone());
        let mut stopwatch = Stopwatch::start();
        memory::check(model, &analysis)?;
        let start = Start::new(model, &analysis, &options)?;
        let (asked, model, system) = (model, &*start.model, &start.system);
        let mut sampler = Sampler::new(model, system, options.detail())?;
        sampler.angles = start.angles();
        let target = match &self.arc_length {
            None => None,
            Some(arc) => Some(Target { arc, probe: sampler.end_of_path(arc)? }),
        };
        let leads_on = |target: &Target<'_>| target.arc.until_load.is_some() || system.is_driven(0.0);
        if !target.as_ref().is_none_or(leads_on) {
            return Err(RunError::NoPath);
        }
        stopwatch.built();
        let mut watch = Watch { open: self.arc_length.is_some(), ..Watch::new(options.observer) };
        let report =
            &mut |load: f64, step: f64, statistics: &Statistics| watch.goes_on(load, 1.0, step, statistics);
        let solution = statics::solve(system, self, target.as_ref(), report);
        stopwatch.solved();
        let unreached = solution.unreached.zip(self.arc_length.as_ref());
        let mut outcome = match (&solution.stuck, unreached) {
            (Some(stuck), _) => Err(sampler.stuck(stuck, &solution, self.arc_length.is_some())),
            (None, Some((why, arc))) => Err(sampler.unreached(why, arc, &solution)),
            (None, None) => {
                let mut trajectory = sampler.statics(&solution);
                trajectory.run.warnings.extend(sampler.on_the_way(&solution));
                if options.saved {
                    trajectory.saved = sampler.equilibrium(&solution, &trajectory, asked, start.time());
                }
                trajectory.run.settings.extend(options.start.map(told));
                Ok(trajectory)
            }
        };
        if let Some(trajectory) = left(&mut outcome) {
            if model.outputs.section_forces {
                let states = solution.states.iter().zip(&solution.variables);
                let acted = states.map(|((load, x), variables)| {
                    let actions = system.static_actions(*load, x, variables);
                    (sampler.coordinates_of(x), None, Some(actions))
                });
                sampler.record_sections(trajectory, acted);
            }
            if options.states {
                let states = solution.states.into_iter().zip(solution.variables);
                let states = states.map(|((_, x), variables)| RecordedState::Equilibrium { x, variables });
                trajectory.states =
                    Some(RecordedStates { states: states.collect(), taken_up: start.taken_up() });
            }
        }
        timed(outcome, |trajectory| trajectory, &watch, stopwatch)
    }
}
