//! Names of beams and places on them → indices and arc lengths.

use super::diagnose::choices;
use super::error::Fault;
use super::value::{At, Located};
use crate::centreline::Curve;
use crate::model::Place;

/// Name and curve of a beam, for the checks of other tables.
pub(super) struct Built {
    pub name: Located<String>,
    pub curve: Curve,
}

/// The index of the beam of that name.
pub(super) fn beam_index(name: &Located<String>, built: &[Built]) -> Result<usize, Fault> {
    built.iter().position(|beam| beam.name.get() == name.get()).ok_or_else(|| {
        let names: Vec<String> = built.iter().map(|beam| beam.name.get().clone()).collect();
        Fault::new(name.span(), format!("there is no beam named `{}`", name.get())).help(choices(
            "beams of this scene",
            name.get(),
            &names,
        ))
    })
}

/// A point of a beam.
pub(super) fn place(beam: &Located<String>, at: &Located<At>, built: &[Built]) -> Result<Place, Fault> {
    let index = beam_index(beam, built)?;
    let length = built.get(index).map_or(0.0, |b| b.curve.length());
    let s = at.get().on(length);
    if !(0.0..=length).contains(&s) {
        return Err(Fault::new(
            at.span(),
            format!("arc length {s} m is not on beam `{}`, which is {length} m long", beam.get()),
        )
        .help(format!("give \"start\", \"end\" or an arc length from 0 to {length} m")));
    }
    Ok(Place { beam: index, s })
}
