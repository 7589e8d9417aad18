//! Analyses one after the other, each from where the one before it ended.

use super::{Control, Inventory, Options, Progress, RunError};
use crate::assembly::Part;
use crate::effect::Tendon;
use crate::model::{Analysis, Displacement, Model, Stage};
use crate::restart::SavedState;
use crate::results::Results;
use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

/// What is computed of a scene with stages.
#[derive(Debug)]
pub struct StagesRun {
    /// The results of the stages, in their order: of all, or up to the one that failed or was
    /// stopped, with what is known of it.
    pub results: Vec<Results>,
    /// Why there are no more.
    pub failure: Option<RunError>,
}

impl StagesRun {
    /// The results of the last stage.
    ///
    /// # Errors
    /// [`RunError`], of the stage that failed.
    pub fn last(self) -> Result<Results, RunError> {
        let Self { mut results, failure } = self;
        match (failure, results.pop()) {
            (None, Some(last)) => Ok(last),
            (failure, _) => Err(failure.unwrap_or(RunError::Stages)),
        }
    }
}

/// The model of a stage as it is built: joints of a stage that goes on may be open when it starts.
pub fn model_of_stage(stages: &[Stage], index: usize) -> (Model, &Analysis) {
    let Stage { model, analysis, .. } = &stages[index];
    let mut model = model.clone();
    if index > 0 {
        model.standing = Some(Vec::new());
        // Supports that move by no law hold a motion where it is.
        let moves = matches!(analysis, Analysis::Dynamic(_));
        let begins = &model.entering.supports;
        for (i, support) in model.supports.iter_mut().enumerate() {
            let holds = moves && support.law.is_none() && !begins.contains(&i);
            if holds && stages[..index].iter().any(|before| before.model.supports.contains(support)) {
                support.displacement = Displacement::default();
            }
        }
    }
    (model, analysis)
}

/// What would be built of every stage, by [`super::inspect`] or [`super::measure`], with its name.
///
/// # Errors
/// [`RunError::InStage`] where a stage contradicts itself.
pub fn inspect_stages(
    stages: &[Stage],
    look: impl Fn(&Model, &Analysis) -> Result<Inventory, RunError>,
) -> Result<Vec<(&str, Inventory)>, RunError> {
    let of = |(index, Stage { name, .. }): (usize, &'_ Stage)| {
        let (model, analysis) = model_of_stage(stages, index);
        look(&model, analysis)
            .map_err(|cause| RunError::InStage { stage: name.clone(), cause: Box::new(cause) })
    };
    let inventories = stages.iter().enumerate().map(of).collect::<Result<Vec<_>, _>>()?;
    Ok(stages.iter().map(|stage| stage.name.as_str()).zip(inventories).collect())
}

/// The part that fades where `part` has gone, if there is one: of a tendon of given length one that pulls
/// as it does in the state that was reached. `tensions` are those of the tendons of given length, in turn.
fn fading(part: &Arc<dyn Part>, tensions: &mut impl Iterator<Item = f64>) -> Option<Arc<dyn Part>> {
    let any: &dyn Any = part.as_ref();
    match any.downcast_ref::<Tendon>() {
        Some(tendon) if tendon.shortening.is_some() => {
            tensions.next().map(|tension| Arc::new(tendon.pulled_with(tension)) as Arc<dyn Part>)
        }
        _ => part.fades().then(|| Arc::clone(part)),
    }
}

/// Those parts of `acted` that have gone where a model goes on, as they fade.
fn gone(acted: &[Arc<dyn Part>], model: &Model, tensions: &[f64]) -> Vec<Arc<dyn Part>> {
    let parts = model.parts.iter().enumerate();
    let mut going_on: Vec<_> =
        parts.filter(|(i, _)| !model.entering.parts.contains(i)).map(|(_, part)| part).collect();
    let mut tensions = tensions.iter().copied();
    let of = |part: &Arc<dyn Part>| {
        let fading = fading(part, &mut tensions);
        match going_on.iter().position(|other| *other == part) {
            Some(same) => {
                going_on.swap_remove(same);
                None
            }
            None => fading,
        }
    };
    acted.iter().filter_map(of).collect()
}

/// Solves `stages`, the first from the start that `options` give. The others start where the one
/// before them ended: motions at rest after statics, and with its velocities after a motion. In
/// statics what is new grows with the load factor, and what has gone fades. Vibrations leave the
/// state as it was.
pub fn solve_stages(stages: &[Stage], options: Options<'_>) -> StagesRun {
    solve_stages_by(stages, options, &mut |_, model, analysis, options| model.solve_with(analysis, options))
}

/// Solves a stage: its number, its model with what fades there, its analysis, and what it starts from.
type SolveStage<'s> = dyn FnMut(usize, &Model, &Analysis, Options<'_>) -> Result<Results, RunError> + 's;

/// [`solve_stages`], each stage by `solve`.
pub(crate) fn solve_stages_by(
    stages: &[Stage],
    mut options: Options<'_>,
    solve: &mut SolveStage<'_>,
) -> StagesRun {
    let mut run = StagesRun { results: Vec::with_capacity(stages.len()), failure: None };
    let mut reached: Option<SavedState> = None;
    // The parts that have acted in the state that was reached.
    let mut acted: &[Arc<dyn Part>] = &[];
    // The tensions of those among them that are tendons of given length.
    let mut held: Vec<f64> = Vec::new();
    let mut observer = options.observer.take();
    for (index, Stage { name, model, analysis }) in stages.iter().enumerate() {
        let mut watch =
            |now: &Progress| observer.as_mut().map_or(Control::Continue, |observer| observer(now));
        let here = Options {
            start: reached.as_ref().or(options.start),
            observer: Some(&mut watch),
            ..options.copied()
        };
        let time = reached.as_ref().map_or(0.0, SavedState::time);
        // A follower load that has gone would make the equations of vibrations unsymmetric.
        let fades = |part: &Arc<dyn Part>| matches!(analysis, Analysis::Static(_)) || part.tendon().is_some();
        let gone = gone(acted, model, &held).into_iter().filter(fades);
        let fading: Vec<_> = gone.map(|part| (part, time)).collect();
        let model = if fading.is_empty() {
            Cow::Borrowed(model)
        } else {
            Cow::Owned(Model { fading, ..model.clone() })
        };
        match solve(index, &model, analysis, here) {
            Ok(results) => {
                let complete = results.run().complete;
                let saved = results.states().saved.clone();
                let tensions: Vec<f64> = results.run().tensions.iter().map(|of| of.tension).collect();
                run.results.push(results);
                if !complete {
                    break;
                }
                let moves_on = matches!(analysis, Analysis::Static(_) | Analysis::Dynamic(_));
                match saved {
                    None if moves_on && index + 1 < stages.len() => {
                        run.failure = Some(RunError::OpenEnd { stage: name.clone() });
                        break;
                    }
                    None => {}
                    saved => (reached, acted, held) = (saved, &stages[index].model.parts, tensions),
                }
            }
            Err(mut error) => {
                run.results.extend(error.take_partial());
                run.failure = Some(RunError::InStage { stage: name.clone(), cause: Box::new(error) });
                break;
            }
        }
    }
    run
}
