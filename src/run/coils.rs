//! Beams that lie on themselves.

use crate::model::{Centreline, Model};
use std::f64::consts::TAU;

/// Turns beyond one that are round-off.
const MORE: f64 = 1e-6;

/// A message for every beam that is an arc of more than one turn, as one is whose degrees are taken for radians.
pub(super) fn coils(model: &Model) -> impl Iterator<Item = String> {
    model.beams.iter().filter_map(|beam| {
        let Centreline::Arc { from, to, .. } = beam.centreline else { return None };
        let turns = (to - from).abs() / TAU;
        (turns > 1.0 + MORE).then(|| {
            format!(
                "beam `{}` is an arc of {turns:.2} turns, which lies on itself; a number alone is an angle in radians, and text may be one in degrees, \
                 as \"90 deg\"",
                beam.name
            )
        })
    })
}
