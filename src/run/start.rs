//! Statics that starts from the state that another run has left.

use super::{Options, RunError, needs};
use crate::basis::BasisCache;
use crate::model::{Analysis, Model};
use crate::restart::SavedState;
use crate::results::TakenUp;
use crate::solve::dynamics::State;
use crate::solve::resume::{Holding, resume};
use crate::system::System;
use std::borrow::Cow;
use std::sync::Arc;

/// The model of a static analysis, and its equations, which begin in the state that `options` give,
/// or else as the model says.
pub(super) struct Start<'m> {
    pub model: Cow<'m, Model>,
    pub system: System,
    /// The state.
    pub state: Option<State>,
    /// What held it, where that is known.
    holding: Option<Holding>,
}

impl<'m> Start<'m> {
    pub(super) fn new(
        model: &'m Model,
        analysis: &Analysis,
        options: &Options<'_>,
    ) -> Result<Self, RunError> {
        let Some(saved) = options.start else {
            let system = System::build_with(model, needs(analysis), options.cache)?;
            return Ok(Self { model: Cow::Borrowed(model), system, state: None, holding: None });
        };
        let asked = model;
        let model = saved.gone_on(model);
        let mut system = System::build_with(&model, needs(analysis), options.cache)?;
        let (checkpoint, _) = saved.take_up(&model, &system, "")?;
        let state = checkpoint.state;
        let holding = saved.holding(asked, &system);
        resume(&mut system, &state.q, &state.variables, holding.as_ref());
        Ok(Self { model: Cow::Owned(model), system, state: Some(state), holding })
    }

    /// The equations of another model, with the same unknowns, from the same state.
    pub(super) fn with_model(
        &self,
        model: &Model,
        analysis: &Analysis,
        cache: Option<&BasisCache>,
    ) -> Result<System, RunError> {
        let mut system = System::build_with(model, needs(analysis), cache)?;
        if let Some(state) = &self.state {
            resume(&mut system, &state.q, &state.variables, self.holding.as_ref());
        }
        Ok(system)
    }

    /// What a later look at the states of the run needs to know of the state.
    pub(super) fn taken_up(&self) -> Option<TakenUp> {
        let model = Arc::new(self.model.clone().into_owned());
        self.state.as_ref().map(|State { q, variables, .. }| TakenUp {
            model,
            q: q.clone(),
            variables: variables.clone(),
            holding: self.holding.clone(),
        })
    }

    /// Directions at the probes in the state \[rad\], with full turns included.
    pub(super) fn angles(&self) -> Vec<f64> {
        self.state.as_ref().map_or_else(Vec::new, |state| state.angles.clone())
    }

    /// The time of the state \[s\].
    pub(super) fn time(&self) -> f64 {
        self.state.as_ref().map_or(0.0, |state| state.time)
    }
}

/// The equations of a run whose states are looked at again.
pub(super) fn again(
    taken_up: &TakenUp,
    analysis: &Analysis,
    cache: Option<&BasisCache>,
) -> Result<System, RunError> {
    let mut system = System::build_with(&taken_up.model, needs(analysis), cache)?;
    match analysis {
        Analysis::Dynamic(_) => system.freeze(&taken_up.q),
        _ => resume(&mut system, &taken_up.q, &taken_up.variables, taken_up.holding.as_ref()),
    }
    Ok(system)
}

/// What a run tells of the state in which it starts.
pub(super) fn told(saved: &SavedState) -> (String, String) {
    let from = if saved.is_equilibrium() { "a static equilibrium" } else { "the end of a motion" };
    ("starts from".into(), from.into())
}
