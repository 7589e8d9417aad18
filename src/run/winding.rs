//! Torsion springs that are wound up beyond half a turn, whose moment then jumps.

use super::angle;
use crate::model::Model;
use crate::system::{System, SystemError, View, unfold};
use std::f64::consts::PI;

/// The torsion springs of a model, and how far they were wound.
#[derive(Clone)]
pub(super) struct Winding {
    springs: Vec<Spring>,
}

#[derive(Clone)]
struct Spring {
    beam: usize,
    view: View,
    /// θ of the stress-free state \[rad\].
    start: f64,
    /// θ of the last state, and the largest |θ − θ₀|.
    last: f64,
    largest: f64,
}

impl Winding {
    /// Of all springs of `model`.
    pub fn new(model: &Model, system: &System) -> Result<Self, SystemError> {
        let springs = model.parts.iter().filter_map(|part| part.torsion_spring()).map(|at| {
            let s = system.arc_length("a torsion spring", at)?;
            let part = &system.beams()[at.beam];
            let view =
                View::point(&part.basis, part.offset(), s).map_err(|e| SystemError::basis(&part.name, e))?;
            let start = view.fields(system.reference()).angle();
            Ok(Spring { beam: at.beam, view, start, last: start, largest: 0.0 })
        });
        Ok(Self { springs: springs.collect::<Result<_, SystemError>>()? })
    }

    /// Takes a state into account, and of a load step the state before it.
    pub fn see(&mut self, system: &System, before: Option<&[f64]>, q: &[f64]) {
        for spring in &mut self.springs {
            let part = &system.beams()[spring.beam];
            let turned = before.map_or(0.0, |before| angle::turn(part, spring.view.s()[0], before, q));
            spring.last = unfold(spring.view.fields(q).angle(), Some(spring.last + turned));
            spring.largest = spring.largest.max((spring.last - spring.start).abs());
        }
    }

    /// What there is to say.
    pub fn warnings<'w>(&'w self, system: &'w System) -> impl Iterator<Item = String> + 'w {
        let wound = self.springs.iter().filter(|spring| spring.largest > PI);
        wound.map(|spring| {
            format!(
                "the torsion spring at s = {:.6} m of beam `{}` is wound up by {:.2} rad, but counts its angle from −π to π: where it passed half a turn \
                 its moment jumped to the other side, and what follows is wrong; keep it within half a turn",
                spring.view.s()[0],
                system.beams()[spring.beam].name,
                spring.largest,
            )
        })
    }
}
