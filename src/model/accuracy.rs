//! What error results may have, and what may be chosen to that end.

use super::{Analysis, Discretization, Model, Static};

/// The largest errors that results may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Statics and motions: of the positions of the probes and of the shape, in lengths of the
    /// beam. Vibrations and critical loads: of every number, relative.
    pub result: f64,
    /// Of the curvature, relative to its largest; `None`: not asked for.
    pub curvature: Option<f64>,
    /// Of the section forces, relative to their largest; `None`: not asked for.
    pub section_force: Option<f64>,
}

impl Accuracy {
    /// Where nothing else is said.
    pub const USUAL: f64 = 1e-4;

    /// This error of the result; curvature and section forces are not asked for.
    pub fn new(result: f64) -> Self {
        Self { result, curvature: None, section_force: None }
    }
}

impl Default for Accuracy {
    fn default() -> Self {
        Self::new(Self::USUAL)
    }
}

/// What a scene leaves to be chosen for an accuracy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Open {
    /// Per beam, whether it has no discretisation of its own.
    pub beams: Vec<bool>,
    /// Whether a motion has no integrator of its own.
    pub integrator: bool,
    /// Whether the path of equilibria with friction has no largest load step of its own.
    pub load_steps: bool,
}

impl Open {
    /// The beams of `model` that are [`Discretization::Open`]; with `integrator` also how time
    /// advances.
    pub fn of(model: &Model, analysis: &Analysis, integrator: bool) -> Self {
        let beams = model.beams.iter().map(|beam| beam.discretization == Discretization::Open).collect();
        Self {
            beams,
            integrator: integrator && matches!(analysis, Analysis::Dynamic(_)),
            load_steps: follows_friction(model, analysis)
                && matches!(analysis, Analysis::Static(Static { max_step: None, .. })),
        }
    }

    /// Everything: all beams, and how time or the load advances.
    pub fn all(model: &Model, analysis: &Analysis) -> Self {
        Self {
            beams: vec![true; model.beams.len()],
            integrator: matches!(analysis, Analysis::Dynamic(_)),
            load_steps: follows_friction(model, analysis),
        }
    }

    /// Nothing.
    pub fn none(model: &Model) -> Self {
        Self { beams: vec![false; model.beams.len()], ..Self::default() }
    }

    /// Whether nothing is left to be chosen.
    pub fn is_closed(&self) -> bool {
        !self.integrator && !self.load_steps && !self.beams.contains(&true)
    }
}

/// Whether friction makes the results of `analysis` depend on load steps. Those along a path by arc length are not chosen.
fn follows_friction(model: &Model, analysis: &Analysis) -> bool {
    model.has_friction() && matches!(analysis, Analysis::Static(Static { arc_length: None, .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_open_beam_or_integrator_leaves_something_to_be_chosen() {
        let closed = |beams: &[bool], integrator: bool| {
            Open { beams: beams.into(), integrator, load_steps: false }.is_closed()
        };
        assert!(closed(&[false, false], false) && closed(&[], false));
        assert!(!closed(&[false, true], false) && !closed(&[false], true));
        assert!(!Open { load_steps: true, ..Open::default() }.is_closed());
        assert_eq!(Accuracy::default(), Accuracy { result: 1e-4, curvature: None, section_force: None });
    }
}
